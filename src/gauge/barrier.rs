//! Force on a barrier from the impulses that it gave to the grid nodes: on a rigid boundary, or on a body in contact.

use super::peak::Peak;
use super::running::RunningMean;
use crate::boundary::Boundary;
use crate::seeded::{self, Seed};
use crate::simulation::{ContactPoint, Simulation};

/// Length of the mean whose largest value is kept, s: the paper's archive interval.
const PEAK_WINDOW: f64 = 0.02;

/// Mean forces over a sampling interval, on the boundary.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ForceSample {
    /// Force against the face, N; positive when the material pushes. For a wall that is its base shear.
    pub normal: f64,
    /// Force along the face towards the crest, N; negative when the material drags the wall down.
    pub tangential: f64,
    /// Overturning moment about the foot, N m; positive when the material pushes the wall over.
    pub moment: f64,
    /// Largest normal force of a single step in the interval, N.
    pub normal_max: f64,
    /// Length of the interval, s.
    pub duration: f64,
}

/// What a gauge sits on.
#[derive(Debug, Clone)]
enum Source {
    /// A boundary, by index.
    Boundary(usize),
    /// A body, by index, with its face at the start.
    Body(usize, Box<Boundary>),
}

/// Accumulates, step by step, what a barrier receives.
#[derive(Debug, Clone)]
pub struct BarrierGauge {
    source: Source,
    /// -1 where a positive rotation is counter-clockwise but overturning is clockwise.
    turn: f64,
    impulse: [f64; 2],
    moment: f64,
    duration: f64,
    largest: f64,
    peak_force: Peak,
    peak_moment: Peak,
    running: RunningMean,
    total_impulse: [f64; 2],
    bin_height: f64,
    profile: Vec<f64>,
    profile_duration: f64,
}

impl BarrierGauge {
    /// A gauge on a boundary, with pressure bins one cell high.
    pub fn new(simulation: &Simulation, boundary: usize) -> Self {
        Self::on(simulation, Source::Boundary(boundary))
    }

    /// The same without a profile of the pressure, for those who never ask for it.
    pub fn without_profile(self) -> Self {
        Self { profile: Vec::new(), ..self }
    }

    /// A gauge on a body in contact: on what its contacts give to it, in the directions and about the foot of `face`, which says
    /// where its face stands at the start.
    pub fn on_body(simulation: &Simulation, body: usize, face: Boundary) -> Self {
        Self::on(simulation, Source::Body(body, Box::new(face)))
    }

    fn on(simulation: &Simulation, source: Source) -> Self {
        let b = source.face(simulation);
        let bin_height = simulation.spacing();
        let bins = if b.height().is_finite() { (b.height() / bin_height - NEAR).ceil() as usize + 1 } else { 0 };
        // The wall turns over when its crest moves away from the material, against the normal.
        let turn = (b.tangent.x * -b.normal.y - b.tangent.y * -b.normal.x).signum();
        Self {
            source,
            turn,
            impulse: [0.0; 2],
            moment: 0.0,
            duration: 0.0,
            largest: 0.0,
            peak_force: Peak::default(),
            peak_moment: Peak::default(),
            running: RunningMean::new(PEAK_WINDOW),
            total_impulse: [0.0; 2],
            bin_height,
            profile: vec![0.0; bins],
            profile_duration: 0.0,
        }
    }

    /// Reads the last step.
    pub fn after_step(&mut self, simulation: &Simulation) {
        let dt = simulation.time_step().dt;
        let b = self.source.face(simulation);
        let ([px, py], moment) = self.source.impulse(simulation);
        let normal = seeded::times(Seed::GaugeNormal, -(px * b.normal.x + py * b.normal.y));
        let tangential = seeded::times(Seed::GaugeShear, px * b.tangent.x + py * b.tangent.y);
        let moment = moment * self.turn;
        self.impulse[0] += normal;
        self.impulse[1] += tangential;
        self.total_impulse[0] += normal;
        self.total_impulse[1] += tangential;
        self.moment += moment;
        self.duration += dt;
        self.largest = self.largest.max(normal / dt);
        if normal / dt > self.peak_force.value {
            self.peak_force = Peak { value: seeded::times(Seed::GaugePeak, normal / dt), time: simulation.time() };
        }
        if moment / dt > self.peak_moment.value {
            self.peak_moment = Peak { value: moment / dt, time: simulation.time() };
        }
        self.running.add(normal, dt, simulation.time());
        self.profile_duration += dt;
        if !self.profile.is_empty() && (normal != 0.0 || tangential != 0.0) {
            let (profile, height) = (&mut self.profile, self.bin_height);
            let mut add = |along: f64, p: [f64; 2]| {
                // Most nodes of a wall touch nothing.
                if p == [0.0; 2] {
                    return;
                }
                let normal = p[0] * b.normal.x + p[1] * b.normal.y;
                for (bin, share) in shares(along / height, profile.len()) {
                    profile[bin] += share * normal;
                }
            };
            match &self.source {
                Source::Boundary(boundary) => {
                    let own = simulation.holds().filter(|h| h.boundary as usize == *boundary);
                    own.for_each(|hold| add(hold.along, hold.vector_impulse()));
                    let crossed = simulation.sites().iter().filter(|s| s.boundary as usize == *boundary);
                    crossed.for_each(|site| add(site.along, site.vector_impulse()));
                }
                Source::Body(body, face) => {
                    let own = simulation.contact_points().iter();
                    own.filter_map(|p| Some((p, on_body(simulation, p.contact, *body)?))).for_each(|(p, sign)| {
                        let ContactPoint { x, impulse, .. } = *p;
                        add(face.face_coordinates(x).1, impulse.map(|i| -sign * i));
                    });
                }
            }
        }
    }

    /// Means since the last call.
    pub fn sample(&mut self) -> ForceSample {
        let per = if self.duration > 0.0 { 1.0 / self.duration } else { 0.0 };
        let sample = ForceSample {
            normal: self.impulse[0] * per,
            tangential: self.impulse[1] * per,
            moment: self.moment * per,
            normal_max: self.largest,
            duration: self.duration,
        };
        self.impulse = [0.0; 2];
        self.moment = 0.0;
        self.duration = 0.0;
        self.largest = 0.0;
        sample
    }

    /// Mean pressure by height since the last call, as (height above the foot in m, pressure in Pa). A bin reaches half a cell up and
    /// down; at foot and crest only the half that lies on the wall. Force and moment of the profile are those of the normal forces on
    /// the face; what acts below the foot, inside a base, counts at the foot.
    pub fn profile(&mut self, thickness: f64) -> Vec<(f64, f64)> {
        let last = self.profile.len().saturating_sub(1);
        let per = if self.profile_duration > 0.0 { 1.0 / (self.profile_duration * thickness) } else { 0.0 };
        let rows = self
            .profile
            .iter()
            .enumerate()
            .map(|(k, impulse)| {
                let height = if (k == 0 || k == last) && !seeded::is(Seed::GaugeProfile) {
                    0.5 * self.bin_height
                } else {
                    self.bin_height
                };
                (k as f64 * self.bin_height, impulse * per / height)
            })
            .collect();
        self.profile.fill(0.0);
        self.profile_duration = 0.0;
        rows
    }

    /// Largest normal force of a single step, N, and when.
    pub fn peak_force(&self) -> Peak {
        self.peak_force
    }

    /// Largest mean normal force over 20 ms, N, and the middle of that time.
    pub fn peak_mean(&self) -> Peak {
        self.running.peak()
    }

    /// Largest overturning moment of a single step, N m, and when.
    pub fn peak_moment(&self) -> Peak {
        self.peak_moment
    }

    /// Impulse on the boundary since the start, normal and tangential, N s.
    pub fn total_impulse(&self) -> [f64; 2] {
        self.total_impulse
    }

    /// Index of the boundary; `None` for a body.
    pub fn boundary(&self) -> Option<usize> {
        match self.source {
            Source::Boundary(boundary) => Some(boundary),
            Source::Body(..) => None,
        }
    }

    /// The face on which force and moment are measured; of a body, as it stood at the start.
    pub fn face<'a>(&'a self, simulation: &'a Simulation) -> &'a Boundary {
        self.source.face(simulation)
    }

    /// Normal force in the last step, N.
    pub fn step_force(&self, simulation: &Simulation) -> f64 {
        let (p, b) = (self.source.impulse(simulation).0, self.face(simulation));
        -(p[0] * b.normal.x + p[1] * b.normal.y) / simulation.time_step().dt
    }
}

/// Heights that differ by less than this share of a bin are the same.
const NEAR: f64 = 1e-6;

/// The two of `bins` bins beside a height (in bins), with their shares of what acts there: linear between them, so that force and
/// moment about the foot are kept. What acts below the first, where a wall goes on inside its base, or above the last counts there.
fn shares(height: f64, bins: usize) -> impl Iterator<Item = (usize, f64)> {
    let height = height.clamp(0.0, bins.saturating_sub(1) as f64);
    let (whole, low) = (height.round(), height.floor());
    let near = (height - whole).abs() < NEAR;
    let [first, second] =
        if near { [(whole, 1.0), (whole, 0.0)] } else { [(low, low + 1.0 - height), (low + 1.0, height - low)] };
    [first, second]
        .into_iter()
        .filter(move |(_, share)| bins > 0 && *share > 0.0)
        .map(|(bin, share)| (bin as usize, share))
}

/// 1 if what contact number `contact` gives is given to `body`, -1 if it is taken from it, `None` if the body is not in it.
fn on_body(simulation: &Simulation, contact: usize, body: usize) -> Option<f64> {
    let rule = simulation.contacts().nth(contact)?;
    [-1.0, 1.0].into_iter().zip(rule.bodies).find_map(|(sign, b)| (b == body).then_some(sign))
}

/// What all contacts of a body gave to it in the last step: impulse (N s), and its moment about the origin (N m s).
pub fn contact_impulse(simulation: &Simulation, body: usize) -> ([f64; 2], f64) {
    let (mut impulse, mut moment) = ([0.0; 2], 0.0);
    for (contact, tally) in simulation.contact_tallies().enumerate() {
        let Some(sign) = on_body(simulation, contact, body) else { continue };
        let sign = seeded::times(Seed::GaugeBody, sign);
        impulse[0] += sign * tally.exchange.impulse[0];
        impulse[1] += sign * tally.exchange.impulse[1];
        moment += sign * tally.moment;
    }
    (impulse, moment)
}

impl Source {
    fn face<'a>(&'a self, simulation: &'a Simulation) -> &'a Boundary {
        match self {
            Source::Boundary(boundary) => &simulation.boundaries()[*boundary],
            Source::Body(_, face) => face,
        }
    }

    /// Impulse on the barrier in the last step (N s), and its moment about the foot, counter-clockwise (N m s).
    fn impulse(&self, simulation: &Simulation) -> ([f64; 2], f64) {
        match self {
            Source::Boundary(boundary) => {
                let tally = &simulation.step_tallies()[*boundary];
                let wrong = seeded::is(Seed::GaugeArm);
                (tally.impulse.map(|p| -p), if wrong { tally.impulse[0] - tally.moment } else { -tally.moment })
            }
            Source::Body(body, face) => {
                let (p, about_origin) = contact_impulse(simulation, *body);
                let foot = face.foot();
                let below = if seeded::is(Seed::GaugeBodyArm) { 1.0 } else { 0.0 };
                (p, about_origin - (foot.x * p[1] - (foot.y - below) * p[0]))
            }
        }
    }
}

#[cfg(test)]
#[path = "barrier_tests.rs"]
mod tests;
