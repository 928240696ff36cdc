//! Placing texts beside what they name without letting them overlap.

/// Moves `wanted` positions apart to at least `gap` within `lo` to `hi`, by as little as possible (least squares).
///
/// The order of the positions is kept. Where there is no room for all, the gap shrinks.
pub(super) fn spread(wanted: &[f64], gap: f64, lo: f64, hi: f64) -> Vec<f64> {
    let count = wanted.len();
    let gap = if count > 1 { gap.min((hi - lo) / (count - 1) as f64) } else { gap };
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|a, b| wanted[*a].total_cmp(&wanted[*b]));
    // With the gaps taken out, the task is to find the nearest non-decreasing sequence: pool neighbours out of order.
    let mut pools: Vec<(f64, usize)> = Vec::new();
    for (rank, k) in order.iter().enumerate() {
        let mut pool = (wanted[*k] - rank as f64 * gap, 1);
        while let Some(last) = pools.pop_if(|last| last.0 > pool.0) {
            let size = last.1 + pool.1;
            pool = ((last.0 * last.1 as f64 + pool.0 * pool.1 as f64) / size as f64, size);
        }
        pools.push(pool);
    }
    let room = hi - gap * count.saturating_sub(1) as f64;
    let placed = pools.iter().flat_map(|(mean, size)| std::iter::repeat_n(mean.clamp(lo, room.max(lo)), *size));
    let mut result = vec![0.0; count];
    for ((rank, k), position) in order.iter().enumerate().zip(placed) {
        result[*k] = position + rank as f64 * gap;
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distant_labels_stay_and_close_ones_part_evenly() {
        assert_eq!(spread(&[10.0, 50.0], 12.0, 0.0, 100.0), [10.0, 50.0]);
        assert_eq!(spread(&[52.0, 50.0], 12.0, 0.0, 100.0), [57.0, 45.0]);
    }

    #[test]
    fn labels_stay_between_the_ends() {
        assert_eq!(spread(&[99.0, 100.0, 100.0], 10.0, 0.0, 100.0), [80.0, 90.0, 100.0]);
        assert_eq!(spread(&[0.0, 0.0, 0.0], 90.0, 0.0, 100.0), [0.0, 50.0, 100.0]);
        assert!(spread(&[], 1.0, 0.0, 1.0).is_empty());
    }
}
