//! What the difference from a published number allows one to say, in the manner of ASME V&V 20 (2009).
//!
//! E = S - D is the difference of our number and the published one; u_val^2 = u_num^2 + u_input^2 + u_D^2. The error of the model
//! lies in E -+ 2 u_val. Where |E| is below 2 u_val, the comparison cannot tell the model from a perfect one: the number is not
//! resolved.

/// Standard uncertainty of an even spread of this half width.
pub fn even(half_width: f64) -> f64 {
    half_width / 3f64.sqrt()
}

/// Standard uncertainties behind a verdict, in the number's unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Uncertainty {
    /// Of grid and scatter.
    pub numerical: f64,
    /// Of the inputs.
    pub input: f64,
    /// Of the datum.
    pub data: f64,
}

impl Uncertainty {
    /// All of it.
    pub fn validation(&self) -> f64 {
        self.numerical.hypot(self.input).hypot(self.data)
    }
}

/// What may be said.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// The difference is within two standard uncertainties of numerics and data.
    Agrees,
    /// It is within two of these and of the inputs together.
    NotResolved,
    /// It is larger, or no number.
    Disagrees,
}

impl Verdict {
    /// On a difference.
    pub fn of(error: f64, u: &Uncertainty) -> Self {
        let without_input = u.numerical.hypot(u.data);
        match error.abs() {
            e if e <= 2.0 * without_input => Self::Agrees,
            e if e <= 2.0 * u.validation() => Self::NotResolved,
            _ => Self::Disagrees,
        }
    }

    /// Its first words, short enough for a table.
    pub fn word(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::NotResolved => "not resolved",
            Self::Disagrees => "disagrees",
        }
    }

    /// In a sentence; which inputs leave a number unresolved is the experiment's to say.
    pub fn sentence(self, not_resolved: &'static str) -> &'static str {
        match self {
            Self::Agrees => "agrees within numerical and data uncertainty",
            Self::NotResolved => not_resolved,
            Self::Disagrees => "disagrees by more than all stated uncertainties",
        }
    }
}

/// Standard uncertainty from the inputs: the root of the sum of squares over them, half the span that each causes, taken as
/// evenly spread. Given are the number of the unchanged run and, input by input, the numbers of those that differ in it. With
/// it, the input with the largest share. Values that are no numbers are left out.
pub fn of_inputs<'a>(base: f64, inputs: impl IntoIterator<Item = (&'a str, Vec<f64>)>) -> (f64, &'a str) {
    let part = |values: Vec<f64>| {
        let values = values.into_iter().chain([base]).filter(|v| v.is_finite());
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        even(0.5 * (high - low))
    };
    let parts: Vec<(f64, &str)> = inputs.into_iter().map(|(name, values)| (part(values), name)).collect();
    let total = parts.iter().map(|p| p.0 * p.0).sum::<f64>().sqrt();
    (total, parts.iter().max_by(|a, b| a.0.total_cmp(&b.0)).map_or("", |p| p.1))
}

/// Slope of the straight line through points, by least squares, and the standard deviation from it (none of two points).
pub fn line(x: &[f64], y: &[f64]) -> (f64, f64) {
    let count = x.len() as f64;
    let [mx, my] = [x, y].map(|v| v.iter().sum::<f64>() / count);
    let pairs = || x.iter().zip(y).map(|(x, y)| (x - mx, y - my));
    let slope = pairs().map(|(x, y)| x * y).sum::<f64>() / pairs().map(|(x, _)| x * x).sum::<f64>();
    let squares = pairs().map(|(x, y)| (y - slope * x) * (y - slope * x)).sum::<f64>();
    (slope, (squares / (count - 2.0).max(1.0)).sqrt())
}

/// Standard uncertainty of the value on the finest of some grids, spacings descending: half of its distance from no spacing on
/// a line through all values, times 1.25 where they have an observed order between 1/2 and 2 and 3 where they do not, together
/// with what they deviate from the line (after Eca and Hoekstra 2014; half, since theirs is meant as two standard deviations).
pub fn of_grids(spacings: &[f64], values: &[f64], order: f64) -> f64 {
    let Some(finest) = spacings.last() else { return f64::NAN };
    let (slope, deviation) = line(spacings, values);
    let factor = if (0.5..=2.0).contains(&order) { 1.25 } else { 3.0 };
    (0.5 * factor * (slope * finest).abs()).hypot(deviation)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_may_be_said() {
        let u = Uncertainty { numerical: 3.0, input: 12.0, data: 4.0 };
        assert_eq!(u.validation(), 13.0);
        let said = |error| Verdict::of(error, &u).word();
        assert_eq!([-10.0, 10.1, -26.0].map(said), ["agrees", "not resolved", "not resolved"]);
        assert_eq!([26.1, f64::NAN].map(said), ["disagrees", "disagrees"]);
        assert_eq!(Verdict::NotResolved.sentence("not resolved: why"), "not resolved: why");
    }

    #[test]
    fn an_even_spread() {
        assert!((even(3f64.sqrt()) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn inputs_add_up_by_their_squares() {
        let (total, largest) = of_inputs(100.0, [("gate", vec![94.0, 88.0, f64::NAN]), ("cone", vec![108.0])]);
        assert!((total - (6.0f64.powi(2) + 4.0f64.powi(2)).sqrt() / 3f64.sqrt()).abs() < 1e-12);
        assert_eq!(largest, "gate");
        assert_eq!(of_inputs(1.0, []), (0.0, ""));
    }

    #[test]
    fn a_line_through_points() {
        let (slope, deviation) = line(&[1.0, 2.0, 3.0], &[2.0, 4.0, 6.0]);
        assert!((slope - 2.0).abs() < 1e-12 && deviation < 1e-12);
        // Residuals 1/6, -1/3, 1/6 with one degree of freedom left.
        let (slope, deviation) = line(&[1.0, 2.0, 3.0], &[0.0, 0.0, 1.0]);
        assert!((slope - 0.5).abs() < 1e-12 && (deviation - (1.0f64 / 6.0).sqrt()).abs() < 1e-12);
        assert_eq!(line(&[1.0, 2.0], &[5.0, 7.0]), (2.0, 0.0));
    }

    #[test]
    fn the_distance_from_no_spacing() {
        // 2 h on cells of 1: the distance is 2, half of it 1, times 1.25 with an order and 3 without.
        let of = |order| of_grids(&[2.0, 1.0], &[14.0, 12.0], order);
        assert!((of(1.0) - 1.25).abs() < 1e-12 && (of(f64::NAN) - 3.0).abs() < 1e-12);
    }
}
