//! The front as it passes a place.

use serde::Serialize;

/// The front at a place.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct FrontPassage {
    /// Where, m.
    pub x_m: f64,
    /// When 1 % of the mass that flows had passed it, s.
    pub time_s: f64,
    /// When the edge, the foremost point, passed it, s.
    pub edge_time_s: f64,
    /// Velocity of its first `front_length_m` of `[scales]`, m/s.
    pub velocity_m_per_s: f64,
    /// Largest depth in twice that length, m.
    pub depth_m: f64,
    /// velocity / sqrt(g depth cos).
    pub froude_1: f64,
}
