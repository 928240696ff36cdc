//! The material beside a barrier that bends: how high, how deep inside, what went over, and the force from its stress.

use super::StructureGauge;
use crate::contact::outline::Nearest;
use crate::gauge::beside::beside;
use crate::gauge::flow::may_flow;
use crate::gauge::layers::{self, LAYERS, Near};
use crate::gauge::wall_state::percentile;
use crate::seeded::{self, Seed};
use crate::simulation::Simulation;
use nalgebra::Vector2;

/// What is seen of the material beside a barrier. Distances are from its surface as it is now, heights from its foot along its
/// face at the start.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Survey {
    /// Force against the face from the stress of the nearest 1, 2, 3 layers of points, N.
    pub layers: [f64; 3],
    /// Highest point within 1.5 cells of the face, m.
    pub run_up: f64,
    /// 95th percentile of the heights of these points, m; zero if they are fewer than twenty.
    pub run_up_p95: f64,
    /// Mass behind the barrier, there or where it left the domain since the release, kg.
    pub behind: f64,
    /// Deepest that a point's domain lies inside the barrier, m.
    pub penetration: f64,
}

impl StructureGauge {
    pub(super) fn survey(&self, simulation: &Simulation) -> Survey {
        let h = simulation.spacing();
        let (n, reach) = (self.face.normal, LAYERS[2] as f64 * h);
        let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for place in self.points.iter().flatten() {
            let (d, s) = self.face.face_coordinates(place.x);
            for ([low, high], x) in bounds.iter_mut().zip([d, s]) {
                (*low, *high) = (low.min(x - reach), high.max(x + reach));
            }
        }
        let mut found = Survey { behind: self.departed, ..Survey::default() };
        let (mut near, mut heights) = (Vec::new(), Vec::new());
        let [least, most] = bounds[0];
        let flows = |body| body != self.body && may_flow(simulation, body);
        for point in beside(simulation, &self.face, most.max(least), flows) {
            let x = point.x();
            let (d, s) = self.face.face_coordinates(x);
            let body = &simulation.bodies()[point.body];
            let barrier = self.structures.contains(&point.body);
            if d < bounds[0][0] && !barrier {
                found.behind += body.point_mass;
            }
            let inside = d >= bounds[0][0] && d <= bounds[0][1] && s >= bounds[1][0] && s <= bounds[1][1];
            let Some(to) = inside.then(|| self.nearest(x)).flatten() else { continue };
            let out = Vector2::from(to.normal);
            found.penetration = found.penetration.max(0.5 * body.point_spacing - to.distance);
            if out.dot(&n) < -0.5 {
                found.behind += if barrier { 0.0 } else { body.point_mass };
                continue;
            }
            if to.distance <= 1.5 * h && !barrier {
                found.run_up = found.run_up.max(s);
                heights.push(s);
            }
            let at = self.face.face_coordinates(to.foot).1;
            if at < 0.0 || out.dot(&n) < 0.5 || to.distance < -h || to.distance > reach {
                continue;
            }
            let [xx, yy, _, xy] = point.stress();
            let traction = Vector2::new(xx * out.x + xy * out.y, xy * out.x + yy * out.y);
            near.push(Near {
                bin: (at / h) as usize,
                distance: to.distance,
                compression_volume: -traction.dot(&n)
                    * body.point_volume
                    * if seeded::is(Seed::GaugeSurvey) { 1.0 } else { point.volume_ratio() },
                spacing: body.point_spacing,
            });
        }
        found.layers = layers::sum(&near, h);
        found.run_up_p95 = percentile(&mut heights);
        found
    }

    fn nearest(&self, x: [f64; 2]) -> Option<Nearest> {
        let all = self.surfaces.iter().filter_map(|s| s.nearest(x));
        all.min_by(|a, b| a.distance.total_cmp(&b.distance))
    }
}
