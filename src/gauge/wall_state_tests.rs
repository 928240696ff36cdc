use super::super::two_bodies::{point, simulation};
use super::*;
use crate::boundary::{Boundary, Friction};
use nalgebra::Vector2;

/// A vertical wall at `x` from y = 0, 1 m high, with the material on its left.
fn wall(x: f64) -> Boundary {
    Boundary::wall("wall", Vector2::new(x, 0.0), Vector2::new(0.0, 1.0), 1.0, 0.1, Friction::Smooth)
}

#[test]
fn run_up_counts_at_the_face_and_not_behind_it() {
    // Distances from the face of the wall at x = 1: positive to its left. Cells of 0.25 m.
    let light = vec![
        point(0.75, 0.4, [0.0; 2], 1.0),
        point(0.625, 0.6, [0.0; 2], 1.0),
        point(0.5, 0.9, [0.0; 2], 1.0),
        point(1.25, 0.7, [0.0; 2], 1.0),
        point(1.375, 0.8, [0.0; 2], 1.0),
    ];
    let heavy = vec![point(3.0, 0.95, [0.0; 2], 1.0)];
    let sim = simulation(0.25, [light, heavy], vec![wall(1.0)]);
    let state = wall_state(&sim, 0);
    // One cell behind the face is not yet behind the wall; 1.5 cells before it still is at the wall.
    assert_eq!(state, WallState { run_up: 0.7, behind: 3.0 });
}
