//! What is seen of a barrier.

use super::collect::Collector;
use super::releases::Arrival;
use super::slip;
use checkdam::boundary::Boundary;
use checkdam::gauge::structure::ProfilePoint;

/// What was seen of a barrier.
pub(super) struct Seen {
    pub barrier: &'static str,
    pub arrival: Arrival,
    pub collector: Collector,
    pub rows: Vec<slip::Row>,
    /// Plastic work after the arrival by threshold and region, J.
    pub thresholds: [[f64; 4]; slip::THRESHOLDS.len()],
    pub peak: Vec<ProfilePoint>,
    pub face: Boundary,
    pub thickness: f64,
    pub spacing: f64,
    pub outlines: Vec<(usize, Vec<[f64; 2]>)>,
}
