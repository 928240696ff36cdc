//! Line contact of an elastic cylinder, in plane strain (Hertz 1882; Johnson 1985, section 4.2).
//!
//! `load` is the force per length of the cylinder (N/m), `radius` that of the cylinder, or 1/(1/R1 + 1/R2) of two (m), `modulus`
//! the contact modulus E* of [`contact_modulus`] (Pa). Valid while the half width is small against the radius.

use super::elastic::Elastic;
use std::f64::consts::PI;

/// Contact modulus of two bodies, 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2, Pa. `None` is a rigid body.
pub fn contact_modulus(first: Option<&Elastic>, second: Option<&Elastic>) -> f64 {
    1.0 / [first, second].into_iter().flatten().map(|e| 1.0 / e.plane_strain()).sum::<f64>()
}

/// Half width of the contact, sqrt(4 P R / (pi E*)), m.
pub fn half_width(load: f64, radius: f64, modulus: f64) -> f64 {
    (4.0 * load * radius / (PI * modulus)).sqrt()
}

/// Load that makes a half width, pi E* a^2 / (4 R), N/m.
pub fn load(half_width: f64, radius: f64, modulus: f64) -> f64 {
    PI * modulus * half_width * half_width / (4.0 * radius)
}

/// Largest pressure, sqrt(P E* / (pi R)), Pa.
pub fn peak_pressure(load: f64, radius: f64, modulus: f64) -> f64 {
    (load * modulus / (PI * radius)).sqrt()
}

/// Pressure at `x` (m) from the middle, p0 sqrt(1 - x^2/a^2), Pa.
pub fn pressure(load: f64, radius: f64, modulus: f64, x: f64) -> f64 {
    let a = half_width(load, radius, modulus);
    peak_pressure(load, radius, modulus) * (1.0 - (x / a) * (x / a)).max(0.0).sqrt()
}

/// How much nearer the two ends of a diameter come when an elastic cylinder is pressed between two rigid planes,
/// 4 P (1 - nu^2)/(pi E) (ln(4 R/a) - 1/2), m (Johnson 1985, Eq. 5.57, both contacts).
pub fn squeeze(load: f64, radius: f64, cylinder: &Elastic) -> f64 {
    let modulus = cylinder.plane_strain();
    let a = half_width(load, radius, modulus);
    4.0 * load / (PI * modulus) * (libm::log(4.0 * radius / a) - 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    const E: Elastic = Elastic { young: 1e6, poisson: 0.3 };

    #[test]
    fn a_cylinder_on_a_rigid_plane() {
        let modulus = contact_modulus(Some(&E), None);
        assert!((modulus - 1e6 / 0.91).abs() < 1e-6);
        assert!((half_width(100.0, 0.1, modulus) - 3.404e-3).abs() < 1e-6);
        assert!((peak_pressure(100.0, 0.1, modulus) - 18.70e3).abs() < 5.0);
        assert!((load(half_width(100.0, 0.1, modulus), 0.1, modulus) - 100.0).abs() < 1e-9);
    }

    #[test]
    fn the_pressure_carries_the_load() {
        let modulus = contact_modulus(Some(&E), Some(&E));
        let a = half_width(100.0, 0.1, modulus);
        let n = 20_000;
        let dx = 2.0 * a / f64::from(n);
        let sum: f64 = (0..n).map(|k| pressure(100.0, 0.1, modulus, (f64::from(k) + 0.5) * dx - a) * dx).sum();
        assert!((sum / 100.0 - 1.0).abs() < 1e-5);
        assert_eq!(pressure(100.0, 0.1, modulus, 1.01 * a), 0.0);
        assert!((modulus * 2.0 * 0.91 / 1e6 - 1.0).abs() < 1e-12, "two equal bodies are half as stiff");
    }

    #[test]
    fn squeezing_takes_work() {
        // The slope of the squeeze with the load falls with the load: contact stiffens as it widens.
        let slope = |p: f64| (squeeze(1.01 * p, 0.1, &E) - squeeze(0.99 * p, 0.1, &E)) / (0.02 * p);
        assert!(slope(10.0) > slope(100.0) && slope(100.0) > 0.0);
    }
}
