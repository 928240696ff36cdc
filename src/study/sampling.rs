//! Points that fill a space evenly.
//!
//! Elsewhere: low-discrepancy sequences, quasi-Monte Carlo sampling.

/// The first primes: bases of the dimensions.
const PRIMES: [u32; 12] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37];
/// Most dimensions of a sample.
pub const MOST_DIMENSIONS: usize = PRIMES.len();

/// Coordinate `dimension` of point `index` of Halton's sequence, in (0, 1) (Halton 1960). Index 0 is left out: it is a corner.
pub fn halton(index: usize, dimension: usize) -> f64 {
    let base = PRIMES[dimension];
    let (mut rest, mut share, mut value) = (index + 1, 1.0, 0.0);
    while rest > 0 {
        share /= f64::from(base);
        value += share * (rest % base as usize) as f64;
        rest /= base as usize;
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_points() {
        let all = |d| (0..4).map(|k| halton(k, d)).collect::<Vec<_>>();
        assert_eq!(all(0), [0.5, 0.25, 0.75, 0.125]);
        for (value, wanted) in all(1).iter().zip([1.0 / 3.0, 2.0 / 3.0, 1.0 / 9.0, 4.0 / 9.0]) {
            assert!((value - wanted).abs() < 1e-15);
        }
    }

    #[test]
    fn every_dimension_has_its_mean_in_the_middle() {
        for d in 0..MOST_DIMENSIONS {
            let mean = (0..2000).map(|k| halton(k, d)).sum::<f64>() / 2000.0;
            assert!((mean - 0.5).abs() < 0.01, "{d}: {mean}");
        }
    }
}
