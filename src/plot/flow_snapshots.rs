//! The flow at several instants, as an observer beside the flume sees it.

use std::path::Path;

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::axes::Axis;
use super::panels::{Extent, FOOT_PX, Layout, MARGIN_PX, Point, TITLE_PX, Turn};
use super::style::{
    Canvas, GREY, INK, SMALL_PX, Spot, TEXT_PX, UNIT, WALL, WIDTH_PX, fill, line, render, stroke, units, viridis,
    write_at,
};
use super::{PlotError, by_time, time_decimals};
use crate::output::Table;

/// Number of colours of the scale.
const LEVELS: usize = 32;

/// What the colours show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shown<'a> {
    /// Column of the table of cells.
    pub column: &'a str,
    /// Title of the scale, with the unit.
    pub title: &'a str,
    /// Value of the last colour; values beyond it have that colour, too. The largest value if none is given.
    pub top: Option<f64>,
    /// Colours by the logarithm, from the decade below this positive value on; what is less has the first colour.
    pub logarithmic_from: Option<f64>,
}

impl Shown<'static> {
    /// The speed.
    pub const SPEED: Self = Self { column: "speed_m_per_s", title: "speed (m/s)", top: None, logarithmic_from: None };
}

impl Shown<'_> {
    /// The scale of the colours, of values or of their decimal logarithms, for values up to `most`.
    fn scale(&self, most: f64) -> Axis {
        let most = if most > 0.0 { most } else { 1.0 };
        match self.logarithmic_from {
            Some(least) => {
                // Named at the decades, ending at one, two or five of the last of them.
                let mut scale = Axis::decades(least.log10(), most.log10());
                let end = [2.0, 5.0].map(|f: f64| scale.hi - 1.0 + f.log10());
                scale.hi = end.into_iter().find(|end| *end >= most.log10()).unwrap_or(scale.hi);
                scale.ticks.retain(|tick| *tick <= scale.hi);
                scale
            }
            None => Axis::round(0.0, most, 5),
        }
    }

    /// Which of the colours a value has.
    fn level(&self, scale: &Axis, value: f64) -> usize {
        let value = if self.logarithmic_from.is_some() { value.log10() } else { value };
        // What is not a number, as the logarithm of less than nothing, is below all colours.
        (((value - scale.lo) / (scale.hi - scale.lo) * LEVELS as f64).max(0.0) as usize).min(LEVELS - 1)
    }
}

/// A run of cells of a row that share a colour, in cell numbers: first to last of `row`.
struct Run {
    row: i64,
    first: i64,
    last: i64,
    level: usize,
}

/// Draws `out_svg` from a table of cells and a table of outlines, one panel per time, turned so that gravity points down.
///
/// `field_csv` holds `time_s`, the centre `x_m`, `y_m` of each grid cell with material, and `speed_m_per_s`, which sets the
/// colour. `geometry_csv` holds the corners `x_m`, `y_m` of every outline in order, told apart by the number `boundary`;
/// the panels show all of it, so outlines of half-spaces should be cut to what is worth seeing. `inclination_deg` is the
/// angle of the x axis below the horizontal.
///
/// # Errors
/// [`PlotError::File`] for a missing column or file, [`PlotError::Data`] for a field without cells,
/// [`PlotError::Argument`] for an inclination that is not a finite number.
pub fn draw(
    field_csv: impl AsRef<Path>,
    geometry_csv: impl AsRef<Path>,
    inclination_deg: f64,
    out_svg: impl AsRef<Path>,
) -> Result<(), PlotError> {
    draw_with_barrier(field_csv, &Shown::SPEED, geometry_csv, None, inclination_deg, out_svg)
}

/// The same for any column, with a barrier that moves: `barrier_csv` holds its outline at the times of the cells, `time_s` and `x_m`, `y_m` of
/// its points in order.
///
/// # Errors
/// As [`draw`].
pub fn draw_with_barrier(
    field_csv: impl AsRef<Path>,
    shown: &Shown,
    geometry_csv: impl AsRef<Path>,
    barrier_csv: Option<&Path>,
    inclination_deg: f64,
    out_svg: impl AsRef<Path>,
) -> Result<(), PlotError> {
    if !inclination_deg.is_finite() {
        return Err(PlotError::Argument(format!(
            "the inclination of {inclination_deg} degrees is not a finite number"
        )));
    }
    let field = Table::load(field_csv)?;
    let (x, y) = (field.column("x_m")?, field.column("y_m")?);
    let value = field.column(shown.column)?;
    let mut panels = by_time(&field)?;
    for (_, rows) in &mut panels {
        rows.retain(|k| x[*k].is_finite() && y[*k].is_finite() && value[*k].is_finite());
    }
    panels.retain(|(_, rows)| !rows.is_empty());
    if panels.is_empty() {
        return Err(PlotError::data(field.path(), "no row has a time, a position and a value"));
    }
    let cells: Vec<usize> = panels.iter().flat_map(|(_, rows)| rows.iter().copied()).collect();
    let outlines = outlines(&Table::load(geometry_csv)?)?;
    let barriers = barrier_csv.map_or_else(|| Ok(Vec::new()), |csv| moving(&Table::load(csv)?))?;

    let turn = Turn::new(inclination_deg);
    let fixed = outlines.iter().chain(barriers.iter().map(|(_, outline)| outline)).flatten().copied();
    let corners = cells.iter().map(|k| [x[*k], y[*k]]).chain(fixed);
    let extent = Extent::around(corners.map(|point| turn.apply(point)));
    let cell = spacing(cells.iter().map(|k| x[*k]))
        .or_else(|| spacing(cells.iter().map(|k| y[*k])))
        .unwrap_or(0.01 * extent.width.max(extent.height).max(1e-9));
    let extent = extent.grown(cell);
    // Cells are counted from the centre of one of them.
    let base = [x[cells[0]], y[cells[0]]];
    let most = shown.top.unwrap_or_else(|| cells.iter().fold(0.0, |most: f64, k| most.max(value[*k])));
    let scale = shown.scale(most);
    let layout = Layout::new(panels.len(), &extent);
    // Each cell reaches a little under the next, so that no background shows through the seams.
    let lap = 0.7 / (layout.px_per_m * cell);
    let decimals = time_decimals(panels.iter().map(|(time, _)| *time));

    render(out_svg.as_ref(), layout.height_px.round() as i32, |canvas| {
        for (k, (time, rows)) in panels.iter().enumerate() {
            let origin = layout.origin(k);
            let spot = |point: Point| layout.spot(origin, &extent, turn.apply(point));
            let cells = rows.iter().map(|k| {
                let count = |v: f64, from: f64| ((v - from) / cell).round() as i64;
                (count(y[*k], base[1]), count(x[*k], base[0]), shown.level(&scale, value[*k]))
            });
            for run in runs(cells.collect()) {
                let quad = run.corners(lap).map(|[i, j]| spot([base[0] + i * cell, base[1] + j * cell]));
                fill(canvas, quad.to_vec(), &colour(run.level))?;
            }
            let moved = barriers.iter().filter(|(at, _)| at == time).map(|(_, outline)| outline);
            for outline in outlines.iter().chain(moved) {
                wall(canvas, outline.iter().map(|point| spot(*point)).collect())?;
            }
            let at = (units(origin.0), units(origin.1 - 0.5 * TITLE_PX));
            write_at(canvas, &format!("t = {time:.decimals$} s"), at, TEXT_PX, INK, HPos::Left)?;
        }
        foot(canvas, &layout, shown.title, &scale)
    })
}

impl Run {
    /// Corners in cell widths from the centre of cell 0, reaching by `lap` under the next run and row.
    fn corners(&self, lap: f64) -> [Point; 4] {
        let (from, to) = (self.first as f64 - 0.5, self.last as f64 + 0.5 + lap);
        let (low, high) = (self.row as f64 - 0.5, self.row as f64 + 0.5 + lap);
        [[from, low], [to, low], [to, high], [from, high]]
    }
}

/// Draws a boundary; the line around it closes the seam to the next.
fn wall(canvas: &Canvas<'_>, spots: Vec<Spot>) -> Result<(), PlotError> {
    let closed = spots.iter().chain(spots.first()).copied().collect();
    let width = if spots.len() > 2 { 0.8 } else { 2.0 };
    if spots.len() > 2 {
        fill(canvas, spots, &WALL)?;
    }
    stroke(canvas, closed, line(WALL, width))
}

/// The colour of a level of the scale.
fn colour(level: usize) -> RGBColor {
    viridis((level as f64 + 0.5) / LEVELS as f64)
}

/// Outlines of the boundaries in the order of the table.
fn outlines(table: &Table) -> Result<Vec<Vec<Point>>, PlotError> {
    let (boundary, x, y) = (table.column("boundary")?, table.column("x_m")?, table.column("y_m")?);
    let rows: Vec<usize> = (0..table.rows()).filter(|k| x[*k].is_finite() && y[*k].is_finite()).collect();
    let groups = rows.chunk_by(|a, b| boundary[*a] == boundary[*b]);
    Ok(groups.map(|rows| rows.iter().map(|k| [x[*k], y[*k]]).collect()).collect())
}

/// Outlines of a barrier by time.
fn moving(table: &Table) -> Result<Vec<(f64, Vec<Point>)>, PlotError> {
    let (x, y) = (table.column("x_m")?, table.column("y_m")?);
    let groups = by_time(table)?.into_iter();
    Ok(groups.map(|(time, rows)| (time, rows.iter().map(|k| [x[*k], y[*k]]).collect())).collect())
}

/// Smallest distance between different values; `None` if there are no two.
fn spacing(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let range = values.last()? - values.first()?;
    let steps = values.windows(2).map(|pair| pair[1] - pair[0]);
    steps.filter(|step| *step > 1e-6 * range).reduce(f64::min)
}

/// Joins neighbours of a row that share a colour; rows from the bottom up.
fn runs(mut cells: Vec<(i64, i64, usize)>) -> Vec<Run> {
    cells.sort_unstable();
    let mut runs: Vec<Run> = Vec::new();
    for (row, column, level) in cells {
        match runs.last_mut() {
            Some(run) if run.row == row && run.level == level && run.last + 1 == column => run.last = column,
            _ => runs.push(Run { row, first: column, last: column, level }),
        }
    }
    runs
}

/// Colour scale, length scale and direction of gravity.
fn foot(canvas: &Canvas<'_>, layout: &Layout, title: &str, scale: &Axis) -> Result<(), PlotError> {
    let top = layout.height_px - FOOT_PX;
    // A round length of at most a fifth of the figure.
    let longest = 0.2 * f64::from(WIDTH_PX) / layout.px_per_m;
    let power = 10f64.powf(longest.log10().floor());
    let length = power * [5.0, 2.0, 1.0].into_iter().find(|f| f * power <= longest).unwrap_or(1.0);
    let (x, y) = (units(MARGIN_PX + 4.0), units(top + 36.0));
    let end = x + units(length * layout.px_per_m);
    stroke(canvas, vec![(x, y), (end, y)], line(INK, 1.6))?;
    for x in [x, end] {
        stroke(canvas, vec![(x, y - units(4.0)), (x, y + units(4.0))], line(INK, 1.6))?;
    }
    let decimals = (-length.log10().floor()).max(0.0) as usize;
    write_at(canvas, &format!("{length:.decimals$} m"), ((x + end) / 2, y + units(16.0)), SMALL_PX, INK, HPos::Center)?;

    let (x, from, to) = (end + units(44.0), units(top + 20.0), units(top + 52.0));
    stroke(canvas, vec![(x, from), (x, to - units(4.0))], line(GREY, 1.6))?;
    fill(canvas, vec![(x - units(4.0), to - units(8.0)), (x + units(4.0), to - units(8.0)), (x, to)], &GREY)?;
    write_at(canvas, "gravity", (x + units(10.0), (from + to) / 2), SMALL_PX, GREY, HPos::Left)?;

    let (left, width) = (f64::from(WIDTH_PX) - MARGIN_PX - 340.0, 320.0);
    let (from, to) = (units(top + 26.0), units(top + 42.0));
    for level in 0..LEVELS {
        let edge = |k: usize| units(left + width * k as f64 / LEVELS as f64);
        let lap = if level + 1 < LEVELS { UNIT } else { 0 };
        let (x, end) = (edge(level), edge(level + 1) + lap);
        fill(canvas, vec![(x, from), (end, from), (end, to), (x, to)], &colour(level))?;
    }
    for tick in &scale.ticks {
        let x = units(left + width * (tick - scale.lo) / (scale.hi - scale.lo));
        stroke(canvas, vec![(x, to), (x, to + units(4.0))], line(INK, 1.0))?;
        write_at(canvas, &scale.label(*tick), (x, to + units(14.0)), SMALL_PX, INK, HPos::Center)?;
    }
    write_at(canvas, title, (units(left), units(top + 13.0)), SMALL_PX, INK, HPos::Left)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_value_is_beyond_a_logarithmic_scale() {
        let shown = Shown { logarithmic_from: Some(100.0), ..Shown::SPEED };
        for (most, end) in [(900.0, 1e3), (1.3e5, 2e5), (3e5, 5e5), (1e6, 1e6)] {
            let scale = shown.scale(most);
            assert!((scale.lo - 2.0).abs() < 1e-12 && (scale.hi - f64::log10(end)).abs() < 1e-12, "{most}");
            assert!(scale.ticks.iter().all(|t| *t <= scale.hi));
            assert_eq!([0.0, -5.0, 100.0].map(|v| shown.level(&scale, v)), [0; 3]);
            assert_eq!(shown.level(&scale, 1.001 * end), LEVELS - 1);
        }
    }
}
