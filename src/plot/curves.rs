//! Curves from a table: what was measured beside what is exact, optionally split by a parameter, optionally logarithmic.

use std::path::Path;

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::PlotError;
use super::axes::{Axis, Frame, Margins};
use super::style::{
    BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, SMALL_PX, VERMILION, drawing, line, render, stroke, text_width_px,
    units, write_at,
};
use crate::output::Table;

/// Colours of the curves, in turn.
const COLOURS: [RGBColor; 6] = [BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY];
const HEIGHT_PX: i32 = 460;
/// More points than this are drawn without markers.
const MARKED: usize = 40;

/// One column against another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Curve {
    /// Column of the values.
    pub column: &'static str,
    /// What to call it.
    pub label: &'static str,
    /// Whether it is what should come out (thin, grey, no markers) rather than what did.
    pub exact: bool,
}

/// What to draw from a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Curves {
    /// Column along the horizontal axis.
    pub x: &'static str,
    /// Title of the horizontal axis, with its unit.
    pub x_title: &'static str,
    /// Title of the vertical axis, with its unit.
    pub y_title: &'static str,
    /// The curves.
    pub curves: &'static [Curve],
    /// A column that splits the rows into one set of curves per value, and what to call that value.
    pub split: Option<(&'static str, &'static str)>,
    /// Whether both axes show decimal logarithms of magnitudes; zeros are left out.
    pub logarithmic: bool,
}

/// A drawn curve: label, whether exact, points.
struct Drawn {
    label: String,
    exact: bool,
    points: Vec<(f64, f64)>,
}

/// Draws `out_svg` from `csv`.
///
/// # Errors
/// [`PlotError::File`] for a missing column or file, [`PlotError::Data`] for a table without a point to draw.
pub fn draw(csv: impl AsRef<Path>, what: &Curves, out_svg: impl AsRef<Path>) -> Result<(), PlotError> {
    let table = Table::load(csv)?;
    let drawn = select(&table, what)?;
    let all = || drawn.iter().flat_map(|d| &d.points).filter(|p| p.0.is_finite());
    if all().next().is_none() {
        return Err(PlotError::data(table.path(), "no row has a value on both axes"));
    }
    let range = |value: fn(&(f64, f64)) -> f64| {
        all().map(value).fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)))
    };
    let ((x0, x1), (y0, y1)) = (range(|p| p.0), range(|p| p.1));
    // Zero belongs on the axis unless that would flatten the curves.
    let y0 = if !what.logarithmic && y0 > 0.0 && y0 < 0.7 * y1 { 0.0 } else { y0 };
    let (x, y) = (Axis::exact(x0, x1, 6), Axis::round(y0, y1, 6));
    let key = drawn.iter().map(|d| text_width_px(&d.label, SMALL_PX)).fold(0.0, f64::max);
    let margins = Margins { left: 84.0, right: 56.0 + key, top: 16.0, bottom: 46.0 };
    let titled = |title: &str| if what.logarithmic { format!("log10 of {title}") } else { title.to_string() };

    render(out_svg.as_ref(), HEIGHT_PX, |canvas| {
        let titles = (titled(what.x_title), titled(what.y_title));
        let frame = Frame::draw(canvas, &margins, (&x, &titles.0), (&y, &titles.1))?;
        let (_, right, top, bottom) = frame.bounds();
        let pitch = units(19.0).min((bottom - top) / (drawn.len() as i32 + 1));
        let mut colours = COLOURS.iter().cycle();
        for (k, d) in drawn.iter().enumerate() {
            let colour = if d.exact { GREY } else { *colours.next().unwrap_or(&INK) };
            let style = line(colour, if d.exact { 1.2 } else { 1.8 });
            let (xs, ys): (Vec<f64>, Vec<f64>) = d.points.iter().copied().unzip();
            frame.series(canvas, &xs, &ys, style)?;
            if !d.exact && d.points.len() <= MARKED {
                let marker = ShapeStyle { color: colour.to_rgba(), filled: true, stroke_width: 0 };
                for &(px, py) in d.points.iter().filter(|p| p.0.is_finite()) {
                    canvas.draw(&Circle::new(frame.spot(px, py), units(3.0), marker)).map_err(drawing)?;
                }
            }
            let at = (right + units(14.0), top + pitch * (k as i32 + 1) - units(6.0));
            stroke(canvas, vec![at, (at.0 + units(18.0), at.1)], style)?;
            write_at(canvas, &d.label, (at.0 + units(24.0), at.1), SMALL_PX, INK, HPos::Left)?;
        }
        Ok(())
    })
}

/// The curves of a table, split and transformed.
fn select(table: &Table, what: &Curves) -> Result<Vec<Drawn>, PlotError> {
    let x = table.column(what.x)?;
    let split = what.split.map(|(column, label)| table.column(column).map(|v| (v, label))).transpose()?;
    let mut values: Vec<f64> = split.map_or_else(|| vec![f64::NAN], |(v, _)| v.to_vec());
    values.dedup();
    let mut seen = Vec::new();
    values.retain(|v| {
        !seen.contains(&v.to_bits()) && {
            seen.push(v.to_bits());
            true
        }
    });
    let mut drawn = Vec::new();
    for &value in &values {
        for curve in what.curves {
            let y = table.column(curve.column)?;
            let rows = (0..table.rows()).filter(|k| split.is_none_or(|(v, _)| v[*k] == value));
            let map = |v: f64| if what.logarithmic { v.abs().log10() } else { v };
            let points: Vec<_> =
                rows.map(|k| (map(x[k]), map(y[k]))).filter(|(a, b)| a.is_finite() && b.is_finite()).collect();
            let points = parted(points);
            let label = match split {
                None => curve.label.to_string(),
                Some((_, name)) => format!("{}, {name} {value}", curve.label),
            };
            if !points.is_empty() {
                drawn.push(Drawn { label, exact: curve.exact, points });
            }
        }
    }
    Ok(drawn)
}

/// Puts a gap where the horizontal coordinate goes back: there another run begins.
fn parted(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let mut out: Vec<(f64, f64)> = Vec::with_capacity(points.len());
    for p in points {
        if out.last().is_some_and(|last| p.0 < last.0) {
            out.push((f64::NAN, f64::NAN));
        }
        out.push(p);
    }
    out
}
