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
