//! Points of two bodies for the tests of what is read of the flow.

use crate::body::{Body, Particle};
use crate::boundary::Boundary;
use crate::constitutive::{AnyLaw, LinearElastic};
use crate::scaffold::{Brick, scene};
use crate::simulation::{Scene, Simulation};

/// Mass (kg) and volume (m3) of a point of the two bodies: what is weighted wrongly shows.
pub const BODIES: [(f64, f64); 2] = [(1.0, 3e-5), (2.0, 5e-5)];

pub fn point(x: f64, y: f64, v: [f64; 2], volume_ratio: f64) -> Particle {
    Particle { v, volume_ratio, ..Particle::at_rest(0, [x, y]) }
}

/// Points of two bodies on a grid of spacing `h`, without forces.
pub fn scene_of(h: f64, points: [Vec<Particle>; 2], boundaries: Vec<Boundary>) -> Scene {
    let brick = Brick::new([0.0; 2], [1, 1], h);
    let law = AnyLaw::LinearElastic(LinearElastic::new(1e4, 0.0));
    let mut scene = scene(&brick, law, 1000.0, Vec::new(), boundaries);
    scene.bodies = points
        .into_iter()
        .zip(BODIES)
        .map(|(points, (point_mass, point_volume))| {
            (Body { point_mass, point_volume, ..brick.body(law, 1000.0) }, points)
        })
        .collect();
    scene
}

pub fn simulation(h: f64, points: [Vec<Particle>; 2], boundaries: Vec<Boundary>) -> Simulation {
    Simulation::new(scene_of(h, points, boundaries))
}

pub fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * b.abs().max(1.0)
}
