//! Implicit steps of a body that moves by its mesh.

use super::{H, angular_momentum, body, meshed, plane, residuals, rubber, wall_and_block};
use crate::boundary::Friction;
use crate::constitutive::{AnyLaw, NeoHookean};
use crate::scaffold::{Brick, Lcg, run_until};
use crate::simulation::implicit::THETA;
use crate::simulation::{Scene, Simulation};
use crate::space::{minus, moment, norm, plus, scaled};
use std::f64::consts::TAU;

/// A plate of 0.08 m by 0.24 m over its clamp, at rest.
fn plate(young: f64, dt: f64, change: impl Fn(&mut Scene)) -> Simulation {
    let brick = Brick::new([0.0; 2], [4, 12], H);
    let law = AnyLaw::NeoHookean(NeoHookean::new(young, 0.3));
    let mut scene = meshed(&brick, law, 1000.0, vec![plane("clamp", [0.0; 2], Friction::Bonded)]);
    scene.bodies[0].0.implicit = true;
    scene.numerics.max_time_step = dt;
    change(&mut scene);
    Simulation::new(scene)
}

/// Mean displacement of the upper edge, m.
fn tip(sim: &Simulation) -> [f64; 2] {
    let b = body(sim);
    let top = b.start.iter().zip(&b.displacement).filter(|(x, _)| x[1] > 12.0 * H - 1e-9);
    let (sum, n) = top.fold(([0.0; 2], 0.0), |(s, n), (_, u)| (plus(s, *u), n + 1.0));
    scaled(sum, 1.0 / n)
}

#[test]
fn the_stiffness_is_the_slope_of_the_forces() {
    let sim =
        Simulation::new(meshed(&Brick { angle: 0.4, ..Brick::new([0.1, 0.0], [6, 4], H) }, rubber(), 1e3, vec![]));
    let (b, mut rng) = (body(&sim), Lcg::new(3));
    let n = b.start.len();
    let law = b.law.expect("a law");
    let u: Vec<[f64; 2]> = (0..n).map(|_| [0; 2].map(|_| 0.1 * H * rng.signed())).collect();
    let way: Vec<[f64; 2]> = (0..n).map(|_| [0; 2].map(|_| rng.signed())).collect();
    let mut pulled = vec![[0.0; 2]; n];
    let mut blocks = std::collections::BTreeMap::new();
    b.elements.stiffen(&law, &u, |i, j, k| {
        let d = way[j as usize];
        let p = &mut pulled[i as usize];
        *p = plus(*p, [k[0] * d[0] + k[1] * d[1], k[2] * d[0] + k[3] * d[1]]);
        let sum = blocks.entry((i, j)).or_insert([0.0; 4]);
        *sum = plus(*sum, k);
    });
    let along = |e: f64| {
        let moved: Vec<[f64; 2]> = u.iter().zip(&way).map(|(u, w)| plus(*u, scaled(*w, e))).collect();
        let mut forces = vec![[0.0; 2]; n];
        b.elements.strain(&law, &moved, &mut forces);
        forces
    };
    let e = 1e-6 * H;
    let scale = pulled.iter().map(|p| norm(*p)).fold(0.0, f64::max);
    for ((up, down), p) in along(e).iter().zip(along(-e)).zip(&pulled) {
        let slope = scaled(minus(*up, down), -0.5 / e);
        assert!(norm(minus(slope, *p)) < 1e-7 * scale, "{slope:?} {p:?}");
    }
    for ((i, j), k) in &blocks {
        let other = blocks[&(*j, *i)];
        assert!(norm(minus(*k, [other[0], other[2], other[1], other[3]])) < 1e-12 * scale, "not symmetric");
    }
}

#[test]
fn a_turn_costs_no_force() {
    let sim = Simulation::new(meshed(&Brick::new([0.1, 0.2], [6, 4], H), rubber(), 1e3, vec![]));
    let b = body(&sim);
    let law = b.law.expect("a law");
    let (c, s) = (libm::cos(2.0), libm::sin(2.0));
    let turned: Vec<[f64; 2]> =
        b.start.iter().map(|x| minus([c * x[0] - s * x[1] + 3.0, s * x[0] + c * x[1] - 1.0], *x)).collect();
    let mut forces = vec![[0.0; 2]; turned.len()];
    let found = b.elements.strain(&law, &turned, &mut forces);
    // Displacements of three metres are known to 4e-16 m: of a force of E times the area of a cell's side, 2e-14.
    let scale = 1e6 * H * crate::scaffold::THICKNESS;
    assert!(forces.iter().all(|f| norm(*f) < 1e-12 * scale), "{forces:?}");
    assert!(found.energy.abs() < 1e-12 * scale * H && (found.smallest - 1.0).abs() < 1e-12);
}

#[test]
fn a_step_obeys_the_equation_of_motion_and_the_clamp_takes_what_is_missing() {
    // A soft plate bends far in few steps, with weight and drag.
    let mut sim = plate(3e4, 5e-3, |scene| {
        scene.gravity = [20.0, -9.81];
        scene.bodies[0].1.iter_mut().for_each(|p| p.v = [10.0 * p.x[1], 0.0]);
    });
    sim.set_damping(3.0);
    let longest = body(&sim).longest;
    for _ in 0..30 {
        let before = body(&sim).clone();
        let [_, energy_before] = residuals(&sim);
        sim.step().expect("a step");
        let (b, dt) = (body(&sim), sim.time_step().dt);
        assert!(dt > 2.0 * longest, "{dt} {longest}");
        let (mut missing, mut turn, mut scale) = ([0.0; 2], 0.0, 0.0f64);
        for k in 0..b.start.len() {
            let (m, v0, v1) = (b.mass[k], before.velocity[k], b.velocity[k]);
            let way = scaled(plus(scaled(v1, THETA), scaled(v0, 1.0 - THETA)), dt);
            assert!(norm(minus(minus(b.displacement[k], before.displacement[k]), way)) < 1e-15, "{k}");
            let force = plus(scaled(b.internal[k], THETA), scaled(before.internal[k], 1.0 - THETA));
            let weight = [20.0 * m, -9.81 * m];
            let given = plus(scaled(plus(force, weight), dt), scaled(v0, -3.0 * dt * m));
            let left = minus(scaled(minus(v1, v0), m), given);
            scale = scale.max(m * norm(v1));
            if b.held[k] {
                missing = plus(missing, left);
                turn += moment(b.start[k], left);
            } else {
                assert!(norm(left) < 1e-11 * scale.max(1e-6), "{k}: {left:?} of {scale}");
            }
        }
        let tally = sim.step_tallies()[0];
        assert!(norm(minus(tally.impulse, missing)) < 1e-12 && (tally.moment - turn).abs() < 1e-12, "{tally:?}");
        // What the method takes is booked, so all energy is accounted for.
        let [momentum, energy] = residuals(&sim);
        let stock = sim.stock();
        assert!(momentum < 1e-10 * sim.ledger().impulse_scale, "{momentum:e}");
        assert!((energy - energy_before).abs() < 1e-11 * (stock.kinetic + stock.elastic), "{energy:e}");
    }
    let pic = sim.ledger().pic_loss;
    assert!(norm(tip(&sim)) > 0.05 && pic > 0.0, "{:?} {pic}", tip(&sim));
}

#[test]
fn a_free_body_keeps_its_momentum_and_a_spin_is_hardly_damped() {
    let brick = Brick { angle: 0.3, ..Brick::new([0.1, 0.2], [5, 5], H) };
    let mut scene = meshed(&brick, rubber(), 1000.0, vec![]);
    scene.bodies[0].0.implicit = true;
    scene.numerics.max_time_step = 2e-4;
    for p in &mut scene.bodies[0].1 {
        let r = minus(p.x, [0.12, 0.25]);
        p.v = [0.3 - 20.0 * r[1], -0.2 + 20.0 * r[0]];
    }
    let mut sim = Simulation::new(scene);
    // About the centre of mass.
    let spin = |sim: &Simulation| {
        let (b, stock) = (body(sim), sim.stock());
        let places = b.start.iter().zip(&b.displacement).map(|(x, u)| plus(*x, *u));
        let centre = places.zip(&b.mass).fold([0.0; 2], |s, (x, m)| plus(s, scaled(x, m / stock.mass)));
        angular_momentum(b) - moment(centre, stock.momentum)
    };
    let (first, opening) = (spin(&sim), *sim.opening());
    run_until(&mut sim, TAU / 20.0).expect("it runs");
    let [momentum, energy] = residuals(&sim);
    assert!(momentum < 1e-10 * norm(opening.momentum), "{momentum:e}");
    assert!(energy.abs() < 1e-9 * opening.kinetic, "{energy:e}");
    // Velocities are turned by (theta - 1/2) w dt against the circle, and the forces of a step by (2 theta - 1) w dt against the mean
    // velocity: a share of (2 theta - 1) (w dt)^2 is lost in a step.
    let expected = -(2.0 * THETA - 1.0) * (20.0 * 2e-4) * (20.0 * 2e-4) * sim.steps() as f64;
    let change = spin(&sim) / first - 1.0;
    println!("angular momentum {change:e}, {expected:e} expected");
    assert!((change / expected - 1.0).abs() < 0.05, "{change:e} {expected:e}");
}

#[test]
fn a_plate_at_rest_hangs_as_in_explicit_steps() {
    let rest = |implicit: bool, dt: f64| {
        let mut sim = plate(1e5, dt, |scene| {
            scene.gravity = [3.0, -1.0];
            scene.bodies[0].0.implicit = implicit;
        });
        // First frequency 14 rad/s: amplitudes fall by exp(-10 t).
        sim.set_damping(20.0);
        run_until(&mut sim, 1.8).expect("it runs");
        (tip(&sim), sim.steps())
    };
    let ((explicit, few), (implicit, fewer)) = (rest(false, 1.0), rest(true, 4e-3));
    println!("{explicit:?} {implicit:?}, {few} and {fewer} steps");
    assert!(norm(explicit) > 0.02 && norm(minus(explicit, implicit)) < 1e-6 * norm(explicit));
    assert!(fewer * 3 < few);
}

#[test]
fn a_free_swing_is_slowed_and_damped_as_the_method_says() {
    // Angular frequency, steps in two periods, and the energy after them over that before.
    let swing = |implicit: bool, dt: f64| {
        let mut sim = plate(1e6, dt, |scene| {
            scene.bodies[0].0.implicit = implicit;
            for p in &mut scene.bodies[0].1 {
                let s = p.x[1] / (12.0 * H);
                p.v = [0.01 * s * s * (3.0 - s), 0.0];
            }
        });
        // Steps, time and energy where the tip crosses its place at rest.
        let (mut crossings, mut before) = (Vec::new(), [sim.time(), 0.0]);
        while crossings.len() < 5 {
            sim.step().expect("a step");
            let now = [sim.time(), tip(&sim)[0]];
            if before[1] * now[1] < 0.0 {
                let time = before[0] + (now[0] - before[0]) * before[1] / (before[1] - now[1]);
                let stock = sim.stock();
                crossings.push((sim.steps(), time, stock.kinetic + stock.elastic));
            }
            before = now;
        }
        let (first, last) = (crossings[0], crossings[4]);
        (2.0 * TAU / (last.1 - first.1), last.0 - first.0, last.2 / first.2)
    };
    let (angular, _, kept) = swing(false, 1.0);
    assert!((kept - 1.0).abs() < 1e-3, "{kept}");
    let found = [4e-3, 2e-3].map(|dt| {
        let (found, steps, kept) = swing(true, dt);
        // In a step a swing is multiplied by (1 + i (1 - theta) z)/(1 - i theta z) with z = w dt.
        let z = angular * dt;
        let [before, after] = [1.0 - THETA, THETA].map(|t| t * z);
        let expected = (libm::atan(before) + libm::atan(after)) / dt;
        let rest = libm::pow((1.0 + before * before) / (1.0 + after * after), steps as f64);
        println!("{dt}: w dt {z:.3}, w {found:.5} for {expected:.5}, kept {kept:.5} for {rest:.5}");
        assert!((kept / rest - 1.0).abs() < 0.01, "{kept} {rest}");
        [found, expected]
    });
    // All are off alike: in explicit steps faster modes are left, which move the crossings by some ten-thousandths of a period.
    let [coarse, fine] = found;
    assert!((fine[0] / angular - 1.0).abs() < 1e-3 && (coarse[0] / angular - 1.0).abs() < 4e-3);
    let slower = (coarse[1] - fine[1]) / angular;
    assert!(((coarse[0] - fine[0]) / angular / slower - 1.0).abs() < 0.1, "{found:?}");
}

/// Impulse on the wall, its largest deflection, and residuals of momentum and energy.
fn impact(mut sim: Simulation) -> [f64; 4] {
    let opening = *sim.opening();
    let start = sim.points_of(0).fold(0.0, |a: f64, p| a.max(p.x[0]));
    let (mut impulse, mut bent, mut worst) = (0.0, 0.0f64, [0.0f64; 2]);
    let mut clamped = [0.0; 2];
    let mut given = [0.0; 2];
    while sim.time() < 0.06 {
        sim.step().expect("a step");
        for tally in sim.contact_tallies() {
            given = minus(given, tally.exchange.impulse);
        }
        impulse -= sim.contact_tallies().map(|t| t.exchange.impulse[0]).sum::<f64>();
        bent = bent.max(sim.points_of(0).fold(0.0, |a: f64, p| a.max(p.x[0])) - start);
        clamped = plus(clamped, sim.step_tallies_of(0).next().expect("a clamp").impulse);
        // What contact gives the wall, its clamp takes or it keeps.
        let wall = sim.stock_of(|b| b == 0).momentum;
        let left = norm(minus(plus(given, clamped), wall)) / sim.ledger().impulse_scale.max(1e-3);
        let [momentum, energy] = residuals(&sim);
        worst[0] = worst[0].max(left).max(momentum / norm(opening.momentum));
        worst[1] = worst[1].max(energy.abs() / opening.kinetic);
    }
    let passes = sim.contact_sweeps().map_or(0, |[most, _]| most);
    println!("impulse {impulse:.4}, bent {bent:.5}, left {worst:?}, {passes} sweeps, {} steps", sim.steps());
    assert!(passes > 1 && passes < 1000, "{passes} sweeps");
    [impulse, bent, worst[0], worst[1]]
}

/// The wall of a Young's modulus (Pa) by its mesh, in steps of the block.
fn struck(young: f64, implicit: bool, lean: f64, longest: f64) -> Simulation {
    wall_and_block(true, lean, |scene| {
        scene.bodies[0].0.law = AnyLaw::NeoHookean(NeoHookean::new(young, 0.2));
        scene.bodies[0].0.implicit = implicit;
        scene.numerics.max_time_step = longest;
    })
}

#[test]
fn a_wall_takes_the_same_impact_in_implicit_steps() {
    for lean in [0.0, -0.4] {
        let plain = impact(struck(2e6, false, lean, 1e-4));
        let found = impact(struck(2e6, true, lean, 1e-4));
        for k in 0..2 {
            assert!((found[k] / plain[k] - 1.0).abs() < 0.02, "{lean}: {plain:?} {found:?}");
        }
        assert!(found[2] < 1e-10, "momentum: {:e}", found[2]);
        assert!(found[3] < plain[3] + 0.005, "energy: {:e} {:e}", found[3], plain[3]);
    }
}

#[test]
fn a_stiff_wall_does_not_shorten_the_step() {
    let mut steps = Vec::new();
    for young in [2e8, 2e11] {
        let sim = struck(young, true, 0.0, 1.0);
        let found = impact(sim.clone());
        // The block's own steps, and what it gives in them: no more than twice what it brings.
        let block = sim.opening().momentum[0];
        assert!(found[0] > 0.5 * block && found[0] < 2.0 * block, "{found:?} {block}");
        assert!(found[2] < 1e-9 && found[3] < 0.06, "{found:?}");
        let mut sim = sim;
        run_until(&mut sim, 0.02).expect("it runs");
        steps.push(sim.steps());
        let ratio = sim.time_step().dt / body(&sim).longest;
        println!("{young:e} Pa: steps of {ratio:.1} times the longest explicit one");
        assert!(ratio > 3.0, "{ratio}");
    }
    assert!(steps[0].abs_diff(steps[1]) * 20 < steps[0], "{steps:?}");
}

#[test]
fn the_same_bits_for_any_number_of_threads() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let mut sim = struck(2e9, true, -0.4, 1.0);
            run_until(&mut sim, 0.02).expect("it runs");
            sim.particles().map(|(_, p)| p.x[0].to_bits() ^ p.v[1].to_bits()).collect::<Vec<_>>()
        })
    };
    assert!(run(1) == run(3));
}

#[test]
fn contact_knows_how_the_whole_body_answers() {
    let mut sim = struck(2e9, true, -0.4, 1.0);
    run_until(&mut sim, 0.01).expect("it runs");
    let b = body(&sim);
    let s = b.solver.as_ref().expect("implicit steps");
    assert!(s.touched.len() > 2, "{}", s.touched.len());
    // Unit impulses at background nodes: (M + theta^2 dt^2 K) v = c, and the velocity at the others.
    let mut pulled = vec![[0.0; 2]; b.mass.len()];
    let mut given = pulled.clone();
    let mut v = pulled.clone();
    let (rank, direction) = (1, [0.6, -0.8]);
    let shares = |k: usize| b.touching.shares[b.touching.shared[k].own.clone()].iter();
    for (node, c) in shares(s.touched[rank]).filter(|(n, _)| !b.held[*n as usize]) {
        given[*node as usize] = scaled(direction, *c);
    }
    let mut solver = s.clone();
    solver.pushed.clone_from(&given);
    solver.push(&mut v, 1.0);
    let by = (THETA * s.dt) * (THETA * s.dt);
    b.elements.stiffen(&b.law.expect("a law"), &b.displacement, |i, j, k| {
        let (p, d) = (&mut pulled[i as usize], v[j as usize]);
        *p = plus(*p, scaled([k[0] * d[0] + k[1] * d[1], k[2] * d[0] + k[3] * d[1]], by));
    });
    for k in (0..b.mass.len()).filter(|k| !b.held[*k]) {
        let left = minus(plus(scaled(v[k], b.mass[k]), pulled[k]), given[k]);
        // The factor is that of some steps ago.
        assert!(norm(left) < 0.02, "{k}: {left:?}");
    }
    let n = s.touched.len();
    for (other, k) in s.touched.iter().enumerate() {
        let moved = shares(*k).fold([0.0; 2], |sum, (node, c)| plus(sum, scaled(v[*node as usize], *c)));
        let a = s.answers[other * n + rank];
        let told = [a[0] * direction[0] + a[1] * direction[1], a[2] * direction[0] + a[3] * direction[1]];
        assert!(norm(minus(told, moved)) < 1e-12 * norm(moved).max(norm(told)), "{other}: {told:?} {moved:?}");
    }
}
