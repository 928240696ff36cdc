//! A column between two smooth plates, the upper of which comes down: the unconfined compression test.
//!
//! The column spreads freely and alike everywhere, so that the load over its width is the strength of one point: 2 c of the cone matched in
//! plane strain without friction, 2 c tan(45 degrees + phi/2) with it. A cone that is matched in triaxial compression
//! carries 15 % more of the same cohesion in the plane. Strength needs more strain than elasticity: the stress out of the plane has to come to the mean of
//! the others, as exp(-strain G/tau). Damping, which takes the waves of the plate's start, is off after the first quarter; until then its force
//! shows, 5 % of the strength.

use crate::report::named_csv;
use crate::scene::{Brick, Material, THICKNESS, points_by_number, scene};
use crate::{Fault, Outcome, RungFailure};
use checkdam::boundary::{Boundary, Friction};
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::constitutive::{AnyLaw, Cone, DruckerPrager};
use checkdam::simulation::{PicShare, Simulation};
use checkdam::theory::drucker_prager::{outer_slope, unconfined_strength};
use checkdam::theory::elastic::confined_speed;
use nalgebra::Vector2;

const SOIL: Material = Material::new(4e6, 0.3, 1500.0);
/// Cohesion, Pa.
const COHESION: f64 = 250.0;
const H: f64 = 0.05;
const CELLS: [usize; 2] = [4, 8];
/// Travel of the plate over the height: G/tau is 3500 or more, so that nothing is left of exp(-strain G/tau).
const STROKE: f64 = 0.004;
/// Speed of the plate over that of P-waves.
const MACH: f64 = 3e-5;
/// Parts into which the stroke is divided.
const PARTS: usize = 40;
/// Columns: name, cone, friction angle (degrees).
const COLUMNS: [(&str, Cone, f64); 3] = [
    ("phi = 0, plane strain", Cone::PlaneStrain, 0.0),
    ("phi = 0, triaxial compression", Cone::TriaxialCompression, 0.0),
    ("phi = 31 deg, plane strain", Cone::PlaneStrain, 31.0),
];

pub(super) fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let (mut outcome, mut rows) = (Outcome::default(), Vec::new());
    for (index, (name, cone, degrees)) in COLUMNS.into_iter().enumerate() {
        let phi = degrees.to_radians();
        let expected = match cone {
            Cone::TriaxialCompression => {
                let s = libm::sin(phi);
                unconfined_strength(outer_slope(phi), 6.0 * libm::cos(phi) / (3f64.sqrt() * (3.0 - s)) * COHESION, 0.0)
            }
            _ => 2.0 * COHESION * libm::tan(0.25 * std::f64::consts::PI + 0.5 * phi),
        };
        let stresses = compress(cone, phi, fault)?;
        let last = &stresses[3 * PARTS / 4..];
        let mean = last.iter().sum::<f64>() / last.len() as f64;
        rows.extend(stresses.iter().enumerate().map(|(k, stress)| {
            let strain = 100.0 * STROKE * (k as f64 + 0.5) / PARTS as f64;
            vec![index as f64, strain, *stress, expected]
        }));
        outcome.check(
            Check::value(
                format!("column between plates, {name}: strength, mean of the last quarter"),
                mean,
                expected,
                "Pa",
            )
            .within(
                Tolerance::Relative(0.005),
                "a plate that moves holds the row of nodes where it started: the column counts as higher, and its load as smaller, by up to the stroke of 0.4 %; 0.1 % for waves that damping leaves",
            )
            .from(Kind::Analytic, "2 c tan(45 deg + phi/2); 2 k of the cone that is matched elsewhere"),
        );
    }
    let header = ["column", "strain_percent", "stress_pa", "strength_pa"];
    let names = COLUMNS.map(|c| c.0);
    outcome.tables.push(("other_codes_plates".into(), named_csv(&header, &[("column", &names)], rows)));
    Ok(outcome)
}

/// Load over the column's width (Pa), mean by mean over the parts of the stroke.
fn compress(cone: Cone, phi: f64, fault: &Fault) -> Result<Vec<f64>, RungFailure> {
    let brick = Brick::new([0.0, 0.0], CELLS, H);
    let mut law = DruckerPrager::new(SOIL.linear_elastic(fault), cone, phi, 0.0, COHESION, f64::INFINITY, true);
    // A cone that is steeper by a factor through the same apex: its strength without pressure goes with it.
    law.friction *= fault.friction;
    law.cohesion *= fault.friction;
    let height = CELLS[1] as f64 * H;
    let at = Vector2::new;
    let boundaries = vec![
        Boundary::plane("lower plate", at(0.0, 0.0), at(0.0, 1.0), Friction::Smooth),
        Boundary::plane("upper plate", at(0.0, height), at(0.0, -1.0), Friction::Smooth),
    ];
    let density = SOIL.density * fault.density;
    let mut scene = scene(&brick, AnyLaw::DruckerPrager(law), density, brick.points(), boundaries);
    scene.numerics.pic = PicShare::Fraction(0.02);
    let mut sim = Simulation::new(scene);
    let speed = MACH * confined_speed(&SOIL.elastic, SOIL.density);
    sim.set_boundary_velocity(1, [0.0, -speed]);
    let crossing = height / (speed / MACH);
    sim.set_damping(0.5 / crossing);
    let start = spread(&sim);
    let mut stresses = Vec::new();
    for part in 0..PARTS {
        if 4 * part >= PARTS {
            sim.set_damping(0.0);
        }
        let until = STROKE * height / speed * (part + 1) as f64 / PARTS as f64;
        let (mut impulse, begun) = (0.0, sim.time());
        while sim.time() < until {
            sim.step()?;
            impulse -= sim.step_tallies()[1].impulse[1];
        }
        let width = CELLS[0] as f64 * H * spread(&sim) / start;
        stresses.push(impulse / ((sim.time() - begun) * width * THICKNESS));
    }
    Ok(stresses)
}

/// Root mean square of the points' places along x about their mean, m.
fn spread(sim: &Simulation) -> f64 {
    let points = points_by_number(sim);
    let n = points.len() as f64;
    let mean = points.iter().map(|p| p.x[0]).sum::<f64>() / n;
    (points.iter().map(|p| (p.x[0] - mean) * (p.x[0] - mean)).sum::<f64>() / n).sqrt()
}
