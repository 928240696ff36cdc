//! What is recorded during a run.
//!
//! Elsewhere: history output, an observer.

use crate::gauge::structure::ProfilePoint;
use crate::gauge::{BaseSample, FieldCell, Front, Passage, StationSample, StructureSample, WindowSample};
use crate::ledger::{EnergyBalance, Ledger, Stock};
use crate::output::OutputError;
use crate::simulation::{ContactPoint, Simulation};

/// One sample of the gauges; means over the sampling interval where a force is meant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HistoryRow {
    /// End of the interval, s after release.
    pub time: f64,
    /// Normal force on the barrier (its base shear), N.
    pub normal: f64,
    /// Force along the barrier's face, towards the crest, N.
    pub tangential: f64,
    /// Overturning moment about the barrier's foot, N m.
    pub moment: f64,
    /// Largest normal force of a single step, N.
    pub normal_max: f64,
    /// Normal force from the stress of the nearest 1, 2, 3 layers of material points, N.
    pub layers: [f64; 3],
    /// Force of the base on the material.
    pub base: BaseSample,
    /// The front.
    pub front: Front,
    /// Highest material at the barrier, m above its foot.
    pub run_up: f64,
    /// 95th percentile of the heights of the points at the barrier, m above its foot; zero if they are fewer than twenty.
    pub run_up_p95: f64,
    /// What has passed the barrier since the release.
    pub passage: Passage,
    /// Speeds in the window.
    pub window: WindowSample,
    /// Kinetic energy, J.
    pub kinetic: f64,
    /// Deepest point inside a boundary, m.
    pub penetration: f64,
    /// Time step, s.
    pub time_step: f64,
    /// Mass that has entered with inflows, kg.
    pub entered: f64,
}

/// Momentum by agent at one moment, N s.
#[derive(Debug, Clone, PartialEq)]
pub struct MomentumRow {
    /// s after release.
    pub time: f64,
    /// Momentum of the material less what it had at release.
    pub gained: [f64; 2],
    /// The ledger.
    pub ledger: Ledger,
    /// `gained` less all impulses.
    pub residual: [f64; 2],
}

impl MomentumRow {
    /// Compares the stock with the ledger.
    pub fn new(time: f64, ledger: &Ledger, opening: &Stock, now: &Stock) -> Self {
        let given = ledger.impulse();
        let gained = [now.momentum[0] - opening.momentum[0], now.momentum[1] - opening.momentum[1]];
        let residual = [gained[0] - given[0], gained[1] - given[1]];
        Self { time, gained, ledger: ledger.clone(), residual }
    }

    /// Residual over the sum of the magnitudes of all impulses.
    pub fn closure(&self) -> f64 {
        self.residual[0].hypot(self.residual[1]) / self.ledger.impulse_scale.max(f64::MIN_POSITIVE)
    }
}

/// Energy by mechanism at one moment.
#[derive(Debug, Clone, PartialEq)]
pub struct EnergyRow {
    /// s after release.
    pub time: f64,
    /// The balance, J.
    pub balance: EnergyBalance,
}

/// Where the rows go that follow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Rows {
    /// Into tables, and numbers with a name come from them.
    #[default]
    All,
    /// Numbers with a name come from them; they are in no table.
    Kept,
    /// Into tables alone.
    Written,
}

impl Rows {
    /// Whether numbers with a name come from them.
    pub fn are_kept(self) -> bool {
        self != Rows::Written
    }

    /// Whether they stand in tables.
    pub fn are_written(self) -> bool {
        self != Rows::Kept
    }
}

/// Receives what is recorded.
pub trait Recorder {
    /// Whether it has tables, whose rows then come at `gauges.sample_rate_hz`; else all rows are those that numbers with a name come from.
    fn has_tables(&self) -> bool {
        false
    }
    /// Says where the rows go that follow: a recorder with tables hears of it when both kinds of rows are not the same.
    fn turn(&mut self, _rows: Rows) {}
    /// The velocity field of material that did not settle.
    fn unsettled(&mut self, _time: f64, _cells: &[FieldCell]) -> Result<(), OutputError> {
        Ok(())
    }
    /// A sample of the gauges.
    fn history(&mut self, row: &HistoryRow) -> Result<(), OutputError>;
    /// The energy ledger.
    fn energy(&mut self, row: &EnergyRow) -> Result<(), OutputError>;
    /// The momentum ledger.
    fn momentum(&mut self, row: &MomentumRow) -> Result<(), OutputError>;
    /// Depth and velocity at a station.
    fn station(&mut self, _time: f64, _sample: &StationSample) -> Result<(), OutputError> {
        Ok(())
    }
    /// Mean pressure on the barrier since the last call: (height, pressure).
    fn profile(&mut self, _time: f64, _rows: &[(f64, f64)]) -> Result<(), OutputError> {
        Ok(())
    }
    /// A sample of a barrier that is a body.
    fn structure(&mut self, _time: f64, _sample: &StructureSample) -> Result<(), OutputError> {
        Ok(())
    }
    /// How such a barrier is bent.
    fn bending(&mut self, _time: f64, _rows: &[ProfilePoint]) -> Result<(), OutputError> {
        Ok(())
    }
    /// Its surface at a snapshot: points in order, m.
    fn outline(&mut self, _time: f64, _points: &[[f64; 2]]) -> Result<(), OutputError> {
        Ok(())
    }
    /// Where bodies touch at a snapshot, in the last step, of `dt` s.
    fn contact(&mut self, _time: f64, _dt: f64, _points: &[ContactPoint]) -> Result<(), OutputError> {
        Ok(())
    }
    /// Velocity field at a snapshot.
    fn field(&mut self, _time: f64, _cells: &[FieldCell]) -> Result<(), OutputError> {
        Ok(())
    }
    /// Who records what is read at a barrier that is not the first, by its number without that: histories of forces alone, profiles,
    /// structure, bending, outline.
    fn further(&mut self, _barrier: usize) -> Option<&mut dyn Recorder> {
        None
    }
    /// A sample of a base that is not the first, by its number without that: its time and its forces, and nothing else.
    fn further_base(&mut self, _base: usize, _row: &HistoryRow) -> Result<(), OutputError> {
        Ok(())
    }
    /// A sample of a window with a name, by its number: its time and its speeds, and nothing else.
    fn window(&mut self, _window: usize, _row: &HistoryRow) -> Result<(), OutputError> {
        Ok(())
    }
    /// Called after every step after release.
    fn step(&mut self, _simulation: &Simulation) -> Result<(), OutputError> {
        Ok(())
    }
    /// A frame of all material points.
    fn frame(&mut self, _simulation: &Simulation) -> Result<(), OutputError> {
        Ok(())
    }
}

/// Keeps the time series in memory.
#[derive(Debug, Clone, Default)]
pub struct Records {
    /// Samples of the gauges.
    pub history: Vec<HistoryRow>,
    /// Energy ledger.
    pub energy: Vec<EnergyRow>,
    /// Momentum ledger.
    pub momentum: Vec<MomentumRow>,
    /// Samples of a barrier that is a body, with their times (s).
    pub structure: Vec<(f64, StructureSample)>,
    /// History and structure of the barriers but the first.
    pub further: Vec<Records>,
    /// Samples of the bases but the first.
    pub further_bases: Vec<Vec<HistoryRow>>,
    /// Samples of the windows with names.
    pub windows: Vec<Vec<HistoryRow>>,
}

impl Recorder for Records {
    fn history(&mut self, row: &HistoryRow) -> Result<(), OutputError> {
        self.history.push(*row);
        Ok(())
    }

    fn energy(&mut self, row: &EnergyRow) -> Result<(), OutputError> {
        self.energy.push(row.clone());
        Ok(())
    }

    fn momentum(&mut self, row: &MomentumRow) -> Result<(), OutputError> {
        self.momentum.push(row.clone());
        Ok(())
    }

    fn structure(&mut self, time: f64, sample: &StructureSample) -> Result<(), OutputError> {
        self.structure.push((time, *sample));
        Ok(())
    }

    fn further(&mut self, barrier: usize) -> Option<&mut dyn Recorder> {
        let records: &mut Records = of_number(&mut self.further, barrier);
        Some(records)
    }

    fn further_base(&mut self, base: usize, row: &HistoryRow) -> Result<(), OutputError> {
        of_number(&mut self.further_bases, base).push(*row);
        Ok(())
    }

    fn window(&mut self, window: usize, row: &HistoryRow) -> Result<(), OutputError> {
        of_number(&mut self.windows, window).push(*row);
        Ok(())
    }
}

/// The one with this number; the list grows until it has it.
fn of_number<T: Default>(list: &mut Vec<T>, number: usize) -> &mut T {
    if list.len() <= number {
        list.resize_with(number + 1, T::default);
    }
    &mut list[number]
}
