use super::*;
use crate::boundary::search::{Found, find_holds};
use crate::boundary::{BoundaryContact, Opening};
use crate::grid::{ActiveGrid, Column};
use nalgebra::Vector2;

const M: f64 = 2.0;

pub(super) fn plane(normal: [f64; 2], friction: Friction) -> Boundary {
    Boundary::plane("plane", Vector2::zeros(), normal.into(), friction)
}

/// The holds of the boundaries on one node at `x`.
pub(super) fn holds_at(x: [f64; 2], boundaries: &[Boundary]) -> Vec<Hold> {
    let mut grid = ActiveGrid {
        corner: x,
        spacing: 1.0,
        inverse_spacing: 1.0,
        columns: vec![Column { start: 0, row: 0, rows: 1 }],
        ..ActiveGrid::default()
    };
    grid.index_columns();
    let mut found = Found::default();
    find_holds(boundaries, &[0], &grid, BoundaryContact::Nodes, &mut found);
    found.holds
}

/// Velocity after the contact of a node at `x`, and what each boundary tallied.
fn contact(boundaries: &[Boundary], x: [f64; 2], old: [f64; 2], free: [f64; 2]) -> ([f64; 2], Vec<Tally>, Vec<Hold>) {
    let mut holds = holds_at(x, boundaries);
    let mut tallies = vec![Tally::default(); boundaries.len()];
    let mut v = free;
    solve(&mut holds, boundaries, M, old, &mut v, &mut tallies);
    // Whatever happened: impulses change momentum, and works the kinetic energy.
    let mut impulse = [0.0; 2];
    let mut work = 0.0;
    for t in &tallies {
        impulse = [impulse[0] + t.impulse[0], impulse[1] + t.impulse[1]];
        work += t.friction_work + t.normal_work;
        let moment = x[0] * t.impulse[1] - x[1] * t.impulse[0];
        assert!((t.moment - moment).abs() < 1e-12, "{t:?}");
    }
    let mean = [0.5 * (old[0] + v[0]), 0.5 * (old[1] + v[1])];
    assert!((work - impulse[0] * mean[0] - impulse[1] * mean[1]).abs() < 1e-12);
    for d in 0..2 {
        assert!((impulse[d] - M * (v[d] - free[d])).abs() < 1e-12, "{impulse:?} {v:?}");
    }
    (v, tallies, holds)
}

fn close(a: [f64; 2], b: [f64; 2]) -> bool {
    (a[0] - b[0]).abs() < 1e-12 && (a[1] - b[1]).abs() < 1e-12
}

/// Components along the normal and along the tangent, for bases at several angles: the answers must not depend on them.
fn turned(angle: f64) -> (impl Fn(f64, f64) -> [f64; 2], [f64; 2]) {
    let (c, s) = (libm::cos(angle), libm::sin(angle));
    (move |n: f64, t: f64| [n * -s + t * c, n * c + t * s], [-s, c])
}

const ANGLES: [f64; 4] = [0.0, 0.5, -1.1, 2.6];

#[test]
fn a_smooth_plane_stops_approach_and_leaves_the_rest() {
    for angle in ANGLES {
        let (at, normal) = turned(angle);
        let base = [plane(normal, Friction::Smooth)];
        let (v, tallies, _) = contact(&base, at(0.0, 3.0), at(-3.0, 1.0), at(-3.5, 4.0));
        assert!(close(v, at(0.0, 4.0)), "{v:?}");
        assert!(close(tallies[0].impulse, at(7.0, 0.0)));
        assert!((tallies[0].normal_work + 7.0 * 1.5).abs() < 1e-12 && tallies[0].friction_work == 0.0);
        let (v, tallies, _) = contact(&base, at(0.0, 3.0), at(-3.0, 1.0), at(0.5, 4.0));
        assert!(close(v, at(0.5, 4.0)) && tallies[0] == Tally::default());
    }
}

#[test]
fn friction_takes_at_most_its_share_of_the_normal_impulse() {
    for angle in ANGLES {
        let (at, normal) = turned(angle);
        let base = [plane(normal, Friction::Coulomb(0.5))];
        for direction in [1.0, -1.0] {
            // It slips: 7 N s press, 3.5 N s brake.
            let (v, tallies, _) = contact(&base, at(-1.0, 2.0), at(-3.0, 5.0 * direction), at(-3.5, 4.0 * direction));
            assert!(close(v, at(0.0, 2.25 * direction)), "{v:?}");
            assert!(close(tallies[0].impulse, at(7.0, -3.5 * direction)));
            assert!((tallies[0].friction_work + 3.5 * 0.5 * (5.0 + 2.25)).abs() < 1e-12);
            assert!((tallies[0].normal_work + 7.0 * 1.5).abs() < 1e-12);
            // It sticks: 3 of 3.5 N s are enough.
            let (v, tallies, _) = contact(&base, at(-1.0, 2.0), at(0.0, 0.0), at(-3.5, 1.5 * direction));
            assert!(close(v, [0.0; 2]) && close(tallies[0].impulse, at(7.0, -3.0 * direction)));
            // It leaves.
            let (v, ..) = contact(&base, at(-1.0, 2.0), at(0.0, 0.0), at(0.1, 1.5 * direction));
            assert!(close(v, at(0.1, 1.5 * direction)));
        }
    }
}

#[test]
fn rough_boundaries_hold_back_sliding_and_bonded_ones_separation_too() {
    for (friction, free, expected) in [
        (Friction::Rough, [9.0, -0.1], [0.0, 0.0]),
        (Friction::Rough, [9.0, 0.0], [9.0, 0.0]),
        (Friction::Rough, [9.0, 0.1], [9.0, 0.1]),
        (Friction::Bonded, [9.0, -0.1], [0.0, 0.0]),
        (Friction::Bonded, [9.0, 0.0], [0.0, 0.0]),
        (Friction::Bonded, [9.0, 0.1], [0.0, 0.0]),
        (Friction::Coulomb(0.5), [9.0, 0.0], [9.0, 0.0]),
    ] {
        let (v, ..) = contact(&[plane([0.0, 1.0], friction)], [1.0, 0.0], [1.0, 0.0], free);
        assert!(close(v, expected), "{friction:?} {free:?}: {v:?}");
    }
}

#[test]
fn a_moving_boundary_gives_its_velocity() {
    for (friction, expected) in [
        (Friction::Smooth, [0.0, 2.0]),
        // 2 kg at 3 m/s towards it: 6 N s, of which 3 N s accelerate the node along it.
        (Friction::Coulomb(0.5), [1.5, 2.0]),
        (Friction::Coulomb(9.0), [5.0, 2.0]),
    ] {
        let mut base = plane([0.0, 1.0], friction);
        base.velocity = Vector2::new(5.0, 2.0);
        let (v, ..) = contact(&[base], [1.0, 0.0], [0.0, 0.0], [0.0, -1.0]);
        assert!(close(v, expected), "{friction:?}: {v:?}");
    }
}

#[test]
fn a_corner_is_no_special_case() {
    // Down and to the right into the corner of a base and a wall, with friction on both: each takes its own normal momentum,
    // and friction finds nothing left to brake.
    for friction in [Friction::Smooth, Friction::Coulomb(0.4), Friction::Rough] {
        let corner = [plane([0.0, 1.0], friction), plane([-1.0, 0.0], friction)];
        let (v, tallies, _) = contact(&corner, [0.0, 0.0], [3.0, -1.0], [3.0, -1.0]);
        assert!(close(v, [0.0; 2]));
        assert!(close(tallies[0].impulse, [0.0, 2.0]) && close(tallies[1].impulse, [-6.0, 0.0]), "{tallies:?}");
        // Up along the wall, out of the base: friction of the wall alone.
        let (v, tallies, _) = contact(&corner, [0.0, 0.0], [0.0; 2], [3.0, 4.0]);
        let braked = (friction.coefficient().min(100.0) * 6.0).min(8.0);
        assert!(close(v, [0.0, 4.0 - braked / M]), "{friction:?} {v:?}");
        assert!(close(tallies[1].impulse, [-6.0, -braked]) && close(tallies[0].impulse, [0.0; 2]));
    }
}

#[test]
fn an_acute_corner_lets_nothing_in_and_holds_nothing_back() {
    // Planes at 60 degrees: their impulses feed each other.
    let (c, s) = (0.5, 0.75f64.sqrt());
    let corner = [plane([0.0, 1.0], Friction::Smooth), plane([-s, -c], Friction::Smooth)];
    let (v, tallies, _) = contact(&corner, [0.0, 0.0], [1.0, 0.0], [1.0, 0.2]);
    // Wedged: both hold, v = 0. Impulses from balance: -s b = -2 and a - c b = -0.4.
    let b = M / s;
    assert!(v[0].abs() < 1e-4 && v[1].abs() < 1e-4, "{v:?}");
    assert!((tallies[1].impulse[0] + s * b).abs() < 1e-3 && (tallies[0].impulse[1] - (c * b - 0.4)).abs() < 1e-3);
    // Out of the corner: free.
    let (v, ..) = contact(&corner, [0.0, 0.0], [1.0, 0.0], [-1.0, 0.0]);
    assert!(close(v, [-1.0, 0.0]));
}

#[test]
fn tallies_add_up() {
    let one = Tally { impulse: [1.0, 2.0], moment: 3.0, friction_work: 4.0, normal_work: 5.0 };
    let mut sum = Tally { impulse: [10.0, 20.0], moment: 30.0, friction_work: 40.0, normal_work: 50.0 };
    sum.add(&one);
    assert_eq!(sum, Tally { impulse: [11.0, 22.0], moment: 33.0, friction_work: 44.0, normal_work: 55.0 });
    // Of several nodes: the second contact adds to the first.
    let base = [plane([0.0, 1.0], Friction::Smooth)];
    let mut tallies = [Tally::default()];
    for x in [1.0, 3.0] {
        solve(&mut holds_at([x, 0.0], &base), &base, M, [0.0, -1.0], &mut [0.0, -1.0], &mut tallies);
    }
    assert_eq!(tallies[0].impulse, [0.0, 4.0]);
    assert_eq!(tallies[0].moment, 8.0);
    assert_eq!(tallies[0].normal_work, -2.0);
}

#[test]
fn a_second_step_starts_from_nothing() {
    let corner = [plane([0.0, 1.0], Friction::Coulomb(0.4)), plane([-1.0, 0.0], Friction::Coulomb(0.4))];
    for boundaries in [&corner[..1], &corner[..]] {
        let mut holds = holds_at([0.0, 0.0], boundaries);
        let mut answers = Vec::new();
        for _ in 0..2 {
            let mut v = [1.0, -3.0];
            let mut tallies = vec![Tally::default(); boundaries.len()];
            solve(&mut holds, boundaries, M, v, &mut v, &mut tallies);
            answers.push((v, tallies));
        }
        assert_eq!(answers[0], answers[1]);
    }
}

#[test]
fn a_lifted_gate_holds_only_what_is_above_its_edge() {
    let mut gate = [Boundary::wall("gate", Vector2::zeros(), Vector2::new(0.0, 1.0), 4.0, 1.0, Friction::Smooth)
        .gate(Opening::Lift { speed: 1.0, opening: 3.0 })];
    let stopped = |holds: &mut [Hold], gate: &[Boundary]| {
        let mut v = [1.0, 0.0];
        let mut tallies = [Tally::default()];
        solve(holds, gate, M, [1.0, 0.0], &mut v, &mut tallies);
        assert_eq!(tallies[0].impulse[0], M * (v[0] - 1.0));
        v[0] == 0.0
    };
    // The nodes are found while it is shut.
    let mut holds = [0.0, 1.0, 2.0].map(|y| holds_at([0.0, y], &gate));
    assert!(holds.iter().all(|h| h.len() == 1));
    for (free, expected) in [(0.0, [true, true, true]), (1.0, [false, true, true]), (1.5, [false, false, true])] {
        gate[0].free_below = free;
        for (h, expected) in holds.iter_mut().zip(expected) {
            assert_eq!(stopped(h, &gate), expected, "{free}");
            // What does not hold does not act on strain velocities, either.
            let mut v = [1.0, 0.0];
            project(h, &mut v, |_, _| {});
            assert_eq!(v[0] == 0.0, expected);
        }
    }
}

#[test]
fn strain_velocities_follow_the_state_of_the_contact() {
    let slope = 0.3;
    let (at, normal) = turned(slope);
    let wall = at(-0.2, 0.5);
    let after = |friction, free: [f64; 2], field: [f64; 2]| {
        let mut base = plane(normal, friction);
        base.velocity = wall.into();
        let base = [base];
        let mut holds = holds_at([0.0, 0.0], &base);
        let mut v = free;
        solve(&mut holds, &base, M, free, &mut v, &mut [Tally::default()]);
        let mut field = field;
        project(&holds, &mut field, |_, _| {});
        field
    };
    // Sticking: with the boundary. Slipping: nothing into it, and what separates stays. Apart: free.
    assert_eq!(after(Friction::Rough, at(-1.0, 2.0), at(3.0, 3.0)), wall);
    assert_eq!(after(Friction::Bonded, at(1.0, 2.0), at(3.0, 3.0)), wall);
    assert_eq!(after(Friction::Coulomb(5.0), at(-1.0, 1.0), at(-3.0, 3.0)), wall);
    assert!(close(after(Friction::Coulomb(0.1), at(-1.0, 9.0), at(-3.0, 3.0)), at(-0.2, 3.0)));
    assert!(close(after(Friction::Coulomb(0.1), at(-1.0, 9.0), at(3.0, 3.0)), at(3.0, 3.0)));
    assert!(close(after(Friction::Smooth, at(-1.0, 0.5), at(-3.0, 3.0)), at(-0.2, 3.0)));
    assert!(close(after(Friction::Rough, at(1.0, 2.0), at(-3.0, 3.0)), at(-3.0, 3.0)));
}

#[test]
fn strain_velocities_in_a_corner_enter_neither_side() {
    let c = 0.5f64.sqrt();
    let wedge = [plane([0.0, 1.0], Friction::Smooth), plane([-c, c], Friction::Smooth)];
    let mut holds = holds_at([0.0, 0.0], &wedge);
    let mut v = [2.0, -1.0];
    solve(&mut holds, &wedge, M, v, &mut v, &mut [Tally::default(); 2]);
    let mut field = [2.0, -1.0];
    project(&holds, &mut field, |_, _| {});
    assert!(field[1] >= -1e-12 && c * (field[1] - field[0]) >= -0.1, "{field:?}");
}

#[test]
fn projection_into_a_wedge_leaves_by_neither_face() {
    // Faces at 70 degrees to each other: what one takes away the other gives back in part.
    let (c, s) = (libm::cos(1.2), libm::sin(1.2));
    let wedge = [plane([0.0, 1.0], Friction::Smooth), plane([s, -c], Friction::Smooth)];
    let mut holds = holds_at([0.0, 0.0], &wedge);
    let mut tallies = [Tally::default(); 2];
    let mut v = [-1.0, -0.2];
    solve(&mut holds, &wedge, M, v, &mut v, &mut tallies);
    let mut v = [-1.0, -0.2];
    project(&holds, &mut v, |_, _| {});
    assert!(v[1] > -0.01 && v[0] * s - v[1] * c > -0.01, "{v:?}");
}

#[test]
fn a_clamp_prescribes_its_velocity_while_it_is_closed() {
    let gate = |friction| {
        let wall = Boundary::wall("gate", Vector2::zeros(), Vector2::new(0.0, 1.0), 1.0, 1.0, friction);
        Boundary { velocity: Vector2::new(0.1, 0.2), ..wall.gate(Opening::Vanish) }
    };
    let held = |boundary: &Boundary| holds_at([0.0, 0.5], std::slice::from_ref(boundary))[0];
    let mut clamp = gate(Friction::Bonded);
    let hold = held(&clamp);
    assert_eq!(hold.clamped(std::slice::from_ref(&clamp)), Some([0.1, 0.2]));
    clamp.release();
    assert_eq!(hold.clamped(&[clamp]), None);
    let mut rough = gate(Friction::Rough);
    let hold = held(&rough);
    assert_eq!(hold.clamped(std::slice::from_ref(&rough)), None);
    rough.release();
    assert_eq!(hold.clamped(&[rough]), None);
}

#[test]
fn a_node_that_nothing_reaches_keeps_no_impulse() {
    let (_, _, mut holds) = contact(&[plane([0.0, 1.0], Friction::Coulomb(0.4))], [0.0, 0.0], [0.0; 2], [0.3, -1.0]);
    assert!(holds[0].vector_impulse()[1] > 0.0);
    holds.iter_mut().for_each(Hold::let_go);
    assert_eq!(holds[0].vector_impulse(), [0.0; 2]);
    // Nor does it hold what strains the material.
    let mut v = [0.3, -1.0];
    project(&holds, &mut v, |_, _| {});
    assert_eq!(v, [0.3, -1.0]);
}
