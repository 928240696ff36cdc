//! A beam clamped at one end: deflections of Timoshenko's beam, its first frequency, and the elastica.

use super::elastic::Elastic;
use libm::{cos, cosh, sin, sinh};

/// A strip in plane strain of depth `depth` in the plane of bending, clamped at its foot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cantilever {
    /// Elasticity.
    pub elastic: Elastic,
    /// Density, kg/m3.
    pub density: f64,
    /// Length, m.
    pub length: f64,
    /// Depth t, m.
    pub depth: f64,
    /// Extent across the plane, m.
    pub width: f64,
}

impl Cantilever {
    /// E/(1 - nu^2) I, N m2.
    pub fn bending_stiffness(&self) -> f64 {
        self.elastic.plane_strain() * self.width * self.depth * self.depth * self.depth / 12.0
    }

    /// kappa G A with kappa = 10 (1 + nu) / (12 + 11 nu) (Cowper 1966), N; in plane strain with nu / (1 - nu) for nu.
    pub fn shear_stiffness(&self) -> f64 {
        let nu = self.elastic.lateral_ratio();
        10.0 * (1.0 + nu) / (12.0 + 11.0 * nu) * self.elastic.shear() * self.width * self.depth
    }

    /// Deflection at `at` (m) from the clamp under a force (N) there (Timoshenko 1921), m.
    pub fn under_force(&self, force: f64, at: f64) -> f64 {
        force * at * at * at / (3.0 * self.bending_stiffness()) + force * at / self.shear_stiffness()
    }

    /// Deflection at `at` (m) from the clamp under `load` (N/m) all along (Timoshenko 1921), m.
    pub fn under_load(&self, load: f64, at: f64) -> f64 {
        let l = self.length;
        load * at * at * (6.0 * l * l - 4.0 * l * at + at * at) / (24.0 * self.bending_stiffness())
            + load * (l * at - 0.5 * at * at) / self.shear_stiffness()
    }

    /// First angular frequency of Timoshenko's beam (Huang 1961), rad/s.
    pub fn frequency(&self) -> f64 {
        let area = self.width * self.depth;
        let l2 = self.length * self.length;
        let r2 = self.depth * self.depth / (12.0 * l2);
        let s2 = self.bending_stiffness() / (self.shear_stiffness() * l2);
        let characteristic = |b: f64| {
            let root = ((r2 - s2) * (r2 - s2) + 4.0 / (b * b)).sqrt();
            let alpha = (0.5 * (root - (r2 + s2))).sqrt();
            let beta = (0.5 * (root + r2 + s2)).sqrt();
            let coupling = b * (r2 + s2) / (1.0 - b * b * r2 * s2).sqrt();
            2.0 + (b * b * (r2 - s2) * (r2 - s2) + 2.0) * cosh(b * alpha) * cos(b * beta)
                - coupling * sinh(b * alpha) * sin(b * beta)
        };
        let b = root_between(1.0, 3.6, characteristic);
        b * (self.bending_stiffness() / (self.density * area)).sqrt() / l2
    }
}

/// First mode of Euler's and Bernoulli's cantilever at `s` in [0, 1], one at the tip.
pub fn first_mode(s: f64) -> f64 {
    let k = 1.875_104_068_7;
    let ratio = (cosh(k) + cos(k)) / (sinh(k) + sin(k));
    0.5 * (cosh(k * s) - cos(k * s) - ratio * (sinh(k * s) - sin(k * s)))
}

/// Tip of the elastica under a dead force P across its straight axis: angle (rad), what the tip comes nearer to the clamp
/// along the axis, and its deflection, over L; `load` is P L^2 / (E'I) (Bisshopp and Drucker 1945).
pub fn elastica(load: f64) -> [f64; 3] {
    bent(load, |_| load)
}

/// The same under a dead load w (N/m) all along, across its straight axis; `load` is w L^3 / (E'I).
pub fn elastica_under_load(load: f64) -> [f64; 3] {
    bent(load, |s| load * (1.0 - s))
}

/// The elastica of length 1 whose cross section at `s` carries the force `shear(s)` across the straight axis, over E'I; `most` bounds the
/// curvature at the clamp.
fn bent(most: f64, shear: impl Fn(f64) -> f64) -> [f64; 3] {
    // d2 angle/ds2 = -shear cos(angle), angle(0) = 0, no curvature at the tip: shoot with the curvature at the clamp.
    let shoot = |curvature: f64| {
        let n = 2000;
        let ds = 1.0 / f64::from(n);
        let slope = |y: [f64; 4], s: f64| [y[1], -shear(s) * cos(y[0]), cos(y[0]), sin(y[0])];
        let along = |y: [f64; 4], k: [f64; 4], s: f64| [0, 1, 2, 3].map(|i| y[i] + s * k[i]);
        let mut y = [0.0, curvature, 0.0, 0.0];
        for k in 0..n {
            let s = f64::from(k) * ds;
            let k1 = slope(y, s);
            let k2 = slope(along(y, k1, 0.5 * ds), s + 0.5 * ds);
            let k3 = slope(along(y, k2, 0.5 * ds), s + 0.5 * ds);
            let k4 = slope(along(y, k3, ds), s + ds);
            y = [0, 1, 2, 3].map(|i| y[i] + ds / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        }
        y
    };
    let [angle, _, along, across] = shoot(root_between(0.0, most, |c| shoot(c)[1]));
    [angle, 1.0 - along, across]
}

/// The root of `f` between two places where its signs differ, by bisection.
fn root_between(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let sign = f(low) > 0.0;
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if (f(middle) > 0.0) == sign {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn beam(slenderness: f64) -> Cantilever {
        let elastic = Elastic { young: 1e6, poisson: 0.3 };
        Cantilever { elastic, density: 2000.0, length: 0.1 * slenderness, depth: 0.1, width: 0.1 }
    }

    #[test]
    fn timoshenko_lowers_the_frequency() {
        for (slenderness, known) in [(6.0, 0.97746), (10.0, 0.99167), (20.0, 0.99790)] {
            let b = beam(slenderness);
            // Over Euler's and Bernoulli's beam, 3.51602 sqrt(E'I / (rho A L^4)).
            let mass = b.density * b.width * b.depth;
            let slender = 3.516_015_268_5 * (b.bending_stiffness() / mass).sqrt() / (b.length * b.length);
            let ratio = b.frequency() / slender;
            assert!((ratio - known).abs() < 3e-4, "{slenderness}: {ratio}");
        }
    }

    #[test]
    fn elastica_of_the_tables() {
        for (load, known) in [
            (0.5, [0.244_534, 0.015_919, 0.162_144]),
            (1.0, [0.461_352, 0.056_433, 0.301_721]),
            (2.0, [0.781_750, 0.160_642, 0.493_457]),
            (10.0, [1.430_286, 0.554_996, 0.810_609]),
        ] {
            let tip = elastica(load);
            assert!(tip.iter().zip(known).all(|(a, b)| (a - b).abs() < 2e-6), "{load}: {tip:?}");
        }
    }

    /// Iaconeta et al. (2017): a beam of 8 m by 1 m, 90 MPa, Poisson's ratio 0 and 1000 kg/m3 hangs by 0.67433 m under its weight, by
    /// finite elements and three meshfree methods.
    #[test]
    fn a_beam_hangs_under_its_weight_as_others_have_it() {
        let elastic = Elastic { young: 9e7, poisson: 0.0 };
        let beam = Cantilever { elastic, density: 1000.0, length: 8.0, depth: 1.0, width: 1.0 };
        let weight = 9810.0;
        let [_, _, bent] = elastica_under_load(weight * 512.0 / beam.bending_stiffness());
        let shear = 0.5 * weight * 64.0 / beam.shear_stiffness();
        assert!((8.0 * bent + shear - 0.67433).abs() < 5e-5, "{}", 8.0 * bent + shear);
        // Without large rotations 0.5 % more.
        assert!((beam.under_load(weight, 8.0) - 0.67807).abs() < 5e-5);
    }

    #[test]
    fn small_deflections_agree_with_each_other() {
        let b = beam(10.0);
        let load = 1e-3;
        let force = load * b.bending_stiffness() / (b.length * b.length);
        let bending = b.under_force(force, b.length) - force * b.length / b.shear_stiffness();
        assert!((elastica(load)[2] * b.length / bending - 1.0).abs() < 1e-6);
        assert!((elastica_under_load(load)[2] * b.length / (0.375 * bending) - 1.0).abs() < 1e-6);
        // A force spread over the beam bends the tip 3/8 as far, and shears it half as far.
        let spread = b.under_load(force / b.length, b.length);
        let shear = force * b.length / b.shear_stiffness();
        assert!((spread - (0.375 * bending + 0.5 * shear)).abs() < 1e-12 * spread + 1e-15);
        assert!((first_mode(1.0) - 1.0).abs() < 1e-9 && first_mode(0.0) == 0.0);
    }
}
