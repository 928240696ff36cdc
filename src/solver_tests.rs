//! Whole steps of the solver against closed forms that no rung of the ladder covers: side walls, damping, PIC rates, fields,
//! gates, departures, failures.

use crate::body::{Body, Particle};
use crate::boundary::{Boundary, Friction, Opening};
use crate::constitutive::{AnyLaw, LinearElastic, Stress};
use crate::ledger::Stock;
use crate::simulation::{AccelerationField, PicShare, Scene, Scheme, Simulation};
use crate::verification::scene::{Brick, Lcg, THICKNESS, points_by_number, scene};
use nalgebra::Vector2;
use std::sync::Arc;

const H: f64 = 0.1;
const DENSITY: f64 = 1000.0;
/// Time step of every scene here, s.
const DT: f64 = 1e-3;

fn law() -> AnyLaw {
    AnyLaw::LinearElastic(LinearElastic::new(1e5, 0.0))
}

/// A block of 4 by 3 cells that moves with `v`, without forces.
fn block(v: [f64; 2], boundaries: Vec<Boundary>) -> Scene {
    let brick = Brick::new([0.0; 2], [4, 3], H);
    let mut points = brick.points();
    points.iter_mut().for_each(|p| p.v = v);
    let mut scene = scene(&brick, law(), DENSITY, points, boundaries);
    scene.numerics.max_time_step = DT;
    scene
}

fn run(scene: Scene, steps: u32) -> Simulation {
    stepped(Simulation::new(scene), steps)
}

fn stepped(mut sim: Simulation, steps: u32) -> Simulation {
    (0..steps).for_each(|_| sim.step().unwrap());
    sim
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-11 * b.abs().max(1e-3)
}

/// Every point moves with `v`.
fn moves_with(sim: &Simulation, v: [f64; 2]) -> bool {
    sim.particles().all(|(_, p)| close(p.v[0], v[0]) && close(p.v[1], v[1]))
}

/// Mass and momentum of the ledger against what the material holds; returns the energy residual, J.
fn books_balance(sim: &Simulation) -> f64 {
    let (now, then, ledger): (Stock, Stock, _) = (sim.stock(), *sim.opening(), sim.ledger());
    let impulse = ledger.impulse();
    for d in 0..2 {
        let residual = now.momentum[d] - then.momentum[d] - impulse[d];
        assert!(residual.abs() <= 1e-12 * ledger.impulse_scale.max(then.mass), "momentum residual {residual}");
    }
    assert!(close(now.mass + ledger.departed_mass, then.mass) && close(sim.mass(), now.mass));
    sim.energy_balance(&now, [0.3, 0.7]).residual
}

/// What symplectic Euler gains in free fall, J: points fall with the velocity of the step's end, so each step is m g^2 dt^2/2
/// too deep.
fn free_fall_residual(sim: &Simulation, g: [f64; 2]) -> f64 {
    0.5 * sim.mass() * (g[0] * g[0] + g[1] * g[1]) * DT * DT * sim.steps() as f64
}

#[test]
fn side_walls_brake_with_the_out_of_plane_pressure() {
    // Friction mu p on two walls over the area V/b each: a = 2 mu p / (rho b), against the motion.
    let (mu, p) = (0.3, 2000.0);
    let rate = 2.0 * mu * p / (DENSITY * THICKNESS);
    for (v, pressure, rate) in [([0.3, -0.4], p, rate), ([-0.5, 0.0], p, rate), ([0.3, 0.4], -p, 0.0)] {
        let mut scene = block(v, vec![]);
        scene.side_wall_friction = mu;
        scene.bodies[0].1.iter_mut().for_each(|q| q.state.stress = Stress { zz: -pressure, ..Stress::default() });
        let sim = run(scene.clone(), 20);
        let left = 1.0 - rate * 20.0 * DT / 0.5;
        assert!(moves_with(&sim, [v[0] * left, v[1] * left]), "{v:?}");
        let drag = sim.ledger().side_walls;
        let mass = sim.mass();
        assert!((0..2).all(|d| close(drag.impulse[d], mass * v[d] * (left - 1.0))), "{drag:?}");
        assert!(close(drag.work, 0.5 * mass * 0.25 * (left * left - 1.0)), "{drag:?}");
        assert_eq!(sim.energy_balance(&sim.stock(), [0.0; 2]).side_walls, -drag.work);
        // In 42 steps it comes to rest, and stays there.
        let sim = run(scene, 60);
        assert!(moves_with(&sim, if rate > 0.0 { [0.0; 2] } else { v }));
        assert!(books_balance(&sim).abs() < 1e-12);
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
    for scheme in [Scheme::Usf, Scheme::Usl, Scheme::Musl] {
        let mut with_gravity = block([0.5, 0.2], vec![]);
        with_gravity.numerics.scheme = scheme;
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
fn what_leaves_the_domain_is_booked() {
    // A block under pressure flies out to the right and over a wall that faces left.
    let wall = Boundary::wall("wall", Vector2::new(0.45, -2.0), Vector2::new(0.0, 1.0), 1.0, 0.1, Friction::Smooth);
    let beyond = Boundary::wall("beyond", Vector2::new(9.0, -2.0), Vector2::new(0.0, 1.0), 1.0, 0.1, Friction::Smooth);
    let mut scene = block([5.0, 1.0], vec![wall, beyond]);
    scene.gravity = [2.0, -9.81];
    scene.bodies[0].1.iter_mut().for_each(|p| p.state.stress = Stress { zz: -3000.0, ..Stress::default() });
    scene.domain = [[-1.0, 0.62], [-1.0, 0.9]];
    let sim = run(scene, 80);
    let ledger = sim.ledger();
    assert!(ledger.departed_mass > 0.2 * sim.opening().mass && sim.particle_count() > 0);
    assert!(close(ledger.departed_behind[0], ledger.departed_mass) && ledger.departed_behind[1] == 0.0);
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
    assert!(front(true) > front(false) && front(false) > 0.38, "{} {}", front(true), front(false));
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

/// The step that fails, in words.
fn failure(scene: Scene) -> String {
    let mut sim = Simulation::new(scene);
    for _ in 0..50 {
        if let Err(failure) = sim.step() {
            return failure.to_string();
        }
    }
    panic!("no failure")
}

#[test]
fn failures_say_what_where_and_why() {
    let mut broken = block([1.0, 0.0], vec![]);
    broken.bodies[0].1[17].v[1] = f64::NAN;
    let text = failure(broken);
    assert!(text.starts_with("a velocity is not a number at t = 1.000000e-3 s (step 1): particle"), "{text}");
    assert!(text.contains("body `brick`") && text.contains("the time step of 1.0000e-3 s"), "{text}");
    assert!(text.contains("limited by the largest time step allowed"), "{text}");

    let mut crushed = block([1.0, 0.0], vec![]);
    crushed.bodies[0].1[17].volume_ratio = 0.05;
    let text = failure(crushed);
    assert!(text.contains("crushed or inverted") && text.contains("particle 17 "), "{text}");
    assert!(
        text.contains("x = 0.076000 m, y = 0.125000 m") && text.contains("speed 1.0000e0 m/s, volume ratio 5.0000e-2"),
        "{text}"
    );
    let mut dense = block([1.0, 0.0], vec![]);
    dense.bodies[0].1[17].volume_ratio = 0.0501;
    run(dense, 10);

    let mut fast = block([1.0, 0.0], vec![]);
    fast.numerics.cfl = 1.5;
    fast.numerics.max_time_step = 1.0;
    let law = LinearElastic::new(10.0, 0.0);
    fast.bodies[0].0.law = AnyLaw::LinearElastic(law);
    let text = failure(fast.clone());
    assert!(text.contains("moves more than a cell in one step"), "{text}");
    assert!(text.contains("the particle speed in body `brick` (1.0000 m/s)"), "{text}");
    fast.numerics.cfl = 0.9;
    run(fast, 10);

    let mut sim = Simulation::new(block([1.0, 0.0], vec![]));
    assert!(sim.time_step().dt == DT && sim.steps() == 0);
    sim.step().unwrap();
    let mut waves = block([1.0, 0.0], vec![]);
    waves.numerics.max_time_step = 1.0;
    let sim = run(waves, 1);
    let text = sim.describe_limit(&sim.time_step());
    assert_eq!(text, "the P-wave of body `brick` (10.0000 m/s; its points reach 1.000 m/s)");
    assert!(close(sim.time_step().dt, 0.4 * H / 11.0));
}
