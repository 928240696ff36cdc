//! Scenes of several bricks, each a body of its own.

use crate::body::Particle;
use crate::boundary::Boundary;
use crate::contact::rule::{ContactRule, GapRule, NormalRule};
use crate::simulation::{Scene, Simulation};
use crate::verification::Fault;
use crate::verification::scene::{Brick, Material, scene};

/// A brick of a material with its points.
#[derive(Debug, Clone)]
pub struct Part {
    pub brick: Brick,
    pub material: Material,
    pub points: Vec<Particle>,
}

impl Part {
    pub fn new(brick: Brick, material: Material) -> Self {
        Self { brick, material, points: brick.points() }
    }

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

/// The choices of a contact, by name.
pub const NORMALS: [(&str, NormalRule); 5] = [
    ("larger body", NormalRule::LargerBody),
    ("average", NormalRule::Average),
    ("regression", NormalRule::Regression),
    ("nearest face of the first", NormalRule::NearestFace(0)),
    ("nearest face of the second", NormalRule::NearestFace(1)),
];

pub const GAPS: [(&str, GapRule); 4] = [
    ("approach", GapRule::Approach),
    ("positions", GapRule::POSITIONS),
    ("displacements", GapRule::Displacements),
    ("extents", GapRule::Extents),
];

/// Momentum, energies of a body.
pub fn of_body(sim: &Simulation, body: usize) -> crate::ledger::Stock {
    sim.stock_of(|b| b == body)
}
