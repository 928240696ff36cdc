//! Where the released energy is at every instant: stacked shares of the energy at the start.

use std::path::Path;

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::PlotError;
use super::axes::{Axis, Frame, Margins};
use super::energy_layers::{Band, Layer, columns, group, paint, stack, title};
use super::labels::spread;
use super::style::{
    Canvas, GREY, INK, SMALL_PX, Spot, UNIT, dashes, fill, line, render, stroke, text_width_px, units, write_at,
};
use crate::output::Table;

/// Number of instants drawn at most.
const INSTANTS: usize = 600;
const HEIGHT_PX: i32 = 520;

/// Draws `out_svg` from an energy table: one area per column in J, stacked, and the residual of the balance as a line.
///
/// Reads `time_s` and every column in `_j`; those in `gravitational_j`, `kinetic_j` and `elastic_j` of the first
/// row make up the whole. Negative shares stack below zero, empty cells count as 0. Mechanisms that never reach
/// 0.2 % are drawn together as "other".
///
/// # Errors
/// [`PlotError::File`] for a missing column or file, [`PlotError::Data`] for a table without rows or initial energy.
pub fn draw(energy_csv: impl AsRef<Path>, out_svg: impl AsRef<Path>) -> Result<(), PlotError> {
    let table = Table::load(energy_csv)?;
    let rows = instants(&table)?;
    let time: Vec<f64> = pick(table.column("time_s")?, &rows);
    let mut whole = 0.0;
    for name in ["gravitational_j", "kinetic_j", "elastic_j"] {
        whole += table.column(name)?[rows[0]];
    }
    if !(whole.is_finite() && whole > 0.0) {
        return Err(PlotError::data(table.path(), format!("the energy of the first row is {whole} J, not positive")));
    }
    let share = |name: &str| -> Result<Vec<f64>, PlotError> {
        let values = pick(table.column(name)?, &rows);
        Ok(values.iter().map(|v| if v.is_finite() { 100.0 * v / whole } else { 0.0 }).collect())
    };
    let residual = share("residual_j")?;
    let mut layers = Vec::new();
    for name in columns(&table) {
        let share = share(&name)?;
        layers.push(Layer { name: title(&name), column: name, colour: GREY, share });
    }
    let mut layers = group(layers);
    paint(&mut layers);
    let bands = stack(&layers, time.len());

    let ends = bands.iter().flatten().flat_map(|b| [b.above.1, b.below.1]).chain(residual.iter().copied());
    let (lo, hi) = ends.fold((0.0, 100.0), |(lo, hi): (f64, f64), v| (lo.min(v), hi.max(v)));
    // A strip below zero keeps the residual apart from the axis.
    let y = Axis::exact((1.1 * lo).min(-3.0), hi, 5);
    let x = Axis::exact(time[0], time[time.len() - 1], 7);
    let names: Vec<String> = layers.iter().map(end_label).collect();
    let right = names.iter().map(|name| text_width_px(name, SMALL_PX)).fold(0.0, f64::max).min(280.0) + 34.0;
    let margins = Margins { left: 62.0, right, top: 40.0, bottom: 46.0 };

    render(out_svg.as_ref(), HEIGHT_PX, |canvas| {
        let frame = Frame::draw(canvas, &margins, (&x, "time (s)"), (&y, "share of the initial energy (%)"))?;
        let (left, right, top, bottom) = frame.bounds();
        areas(canvas, &frame, &time, &layers, &bands)?;
        dashes(canvas, (left, frame.spot(x.lo, 100.0).1), right, INK, 1.0)?;
        frame.series(canvas, &time, &residual, line(INK, 1.6))?;

        let mut outside = Vec::new();
        for (k, (layer, band)) in layers.iter().zip(&bands).enumerate() {
            let (from, to) = band[band.len() - 1].larger();
            let spot = (right, frame.spot(x.hi, 0.5 * (from + to)).1);
            match inside(&frame, &time, band, &layer.name) {
                // A share that is spent by the end has no height to point at.
                Some(at) if layer.share[layer.share.len() - 1].abs() < 0.5 => {
                    write_at(canvas, &layer.name, at, SMALL_PX, ink_on(layer.colour), HPos::Center)?;
                }
                _ => outside.push((k, spot)),
            }
        }
        let wanted: Vec<f64> = outside.iter().map(|(_, spot)| f64::from(spot.1)).collect();
        let placed =
            spread(&wanted, f64::from(units(19.0)), f64::from(top + units(6.0)), f64::from(bottom - units(6.0)));
        for ((k, spot), at) in outside.iter().zip(placed) {
            let at = (right + units(12.0), at.round() as i32);
            stroke(canvas, vec![*spot, at], line(GREY, 0.8))?;
            let swatch = [(0.0, -5.0), (10.0, -5.0), (10.0, 5.0), (0.0, 5.0)];
            let corners = swatch.map(|(dx, dy)| (at.0 + units(dx), at.1 + units(dy)));
            fill(canvas, corners.to_vec(), &layers[*k].colour)?;
            write_at(canvas, &names[*k], (at.0 + units(15.0), at.1), SMALL_PX, INK, HPos::Left)?;
        }

        let largest = residual.iter().fold(0.0, |largest: f64, v| if v.abs() > largest.abs() { *v } else { largest });
        let key = (left, top - units(18.0));
        stroke(canvas, vec![key, (key.0 + units(24.0), key.1)], line(INK, 1.6))?;
        let text = format!("residual of the balance (largest {} %)", signed(largest));
        write_at(canvas, &text, (key.0 + units(30.0), key.1), SMALL_PX, INK, HPos::Left)?;
        let text = format!("100 % = {whole:.1} J");
        write_at(canvas, &text, (right, key.1), SMALL_PX, GREY, HPos::Right)
    })
}

/// Rows to draw: all that have a time, or evenly many of them, the first and the last always.
fn instants(table: &Table) -> Result<Vec<usize>, PlotError> {
    let time = table.column("time_s")?;
    let rows: Vec<usize> = (0..table.rows()).filter(|k| time[*k].is_finite()).collect();
    match rows.len() {
        0 => Err(PlotError::data(table.path(), "no row has a time")),
        count if count <= INSTANTS => Ok(rows),
        count => Ok((0..INSTANTS).map(|k| rows[k * (count - 1) / (INSTANTS - 1)]).collect()),
    }
}

fn pick(values: &[f64], rows: &[usize]) -> Vec<f64> {
    rows.iter().map(|k| values[*k]).collect()
}

/// Fills the layers, each from zero to its far end and the farthest first: neighbours overlap, so nothing shows between them.
fn areas(
    canvas: &Canvas<'_>,
    frame: &Frame<'_>,
    time: &[f64],
    layers: &[Layer],
    bands: &[Vec<Band>],
) -> Result<(), PlotError> {
    for (layer, band) in layers.iter().zip(bands).rev() {
        for side in [|b: &Band| b.above, |b: &Band| b.below] {
            if band.iter().map(side).all(|(near, far)| near == far) {
                continue;
            }
            let edge = time.iter().zip(band).map(|(t, b)| frame.spot(*t, side(b).1));
            let mut outline: Vec<Spot> = edge.collect();
            outline.push(frame.spot(time[time.len() - 1], 0.0));
            outline.push(frame.spot(time[0], 0.0));
            fill(canvas, outline, &layer.colour)?;
        }
    }
    Ok(())
}

/// The middle of the roomiest place for `name` inside a layer, if there is one.
fn inside(frame: &Frame<'_>, time: &[f64], band: &[Band], name: &str) -> Option<Spot> {
    let half = units(0.5 * text_width_px(name, SMALL_PX) + 3.0);
    let edges: Vec<(i32, i32, i32)> = time
        .iter()
        .zip(band)
        .map(|(t, b)| (t, b.larger()))
        .map(|(t, (from, to))| (frame.spot(*t, from), frame.spot(*t, to)))
        .map(|(from, to)| (from.0, to.1, from.1))
        .collect();
    let (left, right, ..) = frame.bounds();
    let mut best: Option<(i32, Spot)> = None;
    for x in (left + half..=right - half).step_by(4 * UNIT as usize) {
        let under = edges.iter().filter(|edge| (edge.0 - x).abs() <= half);
        let (top, bottom) = under.fold((i32::MIN, i32::MAX), |(t, b), edge| (t.max(edge.1), b.min(edge.2)));
        let room = bottom.saturating_sub(top);
        if top > i32::MIN && room >= units(SMALL_PX + 4.0) && best.is_none_or(|(most, _)| room > most) {
            best = Some((room, (x, top + room / 2)));
        }
    }
    best.map(|(_, spot)| spot)
}

/// White or dark, whichever reads better on `colour`.
fn ink_on(colour: RGBColor) -> RGBColor {
    let light = 0.299 * f64::from(colour.0) + 0.587 * f64::from(colour.1) + 0.114 * f64::from(colour.2);
    if light < 120.0 { WHITE } else { INK }
}

/// Name and final share of a layer; its largest share instead where it ends at nothing.
fn end_label(layer: &Layer) -> String {
    let last = layer.share.last().copied().unwrap_or(0.0);
    if last.abs() < 0.05 && layer.largest() >= 0.05 {
        format!("{} (up to {:.1} %)", layer.name, layer.largest())
    } else {
        format!("{} {} %", layer.name, signed(last))
    }
}

/// A share with one decimal and a true minus sign; "below 0.1" where that would show as nothing.
fn signed(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        v if v.abs() < 0.1 => "< 0.1".to_owned(),
        v => format!("{v:.1}").replace('-', "\u{2212}"),
    }
}
