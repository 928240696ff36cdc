//! A uniform layer that flows along a plane.
//!
//! With the depth z below its free surface and the slope theta, equilibrium across the bed gives sigma_yy = -rho g z cos(theta), and steady
//! flow along it tau = rho g z sin(theta) (infinite slope). Where the stress goes with the square of the shear rate, the velocity falls from
//! the surface to the bed as 1 - (1 - y/d)^(3/2) (Bagnold 1954; Silbert et al. 2001).

/// Pressure across the bed at the depth `z` (m) below the surface, Pa.
pub fn pressure(density: f64, gravity: f64, slope: f64, z: f64) -> f64 {
    density * gravity * libm::cos(slope) * z
}

/// Shear stress of steady flow at the depth `z` (m) below the surface, Pa.
pub fn shear(density: f64, gravity: f64, slope: f64, z: f64) -> f64 {
    density * gravity * libm::sin(slope) * z
}

/// Mass that passes a section of the depth `depth` (m) and the width `width` (m) in `time` seconds at the mean velocity `velocity` (m/s), kg.
pub fn mass(density: f64, depth: f64, width: f64, velocity: f64, time: f64) -> f64 {
    density * depth * width * velocity * time
}

/// Pressure along the bed over that across it in a cohesionless layer about to spread, with the angle of friction `phi` (rad) and the shear
/// stress `shear` times the pressure across the bed: Rankine's active state on a slope, as Savage and Hutter (1989) use it.
pub fn active_ratio(phi: f64, shear: f64) -> f64 {
    let cosine = libm::cos(phi) * libm::cos(phi);
    2.0 / cosine * (1.0 - (1.0 - cosine * (1.0 + shear * shear)).sqrt()) - 1.0
}

/// Velocity over its mean at a share of the depth from the bed up, of Bagnold's profile.
pub fn bagnold(share: f64) -> f64 {
    5.0 / 3.0 * (1.0 - libm::pow(1.0 - share, 1.5))
}

/// Mean square of the velocity over the square of its mean of a profile that grows in proportion to the height above the bed.
pub const LINEAR_MOMENTUM: f64 = 4.0 / 3.0;
/// The same of Bagnold's profile.
pub const BAGNOLD_MOMENTUM: f64 = 5.0 / 4.0;

#[cfg(test)]
mod tests {
    use super::*;

    /// Means over the depth by the midpoint rule.
    #[test]
    fn profiles_have_their_means() {
        let mean = |f: &dyn Fn(f64) -> f64| (0..10_000).map(|k| f((f64::from(k) + 0.5) / 1e4)).sum::<f64>() / 1e4;
        assert!((mean(&bagnold) - 1.0).abs() < 1e-6);
        assert!((mean(&|s| bagnold(s) * bagnold(s)) - BAGNOLD_MOMENTUM).abs() < 1e-6);
        assert!((mean(&|s| 4.0 * s * s) - LINEAR_MOMENTUM).abs() < 1e-6);
    }

    /// On a level bed Rankine's (1 - sin) / (1 + sin); at the angle of friction 1 + 2 tan^2, where both states meet.
    #[test]
    fn the_active_state_is_that_of_rankine() {
        let phi = 35f64.to_radians();
        let (sine, tangent) = (libm::sin(phi), libm::tan(phi));
        assert!((active_ratio(phi, 0.0) - (1.0 - sine) / (1.0 + sine)).abs() < 1e-12);
        assert!((active_ratio(phi, tangent * (1.0 - 1e-15)) - (1.0 + 2.0 * tangent * tangent)).abs() < 1e-6);
    }

    /// A metre of sand of 1500 kg/m3 on 30 degrees: 1500 x 9.81 x 0.8660254 and x 0.5 Pa.
    #[test]
    fn a_layer_carries_its_weight() {
        let slope = 30f64.to_radians();
        assert!((pressure(1500.0, 9.81, slope, 1.0) - 12_743.563_9).abs() < 1e-3);
        assert!((shear(1500.0, 9.81, slope, 1.0) - 7357.5).abs() < 1e-9);
        assert_eq!(mass(1500.0, 3.0, 8.0, 10.0, 20.0), 7.2e6);
    }
}
