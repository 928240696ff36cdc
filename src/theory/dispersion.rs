//! How fast a wave runs on the grid of the material point method.
//!
//! With two points a cell and direction at their rest positions, linear or uGIMP functions give the strain of a cell from its
//! two nodes, as finite elements do. A velocity passes once from points to nodes before it strains the material, and an
//! acceleration once from nodes to points, each at the cost of [`mapping_factor`]; lumped masses do the rest (derived here).

use super::pic::mapping_factor;
use libm::{asin, sin};

/// Angular frequency over k c of a wave on the grid: `kh` is wave number times cell size, `courant` c dt/h of a scheme in which
/// velocity and stress leapfrog. Two points a cell and direction.
pub fn frequency_ratio(kh: f64, courant: f64) -> f64 {
    let grid = 2.0 * sin(0.5 * kh) * mapping_factor(kh, 2);
    2.0 * asin(0.5 * courant * grid) / (courant * kh)
}

/// Speed at which a Gaussian pulse of standard deviation `width` cells travels, over c: the mean of the group velocity over the
/// energy of the pulse, which is Gaussian in k with the standard deviation 1/(sqrt(2) width).
pub fn pulse_speed_ratio(width: f64, courant: f64) -> f64 {
    let steps = 4000;
    let top = (6.0 / (2f64.sqrt() * width)).min(3.0);
    let (mut sum, mut weights) = (0.0, 0.0);
    for i in 0..steps {
        let kh = (f64::from(i) + 0.5) * top / f64::from(steps);
        let weight = libm::exp(-kh * kh * width * width);
        let e = 1e-5;
        let omega = |kh: f64| kh * frequency_ratio(kh, courant);
        sum += weight * (omega(kh + e) - omega(kh - e)) / (2.0 * e);
        weights += weight;
    }
    sum / weights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_waves_lag_by_thirteen_percent_of_kh_squared() {
        // 1/24 from the grid and C/2 = 0.09375 from the mapping, less courant^2/24 of the time step.
        let (kh, courant) = (0.01, 0.4);
        let lag = (1.0 - frequency_ratio(kh, courant)) / (kh * kh);
        assert!((lag - (1.0 / 24.0 + 0.09375 - 0.16 / 24.0)).abs() < 1e-4, "{lag}");
    }

    #[test]
    fn wide_pulses_lag_three_times_as_much_at_their_mean_wave_number() {
        let (width, courant) = (40.0, 0.4);
        let lag = 1.0 - pulse_speed_ratio(width, courant);
        let expected = 3.0 * (1.0 / 24.0 + 0.09375 - 0.16 / 24.0) / (2.0 * width * width);
        assert!((lag / expected - 1.0).abs() < 0.01, "{lag} {expected}");
    }
}
