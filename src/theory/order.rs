//! Observed order of convergence and what it says about the error (Roache 1994; Celik et al. 2008).
//!
//! Elsewhere: Richardson extrapolation, grid convergence index (GCI).

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

/// How values change from grid to grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Trend {
    /// By less and less, in one direction.
    Monotone,
    /// In one direction and then in the other.
    Oscillatory,
    /// By more and more.
    Diverging,
    /// Not at all.
    Constant,
}

impl Trend {
    /// Name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Trend::Monotone => "monotone",
            Trend::Oscillatory => "oscillatory",
            Trend::Diverging => "diverging",
            Trend::Constant => "constant",
        }
    }
}

/// What values on three grids say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Study {
    /// How they change; only monotone ones have the rest, which is NaN otherwise.
    pub trend: Trend,
    /// Observed order.
    pub order: f64,
    /// Value at zero spacing.
    pub extrapolated: f64,
    /// Grid convergence index of the medium and of the fine value, relative.
    pub index: [f64; 2],
}

impl Study {
    /// Values and spacings from coarse to fine; the ratios of the spacings need not be equal (Celik et al. 2008).
    pub fn new(values: [f64; 3], spacings: [f64; 3]) -> Self {
        let [coarse, medium, fine] = values;
        let (r32, r21) = (spacings[0] / spacings[1], spacings[1] / spacings[2]);
        let (e32, e21) = (coarse - medium, medium - fine);
        let none = |trend| Self { trend, order: f64::NAN, extrapolated: f64::NAN, index: [f64::NAN; 2] };
        if e21 == 0.0 {
            return none(Trend::Constant);
        }
        if e32 / e21 < 0.0 {
            return none(Trend::Oscillatory);
        }
        let mut order = 0.0;
        let mut q = 0.0;
        for _ in 0..200 {
            order = (log(e32 / e21) + q) / log(r21);
            // As equal ratios to start with, and in the limit of order 0.
            q = if order.abs() > 1e-9 {
                log((pow(r21, order) - 1.0) / (pow(r32, order) - 1.0))
            } else {
                log(log(r21) / log(r32))
            };
        }
        // Also NaN, where the iteration finds none.
        if order.is_nan() || order <= 0.0 {
            return none(Trend::Diverging);
        }
        let index = |coarse: f64, fine: f64, ratio| grid_convergence_index(coarse, fine, ratio, order);
        Self {
            trend: Trend::Monotone,
            order,
            extrapolated: extrapolated(medium, fine, r21, order),
            index: [index(coarse, medium, r32), index(medium, fine, r21)],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_published_study() {
        let s = Study::new([0.96178, 0.96854, 0.97050], [4.0, 2.0, 1.0]);
        assert_eq!(s.trend, Trend::Monotone);
        assert!((s.order - 1.78617).abs() < 1e-5);
        assert!((s.extrapolated - 0.97130).abs() < 1e-5);
        assert!((s.index[1] - 1.031e-3).abs() < 1e-6 && (s.index[0] - 3.562e-3).abs() < 1e-6);
    }

    #[test]
    fn unequal_ratios() {
        for p in [0.7, 1.0, 2.0, 3.0] {
            let f = |h: f64| 5.0 - 0.3 * pow(h, p);
            let h = [0.04, 0.02, 0.04 / 3.0];
            let s = Study::new(h.map(f), h);
            assert!((s.order - p).abs() < 1e-6, "{} instead of {p}", s.order);
            assert!((s.extrapolated - 5.0).abs() < 1e-9);
        }
    }

    #[test]
    fn what_has_no_order_gets_none() {
        for (values, trend) in [
            ([1.0, 2.0, 1.5], Trend::Oscillatory),
            ([1.0, 1.1, 1.5], Trend::Diverging),
            ([1.0, 1.5, 1.5], Trend::Constant),
        ] {
            let s = Study::new(values, [4.0, 2.0, 1.0]);
            assert_eq!(s.trend, trend);
            assert!(s.order.is_nan());
        }
    }

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
