//! The rows of the pages, from `pages.csv`: what they are called, and where ours stands.
//!
//! A row either names published numbers, whose counterpart is ours, or has one of its own.

use super::super::compare::PUBLISHED;
use crate::counterpart::{self, Counterpart};
use crate::data;
use serde::Deserialize;
use std::sync::LazyLock;

const TABLE: &str = include_str!("../pages.csv");

/// A row of the file.
#[derive(Deserialize)]
struct Row {
    figure: String,
    quantity: String,
    unit: String,
    #[serde(deserialize_with = "counterpart::cell")]
    ours: Option<Counterpart>,
    stated: String,
}

/// A quantity of a figure.
pub struct Line {
    /// Number of its figure in the paper.
    pub figure: String,
    /// What it is.
    pub quantity: String,
    /// Its unit; "1" where it has none.
    pub unit: String,
    /// Ours.
    pub of: Counterpart,
    /// Names of the numbers beside which it stands, in `published.csv`.
    pub stated: Vec<String>,
}

/// All lines, in the order of the pages.
pub static LINES: LazyLock<Vec<Line>> = LazyLock::new(|| {
    let rows = csv::Reader::from_reader(TABLE.as_bytes()).into_deserialize::<Row>().collect::<Result<Vec<_>, _>>();
    let rows = rows.unwrap_or_else(|e| panic!("flume/pages.csv: {e}"));
    rows.into_iter().map(line).collect()
});

fn line(row: Row) -> Line {
    let Row { figure, quantity, unit, ours, stated } = row;
    let stated: Vec<String> = stated.split_whitespace().map(String::from).collect();
    let of = ours.or_else(|| data::row(PUBLISHED, stated.first()?).ours);
    let of = of.unwrap_or_else(|| panic!("flume/pages.csv: nothing of ours for {quantity}"));
    Line { figure, quantity, unit, of, stated }
}

#[cfg(test)]
mod tests {
    use super::super::super::compare;
    use super::super::FIGURES;
    use super::*;

    /// What is compared elsewhere stands on one page, with the same number of ours beside it.
    #[test]
    fn every_number_that_is_compared_has_its_line() {
        for case in ["40deg", "23deg"] {
            for (datum, of) in compare::published(case) {
                let own: Vec<&Line> = LINES.iter().filter(|l| l.stated.contains(&datum.id)).collect();
                assert_eq!(own.len(), 1, "{}", datum.id);
                assert_eq!((&own[0].unit, &own[0].of), (&datum.unit, &of), "{}", datum.id);
            }
        }
    }

    /// All numbers beside which a line stands have its counterpart, and it has a page or nothing to say.
    #[test]
    fn every_line_has_its_page_and_one_counterpart() {
        for line in LINES.iter() {
            assert!(FIGURES.iter().any(|f| f.number == line.figure), "{}", line.quantity);
            for id in &line.stated {
                assert_eq!(data::row(PUBLISHED, id).ours.as_ref(), Some(&line.of), "{id}");
            }
        }
    }
}
