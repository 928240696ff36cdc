//! Constitutive laws, at one material point.
//!
//! A law maps a state and a strain increment to a state. It knows neither grid nor bodies. Stress is the full 3-D Cauchy
//! tensor; in plane strain its `yz` and `zx` components stay zero and are not stored, the out-of-plane stress `zz` is.
//! Tension is positive.
//!
//! Elsewhere: material models, stress integration at an integration point (stress-point algorithm, UMAT).

mod drucker_prager;
mod elastic;
mod logarithm;
mod neo_hookean;

pub use drucker_prager::{Cone, DruckerPrager};
pub use elastic::LinearElastic;
pub use neo_hookean::{Finger, NeoHookean};

/// Cauchy stress under plane strain, in Pa, tension positive.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stress {
    /// Normal component along x.
    pub xx: f64,
    /// Normal component along y.
    pub yy: f64,
    /// Out-of-plane normal component.
    pub zz: f64,
    /// In-plane shear.
    pub xy: f64,
}

impl Stress {
    /// Mean stress tr(sigma)/3, tension positive.
    #[inline(always)]
    pub fn mean(&self) -> f64 {
        (self.xx + self.yy + self.zz) * (1.0 / 3.0)
    }

    /// Second invariant of the deviator, J2 = s:s/2.
    #[inline(always)]
    pub fn j2(&self) -> f64 {
        let m = self.mean();
        let (a, b, c) = (self.xx - m, self.yy - m, self.zz - m);
        0.5 * (a * a + b * b + c * c) + self.xy * self.xy
    }

    /// The stress seen after a rotation by the angle whose cosine and sine of the *double* angle are given.
    #[inline(always)]
    fn rotated(self, cos2: f64, sin2: f64) -> Self {
        let centre = 0.5 * (self.xx + self.yy);
        let half = 0.5 * (self.xx - self.yy);
        let d = half * cos2 - self.xy * sin2;
        Self { xx: centre + d, yy: centre - d, zz: self.zz, xy: half * sin2 + self.xy * cos2 }
    }
}

/// What the grid tells a material point in one step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Increment {
    /// Normal strain along x: dt dvx/dx.
    pub xx: f64,
    /// Normal strain along y: dt dvy/dy.
    pub yy: f64,
    /// Tensor shear strain: dt (dvx/dy + dvy/dx) / 2.
    pub xy: f64,
    /// Rotation, counter-clockwise: dt (dvy/dx - dvx/dy) / 2.
    pub spin: f64,
}

impl Increment {
    /// Volumetric strain; the out-of-plane strain is zero.
    #[inline(always)]
    pub fn volumetric(&self) -> f64 {
        self.xx + self.yy
    }
}

/// What a material point remembers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PointState {
    /// Cauchy stress.
    pub stress: Stress,
    /// Volumetric strain by which the material has come apart and which must close before pressure builds up again (>= 0).
    pub opened: f64,
    /// Equivalent plastic shear strain, the path integral of sqrt(2/3 de_p:de_p), deviatoric part.
    pub plastic_shear: f64,
    /// Left Cauchy-Green tensor, for laws that carry it ([`Law::CARRIES_DEFORMATION`]).
    pub finger: Finger,
}

/// A constitutive law.
pub trait Law: Copy + Send + Sync {
    /// Whether the law needs the left Cauchy-Green tensor kept from step to step.
    const CARRIES_DEFORMATION: bool = false;

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

    /// Elastic energy stored per unit current volume, J/m3; in rate form J2/(2G) + mean^2/(2K).
    fn stored_energy(&self, state: &PointState) -> f64;

    /// P-wave modulus M = K + 4G/3 in Pa, which bounds the time step.
    fn p_wave_modulus(&self) -> f64;
}

/// Cosine and sine of the angle `w` in the Cayley form: tan(w/2) replaced by w/2.
#[inline(always)]
fn cayley(w: f64) -> (f64, f64) {
    let quarter = 0.25 * w * w;
    let per = 1.0 / (1.0 + quarter);
    ((1.0 - quarter) * per, w * per)
}

/// Work of the mean of two stresses over a strain increment, per unit volume.
#[inline(always)]
fn midpoint_work(a: &Stress, b: &Stress, d: &Increment) -> f64 {
    0.5 * ((a.xx + b.xx) * d.xx + (a.yy + b.yy) * d.yy) + (a.xy + b.xy) * d.xy
}

/// Any of the laws, chosen once for a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AnyLaw {
    /// Linear elasticity in rate form.
    LinearElastic(LinearElastic),
    /// Drucker-Prager.
    DruckerPrager(DruckerPrager),
    /// Neo-Hookean elasticity.
    NeoHookean(NeoHookean),
}

impl AnyLaw {
    /// See [`Law::CARRIES_DEFORMATION`].
    pub fn carries_deformation(&self) -> bool {
        match self {
            AnyLaw::LinearElastic(_) => LinearElastic::CARRIES_DEFORMATION,
            AnyLaw::DruckerPrager(_) => DruckerPrager::CARRIES_DEFORMATION,
            AnyLaw::NeoHookean(_) => NeoHookean::CARRIES_DEFORMATION,
        }
    }
}

impl Law for AnyLaw {
    fn update(&self, state: &mut PointState, increment: &Increment) -> f64 {
        match self {
            AnyLaw::LinearElastic(law) => law.update(state, increment),
            AnyLaw::DruckerPrager(law) => law.update(state, increment),
            AnyLaw::NeoHookean(law) => law.update(state, increment),
        }
    }

    fn volume_ratio(&self, state: &PointState, before: f64, increment: &Increment) -> f64 {
        match self {
            AnyLaw::LinearElastic(law) => law.volume_ratio(state, before, increment),
            AnyLaw::DruckerPrager(law) => law.volume_ratio(state, before, increment),
            AnyLaw::NeoHookean(law) => law.volume_ratio(state, before, increment),
        }
    }

    fn stored_energy(&self, state: &PointState) -> f64 {
        match self {
            AnyLaw::LinearElastic(law) => law.stored_energy(state),
            AnyLaw::DruckerPrager(law) => law.stored_energy(state),
            AnyLaw::NeoHookean(law) => law.stored_energy(state),
        }
    }

    fn p_wave_modulus(&self) -> f64 {
        match self {
            AnyLaw::LinearElastic(law) => law.p_wave_modulus(),
            AnyLaw::DruckerPrager(law) => law.p_wave_modulus(),
            AnyLaw::NeoHookean(law) => law.p_wave_modulus(),
        }
    }
}

#[cfg(test)]
mod tests;
