//! Axes with round ticks, and the thinning of long series to what a figure can show.

use plotters::coord::Shift;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, ValueFormatter};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::PlotError;
use super::style::{Canvas, GRID, INK, Spot, TEXT_PX, UNIT, drawing, line, text_style, units};

/// A range of values with its ticks.
#[derive(Debug, Clone)]
pub(super) struct Axis {
    pub(super) lo: f64,
    pub(super) hi: f64,
    pub(super) ticks: Vec<f64>,
    decimals: usize,
    /// What the ticks are called, where it is not their value.
    names: Vec<String>,
}

impl Axis {
    /// Covers `lo` to `hi`, up to the next tick if that is very near, with about `count` ticks at multiples of 1, 2 or 5 times a power of ten.
    pub(super) fn exact(lo: f64, hi: f64, count: usize) -> Self {
        let (lo, hi) = widened(lo, hi);
        let step = step(hi - lo, count);
        let next = (hi / step).ceil() * step;
        Self::with_step(lo, if next - hi < 0.005 * (hi - lo) { next } else { hi }, step)
    }

    /// Covers at least `lo` to `hi` and ends on ticks.
    pub(super) fn round(lo: f64, hi: f64, count: usize) -> Self {
        let (lo, hi) = widened(lo, hi);
        let step = step(hi - lo, count);
        Self::with_step((lo / step + 1e-9).floor() * step, (hi / step - 1e-9).ceil() * step, step)
    }

    fn with_step(lo: f64, hi: f64, step: f64) -> Self {
        let first = (lo / step - 1e-9).ceil() as i64;
        let last = (hi / step + 1e-9).floor() as i64;
        let ticks = (first..=last).map(|k| k as f64 * step).collect();
        Self { lo, hi, ticks, decimals: (-step.log10() - 1e-9).ceil().max(0.0) as usize, names: Vec::new() }
    }

    /// Covers the decimal logarithms `lo` to `hi`, from decade to decade.
    pub(super) fn decades(lo: f64, hi: f64) -> Self {
        let (first, last) = ((lo + 1e-9).floor() as i32, (hi - 1e-9).ceil() as i32);
        let last = last.max(first + 1);
        let every = ((last - first) / 6 + 1) as usize;
        let powers: Vec<i32> = (first..=last).step_by(every).collect();
        let names = powers.iter().map(|p| power_of_ten(*p)).collect();
        let ticks = powers.into_iter().map(f64::from).collect();
        Self { lo: f64::from(first), hi: f64::from(last), ticks, decimals: 0, names }
    }

    /// Ticks at these places (ascending, not empty), called so, with a little room beyond them.
    pub(super) fn named(ticks: Vec<f64>, names: Vec<String>) -> Self {
        let (lo, hi) = widened(ticks[0], ticks[ticks.len() - 1]);
        let room = 0.04 * (hi - lo);
        Self { lo: lo - room, hi: hi + room, ticks, decimals: 0, names }
    }

    /// Takes the names of these ticks away; told are a tick's place as a share of the axis and its name.
    pub(super) fn unname(&mut self, mut which: impl FnMut(f64, &str) -> bool) {
        for (tick, name) in self.ticks.iter().zip(&mut self.names) {
            if which((tick - self.lo) / (self.hi - self.lo), name) {
                name.clear();
            }
        }
    }

    /// A range without ticks.
    pub(super) fn bare(lo: f64, hi: f64) -> Self {
        Self { lo, hi, ticks: Vec::new(), decimals: 0, names: Vec::new() }
    }

    /// A tick as text.
    pub(super) fn label(&self, value: f64) -> String {
        if let Some(k) = self.ticks.iter().position(|t| *t == value)
            && let Some(name) = self.names.get(k)
        {
            return name.clone();
        }
        let text = format!("{value:.*}", self.decimals);
        if value.abs() < 1e-9 * (self.hi - self.lo) { text.replace('-', "") } else { text.replace('-', "\u{2212}") }
    }
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let share = (value - self.lo) / (self.hi - self.lo);
        limit.0 + (share * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() { Vec::new() } else { self.ticks.clone() }
    }

    fn range(&self) -> std::ops::Range<f64> {
        self.lo..self.hi
    }
}

impl ValueFormatter<f64> for Axis {
    fn format_ext(&self, value: &f64) -> String {
        self.label(*value)
    }
}

/// A power of ten as one writes it.
pub(super) fn power_of_ten(exponent: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |c: char| c.to_digit(10).map_or('⁻', |d| DIGITS[d as usize]);
    match exponent {
        0 => "1".to_owned(),
        1 => "10".to_owned(),
        _ => std::iter::once("10".to_owned())
            .chain(exponent.to_string().chars().map(|c| raised(c).to_string()))
            .collect(),
    }
}

/// The range itself, or one around it if it has no width.
fn widened(lo: f64, hi: f64) -> (f64, f64) {
    if hi - lo > 1e-12 * hi.abs().max(lo.abs()) { (lo, hi) } else { (lo - 0.5, hi.max(lo) + 0.5) }
}

/// The round step that cuts `span` into about `count` parts.
fn step(span: f64, count: usize) -> f64 {
    let rough = span / count.max(1) as f64;
    let power = 10f64.powf(rough.log10().floor());
    let factor = match rough / power {
        r if r < 1.5 => 1.0,
        r if r < 3.5 => 2.0,
        r if r < 7.5 => 5.0,
        _ => 10.0,
    };
    factor * power
}

/// Room around the plotting area (px), the axis texts included.
pub(super) struct Margins {
    pub(super) left: f64,
    pub(super) right: f64,
    pub(super) top: f64,
    pub(super) bottom: f64,
}

/// A pair of axes on the canvas.
pub(super) struct Frame<'a> {
    area: DrawingArea<SVGBackend<'a>, Cartesian2d<Axis, Axis>>,
}

impl<'a> Frame<'a> {
    /// Draws grid, axes, ticks and titles.
    pub(super) fn draw(
        canvas: &DrawingArea<SVGBackend<'a>, Shift>,
        margins: &Margins,
        (x, x_title): (&Axis, &str),
        (y, y_title): (&Axis, &str),
    ) -> Result<Self, PlotError> {
        let mut chart = ChartBuilder::on(canvas)
            .margin_right(units(margins.right))
            .margin_top(units(margins.top))
            .margin_left(units(8.0))
            .margin_bottom(units(4.0))
            .y_label_area_size(units(margins.left - 8.0))
            .x_label_area_size(units(margins.bottom - 4.0))
            .build_cartesian_2d(x.clone(), y.clone())
            .map_err(drawing)?;
        chart
            .configure_mesh()
            .bold_line_style(line(GRID, 1.0))
            .light_line_style(TRANSPARENT)
            .axis_style(line(INK, 1.0))
            .set_all_tick_mark_size(units(5.0))
            .label_style(text_style(TEXT_PX, INK, HPos::Left, VPos::Top))
            .axis_desc_style(text_style(TEXT_PX, INK, HPos::Left, VPos::Top))
            .x_desc(x_title)
            .y_desc(y_title)
            .draw()
            .map_err(drawing)?;
        Ok(Self { area: chart.plotting_area().clone() })
    }

    /// Where a pair of values lies on the canvas.
    pub(super) fn spot(&self, x: f64, y: f64) -> Spot {
        self.area.map_coordinate(&(x, y))
    }

    /// Left, right, top and bottom of the plotting area (units).
    pub(super) fn bounds(&self) -> (i32, i32, i32, i32) {
        let (x, y) = self.area.get_pixel_range();
        (x.start, x.end, y.start, y.end)
    }

    /// Draws a series as a line, thinned to first, least, largest and last value of each half pixel, broken at gaps.
    pub(super) fn series(&self, canvas: &Canvas<'_>, x: &[f64], y: &[f64], style: ShapeStyle) -> Result<(), PlotError> {
        self.dashed_series(canvas, x, y, style, super::style::SOLID)
    }

    /// The same in dashes, px.
    pub(super) fn dashed_series(
        &self,
        canvas: &Canvas<'_>,
        x: &[f64],
        y: &[f64],
        style: ShapeStyle,
        pattern: &[f64],
    ) -> Result<(), PlotError> {
        let spots: Vec<Option<Spot>> =
            x.iter().zip(y).map(|(x, y)| (x.is_finite() && y.is_finite()).then(|| self.spot(*x, *y))).collect();
        for part in spots.split(Option::is_none) {
            let part: Vec<Spot> = part.iter().flatten().copied().collect();
            if part.len() > 1 {
                super::style::dashed(canvas, &thin(&part), style, pattern)?;
            }
        }
        Ok(())
    }
}

/// Keeps first, highest, lowest and last spot of each column of half a pixel, in their order.
fn thin(spots: &[Spot]) -> Vec<Spot> {
    let column = |spot: &Spot| spot.0.div_euclid(UNIT / 2);
    let mut kept: Vec<Spot> = Vec::new();
    for group in spots.chunk_by(|a, b| column(a) == column(b)) {
        let extreme = |sign: i32| (0..group.len()).min_by_key(|k| sign * group[*k].1).unwrap_or(0);
        let mut picks = [0, extreme(1), extreme(-1), group.len() - 1];
        picks.sort_unstable();
        kept.extend(picks.map(|k| group[k]));
    }
    kept.dedup();
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let axis = Axis::round(0.0, 437.0, 5);
        assert_eq!(axis.ticks, [0.0, 100.0, 200.0, 300.0, 400.0, 500.0]);
        let axis = Axis::exact(-0.03, 1.02, 5);
        assert_eq!(
            axis.ticks.iter().map(|t| axis.label(*t)).collect::<Vec<_>>(),
            ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]
        );
        let flat = Axis::round(3.0, 3.0, 5);
        assert!(flat.lo < 3.0 && flat.hi > 3.0);
        let log = Axis::decades(-2.3, 0.4);
        assert_eq!(log.ticks.iter().map(|t| log.label(*t)).collect::<Vec<_>>(), ["10⁻³", "10⁻²", "10⁻¹", "1", "10"]);
        let named = Axis::named(vec![0.0, 1.0], vec!["8".into(), "16".into()]);
        assert!(named.label(1.0) == "16" && named.lo < 0.0 && named.hi > 1.0);
        let mut named = named;
        named.unname(|place, name| place > 0.5 && name == "16");
        assert_eq!((named.label(0.0), named.label(1.0)), ("8".into(), String::new()));
    }

    #[test]
    fn thinning_keeps_the_extremes_of_a_column() {
        let spots: Vec<Spot> = (0..1000).map(|k| (k / 500, (k * 7919) % 1000)).collect();
        let kept = thin(&spots);
        assert!(kept.len() <= 4);
        assert!(kept.iter().any(|spot| spot.1 == 0) && kept.iter().any(|spot| spot.1 == 999));
    }
}
