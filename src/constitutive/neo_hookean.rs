//! Compressible neo-Hookean elasticity: an energy, and therefore no drift however far a body turns.
//!
//! The state is the left Cauchy-Green tensor b = F F^T, which an isotropic law needs and no more, kept as b - I so that small
//! strains lose no digits. A step multiplies it by f = I + dt grad(v), the gradient of where the grid carries the points, which
//! is exact: the stress depends on the deformation alone and not on the steps taken towards it.
//!
//! Elsewhere: hyperelasticity; b is also called the Finger tensor.

use super::logarithm::log1p;
use super::{Finger, Increment, Law, PointState, Stress};
use crate::seeded::{self, Seed};

/// Neo-Hookean law with the stored energy mu/2 (tr b - 3) - mu ln J + lambda/2 (ln J)^2 per reference volume (Simo and Pister
/// 1984): J sigma = mu (b - I) + lambda ln J I.
///
/// At small strain it is Hooke's law. The P-wave gets faster where the material is strained, by at most an eighth while principal
/// stretches stay between 0.7 and 1.3 (nu = 0.3), which the time step has to leave room for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NeoHookean {
    /// Lame's first parameter lambda, Pa.
    pub lame: f64,
    /// Shear modulus mu, Pa.
    pub shear: f64,
}

impl NeoHookean {
    /// From Young's modulus E > 0 (Pa) and Poisson's ratio -1 < nu < 1/2 at small strain.
    pub fn new(young: f64, poisson: f64) -> Self {
        Self {
            lame: seeded::times(Seed::ConstitutiveLame, young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson))),
            shear: young / (2.0 * (1.0 + poisson)),
        }
    }

    /// Cauchy stress.
    #[inline(always)]
    pub fn stress(&self, b: &Finger) -> Stress {
        let less_one = b.determinant_less_one();
        let per_volume = 1.0 / (1.0 + less_one).sqrt();
        let p = 0.5 * self.lame * log1p(less_one);
        b.times_plus_mean(self.shear, p).times(per_volume)
    }

    /// Stored energy per reference volume, J/m3.
    #[inline(always)]
    pub fn energy(&self, b: &Finger) -> f64 {
        let less_one = b.determinant_less_one();
        let ln = 0.5 * log1p(less_one);
        0.5 * self.shear * (b.trace_less_three() - 2.0 * ln) + 0.5 * self.lame * ln * ln
    }
}

impl Law for NeoHookean {
    const HISTORY: usize = Finger::NUMBERS;

    #[inline(always)]
    fn update(&self, state: &mut PointState, increment: &Increment) -> f64 {
        let before = Finger::kept_in(&state.history);
        let after = before.advanced(increment);
        state.stress = self.stress(&after);
        after.keep_in(&mut state.history);
        // What is stored is the work, whatever the steps.
        let stored = self.energy(&after) - self.energy(&before);
        2.0 * stored / (before.volume_ratio() + after.volume_ratio())
    }

    #[inline(always)]
    fn volume_ratio(&self, state: &PointState, _: f64, _: &Increment) -> f64 {
        Finger::kept_in(&state.history).volume_ratio()
    }

    fn deformation(&self, state: &PointState) -> Option<Finger> {
        Some(Finger::kept_in(&state.history))
    }

    fn stored_energy(&self, state: &PointState) -> f64 {
        let b = Finger::kept_in(&state.history);
        self.energy(&b) / b.volume_ratio()
    }

    fn lame(&self) -> [f64; 2] {
        [self.lame, self.shear]
    }

    /// lambda + 2 mu, at rest.
    fn p_wave_modulus(&self) -> f64 {
        self.lame + 2.0 * self.shear
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constitutive::HalfTurn;
    use crate::scaffold::Lcg;
    use crate::theory::elastic::Elastic;
    use crate::theory::neo_hookean::{self as theory, Gradient};

    const MATERIAL: Elastic = Elastic { young: 1e6, poisson: 0.3 };

    fn law() -> NeoHookean {
        NeoHookean::new(MATERIAL.young, MATERIAL.poisson)
    }

    fn product(a: &Gradient, b: &Gradient) -> Gradient {
        let at = |i: usize, j: usize| a[2 * i] * b[j] + a[2 * i + 1] * b[2 + j];
        [at(0, 0), at(0, 1), at(1, 0), at(1, 1)]
    }

    fn increment(l: &Gradient) -> Increment {
        Increment { dt: 0.0, xx: l[0], yy: l[3], xy: 0.5 * (l[1] + l[2]), spin: 0.5 * (l[2] - l[1]) }
    }

    /// The state after going from I to `f` in `steps` equal steps of F.
    fn reached(f: &Gradient, steps: u32) -> Finger {
        let identity = [1.0, 0.0, 0.0, 1.0];
        let at = |k: u32| {
            let s = f64::from(k) / f64::from(steps);
            [0, 1, 2, 3].map(|i| identity[i] + s * (f[i] - identity[i]))
        };
        (0..steps).fold(Finger::default(), |b, k| {
            let (from, to) = (at(k), at(k + 1));
            let j = from[0] * from[3] - from[1] * from[2];
            let inverse = [from[3] / j, -from[1] / j, -from[2] / j, from[0] / j];
            let g = product(&to, &inverse);
            b.advanced(&increment(&[g[0] - 1.0, g[1], g[2], g[3] - 1.0]))
        })
    }

    fn as_array(s: &Stress) -> [f64; 4] {
        [s.xx, s.yy, s.zz, s.xy]
    }

    #[test]
    fn any_deformation_in_any_number_of_steps() {
        for f in [[1.4, 0.0, 0.0, 1.0], [0.6, 0.0, 0.0, 1.1], [1.0, 0.8, 0.0, 1.0], [0.9, -0.7, 0.5, 1.2]] {
            for steps in [1, 7, 100] {
                let b = reached(&f, steps);
                let (found, exact) = (as_array(&law().stress(&b)), theory::stress(&MATERIAL, &f));
                for (s, e) in found.iter().zip(exact) {
                    assert!((s - e).abs() < 1e-8, "{f:?} {steps}: {s} {e}");
                }
                assert!((law().energy(&b) - theory::energy(&MATERIAL, &f)).abs() < 1e-8);
                assert!((b.volume_ratio() - (f[0] * f[3] - f[1] * f[2])).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn rotation_turns_the_stress_and_does_nothing_else() {
        let start = reached(&[1.2, 0.3, -0.1, 0.9], 1);
        let (before, energy) = (law().stress(&start), law().energy(&start));
        let (steps, turn) = (1000, 2.0 * std::f64::consts::PI / 1000.0);
        let (c, s) = (libm::cos(turn), libm::sin(turn));
        let mut b = start;
        for k in 1..=steps {
            b = b.advanced(&increment(&[c - 1.0, -s, s, c - 1.0]));
            let back = 2.0 * turn * f64::from(k);
            let now = law().stress(&b).turned(HalfTurn { cos2: libm::cos(back), sin2: -libm::sin(back) });
            for (a, e) in as_array(&now).iter().zip(as_array(&before)) {
                assert!((a - e).abs() < 1e-6, "after {k} of {steps}: {a} {e}");
            }
        }
        assert!((law().energy(&b) / energy - 1.0).abs() < 1e-11);
    }

    #[test]
    fn power_is_the_rate_of_the_energy() {
        let mut rng = Lcg::new(21);
        for _ in 0..100 {
            let b = reached(
                &[1.0 + 0.3 * rng.signed(), 0.4 * rng.signed(), 0.4 * rng.signed(), 1.0 + 0.3 * rng.signed()],
                1,
            );
            let l = [rng.signed(), rng.signed(), rng.signed(), rng.signed()];
            let at = |e: f64| law().energy(&b.advanced(&increment(&l.map(|c| e * c))));
            let e = 1e-5;
            let rate = (at(e) - at(-e)) / (2.0 * e);
            let (s, d, j) = (law().stress(&b), increment(&l), b.volume_ratio());
            let power = j * (s.xx * d.xx + s.yy * d.yy + 2.0 * s.xy * d.xy);
            assert!((rate - power).abs() < 1e-3, "{rate} {power}");
        }
    }

    #[test]
    fn small_strains_keep_their_digits() {
        let d = 1e-9;
        let s = law().stress(&Finger::default().advanced(&increment(&[d, 0.0, 0.0, 0.0])));
        assert!((s.xx / d / MATERIAL.confined() - 1.0).abs() < 1e-8);
        assert_eq!(as_array(&law().stress(&Finger::default())), [0.0; 4]);
        let energy = law().energy(&Finger::default().advanced(&increment(&[d, 0.0, 0.0, 0.0])));
        assert!((energy / (0.5 * MATERIAL.confined() * d * d) - 1.0).abs() < 1e-6, "{energy:e}");
    }
}
