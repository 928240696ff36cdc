//! Material at a wall: how high it has run up, how much of it is behind.

use super::beside::{acts_on, beside};
use crate::seeded::{self, Seed};
use crate::simulation::Simulation;

/// Material at a wall.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WallState {
    /// Highest point within 1.5 cells of the face, m above the foot.
    pub run_up: f64,
    /// 95th percentile of the heights of these points.
    pub run_up_p95: f64,
    /// Mass that is more than a cell behind the face now, kg.
    pub behind: f64,
}

/// What is at a wall now. Bodies that are `structures`, by index, are left out; those on which it does not act make no run-up.
pub fn wall_state(simulation: &Simulation, boundary: usize, structures: &[usize]) -> WallState {
    let b = &simulation.boundaries()[boundary];
    let h = simulation.spacing();
    let mut state = WallState::default();
    let mut heights = Vec::new();
    beside(simulation, b, 1.5 * h, |body| !structures.contains(&body)).for_each(|near| {
        let (d, s) = b.face_coordinates(near.x());
        if d < -h {
            state.behind += simulation.bodies()[near.body].point_mass;
        } else if acts_on(b, near.body) {
            let wrong = seeded::is(Seed::GaugeRunUp);
            state.run_up = state.run_up.max(if wrong { s + b.foot().dot(&b.tangent) } else { s });
            heights.push(s);
        }
    });
    state.run_up_p95 = percentile(&mut heights);
    state
}

/// Points of which one in twenty is a point: fewer have no 95th percentile.
const TWENTY: usize = 20;

/// Height (m) below which 95 % of the points at a wall lie; zero if they are fewer than twenty, so that single points that fly up make no
/// run-up. In a full column it is 5 % below the surface.
pub(in crate::gauge) fn percentile(heights: &mut [f64]) -> f64 {
    if heights.len() < TWENTY {
        return 0.0;
    }
    let share = if seeded::is(Seed::GaugePercentile) { 18 } else { 19 };
    let rank = (heights.len() * share).div_ceil(TWENTY) - 1;
    heights.select_nth_unstable_by(rank, f64::total_cmp).1.max(0.0)
}

#[cfg(test)]
#[path = "wall_state_tests.rs"]
mod tests;
