//! How far two bodies are apart at a node.
//!
//! Velocities alone say that bodies approach, not that they have met: the stencils of their points overlap while there is still
//! up to a cell between them. Three measures of the gap along the normal, all negative where bodies overlap:
//!
//! - from mean positions at the node (Nairn 2013; Ng et al., Appendix B, with the sign that makes distant bodies part): cheap,
//!   and off by some hundredths of a cell according to where the surfaces lie between the nodes;
//! - from displacements since the bodies touched: for bodies that start in contact and slide little;
//! - from the points nearest to the surface and their size (Nairn, Hammerquist and Smith 2020): exact for straight surfaces.
//!
//! Elsewhere: gap functions, the narrow phase of contact detection.

use super::Vector;
use super::normal::Sample;
use crate::space::{dot, minus};

/// Share of a cell by which mean positions at a node are apart when two bodies with two points per cell and direction touch.
pub const TOUCHING: f64 = 0.8;

/// Gap from mean positions, m: what their distance along the `normal` (out of `a`) exceeds `offset` cells of size `h` (m).
pub fn from_positions(a: &Sample, b: &Sample, normal: Vector, offset: f64, h: f64) -> f64 {
    dot(minus(b.mean(), a.mean()), normal) - offset * h
}

/// Gap from mean displacements since the bodies touched, m; the samples' moments are those of displacements.
pub fn from_displacements(a: &Sample, b: &Sample, normal: Vector) -> f64 {
    dot(minus(b.mean(), a.mean()), normal)
}

/// A point with the size of its domain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grain {
    /// Position, m.
    pub x: Vector,
    /// Half of its extent along the normal, m.
    pub radius: f64,
}

/// Gap between the outermost points of either body, m; infinite where one has none.
pub fn from_extents(a: &[Grain], b: &[Grain], normal: Vector) -> f64 {
    let top = a.iter().map(|p| dot(p.x, normal) + p.radius).fold(f64::NEG_INFINITY, f64::max);
    let bottom = b.iter().map(|p| dot(p.x, normal) - p.radius).fold(f64::INFINITY, f64::min);
    bottom - top
}

/// Half of the extent along `normal` of a domain that was a square (taken as a circle, so that the result does not depend on
/// how the square lay) of half width `half` (m) and has the left Cauchy-Green tensor I + `finger` (xx, yy, xy):
/// half sqrt(n b n), m.
pub fn stretched_radius(half: f64, finger: [f64; 3], normal: Vector) -> f64 {
    let [x, y] = normal;
    half * (1.0 + x * x * finger[0] + y * y * finger[1] + 2.0 * x * y * finger[2]).max(0.0).sqrt()
}

/// Speed of approach that only closes the gap within a step of `dt` (s), m/s.
pub fn slack(gap: f64, dt: f64) -> f64 {
    gap.max(0.0) / dt
}

/// Area of contact that belongs to a node of a grid of cell size `h` (m): sqrt(2 V min(Va, Vb)) / h with the volumes (m3) of the
/// two bodies there and V their sum, m2. It is thickness times h for a straight surface through the node (Nairn 2013; the
/// paper's A_cell without its factor t, which its areas need and volumes do not).
pub fn area(va: f64, vb: f64, h: f64) -> f64 {
    (2.0 * (va + vb) * va.min(vb)).sqrt() / h
}
