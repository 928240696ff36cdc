//! What a run says of the force on a barrier.

use super::means::{arrival, impulse, late_mean, smoothed_peak, time_to_static};
use super::note::Kind;
use super::passage::FrontPassage;
use super::records::HistoryRow;
use super::scales::Scales;
use crate::gauge::BarrierGauge;
use crate::seeded::{self, Seed};
use serde::Serialize;

/// Time after arrival over which the impulse of the impact is taken, s.
const IMPACT_WINDOW: f64 = 0.5;
/// Share of the elastic impact from which the peak is said to be one, where it is also so many times the static force: what heaps up slowly
/// is no impact.
const ELASTIC: f64 = 0.5;
const OVER_STATIC: f64 = 1.5;

/// Forces on the barrier.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct BarrierResults {
    /// First time at which the normal force exceeds `arrival_force_n` of `[scales]`, s; absent if the flow did not arrive.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub arrival_s: Option<f64>,
    /// Largest normal force of a single step, N.
    pub peak_step_n: f64,
    /// Its time, s.
    pub peak_step_time_s: f64,
    /// Largest mean normal force over 20 ms, N: over the 20 or 21 rows of `resolution_s` that end within 20 ms, each with the same weight.
    /// Studies have recorded this one. It may lie a percent or two below `peak_20ms_by_steps_n`.
    pub peak_20ms_n: f64,
    /// Middle of that interval, s.
    pub peak_20ms_time_s: f64,
    /// Largest mean normal force over 20 ms, N, over exactly that time and from steps: a window ends with a step.
    pub peak_20ms_by_steps_n: f64,
    /// That force over rho v^2 h b, with density, velocity, depth and width of the front just before it arrived: the coefficient of
    /// dynamic pressure; absent if no front was seen.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub peak_20ms_alpha_1: Option<f64>,
    /// rho c v h b with the fastest P-wave c of the flow: the force of an elastic body of that section which is stopped at once (Joukowsky
    /// 1900). A peak of this size is one of `young_pa`, and not of the flow; absent if no front was seen.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elastic_impact_n: Option<f64>,
    /// Mean normal force over the last 0.3 s, N.
    pub static_force_n: f64,
    /// Mean force along the barrier's face over the last 0.3 s, N; negative when the material drags it down.
    pub static_shear_n: f64,
    /// Change of the normal force from the first to the last third of these 0.3 s, N.
    pub static_force_drift_n: f64,
    /// The same force from the stress of the nearest layer of material points, N.
    pub static_layer1_n: f64,
    /// The same force from the stress of the nearest two layers, N.
    pub static_layer2_n: f64,
    /// The same force from the stress of the nearest three layers, N.
    pub static_layer3_n: f64,
    /// Base shear at the foot: the static normal force, N.
    pub base_shear_n: f64,
    /// Mean overturning moment about the foot over the last 0.3 s, N m.
    pub static_moment_n_m: f64,
    /// Height above the foot at which the static force acts, m.
    pub static_height_of_action_m: f64,
    /// Largest overturning moment of a single step, N m.
    pub peak_moment_n_m: f64,
    /// When the mean over 20 ms comes within 5 % of the static force to stay there, s after release.
    pub time_to_static_s: f64,
    /// Impulse of the normal force in the first 0.5 s after arrival, N s.
    pub impulse_half_second_n_s: f64,
    /// Impulse of the normal force, N s.
    pub impulse_normal_n_s: f64,
    /// Impulse of the force along the face, N s.
    pub impulse_tangential_n_s: f64,
    /// Highest single point at the barrier at any time, m above its foot.
    pub run_up_m: f64,
    /// Largest 95th percentile at any time of the heights of the points at the barrier, where there are twenty or more, m above its foot.
    pub run_up_p95_m: f64,
    /// Mass that went over the barrier's crest, or at most half a cell below it, kg; of a barrier that is a body, all that passed.
    pub overtopped_kg: f64,
    /// Mass that went under the barrier, or at most half a cell above its lower edge, kg.
    pub passed_under_kg: f64,
    /// All mass that passed the barrier, kg; what it is more than the other two went through it.
    pub passed_kg: f64,
}

/// Of the history of a barrier, `None` without a sample.
pub(super) fn results(gauge: &BarrierGauge, history: &[HistoryRow], scales: &Scales) -> Option<BarrierResults> {
    let last = history.last()?;
    let late = |value: fn(&HistoryRow) -> f64| late_mean(history, 0.0, 1.0, value);
    let static_force = late(|r| r.normal);
    let static_moment = seeded::times(Seed::RunMoment, late(|r| r.moment));
    let thirds = [late_mean(history, 2.0 / 3.0, 1.0, |r| r.normal), late_mean(history, 0.0, 1.0 / 3.0, |r| r.normal)];
    let [last_third, first_third] = seeded::exchanged(Seed::RunDrift, thirds);
    let [layer1, layer3] = seeded::exchanged(Seed::RunLayers, [late(|r| r.layers[0]), late(|r| r.layers[2])]);
    let [along_normal, along_face] = seeded::exchanged(Seed::RunImpulses, gauge.total_impulse());
    let [over, under] = seeded::exchanged(Seed::RunOvertopped, [last.passage.over, last.passage.under]);
    let peak = smoothed_peak(history);
    let arrival = arrival(history, scales.arrival_force_n);
    Some(BarrierResults {
        arrival_s: arrival,
        peak_step_n: gauge.peak_force().value,
        peak_step_time_s: gauge.peak_force().time,
        peak_20ms_n: peak.0,
        peak_20ms_time_s: peak.1,
        peak_20ms_by_steps_n: gauge.peak_mean().value,
        peak_20ms_alpha_1: None,
        elastic_impact_n: None,
        static_force_n: static_force,
        static_shear_n: seeded::times(Seed::RunShear, late(|r| r.tangential)),
        static_force_drift_n: last_third - first_third,
        static_layer1_n: layer1,
        static_layer2_n: late(|r| r.layers[1]),
        static_layer3_n: layer3,
        base_shear_n: static_force,
        static_moment_n_m: static_moment,
        static_height_of_action_m: if static_force > 0.0 {
            seeded::times(Seed::RunAction, static_moment / static_force)
        } else {
            0.0
        },
        peak_moment_n_m: seeded::times(Seed::RunPeakMoment, gauge.peak_moment().value),
        time_to_static_s: time_to_static(history, static_force),
        impulse_half_second_n_s: arrival.map_or(0.0, |t| impulse(history, t, t + IMPACT_WINDOW)),
        impulse_normal_n_s: along_normal,
        impulse_tangential_n_s: along_face,
        run_up_m: seeded::times(Seed::RunRunUp, history.iter().map(|r| r.run_up).fold(0.0, f64::max)),
        run_up_p95_m: history.iter().map(|r| r.run_up_p95).fold(0.0, f64::max),
        overtopped_kg: over,
        passed_under_kg: under,
        passed_kg: last.passage.past,
    })
}

impl BarrierResults {
    /// Holds the peak against the front that arrived, on a flow `width` (m) wide.
    pub(super) fn compare(&mut self, front: &FrontPassage, scales: &Scales, width: f64) {
        let (v, area) = (front.velocity_m_per_s, front.depth_m * width);
        let per_speed = scales.flow_density_kg_per_m3 * v * area;
        if v > 0.0 && area > 0.0 {
            let alpha = self.peak_20ms_by_steps_n / (per_speed * v);
            self.peak_20ms_alpha_1 = Some(seeded::times(Seed::RunAlpha, alpha));
            self.elastic_impact_n = Some(seeded::times(Seed::RunElastic, per_speed * scales.flow_wave_speed_m_per_s));
        }
    }

    /// Notes what is odd about the barrier called `name`; less than `little` (kg) that went through it is little.
    pub(super) fn note(&self, name: &str, little: f64, note: &mut impl FnMut(Kind, String)) {
        let through = self.passed_kg - self.overtopped_kg - self.passed_under_kg;
        if through > 1e-9 * self.passed_kg {
            let kind = if through > little { Kind::Through } else { Kind::Passed };
            let text = format!(
                "{through:.4} kg went through {name}, between its foot and its crest: it does not hold the flow, and its force is too low"
            );
            note(kind, text);
        }
        if self.overtopped_kg > 0.0 {
            note(Kind::Passed, format!("{:.4} kg went over {name}", self.overtopped_kg));
        }
        if self.passed_under_kg > 0.0 {
            note(Kind::Passed, format!("{:.4} kg went under {name}", self.passed_under_kg));
        }
        let peak = self.peak_20ms_by_steps_n;
        let strikes = peak >= OVER_STATIC * self.static_force_n;
        if let Some(elastic) = self.elastic_impact_n.filter(|elastic| strikes && peak >= ELASTIC * elastic) {
            let text = format!(
                "the peak on {name} is that of an elastic body: {peak:.4e} N over 20 ms beside rho c v h b = {elastic:.4e} N, which grows with \
                 the root of young_pa; without another young_pa to compare with it says little of the flow"
            );
            note(Kind::Elastic, text);
        }
        if self.arrival_s.is_none() {
            note(Kind::NotReached, format!("the flow did not reach {name}"));
        }
    }
}
