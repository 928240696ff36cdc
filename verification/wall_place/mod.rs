//! A wall takes the same force wherever it stands in the grid, however thin it is, and however the grid is turned.
//!
//! A fill between smooth walls on a smooth base is in confined compression, so the force on a wall and where it acts are known. The
//! scene is moved over the grid by eighths of a cell, along and across, and turned on it with gravity; the wall is thick, as thin as
//! a cell, or a plate without thickness. Nothing of that may matter.
//!
//! The same scenes with contact at the nodes inside a wall, as Ng et al. have it, stand beside it in the table. They are not judged but
//! for one thing: that the scene tells the two apart.

mod sides;

use super::report::named_csv;
use super::scene::{Brick, Material, THICKNESS, scene};
use super::{Fault, FaultKind, Outcome, Rung, RungFailure};
use crate::figure::{Figure, curves, measured};
use crate::of_module;
use checkdam::boundary::{Boundary, BoundaryContact, Friction};
use checkdam::check::{Check, Expected, Kind, Tolerance};
use checkdam::plot::curves::{Curves, panel};
use checkdam::simulation::{PicShare, Simulation};
use checkdam::theory::earth_pressure;
use checkdam::theory::elastic::confined_speed;
use checkdam::theory::order;
use nalgebra::Vector2;
use rayon::prelude::*;

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "A fill at rest against a wall at eight places between nodes, of four thicknesses, and turned on the grid: force, moment",
    goal: "A wall acts where it is drawn, whatever its thickness and the place of the grid",
    source: "nu/(1 - nu) rho g H^2 / 2, at H/3",
    sketch: r"
    smooth |o o o o||      . . . .  nodes of the grid,
           |o o o o||<--    . . . . anywhere
      H    |o o o o||<---
           |o o o o||<----  thickness 0 to 4 cells
    -------+-------++-----  all of it turned by some angle
",
    run,
    covers: &[(FaultKind::Gravity, 1.03), (FaultKind::Density, 1.03), (FaultKind::ContactForce, 1.03)],
    under_fault: "all; of the sides of a wall, two places",
    figures: FIGURES,
};

/// Its figures.
const FIGURES: &[Figure] = &[SETTINGS, sides::FIGURE];

const SETTINGS: Figure = curves(
    "wall_place_settings",
    "wall_place_plot",
    Curves {
        x: "offset_cells",
        x_title: "place between two nodes (cells)",
        y_title: "force over closed form",
        curves: &[measured("force_over_exact", "")],
        panels: &[
            panel("contact on the surface", &[("angle_deg", "0"), ("contact", "surface")]),
            panel("contact at nodes, not judged", &[("angle_deg", "0"), ("contact", "nodes")]),
        ],
        split: &[("thickness_cells", "thickness of the wall (cells) ")],
        ..Curves::LINEAR
    },
);

const FILL: Material = Material::new(1e6, 0.3, 1500.0);
const HEIGHT: f64 = 0.4;
/// Cells over the height.
const CELLS: usize = 8;
const GRAVITY: f64 = 9.81;
const CONTACTS: [&str; 2] = ["surface", "nodes"];

/// Where the fill is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    /// Before the face of the wall.
    Face,
    /// Before the face, and all of it mirrored at a column of nodes.
    Mirror,
    /// Behind the wall, whose face is free.
    Back,
}

/// Where the scene lies.
#[derive(Debug, Clone, Copy)]
struct Place {
    contact: BoundaryContact,
    /// Of the wall, cells.
    thickness: f64,
    /// By how much the scene is moved along its own axes, cells.
    offset: [f64; 2],
    /// Angle of the base to the grid, degrees.
    angle: f64,
    /// Cells over the height.
    cells: usize,
    side: Side,
}

/// What the wall shows.
struct Seen {
    force: f64,
    arm: f64,
    /// Mass past the face, kg.
    past: f64,
}

fn places() -> Vec<Place> {
    let (mut places, side) = (Vec::new(), Side::Face);
    for contact in [BoundaryContact::Surface, BoundaryContact::Nodes] {
        for thickness in [0.0, 0.1, 1.0, 4.0] {
            for k in 0..8u32 {
                // Every eighth along, and every one across, in another order.
                let offset = [f64::from(k) / 8.0, f64::from(3 * k % 8) / 8.0];
                places.push(Place { contact, thickness, offset, angle: 0.0, cells: CELLS, side });
            }
            for (k, angle) in [7.0, 24.0, 45.0, 80.0, 173.0, -60.0].into_iter().enumerate() {
                let offset = [0.3 + 0.1 * k as f64, 0.7 - 0.1 * k as f64];
                places.push(Place { contact, thickness, offset, angle, cells: CELLS, side });
                if contact == BoundaryContact::Surface {
                    places.push(Place { contact, thickness, offset, angle, cells: 2 * CELLS, side });
                }
            }
        }
    }
    places
}

impl Place {
    /// The fill at rest, after gravity has been raised slowly with damping.
    fn settle(&self, fault: &Fault) -> Result<Seen, RungFailure> {
        let angle = self.angle.to_radians();
        let (along, up) =
            (Vector2::new(libm::cos(angle), libm::sin(angle)), Vector2::new(-libm::sin(angle), libm::cos(angle)));
        // Exact where the scene lies along the grid.
        let (along, up) = if self.angle == 0.0 { (Vector2::x(), Vector2::y()) } else { (along, up) };
        let h = HEIGHT / self.cells as f64;
        let corner = (along * self.offset[0] + up * self.offset[1]) * h;
        let brick = Brick { angle, ..Brick::new(corner.into(), [self.cells, self.cells], h) };
        let mut points = brick.points();
        points.iter_mut().for_each(|p| p.x = self.side.seen(p.x.into()).into());
        let [along, up, corner] = [along, up, corner].map(|v| self.side.seen(v));
        let boundaries = vec![
            self.side.wall([corner + along * HEIGHT, along, up], 1.5 * HEIGHT, self.thickness * h),
            Boundary::plane("other wall", corner, along, Friction::Smooth),
            Boundary::plane("base", corner, up, Friction::Smooth),
        ];
        let mut scene = scene(&brick, FILL.law(fault), FILL.density * fault.density, points, boundaries);
        scene.numerics.pic = PicShare::Fraction(0.02);
        scene.numerics.boundary_contact = self.contact;
        let mut sim = Simulation::new(scene);
        let crossing = HEIGHT / confined_speed(&FILL.elastic, FILL.density);
        sim.set_damping(2.0 / crossing);
        let (raised, end) = (20.0 * crossing, 30.0 * crossing);
        let (mut impulse, mut moment, mut time) = (0.0, 0.0, 0.0);
        while sim.time() < end {
            let share = (sim.time() / raised).min(1.0);
            sim.set_gravity((up * (-GRAVITY * fault.gravity * share)).into());
            sim.step()?;
            if sim.time() > 28.0 * crossing {
                let tally = sim.step_tallies()[0];
                impulse -= Vector2::from(tally.impulse).dot(&along) * fault.contact_force;
                moment += tally.moment * fault.contact_force;
                time += sim.time_step().dt;
            }
        }
        let past = sim.particles().filter(|(_, p)| (Vector2::from(p.x) - corner).dot(&along) > HEIGHT).count() as f64;
        let mass = sim.bodies()[0].point_mass;
        let arm = self.side.turn() * moment / impulse;
        Ok(Seen { force: impulse / time / THICKNESS, arm, past: past * mass })
    }
}

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let mut outcome = Outcome::default();
    let poisson = FILL.elastic.poisson;
    let exact = earth_pressure::triangular_force(poisson / (1.0 - poisson), FILL.density, GRAVITY, HEIGHT);
    let lever = earth_pressure::triangular_arm(HEIGHT);
    let places = places();
    let seen: Result<Vec<_>, _> = places.par_iter().map(|p| p.settle(fault)).collect();
    let seen: Vec<(&Place, Seen)> = places.iter().zip(seen?).collect();
    let rows = seen.iter().map(|(p, s)| {
        vec![
            f64::from(u8::from(p.contact == BoundaryContact::Nodes)),
            p.thickness,
            p.offset[0],
            p.offset[1],
            p.angle,
            p.cells as f64,
            s.force / exact,
            s.arm / HEIGHT,
            s.past,
        ]
    });
    let header = [
        "contact",
        "thickness_cells",
        "offset_cells",
        "base_offset_cells",
        "angle_deg",
        "cells_over_height",
        "force_over_exact",
        "arm_over_height",
        "past_kg",
    ];
    let rows: Vec<Vec<f64>> = rows.collect();
    outcome.tables.push(("wall_place_settings".into(), named_csv(&header, &[("contact", &CONTACTS)], rows)));

    let of = |contact: BoundaryContact, turned: bool, cells: usize| {
        let own = move |p: &Place| p.contact == contact && (p.angle != 0.0) == turned && p.cells == cells;
        seen.iter().filter(move |(p, _)| own(p))
    };
    let error = |s: &Seen| s.force / exact - 1.0;
    let worst = |turned: bool, cells: usize| {
        let errors = of(BoundaryContact::Surface, turned, cells).map(|(_, s)| error(s));
        1.0 + errors.fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a })
    };
    outcome.check(
        Check::value(
            "along the grid: force on the wall over the closed form, the worst of all",
            worst(false, CELLS),
            1.0,
            "1",
        )
        .within(Tolerance::Absolute(0.01), "strains of rho g H/M = 0.4 %; what still swings after the ramp, 0.25 %")
        .from(Kind::Analytic, "nu/(1 - nu) rho g H^2 / 2"),
    );
    let forces = || of(BoundaryContact::Surface, false, CELLS).map(|(_, s)| s.force);
    let (low, high) = (forces().fold(f64::INFINITY, f64::min), forces().fold(0.0, f64::max));
    outcome.check(
        Check::at_most(
            "along the grid: greatest over least force of all places and thicknesses, less one",
            high / low - 1.0,
            0.005,
            "1",
        )
        .because("neither is physics; what still swings after the ramp is 0.25 %")
        .from(Kind::Conservation, "invariance to a shift of the grid"),
    );
    let arm = of(BoundaryContact::Surface, false, CELLS).map(|(_, s)| (s.arm - lever).abs()).fold(0.0, f64::max);
    outcome.check(
        Check::at_most(
            "along the grid: distance of the point of action from H/3, the largest",
            arm / HEIGHT,
            0.01,
            "1",
        )
        .because("a quarter of a cell is 3 % of the height; a wall is known better than that")
        .from(Kind::Analytic, "H / 3"),
    );
    let past =
        seen.iter().filter(|(p, _)| p.contact == BoundaryContact::Surface).map(|(_, s)| s.past).fold(0.0, f64::max);
    outcome.check(
        Check::at_most("mass past the wall, the most of all", past, 0.0, "kg")
            .because("a wall holds what comes from the side that it faces")
            .from(Kind::Conservation, "impenetrability"),
    );
    sides::judge(fault, exact, &mut outcome)?;
    // Under a fault it is enough that the walls along the grid notice.
    if *fault == Fault::NONE {
        turned(&|cells| of(BoundaryContact::Surface, true, cells).map(|(_, s)| error(s).abs()).collect(), &mut outcome);
    }
    if *fault == Fault::NONE {
        let off = of(BoundaryContact::Nodes, false, CELLS).map(|(_, s)| error(s).abs()).fold(0.0, f64::max);
        outcome.check(
            Check::at_most(
                "contact at nodes is refuted: one over its largest relative error".to_string(),
                1.0 / off,
                2.0,
                "1",
            )
            .because("a scene that did not tell the two apart would prove nothing")
            .from(Kind::Analytic, "nu/(1 - nu) rho g H^2 / 2"),
        );
    }
    Ok(outcome)
}

/// On a turned grid the force nears the closed form: a fill that the walls let give way by a thousandth of a cell loses a
/// tenth of its lateral stress, since confinement strains it so little. `errors` are those of all places, by cells over the height.
fn turned(errors: &dyn Fn(usize) -> Vec<f64>, outcome: &mut Outcome) {
    let [coarse, fine] = [errors(CELLS), errors(2 * CELLS)];
    let mean = |e: &[f64]| e.iter().sum::<f64>() / e.len() as f64;
    for (cells, errors) in [(CELLS, &coarse), (2 * CELLS, &fine)] {
        outcome.check(
            Check::at_most(
                format!("turned, {cells} cells over the height: relative error of the force, mean over places and thicknesses"),
                mean(errors),
                1.0 / cells as f64,
                "1",
            )
            .because("of first order: h/H")
            .from(Kind::Analytic, "nu/(1 - nu) rho g H^2 / 2"),
        );
    }
    outcome.check(
        Check::new(
            format!("turned: observed order of that error, {CELLS} to {} cells", 2 * CELLS),
            order::from_errors(mean(&coarse), mean(&fine), 2.0),
            Expected::Within(1.0, 2.0),
            "1",
        )
        .because("first order at the surface, second inside")
        .from(Kind::Convergence, "shape functions that reach past the surface"),
    );
}
