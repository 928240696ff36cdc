//! What acts throughout the material.

use super::*;
use crate::body::Particle;
use crate::constitutive::Stress;
use crate::scaffold::{Lcg, THICKNESS, points_by_number};
use crate::shape::ShapeFunction;
use crate::simulation::{AccelerationField, PicShare, Scheme};
use std::sync::Arc;

#[test]
fn side_walls_brake_with_the_out_of_plane_pressure() {
    // Friction mu p on two walls over the area V/b each: a = 2 mu p / (rho b), against the motion; at 0.8 of the volume.
    let (mu, p, ratio) = (0.3, 2500.0, 0.8);
    let rate = 2.0 * mu * p * ratio / (DENSITY * THICKNESS);
    for (v, pressure, rate) in [([0.3, -0.4], p, rate), ([-0.5, 0.0], p, rate), ([0.3, 0.4], -p, 0.0)] {
        let mut scene = block(v, vec![]);
        scene.side_wall_friction = mu;
        for q in &mut scene.bodies[0].1 {
            q.state.stress = Stress { zz: -pressure, ..Stress::default() };
            q.volume_ratio = ratio;
        }
        let sim = run(scene.clone(), 20);
        let left = 1.0 - rate * 20.0 * DT / 0.5;
        assert!(moves_with(&sim, [v[0] * left, v[1] * left]), "{v:?}");
        let drag = sim.ledger().side_walls;
        let mass = sim.mass();
        assert!((0..2).all(|d| close(drag.impulse[d], mass * v[d] * (left - 1.0))), "{drag:?}");
        assert!(close(drag.work, 0.5 * mass * 0.25 * (left * left - 1.0)), "{drag:?}");
        assert_eq!(sim.energy_balance(&sim.stock(), [0.0; 2]).side_walls, -drag.work);
        // In 42 steps it comes to rest, and stays there.
        let mut free = scene.clone();
        let sim = run(scene, 60);
        assert!(moves_with(&sim, if rate > 0.0 { [0.0; 2] } else { v }));
        assert!(books_balance(&sim).abs() < 1e-12);
        // A body that they do not touch goes on.
        free.bodies[0].0.between_side_walls = false;
        assert!(moves_with(&run(free, 60), v));
    }
}

#[test]
fn damping_takes_its_share_of_the_momentum_in_every_step() {
    let mut sim = Simulation::new(block([0.3, -0.4], vec![]));
    sim.set_damping(20.0);
    let sim = stepped(sim, 10);
    let left = (1.0 - 20.0 * DT).powi(10);
    assert!(moves_with(&sim, [0.3 * left, -0.4 * left]));
    let drag = sim.ledger().damping;
    assert!(
        close(drag.impulse[0], sim.mass() * 0.3 * (left - 1.0))
            && close(drag.impulse[1], sim.mass() * 0.4 * (1.0 - left))
    );
    assert!(close(drag.work, 0.5 * sim.mass() * 0.25 * (left * left - 1.0)));
    assert!(books_balance(&sim).abs() < 1e-12);
    // More than everything cannot be taken.
    let mut sim = Simulation::new(block([0.3, -0.4], vec![]));
    sim.set_damping(1e5);
    let sim = stepped(sim, 1);
    assert!(moves_with(&sim, [0.0; 2]));
}

#[test]
fn a_uniform_field_is_gravity() {
    let g = [1.5, -7.0];
    let schemes = [Scheme::Usf, Scheme::Usl, Scheme::Musl];
    let shapes = [ShapeFunction::Linear, ShapeFunction::Ugimp, ShapeFunction::Bspline];
    for (scheme, shape) in schemes.into_iter().flat_map(|scheme| shapes.map(|shape| (scheme, shape))) {
        let mut with_gravity = block([0.5, 0.2], vec![]);
        with_gravity.numerics.scheme = scheme;
        with_gravity.numerics.shape = shape;
        let mut with_field = Simulation::new(with_gravity.clone());
        with_gravity.gravity = g;
        with_field.set_field(Some(AccelerationField(Arc::new(move |_, _| g))));
        let (sim, with_field) = (run(with_gravity, 10), stepped(with_field, 10));
        let v = [0.5 + g[0] * 10.0 * DT, 0.2 + g[1] * 10.0 * DT];
        assert!(moves_with(&sim, v) && moves_with(&with_field, v), "{scheme:?}");
        let (fall, field) = (sim.ledger().gravity, with_field.ledger().field);
        assert!((0..2).all(|d| close(fall[d], sim.mass() * g[d] * 10.0 * DT) && close(field.impulse[d], fall[d])));
        let gained = with_field.stock().kinetic - with_field.opening().kinetic;
        assert!(close(field.work, gained), "{scheme:?}: {} {gained}", field.work);
        assert!((books_balance(&sim) - free_fall_residual(&sim, g)).abs() < 1e-11);
        assert!(books_balance(&with_field).abs() < 1e-12);
        // And it can be removed.
        let mut sim = with_field;
        sim.set_field(None);
        let sim = stepped(sim, 5);
        assert!(moves_with(&sim, v));
    }
}

#[test]
fn a_field_knows_the_point_and_the_time() {
    let mut sim = Simulation::new(block([0.0; 2], vec![]));
    sim.set_time(5.0);
    sim.set_field(Some(AccelerationField(Arc::new(|p: &Particle, t| [t + f64::from(p.id), p.x[1]]))));
    let sim = stepped(sim, 1);
    let points = points_by_number(&sim);
    let mean = |f: &dyn Fn(&Particle) -> f64| points.iter().map(f).sum::<f64>() / points.len() as f64;
    let ids = mean(&|p| f64::from(p.id));
    assert!(close(mean(&|p| p.v[0]), (5.0 + ids) * DT) && close(mean(&|p| p.v[1]), 0.15 * DT));
    assert!(close(sim.time(), 5.0 + DT));
}

#[test]
fn a_pic_rate_is_a_fraction_at_the_time_step() {
    assert_eq!(PicShare::Rate(30.0).fraction(DT), 0.03);
    assert_eq!(PicShare::Rate(3e4).fraction(DT), 1.0);
    assert_eq!(PicShare::Fraction(0.2).fraction(DT), 0.2);
    // With nothing but PIC, velocities are filtered and what they lose is booked.
    let mut noisy = block([0.1, 0.2], vec![]);
    let mut noise = Lcg::new(1);
    noisy.bodies[0].1.iter_mut().for_each(|p| p.v = [noise.signed(), noise.signed()]);
    let energy = |pic| {
        let mut scene = noisy.clone();
        scene.numerics.pic = pic;
        let sim = run(scene, 1);
        books_balance(&sim);
        assert!(close(
            sim.opening().kinetic - sim.stock().kinetic,
            sim.ledger().pic_loss - sim.ledger().internal_work * 0.0
        ));
        sim.stock().kinetic
    };
    assert_eq!(energy(PicShare::Rate(30.0)), energy(PicShare::Fraction(0.03)));
    assert!(energy(PicShare::Fraction(1.0)) < 0.7 * energy(PicShare::Fraction(0.0)));
}

#[test]
fn what_acts_throughout_a_body_changes_its_momentum() {
    // Gravity, damping, side walls and a field at once; and without weight.
    for weightless in [false, true] {
        let mut scene = block([0.3, -0.4], vec![]);
        (scene.side_wall_friction, scene.gravity) = (0.3, [2.0, -9.81]);
        scene.bodies[0].0.weightless = weightless;
        scene.bodies[0].1.iter_mut().for_each(|p| p.state.stress = Stress { zz: -2500.0, ..Stress::default() });
        let mut sim = Simulation::new(scene);
        sim.set_damping(20.0);
        sim.set_field(Some(AccelerationField(Arc::new(|_, _| [3.0, 5.0]))));
        let before = sim.stock().momentum;
        sim.step().unwrap();
        let (after, given) = (sim.stock().momentum, sim.distributed_impulse_of(0));
        assert!((0..2).all(|d| close(given[d], after[d] - before[d])), "{given:?} {before:?} {after:?}");
        assert_eq!(sim.distributed_impulse_of(1), [0.0; 2]);
    }
}
