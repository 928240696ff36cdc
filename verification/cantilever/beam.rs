//! The beam on the grid.

use crate::scene::{Brick, Material, THICKNESS, points_by_number, run_until, scene};
use crate::{Fault, RungFailure};
use checkdam::body::Particle;
use checkdam::boundary::{Boundary, Friction};
use checkdam::constitutive::{AnyLaw, NeoHookean};
use checkdam::shape::ShapeFunction;
use checkdam::simulation::{AccelerationField, PicShare, Simulation};
use checkdam::theory::cantilever::Cantilever;
use checkdam::theory::elastic::confined_speed;
use nalgebra::Vector2;
use std::sync::Arc;

/// Depth of every beam, m.
pub const DEPTH: f64 = 0.1;
/// Share of PIC a step while a beam comes to rest: stops what nodes do not see.
const SETTLING_PIC: f64 = 0.02;
/// Cells of the beam inside the clamp.
const EMBEDDED: usize = 2;

/// One beam.
#[derive(Debug, Clone, Copy)]
pub struct Beam {
    /// Shape function.
    pub shape: ShapeFunction,
    /// Length over depth.
    pub slenderness: usize,
    /// Cells through the depth.
    pub cells: usize,
    /// What it is made of.
    pub material: Material,
    /// Points per cell and direction.
    pub per_cell: usize,
    /// Whether it moves by its mesh (total-Lagrangian kinematics, neo-Hookean), and not by the grid.
    pub mesh: bool,
    /// Length of its implicit steps, in cells over the speed of its P-wave; none for explicit ones.
    pub implicit: Option<f64>,
}

impl Beam {
    /// Cell size, m.
    pub fn spacing(&self) -> f64 {
        DEPTH / self.cells as f64
    }

    /// Its closed forms.
    pub fn exact(&self) -> Cantilever {
        Cantilever {
            elastic: self.material.elastic,
            density: self.material.density,
            length: DEPTH * self.slenderness as f64,
            depth: DEPTH,
            width: THICKNESS,
        }
    }

    /// Height of the topmost row of points, which carries the load at the tip, m.
    pub fn tip(&self) -> f64 {
        self.exact().length - 0.5 * self.distance()
    }

    /// Distance of the points, m.
    fn distance(&self) -> f64 {
        self.spacing() / self.per_cell as f64
    }

    /// Time in which a P-wave crosses a cell, s.
    pub fn crossing(&self) -> f64 {
        self.spacing() / confined_speed(&self.material.elastic, self.material.density)
    }

    /// Points at rest, upright, the foot two cells deep in the clamp.
    pub fn points(&self) -> Vec<Particle> {
        self.brick().points()
    }

    fn brick(&self) -> Brick {
        let h = self.spacing();
        let cells = [self.cells, self.cells * self.slenderness + EMBEDDED];
        Brick { per_cell: self.per_cell, ..Brick::new([0.0, -(EMBEDDED as f64) * h], cells, h) }
    }

    /// The simulation from given points, with a time step of `courant` h/c, or its own, and a share of PIC.
    pub fn simulation(&self, points: Vec<Particle>, courant: f64, pic: f64, fault: &Fault) -> Simulation {
        let clamp = Boundary::plane("clamp", Vector2::zeros(), Vector2::new(0.0, 1.0), Friction::Bonded);
        let density = self.material.density * fault.density;
        let Material { elastic, .. } = self.material;
        let law = match self.mesh {
            true => AnyLaw::NeoHookean(NeoHookean::new(elastic.young * fault.modulus, elastic.poisson)),
            false => self.material.law(fault),
        };
        let mut scene = scene(&self.brick(), law, density, points, vec![clamp]);
        if self.mesh {
            scene.bodies[0].0.mesh = Some(self.brick().mesh([&[], &[EMBEDDED as f64 * self.spacing()]]));
        }
        scene.bodies[0].0.implicit = self.implicit.is_some();
        scene.numerics.shape = self.shape;
        scene.numerics.pic = PicShare::Fraction(pic);
        scene.numerics.cfl = 0.9;
        scene.numerics.max_time_step = self.implicit.unwrap_or(courant) * self.crossing();
        Simulation::new(scene)
    }
}

/// A load across the beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Load {
    /// A force (N) on the topmost row of points.
    Tip(f64),
    /// Newtons per metre all along.
    Spread(f64),
}

/// A beam at rest under its load.
#[derive(Debug, Clone, Copy)]
pub struct Rest {
    /// Mean displacement of the topmost row, m.
    pub tip: [f64; 2],
    /// Kinetic over elastic energy.
    pub kinetic: f64,
}

/// Lets a beam come to rest under a dead load, with 0.8 of the damping that is critical for its first mode.
pub fn settle(beam: &Beam, load: Load, fault: &Fault) -> Result<Rest, RungFailure> {
    let start = beam.points();
    let exact = beam.exact();
    let h = beam.spacing();
    let heights: Arc<Vec<f64>> = Arc::new(start.iter().map(|p| p.x[1]).collect());
    let top = beam.tip() - 0.1 * h;
    let row = heights.iter().filter(|&&y| y > top).count() as f64;
    // Loads are forces: they do not follow a wrong density.
    let area = beam.distance() * beam.distance();
    let mass = beam.material.density * fault.density * area * THICKNESS;
    let mut sim = beam.simulation(start.clone(), 0.7, SETTLING_PIC, fault);
    let places = Arc::clone(&heights);
    sim.set_field(Some(AccelerationField(Arc::new(move |p, _| {
        let force = match load {
            Load::Tip(force) if places[p.id as usize] > top => force / row,
            Load::Tip(_) => 0.0,
            Load::Spread(q) => q * area / DEPTH,
        };
        [force / mass, 0.0]
    }))));
    let frequency = exact.frequency();
    // exp(-0.8 * 13) = 3e-5 of the amplitude is left.
    sim.set_damping(2.0 * 0.8 * frequency);
    run_until(&mut sim, 13.0 / frequency)?;
    let mut tip = [0.0; 2];
    for (p, p0) in points_by_number(&sim).iter().zip(&start).filter(|(_, p0)| p0.x[1] > top) {
        tip = [tip[0] + (p.x[0] - p0.x[0]) / row, tip[1] + (p.x[1] - p0.x[1]) / row];
    }
    let stock = sim.stock();
    Ok(Rest { tip, kinetic: stock.kinetic / stock.elastic })
}

/// Lets the beam go with a velocity across, given by the height over the clamp; no damping, no PIC.
pub fn released(beam: &Beam, velocity: impl Fn(f64) -> f64, fault: &Fault) -> Simulation {
    let mut points = beam.points();
    for p in points.iter_mut().filter(|p| p.x[1] > 0.0) {
        p.v[0] = velocity(p.x[1]);
    }
    beam.simulation(points, 0.4, 0.0, fault)
}
