//! Material points, in blocks of eight.
//!
//! The points of a body share mass, reference volume and law; everything else is stored as structure of arrays inside
//! [`Block`]s, which the [`crate::layout`] keeps sorted by cell in bands of grid columns.
//!
//! Elsewhere: particles (markers) as structure of arrays; in blocks it is called array of structures of arrays (AoSoA)
//! or a tiled layout.

use crate::constitutive::{AnyLaw, History, Law, PointState, Stress};
use crate::lanes::{LANES, Lane};
use crate::mesh::Mesh;

/// Eight material points. Fields are parallel arrays.
#[derive(Debug, Clone, PartialEq)]
#[repr(C, align(64))]
pub struct Block {
    /// Position, m.
    pub x: [Lane; 2],
    /// Velocity, m/s.
    pub v: [Lane; 2],
    /// Cauchy stress xx, yy, zz, xy in Pa, tension positive.
    pub stress: [Lane; 4],
    /// Current over reference volume, J.
    pub volume_ratio: Lane,
    /// Opened volumetric strain, see [`PointState::opened`].
    pub opened: Lane,
    /// Equivalent plastic shear strain, see [`PointState::plastic_shear`].
    pub plastic_shear: Lane,
}

impl Default for Block {
    fn default() -> Self {
        const ZERO: Lane = [0.0; LANES];
        Self {
            x: [ZERO; 2],
            v: [ZERO; 2],
            stress: [ZERO; 4],
            volume_ratio: [1.0; LANES],
            opened: ZERO,
            plastic_shear: ZERO,
        }
    }
}

/// Slip of a material point on the boundaries that it touches, see `boundary::slip`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Slip {
    /// Elastic slip, m: a vector along the surface, so that it is the same for any grid and for any piece of the surface.
    pub elastic: [f64; 2],
    /// Plastic slip that has weakened the contact, m.
    pub worn: f64,
}

/// One material point, as gauges and writers see it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Particle {
    /// Number within its body.
    pub id: u32,
    /// Position, m.
    pub x: [f64; 2],
    /// Velocity, m/s.
    pub v: [f64; 2],
    /// Stress and history.
    pub state: PointState,
    /// Current over reference volume.
    pub volume_ratio: f64,
    /// Slip on boundaries.
    pub slip: Slip,
}

impl Particle {
    /// A stress-free point at rest in its reference state.
    pub fn at_rest(id: u32, x: [f64; 2]) -> Self {
        Self { id, x, v: [0.0; 2], state: PointState::default(), volume_ratio: 1.0, slip: Slip::default() }
    }

    /// Speed, m/s.
    pub fn speed(&self) -> f64 {
        (self.v[0] * self.v[0] + self.v[1] * self.v[1]).sqrt()
    }
}

impl Block {
    /// Reads one lane, the point of this number, without what its law keeps of its own and without slip.
    #[inline]
    pub fn get(&self, l: usize, id: u32) -> Particle {
        Particle {
            id,
            x: [self.x[0][l], self.x[1][l]],
            v: [self.v[0][l], self.v[1][l]],
            state: PointState {
                stress: Stress {
                    xx: self.stress[0][l],
                    yy: self.stress[1][l],
                    zz: self.stress[2][l],
                    xy: self.stress[3][l],
                },
                opened: self.opened[l],
                plastic_shear: self.plastic_shear[l],
                history: History::default(),
            },
            volume_ratio: self.volume_ratio[l],
            slip: Slip::default(),
        }
    }

    /// Writes one lane; the number of the point is kept elsewhere.
    #[inline]
    pub fn set(&mut self, l: usize, p: &Particle) {
        for d in 0..2 {
            self.x[d][l] = p.x[d];
            self.v[d][l] = p.v[d];
        }
        let s = &p.state.stress;
        for (lane, value) in self.stress.iter_mut().zip([s.xx, s.yy, s.zz, s.xy]) {
            lane[l] = value;
        }
        self.volume_ratio[l] = p.volume_ratio;
        self.opened[l] = p.state.opened;
        self.plastic_shear[l] = p.state.plastic_shear;
    }
}

/// Material points of one body, in order, the last block filled up with copies that are never counted.
#[derive(Debug, Clone, Default)]
pub struct Points {
    blocks: Vec<Block>,
    /// Numbers of the points within their body, unchanged by sorting; parallel to the blocks, which a step reads and writes.
    ids: Vec<[u32; LANES]>,
    /// What the law keeps of its own, block by block, and how many lanes of it a block has: [`Law::HISTORY`].
    histories: Vec<Lane>,
    history: usize,
    /// Slip on boundaries, parallel to the blocks; empty where no point has slipped.
    slips: Vec<[Slip; LANES]>,
    len: usize,
}

impl Points {
    /// Number of material points.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// No points, with room for what this law keeps of its own; without it there is room for nothing.
    pub fn for_law(law: &AnyLaw) -> Self {
        Self { history: law.history(), ..Self::default() }
    }

    /// Forgets all points, keeping the memory.
    pub fn clear(&mut self) {
        self.blocks.clear();
        self.ids.clear();
        self.histories.clear();
        self.slips.clear();
        self.len = 0;
    }

    /// Makes room for `len` points, to be written with [`Points::set`].
    pub fn resize(&mut self, len: usize) {
        let blocks = len.div_ceil(LANES);
        // All points of a body start in one band.
        if self.blocks.capacity() > 64 + 8 * blocks {
            self.blocks.shrink_to(2 * blocks);
            self.ids.shrink_to(2 * blocks);
            self.histories.shrink_to(2 * blocks * self.history);
        }
        self.blocks.resize_with(blocks, Block::default);
        self.ids.resize(blocks, [u32::MAX; LANES]);
        self.histories.resize(blocks * self.history, [0.0; LANES]);
        self.len = len;
    }

    /// Writes point `i`.
    pub fn set(&mut self, i: usize, p: &Particle) {
        self.blocks[i / LANES].set(i % LANES, p);
        self.ids[i / LANES][i % LANES] = p.id;
        for (lane, value) in
            self.histories[i / LANES * self.history..].iter_mut().take(self.history).zip(p.state.history)
        {
            lane[i % LANES] = value;
        }
        if p.slip != Slip::default() || !self.slips.is_empty() {
            self.slips_mut()[i / LANES][i % LANES] = p.slip;
        }
    }

    /// Slip of the points of a block on boundaries.
    pub fn slip(&self, number: usize) -> [Slip; LANES] {
        self.slips.get(number).copied().unwrap_or_default()
    }

    /// The same of all blocks, mutable.
    pub fn slips_mut(&mut self) -> &mut [[Slip; LANES]] {
        self.slips.resize(self.blocks.len(), Default::default());
        &mut self.slips
    }

    /// Whether no point has slipped on a boundary.
    pub fn is_unslipped(&self) -> bool {
        self.slips.is_empty()
    }

    /// Position of point `i`, m.
    #[inline]
    pub fn position(&self, i: usize) -> [f64; 2] {
        let block = &self.blocks[i / LANES];
        [block.x[0][i % LANES], block.x[1][i % LANES]]
    }

    /// Appends a point.
    pub fn push(&mut self, p: &Particle) {
        self.resize(self.len + 1);
        self.set(self.len - 1, p);
    }

    /// Lets the unused lanes of the last block copy a real point, so that vector loops meet only sound numbers.
    pub fn pad(&mut self) {
        let used = self.len % LANES;
        if used > 0
            && let Some(last) = self.blocks.last_mut()
        {
            let p = last.get(used - 1, u32::MAX);
            (used..LANES).for_each(|l| last.set(l, &p));
            let from = self.histories.len() - self.history;
            for lane in &mut self.histories[from..] {
                let value = lane[used - 1];
                lane[used..].fill(value);
            }
        }
    }

    /// Number of blocks.
    pub fn block_count(&self) -> usize {
        self.blocks.len()
    }

    /// Numbers of the points of each block within their body.
    #[inline(always)]
    pub fn ids(&self) -> &[[u32; LANES]] {
        &self.ids
    }

    /// The blocks; lanes beyond the last point repeat one.
    pub fn all(&self) -> &[Block] {
        &self.blocks
    }

    /// A block, if there are so many.
    #[inline(always)]
    pub fn block(&self, number: usize) -> Option<&Block> {
        self.blocks.get(number)
    }

    /// Number of real points in a block.
    pub fn points_in(&self, number: usize) -> usize {
        self.len.saturating_sub(number * LANES).min(LANES)
    }

    /// The blocks with the number of real points in each.
    #[inline(always)]
    pub fn blocks(&self) -> impl Iterator<Item = (&Block, usize)> {
        let len = self.len;
        self.blocks.iter().enumerate().map(move |(i, b)| (b, (len - i * LANES).min(LANES)))
    }

    /// The blocks, mutable, and what the law keeps of its own, [`Law::HISTORY`] lanes a block.
    #[inline(always)]
    pub fn blocks_mut(&mut self) -> (&mut [Block], &mut [Lane]) {
        (&mut self.blocks, &mut self.histories)
    }

    /// All points in order.
    pub fn iter(&self) -> impl Iterator<Item = Particle> {
        self.blocks().zip(&self.ids).enumerate().flat_map(|(i, ((b, n), ids))| {
            let history = &self.histories[i * self.history..(i + 1) * self.history];
            let slips = self.slips.get(i);
            (0..n).map(move |l| {
                let mut p = b.get(l, ids[l]);
                p.state.history.iter_mut().zip(history).for_each(|(value, lane)| *value = lane[l]);
                if let Some(slips) = slips {
                    p.slip = slips[l];
                }
                p
            })
        })
    }

    /// Changes all points in order.
    pub fn for_each_mut(&mut self, mut change: impl FnMut(&mut Particle)) {
        for (i, mut p) in self.iter().collect::<Vec<_>>().into_iter().enumerate() {
            change(&mut p);
            self.set(i, &p);
        }
        self.pad();
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.blocks.capacity() * size_of::<Block>()
            + self.ids.capacity() * size_of::<[u32; LANES]>()
            + self.histories.capacity() * size_of::<Lane>()
            + self.slips.capacity() * size_of::<[Slip; LANES]>()
    }
}

/// What the points of one body have in common.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Name, for reports.
    pub name: String,
    /// Constitutive law.
    pub law: AnyLaw,
    /// Mass of one material point, kg.
    pub point_mass: f64,
    /// Reference volume of one material point, m3.
    pub point_volume: f64,
    /// Material points per cell and direction at the start.
    pub points_per_direction: usize,
    /// Distance between material points at the start, m.
    pub point_spacing: f64,
    /// Whether gravity leaves it alone; needs a velocity field of its own, as bodies in contact have.
    pub weightless: bool,
    /// Whether the side walls touch it.
    pub between_side_walls: bool,
    /// Whether it moves in implicit steps, so that its waves do not limit the time step; for elastic laws, held by clamps alone, in contact or
    /// with a mesh.
    pub implicit: bool,
    /// Its reference configuration, if it moves by the nodes of that (total-Lagrangian kinematics) and its points go with them; else each
    /// point keeps its own deformation, and the grid moves it (updated Lagrangian). For neo-Hookean bodies that clamps alone hold.
    pub mesh: Option<Mesh>,
}

impl Body {
    /// Speed of the P-wave at the reference density, m/s.
    pub fn p_wave_speed(&self) -> f64 {
        (self.law.p_wave_modulus() * self.point_volume / self.point_mass).sqrt()
    }
}

#[cfg(test)]
#[path = "body_tests.rs"]
mod tests;
