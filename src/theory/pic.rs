//! What a share of PIC does to a smooth velocity field.
//!
//! A wave of velocity mapped from points to nodes and back loses the factor T(k h) of its amplitude. In each step a share
//! `a` of PIC therefore takes the share a (1 - T) in one mapping to the nodes of points that lie evenly, which acts as a
//! viscosity on long waves. Both follow from the mapping of exp(i k x) by hat or uGIMP functions at the points' rest
//! positions (derived here; cf. Nairn 2015 on PIC damping).

use libm::cos;

/// Factor T that mapping to the nodes leaves of the amplitude of a wave exp(i k x): the mean over the points of a cell of
/// (1 - u) cos(k h u) + u cos(k h (1 - u)), where u is their place in the cell. `kh` is the wave number times the cell size.
pub fn mapping_factor(kh: f64, points_per_direction: u32) -> f64 {
    let n = f64::from(points_per_direction);
    let sum: f64 = (0..points_per_direction)
        .map(|i| {
            let u = (f64::from(i) + 0.5) / n;
            (1.0 - u) * cos(kh * u) + u * cos(kh * (1.0 - u))
        })
        .sum();
    sum / n
}

/// Constant C of the viscosity, 1/6 + 1/(12 n^2) for n points a cell and direction.
pub fn viscosity_constant(points_per_direction: u32) -> f64 {
    let n = f64::from(points_per_direction);
    1.0 / 6.0 + 1.0 / (12.0 * n * n)
}

/// Numerical viscosity C a h^2 / dt of the share `a` of PIC, m2/s.
pub fn numerical_viscosity(share: f64, spacing: f64, dt: f64, points_per_direction: u32) -> f64 {
    viscosity_constant(points_per_direction) * share * spacing * spacing / dt
}

/// Rate (1/s) at which the share `a` of PIC damps the velocity of a wave: a (1 - T^2) / dt, where the way to the nodes and back
/// costs T twice. A standing wave's energy decays at the same rate, since half of it is kinetic.
pub fn damping_rate(share: f64, kh: f64, dt: f64, points_per_direction: u32) -> f64 {
    let t = mapping_factor(kh, points_per_direction);
    share * (1.0 - t * t) / dt
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_by_points_per_cell() {
        for (n, c) in [(1, 0.25), (2, 0.1875), (3, 0.1759), (4, 0.1719)] {
            assert!((viscosity_constant(n) - c).abs() < 5e-5);
        }
        // Two points: T = 3/4 cos(kh/4) + 1/4 cos(3 kh/4).
        let kh = 0.5;
        assert!((mapping_factor(kh, 2) - (0.75 * cos(kh / 4.0) + 0.25 * cos(0.75 * kh))).abs() < 1e-15);
    }

    #[test]
    fn long_waves_see_the_viscosity() {
        for n in 1..=4 {
            let (a, h, dt, kh) = (0.01, 0.02, 1e-4, 1e-3);
            let k = kh / h;
            let viscous = numerical_viscosity(a, h, dt, n) * k * k;
            assert!((damping_rate(a, kh, dt, n) / viscous - 1.0).abs() < 1e-5, "{n} points");
        }
    }
}
