//! What must hold in any run of the barrier: momentum and energy add up, the barrier's forces are in balance, nothing passes through.

use crate::runs::Run;
use checkdam::check::{Check, Kind};
use checkdam::run::Summary;
use checkdam::run::structure::TORN;

/// Share of the energy at release that may remain unaccounted for.
pub const ENERGY: f64 = 0.02;

/// The largest of each over a run or many; a number that is none fails.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Balances {
    /// Momentum not accounted for over the sum of the magnitudes of all impulses.
    pub momentum: f64,
    /// Energy not accounted for over that at release, magnitude.
    pub energy: f64,
    /// Depth to which material has entered a boundary or a body, cells.
    pub penetration: f64,
    /// Where the barrier is a body: contact less clamp and inertia over their sum.
    pub imbalance: Option<f64>,
    /// Where the barrier is a body that must not tear: widest gap between its points, cells.
    pub gap: Option<f64>,
}

impl Balances {
    /// Of one run; `imbalance` as it was seen.
    pub fn of(summary: &Summary, imbalance: Option<f64>) -> Self {
        Self {
            momentum: summary.momentum.momentum_closure_1,
            energy: summary.energy.energy_residual_1,
            penetration: summary.momentum.penetration_m / summary.case.grid.spacing_m,
            imbalance,
            gap: summary.structure.as_ref().map(|s| s.gap_cells),
        }
    }

    /// Of many runs against barriers that are bodies, on cells of this size, m.
    pub fn over<'a>(runs: impl Iterator<Item = &'a Run> + Clone, cell: impl Fn(&Run) -> f64) -> Self {
        let worst = |name: &str| largest(runs.clone().map(|r| r.get(name)));
        Self {
            momentum: worst("momentum_closure_1"),
            energy: worst("energy_residual_1"),
            penetration: largest(runs.clone().map(|r| r.get("penetration_m") / cell(r))),
            imbalance: Some(worst("imbalance_1")),
            gap: Some(worst("gap_cells")),
        }
    }

    /// The checks, told apart by what stands before them.
    pub fn checks(&self, before: &str, source: &str) -> Vec<Check> {
        let mut checks = vec![
            bound(
                format!("{before}momentum not accounted for over the sum of impulses, largest"),
                self.momentum,
                1e-10,
                "round-off of sums",
            ),
            energy(before, self.energy),
            bound(
                format!("{before}deepest penetration / cell size"),
                self.penetration,
                1.0,
                "walls and contacts act on nodes; a point within a cell of the face is pushed back",
            ),
        ];
        checks.extend(self.imbalance.map(|x| {
            bound(
                format!("{before}contact less clamp and inertia over their sum, largest of all samples"),
                x,
                1e-9,
                "round-off of sums: two readings of one force at every moment",
            )
        }));
        checks.extend(self.gap.map(|x| {
            bound(
                format!("{before}widest gap in the barrier, cells"),
                x,
                TORN,
                "half a spacing of four points a cell: torn",
            )
        }));
        checks.into_iter().map(|c| c.from(Kind::Conservation, source)).collect()
    }
}

/// The check of the energy alone, still without its source.
pub fn energy(before: &str, largest: f64) -> Check {
    bound(
        format!("{before}energy not accounted for over E0, largest"),
        largest,
        ENERGY,
        "second-order terms of the transfers; 2 % is where forces would begin to suffer",
    )
}

fn bound(what: String, measured: f64, limit: f64, reason: &str) -> Check {
    Check::at_most(what, measured, limit, "1").because(reason)
}

/// Largest magnitude; NaN if one is.
pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |a, x| if x.is_nan() || a.is_nan() { f64::NAN } else { x.abs().max(a) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_balance_has_its_bound() {
        let good =
            Balances { momentum: 1e-12, energy: 0.019, penetration: 0.9, imbalance: Some(1e-12), gap: Some(0.2) };
        let failing = |b: Balances| b.checks("x: ", "a run").iter().filter(|c| c.share_used() > 1.0).count();
        assert_eq!((good.checks("x: ", "a run").len(), failing(good)), (5, 0));
        assert_eq!(failing(Balances { momentum: 2e-10, ..good }), 1);
        assert_eq!(failing(Balances { energy: 0.021, ..good }), 1);
        assert_eq!(failing(Balances { penetration: 1.1, ..good }), 1);
        assert_eq!(failing(Balances { imbalance: Some(2e-9), ..good }), 1);
        assert_eq!(failing(Balances { gap: Some(0.26), ..good }), 1);
        assert!(largest([1.0, f64::NAN, 0.0]).is_nan() && largest([-3.0, 2.0]) == 3.0);
    }
}
