//! Rotation: its velocity field strains nothing, and a spinning body keeps its angular momentum, size and energy.

use super::super::report::table_csv;
use super::super::scene::{Brick, Material, points_by_number, run_until, scene};
use super::super::{Fault, Outcome};
use super::ROUND_OFF;
use crate::RungFailure;
use checkdam::body::Particle;
use checkdam::check::{Check, Expected, Kind, Tolerance};
use checkdam::simulation::Simulation;
use checkdam::theory::{elastic, order};

const DISK: Material = Material::new(1e6, 0.3, 1000.0);
const RADIUS: f64 = 0.4;
/// Revolutions: stops where the disk's axes point nowhere near where they started.
const TURNS: f64 = 0.35;

/// Points of a disk about the origin, spinning at `rate` (rad/s).
fn disk(brick: &Brick, rate: f64) -> Vec<Particle> {
    let mut points: Vec<Particle> = brick.points().into_iter().filter(|p| p.x[0].hypot(p.x[1]) <= RADIUS).collect();
    for (id, p) in points.iter_mut().enumerate() {
        p.id = id as u32;
        p.v = [-rate * p.x[1], rate * p.x[0]];
    }
    points
}

/// Angular momentum per mass about the origin (m2/s), mean square radius (m2).
fn moments(sim: &Simulation) -> (f64, f64) {
    let (mut l, mut r2, mut n) = (0.0, 0.0, 0.0);
    for p in points_by_number(sim) {
        l += p.x[0] * p.v[1] - p.x[1] * p.v[0];
        r2 += p.x[0] * p.x[0] + p.x[1] * p.x[1];
        n += 1.0;
    }
    (l / n, r2 / n)
}

pub fn run(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let rate = 0.05 * elastic::confined_speed(&DISK.elastic, DISK.density) / RADIUS;
    let stretch = DISK.density * rate * rate * RADIUS * RADIUS / DISK.elastic.young;
    let source = "rigid rotation of a free body";
    let (mut losses, mut rows) = (Vec::new(), Vec::new());
    for cells in [4usize, 8, 16] {
        let h = RADIUS / cells as f64;
        let brick = Brick::new([-RADIUS, -RADIUS], [2 * cells, 2 * cells], h);
        let mut sim = Simulation::new(scene(&brick, DISK.law(fault), DISK.density, disk(&brick, rate), vec![]));
        let (l0, r0) = moments(&sim);
        sim.step()?;
        if cells == 8 {
            // Points whose nodes are all surrounded by points see the rotation exactly.
            let inside = points_by_number(&sim).into_iter().filter(|p| p.x[0].hypot(p.x[1]) < RADIUS - 3.0 * h);
            let stress = inside.map(|p| p.state.stress).fold(0.0f64, |a, s| {
                [s.xx, s.yy, s.zz, s.xy].iter().fold(a, |b, c| b.max(c.abs() / DISK.elastic.young))
            });
            outcome.check(
                Check::at_most("spinning disk: stress after one step inside, over Young's modulus", stress, 1e-14, "1")
                    .because(ROUND_OFF)
                    .from(Kind::Manufactured, "rigid rotation has no strain rate"),
            );
        }
        run_until(&mut sim, TURNS * 2.0 * std::f64::consts::PI / rate)?;
        let (l, r) = moments(&sim);
        // A step moves a point along its tangent, which takes it outwards: r^2 grows by (w dt)^2 a step.
        let outwards = rate * rate * sim.time_step().dt * sim.time();
        outcome.check(
            Check::value(format!("spinning disk, R/h = {cells}: growth of the mean square radius"), r / r0 - 1.0, outwards, "1")
                .within(
                    Tolerance::Absolute(2.0 * stretch),
                    "beside the step along the tangent there is the centrifugal strain, at most twice rho w^2 R^2 / E when released",
                )
                .from(Kind::Analytic, "forward Euler on a circle: w^2 dt t"),
        );
        losses.push((l / l0 - 1.0).abs());
        rows.push(vec![cells as f64, l / l0 - 1.0, r / r0 - 1.0, outwards]);
    }
    for (pair, cells) in losses.windows(2).zip([8, 16]) {
        outcome.check(
            Check::new(
                format!("spinning disk: observed order of the angular momentum, up to R/h = {cells}"),
                order::from_errors(pair[0], pair[1], 2.0),
                Expected::AtLeast(1.5),
                "1",
            )
            .because("second order, where a staircase of a boundary allows; less than 1.5 would be another order")
            .from(Kind::Convergence, source),
        );
    }
    outcome.check(
        Check::at_most(format!("spinning disk, R/h = 16: loss of angular momentum in {TURNS} revolutions"), losses[2], 0.01, "1")
            .because("the boundary ring, where points do not surround the nodes, errs by (h/R)^2 = 0.4 % of the momentum a radian or so")
            .from(Kind::Conservation, source),
    );
    let header =
        ["cells_per_radius", "angular_momentum_change", "square_radius_growth", "square_radius_growth_forward_euler"];
    outcome.tables.push(("exactness_spinning_disk".into(), table_csv(&header, rows)));
    Ok(())
}
