//! Four of the barriers looked into, under the literal and the calibrated release (Figs. 5 and 7 to 14 of the paper). It shows pressure
//! through time, the wave that runs up the flow, and how the barrier moves and bends. It shows stress and shear in the sand, what rests on
//! the wall at the end, and where the energy is. Where energy is dissipated relative to the slip surface is in [`slip`].
//!
//! When to look follows from the arrival of the flow, as it is on record in the study of rigidities, so that it is the same for both
//! releases. The runs take some minutes; what the figures need of them is on record in `tables`, a folder a release.

mod collect;
mod earth_pressure;
mod figures;
mod lines;
mod numbers;
mod record;
mod releases;
mod seen;
pub mod slip;
mod wave;

pub use numbers::{Numbers, numbers};
pub use releases::BARRIERS;

use crate::balances::{self, largest};
use crate::{Context, Failure, Validation};
use checkdam::check::{Check, Kind};
use checkdam::output::{OutputError, Table, write_text};
use checkdam_verification::Outcome;
use releases::{RELEASES, Release, rows_of, table};
use std::path::{Path, PathBuf};

/// The figures.
pub const VALIDATION: Validation = Validation {
    name: "barrier_close_up",
    title: "Four barriers looked into: pressure, wave, velocity, deflection, stress, shear, energy, slip surface",
    study: "8 runs, about 10 minutes",
    run,
    draw: figures::draw,
    covers: &[],
};

/// Folder of the record.
const RECORD_FOLDER: &str = "barrier_close_up";

/// Where the tables of a release are that are on record, or to be put there.
fn record_folder(folder: &Path, release: &Release) -> PathBuf {
    folder.join(RECORD_FOLDER).join(release.name)
}

/// Where the tables of a release are that follow from those on record.
fn derived_folder(folder: &Path, release: &Release) -> PathBuf {
    folder.join(RECORD_FOLDER).join(format!("{}_shown", release.name))
}

fn run(context: &mut Context) -> Result<Outcome, Failure> {
    let all = tables(context)?;
    let mut outcome = Outcome::default();
    let mut celerities = wave::CELERITIES.to_string();
    let (mut slip, mut thresholds) = (slip::shares::header(), slip::shares::BY_THRESHOLD.to_string());
    for (release, tables) in RELEASES.iter().zip(&all) {
        let [record, derived] = [record_folder, derived_folder].map(|of| of(context.folder, release));
        for folder in [&record, &derived] {
            let fail = |source| OutputError::Create { path: folder.clone(), source };
            std::fs::create_dir_all(folder).map_err(fail)?;
        }
        for (name, text) in tables {
            write_text(record.join(name), text)?;
        }
        let (waves, places) = (table(tables, "wave.csv")?, table(tables, "slip.csv")?);
        outcome.checks.extend(checks(release, &table(tables, "energy.csv")?)?);
        celerities += &wave::celerities(release.name, &waves)?;
        let (text, checks) = slip::shares::table(release, &places)?;
        slip += &text;
        outcome.checks.extend(checks);
        thresholds += &slip::shares::thresholds(release, &table(tables, "slip_thresholds.csv")?)?;
        write_text(derived.join("wave_shown.csv"), &wave::shown(release, &waves)?)?;
        write_text(derived.join("at_rest_lines.csv"), &earth_pressure::with_theory(&table(tables, "at_rest.csv")?)?)?;
        write_text(derived.join("slip_shares.csv"), &slip::shares::paths(release, &places)?)?;
    }
    outcome.tables.push(("barrier_close_up_celerity".into(), celerities));
    outcome.tables.push(("barrier_close_up_slip_shares".into(), slip));
    outcome.tables.push(("barrier_close_up_slip_thresholds".into(), thresholds));
    Ok(outcome)
}

/// The tables of each release: recorded, or made anew if studies are asked for.
fn tables(context: &mut Context) -> Result<Vec<record::Tables>, Failure> {
    if context.studies { record::make(context) } else { RELEASES.iter().map(Release::recorded).collect() }
}

/// The energies of every barrier add up.
fn checks(release: &Release, energy: &Table) -> Result<Vec<Check>, Failure> {
    let residual = energy.column("residual_1")?;
    let one = |barrier: &str| {
        let worst = largest(rows_of(energy, barrier)?.into_iter().map(|k| residual[k]));
        let check = balances::energy(&format!("{}, {barrier}: ", release.name), worst);
        Ok(check.from(Kind::Conservation, "the ledger of the run"))
    };
    BARRIERS.iter().map(|(barrier, _)| one(barrier)).collect()
}
