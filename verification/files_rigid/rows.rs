//! Rows of tables that stand for a time, means of them, and how exactly two of them can agree.

/// Why a number of a table and one of the points agree.
pub const SAME: &str = "the same points at the same moment; tables have nine digits";
/// Why a number of the summary and one of the tables agree.
pub const FROM_TABLES: &str = "the tables' rows are those that the summary's numbers come from, with nine digits";
/// What says so.
pub const DEFINED: &str = "definition of the quantity";
/// Rows of nine digits, or differences of them.
pub const ROWS: f64 = 1e-7;
/// A row of a thousand a second may fall on either side of a window's edge when its time has nine digits.
pub const EDGE: f64 = 4e-3;
/// Window of static values, s.
pub const STATIC: f64 = 0.3;
/// Points that have come apart count with at most this volume ratio in depths.
pub const MOST: f64 = 1.5;

/// The value of a row; NaN where there is none.
pub fn pick(values: &[f64], row: usize) -> f64 {
    values.get(row).copied().unwrap_or(f64::NAN)
}

/// Mean over the last 0.3 s, or over a part of them.
pub fn late(time: &[f64], values: &[f64], from: f64, to: f64) -> f64 {
    let Some(end) = time.last() else { return f64::NAN };
    let (low, high) = (end - STATIC * (1.0 - from), end - STATIC * (1.0 - to));
    let inside: Vec<f64> = time.iter().zip(values).filter(|(t, _)| **t > low && **t <= high).map(|(_, v)| *v).collect();
    inside.iter().sum::<f64>() / inside.len() as f64
}
