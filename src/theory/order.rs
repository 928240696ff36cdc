//! Observed order of convergence and what it says about the error (Roache 1994; Celik et al. 2008).

use libm::{log, pow};

/// Order from two errors on grids whose spacings differ by `ratio` (coarse over fine).
pub fn from_errors(coarse: f64, fine: f64, ratio: f64) -> f64 {
    log(coarse / fine) / log(ratio)
}

/// Order from three values, coarse to fine, of a constant `ratio`, without an exact one. NaN where they do not approach
/// monotonically.
pub fn from_values(coarse: f64, medium: f64, fine: f64, ratio: f64) -> f64 {
    log((coarse - medium) / (medium - fine)) / log(ratio)
}

/// Richardson's extrapolation to zero spacing.
pub fn extrapolated(medium: f64, fine: f64, ratio: f64, order: f64) -> f64 {
    fine + (fine - medium) / (pow(ratio, order) - 1.0)
}

/// Grid convergence index of the fine value, relative, with the factor of safety 1.25 for three grids (Roache 1994).
pub fn grid_convergence_index(medium: f64, fine: f64, ratio: f64, order: f64) -> f64 {
    1.25 * ((medium - fine) / fine).abs() / (pow(ratio, order) - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_published_example() {
        let (fine, medium, coarse) = (0.97050, 0.96854, 0.96178);
        let p = from_values(coarse, medium, fine, 2.0);
        assert!((p - 1.78617).abs() < 1e-5);
        assert!((extrapolated(medium, fine, 2.0, p) - 0.97130).abs() < 1e-5);
        assert!((grid_convergence_index(medium, fine, 2.0, p) - 1.031e-3).abs() < 1e-6);
    }

    #[test]
    fn errors_that_quarter_are_second_order() {
        assert!((from_errors(4e-3, 1e-3, 2.0) - 2.0).abs() < 1e-12);
        assert!(from_values(1.0, 2.0, 1.5, 2.0).is_nan());
    }
}
