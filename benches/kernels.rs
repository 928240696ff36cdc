//! The parts of a step, each by itself on points that are in cache.
//!
//!     cargo bench --bench kernels
//!
//! An element is one point (or one node, for the contact).

mod scenes;

use checkdam::band::{Band, NodeSum};
use checkdam::body::{Body, Particle, Points};
use checkdam::boundary::nodes::{self, Tally};
use checkdam::boundary::search::{Found, find_holds};
use checkdam::boundary::{Boundary, BoundaryContact, Friction};
use checkdam::constitutive::{AnyLaw, Increment, Law, LinearElastic, PointState, Stress};
use checkdam::contact::node;
use checkdam::contact::pair::Touch;
use checkdam::contact::side::Side;
use checkdam::grid::{ActiveGrid, Lattice};
use checkdam::lanes::floor_to_int;
use checkdam::layout::{SortRules, Sorter};
use checkdam::shape::{AveragedHat, Hat, Shape1d, ShapeFunction};
use checkdam::transfer::{NodeMap, PointConstants, Scatter, StressUpdate, Transfer, VelocityUpdate};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;

const SPACING: f64 = 0.01;
/// Cells along x and y: what a band holds.
const CELLS: [usize; 2] = [8, 16];

/// One band of sand under pressure, and its grid.
struct Fixture {
    body: Body,
    band: Band,
    grid: ActiveGrid,
    half_width: f64,
}

impl Fixture {
    fn new(shape: ShapeFunction) -> Self {
        let step = SPACING / 2.0;
        let volume = step * step * 0.1;
        let body = Body {
            name: "sand".into(),
            law: AnyLaw::DruckerPrager(scenes::sand()),
            point_mass: 1680.0 * volume,
            point_volume: volume,
            points_per_direction: 2,
            point_spacing: step,
            weightless: false,
            between_side_walls: true,
            implicit: false,
            mesh: None,
        };
        let mut points = Points::default();
        for k in 0..4 * CELLS[0] * CELLS[1] {
            let (i, j) = (k % (2 * CELLS[0]), k / (2 * CELLS[0]));
            let mut p = Particle::at_rest(k as u32, [(i as f64 + 0.5) * step, (j as f64 + 0.5) * step]);
            p.v = [0.1 + p.x[1], 0.2 * p.x[0]];
            p.state.stress = Stress { xx: -500.0, yy: -900.0, zz: -500.0, xy: 120.0 };
            points.push(&p);
        }
        let mut bands = vec![Band { points: vec![points], ..Band::default() }];
        let mut grid = ActiveGrid::default();
        let rules = SortRules {
            lattice: Lattice { spacing: SPACING, origin: [0.0; 2] },
            shape,
            bodies: std::slice::from_ref(&body),
            domain: [[-1.0, 1.0], [-1.0, 1.0]],
        };
        Sorter::default().sort(&rules, &mut bands, &mut grid, &mut Vec::new());
        let mut band = bands.swap_remove(0);
        band.make_room();
        for (k, v) in band.work.strain_velocity.iter_mut().enumerate() {
            *v = [1e-3 * (k % 7) as f64, -1e-3 * (k % 5) as f64];
        }
        Self { half_width: shape.half_width(2), body, band, grid }
    }

    fn transfer(&self) -> Transfer<'_> {
        let (mass, volume) = (self.body.point_mass, self.body.point_volume);
        Transfer {
            half_width: self.half_width,
            map: NodeMap::new(&self.grid, self.band.first_node),
            constants: PointConstants { mass, volume, side_friction: 0.0 },
        }
    }
}

fn transfers(c: &mut Criterion) {
    let mut group = c.benchmark_group("transfer");
    group.throughput(Throughput::Elements((4 * CELLS[0] * CELLS[1]) as u64));
    for (name, shape) in
        [("uGIMP", ShapeFunction::Ugimp), ("B-spline", ShapeFunction::Bspline), ("linear", ShapeFunction::Linear)]
    {
        let f = Fixture::new(shape);
        let transfer = f.transfer();
        let mut sums = vec![NodeSum::default(); f.band.reach];
        let points = &f.band.points[0];
        group.bench_function(format!("particles to grid, {name}"), |b| {
            b.iter(|| transfer.scatter(Scatter::All, black_box(points), &mut sums));
        });
        let velocity = VelocityUpdate { dt: 1e-5, pic: 0.01, remap: true, move_now: false };
        let (mut moving, mut moved, mut remapped) =
            (points.clone(), f.band.work.moved.clone(), f.band.work.remapped.clone());
        group.bench_function(format!("grid to particles and back (MUSL), {name}"), |b| {
            b.iter(|| {
                let motion = black_box(&f.band.work.motion);
                transfer.gather_velocity(velocity, motion, &mut moving, &mut moved, &mut remapped)
            });
        });
        let stress = StressUpdate { dt: 1e-6, move_after: false };
        let mut strained = points.clone();
        group.bench_function(format!("strain and stress of sand, {name}"), |b| {
            b.iter(|| {
                let velocity = black_box(&f.band.work.strain_velocity);
                transfer.update_stress(f.body.law, stress, velocity, &mut strained, &mut moved)
            });
        });
    }
    group.finish();
}

fn shapes(c: &mut Criterion) {
    fn sum(shape: impl Shape1d, at: &[f64]) -> f64 {
        at.iter()
            .map(|&u| {
                let (_, r) = floor_to_int(u - shape.shift());
                let (w, g) = shape.eval(r);
                w[0] + w[1] * g[2]
            })
            .sum()
    }
    let at: Vec<f64> = (0..1024).map(|k| 2.0 + 0.003_7 * f64::from(k)).collect();
    let mut group = c.benchmark_group("shape function");
    group.throughput(Throughput::Elements(at.len() as u64));
    group.bench_function("linear", |b| b.iter(|| sum(Hat, black_box(&at))));
    group.bench_function("uGIMP", |b| b.iter(|| sum(AveragedHat::new(0.25), black_box(&at))));
    group.bench_function("B-spline", |b| b.iter(|| sum(AveragedHat::new(0.5), black_box(&at))));
    group.finish();
}

fn laws(c: &mut Criterion) {
    fn strain(law: &impl Law, states: &mut [PointState], d: &Increment) -> f64 {
        states.iter_mut().map(|state| law.update(state, d)).sum()
    }
    let increment = Increment { dt: 1e-5, xx: 1e-7, yy: -2e-7, xy: 3e-7, spin: 1e-7 };
    let pressed = PointState { stress: Stress { xx: -500.0, yy: -900.0, zz: -500.0, xy: 0.0 }, ..Default::default() };
    let mut group = c.benchmark_group("law, one point at a time");
    group.throughput(Throughput::Elements(1024));
    let mut states = vec![pressed; 1024];
    let elastic = LinearElastic::new(6e6, 0.3);
    group.bench_function("linear elastic", |b| b.iter(|| strain(&elastic, &mut states, black_box(&increment))));
    let mut states = vec![pressed; 1024];
    let sand = scenes::sand();
    group.bench_function("Drucker-Prager", |b| b.iter(|| strain(&sand, &mut states, black_box(&increment))));
    group.finish();
}

fn contact(c: &mut Criterion) {
    let f = Fixture::new(ShapeFunction::Ugimp);
    let corner = [0.0, 0.0].into();
    let floor = Boundary::plane("floor", corner, [0.0, 1.0].into(), Friction::Coulomb(0.4));
    let wall = Boundary::plane("wall", corner, [1.0, 0.0].into(), Friction::Coulomb(0.3));
    let mut group = c.benchmark_group("contact with rigid boundaries");
    for (name, boundaries, number) in [("face", vec![floor.clone()], 1), ("corner", vec![floor, wall], 2)] {
        let mut found = Found::default();
        find_holds(&boundaries, &[0], &f.grid, BoundaryContact::Surface, &mut found);
        let mut holds: Vec<_> =
            found.holds.chunk_by(|a, b| a.node == b.node).filter(|h| h.len() == number).map(<[_]>::to_vec).collect();
        let mut tallies = vec![Tally::default(); boundaries.len()];
        group.throughput(Throughput::Elements(holds.len() as u64));
        group.bench_function(name, |b| {
            b.iter(|| {
                for hold in &mut holds {
                    let mut v = black_box([-0.3, -0.1]);
                    nodes::solve(hold, &boundaries, 1e-3, [0.1, 0.0], &mut v, &mut tallies);
                }
            });
        });
    }
    group.finish();
}

/// The exchange between bodies at a node: one pair, and three bodies of which each touches the others.
fn bodies(c: &mut Criterion) {
    let side = |mass: f64, v: [f64; 2]| Side { mass, old: v, velocity: v, ..Side::default() };
    let sides = [side(1e-3, [1.0, -0.2]), side(2e-3, [-0.5, 0.1]), side(5e-3, [0.0, 0.3])];
    let touch = |a: usize, b: usize, normal: [f64; 2]| Touch::new([a, b], normal, 0.4);
    let all = [touch(0, 1, [0.8, 0.6]), touch(1, 2, [0.0, 1.0]), touch(0, 2, [0.6, 0.8])];
    let mut group = c.benchmark_group("contact of bodies");
    for (name, bodies, touches) in [("two bodies", 2, 1), ("three bodies", 3, 3)] {
        group.throughput(Throughput::Elements(1));
        group.bench_function(name, |b| {
            b.iter(|| {
                let (mut sides, mut at) = (black_box(sides), black_box(all));
                node::solve(&mut sides[..bodies], &mut at[..touches]);
                sides
            });
        });
    }
    group.finish();
}

criterion_group!(benches, shapes, transfers, laws, contact, bodies);
criterion_main!(benches);
