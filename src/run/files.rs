//! The output folder of a run.
//!
//! Tables grow while the run goes on; VTK frames and the collection that lists them appear by rename. Whatever ends the run,
//! what was computed until then is there and readable, and `summary.toml` says how it ended. Nothing in the folder depends
//! on the wall clock, the number of threads or the place of the folder: the same case gives the same bytes.

use super::ProgressFn;
use super::experiment::{Experiment, RunError};
use super::records::{EnergyRow, HistoryRow, MomentumRow, Recorder, Records, STRUCTURE_COLUMNS, structure_values};
use super::summary::Summary;
use crate::boundary::{Boundary, Solid};
use crate::case::Case;
use crate::gauge::StructureSample;
use crate::gauge::flow::FieldCell;
use crate::gauge::structure::ProfilePoint;
use crate::output::{self, Field, OutputError, Polyline, PvdWriter, Table, TableWriter, Values};
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
    let summary = match &end {
        Ok(end) => Summary::new(case, &experiment, &folder.records, *end),
        Err(error) => Summary::failed(case, &experiment, &folder.records, &error.to_string()),
    };
    let written = output::write_text(directory.join("summary.toml"), &summary.to_toml())
        .and_then(|()| write_peak_profile(directory, &experiment));
    let drawn = draw_figures(case, directory, &summary);
    // The first thing that went wrong is reported: what follows from it would only hide it.
    end?;
    written?;
    drawn?;
    Ok((experiment, folder.records, summary))
}

/// Draws all figures of a run from its tables, leaving out those whose table has no row yet.
///
/// # Errors
/// The first figure that could not be drawn.
pub fn draw_figures(case: &Case, directory: &Path, summary: &Summary) -> Result<(), PlotError> {
    let at = |name: &str| directory.join(name);
    let empty = |name: &str| Table::load(at(name)).is_ok_and(|table| table.rows() == 0);
    let force = || {
        let value = summary.deposit.as_ref().map(|d| d.theoretical_static_force_n).filter(|f| f.is_finite());
        let label = "weight less full base friction\nm g (sin \u{3b8} \u{2212} \u{3bc} cos \u{3b8})";
        let lines: Vec<_> = value.map(|v| ReferenceLine::new(label, v)).into_iter().collect();
        plot::force_time::draw(at("history.csv"), &lines, at("force_time.svg"))
    };
    let profile = || plot::pressure_profile::draw(at("pressure_profile.csv"), at("pressure_profile.svg"));
    let energy = || plot::energy_shares::draw(at("energy.csv"), at("energy_shares.svg"));
    let inclination = case.gravity.inclination_deg;
    let outline = at("barrier_outline.csv");
    let bends = outline.exists();
    let flow = || {
        let (field, geometry, out) = (at("field.csv"), at("geometry.csv"), at("flow_snapshots.svg"));
        let shown = &plot::flow_snapshots::Shown::SPEED;
        plot::flow_snapshots::draw_with_barrier(field, shown, geometry, bends.then_some(&*outline), inclination, out)
    };
    let clamp = || plot::curves::draw(at("barrier.csv"), &BARRIER_FORCES, at("barrier_forces.svg"));
    let bent = || plot::curves::draw(at(PEAK_PROFILE), &PEAK_DEFLECTION, at("barrier_deflection.svg"));

    let barrier = case.gauges.barrier.is_some();
    let fields = !case.gauges.field_times_s.is_empty();
    type Draw<'a> = &'a dyn Fn() -> Result<(), PlotError>;
    let body = summary.structure.is_some();
    let figures: [(bool, &str, Draw); 6] = [
        (body, "barrier.csv", &clamp),
        (body && at(PEAK_PROFILE).exists(), PEAK_PROFILE, &bent),
        (barrier, "history.csv", &force),
        (barrier, "pressure_profile.csv", &profile),
        (summary.energy.initial_j > 0.0, "energy.csv", &energy),
        (fields, "field.csv", &flow),
    ];
    let wanted = figures.into_iter().filter(|(wanted, table, _)| *wanted && !empty(table));
    // All of them, also when one fails.
    let results: Vec<_> = wanted.map(|(_, _, draw)| draw()).collect();
    results.into_iter().collect()
}

/// The table of how a barrier was bent at its largest force.
const PEAK_PROFILE: &str = "barrier_profile_at_peak.csv";

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

/// Columns of the tables of a bent barrier, through time and at its largest force.
const BENDING_COLUMNS: [&str; 4] = ["time_s", "height_m", "deflection_m", "velocity_m_per_s"];

/// How a barrier that is a body was bent at its largest force.
fn write_peak_profile(directory: &Path, experiment: &Experiment) -> Result<(), OutputError> {
    let peak = experiment.peak_profile();
    if peak.points.is_empty() {
        return Ok(());
    }
    let mut table = TableWriter::create(directory.join(PEAK_PROFILE), &BENDING_COLUMNS)?;
    peak.points.iter().try_for_each(|p| table.row(&[peak.time, p.height, p.deflection, p.velocity]))?;
    table.finish().map(|_| ())
}

/// The open tables of a run.
struct Folder {
    directory: PathBuf,
    history: TableWriter,
    energy: TableWriter,
    momentum: TableWriter,
    stations: Option<TableWriter>,
    profile: Option<TableWriter>,
    field: Option<TableWriter>,
    structure: Option<TableWriter>,
    bending: Option<TableWriter>,
    outline: Option<TableWriter>,
    frames: Option<PvdWriter>,
    frame_count: usize,
    records: Records,
}

impl Folder {
    fn create(directory: &Path, experiment: &Experiment) -> Result<Self, OutputError> {
        let sim = experiment.simulation();
        let gauges = experiment.gauges();
        let names: Vec<String> = sim.boundaries().iter().map(|b| column_name(&b.name)).collect();
        let body = |k: usize| column_name(&sim.bodies()[k].name);
        let pairs = sim.contacts().map(|c| format!("{}_on_{}", body(c.bodies[0]), body(c.bodies[1])));
        let where_energy_goes: Vec<String> = names.iter().cloned().chain(pairs).collect();
        let table = |name: &str, columns: &[String]| TableWriter::create(directory.join(name), columns);
        let fixed = |columns: &[&str]| columns.iter().map(ToString::to_string).collect::<Vec<_>>();
        let optional =
            |wanted: bool, name: &str, columns: &[&str]| wanted.then(|| table(name, &fixed(columns))).transpose();
        let has_barrier = experiment.barrier().is_some();
        let bends = experiment.structure().is_some();
        let frames = if experiment.vtk_interval() > 0.0 {
            let frames = directory.join("vtk");
            fs::create_dir_all(&frames).map_err(|source| OutputError::Create { path: frames, source })?;
            write_geometry_vtk(directory, sim)?;
            Some(PvdWriter::create(directory.join("flow.pvd"))?)
        } else {
            None
        };
        write_geometry_table(directory, sim)?;
        Ok(Self {
            directory: directory.to_path_buf(),
            history: table("history.csv", &fixed(&HistoryRow::COLUMNS))?,
            energy: table("energy.csv", &energy_columns(&where_energy_goes))?,
            momentum: table("momentum.csv", &momentum_columns(&names))?,
            stations: optional(
                !gauges.stations_m.is_empty(),
                "stations.csv",
                &["time_s", "x_m", "depth_m", "velocity_m_per_s"],
            )?,
            profile: optional(has_barrier, "pressure_profile.csv", &["time_s", "height_m", "pressure_pa"])?,
            field: optional(
                !gauges.field_times_s.is_empty(),
                "field.csv",
                &[
                    "time_s",
                    "x_m",
                    "y_m",
                    "solid_fraction",
                    "velocity_x_m_per_s",
                    "velocity_y_m_per_s",
                    "speed_m_per_s",
                    "pressure_pa",
                    "plastic_shear_strain",
                ],
            )?,
            structure: optional(bends, "barrier.csv", &STRUCTURE_COLUMNS)?,
            bending: optional(bends, "barrier_profile.csv", &BENDING_COLUMNS)?,
            outline: optional(
                bends && !gauges.field_times_s.is_empty(),
                "barrier_outline.csv",
                &["time_s", "x_m", "y_m"],
            )?,
            frames,
            frame_count: 0,
            records: Records::default(),
        })
    }

    fn close(&mut self) -> Result<(), OutputError> {
        let always = [&mut self.history, &mut self.energy, &mut self.momentum];
        let tables = [
            &mut self.stations,
            &mut self.profile,
            &mut self.field,
            &mut self.structure,
            &mut self.bending,
            &mut self.outline,
        ];
        let optional = tables.into_iter().flatten();
        // All of them, also when one fails.
        let results: Vec<_> = always.into_iter().chain(optional).map(TableWriter::flush).collect();
        results.into_iter().collect()
    }
}

impl Recorder for Folder {
    fn history(&mut self, row: &HistoryRow) -> Result<(), OutputError> {
        self.records.history(row)?;
        self.history.row(&row.values())
    }

    fn energy(&mut self, row: &EnergyRow) -> Result<(), OutputError> {
        self.records.energy(row)?;
        let e = &row.balance;
        let mut values = vec![row.time, e.kinetic, e.gravitational, e.elastic, e.plastic];
        values.extend(&e.friction);
        values.extend(&e.contact);
        values.extend([e.pic, e.damping, e.side_walls, e.outflow, e.residual]);
        self.energy.row(&values)
    }

    fn momentum(&mut self, row: &MomentumRow) -> Result<(), OutputError> {
        self.records.momentum(row)?;
        let l = &row.ledger;
        let mut values = vec![row.time];
        values.extend(row.gained);
        values.extend(l.gravity);
        for boundary in &l.boundaries {
            values.extend(boundary.impulse);
        }
        values.extend(l.damping.impulse);
        values.extend(l.side_walls.impulse);
        values.extend(l.departed_momentum.map(|p| -p));
        values.extend(row.residual);
        self.momentum.row(&values)?;
        // Once per ledger row everything is on disk.
        self.close()
    }

    fn stations(&mut self, time: f64, rows: &[(f64, f64, f64)]) -> Result<(), OutputError> {
        let Some(table) = &mut self.stations else { return Ok(()) };
        rows.iter().try_for_each(|&(x, depth, velocity)| table.row(&[time, x, depth, velocity]))
    }

    fn profile(&mut self, time: f64, rows: &[(f64, f64)]) -> Result<(), OutputError> {
        let Some(table) = &mut self.profile else { return Ok(()) };
        rows.iter().try_for_each(|&(height, pressure)| table.row(&[time, height, pressure]))
    }

    fn structure(&mut self, time: f64, sample: &StructureSample) -> Result<(), OutputError> {
        self.records.structure(time, sample)?;
        let Some(table) = &mut self.structure else { return Ok(()) };
        table.row(&structure_values(time, sample))
    }

    fn bending(&mut self, time: f64, rows: &[ProfilePoint]) -> Result<(), OutputError> {
        let Some(table) = &mut self.bending else { return Ok(()) };
        rows.iter().try_for_each(|p| table.row(&[time, p.height, p.deflection, p.velocity]))
    }

    fn outline(&mut self, time: f64, points: &[[f64; 2]]) -> Result<(), OutputError> {
        let Some(table) = &mut self.outline else { return Ok(()) };
        points.iter().try_for_each(|x| table.row(&[time, x[0], x[1]]))
    }

    fn field(&mut self, time: f64, cells: &[FieldCell]) -> Result<(), OutputError> {
        let Some(table) = &mut self.field else { return Ok(()) };
        let values = |c: &FieldCell| {
            [time, c.x[0], c.x[1], c.fill, c.v[0], c.v[1], c.v[0].hypot(c.v[1]), c.pressure, c.plastic_shear]
        };
        cells.iter().try_for_each(|c| table.row(&values(c)))
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

/// A boundary's name as part of a column name.
fn column_name(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() { c.to_ascii_lowercase() } else { '_' }).collect()
}

fn energy_columns(boundaries: &[String]) -> Vec<String> {
    let start = ["time_s", "kinetic_j", "gravitational_j", "elastic_j", "plastic_j"].map(String::from);
    let friction = boundaries.iter().map(|b| format!("friction_{b}_j"));
    let contact = boundaries.iter().map(|b| format!("contact_{b}_j"));
    let end = ["pic_j", "damping_j", "side_walls_j", "outflow_j", "residual_j"].map(String::from);
    start.into_iter().chain(friction).chain(contact).chain(end).collect()
}

fn momentum_columns(boundaries: &[String]) -> Vec<String> {
    let both = |name: &str| [format!("{name}_x_n_s"), format!("{name}_y_n_s")];
    let mut columns = vec!["time_s".to_string()];
    columns.extend(both("gained"));
    columns.extend(both("gravity"));
    columns.extend(boundaries.iter().flat_map(|b| both(b)));
    for name in ["damping", "side_walls", "outflow", "residual"] {
        columns.extend(both(name));
    }
    columns
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
    let mut table = TableWriter::create(directory.join("geometry.csv"), &["boundary", "x_m", "y_m"])?;
    for (index, corners) in outlines(simulation) {
        for c in corners {
            table.row(&[index as f64, c[0], c[1]])?;
        }
    }
    table.finish().map(|_| ())
}

fn write_geometry_vtk(directory: &Path, simulation: &Simulation) -> Result<(), OutputError> {
    let outlines = outlines(simulation);
    let lines: Vec<Polyline> = outlines
        .iter()
        .map(|(index, corners)| Polyline { boundary: *index as i64, points_m: corners, closed: true })
        .collect();
    output::write_polylines(directory.join("vtk").join("boundaries.vtp"), &lines)
}
