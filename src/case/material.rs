//! Materials: the `[materials.NAME]` tables of a case file.

use serde::{Deserialize, Serialize};

use crate::constitutive::Cone;

/// A material. The keys from `friction_angle_deg` on belong to the Drucker-Prager law and are refused with the others.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Constitutive law. Example: `"drucker_prager"`.
    pub law: Law,
    /// Bulk density. Allowed: above 0. Example: `1500`.
    pub density_kg_per_m3: f64,
    /// Young's modulus. Allowed: above 0. Example: `1.0e6`.
    pub young_pa: f64,
    /// Poisson's ratio. Allowed: above -1 and below 0.5. Example: `0.3`.
    pub poisson: f64,
    /// Mohr-Coulomb friction angle. Default: none; required by `law = "drucker_prager"`. Allowed: only with `law =
    /// "drucker_prager"`; 0 or more and below 90, with `cone = "triaxial_compression"` below 42.2. Example: `31`.
    pub friction_angle_deg: Option<f64>,
    /// Cohesion. Default: `0.0`. Allowed: only with `law = "drucker_prager"`; 0 or more. Example: `500`.
    pub cohesion_pa: Option<f64>,
    /// Dilatancy angle. Default: `0.0`. Allowed: only with `law = "drucker_prager"`; from 0 to `friction_angle_deg`.
    /// Example: `5`.
    pub dilatancy_angle_deg: Option<f64>,
    /// How the cone is matched to the Mohr-Coulomb angle. Default: `"plane_strain"`. Allowed: only with `law =
    /// "drucker_prager"`. Example: `"triaxial_compression"`.
    pub cone: Option<Cone>,
    /// Largest mean tension. Default: `0.0`. Allowed: only with `law = "drucker_prager"`; 0 or more. Example: `100`.
    pub tension_cutoff_pa: Option<f64>,
    /// Material that separates must close the opened volume before it builds pressure. Default: `true`. Allowed: only
    /// with `law = "drucker_prager"`. Example: `false`.
    pub void_tracking: Option<bool>,
}

/// Constitutive law.
// A word, of which `run::scene` makes an `AnyLaw` with the numbers that the material has under keys of their own (see the head of
// `boundary.rs`). The solver's enum has the moduli, the cone and what follows from them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Law {
    /// Linear elasticity with a Drucker-Prager cone.
    DruckerPrager,
    /// Linear elasticity alone.
    LinearElastic,
    /// Neo-Hookean elasticity: for bodies that turn or bend far.
    NeoHookean,
}

/// The Drucker-Prager parameters of a material, defaults filled in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DruckerPrager {
    /// Mohr-Coulomb friction angle, degrees.
    pub friction_angle_deg: f64,
    /// Cohesion, Pa.
    pub cohesion_pa: f64,
    /// Dilatancy angle, degrees.
    pub dilatancy_angle_deg: f64,
    /// Matching of the cone.
    pub cone: Cone,
    /// Largest mean tension, Pa.
    pub tension_cutoff_pa: f64,
    /// Whether opened volume must close before pressure builds up.
    pub void_tracking: bool,
}

impl Material {
    /// The Drucker-Prager parameters; `None` for an elastic material. In a validated case the two cases are exhaustive.
    pub fn drucker_prager(&self) -> Option<DruckerPrager> {
        match self.law {
            Law::LinearElastic | Law::NeoHookean => None,
            Law::DruckerPrager => Some(DruckerPrager {
                friction_angle_deg: self.friction_angle_deg?,
                cohesion_pa: self.cohesion_pa.unwrap_or(0.0),
                dilatancy_angle_deg: self.dilatancy_angle_deg.unwrap_or(0.0),
                cone: self.cone.unwrap_or_default(),
                tension_cutoff_pa: self.tension_cutoff_pa.unwrap_or(0.0),
                void_tracking: self.void_tracking.unwrap_or(true),
            }),
        }
    }

    /// P-wave modulus E (1 - nu) / ((1 + nu)(1 - 2 nu)), Pa.
    pub fn p_wave_modulus_pa(&self) -> f64 {
        let nu = self.poisson;
        self.young_pa * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))
    }

    /// Speed of compression waves, m/s.
    pub fn p_wave_speed_m_per_s(&self) -> f64 {
        (self.p_wave_modulus_pa() / self.density_kg_per_m3).sqrt()
    }

    pub(super) fn resolve(&mut self) {
        if let Some(resolved) = self.drucker_prager() {
            self.cohesion_pa = Some(resolved.cohesion_pa);
            self.dilatancy_angle_deg = Some(resolved.dilatancy_angle_deg);
            self.cone = Some(resolved.cone);
            self.tension_cutoff_pa = Some(resolved.tension_cutoff_pa);
            self.void_tracking = Some(resolved.void_tracking);
        }
    }
}
