//! Whole steps of the solver against closed forms that no rung of the ladder covers: side walls, damping, PIC rates, fields,
//! gates, departures, failures.

mod contact;
mod edges;
mod failures;
mod forces;
mod laws;
mod motion;
mod slip;
mod surface;
mod terrain;

use crate::boundary::Boundary;
use crate::constitutive::{AnyLaw, LinearElastic};
use crate::ledger::Stock;
use crate::scaffold::{Brick, scene};
use crate::simulation::{Scene, Simulation};

const H: f64 = 0.1;
const DENSITY: f64 = 1000.0;
/// Time step of every scene here, s.
const DT: f64 = 1e-3;

fn law() -> AnyLaw {
    AnyLaw::LinearElastic(LinearElastic::new(1e5, 0.0))
}

/// A block of 4 by 3 cells that moves with `v`, without forces.
fn block(v: [f64; 2], boundaries: Vec<Boundary>) -> Scene {
    let brick = Brick::new([0.0; 2], [4, 3], H);
    let mut points = brick.points();
    points.iter_mut().for_each(|p| p.v = v);
    let mut scene = scene(&brick, law(), DENSITY, points, boundaries);
    scene.numerics.max_time_step = DT;
    scene
}

fn run(scene: Scene, steps: u32) -> Simulation {
    stepped(Simulation::new(scene), steps)
}

fn stepped(mut sim: Simulation, steps: u32) -> Simulation {
    (0..steps).for_each(|_| sim.step().unwrap());
    sim
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-11 * b.abs().max(1e-3)
}

/// Every point moves with `v`.
fn moves_with(sim: &Simulation, v: [f64; 2]) -> bool {
    sim.particles().all(|(_, p)| close(p.v[0], v[0]) && close(p.v[1], v[1]))
}

/// Mass and momentum of the ledger against what the material holds; returns the energy residual, J.
fn books_balance(sim: &Simulation) -> f64 {
    let (now, then, ledger): (Stock, Stock, _) = (sim.stock(), *sim.opening(), sim.ledger());
    let impulse = ledger.impulse();
    for (d, impulse) in impulse.into_iter().enumerate() {
        let residual = now.momentum[d] - then.momentum[d] - impulse;
        assert!(residual.abs() <= 1e-12 * ledger.impulse_scale.max(then.mass), "momentum residual {residual}");
    }
    assert!(close(now.mass + ledger.departed_mass, then.mass) && close(sim.mass(), now.mass));
    sim.energy_balance(&now, [0.3, 0.7]).residual
}

/// What symplectic Euler gains in free fall, J: points fall with the velocity of the step's end, so each step is m g^2 dt^2/2
/// too deep.
fn free_fall_residual(sim: &Simulation, g: [f64; 2]) -> f64 {
    0.5 * sim.mass() * (g[0] * g[0] + g[1] * g[1]) * DT * DT * sim.steps() as f64
}
