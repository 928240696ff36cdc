//! Where the points are, a few blocks at a time: those who look for points near a place pass over most of them after one look.
//!
//! Elsewhere: axis-aligned bounding boxes of clusters of particles, for culling.

use super::Simulation;
use crate::body::{Block, Points};
use crate::lanes::{LANES, Lane};

/// Blocks of points that lie beside each other, so that one box is enough for them.
const RUN: usize = 4;

/// The box that a run of blocks of points lies in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    /// Index of its body.
    pub body: usize,
    /// Number of real points.
    pub points: usize,
    /// Least of their x and y, m.
    pub low: [f64; 2],
    /// Greatest of their x and y, m.
    pub high: [f64; 2],
    /// Field, band, body within the field, first block.
    place: [u32; 4],
}

impl Extent {
    /// The corner that lies farthest against a direction: no point in it lies farther that way, also in the last bit of a distance
    /// that is found by the same operations.
    pub fn corner_against(&self, direction: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|d| if direction[d] >= 0.0 { self.low[d] } else { self.high[d] })
    }
}

impl Simulation {
    /// The boxes of all blocks, in the order of [`Simulation::blocks`]. They are found once a step, when they are asked for.
    pub fn extents(&self) -> &[Extent] {
        self.extents.get_or_init(|| {
            let points = self.fields.iter().flat_map(|f| &f.bands).flat_map(|band| &band.points);
            let mut found = Vec::with_capacity(points.map(|points| points.all().len().div_ceil(RUN)).sum());
            for (f, field) in (0..).zip(&self.fields) {
                for (b, band) in (0..).zip(&field.bands) {
                    let seen = (0..).zip(&band.points).zip(&field.members).filter(|(_, body)| **body < self.seen);
                    for ((k, points), &body) in seen {
                        found.extend((0..).step_by(RUN).zip(points.all().chunks(RUN)).map(|(first, blocks)| {
                            let count = (points.len() - first as usize * LANES).min(RUN * LANES);
                            let [x, y] = [span(blocks, 0), span(blocks, 1)];
                            let place = [f, b, k, first];
                            Extent { body, points: count, low: [x[0], y[0]], high: [x[1], y[1]], place }
                        }));
                    }
                }
            }
            found
        })
    }

    /// The blocks of points that lie in a box of this moment, with the number of real points in each.
    pub fn blocks_in(&self, extent: &Extent) -> impl Iterator<Item = (&Block, usize)> {
        let blocks = &self.points_at(extent).all()[extent.place[3] as usize..];
        blocks.iter().zip((0..extent.points).step_by(LANES).map(|first| (extent.points - first).min(LANES)))
    }

    /// The numbers of these points within their body.
    pub fn ids_in(&self, extent: &Extent) -> &[[u32; LANES]] {
        &self.points_at(extent).ids()[extent.place[3] as usize..]
    }

    fn points_at(&self, extent: &Extent) -> &Points {
        let [field, band, body, _] = extent.place.map(|k| k as usize);
        &self.fields[field].bands[band].points[body]
    }
}

/// Least and greatest x or y, lane by lane and then by halves; lanes that are not used repeat points.
fn span(blocks: &[Block], d: usize) -> [f64; 2] {
    let less = |a: f64, b: f64| if b < a { b } else { a };
    let more = |a: f64, b: f64| if b > a { b } else { a };
    let (mut low, mut high): (Lane, Lane) = ([f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES]);
    for block in blocks {
        low = std::array::from_fn(|l| less(low[l], block.x[d][l]));
        high = std::array::from_fn(|l| more(high[l], block.x[d][l]));
    }
    let low: [f64; 4] = std::array::from_fn(|l| less(low[l], low[l + 4]));
    let high: [f64; 4] = std::array::from_fn(|l| more(high[l], high[l + 4]));
    [less(less(low[0], low[2]), less(low[1], low[3])), more(more(high[0], high[2]), more(high[1], high[3]))]
}
