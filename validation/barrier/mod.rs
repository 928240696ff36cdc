//! The parametric study of Ng, Wang, Choi, De Silva and Poudyal: the flume at 60 degrees against a vertical elastic
//! barrier whose flexural rigidity spans six decades.
//!
//! [`rigid`] predicts the limit of a rigid wall, and [`impact`] judges what must hold at every moment. [`rigidity`], [`grids`], [`steps`],
//! [`kinematics`], [`density`] and [`weight`] analyse studies of many runs, which [`records`] lists. [`close_up`] looks into four of the barriers.
//! [`claims`] holds every claim of the paper against all of this.

pub mod beam;
pub mod claims;
pub mod close_up;
pub mod density;
pub mod grids;
pub mod impact;
pub mod kinematics;
pub mod records;
pub mod rigid;
pub mod rigidity;
pub mod steps;
pub mod weight;

use super::data;

/// The file of the paper's numbers for the barrier.
const PUBLISHED: data::Source = data::SOURCES[1];

/// Angle of the flume in all cases of the barrier, degrees below the horizontal.
const INCLINATION_DEG: f64 = 60.0;
