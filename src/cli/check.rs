//! `checkdam check`.

use super::progress::remaining;
use super::{ENDED_EARLY, load, say, tell, use_threads};
use checkdam::run::scene;
use checkdam::simulation::Simulation;
use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// How long the speed of this machine is measured.
const TRIAL: Duration = Duration::from_millis(400);

pub fn check(path: &Path, threads: Option<u16>) -> ExitCode {
    let case = match load(path) {
        Ok(case) => case,
        Err(code) => return code,
    };
    use_threads(threads);
    let mut sim = Simulation::new(scene::build(&case));
    let step = sim.time_step();
    let stages = &case.stages;
    let tilt = stages.tilt.as_ref().map_or(0.0, |t| t.duration_s);
    let steps = (stages.run.end_time_s + tilt) / step.dt;

    say!("{}: {} is valid", path.display(), case.title);
    say!(
        "  {} material points of {:.4e} kg, {:.3} kg in all; {} grid nodes active of cell size {} m",
        sim.particle_count(),
        sim.mass() / sim.particle_count() as f64,
        sim.mass(),
        sim.node_count(),
        sim.spacing()
    );
    say!("  time step {:.3e} s, limited by {}", step.dt, sim.describe_limit(&step));
    say!(
        "  at most {steps:.3e} steps for {} s of tilting and {} s of flow, besides settling",
        tilt,
        stages.run.end_time_s
    );
    say!("  memory {:.1} MB", sim.bytes() as f64 / 1e6);

    let start = Instant::now();
    let mut trial = 0u32;
    let failure = rayon::scope(|_| {
        while start.elapsed() < TRIAL {
            if let Err(failure) = sim.step() {
                return Some(failure);
            }
            trial += 1;
        }
        None
    });
    if let Some(failure) = failure {
        tell!("error: a run would fail: {failure}");
        return ExitCode::from(ENDED_EARLY);
    }
    let per_step = start.elapsed().as_secs_f64() / f64::from(trial.max(1));
    say!(
        "  expected time: at most {} ({:.1} million particle-steps per second, measured over {trial} steps on {} threads)",
        remaining(per_step * steps),
        sim.particle_count() as f64 / per_step / 1e6,
        rayon::current_num_threads()
    );
    ExitCode::SUCCESS
}
