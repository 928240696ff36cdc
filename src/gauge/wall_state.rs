//! Material at a wall: how high it has run up, how much of it is behind.

use super::beside::beside;
use crate::simulation::Simulation;

/// Material at a wall.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WallState {
    /// Highest point within 1.5 cells of the face, m above the foot.
    pub run_up: f64,
    /// Mass that is more than a cell behind the face now, kg.
    pub behind: f64,
}

/// What is at a wall now.
pub fn wall_state(simulation: &Simulation, boundary: usize) -> WallState {
    let b = &simulation.boundaries()[boundary];
    let h = simulation.spacing();
    let mut state = WallState::default();
    beside(b, 1.5 * h, simulation.blocks()).for_each(|near| {
        let (d, s) = b.face_coordinates(near.x());
        if d < -h {
            state.behind += simulation.bodies()[near.body].point_mass;
        } else {
            state.run_up = state.run_up.max(s);
        }
    });
    state
}

#[cfg(test)]
#[path = "wall_state_tests.rs"]
mod tests;
