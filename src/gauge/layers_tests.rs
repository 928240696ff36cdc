use super::*;
use crate::body::Particle;
use crate::boundary::{Boundary, Friction};
use crate::constitutive::{AnyLaw, LinearElastic, PointState, Stress};
use crate::scaffold::{Brick, THICKNESS, scene};
use nalgebra::Vector2;

const H: f64 = 0.02;
const RATIO: f64 = 1.25;

/// A wall 4 cells high that leans by `angle`, material on its right, and a simulation of what `points` makes of a brick of
/// `cells` cells in front of it: it is given distance from the wall, height above its foot, and the point.
fn force(angle: f64, cells: [usize; 2], per_cell: usize, points: impl Fn(f64, f64, &mut Particle) -> bool) -> [f64; 3] {
    force_on(angle, cells, per_cell, points, &[])
}

/// The same of a wall that acts on these bodies alone, or on all if there are none.
fn force_on(
    angle: f64,
    cells: [usize; 2],
    per_cell: usize,
    points: impl Fn(f64, f64, &mut Particle) -> bool,
    bodies: &[usize],
) -> [f64; 3] {
    let foot = Vector2::new(0.3, 0.1);
    let tangent = Vector2::new(-angle.sin(), angle.cos());
    let wall = Boundary::wall("wall", foot, tangent, 4.0 * H, H, Friction::Smooth).facing_right().only_for(bodies);
    let brick = Brick { angle, per_cell, ..Brick::new(foot.into(), cells, H) };
    let mut inside = brick.points();
    inside.retain_mut(|p| {
        let (d, s) = wall.face_coordinates(p.x);
        p.volume_ratio = RATIO;
        points(d, s, p)
    });
    let law = AnyLaw::LinearElastic(LinearElastic::new(1e4, 0.0));
    let sim = Simulation::new(scene(&brick, law, 1000.0, inside, vec![wall]));
    normal_force(&sim, 0)
}

fn close(force: [f64; 3], expected: [f64; 3]) -> bool {
    force.iter().zip(expected).all(|(f, e)| (f - e).abs() <= 1e-9 * e.abs().max(1.0))
}

fn pressure(p: f64) -> PointState {
    PointState { stress: Stress { xx: -p, yy: -p, zz: 0.0, xy: 0.0 }, ..PointState::default() }
}

const AREA: f64 = 4.0 * H * THICKNESS;

#[test]
fn force_of_a_uniform_stress_is_its_normal_component_times_the_area() {
    let stress = Stress { xx: -1000.0, yy: -300.0, zz: 9e9, xy: 200.0 };
    for angle in [0.0f64, 0.2, -0.4, 1.0] {
        let n = [angle.cos(), angle.sin()];
        let normal = -(n[0] * n[0] * stress.xx + n[1] * n[1] * stress.yy + 2.0 * n[0] * n[1] * stress.xy);
        for per_cell in [1, 2, 3] {
            let found = force(angle, [6, 4], per_cell, |_, _, p| {
                p.state.stress = stress;
                true
            });
            assert!(close(found, [normal * AREA * RATIO; 3]), "{angle} {per_cell}: {found:?}");
        }
    }
}

#[test]
fn layers_average_what_lies_in_them() {
    // The pressure is 1, 2, 3, ... kPa in the layers from the face on.
    for per_cell in [1, 2] {
        let spacing = H / per_cell as f64;
        let found = force(0.3, [6, 4], per_cell, |d, _, p| {
            p.state = pressure(1e3 * (d / spacing + 0.5).round());
            true
        });
        assert!(close(found, [1e3, 1.5e3, 2e3].map(|p| p * AREA * RATIO)), "{found:?}");
    }
}

#[test]
fn material_above_the_crest_below_the_foot_or_away_from_the_face_does_not_count() {
    let uniform = |p: &mut Particle| p.state = pressure(1e3);
    // 6 cells high before a wall of 4.
    let found = force(0.0, [6, 6], 2, |_, _, p| {
        uniform(p);
        true
    });
    assert!(close(found, [1e3 * AREA * RATIO; 3]), "{found:?}");
    // Half of it shifted below the foot, where the wall is not.
    let found = force(0.0, [6, 4], 2, |_, _, p| {
        p.x[1] -= 2.0 * H;
        uniform(p);
        true
    });
    assert!(close(found, [0.5e3 * AREA * RATIO; 3]), "{found:?}");
    // The nearest points more than a cell away in the lower half: only the upper half touches.
    let found = force(0.0, [6, 4], 2, |d, s, p| {
        uniform(p);
        s > 2.0 * H || d > H
    });
    assert!(close(found, [0.5e3 * AREA * RATIO; 3]), "{found:?}");
    // What is behind the wall neither counts nor hides what is before it; what has pressed in a little does both.
    let found = force(0.0, [6, 4], 2, |d, _, p| {
        uniform(p);
        if d < H {
            p.x[0] -= 3.0 * H;
        }
        true
    });
    assert_eq!(found, [0.0; 3]);
    let found = force(0.0, [6, 4], 2, |_, _, p| {
        uniform(p);
        p.x[0] -= 0.5 * H;
        true
    });
    assert!(close(found, [1e3 * AREA * RATIO; 3]), "{found:?}");
}

#[test]
fn the_nearest_point_is_sought_in_each_bin() {
    // One spacing is missing at the face in the lower half, where the pressure is 5 kPa and not 1.
    let found = force(0.0, [6, 4], 2, |d, s, p| {
        let low = s < 2.0 * H;
        p.state = pressure(if low { 5e3 } else { 1e3 });
        !low || d > 0.5 * H
    });
    assert!(close(found, [3e3 * AREA * RATIO; 3]), "{found:?}");
}

#[test]
fn no_material_no_force() {
    assert_eq!(force(0.0, [2, 2], 2, |_, _, _| false), [0.0; 3]);
}

#[test]
fn what_the_wall_does_not_act_on_does_not_press_it() {
    let under = |bodies: &[usize]| {
        let pressed = |_: f64, _: f64, p: &mut Particle| {
            p.state = pressure(1e3);
            true
        };
        force_on(0.3, [6, 4], 2, pressed, bodies)
    };
    assert!(close(under(&[1, 0]), [1e3 * AREA * RATIO; 3]));
    assert_eq!(under(&[1]), [0.0; 3]);
}
