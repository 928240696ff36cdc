//! Which nodes of the grid a boundary holds, and where its surface crosses the lines of the grid.

use super::nodes::Hold;
use super::surface::{End, Site};
use super::{Boundary, BoundaryContact, Contact, Friction, Opening, Solid};
use crate::grid::ActiveGrid;
use nalgebra::Vector2;

/// What lies within this share of a cell of a node is taken to lie on it: a crossing so near would only divide by small numbers.
const NEAR: f64 = 0.05;
/// Walls thinner than this, in cells, are plates: material on one side reaches the nodes of the other, so that what touches is
/// decided by the points.
const PLATE: f64 = 2.5;
/// Planes whose normals have a larger scalar product than this are pieces of one surface; others make a corner.
const SMOOTH: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// What holds the nodes of a grid.
#[derive(Debug, Clone, Default)]
pub struct Found {
    /// At single nodes, in the order of the nodes.
    pub holds: Vec<Hold>,
    /// Between two nodes, in the order of the nodes behind the surface.
    pub sites: Vec<Site>,
}

/// A search on one grid.
struct Search<'a> {
    boundaries: &'a [Boundary],
    bodies: &'a [usize],
    grid: &'a ActiveGrid,
    tolerance: f64,
    contact: BoundaryContact,
}

/// Finds what boundaries that act on any of `bodies` hold on the nodes of `grid`.
pub fn find_holds(
    boundaries: &[Boundary],
    bodies: &[usize],
    grid: &ActiveGrid,
    contact: BoundaryContact,
    found: &mut Found,
) {
    found.holds.clear();
    found.sites.clear();
    let search = Search { boundaries, bodies, grid, tolerance: 1e-6 * grid.spacing, contact };
    for (node, x) in grid.nodes() {
        for (index, b) in search.acting() {
            match contact == BoundaryContact::Surface && b.is_still() {
                true => search.on_surface(node, x, index, found),
                false => found.holds.extend(search.at_node(node, x, index)),
            }
        }
    }
}

impl<'a> Search<'a> {
    fn acting(&self) -> impl Iterator<Item = (usize, &'a Boundary)> {
        self.boundaries.iter().enumerate().filter(|(_, b)| b.acts_on(self.bodies))
    }

    /// Whether a place lies inside a plane, where walls continue below their foot, at least so deep (m).
    fn is_buried(&self, x: [f64; 2], depth: f64) -> bool {
        self.acting().any(|(_, b)| b.height().is_infinite() && b.depth(x) >= depth)
    }

    /// The node itself, if the boundary holds it.
    fn at_node(&self, node: usize, x: [f64; 2], index: usize) -> Option<Hold> {
        let b = &self.boundaries[index];
        let contact = b.hold(x, self.grid.spacing, self.tolerance, self.is_buried(x, -self.tolerance))?;
        Some(Hold::new(node, x, index, b, contact, self.contact == BoundaryContact::Surface))
    }

    /// Whether the surface at `x` in or on plane number `index` is that of another plane, which goes on from it without a corner and
    /// has `x` deeper inside by more than the tolerance.
    fn is_of_another(&self, x: [f64; 2], index: usize) -> bool {
        let own = &self.boundaries[index];
        let smooth = |b: &Boundary| b.is_still() && b.height().is_infinite() && b.normal.dot(&own.normal) > SMOOTH;
        let others = self.acting().filter(|(other, b)| *other != index && smooth(b));
        let depth = own.depth(x);
        others.into_iter().any(|(other, b)| {
            let more = b.depth(x) - depth;
            // Of two that coincide the first counts.
            more > self.tolerance || (more >= -self.tolerance && other < index)
        })
    }

    /// The node, if it lies on the surface or deeper than the first one behind it; the crossing before it otherwise.
    fn on_surface(&self, node: usize, x: [f64; 2], index: usize, found: &mut Found) {
        let b = &self.boundaries[index];
        if b.is_plate(self.grid.spacing) {
            found.sites.extend(self.crossing(node, x, index, b, true));
            found.sites.extend(self.crossing(node, x, index, &b.back(), true));
            return;
        }
        let (d, s) = b.face_coordinates(x);
        let near = NEAR * self.step(b);
        if b.height().is_infinite() && d <= near && self.is_of_another(x, index) {
            return;
        }
        if let Some(site) = self.crossing(node, x, index, b, false) {
            found.sites.push(site);
        } else if d < -near || d <= self.tolerance {
            // What passes beside an end of a wall passes along all of it.
            let line = self.grid.spacing / b.tangent[1 - b.normal.iamax()].abs();
            let passes = self.end(b, s, 0.5 * line) == Some(End::Foot) && !b.is_lifted();
            if !passes {
                let hold = self.at_node(node, x, index);
                found.holds.extend(hold.map(|h| h.clear_of_edge(0.5 * line)));
            }
        } else if d <= near && self.is_on_face(b, x, s, 0.0) {
            let contact = Contact { normal: b.normal.into(), along: s };
            found.holds.push(Hold::new(node, x, index, b, contact, true));
        }
    }

    /// How much nearer to the surface the next node lies along the line that crosses it most steeply, m.
    fn step(&self, b: &Boundary) -> f64 {
        b.normal[b.normal.iamax()].abs() * self.grid.spacing
    }

    /// Whether a place on the face, at `s` (m) along it, belongs to it, or lies at most `beyond` (m) off its ends.
    fn is_on_face(&self, b: &Boundary, x: [f64; 2], s: f64, beyond: f64) -> bool {
        let bottom = if b.free_below <= 0.0 && self.is_buried(x, -self.tolerance) {
            f64::NEG_INFINITY
        } else {
            b.free_below.min(0.0)
        };
        let reach = beyond + self.tolerance;
        (bottom - reach..=b.height() + reach).contains(&s)
    }

    /// The end of the face that is less than `half` (m) away from a place on it at `s` (m), if material can pass there. A gate that
    /// is lifted has one at all its places.
    fn end(&self, b: &Boundary, s: f64, half: f64) -> Option<End> {
        let foot = b.foot() + b.tangent * b.free_below.max(0.0);
        let reach = half - self.tolerance;
        match () {
            () if b.height().is_infinite() => None,
            () if b.is_lifted() => Some(End::Foot),
            () if s.abs() < reach && !self.is_buried(foot.into(), -self.tolerance) => Some(End::Foot),
            () if (s - b.height()).abs() < reach => Some(End::Crest),
            () => None,
        }
    }

    /// The nodes beside a place on a line of the grid, the first of them on the side that `toward` points away from, and their
    /// shares; `node` lies on a line beside it or on the same.
    fn between(
        &self,
        node: usize,
        x: [f64; 2],
        at: Vector2<f64>,
        axis: usize,
        toward: f64,
    ) -> Option<([usize; 2], [f64; 2])> {
        let cells = (at - Vector2::from(x)) / self.grid.spacing;
        let mut place = self.grid.place(node);
        place[1 - axis] += cells[1 - axis].round() as i64;
        let ahead = cells[axis] * toward;
        let (mut behind, mut share) = (ahead.floor(), ahead - ahead.floor());
        if share > 1.0 - NEAR {
            (behind, share) = (behind + 1.0, 0.0);
        } else if share < NEAR {
            share = 0.0;
        }
        place[axis] += (behind * toward) as i64;
        let first = self.grid.find(place)?;
        place[axis] += toward as i64;
        Some(([first, self.grid.find(place)?], [1.0 - share, share]))
    }

    /// Where the face crosses the line of the grid from the node to the next one before the face. Where it passes through the node
    /// only if it is that of a plate, or near an end of it.
    fn crossing(&self, node: usize, x: [f64; 2], index: usize, face: &Boundary, plate: bool) -> Option<Site> {
        let axis = face.normal.iamax();
        let (d, _) = face.face_coordinates(x);
        let (step, toward) = (self.step(face), face.normal[axis].signum());
        let near = NEAR * step;
        if d > near || d + step <= near {
            return None;
        }
        let mut at = Vector2::from(x);
        at[axis] += toward * (-d / step) * self.grid.spacing;
        let (_, along) = face.face_coordinates(at.into());
        let line = self.grid.spacing / face.tangent[1 - axis].abs();
        let end = self.end(face, along, 0.5 * line);
        let off = plate || end.is_some() || d < -near;
        let own = self.is_on_face(face, at.into(), along, if end.is_some() { 0.5 * line } else { 0.0 });
        let plane = face.height().is_infinite();
        if !off || !own || (plane && self.is_of_another(at.into(), index)) {
            return None;
        }
        let (nodes, shares) = self.between(node, x, at, axis, toward)?;
        let site = Site::new(nodes, shares, index, face, (along, at.into()), plate);
        let Some(end) = end else { return Some(site) };
        let beyond = at + face.tangent * if end == End::Foot { -line } else { line };
        // Nothing passes where there is no line between the end of the wall and what it stands on.
        let open = end == End::Crest || !self.is_buried(beyond.into(), self.tolerance);
        match self.between(node, x, beyond, axis, toward).filter(|_| open) {
            Some(next) => Some(site.beside(end, next, 0.5 * line)),
            None => Some(site),
        }
    }
}

impl Boundary {
    /// Whether it stands still and lets go: contact on its surface is for such boundaries.
    fn is_still(&self) -> bool {
        self.friction != Friction::Bonded && self.velocity == Vector2::zeros()
    }

    /// Whether it is a gate that opens from below.
    fn is_lifted(&self) -> bool {
        self.released && matches!(self.opening, Some(Opening::Lift { .. }))
    }

    /// Whether it is a wall so thin for cells of this size (m) that material on one side reaches the nodes of the other.
    fn is_plate(&self, spacing: f64) -> bool {
        matches!(self.solid, Solid::Slab { thickness, face_only: false, .. } if thickness < PLATE * spacing)
    }

    /// The back of a wall, as a face.
    fn back(&self) -> Self {
        let mut back = self.clone();
        if let Solid::Slab { foot, thickness, .. } = &mut back.solid {
            *foot -= self.normal * *thickness;
        }
        back.normal = -self.normal;
        back
    }
}
