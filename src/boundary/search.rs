//! Which nodes of the grid a boundary holds, and where its surface crosses the lines of the grid.
//!
//! Elsewhere: contact detection; nodes inside and cut cells of an immersed boundary.

use super::chain::SMOOTH;
use super::nodes::Hold;
use super::side::{Face, NEAR, Part};
use super::surface::{End, Site};
use super::{Boundary, BoundaryContact, Contact};
use crate::grid::ActiveGrid;
use crate::seeded::{self, Seed};
use nalgebra::Vector2;

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
    /// Of the boundaries that act on their surface, in their order.
    faces: Vec<Face>,
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
    let mut search = Search { boundaries, bodies, grid, faces: Vec::new(), tolerance: 1e-6 * grid.spacing, contact };
    if contact == BoundaryContact::Surface {
        let still = search.acting().filter(|(_, b)| b.is_still());
        let is_free = |x: Vector2<f64>| !search.is_buried(x.into(), -search.tolerance);
        search.faces = still.flat_map(|(index, b)| Face::of(index, b, grid.spacing, is_free)).collect();
    }
    for (node, x) in grid.nodes() {
        for (index, _) in search.acting() {
            let first = search.faces.partition_point(|f| f.index < index);
            let own = &search.faces[first..][..search.faces[first..].partition_point(|f| f.index == index)];
            match (own.is_empty(), boundaries[index].chain()) {
                (true, _) => found.holds.extend(search.at_node(node, x, index)),
                (false, Some(chain)) => search.on_terrain(node, x, own, chain, found),
                (false, None) => search.on_surface(node, x, own, found),
            }
        }
    }
}

mod terrain;

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
        let smooth = |b: &Boundary| b.is_still() && b.is_plane() && b.normal.dot(&own.normal) > SMOOTH;
        let mut others = self.acting().filter(|(other, b)| *other != index && smooth(b));
        let depth = own.depth(x);
        others.any(|(other, b)| {
            let more = b.depth(x) - depth;
            // Of two that coincide the first counts.
            more > self.tolerance || (more >= -self.tolerance && other < index)
        })
    }

    /// What a boundary with these faces does to the node: the crossing between it and the next one before a face; else the node
    /// itself, on a face or inside.
    fn on_surface(&self, node: usize, x: [f64; 2], faces: &[Face], found: &mut Found) {
        let before = found.sites.len();
        for face in faces {
            let (d, _) = face.side.face_coordinates(x);
            let first = d <= face.near() && d + face.step > face.near();
            if !first {
                continue;
            }
            let at = face.crossing_point(x, d, self.grid.spacing);
            if face.is_plane() && d < -face.near() && self.is_of_another(at.into(), face.index) {
                let mut next = Vector2::from(x);
                next[face.axis] += face.toward * self.grid.spacing;
                // The other plane has the crossing on this piece of the line.
                if !self.is_buried(next.into(), -face.near()) {
                    return;
                }
            } else {
                found.sites.extend(self.crossing(node, x, face, at, d));
            }
        }
        let Some(face) = faces.first() else { return };
        let crossed = found.sites.len() > before;
        if face.plate || face.is_plane() && (crossed || self.is_of_another(x, face.index)) {
            return;
        }
        // At a corner a node may lie on one side and behind another.
        let apart = if crossed { -NEAR * self.grid.spacing } else { self.tolerance };
        for face in faces {
            let (d, s) = face.side.face_coordinates(x);
            let own = found.sites[before..].iter().any(|site| site.normal == <[f64; 2]>::from(face.side.normal));
            if d > apart && d.abs() <= face.near() && !own && self.is_on_face(face, x, s, 0.0) {
                let b = &self.boundaries[face.index];
                let along = if face.is_narrow() { b.face_coordinates(x).1 } else { s };
                let contact = Contact { normal: face.side.normal.into(), along };
                self.hold(Hold::new(node, x, face.index, b, contact, true), x, found);
                return;
            }
        }
        if !crossed {
            self.inside(node, x, faces).into_iter().for_each(|hold| self.hold(hold, x, found));
        }
    }

    /// Adds what holds the node at `x`: where friction needs slip, as a crossing that remembers it.
    fn hold(&self, hold: Hold, x: [f64; 2], found: &mut Found) {
        let own = &self.boundaries[hold.boundary as usize];
        match own.slip {
            Some(_) => found.sites.push(Site::at_node(&hold, x, own)),
            None => found.holds.push(hold),
        }
    }

    /// A node inside a boundary with these faces, on none of them and not the first behind one.
    fn inside(&self, node: usize, x: [f64; 2], faces: &[Face]) -> Option<Hold> {
        let face = faces.first()?;
        let (_, s) = face.side.face_coordinates(x);
        let half = 0.5 * face.line;
        // What passes beside an end of a wall passes along all of it, unless that has a lower edge of its own.
        let edge = faces.iter().any(|f| f.part == Part::Foot);
        if !edge && self.end(&face.side, s, half) == Some(End::Foot) && !face.side.is_lifted() {
            return None;
        }
        let hold = self.at_node(node, x, face.index)?.clear_of_edge(half);
        // `Boundary::hold` knows no lower edge.
        let depth = |f: &Face| -f.side.face_coordinates(x).0;
        let nearest = faces[1..].iter().fold(face, |near, f| if depth(f) < depth(near) { f } else { near });
        Some(if nearest.part == Part::Foot { hold.toward(nearest.side.normal.into()) } else { hold })
    }

    /// Whether a place on the face, at `s` (m) along it, belongs to it, or lies at most `beyond` (m) off its ends.
    fn is_on_face(&self, face: &Face, x: [f64; 2], s: f64, beyond: f64) -> bool {
        let b = &face.side;
        let buried = || b.free_below <= 0.0 && !face.is_narrow() && self.is_buried(x, -self.tolerance);
        let bottom = if face.is_plane() || buried() { f64::NEG_INFINITY } else { 0.0 };
        let reach = beyond + self.tolerance;
        (bottom - reach..=b.height() + reach).contains(&s)
    }

    /// The end of the face that is less than `half` (m) away from a place on it at `s` (m), if material can pass there. A gate that
    /// is lifted has one at all its places.
    fn end(&self, b: &Boundary, s: f64, half: f64) -> Option<End> {
        let foot = b.foot() + b.tangent * b.free_below.max(0.0);
        let reach = half + self.tolerance;
        match () {
            () if b.height().is_infinite() => None,
            () if b.is_lifted() => Some(End::Foot),
            () if s.abs() < reach && !self.is_buried(foot.into(), -self.tolerance) => Some(End::Foot),
            () if (s - b.height()).abs() < reach => Some(End::Crest),
            () => None,
        }
    }

    /// The nodes beside a place on a line of the grid that crosses a face, the one behind first, and their shares; `node` at `x` lies
    /// on a line beside it or on the same.
    fn between(&self, node: usize, x: [f64; 2], at: Vector2<f64>, face: &Face) -> Option<([usize; 2], [f64; 2])> {
        let Face { axis, toward, .. } = *face;
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
        let share = if seeded::is(Seed::BoundaryCrossing) { (share + 0.05).min(1.0) } else { share };
        Some(([first, self.grid.find(place)?], [1.0 - share, share]))
    }

    /// The crossing at `at` of a face with the line of the grid from the node, which is `d` (m) before the face or behind it, to the
    /// next one before it. Where the face passes through the node only if it is that of a plate, or near an end of it.
    fn crossing(&self, node: usize, x: [f64; 2], face: &Face, at: Vector2<f64>, d: f64) -> Option<Site> {
        let (side, half) = (&face.side, 0.5 * face.line);
        let (_, along) = side.face_coordinates(at.into());
        let end = self.end(side, along, half);
        let off = face.plate || end.is_some() || d < -face.near() || side.slip.is_some();
        if !off || !self.is_on_face(face, at.into(), along, if end.is_some() { half } else { 0.0 }) {
            return None;
        }
        let (nodes, shares) = self.between(node, x, at, face)?;
        let b = &self.boundaries[face.index];
        let on_wall = if face.is_narrow() { b.face_coordinates(at.into()).1 } else { along };
        let places = [along, on_wall];
        let site = Site::new(nodes, shares, face.index, side, (places, at.into(), b.foot().into()), face.plate);
        let Some(end) = end else { return Some(site) };
        let beyond = at + side.tangent * if end == End::Foot { -face.line } else { face.line };
        // Nothing passes where there is no line between the end of the wall and what it stands on.
        let open = end == End::Crest || !self.is_buried(beyond.into(), self.tolerance);
        match self.between(node, x, beyond, face).filter(|_| open) {
            Some(next) => Some(site.beside(end, next, half)),
            None => Some(site),
        }
    }
}
