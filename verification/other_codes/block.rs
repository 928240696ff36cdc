//! A stiff block slides down a slope at an angle to the grid.
//!
//! Once the shear wave of its start has gone, nothing is left but Coulomb's friction on a normal force whose mean is the weight's part across
//! the slope. So its acceleration has to be right far more closely than that of the whole slide in the rung `sliding_block`.

use crate::scene::{Brick, Material, centre, points_by_number, run_until, scene};
use crate::{Fault, Outcome, RungFailure};
use checkdam::body::Particle;
use checkdam::boundary::{Boundary, Friction};
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::simulation::{PicShare, Simulation};
use checkdam::theory::sliding_block::sliding_acceleration;
use nalgebra::Vector2;

const BLOCK: Material = Material::new(2e7, 0.3, 1500.0);
const H: f64 = 0.05;
const GRAVITY: f64 = 9.81;
/// Slope (degrees) and friction: on a grid that is not turned; and that of Matter, whose plane lies along the grid.
const SLOPES: [(f64, f64); 2] = [(30.0, 0.4), (24.0, 0.267_949_192_431_122_7)];
/// Between these times the acceleration is measured, s.
const FROM: f64 = 0.1;
const TO: f64 = 0.4;

pub(super) fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let mut outcome = Outcome::default();
    for (degrees, friction) in SLOPES {
        let slope = degrees.to_radians();
        let measured = slide(slope, friction, fault)?;
        outcome.check(
            Check::value(
                format!("block on {degrees} degrees, turned on the grid: acceleration from {FROM} to {TO} s"),
                measured,
                sliding_acceleration(GRAVITY, slope, friction),
                "m/s2",
            )
            .within(
                Tolerance::Relative(1e-4),
                "what still moves across the slope, 0.1 mm/s at either end, times the friction, over 0.3 s",
            )
            .from(Kind::Analytic, "Coulomb 1785: g (sin - mu cos)"),
        );
    }
    Ok(outcome)
}

/// Mean acceleration down the slope, m/s2.
fn slide(slope: f64, friction: f64, fault: &Fault) -> Result<f64, RungFailure> {
    let down = Vector2::new(libm::cos(slope), -libm::sin(slope));
    let normal = Vector2::new(libm::sin(slope), libm::cos(slope));
    let brick = Brick { angle: -slope, ..Brick::new([0.013, 0.007], [8, 4], H) };
    let on = |points: Vec<Particle>, friction: Friction, pic: f64| {
        let base = Boundary::plane("slope", brick.corner.into(), normal, friction);
        let mut scene = scene(&brick, BLOCK.law(fault), BLOCK.density * fault.density, points, vec![base]);
        scene.gravity = [0.0, -GRAVITY * fault.gravity];
        scene.numerics.pic = PicShare::Fraction(pic);
        Simulation::new(scene)
    };
    let mut sim = on(brick.points(), Friction::Rough, 0.02);
    sim.set_damping(800.0);
    run_until(&mut sim, 0.15)?;
    // Full PIC makes it rigid, as in the rung `sliding_block`.
    let mut sim = on(points_by_number(&sim), Friction::Coulomb(friction * fault.friction), 1.0);
    let mut now = || -> Result<[f64; 2], RungFailure> {
        let until = if sim.time() < FROM { FROM } else { TO };
        run_until(&mut sim, until)?;
        Ok([sim.time(), Vector2::from(centre(&sim).1).dot(&down)])
    };
    let [[t0, v0], [t1, v1]] = [now()?, now()?];
    Ok((v1 - v0) / (t1 - t0))
}
