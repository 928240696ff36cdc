//! A vortex: large rotation and shear, which the square with its parallel lines does not see. Nothing moves at the rim, so
//! that no boundary is needed.
//!
//! Errors are root mean squares over the points inside the ring that turns, at w t = 1: displacements over the largest one,
//! stresses over the shear modulus times the largest shear. Expected of it: second order from the grid and first from the time
//! step, as for the square, as long as domains that do not deform with the shear do not overlap much.

use super::{SHAPE_NAMES, SHAPES};
use crate::report::named_csv;
use crate::scene::{Brick, Material, points_by_number, scene};
use crate::{Fault, Outcome, RungFailure};
use checkdam::check::{Check, Expected, Kind};
use checkdam::shape::ShapeFunction;
use checkdam::simulation::{AccelerationField, Simulation};
use checkdam::theory::elastic::confined_speed;
use checkdam::theory::order;
use checkdam::theory::vortex::Vortex;
use std::sync::Arc;

const MATERIAL: Material = Material::new(1e6, 0.3, 1500.0);
/// Cells per radius of the ring.
const GRIDS: [usize; 4] = [5, 10, 20, 40];
const COURANT: f64 = 0.2;
/// Angles by which the middle of the ring turns, rad: shear strains up to 0.1 and 0.6.
const ANGLES: [f64; 2] = [0.025, 0.15];
/// Half the side of the square of material: wider than the ring by more than a coarse cell.
const HALF_SIDE: f64 = 1.8;

fn vortex(angle: f64) -> Vortex {
    let speed = confined_speed(&MATERIAL.elastic, MATERIAL.density);
    let (elastic, density) = (MATERIAL.elastic, MATERIAL.density);
    Vortex { elastic, density, angle, angular_frequency: 2.0 * speed, radius: 1.0, half_width: 0.5 }
}

/// Errors of displacement and stress on one grid.
fn turn(shape: ShapeFunction, angle: f64, cells: usize, fault: &Fault) -> Result<[f64; 2], RungFailure> {
    let exact = vortex(angle);
    let h = 1.0 / cells as f64;
    let dt = COURANT * h / confined_speed(&MATERIAL.elastic, MATERIAL.density);
    let side = (2.0 * HALF_SIDE * cells as f64).round() as usize;
    // The lattice has its origin at a node; so has the vortex.
    let brick = Brick::new([-HALF_SIDE, -HALF_SIDE], [side, side], h);
    let mut points = brick.points();
    // In this scheme velocities belong to the middle of the step.
    points.iter_mut().for_each(|p| p.v = exact.velocity(p.x, -0.5 * dt));
    let reference: Arc<Vec<[f64; 2]>> = Arc::new(points.iter().map(|p| p.x).collect());
    let mut scene = scene(&brick, MATERIAL.law(fault), MATERIAL.density * fault.density, points, vec![]);
    scene.numerics.shape = shape;
    scene.numerics.cfl = 0.9;
    scene.numerics.max_time_step = dt;
    let mut sim = Simulation::new(scene);
    let places = Arc::clone(&reference);
    sim.set_field(Some(AccelerationField(Arc::new(move |p, t| exact.acceleration(places[p.id as usize], t)))));
    let steps = (1.0 / (exact.angular_frequency * dt)).round() as u32;
    for _ in 0..steps {
        sim.step()?;
    }
    let t = sim.time();
    let mut sums = [0.0; 3];
    for (p, &x0) in points_by_number(&sim).iter().zip(reference.iter()) {
        if (x0[0].hypot(x0[1]) - exact.radius).abs() < exact.half_width {
            let (x, s) = (exact.position(x0, t), exact.stress(x0, t));
            let stress = &p.state.stress;
            sums[0] += 1.0;
            sums[1] += (p.x[0] - x[0]).powi(2) + (p.x[1] - x[1]).powi(2);
            sums[2] += (stress.xx - s[0]).powi(2) + (stress.yy - s[1]).powi(2) + 2.0 * (stress.xy - s[2]).powi(2);
        }
    }
    let now = libm::sin(exact.angular_frequency * t);
    let moved = exact.radius * exact.angle * now;
    let sheared = exact.elastic.shear() * exact.largest_shear() * now;
    Ok([(sums[1] / sums[0]).sqrt() / moved, (sums[2] / sums[0]).sqrt() / sheared])
}

/// Three shape functions at two angles.
pub fn run(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let whole = *fault == Fault::NONE;
    let mut rows = Vec::new();
    for (index, (shape, name)) in SHAPES.into_iter().enumerate() {
        for angle in ANGLES {
            if !whole && (shape != ShapeFunction::Ugimp || angle != ANGLES[0]) {
                continue;
            }
            let errors = GRIDS.iter().map(|&n| turn(shape, angle, n, fault)).collect::<Result<Vec<_>, _>>()?;
            for (&cells, e) in GRIDS.iter().zip(&errors) {
                rows.push(vec![index as f64, angle, cells as f64, e[0], e[1]]);
            }
            judge(shape, &format!("vortex, {name}, {angle} rad"), angle, &errors, outcome);
        }
    }
    let header = ["shape", "angle_rad", "cells", "displacement_error", "stress_error"];
    outcome.tables.push(("manufactured_vortex".into(), named_csv(&header, &[("shape", &SHAPE_NAMES)], rows)));
    Ok(())
}

fn judge(shape: ShapeFunction, what: &str, angle: f64, errors: &[[f64; 2]], outcome: &mut Outcome) {
    let source = "generalised vortex (Kamojjala et al. 2015) for the Jaumann rate, theory::vortex";
    let exact = vortex(angle);
    let shear = exact.largest_shear() * libm::sin(1.0);
    // Half a wave over half the width of the ring.
    let kh = std::f64::consts::PI / exact.half_width / GRIDS[3] as f64;
    let between = |a: usize, b: usize, q: usize| {
        order::from_errors(errors[a][q], errors[b][q], GRIDS[b] as f64 / GRIDS[a] as f64)
    };
    // Points of the ring move by more than a cell; the forces of linear functions jump at every crossing.
    if shape == ShapeFunction::Linear {
        if angle == ANGLES[1] {
            outcome.check(
                Check::at_most(format!("{what}, stress, 10 to 40 cells: observed order"), between(1, 3, 1), 0.5, "1")
                    .because("points cross cells: no convergence; a higher order would say that nothing crossed")
                    .from(Kind::Convergence, "Steffen, Kirby and Berzins 2008: cell crossing"),
            );
        }
        return;
    }
    // At the smaller angle the grid has most of the error; the first grid, with five cells over the ring, may do better than
    // its order.
    let low = if angle == ANGLES[0] { 1.5 } else { 0.75 };
    for fine in 1..GRIDS.len() {
        let expected = if fine == 1 { Expected::AtLeast(low) } else { Expected::Within(low, 2.5) };
        outcome.check(
            Check::new(
                format!("{what}, displacement, {} to {} cells: observed order", GRIDS[fine - 1], GRIDS[fine]),
                between(fine - 1, fine, 0),
                expected,
                "1",
            )
            .because("second order from the grid, first from the time step and from domains that do not deform")
            .from(Kind::Convergence, source),
        );
    }
    outcome.check(
        Check::at_most(format!("{what}, 40 cells: error of stress"), errors[3][1], 0.5 * kh + 0.5 * shear, "1")
            .because("gradients constant within a cell: k h/4 with k = pi/B, doubled for a profile that is no sine; half of the shear by which domains overlap")
            .from(Kind::Manufactured, source),
    );
    outcome.check(
        Check::at_most(format!("{what}, 40 cells: error of displacement"), errors[3][0], 0.52 * kh * kh, "1")
            .because("the lag of a wave, 0.13 (k h)^2 with k = pi/B, as much again for the time step; twice that for a profile steeper than a sine")
            .from(Kind::Manufactured, source),
    );
}
