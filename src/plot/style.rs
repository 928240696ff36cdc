//! What all figures share: canvas, colours, widths, text.

use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::PlotError;
use crate::output::write_text;

/// Canvas units per pixel of the finished figure. The drawing library rounds to whole units; this keeps that invisible.
pub(super) const UNIT: i32 = 4;
/// Width of every figure (px).
pub(super) const WIDTH_PX: i32 = 800;
/// Height of text (px).
pub(super) const TEXT_PX: f64 = 13.0;
/// Height of secondary text (px).
pub(super) const SMALL_PX: f64 = 12.0;

/// Text and axes.
pub(super) const INK: RGBColor = RGBColor(34, 34, 34);
/// Secondary text, leaders.
pub(super) const GREY: RGBColor = RGBColor(96, 96, 96);
/// Rigid boundaries.
pub(super) const WALL: RGBColor = RGBColor(72, 72, 72);
/// Grid lines.
pub(super) const GRID: RGBColor = RGBColor(226, 226, 226);

// The palette of Okabe and Ito, told apart by all common forms of colour vision.
pub(super) const BLUE: RGBColor = RGBColor(0, 114, 178);
pub(super) const SKY: RGBColor = RGBColor(86, 180, 233);
pub(super) const ORANGE: RGBColor = RGBColor(230, 159, 0);
pub(super) const VERMILION: RGBColor = RGBColor(213, 94, 0);
pub(super) const GREEN: RGBColor = RGBColor(0, 158, 115);
pub(super) const PURPLE: RGBColor = RGBColor(204, 121, 167);
pub(super) const YELLOW: RGBColor = RGBColor(240, 228, 66);

/// A figure being drawn.
pub(super) type Canvas<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// A point of the canvas (units, from the upper left corner).
pub(super) type Spot = (i32, i32);

/// Draws a figure of [`WIDTH_PX`] by `height_px` and puts it at `path`.
pub(super) fn render(
    path: &Path,
    height_px: i32,
    draw: impl FnOnce(&Canvas<'_>) -> Result<(), PlotError>,
) -> Result<(), PlotError> {
    let (width, height) = (WIDTH_PX * UNIT, height_px * UNIT);
    let mut svg = String::new();
    {
        let canvas = SVGBackend::with_string(&mut svg, (width as u32, height as u32)).into_drawing_area();
        canvas.fill(&WHITE).map_err(drawing)?;
        draw(&canvas)?;
        canvas.present().map_err(drawing)?;
    }
    // The library states the size in units; the figure is to come up in pixels, with joins that do not spike.
    let stated = format!("width=\"{width}\" height=\"{height}\"");
    let wanted = format!("width=\"{WIDTH_PX}\" height=\"{height_px}\" stroke-linejoin=\"round\"");
    write_text(path, &svg.replacen(&stated, &wanted, 1))?;
    Ok(())
}

/// Reports a refusal of the drawing library.
pub(super) fn drawing(error: impl std::fmt::Display) -> PlotError {
    PlotError::Drawing(error.to_string())
}

/// Pixels in whole canvas units.
pub(super) fn units(px: f64) -> i32 {
    (px * f64::from(UNIT)).round() as i32
}

/// A line `px` wide.
pub(super) fn line(colour: RGBColor, px: f64) -> ShapeStyle {
    ShapeStyle { color: colour.to_rgba(), filled: false, stroke_width: units(px).max(1) as u32 }
}

/// Text `px` high, placed by `h` and `v`. The library writes fonts 1.24 times smaller than it is told.
pub(super) fn text_style(px: f64, colour: RGBColor, h: HPos, v: VPos) -> TextStyle<'static> {
    ("sans-serif", px * 1.24 * f64::from(UNIT)).into_font().color(&colour).pos(Pos::new(h, v))
}

/// Width of a text (px), on the generous side, for the fonts that stand in for `sans-serif`.
pub(super) fn text_width_px(text: &str, px: f64) -> f64 {
    let share = |c: char| match c {
        'i' | 'j' | 'l' | '.' | ',' | ':' | '\'' | '|' | ' ' => 0.34,
        'f' | 'r' | 't' | '(' | ')' | '-' | '/' => 0.43,
        'm' | 'w' | 'M' | 'W' | '%' => 0.95,
        'A'..='Z' => 0.7,
        _ => 0.62,
    };
    text.chars().map(share).sum::<f64>() * px
}

/// Writes `text` at `at`, vertically centred on it.
pub(super) fn write_at(
    canvas: &Canvas<'_>,
    text: &str,
    at: Spot,
    px: f64,
    colour: RGBColor,
    h: HPos,
) -> Result<(), PlotError> {
    canvas.draw(&Text::new(text.to_owned(), at, text_style(px, colour, h, VPos::Center))).map_err(drawing)
}

/// Draws a line through spots.
pub(super) fn stroke(canvas: &Canvas<'_>, spots: Vec<Spot>, style: ShapeStyle) -> Result<(), PlotError> {
    canvas.draw(&PathElement::new(spots, style)).map_err(drawing)
}

/// Fills a polygon.
pub(super) fn fill(canvas: &Canvas<'_>, spots: Vec<Spot>, colour: &impl Color) -> Result<(), PlotError> {
    canvas.draw(&Polygon::new(spots, colour.to_rgba().filled())).map_err(drawing)
}

/// A horizontal dashed line, `px` wide.
pub(super) fn dashes(canvas: &Canvas<'_>, from: Spot, to: i32, colour: RGBColor, px: f64) -> Result<(), PlotError> {
    let (mut x, y) = from;
    while x < to {
        let end = (x + 7 * UNIT).min(to);
        stroke(canvas, vec![(x, y), (end, y)], line(colour, px))?;
        x += 11 * UNIT;
    }
    Ok(())
}

/// No dashes.
pub(super) const SOLID: &[f64] = &[];

/// Draws a line through spots in dashes: lengths of strokes and gaps in turn, px. The pattern runs on around corners.
pub(super) fn dashed(canvas: &Canvas<'_>, spots: &[Spot], style: ShapeStyle, pattern: &[f64]) -> Result<(), PlotError> {
    if pattern.is_empty() {
        return stroke(canvas, spots.to_vec(), style);
    }
    strokes(spots, pattern).into_iter().try_for_each(|part| stroke(canvas, part, style))
}

/// The strokes of a dashed line.
fn strokes(spots: &[Spot], pattern: &[f64]) -> Vec<Vec<Spot>> {
    let (mut k, mut left) = (0, pattern[0] * f64::from(UNIT));
    let mut parts: Vec<Vec<Spot>> = Vec::new();
    let mut part: Vec<Spot> = spots.first().copied().into_iter().collect();
    for pair in spots.windows(2) {
        let (dx, dy) = (f64::from(pair[1].0 - pair[0].0), f64::from(pair[1].1 - pair[0].1));
        let length = dx.hypot(dy);
        let mut at = 0.0;
        while length - at > left {
            at += left;
            let share = at / length;
            let spot = (pair[0].0 + (share * dx).round() as i32, pair[0].1 + (share * dy).round() as i32);
            if k % 2 == 0 {
                part.push(spot);
                parts.push(std::mem::take(&mut part));
            } else {
                part = vec![spot];
            }
            k = (k + 1) % pattern.len();
            left = pattern[k] * f64::from(UNIT);
        }
        left -= length - at;
        if k % 2 == 0 {
            part.push(pair[1]);
        }
    }
    if part.len() > 1 {
        parts.push(part);
    }
    parts
}

/// Anchors of the viridis colour map, evenly spaced: dark is low, and lightness rises steadily.
const VIRIDIS: [[f64; 3]; 9] = [
    [68.0, 1.0, 84.0],
    [71.0, 44.0, 122.0],
    [59.0, 81.0, 139.0],
    [44.0, 113.0, 142.0],
    [33.0, 144.0, 141.0],
    [39.0, 173.0, 129.0],
    [92.0, 200.0, 99.0],
    [170.0, 220.0, 50.0],
    [253.0, 231.0, 37.0],
];

/// The viridis colour at `share`, from 0 to 1.
pub(super) fn viridis(share: f64) -> RGBColor {
    let at = share.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    let k = (at as usize).min(VIRIDIS.len() - 2);
    let blend = |c: usize| (VIRIDIS[k][c] + (VIRIDIS[k + 1][c] - VIRIDIS[k][c]) * (at - k as f64)).round() as u8;
    RGBColor(blend(0), blend(1), blend(2))
}

/// `colour` mixed with white; 0 leaves it, 1 is white.
pub(super) fn lighten(colour: RGBColor, share: f64) -> RGBColor {
    let mix = |c: u8| (f64::from(c) + (255.0 - f64::from(c)) * share).round() as u8;
    RGBColor(mix(colour.0), mix(colour.1), mix(colour.2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_run_on_around_corners() {
        let corner = [(0, 0), (10 * UNIT, 0), (10 * UNIT, 10 * UNIT)];
        let parts = strokes(&corner, &[6.0, 2.0]);
        let u = UNIT;
        assert_eq!(
            parts,
            [
                vec![(0, 0), (6 * u, 0)],
                vec![(8 * u, 0), (10 * u, 0), (10 * u, 4 * u)],
                vec![(10 * u, 6 * u), (10 * u, 10 * u)]
            ]
        );
    }
}
