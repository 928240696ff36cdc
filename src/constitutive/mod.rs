//! Constitutive laws, at one material point.
//!
//! A law maps a state and a strain increment to a state. It knows neither grid nor bodies. Stress is the full 3-D Cauchy
//! tensor; in plane strain its `yz` and `zx` components stay zero and are not stored, the out-of-plane stress `zz` is.
//! Tension is positive.
//!
//! Elsewhere: material models, stress integration at an integration point (stress-point algorithm, UMAT).

mod any;
mod drucker_prager;
mod elastic;
mod logarithm;
mod mohr_coulomb;
mod mu_i;
mod neo_hookean;
mod nominal;
mod opened;
mod principal;
mod softening;
mod tensor;
mod von_mises;

pub use any::AnyLaw;
pub(crate) use any::with_law;
pub use drucker_prager::{Cone, DruckerPrager};
pub use elastic::LinearElastic;
pub use mohr_coulomb::MohrCoulomb;
pub use mu_i::MuI;
pub use neo_hookean::NeoHookean;
pub use nominal::{Gradient, Nominal};
pub use softening::{Softening, SofteningDruckerPrager, SofteningMohrCoulomb, Softens};
pub use tensor::{Finger, HalfTurn, Increment, Stress, Symmetric};
pub use von_mises::VonMises;

/// Room for what a law keeps of its own at a point, of which it uses the first [`Law::HISTORY`]; the others are zero.
pub type History = [f64; AnyLaw::HISTORY];

/// What a material point remembers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PointState {
    /// Cauchy stress.
    pub stress: Stress,
    /// Volumetric strain by which the material has come apart and which must close before pressure builds up again (>= 0).
    pub opened: f64,
    /// Equivalent plastic shear strain, the path integral of sqrt(2/3 de_p:de_p), deviatoric part.
    pub plastic_shear: f64,
    /// What the law keeps of its own.
    pub history: History,
}

/// A constitutive law.
pub trait Law: Copy + Send + Sync {
    /// How many numbers of its own the law keeps at a point from step to step, in [`PointState::history`]. They go with the point
    /// wherever it is sorted to, are zero for a point in its reference state, and cost nothing where there are none.
    const HISTORY: usize = 0;

    /// Advances `state` by one increment and returns the work done per unit volume, at the mean of the volumes before and after
    /// (J/m3).
    ///
    /// Laws in rate form follow the Jaumann rate: the stress is turned by half the spin, strained, and turned by the other half,
    /// which is second-order accurate; each half turn uses the Cayley form of the rotation (Hughes and Winget 1980), which keeps
    /// the invariants to round-off. Their work is that of the midpoint stress.
    fn update(&self, state: &mut PointState, increment: &Increment) -> f64;

    /// Current over reference volume after an increment that `state` has been advanced by; `before` is what it was.
    #[inline(always)]
    fn volume_ratio(&self, state: &PointState, before: f64, increment: &Increment) -> f64 {
        let _ = state;
        // exp of the volumetric strain to third order, without leaving the positive side for |strain| < 2.
        let half = 0.5 * increment.volumetric();
        before * ((1.0 + half) / (1.0 - half))
    }

    /// Left Cauchy-Green tensor, of laws that keep it.
    fn deformation(&self, state: &PointState) -> Option<Finger> {
        let _ = state;
        None
    }

    /// Elastic energy stored per unit current volume, J/m3; in rate form J2/(2G) + mean^2/(2K).
    fn stored_energy(&self, state: &PointState) -> f64;

    /// Lame's parameters lambda and mu at rest, Pa: the stiffness that implicit steps reckon with.
    fn lame(&self) -> [f64; 2];

    /// P-wave modulus M = K + 4G/3 in Pa, which bounds the time step.
    fn p_wave_modulus(&self) -> f64;
}

#[cfg(test)]
mod tests;
