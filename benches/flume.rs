//! Particle-steps per second of the 40 degree flume, whole steps with boundaries, law and ledgers, output excluded.
//!
//!     cargo bench --bench flume
//!
//! Measured in mid-flow, 0.5 s after release, when all of the sand moves. Criterion prints the time for 50 steps and the
//! throughput in elements per second, an element being one particle-step.

use checkdam::run::Experiment;
use checkdam::simulation::Simulation;
use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use std::path::Path;

const STEPS: u64 = 50;

fn in_mid_flow(spacing: f64) -> Simulation {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/flume/40deg.toml");
    let mut case = checkdam::case::load(&path).expect("the case is valid").case;
    case.grid.spacing_m = spacing;
    let mut experiment = Experiment::new(&case);
    experiment.prepare(&mut |_| true).expect("the sand settles");
    let mut simulation = experiment.release().clone();
    while simulation.time() < 0.5 {
        simulation.step().expect("a step");
    }
    simulation
}

fn flume(c: &mut Criterion) {
    let mut group = c.benchmark_group("flume 40 deg");
    group.sample_size(20);
    for (name, spacing) in [("20 mm", 0.02), ("10 mm", 0.01), ("5 mm", 0.005)] {
        let start = in_mid_flow(spacing);
        group.throughput(Throughput::Elements(STEPS * start.particle_count() as u64));
        for threads in [1, 2] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool");
            group.bench_function(format!("{name}, {threads} threads"), |b| {
                let run = |mut simulation: Simulation| {
                    pool.install(|| {
                        for _ in 0..STEPS {
                            simulation.step().expect("a step");
                        }
                    });
                    simulation
                };
                b.iter_batched(|| start.clone(), run, BatchSize::LargeInput);
            });
        }
    }
    group.finish();
}

criterion_group!(benches, flume);
criterion_main!(benches);
