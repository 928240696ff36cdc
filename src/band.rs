//! A band: the points of some neighbouring grid columns, and the nodes they reach.
//!
//! A band owns the nodes from its first column to the first column of the next band and solves their momentum balance.
//! Its points reach a few columns further; what they add there is kept apart and handed to the next band, which adds it
//! before its own. So no two bands write to one place, and sums are taken in the order of the bands whatever thread
//! works on which.
//!
//! Elsewhere: domain decomposition in strips. What a band's points add beyond its own nodes is its halo (ghost nodes,
//! ghost layer), and handing it over is the halo exchange.

use crate::body::Points;
use crate::boundary::nodes::{Hold, Tally};
use crate::lanes::Lane;
use crate::ledger::Distributed;

/// What points add to one node: a cache line, and the width in which the scatter works.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(C, align(64))]
pub struct NodeSum(pub [f64; 8]);

impl NodeSum {
    /// Mass, kg.
    pub fn mass(&self) -> f64 {
        self.0[0]
    }

    /// Momentum, kg m/s.
    pub fn momentum(&self) -> [f64; 2] {
        [self.0[1], self.0[2]]
    }

    /// Side-wall friction capacity, N.
    pub fn side_friction(&self) -> f64 {
        self.0[3]
    }

    /// Internal force, N: from gradients along x and along y, which are kept apart until here.
    pub fn force(&self) -> [f64; 2] {
        [self.0[4] + self.0[6], self.0[5] + self.0[7]]
    }
}

/// What a step needs of a band from its first stage to its last and no longer, so that a few of them serve many bands and stay in
/// cache. Nodal fields but `mass` go on past the nodes that the band owns; `remapped` and `strain_velocity` end with one node more,
/// so that the vectors that read and write three of them at a time may see a fourth.
#[derive(Debug, Clone, Default)]
pub struct Workspace {
    /// What the band's points add.
    pub sums: Vec<NodeSum>,
    /// Momentum of the updated points (MUSL), kg m/s.
    pub remapped: Vec<[f64; 2]>,
    /// Mass of the owned nodes, kg.
    pub mass: Vec<f64>,
    /// New velocity and its change in this step: v_x, v_y, dv_x, dv_y in m/s.
    pub motion: Vec<[f64; 4]>,
    /// Velocity whose gradient strains the material, m/s.
    pub strain_velocity: Vec<[f64; 2]>,
    /// Displacement of the points in this step, m: applied when the stress has been updated. Block by block, body after body.
    pub moved: Vec<[Lane; 2]>,
}

impl Workspace {
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.sums.capacity() * size_of::<NodeSum>()
            + (self.remapped.capacity() + self.strain_velocity.capacity()) * size_of::<[f64; 2]>()
            + self.mass.capacity() * size_of::<f64>()
            + self.motion.capacity() * size_of::<[f64; 4]>()
            + self.moved.capacity() * size_of::<[Lane; 2]>()
    }
}

/// A node whose momentum balance is done but for boundaries and contact.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OpenNode {
    /// Mass, kg; 0 where the field does not reach.
    pub mass: f64,
    /// Velocity before the step, m/s.
    pub old: [f64; 2],
    /// Velocity that the node would have, m/s.
    pub free: [f64; 2],
    /// Impulse of damping, N s.
    pub damped: [f64; 2],
    /// Impulse of side walls, N s.
    pub braked: [f64; 2],
    /// Impulse of a field of accelerations, N s.
    pub field: [f64; 2],
}

/// Points of neighbouring columns, the nodes they reach, and what a step counts there.
#[derive(Debug, Clone, Default)]
pub struct Band {
    /// Points of each body.
    pub points: Vec<Points>,
    /// Index of the first node in the active grid.
    pub first_node: usize,
    /// Nodes that the band solves.
    pub owned: usize,
    /// Nodes that its points reach.
    pub reach: usize,
    /// What a step works with.
    pub work: Workspace,
    /// Force of a body-force field, N; empty unless there is one.
    pub field_force: Vec<[f64; 2]>,
    /// Boundaries acting on the owned nodes, in the order of the nodes.
    pub holds: Vec<Hold>,
    /// Owned nodes that other velocity fields reach, in their order, counted from the first.
    pub shared: Vec<u32>,
    /// What is known of each of them before contact.
    pub open: Vec<OpenNode>,
    /// Sums over the points in this step.
    pub sums: BandSums,
    /// What each boundary did to the owned nodes in this step.
    pub tallies: Vec<Tally>,
    /// What acted throughout the owned nodes in this step.
    pub distributed: Distributed,
}

/// Sums over the points of a band in one step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BandSums {
    /// Kinetic energy, J. Not finite when any velocity is not.
    pub kinetic: f64,
    /// Largest speed component, m/s.
    pub max_speed: f64,
    /// Largest displacement component of the step, m.
    pub max_displacement: f64,
    /// Smallest volume ratio.
    pub min_volume_ratio: f64,
    /// Work of the internal stress, J.
    pub internal_work: f64,
    /// Kinetic energy taken by the PIC share of the velocity update, J.
    pub pic_loss: f64,
    /// Both together of what is led behind the sections of inflows, J; it is not part of the others.
    pub led_work: f64,
}

/// A band and the one before it, which reaches its first nodes.
pub fn with_before(bands: &mut [Band], k: usize) -> (Option<&mut Band>, &mut Band) {
    let (before, rest) = bands.split_at_mut(k);
    (before.last_mut(), &mut rest[0])
}

impl Band {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.points.iter().map(Points::len).sum()
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Velocity of one of its nodes after the momentum balance, m/s.
    pub fn velocity(&self, node: usize) -> [f64; 2] {
        let [x, y, ..] = self.work.motion[node];
        [x, y]
    }

    /// Makes room for a step. What the workspace holds afterwards is of no use.
    pub fn make_room(&mut self) {
        let Self { work, owned, reach, .. } = self;
        work.sums.resize(*reach, NodeSum::default());
        work.remapped.resize(*reach + 1, [0.0; 2]);
        work.mass.resize(*owned, 0.0);
        work.motion.resize(*reach, [0.0; 4]);
        work.strain_velocity.resize(*reach + 1, [0.0; 2]);
        // Seen with weight zero, but seen.
        work.strain_velocity[*reach] = [0.0; 2];
        work.moved.resize(self.points.iter().map(Points::block_count).sum(), Default::default());
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.points.iter().map(Points::bytes).sum::<usize>()
            + self.work.bytes()
            + self.field_force.capacity() * size_of::<[f64; 2]>()
            + self.holds.capacity() * size_of::<Hold>()
            + self.shared.capacity() * size_of::<u32>()
            + self.open.capacity() * size_of::<OpenNode>()
    }
}
