//! A step of a body in implicit steps: before contact, and after.
//!
//! Elsewhere: predictor and corrector.

use super::{ImplicitBody, THETA};
use crate::band::Band;
use crate::body::Particle;
use crate::boundary::Boundary;
use crate::boundary::nodes::Tally;
use crate::constitutive::{AnyLaw, Increment, Law};
use crate::ledger::Distributed;
use crate::momentum::BodyForces;
use crate::simulation::field::VelocityField;
use crate::simulation::sweep::together;
use crate::space::{dot, moment, plus};

impl ImplicitBody {
    /// Finds how the body would move without contact, and opens the nodes that other fields reach.
    pub fn predict(&mut self, field: &mut VelocityField, forces: BodyForces, dt: f64) {
        self.set_step(dt);
        let Self { velocity, blocks, internal, free, pulled, damped, mass, clamped, .. } = self;
        blocks.multiply(velocity, pulled);
        let share = (dt * forces.damping).min(1.0);
        for (node, m) in mass.iter().enumerate() {
            for d in 0..2 {
                let i = 2 * node + d;
                damped[i] = -share * m * velocity[i];
                let force = internal[i] + THETA * (1.0 - THETA) * dt * pulled[i];
                free[i] = m * (velocity[i] + dt * forces.gravity[d]) + damped[i] - dt * force;
                if clamped[node] {
                    free[i] = 0.0;
                }
            }
        }
        self.factor.solve(&mut self.free);
        for s in &mut self.shared {
            s.touched = false;
            let open = &mut field.bands[s.band].open[s.index];
            *open = Default::default();
            if self.mass.get(s.node).is_some_and(|&m| m >= self.touchable) {
                open.mass = self.mass[s.node];
                open.old = [self.velocity[2 * s.node], self.velocity[2 * s.node + 1]];
                open.free = [self.free[2 * s.node], self.free[2 * s.node + 1]];
            }
        }
    }

    /// Ends the step under the impulses found: moves nodes and points, and fills in the sums of the field's bands.
    pub fn finish(&mut self, field: &mut VelocityField, boundaries: &[Boundary], forces: BodyForces, dt: f64) {
        let mut new = std::mem::take(&mut self.free);
        for s in self.shared.iter().filter(|s| s.touched) {
            for (d, p) in s.impulse.into_iter().enumerate().filter(|(_, p)| *p != 0.0) {
                new.iter_mut().zip(self.response(s.node, d)).for_each(|(v, r)| *v += r * p);
            }
        }
        let between = |old: f64, new: f64| (1.0 - THETA) * old + THETA * new;
        self.since += dt;
        for (d, (old, new)) in self.displacement.iter_mut().zip(self.velocity.iter().zip(&new)) {
            *d += dt * between(*old, *new);
        }
        let mut after = std::mem::take(&mut self.after);
        self.blocks.multiply(&self.displacement, &mut after);
        after.iter_mut().zip(&self.force).for_each(|(a, f)| *a += f);
        let before = &self.internal;
        let mean = |i: usize| 0.5 * (self.velocity[i] + new[i]);
        let force = |i: usize| between(before[i], after[i]);
        let travel = |i: usize| dt * between(self.velocity[i], new[i]);
        let stored: f64 = (0..new.len()).map(|i| travel(i) * 0.5 * (before[i] + after[i])).sum();
        let taken: f64 = (0..new.len()).map(|i| dt * force(i) * mean(i)).sum();
        for band in &mut field.bands {
            band.tallies.clear();
            band.tallies.resize(boundaries.len(), Tally::default());
            band.distributed = Distributed::default();
            band.sums = Default::default();
            band.sums.min_volume_ratio = f64::INFINITY;
        }
        // What is missing to the momentum balance of a clamped node comes from its clamp.
        let contact = &mut self.contact;
        contact.fill(0.0);
        for s in self.shared.iter().filter(|s| s.touched && s.node < self.mass.len()) {
            contact[2 * s.node] += s.impulse[0];
            contact[2 * s.node + 1] += s.impulse[1];
        }
        for (node, &(band, at)) in self.places.iter().enumerate() {
            let m = self.mass[node];
            let band = &mut field.bands[band];
            let damped = [self.damped[2 * node], self.damped[2 * node + 1]];
            if forces.damping > 0.0 {
                band.distributed.damping.add(damped, [mean(2 * node), mean(2 * node + 1)]);
            }
            if !self.clamped[node] {
                continue;
            }
            let impulse = [0, 1].map(|d| {
                let i = 2 * node + d;
                let gained = m * (new[i] - self.velocity[i]) - self.caught[i];
                gained - dt * (m * forces.gravity[d] - force(i)) - damped[d] - contact[i]
            });
            let number = band.first_node + at;
            if let Some(hold) = band.holds.iter().find(|h| h.node as usize == number) {
                let tally = Tally { impulse, moment: moment(hold.arm, impulse), ..Tally::default() };
                band.tallies[hold.boundary as usize].add(&tally);
            }
        }
        self.caught.fill(0.0);
        self.free = std::mem::replace(&mut self.velocity, new);
        self.after = std::mem::replace(&mut self.internal, after);
        field.drift = 2.0 * self.displacement.iter().fold(0.0f64, |a, d| a.max(d.abs()));
        let (law, half) = (field.bodies[0].law, self.points.len() / 2);
        let (mut middle, mut first) = (0, 0);
        while first < half {
            first += field.bands[middle].len();
            middle += 1;
        }
        let (before, after) = field.bands.split_at_mut(middle);
        together(|| self.move_points(&law, before, 0), || self.move_points(&law, after, first));
        let points = self.point_kinetic(field);
        let every = field.bands.iter().flat_map(|b| b.points[0].iter());
        let fastest = every.fold(0.0f64, |a, p| a.max(p.v[0].abs()).max(p.v[1].abs()));
        let unseen = self.nodal_kinetic() - points;
        let sums = &mut field.bands[0].sums;
        sums.internal_work = stored;
        sums.kinetic = points;
        // What implicit steps take; the energy of ripples that nodes have and points do not see, which comes and goes; and what a
        // clamp takes of the nodes that it stops at a sort (in explicit steps that is work of the clamp).
        sums.pic_loss = taken - stored + (unseen - self.unseen);
        sums.max_speed = fastest;
        self.unseen = unseen;
        self.show(field);
    }

    /// Lets the shared nodes of the field show how the body moves.
    fn show(&self, field: &mut VelocityField) {
        for s in self.shared.iter().filter(|s| s.node < self.mass.len()) {
            let band = &mut field.bands[s.band];
            let at = band.shared[s.index] as usize;
            band.work.strain_velocity[at] = [self.velocity[2 * s.node], self.velocity[2 * s.node + 1]];
        }
    }

    /// Moves the points of some bands, the first of which has this number.
    fn move_points(&self, law: &AnyLaw, bands: &mut [Band], mut number: usize) {
        for band in bands {
            let mut smallest = f64::INFINITY;
            for i in 0..band.points[0].len() {
                let p = &self.points[number];
                number += 1;
                let (mut moved, mut faster) = ([0.0; 2], [0.0; 2]);
                let mut slope = [0.0; 4];
                for k in 0..9 {
                    let (w, g, node) = (p.weight[k], p.gradient[k], 2 * p.nodes[k] as usize);
                    let d = [self.displacement[node], self.displacement[node + 1]];
                    for e in 0..2 {
                        moved[e] += w * d[e];
                        faster[e] += w * (self.velocity[node + e] - self.start[node + e]);
                    }
                    slope[0] += g[0] * d[0];
                    slope[1] += g[1] * d[0];
                    slope[2] += g[0] * d[1];
                    slope[3] += g[1] * d[1];
                }
                let increment = Increment {
                    dt: self.since,
                    xx: slope[0],
                    yy: slope[3],
                    xy: 0.5 * (slope[1] + slope[2]),
                    spin: 0.5 * (slope[2] - slope[1]),
                };
                let base = &p.base;
                let mut state = base.state;
                law.update(&mut state, &increment);
                let volume_ratio = law.volume_ratio(&state, base.volume_ratio, &increment);
                smallest = smallest.min(volume_ratio);
                let point = Particle {
                    id: base.id,
                    x: plus(base.x, moved),
                    v: plus(base.v, faster),
                    state,
                    volume_ratio,
                    slip: base.slip,
                };
                band.points[0].set(i, &point);
            }
            band.sums.min_volume_ratio = smallest;
        }
    }

    pub(super) fn nodal_kinetic(&self) -> f64 {
        let pairs = self.mass.iter().zip(self.velocity.chunks_exact(2));
        pairs.map(|(m, v)| 0.5 * m * (v[0] * v[0] + v[1] * v[1])).sum()
    }

    pub(super) fn point_kinetic(&self, field: &VelocityField) -> f64 {
        let m = field.bodies[0].point_mass;
        let points = field.bands.iter().flat_map(|b| b.points[0].iter());
        points.map(|p| 0.5 * m * dot(p.v, p.v)).sum()
    }
}
