//! What a run says of a barrier that is a body.

use super::gauges::Barrier;
use super::means::{archived_peak, arrival};
use super::note::Kind;
use super::records::{EnergyRow, Records};
use super::scales::Scales;
use crate::gauge::StructureSample;
use crate::ledger::EnergyBalance;
use crate::seeded::{self, Seed};
use serde::Serialize;

/// Length of the means behind "final" values, s.
const FINAL_WINDOW: f64 = 0.3;
/// Gap between neighbouring points, in cells, from which a barrier counts as torn: half their distance at the start
/// with four points a cell, three quarters of it with nine, all of it with sixteen. In cells, because points hold together by the
/// nodes that they share.
pub const TORN: f64 = 0.25;
/// Share of the forces that contact, clamp and inertia may miss each other by.
const BALANCED: f64 = 1e-9;
/// Share of the largest forces on the barrier below which those of a sample are left out of their balance: round-off of its momentum, and
/// more than that, so that what is left out is always next to nothing.
const UNLOADED: f64 = 1e-9;

/// A barrier that is a body: how it bends, what its clamp carries, whether it holds together.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct StructureResults {
    /// Height of the face above the foot, m.
    pub height_m: f64,
    /// Largest of the samples of the contact force that are the first at or after whole multiples of 20 ms, N: what an
    /// archive of that interval shows of the peak.
    pub peak_50hz_n: f64,
    /// Share of the energy at release that was kinetic when the energies were first recorded after the flow arrived, up
    /// to 10 ms later.
    pub arrival_kinetic_1: f64,
    /// Share of the energy at release that was gone by that record.
    pub arrival_dissipated_1: f64,
    /// Largest deflection of the tip away from the material at any time, m.
    pub tip_max_m: f64,
    /// Largest deflection anywhere on the face when the mean force of a sample was largest, m.
    pub peak_deflection_m: f64,
    /// Its height above the foot, m.
    pub peak_deflection_height_m: f64,
    /// Largest velocity away from the material anywhere on the face at that time, m/s.
    pub peak_barrier_velocity_m_per_s: f64,
    /// Mean deflection of the tip over the last 0.3 s, m.
    pub tip_final_m: f64,
    /// The same over the height.
    pub tip_final_1: f64,
    /// Largest force on the clamp in a single step, N.
    pub peak_clamp_n: f64,
    /// Its time, s.
    pub peak_clamp_time_s: f64,
    /// Mean force on the clamp against the face over the last 0.3 s, N.
    pub static_clamp_n: f64,
    /// Mean moment about the foot on the clamp over the last 0.3 s, N m.
    pub static_clamp_moment_n_m: f64,
    /// Largest magnitude, over all samples, of contact force less clamp reaction and rate of momentum, over the sum of
    /// theirs. Samples in which these forces are less than a billionth of the run's largest are left out.
    pub imbalance_1: f64,
    /// Deepest that the domain of a point of the flow lay inside the barrier, m.
    pub penetration_max_m: f64,
    /// Widest gap between neighbouring points of the barrier beyond what its stretch explains, cells.
    pub gap_cells: f64,
    /// When, s.
    pub gap_time_s: f64,
    /// Where, as height above the foot at the start, m.
    pub gap_height_m: f64,
    /// Whether the barrier has torn: a gap of a quarter of a cell or more. What is read after that means nothing.
    pub torn: bool,
}

/// Of a barrier with its own records and the energies of the run; `None` if it is not a body, or without a sample.
pub(super) fn results(
    barrier: &Barrier,
    records: &Records,
    energy: &[EnergyRow],
    scales: &Scales,
) -> Option<StructureResults> {
    let gauge = barrier.structure()?;
    let samples = &records.structure;
    let end = samples.last()?.0;
    let mean = |value: fn(&StructureSample) -> f64| {
        let late = samples.iter().filter(|(time, _)| *time > end - FINAL_WINDOW);
        let (sum, count) = late.fold((0.0, 0.0), |(s, n), (_, r)| (s + value(r), n + 1.0));
        sum / count
    };
    let largest = |value: fn(&StructureSample) -> f64| samples.iter().map(|(_, s)| value(s)).fold(0.0, f64::max);
    let peak = &barrier.peak_profile().points;
    let bent = peak.iter().fold((0.0, 0.0), |a, p| if p.deflection > a.0 { (p.deflection, p.height) } else { a });
    let widest = samples.iter().fold(&samples[0], |a, b| if b.1.bend.gap > a.1.bend.gap { b } else { a });
    let clamp = gauge.peak_clamp_force();
    let tip = seeded::times(Seed::RunTip, mean(|s| s.bend.tip));
    let height = gauge.face().height();
    let arrival = arrival(&records.history, scales.arrival_force_n);
    let arrived = energy.iter().find(|r| arrival.is_some_and(|t| r.time >= t)).map(|r| r.balance.clone());
    let share = |value: fn(&EnergyBalance) -> f64| arrived.as_ref().map_or(f64::NAN, |b| value(b) / b.initial);
    Some(StructureResults {
        height_m: height,
        peak_50hz_n: archived_peak(&records.history),
        arrival_kinetic_1: share(|b| b.kinetic),
        arrival_dissipated_1: share(|b| {
            b.initial - b.kinetic - b.gravitational - if seeded::is(Seed::RunDissipated) { 0.0 } else { b.elastic }
        }),
        tip_max_m: largest(|s| s.bend.tip),
        peak_deflection_m: bent.0,
        peak_deflection_height_m: bent.1,
        peak_barrier_velocity_m_per_s: peak.iter().map(|p| p.velocity).fold(0.0, f64::max),
        tip_final_m: tip,
        tip_final_1: tip / height,
        peak_clamp_n: seeded::times(Seed::RunPeakClamp, clamp.value),
        peak_clamp_time_s: clamp.time,
        static_clamp_n: seeded::times(Seed::RunClamp, mean(|s| s.clamp.normal)),
        static_clamp_moment_n_m: seeded::times(Seed::RunClampMoment, mean(|s| s.clamp_moment)),
        imbalance_1: imbalance(samples),
        penetration_max_m: largest(|s| s.survey.penetration),
        gap_cells: widest.1.bend.gap,
        gap_time_s: widest.0,
        gap_height_m: widest.1.bend.gap_at,
        torn: widest.1.bend.gap >= TORN,
    })
}

/// Largest imbalance of the samples in which forces act.
fn imbalance(samples: &[(f64, StructureSample)]) -> f64 {
    let least = UNLOADED * samples.iter().map(|(_, s)| s.magnitude()).fold(0.0, f64::max);
    let unloaded = |s: &StructureSample| s.magnitude() < least;
    let loaded = samples.iter().filter(|(_, s)| !unloaded(s)).map(|(_, s)| s.imbalance);
    // What is not a number stays.
    loaded.fold(0.0, |a, b| if b > a || b.is_nan() { b } else { a })
}

impl StructureResults {
    /// Notes what is odd about the barrier called `name`.
    pub(super) fn note(&self, name: &str, note: &mut impl FnMut(Kind, String)) {
        if self.torn {
            let text = format!(
                "{name} has torn numerically: {:.3} s after release its points were {:.2} cells too far apart {:.3} m above \
                 its foot; forces and deflections after that mean nothing (finer cells, or a stiffer barrier)",
                self.gap_time_s, self.gap_cells, self.gap_height_m
            );
            note(Kind::Torn, text);
        }
        if self.imbalance_1 > BALANCED {
            let text = format!(
                "contact, clamp and inertia of {name} miss each other by {:.1e} of their sum",
                self.imbalance_1
            );
            note(Kind::Balance, text);
        }
    }
}

/// A barrier about which nothing is odd.
#[cfg(test)]
pub(super) fn for_tests() -> StructureResults {
    StructureResults {
        height_m: 0.5,
        peak_50hz_n: 0.0,
        arrival_kinetic_1: 0.0,
        arrival_dissipated_1: 0.0,
        tip_max_m: 0.0,
        peak_deflection_m: 0.0,
        peak_deflection_height_m: 0.0,
        peak_barrier_velocity_m_per_s: 0.0,
        tip_final_m: 0.0,
        tip_final_1: 0.0,
        peak_clamp_n: 0.0,
        peak_clamp_time_s: 0.0,
        static_clamp_n: 0.0,
        static_clamp_moment_n_m: 0.0,
        imbalance_1: 0.0,
        penetration_max_m: 0.0,
        gap_cells: 0.0,
        gap_time_s: 0.0,
        gap_height_m: 0.0,
        torn: false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_balance_of_forces_is_that_of_samples_with_forces() {
        let sample = |normal: f64, imbalance: f64| {
            let mut s = StructureSample { imbalance, ..StructureSample::default() };
            (s.contact.normal, s.clamp.normal, s.inertia.tangential) = (3.0 * normal, normal, normal);
            (0.0, s)
        };
        assert_eq!(sample(-2.0, 0.0).1.magnitude(), 10.0);
        // A billionth of the largest counts, less does not.
        assert_eq!(imbalance(&[sample(1000.0, 1e-12), sample(1.1e-6, 1e-3), sample(0.9e-6, 1.0)]), 1e-3);
        assert_eq!(imbalance(&[sample(1000.0, 1e-12), sample(0.0, 1.0)]), 1e-12);
        assert!(imbalance(&[sample(1000.0, f64::NAN), sample(1000.0, 1e-12)]).is_nan());
        assert!(imbalance(&[sample(f64::NAN, f64::NAN), sample(1000.0, 1e-12)]).is_nan());
    }
}
