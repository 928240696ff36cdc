//! A column of grains behind a gate on a bed, level or inclined, that is released: how far it runs and what it leaves.
//!
//! x runs along the bed from the back wall, y perpendicular to it. Lengths are those of the source; the run-out counts from the
//! gate. The column is as high everywhere, perpendicular to the bed, before it is released.

use crate::scene::{Brick, Material, THICKNESS, scene};
use crate::{Fault, RungFailure};
use checkdam::boundary::{Boundary, Friction, Opening};
use checkdam::constitutive::{AnyLaw, Cone, DruckerPrager};
use checkdam::gauge::FRONT_SHARE;
use checkdam::run::records::MomentumRow;
use checkdam::simulation::{PicShare, Simulation};
use checkdam::theory::elastic::confined_speed;
use nalgebra::Vector2;

/// Acceleration of gravity, m/s2.
pub const GRAVITY: f64 = 9.81;

/// A column and its surroundings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Column {
    /// Length along the bed r0, m.
    pub length: f64,
    /// Height perpendicular to the bed h0, m.
    pub height: f64,
    /// Inclination of the bed, rad.
    pub slope: f64,
    /// Cells over the length.
    pub cells: usize,
    /// Material points per cell and direction.
    pub per_cell: usize,
    /// Elasticity and density.
    pub material: Material,
    /// Friction angle of the grains in plane strain, rad; they slide in simple shear at its sine.
    pub friction_angle: f64,
    /// What the bed resists with.
    pub bed: Friction,
    /// How the gate opens.
    pub opening: Opening,
    /// Friction coefficient of the channel's side walls, [`THICKNESS`] apart.
    pub side_walls: f64,
    /// Share of PIC.
    pub pic: PicShare,
    /// Time step as a share of the largest stable one.
    pub cfl: f64,
}

/// Friction angle in plane strain (rad) of grains that slide in simple shear, and so come to rest on a long slope, at `angle`
/// (rad): sin(phi) = tan(angle), at constant volume (Davis 1968).
pub fn plane_strain_angle_of_slope(angle: f64) -> f64 {
    libm::asin(libm::tan(angle))
}

impl Column {
    /// Cell size, m.
    pub fn spacing(&self) -> f64 {
        self.length / self.cells as f64
    }

    /// The column at rest behind its gate, just released, with open ledgers. Boundaries: wall, base, gate.
    ///
    /// # Errors
    /// Where the solver gives up.
    pub fn released(&self, fault: &Fault) -> Result<Simulation, RungFailure> {
        let h = self.spacing();
        let high = (self.height / self.length * self.cells as f64).round() as usize;
        let mut brick = Brick::new([0.0, 0.0], [self.cells, high], h);
        brick.per_cell = self.per_cell;
        let elastic = self.material.linear_elastic(fault);
        let mut law = DruckerPrager::new(elastic, Cone::PlaneStrain, self.friction_angle, 0.0, 0.0, 0.0, true);
        law.friction *= fault.friction;
        let (at, up) = (Vector2::new, Vector2::new(0.0, 1.0));
        let gate = Boundary::wall("gate", at(self.length, 0.0), up, 2.0 * self.height, 4.0 * h, Friction::Smooth);
        let bed = match self.bed {
            Friction::Coulomb(mu) => Friction::Coulomb(mu * fault.friction),
            other => other,
        };
        let boundaries = vec![
            Boundary::plane("wall", at(0.0, 0.0), at(1.0, 0.0), Friction::Smooth),
            Boundary::plane("base", at(0.0, 0.0), up, bed),
            gate.gate(self.opening),
        ];
        let density = self.material.density * fault.density;
        let mut scene = scene(&brick, AnyLaw::DruckerPrager(law), density, brick.points(), boundaries);
        let g = GRAVITY * fault.gravity;
        scene.gravity = [g * libm::sin(self.slope), -g * libm::cos(self.slope)];
        scene.side_wall_friction = self.side_walls;
        scene.numerics.pic = self.pic;
        scene.numerics.cfl = self.cfl;
        let mut sim = Simulation::new(scene);
        let crossing = self.height / confined_speed(&self.material.elastic, self.material.density);
        sim.set_damping(3.0 / crossing);
        while sim.time() < 15.0 * crossing {
            sim.step()?;
        }
        sim.set_damping(0.0);
        sim.set_time(0.0);
        sim.release_gates();
        sim.open_ledger();
        Ok(sim)
    }

    /// Shear over normal impulse on the bed, and mean acceleration along it (m/s2), from one time (s) to another.
    ///
    /// # Errors
    /// Where the solver gives up.
    pub fn on_the_bed(&self, from: f64, to: f64, fault: &Fault) -> Result<[f64; 2], RungFailure> {
        let mut sim = self.released(fault)?;
        while sim.time() < from {
            sim.step()?;
        }
        let (start, before) = (sim.time(), sim.stock().momentum[0]);
        let mut impulse = [0.0; 2];
        while sim.time() < to {
            sim.step()?;
            let step = sim.step_tallies()[1].impulse;
            impulse = [impulse[0] + step[0], impulse[1] + step[1]];
        }
        let gained = sim.stock().momentum[0] - before;
        Ok([-impulse[0] / impulse[1], gained / sim.mass() / (sim.time() - start)])
    }

    /// Runs until the kinetic energy is less than 1e-6 of m g h0 and past its largest value, at most for `longest` (s).
    ///
    /// # Errors
    /// Where the solver gives up.
    pub fn collapse(&self, longest: f64, fault: &Fault) -> Result<Deposit, RungFailure> {
        let mut sim = self.released(fault)?;
        let g = GRAVITY * fault.gravity;
        // What it should weigh, not what a fault makes of it.
        let mass = self.material.density * self.length * self.height * THICKNESS;
        let weight = mass * GRAVITY * libm::cos(self.slope);
        let scale = sim.mass() * g * self.height;
        let opening = sim.opening().gravitational;
        let every = 0.02 * (self.height / g).sqrt();
        let (mut history, mut residual, mut largest) = (Vec::new(), 0.0f64, 0.0f64);
        let (mut push, mut since) = (0.0, 0.0);
        let mut base = 0.0;
        loop {
            let next = sim.time() + every;
            while sim.time() < next {
                sim.step()?;
                push += sim.step_tallies()[1].impulse[1] * fault.contact_force;
            }
            let now = sim.stock();
            history.push((sim.time(), fronts(&sim, self.spacing()).map(|x| x - self.length)));
            let balance = sim.energy_balance(&now, [0.0; 2]);
            residual = residual.max(balance.residual.abs());
            largest = largest.max(now.kinetic);
            // The force on the base over stretches of sqrt(h0/g), the last full one of which counts.
            if sim.time() - since > (self.height / g).sqrt() {
                base = push / (sim.time() - since) / weight;
                (push, since) = (0.0, sim.time());
            }
            if (now.kinetic < 1e-6 * scale && largest > 1e-3 * scale) || sim.time() > longest {
                let run_out = history[history.len() - 1].1;
                let arrived = history.iter().find(|s| s.1[0] > 0.99 * run_out[0]).map_or(f64::NAN, |s| s.0);
                return Ok(Deposit {
                    run_out,
                    height: depth_between(&sim, 0.0, 2.0 * self.spacing()),
                    arrived,
                    at_rest: sim.time(),
                    kinetic: now.kinetic / scale,
                    residual: residual / (scale + (opening - now.gravitational)),
                    closure: MomentumRow::new(sim.time(), sim.ledger(), sim.opening(), &now).closure(),
                    base,
                    profile: profile(&sim, 2.0 * self.spacing()),
                    history,
                });
            }
        }
    }
}

/// What is left of a column.
#[derive(Debug, Clone, PartialEq)]
pub struct Deposit {
    /// Run-out from the gate, m, of the front by mass, of the tip and by depth (see [`fronts`]).
    pub run_out: [f64; 3],
    /// Depth at the back wall, m.
    pub height: f64,
    /// When the front by mass had made 99 % of its way, s.
    pub arrived: f64,
    /// When the run ended, s.
    pub at_rest: f64,
    /// Kinetic energy at the end over m g h0.
    pub kinetic: f64,
    /// Largest energy not accounted for over m g h0 and what gravity has given.
    pub residual: f64,
    /// Momentum not accounted for over the sum of all impulses.
    pub closure: f64,
    /// Normal force on the bed at the end over weight.
    pub base: f64,
    /// Place along the bed and depth, m.
    pub profile: Vec<[f64; 2]>,
    /// Time, s, and run-outs, m.
    pub history: Vec<(f64, [f64; 3])>,
}

/// Volume between two places along x, as a depth, m.
pub fn depth_between(sim: &Simulation, from: f64, to: f64) -> f64 {
    let volume = sim.bodies()[0].point_volume;
    let inside = sim.particles().filter(|(_, p)| (from..to).contains(&p.x[0]));
    inside.map(|(_, p)| volume * p.volume_ratio.min(1.5)).sum::<f64>() / ((to - from) * THICKNESS)
}

/// The front by three definitions, m from the back wall: the place that 1 % of the mass has passed; the tip of the wedge of
/// which the places passed by 1 and by 4 % of the mass are part (the mass ahead grows with the square of the distance from a
/// tip); and the end of the last cell that is filled by a layer of points at least, with all before it.
pub fn fronts(sim: &Simulation, h: f64) -> [f64; 3] {
    let mut x: Vec<f64> = sim.particles().map(|(_, p)| p.x[0]).collect();
    x.sort_by(f64::total_cmp);
    let passed = |share: f64| x[x.len() - (share * x.len() as f64).ceil() as usize];
    let (one, four) = (passed(FRONT_SHARE), passed(4.0 * FRONT_SHARE));
    let volume = sim.bodies()[0].point_volume;
    let mut filled = vec![0.0; (x[x.len() - 1] / h).max(0.0) as usize + 2];
    for (_, p) in sim.particles() {
        filled[(p.x[0] / h).max(0.0) as usize] += volume * p.volume_ratio.min(1.5);
    }
    let cells = filled.iter().take_while(|&&v| v >= 0.5 * h * h * THICKNESS).count();
    [one, 2.0 * one - four, cells as f64 * h]
}

/// Depths of strips of length `strip` (m) along the bed, at their middles.
fn profile(sim: &Simulation, strip: f64) -> Vec<[f64; 2]> {
    let far = sim.particles().map(|(_, p)| p.x[0]).fold(0.0, f64::max);
    let strips = (far / strip).ceil() as usize;
    (0..strips)
        .map(|k| [(k as f64 + 0.5) * strip, depth_between(sim, k as f64 * strip, (k + 1) as f64 * strip)])
        .collect()
}
