//! A heat map: one number for every pair of two parameters, in panels, on a logarithmic scale of colour.

use std::path::Path;

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::PlotError;
use super::axes::power_of_ten;
use super::style::{INK, SMALL_PX, TEXT_PX, WIDTH_PX, drawing, line, render, stroke, units, viridis, write_at};
use crate::check::significant;
use crate::output::Table;

const COLUMNS: usize = 2;
const CELL_PX: f64 = 32.0;
/// Above the cells of a panel, and below them.
const HEAD_PX: f64 = 34.0;
const FOOT_PX: f64 = 50.0;
const LEFT_PX: f64 = 74.0;
const SCALE_PX: f64 = 62.0;

/// What to draw from a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HeatMap {
    /// Column whose text tells the panels apart.
    pub panel: &'static str,
    /// Its values, and what to write above their panels.
    pub panels: &'static [(&'static str, &'static str)],
    /// Column along the horizontal axis; one column of cells for every value.
    pub x: &'static str,
    /// Title of the horizontal axis, with its unit.
    pub x_title: &'static str,
    /// Column along the vertical axis; one row of cells for every value.
    pub y: &'static str,
    /// Title of the vertical axis, with its unit.
    pub y_title: &'static str,
    /// Column of the numbers; their magnitude gives the colour.
    pub value: &'static str,
    /// What the numbers are, with their unit.
    pub value_title: &'static str,
}

/// One panel: its parameters along both axes, and the numbers by row and column.
struct Cells {
    title: &'static str,
    x: Vec<f64>,
    y: Vec<f64>,
    values: Vec<Vec<f64>>,
}

/// Draws `out_svg` from `csv`. Empty cells stay white.
///
/// # Errors
/// [`PlotError::File`] for a missing column or file, [`PlotError::Data`] for a panel without a number.
pub fn draw(csv: impl AsRef<Path>, what: &HeatMap, out_svg: impl AsRef<Path>) -> Result<(), PlotError> {
    let table = Table::load(csv)?;
    let panels = what.panels.iter().map(|p| select(&table, what, p)).collect::<Result<Vec<_>, _>>()?;
    let logs = panels.iter().flat_map(|p| p.values.iter().flatten()).filter(|v| **v != 0.0 && v.is_finite());
    let (lo, hi) =
        logs.map(|v| v.abs().log10()).fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    if lo > hi {
        return Err(PlotError::data(table.path(), "no number differs from zero"));
    }
    // Below a ten-thousandth of the largest nothing is told apart any more.
    let (lo, hi) = (lo.floor().max(hi.ceil() - 4.0), hi.ceil());
    let share = |v: f64| if v == 0.0 { 0.0 } else { (v.abs().log10() - lo) / (hi - lo) };
    let deep = panels.iter().map(|p| p.y.len()).max().unwrap_or(1) as f64;
    let pitch = HEAD_PX + CELL_PX * deep + FOOT_PX;
    let height = pitch * panels.len().div_ceil(COLUMNS) as f64;
    render(out_svg.as_ref(), (height + SCALE_PX) as i32, |canvas| {
        let wide = f64::from(WIDTH_PX) / COLUMNS as f64;
        for (k, p) in panels.iter().enumerate() {
            let (x0, y0) = (wide * (k % COLUMNS) as f64 + LEFT_PX, pitch * (k / COLUMNS) as f64 + HEAD_PX);
            let cell = (wide - LEFT_PX - 16.0) / p.x.len() as f64;
            let at = |x: f64, y: f64| (units(x0 + cell * x), units(y0 + CELL_PX * y));
            write_at(canvas, p.title, at(0.5 * p.x.len() as f64, -0.45), TEXT_PX, INK, HPos::Center)?;
            for (j, (y, row)) in p.y.iter().zip(&p.values).enumerate() {
                let j = j as f64;
                write_at(canvas, &significant(*y, 4), at(-0.08, j + 0.5), SMALL_PX, INK, HPos::Right)?;
                for (i, v) in row.iter().enumerate().filter(|(_, v)| v.is_finite()) {
                    let i = i as f64;
                    let colour = viridis(share(*v));
                    let box_ = [at(i, j), at(i + 1.0, j + 1.0)];
                    canvas.draw(&Rectangle::new(box_, colour.filled())).map_err(drawing)?;
                    let ink = if share(*v) < 0.6 { WHITE } else { INK };
                    let text = significant(*v, 2).replace('-', "\u{2212}");
                    write_at(canvas, &text, at(i + 0.5, j + 0.5), SMALL_PX, ink, HPos::Center)?;
                }
            }
            for (i, x) in p.x.iter().enumerate() {
                let spot = at(i as f64 + 0.5, p.y.len() as f64 + 0.35);
                write_at(canvas, &significant(*x, 4), spot, SMALL_PX, INK, HPos::Center)?;
            }
            let under = at(0.5 * p.x.len() as f64, p.y.len() as f64 + 0.95);
            write_at(canvas, what.x_title, under, SMALL_PX, INK, HPos::Center)?;
            write_at(canvas, what.y_title, at(0.0, -0.45), SMALL_PX, INK, HPos::Right)?;
        }
        scale(canvas, what, height, [lo, hi])
    })
}

/// The scale of colour, with its decades.
fn scale(canvas: &super::style::Canvas<'_>, what: &HeatMap, top: f64, [lo, hi]: [f64; 2]) -> Result<(), PlotError> {
    let (left, wide, high, steps) = (LEFT_PX, 320.0, 12.0, 80);
    for k in 0..steps {
        let x = |k: i32| units(left + wide * f64::from(k) / f64::from(steps));
        let colour = viridis((f64::from(k) + 0.5) / f64::from(steps));
        let ends = [(x(k), units(top + 4.0)), (x(k + 1), units(top + 4.0 + high))];
        canvas.draw(&Rectangle::new(ends, colour.filled())).map_err(drawing)?;
    }
    for decade in lo as i32..=hi as i32 {
        let x = units(left + wide * (f64::from(decade) - lo) / (hi - lo));
        stroke(canvas, vec![(x, units(top + 4.0 + high)), (x, units(top + 8.0 + high))], line(INK, 1.0))?;
        write_at(canvas, &power_of_ten(decade), (x, units(top + 30.0)), SMALL_PX, INK, HPos::Center)?;
    }
    let at = (units(left + wide + 16.0), units(top + 4.0 + 0.5 * high));
    write_at(canvas, what.value_title, at, SMALL_PX, INK, HPos::Left)
}

/// The rows of a panel as cells: coarse on the left, few above.
fn select(table: &Table, what: &HeatMap, (key, title): &(&'static str, &'static str)) -> Result<Cells, PlotError> {
    let (x, y, value) = (table.column(what.x)?, table.column(what.y)?, table.column(what.value)?);
    let names = table.cells(what.panel)?;
    let rows: Vec<usize> = (0..table.rows()).filter(|k| names[*k] == *key).collect();
    let distinct = |of: &[f64]| {
        let mut all: Vec<f64> = rows.iter().map(|k| of[*k]).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    };
    let (mut xs, ys) = (distinct(x), distinct(y));
    xs.reverse();
    let mut values = vec![vec![f64::NAN; xs.len()]; ys.len()];
    for &k in &rows {
        let place = (ys.iter().position(|v| *v == y[k]), xs.iter().position(|v| *v == x[k]));
        if let (Some(j), Some(i)) = place {
            values[j][i] = value[k];
        }
    }
    if values.iter().flatten().all(|v| v.is_nan()) {
        return Err(PlotError::data(table.path(), format!("no number for {key}")));
    }
    Ok(Cells { title, x: xs, y: ys, values })
}
