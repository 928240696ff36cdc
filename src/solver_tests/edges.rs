//! The narrow sides of walls, between the nodes of the grid: crest and lower edge hold where they are drawn, and nothing passes at the
//! corners.

use super::*;
use crate::boundary::Friction;
use crate::constitutive::{Cone, DruckerPrager};
use crate::scaffold::run_until;
use nalgebra::Vector2;

/// Which narrow side of a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Edge {
    Crest,
    Foot,
}

/// A wall, eight cells thick, whose crest or lower edge goes through `at` and looks along `up`: two cells of it on the left of that place.
fn wall(edge: Edge, at: Vector2<f64>, up: Vector2<f64>, friction: Friction) -> Boundary {
    let right = Vector2::new(up.y, -up.x);
    let high = 5.0 * H;
    match edge {
        Edge::Crest => Boundary::wall("wall", at - right * 2.0 * H - up * high, up, high, 8.0 * H, friction),
        Edge::Foot => Boundary::wall("wall", at + right * 6.0 * H, -up, high, 8.0 * H, friction),
    }
}

#[test]
fn a_block_rests_on_the_narrow_side_of_a_wall() {
    for (edge, angle) in [Edge::Crest, Edge::Foot].into_iter().flat_map(|e| [0.0, 0.4, -1.9].map(|a| (e, a))) {
        for offset in 0..8 {
            let corner = [0.013 * f64::from(offset), 0.125 * H * f64::from(offset)];
            let up = Vector2::new(-libm::sin(angle), libm::cos(angle));
            let brick = Brick { angle, ..Brick::new(corner, [4, 3], H) };
            let boundaries = vec![wall(edge, corner.into(), up, Friction::Rough)];
            let mut scene = scene(&brick, law(), DENSITY, brick.points(), boundaries);
            scene.numerics.max_time_step = DT;
            scene.gravity = (-up * 10.0).into();
            let mut sim = Simulation::new(scene);
            sim.set_damping(40.0);
            run_until(&mut sim, 0.6).expect("steps");
            let force = Vector2::from(sim.step_tallies()[0].impulse).dot(&up) / sim.time_step().dt;
            let weight = sim.mass() * 10.0;
            assert!((force / weight - 1.0).abs() < 0.01, "{edge:?} {angle} {offset}: {force} of {weight}");
            let above = |x: [f64; 2]| (Vector2::from(x) - Vector2::from(corner)).dot(&up) / H;
            let lowest = sim.particles().map(|(_, p)| above(p.x)).fold(f64::INFINITY, f64::min);
            assert!((lowest - 0.25).abs() < 0.05, "{edge:?} {angle} {offset}: lowest points lie {lowest} cells above");
            books_balance(&sim);
        }
    }
}

#[test]
fn nothing_passes_at_the_corners_of_a_wall() {
    for (edge, angle) in [Edge::Crest, Edge::Foot].into_iter().flat_map(|e| [0.0, 0.4].map(|a| (e, a))) {
        for offset in 0..8 {
            // Half of the sand falls past the left corner, beside the wall.
            let at = Vector2::new(0.013 * f64::from(offset), 0.125 * H * f64::from(offset));
            let (up, right) =
                (Vector2::new(-libm::sin(angle), libm::cos(angle)), Vector2::new(libm::cos(angle), libm::sin(angle)));
            let brick = Brick { angle, ..Brick::new((at - right * 4.0 * H).into(), [4, 3], H) };
            let law = DruckerPrager::new(LinearElastic::new(1e5, 0.3), Cone::PlaneStrain, 0.5, 0.0, 0.0, 0.0, true);
            let b = wall(edge, at, up, Friction::Coulomb(0.2));
            let mut scene = scene(&brick, AnyLaw::DruckerPrager(law), DENSITY, brick.points(), vec![b]);
            scene.numerics.max_time_step = DT;
            scene.gravity = (-up * 10.0).into();
            let mut sim = Simulation::new(scene);
            let mut deepest = f64::NEG_INFINITY;
            for _ in 0..300 {
                sim.step().expect("a step");
                deepest = sim.particles().map(|(_, p)| sim.boundaries()[0].depth(p.x)).fold(deepest, f64::max);
            }
            assert!(deepest < 0.05 * H, "{edge:?} {angle} {offset}: a point lies {} cells inside", deepest / H);
            let beside = sim.particles().filter(|(_, p)| (Vector2::from(p.x) - at).dot(&up) < 0.0).count();
            assert!(beside > 10, "{edge:?} {angle} {offset}: {beside} points have fallen past the wall");
            books_balance(&sim);
        }
    }
}
