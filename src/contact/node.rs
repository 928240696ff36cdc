//! The law of contact at a node.
//!
//! Each pair of bodies exchanges an impulse: along the normal what stops their approach, never what holds them back, and along
//! the surface what stops sliding, at most the friction coefficient times the normal part. Where more than two bodies meet, or
//! boundaries hold one of them, all impulses are found together by projected Gauss-Seidel iteration (Jean 1999), normal parts
//! first, in the order of the pairs.
//!
//! Impulses are accumulated per pair and given to both bodies with opposite signs, so momentum is kept to round-off. Work is
//! impulse times the mean of the velocities before and after the step: with all other agents counted in the same way the works
//! add up to the change of the node's kinetic energy exactly.
//!
//! Elsewhere: non-smooth contact dynamics, a complementarity problem at each node. There is no warm start: impulses
//! begin at zero in each step.

use super::Vector;
use super::pair::{State, Touch};
use super::side::Side;
use crate::space::{dot, minus, plus, scaled};

/// Most visits to each pair where impulses depend on each other.
const SWEEPS: usize = 400;
/// Velocities that change by less than this share of the largest are final.
const SETTLED: f64 = 1e-14;

/// Solves the contact of all bodies at a node: replaces their velocities, and fills in impulses and states of the touches.
///
/// One pair is solved exactly. Of three bodies, one that is a hundred times lighter than two that squeeze it may keep a
/// thousandth of its approach; momentum and work are exact all the same.
pub fn solve(sides: &mut [Side], touches: &mut [Touch]) {
    solve_held(sides, touches, None::<fn(usize, f64, &mut Vector, bool)>);
}

/// The same with boundaries that hold some of the bodies. `hold` is given the index of a side, its mass, its velocity, and
/// whether friction counts; it brings the impulses of all boundaries that act on the side up to date with its velocity.
///
/// A body that is a hundred times lighter than another that presses it on a boundary may keep some hundredths of its approach.
pub fn solve_held(
    sides: &mut [Side],
    touches: &mut [Touch],
    mut hold: Option<impl FnMut(usize, f64, &mut Vector, bool)>,
) {
    touches.iter_mut().for_each(Touch::reset);
    if touches.len() == 1 && hold.is_none() {
        // Normal and tangential part do not see each other: one visit is exact.
        touches[0].relax(sides, touches[0].friction);
        return;
    }
    // What one surface takes as normal force another could take as friction; normal impulses come first, and friction finds
    // what sliding they leave.
    for with_friction in [false, true] {
        for _ in 0..SWEEPS {
            let mut settling = Settling::default();
            for touch in touches.iter_mut() {
                let before = touch.sides.map(|s| sides[s].velocity);
                touch.relax(sides, if with_friction { touch.friction } else { 0.0 });
                for (s, before) in touch.sides.into_iter().zip(before) {
                    settling.see(before, sides[s].velocity);
                }
            }
            if let Some(hold) = hold.as_mut() {
                visit(sides, hold, with_friction, &mut settling);
            }
            if settling.is_done() {
                break;
            }
        }
    }
}

/// Lets the boundaries act on every side that they hold.
fn visit(
    sides: &mut [Side],
    hold: &mut impl FnMut(usize, f64, &mut Vector, bool),
    with_friction: bool,
    settling: &mut Settling,
) {
    for (k, side) in sides.iter_mut().enumerate().filter(|(_, s)| s.held && !s.fixed) {
        let before = side.velocity;
        hold(k, side.mass, &mut side.velocity, with_friction);
        settling.see(before, side.velocity);
    }
}

/// Largest velocity of a sweep and its largest change.
#[derive(Default)]
struct Settling {
    largest: f64,
    change: f64,
}

impl Settling {
    fn see(&mut self, before: Vector, after: Vector) {
        for d in 0..2 {
            self.largest = self.largest.max(before[d].abs());
            self.change = self.change.max((after[d] - before[d]).abs());
        }
    }

    fn is_done(&self) -> bool {
        self.change <= SETTLED * self.largest
    }
}

/// Applies what [`solve`] decided to other velocities of the same bodies: those that stick move together, those that slip do
/// not approach. For velocities mapped back from the points, which strain the material; no impulse is counted. Momentum is
/// kept, kinetic energy does not grow.
pub fn project(sides: &mut [Side], touches: &[Touch]) {
    let visits = if touches.len() > 1 { 4 } else { 1 };
    for _ in 0..visits {
        for touch in touches.iter().filter(|t| t.state() != State::Apart) {
            let [a, b] = touch.sides;
            let (to_a, to_b) = (sides[a].mobility(), sides[b].mobility());
            let mobility = to_a + to_b;
            if mobility <= 0.0 {
                continue;
            }
            let relative = minus(sides[a].velocity, sides[b].velocity);
            let stop = match touch.state() {
                State::Sticking => relative,
                _ => {
                    let approach = (dot(relative, touch.normal) - touch.slack).max(0.0);
                    scaled(touch.normal, approach)
                }
            };
            sides[a].velocity = minus(sides[a].velocity, scaled(stop, to_a / mobility));
            sides[b].velocity = plus(sides[b].velocity, scaled(stop, to_b / mobility));
        }
    }
}
