//! A bar fixed at one end and free at the other, in its first mode (Bardenhagen 2002; parameters after Buzzi et al. 2008).

use crate::report::table_csv;
use crate::scene::{Brick, Material, centre, scene};
use crate::{Fault, Outcome, RungFailure};
use checkdam::boundary::{Boundary, Friction};
use checkdam::check::{Check, Expected, Kind, Tolerance};
use checkdam::simulation::Simulation;
use checkdam::theory::elastic::bar_speed;
use checkdam::theory::order;
use nalgebra::Vector2;
use std::f64::consts::PI;

const BAR: Material = Material::new(100.0, 0.0, 1.0);
const LENGTH: f64 = 25.0;
const VELOCITY: f64 = 0.1;
const GRIDS: [usize; 3] = [13, 26, 52];
const PERIODS: usize = 5;

/// Period (s), and total energy in the last period over that in the first.
fn vibrate(cells: usize, fault: &Fault) -> Result<[f64; 2], RungFailure> {
    let h = LENGTH / cells as f64;
    let brick = Brick::new([0.0, 0.0], [cells, 2], h);
    let mut points = brick.points();
    for p in &mut points {
        p.v[0] = VELOCITY * libm::sin(0.5 * PI / LENGTH * p.x[0]);
    }
    let clamp = Boundary::plane("clamp", Vector2::zeros(), Vector2::new(1.0, 0.0), Friction::Bonded);
    let mut scene = scene(&brick, BAR.law(fault), BAR.density * fault.density, points, vec![clamp]);
    let speed = bar_speed(&BAR.elastic, BAR.density);
    let exact = 4.0 * LENGTH / speed;
    scene.numerics.max_time_step = 0.2 * h / speed;
    let mut sim = Simulation::new(scene);
    let (mut zeros, mut last, mut energy) = (Vec::new(), [0.0, 1.0], [[0.0; 2]; 2]);
    while sim.time() < (PERIODS as f64 + 0.5) * exact {
        sim.step()?;
        // Velocities belong to the middle of the step.
        let now = [sim.time() - 0.5 * sim.time_step().dt, centre(&sim).1[0]];
        if now[1] * last[1] < 0.0 {
            zeros.push(now[0] - (now[0] - last[0]) * now[1] / (now[1] - last[1]));
        }
        last = now;
        let stock = sim.stock();
        let period = sim.time() / exact;
        if period < 1.0 || (period >= PERIODS as f64 - 1.0 && period < PERIODS as f64) {
            let sum = &mut energy[if period < 1.0 { 0 } else { 1 }];
            *sum = [sum[0] + stock.kinetic + stock.elastic, sum[1] + 1.0];
        }
    }
    let mean = |e: [f64; 2]| e[0] / e[1];
    let period = if zeros.len() >= 2 * PERIODS {
        2.0 * (zeros[zeros.len() - 1] - zeros[0]) / (zeros.len() - 1) as f64
    } else {
        f64::NAN
    };
    Ok([period, mean(energy[1]) / mean(energy[0])])
}

/// Three grids.
pub fn run(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let exact = 4.0 * LENGTH / bar_speed(&BAR.elastic, BAR.density);
    let results = GRIDS.iter().map(|&n| vibrate(n, fault)).collect::<Result<Vec<_>, _>>()?;
    for (cells, [period, energy]) in GRIDS.into_iter().zip(&results) {
        let h = 1.0 / cells as f64;
        outcome.check(
            Check::value(format!("fixed bar, {cells} cells: period"), *period, exact, "s")
                .within(
                    Tolerance::Relative(0.1 * h),
                    "free end and clamp out of place by less than a tenth of a cell in all; 0.2 % at 52 cells",
                )
                .from(Kind::Analytic, "4 L / c"),
        );
        outcome.check(
            Check::value(
                format!("fixed bar, {cells} cells: energy in the fifth period over that in the first"),
                *energy,
                1.0,
                "1",
            )
            .within(
                Tolerance::Absolute(0.005),
                "no PIC: what is lost goes to motion that nodes do not see, at most 0.1 % a period",
            )
            .from(Kind::Conservation, "an elastic bar keeps its energy"),
        );
    }
    let errors: Vec<f64> = results.iter().map(|r| (r[0] / exact - 1.0).abs()).collect();
    let rows = GRIDS.iter().zip(&results).map(|(&n, r)| vec![n as f64, r[0], exact, r[1]]);
    let header = ["cells", "period_s", "period_exact_s", "energy_fifth_over_first_period"];
    outcome.tables.push(("manufactured_bar".into(), table_csv(&header, rows)));
    outcome.check(
        Check::new(
            "fixed bar: observed order of the period, 13 to 52 cells",
            order::from_errors(errors[0], errors[2], 4.0),
            Expected::AtLeast(0.75),
            "1",
        )
        .because("second order inside, first order at the ends")
        .from(Kind::Convergence, "dispersion of the scheme and places of the ends"),
    );
    Ok(())
}
