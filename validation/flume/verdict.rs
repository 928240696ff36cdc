//! The verdict on every published number; `judge.rs` has the rules.

use super::compare;
use super::judge::{Basis, Reading};
use crate::{Context, Failure, Validation};
use checkdam::check::{Check, Kind};
use checkdam::plot::PlotError;
use checkdam_verification::Outcome;
use checkdam_verification::report::{number, quoted};
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

fn run(_: &mut Context) -> Result<Outcome, Failure> {
    let basis = Basis::read()?;
    let mut outcome = Outcome::default();
    let mut text = String::from(
        "reading,case,quantity,unit,kind,published,checkdam,error,u_num,u_input,u_data,u_val,error_over_2_u_val,largest_input,verdict\n",
    );
    let mut logs: Vec<(Reading, f64)> = Vec::new();
    let (mut given, mut asked) = (0, 0);
    for reading in Reading::ALL {
        for case in ["40deg", "23deg"] {
            for (datum, of) in compare::published(case) {
                let j = basis.judge(reading, case, &datum, &of);
                let u = j.uncertainty;
                let over = j.error.abs() / (2.0 * u.validation());
                let numbers =
                    [datum.value, j.ours, j.error, u.numerical, u.input, u.data, u.validation(), over].map(number);
                let first = [reading.name(), case, &quoted(&datum.quantity), &datum.unit, &datum.kind].join(",");
                text += &format!("{first},{},{},{}\n", numbers.join(","), j.largest, j.said);
                if j.ours > 0.0 && datum.value > 0.0 {
                    logs.push((reading, libm::log(j.ours / datum.value)));
                }
                given += usize::from([j.ours, j.error, over].iter().all(|x| x.is_finite()));
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
fn bias(logs: &[(Reading, f64)]) -> String {
    let mut text = String::from("reading,bias_factor,scatter_factor,quantities\n");
    for reading in Reading::ALL {
        let s = crate::scatter::Scatter::of(logs.iter().filter(|l| l.0 == reading).map(|l| l.1));
        let numbers = [libm::exp(s.mean), libm::exp(s.deviation)].map(number);
        text += &format!("{},{},{}\n", reading.name(), numbers.join(","), s.count);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bias_is_a_factor() {
        let logs = [(Reading::Literal, libm::log(2.0)), (Reading::Literal, libm::log(8.0)), (Reading::Calibrated, 0.0)];
        let text = bias(&logs);
        assert!(text.contains("literal,4,"), "{text}");
    }
}
