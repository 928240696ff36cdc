//! `checkdam run`.

use super::progress::Display;
use super::{BAD_INPUT, ENDED_EARLY, NOT_TRUSTED, load, say, stop_on_ctrl_c, tell, use_threads};
use checkdam::run::{self, Progress, Summary, files};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::Ordering;
use std::time::Instant;

pub fn run(path: &Path, out: Option<PathBuf>, threads: Option<u16>, force: bool) -> ExitCode {
    let case = match load(path) {
        Ok(case) => case,
        Err(code) => return code,
    };
    let directory = out.unwrap_or_else(|| Path::new("out").join(path.file_stem().unwrap_or_default()));
    let claim = match files::Claim::new(&directory, force) {
        Ok(claim) => claim,
        Err(message) => {
            tell!("error: {message}");
            return ExitCode::from(BAD_INPUT);
        }
    };
    use_threads(threads);

    let stop = stop_on_ctrl_c("stopping: writing what was computed (Ctrl-C again to quit at once)");
    let mut display = Display::new();
    let start = Instant::now();
    let mut steps = (0u64, 0usize);
    let mut stopped = false;
    let mut progress = |p: &Progress| {
        steps = (p.steps, p.particles);
        display.show(p);
        stopped = stop.load(Ordering::SeqCst);
        !stopped
    };
    let result = run::run_claimed(&case, claim, &mut progress);
    display.clear();
    let seconds = start.elapsed().as_secs_f64();
    match result {
        Ok(summary) => {
            report(&summary, &directory);
            say!(
                "{:.1} s of wall time, {} steps, {:.1} million particle-steps per second",
                seconds,
                steps.0,
                steps.0 as f64 * steps.1 as f64 / seconds / 1e6
            );
            match () {
                () if stopped => ExitCode::from(ENDED_EARLY),
                () if summary.trusted => ExitCode::SUCCESS,
                () => ExitCode::from(NOT_TRUSTED),
            }
        }
        Err(error) => {
            tell!("error: {error}");
            if directory.is_dir() {
                tell!("what was computed is in {}", directory.display());
            }
            ExitCode::from(ENDED_EARLY)
        }
    }
}

/// The main results, for someone who looks at the terminal only.
fn report(summary: &Summary, directory: &Path) {
    if !summary.trusted {
        say!("NOT TO BE TRUSTED:");
        summary.reasons.iter().for_each(|reason| say!("  {reason}"));
    }
    say!("{}: {}", summary.case.title, summary.status);
    for f in &summary.front {
        say!(
            "  front at {:.2} m: t = {:.3} s, {:.2} m/s, depth {:.3} m, Froude number {:.1}",
            f.x_m,
            f.time_s,
            f.velocity_m_per_s,
            f.depth_m,
            f.froude_1
        );
    }
    if let Some(b) = &summary.barrier {
        if let Some(t) = b.arrival_s {
            say!("  arrival at the barrier: t = {t:.3} s");
        }
        say!(
            "  peak force: {:.1} N in a single step (t = {:.4} s), {:.1} N over 20 ms (t = {:.3} s)",
            b.peak_step_n,
            b.peak_step_time_s,
            b.peak_20ms_n,
            b.peak_20ms_time_s
        );
        if let (Some(alpha), Some(elastic)) = (b.peak_20ms_alpha_1, b.elastic_impact_n) {
            say!(
                "  that is {alpha:.2} rho v^2 h b of the front; an elastic body of its section would give rho c v h b = {elastic:.1} N"
            );
        }
        say!(
            "  static force: {:.1} N (from the stress of 1, 2, 3 layers: {:.1}, {:.1}, {:.1} N), acting {:.3} m above the foot",
            b.static_force_n,
            b.static_layer1_n,
            b.static_layer2_n,
            b.static_layer3_n,
            b.static_height_of_action_m
        );
        say!(
            "  run-up: {:.3} m (95 % of the points at the wall), highest point {:.3} m; over the barrier: {:.4} kg; past it: {:.4} kg",
            b.run_up_p95_m,
            b.run_up_m,
            b.overtopped_kg,
            b.passed_kg
        );
    }
    if let Some(d) = &summary.deposit {
        let limits = d.equilibrium_limits_n.map(|[low, high]| format!("; equilibrium allows {low:.1} to {high:.1} N"));
        say!(
            "  at the end: m g sin = {:.1} N, base friction {:.1} of +-{:.1} N (mobilised share {:.2}){}",
            d.weight_along_n,
            d.base_friction_n,
            d.friction_limit_n,
            d.mobilised_1,
            limits.unwrap_or_default()
        );
    }
    let e = &summary.energy;
    say!(
        "  energy: E0 = {:.1} J; {:.1} % gravitational, {:.1} % plastic, {:.1} % friction at the end; residual {:.3} % (largest {:.3} %)",
        e.initial_j,
        100.0 * e.gravitational_1,
        100.0 * e.plastic_1,
        100.0 * e.friction_1,
        100.0 * e.residual_end_1,
        100.0 * e.energy_residual_1
    );
    say!("  momentum closes to {:.1e} of all impulses", summary.momentum.momentum_closure_1);
    for warning in &summary.warnings {
        say!("  note: {warning}");
    }
    let frames = if summary.case.output.vtk_interval_s > 0.0 { ", flow.pvd for ParaView" } else { "" };
    say!("results in {}: summary.toml, tables, figures{frames}", directory.display());
}
