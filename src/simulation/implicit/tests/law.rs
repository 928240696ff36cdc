//! Body and contact law agree at every node at the end of a step.

use super::{H, wall_and_block};
use crate::boundary::Boundary;
use crate::contact::rule::{ContactRule, GapRule, NormalRule};
use crate::simulation::field::VelocityField;
use crate::simulation::implicit::PASSES;
use crate::simulation::{ContactPoint, Scene, Simulation};

/// A second block rides on the back of the first and is not in contact with the wall; the bodies are numbered the other way round
/// where `turned`. Normals are given and no gap is left over, so that Signorini's and Coulomb's conditions can be written down.
fn with_rider(scene: &mut Scene, friction: f64, turned: bool) {
    let (block, mut points) = scene.bodies[1].clone();
    points.iter_mut().for_each(|p| p.x[0] -= 6.0 * H);
    scene.bodies.push((block, points));
    scene.boundaries[1].bodies.push(2);
    let between = |bodies: [usize; 2], friction: f64, out: f64| {
        let (normal, gap) = (NormalRule::Prescribed([out, 0.0]), GapRule::Approach);
        ContactRule { bodies, friction, normal, gap }
    };
    scene.contacts = vec![between([0, 1], friction, -1.0), between([1, 2], 0.2, -1.0)];
    if turned {
        scene.bodies.reverse();
        let turn = |b: &mut Boundary| b.bodies.iter_mut().for_each(|b| *b = 2 - *b);
        scene.boundaries.iter_mut().for_each(turn);
        scene.contacts = vec![between([2, 1], friction, -1.0), between([1, 0], 0.2, -1.0)];
    }
}

/// Velocity of the block over that of the wall at a node: after the momentum balance, and as strains see it, m/s.
fn relative(sim: &Simulation, at: &ContactPoint) -> [[f64; 2]; 2] {
    let place = at.x.map(|x| (x / H).round() as i64);
    let body = sim.implicit_body();
    let (wall, block) = (&sim.fields[body.field], &sim.fields[1]);
    let find = |field: &VelocityField| {
        let node = field.grid.find(place).expect("an active node");
        let band = field.bands.iter().rposition(|b| b.first_node <= node).expect("a band");
        (band, node - field.bands[band].first_node)
    };
    let (own, (band, node)) = (find(wall), find(block));
    let number = body.places.iter().position(|place| *place == own).expect("a node with mass");
    let largest = body.mass.iter().fold(0.0f64, |a, m| a.max(*m));
    let v = [body.velocity[2 * number], body.velocity[2 * number + 1]];
    assert_eq!(wall.bands[own.0].work.strain_velocity[own.1], v, "strains see how the wall moves");
    let nodes = &block.bands[band].work;
    let [motion, strain] = [[nodes.motion[node][0], nodes.motion[node][1]], nodes.strain_velocity[node]];
    assert!(body.mass[number] >= 1e-3 * largest, "contact where the wall has next to no mass");
    [motion, strain].map(|u| [u[0] - v[0], u[1] - v[1]])
}

#[test]
fn nodes_that_press_move_together_and_friction_opposes_what_slides() {
    for (friction, speed, turned) in [(0.0, 2.0, false), (0.4, 2.0, true), (0.4, 0.02, false)] {
        let mut sim = wall_and_block(2e7, true, speed, 2e-4, |scene| with_rider(scene, friction, turned));
        let wall = if turned { 2 } else { 0 };
        assert!(sim.structures.len() == 1 && sim.fields[sim.implicit_body().field].members == [wall]);
        let still = 1e-5 * speed;
        let (mut pressed, mut stuck, mut slid) = (0, 0, 0);
        while sim.time() < 0.02 {
            sim.step().expect("a step");
            let between = || sim.contact_points().iter().filter(|at| at.contact == 0);
            let scale = between().map(|at| at.impulse[0].abs()).fold(0.0, f64::max);
            for at in between() {
                let [[vx, vy], strain] = relative(&sim, at);
                // The impulse on the block, out of the wall and up.
                let [p, q] = [-at.impulse[0], at.impulse[1]];
                assert!(p >= 0.0 && vx <= still, "{at:?}: approach by {vx} m/s");
                // Strains see the same where nothing else acts on the node.
                let others = sim.contact_points().iter().filter(|b| b.x == at.x).count() > 1 || at.x[1] < 0.5 * H;
                let strain = if others { [0.0; 2] } else { strain };
                assert!(strain[0] <= still, "{at:?}: strains as if it approached by {} m/s", strain[0]);
                assert!(q.abs() <= friction * p * (1.0 + 1e-9) + 1e-12 * scale, "{at:?}");
                if p > 1e-6 * scale {
                    pressed += 1;
                    assert!(vx.abs() < still, "{at:?}: pressed and parting by {vx} m/s");
                    if q.abs() < 0.999 * friction * p {
                        stuck += 1;
                        assert!(vy.abs() < still, "{at:?}: sticks and slides by {vy} m/s");
                        assert!(
                            strain[0].hypot(strain[1]) < still,
                            "{at:?}: sticks and strains as if it slid: {strain:?}"
                        );
                    } else if vy.abs() > still && friction > 0.0 {
                        slid += 1;
                        assert!(vy * q < 0.0, "{at:?}: pushed along by friction");
                    }
                }
            }
        }
        let passes = sim.implicit_body().passes;
        println!("friction {friction}: {pressed} pressed, {stuck} stuck, {slid} slid; {passes} sweeps");
        assert!(pressed > 50 && (stuck > 10) == (friction > 0.0), "{pressed} {stuck}");
        assert!((slid > 10) == (friction > 0.0), "{slid}");
        assert!(passes > 3 && passes < PASSES, "{passes} sweeps");
    }
}

#[test]
fn a_wall_that_nothing_touches_takes_one_sweep() {
    let mut sim = wall_and_block(2e7, true, -2.0, 2e-4, |_| ());
    (0..5).for_each(|_| sim.step().expect("a step"));
    assert!(sim.contact_points().is_empty() && sim.implicit_body().passes == 1);
}

#[test]
fn steps_keep_their_length_while_it_serves() {
    // Of what is stable, 97 % or, as long as that does not need a new factorisation, 94 to 100 %.
    let mut sim = wall_and_block(2e7, true, 8.0, 1.0, |_| ());
    let (mut last, mut changes) = (0.0, 0);
    while sim.time() < 0.03 {
        let block = &sim.bodies()[1];
        let fastest = sim.points_of(1).fold(0.0f64, |a, p| a.max(p.v[0].abs()).max(p.v[1].abs()));
        let stable = 0.4 * H / (block.p_wave_speed() + fastest);
        sim.step().expect("a step");
        let dt = sim.time_step().dt;
        let keep = last <= stable && last >= 0.94 * stable;
        assert!(keep == (dt == last) && (keep || (dt / stable - 0.97).abs() < 1e-9), "{dt} after {last}: {stable}");
        changes += usize::from(!keep);
        last = dt;
    }
    println!("{changes} changes in {} steps", sim.steps());
    assert!(changes > 2 && changes * 3 < sim.steps() as usize);
}
