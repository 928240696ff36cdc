mod still;

use super::*;
use crate::boundary::Friction;
use crate::constitutive::{AnyLaw, NeoHookean};
use crate::contact::rule::ContactRule;
use crate::scaffold::{Brick, THICKNESS, elastic, run_until, scene};
use crate::simulation::PicShare;

const H: f64 = 0.02;

/// A wall of 0.1 m by 0.3 m above its clamp, and a block that runs against it.
fn wall_and_block(young: f64, weightless: bool) -> (Simulation, StructureGauge) {
    wall_of(elastic(young, 0.2), weightless, false)
}

/// The same by its law; it may move by a mesh.
fn wall_of(stiff: AnyLaw, weightless: bool, mesh: bool) -> (Simulation, StructureGauge) {
    let soft = elastic(1e6, 0.3);
    let wall = Brick::new([0.4, -2.0 * H], [5, 17], H);
    let block = Brick::new([0.2, 0.0], [6, 6], H);
    // The gauge counts along the height first.
    let [nx, ny] = [10, 34];
    let mut points = wall.points();
    points.iter_mut().for_each(|p| p.id = (p.id % nx) * ny + p.id / nx);
    let plane =
        |name: &str, x: [f64; 2], friction| Boundary::plane(name, Vector2::from(x), Vector2::new(0.0, 1.0), friction);
    let clamp = plane("clamp", [0.4, 0.0], Friction::Bonded).only_for(&[0]);
    let bed = plane("bed", [0.0, 0.0], Friction::Coulomb(0.3)).only_for(&[1]);
    let mut scene = scene(&wall, stiff, 2400.0, points, vec![clamp, bed]);
    scene.bodies[0].0.weightless = weightless;
    scene.bodies[0].0.mesh = mesh.then(|| wall.mesh([&[], &[2.0 * H]]));
    let mut moving = block.points();
    moving.iter_mut().for_each(|p| p.v = [2.0, 0.0]);
    scene.bodies.push((block.body(soft, 1500.0), moving));
    scene.contacts = vec![ContactRule::with_structure(0, 1, 0.4)];
    scene.gravity = [0.5, -9.81];
    scene.numerics.pic = PicShare::Fraction(5e-4);
    let sim = Simulation::new(scene);
    let face = Boundary::wall("wall", Vector2::new(0.4, 0.0), Vector2::new(0.0, 1.0), 0.3, 0.1, Friction::Smooth);
    let gauge = StructureGauge::new(&sim, 0, face, [nx as usize, ny as usize], 0.0);
    (sim, gauge)
}

/// Largest disagreement of contact and weight with clamp and inertia at any step, over the sum of their magnitudes, when the
/// contact force that is read is off by a factor; and the largest contact force.
fn largest_imbalance((mut sim, mut gauge): (Simulation, StructureGauge), factor: f64) -> (f64, f64) {
    let (mut worst, mut force) = (0.0f64, 0.0f64);
    while sim.time() < 0.1 {
        sim.step().expect("a step");
        gauge.after_step(&sim);
        let (impulse, _) = contact_impulse(&sim, 0);
        let excess = impulse.map(|p| (factor - 1.0) * p);
        gauge.contact.add(excess, 0.0, 0.0, sim.time());
        let sample = gauge.sample(&sim);
        worst = worst.max(sample.imbalance);
        force = force.max(sample.contact.normal);
    }
    (worst, force)
}

#[test]
fn contact_clamp_and_inertia_agree_at_every_step() {
    for (young, weightless) in [(5e5, true), (5e5, false), (2e7, true)] {
        let (worst, force) = largest_imbalance(wall_and_block(young, weightless), 1.0);
        println!("{young:e} Pa, weightless {weightless}: {worst:.1e} of up to {force:.0} N");
        assert!(force > 100.0, "the block strikes the wall: {force}");
        assert!(worst < 1e-11, "{young} {weightless}: {worst:e}");
        // A contact force that is off by 2 % is seen.
        let (wrong, _) = largest_imbalance(wall_and_block(young, weightless), 1.02);
        assert!(wrong > 1e-3, "{young} {weightless}: {wrong:e}");
    }
}

#[test]
fn a_wall_that_moves_by_a_mesh_balances_by_its_nodes_and_has_no_gaps() {
    for weightless in [true, false] {
        let wall = || wall_of(AnyLaw::NeoHookean(NeoHookean::new(5e5, 0.2)), weightless, true);
        let (worst, force) = largest_imbalance(wall(), 1.0);
        assert!(force > 100.0 && worst < 1e-11, "{force} {worst:e}");
        let (wrong, _) = largest_imbalance(wall(), 1.02);
        assert!(wrong > 1e-3, "{wrong:e}");
        let (mut sim, mut gauge) = wall();
        run_until(&mut sim, 0.1).expect("it runs");
        let bend = gauge.sample(&sim).bend;
        assert!(bend.tip > 0.01 && bend.gap < 0.01, "{bend:?}");
    }
}

#[test]
fn impulses_add_up_to_the_momentum_of_the_block() {
    // Over the whole impact, means times durations give back what the block has lost to the wall.
    let (mut sim, mut gauge) = wall_and_block(5e5, true);
    let block = |sim: &Simulation| sim.stock_of(|b| b == 1);
    let before = block(&sim);
    let mut given = 0.0;
    while sim.time() < 0.08 {
        sim.step().expect("a step");
        gauge.after_step(&sim);
        if sim.steps().is_multiple_of(7) {
            let duration = gauge.contact.sampled_duration();
            given += gauge.sample(&sim).contact.normal * duration;
        }
    }
    let rest = gauge.contact.sampled_duration();
    given += gauge.sample(&sim).contact.normal * rest;
    let gravity = sim.gravity()[0] * before.mass * sim.time();
    let bed = sim.ledger().boundaries[1].impulse[0];
    let lost = before.momentum[0] - block(&sim).momentum[0] + gravity + bed;
    assert!((given / lost - 1.0).abs() < 1e-9, "{given} {lost}");
}

#[test]
fn at_rest_the_clamp_carries_weight_and_load() {
    let (mut sim, mut gauge) = wall_and_block(5e6, false);
    sim.set_damping(40.0);
    run_until(&mut sim, 1.0).expect("it runs");
    gauge.open(&sim);
    for _ in 0..400 {
        sim.step().expect("a step");
        gauge.after_step(&sim);
    }
    let s = gauge.sample(&sim);
    let weight = 2400.0 * 0.1 * 17.0 * H * THICKNESS * 9.81;
    assert!(s.inertia.normal.abs() < 1e-3 * weight && s.imbalance < 1e-9, "{s:?}");
    assert!((s.clamp.tangential / -weight - 1.0).abs() < 0.05, "{s:?} {weight}");
    assert!((s.clamp.normal - s.contact.normal - 0.5 / 9.81 * weight).abs() < 0.01 * weight, "{s:?}");
}

#[test]
fn a_bent_wall_is_seen_bent() {
    let (mut sim, mut gauge) = wall_and_block(5e6, true);
    let mut scene_points = Vec::new();
    // A parabola with 10 mm at the tip, by hand: deflection w(s) = 0.01 (s/0.3)^2.
    for p in sim.points_of(0) {
        let s = p.x[1].max(0.0);
        scene_points.push((p.id, [p.x[0] + 0.01 * (s / 0.3) * (s / 0.3), p.x[1]]));
    }
    for (id, x) in scene_points {
        gauge.points[id as usize].as_mut().expect("a point").x = x;
    }
    let profile = gauge.profile();
    assert_eq!(profile.len(), 30, "points above the foot");
    for p in &profile {
        assert!((p.deflection - 0.01 * (p.height / 0.3) * (p.height / 0.3)).abs() < 1e-12, "{p:?}");
    }
    let bend = gauge.bend(&sim);
    assert!((bend.tip - bend.largest).abs() < 1e-15 && (bend.largest_at - 0.295).abs() < 1e-12, "{bend:?}");
    // A slope of 0.066 makes the half cell between points longer by 0.2 %.
    assert!(bend.gap < 2e-3, "a bent wall has no gap: {bend:?}");
    // A tear: everything above 0.1 m lifted by half a cell.
    for place in gauge.points.iter_mut().flatten().filter(|p| p.x[1] > 0.1) {
        place.x[1] += 0.5 * H;
    }
    let torn = gauge.bend(&sim);
    assert!((torn.gap - 0.5).abs() < 0.01 && (torn.gap_at - 0.095).abs() < 1e-9, "{torn:?}");
    sim.step().expect("a step");
    gauge.follow(&sim);
    assert!(gauge.bend(&sim).gap < 0.01);
}

#[test]
fn the_survey_sees_layers_run_up_and_what_went_over() {
    let (mut sim, mut gauge) = wall_and_block(5e6, true);
    // The block ends 0.08 m before the wall.
    assert_eq!(gauge.survey(&sim), Survey::default());
    while sim.time() < 0.05 {
        sim.step().expect("a step");
        gauge.after_step(&sim);
    }
    let found = gauge.sample(&sim).survey;
    assert!(found.run_up > 0.1 && found.run_up < 0.13, "{found:?}");
    assert!(found.penetration < 0.5 * H && found.behind == 0.0, "{found:?}");
    assert!(found.layers[0] > 0.0, "{found:?}");
}
