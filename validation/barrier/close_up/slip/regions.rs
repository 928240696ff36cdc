//! Deposit, slip surface and flow, by grid cells.

use super::TOUCH;

/// What makes a cell rest, and what is near the slip surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Threshold {
    /// Speed below which sand rests, over the velocity of the front.
    pub rest: f64,
    /// Width of the slip surface on either side, cells.
    pub cells: i64,
}

/// Where a cell lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Region {
    /// In the deposit, away from the slip surface.
    Deposit,
    /// In the deposit, at the slip surface.
    SlipDeposit,
    /// In the flow, at the slip surface.
    SlipFlow,
    /// In the flow, away from it.
    Flow,
}

/// What lies in a cell.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Cell {
    /// Sum of the displacements of its points, m, and their number.
    moved: [f64; 2],
    count: f64,
    barrier: bool,
}

impl Cell {
    fn displacement(&self) -> f64 {
        self.moved[0].hypot(self.moved[1]) / self.count
    }
}

/// The cells of a rectangle of the grid, row by row.
#[derive(Debug, Clone)]
pub struct Cells {
    spacing: f64,
    first: [i64; 2],
    size: [i64; 2],
    cells: Vec<Cell>,
}

impl Cells {
    /// No sand and no barrier, on a grid of this spacing (m) over a domain ([least, greatest] of x and y, m).
    pub fn new(spacing: f64, domain: [[f64; 2]; 2]) -> Self {
        let count = |x: f64| (x / spacing).floor() as i64;
        let first = domain.map(|d| count(d[0]));
        let size = [0, 1].map(|d| count(domain[d][1]) - first[d] + 1);
        Self { spacing, first, size, cells: vec![Cell::default(); (size[0] * size[1]) as usize] }
    }

    /// Takes everything out.
    pub fn clear(&mut self) {
        self.cells.fill(Cell::default());
    }

    /// Index of the cell in which a point lies; the nearest if it lies outside.
    pub fn index(&self, x: [f64; 2]) -> usize {
        let [i, j] = [0, 1].map(|d| ((x[d] / self.spacing).floor() as i64 - self.first[d]).clamp(0, self.size[d] - 1));
        (j * self.size[0] + i) as usize
    }

    /// Puts a point of sand in that was displaced by so much, m.
    pub fn add_sand(&mut self, cell: usize, moved: [f64; 2]) {
        let c = &mut self.cells[cell];
        c.moved = [c.moved[0] + moved[0], c.moved[1] + moved[1]];
        c.count += 1.0;
    }

    /// Puts a point of the barrier in.
    pub fn add_barrier(&mut self, cell: usize) {
        self.cells[cell].barrier = true;
    }

    /// Which cells belong to the deposit: sand whose mean displacement is less than `least` (m) and that hangs together with some at the
    /// barrier.
    pub fn deposit(&self, least: f64) -> Vec<bool> {
        let rests = |k: usize| self.cells[k].count > 0.0 && self.cells[k].displacement() < least;
        let mut found = vec![false; self.cells.len()];
        let touches = |k: usize| self.near(k, TOUCH).any(|(m, _)| self.cells[m].barrier);
        let mut waiting: Vec<usize> = (0..self.cells.len()).filter(|&k| rests(k) && touches(k)).collect();
        waiting.iter().for_each(|&k| found[k] = true);
        while let Some(k) = waiting.pop() {
            for (m, _) in self.near(k, 1) {
                if !found[m] && rests(m) {
                    found[m] = true;
                    waiting.push(m);
                }
            }
        }
        found
    }

    /// The regions of all cells, given the deposit and the width of the slip surface on either side, cells; of those without sand, flow.
    pub fn regions(&self, deposit: &[bool], width: i64) -> Vec<Region> {
        let of = |k: usize| if self.cells[k].count > 0.0 { self.region(k, deposit, width) } else { Region::Flow };
        (0..self.cells.len()).map(of).collect()
    }

    fn region(&self, cell: usize, deposit: &[bool], width: i64) -> Region {
        let own = deposit[cell];
        let other = |m: usize| self.cells[m].count > 0.0 && deposit[m] != own;
        let slips = self.near(cell, width).any(|(m, squared)| squared <= width * width && other(m));
        match (own, slips) {
            (true, false) => Region::Deposit,
            (true, true) => Region::SlipDeposit,
            (false, true) => Region::SlipFlow,
            (false, false) => Region::Flow,
        }
    }

    /// The cells at most so many columns and rows away, with the square of their distance.
    fn near(&self, cell: usize, reach: i64) -> impl Iterator<Item = (usize, i64)> + '_ {
        let (i, j) = (cell as i64 % self.size[0], cell as i64 / self.size[0]);
        let within = |at: i64, size: i64| (at - reach).max(0)..=(at + reach).min(size - 1);
        let columns = within(i, self.size[0]);
        within(j, self.size[1]).flat_map(move |n| {
            columns.clone().map(move |m| ((n * self.size[0] + m) as usize, (m - i) * (m - i) + (n - j) * (n - j)))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twenty columns and ten rows of sand, at rest below row 5 and from column 5 on, before a barrier to the right.
    fn heap() -> Cells {
        let mut cells = Cells::new(0.1, [[0.0, 2.19], [0.0, 0.99]]);
        let centre = |i: i32, j: i32| [0.1 * (f64::from(i) + 0.5), 0.1 * (f64::from(j) + 0.5)];
        for (i, j) in (0..20).flat_map(|i| (0..10).map(move |j| (i, j))) {
            let at = cells.index(centre(i, j));
            let moved = if j < 5 && i >= 5 { 0.0 } else { 0.01 };
            cells.add_sand(at, [moved, 0.0]);
            cells.add_sand(at, [-0.5 * moved, 0.0]);
        }
        // Rests, but far from the deposit.
        let lost = cells.index(centre(1, 1));
        cells.add_sand(lost, [-0.005, 0.0]);
        (0..10).for_each(|j| cells.add_barrier(cells.index(centre(20, j))));
        cells
    }

    #[test]
    fn regions_are_where_they_should_be() {
        let cells = heap();
        let deposit = cells.deposit(1e-3);
        assert_eq!(deposit.iter().filter(|d| **d).count(), 15 * 5);
        let at = |i: usize, j: usize, width| cells.regions(&deposit, width)[j * 22 + i];
        assert_eq!(
            [0, 2, 3, 4].map(|j| at(12, j, 2)),
            [Region::Deposit, Region::Deposit, Region::SlipDeposit, Region::SlipDeposit]
        );
        assert_eq!(
            [5, 6, 7, 9].map(|j| at(12, j, 2)),
            [Region::SlipFlow, Region::SlipFlow, Region::Flow, Region::Flow]
        );
        assert_eq!(
            [3, 4, 5, 6].map(|j| at(12, j, 1)),
            [Region::Deposit, Region::SlipDeposit, Region::SlipFlow, Region::Flow]
        );
        // The sand that rests far away is not of the deposit.
        assert_eq!(at(1, 1, 2), Region::Flow);
        // A larger threshold lets everything rest: no slip surface is left.
        let all = cells.deposit(1.0);
        assert!(all.iter().filter(|d| **d).count() == 200 && cells.regions(&all, 4)[0] == Region::Deposit);
        // Nothing rests: all is flow.
        assert!(cells.deposit(0.0).iter().all(|d| !d));
    }
}
