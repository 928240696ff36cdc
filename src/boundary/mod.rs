//! Rigid boundaries: planes, walls of finite height at any angle to the grid, and gates.
//!
//! Material may leave a boundary but not press into it, and slides on it with Coulomb friction. A clamp holds material back
//! as well, on the nodes nearest to its plane and behind it. [`Boundary`] is the geometry, [`nodes`] the law at a node,
//! `surface` the law where the surface passes between nodes; `search` finds both, side by side (`side`).
//!
//! Elsewhere: rigid obstacles, and essential (Dirichlet) conditions at nodes: free slip, no slip, unilateral, fixed.

mod chain;
pub mod nodes;
pub mod search;
mod side;
pub(crate) mod slip;
pub(crate) mod surface;

pub use chain::{Chain, Near, Piece};

use crate::seeded::{self, Seed};
use nalgebra::Vector2;
use serde::{Deserialize, Serialize};
use slip::SlipLaw;
use std::sync::Arc;

/// Where boundaries act.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum BoundaryContact {
    /// On their surface, wherever the grid lies. Clamps and moving boundaries act at nodes.
    #[default]
    Surface,
    /// At the nodes inside them, as in the paper: as if the surface lay on the nodes behind it.
    Nodes,
}

/// What resists sliding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Friction {
    /// Nothing.
    Smooth,
    /// At most the coefficient times the normal force.
    Coulomb(f64),
    /// Whatever is needed, as long as the material presses on the boundary.
    Rough,
    /// Whatever is needed, also against separation: a clamp.
    Bonded,
}

impl Friction {
    /// The Coulomb coefficient; infinite where nothing slides.
    pub fn coefficient(self) -> f64 {
        match self {
            Friction::Smooth => 0.0,
            Friction::Coulomb(mu) => mu,
            Friction::Rough | Friction::Bonded => f64::INFINITY,
        }
    }
}

/// How a gate opens once it is released.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Opening {
    /// It is gone at once.
    Vanish,
    /// It is lifted at a speed (m/s) until `opening` (m) is free below it; both may be infinite.
    Lift {
        /// m/s.
        speed: f64,
        /// m.
        opening: f64,
    },
}

/// Shape of a boundary.
#[derive(Debug, Clone, PartialEq)]
pub enum Solid {
    /// Everything on the side of `point` that the normal points away from.
    HalfSpace {
        /// A point of the surface, m.
        point: Vector2<f64>,
    },
    /// A slab that rises from `foot` along the tangent; its face looks along the normal.
    Slab {
        /// Lower end of the face, m.
        foot: Vector2<f64>,
        /// Length of the face, m.
        height: f64,
        /// Extent behind the face, m.
        thickness: f64,
        /// Whether only the face acts (gates), or also crest and back.
        face_only: bool,
    },
    /// Everything on the right of a chain of pieces, each with its own friction.
    Terrain {
        /// The chain.
        chain: Arc<Chain>,
    },
}

/// One rigid boundary.
#[derive(Debug, Clone, PartialEq)]
pub struct Boundary {
    /// Name, for reports.
    pub name: String,
    /// Shape.
    pub solid: Solid,
    /// Unit normal of the face, into the material.
    pub normal: Vector2<f64>,
    /// Unit vector along the face: from foot to crest; for a plane, the normal turned clockwise.
    pub tangent: Vector2<f64>,
    /// What resists sliding.
    pub friction: Friction,
    /// How slip mobilises Coulomb friction, where it needs slip and contact is on the surface.
    pub slip: Option<SlipLaw>,
    /// Indices of the bodies that it acts on; empty for all. Bodies that share a velocity field are held together.
    pub bodies: Vec<usize>,
    /// Velocity of the boundary, m/s. Moves the solid, too.
    pub velocity: Vector2<f64>,
    /// How far it has moved, m.
    pub travel: Vector2<f64>,
    /// For a gate: how it opens.
    pub opening: Option<Opening>,
    /// Free height below a gate now, m; infinite when it is gone.
    pub free_below: f64,
    /// Whether a gate has been released.
    pub released: bool,
}

/// Where a node lies with respect to a boundary that holds it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Unit normal at the node, into the material.
    pub normal: [f64; 2],
    /// Position along the face from its foot (walls) or from the reference point (planes), m.
    pub along: f64,
}

impl Boundary {
    /// An infinite plane through `point` with outward unit normal `normal`.
    pub fn plane(name: &str, point: Vector2<f64>, normal: Vector2<f64>, friction: Friction) -> Self {
        let normal = normal.normalize();
        Self {
            name: name.into(),
            solid: Solid::HalfSpace { point },
            normal,
            tangent: Vector2::new(normal.y, -normal.x),
            friction,
            slip: None,
            bodies: Vec::new(),
            velocity: Vector2::zeros(),
            travel: Vector2::zeros(),
            opening: None,
            free_below: 0.0,
            released: false,
        }
    }

    /// A wall from `foot` along the unit vector `tangent`, with the material on its left, seen from foot to crest.
    pub fn wall(
        name: &str,
        foot: Vector2<f64>,
        tangent: Vector2<f64>,
        height: f64,
        thickness: f64,
        friction: Friction,
    ) -> Self {
        let tangent = tangent.normalize();
        Self {
            solid: Solid::Slab { foot, height, thickness, face_only: false },
            normal: Vector2::new(-tangent.y, tangent.x),
            tangent,
            ..Self::plane(name, foot, tangent, friction)
        }
    }

    /// Terrain below a chain; its friction as a whole is that of its first piece, its tangent leads from its first point to its last.
    pub fn terrain(name: &str, chain: Chain) -> Self {
        let (first, last) = (chain.pieces().first(), chain.pieces().last());
        let from = first.map_or_else(Vector2::zeros, |p| p.from);
        let chord = last.map_or_else(Vector2::zeros, |p| p.to) - from;
        let tangent = if chord.norm() > 0.0 { chord } else { Vector2::new(1.0, 0.0) };
        let friction = first.map_or(Friction::Smooth, |p| p.friction);
        let plane = Self::plane(name, from, Vector2::new(-tangent.y, tangent.x), friction);
        Self { solid: Solid::Terrain { chain: Arc::new(chain) }, ..plane }
    }

    /// The same boundary for some bodies only, by index.
    pub fn only_for(self, bodies: &[usize]) -> Self {
        Self { bodies: bodies.to_vec(), ..self }
    }

    /// The same with Coulomb friction that is mobilised over a slip length (m, above 0) up to a static coefficient, which may be larger
    /// than the kinetic one; of other boundaries nothing changes.
    pub fn mobilised(self, length: f64, peak: f64) -> Self {
        let slip = match self.friction {
            Friction::Coulomb(kinetic) if peak > 0.0 => Some(SlipLaw { length, peak: peak.max(kinetic), kinetic }),
            _ => self.slip,
        };
        Self { slip, ..self }
    }

    /// Whether it acts on any of these bodies.
    pub fn acts_on(&self, bodies: &[usize]) -> bool {
        self.bodies.is_empty() || bodies.iter().any(|b| self.bodies.contains(b))
    }

    /// The same wall with the material on its right.
    pub fn facing_right(mut self) -> Self {
        self.normal = Vector2::new(self.tangent.y, -self.tangent.x);
        self
    }

    /// A wall that opens when released.
    pub fn gate(self, opening: Opening) -> Self {
        let solid = match self.solid {
            Solid::Slab { foot, height, thickness, .. } => Solid::Slab { foot, height, thickness, face_only: true },
            other => other,
        };
        Self { solid, opening: Some(opening), ..self }
    }

    /// Reference point: the foot of a wall, the given point of a plane, the first point of a terrain.
    pub fn foot(&self) -> Vector2<f64> {
        match &self.solid {
            Solid::HalfSpace { point } => *point,
            Solid::Slab { foot, .. } => *foot,
            Solid::Terrain { chain } => chain.points()[0].into(),
        }
    }

    /// Height of a wall, m; infinite for a plane and a terrain.
    pub fn height(&self) -> f64 {
        match self.solid {
            Solid::HalfSpace { .. } | Solid::Terrain { .. } => f64::INFINITY,
            Solid::Slab { height, .. } => height,
        }
    }

    /// Extent of a wall behind its face, m; infinite for a plane and a terrain.
    pub fn thickness(&self) -> f64 {
        match self.solid {
            Solid::HalfSpace { .. } | Solid::Terrain { .. } => f64::INFINITY,
            Solid::Slab { thickness, .. } => thickness,
        }
    }

    /// The chain of a terrain.
    pub fn chain(&self) -> Option<&Chain> {
        match &self.solid {
            Solid::Terrain { chain } => Some(chain),
            Solid::HalfSpace { .. } | Solid::Slab { .. } => None,
        }
    }

    /// Distance from the (infinitely extended) face, positive on the material's side, and position along it; m.
    pub fn face_coordinates(&self, x: [f64; 2]) -> (f64, f64) {
        let r = Vector2::from(x) - self.foot();
        (r.dot(&self.normal), r.dot(&self.tangent))
    }

    /// Depth of a point inside the solid, m; zero or less outside.
    pub fn depth(&self, x: [f64; 2]) -> f64 {
        let (d, s) = self.face_coordinates(x);
        match &self.solid {
            Solid::HalfSpace { .. } => -d,
            Solid::Slab { height, thickness, .. } => (-d).min(thickness + d).min(s - self.free_below).min(height - s),
            Solid::Terrain { chain } => -chain.nearest(x).distance,
        }
    }

    /// How the boundary holds a node at `x`, if it does. `tolerance` (m) decides what lies on a surface; `buried` says
    /// that the node lies inside a plane, where walls continue below their foot.
    ///
    /// A boundary that has moved keeps its nodes until it has moved by half a cell (`spacing`, m): they carry its
    /// velocity, so a small stroke acts at once, and a large one advances from node to node.
    pub fn hold(&self, x: [f64; 2], spacing: f64, tolerance: f64, buried: bool) -> Option<Contact> {
        let beyond = self.travel - (self.travel / spacing).map(f64::round) * spacing;
        let (d, s) = self.face_coordinates((Vector2::from(x) + beyond).into());
        if let Solid::Terrain { chain } = &self.solid {
            let near = chain.nearest((Vector2::from(x) + beyond).into());
            return (near.distance <= tolerance).then_some(Contact { normal: near.normal, along: near.along });
        }
        let normal = match self.solid {
            Solid::HalfSpace { .. } => (d <= self.reach(spacing, tolerance)).then_some(self.normal)?,
            Solid::Slab { height, thickness, face_only, .. } => {
                let bottom = match () {
                    () if self.free_below > 0.0 => self.free_below,
                    () if buried => f64::NEG_INFINITY,
                    () => 0.0,
                };
                if d > tolerance || d < -thickness - tolerance || s < bottom - tolerance || s > height + tolerance {
                    return None;
                }
                let (to_face, to_back, to_crest) = (-d, thickness + d, height - s);
                if face_only || to_face <= to_back.min(to_crest) {
                    self.normal
                } else if to_crest <= to_back {
                    self.tangent
                } else {
                    -self.normal
                }
            }
            Solid::Terrain { .. } => return None,
        };
        Some(Contact { normal: normal.into(), along: s })
    }

    /// How far in front of a plane nodes are held, m: those that lie on it. A body between a held and a free row of
    /// nodes bends from the held one on, which, were only nodes behind the plane held, would lie half a cell behind it
    /// on the average of all places of the grid. A clamp therefore holds the rows nearest to its plane; of two that are
    /// as near, the one behind.
    fn reach(&self, spacing: f64, tolerance: f64) -> f64 {
        if self.friction == Friction::Bonded { 0.5 * spacing - tolerance } else { tolerance }
    }

    /// Opens a released gate by what it moves in `dt`, and moves a boundary that has a velocity.
    pub fn advance(&mut self, dt: f64) {
        if self.released
            && let Some(Opening::Lift { speed, opening }) = self.opening
        {
            let lifted = if speed.is_finite() {
                self.free_below + seeded::times(Seed::BoundaryLift, speed) * dt
            } else {
                opening
            };
            self.free_below = lifted.min(opening);
            if self.free_below >= self.height() {
                self.free_below = f64::INFINITY;
            }
        }
        let shift = self.velocity * dt;
        self.travel += shift;
        match &mut self.solid {
            Solid::HalfSpace { point } => *point += shift,
            Solid::Slab { foot, .. } => *foot += shift,
            Solid::Terrain { .. } if shift == Vector2::zeros() => {}
            Solid::Terrain { chain } => Arc::make_mut(chain).shift(shift),
        }
    }

    /// Releases a gate; does nothing to other boundaries.
    pub fn release(&mut self) {
        self.released = self.opening.is_some();
        match self.opening {
            Some(Opening::Vanish) => self.free_below = f64::INFINITY,
            Some(Opening::Lift { .. }) => self.advance(0.0),
            None => {}
        }
    }

    /// Whether the boundary is a gate that was released and is still being lifted.
    pub fn is_opening(&self) -> bool {
        let lifts = matches!(self.opening, Some(Opening::Lift { opening, .. }) if self.free_below < opening);
        self.released && lifts && !self.is_gone()
    }

    /// Whether the boundary holds nothing any more (a gate that is gone).
    pub fn is_gone(&self) -> bool {
        self.free_below == f64::INFINITY
    }
}

#[cfg(test)]
mod tests;
