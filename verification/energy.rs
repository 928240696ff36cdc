//! Energy of a vibrating bar: kept without PIC, and lost with it at the rate that theory gives; the ledger accounts for it.
//!
//! A bar with free ends and Poisson's ratio zero vibrates in its first mode at strains of 1e-5. PIC is measured on a standing
//! wave that spans many cells, where the ends do not matter much.

use super::report::{named_csv, table_csv};
use super::scene::{Brick, Material, scene};
use super::{Fault, FaultKind, Outcome, Rung, RungFailure};
use crate::figure::{Figure, curves, exact, measured};
use crate::of_module;
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::ledger::EnergyBalance;
use checkdam::plot::curves::Curves;
use checkdam::simulation::{PicShare, Scheme, Simulation};
use checkdam::theory::{bar, elastic, order, pic};

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "A vibrating bar keeps its energy without PIC and loses it at the predicted rate with PIC; the ledger closes",
    goal: "A bar keeps its energy without PIC, loses it with PIC at the predicted rate, and the ledger closes",
    source: "symplectic Euler; the share that PIC takes of a wave, theory::pic",
    sketch: r"
   +-----------------------------+
   | <- o o o o o | o o o o o -> |   first mode, free ends
   +-----------------------------+
   E(t) = E(0)                  alpha_PIC = 0
   E(t) = E(0) exp(-rate t)     alpha_PIC > 0
",
    run,
    covers: &[(FaultKind::Density, 1.03), (FaultKind::Modulus, 1.03)],
    under_fault: "all",
    figures: FIGURES,
};

/// Its figures.
const FIGURES: &[Figure] = &[
    curves(
        "energy_drift",
        "energy_drift_plot",
        Curves {
            x: "cfl",
            x_title: "c dt / h",
            y_title: "energy to and fro within a period, relative",
            curves: &[measured("energy_to_and_fro", ""), exact("energy_to_and_fro_exact", "w dt / 2")],
            split: &[("scheme", ""), ("cells", "cells ")],
            ..Curves::LOGARITHMIC
        },
    ),
    curves(
        "energy_pic_decay",
        "energy_pic_decay_plot",
        Curves {
            x: "kh",
            x_title: "wave number times cell size",
            y_title: "rate of decay (1/s)",
            curves: &[measured("rate_1_s", "standing wave"), exact("rate_exact_1_s", "a (1 - T²)/dt")],
            ..Curves::LINEAR
        },
    ),
];

const BAR: Material = Material::new(1e6, 0.0, 1500.0);
const LENGTH: f64 = 1.0;
const CELLS: usize = 25;

/// A bar of `cells` cells, `mode` half waves, a fixed time step, an amplitude of 1e-5 of the wave speed.
fn vibrating(cells: usize, mode: u32, dt: f64, share: f64, scheme: Scheme, fault: &Fault) -> Simulation {
    let h = LENGTH / cells as f64;
    let k = bar::free_wave_number(mode, LENGTH);
    let brick = Brick::new([0.3 * h, 0.2 * h], [cells, 2], h);
    let mut points = brick.points();
    for p in &mut points {
        p.v[0] = amplitude() * libm::cos(k * (p.x[0] - 0.3 * h));
    }
    let mut scene = scene(&brick, BAR.law(fault), BAR.density * fault.density, points, vec![]);
    scene.numerics.scheme = scheme;
    scene.numerics.pic = PicShare::Fraction(share);
    scene.numerics.max_time_step = dt;
    Simulation::new(scene)
}

fn amplitude() -> f64 {
    1e-5 * elastic::bar_speed(&BAR.elastic, BAR.density)
}

fn balance(sim: &Simulation) -> EnergyBalance {
    sim.energy_balance(&sim.stock(), [0.0, 0.0])
}

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let mut outcome = Outcome::default();
    period(fault, &mut outcome)?;
    drift(fault, &mut outcome)?;
    decay(fault, &mut outcome)?;
    damping(fault, &mut outcome)?;
    Ok(outcome)
}

/// Period from the zeros of the modal velocity; energy at the start.
fn period(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let speed = elastic::bar_speed(&BAR.elastic, BAR.density);
    let k = bar::free_wave_number(1, LENGTH);
    let exact = 2.0 * std::f64::consts::PI / bar::angular_frequency(k, speed);
    let cells = 2 * CELLS;
    let dt = 0.2 * LENGTH / cells as f64 / speed;
    let mut sim = vibrating(cells, 1, dt, 0.0, Scheme::Musl, fault);
    let mass = BAR.density * LENGTH * 2.0 * LENGTH / cells as f64 * super::scene::THICKNESS;
    outcome.check(
        Check::value("energy of the first mode", sim.opening().kinetic, bar::vibration_energy(mass, amplitude()), "J")
            .within(Tolerance::Relative(1e-12), "midpoint rule on a cosine over full half waves is exact")
            .from(Kind::Analytic, "rho A L v0^2 / 4"),
    );
    let (mut zeros, mut last) = (Vec::new(), 1.0);
    while zeros.len() < 21 {
        sim.step()?;
        let modal: f64 = sim.particles().map(|(_, p)| p.v[0] * libm::cos(k * p.x[0])).sum();
        let t = sim.time() - 0.5 * sim.time_step().dt;
        if modal * last < 0.0 {
            zeros.push(t - dt * modal / (modal - last));
        }
        last = modal;
        if sim.time() > 20.0 * exact {
            break;
        }
    }
    let measured = if zeros.len() == 21 { (zeros[20] - zeros[0]) / 10.0 } else { f64::NAN };
    outcome.check(
        Check::value("period of the first mode, mean of ten", measured, exact, "s")
            .within(
                Tolerance::Relative(0.002),
                "dispersion 0.13 (k h)^2 = 0.05 %, and as much again at each of the free ends",
            )
            .from(Kind::Analytic, "2 L / c"),
    );
    Ok(())
}

/// Energy without PIC, by scheme and time step: to and fro within a period, and from the first period to the tenth.
fn drift(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let speed = elastic::bar_speed(&BAR.elastic, BAR.density);
    let period = 2.0 * LENGTH / speed;
    let mut rows = Vec::new();
    for (index, (scheme, name)) in
        [(Scheme::Musl, "MUSL"), (Scheme::Usf, "USF"), (Scheme::Usl, "USL")].into_iter().enumerate()
    {
        let (mut sways, mut refined) = (Vec::new(), Vec::new());
        // Three time steps on one grid, then three grids at one Courant number.
        let finer = if scheme == Scheme::Musl { &[(2 * CELLS, 0.2), (4 * CELLS, 0.2)][..] } else { &[] };
        for &(cells, cfl) in [(CELLS, 0.4), (CELLS, 0.2), (CELLS, 0.1)].iter().chain(finer) {
            let h = LENGTH / cells as f64;
            let mut sim = vibrating(cells, 1, cfl * h / speed, 0.0, scheme, fault);
            let initial = balance(&sim).initial;
            let (mut sway, mut first, mut tenth) = (0.0f64, [0.0; 2], [0.0; 2]);
            while sim.time() < 10.0 * period {
                sim.step()?;
                let b = balance(&sim);
                let energy = (b.kinetic + b.elastic) / initial;
                if sim.time() < period {
                    sway = sway.max((energy - 1.0).abs());
                    first = [first[0] + energy, first[1] + 1.0];
                } else if sim.time() >= 9.0 * period {
                    tenth = [tenth[0] + energy, tenth[1] + 1.0];
                }
            }
            let b = balance(&sim);
            let drift = tenth[0] / tenth[1] - first[0] / first[1];
            let half_step = 0.5 * std::f64::consts::PI * cfl * h / LENGTH;
            let (residual, work) = (b.residual / initial, b.plastic / initial);
            rows.push(vec![index as f64, cells as f64, cfl, sway, half_step, drift, residual, work]);
            if cells == CELLS {
                sways.push(sway);
            }
            if cfl == 0.2 {
                refined.push(sway);
            }
            if cfl == 0.2 && scheme != Scheme::Usl {
                let name = format!("{name}, {cells} cells");
                outcome.check(
                    Check::value(format!("{name}, CFL 0.2: energy to and fro within a period"), sway, half_step, "1")
                        .within(
                            Tolerance::Relative(0.05),
                            "velocity and stress are half a step apart: w dt / 2 to first order",
                        )
                        .from(Kind::Analytic, "symplectic Euler"),
                );
                outcome.check(
                    Check::value(format!("{name}, CFL 0.2: energy of the tenth period less that of the first"), drift, 0.0, "1")
                        .within(Tolerance::Absolute(1e-4), "kept to the order above: (w dt / 2)^2 = 1.6e-4 to and fro, less than that in the mean of a period")
                        .from(Kind::Conservation, "an elastic bar keeps its energy"),
                );
                outcome.check(
                    Check::at_most(
                        format!("{name}, CFL 0.2: work of stresses not stored, over the energy"),
                        b.plastic.abs() / initial,
                        1e-4,
                        "1",
                    )
                    .because("the midpoint rule is exact for a linear law; strains of 1e-5 change volumes by as much")
                    .from(Kind::Conservation, "an elastic law dissipates nothing"),
                );
            }
        }
        for pair in sways.windows(2) {
            outcome.check(
                Check::value(
                    format!("{name}: observed order in dt of the energy to and fro"),
                    order::from_errors(pair[0], pair[1], 2.0),
                    1.0,
                    "1",
                )
                .within(Tolerance::Absolute(0.1), "first order: velocity and stress are half a step apart")
                .from(Kind::Convergence, "symplectic Euler; Bardenhagen 2002"),
            );
        }
        for (pair, grids) in refined.windows(2).zip(["25 to 50 cells", "50 to 100 cells"]) {
            outcome.check(
                Check::value(
                    format!("{name}: observed order in h of the energy to and fro at CFL 0.2, {grids}"),
                    order::from_errors(pair[0], pair[1], 2.0),
                    1.0,
                    "1",
                )
                .within(
                    Tolerance::Absolute(0.1),
                    "the step goes with the cell, and nothing else matters to first order",
                )
                .from(Kind::Convergence, "symplectic Euler; Bardenhagen 2002"),
            );
        }
    }
    let header = [
        "scheme",
        "cells",
        "cfl",
        "energy_to_and_fro",
        "energy_to_and_fro_exact",
        "energy_drift_in_9_periods",
        "residual",
        "work_not_stored",
    ];
    outcome.tables.push(("energy_drift".into(), named_csv(&header, &[("scheme", &["MUSL", "USF", "USL"])], rows)));
    Ok(())
}

/// A body that flies freely against mass-proportional damping: the velocity that is left, and what the ledger has of it.
fn damping(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let (rate, end) = (20.0, 0.05);
    let brick = Brick::new([0.0, 0.0], [4, 4], LENGTH / CELLS as f64);
    let mut points = brick.points();
    points.iter_mut().for_each(|p| p.v = [0.3, -0.4]);
    let mut sim = Simulation::new(scene(&brick, BAR.law(fault), BAR.density * fault.density, points, vec![]));
    sim.set_damping(rate);
    super::scene::run_until(&mut sim, end)?;
    let b = balance(&sim);
    let exact = libm::exp(-2.0 * rate * sim.time());
    outcome.check(
        Check::value("damped flight: kinetic energy left", b.kinetic / b.initial, exact, "1")
            .within(
                Tolerance::Relative(0.02),
                "steps of at most 1 ms: (1 - d dt)^n is off by d^2 dt t = 2 % in the energy",
            )
            .from(Kind::Analytic, "dv/dt = -d v"),
    );
    outcome.check(
        Check::value(
            "damped flight: loss by damping in the ledger over what is missing",
            b.damping / b.initial,
            1.0 - b.kinetic / b.initial,
            "1",
        )
        .within(Tolerance::Relative(1e-12), "a translation has no other mechanism: only round-off")
        .from(Kind::Conservation, "energy balance"),
    );
    Ok(())
}

/// Decay of a standing wave by PIC.
fn decay(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let speed = elastic::bar_speed(&BAR.elastic, BAR.density);
    let (cells, share) = (80, 0.02);
    let h = LENGTH / cells as f64;
    let dt = 0.2 * h / speed;
    let mut rows = Vec::new();
    for mode in [5u32, 9, 13] {
        let kh = bar::free_wave_number(mode, LENGTH) * h;
        let mut sim = vibrating(cells, mode, dt, share, Scheme::Musl, fault);
        let exact = pic::damping_rate(share, kh, dt, 2);
        // Whole periods of the wave, so that the energy is in the same state at both ends, near 0.7 of the time of decay.
        let wave = 2.0 * std::f64::consts::PI / (kh / h * speed);
        let periods = (0.7 / exact / wave).ceil();
        let end = periods * wave;
        let without = {
            let mut sim = vibrating(cells, mode, dt, 0.0, Scheme::Musl, fault);
            super::scene::run_until(&mut sim, end)?;
            let b = balance(&sim);
            (b.kinetic + b.elastic) / b.initial
        };
        super::scene::run_until(&mut sim, end)?;
        let b = balance(&sim);
        let left = (b.kinetic + b.elastic) / b.initial;
        let rate = -libm::log(left / without) / sim.time();
        rows.push(vec![kh, rate, exact, b.pic / b.initial, 1.0 - left, b.residual / b.initial]);
        outcome.check(
            Check::value(format!("k h = {kh:.3}: rate of decay by PIC"), rate, exact, "1/s")
                .within(
                    Tolerance::Relative(0.05),
                    "the ends take a share h/L of it, and the points have moved from where T holds",
                )
                .from(Kind::Analytic, "a (1 - T^2)/dt; a standing wave's energy decays at the rate of the velocity"),
        );
        outcome.check(
            Check::value(
                format!("k h = {kh:.3}: loss by PIC in the ledger over what is missing"),
                b.pic / b.initial,
                1.0 - left,
                "1",
            )
            .within(
                Tolerance::Absolute(0.1 * kh),
                "the rest is the residual of the time scheme, w dt / 2 to and fro at CFL 0.2",
            )
            .from(Kind::Conservation, "energy balance"),
        );
    }
    let header = ["kh", "rate_1_s", "rate_exact_1_s", "pic_loss_in_ledger", "energy_missing", "residual"];
    outcome.tables.push(("energy_pic_decay".into(), table_csv(&header, rows)));
    Ok(())
}
