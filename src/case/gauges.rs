//! What a case measures.

use serde::{Deserialize, Serialize};

/// What is measured during the run. Every field may be left out.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Gauges {
    /// Name of the boundary, or of the body, whose force is measured. Default: none. Allowed: the name of one of
    /// `[[boundaries]]`, or of a body in `[[contacts]]`, and not of both. Example: `"barrier"`.
    pub barrier: Option<String>,
    /// Names of several such boundaries and bodies, instead of `barrier`. The first is what is meant by the barrier; each of the
    /// others has files and a table of results of its own. Default: none. Allowed: as `barrier`, each name once; not together
    /// with `barrier`. Example: `["barrier", "second"]`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub barriers: Vec<String>,
    /// Name of the boundary whose friction holds the deposit. Default: none. Allowed: the name of one of
    /// `[[boundaries]]`. Example: `"base"`.
    pub base: Option<String>,
    /// Names of several such boundaries, instead of `base`. The first is what is meant by the base; each of the others has a file and
    /// a table of results of its own. Default: none. Allowed: as `base`, each name once; not together with `base`. Example:
    /// `["base", "second"]`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub bases: Vec<String>,
    /// Rows per second of the tables; a row is the mean over its interval. What `summary.toml` says does not depend on it. Default:
    /// `1000.0`. Allowed: above 0; at most 1e8 rows in a run, and at least ten if below 1000. Example: `500`.
    pub sample_rate_hz: f64,
    /// Length behind the front over which its velocity is averaged; its depth is the largest within twice that length. Default: 0.158
    /// times the square root of the area of what flows at the start. Allowed: above 0. Example: `0.05`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub front_length_m: Option<f64>,
    /// Force on a barrier from which the flow counts as arrived. Default: a 600th of the weight of what flows at the start. Allowed:
    /// 0 or more. Example: `0.5`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub arrival_force_n: Option<f64>,
    /// Flow depth and velocity are recorded at these x. Default: `[]`. Allowed: any number of x inside the domain.
    /// Example: `[0.5, 0.7]`.
    pub stations_m: Vec<f64>,
    /// Least and greatest x of the velocity field. Default: none. Allowed: `[low, high]` with low < high, inside the
    /// domain; together with `window_y_m` or not at all. Example: `[0.7, 1.2]`.
    pub window_x_m: Option<[f64; 2]>,
    /// Least and greatest y of the velocity field. Default: none. Allowed: as `window_x_m`. Example: `[0.0, 0.6]`.
    pub window_y_m: Option<[f64; 2]>,
    /// Times of the snapshots. Default: `[]`. Allowed: increasing, from 0 to `end_time_s`. Example: `[0.0, 0.5, 1.0]`.
    pub field_times_s: Vec<f64>,
    /// Further windows in which speeds are read, each with a file of its own.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub windows: Vec<Window>,
}

/// A rectangle in which speeds are read.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Window {
    /// Name; its file is called by it. Allowed: not empty, and different in its letters and digits from that of every other window.
    /// Example: `"upstream"`.
    pub name: String,
    /// Least and greatest x. Allowed: `[low, high]` with low < high, inside the domain. Example: `[0.2, 0.4]`.
    pub x_m: [f64; 2],
    /// Least and greatest y. Allowed: as `x_m`. Example: `[0.0, 0.2]`.
    pub y_m: [f64; 2],
}

impl Default for Gauges {
    fn default() -> Self {
        Gauges {
            barrier: None,
            barriers: Vec::new(),
            base: None,
            bases: Vec::new(),
            sample_rate_hz: 1000.0,
            front_length_m: None,
            arrival_force_n: None,
            stations_m: Vec::new(),
            window_x_m: None,
            window_y_m: None,
            field_times_s: Vec::new(),
            windows: Vec::new(),
        }
    }
}

impl Gauges {
    /// Names of all barriers, in order.
    pub fn barrier_names(&self) -> impl Iterator<Item = &str> {
        self.barrier.iter().chain(&self.barriers).map(String::as_str)
    }

    /// Names of all bases, in order.
    pub fn base_names(&self) -> impl Iterator<Item = &str> {
        self.base.iter().chain(&self.bases).map(String::as_str)
    }
}
