//! Normal force on the barrier against time.

use std::path::Path;

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::PlotError;
use super::axes::{Axis, Frame, Margins};
use super::labels::spread;
use super::style::{
    BLUE, Canvas, GREEN, GREY, INK, ORANGE, PURPLE, SKY, SMALL_PX, Spot, TEXT_PX, VERMILION, dashes, drawing, fill,
    line, render, stroke, text_width_px, units, write_at,
};
use crate::output::Table;

/// A force to compare with, drawn as a horizontal line.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferenceLine {
    /// What it is, in a few words; may have line breaks.
    pub label: String,
    /// The force (N).
    pub value_n: f64,
    /// Half width of a band around it (N): an uncertainty, or the span between two limits; 0 for a line alone.
    pub half_width_n: f64,
}

impl ReferenceLine {
    /// A line alone.
    pub fn new(label: impl Into<String>, value_n: f64) -> Self {
        Self { label: label.into(), value_n, half_width_n: 0.0 }
    }
}

/// Colours of the reference lines, in turn.
const REFERENCES: [RGBColor; 6] = [VERMILION, GREEN, PURPLE, SKY, GREY, INK];
/// Width at which the name of a reference line is wrapped (px).
const WRAP_PX: f64 = 170.0;
const HEIGHT_PX: i32 = 480;

/// Draws `out_svg` from a history: the normal force from the grid's impulse, that from the stress in two layers of
/// material points, the reference forces and the peak.
///
/// Reads `time_s`, `force_normal_n`, `force_layer2_n` and `force_normal_max_n`; gaps (empty cells) are left out.
///
/// # Errors
/// [`PlotError::File`] for a missing column or file, [`PlotError::Data`] for a table without a force,
/// [`PlotError::Argument`] for a reference that is not a finite number.
pub fn draw(
    history_csv: impl AsRef<Path>,
    lines: &[ReferenceLine],
    out_svg: impl AsRef<Path>,
) -> Result<(), PlotError> {
    let table = Table::load(history_csv)?;
    let time = table.column("time_s")?;
    let force = table.column("force_normal_n")?;
    let layers = table.column("force_layer2_n")?;
    let step_max = table.column("force_normal_max_n")?;
    if let Some(line) = lines.iter().find(|line| !line.value_n.is_finite()) {
        return Err(PlotError::Argument(format!("the reference force {:?} is not a finite number", line.label)));
    }
    let peak = (0..table.rows())
        .filter(|k| time[*k].is_finite() && force[*k].is_finite())
        .reduce(|best, k| if force[k] > force[best] { k } else { best })
        .ok_or_else(|| PlotError::data(table.path(), "no row has both a time and a normal force"))?;
    let largest_step = step_max.iter().copied().filter(|v| v.is_finite()).reduce(f64::max);

    let finite = |values: &[f64]| values.iter().copied().filter(|v| v.is_finite()).collect::<Vec<_>>();
    let times = finite(time);
    let values: Vec<f64> = finite(force)
        .into_iter()
        .chain(finite(layers))
        .chain(lines.iter().map(|line| line.value_n + line.half_width_n))
        .collect();
    let (lo, hi) = values.iter().fold((0.0, 0.0), |(lo, hi): (f64, f64), v| (lo.min(*v), hi.max(*v)));
    let (scale, unit) = if hi.max(-lo) >= 20e3 { (1e-3, "kN") } else { (1.0, "N") };
    let scaled = |values: &[f64]| values.iter().map(|v| v * scale).collect::<Vec<_>>();
    let y = Axis::round(lo * scale, hi * scale, 6);
    let first = times.iter().copied().fold(f64::INFINITY, f64::min);
    let last = times.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    // The first sample ends one interval after the start.
    let x = Axis::exact(if first > 0.0 && first < 0.02 * last { 0.0 } else { first }, last, 7);

    let names: Vec<Vec<String>> = lines
        .iter()
        .map(|line| {
            let mut text = wrap(&line.label);
            text.push(match line.half_width_n * scale {
                0.0 => format!("{} {unit}", short(line.value_n * scale)),
                half => {
                    format!("{} to {} {unit}", short(line.value_n * scale - half), short(line.value_n * scale + half))
                }
            });
            text
        })
        .collect();
    let widest = names.iter().flatten().map(|text| text_width_px(text, SMALL_PX)).fold(0.0, f64::max);
    let right = if names.is_empty() { 24.0 } else { widest.min(260.0) + 22.0 };
    let margins = Margins { left: 68.0, right, top: 62.0, bottom: 46.0 };

    render(out_svg.as_ref(), HEIGHT_PX, |canvas| {
        let frame = Frame::draw(canvas, &margins, (&x, "time (s)"), (&y, &format!("normal force ({unit})")))?;
        let (left, right, top, bottom) = frame.bounds();
        for (k, line) in lines.iter().enumerate().filter(|(_, line)| line.half_width_n > 0.0) {
            let edge =
                |sign: f64| frame.spot(x.lo, (line.value_n + sign * line.half_width_n) * scale).1.clamp(top, bottom);
            let corners = vec![(left, edge(1.0)), (right, edge(1.0)), (right, edge(-1.0)), (left, edge(-1.0))];
            fill(canvas, corners, &REFERENCES[k % REFERENCES.len()].mix(0.16))?;
        }
        let heights: Vec<i32> = lines.iter().map(|line| frame.spot(x.lo, line.value_n * scale).1).collect();
        frame.series(canvas, time, &scaled(force), line(BLUE, 2.2))?;
        // Seen through, so that neither hides the other where they agree.
        let thin = ShapeStyle { color: ORANGE.mix(0.75), ..line(ORANGE, 0.9) };
        frame.series(canvas, time, &scaled(layers), thin)?;
        for (k, height) in heights.iter().enumerate() {
            dashes(canvas, (left, *height), right, REFERENCES[k % REFERENCES.len()], 1.3)?;
        }

        let pitch = SMALL_PX + 3.0;
        let tallest = names.iter().map(Vec::len).max().unwrap_or(0) as f64;
        let wanted: Vec<f64> = heights.iter().map(|h| f64::from(*h)).collect();
        let (from, to) = (f64::from(top + units(pitch)), f64::from(bottom - units(pitch)));
        let placed = spread(&wanted, f64::from(units(tallest * pitch + 7.0)), from, to);
        for (k, name) in names.iter().enumerate() {
            let (at, colour) = (placed[k].round() as i32, REFERENCES[k % REFERENCES.len()]);
            stroke(canvas, vec![(right, heights[k]), (right + units(10.0), at)], line(colour, 1.0))?;
            for (row, text) in name.iter().enumerate() {
                let y = at + units((row as f64 - 0.5 * (name.len() - 1) as f64) * pitch);
                let ink = if row + 1 < name.len() { INK } else { GREY };
                write_at(canvas, text, (right + units(14.0), y), SMALL_PX, ink, HPos::Left)?;
            }
        }

        let keys = [
            ("force from the grid's impulse", BLUE, 2.2),
            ("force from stress, two layers of material points", ORANGE, 1.2),
        ];
        legend(canvas, (left, top - units(40.0)), &keys)?;
        let mut text = format!("peak {} {unit} at {:.3} s", short(force[peak] * scale), time[peak]);
        if let Some(largest) = largest_step {
            text.push_str(&format!(" (single step: {} {unit})", short(largest * scale)));
        }
        let spot = frame.spot(time[peak], force[peak] * scale);
        mark_peak(canvas, spot, &text, (left, top - units(18.0)))
    })
}

/// Breaks a label at its line breaks, and between words into lines of about [`WRAP_PX`].
fn wrap(label: &str) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for part in label.lines() {
        lines.push(String::new());
        for word in part.split_whitespace() {
            match lines.last_mut() {
                Some(line) if line.is_empty() => line.push_str(word),
                Some(line) if text_width_px(&format!("{line} {word}"), SMALL_PX) <= WRAP_PX => {
                    line.push(' ');
                    line.push_str(word);
                }
                _ => lines.push(word.to_owned()),
            }
        }
    }
    lines
}

/// A number with about three significant digits, as it would be said in a report.
fn short(value: f64) -> String {
    match value.abs() {
        v if v >= 99.95 => format!("{value:.0}"),
        v if v >= 9.995 => format!("{value:.1}"),
        _ => format!("{value:.2}"),
    }
}

/// One row of line samples with their names, outside the plotting area so that it never covers data.
fn legend(canvas: &Canvas<'_>, at: Spot, keys: &[(&str, RGBColor, f64)]) -> Result<(), PlotError> {
    let (mut x, y) = at;
    for (name, colour, px) in keys {
        stroke(canvas, vec![(x, y), (x + units(24.0), y)], line(*colour, *px))?;
        write_at(canvas, name, (x + units(30.0), y), TEXT_PX, INK, HPos::Left)?;
        x += units(30.0 + text_width_px(name, TEXT_PX) + 12.0);
    }
    Ok(())
}

/// Marks the peak with a dot and explains the dot in the legend's second row: beside a noisy peak there is no room for text.
fn mark_peak(canvas: &Canvas<'_>, peak: Spot, text: &str, key: Spot) -> Result<(), PlotError> {
    let ring = ShapeStyle { color: WHITE.to_rgba(), filled: true, stroke_width: 0 };
    let dot = ShapeStyle { color: INK.to_rgba(), filled: true, stroke_width: 0 };
    canvas.draw(&Circle::new(peak, units(4.4), ring)).map_err(drawing)?;
    canvas.draw(&Circle::new(peak, units(3.2), dot)).map_err(drawing)?;
    canvas.draw(&Circle::new((key.0 + units(12.0), key.1), units(3.2), dot)).map_err(drawing)?;
    write_at(canvas, text, (key.0 + units(30.0), key.1), TEXT_PX, INK, HPos::Left)
}
