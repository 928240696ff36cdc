//! Friction that softens with plastic shear, from a peak to the critical state.
//!
//! Elsewhere: strain softening; the critical state is that of soil mechanics, where grains shear at constant volume.

use super::opened::min;
use super::{DruckerPrager, Increment, Law, MohrCoulomb, PointState};

/// A law with a peak: its friction falls in a straight line with the equivalent plastic shear strain of a point
/// ([`PointState::plastic_shear`]), from its own to that of the critical state, and its dilatancy and its cohesion to nothing. Further on
/// it stays in the critical state.
///
/// Strength is that of the plastic shear at the start of a step. Where it localises, the width of a shear band is that of the grid, and so
/// is what a band takes to soften.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Softening<L> {
    /// The law as it is before any plastic shear.
    pub peak: L,
    /// Friction in the critical state, as the law counts it: slope of a cone, or sine of an angle.
    pub critical: f64,
    /// Equivalent plastic shear strain at which the critical state is reached, above 0.
    pub over: f64,
}

/// Drucker-Prager that softens.
pub type SofteningDruckerPrager = Softening<DruckerPrager>;

/// Mohr-Coulomb that softens.
pub type SofteningMohrCoulomb = Softening<MohrCoulomb>;

/// A law that can soften.
pub trait Softens: Law {
    /// The law on its way to the critical state, where its friction is `critical`; `share` goes from 0 to 1.
    fn softened(&self, critical: f64, share: f64) -> Self;
}

/// Friction, dilatancy, cohesion and cut-off on the way.
#[inline(always)]
fn on_the_way(of: [f64; 4], critical: f64, share: f64) -> [f64; 4] {
    let [friction, dilatancy, cohesion, cutoff] = of;
    let left = 1.0 - share;
    let (friction, cohesion) = (friction + share * (critical - friction), left * cohesion);
    // No cut-off beyond the apex.
    let apex = if friction > 0.0 { cohesion / friction } else { cutoff };
    [friction, left * dilatancy, cohesion, min(cutoff, apex)]
}

impl Softens for DruckerPrager {
    #[inline(always)]
    fn softened(&self, critical: f64, share: f64) -> Self {
        let peak = [self.friction, self.dilatancy, self.cohesion, self.tension_cutoff];
        let [friction, dilatancy, cohesion, tension_cutoff] = on_the_way(peak, critical, share);
        Self { friction, dilatancy, cohesion, tension_cutoff, ..*self }
    }
}

impl Softens for MohrCoulomb {
    #[inline(always)]
    fn softened(&self, critical: f64, share: f64) -> Self {
        let peak = [self.friction, self.dilatancy, self.cohesion, self.tension_cutoff];
        let [friction, dilatancy, cohesion, tension_cutoff] = on_the_way(peak, critical, share);
        Self { friction, dilatancy, cohesion, tension_cutoff, ..*self }
    }
}

impl<L: Softens> Law for Softening<L> {
    const HISTORY: usize = L::HISTORY;

    #[inline(always)]
    fn update(&self, state: &mut PointState, d: &Increment) -> f64 {
        let share = min(1.0, state.plastic_shear * (1.0 / self.over));
        self.peak.softened(self.critical, share).update(state, d)
    }

    fn stored_energy(&self, state: &PointState) -> f64 {
        self.peak.stored_energy(state)
    }

    fn lame(&self) -> [f64; 2] {
        self.peak.lame()
    }

    fn p_wave_modulus(&self) -> f64 {
        self.peak.p_wave_modulus()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constitutive::tests::near;
    use crate::constitutive::{AnyLaw, Cone, LinearElastic, Stress};
    use crate::theory::mohr_coulomb::softened_ratio;

    const PEAK: f64 = 0.7;
    const CRITICAL: f64 = 0.5;
    /// Equivalent plastic shear strain, and the engineering strain of plastic simple shear that it is.
    const OVER: f64 = 0.02;
    const OVER_GAMMA: f64 = OVER * 1.732_050_807_568_877_2;
    const P: f64 = 1e4;

    fn elastic() -> LinearElastic {
        LinearElastic::new(1e6, 0.3)
    }

    fn cone(psi: f64) -> SofteningDruckerPrager {
        let peak = DruckerPrager::new(elastic(), Cone::PlaneStrain, libm::asin(PEAK), psi, 0.0, 0.0, true);
        Softening { peak, critical: CRITICAL, over: OVER }
    }

    fn pyramid() -> SofteningMohrCoulomb {
        let peak = MohrCoulomb::new(elastic(), libm::asin(PEAK), 0.0, 0.0, 0.0, true);
        Softening { peak, critical: CRITICAL, over: OVER }
    }

    /// Shear stress over pressure after simple shear in so many steps.
    fn sheared(law: &impl Law, gamma: f64, steps: u32) -> PointState {
        let stress = Stress { xx: -P, yy: -P, zz: -P, xy: 0.0 };
        let mut state = PointState { stress, ..PointState::default() };
        let d = Increment { xy: 0.5 * gamma / f64::from(steps), ..Increment::default() };
        (0..steps).for_each(|_| {
            law.update(&mut state, &d);
        });
        state
    }

    /// Without dilatancy the pressure stays, and cone and pyramid are the same in pure shear: the bilinear descent, of first order in
    /// the step.
    #[test]
    fn friction_falls_along_the_closed_form() {
        let stiffness = elastic().shear / P;
        let exact = |gamma| softened_ratio(gamma, stiffness, PEAK, PEAK - CRITICAL, OVER_GAMMA);
        for law in [AnyLaw::SofteningDruckerPrager(cone(0.0)), AnyLaw::SofteningMohrCoulomb(pyramid())] {
            // The plastic shear of one step is missing, 0.2 / OVER_GAMMA of it.
            for gamma in [0.015, 0.03, 0.04, 0.1] {
                let found = sheared(&law, gamma, 4000).stress.xy / P;
                let lag = 2.0 * (PEAK - CRITICAL) / OVER_GAMMA * gamma / 4000.0;
                assert!((found - exact(gamma)).abs() < lag, "{gamma}: {found} {}", exact(gamma));
            }
            let error = |steps| sheared(&law, 0.03, steps).stress.xy / P - exact(0.03);
            let [coarse, fine] = [error(1000), error(2000)];
            assert!((coarse / fine - 2.0).abs() < 0.2, "{coarse} {fine}");
            // In the critical state nothing changes any more: it stands on the critical cone at once.
            near(sheared(&law, 0.2, 4000).stress.xy / (CRITICAL * P), 1.0);
        }
    }

    #[test]
    fn dilatancy_and_cohesion_end_in_the_critical_state() {
        let law = cone(0.2);
        let gain = |steps: u32| sheared(&law, 5e-5 * f64::from(steps), steps).stress.mean() / -P;
        // Pressure grows while it dilates, and no more after: half of q_psi over the plastic shear that it takes.
        let (q_psi, bulk) = (law.peak.dilatancy, elastic().bulk);
        let exact = 1.0 + 0.5 * bulk * q_psi * OVER_GAMMA / P;
        assert!((gain(4000) / exact - 1.0).abs() < 1e-3, "{} {exact}", gain(4000));
        assert!((gain(6000) / gain(4000) - 1.0).abs() < 1e-9);
        let bonded = MohrCoulomb::new(elastic(), libm::asin(PEAK), 0.0, 700.0, 1e9, true);
        let end = bonded.softened(CRITICAL, 1.0);
        assert_eq!((end.friction, end.dilatancy, end.cohesion, end.tension_cutoff), (CRITICAL, 0.0, 0.0, 0.0));
        assert_eq!(bonded.softened(CRITICAL, 0.0), bonded);
        let half = bonded.softened(CRITICAL, 0.5);
        near(half.tension_cutoff, half.cohesion / half.friction);
        near(half.friction, 0.6);
    }

    #[test]
    fn a_law_that_ends_where_it_begins_does_not_soften() {
        let mut law = cone(0.0);
        law.critical = law.peak.friction;
        assert_eq!(sheared(&law, 0.03, 500), sheared(&law.peak, 0.03, 500));
    }
}
