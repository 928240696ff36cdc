//! Symmetric band matrices and their Cholesky factors.

/// The lower half of a symmetric matrix, row by row: each row ends on the diagonal.
#[derive(Debug, Clone, Default)]
pub(super) struct Banded {
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

    /// y = A x.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        y.fill(0.0);
        for (i, row) in self.rows.chunks_exact(self.reach + 1).enumerate() {
            let first = i.saturating_sub(self.reach);
            let left = &row[self.reach + first - i..self.reach];
            let (before, rest) = y.split_at_mut(i);
            let mut sum = row[self.reach] * x[i];
            for ((a, x_j), y_j) in left.iter().zip(&x[first..i]).zip(&mut before[first..]) {
                sum += a * x_j;
                *y_j += a * x[i];
            }
            rest[0] += sum;
        }
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
        let width = self.reach + 1;
        let row = |i: usize| &self.rows[i * width..(i + 1) * width];
        for i in 0..self.size {
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
    use crate::verification::scene::Lcg;

    #[test]
    fn a_solution_gives_back_the_right_side() {
        let mut random = Lcg::new(5);
        for (size, reach) in [(1, 0), (7, 2), (40, 9), (25, 24)] {
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
            let mut b = vec![0.0; size];
            a.multiply(&x, &mut b);
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
