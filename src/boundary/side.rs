//! The sides of a boundary that material may meet, as contact on the surface knows them.
//!
//! A plane has its face. A wall has face and back, and the narrow sides between them: the top of its crest, and its lower edge where
//! there is an opening below it. Each is a straight piece of surface with two ends; a corner of the wall is where an end of one is an
//! end of the next.

use super::{Boundary, Friction, Opening, Piece, Solid};
use nalgebra::Vector2;

/// What lies within this share of a cell of a node is taken to lie on it: a crossing so near would only divide by small numbers.
pub(super) const NEAR: f64 = 0.05;
/// Walls thinner than this, in cells, are plates: material on one side reaches the nodes of the other, so that what touches is
/// decided by the points.
pub(super) const PLATE: f64 = 2.5;

/// Which side of a boundary.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    Face,
    Back,
    /// The narrow side at the top of a wall.
    Crest,
    /// The narrow side at its lower edge.
    Foot,
}

/// A side of a boundary, as if that were its face.
#[derive(Debug, Clone)]
pub(super) struct Face {
    /// Index of the boundary.
    pub index: usize,
    /// The boundary with this side as its face.
    pub side: Boundary,
    /// Whether the wall is so thin that points decide about contact.
    pub plate: bool,
    /// Which side it is.
    pub part: Part,
    /// Axis of the grid lines that cross it most steeply.
    pub axis: usize,
    /// Which way along it leads out of the boundary, 1 or -1.
    pub toward: f64,
    /// How much nearer to the surface the next node lies along such a line, m.
    pub step: f64,
    /// Distance of such lines along the face, m.
    pub line: f64,
}

impl Face {
    /// The sides of a boundary that contact on the surface knows, on cells of `spacing` (m); `is_free` says where material can be.
    pub fn of(index: usize, b: &Boundary, spacing: f64, is_free: impl Fn(Vector2<f64>) -> bool) -> Vec<Self> {
        if let Some(chain) = b.chain() {
            let plane = |p: &Piece| Boundary::plane("", p.from, p.normal, p.friction);
            return chain.pieces().iter().map(|p| Self::new(index, plane(p), Part::Face, false, spacing)).collect();
        }
        let wall = matches!(b.solid, Solid::Slab { face_only: false, .. });
        let plate = b.height().is_finite() && !b.is_gate() && b.thickness() < PLATE * spacing;
        let mut sides = vec![(b.clone(), Part::Face)];
        if wall {
            sides.push((b.back(), Part::Back));
        }
        if wall && !plate {
            let ends = [(b.crest_side(), Part::Crest), (b.foot_side(), Part::Foot)].into_iter();
            let acts = |(s, _): &(Boundary, Part)| is_free(s.foot()) || is_free(s.foot() + s.tangent * s.height());
            let ends: Vec<_> = ends.filter(acts).collect();
            // Of a beam that is lower than a plate is thick both narrow sides would move the same nodes.
            if ends.len() < 2 || b.height() >= PLATE * spacing {
                sides.extend(ends);
            }
        }
        sides.into_iter().map(|(side, part)| Self::new(index, side, part, plate, spacing)).collect()
    }

    fn new(index: usize, side: Boundary, part: Part, plate: bool, spacing: f64) -> Self {
        let axis = side.normal.iamax();
        Self { index, side, plate, part, axis, toward: 0.0, step: 0.0, line: 0.0 }.along(axis, spacing)
    }

    /// The same on lines of the grid along this axis.
    pub fn along(self, axis: usize, spacing: f64) -> Self {
        let [normal, tangent] = [self.side.normal[axis], self.side.tangent[1 - axis]];
        Self { axis, toward: normal.signum(), step: normal.abs() * spacing, line: spacing / tangent.abs(), ..self }
    }

    /// Within this distance of the face a node lies on it, m.
    pub fn near(&self) -> f64 {
        NEAR * self.step
    }

    /// Whether it lies between face and back of a wall.
    pub fn is_narrow(&self) -> bool {
        matches!(self.part, Part::Crest | Part::Foot)
    }

    /// Whether it is that of a plane.
    pub fn is_plane(&self) -> bool {
        self.side.height().is_infinite()
    }

    /// Where the face crosses the line of the grid through `x`, which is `d` (m) before it.
    pub fn crossing_point(&self, x: [f64; 2], d: f64, spacing: f64) -> Vector2<f64> {
        let mut at = Vector2::from(x);
        at[self.axis] += self.toward * (-d / self.step) * spacing;
        at
    }
}

impl Boundary {
    /// Whether it stands still and lets go: contact on its surface is for such boundaries.
    pub(super) fn is_still(&self) -> bool {
        self.friction != Friction::Bonded && self.velocity == Vector2::zeros()
    }

    /// Whether it is a plane.
    pub(super) fn is_plane(&self) -> bool {
        matches!(self.solid, Solid::HalfSpace { .. })
    }

    /// Whether it is a gate that opens from below.
    pub(super) fn is_lifted(&self) -> bool {
        self.released && matches!(self.opening, Some(Opening::Lift { .. }))
    }

    /// Whether it is a gate, of which only the face acts.
    fn is_gate(&self) -> bool {
        matches!(self.solid, Solid::Slab { face_only: true, .. })
    }

    /// The same wall with another side as its face: where that begins, its direction and normal, its length (m).
    fn with_face(&self, begin: Vector2<f64>, tangent: Vector2<f64>, normal: Vector2<f64>, length: f64) -> Self {
        let mut side = Self { normal, tangent, ..self.clone() };
        if let Solid::Slab { foot, height, .. } = &mut side.solid {
            (*foot, *height) = (begin, length);
        }
        side
    }

    /// The back of a wall, as a face.
    fn back(&self) -> Self {
        self.with_face(self.foot() - self.normal * self.thickness(), self.tangent, -self.normal, self.height())
    }

    /// The top of a wall, from its face to its back, as a face.
    fn crest_side(&self) -> Self {
        self.with_face(self.foot() + self.tangent * self.height(), -self.normal, self.tangent, self.thickness())
    }

    /// The lower edge of a wall, from its face to its back, as a face.
    fn foot_side(&self) -> Self {
        self.with_face(self.foot(), -self.normal, -self.tangent, self.thickness())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The sides of a wall that stands at (1, 2), 4 m high, on cells of 0.1 m, if only places above `ground` (m) are free.
    fn sides(wall: &Boundary, ground: f64) -> Vec<(Part, Vector2<f64>, Vector2<f64>, f64)> {
        let all = Face::of(0, wall, 0.1, |x| x.y > ground);
        all.into_iter().map(|f| (f.part, f.side.foot(), f.side.normal, f.side.height())).collect()
    }

    #[test]
    fn a_wall_has_narrow_sides_where_material_can_be() {
        let (at, up) = (Vector2::new, Vector2::new(0.0, 1.0));
        let wall = |thickness: f64| Boundary::wall("wall", at(1.0, 2.0), up, 4.0, thickness, Friction::Smooth);
        let all = [
            (Part::Face, at(1.0, 2.0), at(-1.0, 0.0), 4.0),
            (Part::Back, at(1.5, 2.0), at(1.0, 0.0), 4.0),
            (Part::Crest, at(1.0, 6.0), at(0.0, 1.0), 0.5),
            (Part::Foot, at(1.0, 2.0), at(0.0, -1.0), 0.5),
        ];
        assert_eq!(sides(&wall(0.5), 0.0), all);
        assert_eq!(sides(&wall(0.5), 2.0), all[..3], "it stands on the ground");
        assert_eq!(sides(&wall(0.2), 0.0).len(), 2, "a plate ends in a line");
        assert_eq!(sides(&wall(0.5).gate(Opening::Vanish), 0.0).len(), 1);
        let mirrored = sides(&wall(0.5).facing_right(), 0.0);
        assert_eq!(mirrored[3], (Part::Foot, at(1.0, 2.0), at(0.0, -1.0), 0.5));
        let tangent = Face::of(0, &wall(0.5).facing_right(), 0.1, |_| true)[2].side.tangent;
        assert_eq!(tangent, at(-1.0, 0.0), "from the face to the back");
    }
}
