//! A cantilever barrier: how its stiffness is normalised, what its clamp carries, how much of it is energy, when it buckles.

use super::cantilever::Cantilever;

/// Flexural rigidity EI (N m2) and height (m) of the barrier that stands for 1: reinforced concrete of 25 GPa, 1 m thick, 3 m
/// high, 0.2 m wide (Ng et al., Table 2).
pub const REFERENCE: [f64; 2] = [25e9 * 0.2 / 12.0, 3.0];

/// 3 EI/H^3 over that of [`REFERENCE`]; `rigidity` EI in N m2, `height` in m.
pub fn normalised_stiffness(rigidity: f64, height: f64) -> f64 {
    tip_stiffness(rigidity, height) / tip_stiffness(REFERENCE[0], REFERENCE[1])
}

/// Young's modulus that gives a rectangular barrier (`depth` in the plane of bending, `width` across it, m) a normalised
/// stiffness, as the paper does: by EI of a beam, without the 1/(1 - nu^2) of plane strain, Pa.
pub fn young_for(normalised: f64, height: f64, depth: f64, width: f64) -> f64 {
    let stiffness = normalised * tip_stiffness(REFERENCE[0], REFERENCE[1]);
    stiffness * height * height * height / 3.0 / (width * depth * depth * depth / 12.0)
}

/// Force at the tip per deflection there, 3 EI/H^3, N/m.
pub fn tip_stiffness(rigidity: f64, height: f64) -> f64 {
    3.0 * rigidity / (height * height * height)
}

/// Shear force (N) and moment (N m) at the clamp under a load (N/m) given at heights over it, by the trapezoidal rule between
/// `[height, load]` pairs.
pub fn clamp_reaction(load: &[[f64; 2]]) -> [f64; 2] {
    let mut sum = [0.0; 2];
    for pair in load.windows(2) {
        let ([z0, q0], [z1, q1]) = (pair[0], pair[1]);
        let dz = z1 - z0;
        sum[0] += 0.5 * (q0 + q1) * dz;
        // The load is linear in between: Simpson's rule is exact for its moment.
        sum[1] += dz / 6.0 * (q0 * z0 + (q0 + q1) * (z0 + z1) + q1 * z1);
    }
    sum
}

/// Deflection of the tip under an earth pressure that grows linearly from nothing at `reach` (m) over the clamp to `q0` (N/m) at
/// the clamp: q0 a^4/(30 EI) + q0 a^3 (H - a)/(24 EI), m. Bending only.
pub fn under_triangle(beam: &Cantilever, q0: f64, reach: f64) -> f64 {
    let (ei, a) = (beam.bending_stiffness(), reach);
    q0 * a * a * a * (a / 30.0 + (beam.length - a) / 24.0) / ei
}

/// Elastic energy of a barrier bent by a force at its tip, 1/2 (3 EI/H^3) w^2, J.
pub fn bending_energy(rigidity: f64, height: f64, deflection: f64) -> f64 {
    0.5 * tip_stiffness(rigidity, height) * deflection * deflection
}

/// Density at which an upright cantilever buckles under its own weight: rho A g H^3/(EI) = 7.837 (Greenhill 1881), kg/m3.
pub fn buckling_density(rigidity: f64, height: f64, section: f64, gravity: f64) -> f64 {
    7.837_347_4 * rigidity / (section * gravity * height * height * height)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::theory::elastic::Elastic;

    #[test]
    fn the_papers_barriers() {
        // 0.6 m high, 0.1 m by 0.2 m: Young's modulus is 200 GPa times the normalised stiffness.
        for n in [1.0, 1e-4, 2.5e-6] {
            let young = young_for(n, 0.6, 0.1, 0.2);
            assert!((young / (n * 2e11) - 1.0).abs() < 1e-12);
            assert!((normalised_stiffness(young * 0.2 * 1e-3 / 12.0, 0.6) / n - 1.0).abs() < 1e-12);
        }
        // Its 25 GPa concrete in this section is an eighth of the reference; bent by 40 % the plastic one holds 3.3 J.
        assert!((normalised_stiffness(25e9 * 0.2 * 1e-3 / 12.0, 0.6) - 0.125).abs() < 1e-12);
        assert!((bending_energy(2.5e-6 * 10e6 / 3.0, 0.6, 0.24) - 3.33).abs() < 0.01);
    }

    #[test]
    fn soft_barriers_buckle_under_their_own_weight() {
        for (n, density) in [(1e-6, 616.0), (2.5e-6, 1541.0), (1e-5, 6164.0)] {
            let found = buckling_density(n * 10e6 / 3.0, 0.6, 0.02, 9.81);
            assert!((found - density).abs() < 1.0, "{n}: {found}");
        }
    }

    #[test]
    fn reactions_of_simple_loads() {
        let [force, moment] = clamp_reaction(&[[0.0, 30.0], [0.3, 0.0]]);
        assert!((force - 4.5).abs() < 1e-12 && (moment - 0.45).abs() < 1e-12, "acts at a third: {moment}");
        assert_eq!(clamp_reaction(&[[0.0, 5.0], [2.0, 5.0]]), [10.0, 10.0]);
        assert_eq!(clamp_reaction(&[]), [0.0; 2]);
    }

    #[test]
    fn a_triangle_over_the_whole_height() {
        let elastic = Elastic { young: 1e6, poisson: 0.0 };
        let beam = Cantilever { elastic, density: 1.0, length: 0.6, depth: 0.1, width: 0.2 };
        let w = under_triangle(&beam, 100.0, 0.6);
        assert!((w - 100.0 * 0.6f64.powi(4) / (30.0 * beam.bending_stiffness())).abs() < 1e-15);
        // By superposition of forces: a force dP at z moves the tip by z^2 (3 H - z)/(6 EI).
        let (n, a) = (4000, 0.4);
        let dz = a / f64::from(n);
        let summed: f64 = (0..n)
            .map(|k| (f64::from(k) + 0.5) * dz)
            .map(|z| 100.0 * (1.0 - z / a) * dz * z * z * (1.8 - z) / (6.0 * beam.bending_stiffness()))
            .sum();
        assert!((under_triangle(&beam, 100.0, a) / summed - 1.0).abs() < 1e-6);
    }
}
