//! Von Mises plasticity with hardening and viscosity.
//!
//! A law that hardens and depends on the rate is this much: one file and one line in `any.rs`.
//!
//! Elsewhere: J2 plasticity, Perzyna viscoplasticity.

use super::{Increment, Law, LinearElastic, PointState};

/// Von Mises plasticity with linear isotropic hardening and linear overstress (Perzyna 1966): sqrt(J2) exceeds the strength
/// k + H g by the viscosity times the rate of the plastic shear g.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VonMises {
    /// The elastic part.
    pub elastic: LinearElastic,
    /// Shear strength k of the virgin material, Pa.
    pub strength: f64,
    /// Hardening modulus H, Pa.
    pub hardening: f64,
    /// Viscosity, Pa s; 0 where the rate does not matter.
    pub viscosity: f64,
}

impl Law for VonMises {
    /// The plastic shear g, the path integral of sqrt(2 de_p:de_p), by which it has hardened.
    const HISTORY: usize = 1;

    #[inline(always)]
    fn update(&self, state: &mut PointState, d: &Increment) -> f64 {
        let half = d.half_turn();
        let before = state.stress.turned(half);
        let trial = self.elastic.strain(&before, d, d.volumetric());
        let tau = trial.j2().sqrt();
        let over = (tau - self.strength - self.hardening * state.history[0]).max(0.0);
        // Implicit in time: what is over at the end of the step drives the plastic shear of all of it.
        let viscous = if self.viscosity > 0.0 { self.viscosity / d.dt } else { 0.0 };
        let slip = over / (self.elastic.shear + self.hardening + viscous);
        let scale = if slip > 0.0 { 1.0 - self.elastic.shear * slip / tau } else { 1.0 };
        let after = trial.deviator().times(scale).plus_mean(trial.mean());
        state.history[0] += slip;
        state.plastic_shear += slip / 3f64.sqrt();
        state.stress = after.turned(half);
        d.midpoint_work(&before, &after)
    }

    fn stored_energy(&self, state: &PointState) -> f64 {
        self.elastic.stored_energy(state)
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
    use super::super::tests::near;
    use super::*;

    /// Young's modulus 1 MPa, Poisson's ratio 0.3; strength 2 kPa; relaxes in 20 ms or so.
    fn law() -> VonMises {
        VonMises { elastic: LinearElastic::new(1e6, 0.3), strength: 2e3, hardening: 5e4, viscosity: 1e4 }
    }

    /// Shear stress after simple shear by `gamma` in so many steps of `dt` seconds each, and the state then.
    fn sheared(law: &VonMises, gamma: f64, steps: u32, dt: f64) -> PointState {
        let mut state = PointState::default();
        let d = Increment { dt, xy: 0.5 * gamma / f64::from(steps), ..Increment::default() };
        (0..steps).for_each(|_| {
            law.update(&mut state, &d);
        });
        state
    }

    /// The bilinear curve of a material that hardens (Hill 1950): the slope falls from G to G H / (G + H).
    fn hardened(law: &VonMises, gamma: f64) -> f64 {
        let (g, h) = (law.elastic.shear, law.hardening);
        law.strength + g * h / (g + h) * (gamma - law.strength / g)
    }

    #[test]
    fn it_hardens_along_the_bilinear_curve() {
        let law = VonMises { viscosity: 0.0, ..law() };
        let (gamma, first) = (0.2, law.strength / law.elastic.shear);
        near(sheared(&law, 0.9 * first, 7, 0.0).stress.xy, 0.9 * law.strength);
        // In any number of steps.
        for steps in [1, 10, 1000] {
            let state = sheared(&law, gamma, steps, 0.0);
            near(state.stress.xy / hardened(&law, gamma), 1.0);
            near(state.history[0], gamma - state.stress.xy / law.elastic.shear);
            near(state.plastic_shear * 3f64.sqrt(), state.history[0]);
            assert!(state.stress.mean().abs() < 1e-12 && state.opened == 0.0);
        }
        // It comes back to where it left: what hardened does not soften.
        let mut state = sheared(&law, gamma, 10, 0.0);
        let top = state;
        for xy in [-1e-3, 1e-3] {
            law.update(&mut state, &Increment { xy, ..Increment::default() });
        }
        near(state.stress.xy / top.stress.xy, 1.0);
        near(state.history[0] / top.history[0], 1.0);
    }

    /// What is over after a sudden simple shear of 0.02 and a time (s) in so many steps, Pa.
    fn relaxed(law: &VonMises, steps: u32, time: f64) -> f64 {
        let mut state = sheared(law, 0.02, 1, 0.0);
        let d = Increment { dt: time / f64::from(steps), ..Increment::default() };
        (0..steps).for_each(|_| {
            law.update(&mut state, &d);
        });
        state.stress.xy - law.strength - law.hardening * state.history[0]
    }

    /// Under constant strain d(over)/dt = -(G + H) over / viscosity: what is over at first, Pa, and its relaxation time, s.
    fn relaxation(law: &VonMises) -> (f64, f64) {
        (law.elastic.shear * 0.02 - law.strength, law.viscosity / (law.elastic.shear + law.hardening))
    }

    #[test]
    fn overstress_decays_with_its_time() {
        let law = law();
        let (over, time) = relaxation(&law);
        // Nothing slips in no time.
        near(relaxed(&law, 1, 0.0), over);
        // Of first order: half the step, half the error.
        let error = |steps: u32| relaxed(&law, steps, time) / (over / std::f64::consts::E) - 1.0;
        let [coarse, fine] = [error(1000), error(2000)];
        assert!(fine > 0.0 && fine < 3e-4 && (coarse / fine - 2.0).abs() < 0.01, "{coarse} {fine}");
    }

    #[test]
    fn steady_shear_carries_the_rate_times_the_viscosity() {
        let law = VonMises { hardening: 0.0, ..law() };
        // 0.1 per second for 50 relaxation times.
        let (rate, time) = (0.1, 50.0 * law.viscosity / law.elastic.shear);
        let state = sheared(&law, rate * time, 5000, time / 5000.0);
        near(state.stress.xy / (law.strength + law.viscosity * rate), 1.0);
    }

    #[test]
    fn three_percent_of_a_parameter_are_noticed() {
        let law = law();
        let (over, relaxing) = relaxation(&law);
        let (plastic, steady) = (VonMises { viscosity: 0.0, ..law }, VonMises { hardening: 0.0, ..law });
        let time = 50.0 * law.viscosity / law.elastic.shear;
        for factor in [0.97, 1.03] {
            let wrong = VonMises { hardening: factor * law.hardening, ..plastic };
            let off = sheared(&wrong, 0.2, 10, 0.0).stress.xy / hardened(&plastic, 0.2) - 1.0;
            assert!(off.abs() > 0.01, "hardening: {off}");
            let thick = |law: VonMises| VonMises { viscosity: factor * law.viscosity, ..law };
            let off = relaxed(&thick(law), 2000, relaxing) / (over / std::f64::consts::E) - 1.0;
            assert!(off.abs() > 0.02, "viscosity, relaxing: {off}");
            let state = sheared(&thick(steady), 0.1 * time, 5000, time / 5000.0);
            let off = state.stress.xy / (law.strength + 0.1 * law.viscosity) - 1.0;
            assert!(off.abs() > 0.009, "viscosity, steady: {off}");
        }
    }
}
