//! What is looked into: four barriers under two releases, and when.

use super::super::records::{CALIBRATED, LITERAL, RIGIDITY};
use super::RECORD_FOLDER;
use crate::Failure;
use checkdam::case::Case;
use checkdam::output::Table;

/// Name and row of the study of the barriers shown: their normalised stiffness as it stands there.
pub const BARRIERS: [(&str, &str); 4] =
    [("plastic", "2.5e-6"), ("fibre glass", "1e-5"), ("steel", "0.0001"), ("concrete", "1")];
/// Of these two, the fields are shown: soft above stiff.
pub(super) const FIELDS: [&str; 2] = ["plastic", "concrete"];

/// When the fields are shown: so long after the arrival, s; and once more at the end of the run.
pub(super) const INSTANTS: [f64; 3] = [0.016, 0.126, 0.526];
/// From the arrival on, so long, the pressure up the flow is read, s.
pub(super) const WAVE_TIME: f64 = 0.056;
/// Every so often, s.
pub(super) const WAVE_STEP: f64 = 0.002;

/// One way in which the sand is released.
pub(super) struct Release {
    /// What it is called, also its folder of the record.
    pub name: &'static str,
    /// Its case in the study of rigidities.
    pub case: &'static str,
    /// What the names of its figures begin with.
    pub figures: &'static str,
    /// Tables of its record: file, text.
    pub record: &'static [(&'static str, &'static str)],
}

macro_rules! record {
    ($release:literal: $($name:literal),* $(,)?) => {
        &[$((concat!($name, ".csv"), include_str!(concat!("tables/", $release, "/", $name, ".csv")))),*]
    };
    ($release:literal) => {
        record!(
            $release: "pressure", "wave", "at_peak", "at_rest", "energy", "slip", "slip_thresholds", "geometry",
            "field_plastic", "field_concrete", "outline_plastic", "outline_concrete", "mechanisms_plastic",
            "mechanisms_concrete",
        )
    };
}

/// Both, the literal one first.
pub(super) const RELEASES: [Release; 2] = [
    Release { name: "literal", case: LITERAL, figures: "barrier_close_up", record: record!("literal") },
    Release {
        name: "calibrated",
        case: CALIBRATED,
        figures: "barrier_close_up_calibrated",
        record: record!("calibrated"),
    },
];

impl Release {
    /// Its tables on record: file, text.
    ///
    /// # Errors
    /// One of them is empty: nothing is on record yet.
    pub fn recorded(&self) -> Result<Vec<(String, String)>, Failure> {
        if let Some((name, _)) = self.record.iter().find(|(_, text)| text.is_empty()) {
            let again = "make the record with `checkdam validate --studies barrier_close_up`";
            return Err(Failure::Record(format!("nothing is on record in {}/{name}: {again}", self.name)));
        }
        Ok(self.record.iter().map(|(name, text)| (name.to_string(), text.to_string())).collect())
    }
}

/// The flow as it meets a barrier, from the record of the study of rigidities.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Arrival {
    /// When, s after release.
    pub time: f64,
    /// Velocity of the front, m/s.
    pub velocity: f64,
    /// Its depth, m.
    pub depth: f64,
}

/// A barrier under a release.
pub(super) struct Look {
    /// The barrier.
    pub barrier: &'static str,
    /// The case of the study, with the gauges that the figures need.
    pub case: Case,
    /// When and how the flow meets the barrier.
    pub arrival: Arrival,
}

/// A barrier (by its stiffness, as the study writes it) under a release.
pub(super) fn look(release: &Release, (barrier, stiffness): (&'static str, &str)) -> Result<Look, Failure> {
    let planned = RIGIDITY.planned(release.case, stiffness)?;
    let run = RIGIDITY.recorded(&planned)?;
    let [time, velocity, depth] =
        ["arrival_s", "barrier_velocity_m_per_s", "barrier_depth_m"].map(|name| run.get(name));
    let mut case = planned.case;
    let arrival = Arrival { time, velocity, depth };
    let frames = (WAVE_TIME / WAVE_STEP).round() as usize;
    let wave = (0..=frames).map(|k| time + k as f64 * WAVE_STEP);
    // A time that is not reached gives the field at the end.
    let mut times: Vec<f64> =
        wave.chain(INSTANTS.map(|t| time + t)).chain([2.0 * case.stages.run.end_time_s]).collect();
    times.sort_by(f64::total_cmp);
    // An instant may be one of the frames of the wave.
    times.dedup_by(|b, a| *b - *a < 0.5 * WAVE_STEP);
    case.gauges.field_times_s = times;
    case.output.vtk_interval_s = 0.02;
    Ok(Look { barrier, case, arrival })
}

/// The arrival at a barrier under a release.
pub(super) fn arrival(release: &Release, barrier: &str) -> Result<Arrival, Failure> {
    let found = BARRIERS.into_iter().find(|b| b.0 == barrier);
    Ok(look(release, found.ok_or_else(|| Failure::Record(format!("there is no barrier of {barrier}")))?)?.arrival)
}

/// A table of a release by its file.
pub(super) fn table(tables: &[(String, String)], name: &str) -> Result<Table, Failure> {
    let text = tables.iter().find(|t| t.0 == name).map_or("", |t| &t.1);
    Ok(Table::parse(text, format!("{RECORD_FOLDER}/{name}"))?)
}

/// Rows of a table of a barrier.
pub(super) fn rows_of(table: &Table, barrier: &str) -> Result<Vec<usize>, Failure> {
    Ok(table.cells("barrier")?.iter().enumerate().filter(|(_, b)| *b == barrier).map(|(k, _)| k).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_releases_are_looked_at_from_their_own_arrival_on() {
        let seen = RELEASES.each_ref().map(|r| look(r, BARRIERS[0]).expect("a barrier"));
        for s in &seen {
            let times = &s.case.gauges.field_times_s;
            assert_eq!(times[0], s.arrival.time);
            assert!(times.windows(2).all(|t| t[1] - t[0] > 0.9 * WAVE_STEP), "{times:?}");
            assert!(s.arrival.velocity > 1.0 && s.arrival.depth > 0.0);
        }
        // The calibrated gate opens slowly.
        assert!(seen[1].arrival.time > seen[0].arrival.time + 0.1);
        assert!(arrival(&RELEASES[0], "glass").is_err());
    }
}
