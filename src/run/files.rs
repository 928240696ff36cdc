//! The output folder of a run.
//!
//! Tables grow while the run goes on; VTK frames and the collection that lists them appear by rename. Whatever ends the run,
//! what was computed until then is there and readable, and `summary.toml` says how it ended. Nothing in the folder depends
//! on the wall clock, the number of threads or the place of the folder: the same case gives the same bytes.

use super::ProgressFn;
use super::columns::{self, Names, OpenTable, TableKind};
use super::experiment::{Experiment, RunError};
use super::gauges::{Barrier, PeakProfile};
use super::records::{EnergyRow, HistoryRow, MomentumRow, Recorder, Records};
use super::summary::Summary;
use crate::boundary::{Boundary, Solid};
use crate::case::{Case, file_name};
use crate::gauge::StructureSample;
use crate::gauge::flow::FieldCell;
use crate::gauge::structure::ProfilePoint;
use crate::output::{self, Field, OutputError, Polyline, PvdWriter, Table, Values};
use crate::plot::curves::{Curve, Curves};
use crate::plot::{self, PlotError, force_time::ReferenceLine};
use crate::simulation::Simulation;
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

/// Draws all figures of a run from its tables, leaving out those whose table has no row yet. All of them are tried, also when one
/// fails.
fn draw_figures(case: &Case, directory: &Path, experiment: &Experiment, summary: &Summary) -> Result<(), PlotError> {
    let at = |name: &str| directory.join(name);
    let has_rows = |name: &str| !Table::load(at(name)).is_ok_and(|table| table.rows() == 0);
    let mut results = Vec::new();
    for (k, barrier) in experiment.barriers().iter().enumerate() {
        results.extend(draw_barrier(
            directory,
            &suffix(barrier, k),
            barrier,
            if k == 0 { Some(summary) } else { None },
        ));
    }
    if summary.energy.initial_j > 0.0 && has_rows("energy.csv") {
        results.push(plot::energy_shares::draw(at("energy.csv"), at("energy_shares.svg")));
    }
    if !case.gauges.field_times_s.is_empty() && has_rows("field.csv") {
        let bends = experiment.barriers().iter().enumerate().find(|(_, b)| b.structure().is_some());
        let outline = bends.map(|(k, b)| at(&format!("barrier_outline{}.csv", suffix(b, k))));
        let (field, geometry, out) = (at("field.csv"), at("geometry.csv"), at("flow_snapshots.svg"));
        let (shown, inclination) = (&plot::flow_snapshots::Shown::SPEED, case.gravity.inclination_deg);
        let drawn =
            plot::flow_snapshots::draw_with_barrier(field, shown, geometry, outline.as_deref(), inclination, out);
        results.push(drawn);
    }
    results.into_iter().collect()
}

/// Draws the figures of a barrier from its tables. The force that it would take at least is known of the first, with its `summary`.
fn draw_barrier(
    directory: &Path,
    suffix: &str,
    barrier: &Barrier,
    summary: Option<&Summary>,
) -> Vec<Result<(), PlotError>> {
    let at = |name: &str, kind: &str| directory.join(format!("{name}{suffix}.{kind}"));
    let has_rows = |name: &str| !Table::load(at(name, "csv")).is_ok_and(|table| table.rows() == 0);
    let mut results = Vec::new();
    if barrier.structure().is_some() && has_rows("barrier") {
        results.push(plot::curves::draw(at("barrier", "csv"), &BARRIER_FORCES, at("barrier_forces", "svg")));
    }
    if !barrier.peak_profile().points.is_empty() {
        let (table, figure) = (at("barrier_profile_at_peak", "csv"), at("barrier_deflection", "svg"));
        results.push(plot::curves::draw(table, &PEAK_DEFLECTION, figure));
    }
    if has_rows("history") {
        let deposit = summary.and_then(|s| s.deposit.as_ref());
        let value = deposit.map(|d| d.theoretical_static_force_n).filter(|f| f.is_finite());
        let label = "weight less full base friction\nm g (sin \u{3b8} \u{2212} \u{3bc} cos \u{3b8})";
        let lines: Vec<_> = value.map(|v| ReferenceLine::new(label, v)).into_iter().collect();
        results.push(plot::force_time::draw(at("history", "csv"), &lines, at("force_time", "svg")));
    }
    if has_rows("pressure_profile") {
        let (table, figure) = (at("pressure_profile", "csv"), at("pressure_profile", "svg"));
        results.push(plot::pressure_profile::draw(table, figure));
    }
    results
}

/// What follows in the names of a barrier's files, by its number: nothing for the first, else its name.
fn suffix(barrier: &Barrier, number: usize) -> String {
    if number == 0 { String::new() } else { format!("_{}", file_name(barrier.name())) }
}

/// Force on a barrier that is a body: what contact gives, what the clamp takes, what is left as momentum.
const BARRIER_FORCES: Curves = Curves {
    x: "time_s",
    x_title: "time (s)",
    y_title: "force against the face (N)",
    curves: &[
        Curve { column: "contact_normal_n", label: "contact with the flow", exact: false },
        Curve { column: "clamp_normal_n", label: "clamp", exact: false },
        Curve { column: "inertia_normal_n", label: "rate of momentum", exact: false },
    ],
    ..Curves::LINEAR
};

/// Its face, bent.
const PEAK_DEFLECTION: Curves = Curves {
    x: "deflection_m",
    x_title: "deflection at the largest force (m)",
    y_title: "height above the foot (m)",
    curves: &[Curve { column: "height_m", label: "", exact: false }],
    ..Curves::LINEAR
};

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
    stations: Option<OpenTable<[f64; 4]>>,
    field: Option<OpenTable<(f64, FieldCell)>>,
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
            frames,
            frame_count: 0,
        })
    }

    /// Hands all rows to the files; all of them, also when one fails.
    fn close(&mut self) -> Result<(), OutputError> {
        let mut results = vec![self.first.flush(), self.energy.flush(), self.momentum.flush()];
        results.extend([flush(&mut self.stations), flush(&mut self.field)]);
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

    fn stations(&mut self, time: f64, rows: &[(f64, f64, f64)]) -> Result<(), OutputError> {
        let Some(table) = &mut self.stations else { return Ok(()) };
        rows.iter().try_for_each(|&(x, depth, velocity)| table.row(&[time, x, depth, velocity]))
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

/// Outlines of the boundaries that stay, planes cut to a strip two cells thick along the domain.
pub fn outlines(simulation: &Simulation) -> Vec<(usize, Vec<[f64; 2]>)> {
    let fixed = |b: &&Boundary| b.opening.is_none();
    simulation
        .boundaries()
        .iter()
        .enumerate()
        .filter(|(_, b)| fixed(b))
        .map(|(index, b)| {
            let (foot, n, t) = (b.foot(), b.normal, b.tangent);
            let corners = match b.solid {
                Solid::HalfSpace { .. } => {
                    let depth = 2.0 * simulation.spacing();
                    let [xs, ys] = simulation.domain();
                    let along: Vec<f64> = [[xs[0], ys[0]], [xs[1], ys[0]], [xs[0], ys[1]], [xs[1], ys[1]]]
                        .iter()
                        .filter(|c| b.depth(**c) >= 0.0)
                        .map(|c| b.face_coordinates(*c).1)
                        .collect();
                    let low = along.iter().fold(f64::INFINITY, |a, s| a.min(*s));
                    let high = along.iter().fold(f64::NEG_INFINITY, |a, s| a.max(*s));
                    if low >= high {
                        return (index, Vec::new());
                    }
                    vec![foot + t * low, foot + t * high, foot + t * high - n * depth, foot + t * low - n * depth]
                }
                Solid::Slab { height, thickness, .. } => {
                    vec![foot, foot + t * height, foot + t * height - n * thickness, foot - n * thickness]
                }
            };
            (index, corners.into_iter().map(Into::into).collect())
        })
        .filter(|(_, corners): &(usize, Vec<[f64; 2]>)| !corners.is_empty())
        .collect()
}

fn write_geometry_table(directory: &Path, simulation: &Simulation) -> Result<(), OutputError> {
    let mut table = OpenTable::create(&columns::GEOMETRY, &directory.join("geometry.csv"), Names::default())?;
    for (index, corners) in outlines(simulation) {
        for c in corners {
            table.row(&[index as f64, c[0], c[1]])?;
        }
    }
    table.finish()
}

fn write_geometry_vtk(directory: &Path, simulation: &Simulation) -> Result<(), OutputError> {
    let outlines = outlines(simulation);
    let lines: Vec<Polyline> = outlines
        .iter()
        .map(|(index, corners)| Polyline { boundary: *index as i64, points_m: corners, closed: true })
        .collect();
    output::write_polylines(directory.join("vtk").join("boundaries.vtp"), &lines)
}
