//! What a Drucker-Prager cone f = sqrt(J2) + q m - k, potential slope q_psi, amounts to in the tests of soil mechanics.
//!
//! m is the mean stress, tension positive: q = 3 alpha, where alpha multiplies the first invariant. Angles are those a
//! Mohr-Coulomb material would need. Closed forms follow from the yield and flow conditions in the state of failure, where
//! the stress no longer changes and the elastic strain rate is zero (Drucker and Prager 1952; Chen and Mizuno 1990; plane
//! strain as in Davis 1968).

use libm::{asin, atan, sin};

/// Slope q of the cone through the compression meridian ("outer cone") of a friction angle (rad).
pub fn outer_slope(friction_angle: f64) -> f64 {
    let s = sin(friction_angle);
    6.0 * s / (3f64.sqrt() * (3.0 - s))
}

/// Slope q of the cone through the extension meridian ("inner cone") of a friction angle (rad).
pub fn inner_slope(friction_angle: f64) -> f64 {
    let s = sin(friction_angle);
    6.0 * s / (3f64.sqrt() * (3.0 + s))
}

/// Ratio of the largest to the smallest compressive stress at failure in triaxial compression, (1 + 2x) / (1 - x), x = q/sqrt(3).
pub fn compression_ratio(q: f64) -> f64 {
    let x = q / 3f64.sqrt();
    (1.0 + 2.0 * x) / (1.0 - x)
}

/// Ratio of the largest to the smallest compressive stress at failure in triaxial extension, (1 + x) / (1 - 2x), x = q/sqrt(3).
pub fn extension_ratio(q: f64) -> f64 {
    let x = q / 3f64.sqrt();
    (1.0 + x) / (1.0 - 2.0 * x)
}

/// Friction angle (rad) that a principal stress ratio stands for without cohesion, sin(phi) = (r - 1) / (r + 1).
pub fn angle_of_ratio(ratio: f64) -> f64 {
    asin((ratio - 1.0) / (ratio + 1.0))
}

/// Sine of the friction angle in plane strain at failure, q sqrt(1 - q_psi^2/3) / (1 - q q_psi/3).
///
/// At failure the out-of-plane plastic strain rate vanishes, so the out-of-plane deviator is -2/3 q_psi sqrt(J2).
pub fn plane_strain_sine(q: f64, q_psi: f64) -> f64 {
    q * (1.0 - q_psi * q_psi / 3.0).sqrt() / (1.0 - q * q_psi / 3.0)
}

/// Friction angle in plane strain at failure, rad.
pub fn plane_strain_angle(q: f64, q_psi: f64) -> f64 {
    asin(plane_strain_sine(q, q_psi))
}

/// Slope q_psi of the potential for a dilatancy angle (rad) in plane strain, sin(psi) / sqrt(1 + sin^2(psi)/3): the in-plane
/// volume gained per shear at failure is then sin(psi).
pub fn plane_strain_potential(dilatancy_angle: f64) -> f64 {
    let s = sin(dilatancy_angle);
    s / (1.0 + s * s / 3.0).sqrt()
}

/// Slope q that fails at a friction angle (rad) in plane strain, given q_psi: the inverse of [`plane_strain_sine`].
pub fn plane_strain_slope(friction_angle: f64, q_psi: f64) -> f64 {
    let s = sin(friction_angle);
    s / ((1.0 - q_psi * q_psi / 3.0).sqrt() + s * q_psi / 3.0)
}

/// Ratio of the in-plane principal stresses at failure in plane strain, without cohesion.
pub fn plane_strain_ratio(q: f64, q_psi: f64) -> f64 {
    let s = plane_strain_sine(q, q_psi);
    (1.0 + s) / (1.0 - s)
}

/// Largest stress (Pa) of a column that is free to spread in the plane, 2 sqrt(1 - q_psi^2/3) k / (1 - q sqrt(1 - q_psi^2/3) - q q_psi/3), with
/// the strength `k` (Pa) at zero mean stress: 2 k without friction.
///
/// The yield condition in the state of failure, with one in-plane principal stress zero and the out-of-plane deviator -2/3 q_psi sqrt(J2).
pub fn unconfined_strength(q: f64, k: f64, q_psi: f64) -> f64 {
    let root = (1.0 - q_psi * q_psi / 3.0).sqrt();
    2.0 * root * k / (1.0 - q * root - q * q_psi / 3.0)
}

/// Shear over normal stress in simple shear at failure, q sqrt(1 - 4 q_psi^2/3) / (1 - 4 q q_psi/3): q itself at constant volume.
///
/// Strain along the shear plane and out of plane vanish, so both deviators are -2/3 q_psi sqrt(J2).
pub fn simple_shear_ratio(q: f64, q_psi: f64) -> f64 {
    q * (1.0 - 4.0 * q_psi * q_psi / 3.0).sqrt() / (1.0 - 4.0 * q * q_psi / 3.0)
}

/// Dilatancy angle in simple shear at failure, rad: tan = q_psi / sqrt(1 - 4 q_psi^2/3), volume gained per engineering shear.
pub fn simple_shear_dilatancy(q_psi: f64) -> f64 {
    atan(q_psi / (1.0 - 4.0 * q_psi * q_psi / 3.0).sqrt())
}

/// Lateral over vertical stress on the cone when lateral strain is prevented: (sqrt(3) - q) / (sqrt(3) + 2 q), no cohesion.
pub fn oedometric_limit(q: f64) -> f64 {
    (3f64.sqrt() - q) / (3f64.sqrt() + 2.0 * q)
}

/// Lateral over vertical stress in first confined compression from zero stress at constant plastic volume: elastic
/// nu / (1 - nu), or the limit of the cone where that is larger. The path is straight.
pub fn oedometric_ratio(poisson: f64, q: f64) -> f64 {
    (poisson / (1.0 - poisson)).max(oedometric_limit(q))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PHI: f64 = 31.0 * std::f64::consts::PI / 180.0;

    fn near(a: f64, b: f64, tolerance: f64) {
        assert!((a - b).abs() <= tolerance, "{a} instead of {b}");
    }

    #[test]
    fn angles_of_the_cones_at_31_degrees() {
        let (outer, inner) = (outer_slope(PHI), inner_slope(PHI));
        let printed = outer / 3.0;
        near(outer / 3.0, 0.23933, 5e-6);
        near(inner / 3.0, 0.16919, 5e-6);
        near(plane_strain_angle(outer, 0.0).to_degrees(), 45.89, 5e-3);
        near(plane_strain_angle(printed, 0.0).to_degrees(), 13.85, 5e-3);
        near(plane_strain_angle(inner, 0.0).to_degrees(), 30.50, 5e-3);
        near(plane_strain_angle(sin(PHI), 0.0).to_degrees(), 31.0, 1e-12);
        near(angle_of_ratio(compression_ratio(outer)).to_degrees(), 31.0, 1e-12);
        near(angle_of_ratio(compression_ratio(printed)).to_degrees(), 11.18, 5e-3);
        near(angle_of_ratio(extension_ratio(inner)).to_degrees(), 31.0, 1e-12);
        near(angle_of_ratio(extension_ratio(outer)).to_degrees(), 51.7, 5e-2);
    }

    #[test]
    fn stress_ratios_at_31_degrees() {
        let (outer, inner) = (outer_slope(PHI), inner_slope(PHI));
        near(compression_ratio(outer), 3.12404, 5e-6);
        near(extension_ratio(outer), 8.274, 5e-4);
        near(plane_strain_ratio(outer, 0.0), 6.0916, 5e-5);
        near(plane_strain_ratio(inner, 0.0), 3.0615, 5e-5);
        near(plane_strain_ratio(outer / 3.0, 0.0), 1.6292, 5e-5);
        near(plane_strain_angle(outer, outer).to_degrees(), 52.1, 5e-2);
        near(simple_shear_ratio(outer, 0.0), 0.71798, 5e-6);
        near(simple_shear_ratio(inner, 0.0), 0.50757, 5e-6);
    }

    #[test]
    fn associated_flow_in_plane_strain_is_the_classical_match() {
        // alpha = tan(phi) / sqrt(9 + 12 tan^2(phi)), Drucker and Prager (1952): 0.16456 at 31 degrees.
        let t = libm::tan(PHI);
        let alpha = t / (9.0 + 12.0 * t * t).sqrt();
        near(alpha, 0.16456, 5e-6);
        near(plane_strain_angle(3.0 * alpha, 3.0 * alpha), PHI, 1e-12);
        near(plane_strain_potential(PHI), 3.0 * alpha, 1e-12);
        near(plane_strain_slope(PHI, 3.0 * alpha), 3.0 * alpha, 1e-12);
        // Simple shear then gives Coulomb's line, and the same dilatancy angle.
        near(simple_shear_dilatancy(3.0 * alpha), PHI, 1e-12);
        near(simple_shear_ratio(3.0 * alpha, 3.0 * alpha), t, 1e-12);
    }

    /// Mohr-Coulomb: 2 c tan(45 degrees + phi/2), and 2 c without friction; at any dilatancy angle, for the cone matched in plane strain.
    #[test]
    fn unconfined_columns() {
        near(unconfined_strength(0.0, 250.0, 0.0), 500.0, 1e-12);
        let mohr_coulomb = 500.0 * libm::tan(0.25 * std::f64::consts::PI + 0.5 * PHI);
        near(mohr_coulomb, 883.75, 5e-3);
        for psi in [0.0, 0.2, PHI] {
            let q_psi = plane_strain_potential(psi);
            let q = plane_strain_slope(PHI, q_psi);
            near(unconfined_strength(q, q * 250.0 / libm::tan(PHI), q_psi), mohr_coulomb, 1e-9);
        }
    }

    #[test]
    fn coefficients_at_rest() {
        let outer = outer_slope(PHI);
        near(oedometric_ratio(0.3, outer), 0.42857, 5e-6);
        near(oedometric_ratio(0.3, inner_slope(PHI)), 0.44572, 5e-6);
        near(oedometric_ratio(0.3, sin(PHI)), 0.44061, 5e-6);
        near(oedometric_ratio(0.3, outer / 3.0), 0.67523, 5e-6);
        near(1.0 / oedometric_limit(outer), compression_ratio(outer), 1e-12);
    }
}
