//! Numbers that a run is reduced to.

use crate::run::Summary;
use crate::run::structure::StructureResults;
use crate::run::summary::{BarrierResults, DepositResults, FrontPassage};
use crate::seeded::{self, Seed};

/// A number of a run.
#[derive(Debug, Clone, Copy)]
pub struct Quantity {
    /// Column; ends in the unit.
    pub name: &'static str,
    /// Title on an axis, with the unit.
    pub title: &'static str,
    /// The number; NaN where the run has none.
    pub of: fn(&Summary) -> f64,
}

fn barrier(summary: &Summary, value: fn(&BarrierResults) -> f64) -> f64 {
    summary.barrier.as_ref().map_or(f64::NAN, value)
}

fn structure(summary: &Summary, value: fn(&StructureResults) -> f64) -> f64 {
    summary.structure.as_ref().map_or(f64::NAN, value)
}

fn deposit(summary: &Summary, value: fn(&DepositResults) -> f64) -> f64 {
    summary.deposit.as_ref().map_or(f64::NAN, value)
}

/// The front as it enters the window of the velocity field.
fn at_window(summary: &Summary, value: fn(&FrontPassage) -> f64) -> f64 {
    let entered = usize::from(summary.scales.flow_direction_1 < 0.0);
    let x = summary.case.gauges.window_x_m.map(|w| w[entered]);
    summary.front.iter().find(|f| Some(f.x_m) == x).map_or(f64::NAN, value)
}

/// The front just before it touches the barrier.
fn at_barrier(summary: &Summary, value: fn(&FrontPassage) -> f64) -> f64 {
    summary.arriving_front().map_or(f64::NAN, value)
}

fn pressed(b: &BarrierResults) -> [f64; 2] {
    seeded::exchanged(Seed::StudyColumns, [b.static_force_n, b.static_shear_n])
}

fn dissipated(summary: &Summary) -> f64 {
    let e = &summary.energy;
    1.0 - e.kinetic_1 - e.gravitational_1 - if seeded::is(Seed::StudyDissipated) { 0.0 } else { e.elastic_1 }
}

macro_rules! quantities {
    ($($name:literal, $title:literal, $of:expr;)*) => {
        &[$(Quantity { name: $name, title: $title, of: $of }),*]
    };
}

/// All of them, in the order of the table.
pub const QUANTITIES: &[Quantity] = quantities![
    "static_force_n", "static force (N)", |s| barrier(s, |b| pressed(b)[0]);
    "static_shear_n", "static shear on the face (N)", |s| barrier(s, |b| pressed(b)[1]);
    "static_moment_n_m", "static overturning moment (N m)", |s| barrier(s, |b| b.static_moment_n_m);
    "static_layer1_n", "static force from one layer's stress (N)", |s| barrier(s, |b| b.static_layer1_n);
    "static_layer2_n", "static force from two layers' stress (N)", |s| barrier(s, |b| b.static_layer2_n);
    "static_layer3_n", "static force from three layers' stress (N)", |s| barrier(s, |b| b.static_layer3_n);
    "peak_20ms_n", "largest force over 20 ms (N)", |s| barrier(s, |b| b.peak_20ms_n);
    "peak_20ms_time_s", "its time (s)", |s| barrier(s, |b| b.peak_20ms_time_s);
    "peak_step_n", "largest force of a step (N)", |s| barrier(s, |b| b.peak_step_n);
    "peak_moment_n_m", "largest overturning moment of a step (N m)", |s| barrier(s, |b| b.peak_moment_n_m);
    "impulse_half_second_n_s", "impulse in 0.5 s after arrival (N s)", |s| barrier(s, |b| b.impulse_half_second_n_s);
    "run_up_m", "run-up (m)", |s| barrier(s, |b| b.run_up_m);
    "overtopped_kg", "mass over the barrier (kg)", |s| barrier(s, |b| b.overtopped_kg);
    "arrival_s", "arrival (s)", |s| barrier(s, |b| b.arrival_s.unwrap_or(f64::NAN));
    "time_to_static_s", "time to the static force (s)", |s| barrier(s, |b| b.time_to_static_s);
    "front_velocity_m_per_s", "front velocity at the window (m/s)", |s| at_window(s, |f| f.velocity_m_per_s);
    "front_depth_m", "flow depth at the window (m)", |s| at_window(s, |f| f.depth_m);
    "froude_1", "Froude number at the window", |s| at_window(s, |f| f.froude_1);
    "barrier_velocity_m_per_s", "front velocity at the barrier (m/s)", |s| at_barrier(s, |f| f.velocity_m_per_s);
    "barrier_depth_m", "flow depth at the barrier (m)", |s| at_barrier(s, |f| f.depth_m);
    "weight_along_n", "weight along the flume (N)", |s| deposit(s, |d| d.weight_along_n);
    "friction_limit_n", "largest base friction (N)", |s| deposit(s, |d| d.friction_limit_n);
    "mobilised_1", "mobilised share of the base friction", |s| deposit(s, |d| d.mobilised_1);
    "dissipated_1", "share of E0 dissipated", dissipated;
    "plastic_1", "share of E0 dissipated plastically", |s| s.energy.plastic_1;
    "friction_1", "share of E0 dissipated by boundary friction", |s| s.energy.friction_1;
    "impact_1", "share of E0 lost in normal impact", |s| s.energy.impact_1;
    "pic_1", "share of E0 lost to PIC", |s| s.energy.pic_1;
    "kinetic_max_1", "largest kinetic share of E0", |s| s.energy.kinetic_max_1;
    "energy_residual_1", "share of E0 not accounted for, largest", |s| s.energy.energy_residual_1;
    "momentum_closure_1", "momentum not accounted for", |s| s.momentum.momentum_closure_1;
    "penetration_m", "deepest penetration (m)", |s| s.momentum.penetration_m;
    "end_s", "end of the run (s)", |s| s.stepping.end_s;
    "peak_50hz_n", "largest force of samples every 20 ms (N)", |s| structure(s, |b| b.peak_50hz_n);
    "peak_clamp_n", "largest force on the clamp in a step (N)", |s| structure(s, |b| b.peak_clamp_n);
    "static_clamp_n", "static force on the clamp (N)", |s| structure(s, |b| b.static_clamp_n);
    "static_clamp_moment_n_m", "static moment on the clamp (N m)", |s| structure(s, |b| b.static_clamp_moment_n_m);
    "tip_final_m", "final deflection of the tip (m)", |s| structure(s, |b| b.tip_final_m);
    "tip_max_m", "largest deflection of the tip (m)", |s| structure(s, |b| b.tip_max_m);
    "peak_deflection_m", "largest deflection at the peak (m)", |s| structure(s, |b| b.peak_deflection_m);
    "peak_deflection_height_m", "its height (m)", |s| structure(s, |b| b.peak_deflection_height_m);
    "peak_barrier_velocity_m_per_s", "velocity of the barrier at the peak (m/s)", |s| structure(s, |b| b.peak_barrier_velocity_m_per_s);
    "imbalance_1", "contact less clamp and inertia, over their sum", |s| structure(s, |b| b.imbalance_1);
    "gap_cells", "widest gap in the barrier (cells)", |s| structure(s, |b| b.gap_cells);
    "arrival_kinetic_1", "kinetic share of E0 at the arrival", |s| structure(s, |b| b.arrival_kinetic_1);
    "arrival_dissipated_1", "share of E0 dissipated before the arrival", |s| structure(s, |b| b.arrival_dissipated_1);
];

/// All quantities of a run.
pub fn measure(summary: &Summary) -> Vec<f64> {
    QUANTITIES.iter().map(|q| (q.of)(summary)).collect()
}

/// Index of a quantity.
pub fn index(name: &str) -> Option<usize> {
    QUANTITIES.iter().position(|q| q.name == name)
}

#[cfg(test)]
#[path = "quantities_tests.rs"]
mod tests;
