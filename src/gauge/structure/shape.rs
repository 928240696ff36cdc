//! How a barrier bends, and whether its points still hold together.

use super::StructureGauge;
use crate::constitutive::{Finger, Law};
use crate::contact::Vector;
use crate::seeded::{self, Seed};
use crate::simulation::Simulation;
use nalgebra::Vector2;

/// A point now.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    pub x: Vector,
    pub v: Vector,
    /// Largest principal stretch by the law; 1 for laws that keep no left Cauchy-Green tensor.
    pub stretch: f64,
}

/// How a barrier bends. Deflections and velocities are those of the points at its face, positive away from the material.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bend {
    /// Deflection of the highest point of the face, m.
    pub tip: f64,
    /// Its velocity, m/s.
    pub tip_velocity: f64,
    /// Largest deflection, m.
    pub largest: f64,
    /// Its height above the foot at the start, m.
    pub largest_at: f64,
    /// Widest gap between neighbouring points, in cells: their distance less what the stretch of the material makes of the one at
    /// the start. A barrier that tears numerically shows it here; points in place keep below a tenth.
    pub gap: f64,
    /// Its height above the foot at the start, m.
    pub gap_at: f64,
}

/// One point of the face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfilePoint {
    /// Height above the foot at the start, m.
    pub height: f64,
    /// Deflection away from the material, m.
    pub deflection: f64,
    /// Velocity away from the material, m/s.
    pub velocity: f64,
}

impl StructureGauge {
    /// Finds where the points and the surface are now.
    pub(super) fn follow(&mut self, simulation: &Simulation) {
        let law = simulation.bodies()[self.body].law;
        self.points.fill(None);
        for p in simulation.points_of(self.body) {
            let stretch = law.deformation(&p.state).as_ref().map_or(1.0, Finger::largest_stretch);
            self.points[p.id as usize] = Some(Place { x: p.x, v: p.v, stretch });
        }
        for (surface, ring) in self.surfaces.iter_mut().zip(&self.outline.rings) {
            surface.follow(ring.iter().filter_map(|&id| self.points[id as usize]).map(|p| p.x));
        }
    }

    /// Deflection and velocity of the points at the face, upwards from the foot, as of the last sample.
    pub fn profile(&self) -> Vec<ProfilePoint> {
        let [across, along] = self.counts;
        // The column of points nearest to the face.
        let distance = |i: usize| self.face.face_coordinates(self.start[i * along]).0.abs();
        let column = if distance(0) <= distance(across - 1) { 0 } else { across - 1 };
        let n = self.face.normal;
        let numbers = column * along..(column + 1) * along;
        let found = numbers.filter_map(|id| {
            let (place, start) = (self.points[id]?, self.start[id]);
            let height = self.face.face_coordinates(start).1;
            let deflection = -(Vector2::from(place.x) - Vector2::from(start)).dot(&n);
            let deflection = seeded::times(Seed::GaugeDeflection, deflection);
            (height > 0.0).then(|| ProfilePoint { height, deflection, velocity: -Vector2::from(place.v).dot(&n) })
        });
        found.collect()
    }

    pub(super) fn bend(&self, simulation: &Simulation) -> Bend {
        let profile = self.profile();
        let Some(tip) = profile.last() else { return Bend::default() };
        let largest = profile.iter().fold(*tip, |a, b| if b.deflection > a.deflection { *b } else { a });
        let (gap, gap_at) = self.widest_gap(simulation);
        Bend {
            tip: tip.deflection,
            tip_velocity: tip.velocity,
            largest: largest.deflection,
            largest_at: largest.height,
            gap,
            gap_at,
        }
    }

    fn widest_gap(&self, simulation: &Simulation) -> (f64, f64) {
        let along = self.counts[1];
        let h = simulation.spacing();
        let mut widest = (0.0, 0.0);
        for (id, place) in self.points.iter().enumerate() {
            let Some(place) = place else { continue };
            let above = ((id + 1) % along != 0).then_some(id + 1);
            for other in [above, Some(id + along)].into_iter().flatten() {
                let Some(Some(next)) = self.points.get(other) else { continue };
                let apart = (Vector2::from(next.x) - Vector2::from(place.x)).norm();
                let before = (Vector2::from(self.start[other]) - Vector2::from(self.start[id])).norm();
                let gap = (apart - place.stretch.max(next.stretch) * before) / h;
                if gap > widest.0 {
                    widest = (gap, self.face.face_coordinates(self.start[id]).1);
                }
            }
        }
        widest
    }
}
