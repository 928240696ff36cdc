//! What must hold in all runs of the study.

use super::{Analysis, Point};
use crate::balances::Balances;
use crate::runs::Run;
use checkdam::check::{Check, Expected, Kind};

/// Spearman's rank correlation of values with their places; without ties.
pub fn rank_correlation(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let rank = |v: f64| values.iter().filter(|w| **w < v).count() as f64;
    let squares: f64 = values.iter().enumerate().map(|(k, v)| (rank(*v) - k as f64) * (rank(*v) - k as f64)).sum();
    1.0 - 6.0 * squares / (n * (n * n - 1.0))
}

/// The checks of runs on cells of this size, m.
pub(super) fn checks(analysis: &Analysis, cell: f64) -> Vec<Check> {
    let all: Vec<&Run> = analysis.releases.iter().flat_map(|(_, points)| points.iter().map(|p| &p.run)).collect();
    let mut checks = Balances::over(all.iter().copied(), |_| cell).checks("", "ledgers and gauges of all runs");
    for (release, points) in &analysis.releases {
        let at = |p: &Point| p.run.get("front_velocity_m_per_s");
        let (low, high) =
            points.iter().map(at).fold((f64::INFINITY, 0.0), |(a, b): (f64, f64), x| (a.min(x), b.max(x)));
        checks.push(
            Check::at_most(
                format!("{release}: spread of the front's velocity at 0.7 m over all barriers"),
                1.0 - low / high,
                0.01,
                "1",
            )
            .because("the barrier cannot be felt before the arrival; time steps differ")
            .from(Kind::Analytic, "causality"),
        );
        let peaks: Vec<f64> = points.iter().map(|p| p.peaks.mean).collect();
        checks.push(
            Check::new(
                format!("{release}: rank correlation of peak force and rigidity"),
                rank_correlation(&peaks),
                Expected::AtLeast(0.9),
                "1",
            )
            .because("stiff barriers differ by less than single runs scatter, so that neighbours may change places")
            .from(Kind::Published, "Ng et al., Fig. 6: the impact coefficient grows with rigidity"),
        );
    }
    checks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_follow_the_order() {
        assert_eq!(rank_correlation(&[1.0, 2.0, 5.0]), 1.0);
        assert_eq!(rank_correlation(&[5.0, 2.0, 1.0]), -1.0);
        // 1 - 6 x 2 / (3 x 8).
        assert_eq!(rank_correlation(&[2.0, 1.0, 5.0]), 0.5);
    }
}
