//! The simulation: bodies, grid and clock. [`Simulation::step`] is the algorithm.
//!
//! Explicit steps are semi-implicit (symplectic) Euler: velocities first, then positions with the new velocities. That
//! is the staggered leapfrog, with velocities half a step off.

use crate::band::Band;
use crate::body::Body;
use crate::boundary::Boundary;
use crate::boundary::nodes::Tally;
use crate::constitutive::Law;
use crate::grid::Lattice;
use crate::layout::{Departed, SortRules};
use crate::ledger::{Ledger, Stock};
use crate::momentum::BodyForces;
use crate::seeded::{self, Seed};
use crate::space::{dot, plus, scaled};
use crate::timestep::{TimeStep, TimeStepLimit, stable_time_step};
use coupling::Coupling;
use failure::{CRUSHED, LOST};
use field::VelocityField;
use implicit::Turn;
use inflow::Entering;
use lagrangian::{Acting, LagrangianBody};
use occupied::Occupied;
use stages::Stage;
use std::sync::OnceLock;
use structure::Structure;
use surface::Surface;
use sweep::{On, Pool};

mod access;
mod coupling;
mod extents;
mod failure;
mod field;
mod implicit;
mod inflow;
mod lagrangian;
mod occupied;
mod scene;
mod slip;
mod stages;
mod structure;
mod surface;
mod sweep;

pub use coupling::ContactPoint;
pub use extents::Extent;
pub use failure::StepFailure;
pub use inflow::{Coming, Inflow, Way};
pub use lagrangian::HELD_WITHIN;
pub use scene::{Acceleration, AccelerationField, Numerics, OpenedVolume, PicShare, Scene, Scheme};

/// Share of the stable time step that is left unused so that a step can keep its length for a while.
const SPARE: f64 = 0.03;

/// A running simulation.
#[derive(Debug, Clone)]
pub struct Simulation {
    lattice: Lattice,
    domain: [[f64; 2]; 2],
    thickness: f64,
    numerics: Numerics,
    bodies: Vec<Body>,
    /// How many of them are seen: those after them are what is led behind the sections of inflows.
    seen: usize,
    inflows: Vec<Entering>,
    /// Whether inflows have been opened.
    entering: bool,
    side_friction: f64,
    boundaries: Vec<Boundary>,
    forces: BodyForces,
    field: Option<AccelerationField>,
    mass: f64,
    /// The part of it that gravity acts on, kg.
    heavy: f64,

    fields: Vec<VelocityField>,
    /// Where the bands of each field are during a sweep.
    bands: Vec<Vec<Band>>,
    /// What they work with where one sweep does all of a step.
    pools: Vec<Pool>,
    coupling: Coupling,
    surface: Surface,
    occupied: Occupied,
    /// Whether a field was sorted anew, or its boundaries have changed, since the open nodes were found.
    stale: bool,
    structures: Vec<Structure>,
    speeds: Vec<f64>,
    /// Where the blocks of points are since the last step, once someone has asked.
    extents: OnceLock<Vec<Extent>>,

    time: f64,
    steps: u64,
    time_step: TimeStep,
    step_tallies: Vec<Tally>,
    ledger: Ledger,
    opening: Stock,
}

impl Simulation {
    /// Takes over a scene.
    pub fn new(scene: Scene) -> Self {
        let (mut fields, mut bodies, mut mass, mut heavy) = (Vec::new(), Vec::new(), 0.0, 0.0);
        let mut common = None;
        for (index, (body, particles)) in scene.bodies.into_iter().enumerate() {
            let own = body.point_mass * particles.len() as f64;
            mass += own;
            heavy += if body.weightless { 0.0 } else { own };
            // Bodies in contact and those with a mesh have a velocity field each, all others share one.
            let alone = body.mesh.is_some() || scene.contacts.iter().any(|c| c.bodies.contains(&index));
            let field = match common {
                Some(field) if !alone => field,
                _ => {
                    fields.push(VelocityField::default());
                    fields.len() - 1
                }
            };
            if !alone {
                common = Some(field);
            }
            fields[field].add(index, body.clone(), &particles);
            bodies.push(body);
        }
        let boundaries = scene.boundaries;
        let mut simulation = Self {
            lattice: scene.lattice,
            domain: scene.domain,
            thickness: scene.thickness,
            numerics: scene.numerics,
            side_friction: 2.0 * scene.side_wall_friction / scene.thickness,
            forces: BodyForces { gravity: scene.gravity, damping: 0.0 },
            field: None,
            mass,
            heavy,
            speeds: vec![0.0; bodies.len()],
            step_tallies: vec![Tally::default(); boundaries.len()],
            ledger: Ledger::new(boundaries.len(), scene.contacts.len()),
            coupling: Coupling::new(&scene.contacts, &fields),
            surface: Surface::default(),
            occupied: Occupied::default(),
            stale: true,
            structures: structure::of(&fields, &boundaries),
            seen: bodies.len(),
            inflows: Vec::new(),
            entering: false,
            bodies,
            boundaries,
            bands: vec![Vec::new(); fields.len()],
            pools: Vec::new(),
            fields,
            extents: OnceLock::new(),
            time: 0.0,
            steps: 0,
            time_step: TimeStep { dt: 0.0, limit: TimeStepLimit::Maximum, wave_speed: 0.0, particle_speed: 0.0 },
            opening: Stock::default(),
        };
        simulation.measure_speeds();
        (0..simulation.fields.len()).for_each(|k| simulation.sort(k));
        simulation.open_ledger();
        simulation
    }

    /// One time step: the stages of [`Scheme`], then the books.
    pub fn step(&mut self) -> Result<(), StepFailure> {
        self.extents.take();
        if self.entering {
            self.admit();
        }
        for k in 0..self.fields.len() {
            self.fields[k].departed.clear();
            if self.fields[k].drift > self.lattice.spacing {
                self.sort(k);
            }
        }
        self.time_step = self.next_time_step();
        let dt = self.time_step.dt;
        let stages = self.numerics.scheme.stages();
        if std::mem::take(&mut self.stale) {
            self.find_open();
        }
        if self.in_one_sweep() {
            self.sweep_all(stages, dt, None);
        } else {
            self.sweep_coupled(stages, dt);
            self.surface.keep(&mut self.fields, &self.boundaries);
        }
        if self.entering {
            self.lead(dt);
        }
        self.time += dt;
        self.steps += 1;
        for boundary in &mut self.boundaries {
            boundary.advance(dt);
        }
        self.book_impulses(dt);
        self.close_step(dt)
    }

    /// Does stages of a step on all fields but those of structures, which take their `turn` meanwhile.
    fn sweep_all(&mut self, stages: &[(On, Stage)], dt: f64, turn: Option<Turn>) {
        let alone = self.in_one_sweep();
        // The bands leave their fields, which all threads read, for as long as they are worked on.
        let (mut bands, mut pools) = (std::mem::take(&mut self.bands), std::mem::take(&mut self.pools));
        self.swap_bands(&mut bands);
        let mut structures = std::mem::take(&mut self.structures);
        structures.iter_mut().for_each(|b| b.swap(&mut self.fields));
        let step = self.begin(dt);
        let lent = alone.then_some(&mut pools);
        let sweep = || {
            sweep::sweep(stages, &mut bands, lent, &|&stage, k, before, band| {
                step.run(stage, &self.fields[k], before, band);
            });
        };
        match turn.filter(|_| !structures.is_empty()) {
            None => sweep(),
            Some(turn) => {
                let acting = Acting {
                    boundaries: &self.boundaries,
                    forces: self.forces,
                    field: self.field.as_ref(),
                    shape: self.numerics.shape,
                    time: self.time,
                    dt,
                };
                sweep::beside(sweep, || structures.iter_mut().for_each(|b| b.take_turn(turn, &acting)));
            }
        }
        structures.iter_mut().for_each(|b| b.swap(&mut self.fields));
        self.structures = structures;
        self.swap_bands(&mut bands);
        (self.bands, self.pools) = (bands, pools);
    }

    fn swap_bands(&mut self, bands: &mut [Vec<Band>]) {
        for (k, (field, bands)) in self.fields.iter_mut().zip(bands).enumerate() {
            if !self.structures.iter().any(|b| b.field() == k) {
                std::mem::swap(&mut field.bands, bands);
            }
        }
    }

    /// Does a step on all fields, which wait for each other where their velocities meet.
    fn sweep_coupled(&mut self, stages: &[(On, Stage)], dt: f64) {
        let mut after = None;
        for part in stages.split_inclusive(|(on, _)| *on == On::Nodes) {
            let last = part.last().map(|(_, stage)| *stage);
            self.sweep_all(part, dt, if last == Some(Stage::Momentum) { Some(Turn::Predict) } else { after.take() });
            let Self { fields, coupling, surface, boundaries, numerics, structures, .. } = self;
            match last {
                Some(Stage::Momentum) => {
                    sweep::alone(|| {
                        if !coupling.is_empty() {
                            coupling.exchange(fields, boundaries, numerics.shape, dt, structures);
                        }
                        surface.solve(fields, boundaries, numerics.shape, dt);
                    });
                    after = Some(Turn::Finish);
                }
                Some(stage @ (Stage::RemappedVelocities | Stage::OldVelocities)) => sweep::alone(|| {
                    coupling.project(fields);
                    surface.project(fields, (stage == Stage::RemappedVelocities).then_some(dt));
                }),
                _ => {}
            }
        }
    }

    /// Whether a step needs no place where the bands wait for each other.
    fn in_one_sweep(&self) -> bool {
        self.coupling.is_empty() && self.surface.is_empty() && self.structures.is_empty()
    }

    /// Finds the nodes that the momentum balance leaves open, in a new layout of the fields.
    fn find_open(&mut self) {
        let Self { fields, coupling, surface, boundaries, lattice, .. } = self;
        fields.iter_mut().flat_map(|f| &mut f.bands).for_each(|band| band.shared.clear());
        coupling.list(fields);
        surface.list(fields, boundaries.len());
        for band in fields.iter_mut().flat_map(|f| &mut f.bands) {
            band.shared.sort_unstable();
            band.open.resize(band.shared.len(), Default::default());
        }
        coupling.find(fields);
        surface.find(fields, boundaries, lattice.spacing);
        if !self.in_one_sweep() {
            let Self { fields, structures, .. } = self;
            fields.iter_mut().flat_map(|f| &mut f.bands).for_each(Band::make_room);
            structures.iter_mut().for_each(|b| b.follow(&fields[b.field()]));
        }
    }

    fn next_time_step(&self) -> TimeStep {
        let n = &self.numerics;
        let mut limit = stable_time_step(&self.bodies, &self.speeds, self.lattice.spacing, n.cfl, n.max_time_step);
        for body in &self.structures {
            let Some(longest) = body.lagrangian().map(|b| b.longest_step()).filter(|l| *l < limit.dt) else { continue };
            let number = self.fields[body.field()].members[0];
            let (wave_speed, particle_speed) = (self.bodies[number].p_wave_speed(), self.speeds[number]);
            limit = TimeStep { dt: longest, limit: TimeStepLimit::Wave(number), wave_speed, particle_speed };
        }
        if !self.structures.iter().any(Structure::is_implicit) || limit.limit == TimeStepLimit::Maximum {
            return limit;
        }
        // A step of another length costs a body in implicit steps a new factorisation.
        let last = self.time_step.dt;
        let keep = last <= limit.dt && last >= (1.0 - 2.0 * SPARE) * limit.dt;
        TimeStep { dt: if keep { last } else { (1.0 - SPARE) * limit.dt }, ..limit }
    }

    /// Books what acted from outside.
    fn book_impulses(&mut self, dt: f64) {
        let ledger = &mut self.ledger;
        self.step_tallies.fill(Tally::default());
        for band in self.fields.iter().flat_map(|f| &f.bands) {
            for (sum, tally) in self.step_tallies.iter_mut().zip(&band.tallies) {
                sum.add(tally);
            }
            ledger.damping.merge(&band.distributed.damping);
            ledger.side_walls.merge(&band.distributed.side_walls);
            ledger.field.merge(&band.distributed.field);
        }
        for field in 0..self.fields.len() {
            for (sum, tally) in self.step_tallies.iter_mut().zip(self.surface.tallies(field)) {
                sum.add(tally);
            }
        }
        for (sum, tally) in ledger.contacts.iter_mut().zip(self.coupling.tallies()) {
            sum.merge(tally);
            ledger.impulse_scale += tally.exchange.impulse[0].abs() + tally.exchange.impulse[1].abs();
        }
        ledger.elastic_slip.fill(0.0);
        self.surface.slip_energy(&mut ledger.elastic_slip);
        for d in 0..2 {
            let impulse = self.heavy * self.forces.gravity[d] * dt;
            ledger.gravity[d] += seeded::times(Seed::LedgerGravity, impulse);
            ledger.impulse_scale += impulse.abs();
        }
        for (sum, tally) in ledger.boundaries.iter_mut().zip(&self.step_tallies) {
            sum.add(tally);
            ledger.impulse_scale += tally.impulse[0].abs() + tally.impulse[1].abs();
        }
    }

    /// Adds up the bands' sums in order, books them, and looks for signs of failure.
    fn close_step(&mut self, dt: f64) -> Result<(), StepFailure> {
        let mut kinetic = 0.0;
        let (mut fastest, mut smallest) = (0.0f64, f64::INFINITY);
        for field in &mut self.fields {
            let (mut speed, mut moved) = (0.0f64, 0.0f64);
            for band in &field.bands {
                let s = &band.sums;
                kinetic += s.kinetic;
                self.ledger.internal_work += s.internal_work;
                self.ledger.pic_loss += s.pic_loss;
                self.ledger.inflow_work -= s.led_work;
                speed = speed.max(s.max_speed);
                moved = moved.max(s.max_displacement);
                smallest = smallest.min(s.min_volume_ratio);
            }
            field.drift += moved; // of a body in implicit steps it is set
            field.members.iter().for_each(|&body| self.speeds[body] = speed);
            fastest = fastest.max(speed);
        }
        let what = match () {
            () if !kinetic.is_finite() => "a velocity is not a number",
            () if smallest <= CRUSHED => "a material point is crushed or inverted",
            () if self.structures.iter().filter_map(Structure::lagrangian).any(LagrangianBody::is_lost) => LOST,
            () if fastest * dt > self.lattice.spacing => "a material point moves more than a cell in one step",
            () => return Ok(()),
        };
        Err(self.failure(what))
    }

    fn sort(&mut self, field: usize) {
        let domain = self.domain_of(field);
        let rules = SortRules { lattice: self.lattice, shape: self.numerics.shape, bodies: &[], domain };
        self.fields[field].sort(&rules, &self.boundaries, self.numerics.boundary_contact);
        if self.numerics.opened_volume == OpenedVolume::Occupied {
            self.occupied.bound(&mut self.fields, field, &self.boundaries, self.thickness);
        }
        self.stale = true;
        if let Some(body) = self.structures.iter_mut().find(|b| b.field() == field) {
            body.rebuild(&self.fields[field], self.numerics.shape);
        }
        for i in 0..self.fields[field].departed.len() {
            self.book_departure(self.fields[field].departed[i]);
        }
    }

    /// What the points of a field may not leave. Those of a body with a mesh go with it wherever it moves.
    fn domain_of(&self, field: usize) -> [[f64; 2]; 2] {
        let mut domain = self.domain;
        if self.fields[field].bodies.iter().any(|b| b.mesh.is_some()) {
            for (_, p) in self.fields[field].particles() {
                for ([low, high], x) in domain.iter_mut().zip(p.x) {
                    (*low, *high) = (low.min(x), high.max(x));
                }
            }
        }
        domain
    }

    /// Finds what holds each node.
    fn find_holds(&mut self) {
        self.occupied.forget_boundaries();
        let contact = self.numerics.boundary_contact;
        self.fields.iter_mut().for_each(|f| f.find_holds(&self.boundaries, contact));
        self.stale = true;
    }

    fn book_departure(&mut self, departed: Departed) {
        let body = &self.bodies[departed.body];
        let p = &departed.particle;
        let m = body.point_mass;
        let elastic = body.point_volume * p.volume_ratio * body.law.stored_energy(&p.state);
        self.mass -= m;
        let heavy = if body.weightless { 0.0 } else { m };
        self.heavy -= heavy;
        let ledger = &mut self.ledger;
        ledger.departed_mass += seeded::times(Seed::LedgerOutflowMass, m);
        let energy = 0.5 * m * p.speed() * p.speed() + elastic + heavy * potential(self.forces.gravity, p.x);
        ledger.departed_energy += seeded::times(Seed::LedgerOutflow, energy);
        // The elastic energy leaves the stock without being dissipated.
        ledger.internal_work -= elastic;
        ledger.departed_momentum = plus(ledger.departed_momentum, scaled(p.v, m));
    }

    fn measure_speeds(&mut self) {
        self.speeds.fill(0.0);
        for (body, p) in self.fields.iter().flat_map(VelocityField::particles) {
            self.speeds[body] = self.speeds[body].max(p.v[0].abs()).max(p.v[1].abs());
        }
    }
}

/// Gravitational energy per mass at `x`, zero at the origin, J/kg.
fn potential(gravity: [f64; 2], x: [f64; 2]) -> f64 {
    -dot(gravity, x)
}
