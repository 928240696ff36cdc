//! What tables and summary say of the material, made anew from the points of the VTK frames of the same moments.

use super::gauges;
use super::judge::{Judge, WRITTEN, within};
use super::ledgers::row_at;
use super::rows::{DEFINED, MOST, SAME, pick};
use super::setting::{Point, Setting, at};
use crate::from_file::{Files, largest};
use std::collections::BTreeMap;

/// Round-off of sums over some hundred doubles.
const SUMS: f64 = 1e-12;

pub fn judge(set: &Setting, files: &Files, judge: &mut Judge) {
    let times: Vec<f64> = (0..files.frames()).map(|k| files.array(k, "TimeValue")[0]).collect();
    judge.same(
        "flow.pvd: times against those in the frames",
        &files.frame_times(),
        &times,
        within(SUMS, "the same number", DEFINED),
    );
    let history = files.column("history.csv", "time_s");
    let ledger = files.column("energy.csv", "time_s");
    let booked = files.column("momentum.csv", "time_s");
    let mut met = 0;
    let mut start = None;
    for (k, time) in times.iter().enumerate() {
        let points = set.points(files, k);
        own(files, k, &points, judge);
        if points.is_empty() && !files.array(k, "body")[0].is_nan() {
            judge.at_most("points of no body", 1.0, 0.0, "every point belongs to a body");
        }
        let sum = |of: &dyn Fn(&Point) -> f64| points.iter().map(of).sum::<f64>();
        let momentum = [sum(&|p| p.mass * p.v[0]), sum(&|p| p.mass * p.v[1])];
        if k == 0 && at(&set.case, "stages.settle.residual").is_none() {
            let off = |p: &Point| (p.v[0] - set.bodies[p.body].v[0]).hypot(p.v[1] - set.bodies[p.body].v[1]);
            let off = largest(points.iter().map(off));
            judge.at_most("flow.vtp: velocity at release against the case", off, 0.0, "nothing has moved yet");
        }
        let first = *start.get_or_insert(momentum);
        if let Some(row) = row_at(&ledger, *time) {
            met += 1;
            energies(set, files, row, &points, judge);
            let row = row_at(&booked, *time).unwrap_or(usize::MAX);
            let gained = ["gained_x_n_s", "gained_y_n_s"].map(|c| pick(&files.column("momentum.csv", c), row));
            let scale = set.mass() * (set.gravity * 0.01 + fastest(set));
            let now = [0, 1].map(|d| momentum[d] - first[d]);
            judge.near("momentum.csv: gained against the points", &gained, &now, scale, within(1e-7, SAME, DEFINED));
            stations(set, files, *time, &points, judge);
        }
        if let Some(row) = row_at(&history, *time) {
            met += 1;
            gauges::judge(set, files, row, &points, judge);
        }
        fields(set, files, *time, &points, judge);
    }
    // At release there is no row of samples yet.
    judge.at_most(
        "frames without a row of the same moment",
        2.0 * times.len() as f64 - 1.0 - f64::from(met),
        0.0,
        "frames, ledgers and samples end with the same steps",
    );
}

/// Speed of the fastest body at the start, m/s.
fn fastest(set: &Setting) -> f64 {
    set.bodies.iter().map(|b| b.v[0].hypot(b.v[1])).fold(0.0, f64::max)
}

/// Arrays of a frame that follow from others.
fn own(files: &Files, frame: usize, points: &[Point], judge: &mut Judge) {
    if points.is_empty() {
        return;
    }
    let made = |of: &dyn Fn(&Point) -> f64| points.iter().map(of).collect::<Vec<_>>();
    judge.same(
        "flow.vtp: speed against velocity",
        &files.array(frame, "speed_m_per_s"),
        &made(&|p| p.speed()),
        within(SUMS, "round-off", DEFINED),
    );
    judge.same(
        "flow.vtp: mean stress against stress",
        &files.array(frame, "mean_stress_pa"),
        &made(&Point::mean),
        within(SUMS, "round-off", DEFINED),
    );
    let out = ["Points.z", "velocity_m_per_s.z", "stress_pa.yz", "stress_pa.xz"].map(|name| files.array(frame, name));
    let out = out.iter().flatten().map(|v| v.abs()).sum::<f64>();
    judge.at_most("flow.vtp: what lies out of the plane", out, 0.0, "the simulation is plane");
    let (ids, bodies) = (files.array(frame, "id"), files.array(frame, "body"));
    let whole = |x: &f64| x.fract() != 0.0;
    let ordered = (1..ids.len()).filter(|&k| (bodies[k - 1], ids[k - 1]) >= (bodies[k], ids[k])).count();
    let odd = ids.iter().chain(&bodies).filter(|x| whole(x)).count() + ordered;
    judge.at_most(
        "flow.vtp: numbers of points and bodies that are out of order",
        odd as f64,
        0.0,
        "they count from 0, body by body",
    );
    if frame == 0 {
        let mut next = BTreeMap::new();
        let counted: Vec<f64> = bodies
            .iter()
            .map(|b| {
                let n = next.entry(b.to_bits()).or_insert(-1.0);
                *n += 1.0;
                *n
            })
            .collect();
        judge.same(
            "flow.vtp: numbers of the points at release",
            &ids,
            &counted,
            within(0.0, "they count from 0", DEFINED),
        );
    }
    for (array, step) in [("connectivity", 0.0), ("offsets", 1.0)] {
        let counted: Vec<f64> = (0..ids.len()).map(|k| k as f64 + step).collect();
        judge.same(
            "flow.vtp: one vertex cell a point",
            &files.array(frame, array),
            &counted,
            within(0.0, "they count", "VTK file formats"),
        );
    }
}

fn energies(set: &Setting, files: &Files, row: usize, points: &[Point], judge: &mut Judge) {
    let get = |name: &str| pick(&files.column("energy.csv", name), row);
    let sum = |of: &dyn Fn(&Point) -> f64| points.iter().map(of).sum::<f64>();
    let same = |judge: &mut Judge, name: &str, made: f64, scale: f64| {
        judge.near(
            &format!("energy.csv: {name} against the points"),
            &[get(name)],
            &[made],
            scale,
            within(1e-8, SAME, DEFINED),
        );
    };
    let kinetic = sum(&|p| 0.5 * p.mass * p.speed().powi(2));
    same(judge, "kinetic_j", kinetic, kinetic);
    let gravitational = sum(&|p| p.mass * set.gravity * set.level(p.x));
    same(judge, "gravitational_j", gravitational, gravitational.abs());
    if set.boundaries.iter().all(|b| !b.slips) {
        let elastic = sum(&|p| set.stored(p));
        same(judge, "elastic_j", elastic, elastic);
    }
}

fn stations(set: &Setting, files: &Files, time: f64, points: &[Point], judge: &mut Judge) {
    let column = |name: &str| files.column("stations.csv", name);
    let [times, xs, depths, velocities] = ["time_s", "x_m", "depth_m", "velocity_m_per_s"].map(column);
    let wanted = (0..).map_while(|k| at(&set.case, &format!("gauges.stations_m.{k}"))).collect::<Vec<_>>();
    if wanted.is_empty() {
        return;
    }
    let rows: Vec<usize> = (0..times.len()).filter(|k| (times[*k] - time).abs() <= WRITTEN * time.max(0.01)).collect();
    let of = |values: &[f64]| rows.iter().map(|k| pick(values, *k)).collect::<Vec<_>>();
    judge.same(
        "stations.csv: places against the case",
        &of(&xs),
        &wanted,
        within(WRITTEN, "nine digits", "the case file"),
    );
    let near = |x: &f64| points.iter().filter(|p| (p.x[0] - x).abs() <= set.h).collect::<Vec<_>>();
    let depth = |x: &f64| {
        near(x).iter().map(|p| p.volume.min(p.volume / p.ratio * MOST)).sum::<f64>() / (2.0 * set.h * set.width)
    };
    let velocity = |x: &f64| {
        let (p, m) = near(x).iter().fold((0.0, 0.0), |(p, m), q| (p + q.mass * q.v[0], m + q.mass));
        if m > 0.0 { p / m } else { 0.0 }
    };
    judge.same(
        "stations.csv: depth against the points",
        &of(&depths),
        &wanted.iter().map(depth).collect::<Vec<_>>(),
        within(1e-8, SAME, DEFINED),
    );
    judge.same(
        "stations.csv: velocity against the points",
        &of(&velocities),
        &wanted.iter().map(velocity).collect::<Vec<_>>(),
        within(1e-8, SAME, DEFINED),
    );
}

/// Means by cell.
fn fields(set: &Setting, files: &Files, time: f64, points: &[Point], judge: &mut Judge) {
    if files.rows("field.csv") == 0 {
        return;
    }
    let times = files.column("field.csv", "time_s");
    let rows: Vec<usize> = (0..times.len()).filter(|k| (times[*k] - time).abs() <= WRITTEN * time.max(0.01)).collect();
    let wanted = (0..).map_while(|k| at(&set.case, &format!("gauges.field_times_s.{k}")));
    // A snapshot is due at the first step after its time, as a frame is.
    if !wanted.into_iter().any(|t| (0.0..2e-3).contains(&(time - t))) {
        return;
    }
    let mut cells: BTreeMap<[i64; 2], Vec<&Point>> = BTreeMap::new();
    let origin = [0, 1].map(|d| at(&set.case, &format!("grid.origin_m.{d}")).unwrap_or(0.0));
    let cell = |p: &Point| [0, 1].map(|d| ((p.x[d] - origin[d]) / set.h).floor() as i64);
    points.iter().for_each(|p| cells.entry(cell(p)).or_default().push(p));
    let mean = |cell: &[&Point], of: &dyn Fn(&Point) -> f64| {
        cell.iter().map(|p| p.mass * of(p)).sum::<f64>() / cell.iter().map(|p| p.mass).sum::<f64>()
    };
    let speed = |c: &[&Point]| mean(c, &|p| p.v[0]).hypot(mean(c, &|p| p.v[1]));
    let fill = |c: &[&Point]| {
        c.iter().map(|p| p.volume.min(p.volume / p.ratio * MOST)).sum::<f64>() / (set.h * set.h * set.width)
    };
    let mut same = |name: &str, made: Vec<f64>| {
        let values = files.column("field.csv", name);
        let found: Vec<f64> = rows.iter().map(|k| pick(&values, *k)).collect();
        judge.same(&format!("field.csv: {name} against the points"), &found, &made, within(1e-7, SAME, DEFINED));
    };
    same("x_m", cells.keys().map(|k| origin[0] + (k[0] as f64 + 0.5) * set.h).collect());
    same("y_m", cells.keys().map(|k| origin[1] + (k[1] as f64 + 0.5) * set.h).collect());
    same("solid_fraction", cells.values().map(|c| fill(c)).collect());
    same("velocity_x_m_per_s", cells.values().map(|c| mean(c, &|p| p.v[0])).collect());
    same("velocity_y_m_per_s", cells.values().map(|c| mean(c, &|p| p.v[1])).collect());
    same("speed_m_per_s", cells.values().map(|c| speed(c)).collect());
    same("pressure_pa", cells.values().map(|c| -mean(c, &Point::mean)).collect());
    same("plastic_shear_strain", cells.values().map(|c| mean(c, &|p| p.shear)).collect());
}
