//! What flows, and how much motion is in it.

use crate::body::{Block, Particle};
use crate::lanes::{LANES, Lane};
use crate::seeded::{self, Seed};
use crate::simulation::{Extent, Simulation};

/// Points that have come apart count with at most this volume ratio in depths.
pub(super) const MAX_VOLUME_RATIO: f64 = 1.5;

/// The points of everything that flows: of all bodies but those that are `barriers`, by index, and those without weight, which are
/// structures, with the index of their body.
pub fn flowing(simulation: &Simulation, barriers: &[usize]) -> impl Iterator<Item = (usize, Particle)> {
    simulation.particles().filter(move |(body, _)| !barriers.contains(body) && may_flow(simulation, *body))
}

/// Whether a body, by its index, may flow: one without weight is a structure.
pub(super) fn may_flow(simulation: &Simulation, body: usize) -> bool {
    !simulation.bodies()[body].weightless
}

/// The blocks of points of everything that flows (see [`flowing`]), in the same order: index of the body, block, number of real
/// points.
pub(super) fn flowing_blocks<'a>(
    simulation: &'a Simulation,
    barriers: &'a [usize],
) -> impl Iterator<Item = (usize, &'a Block, usize)> {
    simulation.blocks().filter(move |(body, ..)| !barriers.contains(body) && may_flow(simulation, *body))
}

/// The boxes of those blocks, in the same order.
pub(super) fn flowing_extents<'a>(
    simulation: &'a Simulation,
    barriers: &'a [usize],
) -> impl Iterator<Item = &'a Extent> {
    simulation.extents().iter().filter(move |e| !barriers.contains(&e.body) && may_flow(simulation, e.body))
}

/// What flows, when it has not moved yet.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Released {
    /// kg.
    pub mass: f64,
    /// m3.
    pub volume: f64,
    /// Its centre of mass along x, m.
    pub centre: f64,
    /// Along x, N s.
    pub momentum: f64,
}

/// Mass, volume, centre and momentum of what flows (see [`flowing`]).
pub fn released(simulation: &Simulation, barriers: &[usize]) -> Released {
    let mut sum = Released::default();
    flowing_blocks(simulation, barriers).for_each(|(body, block, n)| {
        let body = &simulation.bodies()[body];
        for l in 0..n {
            sum.mass += body.point_mass;
            sum.volume += body.point_volume * block.volume_ratio[l];
            sum.centre += body.point_mass * block.x[0][l];
            sum.momentum += body.point_mass * block.v[0][l];
        }
    });
    sum.centre /= sum.mass.max(f64::MIN_POSITIVE);
    sum
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
    // Lane by lane over all blocks, and at the end over the lanes.
    let mut lanes: [Lane; 3] = [[0.0; LANES]; 3];
    simulation.blocks().filter(|(body, ..)| chosen(*body)).for_each(|(body, block, n)| {
        let (m, [vx, vy]) = (simulation.bodies()[body].point_mass, &block.v);
        let mut add = |n: usize| {
            for l in 0..n {
                lanes[0][l] += m * vx[l];
                lanes[1][l] += m * vy[l];
                lanes[2][l] += 0.5 * m * (vx[l] * vx[l] + vy[l] * vy[l]);
            }
        };
        if n == LANES {
            add(LANES)
        } else {
            add(n)
        }
        sum.mass += m * n as f64;
    });
    let [x, y, kinetic] = lanes.map(|lane| lane.iter().sum());
    (sum.momentum, sum.kinetic) = ([x, y], kinetic);
    sum.kinetic = seeded::times(Seed::GaugeKinetic, sum.kinetic);
    sum
}

#[cfg(test)]
#[path = "flow_tests.rs"]
mod tests;
