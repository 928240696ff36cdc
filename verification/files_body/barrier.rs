//! A barrier in the files of a run: its columns and numbers by name, whichever of the barriers it is, and what is known of it.

use crate::from_file::Files;
use checkdam::check::{Check, Kind};

/// A barrier that is a body, as it is drawn in the case.
pub struct Barrier<'a> {
    /// What the run left.
    pub files: &'a Files,
    /// What follows in the names of its files: nothing for the first barrier.
    pub suffix: &'static str,
    /// What stands before its keys in the summary.
    pub root: &'static str,
    /// Its clamp.
    pub clamp: &'static str,
    /// Unit normal of its face, towards the material, and the direction to its crest.
    pub normal: [f64; 2],
    /// See `normal`.
    pub tangent: [f64; 2],
    /// Its weight along x and y, N; zero if it is weightless.
    pub weight: [f64; 2],
    /// Height of the face above the foot, m.
    pub height: f64,
    /// Cells, m.
    pub h: f64,
    /// Distance of its points, m.
    pub spacing: f64,
    /// Box around its outermost points at the start: along x, along y, m.
    pub extent: [[f64; 2]; 2],
    /// Where the highest point of the face is drawn, m.
    pub crest: [f64; 2],
    /// Points along the height of the whole body.
    pub points_along: usize,
    /// Whether settling has bent it before the clock starts.
    pub settled: bool,
    /// Width of the channel, m.
    pub width: f64,
}

impl Barrier<'_> {
    fn column(&self, table: &str, name: &str) -> Vec<f64> {
        self.files.column(&format!("{table}{}.csv", self.suffix), name)
    }

    /// Column of the samples of the gauges.
    pub fn history(&self, name: &str) -> Vec<f64> {
        self.column("history", name)
    }

    /// Column of the samples of the body.
    pub fn body(&self, name: &str) -> Vec<f64> {
        self.column("barrier", name)
    }

    /// Column of the profiles of the face.
    pub fn profile(&self, name: &str) -> Vec<f64> {
        self.column("barrier_profile", name)
    }

    /// Column of the profile at the largest force.
    pub fn at_peak(&self, name: &str) -> Vec<f64> {
        self.column("barrier_profile_at_peak", name)
    }

    /// Column of the profiles of pressure.
    pub fn pressure(&self, name: &str) -> Vec<f64> {
        self.column("pressure_profile", name)
    }

    /// Column of the surface.
    pub fn outline(&self, name: &str) -> Vec<f64> {
        self.column("barrier_outline", name)
    }

    /// What stands before what is said of it.
    pub fn label(&self) -> &'static str {
        if self.root.is_empty() { "" } else { "further barrier: " }
    }

    /// Number of the summary: `barrier.static_force_n`.
    pub fn number(&self, key: &str) -> f64 {
        self.files.number(&format!("{}{key}", self.root))
    }

    /// Number of the summary that belongs to the whole run.
    pub fn number_of_run(&self, key: &str) -> f64 {
        self.files.number(key)
    }

    /// Parts of a vector against the face and along it.
    pub fn components(&self, v: [f64; 2]) -> [f64; 2] {
        [-(v[0] * self.normal[0] + v[1] * self.normal[1]), v[0] * self.tangent[0] + v[1] * self.tangent[1]]
    }

    /// The part of a place along the normal of the face, m.
    pub fn outward(&self, x: [f64; 2]) -> f64 {
        x[0] * self.normal[0] + x[1] * self.normal[1]
    }

    /// Lengths of the intervals of the samples, s.
    pub fn intervals(&self) -> Vec<f64> {
        differences(&self.body("time_s"))
    }
}

/// Differences of what grows from zero.
pub fn differences(values: &[f64]) -> Vec<f64> {
    let before = std::iter::once(0.0).chain(values.iter().copied());
    values.iter().zip(before).map(|(b, a)| b - a).collect()
}

/// Sum of products.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Mean of the values whose key fulfils a condition; NaN if none does.
pub fn mean_where(keys: &[f64], values: &[f64], within: impl Fn(f64) -> bool) -> f64 {
    let found: Vec<f64> = keys.iter().zip(values).filter(|(k, _)| within(**k)).map(|(_, v)| *v).collect();
    found.iter().sum::<f64>() / found.len() as f64
}

/// Largest magnitude; NaN stays.
pub fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |a, v| if v.abs() > a || v.is_nan() { v.abs() } else { a })
}

/// The last value.
pub fn last(values: &[f64]) -> f64 {
    values.last().copied().unwrap_or(f64::NAN)
}

/// The value in the row whose key is nearest to `at`.
pub fn at(keys: &[f64], values: &[f64], place: f64) -> f64 {
    let near = keys.iter().zip(values).min_by(|a, b| (a.0 - place).abs().total_cmp(&(b.0 - place).abs()));
    near.map_or(f64::NAN, |n| *n.1)
}

/// The value at a place between rows whose keys grow, in a straight line.
pub fn between(keys: &[f64], values: &[f64], place: f64) -> f64 {
    let k = keys.partition_point(|key| *key < place).clamp(1, keys.len().max(2) - 1);
    match (keys.get(k - 1..=k), values.get(k - 1..=k)) {
        (Some(&[a, b]), Some(&[u, v])) => u + (v - u) * (place - a) / (b - a),
        _ => f64::NAN,
    }
}

/// The largest of many deviations, each over a scale of its own.
#[derive(Default)]
pub struct Worst {
    largest: f64,
    compared: usize,
}

impl Worst {
    /// Compares lists of the same length.
    pub fn lists(&mut self, found: &[f64], expected: &[f64], scale: f64) {
        if found.len() != expected.len() || found.is_empty() {
            self.largest = f64::INFINITY;
        }
        found.iter().zip(expected).for_each(|(a, b)| self.number(*a, *b, scale));
    }

    /// Compares two numbers. What is none is infinitely far off.
    pub fn number(&mut self, found: f64, expected: f64, scale: f64) {
        let off = ((found - expected) / scale).abs();
        self.largest = if off.is_nan() { f64::INFINITY } else { self.largest.max(off) };
        self.compared += 1;
    }

    /// That nothing deviates by more than `allowed`.
    pub fn check(self, what: &str, allowed: f64, why: &str, kind: Kind, source: &str) -> Check {
        let measured = if self.compared == 0 { f64::NAN } else { self.largest };
        Check::at_most(what, measured, allowed, "1").because(why).from(kind, source)
    }
}
