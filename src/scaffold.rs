//! Small scenes for unit tests, rungs, benchmarks and examples: a brick of material points, what it stands on, and how to step it.
//!
//! Below everything that checks: nothing of the solver uses it.
//!
//! Elsewhere: test fixtures.

use crate::body::{Body, Particle};
use crate::boundary::{Boundary, BoundaryContact};
use crate::constitutive::{AnyLaw, LinearElastic};
use crate::grid::Lattice;
use crate::mesh::Mesh;
use crate::shape::ShapeFunction;
use crate::simulation::{Numerics, OpenedVolume, PicShare, Scene, Scheme, Simulation, StepFailure};

/// A linear elastic law of Young's modulus (Pa) and Poisson's ratio.
pub fn elastic(young: f64, poisson: f64) -> AnyLaw {
    AnyLaw::LinearElastic(LinearElastic::new(young, poisson))
}

/// A case: sand behind a gate, in a flume that is tilted, and a rigid barrier.
#[cfg(test)]
pub(crate) const FLUME: &str = include_str!("scaffold/flume.toml");

/// A case: the same sand against a barrier that bends.
#[cfg(test)]
pub(crate) const BARRIER: &str = include_str!("scaffold/barrier.toml");

/// A case: a plug that enters on a slope on which it neither gains nor loses speed.
#[cfg(test)]
pub(crate) const INFLOW: &str = include_str!("scaffold/inflow.toml");

/// Extent of every scene across the plane, m.
pub const THICKNESS: f64 = 0.1;

/// A lattice of material points: its lower left corner, its size in cells, its inclination.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Brick {
    /// Lower left corner, m.
    pub corner: [f64; 2],
    /// Cells along its base and its side.
    pub cells: [usize; 2],
    /// Cell size, m.
    pub spacing: f64,
    /// Points per cell and direction.
    pub per_cell: usize,
    /// Angle of the base against x, rad.
    pub angle: f64,
}

impl Brick {
    /// A brick of `cells` cells at `corner`, aligned with the grid, with two points per cell and direction.
    pub fn new(corner: [f64; 2], cells: [usize; 2], spacing: f64) -> Self {
        Self { corner, cells, spacing, per_cell: 2, angle: 0.0 }
    }

    /// The points, at rest and free of stress, numbered along the base first.
    pub fn points(&self) -> Vec<Particle> {
        let s = self.spacing / self.per_cell as f64;
        let (nx, ny) = (self.cells[0] * self.per_cell, self.cells[1] * self.per_cell);
        let (c, t) = (libm::cos(self.angle), libm::sin(self.angle));
        (0..nx * ny)
            .map(|k| {
                let (a, b) = (((k % nx) as f64 + 0.5) * s, ((k / nx) as f64 + 0.5) * s);
                Particle::at_rest(k as u32, [self.corner[0] + c * a - t * b, self.corner[1] + t * a + c * b])
            })
            .collect()
    }

    /// The brick as a mesh with edges of elements at the `cuts` (m along its base and its side).
    pub fn mesh(&self, cuts: [&[f64]; 2]) -> Mesh {
        Mesh::rectangle(self.corner, self.angle, self.cells.map(|n| n as f64 * self.spacing), self.spacing, cuts)
    }

    /// A body of `law` whose points are those of this brick.
    pub fn body(&self, law: AnyLaw, density: f64) -> Body {
        let s = self.spacing / self.per_cell as f64;
        let volume = s * s * THICKNESS;
        Body {
            name: "brick".into(),
            law,
            point_mass: density * volume,
            point_volume: volume,
            points_per_direction: self.per_cell,
            point_spacing: s,
            weightless: false,
            between_side_walls: true,
            implicit: false,
            mesh: None,
        }
    }
}

/// A scene of one brick: uGIMP, MUSL, no PIC, no gravity, unless changed.
pub fn scene(brick: &Brick, law: AnyLaw, density: f64, points: Vec<Particle>, boundaries: Vec<Boundary>) -> Scene {
    Scene {
        lattice: Lattice { spacing: brick.spacing, origin: [0.0, 0.0] },
        thickness: THICKNESS,
        domain: [[-1e3, 1e3], [-1e3, 1e3]],
        bodies: vec![(brick.body(law, density), points)],
        boundaries,
        gravity: [0.0, 0.0],
        contacts: vec![],
        side_wall_friction: 0.0,
        numerics: Numerics {
            scheme: Scheme::Musl,
            shape: ShapeFunction::Ugimp,
            cfl: 0.4,
            max_time_step: 1.0,
            pic: PicShare::Fraction(0.0),
            boundary_contact: BoundaryContact::Surface,
            opened_volume: OpenedVolume::Occupied,
        },
    }
}

/// Steps until `time` (s) is reached.
///
/// # Errors
/// Where the solver gives up.
pub fn run_until(simulation: &mut Simulation, time: f64) -> Result<(), StepFailure> {
    while simulation.time() < time {
        simulation.step()?;
    }
    Ok(())
}

/// The points in the order of their numbers.
pub fn points_by_number(simulation: &Simulation) -> Vec<Particle> {
    let mut points: Vec<Particle> = simulation.particles().map(|(_, p)| p).collect();
    points.sort_by_key(|p| p.id);
    points
}

/// Mean position and velocity of all points (of equal mass).
pub fn centre(simulation: &Simulation) -> ([f64; 2], [f64; 2]) {
    let (mut x, mut v, mut n) = ([0.0; 2], [0.0; 2], 0.0);
    for p in points_by_number(simulation) {
        for d in 0..2 {
            x[d] += p.x[d];
            v[d] += p.v[d];
        }
        n += 1.0;
    }
    (x.map(|s| s / n), v.map(|s| s / n))
}

/// Numbers in [0, 1) from a linear congruential generator (Knuth's MMIX constants): the same on every machine.
#[derive(Debug, Clone)]
pub struct Lcg(u64);

impl Lcg {
    /// From a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next number.
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// The next number in [-1, 1).
    pub fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }
}
