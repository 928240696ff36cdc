//! Symmetric band matrices and their Cholesky factors; what is not zero in them, to be multiplied with vectors.
//!
//! Elsewhere: a direct solver for band (skyline) matrices.

/// The lower half of a symmetric matrix, row by row: each row ends on the diagonal.
#[derive(Debug, Clone, Default)]
pub(in crate::simulation) struct Banded {
    size: usize,
    /// Entries left of the diagonal in a row.
    reach: usize,
    rows: Vec<f64>,
}

impl Banded {
    /// A matrix of zeros.
    pub fn new(size: usize, reach: usize) -> Self {
        Self { size, reach, rows: vec![0.0; size * (reach + 1)] }
    }

    fn at(&self, i: usize, j: usize) -> usize {
        i * (self.reach + 1) + j + self.reach - i
    }

    /// Adds to entry (i, j), j <= i.
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        let at = self.at(i, j);
        self.rows[at] += value;
    }

    /// Becomes a matrix of zeros again.
    pub fn clear(&mut self) {
        self.rows.fill(0.0);
    }

    /// Becomes a times another matrix of the same shape.
    pub fn scaled_from(&mut self, other: &Banded, a: f64) {
        self.rows.iter_mut().zip(&other.rows).for_each(|(own, value)| *own = a * value);
    }

    /// Clears the row and column of `i` but for `diagonal`.
    pub fn isolate(&mut self, i: usize, diagonal: f64) {
        for j in i.saturating_sub(self.reach)..i {
            let at = self.at(i, j);
            self.rows[at] = 0.0;
        }
        for j in i + 1..(i + self.reach + 1).min(self.size) {
            let at = self.at(j, i);
            self.rows[at] = 0.0;
        }
        let at = self.at(i, i);
        self.rows[at] = diagonal;
    }

    /// Becomes its own Cholesky factor. False if it is not positive definite.
    pub fn factor(&mut self) -> bool {
        let width = self.reach + 1;
        for i in 0..self.size {
            let first = i.saturating_sub(self.reach);
            let (above, rest) = self.rows.split_at_mut(i * width);
            let own = &mut rest[..width];
            let offset = self.reach + first - i;
            for j in first..i {
                let other = &above[j * width..(j + 1) * width];
                // Columns that both rows have.
                let from = first.max(j.saturating_sub(self.reach));
                let a = &own[offset + from - first..offset + j - first];
                let b = &other[self.reach + from - j..self.reach];
                let sum: f64 = dot(a, b);
                own[offset + j - first] = (own[offset + j - first] - sum) / other[self.reach];
            }
            let square = own[self.reach] - dot(&own[offset..self.reach], &own[offset..self.reach]);
            if square.is_nan() || square <= 0.0 {
                return false;
            }
            own[self.reach] = square.sqrt();
        }
        true
    }

    /// Solves A x = b in place; the matrix must hold its factor.
    pub fn solve(&self, x: &mut [f64]) {
        self.solve_from(0, x);
    }

    /// The same for a right side that is zero before its entry `begin`.
    pub fn solve_from(&self, begin: usize, x: &mut [f64]) {
        let width = self.reach + 1;
        let row = |i: usize| &self.rows[i * width..(i + 1) * width];
        for i in begin..self.size {
            let first = i.saturating_sub(self.reach);
            let own = row(i);
            let sum = dot(&own[self.reach + first - i..self.reach], &x[first..i]);
            x[i] = (x[i] - sum) / own[self.reach];
        }
        for i in (0..self.size).rev() {
            let first = i.saturating_sub(self.reach);
            let own = row(i);
            let (before, rest) = x.split_at_mut(i);
            rest[0] /= own[self.reach];
            for (x_j, a) in before[first..].iter_mut().zip(&own[self.reach + first - i..self.reach]) {
                *x_j -= a * rest[0];
            }
        }
    }
}

/// What is not zero in a symmetric band matrix, in blocks of two rows and columns: those of a node.
#[derive(Debug, Clone, Default)]
pub(super) struct Blocks {
    /// For each node its first block, its block on the diagonal and the block past its last.
    rows: Vec<[usize; 3]>,
    /// The other node and the block, column by column, in the order of the other nodes.
    blocks: Vec<(u32, [[f64; 2]; 2])>,
}

impl Blocks {
    /// Takes over a matrix with two rows for each node.
    pub fn follow(&mut self, matrix: &Banded) {
        self.rows.clear();
        self.blocks.clear();
        let (nodes, near) = (matrix.size / 2, matrix.reach.div_ceil(2));
        let entry = |i: usize, j: usize| {
            let (i, j) = (i.max(j), i.min(j));
            if i - j <= matrix.reach { matrix.rows[matrix.at(i, j)] } else { 0.0 }
        };
        for node in 0..nodes {
            let (first, mut own) = (self.blocks.len(), 0);
            for other in node.saturating_sub(near)..(node + near + 1).min(nodes) {
                let block = [0, 1].map(|e| [0, 1].map(|d| entry(2 * node + d, 2 * other + e)));
                if other == node {
                    own = self.blocks.len();
                }
                if other == node || block != [[0.0; 2]; 2] {
                    self.blocks.push((other as u32, block));
                }
            }
            self.rows.push([first, own, self.blocks.len()]);
        }
    }

    /// y = A x. Each row is summed from the diagonal on through the columns before it and then through those after it.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        let add = |sum: &mut [f64; 2], blocks: &[(u32, [[f64; 2]; 2])]| {
            for (other, [a, b]) in blocks {
                let at: &[f64; 2] = x[2 * *other as usize..]
                    .first_chunk()
                    .expect("the vector is as long as the matrix: two entries for each node");
                *sum = [sum[0] + a[0] * at[0], sum[1] + a[1] * at[0]];
                *sum = [sum[0] + b[0] * at[1], sum[1] + b[1] * at[1]];
            }
        };
        for ((&[first, own, end], x), y) in self.rows.iter().zip(x.chunks_exact(2)).zip(y.chunks_exact_mut(2)) {
            let [[xx, yx], [xy, yy]] = self.blocks[own].1;
            let mut sum = [xx * x[0], yy * x[1]];
            add(&mut sum, &self.blocks[first..own]);
            sum = [sum[0] + xy * x[1], sum[1] + yx * x[0]];
            add(&mut sum, &self.blocks[own + 1..end]);
            // Never minus zero.
            (y[0], y[1]) = (0.0 + sum[0], 0.0 + sum[1]);
        }
    }
}

/// Scalar product with four sums, always the same ones.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (a4, b4) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = a4.remainder().iter().zip(b4.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in a4.zip(b4) {
        for k in 0..4 {
            sums[k] += x[k] * y[k];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scaffold::Lcg;

    #[test]
    fn a_solution_gives_back_the_right_side() {
        let mut random = Lcg::new(5);
        for (size, reach) in [(2, 1), (8, 2), (40, 9), (26, 25)] {
            let mut a = Banded::new(size, reach);
            for i in 0..size {
                for j in i.saturating_sub(reach)..i {
                    a.add(i, j, random.signed());
                }
                a.add(i, i, 2.0 * reach as f64 + 1.0);
            }
            if size > 5 {
                a.isolate(4, 3.0);
            }
            let x: Vec<f64> = (0..size).map(|_| random.signed()).collect();
            let (mut b, mut blocks) = (vec![0.0; size], Blocks::default());
            blocks.follow(&a);
            blocks.multiply(&x, &mut b);
            if size > 5 {
                assert_eq!(b[4], 3.0 * x[4]);
            }
            let mut factor = Banded::new(size, reach);
            factor.scaled_from(&a, 1.0);
            assert!(factor.factor());
            factor.solve(&mut b);
            let error = x.iter().zip(&b).map(|(x, b)| (x - b).abs()).fold(0.0, f64::max);
            assert!(error < 1e-13, "{size} {reach}: {error:e}");
        }
    }

    #[test]
    fn what_is_not_positive_definite_is_refused() {
        let mut a = Banded::new(2, 1);
        a.add(0, 0, 1.0);
        a.add(1, 1, 1.0);
        a.add(1, 0, 2.0);
        assert!(!a.factor());
    }
}
