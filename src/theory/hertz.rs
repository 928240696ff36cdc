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

/// An elastic body with a wavy surface on a flat one: a row of Hertzian contacts (Westergaard 1939; Johnson 1985, section 13.2).
///
/// Unloaded, the gap is `amplitude` (1 - cos(2 pi x / `wavelength`)). Loads are mean pressures over a wavelength. As the half
/// width becomes small against the wavelength, each contact becomes that of a cylinder of [`Wavy::radius`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wavy {
    /// From crest to crest, m.
    pub wavelength: f64,
    /// Half of the height from trough to crest, m.
    pub amplitude: f64,
    /// Contact modulus E* of [`contact_modulus`], Pa.
    pub modulus: f64,
}

impl Wavy {
    /// Radius of curvature of a crest, m.
    pub fn radius(&self) -> f64 {
        let k = 2.0 * PI / self.wavelength;
        1.0 / (self.amplitude * k * k)
    }

    /// Mean pressure at which the surfaces touch everywhere, pi E* amplitude / wavelength, Pa.
    pub fn closing_pressure(&self) -> f64 {
        PI * self.modulus * self.amplitude / self.wavelength
    }

    /// Mean pressure that makes a half width (m), Pa.
    pub fn mean_pressure(&self, half_width: f64) -> f64 {
        let s = libm::sin(PI * half_width / self.wavelength);
        self.closing_pressure() * s * s
    }

    /// Half width of each contact under a mean pressure (Pa) up to the one that closes all gaps, m.
    pub fn half_width(&self, mean_pressure: f64) -> f64 {
        libm::asin((mean_pressure / self.closing_pressure()).sqrt()) * self.wavelength / PI
    }

    /// Pressure at `x` (m) from a crest, at most half a wavelength away, Pa.
    pub fn pressure(&self, mean_pressure: f64, x: f64) -> f64 {
        let part = mean_pressure / self.closing_pressure();
        let angle = PI * x / self.wavelength;
        let inside = (part - libm::sin(angle) * libm::sin(angle)).max(0.0);
        2.0 * self.closing_pressure() * libm::cos(angle) * inside.sqrt()
    }

    /// How much nearer the mean levels of the surfaces come, amplitude b (1 - ln b) with b the mean pressure over the closing one,
    /// m. Its derivative is the compliance of a row of flat punches, -2/(pi E*) ln sin(pi a/wavelength) per force per length.
    pub fn approach(&self, mean_pressure: f64) -> f64 {
        let part = mean_pressure / self.closing_pressure();
        self.amplitude * part * (1.0 - libm::log(part))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WAVY: Wavy = Wavy { wavelength: 0.2, amplitude: 1e-3, modulus: 1e6 };

    #[test]
    fn narrow_contacts_of_a_row_are_those_of_cylinders() {
        let mean = 1e-6 * WAVY.closing_pressure();
        let (p, r) = (mean * WAVY.wavelength, WAVY.radius());
        let a = half_width(p, r, WAVY.modulus);
        assert!((WAVY.half_width(mean) / a - 1.0).abs() < 1e-5);
        assert!((WAVY.mean_pressure(a) / mean - 1.0).abs() < 1e-5);
        for x in [0.0, 0.5 * a, 0.9 * a] {
            assert!((WAVY.pressure(mean, x) / pressure(p, r, WAVY.modulus, x) - 1.0).abs() < 1e-5);
        }
        assert_eq!(WAVY.pressure(mean, 1.01 * a), 0.0);
    }

    #[test]
    fn a_row_carries_its_load_and_closes() {
        let mean = 0.3 * WAVY.closing_pressure();
        let n = 20_000;
        let dx = WAVY.wavelength / f64::from(n);
        let at = |k| (f64::from(k) + 0.5) * dx - 0.5 * WAVY.wavelength;
        let sum: f64 = (0..n).map(|k| WAVY.pressure(mean, at(k)) * dx).sum();
        assert!((sum / (mean * WAVY.wavelength) - 1.0).abs() < 1e-5);
        assert!((WAVY.half_width(WAVY.closing_pressure()) / (0.5 * WAVY.wavelength) - 1.0).abs() < 1e-12);
        assert!((WAVY.approach(WAVY.closing_pressure()) / WAVY.amplitude - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_approach_of_a_row_grows_by_the_compliance_of_punches() {
        let mean = 0.1 * WAVY.closing_pressure();
        let d = 1e-5 * mean;
        let slope = (WAVY.approach(mean + d) - WAVY.approach(mean - d)) / (2.0 * d * WAVY.wavelength);
        let sine = libm::sin(PI * WAVY.half_width(mean) / WAVY.wavelength);
        assert!((slope / (-2.0 / (PI * WAVY.modulus) * libm::log(sine)) - 1.0).abs() < 1e-6);
    }

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
}
