//! The points beside a face, found block by block: most blocks lie too far away and are left after one look.

use crate::body::Block;
use crate::boundary::Boundary;
use crate::lanes::LANES;

/// A point beside a face.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beside<'a> {
    /// Index of its body.
    pub body: usize,
    /// Its block.
    pub block: &'a Block,
    /// Its lane.
    pub lane: usize,
}

impl Beside<'_> {
    /// Where it is, m.
    pub fn x(&self) -> [f64; 2] {
        [self.block.x[0][self.lane], self.block.x[1][self.lane]]
    }
}

/// The points of `blocks` (index of the body, block, number of real points) that lie behind the infinitely extended face, or in
/// front of it by `reach` (m) at most, in the order of the blocks.
pub(super) fn beside<'a>(
    face: &Boundary,
    reach: f64,
    blocks: impl Iterator<Item = (usize, &'a Block, usize)>,
) -> impl Iterator<Item = Beside<'a>> {
    let (foot, normal) = (face.foot(), face.normal);
    blocks.flat_map(move |(body, block, n)| {
        // As Boundary::face_coordinates has it, to the last bit.
        let distance = |l: usize| (block.x[0][l] - foot.x) * normal.x + (block.x[1][l] - foot.y) * normal.y;
        let near: [bool; LANES] = std::array::from_fn(|l| distance(l) <= reach);
        let real = if near.contains(&true) { n } else { 0 };
        (0..real).filter(move |&lane| near[lane]).map(move |lane| Beside { body, block, lane })
    })
}
