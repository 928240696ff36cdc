//! The flume's verdicts: what stands behind those of `verdict.rs`.
//!
//! u_num comes from three grids and repetitions; u_D is the datum's half width, taken as evenly spread; u_input is from the inputs
//! of the one-at-a-time study. Inputs that the paper states count with the half of their last digit's unit, as far as the study
//! varies them.

use super::baseline::{self, Numerical};
use super::{calibration, sensitivity};
use crate::Failure;
use crate::counterpart::Counterpart;
use crate::data::Datum;
use crate::record::Record;
use crate::runs::{self, Run};
use crate::verdict::{Uncertainty, Verdict, even, of_inputs};
use checkdam::output::Table;

/// What the paper leaves open: causes of input uncertainty.
const UNSTATED: [&str; 10] = [
    "bulk density",
    "container",
    "cone",
    "friction angle",
    "base friction",
    "base model",
    "side walls",
    "gate",
    "tilt",
    "PIC per second",
];

/// Two ways to fill in what the paper leaves open: literally, and by the best set that was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reading {
    /// The gate is gone at once, no side walls.
    Literal,
    /// The frozen set.
    Calibrated,
}

impl Reading {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Literal, Self::Calibrated];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Literal => "literal",
            Self::Calibrated => "calibrated",
        }
    }
}

/// A published number with ours beside it.
#[derive(Debug, Clone)]
pub struct Judged {
    /// Ours.
    pub ours: f64,
    /// Ours less the published number.
    pub error: f64,
    /// How sure of that one can be.
    pub uncertainty: Uncertainty,
    /// The input with the largest share.
    pub largest: String,
    /// What may be said.
    pub said: &'static str,
}

/// The recorded runs that verdicts rest on.
pub struct Basis {
    repetitions: Vec<Run>,
    finest: Vec<Run>,
    changed: Vec<Run>,
    refined: Vec<Run>,
    best: String,
}

impl Basis {
    /// From the records.
    ///
    /// # Errors
    /// A record is not as it should be.
    pub fn read() -> Result<Self, Failure> {
        let read = |record: &Record, columns: &[&str]| -> Result<Vec<Run>, Failure> {
            Ok(runs::rows(&Table::parse(record.runs, record.name)?, columns)?)
        };
        let repetitions = read(&baseline::RECORD, &["cell_m"])?;
        let refined = read(&calibration::REFINED, &[])?;
        let best = calibration::best(&refined, &repetitions);
        let finest = read(&baseline::FINEST, &["cell_m"])?;
        Ok(Self { changed: read(&sensitivity::RECORD, &[])?, repetitions, finest, refined, best })
    }

    /// What three grids say of a quantity.
    pub fn numerical(&self, case: &str, of: &Counterpart) -> Numerical {
        Numerical::of(&self.repetitions, case, &|r| r.value(of))
    }

    /// The quantity in the one run on the finest grid.
    pub fn finest(&self, case: &str, of: &Counterpart) -> f64 {
        self.finest.iter().find(|r| r.case == case).map_or(f64::NAN, |r| r.value(of))
    }

    /// The quantity with the frozen set.
    pub fn calibrated(&self, case: &str, of: &Counterpart) -> f64 {
        self.refined.iter().find(|r| r.case == case && r.label == self.best).map_or(f64::NAN, |r| r.value(of))
    }

    /// The runs that differ from the literal reading in one thing that the paper leaves open, and came to rest.
    pub fn open(&self, case: &str) -> impl Iterator<Item = &Run> {
        open(&self.changed, case)
    }

    /// A published number, and ours by a reading.
    pub fn judge(&self, reading: Reading, case: &str, datum: &Datum, of: &Counterpart) -> Judged {
        let numerical = self.numerical(case, of);
        let (ours, (input, largest)) = match reading {
            Reading::Literal => (numerical.scatter[1].mean, input(&self.changed, case, of)),
            // A calibrated input is no longer open; what remains of its uncertainty is not known, and not claimed.
            Reading::Calibrated => (self.calibrated(case, of), (0.0, String::new())),
        };
        let uncertainty = Uncertainty { numerical: numerical.uncertainty(), input, data: even(datum.uncertainty) };
        let error = ours - datum.value;
        Judged { ours, error, uncertainty, largest, said: Verdict::of(error, &uncertainty).sentence(NOT_RESOLVED) }
    }
}

fn open<'a>(runs: &'a [Run], case: &str) -> impl Iterator<Item = &'a Run> {
    // A rough base is a limit to look at, not a reading of a friction coefficient of 0.4.
    let stays = |r: &Run| r.label != "rough" && r.ended == "at rest" && UNSTATED.contains(&r.factor.as_str());
    runs.iter().filter(move |r| r.case == case && stays(r))
}

/// Standard uncertainty from the inputs, and the largest of its parts with its cause.
fn input(runs: &[Run], case: &str, of: &Counterpart) -> (f64, String) {
    let base = runs.iter().find(|r| r.case == case && r.factor == "base").map_or(f64::NAN, |r| r.value(of));
    let own = |factor: &str| open(runs, case).filter(|r| r.factor == factor).map(|r| r.value(of)).collect();
    let (total, largest) = of_inputs(base, UNSTATED.map(|factor| (factor, own(factor))));
    (total, largest.to_string())
}

/// What leaves a number of the flume unresolved.
const NOT_RESOLVED: &str = "not resolved: the inputs that are not stated do not determine this number";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_add_up_by_their_squares() {
        let run =
            |factor: &str, label: &str, force: f64| Run::with("40deg", factor, label, &[("static_force_n", force)]);
        let mut runs = vec![
            run("base", "", 100.0),
            run("gate", "slow", 94.0),
            run("gate", "slower", 88.0),
            run("cone", "plane strain", 108.0),
            run("cell size", "0.02 m", 500.0),
            run("base friction", "rough", 10.0),
        ];
        let of = &Counterpart::parse("static_force_n").expect("a quantity");
        let (total, largest) = input(&runs, "40deg", of);
        assert!((total - (6.0f64.powi(2) + 4.0f64.powi(2)).sqrt() / 3f64.sqrt()).abs() < 1e-12);
        assert_eq!(largest, "gate");
        assert_eq!(open(&runs, "40deg").map(|r| r.value(of)).collect::<Vec<_>>(), [94.0, 88.0, 108.0]);
        // What did not come to rest says nothing.
        runs[2].ended = "end time".into();
        assert!(input(&runs, "40deg", of).0 < total);
    }
}
