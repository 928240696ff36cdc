//! The flume at 60 degrees against a rigid vertical wall: the limit of the barrier study of Ng et al., predicted.
//!
//! Two readings of the release: the literal one, and the set that the flume at 40 and 23 degrees was calibrated with, untouched.
//! What must hold is judged; the paper's numbers, none of which was used for anything, stand beside ours.

use super::{INCLINATION_DEG, PUBLISHED};
use crate::balances::Balances;
use crate::case_run::{CaseRun, base_friction};
use crate::{Context, Failure, Validation, data};
use checkdam::case::parse;
use checkdam::check::{Check, Expected, Kind};
use checkdam::plot::force_time::{self, ReferenceLine};
use checkdam::plot::{PlotError, flow_snapshots};
use checkdam::theory::sliding_block::acceleration_from_rest;
use checkdam_verification::Outcome;
use checkdam_verification::report::number;
use std::path::Path;

/// The prediction.
pub const VALIDATION: Validation = Validation {
    name: "barrier_rigid",
    title: "The flume at 60 degrees against a rigid vertical wall, predicted with the literal and the calibrated release",
    study: "",
    run,
    draw,
    covers: &[],
};

/// Readings: name, case.
const READINGS: [(&str, &str); 2] =
    [("literal", include_str!("60deg_rigid.toml")), ("calibrated", include_str!("60deg_rigid_calibrated.toml"))];

/// Cases of the paper that a rigid wall stands for.
const RIGID: [&str; 2] = ["any", "concrete"];

fn run(context: &mut Context) -> Result<Outcome, Failure> {
    let mut outcome = Outcome::default();
    let mut flumes = Vec::new();
    for (name, text) in READINGS {
        let case = parse(text, name).map_err(|e| Failure::Record(e.to_string()))?.case;
        let folder = context.folder.join(format!("barrier_rigid_{name}_run"));
        let flume = CaseRun::new(name, &case, Some(&folder), context)?;
        outcome.checks.extend(checks(&flume));
        flumes.push(flume);
    }
    let mut text = String::from("case,quantity,unit,kind,published,uncertainty,literal,calibrated\n");
    for datum in data::rows(PUBLISHED).into_iter().filter(|d| RIGID.contains(&d.case.as_str())) {
        let Some(of) = &datum.ours else { continue };
        let ours: Vec<f64> = flumes.iter().map(|f| of.of(&|q| f.get(q))).collect();
        // What only a barrier that bends has, or a study of many.
        if ours.iter().any(|x| !x.is_finite()) {
            continue;
        }
        let numbers: Vec<String> = [datum.value, datum.uncertainty].iter().chain(&ours).map(|x| number(*x)).collect();
        text += &format!("{},{},{},{},{}\n", datum.case, datum.quantity, datum.unit, datum.kind, numbers.join(","));
    }
    outcome.tables.push(("barrier_rigid_against_paper".into(), text));
    let mut text = String::from("quantity,literal,calibrated\n");
    for quantity in checkdam::study::quantities::QUANTITIES.iter().filter(|q| q.name != "momentum_closure_1") {
        let numbers: Vec<String> = flumes
            .iter()
            .map(|f| f.get(quantity.name))
            .map(|x| if x.is_finite() { number(x) } else { String::new() })
            .collect();
        if numbers.iter().all(String::is_empty) {
            continue;
        }
        text += &format!("{},{}\n", quantity.name, numbers.join(","));
    }
    outcome.tables.push(("barrier_rigid_quantities".into(), text));
    Ok(outcome)
}

/// What must hold whatever the paper says.
fn checks(flume: &CaseRun) -> Vec<Check> {
    let (name, summary) = (flume.name, &flume.summary);
    let mut checks = Balances::of(summary, None).checks(&format!("{name}: "), "balance of the ledger");
    // Side walls, which the balance of the deposit leaves out, hold a part of it, and may brake the front below a block.
    let by_base_alone = summary.case.side_walls.friction == 0.0;
    if let Some(d) = summary.deposit.as_ref().filter(|_| by_base_alone) {
        let share = d.equilibrium_residual_n.abs() / d.weight_along_n;
        checks.push(
            Check::at_most(format!("{name}: |weight + base friction - other walls| / weight"), share, 0.01, "1")
                .because("at rest, with less than 1e-4 of the energy kinetic; means over 0.3 s")
                .from(Kind::Conservation, "equilibrium along the flume"),
        );
    }
    if by_base_alone {
        let a = acceleration_from_rest(
            summary.case.gravity.magnitude_m_per_s2,
            summary.case.gravity.inclination_deg.to_radians(),
            base_friction(&summary.case),
        );
        for f in summary.front.iter().filter(|f| [0.3, 0.5, 0.7].contains(&f.x_m)) {
            checks.push(
                Check::new(
                    format!("{name}: front velocity at {} m", f.x_m),
                    f.velocity_m_per_s,
                    Expected::AtLeast((2.0 * a * f.x_m).sqrt()),
                    "m/s",
                )
                .because("pressure from behind only adds")
                .from(Kind::Analytic, "a block from rest with the base's friction"),
            );
        }
    }
    checks
}

fn draw(folder: &Path) -> Result<Vec<String>, PlotError> {
    let mut names = Vec::new();
    for (name, _) in READINGS {
        let run = folder.join(format!("barrier_rigid_{name}_run"));
        let mut at = |figure: &str| {
            names.push(format!("barrier_rigid_{name}_{figure}.svg"));
            folder.join(format!("barrier_rigid_{name}_{figure}.svg"))
        };
        let lines: [ReferenceLine; 0] = [];
        force_time::draw(run.join("history.csv"), &lines, at("force_time"))?;
        flow_snapshots::draw(run.join("field.csv"), run.join("geometry.csv"), INCLINATION_DEG, at("flow_snapshots"))?;
    }
    Ok(names)
}
