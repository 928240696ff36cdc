//! Which nodes of the grid a boundary holds, and where its surface crosses the lines of the grid.

use super::nodes::Hold;
use super::surface::Site;
use super::{Boundary, BoundaryContact, Contact, Friction, Solid};
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

    /// Whether a place lies inside a plane, where walls continue below their foot.
    fn is_buried(&self, x: [f64; 2]) -> bool {
        self.acting().any(|(_, b)| b.height().is_infinite() && b.depth(x) >= -self.tolerance)
    }

    /// The node itself, if the boundary holds it.
    fn at_node(&self, node: usize, x: [f64; 2], index: usize) -> Option<Hold> {
        let b = &self.boundaries[index];
        let contact = b.hold(x, self.grid.spacing, self.tolerance, self.is_buried(x))?;
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
        match b.solid {
            Solid::Slab { thickness, face_only: false, .. } if thickness < PLATE * self.grid.spacing => {
                let back = b.back(thickness);
                found.sites.extend(self.crossing(node, x, index, b, true));
                found.sites.extend(self.crossing(node, x, index, &back, true));
            }
            _ => {
                let (d, s) = b.face_coordinates(x);
                let step = self.step(b);
                if b.height().is_infinite() && d <= NEAR * step && self.is_of_another(x, index) {
                    return;
                }
                if let Some(site) = self.crossing(node, x, index, b, false) {
                    found.sites.push(site);
                } else if d <= self.tolerance {
                    found.holds.extend(self.at_node(node, x, index));
                } else if d <= NEAR * step && self.is_on_face(b, x, s) {
                    let contact = Contact { normal: b.normal.into(), along: s };
                    found.holds.push(Hold::new(node, x, index, b, contact, true));
                }
            }
        }
    }

    /// How much nearer to the surface the next node lies along the line that crosses it most steeply, m.
    fn step(&self, b: &Boundary) -> f64 {
        b.normal[b.normal.iamax()].abs() * self.grid.spacing
    }

    /// Whether a place on the face, at `s` (m) along it, belongs to it.
    fn is_on_face(&self, b: &Boundary, x: [f64; 2], s: f64) -> bool {
        let bottom = if b.free_below <= 0.0 && self.is_buried(x) { f64::NEG_INFINITY } else { b.free_below };
        (bottom - self.tolerance..=b.height() + self.tolerance).contains(&s)
    }

    /// Where the face crosses the line of the grid from the node to the next one before the face. Of a plate, also where it passes
    /// through the node.
    fn crossing(&self, node: usize, x: [f64; 2], index: usize, face: &Boundary, plate: bool) -> Option<Site> {
        let spacing = self.grid.spacing;
        let axis = face.normal.iamax();
        let (d, _) = face.face_coordinates(x);
        let (step, toward) = (self.step(face), face.normal[axis].signum());
        let near = NEAR * step;
        if d > near || d + step <= near || (!plate && d >= -near) {
            return None;
        }
        let mut place = self.grid.place(node);
        place[axis] += toward as i64;
        let before = self.grid.find(place)?;
        let share = if d >= -near { 0.0 } else { -d / step };
        let mut at = Vector2::from(x);
        at[axis] += toward * (-d / step) * spacing;
        let (_, along) = face.face_coordinates(at.into());
        if !self.is_on_face(face, at.into(), along) || (!plate && face.height().is_infinite() && self.is_of_another(at.into(), index)) {
            return None;
        }
        Some(Site::new([node, before], [1.0 - share, share], index, face, (along, at.into()), plate))
    }
}

impl Boundary {
    /// Whether it stands still and lets go: contact on its surface is for such boundaries.
    fn is_still(&self) -> bool {
        self.friction != Friction::Bonded && self.velocity == Vector2::zeros()
    }

    /// The back of a wall of this thickness (m), as a face.
    fn back(&self, thickness: f64) -> Self {
        let mut back = self.clone();
        if let Solid::Slab { foot, .. } = &mut back.solid {
            *foot -= self.normal * thickness;
        }
        back.normal = -self.normal;
        back
    }
}
