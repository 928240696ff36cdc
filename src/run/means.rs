//! Means and impulses of a history of samples.
//!
//! Elsewhere: time averages.

use super::records::HistoryRow;
use crate::seeded::{self, Seed};

/// Length of the means behind "static" values, s.
pub(super) const STATIC_WINDOW: f64 = 0.3;
/// Length of the mean behind the filtered peak, s: the paper's archive interval.
const PEAK_WINDOW: f64 = 0.02;
/// The force is static from when its mean over that interval stays within this share of the static force.
const STATIC_BAND: f64 = 0.05;

/// Mean of a quantity over the samples of the last `STATIC_WINDOW`, or of a part of it. Each counts once, whatever its length: rows end with
/// steps, and in the flume on 20 mm they are 0.93 to 1.20 ms long. Weighed by their lengths the static force there changes by
/// 7e-6 of itself in a run to rest, and by 7e-5 in the first second.
pub(super) fn late_mean(history: &[HistoryRow], from: f64, to: f64, value: impl Fn(&HistoryRow) -> f64) -> f64 {
    let Some(last) = history.last() else { return 0.0 };
    let (low, high) = (last.time - STATIC_WINDOW * (1.0 - from), last.time - STATIC_WINDOW * (1.0 - to));
    let inside = history.iter().filter(|r| r.time > low && r.time <= high);
    let (sum, count) = inside.fold((0.0, 0.0), |(s, n), r| (s + value(r), n + 1.0));
    let count = if seeded::is(Seed::RunMean) { count - 1.0 } else { count };
    if count > 0.0 { sum / count } else { value(last) }
}

/// Means of the normal force over `PEAK_WINDOW`: start, end (s) and mean (N) of each interval that ends with a sample.
fn running_means(history: &[HistoryRow]) -> impl Iterator<Item = (f64, f64, f64)> {
    let (mut first, mut sum) = (0, 0.0);
    history.iter().enumerate().map(move |(k, row)| {
        sum += row.normal;
        while row.time - history[first].time > PEAK_WINDOW * (1.0 - 1e-9) {
            sum -= history[first].normal;
            first += 1;
        }
        let few = usize::from(seeded::is(Seed::RunPeak) && k > first);
        (history[first].time, row.time, sum / (k + 1 - first - few) as f64)
    })
}

/// Largest mean over `PEAK_WINDOW` and the middle of its interval.
pub(super) fn smoothed_peak(history: &[HistoryRow]) -> (f64, f64) {
    let whole = running_means(history).filter(|m| m.1 >= PEAK_WINDOW);
    whole.fold((0.0, 0.0), |best, (from, to, mean)| if mean > best.0 { (mean, 0.5 * (from + to)) } else { best })
}

/// Largest of the samples that are the first at or after a whole multiple of `PEAK_WINDOW`.
pub(super) fn archived_peak(history: &[HistoryRow]) -> f64 {
    let frame = |row: &HistoryRow| (row.time / PEAK_WINDOW * (1.0 + 1e-9)).floor();
    let frames = history.windows(2).filter(|p| frame(&p[1]) > frame(&p[0]));
    let kept = usize::from(!seeded::is(Seed::RunArchive));
    frames.map(|p| p[kept].normal).fold(0.0, f64::max)
}

/// When the normal force first exceeds `force` (N).
pub(super) fn arrival(history: &[HistoryRow], force: f64) -> Option<f64> {
    history.iter().find(|r| r.normal > force).map(|r| r.time)
}

/// End of the last interval of `PEAK_WINDOW` whose mean is farther from the static force than `STATIC_BAND`.
pub(super) fn time_to_static(history: &[HistoryRow], static_force: f64) -> f64 {
    let off = running_means(history).filter(|m| (m.2 - static_force).abs() > STATIC_BAND * static_force.abs());
    off.last().map_or(0.0, |m| if seeded::is(Seed::RunTimeToStatic) { m.0 } else { m.1 })
}

/// Impulse of the normal force between two times, N s.
pub(super) fn impulse(history: &[HistoryRow], from: f64, to: f64) -> f64 {
    let pairs = history.windows(2).filter(|p| p[1].time > from && p[1].time <= to);
    seeded::times(Seed::RunImpulse, pairs.map(|p| p[1].normal * (p[1].time - p[0].time)).sum())
}

#[cfg(test)]
#[path = "means_tests.rs"]
mod tests;
