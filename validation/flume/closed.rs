//! What the flume reports of the force on its barrier, against the ledger of momentum and against itself. These are closed balances, which
//! need no repetitions. They see a percent of a force, of a moment and of an impulse. Of a shear that is small they see a thousandth of the
//! force, which is 23 % of it at 23 degrees. It is bookkeeping, no physics: both read what the boundary did.
//!
//! The ledger books what the boundary did to the material, step by step; the gauge turns it into normal, tangential and moment, and
//! `run` into rows, means and sums. Both meet here again.

use crate::case_run::CaseRun;
use checkdam::check::{Check, Expected, Kind, Tolerance};
use checkdam::run::records::{HistoryRow, MomentumRow};

/// Length of the means behind static values, s.
const STATIC: f64 = 0.3;
/// Length of the mean behind the peak, s.
const PEAK: f64 = 0.02;
/// After the arrival the impulse is taken over this time, s.
const IMPACT: f64 = 0.5;

/// What the barrier with this index took until a row of the ledger: normal (N s), tangential (N s), moment (N m s).
type Taken<'a> = &'a dyn Fn(&MomentumRow) -> [f64; 3];

/// The checks.
pub fn checks(flume: &CaseRun) -> Vec<Check> {
    let CaseRun { name, experiment, records, summary } = flume;
    let (Some(barrier), Some(gauge)) = (&summary.barrier, experiment.barrier().and_then(|g| g.boundary())) else {
        return vec![missing(name)];
    };
    let wall = &experiment.simulation().boundaries()[gauge];
    let (n, t) = (wall.normal, wall.tangent);
    // A push of the material against the normal turns the wall over.
    let turn = t.x * n.y - t.y * n.x;
    let taken = |row: &MomentumRow| {
        let tally = &row.ledger.boundaries[gauge];
        let [x, y] = tally.impulse;
        [n.x * x + n.y * y, -(t.x * x + t.y * y), turn * tally.moment]
    };
    let mut checks = at_rest(
        name,
        &records.momentum,
        &taken,
        [
            ("static force", barrier.static_force_n, "N"),
            ("static shear", barrier.static_shear_n, "N"),
            ("static moment", barrier.static_moment_n_m, "N m"),
        ],
    );
    let arrival = barrier.arrival_s.unwrap_or(f64::NAN);
    let impulse = impulse(name, &records.momentum, &taken, arrival, barrier.impulse_half_second_n_s);
    checks.push(impulse.unwrap_or_else(|| missing(name)));
    checks.extend(peaks(name, &records.history, barrier.peak_20ms_n, barrier.peak_20ms_by_steps_n));
    checks
}

/// What fails where there is nothing to compare.
fn missing(name: &str) -> Check {
    Check::value(format!("{name}: what its barrier took, and when"), f64::NAN, 0.0, "1")
        .within(Tolerance::Absolute(0.0), "a run of the flume has a barrier, a ledger and an arrival")
        .from(Kind::Conservation, "the momentum ledger")
}

fn at_rest(name: &str, ledger: &[MomentumRow], taken: Taken, found: [(&str, f64, &'static str); 3]) -> Vec<Check> {
    let end = ledger.last().and_then(|end| Some((end, ledger.iter().find(|r| r.time >= end.time - STATIC)?)));
    let Some((end, start)) = end else { return vec![missing(name)] };
    let (last, first, duration) = (taken(end), taken(start), end.time - start.time);
    let means = [0, 1, 2].map(|k| (last[k] - first[k]) / duration);
    // A shear that is small beside the force is known as well as a thousandth of that.
    let least = [0.0, 1e-3 * means[0].abs(), 0.0];
    let checks = found.into_iter().zip(means).zip(least).map(|(((what, value, unit), mean), least)| {
        Check::value(format!("{name}: {what} and what the ledger has of the last 0.3 s"), value, mean, unit)
            .within(
                Tolerance::Absolute(0.01 * mean.abs() + least),
                "at rest the means of three windows are within 1 %; the ledger's rows begin up to 10 ms later",
            )
            .from(Kind::Conservation, "impulse and moment of the barrier in the momentum ledger")
    });
    checks.collect()
}

fn impulse(name: &str, ledger: &[MomentumRow], taken: Taken, arrival: f64, found: f64) -> Option<Check> {
    // Until a time, linear between the rows of the ledger, and half of what came between these rows.
    let until = |time: f64| {
        let pair = ledger.windows(2).find(|p| p[1].time >= time)?;
        let [before, after] = [taken(&pair[0])[0], taken(&pair[1])[0]];
        let share = (time - pair[0].time) / (pair[1].time - pair[0].time);
        Some((before + share * (after - before), 0.5 * (after - before).abs()))
    };
    let ((from, first), (to, last)) = (until(arrival)?, until(arrival + IMPACT)?);
    Some(
        Check::value(
            format!("{name}: impulse in 0.5 s after the arrival and what the ledger has of it"),
            found,
            to - from,
            "N s",
        )
        .within(Tolerance::Absolute(first + last), "half of what comes between two rows of the ledger, at either end")
        .from(Kind::Conservation, "impulse of the barrier in the momentum ledger"),
    )
}

fn peaks(name: &str, history: &[HistoryRow], by_rows: f64, by_steps: f64) -> [Check; 2] {
    // Impulse until the end of each row; linear within a row.
    let (mut ends, mut sum) = (vec![[0.0; 2]], 0.0);
    for row in history {
        sum += row.normal * (row.time - ends[ends.len() - 1][0]);
        ends.push([row.time, sum]);
    }
    let mut first = 0;
    let whole = ends.iter().filter(|end| end[0] >= PEAK).map(|&[time, sum]| {
        let from = time - PEAK;
        while first + 2 < ends.len() && ends[first + 1][0] <= from {
            first += 1;
        }
        let [[a, p], [b, q]] = [ends[first], ends[first + 1]];
        (sum - (p + (from - a) / (b - a) * (q - p))) / PEAK
    });
    let peak = whole.fold(0.0, f64::max);
    let check = |what: &str, found: f64, low: f64, high: f64, reason: &str| {
        Check::new(
            format!("{name}: {what}, over that of the rows by their lengths"),
            found / peak,
            Expected::Within(low, high),
            "1",
        )
        .because(reason)
        .from(Kind::Conservation, "the same force, added up again")
    };
    // The rows are a millisecond long, within a step: a window holds 20 or 21 of them.
    [
        check("largest mean of rows over 20 ms", by_rows, 0.95, 1.05, "20 or 21 rows with the same weight each"),
        check(
            "largest mean over 20 ms by steps",
            by_steps,
            0.998,
            1.05,
            "of more windows, each at most a row later; a window begins in a row that is taken as even: a third of the force, over 8 and 20",
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use checkdam::ledger::{Ledger, Stock};

    /// A ledger of two seconds with a row every 10 ms, of a force that grows to 200 N in a second and stays.
    fn ledger() -> Vec<MomentumRow> {
        let nothing = Stock::default();
        (0..=200).map(|k| MomentumRow::new(0.01 * f64::from(k), &Ledger::new(1, 0), &nothing, &nothing)).collect()
    }

    fn taken(row: &MomentumRow) -> [f64; 3] {
        let t = row.time;
        let impulse = 200.0 * if t < 1.0 { 0.5 * t * t } else { t - 0.5 };
        [impulse, -0.1 * impulse, 0.05 * impulse]
    }

    fn failing(checks: impl IntoIterator<Item = Check>) -> usize {
        checks.into_iter().filter(|c| !c.passes()).count()
    }

    #[test]
    fn three_percent_of_a_static_value_is_seen() {
        for (changed, share) in [(3, 1.0), (0, 1.03), (0, 0.97), (1, 1.03), (1, 0.97), (2, 1.03), (2, 0.97)] {
            let of = |k: usize, value: f64| if k == changed { share * value } else { value };
            let found = [("force", of(0, 200.0), "N"), ("shear", of(1, -20.0), "N"), ("moment", of(2, 10.0), "N m")];
            assert_eq!(failing(at_rest("x", &ledger(), &taken, found)), usize::from(changed < 3), "{changed} {share}");
        }
    }

    #[test]
    fn three_percent_of_an_impulse_is_seen() {
        // From 0.3 to 0.8 s: 100 N/s times 0.64 s2 less 0.09 s2; half of what comes in 10 ms at either end are 1.1 N s.
        let of = |share: f64| failing(impulse("x", &ledger(), &taken, 0.3, share * 55.0));
        assert_eq!([1.0, 1.01, 0.99, 1.03, 0.97].map(of), [0, 0, 0, 1, 1]);
    }

    #[test]
    fn a_row_too_few_under_a_peak_is_seen() {
        let row = |k: u32| HistoryRow { time: 1e-3 * f64::from(k), normal: 100.0, ..HistoryRow::default() };
        let history: Vec<_> = (1..=500).map(row).collect();
        let of = |by_rows: f64, by_steps: f64| failing(peaks("x", &history, by_rows, by_steps));
        assert_eq!(of(100.0, 100.0), 0);
        assert_eq!((of(100.0 * 20.0 / 19.0, 100.0), of(100.0, 106.0), of(100.0, 99.7)), (1, 1, 1));
    }
}
