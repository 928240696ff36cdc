//! A manufactured solution for the logarithmic law: a motion is chosen, and the accelerations that it needs follow from the
//! momentum balance (Roache 2002; for the material point method Wallstedt and Guilkey 2008).
//!
//! Every line of material parallel to an axis stays so: u = A sin(k X) sin(w t + phi_x), v = A sin(k Y) sin(w t + phi_y). Then
//! F is diagonal, nothing spins, and the Jaumann rate integrates to sigma = lambda tr(ln F) I + 2 G ln F whatever the path. With
//! the first Piola-Kirchhoff stress P_xx = F_yy sigma_xx and dF_xx/dX = -k^2 u, the momentum balance
//! rho0 d2u/dt2 = dP_xx/dX + rho0 b_x gives b_x = u (-w^2 + (lambda + 2 G) k^2 F_yy / (rho0 F_xx)) (derived here).

use super::elastic::Elastic;
use libm::{cos, log, sin};

/// The chosen motion, of the unit of length of `wave_number`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Elasticity.
    pub elastic: Elastic,
    /// Reference density, kg/m3.
    pub density: f64,
    /// A, m.
    pub amplitude: f64,
    /// k, 1/m.
    pub wave_number: f64,
    /// w, rad/s.
    pub angular_frequency: f64,
    /// phi_x and phi_y, rad.
    pub phase: [f64; 2],
}

impl Motion {
    /// Displacement of the point that was at `x0`, m.
    pub fn displacement(&self, x0: [f64; 2], t: f64) -> [f64; 2] {
        self.each(|d| self.amplitude * sin(self.wave_number * x0[d]) * sin(self.angle(d, t)))
    }

    /// Velocity of the point that was at `x0`, m/s.
    pub fn velocity(&self, x0: [f64; 2], t: f64) -> [f64; 2] {
        let speed = self.amplitude * self.angular_frequency;
        self.each(|d| speed * sin(self.wave_number * x0[d]) * cos(self.angle(d, t)))
    }

    /// F_xx and F_yy.
    pub fn stretch(&self, x0: [f64; 2], t: f64) -> [f64; 2] {
        let slope = self.amplitude * self.wave_number;
        self.each(|d| 1.0 + slope * cos(self.wave_number * x0[d]) * sin(self.angle(d, t)))
    }

    /// Cauchy stress xx, yy, zz, Pa.
    pub fn stress(&self, x0: [f64; 2], t: f64) -> [f64; 3] {
        let e = self.stretch(x0, t).map(log);
        let p = self.elastic.lame() * (e[0] + e[1]);
        let two_g = 2.0 * self.elastic.shear();
        [p + two_g * e[0], p + two_g * e[1], p]
    }

    /// Acceleration that has to act on the point that was at `x0`, m/s2.
    pub fn acceleration(&self, x0: [f64; 2], t: f64) -> [f64; 2] {
        let stiffness = self.elastic.confined() * self.wave_number * self.wave_number / self.density;
        let inertia = self.angular_frequency * self.angular_frequency;
        let (u, f) = (self.displacement(x0, t), self.stretch(x0, t));
        self.each(|d| u[d] * (stiffness * f[1 - d] / f[d] - inertia))
    }

    fn angle(&self, d: usize, t: f64) -> f64 {
        self.angular_frequency * t + self.phase[d]
    }

    fn each(&self, f: impl Fn(usize) -> f64) -> [f64; 2] {
        [f(0), f(1)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOTION: Motion = Motion {
        elastic: Elastic { young: 1e6, poisson: 0.3 },
        density: 1500.0,
        amplitude: 0.05,
        wave_number: 2.0 * std::f64::consts::PI,
        angular_frequency: 90.0,
        phase: [0.3, 2.0],
    };
    const AT: [[f64; 2]; 3] = [[0.13, 0.57], [0.81, 0.29], [0.4, 0.93]];

    /// First Piola-Kirchhoff stress, diagonal.
    fn nominal(x0: [f64; 2], t: f64) -> [f64; 2] {
        let (s, f) = (MOTION.stress(x0, t), MOTION.stretch(x0, t));
        [f[1] * s[0], f[0] * s[1]]
    }

    fn moved(x0: [f64; 2], d: usize, by: f64) -> [f64; 2] {
        let mut x = x0;
        x[d] += by;
        x
    }

    #[test]
    fn momentum_balances_by_finite_differences() {
        let (t, e, dt) = (0.0123, 1e-4, 1e-5);
        for x0 in AT {
            for d in 0..2 {
                let u = |t| MOTION.displacement(x0, t)[d];
                let inertia = (u(t + dt) - 2.0 * u(t) + u(t - dt)) / (dt * dt);
                let force = (nominal(moved(x0, d, e), t)[d] - nominal(moved(x0, d, -e), t)[d]) / (2.0 * e);
                let b = MOTION.acceleration(x0, t)[d];
                let scale = inertia.abs() + b.abs();
                assert!((inertia - force / MOTION.density - b).abs() < 1e-5 * scale, "{x0:?} {d}");
            }
        }
    }

    #[test]
    fn velocity_and_stretch_are_derivatives_of_the_displacement() {
        let (t, e) = (0.0123, 1e-6);
        for x0 in AT {
            for d in 0..2 {
                let u = |x, t| MOTION.displacement(x, t)[d];
                let rate = (u(x0, t + e) - u(x0, t - e)) / (2.0 * e);
                assert!((rate - MOTION.velocity(x0, t)[d]).abs() < 1e-6);
                let slope = (u(moved(x0, d, e), t) - u(moved(x0, d, -e), t)) / (2.0 * e);
                assert!((1.0 + slope - MOTION.stretch(x0, t)[d]).abs() < 1e-8);
                assert!((u(moved(x0, 1 - d, e), t) - u(x0, t)).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn the_stress_follows_the_rate_law_of_the_material() {
        // d sigma/dt = lambda tr(D) + 2 G D with D = (dF/dt) / F; no spin.
        let (t, e) = (0.0123, 1e-7);
        let (lambda, two_g) = (MOTION.elastic.lame(), 2.0 * MOTION.elastic.shear());
        for x0 in AT {
            let f = |t| MOTION.stretch(x0, t);
            let d: Vec<f64> = (0..2).map(|i| (f(t + e)[i] - f(t - e)[i]) / (2.0 * e) / f(t)[i]).collect();
            let trace = d[0] + d[1];
            for (i, own) in [d[0], d[1], 0.0].into_iter().enumerate() {
                let rate = (MOTION.stress(x0, t + e)[i] - MOTION.stress(x0, t - e)[i]) / (2.0 * e);
                assert!((rate - lambda * trace - two_g * own).abs() < 1e-5 * lambda * 90.0);
            }
        }
    }

    #[test]
    fn walls_at_full_periods_are_not_crossed() {
        for x in [0.0, 0.5, 1.0] {
            assert!(MOTION.displacement([x, x], 0.01).iter().all(|u| u.abs() < 1e-15));
        }
    }
}
