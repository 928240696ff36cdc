//! Body and contact law agree at every node at the end of a step.

use super::{H, wall_and_block};
use crate::contact::rule::{GapRule, NormalRule};
use crate::simulation::implicit::PASSES;
use crate::simulation::{ContactPoint, Simulation};

/// Velocity of the block at a node over that of the wall, m/s.
fn relative(sim: &Simulation, at: &ContactPoint) -> [f64; 2] {
    let place = at.x.map(|x| (x / H).round() as i64);
    let (body, wall, block) = (&sim.implicit[0], &sim.fields[0], &sim.fields[1]);
    let node = wall.grid.find(place).expect("a node of the wall");
    let number = body.places.iter().position(|&(b, i)| wall.bands[b].first_node + i == node).expect("a number");
    let node = block.grid.find(place).expect("a node of the block");
    let band = block.bands.iter().rev().find(|b| b.first_node <= node).expect("a band");
    let [vx, vy, ..] = band.nodes.motion[node - band.first_node];
    [vx - body.velocity[2 * number], vy - body.velocity[2 * number + 1]]
}

#[test]
fn nodes_that_press_move_together_and_friction_opposes_what_slides() {
    // Normals are given and no gap is left over, so that Signorini's and Coulomb's conditions can be written down.
    for friction in [0.0, 0.4] {
        let mut sim = wall_and_block(2e7, true, 2.0, 2e-4, |rule| {
            (rule.friction, rule.normal, rule.gap) = (friction, NormalRule::Prescribed([-1.0, 0.0]), GapRule::Approach);
        });
        let (mut pressed, mut stuck, mut slid) = (0, 0, 0);
        while sim.time() < 0.02 {
            sim.step().expect("a step");
            let scale = sim.contact_points().iter().map(|at| at.impulse[0].abs()).fold(0.0, f64::max);
            for at in sim.contact_points() {
                let [vx, vy] = relative(&sim, at);
                // The impulse on the block, out of the wall and up.
                let [p, q] = [-at.impulse[0], at.impulse[1]];
                assert!(p >= 0.0 && -vx >= -2e-5, "{at:?}: approach by {vx} m/s");
                assert!(q.abs() <= friction * p * (1.0 + 1e-9) + 1e-12 * scale, "{at:?}");
                if p > 1e-6 * scale {
                    pressed += 1;
                    assert!(vx.abs() < 2e-5, "{at:?}: pressed and parting by {vx} m/s");
                    if q.abs() < 0.999 * friction * p {
                        stuck += 1;
                        assert!(vy.abs() < 2e-5, "{at:?}: sticks and slides by {vy} m/s");
                    } else if vy.abs() > 2e-5 && friction > 0.0 {
                        slid += 1;
                        assert!(vy * q < 0.0, "{at:?}: pushed along by friction");
                    }
                }
            }
        }
        let passes = sim.implicit[0].passes;
        println!("friction {friction}: {pressed} pressed, {stuck} stuck, {slid} slid; {passes} sweeps");
        assert!(pressed > 100 && (stuck > 10 && slid > 10) == (friction > 0.0), "{pressed} {stuck} {slid}");
        assert!(passes > 3 && passes < PASSES, "{passes} sweeps");
    }
}
