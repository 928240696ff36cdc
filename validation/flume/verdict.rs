//! The verdict in the manner of ASME V&V 20 (2009): what the difference from the paper allows one to say.
//!
//! E = S - D is the difference of our number and the paper's; u_val^2 = u_num^2 + u_input^2 + u_D^2. The error of the model lies
//! in E -+ 2 u_val. Where |E| is below 2 u_val, the comparison cannot tell the model from a perfect one: the number is not
//! resolved. u_num comes from three grids and repetitions; u_D is the datum's half width, taken as evenly spread; u_input is
//! the root of the sum of squares over the inputs of the one-at-a-time study, half the span that each causes, taken as evenly
//! spread. Inputs that the paper states count with the half of their last digit's unit, as far as the study varies them.

use super::baseline::{self, Numerical};
use super::runs::{self, Run};
use super::{calibration, compare, sensitivity};
use crate::check::{Check, Kind};
use crate::output::Table;
use crate::plot::PlotError;
use crate::validation::{Context, Failure, Validation};
use crate::verification::Outcome;
use crate::verification::report::{number, quoted};
use std::path::Path;

/// The verdict.
pub const VALIDATION: Validation = Validation {
    name: "flume_verdict",
    title: "The flume against the paper: comparison error beside numerical, input and data uncertainty",
    study: "",
    run,
    draw: |_: &Path| -> Result<Vec<String>, PlotError> { Ok(Vec::new()) },
    covers: &[],
};

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

/// Standard uncertainty of an even spread of this half width.
fn even(half_width: f64) -> f64 {
    half_width / 3f64.sqrt()
}

/// What stands behind a verdict.
struct Uncertainty {
    numerical: f64,
    input: f64,
    data: f64,
}

impl Uncertainty {
    fn validation(&self) -> f64 {
        self.numerical.hypot(self.input).hypot(self.data)
    }
}

/// Standard uncertainty from the inputs, and the largest of its parts with its cause.
fn input(runs: &[Run], case: &str, of: &dyn Fn(&Run) -> f64) -> (f64, String) {
    let base = runs.iter().find(|r| r.case == case && r.factor == "base").map_or(f64::NAN, of);
    let part = |factor: &&str| {
        // A rough base is a limit to look at, not a reading of a friction coefficient of 0.4.
        let own = runs
            .iter()
            .filter(|r| r.case == case && r.factor == **factor && r.label != "rough" && r.ended == "at rest");
        let values = own.map(of).chain([base]).filter(|v| v.is_finite());
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        even(0.5 * (high - low))
    };
    let parts: Vec<(f64, &str)> = UNSTATED.iter().map(|f| (part(f), *f)).collect();
    let total = parts.iter().map(|p| p.0 * p.0).sum::<f64>().sqrt();
    let largest = parts.iter().max_by(|a, b| a.0.total_cmp(&b.0)).map_or("", |p| p.1);
    (total, largest.to_string())
}

fn sentence(error: f64, u: &Uncertainty) -> &'static str {
    let without_input = u.numerical.hypot(u.data);
    match error.abs() {
        e if e <= 2.0 * without_input => "agrees within numerical and data uncertainty",
        e if e <= 2.0 * u.validation() => "not resolved: the inputs that are not stated do not determine this number",
        _ => "disagrees by more than all stated uncertainties",
    }
}

fn run(_: &mut Context) -> Result<Outcome, Failure> {
    let read = |record: &crate::validation::record::Record, columns: &[&str]| -> Result<Vec<Run>, Failure> {
        Ok(runs::rows(&Table::parse(record.runs, record.name)?, columns)?)
    };
    let repetitions = read(&baseline::RECORD, &["cell_m"])?;
    let changed = read(&sensitivity::RECORD, &[])?;
    let refined = read(&calibration::REFINED, &[])?;
    let best = calibration::best(&refined, &repetitions);
    let mut outcome = Outcome::default();
    let mut text = String::from(
        "reading,case,quantity,unit,kind,published,checkdam,error,u_num,u_input,u_data,u_val,error_over_2_u_val,largest_input,verdict\n",
    );
    let mut logs: Vec<(&str, f64)> = Vec::new();
    let (mut given, mut asked) = (0, 0);
    for reading in ["literal", "calibrated"] {
        for case in ["40deg", "23deg"] {
            for (datum, of) in compare::published(case) {
                if datum.kind == "theory" {
                    continue;
                }
                let value = |r: &Run| of(&|q| r.get(q));
                let numerical = Numerical::of(&repetitions, case, &value);
                let ours = if reading == "literal" {
                    numerical.scatter[1].mean
                } else {
                    refined.iter().find(|r| r.case == case && r.label == best).map_or(f64::NAN, value)
                };
                let (input, largest) = input(&changed, case, &value);
                // A calibrated input is no longer open; what remains of its uncertainty is not known, and not claimed.
                let input = if reading == "literal" { input } else { 0.0 };
                let u = Uncertainty { numerical: numerical.uncertainty(), input, data: even(datum.uncertainty) };
                let error = ours - datum.value;
                let over = error.abs() / (2.0 * u.validation());
                let numbers =
                    [datum.value, ours, error, u.numerical, u.input, u.data, u.validation(), over].map(number);
                let largest = if reading == "literal" { largest } else { String::new() };
                let (quantity, unit, kind) = (quoted(&datum.quantity), &datum.unit, &datum.kind);
                let said = sentence(error, &u);
                text += &format!("{reading},{case},{quantity},{unit},{kind},{},{largest},{said}\n", numbers.join(","));
                if ours > 0.0 && datum.value > 0.0 {
                    logs.push((reading, libm::log(ours / datum.value)));
                }
                given += usize::from([ours, error, over].iter().all(|x| x.is_finite()));
                asked += 1;
            }
        }
    }
    outcome.check(
        Check::value("verdicts whose numbers are all there", given as f64, asked as f64, "1")
            .because("a published number that has a counterpart here must not drop out")
            .from(Kind::Published, "validation/flume/published.csv"),
    );
    outcome.tables.push(("flume_verdict_table".into(), text));
    outcome.tables.push(("flume_verdict_bias".into(), bias(&logs)));
    Ok(outcome)
}

/// Mean and scatter of ours over published, as factors (geometric), over all quantities of a reading.
fn bias(logs: &[(&str, f64)]) -> String {
    let mut text = String::from("reading,bias_factor,scatter_factor,quantities\n");
    for reading in ["literal", "calibrated"] {
        let s = super::scatter::Scatter::of(logs.iter().filter(|l| l.0 == reading).map(|l| l.1));
        let numbers = [libm::exp(s.mean), libm::exp(s.deviation)].map(number);
        text += &format!("{reading},{},{}\n", numbers.join(","), s.count);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_may_be_said() {
        let u = Uncertainty { numerical: 3.0, input: 12.0, data: 4.0 };
        assert_eq!(u.validation(), 13.0);
        assert!(sentence(-10.0, &u).starts_with("agrees"));
        assert!(sentence(10.1, &u).starts_with("not resolved") && sentence(-26.0, &u).starts_with("not resolved"));
        assert!(sentence(26.1, &u).starts_with("disagrees") && sentence(f64::NAN, &u).starts_with("disagrees"));
    }

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
        ];
        let (total, largest) = input(&runs, "40deg", &|r| r.get("static_force_n"));
        assert!((total - (6.0f64.powi(2) + 4.0f64.powi(2)).sqrt() / 3f64.sqrt()).abs() < 1e-12);
        assert_eq!(largest, "gate");
        // What did not come to rest says nothing.
        runs[2].ended = "end time".into();
        assert!(input(&runs, "40deg", &|r| r.get("static_force_n")).0 < total);
        assert_eq!(even(3f64.sqrt()), 1.0);
    }

    #[test]
    fn bias_is_a_factor() {
        let logs = [("literal", libm::log(2.0)), ("literal", libm::log(8.0)), ("calibrated", 0.0)];
        let text = bias(&logs);
        assert!(text.contains("literal,4,"), "{text}");
    }
}
