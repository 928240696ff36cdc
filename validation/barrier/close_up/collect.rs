//! Keeps what the figures need of a run.

use super::slip;
use checkdam::gauge::{FieldCell, StructureSample};
use checkdam::output::OutputError;
use checkdam::run::records::{EnergyRow, HistoryRow, MomentumRow, Recorder};
use checkdam::simulation::Simulation;

/// Makes the observer of the slip surface at the release.
type Start = dyn FnOnce(&Simulation) -> slip::Observer + Send;

/// What is kept, with times in s after release.
#[derive(Default)]
pub(super) struct Collector {
    /// Samples of the gauges.
    pub history: Vec<HistoryRow>,
    /// Mean pressure on the barrier by height since the entry before.
    pub profiles: Vec<(f64, Vec<(f64, f64)>)>,
    /// Cells of sand.
    pub fields: Vec<(f64, Vec<FieldCell>)>,
    /// Outline of the barrier, parallel to the fields.
    pub outlines: Vec<(f64, Vec<[f64; 2]>)>,
    /// Set up at the release.
    pub slip: Option<slip::Observer>,
    start: Option<Box<Start>>,
}

impl Collector {
    /// Nothing yet; the observer of the slip surface is made at the release.
    pub fn new(start: impl FnOnce(&Simulation) -> slip::Observer + Send + 'static) -> Self {
        Self { start: Some(Box::new(start)), ..Self::default() }
    }
}

impl Recorder for Collector {
    fn history(&mut self, row: &HistoryRow) -> Result<(), OutputError> {
        self.history.push(*row);
        Ok(())
    }

    fn energy(&mut self, _: &EnergyRow) -> Result<(), OutputError> {
        Ok(())
    }

    fn momentum(&mut self, _: &MomentumRow) -> Result<(), OutputError> {
        Ok(())
    }

    fn structure(&mut self, _: f64, _: &StructureSample) -> Result<(), OutputError> {
        Ok(())
    }

    fn profile(&mut self, time: f64, rows: &[(f64, f64)]) -> Result<(), OutputError> {
        self.profiles.push((time, rows.to_vec()));
        Ok(())
    }

    fn outline(&mut self, time: f64, points: &[[f64; 2]]) -> Result<(), OutputError> {
        self.outlines.push((time, points.to_vec()));
        Ok(())
    }

    fn field(&mut self, time: f64, cells: &[FieldCell]) -> Result<(), OutputError> {
        self.fields.push((time, cells.to_vec()));
        Ok(())
    }

    fn frame(&mut self, simulation: &Simulation) -> Result<(), OutputError> {
        // The first frame is that of the release.
        if let Some(start) = self.start.take() {
            self.slip = Some(start(simulation));
        }
        Ok(())
    }

    fn step(&mut self, simulation: &Simulation) -> Result<(), OutputError> {
        if let Some(slip) = &mut self.slip {
            slip.step(simulation);
        }
        Ok(())
    }
}
