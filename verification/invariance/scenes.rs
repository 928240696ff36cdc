//! The two scenes, from the case files of the validation: coarser, and cut short a little after the impact.

use checkdam::case::{self, Case};

/// A scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scene {
    /// The flume at 40 degrees with a rigid barrier.
    Flume,
    /// The flume at 60 degrees with an elastic barrier.
    Barrier,
}

const FLUME: &str = include_str!("../../validation/flume/40deg.toml");
const BARRIER: &str = include_str!("../../validation/barrier/60deg.toml");

impl Scene {
    /// Both.
    pub const ALL: [Scene; 2] = [Scene::Flume, Scene::Barrier];

    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Scene::Flume => "flume",
            Scene::Barrier => "elastic barrier",
        }
    }

    /// The text of its case file.
    pub fn text(self) -> &'static str {
        match self {
            Scene::Flume => FLUME,
            Scene::Barrier => BARRIER,
        }
    }

    /// The scene of a text.
    pub fn read(self, text: &str) -> Case {
        let spacing = match self {
            Scene::Flume => "spacing_m = 0.05 ",
            Scene::Barrier => "spacing_m = 0.04 ",
        };
        let mut text = text.to_owned();
        for (from, to) in [
            ("spacing_m = 0.01 ", spacing),
            ("particles_per_cell = 9 ", "particles_per_cell = 4 "),
            // Contact of a mesh is found in sweeps that end at a share of the velocities: round-off decides how many there are.
            ("kinematics = \"total_lagrangian\"", "kinematics = \"updated_lagrangian\""),
        ] {
            text = text.replacen(from, to, 1);
        }
        let mut case = case::parse(&text, self.name()).unwrap_or_else(|e| panic!("{e}")).case;
        // The defaults: lengths and forces that belong to the flow.
        (case.gauges.front_length_m, case.gauges.arrival_force_n) = (None, None);
        case.gauges.field_times_s.clear();
        case.output.vtk_interval_s = 0.0;
        case.gauges.stations_m = vec![0.3, 0.7];
        if let Some(settle) = &mut case.stages.settle {
            settle.residual = 1e-2;
        }
        if let Some(tilt) = &mut case.stages.tilt {
            tilt.duration_s = 0.05;
        }
        // A crest half a cell between two nodes is a place where the scheme is discontinuous, which `crest` shows.
        case.boundaries.iter_mut().filter(|b| b.name == "gate").for_each(|b| b.height_m = Some(0.6));
        case.stages.run.end_time_s = match self {
            Scene::Flume => 0.62,
            Scene::Barrier => 0.50,
        };
        case.stages.run.stop_at_rest = false;
        case
    }

    /// The scene as it stands in the file.
    pub fn case(self) -> Case {
        self.read(self.text())
    }
}
