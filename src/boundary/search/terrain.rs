//! Where a chain of pieces crosses the lines of the grid, and which nodes lie in the ground behind it.
//!
//! Each piece is crossed by the lines along the axis to which its normal is nearer. Beside a corner between a flat piece and a steep one there
//! may be a node that neither finds; it has the crossing that is left. Deeper nodes are held as nodes are, by the piece that is nearest,
//! and behind a nook by both.

use super::{Found, Search};
use crate::boundary::nodes::Hold;
use crate::boundary::side::{Face, NEAR};
use crate::boundary::surface::Site;
use crate::boundary::{Chain, Contact};
use nalgebra::Vector2;

/// Behind a nook its pieces go on for so many cells: farther in, no material reaches the nodes.
const BEHIND: f64 = 3.0;

impl Search<'_> {
    /// What a terrain with these pieces as `faces` does to a node.
    pub(super) fn on_terrain(&self, node: usize, x: [f64; 2], faces: &[Face], chain: &Chain, found: &mut Found) {
        let h = self.grid.spacing;
        let near = chain.nearest(x);
        let Some(index) = faces.first().map(|f| f.index).filter(|_| near.distance <= NEAR * h) else { return };
        let behind = |piece, normal| self.behind_piece((node, x), index, chain, piece, normal);
        let before = (found.sites.len(), found.holds.len());
        // Behind a nook both of its pieces act, each as a plane would.
        let nook = (near.at_corner && chain.is_nook(near.piece)).then_some([near.piece, near.piece + 1]);
        let mut met = [false; 2];
        for (piece, face) in faces.iter().enumerate() {
            let (d, _) = face.side.face_coordinates(x);
            if d > face.near() || d + face.step <= face.near() {
                continue;
            }
            let at = face.crossing_point(x, d, h);
            if !chain.covers(piece, at, face.axis, BEHIND * h) {
                continue;
            }
            nook.iter().flatten().zip(&mut met).for_each(|(own, met)| *met |= *own == piece);
            if d < -face.near() {
                found.sites.extend(self.crossing_of_piece(node, x, face, at, chain, piece));
            } else {
                found.holds.push(behind(piece, None));
            }
        }
        let open = (found.sites.len(), found.holds.len()) == before;
        if near.distance > self.tolerance {
            return;
        }
        if let Some(pieces) = nook {
            let rest = pieces.into_iter().zip(met).filter(|(_, met)| !met || open);
            found.holds.extend(rest.map(|(piece, _)| behind(piece, None)));
            return;
        }
        if !open {
            return;
        }
        if near.distance > -h
            && let Some(site) = self.crossing_left(node, x, faces, chain)
        {
            found.sites.push(site);
        } else {
            found.holds.push(behind(near.piece, Some(near.normal)));
        }
    }

    /// The crossing at `at` of a piece with a line of the grid through the node.
    fn crossing_of_piece(
        &self,
        node: usize,
        x: [f64; 2],
        face: &Face,
        at: Vector2<f64>,
        chain: &Chain,
        piece: usize,
    ) -> Option<Site> {
        let (nodes, shares) = self.between(node, x, at, face)?;
        let p = &chain.pieces()[piece];
        let along = p.start + (at - p.from).dot(&p.tangent);
        let foot = chain.points()[0];
        Some(Site::new(nodes, shares, face.index, &face.side, ([along; 2], at.into(), foot), false))
    }

    /// Of a node in the ground beside the surface that no piece finds on its own lines: the steepest crossing on a line from it.
    fn crossing_left(&self, node: usize, x: [f64; 2], faces: &[Face], chain: &Chain) -> Option<Site> {
        let h = self.grid.spacing;
        let crossings = faces.iter().enumerate().flat_map(|(piece, face)| {
            let other = face.clone().along(1 - face.axis, h);
            let (d, _) = other.side.face_coordinates(x);
            let crosses = other.step > NEAR * h && d < -other.near() && d + other.step > other.near();
            let at = if crosses { other.crossing_point(x, d, h) } else { Vector2::zeros() };
            (crosses && chain.covers(piece, at, other.axis, 0.0)).then_some((piece, other, at))
        });
        let (piece, face, at) = crossings.reduce(|a, b| if b.1.step > a.1.step { b } else { a })?;
        self.crossing_of_piece(node, x, &face, at, chain, piece)
    }

    /// The node itself, in the ground behind a piece; with another normal at a corner.
    fn behind_piece(
        &self,
        (node, x): (usize, [f64; 2]),
        index: usize,
        chain: &Chain,
        piece: usize,
        normal: Option<[f64; 2]>,
    ) -> Hold {
        let p = &chain.pieces()[piece];
        let along = p.start + (Vector2::from(x) - p.from).dot(&p.tangent);
        let contact = Contact { normal: normal.unwrap_or(p.normal.into()), along };
        Hold::new(node, x, index, &self.boundaries[index], contact, true).rubbing(p.friction)
    }
}
