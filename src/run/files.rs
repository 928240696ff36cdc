//! The output folder of a run.
//!
//! Tables grow while the run goes on; VTK frames and the collection that lists them appear by rename. Whatever ends the run,
//! what was computed until then is there and readable, and `summary.toml` says how it ended. Nothing in the folder depends
//! on the wall clock, the number of threads or the place of the folder: the same case gives the same bytes.

use super::ProgressFn;
use super::columns;
use super::experiment::Experiment;
use super::figures::draw_figures;
use super::gauges::{Barrier, PeakProfile, suffix};
pub use super::outlines::outlines;
use super::outlines::{write_geometry_table, write_geometry_vtk};
use super::records::{EnergyRow, HistoryRow, MomentumRow, Recorder, Records};
use super::stage::RunError;
use super::summary::Summary;
use super::table::{Names, OpenTable, TableKind};
use crate::case::{Case, file_name};
use crate::gauge::structure::ProfilePoint;
use crate::gauge::{FieldCell, StationSample, StructureSample};
use crate::output::{self, Field, OutputError, PvdWriter, Values};
use crate::simulation::{ContactPoint, Simulation};
use std::fs;
use std::path::{Path, PathBuf};

/// Makes sure that `directory` exists, is empty and can be written.
///
/// # Errors
/// In words: what is wrong and what to do.
pub fn prepare_directory(directory: &Path) -> Result<(), String> {
    let shown = directory.display();
    if directory.exists() && !directory.is_dir() {
        return Err(format!("{shown} is a file; --out names a folder"));
    }
    if directory.is_dir() {
        let mut entries = fs::read_dir(directory).map_err(|e| format!("cannot look into {shown}: {e}"))?;
        if entries.next().is_some() {
            return Err(format!(
                "{shown} exists and is not empty; results are never mixed or overwritten: choose another folder with --out, \
                 or move or delete this one"
            ));
        }
    }
    let existed = directory.is_dir();
    fs::create_dir_all(directory)
        .map_err(|e| format!("cannot create {shown}: {e}; choose another folder with --out"))?;
    let probe = directory.join(".checkdam-probe");
    let tried = fs::write(&probe, b"checkdam");
    let removed = fs::remove_file(&probe);
    tried.and(removed).map_err(|e| {
        if !existed {
            let _ = fs::remove_dir(directory);
        }
        format!("cannot write into {shown}: {e}; choose another folder with --out")
    })
}

/// Runs a case into an empty folder; returns what was recorded.
///
/// # Errors
/// What stopped the run; the folder then holds what was computed.
pub fn run_into(
    case: &Case,
    directory: &Path,
    progress: &mut ProgressFn,
) -> Result<(Experiment, Records, Summary), RunError> {
    let mut experiment = Experiment::new(case);
    let mut folder = Folder::create(directory, &experiment)?;
    let end = experiment.run(&mut folder, progress);
    let closed = folder.close().map_err(RunError::from);
    let end = end.and_then(|end| closed.map(|()| end));
    let records = folder.into_records();
    let summary = match &end {
        Ok(end) => Summary::new(case, &experiment, &records, *end),
        Err(error) => Summary::failed(case, &experiment, &records, &error.to_string()),
    };
    let mut barriers = experiment.barriers().iter().enumerate();
    let mut peaks = || barriers.try_for_each(|(k, b)| write_peak_profile(directory, &suffix(b, k), b.peak_profile()));
    let written = output::write_text(directory.join("summary.toml"), &summary.to_toml()).and_then(|()| peaks());
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
    /// History, and what is read at the first barrier.
    first: BarrierTables,
    /// What is read at the other barriers.
    further: Vec<BarrierTables>,
    energy: OpenTable<EnergyRow>,
    momentum: OpenTable<MomentumRow>,
    stations: Option<OpenTable<(f64, StationSample)>>,
    field: Option<OpenTable<(f64, FieldCell)>>,
    contact: Option<OpenTable<columns::Touching>>,
    frames: Option<PvdWriter>,
    frame_count: usize,
}

/// The open tables of a barrier, and what was written into them.
struct BarrierTables {
    history: OpenTable<HistoryRow>,
    pressure: Option<OpenTable<[f64; 3]>>,
    structure: Option<OpenTable<(f64, StructureSample)>>,
    bending: Option<OpenTable<(f64, ProfilePoint)>>,
    outline: Option<OpenTable<[f64; 3]>>,
    records: Records,
}

impl BarrierTables {
    /// Those of a barrier with this number; without one there is a history all the same.
    fn create(directory: &Path, number: usize, barrier: Option<&Barrier>, fields: bool) -> Result<Self, OutputError> {
        let suffix = barrier.map_or_else(String::new, |b| suffix(b, number));
        let at = |name: &str| directory.join(format!("{name}{suffix}.csv"));
        let kind = if number == 0 { &columns::HISTORY } else { &columns::FURTHER };
        let (any, bends) = (barrier.is_some(), barrier.is_some_and(|b| b.structure().is_some()));
        Ok(Self {
            history: OpenTable::create(kind, &at("history"), Names::default())?,
            pressure: optional(any, &columns::PRESSURE, &at("pressure_profile"))?,
            structure: optional(bends, &columns::STRUCTURE, &at("barrier"))?,
            bending: optional(bends, &columns::BENDING, &at("barrier_profile"))?,
            outline: optional(bends && fields, &columns::OUTLINE, &at("barrier_outline"))?,
            records: Records::default(),
        })
    }

    /// Hands all rows to the files; all of them, also when one fails.
    fn flush(&mut self) -> Result<(), OutputError> {
        let results = [self.history.flush(), flush(&mut self.pressure), flush(&mut self.structure)];
        let results = results.into_iter().chain([flush(&mut self.bending), flush(&mut self.outline)]);
        results.collect::<Vec<_>>().into_iter().collect()
    }
}

/// A table that is there if it is wanted.
fn optional<R>(wanted: bool, kind: &'static TableKind<R>, path: &Path) -> Result<Option<OpenTable<R>>, OutputError> {
    wanted.then(|| OpenTable::create(kind, path, Names::default())).transpose()
}

fn flush<R>(table: &mut Option<OpenTable<R>>) -> Result<(), OutputError> {
    table.as_mut().map_or(Ok(()), OpenTable::flush)
}

impl Recorder for BarrierTables {
    fn history(&mut self, row: &HistoryRow) -> Result<(), OutputError> {
        self.records.history(row)?;
        self.history.row(row)
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
        self.records.structure(time, sample)?;
        self.structure.as_mut().map_or(Ok(()), |table| table.row(&(time, *sample)))
    }

    fn bending(&mut self, time: f64, rows: &[ProfilePoint]) -> Result<(), OutputError> {
        let Some(table) = &mut self.bending else { return Ok(()) };
        rows.iter().try_for_each(|p| table.row(&(time, *p)))
    }

    fn outline(&mut self, time: f64, points: &[[f64; 2]]) -> Result<(), OutputError> {
        let Some(table) = &mut self.outline else { return Ok(()) };
        points.iter().try_for_each(|x| table.row(&[time, x[0], x[1]]))
    }
}

impl Folder {
    fn create(directory: &Path, experiment: &Experiment) -> Result<Self, OutputError> {
        let sim = experiment.simulation();
        let gauges = experiment.gauges();
        let boundaries: Vec<String> = sim.boundaries().iter().map(|b| file_name(&b.name)).collect();
        let body = |k: usize| file_name(&sim.bodies()[k].name);
        let pairs = sim.contacts().map(|c| format!("{}_on_{}", body(c.bodies[0]), body(c.bodies[1])));
        let surfaces = boundaries.iter().cloned().chain(pairs).collect();
        let names = Names { boundaries, surfaces };
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
        Ok(Self {
            directory: directory.to_path_buf(),
            first: BarrierTables::create(directory, 0, barriers.first(), fields)?,
            further: further
                .map(|(k, b)| BarrierTables::create(directory, k, Some(b), fields))
                .collect::<Result<_, _>>()?,
            energy: OpenTable::create(&columns::ENERGY, &at("energy.csv"), names.clone())?,
            momentum: OpenTable::create(&columns::MOMENTUM, &at("momentum.csv"), names)?,
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
        results.into_iter().collect()
    }

    /// What was recorded.
    fn into_records(self) -> Records {
        Records { further: self.further.into_iter().map(|b| b.records).collect(), ..self.first.records }
    }
}

impl Recorder for Folder {
    fn history(&mut self, row: &HistoryRow) -> Result<(), OutputError> {
        self.first.history(row)
    }

    fn energy(&mut self, row: &EnergyRow) -> Result<(), OutputError> {
        self.first.energy(row)?;
        self.energy.row(row)
    }

    fn momentum(&mut self, row: &MomentumRow) -> Result<(), OutputError> {
        self.first.momentum(row)?;
        self.momentum.row(row)?;
        // Once per ledger row everything is on disk.
        self.close()
    }

    fn station(&mut self, time: f64, sample: &StationSample) -> Result<(), OutputError> {
        self.stations.as_mut().map_or(Ok(()), |table| table.row(&(time, *sample)))
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

    fn frame(&mut self, simulation: &Simulation) -> Result<(), OutputError> {
        let Some(collection) = &mut self.frames else { return Ok(()) };
        // In the order of their numbers, so that a point keeps its place from frame to frame.
        let mut points: Vec<_> = simulation.particles().collect();
        points.sort_by_key(|(body, p)| (*body, p.id));
        let stress = |i: usize| {
            let s = &points[i].1.state.stress;
            [s.xx, s.yy, s.zz, s.xy, 0.0, 0.0]
        };
        let fields = [
            Field { name: "velocity_m_per_s", values: Values::Vector(&|i| points[i].1.v) },
            Field { name: "speed_m_per_s", values: Values::Scalar(&|i| points[i].1.speed()) },
            Field { name: "stress_pa", values: Values::SymmetricTensor(&stress) },
            Field { name: "mean_stress_pa", values: Values::Scalar(&|i| points[i].1.state.stress.mean()) },
            Field { name: "volume_ratio", values: Values::Scalar(&|i| points[i].1.volume_ratio) },
            Field { name: "opened_strain", values: Values::Scalar(&|i| points[i].1.state.opened) },
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
