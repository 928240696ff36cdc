//! A rigid square block that slides without friction down a parabola, y = k x^2, with both lower corners on it.
//!
//! With the middle of its base over x = m, its corners lie at m - w and m + w, and the base has the slope 2 k m. So the block has one degree
//! of freedom, and energy alone gives its speed. It turns as it slides: its moment of inertia about the centre is M s^2/6.

/// A block on a parabola.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bowl {
    /// Curvature constant k of y = k x^2, 1/m.
    pub curvature: f64,
    /// Side of the block, m.
    pub side: f64,
    /// Gravity along -y, m/s2.
    pub gravity: f64,
}

impl Bowl {
    /// Angle of the base against x (rad) where its middle is over `m` (m).
    pub fn angle(&self, m: f64) -> f64 {
        libm::atan(2.0 * self.curvature * m)
    }

    /// Centre of the block where the middle of its base is over `m`, m.
    pub fn centre(&self, m: f64) -> [f64; 2] {
        let (k, s) = (self.curvature, self.side);
        let r = self.stretch(m);
        // Half of the base along x: both corners are on the curve.
        let w = 0.5 * s / r;
        [m - s * k * m / r, k * (m * m + w * w) + 0.5 * s / r]
    }

    /// Velocity of the centre (m/s) over `m` after a start from rest over `from`, towards growing x; zero where it cannot be.
    pub fn velocity(&self, from: f64, m: f64) -> [f64; 2] {
        let (k, s) = (self.curvature, self.side);
        let r = self.stretch(m);
        // Derivatives of centre and angle with respect to m.
        let x = 1.0 - s * k / (r * r * r);
        let y = 2.0 * k * m - 2.0 * s * s * k * k * k * m / (r * r * r * r) - 2.0 * s * k * k * m / (r * r * r);
        let turn = 2.0 * k / (r * r);
        let fall = self.centre(from)[1] - self.centre(m)[1];
        let rate = (2.0 * self.gravity * fall.max(0.0) / (x * x + y * y + s * s * turn * turn / 6.0)).sqrt();
        [x * rate, y * rate]
    }

    /// Where the middle of the base is when the centre is over `x`, m; bisection.
    pub fn base_over(&self, x: f64) -> f64 {
        let (mut low, mut high) = (x - self.side, x + self.side);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.centre(middle)[0] < x {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }

    fn stretch(&self, m: f64) -> f64 {
        (1.0 + 4.0 * self.curvature * self.curvature * m * m).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_block_is_a_point() {
        let bowl = Bowl { curvature: 1.0, side: 1e-6, gravity: 9.81 };
        let [vx, vy] = bowl.velocity(-1.0, 0.0);
        assert!((vx - (2.0f64 * 9.81).sqrt()).abs() < 1e-5 && vy.abs() < 1e-12);
        // Half way down, at y = 1/2: the velocity follows the tangent.
        let m = -(0.5f64.sqrt());
        let [vx, vy] = bowl.velocity(-1.0, m);
        assert!((vx.hypot(vy) - 9.81f64.sqrt()).abs() < 1e-5 && (vy / vx - 2.0 * m).abs() < 1e-5);
    }

    #[test]
    fn corners_are_on_the_curve_and_velocities_are_those_of_the_path() {
        let bowl = Bowl { curvature: 0.8, side: 0.2, gravity: 9.81 };
        for m in [-1.1f64, -0.4, 0.0, 0.7] {
            let ([x, y], angle) = (bowl.centre(m), bowl.angle(m));
            let (c, s) = (libm::cos(angle), libm::sin(angle));
            for along in [-0.1, 0.1] {
                let corner = [x + c * along + s * 0.1, y + s * along - c * 0.1];
                assert!((corner[1] - 0.8 * corner[0] * corner[0]).abs() < 1e-12, "{m}: {corner:?}");
            }
            assert!((bowl.base_over(x) - m).abs() < 1e-12);
            let (d, v) = (1e-5, bowl.velocity(-1.5, m));
            let (a, b) = (bowl.centre(m - d), bowl.centre(m + d));
            assert!(((b[1] - a[1]) / (b[0] - a[0]) - v[1] / v[0]).abs() < 1e-7, "{m}");
            // Energy, with what turns: the angle's rate by differences.
            let rate = v[0] / ((b[0] - a[0]) / (2.0 * d));
            let turn = (bowl.angle(m + d) - bowl.angle(m - d)) / (2.0 * d) * rate;
            let kinetic = 0.5 * (v[0] * v[0] + v[1] * v[1] + 0.04 / 6.0 * turn * turn);
            let fall = 9.81 * (bowl.centre(-1.5)[1] - y);
            assert!((kinetic / fall - 1.0).abs() < 1e-8, "{m}");
        }
    }
}
