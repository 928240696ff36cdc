//! Simple shear of an elastic material whose Jaumann stress rate is C : D (Dienes 1979).

use libm::{cos, sin};

/// Shear stress after the engineering shear `gamma` from a stress-free state, G sin(gamma), Pa.
pub fn shear_stress(shear_modulus: f64, gamma: f64) -> f64 {
    shear_modulus * sin(gamma)
}

/// Normal stress along the shear direction, G (1 - cos(gamma)), Pa; across it, the negative.
pub fn normal_stress(shear_modulus: f64, gamma: f64) -> f64 {
    shear_modulus * (1.0 - cos(gamma))
}

/// In-plane components xx, yy, xy of a stress turned counter-clockwise by `angle` (rad): R sigma R^T.
pub fn turned(xx: f64, yy: f64, xy: f64, angle: f64) -> [f64; 3] {
    let (centre, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    let (c, s) = (cos(2.0 * angle), sin(2.0 * angle));
    let d = half * c - xy * s;
    [centre + d, centre - d, half * s + xy * c]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn solves_the_rate_equations() {
        // d(xy)/d(gamma) = G - (xx - yy)/2 and d(xx)/d(gamma) = xy.
        let (g, e) = (3.0, 1e-5);
        for gamma in [0.1, 0.9, 2.3] {
            let rate = (shear_stress(g, gamma + e) - shear_stress(g, gamma - e)) / (2.0 * e);
            assert!((rate - (g - normal_stress(g, gamma))).abs() < 1e-9);
            let rate = (normal_stress(g, gamma + e) - normal_stress(g, gamma - e)) / (2.0 * e);
            assert!((rate - shear_stress(g, gamma)).abs() < 1e-9);
        }
        assert!((shear_stress(g, FRAC_PI_2) - g).abs() < 1e-15);
    }

    #[test]
    fn a_quarter_turn_swaps_the_normal_stresses() {
        let [xx, yy, xy] = turned(3.0, 1.0, 0.5, FRAC_PI_2);
        assert!((xx - 1.0).abs() + (yy - 3.0).abs() + (xy + 0.5).abs() < 1e-12);
        // Uniaxial tension along x, turned by 30 degrees.
        let [xx, yy, xy] = turned(4.0, 0.0, 0.0, FRAC_PI_2 / 3.0);
        assert!((xx - 3.0).abs() + (yy - 1.0).abs() + (xy - 3f64.sqrt()).abs() < 1e-12);
    }
}
