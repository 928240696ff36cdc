use super::*;

const H: f64 = 0.5;

fn vector(x: f64, y: f64) -> Vector2<f64> {
    Vector2::new(x, y)
}

fn near(a: Vector2<f64>, b: Vector2<f64>) -> bool {
    (a - b).norm() < 1e-14
}

fn plane(normal: Vector2<f64>) -> Boundary {
    Boundary::plane("plane", vector(1.0, 2.0), normal, Friction::Coulomb(0.3))
}

/// Foot at (2, 1), 4 m high, 1 m thick, upright; material on its left.
fn wall() -> Boundary {
    Boundary::wall("wall", vector(2.0, 1.0), vector(0.0, 3.0), 4.0, 1.0, Friction::Coulomb(0.3))
}

fn lift(speed: f64, opening: f64) -> Opening {
    Opening::Lift { speed, opening }
}

#[test]
fn friction_coefficients() {
    assert_eq!(Friction::Smooth.coefficient(), 0.0);
    assert_eq!(Friction::Coulomb(0.3).coefficient(), 0.3);
    assert_eq!(Friction::Rough.coefficient(), f64::INFINITY);
    assert_eq!(Friction::Bonded.coefficient(), f64::INFINITY);
}

#[test]
fn frames_are_orthonormal_and_look_into_the_material() {
    let p = plane(vector(-3.0, 4.0));
    assert!(near(p.normal, vector(-0.6, 0.8)) && near(p.tangent, vector(0.8, 0.6)));
    assert_eq!((p.foot(), p.height(), p.friction), (vector(1.0, 2.0), f64::INFINITY, Friction::Coulomb(0.3)));
    let leaning = Boundary::wall("wall", vector(2.0, 1.0), vector(-3.0, 4.0), 4.0, 1.0, Friction::Rough);
    assert!(near(leaning.tangent, vector(-0.6, 0.8)) && near(leaning.normal, vector(-0.8, -0.6)));
    assert_eq!((leaning.foot(), leaning.height(), leaning.friction), (vector(2.0, 1.0), 4.0, Friction::Rough));
    let right = leaning.facing_right();
    assert!(near(right.tangent, vector(-0.6, 0.8)) && near(right.normal, vector(0.8, 0.6)));
}

#[test]
fn coordinates_and_depth_of_a_plane() {
    let p = plane(vector(-3.0, 4.0));
    let x = vector(1.0, 2.0) + 0.7 * p.normal - 1.5 * p.tangent;
    let (d, s) = p.face_coordinates(x.into());
    assert!((d - 0.7).abs() < 1e-14 && (s + 1.5).abs() < 1e-14);
    assert!((p.depth(x.into()) + 0.7).abs() < 1e-14);
}

#[test]
fn depth_in_a_wall_is_the_way_out() {
    for (x, depth) in [
        ([2.25, 3.0], 0.25),
        ([2.75, 3.0], 0.25),
        ([2.5, 4.875], 0.125),
        ([2.5, 1.0625], 0.0625),
        ([1.5, 3.0], -0.5),
        ([3.25, 3.0], -0.25),
        ([2.5, 5.5], -0.5),
        ([2.5, 0.25], -0.75),
    ] {
        assert_eq!(wall().depth(x), depth, "{x:?}");
        let mut gate = wall().gate(lift(1.0, 3.0));
        gate.free_below = 1.0;
        let expected = depth.min(x[1] - 2.0);
        assert_eq!(gate.depth(x), expected, "{x:?} below a gate");
    }
}

/// Normal with which a boundary holds a point, and the position along its face.
fn held(b: &Boundary, x: [f64; 2], buried: bool) -> Option<([f64; 2], f64)> {
    b.hold(x, H, 0.01, buried).map(|c| (c.normal, c.along))
}

#[test]
fn a_plane_holds_what_is_not_in_front_of_it() {
    let p = plane(vector(0.0, 1.0));
    for (y, held_there) in [(-50.0, true), (2.0, true), (2.005, true), (2.015, false), (2.5, false)] {
        let expected = held_there.then_some(([0.0, 1.0], 3.0));
        assert_eq!(held(&p, [4.0, y], false), expected, "{y}");
    }
    assert!(held(&p, [4.0, 2.0 + 0.01], false).is_some(), "on the tolerance");
}

#[test]
fn a_clamp_holds_the_rows_nearest_to_its_plane() {
    // Rows of nodes H apart along the normal, the one behind the plane at all distances from it.
    let clamp = Boundary { friction: Friction::Bonded, ..plane(vector(-3.0, 4.0)) };
    let held = |d: f64| clamp.hold((vector(1.0, 2.0) + d * clamp.normal + clamp.tangent).into(), H, 1e-9, false);
    let mut deep = 0.0;
    for k in 0..100 {
        let behind = -H * f64::from(k) / 100.0;
        let last = if held(behind + H).is_some() { behind + H } else { behind };
        assert!(held(behind).is_some() && held(last + H).is_none() && last.abs() < 0.5 * H + 1e-12, "{behind} {last}");
        deep -= last / 100.0;
    }
    // 0.5 of a hundred: the row that lies half a cell behind, which as well as the one in front of it is the nearest.
    assert!((deep - 0.005 * H).abs() < 1e-9, "{deep}: the mean over all places is on the plane");
}

#[test]
fn a_wall_holds_with_the_side_that_is_nearest() {
    let (left, right, up) = ([-1.0, 0.0], [1.0, 0.0], [0.0, 1.0]);
    for (x, normal) in [
        ([2.0, 3.0], Some(left)),
        ([2.25, 3.0], Some(left)),
        ([2.5, 3.0], Some(left)),
        ([2.75, 3.0], Some(right)),
        ([3.0, 3.0], Some(right)),
        ([2.5, 4.75], Some(up)),
        ([2.125, 4.75], Some(left)),
        ([2.875, 4.75], Some(right)),
        ([2.25, 4.75], Some(left)),
        ([2.75, 4.75], Some(up)),
        ([2.5, 5.0], Some(up)),
        // Within the tolerance, and beyond it.
        ([1.995, 3.0], Some(left)),
        ([1.985, 3.0], None),
        ([3.005, 3.0], Some(right)),
        ([3.015, 3.0], None),
        ([2.5, 5.005], Some(up)),
        ([2.5, 5.015], None),
        ([2.125, 0.995], Some(left)),
        ([2.125, 0.985], None),
    ] {
        let found = held(&wall(), x, false);
        assert_eq!(found.map(|f| f.0), normal, "{x:?}");
        assert!(found.is_none_or(|f| f.1 == x[1] - 1.0), "{x:?}: {found:?}");
        // A gate acts with its face alone.
        let gate = wall().gate(Opening::Vanish);
        assert_eq!(held(&gate, x, false).map(|f| f.0), normal.map(|_| left), "{x:?}");
    }
}

#[test]
fn a_wall_continues_below_its_foot_inside_the_base_unless_it_is_a_lifted_gate() {
    let below = [2.0, -7.0];
    assert!(held(&wall(), below, true).is_some());
    assert!(held(&wall(), below, false).is_none());
    assert!(held(&wall(), [2.0, 5.5], true).is_none());
    let mut gate = wall().gate(lift(1.0, 3.0));
    assert!(held(&gate, below, true).is_some());
    gate.free_below = 1.0;
    assert!(held(&gate, below, true).is_none());
    assert!(held(&gate, [2.0, 1.985], true).is_none());
    assert!(held(&gate, [2.0, 1.995], true).is_some());
}

#[test]
fn edges_of_the_tolerance_belong_to_the_wall() {
    let on = |x| wall().hold(x, H, 0.125, false).is_some();
    for x in [[1.875, 3.0], [3.125, 3.0], [2.5, 5.125], [2.5, 0.875]] {
        assert!(on(x), "{x:?}");
    }
}

#[test]
fn a_moving_boundary_keeps_its_nodes_until_half_a_cell() {
    let velocity = vector(0.0, -2.0);
    for (time, level) in [(0.0, 2.0), (0.124, 2.0), (0.126, 1.5), (0.374, 1.5), (0.376, 1.0), (0.5, 1.0)] {
        for steps in [1, 2] {
            let mut p = plane(vector(0.0, 1.0));
            p.velocity = velocity;
            (0..steps).for_each(|_| p.advance(time / f64::from(steps)));
            assert!(near(p.travel, velocity * time) && near(p.foot(), vector(1.0, 2.0) + velocity * time));
            for (y, held_there) in [(level, true), (level + H, false)] {
                assert_eq!(p.hold([1.0, y], H, 1e-6, false).is_some(), held_there, "{time} {y}");
            }
        }
    }
    // The other way, and a wall.
    let mut w = wall();
    w.velocity = vector(2.0, 0.0);
    w.advance(0.126);
    assert!(near(w.foot(), vector(2.252, 1.0)) && near(w.travel, vector(0.252, 0.0)));
    assert!(w.hold([2.0, 3.0], H, 1e-6, false).is_none());
    assert!(w.hold([2.5, 3.0], H, 1e-6, false).is_some());
}

#[test]
fn a_gate_is_lifted_at_its_speed_up_to_its_opening() {
    let mut gate = wall().gate(lift(2.0, 3.0));
    gate.advance(0.5);
    assert_eq!(gate.free_below, 0.0, "it waits for its release");
    gate.release();
    assert!(gate.released && gate.free_below == 0.0 && !gate.is_gone());
    gate.advance(0.5);
    gate.advance(0.25);
    assert_eq!(gate.free_below, 1.5);
    gate.advance(10.0);
    assert_eq!(gate.free_below, 3.0);
    assert!(!gate.is_gone());
}

#[test]
fn a_gate_that_opens_beyond_its_height_or_at_once_is_gone() {
    for (opening, after) in [
        (Opening::Vanish, f64::INFINITY),
        (lift(f64::INFINITY, f64::INFINITY), f64::INFINITY),
        (lift(f64::INFINITY, 4.0), f64::INFINITY),
        (lift(f64::INFINITY, 3.0), 3.0),
        (lift(1.0, 8.0), 0.0),
    ] {
        let mut gate = wall().gate(opening);
        assert!(!gate.is_gone());
        gate.release();
        assert_eq!(gate.free_below, after, "{opening:?}");
        assert_eq!(gate.is_gone(), after.is_infinite());
    }
    let mut gate = wall().gate(lift(1.0, 8.0));
    gate.release();
    gate.advance(4.0);
    assert!(gate.is_gone());
}

#[test]
fn only_gates_can_be_released() {
    let mut w = wall();
    w.release();
    assert_eq!(w, wall());
    let p = plane(vector(0.0, 1.0)).gate(Opening::Vanish);
    assert_eq!((p.solid, p.opening), (plane(vector(0.0, 1.0)).solid, Some(Opening::Vanish)));
}

#[test]
fn friction_needs_slip_only_where_there_is_some() {
    let coulomb = Boundary { friction: Friction::Coulomb(0.4), ..plane(vector(0.0, 1.0)) };
    let law = coulomb.clone().mobilised(1e-3, 0.5).slip.expect("a law");
    assert_eq!((law.length, law.peak, law.kinetic), (1e-3, 0.5, 0.4));
    // Static friction is never less than kinetic.
    assert_eq!(coulomb.mobilised(1e-3, 0.3).slip.map(|l| l.peak), Some(0.4));
    for friction in [Friction::Smooth, Friction::Coulomb(0.0), Friction::Rough, Friction::Bonded] {
        let other = Boundary { friction, ..plane(vector(0.0, 1.0)) };
        assert_eq!(other.mobilised(1e-3, 0.0).slip, None);
    }
}
