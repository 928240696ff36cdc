//! Normal pressure on the barrier over its height, at several instants.

use std::path::Path;

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::axes::{Axis, Frame, Margins};
use super::style::{INK, TEXT_PX, drawing, line, render, stroke, units, viridis, write_at};
use super::{PlotError, by_time, time_decimals};
use crate::output::Table;

const HEIGHT_PX: i32 = 520;

/// Draws `out_svg` from a tidy table of `time_s`, `height_m` and `pressure_pa`: one line per time, early ones dark.
///
/// # Errors
/// [`PlotError::File`] for a missing column or file, [`PlotError::Data`] for a table without a pressure.
pub fn draw(pressure_profile_csv: impl AsRef<Path>, out_svg: impl AsRef<Path>) -> Result<(), PlotError> {
    let table = Table::load(pressure_profile_csv)?;
    let height = table.column("height_m")?;
    let pressure = table.column("pressure_pa")?;
    let mut groups = by_time(&table)?;
    for (_, rows) in &mut groups {
        rows.retain(|k| height[*k].is_finite() && pressure[*k].is_finite());
        rows.sort_by(|a, b| height[*a].total_cmp(&height[*b]));
    }
    groups.retain(|(_, rows)| !rows.is_empty());
    if groups.is_empty() {
        return Err(PlotError::data(table.path(), "no row has a time, a height and a pressure"));
    }
    let shown = || groups.iter().flat_map(|(_, rows)| rows.iter().copied());
    let (lo, hi) = shown().fold((0.0, 0.0), |(lo, hi): (f64, f64), k| (lo.min(pressure[k]), hi.max(pressure[k])));
    let (bottom, top) = shown().fold((0.0, 0.0), |(lo, hi): (f64, f64), k| (lo.min(height[k]), hi.max(height[k])));
    let (scale, unit) = if hi.max(-lo) >= 2e3 { (1e-3, "kPa") } else { (1.0, "Pa") };
    let x = Axis::round(lo * scale, if hi > lo { hi * scale } else { 1.0 }, 6);
    let y = Axis::round(bottom, if top > bottom { top } else { bottom + 0.1 }, 6);
    let decimals = time_decimals(groups.iter().map(|(time, _)| *time));
    let margins = Margins { left: 68.0, right: 118.0, top: 20.0, bottom: 46.0 };

    render(out_svg.as_ref(), HEIGHT_PX, |canvas| {
        let titles = (format!("normal pressure ({unit})"), "height above the foot of the barrier (m)");
        let frame = Frame::draw(canvas, &margins, (&x, &titles.0), (&y, titles.1))?;
        let (_, right, top, bottom) = frame.bounds();
        let pitch = units(22.0).min((bottom - top) / (groups.len() as i32 + 1));
        for (k, (time, rows)) in groups.iter().enumerate() {
            // The yellow end of the map is too pale for a line on white.
            let colour = viridis(0.88 * k as f64 / (groups.len() - 1).max(1) as f64);
            let (p, h): (Vec<f64>, Vec<f64>) = rows.iter().map(|k| (pressure[*k] * scale, height[*k])).unzip();
            let spots: Vec<_> = p.iter().zip(&h).map(|(p, h)| frame.spot(*p, *h)).collect();
            let marker = ShapeStyle { color: colour.to_rgba(), filled: true, stroke_width: 0 };
            if spots.len() < 60 {
                for spot in &spots {
                    canvas.draw(&Circle::new(*spot, units(2.2), marker)).map_err(drawing)?;
                }
            }
            stroke(canvas, spots, line(colour, 1.6))?;
            let at = (right + units(16.0), top + pitch * (k as i32 + 1));
            stroke(canvas, vec![at, (at.0 + units(20.0), at.1)], line(colour, 2.4))?;
            let text = format!("{time:.decimals$} s");
            write_at(canvas, &text, (at.0 + units(27.0), at.1), TEXT_PX, INK, HPos::Left)?;
        }
        Ok(())
    })
}
