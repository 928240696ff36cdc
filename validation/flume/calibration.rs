//! The open inputs together: which of them the paper's numbers can identify, and what no set of them can fit.
//!
//! The misfit of a run to a case is the mean of ((ours - published) / u)^2 over the published numbers that have a counterpart. Here u^2 is
//! the sum of the squares of the datum's half width and of our numerical uncertainty. One set has to serve both angles. Runs are judged at
//! rest. The sample is run on 20 mm cells; its best are run again at 10 mm, and the best of those is frozen in `40deg_calibrated.toml` and
//! `23deg_calibrated.toml`.

use super::baseline::{self, Numerical};
use super::rules::{Energy, judge};
use super::{compare, read_case};
use crate::counterpart::Counterpart;
use crate::data::Datum;
use crate::record::Record;
use crate::runs::{self, Run};
use crate::{Context, Failure, Validation};
use checkdam::output::Table;
use checkdam::plot::PlotError;
use checkdam::plot::curves::{self, Curve, Curves, panel};
use checkdam_verification::Outcome;
use checkdam_verification::report::{number, quoted};
use std::path::Path;

/// The analysis of the recorded runs.
pub const VALIDATION: Validation = Validation {
    name: "flume_calibration",
    title: "The open inputs of the flume together: misfit, profiles, trade-off between the angles, the best set",
    study: "360 runs on coarse cells and 18 on fine ones, about 20 minutes",
    run,
    draw,
    covers: &[],
};

/// The sample.
pub const SAMPLE: Record = Record {
    name: "flume_calibration",
    study: include_str!("studies/calibration.toml"),
    read: read_case,
    runs: include_str!("runs/calibration.csv"),
};

/// The best of the sample on finer cells.
pub const REFINED: Record = Record {
    name: "flume_refined",
    study: include_str!("studies/refined.toml"),
    read: read_case,
    runs: include_str!("runs/refined.csv"),
};

/// Numbers that are sampled, and into how many classes a profile divides them.
const RANGES: [&str; 3] = ["gate_speed_m_per_s", "side_friction_1", "pic_rate_per_s"];
const CLASSES: usize = 4;
/// Words that are sampled.
const CHOICES: [&str; 2] = ["container", "cone"];
/// Cases in the order of the tables.
const ANGLES: [&str; 2] = ["40deg", "23deg"];

/// Published numbers of a case with what stands beside them and the standard deviation of the difference.
pub struct Target {
    /// The number.
    pub datum: Datum,
    /// Ours, from the quantities of a run.
    pub of: Counterpart,
    /// Standard deviation of ours from numerical causes.
    pub numerical: f64,
}

impl Target {
    /// Distance of a run over its standard deviation.
    pub fn distance(&self, run: &Run) -> f64 {
        (run.value(&self.of) - self.datum.value) / self.datum.uncertainty.hypot(self.numerical)
    }
}

/// What a case is fitted to.
pub fn targets(case: &str, repetitions: &[Run]) -> Vec<Target> {
    let published = compare::published(case).into_iter();
    published
        .map(|(datum, of)| {
            let numerical = Numerical::of(repetitions, case, &|r| r.value(&of)).uncertainty();
            Target { datum, of, numerical }
        })
        .collect()
}

/// Label of the set that fits both angles best on fine cells; empty if none came to rest at both.
pub fn best(refined: &[Run], repetitions: &[Run]) -> String {
    let targets = ANGLES.map(|case| targets(case, repetitions));
    members(refined, &targets).first().map_or_else(String::new, |m| m.label.to_string())
}

/// One set of inputs, run at both angles.
struct Member<'a> {
    label: &'a str,
    runs: [&'a Run; 2],
    misfit: [f64; 2],
}

impl Member<'_> {
    fn both(&self) -> f64 {
        0.5 * (self.misfit[0] + self.misfit[1])
    }
}

/// Sets whose runs came to rest at both angles, best first.
fn members<'a>(rows: &'a [Run], targets: &[Vec<Target>; 2]) -> Vec<Member<'a>> {
    let find =
        |case: &str, label: &str| rows.iter().find(|r| r.case == case && r.label == label && r.ended == "at rest");
    let mut members: Vec<Member> = (rows.iter().filter(|r| r.case == ANGLES[0]))
        .filter_map(|r| {
            let runs = [find(ANGLES[0], &r.label)?, find(ANGLES[1], &r.label)?];
            let misfit = [0, 1].map(|k| {
                let squares = targets[k].iter().map(|t| t.distance(runs[k]).powi(2));
                squares.sum::<f64>() / targets[k].len() as f64
            });
            Some(Member { label: &r.label, runs, misfit })
        })
        .filter(|m| m.both().is_finite())
        .collect();
    members.sort_by(|a, b| a.both().total_cmp(&b.both()));
    members
}

fn run(context: &mut Context) -> Result<Outcome, Failure> {
    let columns: Vec<&str> = RANGES.into_iter().chain(CHOICES).collect();
    let sample = runs::rows(&SAMPLE.table(context)?, &columns)?;
    let refined = runs::rows(&REFINED.table(context)?, &[])?;
    let repetitions = runs::rows(&Table::parse(baseline::RECORD.runs, "flume/runs/baseline.csv")?, &["cell_m"])?;
    let targets = ANGLES.map(|case| targets(case, &repetitions));
    let mut outcome = Outcome::default();
    // All of them have side walls, which hold a part of the deposit.
    let all: Vec<Run> = sample.iter().chain(&refined).cloned().collect();
    outcome.checks = judge(&all, Energy::Released, &|_| false);
    let members = members(&sample, &targets);
    outcome.tables.push(("flume_calibration_sets".into(), sets(&members, &columns)));
    outcome.tables.push(("flume_calibration_profiles".into(), profiles(&members)));
    outcome.tables.push(("flume_calibration_front".into(), front(&members)));
    outcome
        .tables
        .push(("flume_calibration_residuals".into(), residuals(&self::members(&refined, &targets), &targets)));
    Ok(outcome)
}

/// All sets, best first.
fn sets(members: &[Member], columns: &[&str]) -> String {
    let mut text = format!("set,{},misfit_40deg,misfit_23deg,misfit\n", columns.join(","));
    for m in members {
        let inputs: Vec<String> = columns.iter().map(|c| quoted(&m.runs[0].set[*c])).collect();
        let [a, b] = m.misfit.map(number);
        text += &format!("{},{},{a},{b},{}\n", m.label, inputs.join(","), number(m.both()));
    }
    text
}

/// The least misfit in each class of each input: an input whose profile is flat cannot be identified.
fn profiles(members: &[Member]) -> String {
    let mut text = String::from("input,class,middle,misfit_40deg,misfit_23deg,misfit,sets\n");
    let mut line = |input: &str, class: &str, middle: f64, of: &dyn Fn(&Member) -> bool| {
        let own: Vec<&Member> = members.iter().filter(|m| of(m)).collect();
        let least = |value: &dyn Fn(&Member) -> f64| own.iter().map(|m| value(m)).fold(f64::INFINITY, f64::min);
        let numbers = [least(&|m| m.misfit[0]), least(&|m| m.misfit[1]), least(&|m| m.both())].map(number);
        let middle = if middle.is_nan() { String::new() } else { number(middle) };
        text += &format!("{input},{},{middle},{},{}\n", quoted(class), numbers.join(","), own.len());
    };
    for input in RANGES {
        let value = |m: &Member| m.runs[0].set[input].parse::<f64>().unwrap_or(f64::NAN);
        let mut sorted: Vec<f64> = members.iter().map(value).filter(|v| v.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        for class in 0..CLASSES {
            // Classes of equal number.
            let part = &sorted[class * sorted.len() / CLASSES..(class + 1) * sorted.len() / CLASSES];
            let (Some(&low), Some(&high)) = (part.first(), part.last()) else { continue };
            let inside = |m: &Member| (low..=high).contains(&value(m));
            line(input, &format!("{} to {}", number(low), number(high)), part[part.len() / 2], &inside);
        }
    }
    for input in CHOICES {
        let mut names: Vec<&String> = members.iter().map(|m| &m.runs[0].set[input]).collect();
        names.sort();
        names.dedup();
        for name in names {
            line(input, name, f64::NAN, &|m| m.runs[0].set[input] == *name);
        }
    }
    text
}

/// Sets of which no other is better at both angles.
fn front(members: &[Member]) -> String {
    let beaten =
        |m: &Member| members.iter().any(|o| (0..2).all(|k| o.misfit[k] <= m.misfit[k]) && o.misfit != m.misfit);
    let mut best: Vec<&Member> = members.iter().filter(|m| !beaten(m)).collect();
    best.sort_by(|a, b| a.misfit[0].total_cmp(&b.misfit[0]));
    let mut text = String::from("set,misfit_40deg,misfit_23deg\n");
    for m in best {
        text += &format!("{},{},{}\n", m.label, number(m.misfit[0]), number(m.misfit[1]));
    }
    text
}

/// Every published number against every set that was run on fine cells.
fn residuals(members: &[Member], targets: &[Vec<Target>; 2]) -> String {
    let mut text = String::from("set,misfit,case,quantity,published,standard_deviation,checkdam,distance\n");
    for m in members {
        for (k, case) in ANGLES.iter().enumerate() {
            for t in &targets[k] {
                let ours = m.runs[k].value(&t.of);
                let deviation = t.datum.uncertainty.hypot(t.numerical);
                let numbers = [t.datum.value, deviation, ours, t.distance(m.runs[k])].map(number);
                let (set, quantity) = (quoted(m.label), quoted(&t.datum.quantity));
                text += &format!("{set},{},{case},{quantity},{}\n", number(m.both()), numbers.join(","));
            }
        }
    }
    text
}

const PROFILES: Curves = Curves {
    x: "middle",
    x_title: "input, middle of its class",
    y_title: "least misfit in the class",
    curves: &[
        Curve { column: "misfit_40deg", label: "40 degrees alone", exact: false },
        Curve { column: "misfit_23deg", label: "23 degrees alone", exact: false },
        Curve { column: "misfit", label: "one set for both", exact: false },
    ],
    panels: &[
        panel("speed of the gate (m/s)", &[("input", "gate_speed_m_per_s")]),
        panel("friction of the side walls", &[("input", "side_friction_1")]),
        panel("rate of PIC damping (1/s)", &[("input", "pic_rate_per_s")]),
    ],
    ..Curves::LOGARITHMIC
};

const FRONT: Curves = Curves {
    x: "misfit_40deg",
    x_title: "misfit at 40 degrees",
    y_title: "misfit at 23 degrees",
    curves: &[Curve { column: "misfit_23deg", label: "sets of which no other is better at both angles", exact: false }],
    ..Curves::LOGARITHMIC
};

fn draw(folder: &Path) -> Result<Vec<String>, PlotError> {
    let drawn = [("profiles", &PROFILES), ("front", &FRONT)];
    let draw = |(stem, what): (&str, &Curves)| {
        let name = format!("flume_calibration_{stem}_plot.svg");
        let table = folder.join(format!("flume_calibration_{stem}.csv"));
        curves::draw(table, what, folder.join(&name)).map(|()| name)
    };
    drawn.into_iter().map(draw).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use checkdam::case::parse;

    /// Targets that ask for a force of 10 N at 40 and 20 N at 23 degrees, both to 1 N.
    fn wanted() -> [Vec<Target>; 2] {
        [10.0, 20.0].map(|value| {
            let datum = compare::published("40deg").remove(0).0;
            let of = Counterpart::parse("static_force_n").expect("a quantity");
            vec![Target { datum: Datum { value, uncertainty: 0.6, ..datum }, of, numerical: 0.8 }]
        })
    }

    fn set(label: &str, forces: [f64; 2], speed: f64) -> [Run; 2] {
        [0, 1].map(|k| {
            let mut run = Run::with(ANGLES[k], "sample", label, &[("static_force_n", forces[k])]);
            run.set.extend(RANGES.map(|c| (c.to_string(), speed.to_string())));
            run.set.extend(CHOICES.map(|c| (c.to_string(), if speed < 2.0 { "a" } else { "b" }.to_string())));
            run
        })
    }

    #[test]
    fn sets_are_ordered_by_both_angles_and_the_front_keeps_what_is_not_beaten() {
        let mut runs: Vec<Run> = [
            set("both", [11.0, 21.0], 1.0),
            set("steep", [10.0, 23.0], 2.0),
            set("beaten", [12.0, 22.0], 3.0),
            set("gentle", [14.0, 20.0], 4.0),
            set("restless", [10.0, 20.0], 5.0),
        ]
        .concat();
        runs[8].ended = "end time".into();
        let members = members(&runs, &wanted());
        assert_eq!(members.iter().map(|m| m.label).collect::<Vec<_>>(), ["both", "beaten", "steep", "gentle"]);
        assert!((members[2].misfit[1] - 9.0).abs() < 1e-12 && (members[0].both() - 1.0).abs() < 1e-12);
        let front = front(&members);
        let sets: Vec<&str> = front.lines().skip(1).filter_map(|l| l.split(',').next()).collect();
        assert_eq!(sets, ["steep", "both", "gentle"]);
        let profiles = profiles(&members);
        assert!(profiles.contains("container,a,,1,1,1,1\n"), "{profiles}");
        assert!(profiles.contains("cone,b,,0,0,4,3\n"), "{profiles}");
    }

    /// The set that was found stands in the case files, and nowhere else anything was changed.
    #[test]
    fn the_calibrated_cases_are_the_best_set() {
        let read = |record: &Record, columns: &[&str]| {
            runs::rows(&Table::parse(record.runs, record.name).expect("a record"), columns).expect("a record")
        };
        let best = best(&read(&REFINED, &[]), &read(&baseline::RECORD, &["cell_m"]));
        let (_, plan) = REFINED.plan().expect("a study");
        for (name, text) in
            [("40deg", include_str!("40deg_calibrated.toml")), ("23deg", include_str!("23deg_calibrated.toml"))]
        {
            let mut planned =
                plan.iter().find(|r| r.case_name == name && r.label == best).expect("the set").case.clone();
            let frozen = parse(text, name).expect("a case").case;
            // What is written, and how far the run may go, is no input of the model.
            planned.title.clone_from(&frozen.title);
            planned.output.clone_from(&frozen.output);
            planned.gauges.clone_from(&frozen.gauges);
            assert_eq!(frozen, planned, "{name}");
        }
    }
}
