//! The rungs once more, judged on their physics alone, as unit tests of the library: mutation testing runs them in the one
//! binary that builds fastest. `cargo test` skips them, as it runs the rungs from `tests.rs`.

use super::{Fault, RUNGS};
use std::path::Path;

macro_rules! climb {
    ($($name:ident),* $(,)?) => {
        $(
            #[test]
            #[ignore = "for mutation testing; the tests of `verification/tests.rs` run the same"]
            fn $name() {
                let rung = RUNGS.iter().find(|r| r.name == stringify!($name)).expect("a rung of that name");
                let verdict = (rung.run)(&Fault::NONE).expect("a run that ends").verdict(rung.name, Path::new(""));
                assert!(verdict.passes(), "{verdict}");
            }
        )*
    };
}

each_rung!(climb);
