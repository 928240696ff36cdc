//! A row of samples, made anew from the points of the frame of the same moment.

use super::judge::{Judge, within};
use super::rows::{DEFINED, MOST, SAME, pick};
use super::setting::{BoundaryOf, Point, Setting, at};
use crate::from_file::Files;
use std::collections::BTreeMap;

/// A row of samples.
pub fn judge(set: &Setting, files: &Files, row: usize, points: &[Point], judge: &mut Judge) {
    let mut same = |file: &str, name: &str, made: f64, scale: f64| {
        let found = pick(&files.column(file, name), row);
        let table = if file.starts_with("history") { "history.csv" } else { "window_NAME.csv" };
        judge.near(
            &format!("{table}: {name} against the points"),
            &[found],
            &[made],
            scale.abs(),
            within(1e-7, SAME, DEFINED),
        );
    };
    let kinetic = points.iter().map(|p| 0.5 * p.mass * p.speed().powi(2)).sum::<f64>();
    same("history.csv", "kinetic_j", kinetic, kinetic);
    let deepest = set
        .boundaries
        .iter()
        .filter(|b| !b.gate && !b.bonded)
        .flat_map(|b| points.iter().map(|p| depth_inside(b, p.x)));
    let deepest = deepest.fold(0.0, f64::max);
    same("history.csv", "penetration_m", deepest, deepest);
    for (k, name) in set.barriers.iter().enumerate() {
        let Some(b) = set.boundary(name).filter(|b| !b.gate) else { continue };
        let file = if k == 0 { "history.csv".to_string() } else { format!("history_{name}.csv") };
        let layers = layers(set, b, points);
        for (k, force) in layers.into_iter().enumerate() {
            same(&file, &format!("force_layer{}_n", k + 1), force, layers[0].abs().max(layers[2].abs()));
        }
        let beside = |p: &&Point| (-set.h..=1.5 * set.h).contains(&b.face(p.x)[0]);
        let mut heights: Vec<f64> = points.iter().filter(beside).map(|p| b.face(p.x)[1]).collect();
        heights.sort_unstable_by(f64::total_cmp);
        let top = heights.last().map_or(0.0, |h| h.max(0.0));
        let rank = (heights.len() as f64 * 0.95).ceil() as usize;
        let p95 = if heights.len() < 20 { 0.0 } else { heights[rank.max(1) - 1].max(0.0) };
        same(&file, "run_up_m", top, top);
        same(&file, "run_up_p95_m", p95, p95);
    }
    for (file, key, x, y) in windows(set) {
        let inside = |p: &&Point| (x[0]..=x[1]).contains(&p.x[0]) && (y[0]..=y[1]).contains(&p.x[1]);
        let mut speeds: Vec<f64> = points.iter().filter(inside).map(Point::speed).collect();
        speeds.sort_unstable_by(f64::total_cmp);
        let n = speeds.len();
        let mean = if n > 0 { speeds.iter().sum::<f64>() / n as f64 } else { 0.0 };
        let p95 = if n > 0 { speeds[((n - 1) as f64 * 0.95).round() as usize] } else { 0.0 };
        same(&file, &format!("{key}speed_mean_m_per_s"), mean, mean);
        same(&file, &format!("{key}speed_p95_m_per_s"), p95, p95);
    }
    front(set, files, row, points, judge);
}

/// Files and edges of all windows.
fn windows(set: &Setting) -> Vec<(String, &'static str, [f64; 2], [f64; 2])> {
    let edges = |key: &str| Some([at(&set.case, &format!("{key}.0"))?, at(&set.case, &format!("{key}.1"))?]);
    let named = |k: usize| {
        let name = super::setting::find(&set.case, &format!("gauges.windows.{k}.name"))?.as_str()?;
        Some((
            format!("window_{name}.csv"),
            "window_",
            edges(&format!("gauges.windows.{k}.x_m"))?,
            edges(&format!("gauges.windows.{k}.y_m"))?,
        ))
    };
    let first = edges("gauges.window_x_m")
        .zip(edges("gauges.window_y_m"))
        .map(|(x, y)| ("history.csv".into(), "window_", x, y));
    first.into_iter().chain((0..).map_while(named)).collect()
}

fn depth_inside(b: &BoundaryOf, x: [f64; 2]) -> f64 {
    let [d, s] = b.face(x);
    if b.height.is_infinite() { -d } else { (-d).min(b.thickness + d).min(s).min(b.height - s) }
}

/// Force on a face from the nearest one, two and three layers of points: pressure times volume over their thickness, by cells of height.
fn layers(set: &Setting, b: &BoundaryOf, points: &[Point]) -> [f64; 3] {
    let near = |p: &&Point| {
        let [d, s] = b.face(p.x);
        (-set.h..=3.0 * set.h).contains(&d) && (0.0..=b.height).contains(&s)
    };
    let mut bins: BTreeMap<usize, Vec<&Point>> = BTreeMap::new();
    points.iter().filter(near).for_each(|p| bins.entry((b.face(p.x)[1] / set.h) as usize).or_default().push(p));
    let mut force = [0.0; 3];
    for bin in bins.values() {
        let first = bin.iter().map(|p| b.face(p.x)[0]).fold(f64::INFINITY, f64::min);
        for p in bin.iter().filter(|_| first <= set.h) {
            let [nx, ny] = b.normal;
            let pressure = -(nx * nx * p.stress[0] + ny * ny * p.stress[1] + 2.0 * nx * ny * p.stress[3]);
            for (k, force) in force.iter_mut().enumerate() {
                let thickness = (k + 1) as f64 * p.spacing;
                if b.face(p.x)[0] < first - 0.5 * p.spacing + thickness {
                    *force += pressure * p.volume / thickness;
                }
            }
        }
    }
    force
}

fn front(set: &Setting, files: &Files, row: usize, points: &[Point], judge: &mut Judge) {
    if points.is_empty() {
        // The cells are empty.
        let names = ["front_x_m", "front_edge_x_m", "front_velocity_m_per_s"];
        let told = names.iter().filter(|name| !pick(&files.column("history.csv", name), row).is_nan()).count();
        judge.at_most("history.csv: numbers of a front where nothing flows", told as f64, 0.0, "there is no front");
        return;
    }
    let way = set.way();
    let length = at(&set.case, "gauges.front_length_m").unwrap_or(0.158 * set.area().sqrt());
    let mut ahead: Vec<&Point> = points.iter().collect();
    ahead.sort_by(|a, b| (way * b.x[0]).total_cmp(&(way * a.x[0])));
    let total: f64 = ahead.iter().map(|p| p.mass).sum();
    let mut passed = 0.0;
    let first = ahead.iter().find(|p| {
        passed += p.mass;
        passed >= 0.01 * total
    });
    let x = first.map_or(0.0, |p| way * p.x[0]);
    let edge = ahead.first().map_or(0.0, |p| way * p.x[0]);
    let head = ahead.iter().filter(|p| way * p.x[0] >= x - length);
    let (momentum, mass) = head.fold((0.0, 0.0), |(q, m), p| (q + way * p.mass * p.v[0], m + p.mass));
    let strip = 2.0 * set.h;
    let strips = (2.0 * length / strip).round().max(1.0);
    let mut volumes = vec![0.0; strips as usize];
    for p in &ahead {
        let behind = x - way * p.x[0];
        if (0.0..strips * strip).contains(&behind) {
            let k = ((behind / strip) as usize).min(volumes.len() - 1);
            volumes[k] += p.volume.min(p.volume / p.ratio * MOST);
        }
    }
    let depth = volumes.iter().fold(0.0, |a: f64, v| a.max(*v)) / (strip * set.width);
    let velocity = if mass > 0.0 { momentum / mass } else { 0.0 };
    let made = [
        ("front_x_m", way * x),
        ("front_edge_x_m", way * edge),
        ("front_velocity_m_per_s", velocity),
        ("front_depth_m", depth),
    ];
    for (name, made) in made {
        let found = pick(&files.column("history.csv", name), row);
        judge.near(
            &format!("history.csv: {name} against the points"),
            &[found],
            &[made],
            made.abs(),
            within(1e-7, SAME, DEFINED),
        );
    }
}
