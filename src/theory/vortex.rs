//! A vortex manufactured for the Jaumann rate: rings turn against each other, so that material is sheared and turned far
//! (the generalised vortex of Kamojjala, Brannon, Sadeghirad and Guilkey 2015, here for a hypoelastic law and a smoother profile).
//!
//! A point at radius R turns by a(R, t) = A sin(w t) g(R), g = (1 - s^2)^3 with s = (R - R0)/B inside |s| < 1 and 0 outside: three times
//! differentiable, and nothing moves at the edges. In the frame that turns with the point this is simple shear by y = R da/dR along the
//! circle, so Dienes' (1979) solution holds. The shear stress is G sin(y), the stress along the circle G (1 - cos(y)), and that across it
//! the negative. The volume is kept. The momentum balance on the circle then gives the acceleration that has to act, outwards and along the
//! circle (derived here): b_r = -R a_t^2 + (G/rho) (y' sin(y) + 2 (1 - cos(y))/R), b_c = R a_tt - (G/rho) (y' cos(y) + 2 sin(y)/R), y' =
//! dy/dR.

use super::elastic::Elastic;
use super::jaumann;
use libm::{cos, sin};

/// The chosen motion about the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vortex {
    /// Elasticity.
    pub elastic: Elastic,
    /// Density, kg/m3.
    pub density: f64,
    /// A, rad.
    pub angle: f64,
    /// w, rad/s.
    pub angular_frequency: f64,
    /// R0, m.
    pub radius: f64,
    /// B, half the width of what turns, m; less than R0.
    pub half_width: f64,
}

impl Vortex {
    /// Angle by which the point at radius `r` has turned, rad.
    pub fn turned(&self, r: f64, t: f64) -> f64 {
        self.angle * sin(self.angular_frequency * t) * self.profile(r)[0]
    }

    /// Largest shear strain while it turns: R |da/dR| over all radii, at w t = pi/2.
    pub fn largest_shear(&self) -> f64 {
        let at = |k: u32| self.radius - self.half_width * (1.0 - f64::from(k) / 500.0);
        (0..=1000).map(|k| (self.angle * at(k) * self.profile(at(k))[1]).abs()).fold(0.0, f64::max)
    }

    /// Where the point that was at `x0` is, m.
    pub fn position(&self, x0: [f64; 2], t: f64) -> [f64; 2] {
        let (c, s) = self.rotation(x0, t);
        [c * x0[0] - s * x0[1], s * x0[0] + c * x0[1]]
    }

    /// Velocity of the point that was at `x0`, m/s.
    pub fn velocity(&self, x0: [f64; 2], t: f64) -> [f64; 2] {
        let rate = self.angle * self.angular_frequency * cos(self.angular_frequency * t) * self.profile(radius(x0))[0];
        let x = self.position(x0, t);
        [-rate * x[1], rate * x[0]]
    }

    /// Cauchy stress xx, yy, xy of the point that was at `x0`, Pa.
    pub fn stress(&self, x0: [f64; 2], t: f64) -> [f64; 3] {
        let (r, g) = (radius(x0), self.elastic.shear());
        let shear = r * self.angle * sin(self.angular_frequency * t) * self.profile(r)[1];
        let along = jaumann::normal_stress(g, shear);
        // From outwards and along the circle to x and y.
        jaumann::turned(-along, along, jaumann::shear_stress(g, shear), self.bearing(x0, t))
    }

    /// Acceleration that has to act on the point that was at `x0`, m/s2.
    pub fn acceleration(&self, x0: [f64; 2], t: f64) -> [f64; 2] {
        let (r, w) = (radius(x0), self.angular_frequency);
        if (r - self.radius).abs() >= self.half_width {
            return [0.0; 2];
        }
        let [g, g1, g2] = self.profile(r);
        let (a, rate) = (self.angle * sin(w * t), self.angle * w * cos(w * t) * g);
        let (shear, slope) = (r * a * g1, a * (g1 + r * g2));
        let stiffness = self.elastic.shear() / self.density;
        let outwards = -r * rate * rate + stiffness * (slope * sin(shear) + 2.0 * (1.0 - cos(shear)) / r);
        let along = -r * a * w * w * g - stiffness * (slope * cos(shear) + 2.0 * sin(shear) / r);
        let (c, s) = (cos(self.bearing(x0, t)), sin(self.bearing(x0, t)));
        [c * outwards - s * along, s * outwards + c * along]
    }

    /// g and its first two derivatives.
    fn profile(&self, r: f64) -> [f64; 3] {
        let s = (r - self.radius) / self.half_width;
        let p = 1.0 - s * s;
        if p <= 0.0 {
            return [0.0; 3];
        }
        let b = self.half_width;
        [p * p * p, -6.0 * s * p * p / b, (24.0 * s * s * p - 6.0 * p * p) / (b * b)]
    }

    fn rotation(&self, x0: [f64; 2], t: f64) -> (f64, f64) {
        let a = self.turned(radius(x0), t);
        (cos(a), sin(a))
    }

    /// Direction of the point from the origin, rad.
    fn bearing(&self, x0: [f64; 2], t: f64) -> f64 {
        libm::atan2(x0[1], x0[0]) + self.turned(radius(x0), t)
    }
}

fn radius(x: [f64; 2]) -> f64 {
    (x[0] * x[0] + x[1] * x[1]).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    const VORTEX: Vortex = Vortex {
        elastic: Elastic { young: 1e3, poisson: 0.3 },
        density: 1e3,
        angle: 0.4,
        angular_frequency: 3.0,
        radius: 1.0,
        half_width: 0.5,
    };
    const AT: [[f64; 2]; 3] = [[0.8, 0.3], [-0.5, 0.9], [0.2, -1.2]];

    /// The point that is at `x` at time `t`: turned back by the angle at its radius.
    fn origin_of(x: [f64; 2], t: f64) -> [f64; 2] {
        let a = -VORTEX.turned(radius(x), t);
        [cos(a) * x[0] - sin(a) * x[1], sin(a) * x[0] + cos(a) * x[1]]
    }

    #[test]
    fn momentum_balances_by_finite_differences() {
        let (t, e, dt) = (0.31, 1e-5, 1e-4);
        for x0 in AT {
            let x = VORTEX.position(x0, t);
            let sigma = |dx: f64, dy: f64| VORTEX.stress(origin_of([x[0] + dx, x[1] + dy], t), t);
            let d = |k: usize, along: usize| {
                let (dx, dy) = if along == 0 { (e, 0.0) } else { (0.0, e) };
                (sigma(dx, dy)[k] - sigma(-dx, -dy)[k]) / (2.0 * e)
            };
            let force = [d(0, 0) + d(2, 1), d(2, 0) + d(1, 1)];
            let b = VORTEX.acceleration(x0, t);
            for k in 0..2 {
                let at = |t| VORTEX.position(x0, t)[k];
                let inertia = (at(t + dt) - 2.0 * at(t) + at(t - dt)) / (dt * dt);
                let gap = inertia - force[k] / VORTEX.density - b[k];
                assert!(gap.abs() < 1e-4 * (1.0 + inertia.abs() + b[k].abs()), "{x0:?} {k}: {gap}");
            }
        }
    }

    #[test]
    fn the_stress_follows_the_jaumann_rate() {
        let (t, e, dx) = (0.31, 1e-6, 1e-5);
        for x0 in AT {
            let x = VORTEX.position(x0, t);
            let v = |dx: f64, dy: f64| VORTEX.velocity(origin_of([x[0] + dx, x[1] + dy], t), t);
            let along = |d: usize| {
                let (a, b) = if d == 0 { (v(dx, 0.0), v(-dx, 0.0)) } else { (v(0.0, dx), v(0.0, -dx)) };
                [(a[0] - b[0]) / (2.0 * dx), (a[1] - b[1]) / (2.0 * dx)]
            };
            let (gx, gy) = (along(0), along(1));
            assert!((gx[0] + gy[1]).abs() < 1e-6, "the volume changes");
            let (dxy, w) = (0.5 * (gx[1] + gy[0]), 0.5 * (gx[1] - gy[0]));
            let s = VORTEX.stress(x0, t);
            let two_g = 2.0 * VORTEX.elastic.shear();
            // d sigma/dt = 2 G D + W sigma - sigma W, W the spin, counter-clockwise w.
            let expected =
                [two_g * gx[0] - 2.0 * w * s[2], two_g * gy[1] + 2.0 * w * s[2], two_g * dxy + w * (s[0] - s[1])];
            for (k, expected) in expected.into_iter().enumerate() {
                let rate = (VORTEX.stress(x0, t + e)[k] - VORTEX.stress(x0, t - e)[k]) / (2.0 * e);
                assert!((rate - expected).abs() < 1e-4 * two_g, "{x0:?} {k}: {rate} {expected}");
            }
        }
    }

    #[test]
    fn velocity_is_the_rate_of_the_position_and_nothing_moves_outside() {
        let (t, e) = (0.31, 1e-6);
        for x0 in AT {
            for k in 0..2 {
                let rate = (VORTEX.position(x0, t + e)[k] - VORTEX.position(x0, t - e)[k]) / (2.0 * e);
                assert!((rate - VORTEX.velocity(x0, t)[k]).abs() < 1e-8);
            }
        }
        for x0 in [[0.1, 0.2], [1.2, 1.1], [0.0, 0.0]] {
            assert_eq!(VORTEX.position(x0, t), x0);
            assert_eq!(VORTEX.acceleration(x0, t), [0.0; 2]);
        }
        // 6 s (1 - s^2)^2 has its largest value near s = 1/sqrt(5): 1.717, over half the width, times a radius near 1 there.
        let largest = VORTEX.largest_shear() / VORTEX.angle;
        assert!((3.4..4.4).contains(&largest), "{largest}");
    }
}
