//! Where digits must differ, because the scene lies otherwise between the nodes: means of several runs, with other packings and places.

use super::judge::{Compared, FLOOR};
use super::pairs::BY_AXES;
use super::reading::Reading;
use super::transform::turned;
use checkdam::case::Case;
use rayon::prelude::*;

/// Runs of a set.
const RUNS: u32 = 6;
/// Displacement of the points in them, as a share of their distance.
const JITTER: f64 = 0.2;
/// Angles by which sets are turned, degrees.
const ANGLES: [f64; 2] = [-17.0, -45.0];
/// Standard errors by which means of two sets of six may differ: Student's t of ten degrees of freedom at 1e-4, two-sided, so that one of the
/// two hundred numbers that are compared is off by chance in one of fifty rungs.
const ERRORS: f64 = 6.21;
/// Counts of steps and looks, which are 25 steps apart; and a sum of magnitudes along the axes, see `notes`.
const SILENT: &[&str] = &["stepping: ", "scales: ", "impulse_scale_n_s", "momentum_closure_1"];

/// Sets of runs: with walls on nodes, at places between them, and turned there.
pub struct Sets {
    on_nodes: Vec<Reading>,
    between: Vec<Reading>,
    turned: [Vec<Reading>; 2],
}

impl Sets {
    /// Runs them.
    pub fn run(base: &Case, run: impl Fn(&Case) -> Reading + Sync) -> Self {
        let case = |k: u32| {
            let mut case = base.clone();
            (case.bodies[0].jitter, case.bodies[0].jitter_seed) = (JITTER, k);
            if k >= RUNS {
                // Places that fill the cell evenly.
                let h = case.grid.spacing_m;
                case.grid.origin_m = [0.137, 0.411].map(|step| (step * f64::from(k)).fract() * h);
            }
            match (k / RUNS).checked_sub(2) {
                Some(set) => turned(&case, ANGLES[set as usize]),
                None => case,
            }
        };
        let mut readings: Vec<Reading> = (0..4 * RUNS).into_par_iter().map(|k| run(&case(k))).collect();
        let far = readings.split_off(3 * RUNS as usize);
        let turned = [readings.split_off(2 * RUNS as usize), far];
        let between = readings.split_off(RUNS as usize);
        Self { on_nodes: readings, between, turned }
    }

    /// Moved by broken cells.
    pub fn moved(&self) -> Vec<Compared> {
        compare(&self.on_nodes, &self.between, &[])
    }

    /// Turned by the first or the second angle.
    pub fn turned(&self, angle: usize) -> Vec<Compared> {
        compare(&self.between, &self.turned[angle], BY_AXES)
    }

    /// Means of a number between nodes, and turned there by the first angle.
    pub fn of(&self, name: &str) -> [f64; 2] {
        [&self.between, &self.turned[0]].map(|set| statistics(set, name).0)
    }
}

fn statistics(set: &[Reading], name: &str) -> (f64, f64) {
    let x: Vec<f64> = set.iter().map(|r| r.number(name)).collect();
    let n = x.len() as f64;
    let mean = x.iter().sum::<f64>() / n;
    (mean, (x.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0)).sqrt())
}

fn compare(before: &[Reading], after: &[Reading], silent: &[&str]) -> Vec<Compared> {
    let names = before.iter().take(1).flat_map(|r| &r.summary).map(|q| q.0.clone());
    let compared = names.filter(|name| !SILENT.iter().chain(silent).any(|part| name.contains(part))).map(|name| {
        let [(a, da), (b, db)] = [before, after].map(|set| statistics(set, &name));
        let error = ((da * da + db * db) / f64::from(RUNS)).sqrt();
        let allowed = (ERRORS * error).max(FLOOR * a.abs());
        Compared { name, before: a, after: b, difference: (a - b).abs(), allowed }
    });
    compared.collect()
}
