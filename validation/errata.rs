//! The numbers of `ERRATA.md`, computed again from the closed forms: what the page prints in bold, and nothing else.

use checkdam::theory::barrier::{bending_energy, buckling_density, normalised_stiffness, tip_stiffness, young_for};
use checkdam::theory::drucker_prager as cone;
use checkdam::theory::earth_pressure::{Wall, jaky};
use checkdam::theory::pic::numerical_viscosity;
use checkdam::theory::sliding_block::acceleration_from_rest;
use std::collections::BTreeSet;

const PAGE: &str = include_str!("ERRATA.md");
const WEIGHT: f64 = 30.0 * 9.81;
const MU: f64 = 0.4;
/// Area of 30 kg at 1500 kg/m3 in a channel of 0.2 m, m2.
const AREA: f64 = 30.0 / 1500.0 / 0.2;

fn rad(degrees: f64) -> f64 {
    degrees.to_radians()
}

/// Potential energy over the barrier's foot of the container's sand, 0.2 m x 0.5 m and 1.2 m up the bed, J.
fn initial_energy(bed: f64) -> f64 {
    WEIGHT * (1.3 * rad(bed).sin() + 0.25 * rad(bed).cos())
}

/// The same of a deposit with a level surface between a bed and a wall that rise at these angles (deg) from its foot, upstream
/// being 0: a triangle whose centre of mass is at two thirds of its depth.
fn level_energy(bed: f64, wall: f64) -> f64 {
    let depth = (2.0 * AREA / (1.0 / rad(bed).tan() - 1.0 / rad(wall).tan())).sqrt();
    WEIGHT * 2.0 * depth / 3.0
}

/// Smallest force on a barrier perpendicular to the bed with the base's friction mobilised up the flume: the barrier's drags
/// the sand onto the base.
fn smallest_force(mu: f64) -> f64 {
    WEIGHT * (rad(40.0).sin() - mu * rad(40.0).cos()) / (1.0 + mu * mu)
}

/// Every number with its digits, as the page prints it.
fn recomputed() -> Vec<String> {
    let phi = rad(31.0);
    let (outer, printed) = (cone::outer_slope(phi), cone::outer_slope(phi) / 3.0);
    let compression = |q: f64| cone::angle_of_ratio(cone::compression_ratio(q)).to_degrees();
    let plane = |q: f64| cone::plane_strain_angle(q, 0.0).to_degrees();
    let kept = |bed, wall| level_energy(bed, wall) / initial_energy(bed);
    let wall = Wall { friction_angle: phi, wall_friction_angle: MU.atan(), batter: 0.0, surface_slope: 0.0 };
    let theoretical = |bed: f64| WEIGHT * (rad(bed).sin() - MU * rad(bed).cos());
    let down = WEIGHT * (rad(40.0).sin() + MU * rad(40.0).cos()) / (1.0 - MU * MU);
    let block = |bed: f64, x: f64| (2.0 * acceleration_from_rest(9.81, rad(bed), MU) * x).sqrt();
    let (plastic, height, section) = (25.0 / 3.0, 0.6, 0.2 * 0.1);
    let second_moment = 0.2 * 1e-3 / 12.0;
    let first_frequency = |rigidity: f64, line_mass: f64| {
        3.516_015 / (2.0 * std::f64::consts::PI) * (rigidity / (line_mass * f64::powi(height, 4))).sqrt()
    };
    let share = bending_energy(plastic, height, 0.24) / initial_energy(60.0);
    let to_hold = (2.0 * 0.24 * initial_energy(60.0) / tip_stiffness(plastic, height)).sqrt();
    let confined: f64 = 1e6 * 0.7 / (1.3 * 0.4);
    let viscosity = |dt: f64| numerical_viscosity(5e-4, 0.01, dt, 2);
    vec![
        format!("{:.2}", compression(printed)),
        format!("{:.2}", plane(printed)),
        format!("{:.2}", plane(outer)),
        format!("{:.2}", cone::plane_strain_ratio(outer, 0.0)),
        format!("{:.2}", (1.0 + phi.sin()) / (1.0 - phi.sin())),
        format!("{:.3}", cone::oedometric_ratio(0.3, outer)),
        format!("{:.3}", 2.0 * 3f64.sqrt() * phi.cos() / (3.0 - phi.sin())),
        format!("{:.1}", 100.0 * (1.0 - kept(40.0, 130.0))),
        format!("{:.1}", 100.0 * (1.0 - kept(60.0, 90.0))),
        format!("{:.2}", bending_energy(plastic, height, 0.24)),
        format!("{:.1}", 100.0 * share),
        format!("{to_hold:.2}"),
        format!("{:.2}", theoretical(40.0)),
        format!("{:.1}", smallest_force(MU)),
        format!("{:.1}", theoretical(40.0) / (1.0 - MU * MU)),
        format!("{down:.1}"),
        format!("{:.1}", theoretical(23.0)),
        format!("{:.3}", {
            // The friction at which the smallest force is the 79 N measured, by bisection.
            let (mut low, mut high) = (0.4, 0.5);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if smallest_force(middle) > 79.0 { low = middle } else { high = middle }
            }
            low
        }),
        format!("{:.3}", wall.coulomb_active()),
        format!("{:.2}", wall.coulomb_passive()),
        format!("{:.3}", jaky(phi)),
        format!("{:.1}", (1e6f64 / 1500.0).sqrt()),
        format!("{:.1}", (confined / 1500.0).sqrt()),
        format!("{:.0}", 0.2 / 0.02),
        format!("{:.1}", young_for(2.5e-6, height, 0.1, 0.2) / 1e6),
        format!("{:.3}", normalised_stiffness(25e9 * second_moment, height)),
        format!("{:.2}", first_frequency(plastic, 2400.0 * section)),
        format!("{:.1}", first_frequency(plastic, 1200.0 * 0.2 * 0.005)),
        format!("{:.0}", buckling_density(plastic, height, section, 9.81)),
        format!("{:.2}", 1.3 * 0.6),
        format!("{:.3}", 2.0 * 1.2 / block(60.0, 1.2)),
        format!("{:.2}", block(40.0, 0.7)),
        format!("{:.2}", block(40.0, 1.2)),
        format!("{:.2}", block(60.0, 0.7)),
        format!("{:.2}", block(60.0, 1.2)),
        format!("{:.4}", 2.2 * 2.2 / (3.5 * 3.5 * 9.81 * rad(40.0).cos())),
        format!("{:.4}", 2.2 * 2.2 / (3.5 * 3.5 * 9.81)),
        format!("{:.1}", 100.0 * (1.0 - 1.4 / 2.2)),
        format!("{:.1e}", viscosity(1.3e-4)),
        format!("{:.1e}", viscosity(1.2e-6)),
    ]
}

#[test]
fn every_bold_number_of_the_page_is_computed_again() {
    let bold = |s: &&str| s.chars().all(|c| c.is_ascii_digit() || "+-.e".contains(c)) && !s.is_empty();
    let page: BTreeSet<String> = PAGE.split("**").filter(bold).map(String::from).collect();
    let computed: BTreeSet<String> = recomputed().into_iter().collect();
    assert!(page.len() > 35, "{page:?}");
    assert_eq!(page, computed);
}

#[test]
fn the_printed_active_coefficient_is_the_passive_one() {
    // Eq. 13 with alpha = beta = 0: cos^2(phi) / (cos(delta) (1 - sqrt(sin(phi + delta) sin(phi) / cos(delta)))^2), for both.
    let (phi, delta) = (rad(31.0), MU.atan());
    let bracket = 1.0 - ((phi + delta).sin() * phi.sin() / delta.cos()).sqrt();
    let printed = phi.cos().powi(2) / (delta.cos() * bracket * bracket);
    let wall = Wall { friction_angle: phi, wall_friction_angle: delta, batter: 0.0, surface_slope: 0.0 };
    assert!((printed / wall.coulomb_passive() - 1.0).abs() < 1e-12);
    assert!(printed > 10.0 * wall.coulomb_active());
}

/// No plane deposit behind the barrier has less energy than the level one.
#[test]
fn a_level_deposit_lies_lowest() {
    for (bed, wall) in [(40.0f64, 130.0f64), (60.0, 90.0)] {
        let level = level_energy(bed, wall);
        for slope in [-10.0f64, -5.0, 5.0, 10.0, 20.0, 30.0] {
            let (b, w, s) = (rad(bed), rad(wall), rad(slope).tan());
            // The surface from r up the wall to q up the bed.
            let ratio = (w.sin() - s * w.cos()) / (b.sin() - s * b.cos());
            let r = (2.0 * AREA / (ratio * (w - b).sin())).sqrt();
            let energy = WEIGHT * (r * w.sin() + ratio * r * b.sin()) / 3.0;
            assert!(energy > level, "{bed} {slope}: {energy} {level}");
        }
    }
}
