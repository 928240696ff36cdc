//! Materials: the `[materials.NAME]` tables of a case file.

use serde::{Deserialize, Serialize};

use crate::constitutive::Cone;

/// A material. Each law has keys of its own from `friction_angle_deg` on; a key is refused with the laws that do not use it.
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
    /// Mohr-Coulomb friction angle, before anything softens. Default: none; required by `law = "drucker_prager"` and `"mohr_coulomb"`.
    /// Allowed: only with these; 0 or more and below 90, with `cone = "triaxial_compression"` below 42.2. Example: `31`.
    pub friction_angle_deg: Option<f64>,
    /// Cohesion. Default: `0.0`. Allowed: only with `law = "drucker_prager"` and `"mohr_coulomb"`; 0 or more. Example: `500`.
    pub cohesion_pa: Option<f64>,
    /// Dilatancy angle. Default: `0.0`. Allowed: only with `law = "drucker_prager"` and `"mohr_coulomb"`; from 0 to `friction_angle_deg`.
    /// Example: `5`.
    pub dilatancy_angle_deg: Option<f64>,
    /// How the cone is matched to the Mohr-Coulomb angle. Default: `"plane_strain"`. Allowed: only with `law =
    /// "drucker_prager"`. Example: `"triaxial_compression"`.
    pub cone: Option<Cone>,
    /// Largest mean tension. Default: `0.0`. Allowed: only with `law = "drucker_prager"` and `"mohr_coulomb"`; 0 or more. Example: `100`.
    pub tension_cutoff_pa: Option<f64>,
    /// Material that separates must close the opened volume before it builds pressure. Default: `true`. Allowed: only
    /// with `law = "drucker_prager"`, `"mohr_coulomb"` and `"mu_i"`. Example: `false`.
    pub void_tracking: Option<bool>,
    /// Friction angle of the critical state, to which friction falls with plastic shear; dilatancy and cohesion fall to nothing.
    /// Default: none; it does not soften. Allowed: only with `law = "drucker_prager"` and `"mohr_coulomb"`, together with
    /// `softening_strain`; from 0 to `friction_angle_deg`. Example: `28`.
    pub critical_friction_angle_deg: Option<f64>,
    /// Equivalent plastic shear strain since the start at which the critical state is reached, in a straight line. Shear bands are as wide
    /// as the grid makes them, so results depend on the cell size. Default: none; it does not soften. Allowed: only with
    /// `critical_friction_angle_deg`; above 0. Example: `0.1`.
    pub softening_strain: Option<f64>,
    /// Share of the mean pressure that a pore fluid carries, everywhere and for all time: a simplification, without flow of the fluid.
    /// Friction of the material acts on the rest; that of boundaries is given as it acts. Default: none; it is dry. Allowed: only with `law =
    /// "drucker_prager"`; 0 or more and below 1. Example: `0.4`.
    pub pore_pressure_ratio: Option<f64>,
    /// Shear strength in pure shear. Default: none; required by `law = "von_mises"`. Allowed: only with it; above 0. Example: `2000`.
    pub shear_strength_pa: Option<f64>,
    /// Growth of the shear strength with the plastic shear (engineering strain). Default: none; it does not harden. Allowed: only with
    /// `law = "von_mises"`; 0 or more. Example: `5.0e4`.
    pub hardening_pa: Option<f64>,
    /// Shear stress beyond the strength over the rate of the plastic shear (Bingham). Default: none; the rate does not matter. Allowed: only
    /// with `law = "von_mises"`; 0 or more. Example: `20`.
    pub viscosity_pa_s: Option<f64>,
    /// Friction of the slowest flow, shear over normal stress in simple shear. Default: none; required by `law = "mu_i"`. Allowed: only with
    /// it; 0 or more. Example: `0.38`.
    pub mu_s: Option<f64>,
    /// Friction of the fastest flow. Default: none; required by `law = "mu_i"`. Allowed: only with it; from `mu_s` on, and below 1. Example:
    /// `0.64`.
    pub mu_2: Option<f64>,
    /// Inertial number at which friction is half way from `mu_s` to `mu_2`. Default: none; required by `law = "mu_i"`. Allowed: only with
    /// it; above 0. Example: `0.279`.
    pub i_0: Option<f64>,
    /// Diameter of grains. Default: none; required by `law = "mu_i"`. Allowed: only with it; above 0. Example: `5.3e-4`.
    pub grain_diameter_m: Option<f64>,
    /// Density of grains. Default: none; required by `law = "mu_i"`. Allowed: only with it; `density_kg_per_m3` or more. Example: `2450`.
    pub grain_density_kg_per_m3: Option<f64>,
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
    /// Linear elasticity with the pyramid of Mohr-Coulomb, all edges and its apex.
    MohrCoulomb,
    /// Granular flow whose friction depends on the inertial number, at constant volume.
    MuI,
    /// Neo-Hookean elasticity: for bodies that turn or bend far.
    NeoHookean,
    /// Linear elasticity with a shear strength that does not depend on pressure, with hardening and viscosity: mud, clay.
    VonMises,
}

impl Law {
    /// Whether it flows: all but those that are elastic.
    pub fn flows(self) -> bool {
        match self {
            Law::LinearElastic | Law::NeoHookean => false,
            Law::DruckerPrager | Law::MohrCoulomb | Law::MuI | Law::VonMises => true,
        }
    }
}

/// The parameters of a material with a friction angle, defaults filled in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frictional {
    /// Mohr-Coulomb friction angle, degrees.
    pub friction_angle_deg: f64,
    /// Cohesion, Pa.
    pub cohesion_pa: f64,
    /// Dilatancy angle, degrees.
    pub dilatancy_angle_deg: f64,
    /// Matching of the cone; of Mohr-Coulomb, which has none, the default.
    pub cone: Cone,
    /// Largest mean tension, Pa.
    pub tension_cutoff_pa: f64,
    /// Whether opened volume must close before pressure builds up.
    pub void_tracking: bool,
    /// Share of the mean pressure that a pore fluid carries.
    pub pore_pressure_ratio: f64,
    /// Friction angle of the critical state in degrees, and the plastic shear strain at which it is reached; none where it does not soften.
    pub softening: Option<[f64; 2]>,
}

impl Material {
    /// The parameters of a Drucker-Prager or Mohr-Coulomb material; `None` for others. In a validated case one of these laws has them.
    pub fn frictional(&self) -> Option<Frictional> {
        matches!(self.law, Law::DruckerPrager | Law::MohrCoulomb).then_some(())?;
        Some(Frictional {
            friction_angle_deg: self.friction_angle_deg?,
            cohesion_pa: self.cohesion_pa.unwrap_or(0.0),
            dilatancy_angle_deg: self.dilatancy_angle_deg.unwrap_or(0.0),
            cone: self.cone.unwrap_or_default(),
            tension_cutoff_pa: self.tension_cutoff_pa.unwrap_or(0.0),
            void_tracking: self.void_tracking.unwrap_or(true),
            pore_pressure_ratio: self.pore_pressure_ratio.unwrap_or(0.0),
            softening: self.critical_friction_angle_deg.zip(self.softening_strain).map(Into::into),
        })
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
        if let Some(resolved) = self.frictional() {
            self.cohesion_pa = Some(resolved.cohesion_pa);
            self.dilatancy_angle_deg = Some(resolved.dilatancy_angle_deg);
            self.cone = (self.law == Law::DruckerPrager).then_some(resolved.cone);
            self.tension_cutoff_pa = Some(resolved.tension_cutoff_pa);
            self.void_tracking = Some(resolved.void_tracking);
        }
        match self.law {
            Law::MuI => self.void_tracking = Some(self.void_tracking.unwrap_or(true)),
            Law::VonMises => {
                self.hardening_pa = Some(self.hardening_pa.unwrap_or(0.0));
                self.viscosity_pa_s = Some(self.viscosity_pa_s.unwrap_or(0.0));
            }
            Law::DruckerPrager | Law::LinearElastic | Law::MohrCoulomb | Law::NeoHookean => {}
        }
    }
}
