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

        #[test]
        fn every_rung_is_here() {
            assert_eq!(RUNGS.iter().map(|r| r.name).collect::<Vec<_>>(), [$(stringify!($name)),*]);
        }
    };
}

climb!(
    exactness,
    self_weight,
    sliding_block,
    drucker_prager_point,
    celerity,
    energy,
    earth_pressure,
    manufactured,
    cantilever,
    neo_hookean,
    contact,
    wall_pressure,
    collapse,
    convergence
);
