//! Boundaries that move or open, several bodies, and points that travel and leave.

use super::*;
use crate::body::{Body, Particle};
use crate::boundary::{Friction, Opening};
use crate::constitutive::Stress;
use crate::scaffold::{THICKNESS, points_by_number};
use nalgebra::Vector2;

#[test]
fn what_leaves_the_domain_is_booked() {
    // A block under pressure flies out to the right and over a wall that faces left.
    let wall = Boundary::wall("wall", Vector2::new(0.45, -2.0), Vector2::new(0.0, 1.0), 1.0, 0.1, Friction::Smooth);
    let mut scene = block([5.0, 1.0], vec![wall]);
    scene.gravity = [2.0, -9.81];
    scene.bodies[0].1.iter_mut().for_each(|p| p.state.stress = Stress { zz: -3000.0, ..Stress::default() });
    scene.domain = [[-1.0, 0.62], [-1.0, 0.9]];
    let sim = run(scene, 80);
    let ledger = sim.ledger();
    assert!(ledger.departed_mass > 0.2 * sim.opening().mass && sim.particle_count() > 0);
    assert!(close(ledger.departed_momentum[0] / ledger.departed_mass, 5.0) || ledger.departed_momentum[0] > 0.0);
    assert!(sim.particles().all(|(_, p)| p.x[0] <= 0.62 + 2.0 * H));
    // What fell for how long lies between what is left and what there was.
    let residual = books_balance(&sim);
    let least = free_fall_residual(&sim, [2.0, -9.81]);
    assert!(residual > least && residual < least * sim.opening().mass / sim.mass(), "{residual} {least}");
    // Every edge of the domain lets out, and only out.
    for (v, domain) in [
        ([-5.0, 0.0], [[-0.1, 9.0], [-9.0, 9.0]]),
        ([5.0, 0.0], [[-9.0, 0.5], [-9.0, 9.0]]),
        ([0.0, -5.0], [[-9.0, 9.0], [-0.1, 9.0]]),
        ([0.0, 5.0], [[-9.0, 9.0], [-9.0, 0.4]]),
    ] {
        let mut scene = block(v, vec![]);
        scene.domain = domain;
        let sim = Simulation::new(scene);
        assert_eq!((sim.domain(), sim.particle_count()), (domain, 48));
        let sim = stepped(sim, 160);
        assert_eq!((sim.particle_count(), sim.node_count()), (0, 0), "{v:?}");
        assert!(close(sim.ledger().departed_momentum[0], 120.0 * DENSITY * 1e-4 * v[0]) || v[0] == 0.0);
        assert!(books_balance(&sim).abs() < 1e-9);
    }
}

#[test]
fn a_gate_holds_until_it_is_released() {
    let gate = |opening| {
        Boundary::wall("gate", Vector2::new(4.0 * H, -H), Vector2::new(0.0, 1.0), 6.0 * H, H, Friction::Smooth)
            .gate(opening)
    };
    let mut sim = run(block([1.0, 0.0], vec![gate(Opening::Vanish)]), 1);
    assert!(close(sim.ledger().boundaries[0].impulse[0], sim.step_tallies()[0].impulse[0]));
    assert!(sim.step_tallies()[0].impulse[0] < 0.0 && sim.holds().count() > 0);
    sim.release_gates();
    sim.step().unwrap();
    assert!(sim.step_tallies()[0].impulse == [0.0; 2] && sim.holds().count() == 0);
    // A gate that is lifted by a cell in 100 steps lets go of the lowest nodes first.
    let mut sim =
        Simulation::new(block([0.0; 2], vec![gate(Opening::Lift { speed: H / (100.0 * DT), opening: 6.0 * H })]));
    sim.set_gravity([1.0, 0.0]);
    sim.release_gates();
    let mut heights = Vec::new();
    for _ in 0..350 {
        sim.step().unwrap();
        heights.push(sim.boundaries()[0].free_below);
    }
    assert!(close(heights[349], 3.5 * H), "{}", heights[349]);
    let front =
        |low: bool| sim.particles().filter(|(_, p)| (p.x[1] < H) == low).map(|(_, p)| p.x[0]).fold(0.0, f64::max);
    assert!(front(true) > front(false) && front(false) > 0.375, "{} {}", front(true), front(false));
}

#[test]
fn a_moving_boundary_pushes() {
    let wall = Boundary::wall("wall", Vector2::new(0.0, -H), Vector2::new(0.0, 1.0), 6.0 * H, H, Friction::Smooth);
    let mut sim = Simulation::new(block([0.0; 2], vec![wall.facing_right()]));
    assert_eq!((sim.boundary_index("wall"), sim.boundary_index("gate")), (Some(0), None));
    sim.set_boundary_velocity(0, [0.5, 0.0]);
    let sim = stepped(sim, 40);
    assert!(close(sim.boundaries()[0].foot().x, 0.5 * 40.0 * DT));
    let balance = sim.energy_balance(&sim.stock(), [0.0; 2]);
    assert!(balance.contact[0] < 0.0 && sim.stock().momentum[0] > 0.0);
    books_balance(&sim);
}

#[test]
fn bodies_keep_their_own_mass_and_law() {
    let mut scene = block([1.0, 0.0], vec![]);
    let (light, points) = scene.bodies[0].clone();
    let stiff = AnyLaw::LinearElastic(LinearElastic::new(4e5, 0.0));
    let heavy = Body { name: "heavy".into(), law: stiff, point_mass: 3.0 * light.point_mass, ..light };
    let moved = points.iter().map(|p| Particle { x: [p.x[0] + 1.0, p.x[1] + 0.5], v: [0.0, -2.0], ..*p }).collect();
    scene.bodies.push((heavy, moved));
    let mut sim = Simulation::new(scene);
    let m = 48.0 * sim.bodies()[0].point_mass;
    assert!(close(sim.mass(), 4.0 * m) && sim.particle_count() == 96);
    assert_eq!((sim.spacing(), sim.thickness(), sim.gravity()), (H, THICKNESS, [0.0; 2]));
    assert!(close(sim.stock().kinetic, 0.5 * m * (1.0 + 3.0 * 4.0)));
    sim.set_gravity([0.0, -9.81]);
    assert_eq!(sim.gravity(), [0.0, -9.81]);
    sim.open_ledger();
    let weights = m * (0.15 + 3.0 * 0.65);
    assert!(close(sim.stock().gravitational, 9.81 * weights));
    let sim = stepped(sim, 10);
    assert_eq!(sim.steps(), 10);
    for (body, p) in sim.particles() {
        let v = [[1.0, 0.0], [0.0, -2.0]][body];
        assert!(close(p.v[0], v[0]) && close(p.v[1], v[1] - 9.81 * 10.0 * DT));
    }
    assert!((books_balance(&sim) - free_fall_residual(&sim, [0.0, 9.81])).abs() < 1e-10);
}

#[test]
fn points_keep_their_number_and_are_counted_once() {
    // Wide enough for several bands; a long flight with many sorts.
    let brick = Brick::new([-1.0, 2.0], [150, 8], 0.01);
    let mut points = brick.points();
    points.iter_mut().for_each(|p| p.v = [1.0 + 0.1 * p.x[1], -2.0 + 0.1 * p.x[0]]);
    let started = points.clone();
    let sim = run(scene(&brick, law(), DENSITY, points, vec![]), 60);
    let now = points_by_number(&sim);
    assert_eq!(now.len(), started.len());
    assert!(sim.time() > 0.01);
    for (a, b) in started.iter().zip(&now) {
        assert_eq!(a.id, b.id);
        assert!((b.x[0] - a.x[0] - sim.time()).abs() < 0.4 * sim.time());
        assert!((b.x[1] - a.x[1] + 2.0 * sim.time()).abs() < 0.4 * sim.time());
    }
    books_balance(&sim);
}

#[test]
fn strained_material_takes_its_energy_along_when_it_leaves() {
    // Under 3 kPa across the plane and at nine tenths of its volume: p^2/2E per volume.
    let mut scene = block([5.0, -1.0], vec![]);
    for p in &mut scene.bodies[0].1 {
        p.state.stress = Stress { zz: -3000.0, ..Stress::default() };
        p.volume_ratio = 0.9;
    }
    scene.gravity = [0.0, -2.0];
    let energy = 3000.0f64.powi(2) / 2e5 * 0.9 * 0.12 * THICKNESS;
    let mut sim = Simulation::new(scene.clone());
    assert!(sim.node_count() >= 5 * 4);
    assert!(close(sim.stock().elastic, energy) && close(sim.opening().elastic, energy));
    // Energies count from the datum.
    let balance = sim.energy_balance(&sim.stock(), [7.0, 0.05]);
    assert!(close(balance.gravitational, sim.mass() * 2.0 * 0.1) && balance.residual.abs() < 1e-9, "{balance:?}");
    assert!(close(balance.initial, balance.kinetic + balance.gravitational + energy));
    sim.set_gravity([0.0; 2]);
    sim.open_ledger();
    let sim = {
        let mut scene = scene;
        scene.gravity = [0.0; 2];
        scene.domain = [[-9.0, 0.5], [-9.0, 9.0]];
        run(scene, 160)
    };
    let ledger = sim.ledger();
    assert_eq!(sim.particle_count(), 0);
    assert!(close(ledger.departed_energy, 0.5 * 12.0 * 26.0 * DENSITY * 0.01 * THICKNESS + energy));
    assert!(close(ledger.internal_work, -energy));
}

#[test]
fn all_impulses_count_in_the_scale_of_the_ledger() {
    let base = Boundary::plane("base", Vector2::zeros(), Vector2::new(0.0, 1.0), Friction::Coulomb(0.2));
    let mut scene = block([0.5, -1.0], vec![base]);
    scene.gravity = [1.5, -9.81];
    let sim = run(scene, 1);
    let [px, py] = sim.ledger().boundaries[0].impulse;
    assert!(px < 0.0 && py > 0.0);
    assert!(close(sim.ledger().impulse_scale, sim.mass() * (1.5 + 9.81) * DT - px + py));
}

#[test]
fn stresses_do_the_work_that_is_stored() {
    let mut scene = block([0.0; 2], vec![]);
    scene.bodies[0].1.iter_mut().for_each(|p| p.v = [-0.3 * p.x[0], 0.1 * p.x[1]]);
    scene.numerics.scheme = crate::simulation::Scheme::Usl;
    let mut sim = run(scene, 10);
    let (stored, work) = (sim.stock().elastic, sim.ledger().internal_work);
    assert!(stored > 1e-4 && (work / stored - 1.0).abs() < 0.02, "{work} {stored}");
    // From now on with PIC alone, which takes kinetic energy at once.
    assert_eq!(sim.ledger().pic_loss, 0.0);
    sim.set_pic(crate::simulation::PicShare::Fraction(1.0));
    sim.step().unwrap();
    assert!(sim.ledger().pic_loss > 0.0);
}

#[test]
fn a_floor_stops_every_column_alike() {
    // Wide enough for several bands. It falls by almost a cell, so that in the end the lowest nodes that it can reach before the
    // next sort hold it.
    let floor = Boundary::plane("floor", Vector2::new(0.0, -H), Vector2::new(0.0, 1.0), Friction::Smooth);
    let brick = Brick::new([0.0, 0.6 * H], [120, 4], H);
    let mut points = brick.points();
    points.iter_mut().for_each(|p| p.v = [0.0, -1.0]);
    let mut scene = scene(&brick, law(), DENSITY, points, vec![floor]);
    scene.numerics.max_time_step = DT;
    let sim = run(scene, 97);
    let points = points_by_number(&sim);
    assert!(points[0].v[1] > -0.999 && points[0].v[1] < -0.1, "{:?}", points[0]);
    for (k, p) in points.iter().enumerate() {
        assert!((p.v[1] - points[k - k % 240].v[1]).abs() < 1e-12, "{p:?}");
    }
}

#[test]
fn musl_strains_with_the_velocities_that_points_have_after_the_update() {
    // Usf does so with those that they have at the start of a step, before anything moves.
    use crate::simulation::Scheme;
    let mut before = block([0.0; 2], vec![]);
    before.bodies[0].1.iter_mut().for_each(|p| p.v = [-3.0 * p.x[0] * p.x[1], 2.0 * p.x[0] * p.x[0]]);
    before.numerics.pic = crate::simulation::PicShare::Fraction(0.5);
    let mut after = before.clone();
    let musl = points_by_number(&run(before, 1));
    after.numerics.scheme = Scheme::Usf;
    for (p, new) in after.bodies[0].1.iter_mut().zip(&musl) {
        p.v = new.v;
    }
    for (a, b) in musl.iter().zip(points_by_number(&run(after, 1))) {
        let (s, t) = (a.state.stress, b.state.stress);
        assert!((s.xx - t.xx).abs() + (s.yy - t.yy).abs() + (s.xy - t.xy).abs() < 1e-9, "{a:?} {b:?}");
        assert!(s.xy != 0.0);
    }
}

#[test]
fn stresses_turn_with_the_material() {
    // A turn by 0.05 rad, counter-clockwise, about the middle.
    let mut scene = block([0.0; 2], vec![]);
    for p in &mut scene.bodies[0].1 {
        p.v = [-5.0 * (p.x[1] - 0.15), 5.0 * (p.x[0] - 0.2)];
        p.state.stress = Stress { xx: 10.0, yy: -10.0, ..Stress::default() };
    }
    // So soft that it does not answer.
    scene.bodies[0].0.law = AnyLaw::LinearElastic(LinearElastic::new(10.0, 0.0));
    let sim = run(scene, 10);
    for (_, p) in sim.particles().filter(|(_, p)| (p.x[0] - 0.2).abs() < 0.06 && (p.x[1] - 0.15).abs() < 0.06) {
        assert!((p.state.stress.xy - 10.0 * libm::sin(0.1)).abs() < 0.05, "{p:?}");
    }
}
