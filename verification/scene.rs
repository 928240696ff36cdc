//! Building blocks of the rungs' scenes: those of [`checkdam::scaffold`], and materials that know of the fault.

use crate::Fault;
use checkdam::constitutive::{AnyLaw, LinearElastic};
pub use checkdam::scaffold::{Brick, Lcg, THICKNESS, centre, points_by_number, run_until, scene};
use checkdam::theory::elastic::Elastic;

/// Material parameters of a rung. The solver gets them with the fault, the closed forms without.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Elasticity.
    pub elastic: Elastic,
    /// Density, kg/m3.
    pub density: f64,
}

impl Material {
    /// Young's modulus (Pa), Poisson's ratio, density (kg/m3).
    pub const fn new(young: f64, poisson: f64, density: f64) -> Self {
        Self { elastic: Elastic { young, poisson }, density }
    }

    /// The elastic part as the solver gets it.
    pub fn linear_elastic(&self, fault: &Fault) -> LinearElastic {
        LinearElastic::new(self.elastic.young * fault.modulus, self.elastic.poisson)
    }

    /// The elastic law as the solver gets it.
    pub fn law(&self, fault: &Fault) -> AnyLaw {
        AnyLaw::LinearElastic(self.linear_elastic(fault))
    }
}
