//! Lengths and forces that the flow is measured by: ratios to what flows, unless the case gives them.
//!
//! Elsewhere: characteristic scales.

use super::clock::METER_S;
use crate::boundary::{Boundary, Solid};
use crate::case::Case;
use crate::gauge::flow::{Released, released};
use crate::seeded::{self, Seed};
use crate::simulation::Simulation;
use serde::Serialize;

/// The length behind the front over which its velocity is averaged, as a share of the square root of the area of what flows at the start:
/// 0.05 m for the 0.2 m x 0.5 m of a laboratory flume. Depth and velocity are then read at the same place of a flow on any scale.
const FRONT: f64 = 0.158;
/// The weight of what flows at the start over the force from which it counts as arrived: 0.5 N of 30 kg.
const ARRIVED: f64 = 600.0;

/// What the flow was measured by.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Scales {
    /// Where the flow runs along x: 1 to the right, -1 to the left. Towards the first barrier that is a wall or a body; without one, where
    /// gravity points along x, else where the material moves at the start, else to the right.
    pub flow_direction_1: f64,
    /// Length behind the front over which its velocity is averaged, m; its depth is the largest within twice that length. Of an inflow it is the
    /// depth of that, if it is more than that of what lies there at the start.
    pub front_length_m: f64,
    /// Force on a barrier from which the flow counts as arrived, N: a 600th of the weight of what flows at the start, with a square of the depth
    /// of each inflow.
    pub arrival_force_n: f64,
    /// Density of what flows, at the start, kg/m3.
    pub flow_density_kg_per_m3: f64,
    /// Fastest P-wave in it, m/s.
    pub flow_wave_speed_m_per_s: f64,
    /// Steps are summed over this time before means, peaks, arrivals and times are taken of them, s; a longer step counts by itself. It does
    /// not depend on `gauges.sample_rate_hz`, which is that of the tables.
    pub resolution_s: f64,
}

impl Scales {
    /// Those of a case whose bodies have not moved yet; `structures` are the bodies, by index, that do not flow, and `barrier` is the face
    /// of the first barrier.
    pub(super) fn new(case: &Case, simulation: &Simulation, structures: &[usize], barrier: Option<&Boundary>) -> Self {
        let Released { mut mass, mut volume, mut centre, mut momentum } = released(simulation, structures);
        let g = case.gravity.magnitude_m_per_s2;
        let gauges = &case.gauges;
        let mut area = volume / simulation.thickness();
        // Of what flows in, a square of its depth.
        for inflow in &case.inflows {
            let deep = inflow.deepest_m();
            let square = deep * deep * case.grid.thickness_m;
            let own = square * case.materials.get(&inflow.material).map_or(0.0, |m| m.density_kg_per_m3);
            centre = (mass * centre + own * inflow.foot_m[0]) / (mass + own);
            momentum += own * inflow.direction() * inflow.fastest_m_per_s();
            (mass, volume) = (mass + own, volume + square);
            area = area.max((deep / FRONT) * (deep / FRONT));
        }
        let face = barrier.filter(|b| matches!(b.solid, Solid::Slab { .. }));
        let down = libm::sin(case.gravity.inclination_deg.to_radians());
        let ways = [face.map_or(0.0, |b| b.foot().x - centre), down * f64::from(u8::from(g > 0.0)), momentum];
        let way = ways.into_iter().find(|way| way.abs() > 1e-12).unwrap_or(1.0);
        let flows = |b: &usize| !structures.contains(b) && !simulation.bodies()[*b].weightless;
        let speeds = (0..simulation.bodies().len()).filter(flows).map(|b| simulation.bodies()[b].p_wave_speed());
        Self {
            flow_direction_1: way.signum(),
            front_length_m: gauges.front_length_m.unwrap_or(seeded::times(Seed::RunFrontLength, FRONT * area.sqrt())),
            arrival_force_n: gauges.arrival_force_n.unwrap_or(seeded::times(Seed::RunArrival, mass * g / ARRIVED)),
            flow_density_kg_per_m3: if volume > 0.0 { seeded::times(Seed::RunDensity, mass / volume) } else { 0.0 },
            flow_wave_speed_m_per_s: speeds.fold(0.0, f64::max),
            resolution_s: METER_S,
        }
    }

    /// 1 if the tangent of a boundary points where the flow runs, -1 if it points back.
    pub(super) fn along(&self, boundary: &Boundary) -> f64 {
        if self.flow_direction_1 * boundary.tangent.x < -1e-9 { -1.0 } else { 1.0 }
    }
}
