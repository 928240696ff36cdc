//! The plane that best separates two clouds of points, by logistic regression (Nairn, Hammerquist and Smith 2020).
//!
//! Each point carries a label, -1 for the first body and +1 for the second. The function tanh((b0 x + b1 y + b2)/2) is fitted
//! to the labels by least squares; its gradient is the normal. A small penalty on b keeps clouds that can be separated, for
//! which the fit would grow without bound, at a finite slope. Gauss-Newton steps start from the linear fit.

use super::Vector;
use crate::space::direction;

/// Most Gauss-Newton steps.
const STEPS: usize = 15;
/// One minus the cosine of the last turn of the normal at which the fit is done.
const TURNED: f64 = 1e-10;
/// Penalty on the slope, per point, with positions in cells.
const PENALTY: f64 = 1e-5;

/// Unit normal out of the first body, from the positions (m) of both about the node at `origin`, on a grid of cell size `h`
/// (m). None where the clouds coincide or one is empty.
pub fn normal(a: &[Vector], b: &[Vector], origin: Vector, h: f64) -> Option<Vector> {
    if a.is_empty() || b.is_empty() {
        return None;
    }
    let points = || {
        let labelled = |label: f64| move |x: &Vector| ([(x[0] - origin[0]) / h, (x[1] - origin[1]) / h, 1.0], label);
        a.iter().map(labelled(-1.0)).chain(b.iter().map(labelled(1.0)))
    };
    let count = (a.len() + b.len()) as f64;
    let mut fit = Normal::new(PENALTY * count, [0.0; 3]);
    points().for_each(|(x, label)| fit.add(x, label));
    // tanh(y/2) rises with slope 1/2: the linear fit is doubled.
    let mut beta = fit.solve()?.map(|c| 2.0 * c);
    let mut last = direction([beta[0], beta[1]], 0.0)?;
    for _ in 0..STEPS {
        let mut fit = Normal::new(PENALTY * count, beta);
        for (x, label) in points() {
            let y = beta[0] * x[0] + beta[1] * x[1] + beta[2];
            let value = libm::tanh(0.5 * y);
            let slope = 0.5 * (1.0 - value * value);
            fit.add(x.map(|c| slope * c), label - value);
        }
        let step = fit.solve()?;
        for (b, s) in beta.iter_mut().zip(step) {
            *b += s;
        }
        let next = direction([beta[0], beta[1]], 0.0)?;
        let turn = 1.0 - (next[0] * last[0] + next[1] * last[1]);
        last = next;
        if turn < TURNED {
            break;
        }
    }
    Some(last)
}

/// Normal equations of a penalised least-squares fit in three unknowns.
struct Normal {
    /// Upper triangle: 00, 01, 02, 11, 12, 22.
    matrix: [f64; 6],
    right: [f64; 3],
}

impl Normal {
    /// With a penalty on the distance of the solution from `-beta`.
    fn new(penalty: f64, beta: [f64; 3]) -> Self {
        Self { matrix: [penalty, 0.0, 0.0, penalty, 0.0, penalty], right: beta.map(|b| -penalty * b) }
    }

    fn add(&mut self, x: [f64; 3], value: f64) {
        for (entry, (i, j)) in self.matrix.iter_mut().zip([(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]) {
            *entry += x[i] * x[j];
        }
        for (r, c) in self.right.iter_mut().zip(x) {
            *r += c * value;
        }
    }

    /// By Cholesky factors.
    fn solve(&self) -> Option<[f64; 3]> {
        let [a, b, c, d, e, f] = self.matrix;
        let l00 = a.sqrt();
        let (l10, l20) = (b / l00, c / l00);
        let l11 = (d - l10 * l10).sqrt();
        let l21 = (e - l20 * l10) / l11;
        let l22 = (f - l20 * l20 - l21 * l21).sqrt();
        let [r0, r1, r2] = self.right;
        let y0 = r0 / l00;
        let y1 = (r1 - l10 * y0) / l11;
        let y2 = (r2 - l20 * y0 - l21 * y1) / l22;
        let x2 = y2 / l22;
        let x1 = (y1 - l21 * x2) / l11;
        let x0 = (y0 - l10 * x1 - l20 * x2) / l00;
        [x0, x1, x2].iter().all(|x| x.is_finite()).then_some([x0, x1, x2])
    }
}
