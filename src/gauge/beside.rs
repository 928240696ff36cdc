//! The points beside a face, found a few blocks at a time: most lie too far away and are left after one look.

use crate::body::Block;
use crate::boundary::Boundary;
use crate::seeded::{self, Seed};
use crate::simulation::Simulation;

/// A point beside a face.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beside<'a> {
    /// Index of its body.
    pub body: usize,
    block: &'a Block,
    lane: usize,
}

impl Beside<'_> {
    /// Where it is, m.
    pub fn x(&self) -> [f64; 2] {
        [self.block.x[0][self.lane], self.block.x[1][self.lane]]
    }

    /// Its stress xx, yy, zz, xy, Pa.
    pub fn stress(&self) -> [f64; 4] {
        [0, 1, 2, 3].map(|k| self.block.stress[k][self.lane])
    }

    /// Its volume over that at the start.
    pub fn volume_ratio(&self) -> f64 {
        self.block.volume_ratio[self.lane]
    }
}

/// Whether a boundary acts on a body, by its index: what it does not act on is not beside it.
pub(super) fn acts_on(face: &Boundary, body: usize) -> bool {
    face.acts_on(&[body]) || seeded::is(Seed::GaugeBodies)
}

/// The points of the `chosen` bodies, by index, that lie behind the infinitely extended face, or in front of it by `reach` (m) at
/// most, in the order of the blocks.
pub(super) fn beside<'a>(
    simulation: &'a Simulation,
    face: &Boundary,
    reach: f64,
    chosen: impl Fn(usize) -> bool + 'a,
) -> impl Iterator<Item = Beside<'a>> {
    let (foot, normal): ([f64; 2], [f64; 2]) = (face.foot().into(), face.normal.into());
    // As Boundary::face_coordinates has it, to the last bit.
    let distance = move |x: [f64; 2]| (x[0] - foot[0]) * normal[0] + (x[1] - foot[1]) * normal[1];
    let near =
        simulation.extents().iter().filter(move |e| distance(e.corner_against(normal)) <= reach && chosen(e.body));
    near.flat_map(move |e| {
        simulation.blocks_in(e).flat_map(move |(block, points)| {
            let real = (0..points).filter(move |&l| distance([block.x[0][l], block.x[1][l]]) <= reach);
            real.map(move |lane| Beside { body: e.body, block, lane })
        })
    })
}
