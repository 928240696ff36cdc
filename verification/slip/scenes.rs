//! The block of the rung, wherever its plane lies.

use crate::scene::{Brick, Material, THICKNESS, centre, points_by_number, run_until, scene};
use crate::{Fault, RungFailure};
use checkdam::body::Particle;
use checkdam::boundary::{Boundary, Friction};
use checkdam::simulation::{PicShare, Simulation};
use nalgebra::Vector2;

pub(super) const GRAVITY: f64 = 9.81;
const CELLS: [usize; 2] = [8, 4];
const DENSITY: f64 = 1500.0;
/// Stiff against the elastic slip by a factor of 500 and more.
const YOUNG: f64 = 1e8;

/// A block on a plane whose friction needs slip.
#[derive(Clone, Copy)]
pub(super) struct Block {
    /// Angle of the plane to the grid, degrees.
    pub plane: f64,
    /// Place of the plane between two rows of nodes, cells.
    pub offset: f64,
    /// Slope under gravity, degrees.
    pub slope: f64,
    /// Kinetic and static coefficient.
    pub friction: [f64; 2],
    /// Slip length, m.
    pub length: f64,
    /// Cell size, m; all other lengths of the block go with it.
    pub cell: f64,
    /// Whether the slope falls to the left, seen with the normal up.
    pub leftward: bool,
    /// Share of PIC.
    pub pic: f64,
}

impl Block {
    pub const LEVEL: Block = Block {
        plane: 0.0,
        offset: 0.14,
        slope: 0.0,
        friction: [0.4, 0.4],
        length: 4e-3,
        cell: 0.05,
        leftward: false,
        // Keeps the block from shaking without touching its translation.
        pic: 1.0,
    };

    pub fn mass(&self) -> f64 {
        DENSITY * (CELLS[0] * CELLS[1]) as f64 * self.cell * self.cell * THICKNESS
    }

    /// Weight on the plane as it should be, N.
    pub fn normal_force(&self) -> f64 {
        self.mass() * GRAVITY * libm::cos(self.slope.to_radians())
    }

    /// Down the slope.
    pub fn tangent(&self) -> Vector2<f64> {
        let angle = self.plane.to_radians();
        let right = Vector2::new(libm::cos(angle), -libm::sin(angle));
        if self.leftward { -right } else { right }
    }

    fn normal(&self) -> Vector2<f64> {
        let angle = self.plane.to_radians();
        Vector2::new(libm::sin(angle), libm::cos(angle))
    }

    /// Gravity on a slope (degrees).
    pub fn gravity(&self, slope: f64, fault: &Fault) -> [f64; 2] {
        let (g, slope) = (GRAVITY * fault.gravity, slope.to_radians());
        (self.tangent() * (g * libm::sin(slope)) - self.normal() * (g * libm::cos(slope))).into()
    }

    fn simulation(&self, points: Option<Vec<Particle>>, rough: bool, pic: f64, fault: &Fault) -> Simulation {
        let corner = self.tangent() * (0.26 * self.cell) + self.normal() * (self.offset * self.cell);
        let brick = Brick { angle: -self.plane.to_radians(), ..Brick::new(corner.into(), CELLS, self.cell) };
        let [kinetic, peak] = self.friction.map(|mu| mu * fault.friction);
        let friction = if rough { Friction::Rough } else { Friction::Coulomb(kinetic) };
        let base = Boundary::plane("base", corner, self.normal(), friction);
        let base = base.mobilised(self.length * fault.slip_length, peak);
        // Stiffness that grows with the cell size keeps the scaled block similar.
        let block = Material::new(YOUNG * self.cell / Block::LEVEL.cell, 0.3, DENSITY);
        let points = points.unwrap_or_else(|| brick.points());
        let mut scene = scene(&brick, block.law(fault), block.density * fault.density, points, vec![base]);
        scene.gravity = self.gravity(self.slope, fault);
        scene.numerics.pic = PicShare::Fraction(pic);
        Simulation::new(scene)
    }

    /// The block at rest on its slope, with nothing slipped yet, that moves at a speed (m/s) down the slope.
    pub fn launch(&self, speed: f64, fault: &Fault) -> Result<Simulation, RungFailure> {
        let time = (self.cell / Block::LEVEL.cell).sqrt();
        let mut still = self.simulation(None, true, 0.02, fault);
        still.set_damping(1500.0 / time);
        run_until(&mut still, 0.06 * time)?;
        let mut points = points_by_number(&still);
        points.iter_mut().for_each(|p| p.v = (self.tangent() * speed).into());
        Ok(self.simulation(Some(points), false, self.pic, fault))
    }

    /// The block held on its slope by elastic slip: damping lets it go there without swinging.
    pub fn hung(&self, fault: &Fault) -> Result<Simulation, RungFailure> {
        let mut sim = self.launch(0.0, fault)?;
        sim.set_damping(80.0);
        run_until(&mut sim, 0.7)?;
        sim.set_damping(0.0);
        Ok(sim)
    }

    /// Place and velocity of the centre down the slope.
    pub fn centre(&self, sim: &Simulation) -> [f64; 2] {
        let (x, v) = centre(sim);
        [x, v].map(|r| Vector2::from(r).dot(&self.tangent()))
    }
}
