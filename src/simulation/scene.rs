//! What a simulation starts from.

use crate::body::{Body, Particle};
use crate::boundary::{Boundary, BoundaryContact};
use crate::contact::rule::ContactRule;
use crate::grid::Lattice;
use crate::shape::ShapeFunction;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// When the stress is updated within a step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Scheme {
    /// Update stress first, from the velocities of the step's start (Bardenhagen 2002).
    Usf,
    /// Update stress last, from the new nodal velocities.
    Usl,
    /// Modified update stress last, from the new point velocities mapped back to the grid (Sulsky, Zhou and Schreyer 1995).
    #[default]
    Musl,
}

/// Share of PIC in the velocity update, v = a v_PIC + (1 - a) v_FLIP.
///
/// A fraction per step damps in proportion to the number of steps, a rate in proportion to time: a = rate dt. They are
/// interchangeable at a given time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PicShare {
    /// a itself, per step.
    Fraction(f64),
    /// a/dt, in 1/s.
    Rate(f64),
}

impl PicShare {
    /// The fraction for a step of `dt` seconds, at most 1.
    pub fn fraction(self, dt: f64) -> f64 {
        match self {
            PicShare::Fraction(a) => a,
            PicShare::Rate(rate) => (rate * dt).min(1.0),
        }
    }
}

/// What the opened strain of material that came apart follows.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum OpenedVolume {
    /// The strain that the grid sees, within what the volume that the points occupy allows.
    #[default]
    Occupied,
    /// The strain that the grid sees alone: sand that falls apart and comes together again stands up to 40 % too high.
    Strain,
}

/// Choices of the method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Numerics {
    /// Order of the stress update.
    pub scheme: Scheme,
    /// Shape function.
    pub shape: ShapeFunction,
    /// Time step as a share of h / (c + |v|).
    pub cfl: f64,
    /// Largest time step, s.
    pub max_time_step: f64,
    /// Share of PIC.
    pub pic: PicShare,
    /// Where boundaries act.
    pub boundary_contact: BoundaryContact,
    /// What the opened strain of material that came apart follows.
    pub opened_volume: OpenedVolume,
}

/// A field of accelerations (m/s2), given a point and the time (s). It is asked while bands are held by their threads, so it must not
/// start parallel work of its own on the same thread pool.
#[derive(Clone)]
pub struct AccelerationField(pub Arc<Acceleration>);

/// Acceleration (m/s2) of a point at a time (s).
pub type Acceleration = dyn Fn(&Particle, f64) -> [f64; 2] + Send + Sync;

impl std::fmt::Debug for AccelerationField {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("AccelerationField")
    }
}

/// Everything that a simulation starts from.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The grid.
    pub lattice: Lattice,
    /// Extent of the material across the plane, m.
    pub thickness: f64,
    /// Material outside [x_min, x_max], [y_min, y_max] is removed and counted, m.
    pub domain: [[f64; 2]; 2],
    /// Bodies with their points.
    pub bodies: Vec<(Body, Vec<Particle>)>,
    /// Contacts between bodies; bodies that are in none stick to each other where they meet.
    pub contacts: Vec<ContactRule>,
    /// Rigid boundaries.
    pub boundaries: Vec<Boundary>,
    /// Gravity, m/s2.
    pub gravity: [f64; 2],
    /// Friction coefficient of two side walls, at the distance of the thickness; 0 for none.
    pub side_wall_friction: f64,
    /// Method.
    pub numerics: Numerics,
}
