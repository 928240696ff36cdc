//! Published and measured numbers with their provenance, as the CSV files beside this one have them.
//!
//! One row, one number: what it is, in which unit, how uncertain, of which kind, where it stands, how it was read. The
//! uncertainty is the half width of the interval in which the number lies by what the source says, in the number's unit. The column
//! `ours` says what stands beside it here; comparison, verdict, page and figure are made from that.

use crate::counterpart::{self, Counterpart};
use serde::Deserialize;

/// How a number came about.
pub const KINDS: [&str; 6] = ["measured", "computed", "computed or measured", "derived", "theory", "input"];

/// A number and where it is from.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Datum {
    /// Case it belongs to.
    pub case: String,
    /// What it is.
    pub quantity: String,
    /// The number.
    pub value: f64,
    /// Its unit; "1" where it has none.
    pub unit: String,
    /// How it came about: one of [`KINDS`].
    pub kind: String,
    /// Half width of the interval in which it lies, same unit.
    pub uncertainty: f64,
    /// Inclination of the bed, degrees.
    pub angle_deg: Option<f64>,
    /// Where it stands.
    #[serde(rename = "where")]
    pub place: String,
    /// How it was read, and how its uncertainty was estimated.
    pub how: String,
    /// What else to know.
    pub note: String,
    /// Name within its file.
    pub id: String,
    /// Where ours stands; none for what nothing of ours stands beside.
    #[serde(default, deserialize_with = "counterpart::cell")]
    pub ours: Option<Counterpart>,
}

/// A file of numbers: its name below `validation/`, and its text.
pub type Source = (&'static str, &'static str);

/// Columns that collapse.
pub const COLUMNS: Source = ("column/published.csv", include_str!("column/published.csv"));

/// All files.
pub const SOURCES: [Source; 3] = [
    ("flume/published.csv", include_str!("flume/published.csv")),
    ("barrier/published.csv", include_str!("barrier/published.csv")),
    COLUMNS,
];

/// The rows of a file.
///
/// # Panics
/// On a row that is malformed: the files are part of the program.
pub fn rows(source: Source) -> Vec<Datum> {
    let mut reader = csv::Reader::from_reader(source.1.as_bytes());
    reader.deserialize().map(|row| row.unwrap_or_else(|e| panic!("{}: {e}", source.0))).collect()
}

/// The row of a file with a name.
///
/// # Panics
/// Where there is none.
pub fn row(source: Source, id: &str) -> Datum {
    rows(source).into_iter().find(|r| r.id == id).unwrap_or_else(|| panic!("{}: no row {id}", source.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_number_has_a_source_and_an_uncertainty() {
        for source in SOURCES {
            let rows = rows(source);
            assert!(!rows.is_empty(), "{} is empty", source.0);
            let mut names = BTreeSet::new();
            for r in rows {
                let at = format!("{}, {}", source.0, r.id);
                assert!(names.insert(r.id.clone()) && !r.id.is_empty(), "{at}: name not unique");
                for (what, text) in
                    [("quantity", &r.quantity), ("case", &r.case), ("unit", &r.unit), ("where", &r.place)]
                {
                    assert!(!text.trim().is_empty(), "{at}: no {what}");
                }
                assert!(r.how.split_whitespace().count() >= 2, "{at}: how it was read?");
                assert!(r.value.is_finite(), "{at}: no value");
                assert!(r.uncertainty > 0.0 && r.uncertainty.is_finite(), "{at}: uncertainty {}", r.uncertainty);
                assert!(KINDS.contains(&r.kind.as_str()), "{at}: kind {}", r.kind);
                assert!(r.angle_deg.is_none_or(|a| (0.0..90.0).contains(&a)), "{at}: angle");
            }
        }
    }

    #[test]
    fn every_file_is_listed() {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        for folder in std::fs::read_dir(root).expect("the validations").filter_map(Result::ok) {
            let file = folder.path().join("published.csv");
            if file.exists() {
                let name = format!("{}/published.csv", folder.file_name().to_string_lossy());
                assert!(SOURCES.iter().any(|s| s.0 == name), "{name} is not in SOURCES");
            }
        }
    }

    #[test]
    #[should_panic(expected = "no row X")]
    fn a_row_that_is_not_there() {
        row(SOURCES[0], "X");
    }
}
