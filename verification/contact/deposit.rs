//! Sand that runs against an elastic wall and comes to rest: nothing may leak, no energy may come from nowhere.

use super::scenes::{Part, several, usual};
use crate::scene::{Brick, Material};
use crate::{Fault, Outcome, RungFailure};
use checkdam::boundary::{Boundary, Friction};
use checkdam::check::{Check, Kind};
use checkdam::constitutive::{AnyLaw, Cone, DruckerPrager};
use checkdam::contact::outline::Outline;
use checkdam::contact::rule::ContactRule;
use checkdam::gauge::penetration;
use checkdam::simulation::{PicShare, Simulation};
use nalgebra::Vector2;

const H: f64 = 0.02;
const SAND: Material = Material::new(1e6, 0.3, 1530.0);

/// What became of the sand.
pub struct Deposit {
    /// Deepest that a point's domain was inside the wall, cells.
    pub deepest: f64,
    /// Largest residual of the energy ledger, over the energy.
    pub residual: f64,
    /// Mean force on the wall at rest, N, and largest mean over 20 ms.
    pub force: [f64; 2],
    /// Clamp, contact and gravity against the momentum of the wall, over the impulse of the clamp.
    pub clamp: f64,
}

/// A square of sand, 0.2 m, runs 0.4 m down a bed of 40 degrees against a wall of the given stiffness (Pa), 0.1 m thick.
pub fn run_against(young: f64, rule: ContactRule, end: f64, fault: &Fault) -> Result<Deposit, RungFailure> {
    let slope = 40f64.to_radians();
    let wall = Part::new(Brick::new([0.6, -2.0 * H], [5, 17], H), Material::new(young, 0.2, 1200.0));
    let points: Vec<_> = wall.points.iter().map(|p| (p.id, p.x)).collect();
    let outline = Outline::trace(&points, 0.5 * H, 0.0);
    let plane = |name: &str, x: [f64; 2], normal: [f64; 2], friction, body: usize| {
        Boundary::plane(name, Vector2::from(x), Vector2::from(normal), friction).only_for(&[body])
    };
    let boundaries = vec![
        plane("bed", [0.0; 2], [0.0, 1.0], Friction::Coulomb(0.4 * fault.friction), 1),
        plane("back", [0.0; 2], [1.0, 0.0], Friction::Smooth, 1),
        plane("clamp", [0.6, 0.0], [0.0, 1.0], Friction::Bonded, 0),
    ];
    let sand = Part::new(Brick::new([0.0, 0.0], [10, 10], H), SAND);
    let mut scene = several(vec![wall, sand], vec![rule], boundaries, fault);
    let elastic = SAND.linear_elastic(fault);
    let angle = 31f64.to_radians();
    scene.bodies[1].0.law = AnyLaw::DruckerPrager(DruckerPrager::new(
        elastic,
        Cone::TriaxialCompression,
        angle,
        0.0,
        0.0,
        f64::INFINITY,
        true,
    ));
    scene.gravity = [9.81 * libm::sin(slope), -9.81 * libm::cos(slope)];
    scene.numerics.pic = PicShare::Fraction(5e-4);
    let mut sim = Simulation::new(scene);
    let gravity = Vector2::from(sim.gravity());
    let (mut deepest, mut residual) = (0.0f64, 0.0f64);
    let (mut rest, mut window, mut peak) = ([0.0; 2], [0.0; 2], 0.0f64);
    let (mut given, mut clamped) = (Vector2::zeros(), 0.0);
    while sim.time() < end {
        sim.step()?;
        let dt = sim.time_step().dt;
        let contact: Vector2<f64> = sim.contact_tallies().map(|t| Vector2::from(t.exchange.impulse)).sum();
        let clamp = Vector2::from(sim.step_tallies()[2].impulse);
        given += clamp - contact * fault.contact_force + gravity * (sim.stock_of(|b| b == 0).mass * dt);
        clamped += clamp.norm();
        window = [window[0] - contact.x, window[1] + dt];
        if window[1] > 0.02 {
            peak = peak.max(window[0] / window[1]);
            window = [0.0; 2];
        }
        if sim.time() > 0.8 * end {
            rest = [rest[0] - contact.x, rest[1] + dt];
        }
        if sim.steps().is_multiple_of(20) {
            deepest = deepest.max(penetration::measure(&sim, 0, &outline, H).deepest);
            let e = sim.energy_balance(&sim.stock(), [0.6, 0.0]);
            residual = residual.max((e.residual / e.initial).abs());
        }
    }
    let momentum = Vector2::from(sim.stock_of(|b| b == 0).momentum);
    Ok(Deposit {
        deepest: deepest / H,
        residual,
        force: [rest[0] / rest[1], peak],
        clamp: (given - momentum).norm() / clamped,
    })
}

/// A soft wall and a hard one, in the usual way.
pub fn run(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    for (name, young) in [("wall of 0.5 MPa", 5e5), ("wall of 10 MPa", 1e7)] {
        let found = run_against(young, usual(0.4), 0.8, fault)?;
        outcome.check(
            Check::at_most(format!("{name}: deepest that sand gets into it"), found.deepest, 0.5, "cells")
                .because("a point may move by less than half a cell before a node that sees it stops it")
                .from(Kind::Analytic, "Signorini 1933"),
        );
        outcome.check(
            Check::at_most(format!("{name}: largest residual of the energy ledger"), found.residual, 0.01, "1")
                .because("1 % of the energy, as in the rungs with rigid walls")
                .from(Kind::Conservation, "energy"),
        );
        outcome.check(
            Check::at_most(
                format!("{name}: clamp, contact and gravity against the momentum of the wall"),
                found.clamp,
                1e-11,
                "1",
            )
            .because("round-off of some thousand steps")
            .from(Kind::Conservation, "Newton's second law"),
        );
    }
    Ok(())
}
