//! The verdict on a number: comparison error beside numerical, input and data uncertainty, in the manner of ASME V&V 20 (2009).

use super::plan::{CHANGES, COLUMNS};
use crate::data::Datum;
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

/// Standard uncertainty of an even spread of this half width.
pub fn even(half_width: f64) -> f64 {
    half_width / 3f64.sqrt()
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
    /// The number `column` of `case`, on its grids. Changed inputs are those of `changed`, a case that has them; they count in
    /// proportion to its number.
    ///
    /// The finest value counts. A line through the values against the cell size, by least squares, says how far it is from
    /// none; u_num is half of that distance, times 1.25 where the values have an observed order between 1/2 and 2 and 3 where
    /// they do not, together with what the values deviate from the line and what repetitions scatter (after Eca and Hoekstra
    /// 2014; half, since theirs is meant as two standard deviations).
    pub fn new(rows: &[Recorded], case: &str, cells: [usize; 3], column: &str, changed: &str) -> Self {
        let at = |c: &str, n: Option<usize>, change: &str| {
            let row = rows.iter().find(|r| r.case == c && n.is_none_or(|n| r.cells == n) && r.change == change);
            row.map_or(f64::NAN, |r| r.get(column))
        };
        let grids = cells.map(|n| at(case, Some(n), "base"));
        let spacings = cells.map(|n| 1.0 / n as f64);
        let study = Study::new(grids, spacings);
        let (slope, deviation) = line(spacings, grids);
        let factor = if (0.5..=2.0).contains(&study.order) { 1.25 } else { 3.0 };
        let grid = 0.5 * factor * (slope * spacings[2]).abs();

        let on = rows.iter().find(|r| r.case == changed && r.change == CHANGES[1].0).map(|r| r.cells);
        let base = at(changed, on, "base");
        let relative = |change: &str| at(changed, on, change) / base;
        let again: Vec<f64> = CHANGES.iter().filter(|c| c.1.is_empty()).map(|c| relative(c.0)).chain([1.0]).collect();
        let mean = again.iter().sum::<f64>() / again.len() as f64;
        let scatter = (again.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (again.len() - 1) as f64).sqrt();
        let mut parts: Vec<(f64, &str)> = Vec::new();
        for cause in causes() {
            let own = CHANGES.iter().filter(|c| c.1 == cause).map(|c| relative(c.0));
            let (low, high) =
                own.filter(|x| x.is_finite()).chain([1.0]).fold((1.0f64, 1.0f64), |(a, b), x| (a.min(x), b.max(x)));
            parts.push((even(0.5 * (high - low)), cause));
        }
        let input = parts.iter().map(|p| p.0 * p.0).sum::<f64>().sqrt();
        let largest = parts.iter().max_by(|a, b| a.0.total_cmp(&b.0)).map_or("", |p| p.1);
        Self {
            grids,
            study,
            numerical: grid.hypot(deviation).hypot(scatter * grids[2]),
            input: input * grids[2].abs(),
            largest_input: largest.into(),
        }
    }

    /// Everything but the data, and the data.
    pub fn validation(&self, datum: &Datum, scale: f64) -> f64 {
        self.numerical.hypot(self.input).hypot(even(datum.uncertainty) / scale)
    }
}

/// Slope of the straight line through three points, by least squares, and the standard deviation from it.
pub fn line(x: [f64; 3], y: [f64; 3]) -> (f64, f64) {
    let [mx, my] = [x, y].map(|v| v.iter().sum::<f64>() / 3.0);
    let pairs = || x.iter().zip(y).map(|(x, y)| (x - mx, y - my));
    let slope = pairs().map(|(x, y)| x * y).sum::<f64>() / pairs().map(|(x, _)| x * x).sum::<f64>();
    (slope, pairs().map(|(x, y)| (y - slope * x) * (y - slope * x)).sum::<f64>().sqrt())
}

/// Causes of input uncertainty, each once.
pub fn causes() -> Vec<&'static str> {
    let mut causes: Vec<&str> = CHANGES.iter().map(|c| c.1).filter(|c| !c.is_empty() && *c != "base").collect();
    causes.dedup();
    causes
}

/// What the difference from a datum allows one to say. `scale` is the length r0 that the datum is given in, 1 for ratios.
pub fn sentence(ours: &Ours, datum: &Datum, scale: f64) -> &'static str {
    let error = (ours.grids[2] - datum.value / scale).abs();
    let without_input = ours.numerical.hypot(even(datum.uncertainty) / scale);
    match error {
        e if e <= 2.0 * without_input => "agrees within numerical and data uncertainty",
        e if e <= 2.0 * ours.validation(datum, scale) => {
            "not resolved: inputs that are not known do not determine this number"
        }
        _ => "disagrees by more than all stated uncertainties",
    }
}
