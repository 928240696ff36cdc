//! A barrier that is a body: what its contacts and its clamp do to it, how it bends, whether it holds together.
//!
//! Two of the three ways to know the force on it are here, besides the stress layers of `survey`. What the contacts give less
//! what the clamp takes is the rate of the barrier's momentum, node by node and step by step, so that both must agree to
//! round-off; the largest disagreement is a result.

mod shape;
mod survey;

pub use shape::{Bend, ProfilePoint};
pub use survey::Survey;

use super::barrier::contact_impulse;
use super::flow::may_flow;
use super::passage::Passage;
use super::reaction::ReactionGauge;
use crate::boundary::Boundary;
use crate::contact::Vector;
use crate::contact::outline::{Outline, Surface};
use crate::seeded::{self, Seed};
use crate::simulation::Simulation;
use nalgebra::Vector2;

/// Forces on a barrier in the directions of its face at the start: against it (positive when pushed by the material) and along
/// it, towards the crest.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Components {
    /// N.
    pub normal: f64,
    /// N.
    pub tangential: f64,
}

impl Components {
    fn magnitude(&self) -> f64 {
        self.normal.hypot(self.tangential)
    }
}

/// One sample; forces are means over the interval.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StructureSample {
    /// What the material gives to the barrier.
    pub contact: Components,
    /// What the barrier gives to its clamp.
    pub clamp: Components,
    /// Its moment about the foot, positive when it turns the barrier over, N m.
    pub clamp_moment: f64,
    /// Rate of the barrier's momentum.
    pub inertia: Components,
    /// Magnitude of contact and weight less clamp and inertia, over the sum of their magnitudes: round-off. Of order one, and
    /// without meaning, where all of them are round-off of the momentum; see [`Self::magnitude`].
    pub imbalance: f64,
    /// How it bends.
    pub bend: Bend,
    /// The material beside it.
    pub survey: Survey,
}

impl StructureSample {
    /// Sum of the magnitudes of contact, clamp and inertia, N.
    pub fn magnitude(&self) -> f64 {
        self.contact.magnitude() + self.clamp.magnitude() + self.inertia.magnitude()
    }
}

/// Reads a body that is a barrier: a rectangle of points, numbered along its height first, then across its thickness.
#[derive(Debug, Clone)]
pub struct StructureGauge {
    body: usize,
    face: Boundary,
    /// Points across the thickness and along the height.
    counts: [usize; 2],
    /// Where they were at the start, by number, m.
    start: Vec<Vector>,
    points: Vec<Option<shape::Place>>,
    outline: Outline,
    surfaces: Vec<Surface>,
    contact: ReactionGauge,
    clamp: ReactionGauge,
    other: [f64; 2],
    momentum: [f64; 2],
    /// Barriers, by index of the body: none of them runs up at it or passes it.
    structures: Vec<usize>,
    /// Mass behind it when the gauge was opened, kg.
    behind: f64,
    /// Mass that has left the domain behind it since, kg.
    departed: f64,
    /// -1 where overturning is clockwise.
    turn: f64,
}

impl StructureGauge {
    /// A gauge on the body with this index, whose face stands at `face` now. `counts` are its points across the thickness and along
    /// the height, and `angle` (rad) is that of its rows against x.
    pub fn new(simulation: &Simulation, body: usize, face: Boundary, counts: [usize; 2], angle: f64) -> Self {
        let numbered: Vec<(u32, Vector)> = simulation.points_of(body).map(|p| (p.id, p.x)).collect();
        let mut start = vec![[0.0; 2]; counts[0] * counts[1]];
        numbered.iter().for_each(|&(id, x)| start[id as usize] = x);
        let spacing = simulation.bodies()[body].point_spacing;
        let outline = Outline::trace(&numbered, spacing, angle);
        let turn = -(face.tangent.x * face.normal.y - face.tangent.y * face.normal.x).signum();
        let mut gauge = Self {
            body,
            face,
            counts,
            points: vec![None; start.len()],
            start,
            surfaces: vec![Surface::new(0.5 * spacing); outline.rings.len()],
            outline,
            contact: ReactionGauge::new(),
            clamp: ReactionGauge::new(),
            other: [0.0; 2],
            momentum: [0.0; 2],
            structures: Vec::new(),
            behind: 0.0,
            departed: 0.0,
            turn,
        };
        gauge.open(simulation);
        gauge
    }

    /// Index of the body.
    pub fn body(&self) -> usize {
        self.body
    }

    /// Leaves out bodies, by index, that are barriers themselves: they neither run up at it nor lie behind it. The next interval begins now.
    pub fn leave_out(&mut self, simulation: &Simulation, structures: &[usize]) {
        self.structures = structures.to_vec();
        self.open(simulation);
    }

    /// Mass behind it now, in the domain, kg.
    pub fn behind(&self, simulation: &Simulation) -> f64 {
        self.survey(simulation).behind - self.departed
    }

    /// Where its face stood at the start.
    pub fn face(&self) -> &Boundary {
        &self.face
    }

    /// Forgets what it has seen: the next interval begins now.
    pub fn open(&mut self, simulation: &Simulation) {
        (self.contact, self.clamp, self.other) = (ReactionGauge::new(), ReactionGauge::new(), [0.0; 2]);
        self.follow(simulation);
        self.momentum = self.momentum_now(simulation);
        self.departed = 0.0;
        self.behind = self.survey(simulation).behind;
    }

    /// What has passed it by a survey, all of it taken to have gone over the crest.
    pub fn passage(&self, survey: &Survey) -> Passage {
        let past = (survey.behind - self.behind).max(0.0);
        Passage { over: past, under: 0.0, past }
    }

    /// Reads the last step.
    pub fn after_step(&mut self, simulation: &Simulation) {
        let (dt, time) = (simulation.time_step().dt, simulation.time());
        let foot = self.face.foot();
        let (impulse, _) = contact_impulse(simulation, self.body);
        self.contact.add(impulse, 0.0, dt, time);
        let (mut impulse, mut moment) = ([0.0; 2], 0.0);
        for (boundary, tally) in simulation.boundaries().iter().zip(simulation.step_tallies_of(self.body)) {
            let arm = (boundary.foot() - foot) * if seeded::is(Seed::GaugeClampArm) { 0.0 } else { 1.0 };
            let p = tally.impulse.map(|p| -p);
            impulse = [impulse[0] + p[0], impulse[1] + p[1]];
            moment += -tally.moment + arm.x * p[1] - arm.y * p[0];
        }
        self.clamp.add(impulse, moment, dt, time);
        for (body, x) in simulation.departures() {
            // What leaves the domain elsewhere has not passed the barrier.
            let behind = self.face.face_coordinates(x).0 < 0.0 || seeded::is(Seed::GaugeDeparted);
            if behind && self.may_pass(simulation, body) {
                self.departed += simulation.bodies()[body].point_mass;
            }
        }
        let other = simulation.distributed_impulse_of(self.body);
        self.other = [self.other[0] + other[0], self.other[1] + other[1]];
    }

    /// Whether a body, by its index, flows and may pass it.
    fn may_pass(&self, simulation: &Simulation, body: usize) -> bool {
        body != self.body && may_flow(simulation, body) && !self.structures.contains(&body)
    }

    /// Means since the last call, and the state now.
    pub fn sample(&mut self, simulation: &Simulation) -> StructureSample {
        self.follow(simulation);
        let (contact, clamp) = (self.contact.sample(), self.clamp.sample());
        let now = self.momentum_now(simulation);
        let per = if contact.duration > 0.0 { 1.0 / contact.duration } else { 0.0 };
        let rate = [0, 1].map(|d| seeded::times(Seed::GaugeInertia, now[d] - self.momentum[d]) * per);
        let other = self.other.map(|p| p * per);
        let left = [0, 1].map(|d| contact.force[d] + other[d] - clamp.force[d] - rate[d]);
        let size = |p: [f64; 2]| Vector2::from(p).norm();
        let scale = size(contact.force) + size(other) + size(clamp.force) + size(rate);
        self.momentum = now;
        self.other = [0.0; 2];
        StructureSample {
            contact: self.components(contact.force),
            clamp: self.components(clamp.force),
            clamp_moment: clamp.moment * self.turn,
            inertia: self.components(rate),
            imbalance: if scale > 0.0 { size(left) / scale } else { 0.0 },
            bend: self.bend(simulation),
            survey: self.survey(simulation),
        }
    }

    /// The surface as of the last sample: its points in order, ring by ring, m.
    pub fn outline(&self) -> Vec<Vector> {
        self.outline.rings.iter().flatten().filter_map(|&id| self.points[id as usize]).map(|p| p.x).collect()
    }

    /// Largest force on the clamp in a single step, N, and when.
    pub fn peak_clamp_force(&self) -> super::Peak {
        self.clamp.peak_force()
    }

    fn components(&self, force: [f64; 2]) -> Components {
        let f = Vector2::from(force);
        Components { normal: -f.dot(&self.face.normal), tangential: f.dot(&self.face.tangent) }
    }

    /// Momentum of the body, N s.
    fn momentum_now(&self, simulation: &Simulation) -> [f64; 2] {
        if let Some(momentum) = simulation.nodal_momentum_of(self.body) {
            return momentum;
        }
        let mass = simulation.bodies()[self.body].point_mass;
        let mut sum = [0.0; 2];
        for place in self.points.iter().flatten() {
            sum = [sum[0] + mass * place.v[0], sum[1] + mass * place.v[1]];
        }
        sum
    }
}

#[cfg(test)]
mod tests;
