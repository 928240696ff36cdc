//! The grid solve: nodal sums, momentum balance, contact with rigid boundaries, for the nodes that a band owns.
//!
//! A node near the left edge of a band is also reached by points of the band before: their sum comes first, then the band's own.
//! What the band before needs to see of the result is copied back into its reach.
//!
//! Elsewhere: the nodal momentum equation with lumped mass, in explicit steps. What is copied between bands is the halo
//! exchange.

use crate::band::{Band, NodeSum, OpenNode};
use crate::boundary::Boundary;
use crate::boundary::nodes::{self, Hold, Remapped, Tally};
use crate::ledger::Distributed;
use crate::seeded::{self, Seed};
use crate::space::{mean, minus, norm, plus, scaled};

/// What acts on every node alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyForces {
    /// Gravity, m/s2.
    pub gravity: [f64; 2],
    /// Mass-proportional damping, 1/s.
    pub damping: f64,
}

/// Gives every band the holds of its nodes.
///
/// `holds` lists what holds the nodes of the whole grid, in their order.
pub fn distribute_holds(holds: &[Hold], boundaries: usize, bands: &mut [Band]) {
    let mut rest = holds;
    for band in bands {
        let end = band.first_node + band.owned;
        let (own, others) = rest.split_at(rest.partition_point(|h| (h.node as usize) < end));
        band.holds.clear();
        band.holds.extend_from_slice(own);
        band.tallies.clear();
        band.tallies.resize(boundaries, Tally::default());
        rest = others;
    }
}

/// Internal force at an owned node of a band, N.
pub fn internal_force(before: Option<&Band>, band: &Band, node: usize) -> [f64; 2] {
    total(tail(before, |b| &b.work.sums), &band.work.sums, node).force()
}

/// Sums of node `i` of a band over its points and those of the band before it.
#[inline(always)]
fn total(before: &[NodeSum], own: &[NodeSum], i: usize) -> NodeSum {
    let mut sum = own[i];
    if let Some(first) = before.get(i) {
        for (s, b) in sum.0.iter_mut().zip(&first.0) {
            *s += b;
        }
    }
    sum
}

/// What the band before adds to the first nodes of this one, for one of its nodal fields.
fn tail<T>(before: Option<&Band>, field: impl Fn(&Band) -> &[T]) -> &[T] {
    before.map_or(&[], |b| field(b).get(b.owned..).unwrap_or_default())
}

/// Copies a nodal field of the first nodes of a band into the reach of the band before.
fn hand_back<T: Copy>(own: &[T], owned_before: usize, before: &mut [T]) {
    let past = &mut before[owned_before..];
    let shared = past.len().min(own.len());
    past[..shared].copy_from_slice(&own[..shared]);
}

/// Nodal masses and velocities of the step's start, for a stress update before the momentum balance (USF).
pub fn old_velocities(mut before: Option<&mut Band>, band: &mut Band) {
    let sums = tail(before.as_deref(), |b| &b.work.sums);
    let work = &mut band.work;
    for i in 0..work.mass.len() {
        let sum = total(sums, &work.sums, i);
        work.mass[i] = sum.mass();
        work.strain_velocity[i] = per_mass(sum.mass(), sum.momentum());
    }
    project(band);
    if let Some(before) = &mut before {
        let owned = before.owned;
        hand_back(&band.work.strain_velocity, owned, &mut before.work.strain_velocity);
    }
}

/// Velocities from the momentum that the points carry after their update (MUSL), for the stress update. Books what boundaries take of
/// them in a step of `dt` seconds.
pub fn remapped_velocities(mut before: Option<&mut Band>, band: &mut Band, dt: f64) {
    let momenta = tail(before.as_deref(), |b| &b.work.remapped);
    let work = &mut band.work;
    for (i, &m) in work.mass.iter().enumerate() {
        let mut p = work.remapped[i];
        if let Some(first) = momenta.get(i) {
            p = plus(p, *first);
        }
        work.strain_velocity[i] = per_mass(m, p);
    }
    let sums = tail(before.as_deref(), |b| &b.work.sums);
    let Band { work, holds, tallies, first_node, .. } = band;
    for holds in holds.chunk_by(|a, b| a.node == b.node) {
        let node = holds[0].node as usize - *first_node;
        let [x, y, ..] = work.motion[node];
        let internal = scaled(total(sums, &work.sums, node).force(), dt);
        let remapped = Remapped { balance: [x, y], v: work.strain_velocity[node], internal };
        work.strain_velocity[node] = remapped.project(holds, tallies);
    }
    if let Some(before) = &mut before {
        let owned = before.owned;
        hand_back(&band.work.strain_velocity, owned, &mut before.work.strain_velocity);
    }
}

#[inline(always)]
fn per_mass(m: f64, p: [f64; 2]) -> [f64; 2] {
    if m > 0.0 { scaled(p, 1.0 / m) } else { [0.0; 2] }
}

/// New velocity and its change, side by side as the points read them.
#[inline(always)]
fn motion(old: [f64; 2], v: [f64; 2]) -> [f64; 4] {
    let change = minus(v, old);
    [v[0], v[1], change[0], change[1]]
}

/// Applies the contact state of each held node to the velocity that strains the material.
fn project(band: &mut Band) {
    let velocity = &mut band.work.strain_velocity;
    for holds in band.holds.chunk_by(|a, b| a.node == b.node) {
        nodes::project(holds, &mut velocity[holds[0].node as usize - band.first_node], |_, _| {});
    }
}

/// Momentum balance of every node and its contact with the boundaries: v = v + dt (f/m + g), then drags, then contact. Nodes that
/// other velocity fields reach are left open.
pub fn balance(before: Option<&mut Band>, band: &mut Band, boundaries: &[Boundary], forces: BodyForces, dt: f64) {
    if band.shared.is_empty() {
        balance_nodes::<false>(before, band, boundaries, forces, dt);
    } else {
        balance_nodes::<true>(before, band, boundaries, forces, dt);
    }
}

fn balance_nodes<const SHARED: bool>(
    mut before: Option<&mut Band>,
    band: &mut Band,
    boundaries: &[Boundary],
    forces: BodyForces,
    dt: f64,
) {
    band.tallies.fill(Tally::default());
    band.distributed = Distributed::default();
    sum_field(before.as_deref(), band);
    let sums = tail(before.as_deref(), |b| &b.work.sums);
    let work = &mut band.work;
    let (mut next_hold, mut next_shared) = (0, 0);
    let gravity = forces.gravity.map(|g| seeded::times(Seed::MomentumGravity, g));
    let late = seeded::is(Seed::MomentumDrag);
    for i in 0..work.mass.len() {
        let sum = total(sums, &work.sums, i);
        let m = sum.mass();
        work.mass[i] = m;
        let first_hold = next_hold;
        while band.holds.get(next_hold).is_some_and(|h| h.node as usize == band.first_node + i) {
            next_hold += 1;
        }
        let open = SHARED && band.shared.get(next_shared).is_some_and(|&s| s as usize == i);
        next_shared += usize::from(open);
        if m <= 0.0 {
            if open {
                band.open[next_shared - 1] = OpenNode::default();
            }
            work.motion[i] = [0.0; 4];
            work.strain_velocity[i] = [0.0; 2];
            band.holds[first_hold..next_hold].iter_mut().for_each(Hold::let_go);
            continue;
        }
        let per_m = 1.0 / m;
        let old = scaled(sum.momentum(), per_m);
        let mut f = sum.force();
        let field = band.field_force.get(i).copied();
        if let Some(field) = field {
            f = plus(f, field);
        }
        let mut v = plus(old, scaled(plus(scaled(f, per_m), gravity), dt));
        let mut damped = [0.0; 2];
        if forces.damping > 0.0 {
            let share = (dt * forces.damping).min(1.0);
            damped = scaled(old, -share * m);
            v = plus(v, scaled(damped, per_m));
        }
        let mut braked = [0.0; 2];
        let side_friction = sum.side_friction();
        if side_friction > 0.0 {
            let speed = norm(v);
            let share = if speed > 0.0 { (dt * side_friction / (m * speed)).min(1.0) } else { 0.0 };
            braked = scaled(v, -share * m);
            v = scaled(v, 1.0 - share);
        }
        if open {
            let field = field.map_or([0.0; 2], |f| scaled(f, dt));
            band.open[next_shared - 1] = OpenNode { mass: m, old, free: v, damped, braked, field };
            continue;
        }
        if next_hold > first_hold {
            let holds = &mut band.holds[first_hold..next_hold];
            nodes::solve(holds, boundaries, m, old, &mut v, &mut band.tallies);
        }
        let mean = mean(old, v);
        if forces.damping > 0.0 {
            band.distributed.damping.add(damped, mean);
        }
        if side_friction > 0.0 {
            band.distributed.side_walls.add(braked, if late { v } else { mean });
        }
        if let Some(f) = field {
            band.distributed.field.add(scaled(f, dt), mean);
        }
        work.motion[i] = motion(old, v);
        work.strain_velocity[i] = v;
    }
    if let Some(before) = &mut before {
        let owned = before.owned;
        hand_back(&band.work.motion, owned, &mut before.work.motion);
        hand_back(&band.work.strain_velocity, owned, &mut before.work.strain_velocity);
    }
}

/// Gives an open node its velocity: books the drags, and lets both bands that reach the node see how it moves. `node` counts
/// from the band's first, `index` is its place among the open ones.
pub fn close(before: Option<&mut Band>, band: &mut Band, node: usize, index: usize, v: [f64; 2]) {
    let open = band.open[index];
    let mean = mean(open.old, v);
    band.distributed.damping.add(open.damped, mean);
    band.distributed.side_walls.add(open.braked, mean);
    band.distributed.field.add(open.field, mean);
    amend(before, band, node, index, v);
}

/// Gives an open node a velocity and books nothing.
pub fn amend(before: Option<&mut Band>, band: &mut Band, node: usize, index: usize, v: [f64; 2]) {
    let motion = motion(band.open[index].old, v);
    band.work.motion[node] = motion;
    if let Some(before) = before {
        let past = before.owned + node;
        if let Some(seen) = before.work.motion.get_mut(past) {
            *seen = motion;
        }
    }
}

/// Sets the velocity that strains the material at one node, for both bands that reach it.
pub fn set_strain_velocity(before: Option<&mut Band>, band: &mut Band, node: usize, v: [f64; 2]) {
    band.work.strain_velocity[node] = v;
    if let Some(before) = before {
        let past = before.owned + node;
        if let Some(seen) = before.work.strain_velocity.get_mut(past) {
            *seen = v;
        }
    }
}

/// Completes the force of a body-force field, if there is one.
fn sum_field(before: Option<&Band>, band: &mut Band) {
    let past = tail(before, |b| &b.field_force);
    for (own, first) in band.field_force.iter_mut().zip(past) {
        *own = plus(*own, *first);
    }
}
