//! The studies of the barrier and their records.

use crate::case::Case;
use crate::theory::elastic::{Elastic, confined_speed};
use crate::validation::flume::runs::{self, Run};
use crate::validation::record::Record;
use crate::validation::{Context, Failure};

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
/// Three of them on fine cells.
pub const FINE: BarrierStudy = study!("barrier_fine", "fine", &["stiffness_1"]);
/// A rigid wall on two grids, moved and repacked.
pub const RIGID: BarrierStudy = study!("barrier_rigid_wall", "rigid", &["cell_m"]);
/// Explicit and implicit steps.
pub const INTEGRATION: BarrierStudy = study!("barrier_integration", "integration", &["stiffness_1", "integration"]);
/// Barriers of equal rigidity and other mass.
pub const DENSITY: BarrierStudy = study!("barrier_density", "density", &["density_kg_per_m3", "stiffness_1"]);

/// All of them.
pub const ALL: [BarrierStudy; 6] = [RIGIDITY, SCATTER, FINE, RIGID, INTEGRATION, DENSITY];

/// The cases: name and text.
pub const CASES: [(&str, &str); 4] = [
    ("60deg", include_str!("60deg.toml")),
    ("60deg_calibrated", include_str!("60deg_calibrated.toml")),
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
/// the width of the flume (m) and the angle between the flow and the barrier's normal, 60 degrees (Eq. 1 of the paper).
pub fn impact_coefficient(case: &Case, force: f64, velocity: f64, depth: f64) -> f64 {
    let density = case.materials["sand"].density_kg_per_m3;
    force / (density * velocity * velocity * libm::cos(60f64.to_radians()) * depth * case.grid.thickness_m)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_record_is_that_of_its_study() {
        for study in ALL {
            let (_, plan) = study.record.plan().expect("a study");
            let table = crate::output::Table::parse(study.record.runs, study.record.name).expect("a record");
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
    fn coefficient_and_impedance_are_what_they_say() {
        let case = RIGIDITY.first_case().expect("a case");
        // 1500 kg/m3 x 9 m2/s2 x 1/2 x 0.1 m x 0.2 m = 135 N.
        assert!((impact_coefficient(&case, 270.0, 3.0, 0.1) - 2.0).abs() < 1e-12);
        // sqrt(M rho), M = 1.2 Pa at nu = 1/4.
        assert!((impedance(1.0, 0.25, 3.0) - 3.6f64.sqrt()).abs() < 1e-12);
    }
}
