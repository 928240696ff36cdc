//! Mean and scatter of repeated runs.

/// Mean, standard deviation and number of values that are numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scatter {
    /// Mean.
    pub mean: f64,
    /// Standard deviation of one run (n - 1 in the denominator).
    pub deviation: f64,
    /// How many.
    pub count: usize,
}

impl Scatter {
    /// Of these values; NaN ones are left out.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let values: Vec<f64> = values.into_iter().filter(|v| v.is_finite()).collect();
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
        Self {
            mean,
            deviation: if values.len() > 1 { (squares / (n - 1.0)).sqrt() } else { f64::NAN },
            count: values.len(),
        }
    }

    /// Standard error of the mean.
    pub fn standard_error(&self) -> f64 {
        self.deviation / (self.count as f64).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_few_numbers() {
        let s = Scatter::of([1.0, f64::NAN, 2.0, 3.0, 6.0]);
        assert_eq!((s.mean, s.count), (3.0, 4));
        assert!((s.deviation - (14.0f64 / 3.0).sqrt()).abs() < 1e-15);
        assert!((s.standard_error() - 0.5 * s.deviation).abs() < 1e-15);
        assert!(Scatter::of([1.0]).deviation.is_nan());
    }
}
