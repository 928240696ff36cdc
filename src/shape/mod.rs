//! Grid shape functions: how a material point sees the nodes around it.
//!
//! All are products of one-dimensional functions with at most three nodes a direction, so that the transfer loops know one stencil. The
//! quadratic B-spline is the uGIMP function of a particle domain that is one cell wide: both are the hat function averaged over a box. So
//! the two share their code. The hat itself is the limit of a domain of no width.
//!
//! Elsewhere: interpolation, basis or kernel functions; GIMP is the generalised interpolation material point method.

use serde::{Deserialize, Serialize};

pub(crate) mod stencil;

/// Nodes of the stencil in each direction.
pub const STENCIL: usize = 3;

/// Interpolation between particles and grid nodes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum ShapeFunction {
    /// Linear hat functions: the original material point method (Sulsky, Chen and Schreyer 1994).
    Linear,
    /// Uniform generalised interpolation: the hat averaged over an undeforming particle domain (Bardenhagen and Kober 2004).
    #[default]
    Ugimp,
    /// Quadratic B-spline (Steffen, Kirby and Berzins 2008).
    Bspline,
}

impl ShapeFunction {
    /// Half the width of the averaging box, in cells, for `points_per_direction` material points a cell and direction.
    pub fn half_width(self, points_per_direction: usize) -> f64 {
        match self {
            ShapeFunction::Linear => 0.0,
            ShapeFunction::Ugimp => 0.5 / points_per_direction as f64,
            ShapeFunction::Bspline => 0.5,
        }
    }
}

/// A one-dimensional shape function on a grid of unit spacing.
///
/// A point at `u` touches the nodes `b`, `b + 1`, `b + 2`, where `b` is the integer part of `u - shift()`.
pub trait Shape1d: Copy + Send + Sync {
    /// What to subtract from the coordinate, in cells, before taking its integer part.
    fn shift(&self) -> f64;
    /// Weights of the three nodes and their derivatives, per cell, at the remainder `r` in [0, 1].
    fn eval(&self, r: f64) -> ([f64; STENCIL], [f64; STENCIL]);
}

/// The linear hat function. The third node of the stencil has no weight.
#[derive(Debug, Clone, Copy)]
pub struct Hat;

impl Shape1d for Hat {
    #[inline(always)]
    fn shift(&self) -> f64 {
        0.0
    }

    #[inline(always)]
    fn eval(&self, r: f64) -> ([f64; STENCIL], [f64; STENCIL]) {
        ([1.0 - r, r, 0.0], [-1.0, 1.0, 0.0])
    }
}

/// The hat function averaged over a box: uGIMP, and at half width 1/2 the quadratic B-spline.
#[derive(Debug, Clone, Copy)]
pub struct AveragedHat {
    half_width: f64,
    per_4_half_widths: f64,
}

impl AveragedHat {
    /// `half_width` in cells, in (0, 1/2].
    pub fn new(half_width: f64) -> Self {
        Self { half_width, per_4_half_widths: 0.25 / half_width }
    }
}

impl Shape1d for AveragedHat {
    #[inline(always)]
    fn shift(&self) -> f64 {
        self.half_width
    }

    #[inline(always)]
    fn eval(&self, r: f64) -> ([f64; STENCIL], [f64; STENCIL]) {
        // The box [r, r + 2l] in cell coordinates of the first node: p and q are what lies between its two ends and the
        // second node (q only while it has not passed it), e what reaches beyond it.
        let end = r + 2.0 * self.half_width;
        let p = 1.0 - r;
        let q = max0(1.0 - end);
        let e = max0(end - 1.0);
        let w0 = (p * p - q * q) * self.per_4_half_widths;
        let w2 = e * e * self.per_4_half_widths;
        let g0 = (q - p) * (2.0 * self.per_4_half_widths);
        let g2 = e * (2.0 * self.per_4_half_widths);
        ([w0, 1.0 - w0 - w2, w2], [g0, -g0 - g2, g2])
    }
}

/// max(x, 0) as one vector instruction (no special case for NaN, which is caught elsewhere).
#[inline(always)]
fn max0(x: f64) -> f64 {
    if x > 0.0 { x } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::floor_to_int;

    /// Weight of node 0 at distance `d` (in cells) from it, as the textbooks write it.
    fn textbook_ugimp(d: f64, l: f64) -> f64 {
        let d = d.abs();
        if d < l {
            1.0 - (d * d + l * l) / (2.0 * l)
        } else if d <= 1.0 - l {
            1.0 - d
        } else if d < 1.0 + l {
            (1.0 + l - d).powi(2) / (4.0 * l)
        } else {
            0.0
        }
    }

    fn textbook_bspline(d: f64) -> f64 {
        let d = d.abs();
        if d < 0.5 {
            0.75 - d * d
        } else if d < 1.5 {
            0.5 * (1.5 - d).powi(2)
        } else {
            0.0
        }
    }

    fn weights(s: impl Shape1d, u: f64) -> (i32, [f64; 3], [f64; 3]) {
        let (b, r) = floor_to_int(u - s.shift());
        let (w, g) = s.eval(r);
        (b, w, g)
    }

    #[test]
    fn averaging_boxes_are_as_wide_as_the_particle_domain() {
        let width = |shape: ShapeFunction, points| 2.0 * shape.half_width(points);
        for points in [1, 2, 3, 4] {
            assert_eq!(width(ShapeFunction::Linear, points), 0.0);
            assert_eq!(width(ShapeFunction::Ugimp, points), 1.0 / points as f64);
            assert_eq!(width(ShapeFunction::Bspline, points), 1.0);
        }
    }

    #[test]
    fn unity_linear_field_and_gradient() {
        for k in 0..400 {
            let u = 2.0 + f64::from(k) * 0.00731;
            for (l, hat) in [(0.0, true), (0.25, false), (0.5, false), (1.0 / 6.0, false)] {
                let at = |u| if hat { weights(Hat, u) } else { weights(AveragedHat::new(l), u) };
                let (b, w, g) = at(u);
                let x = |i: usize| f64::from(b) + i as f64;
                assert!((w.iter().sum::<f64>() - 1.0).abs() < 1e-15);
                assert!(g.iter().sum::<f64>().abs() < 1e-15);
                assert!(((0..3).map(|i| w[i] * x(i)).sum::<f64>() - u).abs() < 1e-14);
                assert!(((0..3).map(|i| g[i] * x(i)).sum::<f64>() - 1.0).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn matches_the_textbook_functions_and_their_differences() {
        for k in 1..400 {
            let u = 2.0 + f64::from(k) * 0.00731;
            for (l, bspline) in [(0.25, false), (1.0 / 6.0, false), (0.125, false), (0.5, true)] {
                let f = |d: f64| if bspline { textbook_bspline(d) } else { textbook_ugimp(d, l) };
                let (b, w, g) = weights(AveragedHat::new(l), u);
                for i in 0..3 {
                    let d = u - f64::from(b) - i as f64;
                    assert!((w[i] - f(d)).abs() < 1e-14, "l {l} u {u} node {i}");
                    let e = 1e-6;
                    assert!((g[i] - (f(d + e) - f(d - e)) / (2.0 * e)).abs() < 1e-5);
                }
            }
        }
    }
}
