//! The neo-Hookean law in the reference configuration: nominal stress from the gradient of the displacement.
//!
//! Elsewhere: first Piola-Kirchhoff stress.

use super::logarithm::log1p;
use super::{Finger, NeoHookean};

/// Gradient of the displacement in the reference configuration, F - I: xx, xy, yx, yy, where xy is d u_x/d Y.
pub type Gradient = [f64; 4];

/// What the law says of a deformation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nominal {
    /// Nominal stress P = dW/dF in the plane, xx, xy, yx, yy: force per reference area, Pa.
    pub stress: [f64; 4],
    /// Stored energy per reference volume W, J/m3.
    pub energy: f64,
    /// Volume ratio J.
    pub volume_ratio: f64,
    /// A bound of the largest eigenvalue of dP/dF, Pa: the square of the fastest wave times the reference density is not above it.
    pub stiffness: f64,
}

impl NeoHookean {
    /// Stress and energy in a deformation: P = mu (F - F^-T) + lambda ln J F^-T.
    #[inline]
    pub fn nominal(&self, h: &Gradient) -> Nominal {
        let &[a, b, c, d] = h;
        let less_one = a + d + (a * d - b * c);
        let j = 1.0 + less_one;
        let ln = log1p(less_one);
        let (mu, lambda) = (self.shear, self.lame);
        // J F^-T, and F - F^-T times J without the difference of large numbers.
        let cofactor = [1.0 + d, -c, -b, 1.0 + a];
        let f = [1.0 + a, b, c, 1.0 + d];
        let apart = [a - d, b + c, b + c, d - a];
        let per = 1.0 / j;
        let stress = std::array::from_fn(|k| per * (mu * (less_one * f[k] + apart[k]) + lambda * ln * cofactor[k]));
        let strain = 2.0 * (a + d) + (a * a + b * b + c * c + d * d);
        // Of F^-T: the sum of its squared singular values, and the largest of them.
        let squares = (strain + 2.0) * per * per;
        let largest = 0.5 * (squares + (squares * squares - 4.0 * per * per).max(0.0).sqrt());
        Nominal {
            stress,
            energy: 0.5 * mu * (strain - 2.0 * ln) + 0.5 * lambda * ln * ln,
            volume_ratio: j,
            stiffness: mu + (mu - lambda * ln).abs() * largest + lambda * squares,
        }
    }
}

impl NeoHookean {
    /// Tangent dP/dF in a deformation, Pa: the change of P, row by row in the order of [`Nominal::stress`], with each component of F.
    ///
    /// With G = F^-T: `mu dF + (mu - lambda ln J) G dF^T G + lambda (G : dF) G`, which is symmetric.
    #[inline]
    pub fn tangent(&self, h: &Gradient) -> [[f64; 4]; 4] {
        let &[a, b, c, d] = h;
        let less_one = a + d + (a * d - b * c);
        let per = 1.0 / (1.0 + less_one);
        let g = [1.0 + d, -c, -b, 1.0 + a].map(|x| per * x);
        let turned = self.shear - self.lame * log1p(less_one);
        std::array::from_fn(|k| {
            std::array::from_fn(|l| {
                let same = if k == l { self.shear } else { 0.0 };
                same + turned * g[k / 2 * 2 + l % 2] * g[l / 2 * 2 + k % 2] + self.lame * g[k] * g[l]
            })
        })
    }
}

impl Finger {
    /// b - I = H + H^T + H H^T of a gradient of displacement.
    #[inline]
    pub fn of_gradient(&[a, b, c, d]: &Gradient) -> Self {
        Self { xx: 2.0 * a + (a * a + b * b), yy: 2.0 * d + (c * c + d * d), xy: (b + c) + (a * c + b * d) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scaffold::Lcg;

    fn law() -> NeoHookean {
        NeoHookean::new(1e6, 0.3)
    }

    fn gradients() -> Vec<Gradient> {
        let mut rng = Lcg::new(5);
        let mut found: Vec<Gradient> = (0..50).map(|_| [0; 4].map(|_| 0.45 * rng.signed())).collect();
        found.push([0.0; 4]);
        found
    }

    #[test]
    fn the_nominal_stress_is_the_slope_of_the_energy() {
        let e = 1e-5;
        for h in gradients() {
            let at = law().nominal(&h);
            for k in 0..4 {
                let moved = |e: f64| {
                    let mut h = h;
                    h[k] += e;
                    law().nominal(&h).energy
                };
                let slope = (moved(e) - moved(-e)) / (2.0 * e);
                assert!((slope - at.stress[k]).abs() < 1e-9 * at.stiffness + 1e-2, "{h:?} {k}: {slope} {at:?}");
            }
        }
    }

    #[test]
    fn it_is_the_cauchy_stress_on_reference_areas() {
        for h in gradients() {
            let at = law().nominal(&h);
            let f = [1.0 + h[0], h[1], h[2], 1.0 + h[3]];
            let p = at.stress;
            let j = at.volume_ratio;
            // sigma = P F^T / J.
            let turned = [p[0] * f[0] + p[1] * f[1], p[0] * f[2] + p[1] * f[3], p[2] * f[0] + p[3] * f[1]];
            let b = Finger::of_gradient(&h);
            let s = law().stress(&b);
            let scale = 1e-12 * at.stiffness;
            assert!((turned[0] / j - s.xx).abs() < scale && (turned[1] / j - s.xy).abs() < scale, "{h:?}");
            assert!((turned[2] / j - s.xy).abs() < scale, "{h:?}");
            assert!((b.volume_ratio() - j).abs() < 1e-12 && (law().energy(&b) - at.energy).abs() < scale);
        }
    }

    #[test]
    fn no_direction_is_stiffer_than_the_bound() {
        let mut rng = Lcg::new(9);
        for h in gradients() {
            let bound = law().nominal(&h).stiffness;
            for _ in 0..20 {
                let way = [0; 4].map(|_| rng.signed());
                let square: f64 = way.iter().map(|x| x * x).sum();
                let along = |e: f64| {
                    let h: Gradient = std::array::from_fn(|k| h[k] + e * way[k]);
                    law().nominal(&h).stress.iter().zip(way).map(|(p, w)| p * w).sum::<f64>()
                };
                let e = 1e-6;
                let slope = (along(e) - along(-e)) / (2.0 * e) / square;
                assert!(slope <= bound * (1.0 + 1e-6), "{h:?} {way:?}: {slope} {bound}");
            }
        }
        // At rest the bound is 2 (lambda + mu), reached where the area changes alike in both directions.
        let rest = law().nominal(&[0.0; 4]).stiffness;
        assert!((rest - 2.0 * (law().lame + law().shear)).abs() < 1e-6);
    }

    #[test]
    fn the_tangent_is_the_slope_of_the_stress() {
        let e = 1e-6;
        for h in gradients() {
            let (tangent, scale) = (law().tangent(&h), law().nominal(&h).stiffness);
            for l in 0..4 {
                let moved = |e: f64| {
                    let mut h = h;
                    h[l] += e;
                    law().nominal(&h).stress
                };
                let (up, down) = (moved(e), moved(-e));
                for k in 0..4 {
                    let slope = (up[k] - down[k]) / (2.0 * e);
                    // Of second order in a step that is a millionth, and what round-off leaves of a difference over it.
                    assert!((slope - tangent[k][l]).abs() < 1e-8 * scale, "{h:?} {k} {l}: {slope} {}", tangent[k][l]);
                    assert!((tangent[k][l] - tangent[l][k]).abs() <= 1e-15 * scale, "{h:?}: not symmetric");
                }
            }
        }
    }

    #[test]
    fn small_strains_keep_their_digits() {
        let p = law().nominal(&[1e-9, 0.0, 0.0, 0.0]).stress[0];
        assert!((p / (1e-9 * (law().lame + 2.0 * law().shear)) - 1.0).abs() < 1e-8);
        assert_eq!(law().nominal(&[0.0; 4]).stress, [0.0; 4]);
    }
}
