//! A tornado: how far a number moves when one thing at a time is changed, the largest span on top, in panels.

use std::path::Path;

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::PlotError;
use super::axes::{Axis, Frame, Margins};
use super::style::{
    BLUE, Canvas, GREY, INK, SMALL_PX, Spot, TEXT_PX, VERMILION, WIDTH_PX, fill, lighten, line, render, stroke,
    text_width_px, units, write_at,
};
use crate::check::significant;
use crate::output::Table;

/// Height of a factor.
const ROW_PX: f64 = 24.0;
/// Half the height of a bar.
const HALF_PX: f64 = 7.0;
/// Height of the labels at the ends of bars.
const LABEL_PX: f64 = 0.85 * SMALL_PX;
/// Significant digits of the numbers.
const DIGITS: usize = 3;
const HEAD_PX: f64 = 40.0;
const FOOT_PX: f64 = 46.0;

/// What to draw from a table with the columns `case`, `factor`, `label` and one of numbers. The row whose factor is `base` is
/// what all others are compared with; those of the factor `noise` are the ends of a band in which nothing can be told apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tornado<'a> {
    /// Cases, and what to write above their panels.
    pub panels: &'a [(&'a str, &'a str)],
    /// Column of the numbers.
    pub column: &'a str,
    /// What the numbers are, with their unit.
    pub title: &'a str,
    /// Whether only runs count that came to rest (column `ended`); the others are named in any case.
    pub at_rest: bool,
}

/// The numbers of a factor.
struct Factor {
    name: String,
    /// Least and greatest with their labels; the base among them.
    ends: [(f64, String); 2],
}

/// A panel: the base, the band of noise, the factors.
struct Panel<'a> {
    title: &'a str,
    base: f64,
    noise: Option<[f64; 2]>,
    factors: Vec<Factor>,
}

/// Draws `out_svg` from `csv`; rows without a number are left out.
///
/// # Errors
/// [`PlotError::File`] for a missing column or file, [`PlotError::Data`] for a panel without a base.
pub fn draw(csv: impl AsRef<Path>, what: &Tornado, out_svg: impl AsRef<Path>) -> Result<(), PlotError> {
    let table = Table::load(csv)?;
    let panels = what.panels.iter().map(|p| select(&table, what, p)).collect::<Result<Vec<_>, _>>()?;
    // One below the other: names and labels need the width.
    let tall = |p: &Panel| HEAD_PX + ROW_PX * p.factors.len() as f64 + FOOT_PX;
    render(out_svg.as_ref(), panels.iter().map(tall).sum::<f64>() as i32, |canvas| {
        let mut down = 0.0;
        for panel in &panels {
            let area = canvas.clone().shrink((0, units(down)), (units(f64::from(WIDTH_PX)), units(tall(panel))));
            draw_panel(canvas, &area, what, panel)?;
            down += tall(panel);
        }
        Ok(())
    })
}

fn draw_panel(canvas: &Canvas<'_>, area: &Canvas<'_>, what: &Tornado, panel: &Panel<'_>) -> Result<(), PlotError> {
    let rows = panel.factors.len();
    let names = panel.factors.iter().map(|f| text_width_px(&f.name, SMALL_PX)).fold(0.0, f64::max);
    let margins = Margins { left: names + 14.0, right: 18.0, top: HEAD_PX, bottom: FOOT_PX };
    let all = panel.factors.iter().flat_map(|f| f.ends.iter().map(|e| e.0));
    let all = all.chain(panel.noise.into_iter().flatten()).chain([panel.base]);
    let (lo, hi) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    let wide = f64::from(WIDTH_PX) - margins.left - margins.right;
    let [left, right] = room(panel, [lo, hi], wide);
    let mut x = Axis::exact(left, right, 6);
    // There may have to be room for a label beyond zero, but there are no numbers.
    x.ticks.retain(|t| lo < 0.0 || *t >= 0.0);
    let y = Axis::bare(0.0, rows.max(1) as f64);
    let frame = Frame::draw(area, &margins, (&x, what.title), (&y, ""))?;
    let (left, right, top, bottom) = frame.bounds();
    write_at(canvas, panel.title, ((left + right) / 2, top - units(16.0)), TEXT_PX, INK, HPos::Center)?;
    let across = |v: f64| frame.spot(v, 0.0).0;
    if let Some([a, b]) = panel.noise {
        let corners: Vec<Spot> = vec![(across(a), top), (across(b), top), (across(b), bottom), (across(a), bottom)];
        fill(canvas, corners, &lighten(GREY, 0.75))?;
    }
    let base = across(panel.base);
    for (k, factor) in panel.factors.iter().enumerate() {
        let height = top + units(ROW_PX * (k as f64 + 0.5));
        write_at(canvas, &factor.name, (units(names + 4.0), height), SMALL_PX, INK, HPos::Right)?;
        for (end, colour) in [(&factor.ends[0], BLUE), (&factor.ends[1], VERMILION)] {
            let at = across(end.0);
            if end.1.is_empty() {
                continue;
            }
            let half = units(HALF_PX);
            let corners = vec![(base, height - half), (at, height - half), (at, height + half), (base, height + half)];
            fill(canvas, corners, &colour.mix(0.75))?;
            let (shift, side) = if end.0 < panel.base { (-4.0, HPos::Right) } else { (4.0, HPos::Left) };
            write_at(canvas, &end.1, (at + units(shift), height), LABEL_PX, GREY, side)?;
        }
    }
    stroke(canvas, vec![(base, top), (base, bottom)], line(INK, 1.0))
}

/// The range of an axis `wide` pixels long that has the values and the labels at the ends of the bars.
fn room(panel: &Panel<'_>, [lo, hi]: [f64; 2], wide: f64) -> [f64; 2] {
    let ends = || panel.factors.iter().flat_map(|f| &f.ends).filter(|e| !e.1.is_empty());
    let [mut left, mut right] = [lo, hi];
    // A longer axis makes labels longer, in its units; that settles after a few rounds where they leave room for bars at all.
    for _ in 0..30 {
        let scale = (right - left).max(1e-12) / wide;
        let long = |text: &str| scale * (text_width_px(text, LABEL_PX) + 12.0);
        for (value, label) in ends() {
            if *value < panel.base {
                left = left.min(value - long(label));
            } else {
                right = right.max(value + long(label));
            }
        }
    }
    [left, right]
}

fn select<'a>(table: &Table, what: &Tornado<'a>, panel: &(&'a str, &'a str)) -> Result<Panel<'a>, PlotError> {
    let (cases, factors, labels) = (table.cells("case")?, table.cells("factor")?, table.cells("label")?);
    let (values, ended) = (table.column(what.column)?, table.cells("ended")?);
    let rows: Vec<usize> = (0..table.rows()).filter(|&k| cases[k] == panel.0 && values[k].is_finite()).collect();
    let Some(base) = rows.iter().find(|&&k| factors[k] == "base").map(|&k| values[k]) else {
        return Err(PlotError::data(table.path(), format!("there is no base of {}", panel.0)));
    };
    let noise: Vec<f64> = rows.iter().filter(|&&k| factors[k] == "noise").map(|&k| values[k]).collect();
    let mut names: Vec<&String> = Vec::new();
    for &k in rows.iter().filter(|&&k| !["base", "noise"].contains(&factors[k].as_str())) {
        if !names.contains(&&factors[k]) {
            names.push(&factors[k]);
        }
    }
    let mut drawn: Vec<Factor> = names
        .into_iter()
        .map(|name| {
            let mut ends = [(base, String::new()), (base, String::new())];
            for &k in rows.iter().filter(|&&k| factors[k] == *name) {
                let restless = if ended[k] == "at rest" { "" } else { ", not at rest" };
                if what.at_rest && !restless.is_empty() {
                    continue;
                }
                // What reads as the base says nothing.
                let shown = significant(values[k], DIGITS);
                if shown == significant(base, DIGITS) {
                    continue;
                }
                let text = || format!("{}{restless} ({shown})", labels[k]);
                if values[k] < ends[0].0 {
                    ends[0] = (values[k], text());
                }
                if values[k] > ends[1].0 {
                    ends[1] = (values[k], text());
                }
            }
            for &k in rows.iter().filter(|&&k| what.at_rest && factors[k] == *name && ended[k] != "at rest") {
                let before = if ends[1].1.is_empty() { "" } else { "; " };
                ends[1].1 += &format!("{before}{}: not at rest", labels[k]);
            }
            Factor { name: name.clone(), ends }
        })
        .collect();
    drawn.sort_by(|a, b| (b.ends[1].0 - b.ends[0].0).total_cmp(&(a.ends[1].0 - a.ends[0].0)));
    let noise = match noise[..] {
        [a, b] => Some([a.min(b), a.max(b)]),
        _ => None,
    };
    Ok(Panel { title: panel.1, base, noise, factors: drawn })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "case,factor,label,ended,force_n\n\
        steep,base,,at rest,10\n\
        steep,gate,slow,at rest,4\n\
        steep,gate,fast,at rest,11\n\
        steep,cone,other,at rest,10.001\n\
        steep,damping,little,at rest,12\n\
        steep,damping,none,end time,19\n\
        steep,noise,low,,9.5\n\
        steep,noise,high,,10.5\n";

    fn panel(at_rest: bool) -> Panel<'static> {
        let what = Tornado { panels: &[], column: "force_n", title: "force (N)", at_rest };
        select(&Table::parse(TABLE, "table.csv").expect("a table"), &what, &("steep", "steep")).expect("a panel")
    }

    #[test]
    fn runs_that_did_not_come_to_rest_are_named() {
        let ends = |panel: Panel| panel.factors.into_iter().map(|f| (f.name, f.ends.map(|e| e.1))).collect::<Vec<_>>();
        let wanted = |name: &str, low: &str, high: &str| (name.to_string(), [low.to_string(), high.to_string()]);
        assert_eq!(
            ends(panel(false)),
            [
                wanted("damping", "", "none, not at rest (19)"),
                wanted("gate", "slow (4)", "fast (11)"),
                wanted("cone", "", ""),
            ]
        );
        // Where they do not count.
        assert_eq!(
            ends(panel(true)),
            [
                wanted("gate", "slow (4)", "fast (11)"),
                wanted("damping", "", "little (12); none: not at rest"),
                wanted("cone", "", ""),
            ]
        );
    }

    #[test]
    fn there_is_room_for_every_label_and_not_much_more() {
        let panel = panel(true);
        let [left, right] = room(&panel, [4.0, 12.0], 600.0);
        let px = |v: f64| 600.0 * (v - left) / (right - left);
        let gaps: Vec<f64> = (panel.factors.iter().flat_map(|f| &f.ends).filter(|e| !e.1.is_empty()))
            .map(|(v, label)| {
                let free = if *v < panel.base { px(*v) } else { 600.0 - px(*v) };
                free - text_width_px(label, LABEL_PX)
            })
            .collect();
        assert!(gaps.iter().all(|g| *g > 10.0), "{gaps:?}");
        assert!(gaps.iter().any(|g| *g < 14.0), "{gaps:?}");
    }
}
