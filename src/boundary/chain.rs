//! Terrain: a chain of straight pieces with material on its left, as one walks along its points.
//!
//! The first and the last piece go on straight beyond their ends, so that the chain divides the plane: on its left there is room for
//! material, on its right there is ground. A corner may be a valley, where the room has less than half a turn, or a crest.
//!
//! Elsewhere: a bed, a bottom profile; a signed distance to a polyline with angle-weighted pseudonormals (Baerentzen and Aanaes 2005).

use super::Friction;
use nalgebra::Vector2;
use std::ops::Range;

/// Planes and pieces whose normals have a larger scalar product than this are pieces of one surface; others make a corner.
pub(super) const SMOOTH: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// So many pieces share a box by which far ones are passed over.
const TOGETHER: usize = 16;

/// One straight piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Where it begins, m.
    pub from: Vector2<f64>,
    /// Where it ends, m.
    pub to: Vector2<f64>,
    /// Unit vector along it.
    pub tangent: Vector2<f64>,
    /// Unit normal, into the material.
    pub normal: Vector2<f64>,
    /// Length of the pieces before it, m.
    pub start: f64,
    /// What resists sliding.
    pub friction: Friction,
}

/// What of a chain is nearest to a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Near {
    /// Distance, m; negative in the ground.
    pub distance: f64,
    /// Unit vector into the material: the normal of the piece, or the mean of two at a corner between them.
    pub normal: [f64; 2],
    /// Place along the chain from its first point, m.
    pub along: f64,
    /// Number of the piece.
    pub piece: usize,
    /// Whether it is the corner at which this piece ends.
    pub at_corner: bool,
}

/// A chain of straight pieces.
#[derive(Debug, Clone, PartialEq)]
pub struct Chain {
    points: Vec<[f64; 2]>,
    pieces: Vec<Piece>,
    /// Least and greatest x and y of groups of pieces, m.
    boxes: Vec<([f64; 4], Range<usize>)>,
}

impl Chain {
    /// The chain through `points` (m), with what resists sliding on each piece; `None` with fewer than two points, a piece without length, or
    /// another number of frictions than pieces.
    pub fn new(points: Vec<[f64; 2]>, frictions: &[Friction]) -> Option<Self> {
        if points.len() < 2 || frictions.len() + 1 != points.len() {
            return None;
        }
        let mut start = 0.0;
        let mut pieces = Vec::with_capacity(frictions.len());
        for (ends, friction) in points.windows(2).zip(frictions) {
            let [from, to] = [ends[0], ends[1]].map(Vector2::from);
            let (along, length) = (to - from, (to - from).norm());
            if length <= 0.0 || !length.is_finite() {
                return None;
            }
            let tangent = along / length;
            let normal = Vector2::new(-tangent.y, tangent.x);
            pieces.push(Piece { from, to, tangent, normal, start, friction: *friction });
            start += length;
        }
        let mut chain = Self { points, pieces, boxes: Vec::new() };
        chain.set_boxes();
        Some(chain)
    }

    fn set_boxes(&mut self) {
        let last = self.pieces.len() - 1;
        let groups = (0..=last).step_by(TOGETHER).map(|a| a..(a + TOGETHER).min(last + 1));
        self.boxes = groups
            .map(|group| {
                // The ends of the chain are infinite.
                if group.start == 0 || group.end == last + 1 {
                    let all = [f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY];
                    return (all, group);
                }
                let ends = self.points[group.start..=group.end].iter();
                let start = [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY];
                let all = ends.fold(start, |b, p| [b[0].min(p[0]), b[1].max(p[0]), b[2].min(p[1]), b[3].max(p[1])]);
                (all, group)
            })
            .collect();
    }

    /// Its points, m.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// Its pieces.
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// Ends of its pieces, m, the first and the last ten thousand times as far out as the chain is long.
    pub fn segments(&self) -> impl Iterator<Item = [[f64; 2]; 2]> {
        let last = self.pieces.len() - 1;
        let far = 1.0e4 * self.length();
        self.pieces.iter().enumerate().map(move |(k, p)| {
            let from = if k == 0 { p.from - p.tangent * far } else { p.from };
            let to = if k == last { p.to + p.tangent * far } else { p.to };
            [from.into(), to.into()]
        })
    }

    /// Length from the first point to the last, m.
    pub fn length(&self) -> f64 {
        self.pieces.last().map_or(0.0, |p| p.start + (p.to - p.from).norm())
    }

    /// The same moved.
    pub fn shift(&mut self, by: Vector2<f64>) {
        for p in &mut self.points {
            (p[0], p[1]) = (p[0] + by.x, p[1] + by.y);
        }
        for p in &mut self.pieces {
            p.from += by;
            p.to += by;
        }
        self.set_boxes();
    }

    /// Sine of the turn at the corner where a piece ends, positive in a valley; 0 at the end of the chain.
    pub fn turn(&self, piece: usize) -> f64 {
        let (Some(a), Some(b)) = (self.pieces.get(piece), self.pieces.get(piece + 1)) else { return 0.0 };
        a.tangent.x * b.tangent.y - a.tangent.y * b.tangent.x
    }

    /// Whether the corner where a piece ends is a valley so steep that both its pieces act on what lies in the ground behind it.
    pub fn is_nook(&self, piece: usize) -> bool {
        let (Some(a), Some(b)) = (self.pieces.get(piece), self.pieces.get(piece + 1)) else { return false };
        self.turn(piece) > 0.0 && a.tangent.dot(&b.tangent) < SMOOTH
    }

    /// What is nearest to a place.
    pub fn nearest(&self, x: [f64; 2]) -> Near {
        let (x, last) = (Vector2::from(x), self.pieces.len() - 1);
        // The square of the distance, the piece, the place along it.
        let mut best = (f64::INFINITY, 0, 0.0);
        for ([left, right, low, high], group) in &self.boxes {
            let out = [(left - x.x).max(x.x - right).max(0.0), (low - x.y).max(x.y - high).max(0.0)];
            if out[0] * out[0] + out[1] * out[1] > best.0 {
                continue;
            }
            for k in group.clone() {
                let p = &self.pieces[k];
                let r = x - p.from;
                let length = (p.to - p.from).norm();
                let bottom = if k == 0 { f64::NEG_INFINITY } else { 0.0 };
                let top = if k == last { f64::INFINITY } else { length };
                let s = r.dot(&p.tangent).clamp(bottom, top);
                let square = (r - p.tangent * s).norm_squared();
                if square < best.0 {
                    best = (square, k, s);
                }
            }
        }
        let (_, k, s) = best;
        let p = &self.pieces[k];
        let length = (p.to - p.from).norm();
        // The corner at which a piece begins is that at which the one before it ends.
        let corner = match () {
            () if s <= 0.0 && k > 0 => Some(k - 1),
            () if s >= length && k < last => Some(k),
            () => None,
        };
        let Some(corner) = corner else {
            let distance = (x - p.from).dot(&p.normal);
            return Near { distance, normal: p.normal.into(), along: p.start + s, piece: k, at_corner: false };
        };
        let (a, b) = (&self.pieces[corner], &self.pieces[corner + 1]);
        let normal = (a.normal + b.normal).normalize();
        let r = x - a.to;
        let distance = r.norm().copysign(r.dot(&normal));
        Near { distance, normal: normal.into(), along: b.start, piece: corner, at_corner: true }
    }

    /// Whether a line of the grid that crosses the line of a piece at a place crosses the piece itself, or what goes on from it: beyond the ends
    /// of the chain, and in the ground behind a nook, at most `reach` (m) from its corner. The line runs along `axis`.
    pub fn covers(&self, piece: usize, at: Vector2<f64>, axis: usize, reach: f64) -> bool {
        let p = &self.pieces[piece];
        // Across the lines; pieces that follow each other share the number, so that each line meets one of them.
        let across = 1 - axis;
        let way = p.tangent[across].signum();
        let [from, to, s] = [p.from[across], p.to[across], at[across]].map(|c| way * c);
        let back = if piece > 0 && self.is_nook(piece - 1) { reach * p.tangent[across].abs() } else { 0.0 };
        let ahead = if self.is_nook(piece) { reach * p.tangent[across].abs() } else { 0.0 };
        let next = self.pieces.get(piece + 1);
        // Where the next piece is met by other lines, the corner belongs to both.
        let shared = next.is_some_and(|n| n.normal.iamax() != p.normal.iamax());
        (piece == 0 || s >= from - back) && (next.is_none() || s < to + ahead || shared && s <= to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Down to a floor, up a step: a valley of 45 degrees, a nook, a crest of 90 degrees.
    fn chain() -> Chain {
        let points = vec![[-2.0, 2.0], [0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [5.0, 1.0]];
        Chain::new(points, &[Friction::Smooth; 4]).expect("a chain")
    }

    #[test]
    fn places_before_and_behind_a_chain() {
        let c = chain();
        let half = std::f64::consts::FRAC_1_SQRT_2;
        for (x, distance, normal) in [
            ([1.0, 0.5], 0.5, [0.0, 1.0]),
            ([1.0, -0.5], -0.5, [0.0, 1.0]),
            ([-3.0, 3.0], 0.0, [half, half]),
            ([-9.0, 9.0 + 1.0], half, [half, half]),
            ([2.8, 0.4], 0.2, [-1.0, 0.0]),
            ([3.4, 0.9], -0.1, [0.0, 1.0]),
            ([3.1, 0.5], -0.1, [-1.0, 0.0]),
            ([2.7, 1.4], 0.5, [-half, half]),
            ([3.3, -0.4], -0.5, [-half, half]),
            ([50.0, 3.0], 2.0, [0.0, 1.0]),
        ] {
            let near = c.nearest(x);
            assert!((near.distance - distance).abs() < 1e-12, "{x:?} {near:?}");
            assert!((Vector2::from(near.normal) - Vector2::from(normal)).norm() < 1e-12, "{x:?} {near:?}");
        }
        assert_eq!([1, 2, 3].map(|k| c.is_nook(k)), [true, false, false]);
        assert!(c.turn(0) > 0.0 && c.turn(2) < 0.0);
        assert!((c.length() - (8f64.sqrt() + 3.0 + 1.0 + 2.0)).abs() < 1e-12);
        assert!((c.nearest([4.0, 3.0]).along - (8f64.sqrt() + 5.0)).abs() < 1e-12);
    }

    /// A long chain, where groups are passed over, against all pieces one by one.
    #[test]
    fn the_nearest_piece_is_found_among_many() {
        let points: Vec<[f64; 2]> = (0..=400).map(|k| f64::from(k) * 0.01 - 2.0).map(|x| [x, x * x]).collect();
        let c = Chain::new(points.clone(), &[Friction::Smooth; 400]).expect("a chain");
        for k in 0..200 {
            let x = [-1.9 + 0.019 * f64::from(k), 0.3 + 0.01 * f64::from(k % 37)];
            let all = c.pieces().iter().map(|p| {
                let s = (Vector2::from(x) - p.from).dot(&p.tangent).clamp(0.0, (p.to - p.from).norm());
                (Vector2::from(x) - p.from - p.tangent * s).norm()
            });
            let least = all.fold(f64::INFINITY, f64::min);
            let near = c.nearest(x);
            assert!((near.distance.abs() - least).abs() < 1e-12, "{x:?}");
            assert_eq!(near.distance > 0.0, x[1] > x[0] * x[0], "{x:?}");
        }
    }

    /// Each vertical line meets one of the flat pieces, each horizontal one the riser; the floor and the riser go on behind their nook.
    #[test]
    fn a_line_meets_one_piece() {
        let points = vec![[-2.0, 1.0], [0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [5.0, 1.0]];
        let c = Chain::new(points, &[Friction::Smooth; 4]).expect("a chain");
        let met = |x: f64, axis: usize| -> Vec<usize> {
            (0..4).filter(|&k| c.covers(k, Vector2::new(x, x), axis, 0.2)).collect()
        };
        assert_eq!(met(-5.0, 1), [0]);
        // The riser has no extent along x: it is met where its lines are horizontal.
        assert_eq!([met(-0.001, 1), met(0.001, 1)], [[0], [1]]);
        assert_eq!([met(2.9, 1), met(3.1, 1), met(3.3, 1)], [vec![1], vec![1, 3], vec![3]]);
        assert!(c.covers(2, Vector2::new(3.0, 0.5), 0, 0.2) && c.covers(2, Vector2::new(3.0, -0.1), 0, 0.2));
        // The crest belongs to the riser and to the tread.
        assert!(c.covers(2, Vector2::new(3.0, 1.0), 0, 0.2) && c.covers(3, Vector2::new(3.0, 1.0), 1, 0.2));
        assert!(!c.covers(2, Vector2::new(3.0, 1.01), 0, 0.2) && !c.covers(2, Vector2::new(3.0, -0.3), 0, 0.2));
    }

    #[test]
    fn what_is_no_chain_is_none() {
        assert!(Chain::new(vec![[0.0, 0.0]], &[]).is_none());
        assert!(Chain::new(vec![[0.0, 0.0], [0.0, 0.0]], &[Friction::Smooth]).is_none());
        assert!(Chain::new(vec![[0.0, 0.0], [1.0, 0.0]], &[]).is_none());
        let mut moved = chain();
        moved.shift(Vector2::new(1.0, 2.0));
        assert_eq!((moved.points()[0], moved.nearest([2.0, 2.5]).distance), ([-1.0, 4.0], 0.5));
    }
}
