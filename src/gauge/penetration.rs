//! How deep material lies inside a structure or a boundary: the gauge that tells whether contact held.
//!
//! A structure's surface is followed through its outermost points, see [`Outline`]. A barrier whose contact works is entered
//! by less than a cell; a leaking one lets material through, and its force means nothing.

use super::beside::beside;
use crate::boundary::{Boundary, Friction};
use crate::contact::outline::{Outline, penetration};
use crate::seeded::{self, Seed};
use crate::simulation::Simulation;

/// How deep the points of other bodies lie inside a structure.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Penetration {
    /// Largest depth of a point's domain below the surface, m; 0 when none is inside.
    pub deepest: f64,
    /// Where that point is, m.
    pub at: [f64; 2],
    /// Mass of the points whose middle lies below the surface by more than `beyond`, kg.
    pub mass_beyond: f64,
}

/// Measures all points of other bodies against the body `structure` with its `outline`; `beyond` in m.
pub fn measure(simulation: &Simulation, structure: usize, outline: &Outline, beyond: f64) -> Penetration {
    let bodies = simulation.bodies();
    let radius = 0.5 * bodies[structure].point_spacing;
    let numbers = outline.points();
    let mut places = vec![None; numbers.len()];
    for (_, p) in simulation.particles().filter(|(b, _)| *b == structure) {
        if let Ok(k) = numbers.binary_search(&p.id) {
            places[k] = Some(p.x);
        }
    }
    // A point that left the domain leaves the ring open between its neighbours, which a straight line closes.
    let rings = outline.rings.iter().map(|ring| {
        let place = |id: &u32| numbers.binary_search(id).ok().and_then(|k| places[k]);
        ring.iter().filter_map(place).collect::<Vec<_>>()
    });
    let mut found = Penetration::default();
    for ring in rings.filter(|ring| ring.len() > 1) {
        let reach = bodies.iter().fold(radius, |a, b| a.max(0.5 * b.point_spacing)) + radius;
        let bounds = [0, 1]
            .map(|d| ring.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x[d]), b.max(x[d])]));
        for (body, p) in simulation.particles().filter(|(b, _)| *b != structure) {
            if (0..2).any(|d| p.x[d] < bounds[d][0] - reach || p.x[d] > bounds[d][1] + reach) {
                continue;
            }
            let size = 0.5 * bodies[body].point_spacing;
            let depth = penetration(&ring, radius, p.x, size);
            if depth > found.deepest {
                found.deepest = depth;
                found.at = p.x;
            }
            if depth - size > beyond {
                found.mass_beyond += bodies[body].point_mass;
            }
        }
    }
    found
}

/// Deepest that any point lies inside any boundary that acts on it, m, and the boundary's index. Clamps hold what lies in them and
/// do not count.
pub fn of_boundaries(simulation: &Simulation) -> (f64, usize) {
    let mut deepest = (0.0, 0);
    let solid = |b: &Boundary| !b.is_gone() && b.friction != Friction::Bonded;
    for (index, b) in simulation.boundaries().iter().enumerate().filter(|(_, b)| solid(b)) {
        // What lies in front of its face is in no boundary.
        let reach = if b.chain().is_some() { f64::INFINITY } else { 0.0 };
        beside(simulation, b, reach, |body| b.acts_on(&[body])).for_each(|near| {
            let depth = seeded::times(Seed::GaugePenetration, b.depth(near.x()));
            if depth > deepest.0 {
                deepest = (depth, index);
            }
        });
    }
    deepest
}

#[cfg(test)]
mod tests {
    use super::super::two_bodies::{point, simulation};
    use super::*;
    use crate::boundary::Opening;
    use crate::scaffold::{Brick, elastic, scene};
    use nalgebra::Vector2;

    #[test]
    fn a_brick_pushed_into_another() {
        let (law, density, h) = (elastic(1e6, 0.0), 1000.0, 0.1);
        let wall = Brick { angle: 0.3, ..Brick::new([0.0, 0.0], [4, 10], h) };
        let outline = Outline::trace(&wall.points().iter().map(|p| (p.id, p.x)).collect::<Vec<_>>(), 0.05, 0.3);
        let (c, s) = (libm::cos(0.3), libm::sin(0.3));
        for (gap, depth, beyond) in [(0.02, 0.0, 0.0), (0.0, 0.0, 0.0), (-0.03, 0.03, 0.0), (-0.12, 0.12, 2.0)] {
            // Beside the wall's left face, `gap` away from it; two columns of 4 x 2 points.
            let at = |a: f64, b: f64| [c * a - s * b, s * a + c * b];
            let other = Brick { angle: 0.3, ..Brick::new(at(-0.1 - gap, 0.4), [1, 2], h) };
            let mut scene = scene(&wall, law, density, wall.points(), vec![]);
            scene.bodies.push((other.body(law, density), other.points()));
            let simulation = Simulation::new(scene);
            let found = measure(&simulation, 0, &outline, 0.05);
            assert!((found.deepest - depth).abs() < 1e-9, "{gap}: {found:?}");
            let mass = simulation.bodies()[1].point_mass;
            // Middles at 0.095 and 0.045 below the surface: one column of four lies deeper than 0.05.
            assert!((found.mass_beyond - beyond * 2.0 * mass).abs() < 1e-12, "{gap}: {found:?}");
        }
    }

    #[test]
    fn points_that_barely_enter_are_found_on_every_side() {
        let (law, density, h) = (elastic(1e6, 0.0), 1000.0, 0.1);
        let wall = Brick::new([0.0, 0.0], [4, 10], h);
        let outline = Outline::trace(&wall.points().iter().map(|p| (p.id, p.x)).collect::<Vec<_>>(), 0.05, 0.0);
        let measured = |corner: [f64; 2]| {
            let other = Brick::new(corner, [1, 1], h);
            let mut scene = scene(&wall, law, density, wall.points(), vec![]);
            scene.bodies.push((other.body(law, density), other.points()));
            measure(&Simulation::new(scene), 0, &outline, 0.0)
        };
        // The middles of the nearest points are 15 mm outside of the surface, and 40 mm outside of the ring.
        for corner in [[-0.09, 0.4], [0.39, 0.4], [0.1, -0.09], [0.1, 0.99]] {
            let found = measured(corner);
            assert!((found.deepest - 0.01).abs() < 1e-9 && found.mass_beyond == 0.0, "{corner:?}: {found:?}");
        }
        assert_eq!(measured([-0.2, 0.4]), Penetration::default());
        assert_eq!(measured([-0.095, -0.095]), Penetration::default(), "beside the corner and not inside");
    }

    #[test]
    fn penetration_finds_the_deepest_point_and_skips_gates_that_are_gone() {
        let plane = |y: f64| Boundary::plane("base", Vector2::new(0.0, y), Vector2::new(0.0, 1.0), Friction::Smooth);
        let points = vec![point(0.0, -0.25, [0.0; 2], 1.0), point(0.0, 0.5, [0.0; 2], 1.0)];
        let heavy = vec![point(0.0, -0.125, [0.0; 2], 1.0)];
        let sim = simulation(0.1, [points.clone(), heavy.clone()], vec![plane(-1.0), plane(0.0), plane(-0.0625)]);
        assert_eq!(of_boundaries(&sim), (0.25, 1));
        for above in [-1.0, -0.25] {
            // On the surface is not inside.
            let sim = simulation(0.1, [points.clone(), heavy.clone()], vec![plane(-2.0), plane(above)]);
            assert_eq!(of_boundaries(&sim), (0.0, 0));
        }
        let mut gate = plane(0.0).gate(Opening::Vanish);
        gate.release();
        let sim = simulation(0.1, [points.clone(), heavy.clone()], vec![gate, plane(-0.0625)]);
        assert_eq!(of_boundaries(&sim), (0.1875, 1));
        let clamp = Boundary { friction: Friction::Bonded, ..plane(0.0) };
        let sim = simulation(0.1, [points, heavy], vec![clamp, plane(0.0).only_for(&[1])]);
        assert_eq!(of_boundaries(&sim), (0.125, 1), "clamps hold what lies in them; others act on their bodies alone");
    }
}
