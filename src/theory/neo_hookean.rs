//! Compressible neo-Hookean elasticity in plane strain, from the deformation gradient.
//!
//! Stored energy per reference volume: mu/2 (tr(F F^T) - 3) - mu ln J + lambda/2 (ln J)^2 (Simo and Pister 1984; Bonet and Wood
//! 2008, Eq. 6.27), with Lame's parameters lambda and mu. The first Piola-Kirchhoff stress is
//! P = mu (F - F^-T) + lambda ln J F^-T.

use super::elastic::Elastic;
use libm::log;

/// A deformation gradient in the plane: xx, xy, yx, yy.
pub type Gradient = [f64; 4];

fn determinant(f: &Gradient) -> f64 {
    f[0] * f[3] - f[1] * f[2]
}

/// Stored energy per reference volume, J/m3.
pub fn energy(e: &Elastic, f: &Gradient) -> f64 {
    let ln = log(determinant(f));
    let squares: f64 = f.iter().map(|c| c * c).sum();
    0.5 * e.shear() * (squares - 2.0) - e.shear() * ln + 0.5 * e.lame() * ln * ln
}

/// First Piola-Kirchhoff stress xx, xy, yx, yy and zz, Pa.
pub fn nominal_stress(e: &Elastic, f: &Gradient) -> [f64; 5] {
    let j = determinant(f);
    let inverse_transposed = [f[3] / j, -f[2] / j, -f[1] / j, f[0] / j];
    let p = e.lame() * log(j);
    let plane = [0, 1, 2, 3].map(|k| e.shear() * (f[k] - inverse_transposed[k]) + p * inverse_transposed[k]);
    [plane[0], plane[1], plane[2], plane[3], p]
}

/// Cauchy stress P F^T / J: xx, yy, zz, xy, Pa.
pub fn stress(e: &Elastic, f: &Gradient) -> [f64; 4] {
    let (p, j) = (nominal_stress(e, f), determinant(f));
    [(p[0] * f[0] + p[1] * f[1]) / j, (p[2] * f[2] + p[3] * f[3]) / j, p[4] / j, (p[0] * f[2] + p[1] * f[3]) / j]
}

/// Cauchy stress xx, yy, xy of simple shear: mu gamma^2, 0, mu gamma, Pa. The normal stress is Poynting's effect.
pub fn simple_shear(e: &Elastic, gamma: f64) -> [f64; 3] {
    [e.shear() * gamma * gamma, 0.0, e.shear() * gamma]
}

/// Lateral stretch of a strip in plane strain that is stretched by `axial` with its faces free, by bisection of
/// mu (l^2 - 1) + lambda ln(axial l) = 0.
pub fn free_lateral_stretch(e: &Elastic, axial: f64) -> f64 {
    let lateral = |l: f64| e.shear() * (l * l - 1.0) + e.lame() * log(axial * l);
    let (mut low, mut high) = (1e-3, 1e3);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if lateral(middle) < 0.0 {
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

    const MATERIAL: Elastic = Elastic { young: 1e6, poisson: 0.3 };

    #[test]
    fn the_stress_is_the_slope_of_the_energy() {
        let f = [1.3, 0.4, -0.2, 0.8];
        let p = nominal_stress(&MATERIAL, &f);
        for k in 0..4 {
            let at = |d: f64| {
                let mut g = f;
                g[k] += d;
                energy(&MATERIAL, &g)
            };
            let slope = (at(1e-6) - at(-1e-6)) / 2e-6;
            assert!((slope - p[k]).abs() < 1e-3, "{k}: {slope} {}", p[k]);
        }
        assert_eq!(energy(&MATERIAL, &[1.0, 0.0, 0.0, 1.0]), 0.0);
    }

    #[test]
    fn special_cases_follow_from_the_general_one() {
        let e = MATERIAL;
        for s in [0.5, 0.9, 1.4] {
            let l = free_lateral_stretch(&e, s);
            assert!(stress(&e, &[s, 0.0, 0.0, l])[1].abs() < 1e-6);
        }
        let shear = stress(&e, &[1.0, 0.7, 0.0, 1.0]);
        let [xx, yy, xy] = simple_shear(&e, 0.7);
        assert!((shear[0] - xx).abs() < 1e-9 && (shear[1] - yy).abs() < 1e-9 && (shear[3] - xy).abs() < 1e-9);
    }

    #[test]
    fn small_strains_are_hookes() {
        let (e, d) = (MATERIAL, 1e-6);
        let s = stress(&e, &[1.0 + d, 0.0, 0.0, 1.0]);
        assert!((s[0] / d - e.confined()).abs() < 10.0 && (s[1] / d - e.lame()).abs() < 10.0);
        assert!((stress(&e, &[1.0, d, 0.0, 1.0])[3] / d - e.shear()).abs() < 10.0);
        let axial = stress(&e, &[1.0 + d, 0.0, 0.0, free_lateral_stretch(&e, 1.0 + d)]);
        assert!((axial[0] / d - e.plane_strain()).abs() < 10.0);
    }
}
