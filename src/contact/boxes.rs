//! Which segment of a ring is nearest: runs of eight segments in boxes, eight boxes in a larger one, and so on, so that most
//! segments are never looked at. Eight boxes or segments at a time are plain loops that the compiler turns into vectors.
//!
//! Elsewhere: a bounding volume hierarchy (a tree of axis-aligned boxes), the broad phase of contact detection.

use super::Vector;
use crate::lanes::{LANES, Lane};
use crate::space::minus;

/// Eight boxes; those that are missing are infinitely far away.
#[derive(Debug, Clone, Copy)]
struct Boxes {
    low: [Lane; 2],
    high: [Lane; 2],
}

/// Eight segments in a row; those that are missing have no length.
#[derive(Debug, Clone, Copy)]
struct Run {
    from: [Lane; 2],
    along: [Lane; 2],
    square: Lane,
}

/// The segments of a closed ring.
#[derive(Debug, Clone, Default)]
pub(super) struct Segments {
    runs: Vec<Run>,
    /// A box around each run, and around each eight of those.
    boxes: Vec<Boxes>,
    outer: Vec<Boxes>,
}

impl Boxes {
    const NONE: Self = Self { low: [[f64::INFINITY; LANES]; 2], high: [[f64::NEG_INFINITY; LANES]; 2] };

    /// Lets a box reach to a place.
    fn widen(&mut self, number: usize, x: Vector) {
        for (d, x) in x.into_iter().enumerate() {
            self.low[d][number] = self.low[d][number].min(x);
            self.high[d][number] = self.high[d][number].max(x);
        }
    }

    /// Squares of the distances to `x`, m2.
    #[inline(always)]
    fn squares(&self, x: Vector) -> Lane {
        let mut squares = [0.0; LANES];
        for (l, square) in squares.iter_mut().enumerate() {
            let outside = |d: usize| larger(larger(self.low[d][l] - x[d], x[d] - self.high[d][l]), 0.0);
            let r = [outside(0), outside(1)];
            *square = r[0] * r[0] + r[1] * r[1];
        }
        squares
    }
}

/// Unlike the library's maximum one vector instruction.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

impl Run {
    const NONE: Self = Self { from: [[0.0; LANES]; 2], along: [[0.0; LANES]; 2], square: [0.0; LANES] };

    /// Squares of the distances to `x`, m2, infinite without a length. As [`super::outline::foot_on`] finds them.
    #[inline(always)]
    fn squares(&self, x: Vector) -> Lane {
        let mut squares = [0.0; LANES];
        for (l, square) in squares.iter_mut().enumerate() {
            let (from, along) = ([self.from[0][l], self.from[1][l]], [self.along[0][l], self.along[1][l]]);
            let r = minus(x, from);
            let share = (r[0] * along[0] + r[1] * along[1]) / self.square[l];
            let share = larger(share, 0.0);
            let share = if share < 1.0 { share } else { 1.0 };
            let r = minus(x, [from[0] + share * along[0], from[1] + share * along[1]]);
            *square = if self.square[l] > 0.0 { r[0] * r[0] + r[1] * r[1] } else { f64::INFINITY };
        }
        squares
    }

    /// Looks for a nearer segment in the run of this number than the `best` so far: square of its distance (m2) and its number.
    #[inline(always)]
    fn look(&self, number: usize, x: Vector, best: &mut (f64, Option<usize>)) {
        for (l, square) in self.squares(x).into_iter().enumerate() {
            if square < best.0 {
                *best = (square, Some(number * LANES + l));
            }
        }
    }
}

impl Segments {
    /// Takes new positions of the ring, m.
    pub fn follow(&mut self, ring: &[Vector]) {
        let runs = ring.len().div_ceil(LANES);
        self.runs.clear();
        self.runs.resize(runs, Run::NONE);
        self.boxes.clear();
        self.boxes.resize(runs.div_ceil(LANES), Boxes::NONE);
        self.outer.clear();
        self.outer.resize(self.boxes.len().div_ceil(LANES), Boxes::NONE);
        for (k, &from) in ring.iter().enumerate() {
            let to = ring[if k + 1 < ring.len() { k + 1 } else { 0 }];
            let along = minus(to, from);
            let (run, l) = (k / LANES, k % LANES);
            let segments = &mut self.runs[run];
            for d in 0..2 {
                (segments.from[d][l], segments.along[d][l]) = (from[d], along[d]);
            }
            segments.square[l] = along[0] * along[0] + along[1] * along[1];
            for x in [from, to] {
                self.boxes[run / LANES].widen(run % LANES, x);
                self.outer[run / LANES / LANES].widen(run / LANES % LANES, x);
            }
        }
    }

    /// Number of the segment nearest to `x` among those that have a length. Of equally near ones the first in the nearest box, or
    /// else the first.
    pub fn nearest(&self, x: Vector) -> Option<usize> {
        let mut first = 0;
        self.look_within(f64::INFINITY, x, |run, square| {
            first = run;
            square
        });
        // The nearest box rules out most of the others.
        let mut best = (f64::INFINITY, None);
        self.runs.get(first)?.look(first, x, &mut best);
        self.look_within(best.0, x, |run, _| {
            if run != first {
                self.runs[run].look(run, x, &mut best);
            }
            best.0
        });
        best.1
    }

    /// Calls `look` in order with every run whose box is nearer to `x` than a bound, and with the square of its distance (m2).
    /// `look` gives the bound (m2) from then on.
    #[inline(always)]
    fn look_within(&self, mut bound: f64, x: Vector, mut look: impl FnMut(usize, f64) -> f64) {
        for (o, (outer, boxes)) in self.outer.iter().zip(self.boxes.chunks(LANES)).enumerate() {
            let to_outer = outer.squares(x);
            for (b, around) in boxes.iter().enumerate() {
                if to_outer[b] < bound {
                    for (l, square) in around.squares(x).into_iter().enumerate() {
                        if square < bound {
                            bound = look((o * LANES + b) * LANES + l, square);
                        }
                    }
                }
            }
        }
    }
}
