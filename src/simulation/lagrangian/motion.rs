//! A step of a body in total-Lagrangian kinematics: before contact, and after.

use super::{Embedded, LagrangianBody, gradient, interpolated};
use crate::body::Particle;
use crate::boundary::Boundary;
use crate::boundary::nodes::Tally;
use crate::constitutive::{Finger, NeoHookean};
use crate::ledger::Distributed;
use crate::momentum::BodyForces;
use crate::seeded::{self, Seed};
use crate::shape::ShapeFunction;
use crate::simulation::AccelerationField;
use crate::simulation::field::VelocityField;
use crate::space::{dot, mean, minus, moment, norm, plus, scaled};

/// What acts on the body in a step.
#[derive(Debug, Clone, Copy)]
pub(in crate::simulation) struct Acting<'a> {
    pub boundaries: &'a [Boundary],
    /// On all fields alike.
    pub forces: BodyForces,
    pub field: Option<&'a AccelerationField>,
    pub shape: ShapeFunction,
    /// At the start of the step, s.
    pub time: f64,
    /// s.
    pub dt: f64,
}

impl LagrangianBody {
    /// Finds how the body would move without contact, and shows it at the nodes that other fields reach.
    pub fn predict(&mut self, acting: &Acting) {
        let mut field = std::mem::take(&mut self.own);
        let (forces, dt) = (field.forces(acting.forces), acting.dt);
        self.drive(&field, acting);
        let share = (dt * forces.damping).min(1.0);
        for (node, &m) in self.mass.iter().enumerate() {
            let old = self.velocity[node];
            self.damped[node] = scaled(old, -share * m);
            let given = plus(plus(scaled(self.internal[node], dt), self.damped[node]), self.driven[node]);
            self.next[node] = plus(old, plus(scaled(given, 1.0 / m), scaled(forces.gravity, dt)));
        }
        self.hold_next(acting.boundaries);
        self.solve_free(acting, forces);
        self.show_free(&mut field, acting.shape);
        self.own = field;
    }

    /// Impulses of a field of accelerations on the nodes.
    fn drive(&mut self, field: &VelocityField, acting: &Acting) {
        self.driven.fill([0.0; 2]);
        let Some(AccelerationField(at)) = acting.field else { return };
        let mass = field.bodies[0].point_mass * acting.dt;
        for (p, &k) in field.bands.iter().flat_map(|b| b.points[0].iter()).zip(&self.order) {
            let impulse = scaled(at(&p, acting.time), mass);
            let place = &self.points[k as usize].place;
            for (node, w) in place.nodes.iter().zip(place.weight) {
                let sum = &mut self.driven[*node as usize];
                *sum = plus(*sum, scaled(impulse, w));
            }
        }
    }

    /// Ends the step under the impulses found: moves nodes and points, and fills in the sums of the field's bands.
    pub fn finish(&mut self, acting: &Acting) {
        let mut field = std::mem::take(&mut self.own);
        for band in &mut field.bands {
            band.tallies.clear();
            band.tallies.resize(acting.boundaries.len(), Tally::default());
            band.distributed = Distributed::default();
            band.sums = Default::default();
            band.sums.min_volume_ratio = f64::INFINITY;
        }
        let implicit = self.solve_touched(field.forces(acting.forces).gravity);
        let force = implicit.as_ref().map_or(&self.internal, |(force, _)| force);
        self.book(&mut field, acting, force);
        std::mem::swap(&mut self.velocity, &mut self.next);
        if implicit.is_some() {
            self.take_end();
        } else {
            for (u, v) in self.displacement.iter_mut().zip(&self.velocity) {
                *u = plus(*u, scaled(*v, acting.dt));
            }
        }
        let before = self.elastic;
        self.strain();
        let stored = self.elastic - before;
        self.move_points(&mut field);
        let sums = &mut field.bands[0].sums;
        sums.internal_work = stored;
        let taken = implicit.map_or(0.0, |(_, taken)| taken - stored);
        sums.pic_loss = seeded::times(Seed::SimulationTaken, taken);
        sums.min_volume_ratio = sums.min_volume_ratio.min(self.smallest);
        self.show(&mut field);
        self.own = field;
    }

    /// Books what acted on the nodes from outside, but gravity and contact. What is missing to the momentum balance of a clamped node
    /// comes from its clamp. `force` is that of the stresses in the step, N.
    fn book(&self, field: &mut VelocityField, acting: &Acting, force: &[[f64; 2]]) {
        let (forces, dt) = (field.forces(acting.forces), acting.dt);
        let mut contact = vec![[0.0; 2]; self.mass.len()];
        self.add_contact(true, &mut contact);
        let band = &mut field.bands[0];
        for node in 0..self.mass.len() {
            let mean = mean(self.velocity[node], self.next[node]);
            if forces.damping > 0.0 {
                band.distributed.damping.add(self.damped[node], mean);
            }
            if acting.field.is_some() {
                band.distributed.field.add(self.driven[node], mean);
            }
        }
        for c in &self.clamped {
            let (m, old, new) = (self.mass[c.node], self.velocity[c.node], self.next[c.node]);
            let given = plus(scaled(plus(force[c.node], scaled(forces.gravity, m)), dt), contact[c.node]);
            let given = plus(given, plus(self.damped[c.node], self.driven[c.node]));
            let impulse = minus(scaled(minus(new, old), m), given);
            let x = plus(self.start[c.node], self.displacement[c.node]);
            let arm = minus(x, acting.boundaries[c.boundary].foot().into());
            let normal_work = dot(impulse, mean(old, new));
            let tally = Tally { impulse, moment: moment(arm, impulse), normal_work, friction_work: 0.0 };
            band.tallies[c.boundary].add(&tally);
        }
    }

    /// Lets the points go with the nodes.
    fn move_points(&self, field: &mut VelocityField) {
        let Some(law) = &self.law else { return };
        let (mass, mut next) = (field.bodies[0].point_mass, 0);
        for band in &mut field.bands {
            for i in 0..band.points[0].len() {
                let point = &self.points[self.order[next] as usize];
                next += 1;
                let before = band.points[0].position(i);
                let p = self.point_now(law, point);
                let s = &mut band.sums;
                s.kinetic += 0.5 * mass * dot(p.v, p.v);
                s.max_speed = s.max_speed.max(p.v[0].abs()).max(p.v[1].abs());
                s.max_displacement = s.max_displacement.max(norm(minus(p.x, before)));
                s.min_volume_ratio = s.min_volume_ratio.min(p.volume_ratio);
                band.points[0].set(i, &p);
            }
        }
    }

    /// A point as it lies in the mesh now.
    fn point_now(&self, law: &NeoHookean, point: &Embedded) -> Particle {
        let place = &point.place;
        let u = place.nodes.map(|n| self.displacement[n as usize]);
        let b = Finger::of_gradient(&gradient(&u, &place.gradient));
        let mut p = Particle::at_rest(point.id, plus(point.start, interpolated(place, &self.displacement)));
        p.v = interpolated(place, &self.velocity);
        p.state.stress = law.stress(&b);
        b.keep_in(&mut p.state.history);
        p.volume_ratio = b.volume_ratio();
        p
    }
}
