//! What a crossing knows of the slip of the material that passes it. The material points remember it; see `simulation/slip.rs`.

use super::{Site, SiteNode};
use crate::boundary::Boundary;
use crate::boundary::nodes::{Hold, HoldState};
use crate::boundary::slip::{SlipLaw, Slipped};
use crate::space::{clockwise, dot, scaled};

/// Slip at a crossing in a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SiteSlip {
    law: SlipLaw,
    /// When the step began.
    at: Slipped,
    /// Length of the step, s.
    dt: f64,
    /// Slip of the step while the boundary presses, m.
    moved: f64,
    /// Energy of the elastic slip after it, J.
    stored: f64,
}

impl SiteSlip {
    pub(super) fn new(law: SlipLaw) -> Self {
        Self { law, at: Slipped::default(), dt: 0.0, moved: 0.0, stored: 0.0 }
    }

    /// Tangential impulse under this normal one (N s); `stick` (N s) would stop all slip.
    pub(super) fn impulse(&self, normal: f64, stick: f64, mobility: f64) -> f64 {
        self.law.impulse(self.at, self.dt, normal, -stick * mobility, mobility)
    }
}

impl Site {
    /// A node at `x` (m) that a boundary whose friction needs slip holds, as a crossing.
    pub(in crate::boundary) fn at_node(hold: &Hold, x: [f64; 2], face: &Boundary) -> Self {
        let (node, index) = (hold.node as usize, hold.boundary as usize);
        let site = Self::new([node, node], [1.0, 0.0], index, face, ([hold.along; 2], x, face.foot().into()), false);
        Self { normal: hold.normal, ..site }
    }

    /// How slip mobilises its friction.
    pub fn slip_law(&self) -> Option<&SlipLaw> {
        self.slip.as_ref().map(|s| &s.law)
    }

    /// Begins a step of `dt` (s) with the slip that the material brings.
    pub fn recall(&mut self, at: Slipped, dt: f64) {
        if let Some(slip) = &mut self.slip {
            *slip = SiteSlip { at, dt, ..SiteSlip::new(slip.law) };
        }
    }

    /// Sees how far the material has slipped in the step, given the nodes of its group after it.
    pub fn follow_slip(&mut self, nodes: &[SiteNode]) {
        let velocity = dot(self.velocity(|k| nodes[k].v), clockwise(self.normal));
        let (presses, normal) = (self.state != HoldState::Apart, self.impulse[0]);
        if let Some(slip) = self.slip.as_mut().filter(|s| presses && s.dt > 0.0) {
            slip.moved = slip.dt * velocity;
            // Velocities lie half a step beside places: the product is the energy that goes with them.
            let after = slip.law.after(slip.at, slip.moved);
            slip.stored = 0.5 * slip.law.stiffness() * normal / slip.dt * (slip.at.elastic * after.elastic).max(0.0);
        }
    }

    /// Slip of the material in the last step, m; `None` where the boundary did not press.
    pub fn slip_moved(&self) -> Option<[f64; 2]> {
        let slip = self.slip.as_ref().filter(|_| self.state != HoldState::Apart)?;
        Some(scaled(clockwise(self.normal), slip.moved))
    }

    /// Energy of the elastic slip there, J.
    pub fn slip_energy(&self) -> f64 {
        self.slip.map_or(0.0, |s| s.stored)
    }

    /// Nodes that see it, with their shares.
    pub fn weights(&self) -> impl Iterator<Item = (u32, f64)> {
        self.nodes.into_iter().zip(self.shares[0]).filter(|(_, share)| *share > 0.0)
    }
}
