//! Granular flow whose friction depends on the inertial number.
//!
//! Elsewhere: mu(I) rheology (Jop, Forterre and Pouliquen 2006), here as a Drucker-Prager cone with a slope that depends on the rate,
//! on a compressible elastic skeleton (Dunatunga and Kamrin 2015).

use super::elastic::LinearElastic;
use super::opened::{Capped, capped, closed, max};
use super::{Increment, Law, PointState};
use crate::seeded::{self, Seed};

/// mu(I) with linear elasticity: sqrt(J2) = mu(I) p where it flows, mu = mu_s + (mu_2 - mu_s) / (1 + I_0/I), I = rate d sqrt(rho_s/p), p the
/// pressure -tr(sigma)/3 and the rate that of the plastic shear, sqrt(2 D:D). At constant volume, without cohesion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MuI {
    /// The elastic part.
    pub elastic: LinearElastic,
    /// Friction of the slowest flow, mu_s.
    pub least: f64,
    /// Friction of the fastest flow, mu_2.
    pub most: f64,
    /// Rate over the root of the pressure at which it is half way between: I_0 / (d sqrt(rho_s)), 1/(s sqrt(Pa)).
    pub half_way: f64,
    /// Whether material that came apart must close the opened volume before it builds pressure.
    pub void_tracking: bool,
}

impl MuI {
    /// From mu_s, mu_2 >= mu_s, the inertial number I_0 > 0, and the diameter (m) and density (kg/m3) of grains.
    pub fn new(
        elastic: LinearElastic,
        [least, most]: [f64; 2],
        half_way: f64,
        diameter: f64,
        grain_density: f64,
        void_tracking: bool,
    ) -> Self {
        let half_way = half_way / (diameter * grain_density.sqrt());
        Self { elastic, least, most, half_way: seeded::times(Seed::ConstitutiveInertial, half_way), void_tracking }
    }
}

impl Law for MuI {
    #[inline(always)]
    fn update(&self, state: &mut PointState, d: &Increment) -> f64 {
        let (bulk, shear) = (self.elastic.bulk, self.elastic.shear);
        let half = d.half_turn();
        let before = state.stress.turned(half);
        let (closing, still_open) = closed(state.opened, d);
        let trial = self.elastic.strain(&before, d, d.volumetric() + closing);
        let (mean_trial, tau_trial) = (trial.mean(), trial.j2().sqrt());
        let Capped { mean, opened, .. } = capped(mean_trial, still_open, bulk, 0.0, self.void_tracking);

        // Implicit in time: tau = tau_trial - G g and tau = p (mu_s + (mu_2 - mu_s) g / (g + dt xi sqrt(p))) with the plastic shear g of the
        // step and xi = I_0 / (d sqrt(rho_s)) have one root between the slowest and the fastest flow (Dunatunga and Kamrin 2015).
        let pressure = max(0.0, -mean);
        let (slow, fast) = (self.least * pressure, self.most * pressure);
        let viscous = shear * d.dt * self.half_way * pressure.sqrt();
        let sum = fast + tau_trial + viscous;
        let product = fast * tau_trial + slow * viscous;
        let root = max(0.0, sum * sum - 4.0 * product).sqrt();
        let flowing = if sum > 0.0 { 2.0 * product / (sum + root) } else { 0.0 };
        let tau = if tau_trial > slow { flowing } else { tau_trial };

        let scale = if tau_trial > 0.0 { tau / tau_trial } else { 0.0 };
        let after = trial.deviator().times(scale).plus_mean(mean);
        state.opened = opened;
        state.plastic_shear += (tau_trial - tau) * (1.0 / (shear * 3f64.sqrt()));
        state.stress = after.turned(half);
        d.midpoint_work(&before, &after)
    }

    fn stored_energy(&self, state: &PointState) -> f64 {
        self.elastic.energy(&state.stress)
    }

    fn lame(&self) -> [f64; 2] {
        self.elastic.lame()
    }

    fn p_wave_modulus(&self) -> f64 {
        self.elastic.p_wave_modulus()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constitutive::tests::{near, same};
    use crate::constitutive::{Cone, DruckerPrager, Stress};
    use crate::theory::mu_i as theory;

    const BEADS: theory::MuI =
        theory::MuI { least: 0.3819, most: 0.6435, half_way: 0.279, diameter: 5.3e-4, grain_density: 2450.0 };
    const P: f64 = 500.0;

    fn law() -> MuI {
        let elastic = LinearElastic::new(1e6, 0.3);
        MuI::new(elastic, [BEADS.least, BEADS.most], BEADS.half_way, BEADS.diameter, BEADS.grain_density, true)
    }

    fn pressed() -> PointState {
        PointState { stress: Stress { xx: -P, yy: -P, zz: -P, xy: 0.0 }, ..PointState::default() }
    }

    /// After simple shear at a rate (1/s) in so many steps of `dt`.
    fn sheared(law: &MuI, rate: f64, steps: u32, dt: f64) -> PointState {
        let mut state = pressed();
        let d = Increment { dt, xy: 0.5 * rate * dt, ..Increment::default() };
        (0..steps).for_each(|_| {
            law.update(&mut state, &d);
        });
        state
    }

    #[test]
    fn steady_shear_has_the_friction_of_its_inertial_number() {
        for rate in [0.1, 10.0, 300.0, 2000.0] {
            let exact = BEADS.friction(BEADS.number(rate, P));
            // Steady flow does not know the step; on the way, G g reaches the strength within 0.2 % of strain, relaxes to the viscous rate.
            let dt = 1e-5 / rate;
            let state = sheared(&law(), rate, 40_000, dt);
            assert!((state.stress.xy / (exact * P) - 1.0).abs() < 1e-6, "{rate}: {} {exact}", state.stress.xy / P);
            near(state.stress.mean() / -P, 1.0);
            assert_eq!(state.opened, 0.0);
        }
        for factor in [0.97, 1.03] {
            let wrong = MuI { half_way: factor * law().half_way, ..law() };
            let exact = BEADS.friction(BEADS.number(300.0, P));
            let off = sheared(&wrong, 300.0, 40_000, 1e-5 / 300.0).stress.xy / (exact * P) - 1.0;
            assert!(off.abs() > 1e-3, "{off}");
        }
    }

    #[test]
    fn one_step_solves_both_equations() {
        let law = law();
        for (gamma, dt) in [(1e-3, 1e-5), (0.02, 1e-4), (0.3, 1e-3), (5e-4, 1.0)] {
            let state = sheared(&law, gamma / dt, 1, dt);
            let (tau, trial) = (state.stress.xy, law.elastic.shear * gamma);
            let slip = (trial - tau) / law.elastic.shear;
            let exact = BEADS.friction(BEADS.number(slip / dt, P)) * P;
            assert!((tau / exact - 1.0).abs() < 1e-9, "{gamma}: {tau} {exact}");
            near(state.plastic_shear, slip / 3f64.sqrt());
        }
    }

    /// With one friction it is a cone of that slope, and below mu_s it is elastic.
    #[test]
    fn without_a_rate_it_is_drucker_prager() {
        let elastic = law().elastic;
        let same_friction = MuI { most: BEADS.least, ..law() };
        let cone = DruckerPrager::new(elastic, Cone::PlaneStrain, libm::asin(BEADS.least), 0.0, 0.0, 0.0, true);
        let paths = [[-1e-3, 1e-3, 2e-3], [1e-4, -3e-3, 1e-3], [3e-3, 1e-3, 0.0], [-1e-3, 0.0, 1e-3], [1e-4, 0.0, 0.0]];
        let [mut a, mut b] = [pressed(); 2];
        for [xx, yy, xy] in paths {
            let d = Increment { dt: 1e-4, xx, yy, xy, spin: 0.01 };
            let [work, expected] = [same_friction.update(&mut a, &d), cone.update(&mut b, &d)];
            same(a.stress, b.stress);
            near(work, expected);
            near(a.opened, b.opened);
            near(a.plastic_shear, b.plastic_shear);
        }
        let small = Increment { dt: 1e-4, xy: 0.4 * BEADS.least * P / (2.0 * elastic.shear), ..Increment::default() };
        let mut state = pressed();
        law().update(&mut state, &small);
        near(state.stress.xy, 0.4 * BEADS.least * P);
        assert_eq!(state.plastic_shear, 0.0);
    }

    #[test]
    fn what_comes_apart_carries_nothing() {
        let mut state = pressed();
        let bulk = law().elastic.bulk;
        law().update(&mut state, &Increment { dt: 1e-4, xx: 0.01, yy: 0.01, xy: 0.02, spin: 0.0 });
        assert_eq!(state.stress, Stress::default());
        near(state.opened, 0.02 - P / bulk);
        // At rest, without pressure and without shear, it stays at that.
        let apart = state;
        law().update(&mut state, &Increment { dt: 1e-4, ..Increment::default() });
        assert_eq!(state, apart);
    }
}
