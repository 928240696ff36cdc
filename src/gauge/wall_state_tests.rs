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
    let sim = simulation(0.25, [light, heavy], vec![wall(1.0), wall(1.0).only_for(&[1])]);
    let state = wall_state(&sim, 0, &[]);
    // One cell behind the face is not yet behind the wall; 1.5 cells before it still is at the wall.
    assert_eq!(state, WallState { run_up: 0.7, run_up_p95: 0.0, behind: 3.0 });
    // A barrier that stands behind has not gone over this one.
    assert_eq!(wall_state(&sim, 0, &[1]), WallState { behind: 1.0, ..state });
    // What a wall does not hold makes no run-up at it.
    assert_eq!(wall_state(&sim, 1, &[]), WallState { run_up: 0.0, ..state });
}

#[test]
fn a_percentile_is_that_of_twenty_points_or_more() {
    let column = |n: u32| (1..=n).rev().map(f64::from).collect::<Vec<_>>();
    assert_eq!(percentile(&mut column(19)), 0.0);
    assert_eq!(percentile(&mut column(20)), 19.0);
    assert_eq!(percentile(&mut column(100)), 95.0);
    // One point of a hundred that flies up changes next to nothing.
    let mut splash = column(100);
    splash[0] = 1e3;
    assert_eq!(percentile(&mut splash), 95.0);
    // Below the foot is no run-up.
    assert_eq!(percentile(&mut [-1.0; 30]), 0.0);
}
