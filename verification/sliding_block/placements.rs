//! The same block wherever its plane lies: all the way round by 15 degrees, at eight places between nodes, falling to either side.
//!
//! Contact on the surface meets another pattern of crossings in each of them, and Coulomb knows none. A block without damping, whose
//! slope is 2 % short of the friction angle, has to stay where it is.

use super::{COULOMB, Fault, GRAVITY, H, MASS, Outcome, RIGID, RungFailure, Setting, centre, moved, run_until, theory};
use crate::figure::{Figure, curves, measured};
use crate::report::named_csv;
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::plot::curves::{Curves, panel};
use nalgebra::Vector2;
use rayon::prelude::*;

pub(super) const FIGURE: Figure = curves(
    "sliding_block_placements",
    "sliding_block_placements_plot",
    Curves {
        x: "plane_to_grid_deg",
        x_title: "plane to grid (degrees)",
        y_title: "displacement off Coulomb's (%)",
        curves: &[measured("displacement_error_percent", "")],
        panels: &[
            panel("falls to the right", &[("falls_to_the", "right")]),
            panel("falls to the left", &[("falls_to_the", "left")]),
        ],
        split: &[("offset_cells", "plane between nodes (cells) ")],
        ..Curves::LINEAR
    },
);

const ANGLES: u32 = 24;
/// Places between two nodes.
const PLACES: u32 = 8;
const FRICTION: f64 = 0.4;
/// The tangent of this slope is 2 % less than the friction coefficient, degrees.
const NEARLY_STEEP: f64 = 21.4;
const SIDES: [&str; 2] = ["right", "left"];

/// Where a plane lies.
#[derive(Clone, Copy)]
struct Place {
    /// Its angle to the grid, degrees.
    angle: f64,
    /// How far it is moved along its normal, in eighths of a cell. Odd ones fall to the left.
    eighths: u32,
}

/// What a block on it does, over what Coulomb says but for the last.
struct Slid {
    displacement: f64,
    velocity: f64,
    normal_impulse: f64,
    /// Energy that the ledger does not account for, over what gravity gave.
    residual: f64,
}

impl Place {
    fn setting(&self, slope: f64) -> Setting {
        let level = Setting::new("", self.angle, slope, FRICTION);
        let offset = level.tangent() * (0.26 * H) + level.normal() * (f64::from(self.eighths) / f64::from(PLACES) * H);
        Setting { corner: offset.into(), leftward: self.eighths % 2 == 1, ..level }
    }

    /// Slides for 0.2 s on 40 degrees.
    fn slide(&self, fault: &Fault) -> Result<Slid, RungFailure> {
        let s = self.setting(40.0);
        let mut sim = s.simulation(s.at_rest(fault)?, s.coulomb(fault), RIGID, fault);
        let start = centre(&sim).0;
        run_until(&mut sim, 0.2)?;
        let ((x, v), t) = (moved(&sim, start, &s), sim.time());
        let a = theory::acceleration_from_rest(GRAVITY, s.slope, s.friction);
        let normal = Vector2::from(sim.ledger().boundaries[0].impulse).dot(&s.normal()) * fault.contact_force;
        let given = MASS * GRAVITY * libm::sin(s.slope) * x;
        let balance = sim.energy_balance(&sim.stock(), [0.0; 2]);
        // A boundary that reports wrong impulses reports wrong works.
        let residual = balance.residual - (fault.contact_force - 1.0) * balance.friction[0];
        Ok(Slid {
            displacement: x / theory::distance(a, t),
            velocity: v / (a * t),
            normal_impulse: normal / (MASS * GRAVITY * libm::cos(s.slope) * t),
            residual: residual / given,
        })
    }

    /// How far a block without damping creeps in 0.5 s on a slope that is nearly too steep, cells.
    fn creep(&self, fault: &Fault) -> Result<f64, RungFailure> {
        let s = self.setting(NEARLY_STEEP);
        let mut sim = s.simulation(s.at_rest(fault)?, s.coulomb(fault), 0.0, fault);
        let start = centre(&sim).0;
        run_until(&mut sim, 0.5)?;
        let gone = Vector2::from(centre(&sim).0) - Vector2::from(start);
        Ok(gone.norm() / H)
    }
}

/// Slides in all placements, or under a fault in one for each angle; creep in one for each angle.
pub(super) fn judge(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let place = |a: u32, eighths: u32| Place { angle: 360.0 / f64::from(ANGLES) * f64::from(a), eighths };
    let one_each: Vec<Place> = (0..ANGLES).map(|a| place(a, 3 * a % PLACES)).collect();
    let all = (0..ANGLES).flat_map(|a| (0..PLACES).map(move |k| place(a, k)));
    let places: Vec<Place> = if *fault == Fault::NONE { all.collect() } else { one_each.clone() };
    let slid: Vec<Slid> = places.par_iter().map(|p| p.slide(fault)).collect::<Result<_, _>>()?;
    let crept: Vec<f64> = one_each.par_iter().map(|p| p.creep(fault)).collect::<Result<_, _>>()?;

    let worst = |of: fn(&Slid) -> f64| {
        slid.iter().map(of).fold(1.0, |a: f64, b| if (b - 1.0).abs() > (a - 1.0).abs() { b } else { a })
    };
    for (what, measured, tolerance, reason, kind, source) in [
        (
            "displacement",
            worst(|s| s.displacement),
            0.01,
            "the block is not rigid, and starts with a shear wave, 5 ms of 200",
            Kind::Analytic,
            COULOMB,
        ),
        (
            "velocity",
            worst(|s| s.velocity),
            0.01,
            "the block is not rigid, and starts with a shear wave, 5 ms of 200",
            Kind::Analytic,
            COULOMB,
        ),
        (
            "normal impulse of the plane",
            worst(|s| s.normal_impulse),
            0.005,
            "weight times time; what the block still moves along the normal is below 1 mm/s",
            Kind::Conservation,
            "Newton's second law",
        ),
    ] {
        outcome.check(
            Check::value(format!("any angle and place: {what} over what it should be, the worst"), measured, 1.0, "1")
                .within(Tolerance::Absolute(tolerance), reason)
                .from(kind, source),
        );
    }
    let residual = slid.iter().map(|s| s.residual.abs()).fold(0.0, f64::max);
    outcome.check(
        Check::at_most(
            "any angle and place: energy residual over what gravity gave, the largest",
            residual,
            0.005,
            "1",
        )
        .because("points move with one velocity in a step: of the order of one step in 0.2 s, 0.1 %")
        .from(Kind::Conservation, "energy balance"),
    );
    outcome.check(
        Check::at_most(
            "any angle: creep in 0.5 s without damping, slope 2 % short of the friction angle, the largest",
            crept.iter().copied().fold(0.0, f64::max),
            0.02,
            "cells",
        )
        .because("none in theory; with 3 % less friction it would go a tenth of a cell")
        .from(Kind::Analytic, "Coulomb 1785: sticks where mu > tan"),
    );

    let header = [
        "plane_to_grid_deg",
        "offset_cells",
        "falls_to_the",
        "displacement_error_percent",
        "velocity_error_percent",
        "normal_impulse_over_exact",
        "energy_residual_percent",
    ];
    let rows = places.iter().zip(&slid).map(|(p, s)| {
        let place = [p.angle, f64::from(p.eighths) / f64::from(PLACES), f64::from(p.eighths % 2)];
        place
            .into_iter()
            .chain([100.0 * (s.displacement - 1.0), 100.0 * (s.velocity - 1.0), s.normal_impulse, 100.0 * s.residual])
            .collect()
    });
    outcome.tables.push(("sliding_block_placements".into(), named_csv(&header, &[("falls_to_the", &SIDES)], rows)));
    let rows = one_each.iter().zip(&crept);
    let rows = rows
        .map(|(p, creep)| vec![p.angle, f64::from(p.eighths) / f64::from(PLACES), f64::from(p.eighths % 2), *creep]);
    let header = ["plane_to_grid_deg", "offset_cells", "falls_to_the", "creep_cells"];
    outcome.tables.push(("sliding_block_creep".into(), named_csv(&header, &[("falls_to_the", &SIDES)], rows)));
    Ok(())
}
