//! Two runs of a pair, number by number: what the first becomes under the transformation, what the second says, what is allowed.
//!
//! Round-off is no fixed share: a flow of sand amplifies it, from number to number by another factor. What is allowed is measured on the
//! same scene: twins whose points lie [`DISPLACED`] of their distance elsewhere, at random, are the same flow to more digits than any
//! number is read, and round-off displaces points by less than that.

use super::pairs::{Near, Pair, ROUND_OFF};
use super::reading::Reading;

/// Displacement of the points of a twin, as a share of their distance. Places of up to two metres are rounded to 2e-16 m, which is 1e-14 of a
/// distance of 2 cm, in each of some 2000 steps, at random: 5e-13 altogether, a twentieth of this.
pub const DISPLACED: f64 = 1e-11;
/// Twins, of which the farthest counts.
pub const TWINS: u32 = 2;
/// Numbers that twins leave as they are may differ by this share of themselves: their own round-off, of a few thousand sums.
pub const FLOOR: f64 = 1e-12;
/// The same of shares and ratios.
const FLOOR_OF_ONE: f64 = 1e-13;
/// Lengths are differences of places, m: each of these, some metres from the origin, is rounded to 4e-16 m.
const FLOOR_OF_PLACES: f64 = 2e-15;

/// A number, or a column, of both runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// Its name.
    pub name: String,
    /// What the transformation makes of the first run's; of a column the largest.
    pub before: f64,
    /// What the second run says; of a column the largest.
    pub after: f64,
    /// Their difference; of a column the largest of all rows.
    pub difference: f64,
    /// How large it may be.
    pub allowed: f64,
}

impl Compared {
    /// Difference over what is allowed; infinite where nothing is.
    pub fn share(&self) -> f64 {
        match () {
            () if self.difference.is_nan() => f64::INFINITY,
            () if self.difference == 0.0 => 0.0,
            () => self.difference / self.allowed,
        }
    }
}

/// What of a reading is compared: numbers as columns of one row.
fn quantities(reading: &Reading, by_rows: bool) -> Vec<(String, Vec<f64>)> {
    let summary = if by_rows { &reading.by_rows } else { &reading.summary };
    let numbers = summary.iter().map(|(name, x)| (name.clone(), vec![*x]));
    numbers.chain(reading.columns.iter().cloned()).collect()
}

fn largest(column: &[f64]) -> f64 {
    column.iter().fold(0.0, |a: f64, b| if b.abs() > a.abs() { *b } else { a })
}

/// Largest difference of two columns; not a number where one has another length or holds no number.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    let worst = |x: f64, y: f64| if x.is_nan() || y.is_nan() { f64::NAN } else { x.max(y) };
    let pairs = a.iter().zip(b).filter(|(a, b)| a.to_bits() != b.to_bits());
    let all = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, worst);
    if a.len() == b.len() { all } else { f64::NAN }
}

/// Both runs of a pair; `twins` are runs of the first scene.
pub fn compare(pair: &Pair, base: &Reading, twins: &[Reading], after: &Reading) -> Vec<Compared> {
    let by_rows = pair.factors.time != 1.0;
    let own = quantities(after, by_rows);
    let twins: Vec<_> = twins.iter().map(|t| quantities(t, by_rows)).collect();
    let silent = |name: &str| {
        let round_off = pair.near == Near::RoundOff && ROUND_OFF.iter().any(|part| name.ends_with(part));
        round_off || pair.silent.iter().copied().flatten().any(|part| name.contains(part))
    };
    let mut found = Vec::new();
    for (name, column) in quantities(base, by_rows).into_iter().filter(|q| !silent(&q.0)) {
        let of = |all: &[(String, Vec<f64>)]| all.iter().find(|q| q.0 == name).map(|q| q.1.clone()).unwrap_or_default();
        let along_x = name.ends_with(": x_m") || name.contains("front_x_m") || name.contains("front_edge_x_m");
        let turns = along_x || name.contains("_x_n_s") || name.ends_with("flow_direction_1");
        let factor = pair.factors.of(&name) * if turns { pair.sense } else { 1.0 };
        let shift = if along_x { pair.shift } else { 0.0 };
        let expected: Vec<f64> = column.iter().map(|x| factor * x + shift).collect();
        let seen = of(&own);
        let grown = twins.iter().map(|t| apart(&column, &of(t))).fold(0.0, f64::max) * factor.abs();
        let size = largest(&expected).abs();
        let least = match () {
            () if name.ends_with("_1") => FLOOR_OF_ONE,
            () if name.ends_with("_m") && !name.ends_with("_n_m") => FLOOR_OF_PLACES * pair.factors.length,
            () => 0.0,
        };
        let floor = least.max(FLOOR * size);
        let allowed = if pair.near == Near::Bits { 0.0 } else { grown.max(floor) };
        let difference = apart(&expected, &seen);
        found.push(Compared { name, before: largest(&expected), after: largest(&seen), difference, allowed });
    }
    found
}

/// The worst of all.
pub fn worst(compared: &[Compared]) -> Option<&Compared> {
    compared.iter().max_by(|a, b| a.share().total_cmp(&b.share()))
}
