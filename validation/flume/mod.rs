//! The flume of Ng, Wang, Choi, De Silva and Poudyal at 40 and 23 degrees: 30 kg of sand against a rigid barrier.
//!
//! [`VALIDATION`] runs both cases as the command does; [`noise`] repeats them on moved grids to see a shift of a few percent;
//! [`baseline`], [`sensitivity`], [`at_rest`] and [`calibration`] analyse studies of many runs; [`shaken`] shakes what rests;
//! [`step_length`] tries longer and shorter steps; [`verdict`] compares with the paper.

pub mod at_rest;
pub mod baseline;
pub mod calibration;
mod closed;
mod compare;
mod figures;
mod judge;
pub mod noise;
mod pages;
mod physics;
mod rules;
pub mod sensitivity;
pub mod shaken;
pub mod step_length;
pub mod verdict;

use super::case_run::CaseRun;
use super::{Context, Failure, Validation};
use checkdam::boundary::Friction;
use checkdam::case::{Case, parse};
use checkdam::plot::PlotError;
use checkdam::study::quantities::{QUANTITIES, measure};
use checkdam_verification::report::number;
use checkdam_verification::{Fault, Outcome};
use std::path::{Path, PathBuf};

/// Both angles, from their case files.
pub const VALIDATION: Validation = Validation {
    name: "flume",
    title: "The flume at 40 and 23 degrees from its case files: balances, bounds, and the paper's numbers beside ours",
    study: "",
    run,
    draw,
    covers: &[],
};

/// The cases: name, angle and text.
pub(super) const CASES: [(&str, &str); 2] =
    [("40deg", include_str!("40deg.toml")), ("23deg", include_str!("23deg.toml"))];

/// Folder of the whole run of a case.
fn run_folder(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("flume_{name}_run"))
}

/// The text of a case, by the name that studies use.
pub(super) fn read_case(name: &str) -> std::io::Result<String> {
    let found = CASES.iter().find(|c| name.trim_start_matches("../").trim_end_matches(".toml") == c.0);
    found.map(|c| c.1.to_string()).ok_or_else(|| std::io::Error::other(format!("the flume has no case {name}")))
}

/// Puts a fault into a case.
fn make_faulty(case: &mut Case, fault: &Fault) {
    case.gravity.magnitude_m_per_s2 *= fault.gravity;
    for b in &mut case.boundaries {
        if let Some(Friction::Coulomb(friction)) = b.contact_law() {
            b.friction = Some(friction * fault.friction);
        }
    }
    for material in case.materials.values_mut() {
        material.density_kg_per_m3 *= fault.density;
        material.young_pa *= fault.modulus;
        material.friction_angle_deg = material.friction_angle_deg.map(|a| a * fault.friction);
    }
}

fn run(context: &mut Context) -> Result<Outcome, Failure> {
    let mut outcome = Outcome::default();
    let mut flumes = Vec::new();
    for (name, text) in CASES {
        let mut case = parse(text, name).map_err(|e| Failure::Record(e.to_string()))?.case;
        make_faulty(&mut case, &context.fault);
        let folder = run_folder(context.folder, name);
        let flume = CaseRun::new(name, &case, Some(&folder), context)?;
        outcome.checks.extend(physics::checks(&flume));
        outcome.checks.extend(closed::checks(&flume));
        flumes.push(flume);
    }
    outcome.tables.push(("flume_quantities".into(), quantities(&flumes)));
    outcome.tables.push(("flume_against_paper".into(), compare::against_paper(&flumes)));
    for flume in &flumes {
        outcome.tables.extend(figures::tables(flume));
    }
    outcome.tables.extend(pages::tables(&flumes)?);
    Ok(outcome)
}

/// Figures of both cases, and the pages that they stand on.
fn draw(folder: &Path) -> Result<Vec<String>, PlotError> {
    let mut names = figures::draw(folder)?;
    names.extend(pages::write(folder)?);
    Ok(names)
}

/// All quantities of both cases, to nine digits: what changes in them is a change of the code.
fn quantities(flumes: &[CaseRun]) -> String {
    let mut text = String::from("quantity");
    text.extend(flumes.iter().map(|f| format!(",{}", f.name)));
    text.push('\n');
    for (k, q) in QUANTITIES.iter().enumerate() {
        // Round-off differs with the order of sums; its size is judged by the checks.
        let own = flumes.iter().any(|f| measure(&f.summary)[k].is_finite());
        if q.name == "momentum_closure_1" || !own {
            continue;
        }
        text.push_str(q.name);
        text.extend(flumes.iter().map(|f| format!(",{}", number(measure(&f.summary)[k]))));
        text.push('\n');
    }
    text
}
