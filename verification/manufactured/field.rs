//! The manufactured solution on one grid.

use crate::scene::{Brick, Material, points_by_number, scene};
use crate::{Fault, RungFailure};
use checkdam::boundary::{Boundary, Friction, Opening};
use checkdam::shape::ShapeFunction;
use checkdam::simulation::{AccelerationField, Simulation};
use checkdam::theory::elastic::{Elastic, confined_speed};
use checkdam::theory::manufactured::Motion;
use nalgebra::Vector2;
use std::f64::consts::PI;
use std::sync::Arc;

const MATERIAL: Material = Material::new(1e6, 0.3, 1500.0);

/// Where the interior begins, from the walls: a P-wave has run 0.3 when errors there are judged first.
const REACHED: f64 = 0.4;

/// What is varied.
#[derive(Debug, Clone, Copy)]
pub struct Setting {
    /// Shape function.
    pub shape: ShapeFunction,
    /// Amplitude over the side of the square.
    pub amplitude: f64,
    /// Cells along a side.
    pub cells: usize,
    /// c dt / h.
    pub courant: f64,
}

/// Root mean squares over the points of the errors at one time, over the amplitudes A, A w and M k A.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Errors {
    /// Of the displacement.
    pub displacement: f64,
    /// Of the velocity.
    pub velocity: f64,
    /// Of the stresses in the plane.
    pub stress: f64,
}

/// A state to be compared with other ones.
#[derive(Debug, Clone, Default)]
pub struct State {
    /// Errors over all points.
    pub whole: Errors,
    /// Errors over the points that no wall has had the time to reach.
    pub interior: Errors,
    /// Displacements over A of the interior.
    pub displacement: Vec<[f64; 2]>,
    /// Normal stresses xx, yy over M k A of the interior.
    pub stress: Vec<[f64; 2]>,
}

/// Elasticity of the square.
pub fn elasticity() -> Elastic {
    MATERIAL.elastic
}

/// The motion of amplitude `amplitude` on the unit square.
fn motion(amplitude: f64) -> Motion {
    let speed = confined_speed(&MATERIAL.elastic, MATERIAL.density);
    Motion {
        elastic: MATERIAL.elastic,
        density: MATERIAL.density,
        amplitude,
        wave_number: 2.0 * PI,
        angular_frequency: PI * speed,
        phase: [0.0, PI],
    }
}

/// Smooth walls around the unit square that neither let in nor let go: each is a face from outside and one from inside.
fn walls(h: f64) -> Vec<Boundary> {
    let (depth, long) = (2.0 * h, 4.0);
    let mut all = Vec::new();
    for (outward, at) in [([-1.0, 0.0], 0.0), ([1.0, 0.0], 1.0), ([0.0, -1.0], 0.0), ([0.0, 1.0], 1.0)] {
        let outward = Vector2::from(outward);
        let on_face = outward.abs() * at + (outward.yx().abs()) * 0.5;
        for (normal, face) in [(-outward, on_face), (outward, on_face + outward * depth)] {
            let tangent = Vector2::new(normal.y, -normal.x);
            let foot = face - tangent * (0.5 * long);
            let wall = Boundary::wall("wall", foot, tangent, long, depth, Friction::Smooth);
            all.push(wall.gate(Opening::Vanish));
        }
    }
    all
}

/// Runs to the times `ends`, given as c t over the side of the square, and measures at each.
pub fn fly(setting: &Setting, ends: &[f64], fault: &Fault) -> Result<Vec<State>, RungFailure> {
    let Setting { shape, amplitude, cells, courant } = *setting;
    let exact = motion(amplitude);
    let h = 1.0 / cells as f64;
    let speed = confined_speed(&MATERIAL.elastic, MATERIAL.density);
    let dt = courant * h / speed;
    let brick = Brick::new([0.0, 0.0], [cells, cells], h);
    let mut points = brick.points();
    // In this scheme velocities belong to the middle of the step.
    points.iter_mut().for_each(|p| p.v = exact.velocity(p.x, -0.5 * dt));
    let reference: Arc<Vec<[f64; 2]>> = Arc::new(points.iter().map(|p| p.x).collect());
    let law = MATERIAL.law(fault);
    let mut scene = scene(&brick, law, MATERIAL.density * fault.density, points, walls(h));
    scene.numerics.shape = shape;
    scene.numerics.cfl = 0.9;
    scene.numerics.max_time_step = dt;
    let mut sim = Simulation::new(scene);
    let places = Arc::clone(&reference);
    sim.set_field(Some(AccelerationField(Arc::new(move |p, t| exact.acceleration(places[p.id as usize], t)))));
    let mut states = Vec::new();
    let mut done = 0usize;
    for &end in ends {
        let steps = (end / (courant * h)).round() as usize;
        while done < steps {
            sim.step()?;
            done += 1;
        }
        states.push(measure(&sim, &exact, &reference, dt));
    }
    Ok(states)
}

/// Errors now, half a step after the velocities.
fn measure(sim: &Simulation, exact: &Motion, reference: &[[f64; 2]], dt: f64) -> State {
    let t = sim.time();
    let (a, w) = (exact.amplitude, exact.angular_frequency);
    let pressure = exact.elastic.confined() * exact.wave_number * a;
    let mut sums = [[0.0; 4]; 2];
    let (mut displacement, mut stresses) = (Vec::new(), Vec::new());
    for (p, &x0) in points_by_number(sim).iter().zip(reference) {
        let (u, v, s) = (exact.displacement(x0, t), exact.velocity(x0, t - 0.5 * dt), exact.stress(x0, t));
        let square = |x: f64| x * x;
        let moved = [p.x[0] - x0[0], p.x[1] - x0[1]];
        let stress = &p.state.stress;
        let add = [
            1.0,
            (square(moved[0] - u[0]) + square(moved[1] - u[1])) / square(a),
            (square(p.v[0] - v[0]) + square(p.v[1] - v[1])) / square(a * w),
            (square(stress.xx - s[0]) + square(stress.yy - s[1]) + 2.0 * square(stress.xy)) / square(pressure),
        ];
        let inside = x0.iter().all(|c| (c - 0.5).abs() < 0.5 - REACHED);
        for sum in sums.iter_mut().take(if inside { 2 } else { 1 }) {
            for (s, x) in sum.iter_mut().zip(add) {
                *s += x;
            }
        }
        if inside {
            displacement.push(moved.map(|m| m / a));
            stresses.push([stress.xx / pressure, stress.yy / pressure]);
        }
    }
    let [whole, interior] = sums.map(|[n, u, v, s]| Errors {
        displacement: (u / n).sqrt(),
        velocity: (v / n).sqrt(),
        stress: (s / n).sqrt(),
    });
    State { whole, interior, displacement, stress: stresses }
}

/// Root mean square of the difference of two lists of vectors.
pub fn distance(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    let sum: f64 = a.iter().zip(b).flat_map(|(a, b)| [a[0] - b[0], a[1] - b[1]]).map(|d| d * d).sum();
    (sum / a.len() as f64).sqrt()
}
