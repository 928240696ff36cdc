//! What the benchmarks run.

#![allow(dead_code, reason = "no benchmark runs all of them")]

use checkdam::body::{Body, Particle};
use checkdam::boundary::{Boundary, BoundaryContact, Friction};
use checkdam::constitutive::{AnyLaw, Cone, DruckerPrager, LinearElastic, NeoHookean};
use checkdam::contact::rule::ContactRule;
use checkdam::grid::Lattice;
use checkdam::run::Experiment;
use checkdam::shape::ShapeFunction;
use checkdam::simulation::{Numerics, OpenedVolume, PicShare, Scene, Scheme, Simulation};
use std::path::Path;

/// Cell size of the column, m.
const SPACING: f64 = 0.01;
/// Extent across the plane, m.
const THICKNESS: f64 = 0.1;
/// Points per cell and direction.
const PER_CELL: usize = 2;

/// Sand without dilatancy at 31 degrees, matched in plane strain.
pub fn sand() -> DruckerPrager {
    let elastic = LinearElastic::new(6e6, 0.3);
    DruckerPrager::new(elastic, Cone::PlaneStrain, 31f64.to_radians(), 0.0, 0.0, 0.0, true)
}

/// A column of sand of about `points` points, twice as wide as high but no higher than 100 cells, between a wall and a rough
/// floor, that spreads as it is let go. Steps are measured from here.
pub fn column(points: usize, shape: ShapeFunction, scheme: Scheme) -> Simulation {
    let rows = ((points as f64 / 8.0).sqrt().round() as usize).min(100);
    let columns = points / (PER_CELL * PER_CELL * rows);
    let step = SPACING / PER_CELL as f64;
    let (width, height) = (columns as f64 * SPACING, rows as f64 * SPACING);
    let particles = (0..PER_CELL * PER_CELL * rows * columns)
        .map(|k| {
            let (i, j) = (k % (PER_CELL * columns), k / (PER_CELL * columns));
            let x = [(i as f64 + 0.5) * step, (j as f64 + 0.5) * step];
            let mut p = Particle::at_rest(k as u32, x);
            p.v = [0.5 * x[0] / width, -0.5 * x[1] / height];
            p
        })
        .collect();
    let volume = step * step * THICKNESS;
    let body = Body {
        name: "sand".into(),
        law: AnyLaw::DruckerPrager(sand()),
        point_mass: 1680.0 * volume,
        point_volume: volume,
        points_per_direction: PER_CELL,
        point_spacing: step,
        weightless: false,
        between_side_walls: true,
        implicit: false,
        mesh: None,
    };
    let corner = [0.0, 0.0].into();
    Simulation::new(Scene {
        lattice: Lattice { spacing: SPACING, origin: [0.0; 2] },
        thickness: THICKNESS,
        domain: [[-1.0, 1e4], [-1.0, 1e4]],
        bodies: vec![(body, particles)],
        boundaries: vec![
            Boundary::plane("floor", corner, [0.0, 1.0].into(), Friction::Coulomb(0.4)),
            Boundary::plane("wall", corner, [1.0, 0.0].into(), Friction::Smooth),
        ],
        gravity: [0.0, -9.81],
        contacts: vec![],
        side_wall_friction: 0.0,
        numerics: Numerics {
            scheme,
            shape,
            cfl: 0.3,
            max_time_step: 1.0,
            pic: PicShare::Fraction(0.01),
            boundary_contact: BoundaryContact::Surface,
            opened_volume: OpenedVolume::Occupied,
        },
    })
}

/// The flume at 40 degrees with cells of `spacing` metres, half a second after release, when all of the sand moves.
pub fn flume(spacing: f64) -> Simulation {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/flume/40deg.toml");
    let mut case = checkdam::case::load(&path).expect("the case is valid").case;
    case.grid.spacing_m = spacing;
    let mut experiment = Experiment::new(&case);
    experiment.prepare(&mut |_| true).expect("the sand settles");
    let mut simulation = experiment.release().clone();
    while simulation.time() < 0.5 {
        simulation.step().expect("a step");
    }
    simulation
}

/// A metre of sand, 0.1 m deep, that has slid down a bed of 60 degrees against an elastic cantilever, 0.6 m by 0.1 m, clamped below
/// the bed, in frictional contact; 0.1 s after they met. The cantilever moves in implicit steps where `implicit`.
pub fn barrier(spacing: f64, implicit: bool) -> Simulation {
    let step = spacing / PER_CELL as f64;
    let volume = step * step * THICKNESS;
    let brick = |corner: [f64; 2], size: [f64; 2], v: [f64; 2]| -> Vec<Particle> {
        let [nx, ny] = size.map(|s| (s / step).round() as usize);
        (0..nx * ny)
            .map(|k| {
                let (i, j) = ((k % nx) as f64 + 0.5, (k / nx) as f64 + 0.5);
                let mut p = Particle::at_rest(k as u32, [corner[0] + i * step, corner[1] + j * step]);
                p.v = v;
                p
            })
            .collect()
    };
    let body = |name: &str, law: AnyLaw, density: f64, implicit: bool| Body {
        name: name.into(),
        law,
        point_mass: density * volume,
        point_volume: volume,
        points_per_direction: PER_CELL,
        point_spacing: step,
        weightless: false,
        between_side_walls: true,
        implicit,
        mesh: None,
    };
    let plane =
        |name: &str, normal: [f64; 2], friction| Boundary::plane(name, [0.0; 2].into(), normal.into(), friction);
    let angle = 60f64.to_radians();
    let mut simulation = Simulation::new(Scene {
        lattice: Lattice { spacing, origin: [0.0; 2] },
        thickness: THICKNESS,
        domain: [[-3.0, 3.0], [-1.0, 3.0]],
        bodies: vec![
            (
                body("barrier", AnyLaw::NeoHookean(NeoHookean::new(1e7, 0.2)), 1200.0, implicit),
                brick([1.0, -0.05], [0.1, 0.65], [0.0; 2]),
            ),
            (body("sand", AnyLaw::DruckerPrager(sand()), 1680.0, false), brick([0.0, 0.0], [1.0, 0.1], [3.0, 0.0])),
        ],
        boundaries: vec![
            plane("bed", [0.0, 1.0], Friction::Coulomb(0.4)).only_for(&[1]),
            plane("clamp", [0.0, 1.0], Friction::Bonded).only_for(&[0]),
        ],
        contacts: vec![ContactRule::with_structure(0, 1, 0.4)],
        gravity: [9.81 * angle.sin(), -9.81 * angle.cos()],
        side_wall_friction: 0.0,
        numerics: Numerics {
            scheme: Scheme::Musl,
            shape: ShapeFunction::Ugimp,
            cfl: 0.3,
            max_time_step: 1.0,
            pic: PicShare::Fraction(0.01),
            boundary_contact: BoundaryContact::Surface,
            opened_volume: OpenedVolume::Occupied,
        },
    });
    while simulation.time() < 0.1 {
        simulation.step().expect("a step");
    }
    simulation
}

/// Does `steps` steps.
pub fn run(simulation: &mut Simulation, steps: u64) {
    for _ in 0..steps {
        simulation.step().expect("a step");
    }
}
