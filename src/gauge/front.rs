//! The front of the flow: where it is, how fast and how deep.

use super::flow::{MAX_VOLUME_RATIO, flowing_blocks, flowing_extents};
use crate::body::{Block, Body};
use crate::seeded::{self, Seed};
use crate::simulation::{Extent, Simulation};

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

impl Front {
    /// Where nothing flows: nowhere, and no number says where.
    pub const NONE: Self = Self { x: f64::NAN, edge: f64::NAN, velocity: f64::NAN, depth: 0.0 };
}

/// How far behind the last front the next one is first looked for, strips: farther than a front falls back between two samples.
const BACK: f64 = 0.125;

/// Finds the front of the flow. It keeps nothing but the memory that it works in, and where to look first.
#[derive(Debug, Clone)]
pub struct FrontGauge {
    /// 1 where the flow runs along x, -1 where it runs against it.
    ahead: f64,
    /// Length behind the front over which its velocity is averaged, m.
    length: f64,
    /// The front is ahead of here, if it is about where it was, m.
    begin: f64,
    /// Mass and number of all points, and how many of them are ahead of the front.
    share: (f64, usize, usize),
    /// Memory to work in: places ahead, m.
    places: Vec<f64>,
}

impl FrontGauge {
    /// Of a flow that runs along x (`ahead` = 1) or against it (-1), with its velocity averaged over `length` (m) behind the front.
    pub fn new(ahead: f64, length: f64) -> Self {
        Self { ahead, length, begin: f64::NEG_INFINITY, share: (0.0, 0, 0), places: Vec::new() }
    }

    /// The front now of what flows (see `flow::flowing`): of all bodies but `barriers`, by index; [`Front::NONE`] where nothing flows.
    ///
    /// Where all points have one mass, the front is found by how many of them are ahead of it, among those that are ahead of where it was.
    /// Else all points are put in order.
    pub fn sample(&mut self, simulation: &Simulation, barriers: &[usize]) -> Front {
        let bodies = simulation.bodies();
        let (mut one_mass, mut of_point, mut count) = (true, None, 0);
        flowing_extents(simulation, barriers).for_each(|e| {
            let mass = bodies[e.body].point_mass;
            one_mass &= mass == *of_point.get_or_insert(mass);
            count += e.points;
        });
        let Some(of_point) = of_point else { return Front::NONE };
        if one_mass && (self.share.0, self.share.1) != (of_point, count) {
            self.share = (of_point, count, points_ahead(std::iter::repeat_n(of_point, count)));
        }
        let [x, edge] =
            if one_mass { self.among_equals(simulation, barriers) } else { self.in_order(simulation, barriers) };
        let mut head = Head::new(simulation, self.ahead, self.length, x, edge);
        self.begin = x - BACK * head.strip;
        let start = head.start;
        flowing_extents(simulation, barriers).filter(|e| foremost(self.ahead, e) >= start).for_each(|e| {
            let body = &bodies[e.body];
            simulation.blocks_in(e).for_each(|(block, points)| head.add(body, block, points));
        });
        head.front()
    }

    /// Where the front and the edge are, positive ahead, m, if all points have one mass.
    fn among_equals(&mut self, simulation: &Simulation, barriers: &[usize]) -> [f64; 2] {
        let (way, places, ahead) = (self.ahead, &mut self.places, self.share.2);
        // The front is about where it was, or anywhere.
        for least in [self.begin, f64::NEG_INFINITY] {
            places.clear();
            for e in flowing_extents(simulation, barriers).filter(|e| foremost(way, e) >= least) {
                for (block, points) in simulation.blocks_in(e) {
                    places.extend(block.x[0][..points].iter().map(|x| way * x).filter(|x| *x >= least));
                }
            }
            if ahead < places.len() {
                break;
            }
        }
        let (before, x, _) = places.select_nth_unstable_by(ahead, |a, b| b.total_cmp(a));
        let x = *x;
        [x, before.iter().fold(x, |a, b| a.max(*b))]
    }

    /// The same, whatever their masses.
    fn in_order(&self, simulation: &Simulation, barriers: &[usize]) -> [f64; 2] {
        let mut all: Vec<[f64; 2]> = Vec::new();
        flowing_blocks(simulation, barriers).for_each(|(body, block, n)| {
            let mass = simulation.bodies()[body].point_mass;
            all.extend(block.x[0][..n].iter().map(|x| [self.ahead * x, mass]));
        });
        all.sort_unstable_by(|a, b| b[0].total_cmp(&a[0]).then(b[1].total_cmp(&a[1])));
        [all[points_ahead(all.iter().map(|p| p[1]))][0], all[0][0]]
    }
}

/// The place of the foremost point of a box, positive ahead, m.
fn foremost(way: f64, extent: &Extent) -> f64 {
    if way > 0.0 { extent.high[0] } else { -extent.low[0] }
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
    fn new(simulation: &Simulation, way: f64, length: f64, x: f64, edge: f64) -> Self {
        let strip = 2.0 * simulation.spacing();
        let strips = (2.0 * length / strip).round().max(1.0) as usize;
        let reach = [length, strips as f64 * strip];
        let start = (x - reach[0]).min(x - reach[1]);
        let (thickness, volumes) = (simulation.thickness(), vec![0.0; strips]);
        Self { way, x, reach, start, strip, thickness, edge, momentum: 0.0, moving: 0.0, volumes }
    }

    /// Adds what of the points of a block belongs to it.
    fn add(&mut self, body: &Body, block: &Block, points: usize) {
        let (slow, shallow, strips) = (self.x - self.reach[0], self.x - self.reach[1], self.volumes.len() - 1);
        for l in 0..points {
            let x = self.way * block.x[0][l];
            if x >= slow {
                self.momentum += body.point_mass * (self.way * block.v[0][l]);
                self.moving += body.point_mass;
            }
            if x <= self.x && x > shallow {
                let volume = body.point_volume * block.volume_ratio[l].min(MAX_VOLUME_RATIO);
                self.volumes[(((self.x - x) / self.strip) as usize).min(strips)] += volume;
            }
        }
    }

    fn front(&self) -> Front {
        let depth = self.volumes.iter().fold(0.0, |a: f64, v| a.max(v / (self.strip * self.thickness)));
        let depth = seeded::times(Seed::GaugeFrontDepth, depth);
        let velocity = seeded::times(Seed::GaugeFrontVelocity, self.momentum / self.moving);
        Front { x: self.way * self.x, edge: self.way * self.edge, velocity, depth }
    }
}

#[cfg(test)]
#[path = "front_tests.rs"]
mod tests;
