//! The front of the flow: where it is, how fast and how deep.

use super::flow::{MAX_VOLUME_RATIO, flowing_blocks, flowing_extents};
use crate::body::{Block, Body};
use crate::lanes::LANES;
use crate::seeded::{self, Seed};
use crate::simulation::{Extent, Simulation};
use std::cmp::Ordering;

/// Share of the mass ahead of what counts as the front: single grains do not.
pub const FRONT_SHARE: f64 = 0.01;

/// The front along x. Ahead is where the flow runs: to the right or to the left.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Front {
    /// Position that 1 % of the mass has passed, m: the 99 % quantile of the mass. In a long flow it lies far behind the edge.
    pub x: f64,
    /// The edge: position of the foremost point, m.
    pub edge: f64,
    /// Mean velocity along x of the mass within a length behind it (and all ahead), m/s; positive ahead.
    pub velocity: f64,
    /// Largest flow depth within twice that length behind it, m.
    pub depth: f64,
}

/// How far behind the last head the next one is first looked for, strips: farther than a front falls back between two samples.
const BACK: f64 = 0.125;

/// A point of the flow's head: x (m), positive ahead, body, block and lane.
type HeadPoint<'a> = (f64, &'a Body, &'a Block, usize);

/// Finds the front of the flow. It keeps nothing but the memory that it works in, and where to look first.
#[derive(Debug, Clone)]
pub struct FrontGauge {
    /// 1 where the flow runs along x, -1 where it runs against it.
    ahead: f64,
    /// Length behind the front over which its velocity is averaged, m.
    length: f64,
    /// Where the head may begin, if it is about where it was, m.
    begin: f64,
    /// Mass and number of all points, and how many of them are ahead of the front.
    share: (f64, usize, usize),
    order: Order,
}

impl FrontGauge {
    /// Of a flow that runs along x (`ahead` = 1) or against it (-1), with its velocity averaged over `length` (m) behind the front.
    pub fn new(ahead: f64, length: f64) -> Self {
        Self { ahead, length, begin: f64::NEG_INFINITY, share: (0.0, 0, 0), order: Order::default() }
    }

    /// The front now of what flows (see `flow::flowing`): of all bodies but `barriers`, by index. At the origin and at
    /// rest where nothing flows.
    ///
    /// Sums run from the foremost point backwards. Only the head is put in order: where the front is follows from how many points
    /// are ahead of it. That needs points of one mass and no two at the same x; else all of them are sorted.
    pub fn sample(&mut self, simulation: &Simulation, barriers: &[usize]) -> Front {
        let bodies = simulation.bodies();
        let way = self.ahead;
        let (mut one_mass, mut of_point, mut count) = (true, None, 0);
        flowing_extents(simulation, barriers).for_each(|e| {
            let mass = bodies[e.body].point_mass;
            one_mass &= mass == *of_point.get_or_insert(mass);
            count += e.points;
        });
        let Some(of_point) = of_point else { return Front::default() };
        if one_mass && (self.share.0, self.share.1) != (of_point, count) {
            self.share = (of_point, count, points_ahead(std::iter::repeat_n(of_point, count)));
        }
        // The head is about where it was, or anywhere.
        let looks = [self.begin, f64::NEG_INFINITY];
        for least in looks.into_iter().filter(|_| one_mass) {
            let behind = |e: &Extent| if way > 0.0 { e.high[0] < least } else { -e.low[0] < least };
            let near: Vec<_> = flowing_extents(simulation, barriers).filter(|e| !behind(e)).collect();
            let mut blocks = Vec::with_capacity(near.iter().map(|e| e.points / LANES + 1).sum());
            near.iter().for_each(|e| blocks.extend(simulation.blocks_in(e).map(|(b, n)| (&bodies[e.body], b, n))));
            let ahead = |e: &&Extent| if way > 0.0 { [e.low[0], e.high[0]] } else { [-e.high[0], -e.low[0]] };
            let placed = self.order.sort(way, least, near.iter().map(ahead), &blocks);
            let Some(front) = placed.get(self.share.2) else { continue };
            let mut head = Head::new(simulation, way, self.length, front.x);
            if head.start < least {
                continue;
            }
            self.begin = head.start - BACK * head.strip;
            let points = placed.iter().map(|p| {
                let (body, block, _) = blocks[p.number as usize / LANES];
                (p.x, body, block, p.number as usize % LANES)
            });
            match head.add(points) {
                true => return head.front(),
                false => break,
            }
        }
        let mut all: Vec<HeadPoint> = Vec::new();
        flowing_blocks(simulation, barriers).for_each(|(body, block, n)| {
            all.extend((0..n).map(|l| (way * block.x[0][l], &bodies[body], block, l)));
        });
        all.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
        let front = all[points_ahead(all.iter().map(|p| p.1.point_mass))].0;
        let mut head = Head::new(simulation, way, self.length, front);
        head.add(all.into_iter());
        head.front()
    }
}

/// How many points are ahead of the front, of all points with these masses, the foremost first.
fn points_ahead(masses: impl ExactSizeIterator<Item = f64> + Clone) -> usize {
    let (mut passed, last) = (0.0, masses.len().saturating_sub(1));
    let ahead = seeded::times(Seed::GaugeFront, FRONT_SHARE) * masses.clone().sum::<f64>();
    let before = masses.take_while(|m| {
        passed += m;
        passed < ahead
    });
    before.count().min(last)
}

/// The head of the flow: what is ahead of the front, and close behind it.
struct Head {
    /// 1 where the flow runs along x, -1 where it runs against it.
    way: f64,
    /// Where the front is, m.
    x: f64,
    /// How far back the velocity and the depth look, m.
    reach: [f64; 2],
    /// Where the head begins, m.
    start: f64,
    /// Depths are volumes in strips of two cells, m.
    strip: f64,
    /// Width of the flow, m.
    thickness: f64,
    edge: f64,
    momentum: f64,
    moving: f64,
    volumes: Vec<f64>,
}

impl Head {
    fn new(simulation: &Simulation, way: f64, length: f64, x: f64) -> Self {
        let strip = 2.0 * simulation.spacing();
        let strips = (2.0 * length / strip).round().max(1.0) as usize;
        let reach = [length, strips as f64 * strip];
        let start = (x - reach[0]).min(x - reach[1]);
        let (thickness, volumes) = (simulation.thickness(), vec![0.0; strips]);
        Self { way, x, reach, start, strip, thickness, edge: x, momentum: 0.0, moving: 0.0, volumes }
    }

    /// Adds its points, the foremost first. Whether no two have the same x, so that there is one order of them.
    fn add<'a>(&mut self, points: impl Iterator<Item = HeadPoint<'a>>) -> bool {
        let (mut last, mut apart) = (f64::INFINITY, true);
        let (slow, shallow, strips) = (self.x - self.reach[0], self.x - self.reach[1], self.volumes.len() - 1);
        for (x, body, block, l) in points.take_while(|p| p.0 >= self.start) {
            if last == f64::INFINITY {
                self.edge = x;
            }
            apart &= x != last;
            last = x;
            if x >= slow {
                self.momentum += body.point_mass * (self.way * block.v[0][l]);
                self.moving += body.point_mass;
            }
            if x <= self.x && x > shallow {
                let volume = body.point_volume * block.volume_ratio[l].min(MAX_VOLUME_RATIO);
                self.volumes[(((self.x - x) / self.strip) as usize).min(strips)] += volume;
            }
        }
        apart
    }

    fn front(&self) -> Front {
        let depth = self.volumes.iter().fold(0.0, |a: f64, v| a.max(v / (self.strip * self.thickness)));
        let depth = seeded::times(Seed::GaugeFrontDepth, depth);
        let velocity = seeded::times(Seed::GaugeFrontVelocity, self.momentum / self.moving);
        Front { x: self.way * self.x, edge: self.way * self.edge, velocity, depth }
    }
}

/// A place ahead (m), and whose it is: number of the block times [`LANES`], and lane.
#[derive(Debug, Clone, Copy, Default)]
struct Placed {
    x: f64,
    number: u32,
    strip: u32,
}

/// Puts places in order, the foremost first: into strips of about two, then strip by strip.
#[derive(Debug, Clone, Default)]
struct Order {
    found: Vec<Placed>,
    /// Where each strip begins in the ordered list, and after sorting where it ends.
    starts: Vec<u32>,
    sorted: Vec<Placed>,
}

impl Order {
    /// Those from `least` (m) on, in order, of blocks with so many points each. All lie within the `spans` (m).
    fn sort(
        &mut self,
        way: f64,
        least: f64,
        spans: impl Iterator<Item = [f64; 2]>,
        blocks: &[(&Body, &Block, usize)],
    ) -> &[Placed] {
        let Self { found, starts, sorted } = self;
        let both = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        let [low, high] = spans.fold([f64::INFINITY, f64::NEG_INFINITY], both);
        let points = blocks.len() * LANES;
        let strips = points / 2 + 1;
        let per_metre = (strips as f64 / (high - low.max(least)).max(f64::MIN_POSITIVE)).min(f64::MAX);
        starts.clear();
        starts.resize(strips + 1, 0);
        found.clear();
        found.reserve(points);
        for (&(_, block, points), first) in blocks.iter().zip((0..).step_by(LANES)) {
            for (number, x) in (first..).zip(&block.x[0][..points]) {
                let x = way * x;
                if x >= least {
                    let strip = (((high - x) * per_metre) as u32).min(strips as u32 - 1);
                    starts[strip as usize + 1] += 1;
                    found.push(Placed { x, number, strip });
                }
            }
        }
        let mut sum = 0;
        for start in starts.iter_mut() {
            sum += *start;
            *start = sum;
        }
        sorted.resize(found.len(), Placed::default());
        for p in found.iter() {
            let at = &mut starts[p.strip as usize];
            sorted[*at as usize] = *p;
            *at += 1;
        }
        let mut from = 0;
        for to in starts[..strips].iter().map(|to| *to as usize) {
            if to > from + 1 {
                sorted[from..to].sort_unstable_by(|a, b| b.x.partial_cmp(&a.x).unwrap_or(Ordering::Equal));
            }
            from = to;
        }
        sorted
    }
}

#[cfg(test)]
#[path = "front_tests.rs"]
mod tests;
