//! Means and impulses of a history of samples.

use super::records::HistoryRow;

/// Length of the means behind "static" values, s.
pub(super) const STATIC_WINDOW: f64 = 0.3;
/// Length of the mean behind the filtered peak, s: the paper's archive interval.
const PEAK_WINDOW: f64 = 0.02;
/// The force is static from when its mean over that interval stays within this share of the static force.
const STATIC_BAND: f64 = 0.05;

/// Mean of a quantity over the samples of the last `STATIC_WINDOW`, or of a part of it.
pub(super) fn late_mean(history: &[HistoryRow], from: f64, to: f64, value: impl Fn(&HistoryRow) -> f64) -> f64 {
    let Some(last) = history.last() else { return 0.0 };
    let (low, high) = (last.time - STATIC_WINDOW * (1.0 - from), last.time - STATIC_WINDOW * (1.0 - to));
    let inside = history.iter().filter(|r| r.time > low && r.time <= high);
    let (sum, count) = inside.fold((0.0, 0.0), |(s, n), r| (s + value(r), n + 1.0));
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
        (history[first].time, row.time, sum / (k + 1 - first) as f64)
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
    frames.map(|p| p[1].normal).fold(0.0, f64::max)
}

/// When the normal force first exceeds `force` (N).
pub(super) fn arrival(history: &[HistoryRow], force: f64) -> Option<f64> {
    history.iter().find(|r| r.normal > force).map(|r| r.time)
}

/// End of the last interval of `PEAK_WINDOW` whose mean is farther from the static force than `STATIC_BAND`.
pub(super) fn time_to_static(history: &[HistoryRow], static_force: f64) -> f64 {
    let off = running_means(history).filter(|m| (m.2 - static_force).abs() > STATIC_BAND * static_force.abs());
    off.last().map_or(0.0, |m| m.1)
}

/// Impulse of the normal force between two times, N s.
pub(super) fn impulse(history: &[HistoryRow], from: f64, to: f64) -> f64 {
    let pairs = history.windows(2).filter(|p| p[1].time > from && p[1].time <= to);
    pairs.map(|p| p[1].normal * (p[1].time - p[0].time)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_archive_misses_what_lies_between_its_frames() {
        let row = |ms: f64, normal: f64| HistoryRow { time: 1e-3 * ms, normal, ..HistoryRow::default() };
        let history: Vec<_> = (0..100).map(|k| row(f64::from(k) + 0.3, f64::from(k))).collect();
        // Frames at 20, 40, 60 and 80 ms are the samples at 20.3 ms and so on.
        assert_eq!(archived_peak(&history), 80.0);
        assert_eq!(archived_peak(&history[..80]), 60.0);
        assert_eq!(archived_peak(&[row(1.0, 5.0)]), 0.0);
    }
}
