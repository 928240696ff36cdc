//! A wall from either side: what comes from its right instead of its left, and what comes from behind.
//!
//! A fill at rest, and a block that flies against the wall across a gap. The mirror image of a scene must show the mirror image of
//! what the scene shows, to round-off, also on a turned grid. A wall acts with its back as with its face.

use super::{CELLS, FILL, HEIGHT, Place, Seen, Side};
use crate::figure::{Figure, curves, measured};
use crate::report::named_csv;
use crate::scene::{Brick, THICKNESS, centre, scene};
use crate::{Fault, Outcome, RungFailure};
use checkdam::boundary::{Boundary, BoundaryContact, Friction};
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::plot::curves::{Curves, panel};
use checkdam::simulation::{PicShare, Simulation};
use nalgebra::Vector2;
use rayon::prelude::*;

pub(super) const FIGURE: Figure = curves(
    "wall_place_sides",
    "wall_place_sides_plot",
    Curves {
        x: "offset_cells",
        x_title: "place between two nodes (cells)",
        y_title: "force over closed form",
        curves: &[measured("force_over_exact", "")],
        panels: &[panel("fill behind the wall", &[("side", "back")])],
        split: &[("thickness_cells", "thickness of the wall (cells) ")],
        ..Curves::LINEAR
    },
);

const SIDES: [Side; 3] = [Side::Face, Side::Mirror, Side::Back];
const NAMES: [&str; 3] = ["face", "mirror", "back"];
/// Cells; all but the last are plates.
const THICKNESSES: [f64; 4] = [0.0, 0.1, 1.0, 4.0];
const PLATE: f64 = 2.5;
/// Speed of the block, m/s, its cells in either direction, and its distance from the wall, cells.
const SPEED: f64 = 1.0;
const BLOCK: usize = 4;
const GAP: f64 = 0.37;
const H: f64 = HEIGHT / CELLS as f64;

impl Side {
    /// A vector of the scene as it is seen from this side.
    pub(super) fn seen(self, v: Vector2<f64>) -> Vector2<f64> {
        if self == Side::Mirror { Vector2::new(-v.x, v.y) } else { v }
    }

    /// The sense of rotation.
    pub(super) fn turn(self) -> f64 {
        if self == Side::Mirror { -1.0 } else { 1.0 }
    }

    /// A smooth wall whose loaded surface begins at `foot` and rises along `up`; `along` leads into it.
    pub(super) fn wall(self, [foot, along, up]: [Vector2<f64>; 3], height: f64, thickness: f64) -> Boundary {
        let foot = if self == Side::Back { foot + along * thickness } else { foot };
        let wall = Boundary::wall("wall", foot, up, height, thickness, Friction::Smooth);
        if self == Side::Face { wall } else { wall.facing_right() }
    }

    fn number(self) -> f64 {
        SIDES.iter().position(|s| *s == self).map_or(f64::NAN, |k| k as f64)
    }
}

/// What a block that flew against a wall did.
struct Thrown {
    /// By how much its distance from the wall differed from nothing when the wall first acted, cells; less than nothing when too early.
    late: f64,
    /// Impulse on the wall, and momentum that the block lost, over what it had.
    impulse: f64,
    lost: f64,
    /// How far the domain of a point was beyond the surface at most, cells.
    deepest: f64,
    /// Points beyond the surface at the end.
    past: usize,
}

fn throw((thickness, offset, side): (f64, f64, Side), fault: &Fault) -> Result<Thrown, RungFailure> {
    let brick = Brick::new([offset * H, offset * H], [BLOCK, BLOCK], H);
    let mut points = brick.points();
    for p in &mut points {
        (p.x, p.v) = (side.seen(p.x.into()).into(), side.seen(Vector2::new(SPEED, 0.0)).into());
    }
    let surface = (BLOCK as f64 + offset + GAP) * H;
    let frame = [Vector2::new(surface, -2.0 * H), Vector2::x(), Vector2::y()].map(|v| side.seen(v));
    let wall = side.wall(frame, (BLOCK + 6) as f64 * H, thickness * H);
    let mut scene = scene(&brick, FILL.law(fault), FILL.density * fault.density, points, vec![wall]);
    scene.numerics.pic = PicShare::Fraction(0.02);
    let mut sim = Simulation::new(scene);
    let momentum = FILL.density * (BLOCK as f64 * H).powi(2) * THICKNESS * SPEED;
    let beyond = |x: [f64; 2]| (side.seen(x.into()).x - surface) / H;
    let mut thrown = Thrown { late: f64::NAN, impulse: 0.0, lost: 0.0, deepest: f64::NEG_INFINITY, past: 0 };
    // The gap takes 0.02 s, and a wave to and fro 0.01 s.
    while sim.time() < 0.05 {
        let before = sim.time();
        sim.step()?;
        let given = -side.seen(sim.step_tallies()[0].impulse.into()).x * fault.contact_force / momentum;
        if given > 1e-9 && thrown.late.is_nan() {
            thrown.late = before * SPEED / H - GAP;
        }
        thrown.impulse += given;
        let reach = 0.5 * sim.bodies()[0].point_spacing / H;
        thrown.deepest = sim.particles().map(|(_, p)| beyond(p.x) + reach).fold(thrown.deepest, f64::max);
    }
    thrown.lost = (SPEED - side.seen(centre(&sim).1.into()).x) / SPEED;
    thrown.past = sim.particles().filter(|(_, p)| beyond(p.x) > 0.0).count();
    Ok(thrown)
}

/// Fills and blocks on all sides; under a fault at two places only. `exact` is the force of a fill, N/m.
pub(super) fn judge(fault: &Fault, exact: f64, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let eighths: &[u32] = if *fault == Fault::NONE { &[0, 1, 2, 3, 4, 5, 6, 7] } else { &[3, 6] };
    at_rest(fault, eighths, exact, outcome)?;
    thrown(fault, eighths, outcome)
}

fn at_rest(fault: &Fault, eighths: &[u32], exact: f64, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let mut places = Vec::new();
    for (thickness, side) in THICKNESSES.into_iter().flat_map(|t| SIDES.map(|s| (t, s))) {
        let mut add = |offset, angle| {
            places.push(Place { contact: BoundaryContact::Surface, thickness, offset, angle, cells: CELLS, side })
        };
        eighths.iter().for_each(|&k| add([f64::from(k) / 8.0, f64::from(3 * k % 8) / 8.0], 0.0));
        if *fault == Fault::NONE && side != Side::Back {
            [7.0, 24.0, 80.0].into_iter().for_each(|angle| add([0.4, 0.6], angle));
        }
    }
    let seen: Vec<Seen> = places.par_iter().map(|p| p.settle(fault)).collect::<Result<_, _>>()?;
    let all = || places.iter().zip(&seen);
    let judged = all().filter(|(p, _)| p.angle == 0.0 && p.side != Side::Face);
    let errors = judged.map(|(_, s)| s.force / exact - 1.0);
    outcome.check(
        Check::value(
            "mirror image, and back of a wall: force on the wall over the closed form, the worst of all",
            1.0 + errors.fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a }),
            1.0,
            "1",
        )
        .within(Tolerance::Absolute(0.01), "strains of rho g H/M = 0.4 %; what still swings after the ramp, 0.25 %")
        .from(Kind::Analytic, "nu/(1 - nu) rho g H^2 / 2"),
    );
    let image = |p: &Place| {
        let alike = |q: &Place| q.thickness == p.thickness && q.offset == p.offset && q.angle == p.angle;
        all().find(|(q, _)| q.side == Side::Face && alike(q))
    };
    let apart =
        all().filter(|(p, _)| p.side == Side::Mirror).filter_map(|(p, s)| Some((s.force - image(p)?.1.force).abs()));
    outcome.check(
        Check::at_most(
            "mirror image: difference of the force to that of the scene, the largest",
            apart.fold(0.0, f64::max) / exact,
            1e-9,
            "1",
        )
        .because("round-off")
        .from(Kind::Conservation, "invariance to reflection"),
    );
    let header = [
        "side",
        "thickness_cells",
        "offset_cells",
        "base_offset_cells",
        "angle_deg",
        "force_over_exact",
        "arm_over_height",
        "past_kg",
    ];
    let rows = places.iter().zip(&seen).map(|(p, s)| {
        vec![p.side.number(), p.thickness, p.offset[0], p.offset[1], p.angle, s.force / exact, s.arm / HEIGHT, s.past]
    });
    outcome.tables.push(("wall_place_sides".into(), named_csv(&header, &[("side", &NAMES)], rows)));
    Ok(())
}

fn thrown(fault: &Fault, eighths: &[u32], outcome: &mut Outcome) -> Result<(), RungFailure> {
    let mut settings = Vec::new();
    for thickness in THICKNESSES {
        for &k in eighths {
            settings.extend(SIDES.map(|side| (thickness, f64::from(k) / 8.0, side)));
        }
    }
    let all: Vec<Thrown> = settings.par_iter().map(|s| throw(*s, fault)).collect::<Result<_, _>>()?;
    let plates = || settings.iter().zip(&all).filter(|((t, ..), _)| *t < PLATE).map(|(_, b)| b);
    let largest = |of: &mut dyn Iterator<Item = f64>| of.fold(0.0, f64::max);
    outcome.check(
        Check::at_most(
            "block against a plate: distance when the plate first acts, the largest",
            largest(&mut plates().map(|b| b.late.abs())),
            0.05,
            "cells",
        )
        .because("a step is a way of 0.014 cells; a crossing within a twentieth of a cell of a node counts as on it")
        .from(Kind::Analytic, "contact begins where the gap is closed"),
    );
    outcome.check(
        Check::at_most(
            "block against a plate: depth of a point's domain beyond the surface, the largest",
            largest(&mut plates().map(|b| b.deepest)),
            0.05,
            "cells",
        )
        .because("the way of a step, 0.014 cells, and half a point's spacing times the strain v/c = 3 %")
        .from(Kind::Conservation, "impenetrability"),
    );
    // The three sides of a setting stand beside each other.
    let apart = |side: Side| {
        let pairs = settings.chunks(SIDES.len()).zip(all.chunks(SIDES.len()));
        pairs.fold(0.0, |worst: f64, (of, b)| {
            let own = of.iter().zip(b).filter(|((.., s), _)| *s == side);
            own.map(|(_, other)| (other.impulse - b[0].impulse).abs()).fold(worst, f64::max)
        })
    };
    for (what, difference) in [("mirror image", apart(Side::Mirror)), ("back", apart(Side::Back))] {
        outcome.check(
            Check::at_most(
                format!("block against a wall, {what}: difference of the impulse to that on the face"),
                difference,
                1e-9,
                "1",
            )
            .because("round-off")
            .from(Kind::Conservation, "invariance to reflection"),
        );
    }
    let unbalanced = largest(&mut all.iter().map(|b| (b.impulse / b.lost - 1.0).abs()));
    outcome.check(
        Check::at_most("block against a wall: impulse over the momentum that it lost, less one", unbalanced, 1e-9, "1")
            .because("round-off")
            .from(Kind::Conservation, "Newton's second law"),
    );
    let past = all.iter().map(|b| b.past as f64).fold(0.0, f64::max);
    outcome.check(
        Check::at_most("block against a wall: points past its surface", past, 0.0, "1")
            .because("a wall holds what comes from either side")
            .from(Kind::Conservation, "impenetrability"),
    );
    let header =
        ["side", "thickness_cells", "offset_cells", "late_cells", "impulse_over_momentum", "depth_cells", "past"];
    let rows = settings.iter().zip(&all).map(|((thickness, offset, side), b)| {
        vec![side.number(), *thickness, *offset, b.late, b.impulse, b.deepest, b.past as f64]
    });
    outcome.tables.push(("wall_place_thrown".into(), named_csv(&header, &[("side", &NAMES)], rows)));
    Ok(())
}
