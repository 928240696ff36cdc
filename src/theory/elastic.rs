//! Isotropic linear elasticity: moduli and wave speeds.

/// Young's modulus and Poisson's ratio.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elastic {
    /// Young's modulus E, Pa.
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
}

impl Elastic {
    /// Bulk modulus E / (3 (1 - 2 nu)), Pa (Timoshenko and Goodier 1970).
    pub fn bulk(&self) -> f64 {
        self.young / (3.0 * (1.0 - 2.0 * self.poisson))
    }

    /// Shear modulus E / (2 (1 + nu)), Pa (Timoshenko and Goodier 1970).
    pub fn shear(&self) -> f64 {
        self.young / (2.0 * (1.0 + self.poisson))
    }

    /// Lame's first parameter E nu / ((1 + nu) (1 - 2 nu)), Pa.
    pub fn lame(&self) -> f64 {
        let nu = self.poisson;
        self.young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))
    }

    /// P-wave (confined, oedometric) modulus M = E (1 - nu) / ((1 + nu) (1 - 2 nu)), Pa.
    pub fn confined(&self) -> f64 {
        let nu = self.poisson;
        self.young * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))
    }

    /// Modulus of a strip in plane strain whose faces are free, E / (1 - nu^2), Pa.
    pub fn plane_strain(&self) -> f64 {
        self.young / (1.0 - self.poisson * self.poisson)
    }

    /// Ratio of lateral to axial stress where lateral strain is prevented, nu / (1 - nu).
    pub fn lateral_ratio(&self) -> f64 {
        self.poisson / (1.0 - self.poisson)
    }
}

/// Speed of a wave in a thin bar, sqrt(E / rho), m/s (Rayleigh 1877). `density` in kg/m3.
pub fn bar_speed(e: &Elastic, density: f64) -> f64 {
    (e.young / density).sqrt()
}

/// Speed of a wave in material confined sideways, sqrt(M / rho), m/s: the P-wave.
pub fn confined_speed(e: &Elastic, density: f64) -> f64 {
    (e.confined() / density).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sand_of_1_mpa() {
        let e = Elastic { young: 1e6, poisson: 0.3 };
        assert!((e.confined() - 1.346_153_846e6).abs() < 1.0);
        assert!((e.bulk() + 4.0 / 3.0 * e.shear() - e.confined()).abs() < 1e-6);
        assert!((e.lame() + 2.0 * e.shear() - e.confined()).abs() < 1e-6);
        assert!((bar_speed(&e, 1500.0) - 25.82).abs() < 5e-3);
        assert!((confined_speed(&e, 1500.0) - 29.96).abs() < 5e-3);
        assert!((e.lateral_ratio() - 0.428_571).abs() < 1e-6);
    }
}
