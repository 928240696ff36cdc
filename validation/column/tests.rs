//! The data and the record are what they say.

use super::plan::{self, CASES};
use super::{RECORD, verdict};
use crate::data;
use checkdam::theory::collapse as law;

fn value(id: &str) -> f64 {
    data::row(data::COLUMNS, id).value
}

#[test]
fn the_rows_are_the_laws_that_they_quote() {
    for (id, quoted) in [
        ("L1", law::lube_run_out(0.5)),
        ("L2", law::lube_run_out(1.0)),
        ("L3", law::lube_run_out(4.0)),
        ("L4", law::lube_height(0.5)),
        ("L5", law::lube_height(1.0)),
        ("L6", law::lube_height(4.0)),
        ("J1", law::lajeunesse_run_out(0.5)),
        ("J2", law::lajeunesse_run_out(1.0)),
        ("J3", law::lajeunesse_run_out(4.0)),
        ("J4", law::lajeunesse_height(4.0)),
    ] {
        assert!((value(id) - quoted).abs() < 5e-5, "{id}: {} {quoted}", value(id));
    }
    let avalanche = value("M8").to_radians();
    for (id, slope) in [("M3", 0.0f64), ("M4", 10.0), ("M5", 16.0), ("M6", 19.0)] {
        let quoted = law::slope_run_out(0.14, slope.to_radians(), avalanche, 0.5);
        assert!((value(id) - quoted).abs() < 5e-5, "{id}: {} {quoted}", value(id));
    }
}

#[test]
fn the_record_is_that_of_the_plan() {
    let rows = verdict::recorded(RECORD).expect("a record");
    let plan = plan::all();
    assert_eq!(rows.len(), plan.len());
    for (row, run) in rows.iter().zip(&plan) {
        assert_eq!((row.case.as_str(), row.cells, row.change.as_str()), (run.case.name, run.cells, run.change));
        assert!(row.numbers.iter().all(|x| x.is_finite()), "{}, {}: {:?}", row.case, row.change, row.numbers);
    }
    for run in plan {
        let [r0, h0] = run.case.size;
        let high = h0 / r0 * run.cells as f64;
        assert!((high - high.round()).abs() < 1e-9, "{}: {high} cells over the height", run.case.name);
        assert!(CASES.contains(&run.case));
    }
}

#[test]
fn every_cause_is_there_once() {
    assert_eq!(verdict::causes().len(), 8, "{:?}", verdict::causes());
}
