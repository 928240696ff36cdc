//! Rigid boundaries: the `[[boundaries]]` tables of a case file, and the same as types that cannot be inconsistent.
//!
//! A word that stands for itself is the solver's own enum, read by serde: shape function, scheme, cone, `boundary_contact`,
//! `opened_volume`. A word that has numbers beside it is spelled twice: [`ContactKind`] becomes [`Friction`], [`OpeningKind`]
//! [`Opening`], [`BoundaryKind`] [`Shape`]. In the file the numbers are keys of the same table, so that one that is missing, misspelt or
//! out of place is reported on its own line, and serde cannot read an enum with fields out of a table that refuses unknown keys
//! (`flatten` and `deny_unknown_fields` exclude each other). In the solver a variant holds its numbers, so that it cannot lack them.

use serde::{Deserialize, Serialize};

use super::grid::Grid;
use crate::boundary::{Chain, Friction, Opening};
use crate::seeded::{self, Seed};

/// A rigid boundary. Which of its fields are required, and which refused, depends on `kind`, `contact` and `opening`.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Boundary {
    /// Name. Allowed: not empty, and different from that of every other boundary. Example: `"base"`.
    pub name: String,
    /// Plane, wall, gate or polyline. Example: `"plane"`.
    pub kind: BoundaryKind,
    /// A point on the surface of a plane. Default: none; required by `kind = "plane"`. Allowed: only with `kind =
    /// "plane"`; `[x, y]`. Example: `[0.0, 0.0]`.
    pub point_m: Option<[f64; 2]>,
    /// Direction of the outward normal of a plane, into the material, from the x axis, counter-clockwise. Default:
    /// none; required by `kind = "plane"`. Allowed: only with `kind = "plane"`; -360 to 360. Example: `90`.
    pub normal_deg: Option<f64>,
    /// Lower end of the face that meets the material. Default: none; required by `kind = "wall"` and `"gate"`. Allowed:
    /// only with `kind = "wall"` or `"gate"`; `[x, y]`. Example: `[1.2, 0.0]`.
    pub foot_m: Option<[f64; 2]>,
    /// Distance from foot to crest. Default: none; required by `kind = "wall"` and `"gate"`. Allowed: only with `kind =
    /// "wall"` or `"gate"`; above 0. Example: `0.6`.
    pub height_m: Option<f64>,
    /// Direction from foot to crest, from the x axis, counter-clockwise. Default: `90.0`. Allowed: only with `kind =
    /// "wall"` or `"gate"`; -360 to 360. Example: `120`.
    pub inclination_deg: Option<f64>,
    /// The side of the face on which the material is, seen from foot to crest; of a polyline, seen along its points. Default: `"left"`.
    /// Allowed: not with `kind = "plane"`. Example: `"right"`.
    pub material_side: Option<MaterialSide>,
    /// Thickness on the side away from the material. Default: four cells. Allowed: only with `kind = "wall"` or
    /// `"gate"`; 0 or more, and with `numerics.boundary_contact = "nodes"` at least three cells, a gate one. Example: `0.1`.
    pub thickness_m: Option<f64>,
    /// Points of a polyline, in order. Its first and its last piece go on straight beyond their ends. Default: none; required by `kind =
    /// "polyline"`, if no file has them. Allowed: only with `kind = "polyline"`; 2 to 1000 pairs `[x, y]`, pieces that neither cross nor
    /// touch. Example: `[[0.0, 0.4], [0.6, 0.1], [1.5, 0.0]]`.
    pub points_m: Option<Vec<[f64; 2]>>,
    /// CSV file that has these points, in columns `x_m` and `y_m` under these names; relative to the case file. Default: none. Allowed:
    /// only with `kind = "polyline"`, instead of `points_m`; not in studies. Example: `"terrain.csv"`.
    pub points_file: Option<String>,
    /// Names of the bodies that it acts on; bodies that no `[[contacts]]` names move as one, so what holds one of them holds all.
    /// Default: all bodies. Allowed: at least one name of `[[bodies]]`. Example:
    /// `["sand"]`.
    pub bodies: Option<Vec<String>>,
    /// Contact law. Only a clamp holds back material that moves away. Example: `"coulomb"`.
    pub contact: ContactKind,
    /// Coulomb friction coefficient, not an angle. Default: none; required by `contact = "coulomb"`. Allowed: only with
    /// `contact = "coulomb"`; 0 or more. Example: `0.4`.
    pub friction: Option<f64>,
    /// The same of each piece of a polyline, in order. Default: none, `friction` on all. Allowed: only with `kind = "polyline"`, instead of
    /// `friction`; as many as there are pieces, each 0 or more. Example: `[0.4, 0.6]`.
    pub friction_by_piece: Option<Vec<f64>>,
    /// Slip over which friction is mobilised: the traction grows in proportion to the elastic slip and reaches static friction at this
    /// one. Sand on steel or glass needs 3e-4 to 1e-3 m. Default: none, full friction without slip. Allowed: 0 or more; only with
    /// `contact = "coulomb"` and `numerics.boundary_contact = "surface"`, and not for `kind = "gate"`. Example: `5.0e-4`.
    pub slip_length_m: Option<f64>,
    /// Friction coefficient of material that has not slid. It falls to `friction` over one slip length of sliding, and comes back over
    /// one slip length of elastic slip. Default: that of `friction`. Allowed: at least `friction`; only with a `slip_length_m` above 0.
    /// Example: `0.5`.
    pub static_friction: Option<f64>,
    /// How a gate opens. Default: `"vanish"`. Allowed: only with `kind = "gate"`. Example: `"lift"`.
    pub opening: Option<OpeningKind>,
    /// Speed of a gate that lifts or is raised. Default: none; required by `opening = "lift"`, and a raised gate without it
    /// opens at once. Allowed: only with `opening = "lift"` or `"raise"`; above 0. Example: `1.0`.
    pub lift_speed_m_per_s: Option<f64>,
    /// The free height below a raised gate, at which it is held. Default: none; required by `opening = "raise"`.
    /// Allowed: only with `opening = "raise"`; above 0. Example: `0.05`.
    pub opening_m: Option<f64>,
}

/// Kind of boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum BoundaryKind {
    /// An infinite half space.
    Plane,
    /// A rectangle with a foot, a height and a thickness.
    Wall,
    /// A wall that opens when the run starts.
    Gate,
    /// Terrain: everything on one side of a chain of straight pieces.
    Polyline,
}

/// The side of a wall on which the material is, seen from foot to crest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum MaterialSide {
    /// To the left: at smaller x for a vertical wall.
    #[default]
    Left,
    /// To the right.
    Right,
}

/// Contact law as written in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum ContactKind {
    /// No friction.
    Smooth,
    /// Coulomb friction.
    Coulomb,
    /// No slip while pressed.
    Rough,
    /// No motion at all: a clamp.
    Bonded,
}

/// How a gate opens, as written in the file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum OpeningKind {
    /// Disappears at release.
    #[default]
    Vanish,
    /// Moves away along its face.
    Lift,
    /// Moves along its face until a given height is free below it, and stays there.
    Raise,
}

/// Geometry of a boundary.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// The half space behind the point, away from the normal.
    Plane {
        /// A point on the surface, m.
        point_m: [f64; 2],
        /// Direction of the normal into the material, degrees from the x axis, counter-clockwise.
        normal_deg: f64,
    },
    /// A fixed wall.
    Wall(Wall),
    /// A wall that opens at release.
    Gate(Wall, Opening),
    /// Everything on the right of a chain of pieces.
    Terrain(Chain),
}

/// A wall: a rectangle behind the face from foot to crest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// Lower end of the face, m.
    pub foot_m: [f64; 2],
    /// Distance from foot to crest, m.
    pub height_m: f64,
    /// Direction from foot to crest, degrees from the x axis, counter-clockwise.
    pub inclination_deg: f64,
    /// The side on which the material is.
    pub material_side: MaterialSide,
    /// Thickness away from the material, m.
    pub thickness_m: f64,
}

/// Coulomb friction of this coefficient.
fn coulomb(friction: f64) -> Friction {
    Friction::Coulomb(seeded::times(Seed::CaseFriction, friction))
}

impl Boundary {
    /// Thickness of walls and gates that give none, in cells.
    pub const DEFAULT_THICKNESS_CELLS: f64 = 4.0;

    /// Geometry with the defaults filled in; `None` if a required field is missing, which validation refuses.
    pub fn shape(&self, grid: &Grid) -> Option<Shape> {
        match self.kind {
            BoundaryKind::Plane => Some(Shape::Plane { point_m: self.point_m?, normal_deg: self.normal_deg? }),
            BoundaryKind::Wall => Some(Shape::Wall(self.wall(grid)?)),
            BoundaryKind::Gate => Some(Shape::Gate(self.wall(grid)?, self.opening_law()?)),
            BoundaryKind::Polyline => Some(Shape::Terrain(self.chain()?)),
        }
    }

    /// The word of the file and the coefficient beside it as one; `None` if a required field is missing, which validation
    /// refuses.
    pub fn contact_law(&self) -> Option<Friction> {
        match self.contact {
            ContactKind::Smooth => Some(Friction::Smooth),
            ContactKind::Coulomb => {
                let first = self.friction_by_piece.as_ref().and_then(|each| each.first().copied());
                Some(coulomb(self.friction.or(first)?))
            }
            ContactKind::Rough => Some(Friction::Rough),
            ContactKind::Bonded if seeded::is(Seed::CaseClamp) => Some(Friction::Rough),
            ContactKind::Bonded => Some(Friction::Bonded),
        }
    }

    /// The pieces of a polyline, with material on their left, each with its friction.
    fn chain(&self) -> Option<Chain> {
        let mut points = self.points_m.clone()?;
        let pieces = points.len().saturating_sub(1);
        let mut frictions = match &self.friction_by_piece {
            Some(each) => each.iter().map(|f| coulomb(*f)).collect(),
            None => vec![self.contact_law()?; pieces],
        };
        if self.material_side.unwrap_or_default() == MaterialSide::Right {
            points.reverse();
            frictions.reverse();
        }
        if seeded::is(Seed::CaseTerrain) {
            frictions.reverse();
        }
        Chain::new(points, &frictions)
    }

    /// Slip length (m) and static coefficient, where friction needs slip.
    pub fn slip(&self) -> Option<[f64; 2]> {
        let length = self.slip_length_m.filter(|l| *l > 0.0)?;
        let given = self.static_friction.filter(|_| !seeded::is(Seed::CaseStaticFriction));
        Some([length, given.or(self.friction)?])
    }

    /// Whether it acts on the body of this name.
    pub fn acts_on(&self, body: &str) -> bool {
        self.bodies.as_ref().is_none_or(|names| names.iter().any(|name| name == body))
    }

    pub(super) fn wall(&self, grid: &Grid) -> Option<Wall> {
        Some(Wall {
            foot_m: self.foot_m?,
            height_m: self.height_m?,
            inclination_deg: self.inclination_deg.unwrap_or(90.0),
            material_side: self.material_side.unwrap_or_default(),
            thickness_m: self.thickness_m.unwrap_or(Self::DEFAULT_THICKNESS_CELLS * grid.spacing_m),
        })
    }

    fn opening_law(&self) -> Option<Opening> {
        match self.opening.unwrap_or_default() {
            OpeningKind::Vanish => Some(Opening::Vanish),
            OpeningKind::Lift if seeded::is(Seed::CaseLift) => Some(Opening::Vanish),
            OpeningKind::Lift => Some(Opening::Lift { speed: self.lift_speed_m_per_s?, opening: f64::INFINITY }),
            OpeningKind::Raise => Some(Opening::Lift {
                speed: self.lift_speed_m_per_s.unwrap_or(f64::INFINITY),
                opening: if seeded::is(Seed::CaseOpening) { f64::INFINITY } else { self.opening_m? },
            }),
        }
    }

    pub(super) fn resolve(&mut self, grid: &Grid) {
        if self.kind == BoundaryKind::Polyline {
            self.material_side.get_or_insert_default();
        }
        if let Some(wall) = self.wall(grid).filter(|_| [BoundaryKind::Wall, BoundaryKind::Gate].contains(&self.kind)) {
            self.inclination_deg = Some(wall.inclination_deg);
            self.material_side = Some(wall.material_side);
            self.thickness_m = Some(wall.thickness_m);
        }
        if self.kind == BoundaryKind::Gate {
            self.opening.get_or_insert_default();
        }
    }
}
