//! Particle-steps per second: whole steps with boundaries, law and ledgers, output excluded.
//!
//!     cargo bench --bench steps                 # all of it
//!     cargo bench --bench steps -- flume        # one group
//!
//! Criterion prints the time for a few steps and the throughput in elements per second, an element being one particle-step. Before
//! each scene stands the memory a point takes.

mod scenes;

use checkdam::shape::ShapeFunction::{Bspline, Linear, Ugimp};
use checkdam::simulation::{Scheme, Simulation};
use criterion::measurement::WallTime;
use criterion::{BatchSize, BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};

/// Particle-steps of one measurement, about.
const WORK: u64 = 400_000;

fn measure(group: &mut BenchmarkGroup<'_, WallTime>, name: &str, start: &Simulation) {
    let points = start.particle_count() as u64;
    let steps = (WORK / points).max(2);
    group.throughput(Throughput::Elements(steps * points));
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool");
        group.bench_function(format!("{name}, {threads} threads"), |b| {
            let run = |mut simulation: Simulation| {
                pool.install(|| scenes::run(&mut simulation, steps));
                simulation
            };
            // The first step of a copy asks for the memory of the later ones.
            let warm = || {
                let mut simulation = start.clone();
                pool.install(|| scenes::run(&mut simulation, 1));
                simulation
            };
            b.iter_batched(warm, run, BatchSize::PerIteration);
        });
    }
    let grown = start.bytes() as f64 / points as f64;
    println!("{name}: {points} points, {:.0} bytes per point with its share of the grid", grown);
}

fn flume(c: &mut Criterion) {
    let mut group = c.benchmark_group("flume");
    group.sample_size(10);
    for (name, spacing) in [("20 mm", 0.02), ("10 mm", 0.01), ("5 mm", 0.005), ("2.5 mm", 0.0025)] {
        measure(&mut group, name, &scenes::flume(spacing));
    }
}

fn column(c: &mut Criterion) {
    let mut group = c.benchmark_group("column");
    group.sample_size(10);
    for (name, points) in [("4e3", 4_000), ("4e4", 40_000), ("1e5", 100_000), ("1e6", 1_000_000), ("4e6", 4_000_000)] {
        let mut start = scenes::column(points, Ugimp, Scheme::Musl);
        scenes::run(&mut start, 2);
        measure(&mut group, &format!("{name} points, uGIMP, MUSL"), &start);
    }
    for (name, shape, scheme) in [
        ("B-spline, MUSL", Bspline, Scheme::Musl),
        ("linear, MUSL", Linear, Scheme::Musl),
        ("uGIMP, USL", Ugimp, Scheme::Usl),
        ("uGIMP, USF", Ugimp, Scheme::Usf),
    ] {
        let mut start = scenes::column(40_000, shape, scheme);
        scenes::run(&mut start, 2);
        measure(&mut group, &format!("4e4 points, {name}"), &start);
    }
}

fn barrier(c: &mut Criterion) {
    let mut group = c.benchmark_group("sand and deformable barrier in contact");
    group.sample_size(10);
    for (name, spacing, implicit) in
        [("10 mm", 0.01, false), ("10 mm, implicit steps", 0.01, true), ("5 mm", 0.005, false)]
    {
        measure(&mut group, name, &scenes::barrier(spacing, implicit));
    }
}

criterion_group!(benches, barrier, column, flume);
criterion_main!(benches);
