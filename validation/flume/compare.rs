//! The paper's numbers with ours beside them.

use crate::case_run::CaseRun;
use crate::data::{self, Datum};
use checkdam_verification::report::{number, quoted};

/// The file of the paper's numbers for the flume.
pub const PUBLISHED: data::Source = data::SOURCES[0];

/// What stands beside a published number, from the quantities of a run by their names.
pub type Counterpart = fn(&dyn Fn(&str) -> f64) -> f64;

/// The published numbers of a case that have a counterpart here, with what gives it from the quantities of a run.
pub fn published(case: &str) -> Vec<(Datum, Counterpart)> {
    let rows = data::rows(PUBLISHED).into_iter().filter(|r| r.case == case);
    rows.filter_map(|r| Some((counterpart(&r.quantity)?, r))).map(|(of, r)| (r, of)).collect()
}

/// What of a run stands beside a published quantity.
fn counterpart(quantity: &str) -> Option<Counterpart> {
    Some(match quantity {
        "front velocity before impact" => |q| q("front_velocity_m_per_s"),
        "Froude number before impact" | "Froude number before impact, observed" => |q| q("froude_1"),
        "flow depth before impact" => |q| q("front_depth_m"),
        "share of the initial energy dissipated" => |q| q("dissipated_1"),
        "static force" => |q| q("static_force_n"),
        "largest over static force" => |q| q("peak_20ms_n") / q("static_force_n"),
        // The experiment's largest force stands beside the largest mean over 20 ms.
        "largest measured force" => |q| q("peak_20ms_n"),
        "time to static force" => |q| q("time_to_static_s"),
        "time from impact to static force" => |q| q("time_to_static_s") - q("arrival_s"),
        _ => return None,
    })
}

/// Published, ours, difference, for both cases.
pub fn against_paper(flumes: &[CaseRun]) -> String {
    let mut text = String::from("case,quantity,unit,kind,published,uncertainty,checkdam,difference_percent\n");
    for flume in flumes {
        for (datum, of) in published(flume.name) {
            let ours = of(&|q| flume.get(q));
            // Adding zero turns a rounded -0.0 into 0.0.
            let difference = (1000.0 * (ours / datum.value - 1.0)).round() / 10.0 + 0.0;
            let (value, uncertainty) = (number(datum.value), number(datum.uncertainty));
            let (name, quantity) = (flume.name, quoted(&datum.quantity));
            text += &format!(
                "{name},{quantity},{},{},{value},{uncertainty},{ours:.4},{difference:.1}\n",
                datum.unit, datum.kind
            );
        }
    }
    text
}
