//! What a Mohr-Coulomb material with the friction angle phi, the dilatancy angle psi and the cohesion c amounts to in the tests of soil
//! mechanics, and what softening makes of it.
//!
//! Closed forms from the yield and flow conditions in the state of failure, where the elastic strain rate is zero (Davis 1968;
//! Terzaghi 1943). Compression is positive in ratios.

use libm::{cos, sin, tan};

/// Ratio of the largest to the smallest compressive stress at failure without cohesion, (1 + sin phi) / (1 - sin phi), whatever the
/// stress between them: in triaxial compression, in triaxial extension and in plane strain alike. Rankine's Kp; its inverse is Ka.
pub fn passive_ratio(friction_angle: f64) -> f64 {
    (1.0 + sin(friction_angle)) / (1.0 - sin(friction_angle))
}

/// Strength of a column that is free to spread, 2 c tan(45 degrees + phi/2), in the unit of `cohesion`.
pub fn unconfined_strength(friction_angle: f64, cohesion: f64) -> f64 {
    2.0 * cohesion * tan(0.25 * std::f64::consts::PI + 0.5 * friction_angle)
}

/// Largest mean stress, c cot phi, in the unit of `cohesion`: the apex of the pyramid.
pub fn apex(friction_angle: f64, cohesion: f64) -> f64 {
    cohesion / tan(friction_angle)
}

/// Shear over normal stress in simple shear at failure, sin phi cos psi / (1 - sin phi sin psi): tan phi for psi = phi, sin phi at
/// constant volume.
pub fn simple_shear_ratio(friction_angle: f64, dilatancy_angle: f64) -> f64 {
    let (s, p) = (sin(friction_angle), sin(dilatancy_angle));
    s * cos(dilatancy_angle) / (1.0 - s * p)
}

/// Lateral over vertical stress in first confined compression from zero stress without cohesion and dilatancy: the elastic nu / (1 - nu),
/// or Ka where that is larger. The path is straight.
pub fn oedometric_ratio(poisson: f64, friction_angle: f64) -> f64 {
    (poisson / (1.0 - poisson)).max(1.0 / passive_ratio(friction_angle))
}

/// Shear strength over pressure, friction that falls in a straight line with the plastic shear: what sheared by `gamma` (engineering
/// strain) at a constant mean pressure carries, over that pressure.
///
/// Elastic up to `peak` with `stiffness` = G/p. From there on `peak - drop g / over` with the plastic shear g = gamma - ratio/stiffness,
/// down to `peak - drop` where g = `over`. With h = drop/over, the descent has the slope -h k / (k - h) in gamma, k being the
/// stiffness; h above k would snap back.
pub fn softened_ratio(gamma: f64, stiffness: f64, peak: f64, drop: f64, over: f64) -> f64 {
    let (first, fall) = (peak / stiffness, drop / over);
    if gamma <= first {
        return stiffness * gamma;
    }
    (peak - fall * stiffness / (stiffness - fall) * (gamma - first)).max(peak - drop)
}

/// Work that a band takes to lose all of its strength per area and width, strength that falls in a straight line over the plastic shear
/// `over` (engineering strain): in the unit of the strength.
pub fn softening_work(strength: f64, over: f64) -> f64 {
    0.5 * strength * over
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::theory::drucker_prager as cone;

    const PHI: f64 = 31.0 * std::f64::consts::PI / 180.0;

    fn near(a: f64, b: f64, tolerance: f64) {
        assert!((a - b).abs() <= tolerance, "{a} instead of {b}");
    }

    #[test]
    fn it_is_what_cones_matched_to_it_say() {
        // 3.12404 at 31 degrees, see the cones; the meridians of both cones, and the plane-strain cone at any dilatancy.
        near(passive_ratio(PHI), 3.12404, 5e-6);
        near(passive_ratio(PHI), cone::compression_ratio(cone::outer_slope(PHI)), 1e-12);
        near(passive_ratio(PHI), cone::extension_ratio(cone::inner_slope(PHI)), 1e-12);
        near(unconfined_strength(PHI, 250.0), 883.75, 5e-3);
        near(simple_shear_ratio(PHI, PHI), tan(PHI), 1e-12);
        near(simple_shear_ratio(PHI, 0.0), sin(PHI), 1e-12);
        for psi in [0.0, 0.2, PHI] {
            let q_psi = cone::plane_strain_potential(psi);
            let q = cone::plane_strain_slope(PHI, q_psi);
            near(passive_ratio(PHI), cone::plane_strain_ratio(q, q_psi), 1e-9);
        }
        near(apex(PHI, 500.0), 832.14, 5e-3);
        near(oedometric_ratio(0.3, PHI), 0.3 / 0.7, 1e-12);
        near(oedometric_ratio(0.1, PHI), 1.0 / 3.12404, 1e-6);
    }

    #[test]
    fn softening_descends_in_a_straight_line() {
        // Peak 0.6 at 6e-3; down to 0.5 over a plastic shear of 0.1: at gamma = 0.1 + 0.5/100.
        let at = |gamma| softened_ratio(gamma, 100.0, 0.6, 0.1, 0.1);
        near(at(3e-3), 0.3, 1e-12);
        near(at(6e-3), 0.6, 1e-12);
        near(at(0.105), 0.5, 1e-12);
        near(at(0.3), 0.5, 1e-12);
        // The triangle below the descent.
        near(softening_work(1000.0, 0.1), 50.0, 1e-12);
        // Half of the plastic shear: 0.55 at 0.05 + 0.0055.
        near(at(0.0555), 0.55, 1e-12);
    }
}
