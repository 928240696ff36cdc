//! The studies of the barrier and their records.

use crate::record::Record;
use crate::runs::{self, Run};
use crate::scatter::Scatter;
use crate::{Context, Failure};
use checkdam::case::{Body, Case};
use checkdam::output::Table;
use checkdam::run::scene;
use checkdam::study::PlannedRun;
use checkdam::theory::elastic::{Elastic, confined_speed};

/// A study, and the columns of what it varies.
#[derive(Debug, Clone, Copy)]
pub struct BarrierStudy {
    /// Study and record.
    pub record: Record,
    /// What it varies.
    pub columns: &'static [&'static str],
}

macro_rules! study {
    ($name:literal, $file:literal, $columns:expr) => {
        BarrierStudy {
            record: Record {
                name: $name,
                study: include_str!(concat!("studies/", $file, ".toml")),
                read: read_case,
                runs: include_str!(concat!("runs/", $file, ".csv")),
            },
            columns: $columns,
        }
    };
}

/// Twelve rigidities, both releases.
pub const RIGIDITY: BarrierStudy = study!("barrier_rigidity", "rigidity", &["stiffness_1"]);
/// The same on two grids, moved and repacked, as far as the impact.
pub const SCATTER: BarrierStudy = study!("barrier_scatter", "scatter", &["cell_m", "stiffness_1"]);
/// Barriers of points on two grids, moved and repacked, with boundaries at nodes.
pub const GRIDS: BarrierStudy = study!("barrier_grids", "grids", &["cell_m", "stiffness_1"]);
/// Three of them on fine cells.
pub const FINE: BarrierStudy = study!("barrier_fine", "fine", &["stiffness_1"]);
/// A rigid wall on two grids, moved and repacked.
pub const RIGID: BarrierStudy = study!("barrier_rigid_wall", "rigid", &["cell_m"]);
/// Explicit and implicit steps, long ones and short ones.
pub const INTEGRATION: BarrierStudy =
    study!("barrier_integration", "integration", &["stiffness_1", "integration", "longest_step_s"]);
/// The stiffest of them in steps that are shorter still.
pub const SHORT_STEPS: BarrierStudy =
    study!("barrier_short_steps", "short_steps", &["stiffness_1", "integration", "longest_step_s"]);
/// Barriers of equal rigidity and other mass.
pub const DENSITY: BarrierStudy = study!("barrier_density", "density", &["density_kg_per_m3", "stiffness_1"]);
/// Barriers with and without their own weight.
pub const WEIGHT: BarrierStudy = study!("barrier_weight", "weight", &["weightless", "stiffness_1"]);
/// Barriers of points and of meshes.
pub const KINEMATICS: BarrierStudy = study!("barrier_kinematics", "kinematics", &["stiffness_1", "kinematics"]);
/// The calibrated release, moved and repacked.
pub const SCATTER_CALIBRATED: BarrierStudy =
    study!("barrier_scatter_calibrated", "scatter_calibrated", &["cell_m", "stiffness_1"]);

/// The literal release: name of its case.
pub const LITERAL: &str = "60deg";
/// The calibrated one.
pub const CALIBRATED: &str = "60deg_calibrated";
/// Cell size of the study of rigidities, m, as studies of several sizes write it.
pub const STUDY_CELL: &str = "0.01";

/// All of them.
pub const ALL: [BarrierStudy; 11] =
    [RIGIDITY, SCATTER, SCATTER_CALIBRATED, GRIDS, FINE, RIGID, INTEGRATION, SHORT_STEPS, DENSITY, WEIGHT, KINEMATICS];

/// The cases: name and text.
pub const CASES: [(&str, &str); 4] = [
    (LITERAL, include_str!("60deg.toml")),
    (CALIBRATED, include_str!("60deg_calibrated.toml")),
    ("60deg_rigid", include_str!("60deg_rigid.toml")),
    ("60deg_rigid_calibrated", include_str!("60deg_rigid_calibrated.toml")),
];

/// The text of a case, by the name that studies use.
///
/// # Errors
/// There is no such case.
pub fn read_case(name: &str) -> std::io::Result<String> {
    let found = CASES.iter().find(|c| name.trim_start_matches("../").trim_end_matches(".toml") == c.0);
    found.map(|c| c.1.to_string()).ok_or_else(|| std::io::Error::other(format!("the barrier has no case {name}")))
}

impl BarrierStudy {
    /// Its rows.
    ///
    /// # Errors
    /// The record is not as it should be, or the study is stopped.
    pub fn rows(&self, context: &mut Context) -> Result<Vec<Run>, Failure> {
        Ok(runs::rows(&self.record.table(context)?, self.columns)?)
    }

    /// Its rows with the normalised stiffness of each; rows of rigid walls have none.
    ///
    /// # Errors
    /// As [`Self::rows`].
    pub fn by_stiffness(&self, context: &mut Context) -> Result<Vec<(f64, Run)>, Failure> {
        let stiffness = |run: &Run| run.set.get("stiffness_1").and_then(|n| n.parse().ok());
        Ok(self.rows(context)?.into_iter().map(|run| (stiffness(&run).unwrap_or(f64::NAN), run)).collect())
    }

    /// The planned run of a case (by name) against the barrier of a stiffness (as the study writes it).
    ///
    /// # Errors
    /// There is none.
    pub fn planned(&self, case: &str, stiffness: &str) -> Result<PlannedRun, Failure> {
        let column = self.columns.iter().position(|c| *c == "stiffness_1").unwrap_or(0);
        let own = self.record.plan()?.1.into_iter().find(|r| r.case_name == case && r.values[column] == stiffness);
        own.ok_or_else(|| Failure::Record(format!("{} has no barrier of {stiffness} in {case}", self.record.name)))
    }

    /// What is on record of a planned run, whatever the context asks for.
    ///
    /// # Errors
    /// It is not on record.
    pub fn recorded(&self, planned: &PlannedRun) -> Result<Run, Failure> {
        let table = Table::parse(self.record.runs, self.record.name)?;
        let place = table.cells("key")?.iter().position(|key| *key == planned.key);
        let missing = || Failure::Record(format!("{}: {} is not on record", self.record.name, planned.what));
        Ok(runs::rows(&table, self.columns)?.swap_remove(place.ok_or_else(missing)?))
    }

    /// The case of its first run, for what all runs have in common.
    ///
    /// # Errors
    /// The study or a case is not as it should be.
    pub fn first_case(&self) -> Result<Case, Failure> {
        Ok(self.record.plan()?.1.swap_remove(0).case)
    }
}

/// A material as the barrier studies need it: P-wave impedance, Pa s/m.
pub fn impedance(young: f64, poisson: f64, density: f64) -> f64 {
    density * confined_speed(&Elastic { young, poisson }, density)
}

/// Impact coefficient: force over rho v^2 cos(theta) h w, with the flow's density (kg/m3), the front's velocity (m/s) and depth (m),
/// the width of the flume (m) and the angle between the flow and the barrier's normal (Eq. 1 of the paper).
pub fn impact_coefficient(case: &Case, force: f64, velocity: f64, depth: f64) -> f64 {
    let density = case.materials["sand"].density_kg_per_m3;
    let across = libm::cos(barrier(case).map_or(f64::NAN, |b| b.rotation_deg).to_radians());
    force / (density * velocity * velocity * across * depth * case.grid.thickness_m)
}

/// The barrier of a case.
pub fn barrier(case: &Case) -> Option<&Body> {
    case.bodies.iter().find(|b| b.name == "barrier")
}

/// Height of the barrier's face above its clamp, m; without the round-off of turning it.
pub fn height(case: &Case) -> f64 {
    scene::barrier_face(case, "barrier").map_or(f64::NAN, |face| (1e9 * face.height()).round() / 1e9)
}

/// Young's modulus of a barrier of the normalised stiffness 1, Pa, for the height and thickness of the case.
pub fn young_of_one(case: &Case) -> f64 {
    let depth = barrier(case).map_or(f64::NAN, |b| b.size_m()[0]);
    checkdam::theory::barrier::young_for(1.0, height(case), depth, case.grid.thickness_m)
}

/// Largest force over 20 ms of these runs on the cells of the study.
pub fn peaks<'a>(runs: impl IntoIterator<Item = &'a Run>) -> Scatter {
    on_study_cells(runs, "peak_20ms_n")
}

/// Mean and scatter of a quantity over those of the runs that have the cells of the study.
pub fn on_study_cells<'a>(runs: impl IntoIterator<Item = &'a Run>, quantity: &str) -> Scatter {
    on_cells(runs, STUDY_CELL, quantity)
}

/// Mean and scatter of a quantity over those of the runs that have cells of this size, m, as the study writes it.
pub fn on_cells<'a>(runs: impl IntoIterator<Item = &'a Run>, cell: &str, quantity: &str) -> Scatter {
    Scatter::of(runs.into_iter().filter(|r| r.set["cell_m"] == cell).map(|r| r.get(quantity)))
}

/// Largest force over 20 ms on a rigid wall, N: of the literal and the calibrated release.
///
/// # Errors
/// The record is not as it should be, or the study is stopped.
pub fn on_rigid_wall(context: &mut Context) -> Result<[Scatter; 2], Failure> {
    let walls = RIGID.rows(context)?;
    Ok(["60deg_rigid", "60deg_rigid_calibrated"].map(|case| peaks(walls.iter().filter(|r| r.case == case))))
}

#[cfg(test)]
mod tests {
    use super::super::{PUBLISHED, data};
    use super::*;

    #[test]
    fn every_record_is_that_of_its_study() {
        for study in ALL {
            let (_, plan) = study.record.plan().expect("a study");
            let table = checkdam::output::Table::parse(study.record.runs, study.record.name).expect("a record");
            let keys = table.cells("key").expect("keys");
            assert!(keys.iter().eq(plan.iter().map(|r| &r.key)), "{}", study.record.name);
            assert!(
                table.cells("ended").expect("ends").iter().all(|e| !e.starts_with("failed")),
                "{}",
                study.record.name
            );
        }
    }

    #[test]
    fn what_is_said_of_all_cases_is_true_of_all() {
        for (name, _) in CASES {
            let text = read_case(name).expect("a case");
            let case = checkdam::case::parse(&text, name).expect("a case").case;
            assert_eq!(case.gravity.inclination_deg, super::super::INCLINATION_DEG, "{name}");
            assert_eq!(case.grid.spacing_m.to_string(), STUDY_CELL, "{name}");
            if barrier(&case).is_some() {
                assert!((height(&case) - data::row(PUBLISHED, "B44").value).abs() < 1e-12, "{name}");
            }
        }
    }

    #[test]
    fn coefficient_and_impedance_are_what_they_say() {
        let case = RIGIDITY.first_case().expect("a case");
        // 1500 kg/m3 x 9 m2/s2 x 1/2 x 0.1 m x 0.2 m = 135 N.
        assert!((impact_coefficient(&case, 270.0, 3.0, 0.1) - 2.0).abs() < 1e-12);
        // sqrt(M rho), M = 1.2 Pa at nu = 1/4.
        assert!((impedance(1.0, 0.25, 3.0) - 3.6f64.sqrt()).abs() < 1e-12);
    }
}
