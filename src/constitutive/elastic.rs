//! Isotropic linear elasticity in rate form with the Jaumann rate.
//!
//! Elsewhere: hypoelasticity with an objective (corotational) rate.

use super::{Increment, Law, PointState, Stress};
use crate::seeded::{self, Seed};

/// Isotropic linear elasticity in rate form: the Jaumann rate of the Cauchy stress is C : D.
///
/// Stress-strain response is that of the logarithmic strain as long as the principal axes do not turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinearElastic {
    /// Bulk modulus K in Pa.
    pub bulk: f64,
    /// Shear modulus G in Pa.
    pub shear: f64,
}

impl LinearElastic {
    /// From Young's modulus E > 0 (Pa) and Poisson's ratio -1 < nu < 1/2.
    pub fn new(young: f64, poisson: f64) -> Self {
        let [bulk, shear] = [young / (3.0 * (1.0 - 2.0 * poisson)), young / (2.0 * (1.0 + poisson))];
        Self { bulk: seeded::times(Seed::ConstitutiveBulk, bulk), shear: seeded::times(Seed::ConstitutiveShear, shear) }
    }

    /// Adds C : de for a volumetric increment that may differ from the trace of `d` (see the void tracking of Drucker-Prager).
    #[inline(always)]
    pub(super) fn strain(&self, s: &Stress, d: &Increment, volumetric: f64) -> Stress {
        s.plus(&d.deviator().times(2.0 * self.shear).plus_mean(self.bulk * volumetric))
    }

    #[inline(always)]
    pub(super) fn energy(&self, s: &Stress) -> f64 {
        let m = s.mean();
        s.j2() / (2.0 * self.shear) + m * m / (2.0 * self.bulk)
    }
}

impl Law for LinearElastic {
    #[inline(always)]
    fn update(&self, state: &mut PointState, d: &Increment) -> f64 {
        let half = d.half_turn();
        let before = state.stress.turned(half);
        let after = self.strain(&before, d, d.volumetric());
        state.stress = after.turned(half);
        d.midpoint_work(&before, &after)
    }

    fn stored_energy(&self, state: &PointState) -> f64 {
        self.energy(&state.stress)
    }

    fn lame(&self) -> [f64; 2] {
        [self.bulk - 2.0 / 3.0 * self.shear, self.shear]
    }

    fn p_wave_modulus(&self) -> f64 {
        self.bulk + 4.0 / 3.0 * self.shear
    }
}
