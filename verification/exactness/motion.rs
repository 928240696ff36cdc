//! Motion that strains nothing: translation and free fall; and momentum with everything switched on.

use super::super::scene::{Brick, Material, centre, points_by_number, run_until, scene};
use super::super::{Fault, Outcome};
use super::ROUND_OFF;
use crate::RungFailure;
use checkdam::boundary::{Boundary, Friction};
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::constitutive::{AnyLaw, Cone, DruckerPrager};
use checkdam::simulation::Simulation;
use checkdam::theory::{order, sliding_block};
use nalgebra::Vector2;

const SAND: Material = Material::new(1e6, 0.3, 1500.0);
const H: f64 = 0.02;

/// A block flies across ten cells at a speed that no grid likes.
pub fn translation(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let brick = Brick { per_cell: 3, ..Brick::new([0.0071, 0.0133], [6, 5], H) };
    let velocity = [1.37, 0.713];
    let mut points = brick.points();
    points.iter_mut().for_each(|p| p.v = velocity);
    let mut sim = Simulation::new(scene(&brick, SAND.law(fault), SAND.density, points, vec![]));
    let before = centre(&sim).0;
    run_until(&mut sim, 10.0 * H / velocity[0])?;
    let (mut stress, mut speed) = (0.0f64, 0.0f64);
    for p in points_by_number(&sim) {
        let s = p.state.stress;
        stress = [s.xx, s.yy, s.zz, s.xy].iter().fold(stress, |a, b| a.max(b.abs() / SAND.elastic.young));
        speed = speed.max((p.v[0] - velocity[0]).abs()).max((p.v[1] - velocity[1]).abs());
    }
    let source = "Galilei: uniform motion strains nothing";
    let moved = centre(&sim).0[0] - before[0] - velocity[0] * sim.time();
    for (what, measured, unit) in [
        ("translation: largest stress over Young's modulus", stress, "1"),
        ("translation: largest error of velocity", speed, "m/s"),
        ("translation: error of position after ten cells", moved.abs(), "m"),
    ] {
        outcome.check(Check::at_most(what, measured, 1e-12, unit).because(ROUND_OFF).from(Kind::Conservation, source));
    }
    let momentum = sim.stock().momentum;
    let exact = SAND.density * 6.0 * 5.0 * H * H * super::super::scene::THICKNESS;
    outcome.check(
        Check::value("translation: momentum along x", momentum[0], exact * velocity[0], "N s")
            .within(Tolerance::Relative(1e-12), ROUND_OFF)
            .from(Kind::Conservation, source),
    );
    Ok(())
}

/// A block falls: against the recursion of the scheme to round-off, against the parabola to first order.
pub fn free_fall(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let brick = Brick::new([0.003, 1.0], [4, 4], H);
    let (g, time) = (9.81, 0.1);
    let mut errors = Vec::new();
    for steps in [500u32, 1000, 2000] {
        let dt = time / f64::from(steps);
        let mut scene = scene(&brick, SAND.law(fault), SAND.density, brick.points(), vec![]);
        scene.gravity = [0.0, -g * fault.gravity];
        scene.numerics.max_time_step = dt;
        let mut sim = Simulation::new(scene);
        let start = centre(&sim).0;
        for _ in 0..steps {
            sim.step()?;
        }
        let (x, v) = centre(&sim);
        let (fallen, n) = (start[1] - x[1], f64::from(steps));
        if steps == 500 {
            // Velocity first, then position with the new velocity (symplectic Euler).
            let exact = g * dt * dt * n * (n + 1.0) / 2.0;
            outcome.check(
                Check::value("free fall: distance, against the scheme's own sum", fallen, exact, "m")
                    .within(Tolerance::Relative(1e-12), ROUND_OFF)
                    .from(Kind::Analytic, "sum of g dt^2 k over the steps"),
            );
            outcome.check(
                Check::value("free fall: velocity", -v[1], g * time, "m/s")
                    .within(Tolerance::Relative(1e-12), ROUND_OFF)
                    .from(Kind::Analytic, "Galilei: v = g t"),
            );
            outcome.check(
                Check::value("free fall: distance", fallen, sliding_block::distance(g, time), "m")
                    .within(Tolerance::Relative(0.0025), "first order in time: dt/t = 0.2 %, with a quarter of margin")
                    .from(Kind::Analytic, "Galilei: g t^2 / 2"),
            );
        }
        errors.push((fallen - sliding_block::distance(g, time)).abs());
    }
    for pair in errors.windows(2) {
        outcome.check(
            Check::value("free fall: observed order in dt", order::from_errors(pair[0], pair[1], 2.0), 1.0, "1")
                .within(Tolerance::Absolute(1e-6), "the error is exactly proportional to dt")
                .from(Kind::Convergence, "symplectic Euler"),
        );
    }
    Ok(())
}

/// Sand slides down a tilted plane into a wall, with side walls and damping: what acted must be what changed.
pub fn momentum(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let brick = Brick::new([0.02, 0.055], [10, 10], H);
    let law = DruckerPrager::new(SAND.linear_elastic(fault), Cone::PlaneStrain, 0.5, 0.1, 50.0, 50.0, true);
    let at = Vector2::new;
    let boundaries = vec![
        Boundary::plane("base", at(0.0, 0.0), at(-0.2, 1.0), Friction::Coulomb(0.4)),
        Boundary::wall("wall", at(0.0, 0.0), at(-0.1, 1.0), 0.5, 0.06, Friction::Coulomb(0.3)).facing_right(),
    ];
    let law = AnyLaw::DruckerPrager(law);
    let mut points = brick.points();
    points.iter_mut().for_each(|p| p.v = [-1.0, -0.5]);
    let mut scene = scene(&brick, law, SAND.density, points, boundaries);
    scene.gravity = [-2.0, -9.81];
    scene.side_wall_friction = 0.2;
    scene.domain = [[-1.0, 0.21], [-1.0, 1.0]];
    scene.numerics.pic = checkdam::simulation::PicShare::Fraction(1e-3);
    let mut sim = Simulation::new(scene);
    sim.set_damping(2.0);
    run_until(&mut sim, 0.25)?;
    let (now, opening) = (sim.stock(), *sim.opening());
    let mut ledger = sim.ledger().clone();
    for tally in &mut ledger.boundaries {
        tally.impulse = tally.impulse.map(|p| p * fault.contact_force);
    }
    let impulse = ledger.impulse();
    let residual = (0..2).map(|d| (now.momentum[d] - opening.momentum[d] - impulse[d]).abs()).fold(0.0, f64::max);
    let steps = sim.steps();
    outcome.check(
        Check::at_most(
            "sand against a wall: momentum residual over all impulses",
            residual / ledger.impulse_scale,
            1e-13,
            "1",
        )
        .because(format!("{steps} steps of round-off that mostly cancel"))
        .from(Kind::Conservation, "Newton's second law"),
    );
    let mass = (now.mass + ledger.departed_mass) / opening.mass - 1.0;
    outcome.check(
        Check::at_most("sand against a wall: mass residual", mass.abs(), 1e-13, "1")
            .because("points carry their mass; only the sum is rounded")
            .from(Kind::Conservation, "conservation of mass"),
    );
    let agents = ["base", "wall"].iter().zip(&ledger.boundaries).filter(|(_, t)| t.impulse[0].abs() > 0.0).count();
    outcome.check(
        Check::value("sand against a wall: boundaries that acted", agents as f64, 2.0, "1")
            .within(Tolerance::Absolute(0.0), "a count; guards against a scene in which nothing happens")
            .from(Kind::Conservation, "the scene"),
    );
    Ok(())
}
