//! A column that settles under its own weight, confined sideways, with the logarithmic (hypoelastic) law sigma = M ln(lambda).
//!
//! Y is measured in the unloaded column from its base, L its height there, q = rho0 g L / M the load number.

use libm::exp;

/// A column at rest under its own weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Column {
    /// Height without load, m.
    pub height: f64,
    /// Density without load, kg/m3.
    pub density: f64,
    /// Gravity, m/s2, positive downwards.
    pub gravity: f64,
    /// Confined modulus M (Pa), or Young's modulus at zero Poisson's ratio.
    pub modulus: f64,
}

impl Column {
    /// Load number q = rho0 g L / M.
    pub fn load(&self) -> f64 {
        self.density * self.gravity * self.height / self.modulus
    }

    /// Vertical Cauchy stress at `y0` (m, unloaded height), -rho0 g (L - Y), Pa: equilibrium, for any law.
    pub fn stress(&self, y0: f64) -> f64 {
        -self.density * self.gravity * (self.height - y0)
    }

    /// Where the point of unloaded height `y0` comes to rest, m: the integral of lambda = exp(sigma / M) from the base.
    pub fn position(&self, y0: f64) -> f64 {
        let weight = self.density * self.gravity;
        self.modulus / weight * (exp(self.stress(y0) / self.modulus) - exp(-self.load()))
    }

    /// Height of the loaded column, L (1 - exp(-q)) / q, m.
    pub fn settled_height(&self) -> f64 {
        self.position(self.height)
    }

    /// Elastic energy per area of the base, J/m2: the integral of sigma^2 / (2 M) over the deformed height,
    /// M^2 / (2 rho0 g) (2 - exp(-q) (q^2 + 2 q + 2)).
    pub fn elastic_energy(&self) -> f64 {
        let q = self.load();
        self.modulus * self.modulus / (2.0 * self.density * self.gravity) * (2.0 - exp(-q) * (q * q + 2.0 * q + 2.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_tops_of_the_hypoelastic_column() {
        // AMPLE (Coombs and Augarde 2020): L0 = 50, E = 1e6, nu = 0, rho = 80, g = 10; fMPMM (Wyser et al. 2020): q = 0.7848.
        for (height, modulus, gravity, top) in [(50.0, 1e6, 10.0, 0.980_264), (10.0, 1e4, 9.81, 0.692_901)] {
            let c = Column { height, density: 80.0, gravity, modulus };
            assert!((c.settled_height() / height - top).abs() < 1e-6, "{}", c.settled_height() / height);
        }
    }

    #[test]
    fn energy_agrees_with_quadrature_and_with_small_load() {
        let c = Column { height: 10.0, density: 80.0, gravity: 9.81, modulus: 1e4 };
        let n = 20_000;
        let dy = c.height / f64::from(n);
        let sum: f64 = (0..n)
            .map(|i| {
                let s = c.stress((f64::from(i) + 0.5) * dy);
                0.5 * s * s / c.modulus * exp(s / c.modulus) * dy
            })
            .sum();
        assert!((c.elastic_energy() / sum - 1.0).abs() < 1e-7);
        let stiff = Column { modulus: 1e7, ..c };
        let linear = (80.0 * 9.81f64).powi(2) * 1e3 / (6.0 * 1e7);
        assert!((stiff.elastic_energy() / linear - 1.0).abs() < 1e-3);
    }
}
