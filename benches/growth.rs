//! How time and memory grow with the number of material points, over three decades, on one thread and on two.
//!
//!     cargo bench --bench growth               # print
//!     cargo bench --bench growth -- --write    # and write benches/growth.csv and the figure beside it
//!
//! Rounds go through all sizes and thread counts in turn, so that what else the machine does falls on all of them; the median of
//! the rounds is given. For a quiet machine.

mod scenes;

use checkdam::plot::curves::{self, Curve, Curves};
use checkdam::shape::ShapeFunction::Ugimp;
use checkdam::simulation::{Scheme, Simulation};
use std::path::Path;
use std::time::Instant;

const POINTS: [usize; 7] = [4_000, 12_000, 40_000, 120_000, 400_000, 1_200_000, 4_000_000];
const THREADS: [usize; 2] = [1, 2];
const ROUNDS: usize = 7;
/// Particle-steps of one measurement, about.
const WORK: usize = 4_000_000;

#[derive(Debug, serde::Serialize)]
struct Row {
    points: usize,
    bytes_per_point: f64,
    step_ms_1_thread: f64,
    step_ms_2_threads: f64,
    million_per_s_1_thread: f64,
    million_per_s_2_threads: f64,
    speedup_1: f64,
}

/// Seconds a step of what stands there.
fn seconds(simulation: &mut Simulation, pool: &rayon::ThreadPool) -> f64 {
    let steps = (WORK / simulation.particle_count()).max(2) as u64;
    pool.install(|| {
        let start = Instant::now();
        scenes::run(simulation, steps);
        start.elapsed().as_secs_f64() / steps as f64
    })
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut scenes = POINTS.map(|n| scenes::column(n, Ugimp, Scheme::Musl));
    let mut times = POINTS.map(|_| [const { Vec::new() }; 2]);
    for _ in 0..ROUNDS {
        for (scene, times) in scenes.iter_mut().zip(&mut times) {
            for (threads, times) in THREADS.into_iter().zip(times) {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
                times.push(seconds(scene, &pool));
            }
        }
    }
    println!("{:>9} {:>12} {:>12} {:>12} {:>8}", "points", "bytes/point", "M/s, 1", "M/s, 2", "speed-up");
    let rows = scenes.iter().zip(times).map(|(scene, [one, two])| {
        let (points, one, two) = (scene.particle_count(), median(one), median(two));
        let rate = |t: f64| points as f64 / t * 1e-6;
        let row = Row {
            points,
            bytes_per_point: scene.bytes() as f64 / points as f64,
            step_ms_1_thread: 1e3 * one,
            step_ms_2_threads: 1e3 * two,
            million_per_s_1_thread: rate(one),
            million_per_s_2_threads: rate(two),
            speedup_1: one / two,
        };
        let [a, b] = [row.million_per_s_1_thread, row.million_per_s_2_threads];
        println!("{points:9} {:12.0} {a:12.1} {b:12.1} {:8.2}", row.bytes_per_point, row.speedup_1);
        row
    });
    let rows: Vec<Row> = rows.collect();
    if !std::env::args().any(|a| a == "--write") {
        return Ok(());
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches");
    let mut writer = csv::Writer::from_path(folder.join("growth.csv"))?;
    for row in &rows {
        writer.serialize(row)?;
    }
    writer.flush()?;
    curves::draw(folder.join("growth.csv"), &STEP, folder.join("growth.svg"))?;
    Ok(())
}

const STEP: Curves = Curves {
    x: "points",
    x_title: "material points",
    y_title: "time of a step (ms)",
    curves: &[
        Curve { column: "step_ms_1_thread", label: "one thread", exact: false },
        Curve { column: "step_ms_2_threads", label: "two threads", exact: false },
    ],
    ..Curves::LOGARITHMIC
};
