//! Normal pressure on the barrier over its height, at several instants.

use std::path::Path;

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::axes::{Axis, Frame, Margins};
use super::style::{INK, TEXT_PX, drawing, line, render, stroke, text_width_px, units, viridis, write_at};
use super::{PlotError, by_time, time_decimals};
use crate::output::Table;

const HEIGHT_PX: i32 = 520;
/// Number of profiles drawn at most: more cannot be told apart.
const PROFILES: usize = 7;

/// Draws `out_svg` from a tidy table of `time_s`, `height_m` and `pressure_pa`: at most seven profiles,
/// evenly spaced from the first time with any pressure to the last, early ones dark.
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
    let groups = selected(groups, pressure);
    let shown = || groups.iter().flat_map(|(_, rows)| rows.iter().copied());
    let (lo, hi) = shown().fold((0.0, 0.0), |(lo, hi): (f64, f64), k| (lo.min(pressure[k]), hi.max(pressure[k])));
    let (bottom, top) = shown().fold((0.0, 0.0), |(lo, hi): (f64, f64), k| (lo.min(height[k]), hi.max(height[k])));
    let (scale, unit) = if hi.max(-lo) >= 2e3 { (1e-3, "kPa") } else { (1.0, "Pa") };
    let x = Axis::round(lo * scale, if hi > lo { hi * scale } else { 1.0 }, 6);
    let y = Axis::round(bottom, if top > bottom { top } else { bottom + 0.1 }, 6);
    let decimals = time_decimals(groups.iter().map(|(time, _)| *time));
    let last = groups.len() - 1;
    let name = |(k, (time, _)): (usize, &(f64, Vec<usize>))| {
        if k == last { format!("{time:.decimals$} s, at the end") } else { format!("{time:.decimals$} s") }
    };
    let names: Vec<String> = groups.iter().enumerate().map(name).collect();
    let widest = names.iter().map(|name| text_width_px(name, TEXT_PX)).fold(0.0, f64::max);
    let margins = Margins { left: 68.0, right: widest + 50.0, top: 20.0, bottom: 46.0 };

    render(out_svg.as_ref(), HEIGHT_PX, |canvas| {
        let titles = (format!("normal pressure ({unit})"), "height above the foot of the barrier (m)");
        let frame = Frame::draw(canvas, &margins, (&x, &titles.0), (&y, titles.1))?;
        let (_, right, top, _) = frame.bounds();
        let pitch = units(22.0);
        for (k, (_, rows)) in groups.iter().enumerate() {
            // The yellow end of the map is too pale for a line on white.
            let colour = viridis(0.88 * k as f64 / last.max(1) as f64);
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
            write_at(canvas, &names[k], (at.0 + units(27.0), at.1), TEXT_PX, INK, HPos::Left)?;
        }
        Ok(())
    })
}

/// The profiles to draw: evenly spaced in time from the first with any pressure to the last, which is always among them.
fn selected(mut groups: Vec<(f64, Vec<usize>)>, pressure: &[f64]) -> Vec<(f64, Vec<usize>)> {
    let pressed = |(_, rows): &(f64, Vec<usize>)| rows.iter().any(|k| pressure[*k] != 0.0);
    groups.drain(..groups.iter().position(pressed).unwrap_or(groups.len().saturating_sub(1)));
    if groups.len() <= PROFILES {
        return groups;
    }
    let (first, last) = (groups[0].0, groups[groups.len() - 1].0);
    let nearest = |k: usize| {
        let wanted = first + (last - first) * k as f64 / (PROFILES - 1) as f64;
        let distance = |g: &usize| (groups[*g].0 - wanted).abs();
        (0..groups.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))
    };
    let mut picks: Vec<usize> = (0..PROFILES).filter_map(nearest).collect();
    picks.dedup();
    picks.into_iter().map(|k| std::mem::take(&mut groups[k])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times(groups: &[(f64, f64)]) -> Vec<f64> {
        let pressure: Vec<f64> = groups.iter().map(|(_, p)| *p).collect();
        let groups = groups.iter().enumerate().map(|(k, (t, _))| (*t, vec![k])).collect();
        selected(groups, &pressure).into_iter().map(|(t, _)| t).collect()
    }

    #[test]
    fn profiles_start_with_the_first_pressure_and_end_with_the_last_time() {
        let table: Vec<(f64, f64)> = (0..301).map(|k| (f64::from(k), if k < 60 { 0.0 } else { 5.0 })).collect();
        assert_eq!(times(&table), [60.0, 100.0, 140.0, 180.0, 220.0, 260.0, 300.0]);
        assert_eq!(times(&[(0.0, 0.0), (1.0, 0.0), (2.0, 3.0), (3.0, 0.0)]), [2.0, 3.0]);
        assert_eq!(times(&[(0.0, 0.0), (1.0, 0.0)]), [1.0]);
    }

    #[test]
    fn a_crowd_of_early_profiles_is_drawn_once() {
        let mut table: Vec<(f64, f64)> = (0..20).map(|k| (1e-3 * f64::from(k), 1.0)).collect();
        table.push((10.0, 1.0));
        assert_eq!(times(&table), [0.0, 0.019, 10.0]);
    }
}
