//! The equations of a body in implicit steps, written out anew: sums over all points and nodes, no matrix, no numbering.

use crate::body::{Body, Particle};
use crate::boundary::{Boundary, Friction};
use crate::constitutive::{AnyLaw, Increment};
use crate::scaffold::{Brick, Lcg, scene};
use crate::shape::ShapeFunction;
use crate::simulation::Simulation;
use crate::simulation::implicit::ImplicitBody;
use nalgebra::Vector2;

pub const H: f64 = 0.1;
pub const YOUNG: f64 = 1e6;
pub const POISSON: f64 = 0.3;
const DENSITY: f64 = 2000.0;

/// A lopsided wall of several bands in a clamp that is askew; no two points have the same velocity, stress or volume ratio.
pub fn wall(shape: ShapeFunction, law: AnyLaw) -> Simulation {
    let brick = Brick { angle: 0.3, ..Brick::new([0.537, -0.312], [36, 4], H) };
    let mut points = brick.points();
    let mut random = Lcg::new(3);
    for p in &mut points {
        p.v = [0.3 * random.signed(), 0.3 * random.signed()];
        let s = &mut p.state.stress;
        (s.xx, s.yy) = (1e3 * random.signed(), 1e3 * random.signed());
        (s.zz, s.xy) = (1e3 * random.signed(), 1e3 * random.signed());
        p.volume_ratio = 1.0 + 0.2 * random.signed();
    }
    let clamp = Boundary::plane("clamp", Vector2::new(0.7, 0.1), Vector2::new(1.0, 0.2), Friction::Bonded);
    let mut scene = scene(&brick, law, DENSITY, points, vec![clamp]);
    scene.bodies[0].0.implicit = true;
    scene.numerics.shape = shape;
    let sim = Simulation::new(scene);
    assert!(sim.fields[0].bands.len() > 1 && sim.structures.len() == 1);
    sim
}

/// The hat function, and its integral from the left.
fn hat(d: f64) -> f64 {
    (1.0 - d.abs()).max(0.0)
}

fn hat_integral(d: f64) -> f64 {
    let half = |d: f64| 0.5 * (1.0 + d) * (1.0 + d);
    if d < 0.0 { half(d.max(-1.0)) } else { 1.0 - half(-d.min(1.0)) }
}

/// The hat averaged over `2 l` cells around `d`, and its slope.
fn averaged(d: f64, l: f64) -> [f64; 2] {
    if l == 0.0 {
        return [hat(d), if d.abs() < 1.0 { -d.signum() } else { 0.0 }];
    }
    [(hat_integral(d + l) - hat_integral(d - l)) / (2.0 * l), (hat(d + l) - hat(d - l)) / (2.0 * l)]
}

/// What a point sees of a node: its number, weight and gradient (1/m).
type Seen = (usize, f64, [f64; 2]);

pub struct Reference {
    pub body: Body,
    /// Points as they were at the sort.
    pub points: Vec<Particle>,
    /// Position of each node, m.
    pub x: Vec<[f64; 2]>,
    seen: Vec<Vec<Seen>>,
}

impl Reference {
    pub fn new(sim: &Simulation, implicit: &ImplicitBody) -> Self {
        let field = &sim.fields[implicit.field];
        let positions: Vec<[f64; 2]> = field.grid.nodes().map(|(_, x)| x).collect();
        let x: Vec<_> = implicit.places.iter().map(|&(b, at)| positions[field.bands[b].first_node + at]).collect();
        let points: Vec<Particle> = field.bands.iter().flat_map(|b| b.points[0].iter()).collect();
        let l = sim.numerics.shape.half_width(2);
        let near = |p: &Particle| -> Vec<Seen> {
            let cells = |n: &[f64; 2]| [0, 1].map(|d| (p.x[d] - n[d]) / H);
            let seen = x.iter().enumerate().map(|(k, n)| (k, cells(n).map(|d| averaged(d, l))));
            let seen = seen.map(|(k, [a, b])| (k, a[0] * b[0], [a[1] * b[0] / H, a[0] * b[1] / H]));
            seen.filter(|(_, w, _)| *w > 1e-14).collect()
        };
        let seen = points.iter().map(near).collect();
        Self { body: field.bodies[0].clone(), points, x, seen }
    }

    /// Sum over points of a weight of each node.
    fn gather(&self, size: usize, mut add: impl FnMut(&Particle, &Seen, &mut [f64])) -> Vec<f64> {
        let mut sums = vec![0.0; size * self.x.len()];
        for (p, seen) in self.points.iter().zip(&self.seen) {
            seen.iter().for_each(|s| add(p, s, &mut sums[size * s.0..size * (s.0 + 1)]));
        }
        sums
    }

    /// Mass of the nodes, kg.
    pub fn mass(&self) -> Vec<f64> {
        self.gather(1, |_, (_, w, _), sum| sum[0] += w * self.body.point_mass)
    }

    /// Velocity of the nodes at the sort, m/s.
    pub fn velocity(&self) -> Vec<f64> {
        let mass = self.mass();
        self.gather(2, |p, (k, w, _), sum| (0..2).for_each(|d| sum[d] += w * self.body.point_mass * p.v[d] / mass[*k]))
    }

    /// A nodal field at a point.
    pub fn at(&self, point: usize, field: &[f64]) -> [f64; 2] {
        [0, 1].map(|d| self.seen[point].iter().map(|(k, w, _)| w * field[2 * k + d]).sum())
    }

    /// Strain and spin at a point under displacements of the nodes.
    pub fn increment(&self, point: usize, displacement: &[f64]) -> Increment {
        let slope = |d: usize, e: usize| -> f64 {
            self.seen[point].iter().map(|(k, _, g)| g[e] * displacement[2 * k + d]).sum()
        };
        let [xy, yx] = [slope(0, 1), slope(1, 0)];
        let (xy, spin) = ((xy + yx) / 2.0, (yx - xy) / 2.0);
        Increment { xx: slope(0, 0), yy: slope(1, 1), xy, spin, ..Increment::default() }
    }

    /// Force with which the stresses at the sort, and those of displacements since, pull at the nodes, N.
    pub fn internal_force(&self, displacement: &[f64]) -> Vec<f64> {
        let lambda = YOUNG * POISSON / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON));
        let mu = YOUNG / (2.0 * (1.0 + POISSON));
        let stress: Vec<[f64; 3]> = (0..self.points.len())
            .map(|k| {
                let (e, s) = (self.increment(k, displacement), &self.points[k].state.stress);
                let volume = self.body.point_volume * self.points[k].volume_ratio;
                let mean = lambda * (e.xx + e.yy);
                [s.xx + mean + 2.0 * mu * e.xx, s.yy + mean + 2.0 * mu * e.yy, s.xy + 2.0 * mu * e.xy]
                    .map(|s| volume * s)
            })
            .collect();
        let mut force = vec![0.0; 2 * self.x.len()];
        for (s, seen) in stress.iter().zip(&self.seen) {
            for (k, _, g) in seen {
                force[2 * k] += s[0] * g[0] + s[2] * g[1];
                force[2 * k + 1] += s[2] * g[0] + s[1] * g[1];
            }
        }
        force
    }

    /// Force of displacements alone, N.
    pub fn stiffness_times(&self, displacement: &[f64]) -> Vec<f64> {
        let stressed = self.internal_force(&vec![0.0; displacement.len()]);
        self.internal_force(displacement).iter().zip(stressed).map(|(a, b)| a - b).collect()
    }
}

/// Largest difference, as a share of the largest value.
pub fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let largest = b.iter().fold(0.0f64, |s, x| s.max(x.abs()));
    a.iter().zip(b).fold(0.0f64, |s, (a, b)| s.max((a - b).abs())) / largest
}
