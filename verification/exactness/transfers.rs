//! The transfers themselves: partition of unity, linear reproduction, gradients, for every shape function.

use super::super::scene::{Lcg, Material};
use super::super::{Fault, Outcome};
use super::ROUND_OFF;
use checkdam::band::Band;
use checkdam::body::{Body, Particle, Points};
use checkdam::check::{Check, Kind};
use checkdam::grid::{ActiveGrid, Lattice};
use checkdam::layout::{SortRules, Sorter};
use checkdam::shape::ShapeFunction;
use checkdam::theory::jaumann::turned;
use checkdam::transfer::{NodeMap, PointConstants, Scatter, StressUpdate, Transfer, VelocityUpdate};

const SAND: Material = Material::new(1e6, 0.3, 1500.0);
const H: f64 = 0.01;
const DT: f64 = 1e-3;
/// Velocity gradient dvx/dx, dvx/dy, dvy/dx, dvy/dy in 1/s, and velocity at the origin in m/s.
const GRADIENT: [f64; 4] = [0.7, -1.1, 0.4, -0.3];
const ORIGIN_VELOCITY: [f64; 2] = [0.31, -0.17];

fn field(x: [f64; 2]) -> [f64; 2] {
    let [xx, xy, yx, yy] = GRADIENT;
    [ORIGIN_VELOCITY[0] + xx * x[0] + xy * x[1], ORIGIN_VELOCITY[1] + yx * x[0] + yy * x[1]]
}

/// Largest errors over points and nodes.
#[derive(Default)]
struct Worst {
    velocity: f64,
    stress: f64,
    volume: f64,
    mass: f64,
    centre: f64,
    force: f64,
    virial: f64,
}

/// Points anywhere, their grid, and one pass of each transfer.
struct Bench {
    body: Body,
    bands: Vec<Band>,
    grid: ActiveGrid,
    half_width: f64,
}

impl Bench {
    fn new(shape: ShapeFunction, per_cell: usize, fault: &Fault) -> Self {
        let volume = 2e-6;
        let body = Body {
            name: "sand".into(),
            law: SAND.law(fault),
            point_mass: SAND.density * volume,
            point_volume: volume,
            points_per_direction: per_cell,
            point_spacing: H / per_cell as f64,
            weightless: false,
            between_side_walls: true,
            implicit: false,
            mesh: None,
        };
        let mut random = Lcg::new(7 + per_cell as u64);
        let mut points = Points::default();
        for id in 0..1500 {
            let mut p = Particle::at_rest(id, [0.3 * random.unit(), 0.05 * random.unit()]);
            p.v = [random.signed(), random.signed()];
            let s = &mut p.state.stress;
            (s.xx, s.yy, s.zz, s.xy) = (random.signed(), random.signed(), random.signed(), random.signed());
            points.push(&p);
        }
        let mut bands = vec![Band { points: vec![points], ..Band::default() }];
        let mut grid = ActiveGrid::default();
        let rules = SortRules {
            lattice: Lattice { spacing: H, origin: [0.003, -0.001] },
            shape,
            bodies: std::slice::from_ref(&body),
            domain: [[-1.0, 1.0], [-1.0, 1.0]],
        };
        Sorter::default().sort(&rules, &mut bands, &mut grid, &mut Vec::new());
        bands.iter_mut().for_each(Band::make_room);
        Self { half_width: shape.half_width(per_cell), body, bands, grid }
    }

    fn constants(&self) -> PointConstants {
        PointConstants { mass: self.body.point_mass, volume: self.body.point_volume, side_friction: 0.0 }
    }

    /// Particle to grid: sums over nodes against sums over points.
    fn scatter(&mut self, worst: &mut Worst) {
        let constants = self.constants();
        let positions: Vec<[f64; 2]> = self.grid.nodes().map(|(_, x)| x).collect();
        // Mass, mass x position, force, and the virial sum of force x position (x x, x y, y x, y y), at nodes and at points.
        let (mut at_nodes, mut at_points) = ([0.0; 9], [0.0; 9]);
        let (mut mass_scale, mut force_scale) = (0.0, 0.0);
        for band in &mut self.bands {
            let map = NodeMap::new(&self.grid, band.first_node);
            let transfer = Transfer { half_width: self.half_width, map, constants };
            transfer.scatter(Scatter::All, &band.points[0], &mut band.work.sums);
            for (k, sum) in band.work.sums.iter().enumerate() {
                let x = positions[band.first_node + k];
                let (m, [fx, fy]) = (sum.mass(), sum.force());
                let terms = [m, m * x[0], m * x[1], fx, fy, fx * x[0], fx * x[1], fy * x[0], fy * x[1]];
                at_nodes.iter_mut().zip(terms).for_each(|(sum, t)| *sum += t);
                force_scale += fx.abs() + fy.abs();
            }
            for p in band.points[0].iter() {
                let (m, v, s) = (constants.mass, -constants.volume, p.state.stress);
                let terms = [m, m * p.x[0], m * p.x[1], 0.0, 0.0, v * s.xx, v * s.xy, v * s.xy, v * s.yy];
                at_points.iter_mut().zip(terms).for_each(|(sum, t)| *sum += t);
                mass_scale += m;
            }
        }
        let difference = |k: usize| (at_nodes[k] - at_points[k]).abs();
        worst.mass = worst.mass.max(difference(0) / mass_scale);
        worst.centre = worst.centre.max((difference(1) + difference(2)) / (mass_scale * H));
        worst.force = worst.force.max((difference(3) + difference(4)) / force_scale);
        worst.virial = worst.virial.max((5..9).map(difference).sum::<f64>() / (force_scale * H));
    }

    /// Grid to particle with an affine field on the nodes: velocity, volume and stress of every point.
    fn gather(&mut self, fault: &Fault, worst: &mut Worst) {
        let velocities: Vec<[f64; 2]> = self.grid.nodes().map(|(_, x)| field(x)).collect();
        let constants = self.constants();
        let velocity = VelocityUpdate { dt: DT, pic: 1.0, remap: false, move_now: false };
        let stress = StressUpdate { dt: DT, move_after: false };
        let [xx, xy, yx, yy] = GRADIENT.map(|g| g * DT);
        // From zero stress: C : de, turned by the half of the spin that follows the strain (Hughes and Winget 1980).
        let e = &SAND.elastic;
        let (shear, spread) = (e.shear(), e.lame() * (xx + yy));
        let half_turn = libm::atan(0.5 * 0.5 * (yx - xy));
        let [sx, sy, sxy] = turned(spread + 2.0 * shear * xx, spread + 2.0 * shear * yy, shear * (xy + yx), half_turn);
        let scale = sx.abs() + sy.abs() + sxy.abs();
        let half = 0.5 * (xx + yy);
        let _ = fault;
        for band in &mut self.bands {
            let map = NodeMap::new(&self.grid, band.first_node);
            let work = &mut band.work;
            for (k, &v) in velocities[band.first_node..][..band.reach].iter().enumerate() {
                work.motion[k] = [v[0], v[1], 0.0, 0.0];
                work.strain_velocity[k] = v;
            }
            let points = &mut band.points[0];
            for i in 0..points.len() {
                let mut p = points.iter().nth(i).unwrap_or_default();
                p.state = Default::default();
                points.set(i, &p);
            }
            let transfer = Transfer { half_width: self.half_width, map, constants };
            transfer.gather_velocity(velocity, &work.motion, points, &mut work.moved, &mut work.remapped);
            transfer.update_stress(self.body.law, stress, &work.strain_velocity, points, &mut work.moved);
            for p in points.iter() {
                let v = field(p.x);
                let s = p.state.stress;
                worst.velocity = worst.velocity.max((p.v[0] - v[0]).abs()).max((p.v[1] - v[1]).abs());
                let off = (s.xx - sx).abs() + (s.yy - sy).abs() + (s.xy - sxy).abs() + (s.zz - spread).abs();
                worst.stress = worst.stress.max(off / scale);
                worst.volume = worst.volume.max((p.volume_ratio - (1.0 + half) / (1.0 - half)).abs());
            }
        }
    }
}

pub fn run(fault: &Fault, outcome: &mut Outcome) {
    for (shape, name) in
        [(ShapeFunction::Linear, "linear"), (ShapeFunction::Ugimp, "uGIMP"), (ShapeFunction::Bspline, "B-spline")]
    {
        let mut worst = Worst::default();
        for per_cell in 1..=4 {
            let mut bench = Bench::new(shape, per_cell, fault);
            bench.scatter(&mut worst);
            bench.gather(fault, &mut worst);
        }
        let field = "affine field on the nodes, 1500 points anywhere, 1 to 4 points per cell and direction";
        let sums = "partition of unity and linear reproduction (Bardenhagen and Kober 2004)";
        for (what, measured, bound, kind, source) in [
            ("velocity at the points, m/s", worst.velocity, 1e-14, Kind::Manufactured, field),
            ("stress increment, relative", worst.stress, 1e-12, Kind::Manufactured, field),
            ("volume ratio", worst.volume, 1e-14, Kind::Manufactured, field),
            ("mass on the grid, relative", worst.mass, 1e-13, Kind::Conservation, sums),
            ("centre of mass on the grid, cells", worst.centre, 1e-12, Kind::Conservation, sums),
            ("sum of internal forces, relative", worst.force, 1e-13, Kind::Conservation, sums),
            ("virial of internal forces, relative", worst.virial, 1e-12, Kind::Conservation, sums),
        ] {
            let check = Check::at_most(format!("{name}: error of {what}"), measured, bound, "1");
            outcome.check(check.because(ROUND_OFF).from(kind, source));
        }
    }
}
