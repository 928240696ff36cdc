//! A cantilever under the pressure that a file has.

use super::barrier::{Barrier, last};
use checkdam::theory::cantilever::Cantilever;
use checkdam::theory::elastic::Elastic;

pub(super) const H: f64 = 0.05;
pub(super) const WIDTH: f64 = 0.2;
pub(super) const LENGTH: f64 = 0.5;
pub(super) const DEPTH: f64 = 0.1;
pub(super) const YOUNG: f64 = 1e7;

/// The loads on the plate: forces at heights, from the pressure in the file, and its own weight.
pub struct Line {
    beam: Cantilever,
    /// Height, m, and force, N.
    pub forces: Vec<[f64; 2]>,
    own: f64,
}

impl Line {
    /// Of a barrier at the end of its run, with a weight of `own` N/m.
    pub fn of(b: &Barrier, own: f64) -> Self {
        let elastic = Elastic { young: YOUNG, poisson: 0.0 };
        let beam = Cantilever { elastic, density: 1000.0, length: LENGTH, depth: DEPTH, width: WIDTH };
        let (t, z, p) = (b.pressure("time_s"), b.pressure("height_m"), b.pressure("pressure_pa"));
        let end = last(&t);
        let rows: Vec<usize> = (0..t.len()).filter(|&k| t[k] == end).collect();
        let bins = rows.len();
        let high = |k: usize| if k == 0 || k + 1 == bins { 0.5 * H } else { H };
        let forces = rows.iter().enumerate().map(|(k, &row)| [z[row], p[row] * high(k) * WIDTH]).collect();
        Self { beam, forces, own }
    }

    /// Second moment of the section, m4.
    pub fn inertia(&self) -> f64 {
        WIDTH * DEPTH * DEPTH * DEPTH / 12.0
    }

    /// Deflection at the height `z`, m.
    pub fn deflection(&self, z: f64) -> f64 {
        let (bending, shear) = (self.beam.bending_stiffness(), self.beam.shear_stiffness());
        let one = |[s, force]: [f64; 2]| {
            let (a, b) = (z.min(s), z.max(s));
            force * (a * a * (3.0 * b - a) / (6.0 * bending) + a / shear)
        };
        self.forces.iter().map(|f| one(*f)).sum::<f64>() + self.beam.under_load(self.own, z)
    }

    /// Bending moment at the height `z`, N m.
    pub fn moment(&self, z: f64) -> f64 {
        let above = self.forces.iter().filter(|f| f[0] > z).map(|f| f[1] * (f[0] - z)).sum::<f64>();
        above + 0.5 * self.own * (LENGTH - z) * (LENGTH - z)
    }
}
