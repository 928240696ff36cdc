//! The paper's numbers with ours beside them.

use crate::case_run::CaseRun;
use crate::counterpart::Counterpart;
use crate::data::{self, Datum};
use checkdam_verification::report::{number, quoted};

/// The file of the paper's numbers for the flume.
pub const PUBLISHED: data::Source = data::SOURCES[0];

/// The published numbers of a case that have a counterpart here, with it: closed forms are no data.
pub fn published(case: &str) -> Vec<(Datum, Counterpart)> {
    let rows = data::rows(PUBLISHED).into_iter().filter(|r| r.case == case && r.kind != "theory");
    rows.filter_map(|r| Some((r.ours.clone()?, r))).map(|(of, r)| (r, of)).collect()
}

/// Published, ours, difference, for both cases.
pub fn against_paper(flumes: &[CaseRun]) -> String {
    let mut text = String::from("case,quantity,unit,kind,published,uncertainty,checkdam,difference_percent\n");
    for flume in flumes {
        for (datum, of) in published(flume.name) {
            let ours = of.of(&|q| flume.get(q));
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
