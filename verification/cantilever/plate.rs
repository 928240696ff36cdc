//! A plate that moves by a mesh of its own: bent by a load all along, and struck by sand.

use super::SMALL;
use super::beam::{Beam, Load, settle};
use crate::scene::{Brick, Material, THICKNESS, scene};
use crate::{Fault, Outcome, RungFailure};
use checkdam::boundary::{Boundary, Friction};
use checkdam::check::{Check, Expected, Kind};
use checkdam::constitutive::{AnyLaw, Cone, DruckerPrager, LinearElastic, NeoHookean};
use checkdam::contact::rule::ContactRule;
use checkdam::shape::ShapeFunction;
use checkdam::simulation::Simulation;
use nalgebra::Vector2;

/// Length over depth.
const SLENDER: usize = 6;

/// A plate of so many cells through its depth.
pub(super) fn plate(cells: usize, per_cell: usize, material: Material) -> Beam {
    Beam { shape: ShapeFunction::Ugimp, slenderness: SLENDER, cells, material, per_cell, mesh: true, implicit: None }
}

/// Relative error of a small deflection under a load all along, a row of the table.
pub(super) fn bend(beam: &Beam, fault: &Fault, rows: &mut Vec<Vec<f64>>) -> Result<f64, RungFailure> {
    let e = beam.exact();
    let q = SMALL * e.depth / e.under_load(1.0, e.length);
    let rest = settle(beam, Load::Spread(q * fault.gravity), fault)?;
    let error = rest.tip[0] / e.under_load(q, beam.tip()) - 1.0;
    let points = (beam.per_cell * beam.per_cell) as f64;
    rows.push(vec![e.elastic.poisson, beam.cells as f64, points, error]);
    Ok(error)
}

/// A plate two cells thick that sand strikes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Struck {
    /// How the checks call it, first and later.
    pub names: [&'static str; 2],
    /// Young's modulus, Pa.
    pub young: f64,
    /// Whether it moves in implicit steps.
    pub implicit: bool,
    /// Allowed of the momentum that contact, clamp and plate leave, over that of contact, and why.
    pub round_off: (f64, &'static str),
    /// Allowed of the energy that is not accounted for, over that at the start, and why.
    pub energy: (f64, &'static str),
}

/// In explicit steps.
pub(super) const EXPLICIT: Struck = Struck {
    names: ["sand on a plate of two cells", "the same"],
    young: 1e6,
    implicit: false,
    round_off: (1e-11, "round-off of a few thousand steps"),
    energy: (0.02, "the sand's own share: transfers between points and grid, and time steps"),
};

/// Sand strikes a plate: what contact gives, the clamp takes or the plate keeps. Along x: impulses of contact on the plate and of the plate
/// on its clamp, N s.
pub(super) fn impact(plate_of: &Struck, fault: &Fault, outcome: &mut Outcome) -> Result<[f64; 2], RungFailure> {
    let [name, same] = plate_of.names;
    let h = 0.025;
    let plate = Brick::new([0.3, -2.0 * h], [2, 14], h);
    let sand = Brick::new([0.05, 0.0], [9, 6], h);
    let up = Vector2::new(0.0, 1.0);
    let clamp = Boundary::plane("clamp", Vector2::new(0.3, 0.0), up, Friction::Bonded).only_for(&[0]);
    let base = Boundary::plane("base", Vector2::zeros(), up, Friction::Coulomb(0.4)).only_for(&[1]);
    let law = AnyLaw::NeoHookean(NeoHookean::new(plate_of.young, 0.3));
    let mut scene = scene(&plate, law, 1200.0, plate.points(), vec![clamp, base]);
    scene.bodies[0].0.mesh = Some(plate.mesh([&[], &[2.0 * h]]));
    scene.bodies[0].0.implicit = plate_of.implicit;
    let cone = DruckerPrager::new(
        LinearElastic::new(1e6, 0.3),
        Cone::TriaxialCompression,
        33f64.to_radians(),
        0.0,
        0.0,
        0.0,
        true,
    );
    let mut grains = sand.points();
    grains.iter_mut().for_each(|p| p.v = [2.0, 0.0]);
    scene.bodies.push((sand.body(AnyLaw::DruckerPrager(cone), 1500.0), grains));
    scene.contacts = vec![ContactRule::with_structure(0, 1, 0.4)];
    scene.gravity = [0.0, -9.81];
    let mut sim = Simulation::new(scene);
    let opening = *sim.opening();
    let plate_at = |sim: &Simulation| Vector2::from(sim.stock_of(|b| b == 0).momentum);
    let (mut given, mut clamped, mut weight) = (Vector2::zeros(), Vector2::zeros(), Vector2::zeros());
    let (mut missed, mut scale) = (0.0f64, 0.0f64);
    while sim.time() < 0.3 {
        sim.step()?;
        for tally in sim.contact_tallies() {
            given -= Vector2::from(tally.exchange.impulse) * fault.contact_force;
        }
        clamped += Vector2::from(sim.step_tallies_of(0).next().map_or([0.0; 2], |t| t.impulse));
        weight += Vector2::from(sim.distributed_impulse_of(0));
        missed = missed.max((given + clamped + weight - plate_at(&sim)).norm());
        scale = scale.max(given.norm());
    }
    outcome.check(
        Check::at_most(
            format!("{name}: contact less clamp and momentum, over contact"),
            missed / scale,
            plate_of.round_off.0,
            "1",
        )
        .because(plate_of.round_off.1)
        .from(Kind::Conservation, "Newton's second and third law"),
    );
    let balance = sim.energy_balance(&sim.stock(), [0.0; 2]);
    outcome.check(
        Check::at_most(
            format!("{same}: energy that is not accounted for, of that at the start"),
            balance.residual.abs() / opening.kinetic,
            plate_of.energy.0,
            "1",
        )
        .because(plate_of.energy.1)
        .from(Kind::Conservation, "every loss is measured where it happens"),
    );
    let struck = scale / (1500.0 * 9.0 * 6.0 * h * h * THICKNESS * 2.0);
    outcome.check(
        Check::new(
            format!("{same}: impulse on the plate over momentum of the sand"),
            struck,
            Expected::Within(0.2, 2.0),
            "1",
        )
        .because("the sand strikes: friction takes a part before")
        .from(Kind::Conservation, "what is checked is not nothing"),
    );
    Ok([given.x, -clamped.x])
}
