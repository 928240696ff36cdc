//! Which way the surface between two bodies faces, from what their points add up to at a node.
//!
//! The gradient of a body's volume at a node, the sum of V grad S over its points, points out of the body. It is exact for a
//! straight surface along the grid or its diagonal; at other angles it is a few degrees off, and inside a body that reaches all
//! around the node there is none (Lemiale, Hurmane and Nairn 2010).
//!
//! Elsewhere: contact normals from gradients of mass, volume or a colour function.

use super::Vector;
use crate::space::{direction, minus, plus, scaled};

/// What the points of one body add up to at a node.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sample {
    /// Sum of m S, kg.
    pub mass: f64,
    /// Sum of V S, m3.
    pub volume: f64,
    /// Sum of V grad S with the gradient taken at the points, m2: out of the body.
    pub gradient: Vector,
    /// Sum of m S x, kg m, from any origin that is the same for all bodies; for displacements, of m S u.
    pub moment: Vector,
}

impl Sample {
    /// Adds a point of mass `m` (kg) and volume `v` (m3) at `x` (m), with weight `s` and its gradient (1/m).
    #[inline]
    pub fn add(&mut self, m: f64, v: f64, x: Vector, s: f64, gradient: Vector) {
        self.mass += m * s;
        self.volume += v * s;
        self.gradient = plus(self.gradient, scaled(gradient, v));
        self.moment = plus(self.moment, scaled(x, m * s));
    }

    /// Mean position (or displacement) of the points as the node sees them, m.
    pub fn mean(&self) -> Vector {
        self.moment.map(|x| x / self.mass)
    }
}

/// Unit normal out of body `a`, from the body that has more volume at the node; `least` (m2) is the size below which a gradient
/// is noise. None where the bodies are mixed so well that neither has a side.
pub fn from_larger(a: &Sample, b: &Sample, least: f64) -> Option<Vector> {
    direction(if a.volume >= b.volume { a.gradient } else { b.gradient.map(|g| -g) }, least)
}

/// The same from both: the difference of their gradients.
pub fn from_difference(a: &Sample, b: &Sample, least: f64) -> Option<Vector> {
    direction(minus(a.gradient, b.gradient), least)
}

/// Unit normal along the line from the mean position of `a` to that of `b`: coarse, for where nothing else is known.
pub fn from_positions(a: &Sample, b: &Sample) -> Option<Vector> {
    direction(minus(b.mean(), a.mean()), 0.0)
}
