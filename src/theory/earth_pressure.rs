//! Earth pressure coefficients and forces. Horizontal over vertical stress, compression positive.

use libm::{cos, sin};

/// Coefficient at rest of normally consolidated soil, 1 - sin(phi) (Jaky 1944). `friction_angle` in rad.
pub fn jaky(friction_angle: f64) -> f64 {
    1.0 - sin(friction_angle)
}

/// Active coefficient of a smooth vertical wall and level fill (Rankine 1857).
pub fn rankine_active(friction_angle: f64) -> f64 {
    (1.0 - sin(friction_angle)) / (1.0 + sin(friction_angle))
}

/// Passive coefficient of a smooth vertical wall and level fill (Rankine 1857).
pub fn rankine_passive(friction_angle: f64) -> f64 {
    1.0 / rankine_active(friction_angle)
}

/// A wall and its fill, in the notation of Coulomb (1776) and Mueller-Breslau (1906); all in rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wall {
    /// Friction angle of the fill.
    pub friction_angle: f64,
    /// Friction angle of the wall.
    pub wall_friction_angle: f64,
    /// Batter of the wall's face from the vertical.
    pub batter: f64,
    /// Slope of the fill's surface.
    pub surface_slope: f64,
}

impl Wall {
    /// Active coefficient of the thrust, which acts at the wall friction angle from the face's normal (Coulomb 1776).
    pub fn coulomb_active(&self) -> f64 {
        self.coefficient(1.0)
    }

    /// Passive coefficient of the thrust; an upper bound, far too high where wall friction exceeds half the fill's.
    pub fn coulomb_passive(&self) -> f64 {
        self.coefficient(-1.0)
    }

    /// Inclination of the plane on which the wedge of the active thrust slides, against the horizontal, rad, for a vertical
    /// face and a level surface: tan(w - phi) = (sqrt(t (t + c) (1 + d c)) - t) / (1 + d (t + c)) with t = tan(phi),
    /// c = 1/t, d = tan(delta) (Mueller-Breslau 1906).
    pub fn active_plane(&self) -> f64 {
        let (t, d) = (libm::tan(self.friction_angle), libm::tan(self.wall_friction_angle));
        let c = 1.0 / t;
        self.friction_angle + libm::atan(((t * (t + c) * (1.0 + d * c)).sqrt() - t) / (1.0 + d * (t + c)))
    }

    fn coefficient(&self, sign: f64) -> f64 {
        let Self { friction_angle: phi, wall_friction_angle: delta, batter: a, surface_slope: b } = *self;
        let root = sin(phi + delta) * sin(phi - sign * b) / (cos(a + sign * delta) * cos(a - b));
        let bracket = 1.0 + sign * root.sqrt();
        let numerator = cos(phi - sign * a);
        numerator * numerator / (cos(a) * cos(a) * cos(a + sign * delta) * bracket * bracket)
    }
}

/// Force on a wall of `height` (m) from pressure that grows linearly with depth, K rho g H^2 / 2, N per metre of width.
pub fn triangular_force(coefficient: f64, density: f64, gravity: f64, height: f64) -> f64 {
    0.5 * coefficient * density * gravity * height * height
}

/// Where that force acts above the foot, H/3, m.
pub fn triangular_arm(height: f64) -> f64 {
    height / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_coefficients() {
        let phi = 31f64.to_radians();
        let wall = Wall { friction_angle: phi, wall_friction_angle: libm::atan(0.4), batter: 0.0, surface_slope: 0.0 };
        assert!((wall.coulomb_active() - 0.2855).abs() < 5e-5);
        assert!((wall.coulomb_passive() - 7.040).abs() < 5e-4);
        assert!((wall.coulomb_active() * cos(libm::atan(0.4)) - 0.2651).abs() < 5e-5);
        assert!((jaky(phi) - 0.48496).abs() < 5e-6);
        assert!((rankine_active(phi) - 0.3201).abs() < 5e-5);
    }

    #[test]
    fn the_plane_of_the_wedge_has_the_largest_thrust() {
        for (phi, delta) in [(31f64, 0f64), (31.0, 21.8), (40.0, 15.0)] {
            let (phi, delta) = (phi.to_radians(), delta.to_radians());
            let wall = Wall { friction_angle: phi, wall_friction_angle: delta, batter: 0.0, surface_slope: 0.0 };
            // Thrust over rho g H^2 / 2 of a wedge whose plane is inclined by w: cot(w) sin(w - phi) / cos(w - phi - delta).
            let thrust = |w: f64| sin(w - phi) / (libm::tan(w) * cos(w - phi - delta));
            let best = wall.active_plane();
            assert!((thrust(best) - wall.coulomb_active()).abs() < 1e-12);
            assert!(thrust(best) > thrust(best + 1e-3) && thrust(best) > thrust(best - 1e-3));
            if delta == 0.0 {
                assert!((best.to_degrees() - 60.5).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn coulomb_without_wall_friction_is_rankine() {
        for degrees in [10f64, 31.0, 45.0] {
            let phi = degrees.to_radians();
            let wall = Wall { friction_angle: phi, wall_friction_angle: 0.0, batter: 0.0, surface_slope: 0.0 };
            assert!((wall.coulomb_active() - rankine_active(phi)).abs() < 1e-12);
            assert!((wall.coulomb_passive() / rankine_passive(phi) - 1.0).abs() < 1e-12);
        }
    }
}
