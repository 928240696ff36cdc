//! The output folder of a run.
//!
//! Tables grow while the run goes on; VTK frames and the collection that lists them appear by rename. Whatever ends the run,
//! what was computed until then is there and readable, and `summary.toml` says how it ended. Nothing in the folder depends
//! on the wall clock, the number of threads or the place of the folder: the same case gives the same bytes.

use super::ProgressFn;
use super::barrier_tables::BarrierTables;
use super::claim::SUMMARY;
pub use super::claim::{Claim, prepare_directory};
use super::columns;
use super::experiment::Experiment;
use super::figures::draw_figures;
use super::gauges::{PeakProfile, suffix};
pub use super::outlines::outlines;
use super::outlines::{write_geometry_table, write_geometry_vtk};
use super::records::{EnergyRow, HistoryRow, MomentumRow, Recorder, Records, Rows};
use super::stage::RunError;
use super::summary::Summary;
use super::table::{Names, OpenTable, flush, optional};
use crate::case::{Case, file_name};
use crate::gauge::structure::ProfilePoint;
use crate::gauge::{FieldCell, StationSample, StructureSample};
use crate::output::{self, Field, Lock, OutputError, PvdWriter, Values};
use crate::seeded::{self, Seed};
use crate::simulation::{ContactPoint, Simulation};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Runs a case into an empty folder; returns what was recorded.
///
/// # Errors
/// What stopped the run; the folder then holds what was computed.
pub fn run_into(
    case: &Case,
    directory: &Path,
    progress: &mut ProgressFn,
) -> Result<(Experiment, Records, Summary), RunError> {
    run_claimed(case, Claim::of(directory)?, progress)
}

/// Runs a case into a folder that this process has claimed; what an earlier run left there is replaced.
///
/// # Errors
/// What stopped the run; the folder then holds what was computed.
pub fn run_claimed(
    case: &Case,
    claim: Claim,
    progress: &mut ProgressFn,
) -> Result<(Experiment, Records, Summary), RunError> {
    let directory = claim.directory();
    let mut experiment = Experiment::new(case);
    // From here on a reader is told that nothing is at its end, whatever becomes of this process.
    output::write_text(directory.join(SUMMARY), &Summary::running(case))?;
    claim.clear()?;
    let mut folder = Folder::create(directory, &experiment, claim.lock())?;
    let end = experiment.run(&mut folder, progress);
    let closed = folder.close().map_err(RunError::from);
    let end = end.and_then(|end| closed.map(|()| end));
    let records = folder.into_records();
    // A folder that was deleted may have been made anew by another run.
    if let Err(gone) = claim.lock().check() {
        return Err(end.err().unwrap_or_else(|| gone.into()));
    }
    let summary = match &end {
        Ok(end) => Summary::new(case, &experiment, &records, *end),
        Err(error) => Summary::failed(case, &experiment, &records, &error.to_string()),
    };
    let mut barriers = experiment.barriers().iter().enumerate();
    let mut peaks = || barriers.try_for_each(|(k, b)| write_peak_profile(directory, &suffix(b, k), b.peak_profile()));
    let written = output::write_text(directory.join(SUMMARY), &summary.to_toml()).and_then(|()| peaks());
    let drawn = draw_figures(case, directory, &experiment, &summary);
    // The first thing that went wrong is reported: what follows from it would only hide it.
    end?;
    written?;
    drawn?;
    Ok((experiment, records, summary))
}

/// How a barrier that is a body was bent at its largest force.
fn write_peak_profile(directory: &Path, suffix: &str, peak: &PeakProfile) -> Result<(), OutputError> {
    if peak.points.is_empty() {
        return Ok(());
    }
    let path = directory.join(format!("barrier_profile_at_peak{suffix}.csv"));
    let mut table = OpenTable::create(&columns::BENDING_AT_PEAK, &path, Names::default())?;
    peak.points.iter().try_for_each(|p| table.row(&(peak.time, *p)))?;
    table.finish()
}

/// The open tables of a run.
struct Folder {
    directory: PathBuf,
    lock: Arc<Lock>,
    /// History, and what is read at the first barrier.
    first: BarrierTables,
    /// What is read at the other barriers.
    further: Vec<BarrierTables>,
    energy: OpenTable<EnergyRow>,
    momentum: OpenTable<MomentumRow>,
    /// What is read at the bases but the first.
    bases: Vec<OpenTable<HistoryRow>>,
    /// What is read in the windows with names.
    windows: Vec<OpenTable<HistoryRow>>,
    stations: Option<OpenTable<(f64, StationSample)>>,
    field: Option<OpenTable<(f64, FieldCell)>>,
    contact: Option<OpenTable<columns::Touching>>,
    frames: Option<PvdWriter>,
    frame_count: usize,
}

impl Folder {
    fn create(directory: &Path, experiment: &Experiment, lock: &Arc<Lock>) -> Result<Self, OutputError> {
        let sim = experiment.simulation();
        let gauges = experiment.gauges();
        let boundaries: Vec<String> = sim.boundaries().iter().map(|b| file_name(&b.name)).collect();
        let body = |k: usize| file_name(&sim.bodies()[k].name);
        let pairs = sim.contacts().map(|c| format!("{}_on_{}", body(c.bodies[0]), body(c.bodies[1])));
        let surfaces = boundaries.iter().cloned().chain(pairs).collect();
        let inflow = sim.inflows().next().is_some();
        let names = Names { boundaries, surfaces, inflow };
        let at = |name: &str| directory.join(name);
        let frames = if experiment.vtk_interval() > 0.0 {
            let frames = at("vtk");
            fs::create_dir_all(&frames).map_err(|source| OutputError::Create { path: frames, source })?;
            write_geometry_vtk(directory, sim)?;
            Some(PvdWriter::create(at("flow.pvd"))?)
        } else {
            None
        };
        write_geometry_table(directory, sim)?;
        let fields = !gauges.field_times_s.is_empty();
        let barriers = experiment.barriers();
        let further = barriers.iter().enumerate().skip(1);
        let named = |kind, what: &str, name: &str| {
            OpenTable::create(kind, &at(&format!("{what}_{}.csv", file_name(name))), Names::default())
        };
        let bases = experiment.bases().iter().skip(1).map(|b| named(&columns::FURTHER_BASE, "base", &b.name));
        let windows = experiment.windows().iter().map(|w| named(&columns::WINDOW, "window", &w.name));
        Ok(Self {
            directory: directory.to_path_buf(),
            lock: lock.clone(),
            first: BarrierTables::create(directory, 0, barriers.first(), fields, inflow)?,
            further: further
                .map(|(k, b)| BarrierTables::create(directory, k, Some(b), fields, inflow))
                .collect::<Result<_, _>>()?,
            energy: OpenTable::create(&columns::ENERGY, &at("energy.csv"), names.clone())?,
            momentum: OpenTable::create(&columns::MOMENTUM, &at("momentum.csv"), names)?,
            bases: bases.collect::<Result<_, _>>()?,
            windows: windows.collect::<Result<_, _>>()?,
            stations: optional(!gauges.stations_m.is_empty(), &columns::STATIONS, &at("stations.csv"))?,
            field: optional(fields, &columns::FIELD, &at("field.csv"))?,
            contact: optional(fields && sim.contacts().next().is_some(), &columns::CONTACT, &at("contact.csv"))?,
            frames,
            frame_count: 0,
        })
    }

    /// Hands all rows to the files; all of them, also when one fails.
    fn close(&mut self) -> Result<(), OutputError> {
        let mut results = vec![self.first.flush(), self.energy.flush(), self.momentum.flush()];
        results.extend([flush(&mut self.stations), flush(&mut self.field), flush(&mut self.contact)]);
        results.extend(self.further.iter_mut().map(BarrierTables::flush));
        results.extend(self.bases.iter_mut().chain(&mut self.windows).map(OpenTable::flush));
        results.into_iter().collect()
    }

    /// What was recorded.
    fn into_records(self) -> Records {
        Records { further: self.further.into_iter().map(|b| b.records).collect(), ..self.first.records }
    }
}

impl Folder {
    fn is_written(&self) -> bool {
        self.first.rows.are_written()
    }

    fn is_kept(&self) -> bool {
        self.first.rows.are_kept()
    }
}

impl Recorder for Folder {
    fn has_tables(&self) -> bool {
        true
    }

    fn turn(&mut self, rows: Rows) {
        self.first.rows = rows;
        self.further.iter_mut().for_each(|b| b.rows = rows);
    }

    fn unsettled(&mut self, time: f64, cells: &[FieldCell]) -> Result<(), OutputError> {
        if self.field.is_none() {
            self.field = optional(true, &columns::FIELD, &self.directory.join("field.csv"))?;
        }
        self.field(time, cells)
    }

    fn history(&mut self, row: &HistoryRow) -> Result<(), OutputError> {
        self.first.history(row)
    }

    fn energy(&mut self, row: &EnergyRow) -> Result<(), OutputError> {
        if self.is_kept() {
            self.first.energy(row)?;
        }
        if self.is_written() { self.energy.row(row) } else { Ok(()) }
    }

    fn momentum(&mut self, row: &MomentumRow) -> Result<(), OutputError> {
        if self.is_kept() {
            self.first.momentum(row)?;
        }
        if !self.is_written() {
            return Ok(());
        }
        self.momentum.row(row)?;
        // Once per ledger row everything is on disk, and the disk is where it was.
        self.lock.check()?;
        self.close()
    }

    fn station(&mut self, time: f64, sample: &StationSample) -> Result<(), OutputError> {
        let written = self.is_written();
        self.stations.as_mut().filter(|_| written).map_or(Ok(()), |table| table.row(&(time, *sample)))
    }

    fn profile(&mut self, time: f64, rows: &[(f64, f64)]) -> Result<(), OutputError> {
        self.first.profile(time, rows)
    }

    fn structure(&mut self, time: f64, sample: &StructureSample) -> Result<(), OutputError> {
        self.first.structure(time, sample)
    }

    fn bending(&mut self, time: f64, rows: &[ProfilePoint]) -> Result<(), OutputError> {
        self.first.bending(time, rows)
    }

    fn outline(&mut self, time: f64, points: &[[f64; 2]]) -> Result<(), OutputError> {
        self.first.outline(time, points)
    }

    fn contact(&mut self, time: f64, dt: f64, points: &[ContactPoint]) -> Result<(), OutputError> {
        let Some(table) = &mut self.contact else { return Ok(()) };
        points.iter().try_for_each(|p| table.row(&(time, dt, *p)))
    }

    fn field(&mut self, time: f64, cells: &[FieldCell]) -> Result<(), OutputError> {
        let Some(table) = &mut self.field else { return Ok(()) };
        cells.iter().try_for_each(|c| table.row(&(time, *c)))
    }

    fn further(&mut self, barrier: usize) -> Option<&mut dyn Recorder> {
        self.further.get_mut(barrier).map(|b| b as &mut dyn Recorder)
    }

    fn further_base(&mut self, base: usize, row: &HistoryRow) -> Result<(), OutputError> {
        if self.is_kept() {
            self.first.records.further_base(base, row)?;
        }
        let written = self.is_written();
        self.bases.get_mut(base).filter(|_| written).map_or(Ok(()), |table| table.row(row))
    }

    fn window(&mut self, window: usize, row: &HistoryRow) -> Result<(), OutputError> {
        if self.is_kept() {
            self.first.records.window(window, row)?;
        }
        let written = self.is_written();
        self.windows.get_mut(window).filter(|_| written).map_or(Ok(()), |table| table.row(row))
    }

    fn frame(&mut self, simulation: &Simulation) -> Result<(), OutputError> {
        let Some(collection) = &mut self.frames else { return Ok(()) };
        // In the order of their numbers, so that a point keeps its place from frame to frame.
        let mut points: Vec<_> = simulation.particles().collect();
        points.sort_by_key(|(body, p)| (*body, p.id));
        let stress = |i: usize| {
            let s = &points[i].1.state.stress;
            let [xx, yy] = seeded::exchanged(Seed::OutputTensor, [s.xx, s.yy]);
            [xx, yy, s.zz, s.xy, 0.0, 0.0]
        };
        let volume = |i: usize| {
            let p = &points[i].1;
            seeded::exchanged(Seed::OutputFields, [p.volume_ratio, p.state.opened])
        };
        let fields = [
            Field { name: "velocity_m_per_s", values: Values::Vector(&|i| points[i].1.v) },
            Field { name: "speed_m_per_s", values: Values::Scalar(&|i| points[i].1.speed()) },
            Field { name: "stress_pa", values: Values::SymmetricTensor(&stress) },
            Field { name: "mean_stress_pa", values: Values::Scalar(&|i| points[i].1.state.stress.mean()) },
            Field { name: "volume_ratio", values: Values::Scalar(&|i| volume(i)[0]) },
            Field { name: "opened_strain", values: Values::Scalar(&|i| volume(i)[1]) },
            Field { name: "plastic_shear_strain", values: Values::Scalar(&|i| points[i].1.state.plastic_shear) },
            Field { name: "body", values: Values::Integer(&|i| points[i].0 as i64) },
            Field { name: "id", values: Values::Integer(&|i| i64::from(points[i].1.id)) },
        ];
        let name = format!("vtk/flow_{:05}.vtp", self.frame_count);
        let path = self.directory.join(&name);
        output::write_points(path, simulation.time(), points.len(), &|i| points[i].1.x, &fields)?;
        collection.frame(simulation.time(), 0, &name)?;
        self.frame_count += 1;
        Ok(())
    }
}

#[cfg(test)]
#[path = "files_tests.rs"]
mod tests;
