//! The tables of a barrier.

use super::columns;
use super::gauges::{Barrier, suffix};
use super::records::{EnergyRow, HistoryRow, MomentumRow, Recorder, Records, Rows};
use super::table::{Names, OpenTable, flush, optional};
use crate::gauge::StructureSample;
use crate::gauge::structure::ProfilePoint;
use crate::output::OutputError;
use crate::seeded::{self, Seed};
use std::path::Path;

/// The open tables of a barrier, and what was written into them.
pub(super) struct BarrierTables {
    history: OpenTable<HistoryRow>,
    pressure: Option<OpenTable<[f64; 3]>>,
    structure: Option<OpenTable<(f64, StructureSample)>>,
    bending: Option<OpenTable<(f64, ProfilePoint)>>,
    outline: Option<OpenTable<[f64; 3]>>,
    /// What numbers with a name come from.
    pub records: Records,
    /// Where rows go.
    pub rows: Rows,
}

impl BarrierTables {
    /// Those of a barrier with this number; without one there is a history all the same. With an `inflow` the first one has its mass.
    pub fn create(
        directory: &Path,
        number: usize,
        barrier: Option<&Barrier>,
        fields: bool,
        inflow: bool,
    ) -> Result<Self, OutputError> {
        let suffix = barrier.map_or_else(String::new, |b| suffix(b, number));
        let at = |name: &str| directory.join(format!("{name}{suffix}.csv"));
        let kind = if number == 0 { &columns::HISTORY } else { &columns::FURTHER };
        let (any, bends) = (barrier.is_some(), barrier.is_some_and(|b| b.structure().is_some()));
        Ok(Self {
            history: OpenTable::create(kind, &at("history"), Names { inflow, ..Names::default() })?,
            pressure: optional(any, &columns::PRESSURE, &at("pressure_profile"))?,
            structure: optional(bends, &columns::STRUCTURE, &at("barrier"))?,
            bending: optional(bends, &columns::BENDING, &at("barrier_profile"))?,
            outline: optional(bends && fields, &columns::OUTLINE, &at("barrier_outline"))?,
            records: Records::default(),
            rows: Rows::All,
        })
    }

    /// Hands all rows to the files; all of them, also when one fails.
    pub fn flush(&mut self) -> Result<(), OutputError> {
        let results = [self.history.flush(), flush(&mut self.pressure), flush(&mut self.structure)];
        let results = results.into_iter().chain([flush(&mut self.bending), flush(&mut self.outline)]);
        results.collect::<Vec<_>>().into_iter().collect()
    }
}

impl Recorder for BarrierTables {
    fn history(&mut self, row: &HistoryRow) -> Result<(), OutputError> {
        if self.rows.are_kept() {
            self.records.history(row)?;
        }
        if self.rows.are_written() { self.history.row(row) } else { Ok(()) }
    }

    fn energy(&mut self, row: &EnergyRow) -> Result<(), OutputError> {
        self.records.energy(row)
    }

    fn momentum(&mut self, row: &MomentumRow) -> Result<(), OutputError> {
        self.records.momentum(row)
    }

    fn profile(&mut self, time: f64, rows: &[(f64, f64)]) -> Result<(), OutputError> {
        let Some(table) = &mut self.pressure else { return Ok(()) };
        rows.iter().try_for_each(|&(height, pressure)| table.row(&[time, height, pressure]))
    }

    fn structure(&mut self, time: f64, sample: &StructureSample) -> Result<(), OutputError> {
        if self.rows.are_kept() {
            self.records.structure(time, sample)?;
        }
        let table = self.structure.as_mut().filter(|_| self.rows.are_written());
        table.map_or(Ok(()), |table| table.row(&(time, *sample)))
    }

    fn bending(&mut self, time: f64, rows: &[ProfilePoint]) -> Result<(), OutputError> {
        let Some(table) = &mut self.bending else { return Ok(()) };
        rows.iter().try_for_each(|p| table.row(&(time, *p)))
    }

    fn outline(&mut self, time: f64, points: &[[f64; 2]]) -> Result<(), OutputError> {
        let Some(table) = &mut self.outline else { return Ok(()) };
        points
            .iter()
            .map(|x| seeded::exchanged(Seed::TablesOutline, *x))
            .try_for_each(|[x, y]| table.row(&[time, x, y]))
    }
}
