//! Which face of a structure is nearest to each of many points.
//!
//! Elsewhere: closest-point projection onto the master surface.

use super::scan::Near;
use crate::contact::outline::{Nearest, Surface};
use crate::simulation::sweep::together;

/// Points that are asked for at a time.
const BATCH: usize = 512;
/// Points that are worth the other thread's while.
const WORTH: usize = 32;

/// Points and the faces found for them, by two threads. What follows from them is summed in the order of the points,
/// whichever thread found them.
#[derive(Debug, Clone, Default)]
pub(super) struct Batch {
    points: Vec<Near>,
    faces: Vec<Option<Nearest>>,
}

impl Batch {
    /// Makes room.
    pub fn reserve(&mut self) {
        self.points.reserve(BATCH);
        self.faces.resize(BATCH, None);
    }

    /// Takes a point; says whether the batch is full.
    pub fn push(&mut self, point: Near) -> bool {
        self.points.push(point);
        self.points.len() == BATCH
    }

    /// Calls `visit` with every point and the face nearest to it, in order, and forgets them.
    pub fn answer(&mut self, surfaces: &[Surface], mut visit: impl FnMut(&Near, &Nearest)) {
        let faces = &mut self.faces[..self.points.len()];
        if faces.len() < WORTH {
            search(surfaces, &self.points, faces);
        } else {
            let half = faces.len() / 2;
            let ((first, second), (first_faces, second_faces)) = (self.points.split_at(half), faces.split_at_mut(half));
            together(|| search(surfaces, first, first_faces), || search(surfaces, second, second_faces));
        }
        for (point, face) in self.points.iter().zip(&*faces) {
            if let Some(face) = face {
                visit(point, face);
            }
        }
        self.points.clear();
    }
}

fn search(surfaces: &[Surface], points: &[Near], faces: &mut [Option<Nearest>]) {
    for (point, face) in points.iter().zip(faces) {
        let all = surfaces.iter().filter_map(|s| s.nearest(point.x));
        *face = all.min_by(|p, q| p.distance.total_cmp(&q.distance));
    }
}
