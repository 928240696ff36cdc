//! Curves from a table: what was measured beside what is exact, in panels, split by parameters, optionally logarithmic.

use std::path::Path;

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::PlotError;
use super::axes::{Axis, Frame, Margins};
use super::legend::{Key, LEGEND_ROW_PX, flow, legend};
use super::style::{
    Canvas, GREY, INK, SMALL_PX, SOLID, TEXT_PX, UNIT, WIDTH_PX, dashed, drawing, lighten, line, render, stroke,
    text_width_px, units, write_at,
};
use crate::output::Table;

/// More points than this are drawn without markers.
const MARKED: usize = 40;
/// Room to the right of a panel.
const RIGHT_PX: f64 = 22.0;
/// Least distance between the names of ticks.
const BETWEEN_PX: f64 = 6.0;

/// One column against another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Curve<'a> {
    /// Column of the values.
    pub column: &'a str,
    /// What to call it; may be empty where the split says enough.
    pub label: &'a str,
    /// Whether it is what should come out (thin, grey, no markers; dashed differently where there are more than two) rather than
    /// what did.
    pub exact: bool,
}

/// A part of the rows, with axes of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Panel<'a> {
    /// What stands above it.
    pub title: &'a str,
    /// Columns and the text that a row must have there.
    pub only: &'a [(&'a str, &'a str)],
}

/// The rows that have these texts in these columns, below a title.
pub const fn panel<'a>(title: &'a str, only: &'a [(&'a str, &'a str)]) -> Panel<'a> {
    Panel { title, only }
}

/// What to draw from a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curves<'a> {
    /// Column along the horizontal axis.
    pub x: &'a str,
    /// Title of the horizontal axis, with its unit.
    pub x_title: &'a str,
    /// Title of the vertical axis, with its unit.
    pub y_title: &'a str,
    /// What the values of the curves are multiplied with, for another unit than that of their columns: 1e3 for mm where they are in m.
    pub y_times: f64,
    /// The curves.
    pub curves: &'a [Curve<'a>],
    /// The panels; none for one of all rows.
    pub panels: &'a [Panel<'a>],
    /// Columns that split the rows into one set of curves per combination, and what to write before their values.
    pub split: &'a [(&'a str, &'a str)],
    /// Whether both axes are logarithmic, of magnitudes; zeros are left out.
    pub logarithmic: bool,
    /// Slopes to compare with, on logarithmic axes.
    pub orders: &'a [f64],
}

impl Curves<'static> {
    /// One panel on linear axes.
    pub const LINEAR: Self = Curves {
        x: "",
        x_title: "",
        y_title: "",
        y_times: 1.0,
        curves: &[],
        panels: &[],
        split: &[],
        logarithmic: false,
        orders: &[],
    };

    /// One panel on logarithmic axes.
    pub const LOGARITHMIC: Self = Curves { logarithmic: true, ..Self::LINEAR };
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
/// [`PlotError::File`] for a missing column or file, [`PlotError::Data`] for a panel without a point to draw.
pub fn draw(csv: impl AsRef<Path>, what: &Curves, out_svg: impl AsRef<Path>) -> Result<(), PlotError> {
    let table = Table::load(csv)?;
    let whole = [Panel { title: "", only: &[] }];
    let panels = if what.panels.is_empty() { &whole[..] } else { what.panels };
    let drawn = panels.iter().map(|panel| select(&table, what, panel)).collect::<Result<Vec<_>, _>>()?;
    let legend = legend(drawn.iter().flatten().map(|d| (d.label.as_str(), d.exact)));
    let places = flow(&legend);
    let rows = places.last().map_or(0, |p| p.1 + 1);

    let columns = match panels.len() {
        1 => 1,
        2 | 4 => 2,
        _ => 3,
    };
    let tall = if columns == 1 { 400.0 } else { 290.0 };
    let height = tall * panels.len().div_ceil(columns) as f64;
    let total = (height + LEGEND_ROW_PX * rows as f64 + 14.0).ceil() as i32;
    render(out_svg.as_ref(), total, |canvas| {
        let wide = f64::from(WIDTH_PX) / columns as f64;
        for (k, (panel, curves)) in panels.iter().zip(&drawn).enumerate() {
            let (row, column) = (k / columns, k % columns);
            let corner = (units(wide * column as f64), units(tall * row as f64));
            let area = canvas.clone().shrink(corner, (units(wide), units(tall)));
            let last = k + columns >= panels.len();
            draw_panel(canvas, &area, what, panel, curves, &legend, [column == 0, last])?;
        }
        for (key, (x, row)) in legend.iter().zip(&places) {
            let at = (units(*x), units(height + LEGEND_ROW_PX * (*row as f64 + 0.5)));
            dashed(canvas, &[at, (at.0 + units(key.sample_px()), at.1)], key.style, key.dashes)?;
            write_at(canvas, &key.label, (at.0 + units(key.sample_px() + 6.0), at.1), SMALL_PX, INK, HPos::Left)?;
        }
        Ok(())
    })
}

/// One panel; `titled` says whether its vertical and its horizontal axis have a title.
fn draw_panel(
    canvas: &Canvas<'_>,
    area: &Canvas<'_>,
    what: &Curves,
    panel: &Panel,
    curves: &[Drawn],
    legend: &[Key],
    titled: [bool; 2],
) -> Result<(), PlotError> {
    let top = if panel.title.is_empty() { 16.0 } else { 32.0 };
    let left = if what.panels.len() > 1 { 74.0 } else { 92.0 };
    let wide = f64::from(area.dim_in_pixel().0) / f64::from(UNIT);
    let [x, y] = axes(what, curves, wide - left - RIGHT_PX);
    let margins = Margins { left, right: RIGHT_PX, top, bottom: 46.0 };
    let title = |k: usize, text| if titled[k] { text } else { "" };
    let frame = Frame::draw(area, &margins, (&x, title(1, what.x_title)), (&y, title(0, what.y_title)))?;
    let (left, right, upper, lower) = frame.bounds();
    write_at(canvas, panel.title, ((left + right) / 2, upper - units(14.0)), TEXT_PX, INK, HPos::Center)?;
    guides(canvas, &frame, what.orders, &x, curves, [upper, lower])?;
    for d in curves {
        let found = legend.iter().find(|key| key.label == d.label);
        let (style, pattern) = found.map_or_else(|| (line(INK, 1.0), SOLID), |key| (key.style, key.dashes));
        let (xs, ys): (Vec<f64>, Vec<f64>) = d.points.iter().copied().unzip();
        frame.dashed_series(canvas, &xs, &ys, style, pattern)?;
        if !d.exact && d.points.len() <= MARKED {
            let marker = ShapeStyle { filled: true, stroke_width: 0, ..style };
            for &(px, py) in d.points.iter().filter(|p| p.0.is_finite()) {
                canvas.draw(&Circle::new(frame.spot(px, py), units(3.0), marker)).map_err(drawing)?;
            }
        }
    }
    Ok(())
}

/// Axes around the points, the horizontal one `wide` pixels long; its ticks are the values that occur, if they are few.
fn axes(what: &Curves, curves: &[Drawn], wide: f64) -> [Axis; 2] {
    let all = || curves.iter().flat_map(|d| &d.points).filter(|p| p.0.is_finite());
    let range = |value: fn(&(f64, f64)) -> f64| {
        all().map(value).fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)))
    };
    let ((x0, x1), (y0, y1)) = (range(|p| p.0), range(|p| p.1));
    let mut places: Vec<f64> = all().map(|p| p.0).collect();
    places.sort_by(f64::total_cmp);
    places.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let named = |places: Vec<f64>, value: fn(f64) -> f64| {
        let names = places.iter().map(|p| crate::check::significant(value(*p), 3)).collect();
        let mut axis = Axis::named(places, names);
        // From left to right, those that would touch the one before stay without a name.
        let mut taken = f64::NEG_INFINITY;
        axis.unname(|place, name| {
            let half = 0.5 * text_width_px(name, TEXT_PX);
            let middle = place * wide;
            let free = middle - half > taken + BETWEEN_PX;
            taken = if free { middle + half } else { taken };
            !free
        });
        axis
    };
    if !what.logarithmic {
        // Zero belongs on the axis unless that would flatten the curves.
        let y0 = if y0 > 0.0 && y0 < 0.7 * y1 { 0.0 } else { y0 };
        let count = if what.panels.len() > 1 { 4 } else { 6 };
        let x = if places.len() <= 5 { named(places, |x| x) } else { Axis::exact(x0, x1, count) };
        return [x, Axis::round(y0, y1, 6)];
    }
    let x = if places.len() <= 8 { named(places, |x| 10f64.powf(x)) } else { Axis::decades(x0, x1) };
    [x, Axis::decades(y0, y1)]
}

/// Thin lines of given slopes from the largest value on the left, named at their ends.
fn guides(
    canvas: &Canvas<'_>,
    frame: &Frame<'_>,
    orders: &[f64],
    x: &Axis,
    curves: &[Drawn],
    [upper, lower]: [i32; 2],
) -> Result<(), PlotError> {
    let (a, b) = (x.ticks[0], x.ticks[x.ticks.len() - 1]);
    let coarsest = curves.iter().flat_map(|d| &d.points).filter(|p| (p.0 - a).abs() < 1e-9 && p.1.is_finite());
    let Some(top) = coarsest.map(|p| p.1).max_by(f64::total_cmp) else {
        return Ok(());
    };
    for order in orders {
        let from = frame.spot(a, top);
        let to = frame.spot(b, top - order * (b - a));
        // Cut where it leaves the panel.
        let share = if to.1 > lower { f64::from(lower - from.1) / f64::from(to.1 - from.1) } else { 1.0 };
        let end =
            (from.0 + (f64::from(to.0 - from.0) * share) as i32, from.1 + (f64::from(to.1 - from.1) * share) as i32);
        stroke(canvas, vec![from, end], line(lighten(GREY, 0.55), 1.0))?;
        let at = (end.0 - units(4.0), (end.1 - units(9.0)).max(upper));
        write_at(canvas, &format!("order {order}"), at, SMALL_PX, lighten(GREY, 0.3), HPos::Right)?;
    }
    Ok(())
}

/// The curves of a panel, split and transformed.
fn select(table: &Table, what: &Curves, panel: &Panel) -> Result<Vec<Drawn>, PlotError> {
    let x = table.column(what.x)?;
    let mut rows: Vec<usize> = (0..table.rows()).collect();
    for (column, value) in panel.only {
        let cells = table.cells(column)?;
        rows.retain(|k| cells[*k] == *value);
    }
    let mut keys = vec![Vec::new(); table.rows()];
    for (column, before) in what.split {
        for (key, cell) in keys.iter_mut().zip(table.cells(column)?) {
            key.push(format!("{before}{cell}"));
        }
    }
    let mut sets: Vec<&Vec<String>> = Vec::new();
    for k in &rows {
        if !sets.contains(&&keys[*k]) {
            sets.push(&keys[*k]);
        }
    }
    let map = |v: f64| if what.logarithmic { v.abs().log10() } else { v };
    let mut drawn = Vec::new();
    for set in sets {
        for curve in what.curves {
            let y = table.column(curve.column)?;
            let own = rows.iter().filter(|k| keys[**k] == *set);
            let points: Vec<_> = own
                .map(|k| (map(x[*k]), map(what.y_times * y[*k])))
                .filter(|(a, b)| a.is_finite() && b.is_finite())
                .collect();
            // What should come out has one name, whatever is varied.
            let words = std::iter::once(curve.label).filter(|l| !l.is_empty());
            let split = set.iter().map(String::as_str).filter(|_| !curve.exact);
            let label = words.chain(split).collect::<Vec<_>>().join(", ");
            if !points.is_empty() {
                drawn.push(Drawn { label, exact: curve.exact, points });
            }
        }
    }
    if drawn.is_empty() {
        return Err(PlotError::data(table.path(), format!("no row has a value on both axes: {:?}", panel.only)));
    }
    Ok(drawn)
}
