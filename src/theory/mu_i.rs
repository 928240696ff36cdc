//! Dense granular flow whose friction depends on the inertial number: mu(I) = mu_s + (mu_2 - mu_s) / (1 + I_0/I), with
//! I = rate d / sqrt(p / rho_s) (Jop, Forterre and Pouliquen 2006), and its steady flow down an incline (Bagnold's profile; GDR MiDi
//! 2004).

use libm::{cos, sqrt, tan};

/// Parameters of the law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MuI {
    /// Friction of the slowest flow, mu_s.
    pub least: f64,
    /// Friction of the fastest flow, mu_2.
    pub most: f64,
    /// Inertial number I_0 at which it is half way between.
    pub half_way: f64,
    /// Diameter of grains d, m.
    pub diameter: f64,
    /// Density of grains rho_s, kg/m3.
    pub grain_density: f64,
}

impl MuI {
    /// Inertial number of a shear rate (1/s) under a pressure (Pa).
    pub fn number(&self, rate: f64, pressure: f64) -> f64 {
        rate * self.diameter * sqrt(self.grain_density / pressure)
    }

    /// Friction at an inertial number.
    pub fn friction(&self, number: f64) -> f64 {
        self.least + (self.most - self.least) * number / (self.half_way + number)
    }

    /// Inertial number at which the friction is `friction`; none outside of mu_s to mu_2.
    pub fn number_of(&self, friction: f64) -> Option<f64> {
        let holds = friction > self.least && friction < self.most;
        holds.then(|| self.half_way * (friction - self.least) / (self.most - friction))
    }

    /// Velocity (m/s) at a height above the base, in a layer that flows steadily down an incline of so many rad, in the order depth,
    /// height (m): 2/3 I/d sqrt(rho g cos(theta) / rho_s) (H^1.5 - (H - y)^1.5), with `density` rho in kg/m3. None where it stops or speeds up.
    pub fn incline_velocity(&self, density: f64, gravity: f64, angle: f64, depth: f64, height: f64) -> Option<f64> {
        let number = self.number_of(tan(angle))?;
        let scale = number / self.diameter * sqrt(density * gravity * cos(angle) / self.grain_density);
        let above = depth - height;
        Some(2.0 / 3.0 * scale * (depth * sqrt(depth) - above * sqrt(above)))
    }

    /// The same on an elastic skeleton in rate form with the shear modulus `shear` (Pa), by the midpoint rule on 2000 layers. Stresses that turn
    /// with the material (Jaumann) and flow have in steady simple shear s_xx = -s_yy = tau^2/G to first order in tau/G, so the pressure is
    /// less than the load above it by tau^2/G, and the friction by so much larger.
    pub fn incline_velocity_on_elastic(
        &self,
        density: f64,
        gravity: f64,
        angle: f64,
        [depth, height]: [f64; 2],
        shear: f64,
    ) -> Option<f64> {
        const LAYERS: u32 = 2000;
        let thin = height / f64::from(LAYERS);
        (0..LAYERS)
            .map(|k| {
                let load = density * gravity * cos(angle) * (depth - (f64::from(k) + 0.5) * thin);
                let tau = load * tan(angle);
                let pressure = load - tau * tau / shear;
                let number = self.number_of(tau / pressure)?;
                Some(thin * number / self.diameter * sqrt(pressure / self.grain_density))
            })
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Glass beads (Jop, Forterre and Pouliquen 2006): mu_s = tan 20.9 degrees, mu_2 = tan 32.76 degrees, I_0 = 0.279, d = 0.53 mm.
    const BEADS: MuI = MuI { least: 0.3819, most: 0.6435, half_way: 0.279, diameter: 5.3e-4, grain_density: 2450.0 };

    #[test]
    fn friction_and_number_are_each_others_inverse() {
        assert!((BEADS.friction(0.279) - 0.5127).abs() < 1e-12);
        assert_eq!(BEADS.friction(0.0), 0.3819);
        assert!((BEADS.number_of(BEADS.friction(0.1)).expect("flows") - 0.1).abs() < 1e-12);
        assert_eq!((BEADS.number_of(0.3819), BEADS.number_of(0.65)), (None, None));
        // 100 per second under 245 Pa: 100 x 5.3e-4 x sqrt(10) = 0.1676.
        assert!((BEADS.number(100.0, 245.0) - 0.167_600).abs() < 1e-6);
    }

    /// The profile solves the balance of forces: shear stress rho g sin(theta) (H - y) = mu(I) rho g cos(theta) (H - y), I from its slope.
    #[test]
    fn the_profile_is_in_balance_at_every_height() {
        let (density, g, angle, depth) = (1500.0, 9.81, 25f64.to_radians(), 0.03);
        let v = |y| BEADS.incline_velocity(density, g, angle, depth, y).expect("flows");
        assert_eq!(v(0.0), 0.0);
        for y in [0.003, 0.015, 0.024] {
            let e = 1e-6;
            let rate = (v(y + e) - v(y - e)) / (2.0 * e);
            let pressure = density * g * cos(angle) * (depth - y);
            let friction = BEADS.friction(BEADS.number(rate, pressure));
            assert!((friction / tan(angle) - 1.0).abs() < 1e-7, "{y}: {friction}");
        }
        assert_eq!(BEADS.incline_velocity(density, g, 0.3, depth, 0.01), None);
    }

    #[test]
    fn a_stiff_skeleton_is_none_and_a_soft_one_flows_faster() {
        let (density, g, angle, depth) = (1500.0, 9.81, 25f64.to_radians(), 0.03);
        let rigid = |y| BEADS.incline_velocity(density, g, angle, depth, y).expect("flows");
        let on = |y, shear| BEADS.incline_velocity_on_elastic(density, g, angle, [depth, y], shear).expect("flows");
        for y in [0.01, 0.02, 0.03] {
            assert!((on(y, 1e15) / rigid(y) - 1.0).abs() < 1e-5, "{y}");
        }
        // Close to the base, to first order: the rate goes with I sqrt(p), and dI/dmu = (mu_2 - mu_s) I_0 / (mu_2 - mu)^2.
        let (shear, mu) = (1e6, tan(angle));
        let less = mu * mu * density * g * cos(angle) * depth / shear;
        let steep = (BEADS.most - BEADS.least) * mu / ((BEADS.most - mu) * (mu - BEADS.least));
        let excess = on(1e-5, shear) / rigid(1e-5) - 1.0;
        assert!((excess / (less * (steep - 0.5)) - 1.0).abs() < 1e-2, "{excess}");
    }
}
