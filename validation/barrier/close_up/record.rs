//! Makes the record anew: runs the four barriers and writes down what the figures need.

use super::{BARRIERS, FIELDS, INSTANTS, WAVE, WAVE_REACH, WAVE_ROW, case_of};
use crate::boundary::Boundary;
use crate::gauge::StructureSample;
use crate::gauge::flow::FieldCell;
use crate::gauge::structure::ProfilePoint;
use crate::ledger::Stock;
use crate::output::OutputError;
use crate::run::records::{EnergyRow, HistoryRow, MomentumRow, Recorder, Records};
use crate::run::{Experiment, files};
use crate::simulation::Simulation;
use crate::validation::{Context, Failure};
use crate::verification::report::number;
use rayon::prelude::*;
use std::sync::Mutex;

/// Length of the means at the end, s.
const LATE: f64 = 0.3;

/// Keeps everything that the figures need.
#[derive(Default)]
struct Collector {
    records: Records,
    profiles: Vec<(f64, Vec<(f64, f64)>)>,
    fields: Vec<(f64, Vec<FieldCell>)>,
    outlines: Vec<(f64, Vec<[f64; 2]>)>,
    /// What the barrier holds, through time.
    barrier: Vec<(f64, Stock)>,
}

impl Recorder for Collector {
    fn history(&mut self, row: &HistoryRow) -> Result<(), OutputError> {
        self.records.history(row)
    }

    fn energy(&mut self, row: &EnergyRow) -> Result<(), OutputError> {
        self.records.energy(row)
    }

    fn momentum(&mut self, row: &MomentumRow) -> Result<(), OutputError> {
        self.records.momentum(row)
    }

    fn structure(&mut self, time: f64, sample: &StructureSample) -> Result<(), OutputError> {
        self.records.structure(time, sample)
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
        let own = |b: usize| simulation.bodies()[b].weightless;
        self.barrier.push((simulation.time(), simulation.stock_of(own)));
        Ok(())
    }
}

struct Seen {
    name: &'static str,
    collector: Collector,
    peak: Vec<ProfilePoint>,
    face: Boundary,
    thickness: f64,
    outlines: Vec<(usize, Vec<[f64; 2]>)>,
}

/// Runs the barriers side by side; the tables, by file name.
pub(super) fn make(context: &mut Context) -> Result<Vec<(String, String)>, Failure> {
    let progress = Mutex::new(&mut *context.progress);
    let look = |name: &'static str, stiffness: &str| -> Result<Seen, Failure> {
        let case = case_of(stiffness)?;
        let mut experiment = Experiment::new(&case);
        let mut collector = Collector::default();
        let mut stopped = false;
        experiment.run(&mut collector, &mut |p| {
            let mut progress = progress.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            let go_on = progress(&format!("{name}: {} {:.2} s", p.stage.name(), p.time));
            stopped |= !go_on;
            go_on
        })?;
        if stopped {
            return Err(Failure::Stopped);
        }
        let face = experiment.structure().map(|s| s.face().clone());
        Ok(Seen {
            name,
            peak: experiment.peak_profile().points.clone(),
            face: face.ok_or_else(|| Failure::Record(format!("{name} is no body")))?,
            thickness: case.grid.thickness_m,
            outlines: files::outlines(experiment.simulation()),
            collector,
        })
    };
    let seen: Vec<Seen> =
        BARRIERS.par_iter().map(|(name, stiffness)| look(name, stiffness)).collect::<Result<_, Failure>>()?;
    let all = |header: &str, rows: &dyn Fn(&Seen) -> String| {
        header.to_string() + "\n" + &seen.iter().map(rows).collect::<String>()
    };
    let mut tables = vec![
        ("pressure.csv".into(), all("barrier,time_s,pressure_kpa", &pressure)),
        ("wave.csv".into(), all("barrier,time_s,distance_m,pressure_pa", &wave)),
        (
            "at_peak.csv".into(),
            all("barrier,height_m,height_over_depth_1,deflection_percent,velocity_over_front_1", &at_peak),
        ),
        ("at_rest.csv".into(), all("barrier,height_m,pressure_pa,run_up_m", &at_rest)),
        ("energy.csv".into(), all("barrier,time_s,kinetic_1,dissipated_1,barrier_1,residual_1", &energy)),
        ("geometry.csv".into(), geometry(&seen[0])),
    ];
    for barrier in FIELDS {
        let Some(one) = seen.iter().find(|s| s.name == barrier) else { continue };
        tables.push((format!("field_{barrier}.csv"), field(one)));
        tables.push((format!("outline_{barrier}.csv"), outline(one)));
        tables.push((format!("mechanisms_{barrier}.csv"), mechanisms(one)));
    }
    Ok(tables)
}

fn row(name: &str, values: &[f64]) -> String {
    let cells: Vec<String> = values.iter().map(|x| if x.is_finite() { number(*x) } else { String::new() }).collect();
    format!("{name},{}\n", cells.join(","))
}

/// Force over the area of the face: every sample around the impact, every tenth later.
fn pressure(s: &Seen) -> String {
    let area = s.thickness * s.face.height();
    let history = s.collector.records.history.iter().enumerate();
    let shown = history.filter(|(k, r)| r.time > 0.44 && r.time < 1.0 && (r.time < 0.6 || k % 10 == 0));
    shown.map(|(_, r)| row(s.name, &[r.time, 1e-3 * r.normal / area])).collect()
}

/// Pressure in a row of cells up the flow from where the face stood at the start.
fn wave(s: &Seen) -> String {
    let mut text = String::new();
    let inside = s.collector.fields.iter().filter(|(t, _)| *t >= WAVE[0] && *t < WAVE[1] + 1e-3);
    for (time, cells) in inside {
        let own = cells.iter().filter(|c| (c.x[1] - WAVE_ROW).abs() < 1e-6);
        let foot = s.face.foot();
        // The face at this height.
        let at = foot.x + s.face.tangent.x / s.face.tangent.y * (WAVE_ROW - foot.y);
        for c in own.filter(|c| at - c.x[0] > -0.1 && at - c.x[0] < WAVE_REACH) {
            let numbers = [at - c.x[0], c.pressure].map(number).join(",");
            text += &format!("{},{},{numbers}\n", s.name, number(*time));
        }
    }
    text
}

/// Velocity and depth of the front just before the barrier is touched.
fn front(s: &Seen) -> (f64, f64) {
    let history = &s.collector.records.history;
    let arrival = history.iter().position(|r| r.normal > 0.5).unwrap_or(1).max(1);
    let front = history[arrival - 1].front;
    (front.velocity, front.depth)
}

fn at_peak(s: &Seen) -> String {
    let (velocity, depth) = front(s);
    let height = s.face.height();
    let values = |p: &ProfilePoint| [p.height, p.height / depth, 100.0 * p.deflection / height, p.velocity / velocity];
    s.peak.iter().map(|p| row(s.name, &values(p))).collect()
}

/// Mean pressure by height over the last 0.3 s, and the highest material at the barrier at the end.
fn at_rest(s: &Seen) -> String {
    let history = &s.collector.records.history;
    let (Some(last), Some((_, bins))) = (history.last(), s.collector.profiles.last()) else { return String::new() };
    let late: Vec<_> = s.collector.profiles.iter().filter(|(t, _)| *t > last.time - LATE).collect();
    let mean = |k: usize| late.iter().map(|(_, rows)| rows[k].1).sum::<f64>() / late.len() as f64;
    (0..bins.len()).map(|k| row(s.name, &[bins[k].0, mean(k), last.run_up])).collect()
}

/// Shares of the energy at release, every 20 ms.
fn energy(s: &Seen) -> String {
    let rows = s.collector.barrier.iter().filter_map(|(time, stock)| {
        let at =
            s.collector.records.energy.iter().min_by(|a, b| (a.time - time).abs().total_cmp(&(b.time - time).abs()))?;
        let b = &at.balance;
        let dissipated = b.initial - b.kinetic - b.gravitational - b.elastic;
        let shares = [b.kinetic, dissipated, stock.kinetic + stock.elastic, b.residual].map(|e| e / b.initial);
        Some(row(s.name, &[&[*time], &shares[..]].concat()))
    });
    rows.collect()
}

/// Where the energy is, J, every 20 ms.
fn mechanisms(s: &Seen) -> String {
    let mut text = String::from(
        "time_s,kinetic_j,gravitational_j,elastic_j,plastic_j,friction_base_j,friction_barrier_j,contact_all_j,pic_j,residual_j\n",
    );
    let mut next = 0.0;
    for r in &s.collector.records.energy {
        if r.time < next {
            continue;
        }
        next = r.time + 0.02;
        let b = &r.balance;
        let on_barrier = b.friction.last().copied().unwrap_or(0.0);
        let friction: f64 = b.friction.iter().sum();
        let contact: f64 = b.contact.iter().sum();
        let values = [
            b.kinetic,
            b.gravitational,
            b.elastic,
            b.plastic,
            friction - on_barrier,
            on_barrier,
            contact,
            b.pic,
            b.residual,
        ];
        text += &format!("{},{}\n", number(r.time), values.map(|j| format!("{j:.4}")).join(","));
    }
    text
}

/// The instants that are drawn.
fn instants<T>(s: &[(f64, T)]) -> impl Iterator<Item = (f64, &T)> {
    INSTANTS.iter().filter_map(|t| s.iter().find(|(time, _)| time >= t)).map(|(time, value)| (*time, value))
}

fn field(s: &Seen) -> String {
    let mut text = String::from("time_s,x_m,y_m,pressure_pa,plastic_shear_strain\n");
    for (time, cells) in instants(&s.collector.fields) {
        for c in cells {
            let rounded = [c.x[0], c.x[1]].map(number).join(",");
            text += &format!("{},{rounded},{:.0},{:.3}\n", number(time), c.pressure, c.plastic_shear);
        }
    }
    text
}

fn outline(s: &Seen) -> String {
    let mut text = String::from("time_s,x_m,y_m\n");
    for (time, points) in instants(&s.collector.outlines) {
        points.iter().for_each(|x| text += &format!("{},{:.4},{:.4}\n", number(time), x[0], x[1]));
    }
    text
}

fn geometry(s: &Seen) -> String {
    let mut text = String::from("boundary,x_m,y_m\n");
    for (index, corners) in &s.outlines {
        corners.iter().for_each(|c| text += &format!("{index},{:.4},{:.4}\n", c[0], c[1]));
    }
    text
}
