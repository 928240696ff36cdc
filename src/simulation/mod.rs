//! The simulation: bodies, grid and clock. [`Simulation::step`] is the algorithm.

use crate::band::Band;
use crate::body::{Body, Points};
use crate::boundary::Boundary;
use crate::boundary::nodes::{self, Hold, Tally};
use crate::constitutive::Law;
use crate::grid::{ActiveGrid, Lattice};
use crate::layout::{Departed, SortRules, Sorter};
use crate::ledger::{Ledger, Stock};
use crate::momentum::{self, BodyForces};
use crate::timestep::{TimeStep, TimeStepLimit, stable_time_step};
use failure::CRUSHED;

mod access;
mod failure;
mod scene;
mod stages;
mod sweep;

pub use failure::StepFailure;
pub use scene::{Acceleration, AccelerationField, Numerics, PicShare, Scene, Scheme};

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
    holds: Vec<Hold>,
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
            holds: Vec::new(),
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

    /// One time step: the stages of [`Scheme`], then the books.
    pub fn step(&mut self) -> Result<(), StepFailure> {
        if self.drift > self.lattice.spacing {
            self.sort();
        }
        self.time_step = self.next_time_step();
        let dt = self.time_step.dt;
        let stages = self.numerics.scheme.stages();
        let (step, bands) = self.begin(dt);
        sweep::sweep(stages, bands, &|&stage, before, band| step.run(stage, before, band));
        self.time += dt;
        self.steps += 1;
        for boundary in &mut self.boundaries {
            boundary.advance(dt);
        }
        self.book_impulses(dt);
        self.close_step(dt)
    }

    fn next_time_step(&self) -> TimeStep {
        let n = &self.numerics;
        stable_time_step(&self.bodies, &self.speeds, self.lattice.spacing, n.cfl, n.max_time_step)
    }

    /// Books what acted from outside.
    fn book_impulses(&mut self, dt: f64) {
        let ledger = &mut self.ledger;
        self.step_tallies.fill(Tally::default());
        for band in &self.bands {
            for (sum, tally) in self.step_tallies.iter_mut().zip(&band.tallies) {
                sum.add(tally);
            }
            ledger.damping.merge(&band.distributed.damping);
            ledger.side_walls.merge(&band.distributed.side_walls);
            ledger.field.merge(&band.distributed.field);
        }
        for d in 0..2 {
            let impulse = self.mass * self.forces.gravity[d] * dt;
            ledger.gravity[d] += impulse;
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
        self.find_holds();
        self.drift = 0.0;
    }

    /// Finds what holds each node.
    fn find_holds(&mut self) {
        nodes::find_holds(&self.boundaries, &self.grid, &mut self.holds);
        momentum::distribute_holds(&self.holds, self.boundaries.len(), &mut self.bands);
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
}

/// Gravitational energy per mass at `x`, zero at the origin, J/kg.
fn potential(gravity: &[f64; 2], x: &[f64; 2]) -> f64 {
    -(gravity[0] * x[0] + gravity[1] * x[1])
}
