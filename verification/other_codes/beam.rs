//! A beam of 8 m by 1 m, clamped at one end, comes to rest under its weight.
//!
//! 90 MPa, Poisson's ratio 0, 1000 kg/m3, hyperelastic: the test of Iaconeta et al. (2017). The tip sinks by 8 % of the length, so rotations
//! count by half a percent: the closed form is the elastica under a dead load all along, with Timoshenko's shear.

use crate::report::table_csv;
use crate::scene::{Brick, Material, THICKNESS, points_by_number, run_until, scene};
use crate::{Fault, Outcome, RungFailure};
use checkdam::boundary::{Boundary, Friction};
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::constitutive::{AnyLaw, NeoHookean};
use checkdam::simulation::{PicShare, Simulation};
use checkdam::theory::cantilever::{Cantilever, elastica_under_load};
use checkdam::theory::elastic::confined_speed;
use nalgebra::Vector2;

const BEAM: Material = Material::new(9e7, 0.0, 1000.0);
const LENGTH: f64 = 8.0;
const DEPTH: f64 = 1.0;
const GRAVITY: f64 = 9.81;
/// What others have, m.
const PUBLISHED: f64 = 0.67433;
/// Cells of the beam inside the clamp.
const EMBEDDED: usize = 2;

/// Deflection of the tip, m.
fn exact(beam: &Cantilever) -> f64 {
    let weight = beam.density * GRAVITY * beam.depth * beam.width;
    let load = weight * beam.length * beam.length * beam.length / beam.bending_stiffness();
    beam.length * elastica_under_load(load)[2] + 0.5 * weight * beam.length * beam.length / beam.shear_stiffness()
}

pub(super) fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let (mut outcome, mut rows) = (Outcome::default(), Vec::new());
    let beam =
        Cantilever { elastic: BEAM.elastic, density: BEAM.density, length: LENGTH, depth: DEPTH, width: THICKNESS };
    let expected = exact(&beam);
    for (name, mesh, cells, allowed, reason) in [
        (
            "by its mesh, 2 cells through the depth",
            true,
            2,
            0.003,
            "0.2 % of shear, which one element through the depth takes for a sixth too stiff, and 0.07 % along the beam (rung `cantilever`)",
        ),
        (
            "by the grid, 6 cells through the depth",
            false,
            6,
            0.005,
            "as the elastica of the rung `cantilever`: 0.35 % of grid, and what points leave when they cross cells",
        ),
    ] {
        // By its mesh it is as good a witness, and faster.
        if !mesh && *fault != Fault::NONE {
            continue;
        }
        let [sunk, kinetic] = hang(&beam, cells, mesh, fault)?;
        for (kind, value, source) in [
            (Kind::Analytic, expected, "elastica under a dead load with Timoshenko's shear"),
            (
                Kind::Published,
                PUBLISHED,
                "Iaconeta, Larese, Rossi and Guo 2017, quoted in github.com/KratosMultiphysics/Examples",
            ),
        ] {
            let who = if kind == Kind::Published { "as others have it" } else { "closed form" };
            outcome.check(
                Check::value(format!("beam under its weight, {name}: tip, {who}"), sunk, value, "m")
                    .within(Tolerance::Relative(allowed), reason)
                    .from(kind, source),
            );
        }
        outcome.check(
            Check::at_most(format!("beam under its weight, {name}: kinetic over elastic energy"), kinetic, 1e-6, "1")
                .because("the first mode is damped by exp(-10) in amplitude")
                .from(Kind::Analytic, "at rest"),
        );
        rows.push(vec![f64::from(u8::from(mesh)), cells as f64, sunk, expected, PUBLISHED]);
    }
    let header = ["by_its_mesh", "cells_through_depth", "tip_m", "tip_exact_m", "tip_published_m"];
    outcome.tables.push(("other_codes_beam".into(), table_csv(&header, rows)));
    Ok(outcome)
}

/// Deflection of the tip (m) and kinetic over elastic energy, at rest.
fn hang(beam: &Cantilever, cells: usize, mesh: bool, fault: &Fault) -> Result<[f64; 2], RungFailure> {
    let h = beam.depth / cells as f64;
    let along = (beam.length / h).round() as usize + EMBEDDED;
    let inside = EMBEDDED as f64 * h;
    let brick = Brick::new([-inside, 0.0], [along, cells], h);
    let clamp = Boundary::plane("clamp", Vector2::zeros(), Vector2::new(1.0, 0.0), Friction::Bonded);
    let law = AnyLaw::NeoHookean(NeoHookean::new(BEAM.elastic.young * fault.modulus, BEAM.elastic.poisson));
    let start = brick.points();
    let mut scene = scene(&brick, law, BEAM.density * fault.density, start.clone(), vec![clamp]);
    if mesh {
        scene.bodies[0].0.mesh = Some(brick.mesh([&[inside], &[]]));
    }
    scene.gravity = [0.0, -GRAVITY * fault.gravity];
    // What the nodes do not see has to stop, too.
    scene.numerics.pic = PicShare::Fraction(0.02);
    scene.numerics.cfl = 0.9;
    scene.numerics.max_time_step = 0.7 * h / confined_speed(&BEAM.elastic, BEAM.density);
    let mut sim = Simulation::new(scene);
    let frequency = beam.frequency();
    sim.set_damping(2.0 * 0.8 * frequency);
    run_until(&mut sim, 13.0 / frequency)?;
    // The last column of points is a quarter of a cell short of the tip.
    let place = start.iter().map(|p| p.x[0]).fold(0.0, f64::max);
    let last = start.iter().map(|p| p.x[0] > place - 0.1 * h);
    let sunk: Vec<f64> = points_by_number(&sim)
        .iter()
        .zip(&start)
        .zip(last)
        .filter(|(_, last)| *last)
        .map(|((p, p0), _)| p0.x[1] - p.x[1])
        .collect();
    let sunk = sunk.iter().sum::<f64>() / sunk.len() as f64;
    let stock = sim.stock();
    Ok([sunk * beam.under_load(1.0, beam.length) / beam.under_load(1.0, place), stock.kinetic / stock.elastic])
}
