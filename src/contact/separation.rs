//! How far two bodies are apart at a node.
//!
//! Velocities alone say that bodies approach, not that they have met: the stencils of their points overlap while there is still
//! up to a cell between them. Two measures of the gap along the normal, both negative where bodies overlap:
//!
//! - from mean positions at the node (Nairn 2013; Ng et al., Appendix B, with the sign that makes distant bodies part): cheap,
//!   and off by some hundredths of a cell according to where the surfaces lie between the nodes;
//! - from displacements since the bodies touched: for bodies that start in contact and slide little.
//!
//! A third, from the points nearest to the surface and their size (Nairn, Hammerquist and Smith 2020), needs the surface: it is taken
//! where that is, in `simulation::coupling`.
//!
//! Elsewhere: gap functions, the narrow phase of contact detection.

use super::Vector;
use super::normal::Sample;
use crate::seeded::{self, Seed};
use crate::space::{dot, minus};

/// Share of a cell by which mean positions at a node are apart when two bodies with two points per cell and direction touch.
pub const TOUCHING: f64 = 0.8;

/// Gap from mean positions, m: what their distance along the `normal` (out of `a`) exceeds `offset` cells of size `h` (m).
pub fn from_positions(a: &Sample, b: &Sample, normal: Vector, offset: f64, h: f64) -> f64 {
    dot(minus(b.mean(), a.mean()), normal) - seeded::times(Seed::ContactTouching, offset) * h
}

/// Gap from mean displacements since the bodies touched, m; the samples' moments are those of displacements.
pub fn from_displacements(a: &Sample, b: &Sample, normal: Vector) -> f64 {
    dot(minus(b.mean(), a.mean()), normal)
}

/// Speed of approach that only closes the gap within a step of `dt` (s), m/s.
pub fn slack(gap: f64, dt: f64) -> f64 {
    gap.max(0.0) / dt
}

/// Area of contact that belongs to a node of a grid of cell size `h` (m): sqrt(2 V min(Va, Vb)) / h with the volumes (m3) of the
/// two bodies there and V their sum, m2. It is thickness times h for a straight surface through the node (Nairn 2013; the
/// paper's A_cell without its factor t, which its areas need and volumes do not).
pub fn area(va: f64, vb: f64, h: f64) -> f64 {
    seeded::times(Seed::ContactArea, (2.0 * (va + vb) * va.min(vb)).sqrt()) / h
}
