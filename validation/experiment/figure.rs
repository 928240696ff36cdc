//! The figure of an experiment: published numbers with their half widths, ours with twice its standard uncertainty, a row each and
//! a panel per unit. It is drawn from the table of comparisons; the same table gives the same bytes.

use checkdam::output::{Table, write_text};
use checkdam::plot::PlotError;
use std::fmt::Write;
use std::path::Path;

/// Width of the figure, px.
const WIDTH: f64 = 800.0;
/// Height of a row, and of what is above and below the rows of a panel, px.
const ROW: f64 = 30.0;
const HEAD: f64 = 34.0;
const FOOT: f64 = 44.0;
/// Ends of the axes, px.
const LEFT: f64 = 330.0;
const RIGHT: f64 = 775.0;
const INK: &str = "#222222";
const BLUE: &str = "#0072B2";
const GRID: &str = "#E2E2E2";

/// A number with its bar.
struct Bar {
    value: f64,
    half: f64,
}

struct Row {
    name: String,
    published: Bar,
    ours: Bar,
}

/// Draws `out_svg` from the table of comparisons.
///
/// # Errors
/// A table that cannot be read or has nothing to draw, or a figure that cannot be written.
pub fn draw(comparison: &Path, out_svg: &Path) -> Result<(), PlotError> {
    let panels = panels(&Table::load(comparison)?)?;
    if panels.is_empty() {
        return Err(PlotError::Argument("an experiment without a comparison".into()));
    }
    let tall = |rows: &[Row]| HEAD + ROW * rows.len() as f64 + FOOT;
    let height = panels.iter().map(|p| tall(&p.1)).sum::<f64>();
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height}\" viewBox=\"0 0 {WIDTH} {height}\" \
         font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"{WIDTH}\" height=\"{height}\" fill=\"#FFFFFF\"/>\n"
    );
    let mut top = 0.0;
    for (unit, rows) in &panels {
        panel(&mut svg, top, unit, rows);
        top += tall(rows);
    }
    svg.push_str("</svg>\n");
    Ok(write_text(out_svg, &svg)?)
}

/// The rows, unit by unit in the order of the table.
fn panels(table: &Table) -> Result<Vec<(String, Vec<Row>)>, PlotError> {
    let (quantities, cases, units) = (table.cells("quantity")?, table.cells("case")?, table.cells("unit")?);
    let [published, half, ours, u_num, u_input] =
        ["published", "half_width", "ours", "u_num", "u_input"].map(|c| table.column(c));
    let (published, half, ours, u_num, u_input) = (published?, half?, ours?, u_num?, u_input?);
    let several = cases.iter().any(|c| *c != cases[0]);
    let mut panels: Vec<(String, Vec<Row>)> = Vec::new();
    for k in 0..table.rows() {
        let name = if several { format!("{}: {}", cases[k], quantities[k]) } else { quantities[k].clone() };
        let row = Row {
            name,
            published: Bar { value: published[k], half: half[k] },
            ours: Bar { value: ours[k], half: 2.0 * u_num[k].hypot(u_input[k]) },
        };
        match panels.iter_mut().find(|p| p.0 == units[k]) {
            Some(panel) => panel.1.push(row),
            None => panels.push((units[k].clone(), vec![row])),
        }
    }
    Ok(panels)
}

/// The round step that cuts a span into about five parts.
fn step(span: f64) -> f64 {
    let rough = span / 5.0;
    let power = (-20..20).map(|k| 10f64.powi(k)).take_while(|p| *p <= rough).last().unwrap_or(1e-20);
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|f| f * power).find(|s| *s >= rough).unwrap_or(rough)
}

fn panel(svg: &mut String, top: f64, unit: &str, rows: &[Row]) {
    let ends = rows.iter().flat_map(|r| [&r.published, &r.ours]).flat_map(|b| [b.value - b.half, b.value + b.half]);
    let (low, high) = ends.filter(|x| x.is_finite()).fold((0.0f64, 0.0f64), |(a, b), x| (a.min(x), b.max(x)));
    let step = step((high - low).max(1e-12));
    let (first, last) = ((low / step).floor() as i32, (high / step).ceil() as i32);
    let (low, high) = (f64::from(first) * step, f64::from(last) * step);
    let across = |x: f64| LEFT + (RIGHT - LEFT) * (x - low) / (high - low);
    let (upper, lower) = (top + HEAD, top + HEAD + ROW * rows.len() as f64);
    let decimals = (0..12).find(|d| step * 10f64.powi(*d) >= 0.999).unwrap_or(12) as usize;
    for tick in first..=last {
        let (value, x) = (f64::from(tick) * step, across(f64::from(tick) * step));
        line(svg, [x, upper], [x, lower], GRID, 1.0);
        text(svg, [x, lower + 17.0], "middle", INK, &format!("{value:.decimals$}").replace('-', "\u{2212}"));
    }
    let unit = if unit == "1" { "no unit" } else { unit };
    text(svg, [0.5 * (LEFT + RIGHT), lower + 36.0], "middle", INK, unit);
    dot(svg, [LEFT, top + 16.0], INK);
    text(svg, [LEFT + 10.0, top + 20.0], "start", INK, "published, with its half width");
    dot(svg, [LEFT + 215.0, top + 16.0], BLUE);
    text(svg, [LEFT + 225.0, top + 20.0], "start", BLUE, "ours, with 2 u of grids and inputs");
    for (k, row) in rows.iter().enumerate() {
        let middle = upper + ROW * (k as f64 + 0.5);
        text(svg, [LEFT - 12.0, middle + 4.0], "end", INK, &row.name);
        for (bar, shift, colour) in [(&row.published, -5.0, INK), (&row.ours, 5.0, BLUE)] {
            if !bar.value.is_finite() {
                continue;
            }
            let (y, half) = (middle + shift, if bar.half.is_finite() { bar.half } else { 0.0 });
            let [from, to] = [bar.value - half, bar.value + half].map(across);
            line(svg, [from, y], [to, y], colour, 1.5);
            for end in [from, to] {
                line(svg, [end, y - 4.0], [end, y + 4.0], colour, 1.5);
            }
            dot(svg, [across(bar.value), y], colour);
        }
    }
    line(svg, [LEFT, lower], [RIGHT, lower], INK, 1.0);
}

fn line(svg: &mut String, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2], colour: &str, width: f64) {
    let _ = writeln!(
        svg,
        "<line x1=\"{x1:.2}\" y1=\"{y1:.2}\" x2=\"{x2:.2}\" y2=\"{y2:.2}\" stroke=\"{colour}\" stroke-width=\"{width}\"/>"
    );
}

fn dot(svg: &mut String, [x, y]: [f64; 2], colour: &str) {
    let _ = writeln!(svg, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"3.5\" fill=\"{colour}\"/>");
}

fn text(svg: &mut String, [x, y]: [f64; 2], anchor: &str, colour: &str, words: &str) {
    let words = words.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    let _ = writeln!(svg, "<text x=\"{x:.2}\" y=\"{y:.2}\" text-anchor=\"{anchor}\" fill=\"{colour}\">{words}</text>");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round() {
        for (span, wanted) in [(0.1, 0.02), (1.0, 0.2), (12.0, 5.0), (480.0, 100.0)] {
            assert!((step(span) / wanted - 1.0).abs() < 1e-9, "{span}: {}", step(span));
        }
    }
}
