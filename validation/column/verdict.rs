//! What stands behind the verdicts of the columns: numerical and input uncertainty, from the record.

use super::plan::{CHANGES, COLUMNS};
use crate::counterpart::Counterpart;
use crate::data::Datum;
use crate::verdict::{Uncertainty, Verdict, even, of_grids, of_inputs};
use checkdam::theory::order::Study;

/// A line of the record.
#[derive(Debug, Clone, PartialEq)]
pub struct Recorded {
    /// Case.
    pub case: String,
    /// Cells over r0.
    pub cells: usize,
    /// Change.
    pub change: String,
    /// In the order of [`COLUMNS`].
    pub numbers: [f64; 10],
}

impl Recorded {
    /// A number by its column.
    ///
    /// # Panics
    /// For a column that is none of [`COLUMNS`].
    pub fn get(&self, column: &str) -> f64 {
        let index = COLUMNS.iter().position(|c| *c == column);
        self.numbers[index.unwrap_or_else(|| panic!("no column {column}"))]
    }
}

/// The record's lines from its text.
///
/// # Errors
/// What is wrong with it.
pub fn recorded(text: &str) -> Result<Vec<Recorded>, String> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let rows = reader.deserialize::<(String, usize, String, [f64; 10])>();
    let rows = rows.map(|r| r.map(|(case, cells, change, numbers)| Recorded { case, cells, change, numbers }));
    rows.collect::<Result<_, _>>().map_err(|e| format!("the record of the columns: {e}"))
}

/// A number of ours with its uncertainties, in the number's unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Ours {
    /// On the three grids, coarse to fine.
    pub grids: [f64; 3],
    /// What they say.
    pub study: Study,
    /// From the grids and repetitions.
    pub numerical: f64,
    /// From the inputs.
    pub input: f64,
    /// Cause of the largest part of it.
    pub largest_input: String,
}

impl Ours {
    /// The number `of` of `case`, on its grids. Changed inputs are those of `changed`, a case that has them; they count in
    /// proportion to its number.
    ///
    /// The finest value counts; u_num is that of the grids ([`of_grids`]) together with what repetitions scatter.
    pub fn new(rows: &[Recorded], case: &str, cells: [usize; 3], of: &Counterpart, changed: &str) -> Self {
        let at = |c: &str, n: Option<usize>, change: &str| {
            let row = rows.iter().find(|r| r.case == c && n.is_none_or(|n| r.cells == n) && r.change == change);
            row.map_or(f64::NAN, |r| of.of(&|column| r.get(column)))
        };
        let grids = cells.map(|n| at(case, Some(n), "base"));
        let spacings = cells.map(|n| 1.0 / n as f64);
        let study = Study::new(grids, spacings);
        let on = rows.iter().find(|r| r.case == changed && r.change == CHANGES[1].0).map(|r| r.cells);
        let base = at(changed, on, "base");
        let relative = |change: &str| at(changed, on, change) / base;
        let again: Vec<f64> = CHANGES.iter().filter(|c| c.1.is_empty()).map(|c| relative(c.0)).chain([1.0]).collect();
        let mean = again.iter().sum::<f64>() / again.len() as f64;
        let scatter = (again.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (again.len() - 1) as f64).sqrt();
        let own = |cause: &str| CHANGES.iter().filter(|c| c.1 == cause).map(|c| relative(c.0)).collect();
        let (input, largest) = of_inputs(1.0, causes().into_iter().map(|cause| (cause, own(cause))));
        Self {
            grids,
            study,
            numerical: of_grids(&spacings, &grids, study.order).hypot(scatter * grids[2]),
            input: input * grids[2].abs(),
            largest_input: largest.into(),
        }
    }

    /// With the uncertainty of a datum. `scale` is the length r0 that it is given in, 1 for ratios.
    pub fn uncertainty(&self, datum: &Datum, scale: f64) -> Uncertainty {
        Uncertainty { numerical: self.numerical, input: self.input, data: even(datum.uncertainty) / scale }
    }
}

/// Causes of input uncertainty, each once.
pub fn causes() -> Vec<&'static str> {
    let mut causes: Vec<&str> = CHANGES.iter().map(|c| c.1).filter(|c| !c.is_empty() && *c != "base").collect();
    causes.dedup();
    causes
}

/// What the difference from a datum allows one to say; `scale` as of [`Ours::uncertainty`].
pub fn sentence(ours: &Ours, datum: &Datum, scale: f64) -> &'static str {
    let verdict = Verdict::of(ours.grids[2] - datum.value / scale, &ours.uncertainty(datum, scale));
    verdict.sentence("not resolved: inputs that are not known do not determine this number")
}
