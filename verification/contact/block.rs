//! A block on an elastic base: slips, sticks. The base is a body that is clamped from below.

use super::scenes::{Part, several, usual};
use crate::scene::{Brick, Material, run_until};
use crate::{Fault, Outcome, RungFailure};
use checkdam::boundary::{Boundary, Friction};
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::contact::rule::ContactRule;
use checkdam::simulation::{PicShare, Simulation};
use checkdam::theory::sliding_block as theory;
use nalgebra::Vector2;

const STONE: Material = Material::new(2e7, 0.3, 1500.0);
const H: f64 = 0.05;
const GRAVITY: f64 = 9.81;
const COULOMB: &str = "Coulomb 1785: g (sin - mu cos)";
/// How long the block slides, s.
const TIME: f64 = 0.4;

/// Angles in rad: of the surface against the grid, of the slope against gravity; friction, share of PIC.
#[derive(Clone, Copy)]
pub struct Setting {
    /// Of the surface in the grid, downwards along x.
    pub tilt: f64,
    /// Of the surface under gravity.
    pub slope: f64,
    /// Coefficient while it slides.
    pub friction: f64,
    /// 1 keeps the block from shaking, 0 does not.
    pub pic: f64,
}

/// What a block did, against the closed form.
pub struct Slide {
    /// Displacement along the slope less the exact one, over what gravity alone would do.
    pub displacement: f64,
    /// Displacement along the slope, m.
    pub creep: f64,
    /// Normal impulse over weight times cosine times time.
    pub normal: f64,
    /// Tangential impulse over friction times that.
    pub tangential: f64,
    /// Friction work in the ledger over the exact one.
    pub friction_work: f64,
    /// How far the block moved off the surface, cells.
    pub rise: f64,
    /// Residual of the ledger over the work that gravity alone would do.
    pub residual: f64,
    /// What clamp, gravity and momentum leave over, over the weight times time.
    pub clamp: f64,
}

/// Lets the block settle on a base that it sticks to, then slide.
pub fn slide(s: &Setting, rule: ContactRule, fault: &Fault) -> Result<Slide, RungFailure> {
    let t = Vector2::new(libm::cos(s.tilt), -libm::sin(s.tilt));
    let n = Vector2::new(-t.y, t.x);
    let at = |a: f64, b: f64| -> [f64; 2] { (Vector2::new(0.013, 0.007) + t * a + n * b).into() };
    let brick = |a: f64, b: f64, cells: [usize; 2]| Brick { angle: -s.tilt, ..Brick::new(at(a, b), cells, H) };
    let base = Part::new(brick(-0.2, -4.0 * H, [24, 4]), STONE);
    let block = Part::new(brick(0.0, 0.0, [8, 4]), STONE);
    let clamp = Boundary::plane("clamp", at(0.0, -3.0 * H).into(), n, Friction::Bonded).only_for(&[0]);
    let mut scene = several(vec![base, block], vec![rule], vec![clamp], fault);
    let g = GRAVITY * fault.gravity;
    scene.gravity = (t * (g * libm::sin(s.slope)) - n * (g * libm::cos(s.slope))).into();
    scene.numerics.pic = PicShare::Fraction(0.02);
    let mut sim = Simulation::new(scene);
    sim.set_contact_friction(0, f64::INFINITY);
    sim.set_damping(800.0);
    run_until(&mut sim, 0.15)?;
    sim.set_damping(0.0);
    sim.set_contact_friction(0, s.friction * fault.friction);
    sim.set_pic(PicShare::Fraction(s.pic));
    sim.open_ledger();

    let centre = |sim: &Simulation| {
        let (mut x, mut count) = (Vector2::zeros(), 0.0);
        for (_, p) in sim.particles().filter(|(body, _)| *body == 1) {
            x += Vector2::from(p.x);
            count += 1.0;
        }
        x / count
    };
    let (start, began) = (centre(&sim), sim.time());
    let opening = sim.stock_of(|b| b == 0).momentum;
    let (mut impulse, mut held) = (Vector2::zeros(), Vector2::zeros());
    while sim.time() < began + TIME {
        sim.step()?;
        for tally in sim.contact_tallies() {
            impulse += Vector2::from(tally.exchange.impulse) * fault.contact_force;
        }
        held += Vector2::from(sim.step_tallies()[0].impulse);
    }
    let time = sim.time() - began;
    let moved = centre(&sim) - start;
    let stocks = [0, 1].map(|k| sim.stock_of(|b| b == k));
    let mass = STONE.density * 32.0 * H * H * crate::scene::THICKNESS;
    let a = theory::acceleration_from_rest(GRAVITY, s.slope, s.friction);
    let scale = theory::distance(GRAVITY * libm::sin(s.slope), time);
    let normal = mass * GRAVITY * libm::cos(s.slope) * time;
    let energy = sim.energy_balance(&sim.stock(), [0.0; 2]);
    // What clamp, gravity and block give to the base is the change of its momentum.
    let given = held - impulse + Vector2::from(sim.gravity()) * (stocks[0].mass * time)
        - (Vector2::from(stocks[0].momentum) - Vector2::from(opening));
    Ok(Slide {
        displacement: (moved.dot(&t) - theory::distance(a, time)) / scale,
        creep: moved.dot(&t),
        normal: impulse.dot(&n) / normal,
        tangential: -impulse.dot(&t) / (s.friction * normal),
        friction_work: energy.friction[1] / theory::friction_work(mass, GRAVITY, s.slope, s.friction, moved.dot(&t)),
        rise: moved.dot(&n) / H,
        residual: energy.residual / (mass * GRAVITY * libm::sin(s.slope) * scale),
        clamp: given.norm() / (mass * GRAVITY * time),
    })
}

/// Blocks that slip and one that sticks, in the usual way.
pub fn run(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let rad = f64::to_radians;
    for (name, tilt, slope) in [
        ("40 deg, along the grid", 0.0, 40.0),
        ("40 deg, at 23 deg to the grid", 23.0, 40.0),
        ("23 deg, along the grid", 0.0, 23.0),
        ("23 deg, at 23 deg to the grid", 23.0, 23.0),
    ] {
        for (pic, how) in [(1.0, "pure PIC"), (0.0, "no PIC")] {
            let setting = Setting { tilt: rad(tilt), slope: rad(slope), friction: 0.4, pic };
            judge(&format!("{name}, {how}"), &slide(&setting, usual(0.4), fault)?, pic, outcome);
            if *fault != Fault::NONE {
                return Ok(());
            }
        }
    }
    let setting = Setting { tilt: rad(23.0), slope: rad(40.0), friction: 0.9, pic: 1.0 };
    let stuck = slide(&setting, usual(0.9), fault)?;
    outcome.check(
        Check::at_most("friction 0.9 on 40 deg: creep", stuck.creep.abs(), 1e-4, "m")
            .because("none in theory; a five-hundredth of a cell")
            .from(Kind::Analytic, "sticks while tan(slope) <= mu"),
    );
    Ok(())
}

fn judge(name: &str, found: &Slide, pic: f64, outcome: &mut Outcome) {
    let shakes = "an elastic block without damping shakes, see the rung sliding_block";
    let (share, reason) =
        if pic == 1.0 { (0.01, "the block is not rigid, and starts with a shear wave") } else { (0.02, shakes) };
    outcome.check(
        Check::value(
            format!("{name}: error of the displacement, over what gravity alone would do"),
            found.displacement,
            0.0,
            "1",
        )
        .within(Tolerance::Absolute(share), reason)
        .from(Kind::Analytic, COULOMB),
    );
    outcome.check(
        Check::value(format!("{name}: normal impulse over weight times time"), found.normal, 1.0, "1")
            .within(
                Tolerance::Absolute(if pic == 1.0 { 0.005 } else { 0.03 }),
                "what the block still moves along the normal",
            )
            .from(Kind::Conservation, "Newton's second law"),
    );
    outcome.check(
        Check::value(
            format!("{name}: tangential impulse over friction times weight times time"),
            found.tangential,
            1.0,
            "1",
        )
        .within(
            Tolerance::Absolute(if pic == 1.0 { 0.01 } else { 0.03 }),
            "as the normal impulse, but for the first shear wave",
        )
        .from(Kind::Analytic, COULOMB),
    );
    if pic == 1.0 {
        outcome.check(
            Check::value(format!("{name}: friction work over mu N s"), found.friction_work, 1.0, "1")
                .within(
                    Tolerance::Absolute(0.01),
                    "surfaces slip as far as the centre moves but for the shear of the block",
                )
                .from(Kind::Analytic, "mu N s"),
        );
    }
    outcome.check(
        Check::at_most(format!("{name}: block off the surface"), found.rise.abs(), 0.02, "cells")
            .because("contact knows the gap: what shook loose falls back")
            .from(Kind::Analytic, "Signorini 1933"),
    );
    outcome.check(
        Check::at_most(
            format!("{name}: residual of the energy ledger, over what gravity alone would do"),
            found.residual.abs(),
            0.01,
            "1",
        )
        .because("ripples of the block; the ledger counts every impulse with the mean of two velocities")
        .from(Kind::Conservation, "energy"),
    );
    outcome.check(
        Check::at_most(
            format!("{name}: clamp, contact and gravity against the momentum of the base"),
            found.clamp,
            1e-11,
            "1",
        )
        .because("round-off of some thousand steps")
        .from(Kind::Conservation, "Newton's second law"),
    );
}
