//! The active part of the uniform background grid.
//!
//! Nodes are numbered column by column (a column is a line of nodes along y), and only in the rows that material can reach.
//! Memory and work follow the material, wherever it is; the grid itself has no bounds. The three nodes of a stencil column have
//! successive numbers. The nodal fields themselves are kept by the [`crate::band`]s.

/// Cell size and where node (0, 0) lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lattice {
    /// Cell size h, m.
    pub spacing: f64,
    /// Position of node (0, 0), m.
    pub origin: [f64; 2],
}

impl Lattice {
    /// Position of a node, m.
    pub fn position(&self, i: i64, j: i64) -> [f64; 2] {
        [self.origin[0] + i as f64 * self.spacing, self.origin[1] + j as f64 * self.spacing]
    }
}

/// One column of active nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Column {
    /// Index of its first node among all active nodes.
    pub start: u32,
    /// First row, counted from [`ActiveGrid::first`].
    pub row: i32,
    /// Number of rows.
    pub rows: u32,
}

/// Nodes that material can reach until the next sort.
#[derive(Debug, Clone, Default)]
pub struct ActiveGrid {
    /// Global index of the first column and of row 0.
    pub first: [i64; 2],
    /// Position of the node at `first`, m.
    pub corner: [f64; 2],
    /// One over the cell size, 1/m.
    pub inverse_spacing: f64,
    /// Cell size, m.
    pub spacing: f64,
    /// Active columns, from left to right without gaps; a column may be empty.
    pub columns: Vec<Column>,
    /// For each column, the index that row 0 would have: a node's index less its row.
    pub row_zero: Vec<i32>,
}

impl ActiveGrid {
    /// Number of active nodes.
    pub fn len(&self) -> usize {
        self.columns.last().map_or(0, |c| (c.start + c.rows) as usize)
    }

    /// Whether no node is active.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Follows a change of the columns.
    pub fn index_columns(&mut self) {
        self.row_zero.clear();
        self.row_zero.extend(self.columns.iter().map(|c| c.start as i32 - c.row));
    }

    /// Index of the node at a column and row counted from the grid's corner; of no node where the column has no such row.
    #[inline(always)]
    pub fn node(&self, column: usize, row: i32) -> i32 {
        self.row_zero[column] + row
    }

    /// Column and row of a node, counted from the origin of the lattice.
    pub fn place(&self, node: usize) -> [i64; 2] {
        let c = self.columns.partition_point(|c| c.start as usize <= node) - 1;
        // Columns without rows start where the next one does; the last that starts there holds the node.
        let column = &self.columns[c];
        [self.first[0] + c as i64, self.first[1] + i64::from(column.row) + (node - column.start as usize) as i64]
    }

    /// The node at a column and row counted from the origin of the lattice, if it is active.
    pub fn find(&self, place: [i64; 2]) -> Option<usize> {
        let column = self.columns.get(usize::try_from(place[0] - self.first[0]).ok()?)?;
        let row = place[1] - self.first[1] - i64::from(column.row);
        (0..i64::from(column.rows)).contains(&row).then(|| column.start as usize + row as usize)
    }

    /// First node index of column `c`, or the number of nodes past the last column.
    pub fn column_start(&self, c: usize) -> usize {
        self.columns.get(c).map_or(self.len(), |column| column.start as usize)
    }

    /// All nodes as (index, position).
    pub fn nodes(&self) -> impl Iterator<Item = (usize, [f64; 2])> {
        self.columns.iter().enumerate().flat_map(move |(c, column)| {
            (0..column.rows).map(move |r| {
                let x = self.corner[0] + c as f64 * self.spacing;
                let y = self.corner[1] + (f64::from(column.row) + f64::from(r)) * self.spacing;
                ((column.start + r) as usize, [x, y])
            })
        })
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.columns.capacity() * size_of::<Column>() + self.row_zero.capacity() * size_of::<i32>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Columns at x = 10, 12 and 14 m with 3, 0 and 2 nodes, of which the lowest lie at y = 21 and 17 m.
    fn grid() -> ActiveGrid {
        let column = |start, row, rows| Column { start, row, rows };
        let mut grid = ActiveGrid {
            corner: [10.0, 17.0],
            spacing: 2.0,
            inverse_spacing: 0.5,
            columns: vec![column(0, 2, 3), column(3, 5, 0), column(3, 0, 2)],
            row_zero: vec![1; 9],
            ..ActiveGrid::default()
        };
        grid.index_columns();
        grid
    }

    #[test]
    fn nodes_lie_where_the_lattice_has_them() {
        let lattice = Lattice { spacing: 0.5, origin: [10.0, -3.0] };
        assert_eq!(lattice.position(4, -2), [12.0, -4.0]);
        let nodes: Vec<_> = grid().nodes().collect();
        let expected = [[10.0, 21.0], [10.0, 23.0], [10.0, 25.0], [14.0, 17.0], [14.0, 19.0]];
        assert_eq!(nodes, expected.into_iter().enumerate().collect::<Vec<_>>());
    }

    #[test]
    fn columns_know_their_nodes() {
        let grid = grid();
        assert_eq!((grid.len(), grid.is_empty()), (5, false));
        // The index that row 0 of each column would have.
        assert_eq!(grid.row_zero, [-2, -2, 3]);
        assert_eq!([0, 1, 2, 3].map(|c| grid.column_start(c)), [0, 3, 3, 5]);
        let mut none = ActiveGrid::default();
        none.index_columns();
        assert_eq!((none.len(), none.is_empty(), none.column_start(0)), (0, true, 0));
    }
}
