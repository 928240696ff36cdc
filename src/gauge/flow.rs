//! Front, depth, velocity, run-up and overtopping.

use super::beside::beside;
use crate::body::{Block, Particle};
use crate::boundary::{Boundary, Friction};
use crate::simulation::Simulation;

/// Share of the mass ahead of what counts as the front: single grains do not.
pub const FRONT_SHARE: f64 = 0.01;
/// Length behind the front over which its velocity is averaged, m.
pub const FRONT_LENGTH: f64 = 0.05;

/// The front along x.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Front {
    /// Position that 1 % of the mass has passed, m.
    pub x: f64,
    /// Mean velocity along x of the mass within 0.05 m behind it (and all ahead), m/s.
    pub velocity: f64,
    /// Largest flow depth within 0.1 m behind it, m.
    pub depth: f64,
}

/// The points of everything that flows: of all bodies but those that are `barriers`, by index, and those without weight, which are
/// structures, with the index of their body.
pub fn flowing(simulation: &Simulation, barriers: &[usize]) -> impl Iterator<Item = (usize, Particle)> {
    simulation.particles().filter(move |(body, _)| !barriers.contains(body) && !simulation.bodies()[*body].weightless)
}

/// The blocks of points of everything that flows (see [`flowing`]), in the same order: index of the body, block, number of real
/// points.
pub(super) fn flowing_blocks<'a>(
    simulation: &'a Simulation,
    barriers: &'a [usize],
) -> impl Iterator<Item = (usize, &'a Block, usize)> {
    simulation.blocks().filter(move |(body, ..)| !barriers.contains(body) && !simulation.bodies()[*body].weightless)
}

/// Mass, momentum and kinetic energy of some bodies.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Motion {
    /// kg.
    pub mass: f64,
    /// N s.
    pub momentum: [f64; 2],
    /// J.
    pub kinetic: f64,
}

/// How the bodies move that are `chosen` by index: what [`Simulation::stock_of`] says of it, without the energies that are stored.
pub fn motion(simulation: &Simulation, chosen: impl Fn(usize) -> bool) -> Motion {
    let mut sum = Motion::default();
    simulation.blocks().filter(|(body, ..)| chosen(*body)).for_each(|(body, block, n)| {
        let m = simulation.bodies()[body].point_mass;
        for (vx, vy) in block.v[0][..n].iter().zip(&block.v[1][..n]) {
            sum.mass += m;
            sum.momentum[0] += m * vx;
            sum.momentum[1] += m * vy;
            sum.kinetic += 0.5 * m * (vx * vx + vy * vy);
        }
    });
    sum
}

/// A point of the flow's head: x (m), velocity along x (m/s), mass (kg), volume (m3).
type HeadPoint = [f64; 4];

/// Memory that [`front`] works in.
#[derive(Debug, Clone, Default)]
pub struct FrontScratch {
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

/// Finds the front of the flow (see [`flowing`]). `scratch` is memory to reuse.
///
/// Sums run from the foremost point backwards. Only the head is put in order: where the front is follows from how many points
/// are ahead of it. That needs points of one mass and no two at the same x; else all of them are sorted.
pub fn front(simulation: &Simulation, barriers: &[usize], scratch: &mut FrontScratch) -> Front {
    let bodies = simulation.bodies();
    let FrontScratch { keys, order, found, head } = scratch;
    keys.clear();
    let (mut one_mass, mut of_point) = (true, None);
    flowing_blocks(simulation, barriers).for_each(|(body, block, n)| {
        one_mass &= bodies[body].point_mass == *of_point.get_or_insert(bodies[body].point_mass);
        keys.extend(block.x[0][..n].iter().map(|x| key(*x)));
    });
    let (Some(of_point), count) = (of_point, keys.len()) else { return Front::default() };
    // Depth from the volume in strips of two cells.
    let strip = 2.0 * simulation.spacing();
    let strips = (0.1 / strip).round().max(1.0) as usize;
    let depth_reach = strips as f64 * strip;

    let find = |least: f64, found: &mut Vec<HeadPoint>| {
        found.clear();
        flowing_blocks(simulation, barriers).for_each(|(body, block, n)| {
            let body = &bodies[body];
            for l in (0..n).filter(|&l| block.x[0][l] >= least) {
                let volume = body.point_volume * block.volume_ratio[l].min(MAX_VOLUME_RATIO);
                found.push([block.x[0][l], block.v[0][l], body.point_mass, volume]);
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
        find((x - FRONT_LENGTH).min(x - depth_reach), found);
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
    for [_, v, m, _] in head.iter().take_while(|p| p[0] >= x - FRONT_LENGTH) {
        momentum += m * v;
        moving += m;
    }
    let mut volumes = vec![0.0; strips];
    for p in head.iter().skip_while(|p| p[0] > x).take_while(|p| p[0] > x - depth_reach) {
        volumes[(((x - p[0]) / strip) as usize).min(strips - 1)] += p[3];
    }
    let depth = volumes.iter().fold(0.0, |a: f64, v| a.max(v / (strip * simulation.thickness())));
    Front { x, velocity: momentum / moving, depth }
}

/// Points that have come apart count with at most this volume ratio in depths.
const MAX_VOLUME_RATIO: f64 = 1.5;

/// Depth (m) and mean velocity along x (m/s) in a strip two cells wide around each station.
pub fn stations(simulation: &Simulation, barriers: &[usize], at: &[f64]) -> Vec<(f64, f64)> {
    let h = simulation.spacing();
    let mut sums = vec![(0.0, 0.0, 0.0); at.len()];
    flowing_blocks(simulation, barriers).for_each(|(body, block, n)| {
        let body = &simulation.bodies()[body];
        for (sum, &x) in sums.iter_mut().zip(at) {
            for l in (0..n).filter(|&l| (block.x[0][l] - x).abs() <= h) {
                sum.0 += body.point_volume * block.volume_ratio[l].min(MAX_VOLUME_RATIO);
                sum.1 += body.point_mass;
                sum.2 += body.point_mass * block.v[0][l];
            }
        }
    });
    let area = 2.0 * h * simulation.thickness();
    sums.iter().map(|&(v, m, mv)| (v / area, if m > 0.0 { mv / m } else { 0.0 })).collect()
}

/// Material at a wall.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WallState {
    /// Highest point within 1.5 cells of the face, m above the foot.
    pub run_up: f64,
    /// Mass behind the face, there or already out of the domain, kg: it has gone over.
    pub overtopped: f64,
}

/// Run-up and overtopping at a wall.
pub fn wall_state(simulation: &Simulation, boundary: usize) -> WallState {
    let b = &simulation.boundaries()[boundary];
    let h = simulation.spacing();
    let gone = simulation.ledger().departed_behind[boundary];
    let mut state = WallState { overtopped: gone, ..WallState::default() };
    beside(b, 1.5 * h, simulation.blocks()).for_each(|near| {
        let (d, s) = b.face_coordinates(near.x());
        if d < -h {
            state.overtopped += simulation.bodies()[near.body].point_mass;
        } else {
            state.run_up = state.run_up.max(s);
        }
    });
    state
}

/// Deepest that any point lies inside any boundary that acts on it, m, and the boundary's index. Clamps hold what lies in them and
/// do not count.
pub fn penetration(simulation: &Simulation) -> (f64, usize) {
    let mut deepest = (0.0, 0);
    let solid = |b: &Boundary| !b.is_gone() && b.friction != Friction::Bonded;
    for (index, b) in simulation.boundaries().iter().enumerate().filter(|(_, b)| solid(b)) {
        // What lies in front of its face is in no boundary.
        beside(b, 0.0, simulation.blocks().filter(|(body, ..)| b.acts_on(&[*body]))).for_each(|near| {
            let depth = b.depth(near.x());
            if depth > deepest.0 {
                deepest = (depth, index);
            }
        });
    }
    deepest
}

/// A rectangle in which velocities are read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Extent along x, m.
    pub x: [f64; 2],
    /// Extent along y, m.
    pub y: [f64; 2],
}

impl Window {
    fn contains(&self, x: [f64; 2]) -> bool {
        x[0] >= self.x[0] && x[0] <= self.x[1] && x[1] >= self.y[0] && x[1] <= self.y[1]
    }
}

/// Mean and 95th percentile of the speed of the material in a window, m/s; zero where it is empty.
pub fn window_speed(
    simulation: &Simulation,
    barriers: &[usize],
    window: &Window,
    scratch: &mut Vec<f64>,
) -> (f64, f64) {
    scratch.clear();
    flowing_blocks(simulation, barriers).for_each(|(_, block, n)| {
        let inside = (0..n).filter(|&l| window.contains([block.x[0][l], block.x[1][l]]));
        scratch.extend(inside.map(|l| block.get(l, 0).speed()));
    });
    if scratch.is_empty() {
        return (0.0, 0.0);
    }
    let mean = scratch.iter().sum::<f64>() / scratch.len() as f64;
    let high = ((scratch.len() - 1) as f64 * 0.95).round() as usize;
    (mean, *scratch.select_nth_unstable_by(high, f64::total_cmp).1)
}

/// One grid cell of a velocity field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FieldCell {
    /// Centre, m.
    pub x: [f64; 2],
    /// Share of the cell's volume filled with material.
    pub fill: f64,
    /// Mass-weighted mean velocity, m/s.
    pub v: [f64; 2],
    /// Mass-weighted mean of the pressure (a third of the trace of the stress, positive in compression), Pa.
    pub pressure: f64,
    /// Mass-weighted mean of the equivalent plastic shear strain since the start.
    pub plastic_shear: f64,
}

/// Means in the grid cells that hold material, column by column.
pub fn velocity_field(simulation: &Simulation, barriers: &[usize]) -> Vec<FieldCell> {
    let h = simulation.spacing();
    let mut points: Vec<_> = flowing(simulation, barriers)
        .map(|(b, p)| {
            let body = &simulation.bodies()[b];
            let cell = ((p.x[0] / h).floor() as i64, (p.x[1] / h).floor() as i64);
            (cell, body.point_mass, body.point_volume * p.volume_ratio.min(MAX_VOLUME_RATIO), p)
        })
        .collect();
    points.sort_by_key(|p| p.0);
    points
        .chunk_by(|a, b| a.0 == b.0)
        .map(|cell| {
            let (mut mass, mut volume, mut momentum, mut pressure, mut shear) = (0.0, 0.0, [0.0; 2], 0.0, 0.0);
            for (_, m, v, p) in cell {
                mass += m;
                volume += v;
                momentum[0] += m * p.v[0];
                momentum[1] += m * p.v[1];
                pressure -= m * p.state.stress.mean();
                shear += m * p.state.plastic_shear;
            }
            let (i, j) = cell[0].0;
            FieldCell {
                x: [(i as f64 + 0.5) * h, (j as f64 + 0.5) * h],
                fill: volume / (h * h * simulation.thickness()),
                v: [momentum[0] / mass, momentum[1] / mass],
                pressure: pressure / mass,
                plastic_shear: shear / mass,
            }
        })
        .collect()
}

#[cfg(test)]
#[path = "flow_tests.rs"]
mod tests;
