//! A case file changed from code: how the force at rest goes with the friction of the base.
//!
//! ```sh
//! cargo run --release --example change_a_case
//! ```

use checkdam::case;
use checkdam::run::{Summary, run_in_memory};
use std::error::Error;
use std::path::Path;

/// Runs the flume at 40 degrees on coarse cells with another friction of its base.
fn with_base_friction(friction: f64) -> Result<Summary, Box<dyn Error>> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/flume/40deg.toml");
    let mut case = case::load(&file)?.case;
    case.grid.spacing_m = 0.025;
    case.gauges.field_times_s.clear();
    case.stages.run.end_time_s = 2.0;
    let base = case.boundaries.iter_mut().find(|b| b.name == "base").ok_or("no boundary of that name")?;
    base.friction = Some(friction);
    // What a file may not say, code may not either.
    let case = case::parse(&case.to_toml()?, "changed")?.case;
    Ok(run_in_memory(&case, &mut |_| true)?.2)
}

fn main() -> Result<(), Box<dyn Error>> {
    for friction in [0.3, 0.4, 0.5] {
        let summary = with_base_friction(friction)?;
        let barrier = summary.barrier.ok_or("no barrier is gauged")?;
        println!("friction {friction}: {:6.1} N at rest", barrier.static_force_n);
    }
    Ok(())
}

#[test]
fn the_force_at_rest_is_one_that_the_base_allows() {
    for friction in [0.3, 0.5] {
        let summary = with_base_friction(friction).expect("it runs");
        let deposit = summary.deposit.expect("a base is gauged");
        let force = summary.barrier.expect("a barrier is gauged").static_force_n;
        // What the wall does not hold the base has to: at most its friction.
        let by_the_base = (deposit.weight_along_n - force).abs();
        assert!(by_the_base <= 1.01 * deposit.friction_limit_n, "{friction}: {force} N, {by_the_base} N by the base");
    }
}
