//! What decides the force at rest, and the ratio of the forces at both angles.
//!
//! A force at one angle can be met by many inputs. The ratio of the forces at 40 and 23 degrees has no free band: whatever scales both
//! drops out of it. Each set of inputs runs on moved grids at both angles. Pairs of sets stand for an input that differs by angle.

use super::calibration::SAMPLE;
use super::rules::{Energy, judge};
use super::{compare, read_case};
use crate::data;
use crate::record::Record;
use crate::runs::{self, Run};
use crate::scatter::Scatter;
use crate::{Context, Failure, Validation};
use checkdam::check::{Check, Expected, Kind, significant};
use checkdam::output::{Table, write_text};
use checkdam::plot::PlotError;
use checkdam::plot::tornado::{self, Tornado};
use checkdam_verification::Outcome;
use checkdam_verification::report::{number, quoted};
use std::path::Path;

/// The analysis of the recorded runs.
pub const VALIDATION: Validation = Validation {
    name: "flume_at_rest",
    title: "The force at rest at both angles and its ratio: slip before friction, static friction, gate, side walls, cone",
    study: "180 runs, about 7 minutes",
    run,
    draw,
    covers: &[],
};

/// The study and its record.
pub const RECORD: Record = Record {
    name: "flume_at_rest",
    study: include_str!("studies/at_rest.toml"),
    read: read_case,
    runs: include_str!("runs/at_rest.csv"),
};

/// The largest measured force at 40 degrees, the force at 23 that is computed or measured, and the ratio of the two there.
const PUBLISHED: [&str; 3] = ["F14", "F17", "F18"];
/// The cone that acts as another friction angle than the one that is stated.
const MISPRINTED: &str = "as printed";
/// Sets at 40 and at 23 degrees that differ in the gate alone: factor and label of each.
const BY_ANGLE: [[(&str, &str); 2]; 4] = [
    [("gate", "opens 0.1 m"), ("base", "")],
    [("gate", "opens 0.1 m, slip 1 mm"), ("slip length", "1 mm, base")],
    [("gate", "opens 0.1 m, side walls 0.2"), ("side walls", "0.2")],
    [("gate", "opens 0.1 m, side walls 0.2, slip 1 mm"), ("side walls", "0.2, slip 1 mm")],
];

/// Least and greatest measured ratio of the force at 40 to that at 23 degrees.
pub(super) fn measured() -> [f64; 2] {
    let [steep, flat, either] = PUBLISHED.map(|id| data::row(compare::PUBLISHED, id).value);
    [steep / flat, steep / flat * either]
}

/// The forces of a set at both angles.
#[derive(Debug, Clone)]
struct Set {
    name: String,
    forces: [Scatter; 2],
    /// Energy not accounted for, over E0, largest.
    residual: f64,
}

impl Set {
    /// Ratio of the forces, and its standard error.
    fn ratio(&self) -> [f64; 2] {
        let [steep, flat] = &self.forces;
        let ratio = steep.mean / flat.mean;
        let relative = (steep.standard_error() / steep.mean).hypot(flat.standard_error() / flat.mean);
        [ratio, ratio * relative]
    }
}

fn forces(rows: &[Run], case: &str, (factor, label): (&str, &str)) -> Scatter {
    let own = rows.iter().filter(|r| r.case == case && r.factor == factor && r.label == label && r.ended == "at rest");
    Scatter::of(own.map(|r| r.get("static_force_n")))
}

/// Energy not accounted for in the runs of a set at one angle, largest.
fn residual(rows: &[Run], case: &str, (factor, label): (&str, &str)) -> f64 {
    let own = rows.iter().filter(|r| r.case == case && r.factor == factor && r.label == label);
    own.map(|r| r.get("energy_residual_1")).fold(0.0, f64::max)
}

/// The sets in the order of the study.
fn sets(rows: &[Run]) -> Vec<Set> {
    let mut kinds: Vec<(&str, &str)> = Vec::new();
    for r in rows {
        let kind = (r.factor.as_str(), r.label.as_str());
        if !kinds.contains(&kind) {
            kinds.push(kind);
        }
    }
    let set = |kind: (&str, &str)| Set {
        name: if kind.1.is_empty() { kind.0.to_string() } else { format!("{}: {}", kind.0, kind.1) },
        forces: ["40deg", "23deg"].map(|case| forces(rows, case, kind)),
        residual: residual(rows, "40deg", kind).max(residual(rows, "23deg", kind)),
    };
    kinds.into_iter().map(set).collect()
}

/// Sets of which the gate differs by angle.
fn by_angle(rows: &[Run]) -> Vec<Set> {
    let words = |(factor, label): (&str, &str)| match (factor, label) {
        ("base", _) => "literal".to_string(),
        _ => format!("{factor} {label}"),
    };
    let pair = |[steep, flat]: &[(&str, &str); 2]| Set {
        name: format!("{}; at 23 degrees {}", words(*steep), words(*flat)),
        forces: [forces(rows, "40deg", *steep), forces(rows, "23deg", *flat)],
        residual: residual(rows, "40deg", *steep).max(residual(rows, "23deg", *flat)),
    };
    BY_ANGLE.iter().map(pair).collect()
}

fn run(context: &mut Context) -> Result<Outcome, Failure> {
    let rows = runs::rows(&RECORD.table(context)?, &[])?;
    let mut outcome = Outcome {
        // Side walls hold a part.
        checks: judge(&rows, Energy::Kinetic, &|r| !r.label.contains("side walls") && r.factor != "side walls"),
        ..Outcome::default()
    };
    let [low, high] = measured();
    let sets = sets(&rows);
    let stated: Vec<&Set> = sets.iter().filter(|s| !s.name.contains(MISPRINTED)).collect();
    let lowest = |sets: &[&Set]| {
        let least = sets.iter().map(|s| s.ratio()).map(|[ratio, error]| ratio - 2.0 * error);
        least.fold(f64::INFINITY, |a, b| if b.is_nan() { b } else { a.min(b) })
    };
    outcome.check(
        Check::new(
            "stated cone: force at 40 over that at 23 degrees, least less two errors",
            lowest(&stated),
            Expected::AtLeast(high),
            "1",
        )
        .because("a conclusion, not a demand: were it less, what the README says of the ratio would be wrong")
        .from(Kind::Measured, "Ng et al.: 79 N, and 55 N computed or measured"),
    );
    let sampled = least_sampled()?;
    outcome.check(
        Check::new(
            "stated cone: the same ratio in the sets of the calibration, least",
            sampled[0],
            Expected::AtLeast(high),
            "1",
        )
        .because("a conclusion, not a demand: were it less, what the README says of the ratio would be wrong")
        .from(Kind::Measured, "Ng et al.: 79 N, and 55 N computed or measured"),
    );
    let pairs = by_angle(&rows);
    let counted = sets.iter().flat_map(|s| &s.forces).map(|f| f.count).min().unwrap_or(0);
    outcome.check(
        Check::new("runs at rest of each set and angle, fewest", counted as f64, Expected::AtLeast(4.0), "1")
            .because("a scatter needs a few")
            .from(Kind::Conservation, "rest: 1e-4 of the energy, balanced and steady forces"),
    );
    let header = "set,force_40_n,deviation_40_n,runs_40,force_23_n,deviation_23_n,runs_23,ratio_1,ratio_error_1,energy_residual_1,reaches_measured\n";
    let line = |s: &Set| {
        let [ratio, error] = s.ratio();
        let reaches = ratio + 2.0 * error >= low && ratio - 2.0 * error <= high;
        let forces = s.forces.iter().map(|f| format!("{},{},{}", number(f.mean), number(f.deviation), f.count));
        let forces = forces.collect::<Vec<_>>().join(",");
        let reaches = if reaches { "yes" } else { "no" };
        format!("{},{forces},{},{},{},{reaches}\n", quoted(&s.name), number(ratio), number(error), number(s.residual))
    };
    for (name, sets) in [("flume_at_rest_sets", &sets), ("flume_at_rest_by_angle", &pairs)] {
        outcome.tables.push((name.into(), format!("{header}{}", sets.iter().map(line).collect::<String>())));
    }
    let ratios = [("measured, least", low), ("measured, greatest", high)];
    let ratios = ratios
        .into_iter()
        .chain(["sets of the calibration, stated cone, least", "the same, cone as printed"].into_iter().zip(sampled));
    let ratios = ratios.map(|(what, ratio)| format!("{},{}\n", quoted(what), number(ratio))).collect::<String>();
    outcome.tables.push(("flume_at_rest_ratios".into(), format!("what,ratio_1\n{ratios}")));
    outcome.tables.push(("flume_at_rest_table".into(), means(&rows)));
    Ok(outcome)
}

/// The least ratio in the recorded sets of the calibration: with a cone of the stated angle, and with the printed one.
fn least_sampled() -> Result<[f64; 2], Failure> {
    let rows = runs::rows(&Table::parse(SAMPLE.runs, "flume/runs/calibration.csv")?, &["cone"])?;
    let of = |case: &str, label: &str| {
        let found = rows.iter().find(|r| r.case == case && r.label == label && r.ended == "at rest");
        found.map_or(f64::NAN, |r| r.get("static_force_n"))
    };
    let least = |printed: bool| {
        let own = rows.iter().filter(|r| r.case == "40deg" && (r.set["cone"] == MISPRINTED) == printed);
        own.map(|r| of("40deg", &r.label) / of("23deg", &r.label)).fold(f64::INFINITY, f64::min)
    };
    Ok([least(false), least(true)])
}

/// Means over the moved grids in the form that the figure reads.
fn means(rows: &[Run]) -> String {
    let mut text = String::from("case,factor,label,ended,static_force_n\n");
    for case in ["40deg", "23deg"] {
        let mut done: Vec<(&str, &str)> = Vec::new();
        for r in rows.iter().filter(|r| r.case == case) {
            let kind = (r.factor.as_str(), r.label.as_str());
            if done.contains(&kind) {
                continue;
            }
            done.push(kind);
            let mean = forces(rows, case, kind).mean;
            let cells = [case, kind.0, kind.1, "at rest"].map(quoted).join(",");
            text += &format!("{cells},{}\n", number(mean));
        }
        let base = forces(rows, case, ("base", ""));
        for sign in [-2.0, 2.0] {
            let cells = [case, "noise", &format!("{sign} standard deviations"), ""].map(quoted).join(",");
            text += &format!("{cells},{}\n", number(base.mean + sign * base.deviation));
        }
    }
    text
}

fn draw(folder: &Path) -> Result<Vec<String>, PlotError> {
    let what = Tornado {
        panels: &[("40deg", "40 degrees"), ("23deg", "23 degrees")],
        column: "static_force_n",
        title: "static force (N), means of five grids",
        at_rest: true,
    };
    tornado::draw(folder.join("flume_at_rest_table.csv"), &what, folder.join("flume_at_rest_plot.svg"))?;
    let [sets, pairs, ratios] =
        ["sets", "by_angle", "ratios"].map(|t| Table::load(folder.join(format!("flume_at_rest_{t}.csv"))));
    let page = page(&sets?, &pairs?, &ratios?)?;
    write_text(folder.join("flume_at_rest.md"), &page)?;
    Ok(vec!["flume_at_rest_plot.svg".into(), "flume_at_rest.md".into()])
}

/// The page, from the tables.
fn page(sets: &Table, pairs: &Table, ratios: &Table) -> Result<String, checkdam::output::OutputError> {
    let mut text = String::from("# The flume at rest: what decides the force\n\n");
    text.push_str(
        "Static force at both angles and their ratio, on cells of 20 mm with contact on the surface. \u{b1} is the scatter of one run over moved \
         grids and other packings; of the ratio it is the standard error.\n\n| | ratio |\n|---|---|\n",
    );
    for (what, ratio) in ratios.cells("what")?.iter().zip(ratios.column("ratio_1")?) {
        text += &format!("| {what} | {ratio:.2} |\n");
    }
    text.push('\n');
    text += "![Static force by input](flume_at_rest_plot.svg)\n\n";
    for (title, table) in [("One set for both angles", sets), ("Another gate by angle", pairs)] {
        text += &format!(
            "## {title}\n\n| set | 40 degrees, N | 23 degrees, N | ratio | reaches the measured one | energy not accounted for, % of E0 |\n|---|---|---|---|---|---|\n"
        );
        let (names, reaches) = (table.cells("set")?, table.cells("reaches_measured")?);
        let column = |name: &str| table.column(name).map(<[f64]>::to_vec);
        let [a, da, b, db] = ["force_40_n", "deviation_40_n", "force_23_n", "deviation_23_n"].map(column);
        let (a, da, b, db) = (a?, da?, b?, db?);
        let (ratio, error, residual) = (column("ratio_1")?, column("ratio_error_1")?, column("energy_residual_1")?);
        for k in 0..table.rows() {
            let force = |mean: f64, deviation: f64| format!("{mean:.0} \u{b1} {}", significant(deviation, 2));
            text += &format!(
                "| {} | {} | {} | {:.2} \u{b1} {:.2} | {} | {:.1} |\n",
                names[k],
                force(a[k], da[k]),
                force(b[k], db[k]),
                ratio[k],
                error[k],
                reaches[k],
                100.0 * residual[k]
            );
        }
        text.push('\n');
    }
    text += "Runs, one by one: [`flume/runs/at_rest.csv`](../../validation/flume/runs/at_rest.csv).\n";
    Ok(text)
}
