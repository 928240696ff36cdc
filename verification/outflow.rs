//! Sand flows out of a silo through a slot in its floor: Beverloo's law, and what the grid does to it.
//!
//! The floor is two walls whose crests leave a slot between them. The discharge is proportional to the 3/2 power of the width of the
//! slot and does not know how high the fill is; a liquid's would grow with its root. It must not depend on where the edges of the slot
//! lie between the nodes by more than what lies between two lines of the grid. The stream below the slot falls freely.
//!
//! The coefficient of the law is that of the material and has no closed form, so it is not judged.

use super::report::named_csv;
use super::scene::{Brick, Material, THICKNESS, points_by_number, scene};
use super::{Fault, FaultKind, Outcome, Rung, RungFailure};
use crate::figure::{Figure, curves, measured};
use crate::of_module;
use checkdam::boundary::{Boundary, BoundaryContact, Friction, Opening};
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::constitutive::{AnyLaw, Cone, DruckerPrager};
use checkdam::plot::curves::{Curves, panel};
use checkdam::simulation::{PicShare, Simulation};
use checkdam::theory::elastic::confined_speed;
use checkdam::theory::outflow;
use nalgebra::Vector2;
use rayon::prelude::*;

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "Sand flows out of a slot: power of the width, height of the fill, place between nodes, mirror image, cells",
    goal: "Beverloo's law; edges of walls act where they are drawn",
    source: "C rho sqrt(g) (D - k h)^(3/2) (Beverloo 1961; Staron et al. 2012 for a continuum)",
    sketch: r"
    smooth |o o o o o o| smooth     | g
           |o o o o o o|  3 to 5 D
           |o o o o o o|
    -------+==+    +===+---  two walls, four cells thick
              | oo |   D wide: 4, 8, 16 cells
",
    run,
    covers: &[(FaultKind::Gravity, 1.03), (FaultKind::Density, 1.03), (FaultKind::ContactForce, 1.03)],
    under_fault: "the load on the floor and the fall of the stream; the width has a test of its own",
    figures: FIGURES,
};

/// Its figures.
const FIGURES: &[Figure] = &[curves(
    "outflow_places",
    "outflow_places_plot",
    Curves {
        x: "place_cells",
        x_title: "place of the slot between two nodes (cells)",
        y_title: "discharge over rho sqrt(g) D^1.5",
        curves: &[measured("coefficient", "")],
        panels: &[
            panel("contact on the surface", &[("contact", "surface")]),
            panel("contact at nodes, not judged", &[("contact", "nodes")]),
        ],
        split: &[("cells_over_width", "cells over the width ")],
        ..Curves::LINEAR
    },
)];

const SAND: Material = Material::new(1.2e5, 0.3, 1500.0);
const PHI: f64 = 30.0 * std::f64::consts::PI / 180.0;
/// Of the floor.
const FRICTION: f64 = 0.4;
const GRAVITY: f64 = 9.81;
/// Width of the slot, m, unless said otherwise.
const WIDTH: f64 = 0.08;
const CELLS: usize = 8;
/// Length of the silo over the width of the slot.
const LONG: usize = 4;
/// Of the floor, cells.
const FLOOR: f64 = 4.0;
/// When the discharge is measured, in units of sqrt(D/g).
const FROM: f64 = 1.5;
const TO: f64 = 3.5;
/// Standard deviation of the discharge of a single run. Fills of 3, 4, 5 and 6 widths on sand that is four times as stiff let through
/// 0.6, 2.6, 0.4 and 3.8 % less, where stiffness should not matter.
const SCATTER: f64 = 0.017;
/// Two standard deviations of the ratio of two runs.
const TWO_RUNS: f64 = 2.0 * std::f64::consts::SQRT_2 * SCATTER;
const CONTACTS: [&str; 2] = ["surface", "nodes"];

/// A silo.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Silo {
    contact: BoundaryContact,
    /// Width of the slot, m.
    width: f64,
    /// The same over what it should be.
    drawn: f64,
    /// Cells over it.
    cells: usize,
    /// By how much the silo is moved over the grid along its floor, cells.
    place: f64,
    /// Height of the fill over the width of the slot.
    fill: usize,
}

/// What a silo shows.
#[derive(Debug, Clone, Copy)]
struct Seen {
    /// Discharge over rho sqrt(g) D^1.5.
    coefficient: f64,
    /// Load on the floor before the slot was opened over the weight.
    load: f64,
    /// Acceleration of the stream below the slot over g.
    fall: f64,
}

impl Silo {
    const BASE: Self =
        Self { contact: BoundaryContact::Surface, width: WIDTH, drawn: 1.0, cells: CELLS, place: 0.25, fill: 3 };

    /// The fill at rest on the shut floor, and the load on that over the weight.
    fn settled(&self, fault: &Fault) -> Result<(Simulation, f64), RungFailure> {
        let h = self.width / self.cells as f64;
        let at = Vector2::new;
        let (left, long) = (self.place * h, LONG as f64 * self.width);
        let brick = Brick::new([left, 0.0], [LONG * self.cells, self.fill * self.cells], h);
        let mut law = DruckerPrager::new(SAND.linear_elastic(fault), Cone::PlaneStrain, PHI, 0.0, 0.0, 0.0, true);
        law.friction *= fault.friction;
        // The floor goes on beyond the sides.
        let (right, beyond) = (left + long, FLOOR * h);
        let half = 0.5 * (long - self.drawn * self.width) + beyond;
        let floor = |foot: Vector2<f64>, along: f64, length: f64, friction: Friction| {
            let wall = Boundary::wall("floor", foot, at(along, 0.0), length, FLOOR * h, friction);
            if along < 0.0 { wall.facing_right() } else { wall }
        };
        let rubs = Friction::Coulomb(FRICTION * fault.friction);
        let [first, last] = [at(left - beyond, 0.0), at(right + beyond, 0.0)];
        let boundaries = vec![
            Boundary::plane("left", at(left, 0.0), at(1.0, 0.0), Friction::Smooth),
            Boundary::plane("right", at(right, 0.0), at(-1.0, 0.0), Friction::Smooth),
            floor(first, 1.0, half, rubs),
            floor(last, -1.0, half, rubs),
            floor(first, 1.0, long + 2.0 * beyond, Friction::Smooth).gate(Opening::Vanish),
        ];
        let density = SAND.density * fault.density;
        let mut scene = scene(&brick, AnyLaw::DruckerPrager(law), density, brick.points(), boundaries);
        scene.gravity = [0.0, -GRAVITY * fault.gravity];
        scene.numerics.pic = PicShare::Fraction(5e-4);
        scene.numerics.boundary_contact = self.contact;
        // What has fallen far is of no interest.
        scene.domain[1][0] = -4.0 * self.width;
        let mut sim = Simulation::new(scene);
        let high = self.fill as f64 * self.width;
        let crossing = high / confined_speed(&SAND.elastic, SAND.density);
        sim.set_damping(3.0 / crossing);
        let (mut impulse, mut time) = (0.0, 0.0);
        while sim.time() < 15.0 * crossing {
            sim.step()?;
            if sim.time() > 13.0 * crossing {
                impulse += sim.step_tallies()[2..].iter().map(|t| t.impulse[1]).sum::<f64>() * fault.contact_force;
                time += sim.time_step().dt;
            }
        }
        let weight = SAND.density * long * high * THICKNESS * GRAVITY;
        sim.set_damping(0.0);
        sim.set_time(0.0);
        sim.release_gates();
        Ok((sim, impulse / time / weight))
    }

    fn empty(&self, fault: &Fault) -> Result<Seen, RungFailure> {
        let (mut sim, load) = self.settled(fault)?;
        let unit = (self.width / GRAVITY).sqrt();
        let until = |sim: &mut Simulation, time: f64| -> Result<f64, RungFailure> {
            while sim.time() < time * unit {
                sim.step()?;
            }
            let below = sim.particles().filter(|(_, p)| p.x[1] < 0.0).count() as f64;
            Ok(below * sim.bodies()[0].point_mass + sim.ledger().departed_mass)
        };
        let before = until(&mut sim, FROM)?;
        let start = sim.time();
        // The stream, one to two widths below the floor, falls by another half meanwhile.
        until(&mut sim, 2.5)?;
        let (seen_at, early) = (sim.time(), points_by_number(&sim));
        until(&mut sim, 2.7)?;
        let (mut gained, mut count) = (0.0, 0.0);
        let late = points_by_number(&sim);
        for p in early.iter().filter(|p| (-2.0..-1.0).contains(&(p.x[1] / self.width))) {
            if let Ok(k) = late.binary_search_by_key(&p.id, |q| q.id) {
                gained += p.v[1] - late[k].v[1];
                count += 1.0;
            }
        }
        let fall = gained / count / (sim.time() - seen_at) / GRAVITY;
        let out = until(&mut sim, TO)? - before;
        let discharge = out / (sim.time() - start) / THICKNESS;
        let coefficient = outflow::coefficient(discharge, SAND.density, GRAVITY, self.width);
        Ok(Seen { coefficient, load, fall })
    }
}

/// Coefficients of silos with the slot at these eighths of a cell.
fn at_places(cells: usize, contact: BoundaryContact, eighths: &[u32]) -> Vec<Silo> {
    eighths.iter().map(|&k| Silo { cells, contact, place: f64::from(k) / 8.0, ..Silo::BASE }).collect()
}

/// Eighths of a cell at which the power of the width is looked for.
const POWER_AT: [u32; 3] = [1, 2, 3];

/// The observed power of the width, by slots and slots of half their width, the first drawn so many times as wide as they should be.
fn power(drawn: f64, fault: &Fault) -> Result<f64, RungFailure> {
    let wide = at_places(CELLS, BoundaryContact::Surface, &POWER_AT);
    let slots: Vec<Silo> =
        wide.iter().flat_map(|s| [Silo { drawn, ..*s }, Silo { width: 0.5 * s.width, ..*s }]).collect();
    let seen: Vec<Seen> = slots.par_iter().map(|s| s.empty(fault)).collect::<Result<_, _>>()?;
    let logarithms = seen.chunks(2).map(|two| libm::log2(two[0].coefficient / two[1].coefficient));
    Ok(1.5 + logarithms.sum::<f64>() / POWER_AT.len() as f64)
}

/// What scatter leaves of the power open.
fn power_tolerance() -> f64 {
    TWO_RUNS / (POWER_AT.len() as f64).sqrt() / std::f64::consts::LN_2
}

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let mut outcome = Outcome::default();
    let base = Silo::BASE.empty(fault)?;
    outcome.check(
        Check::value("load on the shut floor over the weight of the fill", base.load, 1.0, "1")
            .within(Tolerance::Absolute(0.01), "what still swings after fifteen crossings with damping, less than that")
            .from(Kind::Analytic, "statics"),
    );
    outcome.check(
        Check::value("acceleration of the stream below the slot over g", base.fall, 1.0, "1")
            .within(
                Tolerance::Absolute(0.01),
                "a stream that comes apart has no stress; the mean of some hundred points",
            )
            .from(Kind::Analytic, "free fall"),
    );
    // A factor on gravity, density or force is the same for all silos: their ratios tell nothing of it.
    if *fault != Fault::NONE {
        return Ok(outcome);
    }
    outcome.check(
        Check::value(
            "power of the width, from slots and slots half as wide on as many cells",
            power(1.0, fault)?,
            1.5,
            "1",
        )
        .within(
            Tolerance::Absolute(power_tolerance()),
            "two standard deviations of three pairs of runs of 1.7 % each, over a factor of two",
        )
        .from(Kind::Analytic, "Beverloo et al. (1961)"),
    );
    let fills: Vec<f64> = [4, 5]
        .par_iter()
        .map(|&fill| Ok(Silo { fill, ..Silo::BASE }.empty(fault)?.coefficient))
        .collect::<Result<_, RungFailure>>()?;
    for (fill, coefficient) in [4, 5].into_iter().zip(&fills) {
        outcome.check(
            Check::value(
                format!("discharge of a fill of {fill} widths over that of three"),
                coefficient / base.coefficient,
                1.0,
                "1",
            )
            .within(
                Tolerance::Absolute(TWO_RUNS),
                "two standard deviations of two runs; a liquid's would be 15 and 29 % more",
            )
            .from(Kind::Analytic, "Beverloo et al. (1961)"),
        );
    }
    places(fault, &mut outcome)?;
    Ok(outcome)
}

/// What the place of the slot between the nodes does, and the number of cells over its width.
fn places(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    const ALL: &[u32] = &[0, 1, 2, 3, 4, 5, 6, 7];
    const SOME: &[u32] = &[0, 2, 4, 6];
    let mut silos = at_places(16, BoundaryContact::Surface, SOME);
    silos.extend(at_places(CELLS, BoundaryContact::Surface, ALL));
    silos.extend(at_places(4, BoundaryContact::Surface, SOME));
    silos.extend(at_places(CELLS, BoundaryContact::Nodes, ALL));
    let seen: Vec<Seen> = silos.par_iter().map(|s| s.empty(fault)).collect::<Result<_, _>>()?;
    let coefficients_of = |contact: BoundaryContact, cells: usize| -> Vec<(f64, f64)> {
        let own = silos.iter().zip(&seen).filter(|(s, _)| s.contact == contact && s.cells == cells);
        own.map(|(s, seen)| (s.place, seen.coefficient)).collect()
    };
    let coefficients = |cells: usize| coefficients_of(BoundaryContact::Surface, cells);
    let mirrored = coefficients(CELLS);
    let apart = mirrored.iter().flat_map(|(place, c)| {
        let image = mirrored.iter().find(|(other, _)| *place > 0.0 && *other == 1.0 - place);
        image.map(|(_, other)| (other / c - 1.0).abs())
    });
    outcome.check(
        Check::at_most(
            "mirror image: relative difference of the discharge, the largest of three",
            apart.fold(0.0, f64::max),
            0.005,
            "1",
        )
        .because("round-off; two of five hundred points that pass a step later")
        .from(Kind::Conservation, "invariance to reflection"),
    );
    let mean = |cells: usize| {
        let all = coefficients(cells);
        all.iter().map(|(_, c)| c).sum::<f64>() / all.len() as f64
    };
    // By how much the width must differ for the discharge to differ as it does, in cells.
    let moved = |contact: BoundaryContact, cells: usize| {
        let all = coefficients_of(contact, cells);
        let (low, high) = all.iter().fold((f64::INFINITY, 0.0f64), |(l, h), (_, c)| (l.min(*c), h.max(*c)));
        cells as f64 * (libm::pow(high / low, 2.0 / 3.0) - 1.0)
    };
    for cells in [CELLS, 16] {
        outcome.check(
            Check::at_most(
                format!("{cells} cells: by how much the place of the slot between the nodes moves its width"),
                moved(BoundaryContact::Surface, cells),
                1.0,
                "cells",
            )
            .because("the grid knows an edge to half a cell, and a slot has two")
            .from(Kind::Conservation, "invariance to a shift of the grid"),
        );
    }
    outcome.check(
        Check::at_most(
            "contact at nodes is refuted: one over what the place of the slot moves there",
            1.0 / moved(BoundaryContact::Nodes, CELLS),
            1.0,
            "1/cells",
        )
        .because("a scene that did not tell the two apart would prove nothing")
        .from(Kind::Conservation, "invariance to a shift of the grid"),
    );
    for cells in [4, CELLS] {
        outcome.check(
            Check::value(
                format!("width that is lost, k, from {cells} and {} cells, mean over the places", 2 * cells),
                outflow::lost_cells(cells as f64, mean(cells), mean(2 * cells)),
                0.0,
                "cells",
            )
            .within(
                Tolerance::Absolute(1.0),
                "between wall and opening the velocity rises over a cell: half of it at either edge",
            )
            .from(Kind::Convergence, "Beverloo et al. (1961), with the cell in the place of the grain"),
        );
    }
    let rows = silos.iter().zip(&seen).map(|(s, seen)| {
        let contact = f64::from(u8::from(s.contact == BoundaryContact::Nodes));
        vec![contact, s.cells as f64, s.place, seen.coefficient, seen.fall]
    });
    let header = ["contact", "cells_over_width", "place_cells", "coefficient", "fall_over_g"];
    outcome.tables.push(("outflow_places".into(), named_csv(&header, &[("contact", &CONTACTS)], rows)));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slot_that_is_three_percent_too_wide_or_too_narrow_is_seen() {
        for drawn in [0.97, 1.03] {
            let power = power(drawn, &Fault::NONE).expect("it runs");
            assert!((power - 1.5).abs() > power_tolerance(), "{drawn}: {power}");
        }
    }
}
