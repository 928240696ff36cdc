//! One quantity on both sides, and whether they differ by more than is allowed.

use checkdam::check::brief;

/// What a comparison found about one quantity.
#[derive(Debug, Clone, PartialEq)]
pub enum Finding {
    /// Both have the number: (b - a) over the scale, infinite where something stands against zero.
    Relative(f64),
    /// Both have the text, and it is the same or not.
    Text(bool),
    /// Why there is nothing to compare, which counts as a difference.
    Not(String),
}

/// A line of the comparison.
#[derive(Debug, Clone)]
pub struct Line {
    /// What is compared.
    pub quantity: String,
    /// The values, as they are shown.
    pub values: [String; 2],
    /// What was found.
    pub finding: Finding,
    /// What else is to be said: where it was largest, what it is relative to.
    pub note: String,
}

impl Line {
    /// Of two numbers, relative to the first.
    pub fn numbers(quantity: impl Into<String>, [a, b]: [f64; 2]) -> Self {
        Self::scaled(quantity, [a, b], a)
    }

    /// Of two numbers, relative to a scale.
    pub fn scaled(quantity: impl Into<String>, [a, b]: [f64; 2], scale: f64) -> Self {
        let values = [a, b].map(brief);
        let finding = relative(a, b, scale).map_or_else(|| Finding::Not("no number".into()), Finding::Relative);
        Self { quantity: quantity.into(), values, finding, note: String::new() }
    }

    /// Of something that only one side has; `side` is 0 for the first.
    pub fn missing(quantity: impl Into<String>, value: impl Into<String>, side: usize) -> Self {
        let mut values = ["-".to_owned(), "-".to_owned()];
        values[1 - side] = value.into();
        let finding = Finding::Not(format!("missing in {}", ["A", "B"][side]));
        Self { quantity: quantity.into(), values, finding, note: String::new() }
    }

    /// Of two texts.
    pub fn texts(quantity: impl Into<String>, [a, b]: [&str; 2]) -> Self {
        let values = [a, b].map(shortened);
        Self { quantity: quantity.into(), values, finding: Finding::Text(a == b), note: String::new() }
    }

    /// The same with a note.
    pub fn noted(self, note: impl Into<String>) -> Self {
        Self { note: note.into(), ..self }
    }

    /// Whether it counts as different.
    pub fn differs(&self, tolerance: f64) -> bool {
        match self.finding {
            Finding::Relative(difference) => difference.is_nan() || difference.abs() > tolerance,
            Finding::Text(same) => !same,
            Finding::Not(_) => true,
        }
    }

    /// The difference as it is shown.
    pub fn difference(&self) -> String {
        match &self.finding {
            Finding::Relative(difference) if *difference == 0.0 => "0".into(),
            Finding::Relative(difference) if difference.is_infinite() => "zero and not zero".into(),
            Finding::Relative(difference) => format!("{difference:+.3e}"),
            Finding::Text(true) => "same".into(),
            Finding::Text(false) => "not the same".into(),
            Finding::Not(why) => why.clone(),
        }
    }
}

/// (b - a) over the magnitude of a scale: zero where both are the same number, infinite where they are not and the scale is zero. None
/// where one is no number.
pub fn relative(a: f64, b: f64, scale: f64) -> Option<f64> {
    match () {
        () if a.is_nan() || b.is_nan() => None,
        () if a == b => Some(0.0),
        () => {
            let difference = (b - a) / scale.abs();
            // Infinite over infinite, or a scale that is no number.
            Some(if difference.is_nan() { f64::INFINITY } else { difference })
        }
    }
}

fn shortened(text: &str) -> String {
    const LONGEST: usize = 36;
    if text.chars().count() <= LONGEST {
        return text.to_owned();
    }
    text.chars().take(LONGEST - 3).chain("...".chars()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_those_of_the_first_side() {
        assert_eq!(relative(100.0, 103.0, 100.0), Some(0.03));
        assert_eq!(relative(-100.0, -103.0, -100.0), Some(-0.03));
        assert_eq!(relative(0.0, -0.0, 0.0), Some(0.0));
        assert_eq!(relative(0.0, 1e-300, 0.0), Some(f64::INFINITY));
        assert_eq!(relative(1e-300, 0.0, 1e-300), Some(-1.0));
        assert_eq!(relative(f64::NAN, f64::NAN, 1.0), None);
        assert_eq!(relative(f64::INFINITY, f64::INFINITY, f64::INFINITY), Some(0.0));
        assert_eq!(relative(f64::INFINITY, 1.0, f64::INFINITY), Some(f64::INFINITY));
    }

    #[test]
    fn what_is_no_number_differs_within_any_tolerance() {
        for pair in [[f64::NAN, 1.0], [1.0, f64::NAN], [f64::NAN, f64::NAN], [0.0, 1.0], [f64::INFINITY, 1.0]] {
            assert!(Line::numbers("q", pair).differs(0.999), "{pair:?}");
        }
        assert!(Line::missing("q", "1", 1).differs(0.999));
        assert!(!Line::numbers("q", [0.0, 0.0]).differs(0.0));
        assert!(
            Line::numbers("q", [100.0, 103.0]).differs(0.0299) && !Line::numbers("q", [100.0, 103.0]).differs(0.0301)
        );
    }
}
