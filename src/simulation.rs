//! The simulation: bodies, grid and clock. [`Simulation::step`] is the algorithm.

use crate::body::{Body, Particle, Points};
use crate::boundary::Boundary;
use crate::boundary::nodes::{Hold, Tally};
use crate::constitutive::Law;
use crate::grid::{ActiveGrid, Lattice};
use crate::layout::{Band, BandSums, Departed, SortRules, Sorter};
use crate::ledger::{EnergyBalance, Ledger, Stock};
use crate::momentum::{BodyForces, NodeSolver};
use crate::shape::ShapeFunction;
use crate::timestep::{TimeStep, TimeStepLimit, stable_time_step};
use crate::transfer::{self, NodeMap, PointConstants, Scatter, StressUpdate, VelocityUpdate};
use rayon::prelude::*;

/// When the stress is updated within a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scheme {
    /// Update stress first, from the velocities of the step's start (Bardenhagen 2002).
    Usf,
    /// Update stress last, from the new nodal velocities.
    Usl,
    /// Modified update stress last, from the new point velocities mapped back to the grid (Sulsky, Zhou and Schreyer 1995).
    Musl,
}

/// Share of PIC in the velocity update, v = a v_PIC + (1 - a) v_FLIP.
///
/// A fraction per step damps in proportion to the number of steps, a rate in proportion to time: a = rate dt. They are
/// interchangeable at a given time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PicShare {
    /// a itself, per step.
    Fraction(f64),
    /// a/dt, in 1/s.
    Rate(f64),
}

impl PicShare {
    /// The fraction for a step of `dt` seconds, at most 1.
    pub fn fraction(self, dt: f64) -> f64 {
        match self {
            PicShare::Fraction(a) => a,
            PicShare::Rate(rate) => (rate * dt).min(1.0),
        }
    }
}

/// Choices of the method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Numerics {
    /// Order of the stress update.
    pub scheme: Scheme,
    /// Shape function.
    pub shape: ShapeFunction,
    /// Time step as a share of h / (c + |v|).
    pub cfl: f64,
    /// Largest time step, s.
    pub max_time_step: f64,
    /// Share of PIC.
    pub pic: PicShare,
}

/// A field of accelerations (m/s2), given a point and the time (s).
#[derive(Clone)]
pub struct AccelerationField(pub std::sync::Arc<dyn Fn(&Particle, f64) -> [f64; 2] + Send + Sync>);

impl std::fmt::Debug for AccelerationField {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("AccelerationField")
    }
}

/// Everything that a simulation starts from.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The grid.
    pub lattice: Lattice,
    /// Extent of the material across the plane, m.
    pub thickness: f64,
    /// Material outside [x_min, x_max], [y_min, y_max] is removed and counted, m.
    pub domain: [[f64; 2]; 2],
    /// Bodies with their points.
    pub bodies: Vec<(Body, Vec<Particle>)>,
    /// Rigid boundaries.
    pub boundaries: Vec<Boundary>,
    /// Gravity, m/s2.
    pub gravity: [f64; 2],
    /// Friction coefficient of two side walls, at the distance of the thickness; 0 for none.
    pub side_wall_friction: f64,
    /// Method.
    pub numerics: Numerics,
}

/// Why a step failed. The state is that of the failure, for inspection.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "{what} at t = {time:.6e} s (step {step}): particle {id} of body `{body}` at x = {x:.6} m, y = {y:.6} m\n  \
         speed {speed:.4e} m/s, volume ratio {volume_ratio:.4e}, mean stress {mean_stress:.4e} Pa\n  \
         the time step of {dt:.4e} s was limited by {limit}; a smaller `cfl` or a coarser grid may help"
)]
pub struct StepFailure {
    /// What went wrong.
    pub what: &'static str,
    /// Time at the failure, s.
    pub time: f64,
    /// Steps done.
    pub step: u64,
    /// Name of the body.
    pub body: Box<str>,
    /// Number of the point in its body.
    pub id: u32,
    /// Position, m.
    pub x: f64,
    /// Position, m.
    pub y: f64,
    /// Speed, m/s.
    pub speed: f64,
    /// Current over reference volume.
    pub volume_ratio: f64,
    /// Mean stress, Pa.
    pub mean_stress: f64,
    /// Time step, s.
    pub dt: f64,
    /// What limited the time step, in words.
    pub limit: Box<str>,
}

/// Volume ratio below which a point counts as inverted.
const CRUSHED: f64 = 0.05;

/// A running simulation.
#[derive(Debug, Clone)]
pub struct Simulation {
    lattice: Lattice,
    domain: [[f64; 2]; 2],
    thickness: f64,
    numerics: Numerics,
    bodies: Vec<Body>,
    side_friction: f64,
    boundaries: Vec<Boundary>,
    forces: BodyForces,
    field: Option<AccelerationField>,
    mass: f64,

    bands: Vec<Band>,
    grid: ActiveGrid,
    nodes: NodeSolver,
    sorter: Sorter,
    departed: Vec<Departed>,
    /// Farthest that any point can have moved since the last sort, m.
    drift: f64,
    speeds: Vec<f64>,

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
        let mut band = Band::default();
        let mut bodies = Vec::new();
        let mut mass = 0.0;
        for (body, particles) in scene.bodies {
            let mut points = Points::default();
            particles.iter().for_each(|p| points.push(p));
            mass += body.point_mass * points.len() as f64;
            band.points.push(points);
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
            speeds: vec![0.0; bodies.len()],
            step_tallies: vec![Tally::default(); boundaries.len()],
            ledger: Ledger::new(boundaries.len()),
            bodies,
            boundaries,
            bands: vec![band],
            grid: ActiveGrid::default(),
            nodes: NodeSolver::default(),
            sorter: Sorter::default(),
            departed: Vec::new(),
            drift: 0.0,
            time: 0.0,
            steps: 0,
            time_step: TimeStep { dt: 0.0, limit: TimeStepLimit::Maximum, wave_speed: 0.0, particle_speed: 0.0 },
            opening: Stock::default(),
        };
        simulation.measure_speeds();
        simulation.sort();
        simulation.open_ledger();
        simulation
    }

    /// One time step: Ng et al., Appendix A, with contact on the grid as in their Appendix B.
    pub fn step(&mut self) -> Result<(), StepFailure> {
        if self.drift > self.lattice.spacing {
            self.sort();
        }
        self.time_step = self.next_time_step();
        let dt = self.time_step.dt;
        match self.numerics.scheme {
            Scheme::Usf => {
                self.particles_to_grid(Scatter::Inertia);
                self.nodes.old_velocities(&mut self.grid, &self.bands);
                self.update_stress(StressUpdate { dt, move_after: false });
                self.particles_to_grid(Scatter::Force);
                self.solve_momentum(dt);
                self.grid_to_particles(dt);
            }
            Scheme::Usl => {
                self.particles_to_grid(Scatter::All);
                self.solve_momentum(dt);
                self.grid_to_particles(dt);
                self.update_stress(StressUpdate { dt, move_after: true });
            }
            Scheme::Musl => {
                self.particles_to_grid(Scatter::All);
                self.solve_momentum(dt);
                self.grid_to_particles(dt);
                self.nodes.remapped_velocities(&mut self.grid, &self.bands);
                self.update_stress(StressUpdate { dt, move_after: true });
            }
        }
        self.time += dt;
        self.steps += 1;
        for boundary in &mut self.boundaries {
            boundary.advance(dt);
        }
        self.close_step(dt)
    }

    fn next_time_step(&self) -> TimeStep {
        let n = &self.numerics;
        stable_time_step(&self.bodies, &self.speeds, self.lattice.spacing, n.cfl, n.max_time_step)
    }

    /// p2g: nodal mass, momentum and internal force.
    fn particles_to_grid(&mut self, what: Scatter) {
        let map = NodeMap::new(&self.grid);
        let (bodies, shape, side) = (&self.bodies, self.numerics.shape, self.side_friction);
        let (field, time) = (self.field.as_ref(), self.time);
        self.bands.par_iter_mut().with_max_len(1).for_each(|band| {
            if what != Scatter::Force {
                band.inertia.fill([0.0; 4]);
            }
            if what != Scatter::Inertia {
                band.force.fill([0.0; 2]);
            }
            for (body, points) in bodies.iter().zip(&band.points) {
                let l = shape.half_width(body.points_per_direction);
                let constants = constants(body, side);
                transfer::scatter(
                    what,
                    l,
                    &map,
                    constants,
                    points,
                    band.first_node,
                    &mut band.inertia,
                    &mut band.force,
                );
            }
            if let Some(AccelerationField(field)) = field.filter(|_| what != Scatter::Inertia) {
                band.field_force.clear();
                band.field_force.resize(band.force.len(), [0.0; 2]);
                for (body, points) in bodies.iter().zip(&band.points) {
                    let l = shape.half_width(body.points_per_direction);
                    let at = |p: &Particle| field(p, time);
                    let (first, m) = (band.first_node, body.point_mass);
                    transfer::scatter_field(l, &map, m, &at, points, first, &mut band.field_force);
                }
            }
        });
    }

    /// Momentum balance and contact at the nodes; books what acted from outside.
    fn solve_momentum(&mut self, dt: f64) {
        self.step_tallies.fill(Tally::default());
        let distributed =
            self.nodes.solve(&mut self.grid, &self.bands, &self.boundaries, self.forces, dt, &mut self.step_tallies);
        let ledger = &mut self.ledger;
        for d in 0..2 {
            let impulse = self.mass * self.forces.gravity[d] * dt;
            ledger.gravity[d] += impulse;
            ledger.impulse_scale += impulse.abs();
        }
        for (sum, tally) in ledger.boundaries.iter_mut().zip(&self.step_tallies) {
            sum.add(tally);
            ledger.impulse_scale += tally.impulse[0].abs() + tally.impulse[1].abs();
        }
        ledger.damping.merge(&distributed.damping);
        ledger.side_walls.merge(&distributed.side_walls);
        ledger.field.merge(&distributed.field);
    }

    /// g2p: new velocities and displacements; for MUSL also their momentum, back on the grid.
    fn grid_to_particles(&mut self, dt: f64) {
        let update = VelocityUpdate {
            dt,
            pic: self.numerics.pic.fraction(dt),
            remap: self.numerics.scheme == Scheme::Musl,
            move_now: self.numerics.scheme == Scheme::Usf,
        };
        let map = NodeMap::new(&self.grid);
        let (bodies, shape, motion) = (&self.bodies, self.numerics.shape, &self.grid.motion);
        self.bands.par_iter_mut().with_max_len(1).for_each(|band| {
            if update.remap {
                band.force.fill([0.0; 2]);
            }
            let mut sums = BandSums::default();
            for (body, points) in bodies.iter().zip(&mut band.points) {
                let l = shape.half_width(body.points_per_direction);
                let constants = constants(body, 0.0);
                let part = transfer::gather_velocity(
                    l,
                    &map,
                    constants,
                    update,
                    motion,
                    points,
                    band.first_node,
                    &mut band.force,
                );
                sums.kinetic += part.kinetic;
                sums.pic_loss += part.pic_loss;
                sums.max_speed = sums.max_speed.max(part.max_speed);
                sums.max_displacement = sums.max_displacement.max(part.max_displacement);
            }
            sums.internal_work = band.sums.internal_work;
            sums.min_volume_ratio = band.sums.min_volume_ratio;
            band.sums = sums;
        });
    }

    /// Strain increments, stresses, volumes; then the points move.
    fn update_stress(&mut self, update: StressUpdate) {
        let map = NodeMap::new(&self.grid);
        let (bodies, shape, velocity) = (&self.bodies, self.numerics.shape, &self.grid.strain_velocity);
        self.bands.par_iter_mut().with_max_len(1).for_each(|band| {
            let (mut work, mut smallest) = (0.0, f64::INFINITY);
            for (body, points) in bodies.iter().zip(&mut band.points) {
                let l = shape.half_width(body.points_per_direction);
                let part = transfer::update_stress(l, body.law, &map, constants(body, 0.0), update, velocity, points);
                work += part.internal_work;
                smallest = smallest.min(part.min_volume_ratio);
            }
            band.sums.internal_work = work;
            band.sums.min_volume_ratio = smallest;
        });
    }

    /// Adds up the bands' sums in order, books them, and looks for signs of failure.
    fn close_step(&mut self, dt: f64) -> Result<(), StepFailure> {
        let mut kinetic = 0.0;
        let (mut fastest, mut smallest) = (0.0f64, f64::INFINITY);
        for band in &self.bands {
            let s = &band.sums;
            kinetic += s.kinetic;
            self.ledger.internal_work += s.internal_work;
            self.ledger.pic_loss += s.pic_loss;
            fastest = fastest.max(s.max_speed);
            smallest = smallest.min(s.min_volume_ratio);
        }

        self.drift += self.bands.iter().map(|b| b.sums.max_displacement).fold(0.0, f64::max);
        self.speeds.fill(fastest);
        let what = match () {
            () if !kinetic.is_finite() => "a velocity is not a number",
            () if smallest <= CRUSHED => "a material point is crushed or inverted",
            () if fastest * dt > self.lattice.spacing => "a material point moves more than a cell in one step",
            () => return Ok(()),
        };
        Err(self.failure(what))
    }

    fn sort(&mut self) {
        let rules =
            SortRules { lattice: self.lattice, shape: self.numerics.shape, bodies: &self.bodies, domain: self.domain };
        self.sorter.sort(&rules, &mut self.bands, &mut self.grid, &mut self.departed);
        for i in 0..self.departed.len() {
            self.book_departure(self.departed[i]);
        }
        self.departed.clear();
        self.nodes.rebuild(&self.grid, &self.boundaries);
        self.drift = 0.0;
    }

    fn book_departure(&mut self, departed: Departed) {
        let body = &self.bodies[departed.body];
        let p = &departed.particle;
        let m = body.point_mass;
        let elastic = body.point_volume * p.volume_ratio * body.law.stored_energy(&p.state.stress);
        self.mass -= m;
        let ledger = &mut self.ledger;
        ledger.departed_mass += m;
        for (behind, b) in ledger.departed_behind.iter_mut().zip(&self.boundaries) {
            *behind += if b.face_coordinates(p.x).0 < 0.0 { m } else { 0.0 };
        }
        ledger.departed_energy += 0.5 * m * p.speed() * p.speed() + elastic + m * potential(&self.forces.gravity, &p.x);
        // The elastic energy leaves the stock without being dissipated.
        ledger.internal_work -= elastic;
        for d in 0..2 {
            ledger.departed_momentum[d] += m * p.v[d];
        }
    }

    fn measure_speeds(&mut self) {
        for (body, speed) in self.speeds.iter_mut().enumerate() {
            *speed = self
                .bands
                .iter()
                .flat_map(|b| b.points[body].iter())
                .fold(0.0, |a: f64, p| a.max(p.v[0].abs()).max(p.v[1].abs()));
        }
    }

    fn failure(&self, what: &'static str) -> StepFailure {
        let broken = |p: &Particle| {
            let numbers = [p.x[0], p.x[1], p.v[0], p.v[1], p.volume_ratio];
            numbers.iter().any(|x| !x.is_finite())
                || p.volume_ratio <= CRUSHED
                || p.speed() * self.time_step.dt > self.lattice.spacing
        };
        let found = self.particles().find(|(_, p)| broken(p)).or_else(|| self.particles().next());
        let (body, p) = found.map_or((0, Particle::default()), |(b, p)| (b, p));
        StepFailure {
            what,
            time: self.time,
            step: self.steps,
            body: self.bodies.get(body).map_or("", |b| &b.name).into(),
            id: p.id,
            x: p.x[0],
            y: p.x[1],
            speed: p.speed(),
            volume_ratio: p.volume_ratio,
            mean_stress: p.state.stress.mean(),
            dt: self.time_step.dt,
            limit: self.describe_limit(&self.time_step).into(),
        }
    }

    /// What limited a time step, in words.
    pub fn describe_limit(&self, step: &TimeStep) -> String {
        match step.limit {
            TimeStepLimit::Wave(b) => {
                format!(
                    "the P-wave of body `{}` ({:.4} m/s; its points reach {:.3} m/s)",
                    self.bodies[b].name, step.wave_speed, step.particle_speed
                )
            }
            TimeStepLimit::Speed(b) => {
                format!("the particle speed in body `{}` ({:.4} m/s)", self.bodies[b].name, step.particle_speed)
            }
            TimeStepLimit::Maximum => "the largest time step allowed".into(),
        }
    }
}

/// Reading and steering.
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
        &self.bodies
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
        self.bands.iter_mut().for_each(|band| band.field_force.clear());
    }

    /// Moves a boundary at a velocity, m/s. Nodes it reaches are found at the next sort, so keep it slow against h per sort.
    pub fn set_boundary_velocity(&mut self, index: usize, velocity: [f64; 2]) {
        self.boundaries[index].velocity = velocity.into();
        self.nodes.rebuild(&self.grid, &self.boundaries);
    }

    /// Releases all gates.
    pub fn release_gates(&mut self) {
        self.boundaries.iter_mut().for_each(Boundary::release);
        self.nodes.rebuild(&self.grid, &self.boundaries);
    }

    /// All points as (body index, point), in a fixed order that changes with sorting.
    pub fn particles(&self) -> impl Iterator<Item = (usize, Particle)> {
        self.bands.iter().flat_map(|band| {
            band.points.iter().enumerate().flat_map(|(body, points)| points.iter().map(move |p| (body, p)))
        })
    }

    /// Number of material points.
    pub fn particle_count(&self) -> usize {
        self.bands.iter().flat_map(|b| &b.points).map(Points::len).sum()
    }

    /// Number of active nodes.
    pub fn node_count(&self) -> usize {
        self.grid.len()
    }

    /// Bytes held by points, accumulators and nodes.
    pub fn bytes(&self) -> usize {
        let bands = self.bands.iter().map(|b| {
            b.points.iter().map(Points::bytes).sum::<usize>()
                + b.inertia.capacity() * size_of::<[f64; 4]>()
                + b.force.capacity() * size_of::<[f64; 2]>()
        });
        bands.sum::<usize>() + self.grid.bytes()
    }

    /// What each boundary did in the last step.
    pub fn step_tallies(&self) -> &[Tally] {
        &self.step_tallies
    }

    /// Contacts of the last step, in the order of the nodes.
    pub fn holds(&self) -> impl Iterator<Item = &Hold> {
        self.nodes.holds()
    }

    /// Starts a new ledger now.
    pub fn open_ledger(&mut self) {
        self.ledger = Ledger::new(self.boundaries.len());
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
        let mut s = Stock::default();
        for (body, p) in self.particles() {
            let body = &self.bodies[body];
            let m = body.point_mass;
            s.mass += m;
            s.momentum[0] += m * p.v[0];
            s.momentum[1] += m * p.v[1];
            s.kinetic += 0.5 * m * (p.v[0] * p.v[0] + p.v[1] * p.v[1]);
            s.gravitational += m * potential(&self.forces.gravity, &p.x);
            s.elastic += body.point_volume * p.volume_ratio * body.law.stored_energy(&p.state.stress);
        }
        s
    }

    /// Energy by mechanism since the ledger was opened, with gravitational energy counted from the level of `datum` (m).
    pub fn energy_balance(&self, now: &Stock, datum: [f64; 2]) -> EnergyBalance {
        let level = potential(&self.forces.gravity, &datum);
        EnergyBalance::new(&self.ledger, &self.opening, now, [self.opening.mass * level, now.mass * level])
    }
}

/// Gravitational energy per mass at `x`, zero at the origin, J/kg.
fn potential(gravity: &[f64; 2], x: &[f64; 2]) -> f64 {
    -(gravity[0] * x[0] + gravity[1] * x[1])
}

fn constants(body: &Body, side_friction: f64) -> PointConstants {
    PointConstants { mass: body.point_mass, volume: body.point_volume, side_friction }
}
