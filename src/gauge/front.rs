//! The front of the flow: where it is, how fast and how deep.

use super::flow::{MAX_VOLUME_RATIO, flowing_blocks};
use crate::simulation::Simulation;

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

/// A point of the flow's head: x (m) and velocity along x (m/s), both positive ahead, mass (kg), volume (m3).
type HeadPoint = [f64; 4];

/// Finds the front of the flow. It keeps nothing but the memory that it works in.
#[derive(Debug, Clone)]
pub struct FrontGauge {
    /// 1 where the flow runs along x, -1 where it runs against it.
    ahead: f64,
    /// Length behind the front over which its velocity is averaged, m.
    length: f64,
    keys: Vec<i64>,
    order: Vec<(i64, u32)>,
    found: Vec<HeadPoint>,
    head: Vec<HeadPoint>,
}

/// The bits of a number as a whole number in the order of `f64::total_cmp`, and back.
fn in_order(bits: i64) -> i64 {
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}

/// A whole number that is the smaller the farther ahead a place is.
fn key(x: f64) -> i64 {
    !in_order(x.to_bits() as i64)
}

/// The place of a [`key`].
fn place(key: i64) -> f64 {
    f64::from_bits(in_order(!key) as u64)
}

impl FrontGauge {
    /// Of a flow that runs along x (`ahead` = 1) or against it (-1), with its velocity averaged over `length` (m) behind the front.
    pub fn new(ahead: f64, length: f64) -> Self {
        Self { ahead, length, keys: Vec::new(), order: Vec::new(), found: Vec::new(), head: Vec::new() }
    }

    /// The front now of what flows (see [`flowing`](super::flow::flowing)): of all bodies but `barriers`, by index. At the origin and at
    /// rest where nothing flows.
    ///
    /// Sums run from the foremost point backwards. Only the head is put in order: where the front is follows from how many points
    /// are ahead of it. That needs points of one mass and no two at the same x; else all of them are sorted.
    pub fn sample(&mut self, simulation: &Simulation, barriers: &[usize]) -> Front {
        let bodies = simulation.bodies();
        let Self { ahead: way, length, keys, order, found, head } = self;
        let (way, length) = (*way, *length);
        keys.clear();
        let (mut one_mass, mut of_point) = (true, None);
        flowing_blocks(simulation, barriers).for_each(|(body, block, n)| {
            one_mass &= bodies[body].point_mass == *of_point.get_or_insert(bodies[body].point_mass);
            keys.extend(block.x[0][..n].iter().map(|x| key(way * *x)));
        });
        let (Some(of_point), count) = (of_point, keys.len()) else { return Front::default() };
        // Depth from the volume in strips of two cells.
        let strip = 2.0 * simulation.spacing();
        let strips = (2.0 * length / strip).round().max(1.0) as usize;
        let depth_reach = strips as f64 * strip;

        let find = |least: f64, found: &mut Vec<HeadPoint>| {
            found.clear();
            flowing_blocks(simulation, barriers).for_each(|(body, block, n)| {
                let body = &bodies[body];
                for l in (0..n).filter(|&l| way * block.x[0][l] >= least) {
                    let volume = body.point_volume * block.volume_ratio[l].min(MAX_VOLUME_RATIO);
                    found.push([way * block.x[0][l], way * block.v[0][l], body.point_mass, volume]);
                }
            });
        };
        let total = one_mass.then(|| std::iter::repeat_n(of_point, count).sum::<f64>());
        let mut apart = false;
        if let Some(total) = total {
            let mut passed = 0.0;
            let ahead = std::iter::repeat_n(of_point, count).take_while(|m| {
                passed += m;
                passed < FRONT_SHARE * total
            });
            let ahead = ahead.count().min(count - 1);
            let x = place(*keys.select_nth_unstable(ahead).1);
            find((x - length).min(x - depth_reach), found);
            order.clear();
            order.extend(found.iter().zip(0..).map(|(p, number)| (key(p[0]), number)));
            order.sort_unstable();
            apart = order.windows(2).all(|pair| pair[0].0 != pair[1].0);
            head.clear();
            head.extend(order.iter().map(|&(_, number)| found[number as usize]));
        }
        if !apart {
            find(f64::NEG_INFINITY, head);
            head.sort_unstable_by(|a, b| b[0].total_cmp(&a[0]));
        }
        let mass = total.unwrap_or_else(|| head.iter().map(|p| p[2]).sum());
        let mut passed = 0.0;
        let front = head.iter().find(|p| {
            passed += p[2];
            passed >= FRONT_SHARE * mass
        });
        let x = front.map_or(0.0, |p| p[0]);
        let (mut momentum, mut moving) = (0.0, 0.0);
        for [_, v, m, _] in head.iter().take_while(|p| p[0] >= x - length) {
            momentum += m * v;
            moving += m;
        }
        let mut volumes = vec![0.0; strips];
        for p in head.iter().skip_while(|p| p[0] > x).take_while(|p| p[0] > x - depth_reach) {
            volumes[(((x - p[0]) / strip) as usize).min(strips - 1)] += p[3];
        }
        let depth = volumes.iter().fold(0.0, |a: f64, v| a.max(v / (strip * simulation.thickness())));
        let edge = head.first().map_or(x, |p| p[0]);
        Front { x: way * x, edge: way * edge, velocity: momentum / moving, depth }
    }
}

#[cfg(test)]
#[path = "front_tests.rs"]
mod tests;
