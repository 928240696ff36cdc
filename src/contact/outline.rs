//! The surface of a body, followed through its outermost points.
//!
//! A body that starts as a lattice of points has an outline: the ring of points with a free side, in order. The points carry it
//! along as the body moves and bends, so the surface is known to a fraction of the distance between points, and a barrier many
//! cells thick has a definite front and back. The surface lies half a point's extent outside of the ring, round at corners.
//!
//! Elsewhere: front tracking by a chain of markers; the distance from it is the signed distance (level set) of the
//! body.

use super::Vector;
use super::boxes::Segments;
use crate::space::{clockwise, direction, dot, minus};
use std::collections::BTreeMap;

/// Rings of point numbers around a body, counter-clockwise, holes clockwise. A point of a thin part may occur twice.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Outline {
    /// The rings, each closed from its last point to its first.
    pub rings: Vec<Vec<u32>>,
}

/// Where a place lies with respect to a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// Distance from the surface, positive outside, m.
    pub distance: f64,
    /// Unit normal of the surface, out of the body.
    pub normal: Vector,
    /// The nearest place on the ring of points, m.
    pub foot: Vector,
}

impl Outline {
    /// Traces the outline of points on a square lattice of the given spacing (m), whose rows lie at `angle` (rad) to x.
    /// `points` are numbers and positions.
    pub fn trace(points: &[(u32, Vector)], spacing: f64, angle: f64) -> Self {
        let Some(&(_, origin)) = points.first() else { return Self::default() };
        let (c, s) = (libm::cos(angle), libm::sin(angle));
        let cell = |x: Vector| {
            let r = minus(x, origin);
            [((c * r[0] + s * r[1]) / spacing).round() as i64, ((c * r[1] - s * r[0]) / spacing).round() as i64]
        };
        let cells: BTreeMap<[i64; 2], u32> = points.iter().map(|&(id, x)| (cell(x), id)).collect();
        // Free sides of each point's square, from corner to corner with the body on the left.
        let mut sides: BTreeMap<[i64; 2], Vec<([i64; 2], u32)>> = BTreeMap::new();
        for (&[i, j], &id) in &cells {
            for (beside, from, to) in [
                ([i, j - 1], [i, j], [i + 1, j]),
                ([i + 1, j], [i + 1, j], [i + 1, j + 1]),
                ([i, j + 1], [i + 1, j + 1], [i, j + 1]),
                ([i - 1, j], [i, j + 1], [i, j]),
            ] {
                if !cells.contains_key(&beside) {
                    sides.entry(from).or_default().push((to, id));
                }
            }
        }
        let mut rings = Vec::new();
        while let Some((&start, _)) = sides.first_key_value() {
            let mut ring: Vec<u32> = Vec::new();
            let mut at = start;
            let mut last = None;
            while let Some(choices) = sides.get_mut(&at) {
                // Where two squares meet at a corner only, stay on the same point.
                let k = choices.iter().position(|&(_, id)| Some(id) == last).unwrap_or(0);
                let (to, id) = choices.swap_remove(k);
                if choices.is_empty() {
                    sides.remove(&at);
                }
                if last != Some(id) {
                    ring.push(id);
                }
                (at, last) = (to, Some(id));
            }
            if ring.len() > 1 && ring.first() == ring.last() {
                ring.pop();
            }
            rings.push(ring);
        }
        Self { rings }
    }

    /// All point numbers that occur, in order, without repetition.
    pub fn points(&self) -> Vec<u32> {
        let mut all: Vec<u32> = self.rings.iter().flatten().copied().collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}

/// The surface about one ring of positions (m), `radius` (m) outside of it, as seen from `x`. None for an empty ring.
///
/// Inside or outside is decided by the winding of the ring, so it holds at any distance.
pub fn nearest(ring: &[Vector], radius: f64, x: Vector) -> Option<Nearest> {
    let mut best = (f64::INFINITY, [0.0; 2], [0.0; 2]);
    let mut crossings = 0i32;
    let mut from = *ring.last()?;
    for &to in ring {
        let (foot, along, _) = foot_on(from, to, x);
        let r = minus(x, foot);
        let square = dot(r, r);
        if square < best.0 {
            best = (square, foot, along);
        }
        crossings += crossing(from, to, x);
        from = to;
    }
    let (square, foot, along) = best;
    let inside = crossings != 0;
    let distance = if inside { -square.sqrt() } else { square.sqrt() };
    // Close to the ring the direction to it is noise; the face itself has a normal, to the right of its direction.
    let face = direction(clockwise(along), 0.0);
    let away = direction(minus(x, foot), 1e-9 * radius.max(f64::MIN_POSITIVE));
    let normal = match away {
        Some(n) if inside => [-n[0], -n[1]],
        Some(n) => n,
        None => face.unwrap_or([1.0, 0.0]),
    };
    Some(Nearest { distance: distance - radius, normal, foot })
}

/// A ring of positions prepared for many questions near it.
///
/// Inside or outside is decided by the side of the nearest segment (at a corner, of both of its segments), which holds for
/// bodies at least two points thick.
#[derive(Debug, Clone, Default)]
pub struct Surface {
    /// Half extent of the points, m.
    pub radius: f64,
    ring: Vec<Vector>,
    segments: Segments,
}

impl Surface {
    /// A surface `radius` (m) outside of a ring that is still unknown.
    pub fn new(radius: f64) -> Self {
        Self { radius, ..Self::default() }
    }

    /// Takes new positions of the ring, m.
    pub fn follow(&mut self, places: impl Iterator<Item = Vector>) {
        self.ring.clear();
        self.ring.extend(places);
        self.segments.follow(&self.ring);
    }

    /// Where `x` lies. None for a ring without points.
    pub fn nearest(&self, x: Vector) -> Option<Nearest> {
        let n = self.ring.len();
        let k = self.segments.nearest(x)?;
        let (foot, _, share) = foot_on(self.ring[k], self.ring[(k + 1) % n], x);
        let face = |k: usize| {
            let along = minus(self.ring[(k + 1) % n], self.ring[k % n]);
            direction(clockwise(along), 0.0).unwrap_or_default()
        };
        let own = face(k);
        let out = match () {
            () if share <= 0.0 => sum(own, face(k + n - 1)),
            () if share >= 1.0 => sum(own, face(k + 1)),
            () => own,
        };
        let r = minus(x, foot);
        let square = dot(r, r);
        let side = if dot(r, out) < 0.0 { -1.0 } else { 1.0 };
        // Close to the ring the direction to it is noise.
        let normal = match direction(r, 1e-6 * self.radius) {
            Some(n) => [side * n[0], side * n[1]],
            None => direction(out, 0.0).unwrap_or(own),
        };
        Some(Nearest { distance: side * square.sqrt() - self.radius, normal, foot })
    }
}

fn sum(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1]]
}

/// The place of a segment nearest to `x`, the segment's direction (not of unit length), and how far along it the place is.
pub(super) fn foot_on(from: Vector, to: Vector, x: Vector) -> (Vector, Vector, f64) {
    let along = minus(to, from);
    let length2 = dot(along, along);
    let share = if length2 > 0.0 { (dot(minus(x, from), along) / length2).clamp(0.0, 1.0) } else { 0.0 };
    ([from[0] + share * along[0], from[1] + share * along[1]], along, share)
}

/// What a segment adds to the winding number of a closed ring about `x`.
fn crossing(from: Vector, to: Vector, x: Vector) -> i32 {
    let left = (to[0] - from[0]) * (x[1] - from[1]) - (x[0] - from[0]) * (to[1] - from[1]);
    match (from[1] <= x[1], to[1] <= x[1]) {
        (true, false) if left > 0.0 => 1,
        (false, true) if left < 0.0 => -1,
        _ => 0,
    }
}

/// Depth (m) to which a point of half extent `reach` (m) lies inside a body: its own surface against that of the body. Zero
/// outside.
pub fn penetration(ring: &[Vector], radius: f64, x: Vector, reach: f64) -> f64 {
    nearest(ring, radius, x).map_or(0.0, |n| (reach - n.distance).max(0.0))
}
