//! The impulses at shared nodes, with boundaries and contact together.

use super::{ContactPoint, Coupling, SharedSide, Solved, VelocityField};
use crate::band::with_before;
use crate::boundary::{Boundary, nodes};
use crate::contact::Vector;
use crate::contact::node;
use crate::contact::pair::{State, Touch};
use crate::contact::rule::{MAX_SIDES, Sides};
use crate::contact::separation::area;
use crate::contact::side::Side;
use crate::momentum;
use crate::shape::ShapeFunction;
use crate::simulation::implicit::PASSES;
use crate::simulation::structure::Structure;
use crate::space::{plus, scaled};

impl Coupling {
    /// Closes the momentum balance of all shared nodes: finds where bodies touch, and the impulses of contact and boundaries.
    ///
    /// Structures answer an impulse at one node at other nodes: with them contact is repeated until it no longer changes what they do, and
    /// only the last pass counts.
    pub fn exchange(
        &mut self,
        fields: &mut [VelocityField],
        boundaries: &[Boundary],
        shape: ShapeFunction,
        dt: f64,
        structures: &mut [Structure],
    ) {
        self.find_touches(fields, shape, dt);
        if !structures.is_empty() {
            self.approach(fields, boundaries, structures);
        }
        self.pass(fields, boundaries, structures, true);
    }

    /// Passes without consequences, until structures and contact agree.
    fn approach(&mut self, fields: &mut [VelocityField], boundaries: &[Boundary], structures: &mut [Structure]) {
        for p in &self.pending {
            for side in &self.sides[self.nodes[p.node as usize].sides.clone()] {
                let here = fields[side.field].bands[side.band].open[side.index].mass > 0.0;
                if let Some(body) = structures.iter_mut().find(|b| here && b.field() == side.field) {
                    body.touch(body.slot(side.band, side.index));
                }
            }
        }
        structures.iter_mut().for_each(Structure::weigh);
        for pass in 0..PASSES {
            self.pass(fields, boundaries, structures, false);
            let mut settled = true;
            for body in structures.iter_mut() {
                settled &= body.settle(pass + 1);
            }
            if settled {
                break;
            }
        }
    }

    /// Solves all nodes once; `last` says whether it counts.
    fn pass(
        &mut self,
        fields: &mut [VelocityField],
        boundaries: &[Boundary],
        structures: &mut [Structure],
        last: bool,
    ) {
        self.touches.clear();
        self.solved.clear();
        self.points.clear();
        let mut next = 0;
        for n in 0..self.nodes.len() {
            let first = next;
            while self.pending.get(next).is_some_and(|p| p.node as usize == n) {
                next += 1;
            }
            if last || next > first {
                self.solve(n, first..next, fields, boundaries, structures, last);
            }
        }
    }

    fn find_touches(&mut self, fields: &[VelocityField], shape: ShapeFunction, dt: f64) {
        let Self { interfaces, nodes, sides, pending, .. } = self;
        pending.clear();
        let mass = |node: usize, side: usize| {
            let s = &sides[nodes[node].sides.start + side];
            fields[s.field].bands[s.band].open[s.index].mass
        };
        for interface in interfaces.iter_mut() {
            interface.find_touches(fields, shape, dt, nodes, mass, pending);
        }
        pending.sort_unstable_by_key(|p| (p.node, p.contact));
    }

    /// One node: all its sides, with what touches there.
    fn solve(
        &mut self,
        n: usize,
        pending: std::ops::Range<usize>,
        fields: &mut [VelocityField],
        boundaries: &[Boundary],
        structures: &mut [Structure],
        last: bool,
    ) {
        let shared = &self.nodes[n];
        let own = &self.sides[shared.sides.clone()];
        if !pending.is_empty() {
            for body in structures.iter() {
                let slot = |at: &SharedSide| body.slot(at.band, at.index);
                let touched = own.iter().filter(|at| at.field == body.field() && body.is_touched(slot(at)));
                touched.for_each(|at| body.offer(slot(at), &mut fields[at.field]));
            }
        }
        let mut sides: Sides = Default::default();
        self.holds.clear();
        let mut ends = [0; MAX_SIDES];
        for (k, (side, at)) in sides.iter_mut().zip(own).enumerate() {
            let band = &fields[at.field].bands[at.band];
            let open = &band.open[at.index];
            *side = Side { mass: open.mass, old: open.old, velocity: open.free, fixed: false, held: false };
            if open.mass > 0.0 {
                self.holds.extend_from_slice(&band.holds[at.holds.clone()]);
            }
            side.held = open.mass > 0.0 && !at.holds.is_empty();
            ends[k] = self.holds.len();
        }
        nodes::reset(&mut self.holds);
        let sides = &mut sides[..own.len()];
        let range = |k: usize| if k == 0 { 0..ends[0] } else { ends[k - 1]..ends[k] };

        if !pending.is_empty() {
            let first = self.touches.len();
            for p in &self.pending[pending.clone()] {
                let friction = self.interfaces[p.contact as usize].friction();
                self.touches.push(Touch::new(p.sides.map(usize::from), p.normal, friction).with_slack(p.slack));
            }
            for (k, side) in sides.iter_mut().enumerate() {
                if let Some(v) = self.holds[range(k)].iter().find_map(|h| h.clamped(boundaries)) {
                    (side.fixed, side.velocity) = (true, v);
                }
            }
            let touches = &mut self.touches[first..];
            if sides.iter().any(|s| s.held && !s.fixed) {
                let holds = &mut self.holds;
                let hold = |k: usize, m: f64, v: &mut Vector, with_friction: bool| {
                    nodes::visit(&mut holds[range(k)], boundaries, m, v, with_friction);
                };
                node::solve_held(sides, touches, Some(hold));
            } else {
                node::solve(sides, touches);
            }
            for body in structures.iter_mut() {
                let touched =
                    |at: &SharedSide| at.field == body.field() && body.is_touched(body.slot(at.band, at.index));
                let Some(k) = own.iter().position(touched) else { continue };
                let mut impulse = [0.0; 2];
                for touch in touches.iter().filter(|t| t.sides.contains(&k)) {
                    let (sign, p) = (if touch.sides[1] == k { 1.0 } else { -1.0 }, touch.vector_impulse());
                    impulse = plus(impulse, scaled(p, sign));
                }
                body.take(body.slot(own[k].band, own[k].index), impulse);
            }
            if !last {
                return;
            }
            // What contact gives to a clamped body goes into the clamp.
            for (k, side) in sides.iter_mut().enumerate().filter(|(_, s)| s.fixed) {
                let at = &own[k];
                let free = fields[at.field].bands[at.band].open[at.index].free;
                let mut v = free;
                for touch in touches.iter() {
                    let p = touch.vector_impulse();
                    let sign = f64::from(u8::from(touch.sides[1] == k)) - f64::from(u8::from(touch.sides[0] == k));
                    v = plus(v, scaled(p, sign).map(|p| p / side.mass));
                }
                nodes::visit(&mut self.holds[range(k)], boundaries, side.mass, &mut v, true);
                side.velocity = v;
            }
            let spacing = fields[own[0].field].grid.spacing;
            let volume = |k: usize| {
                let (at, body) = (&own[k], &fields[own[k].field].bodies[0]);
                let structure = structures.iter().find(|b| b.field() == at.field);
                let mass = structure.and_then(|b| b.mass_at(b.slot(at.band, at.index))).unwrap_or(sides[k].mass);
                mass * body.point_volume / body.point_mass
            };
            for (p, touch) in self.pending[pending].iter().zip(touches.iter()) {
                if touch.state() != State::Apart {
                    let exchange = touch.exchange(sides);
                    self.interfaces[p.contact as usize].tally.add(&exchange, shared.x);
                    let impulse = exchange.impulse;
                    self.points.push(ContactPoint {
                        contact: p.contact as usize,
                        x: shared.x,
                        normal: p.normal,
                        impulse,
                        area: area(volume(touch.sides[0]), volume(touch.sides[1]), spacing),
                    });
                }
            }
            let mut solved = Solved {
                node: n,
                touches: first..self.touches.len(),
                masses: [0.0; MAX_SIDES],
                clamped: [false; MAX_SIDES],
            };
            for (k, side) in sides.iter().enumerate() {
                let moved_later = structures.iter().any(|b| b.field() == own[k].field);
                (solved.masses[k], solved.clamped[k]) = (side.mass, side.fixed || moved_later);
            }
            self.solved.push(solved);
        } else {
            for (k, side) in sides.iter_mut().enumerate().filter(|(_, s)| s.mass > 0.0) {
                let holds = &mut self.holds[range(k)];
                if holds.len() > 1 {
                    nodes::visit(holds, boundaries, side.mass, &mut side.velocity, false);
                }
                nodes::visit(holds, boundaries, side.mass, &mut side.velocity, true);
            }
        }

        for (k, (side, at)) in sides.iter().zip(own).enumerate().filter(|(_, (s, _))| s.mass > 0.0) {
            let (before, band) = with_before(&mut fields[at.field].bands, at.band);
            band.holds[at.holds.clone()].copy_from_slice(&self.holds[range(k)]);
            nodes::book(&self.holds[range(k)], side.mean(), &mut band.tallies);
            let (mut before, v) = (before, side.velocity);
            momentum::close(before.as_deref_mut(), band, at.node, at.index, v);
            momentum::set_strain_velocity(before, band, at.node, v);
        }
    }

    /// Applies what was decided at the nodes to the velocities that strain the material, after they were mapped back.
    pub fn project(&self, fields: &mut [VelocityField]) {
        for solved in &self.solved {
            let own = &self.sides[self.nodes[solved.node].sides.clone()];
            let mut sides: Sides = Default::default();
            for (k, (side, at)) in sides.iter_mut().zip(own).enumerate() {
                let velocity = fields[at.field].bands[at.band].work.strain_velocity[at.node];
                *side = Side { mass: solved.masses[k], velocity, old: velocity, fixed: solved.clamped[k], held: false };
            }
            node::project(&mut sides[..own.len()], &self.touches[solved.touches.clone()]);
            for (side, at) in sides.iter_mut().zip(own).filter(|(s, _)| s.mass > 0.0) {
                let (before, band) = with_before(&mut fields[at.field].bands, at.band);
                nodes::project(&band.holds[at.holds.clone()], &mut side.velocity, |_, _| {});
                momentum::set_strain_velocity(before, band, at.node, side.velocity);
            }
        }
    }
}
