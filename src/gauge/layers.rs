//! Force on a wall from the stress of the nearest layers of material points (Ng et al., Eq. 8 and Appendix C).
//!
//! Eq. 8 sums pressure times area over the points of a layer; with several layers the sum must be divided by their number, or
//! the area counts as often. Here the sum is an integral: normal stress times volume over all points within k point spacings
//! of the nearest one, divided by the thickness of k spacings. The nearest point is sought anew in each bin of one cell's
//! height, so that material which has not arrived does not count.

use super::beside::{acts_on, beside};
use crate::seeded::{self, Seed};
use crate::simulation::Simulation;

/// Layers that are averaged.
pub const LAYERS: [usize; 3] = [1, 2, 3];

/// Normal force (N, positive in compression) on a wall from the nearest 1, 2 and 3 layers of points of the bodies on which it acts.
pub fn normal_force(simulation: &Simulation, boundary: usize) -> [f64; 3] {
    let b = &simulation.boundaries()[boundary];
    let h = simulation.spacing();
    let (nx, ny) = (b.normal.x, b.normal.y);
    let reach = LAYERS[2] as f64 * h;
    let mut near: Vec<Near> = Vec::new();
    beside(simulation, b, reach, |body| acts_on(b, body)).for_each(|point| {
        let (d, s) = b.face_coordinates(point.x());
        if d < -h || s < 0.0 || s > b.height() {
            return;
        }
        let body = &simulation.bodies()[point.body];
        let [xx, yy, _, xy] = point.stress();
        let normal_stress = nx * nx * xx + ny * ny * yy + 2.0 * nx * ny * xy;
        near.push(Near {
            bin: (s / h) as usize,
            distance: d,
            compression_volume: -normal_stress * body.point_volume * point.volume_ratio(),
            spacing: body.point_spacing,
        });
    });
    sum(&near, h)
}

/// A point near a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Near {
    /// Which cell along the face.
    pub bin: usize,
    /// Distance from the face, m.
    pub distance: f64,
    /// Compressive stress against the face times volume, Pa m3.
    pub compression_volume: f64,
    /// Distance between points, m.
    pub spacing: f64,
}

/// Force (N) from the nearest 1, 2 and 3 layers of these points; `h` is the cell size, m.
pub(super) fn sum(near: &[Near], h: f64) -> [f64; 3] {
    let bins = near.iter().map(|n| n.bin + 1).max().unwrap_or(0);
    let mut nearest = vec![f64::INFINITY; bins];
    for n in near {
        nearest[n.bin] = nearest[n.bin].min(n.distance);
    }
    let mut force = [0.0; 3];
    for n in near {
        let first = nearest[n.bin];
        if first > h {
            continue;
        }
        for (force, &layers) in force.iter_mut().zip(&LAYERS) {
            let thickness = seeded::times(Seed::GaugeLayer, layers as f64 * n.spacing);
            if n.distance < first - 0.5 * n.spacing + thickness {
                *force += n.compression_volume / thickness;
            }
        }
    }
    force
}

#[cfg(test)]
#[path = "layers_tests.rs"]
mod tests;
