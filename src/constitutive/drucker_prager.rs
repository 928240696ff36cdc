//! Drucker-Prager plasticity with dilatancy, a tension cut-off, and tracking of opened volume.
//!
//! Elsewhere: return mapping with a radial and an apex return; void tracking is a volume correction for material that
//! separates.

use super::elastic::LinearElastic;
use super::{Increment, Law, PointState};
use crate::seeded::{self, Seed};
use serde::{Deserialize, Serialize};

/// How the cone is matched to the Mohr-Coulomb friction angle.
///
/// The name says where the two agree; everywhere else the cone is stronger or weaker than Mohr-Coulomb. A cone matched in
/// triaxial compression at 31 degrees acts as 45.9 degrees in plane strain without dilatancy.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Cone {
    /// Through the compression meridian ("outer cone"): q = 6 sin(phi) / (sqrt(3) (3 - sin(phi))).
    TriaxialCompression,
    /// Through the extension meridian ("inner cone"): q = 6 sin(phi) / (sqrt(3) (3 + sin(phi))).
    TriaxialExtension,
    /// Equal to Mohr-Coulomb in plane strain at failure for the dilatancy angle given.
    #[default]
    PlaneStrain,
    /// Ng et al., Eqs. 3-4, to the letter: q = 2 sin(phi) / (sqrt(3) (3 - sin(phi))) although it multiplies the mean stress
    /// and not the first invariant, and k = 2 sqrt(3) cos(phi) / (3 - sin(phi)) taken as pascals, without the cohesion.
    /// It acts as 11.2 degrees in triaxial compression and 13.9 in plane strain at phi = 31 degrees.
    AsPrinted,
}

/// Drucker-Prager with linear elasticity. Yield: f = sqrt(J2) + q mean - k <= 0; flow: q replaced by q_psi.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DruckerPrager {
    /// The elastic part.
    pub elastic: LinearElastic,
    /// Slope of the cone q against the mean stress.
    pub friction: f64,
    /// Slope of the plastic potential q_psi; 0 keeps the volume.
    pub dilatancy: f64,
    /// Shear strength k at zero mean stress, Pa.
    pub cohesion: f64,
    /// Largest mean stress, Pa: at most the apex k/q.
    pub tension_cutoff: f64,
    /// Whether material that came apart must close the opened volume before it builds pressure.
    pub void_tracking: bool,
}

impl DruckerPrager {
    /// From the Mohr-Coulomb friction angle, dilatancy angle (rad) and cohesion (Pa), matched at `cone`.
    ///
    /// `tension_cutoff` (Pa) is lowered to the apex where it lies beyond it.
    pub fn new(
        elastic: LinearElastic,
        cone: Cone,
        friction_angle: f64,
        dilatancy_angle: f64,
        cohesion: f64,
        tension_cutoff: f64,
        void_tracking: bool,
    ) -> Self {
        let sin_phi = libm::sin(friction_angle);
        let sin_psi = libm::sin(dilatancy_angle);
        let cos_phi = libm::cos(friction_angle);
        let root3 = 3f64.sqrt();
        let meridian = |sine: f64, sign: f64| 6.0 * sine / (root3 * (3.0 + sign * sine));
        let (q, q_psi) = match cone {
            Cone::TriaxialCompression => (meridian(sin_phi, -1.0), meridian(sin_psi, -1.0)),
            Cone::TriaxialExtension => (meridian(sin_phi, 1.0), meridian(sin_psi, 1.0)),
            Cone::PlaneStrain => {
                // At plane-strain failure the out-of-plane deviator is -2/3 q_psi sqrt(J2); see theory::plane_strain_friction.
                let q_psi = sin_psi / (1.0 + sin_psi * sin_psi / 3.0).sqrt();
                let q = sin_phi / ((1.0 - q_psi * q_psi / 3.0).sqrt() + q_psi * sin_phi / 3.0);
                (q, q_psi)
            }
            Cone::AsPrinted => (meridian(sin_phi, -1.0) / 3.0, meridian(sin_psi, -1.0) / 3.0),
        };
        let k = match cone {
            Cone::AsPrinted => 2.0 * root3 * cos_phi / (3.0 - sin_phi),
            // The apex is that of Mohr-Coulomb, c cot(phi), for every cone; at phi = 0 the strength is matched itself.
            Cone::TriaxialCompression => 6.0 * cos_phi / (root3 * (3.0 - sin_phi)) * cohesion,
            Cone::TriaxialExtension => 6.0 * cos_phi / (root3 * (3.0 + sin_phi)) * cohesion,
            Cone::PlaneStrain if sin_phi > 0.0 => q * cohesion * cos_phi / sin_phi,
            Cone::PlaneStrain => cohesion,
        };
        let apex = if q > 0.0 { k / q } else { f64::INFINITY };
        Self {
            elastic,
            friction: seeded::times(Seed::ConstitutiveCone, q),
            dilatancy: seeded::times(Seed::ConstitutiveDilatancy, q_psi),
            cohesion: seeded::times(Seed::ConstitutiveCohesion, k),
            tension_cutoff: tension_cutoff.min(apex),
            void_tracking,
        }
    }
}

impl Law for DruckerPrager {
    #[inline(always)]
    fn update(&self, state: &mut PointState, d: &Increment) -> f64 {
        let (bulk, shear) = (self.elastic.bulk, self.elastic.shear);
        let half = d.half_turn();
        let before = state.stress.turned(half);

        // Opened material closes without resistance first.
        let volumetric = d.volumetric();
        let closing = max(0.0, min(state.opened, -volumetric));
        let still_open = state.opened - closing;
        let trial = self.elastic.strain(&before, d, volumetric + closing);

        let (mean_trial, tau_trial) = (trial.mean(), trial.j2().sqrt());

        // Return to the cone along the flow direction, then, where that ends beyond the cut-off, to the cut-off or its edge.
        let excess = max(0.0, tau_trial + self.friction * mean_trial - self.cohesion);
        let multiplier = excess * (1.0 / (shear + bulk * self.friction * self.dilatancy));
        let mean_cone = mean_trial - bulk * self.dilatancy * multiplier;
        // Dilatancy, too, fills what is open before it presses.
        let filled = max(0.0, min(still_open, -mean_cone * (1.0 / bulk)));
        let mean_cone = if filled < still_open { max(mean_cone, 0.0) } else { mean_cone + bulk * filled };
        let still_open = still_open - filled;
        // Material that is open, or comes apart now, has lost its tensile strength.
        let torn = still_open > 0.0 || (self.void_tracking && mean_cone > self.tension_cutoff);
        let cap = if torn { min(0.0, self.tension_cutoff) } else { self.tension_cutoff };
        let mean = min(mean_cone, cap);
        let tau = max(0.0, min(tau_trial, self.cohesion - self.friction * mean));

        let scale = if tau_trial > 0.0 { tau / tau_trial } else { 0.0 };
        let after = trial.deviator().times(scale).plus_mean(mean);

        let opening = (mean_cone - mean) * (1.0 / bulk);
        state.opened = if self.void_tracking { still_open + opening } else { 0.0 };
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

// Comparisons that become single vector instructions; f64::min and max treat NaN apart, which costs.
#[inline(always)]
fn max(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[inline(always)]
fn min(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}
