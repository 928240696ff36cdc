//! What passes a barrier, and on which way: over its crest, under its foot, or through it.
//!
//! A point has passed a wall when it lies more than a cell behind its face. On which way, is decided where it crossed the plane of the
//! face: between the last place before it at which it was seen and the first one behind. So the gauge looks whenever a point may have moved
//! by a quarter of a cell, and not when samples are taken. What comes back has not passed, and what lay behind the barrier when the gauge
//! was opened does not count.
//!
//! Elsewhere: overtopping discharge, bypass, leakage.

use super::flow::may_flow;
use crate::boundary::Boundary;
use crate::seeded::{self, Seed};
use crate::simulation::{Extent, Simulation};
use crate::space::{dot, minus};
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// Way of a point between two looks, cells.
const LOOK: f64 = 0.25;
/// Within this distance of an end of a wall a point has passed by that end, cells: the grid knows no better where a wall ends.
const END: f64 = 0.5;

/// What has passed a barrier, since the gauge was opened.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Passage {
    /// Mass that went over the crest, kg.
    pub over: f64,
    /// Mass that went under the foot or the lower edge, kg.
    pub under: f64,
    /// All that has passed, kg. What it is more than the other two went through the barrier.
    pub past: f64,
}

/// How a point came to be where it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    Over,
    Under,
    Through,
    /// It was there before.
    None,
}

/// A point: body, and number within it.
type Key = (usize, u32);

/// What is known of points.
type Points<T> = HashMap<Key, T, BuildHasherDefault<ByNumber>>;

/// A place in a map by the numbers of a key. They are no text that someone has chosen, so that they need not be hidden.
#[derive(Debug, Clone, Copy, Default)]
struct ByNumber(u64);

impl Hasher for ByNumber {
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.write_u64(u64::from(*byte)));
    }

    fn write_u32(&mut self, number: u32) {
        self.write_u64(number.into());
    }

    fn write_usize(&mut self, number: usize) {
        self.write_u64(number as u64);
    }

    fn write_u64(&mut self, number: u64) {
        // Two to the 64th over the golden ratio: numbers that follow each other fall far apart.
        self.0 = (self.0.rotate_left(32) ^ number).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }

    fn finish(&self) -> u64 {
        self.0
    }
}

/// Follows what passes a wall.
#[derive(Debug, Clone, Default)]
pub struct PassageGauge {
    boundary: usize,
    /// Bodies that do not flow, by index.
    structures: Vec<usize>,
    /// Where points close to the face were seen last: distance before it, and position along it, m. For one behind the face, zero and
    /// where it crossed it.
    seen: Points<[f64; 2]>,
    passed: Points<Way>,
    /// Farthest that a point may have moved since the last look, m.
    moved: f64,
}

impl PassageGauge {
    /// A gauge on the boundary with this index. It leaves out the bodies that are `structures`, by index.
    pub fn new(simulation: &Simulation, boundary: usize, structures: &[usize]) -> Self {
        let mut gauge = Self { boundary, structures: structures.into(), ..Self::default() };
        gauge.open(simulation);
        gauge
    }

    /// Forgets what has passed: what is behind the face now was there before.
    pub fn open(&mut self, simulation: &Simulation) {
        self.seen.clear();
        self.passed.clear();
        self.look(simulation);
        self.passed.values_mut().for_each(|way| *way = Way::None);
    }

    /// Reads the last step.
    pub fn after_step(&mut self, simulation: &Simulation) {
        // The largest component of a velocity is at least its magnitude over the root of two.
        self.moved += std::f64::consts::SQRT_2 * simulation.largest_speed() * simulation.time_step().dt;
        if self.moved > LOOK * simulation.spacing() {
            self.look(simulation);
        }
    }

    /// What has passed until the last look.
    pub fn sample(&self, simulation: &Simulation) -> Passage {
        let mut counts = vec![[0u32; 3]; simulation.bodies().len()];
        for ((body, _), way) in &self.passed {
            match way {
                Way::Over => counts[*body][0] += 1,
                Way::Under => counts[*body][1] += 1,
                Way::Through => counts[*body][2] += 1,
                Way::None => (),
            }
        }
        let mut passage = Passage::default();
        for ([over, under, through], body) in counts.into_iter().zip(simulation.bodies()) {
            let mass = seeded::times(Seed::GaugePassage, body.point_mass);
            passage.over += f64::from(over) * mass;
            passage.under += f64::from(under) * mass;
            passage.past += f64::from(over + under + through) * mass;
        }
        passage
    }

    fn look(&mut self, simulation: &Simulation) {
        self.moved = 0.0;
        let b = &simulation.boundaries()[self.boundary];
        let (h, foot, normal) = (simulation.spacing(), b.foot().into(), b.normal.into());
        let distance = |x: [f64; 2]| dot(minus(x, foot), normal);
        let flows = |body: usize| may_flow(simulation, body) && !self.structures.contains(&body);
        let flowing: Vec<bool> = (0..simulation.bodies().len()).map(flows).collect();
        let near = |e: &&Extent| flowing[e.body] && distance(e.corner_against(normal)) <= h;
        for e in simulation.extents().iter().filter(near) {
            for ((block, points), ids) in simulation.blocks_in(e).zip(simulation.ids_in(e)) {
                for (l, id) in ids[..points].iter().enumerate() {
                    let x = [block.x[0][l], block.x[1][l]];
                    let d = distance(x);
                    if d <= h {
                        self.see((e.body, *id), d, b.face_coordinates(x).1, b, h);
                    }
                }
            }
        }
    }

    /// A point that lies `d` (m) before the face at `s` (m) along it, on cells of `h` (m).
    fn see(&mut self, key: Key, d: f64, s: f64, b: &Boundary, h: f64) {
        if d >= 0.0 {
            self.passed.remove(&key);
            self.seen.insert(key, [d, s]);
            return;
        }
        let crossed = match self.seen.get(&key) {
            Some(&[0.0, at]) => at,
            Some(&[before, at]) => at + (s - at) * before / (before - d),
            None => s,
        };
        if d >= -h {
            self.passed.remove(&key);
            self.seen.insert(key, [0.0, crossed]);
        } else {
            self.passed.entry(key).or_insert(match () {
                () if crossed > b.height() - END * h => Way::Over,
                () if crossed < b.free_below.max(0.0) + END * h => Way::Under,
                () => Way::Through,
            });
        }
    }
}

#[cfg(test)]
#[path = "passage_tests.rs"]
mod tests;
