//! Reading a simulation, and steering it between steps.

use super::field::VelocityField;
use super::structure::Structure;
use super::sweep::{self, On};
use super::{AccelerationField, ContactPoint, PicShare, Simulation, potential};
use crate::band::{Band, Workspace};
use crate::body::{Block, Body, Particle};
use crate::boundary::Boundary;
use crate::boundary::nodes::{Hold, Tally};
use crate::boundary::surface::Site;
use crate::constitutive::Law;
use crate::contact::rule::{ContactRule, ContactTally};
use crate::lanes::LANES;
use crate::ledger::{EnergyBalance, Ledger, Stock};
use crate::seeded::{self, Seed};
use crate::space::{dot, plus, scaled};
use crate::timestep::TimeStep;

impl Simulation {
    /// Time, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Sets the clock, s.
    pub fn set_time(&mut self, time: f64) {
        self.time = time;
    }

    /// Steps done.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// The last time step; before the first step, the next.
    pub fn time_step(&self) -> TimeStep {
        if self.steps == 0 { self.next_time_step() } else { self.time_step }
    }

    /// Bodies.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies[..self.seen]
    }

    /// Boundaries.
    pub fn boundaries(&self) -> &[Boundary] {
        &self.boundaries
    }

    /// Index of a boundary by name.
    pub fn boundary_index(&self, name: &str) -> Option<usize> {
        self.boundaries.iter().position(|b| b.name == name)
    }

    /// Cell size, m.
    pub fn spacing(&self) -> f64 {
        self.lattice.spacing
    }

    /// A corner of cells, from which all others lie whole cells away, m.
    pub fn origin(&self) -> [f64; 2] {
        self.lattice.origin
    }

    /// The points that left the domain in the last step: index of the body, and where they were (m).
    pub fn departures(&self) -> impl Iterator<Item = (usize, [f64; 2])> {
        self.fields.iter().flat_map(|f| &f.departed).map(|d| (d.body, d.particle.x))
    }

    /// Material outside [x_min, x_max], [y_min, y_max] is removed, m.
    pub fn domain(&self) -> [[f64; 2]; 2] {
        self.domain
    }

    /// Extent across the plane, m.
    pub fn thickness(&self) -> f64 {
        self.thickness
    }

    /// Mass now in the domain, kg.
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// Gravity, m/s2.
    pub fn gravity(&self) -> [f64; 2] {
        self.forces.gravity
    }

    /// Changes gravity. Energies are then measured in the new field: open the ledger again.
    pub fn set_gravity(&mut self, gravity: [f64; 2]) {
        self.forces.gravity = gravity;
    }

    /// Mass-proportional damping, 1/s.
    pub fn set_damping(&mut self, rate: f64) {
        self.forces.damping = rate;
    }

    /// Adds a field of accelerations to gravity, as manufactured solutions need, or removes it.
    pub fn set_field(&mut self, field: Option<AccelerationField>) {
        self.field = field;
        self.fields.iter_mut().flat_map(|f| &mut f.bands).for_each(|band| band.field_force.clear());
    }

    /// Moves a boundary at a velocity, m/s. Nodes it reaches are found at the next sort, so keep it slow against h per sort.
    pub fn set_boundary_velocity(&mut self, index: usize, velocity: [f64; 2]) {
        self.boundaries[index].velocity = velocity.into();
        self.find_holds();
    }

    /// Changes the share of PIC.
    pub fn set_pic(&mut self, pic: PicShare) {
        self.numerics.pic = pic;
    }

    /// Changes the friction coefficient of a contact of two bodies.
    pub fn set_contact_friction(&mut self, contact: usize, friction: f64) {
        self.coupling.set_friction(contact, friction);
    }

    /// Releases all gates.
    pub fn release_gates(&mut self) {
        self.boundaries.iter_mut().for_each(Boundary::release);
        self.find_holds();
    }

    /// All points as (body index, point), in a fixed order that changes with sorting.
    pub fn particles(&self) -> impl Iterator<Item = (usize, Particle)> {
        self.fields.iter().flat_map(VelocityField::particles).filter(|(body, _)| *body < self.seen)
    }

    /// The same points block by block, for those who read two of their numbers and not all: body index, block, number of real
    /// points.
    pub fn blocks(&self) -> impl Iterator<Item = (usize, &Block, usize)> {
        self.fields.iter().flat_map(VelocityField::blocks).filter(|(body, ..)| *body < self.seen)
    }

    /// The same with the numbers of the points within their body: body index, block, numbers, number of real points.
    pub fn numbered_blocks(&self) -> impl Iterator<Item = (usize, &Block, &[u32; LANES], usize)> {
        self.fields.iter().flat_map(VelocityField::numbered_blocks).filter(|(body, ..)| *body < self.seen)
    }

    /// Largest velocity component of any point, m/s.
    pub fn largest_speed(&self) -> f64 {
        self.speeds.iter().copied().fold(0.0, f64::max)
    }

    /// The points of one body, by its index, in a fixed order that changes with sorting.
    pub fn points_of(&self, body: usize) -> impl Iterator<Item = Particle> {
        let fields = self.fields.iter().filter(move |f| f.members.contains(&body));
        fields.flat_map(VelocityField::particles).filter_map(move |(b, p)| (b == body).then_some(p))
    }

    /// What each boundary did in the last step to the bodies that share a velocity field with `body`, parallel to the
    /// boundaries. A body in contact has a field of its own.
    pub fn step_tallies_of(&self, body: usize) -> impl Iterator<Item = Tally> {
        let field = self.fields.iter().position(|f| f.members.contains(&body));
        (0..self.boundaries.len()).map(move |k| {
            let mut sum = Tally::default();
            field.iter().flat_map(|&f| &self.fields[f].bands).for_each(|band| sum.add(&band.tallies[k]));
            field.iter().filter_map(|&f| self.surface.tallies(f).get(k)).for_each(|tally| sum.add(tally));
            sum
        })
    }

    /// Impulse (N s) in the last step of what acts throughout the bodies that share a velocity field with `body`: gravity,
    /// damping, side walls.
    pub fn distributed_impulse_of(&self, body: usize) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for field in self.fields.iter().filter(|f| f.members.contains(&body)) {
            for band in &field.bands {
                let heavy = band.points.iter().zip(&field.bodies).filter(|(_, b)| !b.weightless);
                let mass: f64 = heavy.map(|(points, b)| points.len() as f64 * b.point_mass).sum();
                let d = &band.distributed;
                for (k, sum) in sum.iter_mut().enumerate() {
                    *sum += mass * self.forces.gravity[k] * self.time_step.dt;
                    *sum += d.damping.impulse[k] + d.side_walls.impulse[k] + d.field.impulse[k];
                }
            }
        }
        sum
    }

    /// Number of material points.
    pub fn particle_count(&self) -> usize {
        self.bands().map(Band::len).sum()
    }

    /// Parts into which so many threads divide a sweep over the points as they lie now; where a step has several sweeps, of the one
    /// with the fewest. What a step computes does not depend on it.
    pub fn parts(&self, threads: usize) -> usize {
        let stages = self.numerics.scheme.stages();
        let apart = |field: usize| self.structures.iter().any(|b| b.field() == field);
        let swept = self.fields.iter().enumerate().filter(|(k, _)| !apart(*k));
        let bands = swept.map(|(_, f)| f.bands.len()).sum();
        if self.in_one_sweep() {
            return sweep::parts(stages, bands, threads);
        }
        let sweeps = stages.split_inclusive(|(on, _)| *on == On::Nodes);
        sweeps.map(|stages| sweep::parts(stages, bands, threads)).min().unwrap_or(1)
    }

    /// Number of active nodes.
    pub fn node_count(&self) -> usize {
        self.fields.iter().map(|f| f.grid.len()).sum()
    }

    /// Bytes held by points, accumulators and nodes.
    pub fn bytes(&self) -> usize {
        let lent: usize = self.pools.iter().flatten().map(Workspace::bytes).sum();
        lent + self.bands().map(Band::bytes).sum::<usize>() + self.fields.iter().map(|f| f.grid.bytes()).sum::<usize>()
    }

    /// What each boundary did in the last step.
    pub fn step_tallies(&self) -> &[Tally] {
        &self.step_tallies
    }

    /// Contacts of bodies.
    pub fn contacts(&self) -> impl Iterator<Item = &ContactRule> {
        self.coupling.rules()
    }

    /// What the two bodies of each contact did to each other in the last step.
    pub fn contact_tallies(&self) -> impl Iterator<Item = &ContactTally> {
        self.coupling.tallies()
    }

    /// Where bodies touched each other in the last step.
    pub fn contact_points(&self) -> &[ContactPoint] {
        self.coupling.points()
    }

    /// The most sweeps over the nodes in contact that a step needed until bodies in implicit steps or with a mesh and contact agreed, and
    /// the most that are allowed; `None` without such bodies.
    pub fn contact_sweeps(&self) -> Option<[usize; 2]> {
        self.structures.iter().map(Structure::passes).max()
    }

    /// What boundaries did to single nodes in the last step, in the order of the nodes.
    pub fn holds(&self) -> impl Iterator<Item = &Hold> {
        self.bands().flat_map(|b| &b.holds)
    }

    /// Where surfaces of boundaries cross lines of the grid, with what they did in the last step.
    pub fn sites(&self) -> &[Site] {
        self.surface.sites()
    }

    fn bands(&self) -> impl Iterator<Item = &Band> {
        self.fields.iter().flat_map(|f| &f.bands)
    }

    /// Starts a new ledger now.
    pub fn open_ledger(&mut self) {
        let slip = std::mem::take(&mut self.ledger.elastic_slip);
        self.ledger = Ledger::new(self.boundaries.len(), self.ledger.contacts.len());
        self.ledger.opening_slip.clone_from(&slip);
        self.ledger.elastic_slip = slip;
        self.opening = self.stock();
    }

    /// The ledger since it was opened.
    pub fn ledger(&self) -> &Ledger {
        &self.ledger
    }

    /// What the material held when the ledger was opened.
    pub fn opening(&self) -> &Stock {
        &self.opening
    }

    /// What the material holds now.
    pub fn stock(&self) -> Stock {
        self.stock_of(|_| true)
    }

    /// What some bodies, chosen by index, hold now.
    pub fn stock_of(&self, chosen: impl Fn(usize) -> bool) -> Stock {
        let mut s = Stock::default();
        let by_points = |body: &usize| self.bodies[*body].mesh.is_none() && chosen(*body);
        self.particles().filter(|(body, _)| by_points(body)).for_each(|(body, p)| {
            let body = &self.bodies[body];
            let m = body.point_mass;
            let heavy = if body.weightless { 0.0 } else { m };
            s.mass += m;
            s.heavy += heavy;
            s.momentum = plus(s.momentum, scaled(p.v, m));
            s.kinetic += 0.5 * m * dot(p.v, p.v);
            s.gravitational += heavy * potential(self.forces.gravity, p.x);
            s.elastic += body.point_volume * p.volume_ratio * body.law.stored_energy(&p.state);
        });
        s.kinetic = seeded::times(Seed::LedgerKinetic, s.kinetic);
        s.gravitational = seeded::times(Seed::LedgerPotential, s.gravitational);
        s.elastic = seeded::times(Seed::LedgerElastic, s.elastic);
        for (_, own) in self.stocks_by_nodes().filter(|(body, _)| chosen(*body)) {
            s.add(&own);
        }
        s
    }

    /// What each body with a mesh holds now, by the nodes of that.
    fn stocks_by_nodes(&self) -> impl Iterator<Item = (usize, Stock)> {
        let own = self.structures.iter().filter_map(|b| Some((self.fields[b.field()].members[0], b.lagrangian()?)));
        own.map(|(body, b)| (body, b.stock(self.forces.gravity, !self.bodies[body].weightless, self.time_step.dt)))
    }

    /// Momentum of a body that moves by the nodes of its mesh, N s: theirs, which the momenta of its points come near to.
    pub fn nodal_momentum_of(&self, body: usize) -> Option<[f64; 2]> {
        self.stocks_by_nodes().find(|(b, _)| *b == body).map(|(_, stock)| stock.momentum)
    }

    /// Energy by mechanism since the ledger was opened, with gravitational energy counted from the level of `datum` (m).
    pub fn energy_balance(&self, now: &Stock, datum: [f64; 2]) -> EnergyBalance {
        let level = potential(self.forces.gravity, datum);
        let heavy = [self.opening.heavy, now.heavy, self.ledger.entered_heavy];
        EnergyBalance::new(&self.ledger, &self.opening, now, heavy.map(|heavy| heavy * level))
    }
}
