//! Scenes of several bricks, each a body of its own.

use crate::Fault;
use crate::scene::{Brick, Material, scene};
use checkdam::body::Particle;
use checkdam::boundary::Boundary;
use checkdam::contact::rule::{ContactRule, GapRule, NormalRule};
use checkdam::simulation::Scene;

/// A brick of a material with its points.
#[derive(Debug, Clone)]
pub struct Part {
    /// Where its points lie.
    pub brick: Brick,
    /// What it is made of.
    pub material: Material,
    /// Its points.
    pub points: Vec<Particle>,
}

impl Part {
    /// A part at rest.
    pub fn new(brick: Brick, material: Material) -> Self {
        Self { brick, material, points: brick.points() }
    }

    /// The same at a velocity (m/s).
    pub fn moving(mut self, v: [f64; 2]) -> Self {
        self.points.iter_mut().for_each(|p| p.v = v);
        self
    }
}

/// A scene of parts on one grid, whose cell size is that of the first.
pub fn several(parts: Vec<Part>, contacts: Vec<ContactRule>, boundaries: Vec<Boundary>, fault: &Fault) -> Scene {
    let mut parts = parts.into_iter();
    let first = parts.next().expect("a part");
    let body = |p: &Part| (p.material.law(fault), p.material.density * fault.density);
    let (law, density) = body(&first);
    let mut scene = scene(&first.brick, law, density, first.points, boundaries);
    for part in parts {
        let (law, density) = body(&part);
        scene.bodies.push((part.brick.body(law, density), part.points));
    }
    let faulty = |c: ContactRule| ContactRule { friction: c.friction * fault.friction, ..c };
    scene.contacts = contacts.into_iter().map(faulty).collect();
    scene
}

/// Ways to find normals, by name; the first body is the structure.
pub const NORMALS: [(&str, NormalRule); 4] = [
    ("larger body", NormalRule::LargerBody),
    ("average", NormalRule::Average),
    ("regression", NormalRule::Regression),
    ("nearest face", NormalRule::NearestFace(0)),
];

/// Ways to find gaps, by name.
pub const GAPS: [(&str, GapRule); 4] = [
    ("approach", GapRule::Approach),
    ("positions", GapRule::POSITIONS),
    ("displacements", GapRule::Displacements),
    ("extents", GapRule::Extents),
];

/// Contact of the first two bodies in one of the ways above.
pub fn rule(friction: f64, normal: NormalRule, gap: GapRule) -> ContactRule {
    ContactRule { bodies: [0, 1], friction, normal, gap }
}

/// Contact of the first two bodies in the way that a user gets.
pub fn usual(friction: f64) -> ContactRule {
    ContactRule::with_structure(0, 1, friction)
}
