//! The simulation: bodies, grid and clock. [`Simulation::step`] is the algorithm.

use crate::body::{Body, Particle, Points};
use crate::boundary::Boundary;
use crate::boundary::nodes::Tally;
use crate::constitutive::Law;
use crate::grid::{ActiveGrid, Lattice};
use crate::layout::{Band, BandSums, Departed, SortRules, Sorter};
use crate::ledger::{Ledger, Stock};
use crate::momentum::{BodyForces, NodeSolver};
use crate::timestep::{TimeStep, TimeStepLimit, stable_time_step};
use crate::transfer::{self, NodeMap, PointConstants, Reach, Scatter, StressUpdate, VelocityUpdate};
use failure::CRUSHED;
use rayon::prelude::*;

mod access;
mod failure;
mod scene;

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
        let field = self.field.as_ref().filter(|_| what != Scatter::Inertia);
        let time = self.time;
        self.bands.par_iter_mut().with_max_len(1).for_each(|band| {
            if what != Scatter::Force {
                band.inertia.fill([0.0; 4]);
            }
            if what != Scatter::Inertia {
                band.force.fill([0.0; 2]);
            }
            for (body, points) in bodies.iter().zip(&band.points) {
                let l = shape.half_width(body.points_per_direction);
                let reach = Reach { first_node: band.first_node, inertia: &mut band.inertia, force: &mut band.force };
                transfer::scatter(what, l, &map, constants(body, side), points, reach);
            }
            if let Some(AccelerationField(field)) = field {
                band.field_force.clear();
                band.field_force.resize(band.force.len(), [0.0; 2]);
                for (body, points) in bodies.iter().zip(&band.points) {
                    let l = shape.half_width(body.points_per_direction);
                    let at = |p: &Particle| field(p, time);
                    let reach = Reach { first_node: band.first_node, inertia: &mut [], force: &mut band.field_force };
                    transfer::scatter_field(l, &map, body.point_mass, &at, points, reach);
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
                let reach = Reach { first_node: band.first_node, inertia: &mut [], force: &mut band.force };
                let part = transfer::gather_velocity(l, &map, constants, update, motion, points, reach);
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
}

/// Gravitational energy per mass at `x`, zero at the origin, J/kg.
fn potential(gravity: &[f64; 2], x: &[f64; 2]) -> f64 {
    -(gravity[0] * x[0] + gravity[1] * x[1])
}

fn constants(body: &Body, side_friction: f64) -> PointConstants {
    PointConstants { mass: body.point_mass, volume: body.point_volume, side_friction }
}
