//! A body that moves by its mesh: alone, in a clamp, and in contact.

mod implicit;

use crate::boundary::{Boundary, Friction};
use crate::constitutive::{AnyLaw, LinearElastic, NeoHookean};
use crate::contact::rule::{ContactRule, GapRule, NormalRule};
use crate::scaffold::{Brick, elastic, points_by_number, run_until, scene};
use crate::simulation::lagrangian::LagrangianBody;
use crate::simulation::{PicShare, Scene, Simulation};
use crate::space::{minus, moment, norm, plus, scaled};
use nalgebra::Vector2;

const H: f64 = 0.02;

fn rubber() -> AnyLaw {
    AnyLaw::NeoHookean(NeoHookean::new(1e6, 0.3))
}

/// A brick that moves by its mesh.
fn meshed(brick: &Brick, law: AnyLaw, density: f64, boundaries: Vec<Boundary>) -> Scene {
    let mut scene = scene(brick, law, density, brick.points(), boundaries);
    scene.bodies[0].0.mesh = Some(brick.mesh([&[], &[]]));
    scene
}

fn plane(name: &str, x: [f64; 2], friction: Friction) -> Boundary {
    Boundary::plane(name, x.into(), Vector2::new(0.0, 1.0), friction)
}

fn body(sim: &Simulation) -> &LagrangianBody {
    sim.structures[0].lagrangian().expect("a body with a mesh")
}

/// What the ledger leaves of momentum, N s, and of energy, J.
fn residuals(sim: &Simulation) -> [f64; 2] {
    let (now, given) = (sim.stock(), sim.ledger().impulse());
    let left = minus(minus(now.momentum, sim.opening().momentum), given);
    [norm(left), sim.energy_balance(&now, [0.0; 2]).residual]
}

fn angular_momentum(b: &LagrangianBody) -> f64 {
    let places = b.start.iter().zip(&b.displacement).map(|(x, u)| plus(*x, *u));
    places.zip(b.mass.iter().zip(&b.velocity)).map(|(x, (m, v))| moment(x, scaled(*v, *m))).sum()
}

#[test]
fn a_square_that_spins_and_breathes_keeps_momentum_angular_momentum_and_energy() {
    let brick = Brick { angle: 0.3, ..Brick::new([0.1, 0.2], [5, 5], H) };
    let mut scene = meshed(&brick, rubber(), 1000.0, vec![]);
    for p in &mut scene.bodies[0].1 {
        let r = minus(p.x, [0.12, 0.25]);
        p.v = [0.3 - 40.0 * r[1] + 25.0 * r[0], -0.2 + 40.0 * r[0] - 10.0 * r[1]];
    }
    scene.numerics.cfl = 0.2;
    let mut sim = Simulation::new(scene);
    let spin = angular_momentum(body(&sim));
    let opening = *sim.opening();
    // The nodes have the velocities of the points, which are linear in space.
    let points: f64 = sim.particles().map(|(_, p)| p.v[0]).sum::<f64>() / 100.0;
    assert!((opening.momentum[0] / opening.mass / points - 1.0).abs() < 1e-9);
    let mut worst = 0.0f64;
    // Three turns, hundreds of sorts of the points.
    while sim.time() < 0.5 {
        sim.step().expect("a step");
        let [momentum, energy] = residuals(&sim);
        assert!(momentum < 1e-13 * opening.mass, "{momentum:e}");
        worst = worst.max(energy.abs() / opening.kinetic);
        let change = angular_momentum(body(&sim)) / spin - 1.0;
        assert!(change.abs() < 1e-11, "{change:e} after {} s", sim.time());
    }
    println!("energy: {worst:.1e} of {} J in {} steps", opening.kinetic, sim.steps());
    // Of second order, in steps of equal length. Where the longest stable step changed from step to step, at twice the cfl, it was 5.5e-3.
    assert!(worst < 1e-3, "{worst}");
}

#[test]
fn the_energy_of_small_swings_stays_to_round_off() {
    // Steps of equal length, and next to no strain: what is left are squares of it.
    let brick = Brick::new([0.0; 2], [4, 12], H);
    let mut scene = meshed(&brick, rubber(), 1000.0, vec![plane("clamp", [0.0; 2], Friction::Bonded)]);
    scene.gravity = [1e-5, 2e-5];
    let mut sim = Simulation::new(scene);
    run_until(&mut sim, 1.0).expect("it runs");
    let stock = sim.stock();
    let [momentum, energy] = residuals(&sim);
    // The first step begins with a velocity that belongs to its middle; nothing grows from then on.
    let scale = stock.kinetic + stock.elastic;
    println!("{energy:e} of {scale:e}");
    assert!(energy.abs() < 1e-6 * scale && momentum < 1e-12 * sim.ledger().impulse_scale, "{energy:e} {scale:e}");
}

#[test]
fn what_a_body_does_alone_knows_no_grid() {
    let motion = |origin: [f64; 2], per_cell: usize| {
        let brick = Brick { per_cell, ..Brick::new([0.0; 2], [4, 10], H) };
        let mut scene = meshed(&brick, rubber(), 1000.0, vec![plane("clamp", [0.0; 2], Friction::Bonded)]);
        scene.lattice.origin = origin;
        scene.gravity = [60.0, -1.0];
        let mut sim = Simulation::new(scene);
        run_until(&mut sim, 0.05).expect("it runs");
        body(&sim).displacement.clone()
    };
    let here = motion([0.0; 2], 2);
    assert!(here.iter().any(|u| norm(*u) > 0.02), "it bends");
    assert_eq!(here, motion([0.3 * H, 0.71 * H], 2));
    // Other points, masses but for round-off.
    for (a, b) in here.iter().zip(motion([0.0; 2], 3)) {
        assert!(norm(minus(*a, b)) < 1e-10, "{a:?} {b:?}");
    }
}

#[test]
fn a_clamp_carries_weight_and_moment_and_all_motion_dies_out() {
    let brick = Brick::new([0.0, -2.0 * H], [4, 14], H);
    let clamp = plane("clamp", [0.0; 2], Friction::Bonded);
    let mut scene = scene(&brick, rubber(), 1000.0, brick.points(), vec![clamp]);
    scene.bodies[0].0.mesh = Some(brick.mesh([&[], &[2.0 * H]]));
    scene.gravity = [0.5, -9.81];
    let mut sim = Simulation::new(scene);
    // There is no PIC: nothing moves that the nodes do not see, so damping stops all of it.
    sim.set_damping(60.0);
    run_until(&mut sim, 1.5).expect("it runs");
    assert!(sim.particles().all(|(_, p)| norm(p.v) < 1e-9), "{:e}", sim.largest_speed());
    let dt = sim.time_step().dt;
    let tally = sim.step_tallies()[0];
    let weight = sim.mass() * 9.81;
    assert!((tally.impulse[1] / dt / weight - 1.0).abs() < 1e-7, "{tally:?}");
    assert!((tally.impulse[0] / dt / (-0.5 / 9.81 * weight) - 1.0).abs() < 1e-7, "{tally:?}");
    let b = body(&sim);
    let places = b.start.iter().zip(&b.displacement).map(|(x, u)| plus(*x, *u));
    let load: f64 = places.zip(&b.mass).map(|(x, m)| moment(x, [0.5 * m, -9.81 * m])).sum();
    assert!((tally.moment / dt / -load - 1.0).abs() < 1e-7, "{tally:?} {load}");
    // The nodes on the plane and behind it stay, those before it do not.
    for (x, u) in b.start.iter().zip(&b.displacement) {
        assert_eq!(*u == [0.0; 2], x[1] < 1e-9, "{x:?} {u:?}");
    }
}

/// A drawing is typed to some digits: a clamp that misses the edge by them holds it.
#[test]
fn a_clamp_a_hair_beside_the_edge_holds_it() {
    let brick = Brick::new([0.0; 2], [4, 8], H);
    let held = |y: f64| {
        let clamp = plane("clamp", [0.0, y], Friction::Bonded);
        let mut scene = meshed(&brick, rubber(), 1000.0, vec![clamp]);
        scene.gravity = [0.5, -9.81];
        let sim = Simulation::new(scene);
        body(&sim).held.iter().filter(|h| **h).count()
    };
    assert!(held(0.0) > 0);
    assert_eq!(held(-1e-6), held(0.0));
    assert_eq!(held(-1e-3), 0);
}

#[test]
fn the_longest_step_is_stable_and_kept_under_compression() {
    let brick = Brick::new([0.0; 2], [4, 6], H);
    let mut scene = meshed(&brick, rubber(), 1000.0, vec![plane("clamp", [0.0; 2], Friction::Bonded)]);
    scene.numerics.cfl = 1.0;
    for p in &mut scene.bodies[0].1 {
        // Down at a third of the speed of the waves, with ripples.
        p.v = [0.1 * libm::sin(700.0 * p.x[1]), -110.0 * p.x[1]];
    }
    let mut sim = Simulation::new(scene);
    let first = sim.time_step().dt;
    let opening = sim.opening().kinetic;
    let (mut shortest, mut worst) = (first, 0.0f64);
    while sim.time() < 0.2 {
        sim.step().expect("a step");
        shortest = shortest.min(sim.time_step().dt);
        worst = worst.max(residuals(&sim)[1].abs() / opening);
    }
    let cell = H / sim.bodies()[0].p_wave_speed();
    println!("first {} cells per wave, shortest {}, energy {worst:.1e}", first / cell, shortest / cell);
    assert!(first < 0.5 * cell && shortest < 0.8 * first, "{first} {shortest} {cell}");
    // A mode that grows would have left all bounds: the highest swings three hundred times.
    assert!(worst < 0.5, "{worst}");
}

#[test]
fn points_go_with_their_mesh_out_of_the_domain() {
    let mut scene = meshed(&Brick::new([0.0; 2], [4, 4], H), rubber(), 1000.0, vec![]);
    scene.domain = [[-0.1, 0.1], [-0.1, 0.1]];
    scene.bodies[0].1.iter_mut().for_each(|p| p.v = [3.0, 1.0]);
    let before = scene.bodies[0].1.clone();
    let mut sim = Simulation::new(scene);
    run_until(&mut sim, 0.1).expect("it runs");
    let way = [3.0 * sim.time(), sim.time()];
    for (p, q) in points_by_number(&sim).iter().zip(before) {
        assert!(norm(minus(p.x, plus(q.x, way))) < 1e-12, "{p:?}");
    }
    assert_eq!(sim.ledger().departed_mass, 0.0);
}

#[test]
fn an_element_turned_inside_out_stops_the_run() {
    let mut scene = meshed(&Brick::new([0.0; 2], [4, 4], H), rubber(), 1000.0, vec![]);
    scene.bodies[0].1.iter_mut().for_each(|p| p.v[0] = -150.0 * (p.x[0] / H));
    let mut sim = Simulation::new(scene);
    let failed = run_until(&mut sim, 0.1).expect_err("it is crushed");
    assert!(failed.what.contains("crushed") && &*failed.body == "brick", "{failed}");
}

/// A wall of 0.1 m by 0.3 m above its clamp, and a soft block that runs against it; the wall may lean.
fn wall_and_block(mesh: bool, lean: f64, change: impl Fn(&mut Scene)) -> Simulation {
    let wall = Brick { angle: lean, ..Brick::new([0.4, -2.0 * H], [5, 17], H) };
    let block = Brick::new([0.27, 0.0], [6, 6], H);
    let up = Vector2::new(-libm::sin(lean), libm::cos(lean));
    let foot = Vector2::from(wall.corner) + up * (2.0 * H);
    let clamp = Boundary::plane("clamp", foot, up, Friction::Bonded).only_for(&[0]);
    let bed = plane("bed", [0.0; 2], Friction::Coulomb(0.3)).only_for(&[1]);
    let law = AnyLaw::NeoHookean(NeoHookean::new(2e6, 0.2));
    let mut scene = scene(&wall, law, 2400.0, wall.points(), vec![clamp, bed]);
    scene.bodies[0].0.weightless = true;
    scene.bodies[0].0.mesh = mesh.then(|| wall.mesh([&[], &[2.0 * H]]));
    let mut moving = block.points();
    moving.iter_mut().for_each(|p| p.v = [2.0, 0.0]);
    scene.bodies.push((block.body(elastic(1e6, 0.3), 1500.0), moving));
    scene.contacts = vec![ContactRule::with_structure(0, 1, 0.4)];
    scene.gravity = [0.5, -9.81];
    scene.numerics.pic = PicShare::Fraction(0.0);
    change(&mut scene);
    Simulation::new(scene)
}

#[test]
fn impulses_go_from_block_to_wall_to_clamp_without_loss() {
    let mut residual = [0.0; 2];
    for (lean, mesh) in [(0.0, true), (-0.4, true), (0.0, false)] {
        let mut sim = wall_and_block(mesh, lean, |_| ());
        let opening = *sim.opening();
        let (mut given, mut clamped) = ([0.0; 2], [0.0; 2]);
        let (mut largest, mut worst) = (0.0f64, 0.0f64);
        while sim.time() < 0.06 {
            sim.step().expect("a step");
            for tally in sim.contact_tallies() {
                given = minus(given, tally.exchange.impulse);
            }
            clamped = plus(clamped, sim.step_tallies_of(0).next().expect("a clamp").impulse);
            // What contact gives the wall, its clamp takes or it keeps.
            let wall = sim.stock_of(|b| b == 0).momentum;
            let left = minus(plus(given, clamped), wall);
            assert!(norm(left) < 1e-12 * sim.ledger().impulse_scale.max(1e-3), "lean {lean}: {left:?}");
            let [momentum, energy] = residuals(&sim);
            assert!(momentum < 1e-12 * norm(opening.momentum), "{momentum:e}");
            worst = worst.max(energy.abs() / opening.kinetic);
            largest = largest.max(norm(given));
        }
        let passes = sim.contact_sweeps().map_or(0, |[most, _]| most);
        println!("lean {lean}, mesh {mesh}: impulse {largest:.2} N s, energy {worst:.1e}, {passes} sweeps");
        assert!(largest > 2.0, "the block strikes: {largest}");
        assert!((passes > 1) == mesh && passes < 60, "{passes} sweeps");
        if lean == 0.0 {
            residual[usize::from(mesh)] = worst;
        }
    }
    // What is left is the block's own, and no more than beside a wall of points.
    assert!(residual[1] < residual[0] + 0.005, "{residual:?}");
}

#[test]
fn contact_and_nodes_agree_at_the_end_of_a_step() {
    // Normals are given and no gap is left over, so that Signorini's and Coulomb's conditions can be written down.
    for friction in [0.0, 0.3] {
        let mut sim = wall_and_block(true, 0.0, |scene| {
            let (normal, gap) = (NormalRule::Prescribed([-1.0, 0.0]), GapRule::Approach);
            scene.contacts = vec![ContactRule { bodies: [0, 1], friction, normal, gap }];
        });
        let (mut pressed, mut stuck) = (0, 0);
        while sim.time() < 0.02 {
            sim.step().expect("a step");
            let scale = sim.contact_points().iter().map(|at| norm(at.impulse)).fold(0.0, f64::max);
            let fastest = sim.largest_speed();
            for at in sim.contact_points() {
                let [wall, block] = [0, 1].map(|f| velocity_at(&sim, f, at.x));
                let (across, along) = (block[0] - wall[0], block[1] - wall[1]);
                let [p, q] = [-at.impulse[0], at.impulse[1]];
                let still = 2e-3 * fastest;
                assert!(p >= 0.0 && across <= still, "{at:?}: approach by {across}");
                assert!(q.abs() <= friction * p * (1.0 + 1e-9) + 1e-12 * scale, "{at:?}");
                if p > 1e-3 * scale {
                    pressed += 1;
                    assert!(across.abs() < still, "{at:?}: pressed and parting by {across}");
                    if q.abs() < 0.99 * friction * p && at.x[1] > 0.5 * H {
                        stuck += 1;
                        assert!(along.abs() < still, "{at:?}: sticks and slides by {along}");
                    }
                }
            }
        }
        assert!(pressed > 50 && (stuck > 10) == (friction > 0.0), "{pressed} {stuck}");
    }
}

/// Velocity of a field at a node after the momentum balance; of a body with a mesh as its nodes give it, m/s.
fn velocity_at(sim: &Simulation, field: usize, x: [f64; 2]) -> [f64; 2] {
    let field = &sim.fields[field];
    let place = x.map(|x| (x / H).round() as i64);
    let node = field.grid.find(place).expect("an active node");
    let band = field.bands.iter().rposition(|b| b.first_node <= node).expect("a band");
    let work = &field.bands[band].work;
    let at = node - field.bands[band].first_node;
    if field.bodies[0].mesh.is_some() { work.strain_velocity[at] } else { [work.motion[at][0], work.motion[at][1]] }
}

#[test]
fn a_wall_with_a_mesh_takes_the_impact_of_one_of_points() {
    let impact = |mesh: bool| {
        let mut sim = wall_and_block(mesh, 0.0, |scene| scene.numerics.max_time_step = 1e-4);
        let (mut impulse, mut peak, mut bent) = (0.0, 0.0f64, 0.0f64);
        let start = sim.points_of(0).fold(0.0, |a: f64, p| a.max(p.x[0]));
        while sim.time() < 0.06 {
            sim.step().expect("a step");
            let given = -sim.contact_tallies().map(|t| t.exchange.impulse[0]).sum::<f64>();
            impulse += given;
            peak = peak.max(given / sim.time_step().dt);
            bent = bent.max(sim.points_of(0).fold(0.0, |a: f64, p| a.max(p.x[0])) - start);
        }
        [impulse, bent]
    };
    let (points, mesh) = (impact(false), impact(true));
    println!("{points:?} {mesh:?}");
    for (a, b) in points.iter().zip(mesh) {
        assert!((b / a - 1.0).abs() < 0.05, "{points:?} {mesh:?}");
    }
}

#[test]
#[should_panic(expected = "only neo-Hookean")]
fn only_the_neo_hookean_law_knows_a_mesh() {
    let law = AnyLaw::LinearElastic(LinearElastic::new(1e6, 0.3));
    let _ = Simulation::new(meshed(&Brick::new([0.0; 2], [4, 4], H), law, 1000.0, vec![]));
}
