//! The figure of a study.

use super::file::Figure;
use super::quantities::QUANTITIES;
use crate::plot::PlotError;
use crate::plot::curves::{self, Curve, Curves};
use std::path::Path;

/// Draws a quantity against what varies, one curve per case, from the table of a study.
///
/// # Errors
/// A column is missing, or has no number.
pub fn draw(figure: &Figure, table: &Path, out: &Path) -> Result<(), PlotError> {
    let title = QUANTITIES.iter().find(|q| q.name == figure.y).map_or(figure.y.as_str(), |q| q.title);
    let curves = [Curve { column: &figure.y, label: "", exact: false }];
    let split = [("case", "")];
    let what = Curves {
        x: &figure.x,
        x_title: &figure.x,
        y_title: title,
        curves: &curves,
        split: &split,
        logarithmic: figure.logarithmic,
        ..Curves::LINEAR
    };
    curves::draw(table, &what, out)
}
