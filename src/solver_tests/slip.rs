//! Boundaries whose friction needs slip: what remembers it, and what does not matter.

use super::*;
use crate::body::Slip;
use crate::boundary::Friction;
use crate::scaffold::{centre, points_by_number};
use crate::shape::ShapeFunction;
use crate::simulation::Scheme;
use nalgebra::Vector2;

const LENGTH: f64 = 0.01;
const FRICTION: f64 = 0.5;

/// A plane at `angle` (rad) through the corner of the block.
fn plane(angle: f64) -> Boundary {
    let normal = Vector2::new(-libm::sin(angle), libm::cos(angle));
    Boundary::plane("base", Vector2::zeros(), normal, Friction::Coulomb(FRICTION)).mobilised(LENGTH, FRICTION)
}

fn heavy(mut scene: Scene, along: f64) -> Scene {
    scene.gravity = [along, -10.0];
    scene
}

#[test]
fn it_hangs_on_elastic_slip_with_every_shape_function_and_scheme() {
    for shape in [ShapeFunction::Linear, ShapeFunction::Ugimp, ShapeFunction::Bspline] {
        for scheme in [Scheme::Musl, Scheme::Usl, Scheme::Usf] {
            let mut scene = heavy(block([0.0; 2], vec![plane(0.0)]), 2.0);
            (scene.numerics.shape, scene.numerics.scheme) = (shape, scheme);
            let mut sim = Simulation::new(scene);
            sim.set_damping(60.0);
            let sim = stepped(sim, 1500);
            let slips: Vec<f64> = sim.particles().map(|(_, p)| p.slip.elastic[0]).filter(|s| *s != 0.0).collect();
            let mean = slips.iter().sum::<f64>() / slips.len() as f64;
            // The mean over points, of a soft block.
            assert!((mean / (LENGTH * 2.0 / 10.0 / FRICTION) - 1.0).abs() < 0.02, "{shape:?} {scheme:?}: {mean} m");
            // F^2 / 2K
            let stored = 0.5 * sim.mass() * 2.0 * mean;
            assert!((sim.ledger().elastic_slip[0] / stored - 1.0).abs() < 0.02, "{shape:?} {scheme:?}");
        }
    }
}

#[test]
fn only_points_at_the_surface_remember_and_along_it() {
    let mut scene = heavy(block([0.0; 2], vec![plane(0.3)]), -1.0);
    let (sin, cos) = (libm::sin(0.3), libm::cos(0.3));
    let turned = |[x, y]: [f64; 2]| [cos * x - sin * y, sin * x + cos * y];
    scene.bodies[0].1.iter_mut().for_each(|p| p.x = turned(p.x));
    let sim = run(scene, 200);
    let mut seen = 0;
    for (_, p) in sim.particles() {
        let height = -sim.boundaries()[0].depth(p.x);
        let [a, b] = p.slip.elastic;
        assert!((cos * b - sin * a).abs() < 1e-12, "along the surface: {a} {b}");
        assert!(height < 2.0 * H || p.slip == Slip::default(), "{height}");
        seen += usize::from(p.slip != Slip::default());
    }
    assert!(seen > 8, "{seen}");
}

#[test]
fn what_leaves_the_surface_forgets() {
    let mut sim = run(heavy(block([0.5, 0.0], vec![plane(0.0)]), 0.0), 50);
    assert!(sim.particles().any(|(_, p)| p.slip.elastic[0] > 0.5 * LENGTH && p.slip.worn > 0.0));
    sim.set_gravity([0.0, 50.0]);
    let sim = stepped(sim, 200);
    assert!(sim.particles().all(|(_, p)| p.slip == Slip::default()), "{:?}", centre(&sim));
    assert_eq!(sim.ledger().elastic_slip, [0.0]);
}

#[test]
fn in_a_corner_each_surface_has_its_own() {
    // Pushed into a corner: it sinks along the wall and is driven along the base.
    let wall =
        Boundary::plane("wall", Vector2::new(4.0 * H, 0.0), Vector2::new(-1.0, 0.0), Friction::Coulomb(FRICTION));
    let boundaries = vec![plane(0.0), wall.mobilised(LENGTH, FRICTION)];
    let mut sim = Simulation::new(heavy(block([0.0; 2], boundaries), 8.0));
    sim.set_damping(60.0);
    let sim = stepped(sim, 1500);
    // The wall takes what the base does not.
    let [base, wall] = [0, 1].map(|k| sim.step_tallies()[k].impulse.map(|p| p / sim.time_step().dt));
    let weight = sim.mass() * 10.0;
    assert!((base[1] + wall[1] - weight).abs() < 0.01 * weight, "{base:?} {wall:?}");
    assert!((base[0] + wall[0] + 0.8 * weight).abs() < 0.01 * weight, "{base:?} {wall:?}");
    assert!(base[0] < 0.0 && -base[0] < FRICTION * base[1] && wall[1].abs() < -FRICTION * wall[0], "{base:?} {wall:?}");
}

#[test]
fn the_order_of_the_points_does_not_matter() {
    let scene = |reversed: bool| {
        let mut scene = heavy(block([1.0, 0.0], vec![plane(0.0)]), 0.0);
        if reversed {
            scene.bodies[0].1.reverse();
        }
        scene
    };
    let [one, other] = [false, true].map(|r| points_by_number(&run(scene(r), 150)));
    assert!(one.iter().any(|p| p.slip.elastic[0] > 0.9 * LENGTH));
    for (a, b) in one.iter().zip(&other) {
        assert!((a.x[0] - b.x[0]).abs() < 1e-12 && (a.slip.elastic[0] - b.slip.elastic[0]).abs() < 1e-12);
    }
}
