//! What stands beside a published number, as its table says it: a quantity of a run, a number, or two of these with a sign between.
//!
//! The column `ours` of `published.csv` holds it: `static_force_n`, `peak_20ms_n / static_force_n`, `1 - dissipated_1`. There
//! are no brackets and no third term: what needs more is a quantity of its own.

use serde::{Deserialize, Deserializer, de};

/// A quantity of a run, or two of them joined.
#[derive(Debug, Clone, PartialEq)]
pub struct Counterpart {
    first: Term,
    then: Option<(Sign, Term)>,
}

/// A quantity by its name, or a number.
#[derive(Debug, Clone, PartialEq)]
enum Term {
    Quantity(String),
    Number(f64),
}

/// What joins two terms.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sign {
    Plus,
    Minus,
    Times,
    Over,
}

impl Sign {
    fn parse(text: &str) -> Option<Self> {
        Some(match text {
            "+" => Self::Plus,
            "-" => Self::Minus,
            "*" => Self::Times,
            "/" => Self::Over,
            _ => return None,
        })
    }
}

impl Term {
    fn parse(text: &str) -> Result<Self, String> {
        if let Ok(number) = text.parse::<f64>() {
            return Ok(Self::Number(number));
        }
        match text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') {
            true => Ok(Self::Quantity(text.into())),
            false => Err(format!("`{text}` is neither a number nor the name of a quantity, as `static_force_n` is")),
        }
    }

    fn of(&self, quantity: &dyn Fn(&str) -> f64) -> f64 {
        match self {
            Self::Quantity(name) => quantity(name),
            Self::Number(number) => *number,
        }
    }
}

impl Counterpart {
    /// From its text.
    ///
    /// # Errors
    /// What is wrong with it, and what it may be.
    pub fn parse(text: &str) -> Result<Self, String> {
        let words: Vec<&str> = text.split_whitespace().collect();
        let (first, then) = match words[..] {
            [first] => (first, None),
            [first, sign, second] => (first, Some((sign, second))),
            _ => {
                return Err(format!(
                    "`{text}` is not a quantity, nor two with +, -, * or / and a space on each side of it"
                ));
            }
        };
        let join = |(sign, second)| {
            let known = Sign::parse(sign).ok_or_else(|| format!("`{sign}` is none of +, -, * and /"))?;
            Ok::<_, String>((known, Term::parse(second)?))
        };
        Ok(Self { first: Term::parse(first)?, then: then.map(join).transpose()? })
    }

    /// Its value, from the quantities by their names.
    pub fn of(&self, quantity: &dyn Fn(&str) -> f64) -> f64 {
        let first = self.first.of(quantity);
        let Some((sign, second)) = &self.then else { return first };
        let second = second.of(quantity);
        match sign {
            Sign::Plus => first + second,
            Sign::Minus => first - second,
            Sign::Times => first * second,
            Sign::Over => first / second,
        }
    }

    /// The quantities that it names.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        let terms = std::iter::once(&self.first).chain(self.then.as_ref().map(|(_, second)| second));
        terms.filter_map(|t| match t {
            Term::Quantity(name) => Some(name.as_str()),
            Term::Number(_) => None,
        })
    }
}

/// Reads a cell that may be empty.
///
/// # Errors
/// As [`Counterpart::parse`].
pub fn cell<'de, D: Deserializer<'de>>(cell: D) -> Result<Option<Counterpart>, D::Error> {
    let text = String::deserialize(cell)?;
    (!text.is_empty()).then(|| Counterpart::parse(&text)).transpose().map_err(de::Error::custom)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> f64 {
        Counterpart::parse(text).expect("a counterpart").of(&|name| if name == "a_n" { 6.0 } else { 4.0 })
    }

    #[test]
    fn a_quantity_or_two() {
        assert_eq!(["a_n", "a_n + b_n", "a_n - b_n", "a_n * b_n", "a_n / b_n"].map(value), [6.0, 10.0, 2.0, 24.0, 1.5]);
        assert_eq!(["1 - b_n", "b_n / 0.5"].map(value), [-3.0, 8.0]);
        let both = Counterpart::parse("a_n / b_n").expect("a counterpart");
        assert_eq!(both.names().collect::<Vec<_>>(), ["a_n", "b_n"]);
    }

    #[test]
    fn what_cannot_be_read_is_named() {
        for (text, named) in
            [("", "not a quantity"), ("a_n/b_n", "`a_n/b_n`"), ("a_n % b_n", "`%`"), ("a + b + c", "nor two")]
        {
            let error = Counterpart::parse(text).expect_err(text);
            assert!(error.contains(named), "{error}");
        }
    }
}
