//! Earth pressure at rest: sand between smooth walls, its force on a wall and where it acts.
//!
//! Gravity is raised slowly, with damping, so that every point follows the straight path of confined compression. The
//! coefficient at rest then tells the cones apart: the outer one never yields on this path and keeps nu/(1 - nu) = 0.4286 at
//! 31 degrees, the plane-strain match gives 0.4406, the cone as printed by Ng et al. 0.6752. None of them is Jaky's 0.485.

use super::report::named_csv;
use super::scene::{Brick, Material, THICKNESS, points_by_number, scene};
use super::{Fault, FaultKind, Outcome, Rung, RungFailure};
use crate::figure::{Figure, curves, exact, measured};
use crate::of_module;
use checkdam::boundary::{Boundary, Friction};
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::constitutive::{AnyLaw, Cone, DruckerPrager};
use checkdam::plot::curves::Curves;
use checkdam::simulation::{PicShare, Simulation};
use checkdam::theory::elastic::confined_speed;
use checkdam::theory::{drucker_prager, earth_pressure};
use nalgebra::Vector2;

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "Sand at rest between smooth walls: coefficient at rest by cone, force on the wall, its point of action",
    goal: "Earth pressure at rest, the force on a wall and where it acts, for three cones",
    source: "nu/(1 - nu), or the cone in confined compression; H/3",
    sketch: r"
   smooth |o o o o| smooth     | g, raised slowly
          |o o o o|<-- K0 rho g z
     H    |o o o o|<---
          |o o o o|<----  acts at H/3
   -------+-------+-------
",
    run,
    covers: &[
        (FaultKind::Friction, 1.05),
        (FaultKind::Gravity, 1.03),
        (FaultKind::Density, 1.03),
        (FaultKind::ContactForce, 1.03),
    ],
    under_fault: "all",
    figures: FIGURES,
};

/// Its figures.
const FIGURES: &[Figure] = &[curves(
    "earth_pressure_profile",
    "earth_pressure_profile_plot",
    Curves {
        x: "depth_m",
        x_title: "depth (m)",
        y_title: "lateral stress (Pa)",
        curves: &[measured("lateral_pa", ""), exact("lateral_exact_pa", "closed form")],
        split: &[("cone", "")],
        ..Curves::LINEAR
    },
)];

const SAND: Material = Material::new(1e6, 0.3, 1500.0);
const PHI: f64 = 31.0 * std::f64::consts::PI / 180.0;
const HEIGHT: f64 = 0.5;
const CELLS: [usize; 2] = [5, 40];
const GRAVITY: f64 = 9.81;
const CONES: [&str; 3] = ["outer cone", "plane-strain cone", "cone as printed"];

/// What the wall and the points of a column show.
struct AtRest {
    /// Force on the left wall per width, N/m, and the height at which it acts, m.
    force: f64,
    arm: f64,
    /// Mean of lateral over vertical stress of points deeper than a tenth of the height, and largest deviation from it.
    coefficient: [f64; 2],
    /// Depth, vertical and lateral stress by rows of points.
    rows: Vec<[f64; 3]>,
}

fn settle(cone: Cone, fault: &Fault) -> Result<AtRest, RungFailure> {
    let h = HEIGHT / CELLS[1] as f64;
    let brick = Brick::new([0.0, 0.0], CELLS, h);
    let mut law = DruckerPrager::new(SAND.linear_elastic(fault), cone, PHI, 0.0, 0.0, 0.0, true);
    law.friction *= fault.friction;
    let at = Vector2::new;
    let boundaries = vec![
        Boundary::plane("wall", at(0.0, 0.0), at(1.0, 0.0), Friction::Smooth),
        Boundary::plane("right", at(CELLS[0] as f64 * h, 0.0), at(-1.0, 0.0), Friction::Smooth),
        Boundary::plane("base", at(0.0, 0.0), at(0.0, 1.0), Friction::Smooth),
    ];
    let points = brick.points();
    let mut scene = scene(&brick, AnyLaw::DruckerPrager(law), SAND.density * fault.density, points, boundaries);
    scene.numerics.pic = PicShare::Fraction(0.02);
    let mut sim = Simulation::new(scene);
    let crossing = HEIGHT / confined_speed(&SAND.elastic, SAND.density);
    sim.set_damping(2.0 / crossing);
    let (raised, end) = (20.0 * crossing, 30.0 * crossing);
    while sim.time() < end {
        let share = (sim.time() / raised).min(1.0);
        sim.set_gravity([0.0, -GRAVITY * fault.gravity * share]);
        sim.step()?;
    }
    let (tally, dt) = (sim.step_tallies()[0], sim.time_step().dt);
    let points = points_by_number(&sim);
    let deep = |p: &&checkdam::body::Particle| p.x[1] < 0.9 * HEIGHT;
    let ratio = |p: &checkdam::body::Particle| p.state.stress.xx / p.state.stress.yy;
    let count = points.iter().filter(deep).count() as f64;
    let mean = points.iter().filter(deep).map(ratio).sum::<f64>() / count;
    let spread = points.iter().filter(deep).map(|p| (ratio(p) - mean).abs()).fold(0.0, f64::max);
    let rows = points.chunks(2 * CELLS[0]).map(|row| {
        let sum = |f: fn(&checkdam::body::Particle) -> f64| row.iter().map(f).sum::<f64>() / row.len() as f64;
        [HEIGHT - sum(|p| p.x[1]), -sum(|p| p.state.stress.yy), -sum(|p| p.state.stress.xx)]
    });
    Ok(AtRest {
        force: tally.impulse[0] / dt / THICKNESS * fault.contact_force,
        arm: -tally.moment / tally.impulse[0],
        coefficient: [mean, spread],
        rows: rows.collect(),
    })
}

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let mut outcome = Outcome::default();
    let outer = drucker_prager::outer_slope(PHI);
    let mut rows = Vec::new();
    for (index, (cone, q)) in
        [(Cone::TriaxialCompression, outer), (Cone::PlaneStrain, libm::sin(PHI)), (Cone::AsPrinted, outer / 3.0)]
            .into_iter()
            .enumerate()
    {
        let name = CONES[index];
        let rest = settle(cone, fault)?;
        let k = drucker_prager::oedometric_ratio(SAND.elastic.poisson, q);
        let cell = 1.0 / CELLS[1] as f64;
        outcome.check(
            Check::value(format!("{name}: lateral over vertical stress, mean"), rest.coefficient[0], k, "1")
                .within(
                    Tolerance::Relative(0.005),
                    "exact on a straight path; the ramp still moves stresses by (crossing / ramp)^2 = 0.25 %",
                )
                .from(Kind::Analytic, "nu/(1 - nu), or the cone's limit"),
        );
        outcome.check(
            Check::at_most(
                format!("{name}: largest scatter of that ratio among points"),
                rest.coefficient[1] / k,
                0.05,
                "1",
            )
            .because("good practice for uGIMP: below 5 % a point")
            .from(Kind::Analytic, "the ratio is the same at every depth"),
        );
        let exact = earth_pressure::triangular_force(k, SAND.density, GRAVITY, HEIGHT);
        outcome.check(
            Check::value(format!("{name}: force on the wall per width"), rest.force, exact, "N/m")
                .within(Tolerance::Relative(0.01), "H has settled by q/2 = 0.3 %; the lateral ratio has its 0.5 %")
                .from(Kind::Analytic, "K rho g H^2 / 2"),
        );
        outcome.check(
            Check::value(
                format!("{name}: height of the point of action"),
                rest.arm,
                earth_pressure::triangular_arm(HEIGHT),
                "m",
            )
            .within(
                Tolerance::Absolute(0.5 * cell * HEIGHT),
                "half a cell, to which a node's share of the wall is known",
            )
            .from(Kind::Analytic, "H / 3"),
        );
        rows.extend(rest.rows.iter().map(|&[depth, vertical, lateral]| {
            let exact = SAND.density * GRAVITY * depth;
            vec![index as f64, depth, vertical, exact, lateral, k * exact]
        }));
    }
    let header = ["cone", "depth_m", "vertical_pa", "vertical_exact_pa", "lateral_pa", "lateral_exact_pa"];
    outcome.tables.push(("earth_pressure_profile".into(), named_csv(&header, &[("cone", &CONES)], rows)));
    Ok(outcome)
}
