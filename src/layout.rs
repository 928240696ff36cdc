//! Keeps material points sorted by cell, in bands of grid columns, and says which nodes are active.
//!
//! A band owns the points whose stencil starts in its columns, see [`crate::band`]. The partition depends on the points alone and
//! never on the number of threads, so neither do the sums.
//!
//! A sort stays valid until some point may have moved by more than one cell; until then a stencil starts at most one column or
//! row beside where it was, and accumulators and active nodes allow for that.

use crate::band::{Band, BandSums};
use crate::body::{Body, Particle, Points};
use crate::grid::{ActiveGrid, Column, Lattice};
use crate::shape::{STENCIL, ShapeFunction, stencil};

/// Nodes beside a sorted stencil that drift can reach, on either side.
const DRIFT: usize = 1;
/// Fewest columns of a band: the accumulators of a band reach no further than the next band.
const MIN_COLUMNS: usize = STENCIL + 2 * DRIFT;
/// Material points that make a band worth a task of its own.
const BAND_POINTS: usize = 256;

/// A particle that left the domain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Departed {
    /// Index of its body.
    pub body: usize,
    /// The particle as it was when it left.
    pub particle: Particle,
}

/// Scratch memory of the sort, kept between sorts.
#[derive(Debug, Clone, Default)]
pub struct Sorter {
    all: Vec<Vec<Particle>>,
    cells: Vec<Vec<[i32; 2]>>,
    base_rows: Vec<(i32, i32)>,
    counts: Vec<u32>,
    offsets: Vec<u32>,
    cuts: Vec<usize>,
    firsts: Vec<u32>,
}

/// What the sort needs to know besides the points.
#[derive(Debug, Clone, Copy)]
pub struct SortRules<'a> {
    /// The grid.
    pub lattice: Lattice,
    /// Shape function, which decides where stencils start.
    pub shape: ShapeFunction,
    /// Bodies, parallel to `Band::points`.
    pub bodies: &'a [Body],
    /// Material outside [x_min, x_max] x [y_min, y_max] is removed.
    pub domain: [[f64; 2]; 2],
}

impl Sorter {
    /// Sorts all points into new bands and lays out the active grid; points outside the domain go to `departed`.
    pub fn sort(
        &mut self,
        rules: &SortRules,
        bands: &mut Vec<Band>,
        grid: &mut ActiveGrid,
        departed: &mut Vec<Departed>,
    ) {
        let bodies = rules.bodies.len();
        self.all.resize_with(bodies, Vec::new);
        self.cells.resize_with(bodies, Vec::new);
        for body in 0..bodies {
            let (all, cells) = (&mut self.all[body], &mut self.cells[body]);
            all.clear();
            cells.clear();
            for p in bands.iter().flat_map(|band| band.points[body].iter()) {
                let inside = (0..2).all(|d| p.x[d] >= rules.domain[d][0] && p.x[d] <= rules.domain[d][1]);
                if inside {
                    all.push(p);
                } else {
                    departed.push(Departed { body, particle: p });
                }
            }
        }
        self.find_cells(rules);
        self.lay_out_grid(rules.lattice, grid);
        self.fill_bands(rules.bodies, bands, grid);
    }

    /// First stencil node of every point, counted from the lower left of the domain.
    fn find_cells(&mut self, rules: &SortRules) {
        let h = rules.lattice.spacing;
        let low = domain_corner(rules);
        for (body, all) in self.all.iter().enumerate() {
            let half_width = rules.shape.half_width(rules.bodies[body].points_per_direction);
            let corner = rules.lattice.position(low[0], low[1]);
            self.cells[body].extend(all.iter().map(|p| {
                // Divided, where others multiply with one over the spacing: the last bit decides about points on a node.
                let cell = |d: usize| stencil::start((p.x[d] - corner[d]) / h, half_width).0;
                [cell(0), cell(1)]
            }));
        }
        // Make the indices global.
        for cells in &mut self.cells {
            for c in cells.iter_mut() {
                c[0] += low[0] as i32;
                c[1] += low[1] as i32;
            }
        }
    }

    fn lay_out_grid(&mut self, lattice: Lattice, grid: &mut ActiveGrid) {
        let mut low = [i32::MAX; 2];
        let mut high = [i32::MIN; 2];
        for cell in self.cells.iter().flatten() {
            for d in 0..2 {
                low[d] = low[d].min(cell[d]);
                high[d] = high[d].max(cell[d]);
            }
        }
        grid.columns.clear();
        grid.spacing = lattice.spacing;
        grid.inverse_spacing = 1.0 / lattice.spacing;
        self.base_rows.clear();
        if low[0] > high[0] {
            grid.index_columns();
            return;
        }
        let drift = DRIFT as i32;
        grid.first = [i64::from(low[0] - drift), i64::from(low[1] - drift)];
        grid.corner = lattice.position(grid.first[0], grid.first[1]);

        // Rows where stencils start, for each column where they start.
        let base_columns = (high[0] - low[0] + 1) as usize;
        self.base_rows.resize(base_columns, (i32::MAX, i32::MIN));
        for cell in self.cells.iter().flatten() {
            let rows = &mut self.base_rows[(cell[0] - low[0]) as usize];
            rows.0 = rows.0.min(cell[1] - low[1]);
            rows.1 = rows.1.max(cell[1] - low[1]);
        }
        // A column of nodes is reached from stencils that start up to STENCIL - 1 + DRIFT columns before, or DRIFT after it.
        let reach = STENCIL - 1 + DRIFT;
        let mut start = 0u32;
        for c in 0..base_columns + DRIFT + reach {
            let from = c.saturating_sub(DRIFT + reach);
            let to = c.min(base_columns - 1);
            let (low, high) = self.base_rows[from.min(base_columns - 1)..=to]
                .iter()
                .fold((i32::MAX, i32::MIN), |(a, b), r| (a.min(r.0), b.max(r.1)));
            let rows = if low <= high { (high - low) as u32 + 1 + (STENCIL - 1 + 2 * DRIFT) as u32 } else { 0 };
            // Row 0 of the grid lies DRIFT below the lowest start, so the first reachable row keeps its number.
            grid.columns.push(Column { start, row: if rows > 0 { low } else { 0 }, rows });
            start += rows;
        }
        grid.index_columns();
    }

    /// Counting sort by (column, row) of the stencil's first node, then a cut into bands.
    fn fill_bands(&mut self, bodies: &[Body], bands: &mut Vec<Band>, grid: &ActiveGrid) {
        let base_columns = self.base_rows.len();
        let total: usize = self.all.iter().map(Vec::len).sum();
        self.counts.clear();
        self.counts.resize(base_columns + 1, 0);
        for cell in self.cells.iter().flatten() {
            self.counts[base_column(cell, grid) + 1] += 1;
        }
        for c in 0..base_columns {
            self.counts[c + 1] += self.counts[c];
        }
        // Cut: at least MIN_COLUMNS columns and about BAND_POINTS points each; a short rest joins the last band.
        let mut cuts = std::mem::take(&mut self.cuts);
        cuts.clear();
        cuts.push(0);
        let mut last = 0;
        for c in 1..=base_columns {
            let points = self.counts[c] - self.counts[last];
            if c - last >= MIN_COLUMNS && points as usize >= BAND_POINTS && c < base_columns {
                cuts.push(c);
                last = c;
            }
        }
        let rest = total as u32 - self.counts[last];
        if cuts.len() > 1 && (base_columns - last < MIN_COLUMNS || (rest as usize) < BAND_POINTS / 2) {
            cuts.pop();
        }
        cuts.push(base_columns.max(1));

        bands.resize_with(cuts.len() - 1, Band::default);
        for (band, cut) in bands.iter_mut().zip(cuts.windows(2)) {
            band.points.extend(bodies[band.points.len()..].iter().map(|b| Points::for_law(&b.law)));
            band.points.iter_mut().for_each(Points::clear);
            band.first_node = grid.column_start(cut[0]);
            // Columns cut[0] .. cut[1] + reach: base column c of the sort is column c + DRIFT of the grid.
            let reach = grid.column_start(cut[1] + STENCIL - 1 + 2 * DRIFT) - band.first_node;
            let owned = if cut[1] < base_columns { grid.column_start(cut[1]) - band.first_node } else { reach };
            (band.owned, band.reach) = (owned, reach);
            band.field_force.clear();
            band.shared.clear();
            band.open.clear();
            band.sums = BandSums::default();
        }
        for body in 0..bodies.len() {
            self.place(body, &cuts, bands, grid);
        }
        self.cuts = cuts;
    }

    fn place(&mut self, body: usize, cuts: &[usize], bands: &mut [Band], grid: &ActiveGrid) {
        let (all, cells) = (&self.all[body], &self.cells[body]);
        let key = |cell: &[i32; 2]| {
            let column = &grid.columns[base_column(cell, grid) + DRIFT];
            column.start as usize + (cell[1] - grid.first[1] as i32 - column.row) as usize
        };
        self.offsets.clear();
        self.offsets.resize(grid.len() + 1, 0);
        for cell in cells {
            self.offsets[key(cell) + 1] += 1;
        }
        for k in 0..grid.len() {
            self.offsets[k + 1] += self.offsets[k];
        }
        let mut next = 0;
        for (band, cut) in bands.iter_mut().zip(cuts.windows(2)) {
            let end = self.offsets[grid.column_start(cut[1] + DRIFT)] as usize;
            band.points[body].resize(end - next);
            next = end;
        }
        // First offset of each band, to turn global order into an index within the band.
        self.firsts.clear();
        self.firsts.extend(cuts.iter().map(|&c| self.offsets[grid.column_start(c + DRIFT)]));
        for (p, cell) in all.iter().zip(cells) {
            let slot = &mut self.offsets[key(cell)];
            let column = base_column(cell, grid);
            let b = cuts.partition_point(|&c| c <= column) - 1;
            bands[b].points[body].set((*slot - self.firsts[b]) as usize, p);
            *slot += 1;
        }
        for band in bands {
            band.points[body].pad();
        }
    }
}

/// Column of the sort (0 = leftmost stencil start) of a global cell.
fn base_column(cell: &[i32; 2], grid: &ActiveGrid) -> usize {
    (i64::from(cell[0]) - grid.first[0]) as usize - DRIFT
}

/// A node at or below the lower-left corner of the domain, with room for stencils.
fn domain_corner(rules: &SortRules) -> [i64; 2] {
    let index = |d: usize| {
        ((rules.domain[d][0] - rules.lattice.origin[d]) / rules.lattice.spacing).floor() as i64 - STENCIL as i64
    };
    [index(0), index(1)]
}

#[cfg(test)]
#[path = "layout_tests.rs"]
mod tests;
