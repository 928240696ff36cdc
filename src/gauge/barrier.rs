//! Force on a boundary from the impulses that it gave to the grid nodes.

use crate::simulation::Simulation;

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

/// The largest value of a single step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Peak {
    /// The value.
    pub value: f64,
    /// When, s.
    pub time: f64,
}

/// Accumulates, step by step, what a boundary receives.
#[derive(Debug, Clone)]
pub struct BarrierGauge {
    boundary: usize,
    /// -1 where a positive rotation is counter-clockwise but overturning is clockwise.
    turn: f64,
    impulse: [f64; 2],
    moment: f64,
    duration: f64,
    largest: f64,
    peak_force: Peak,
    peak_moment: Peak,
    total_impulse: [f64; 2],
    bin_height: f64,
    profile: Vec<f64>,
    profile_duration: f64,
}

impl BarrierGauge {
    /// A gauge on a boundary, with pressure bins one cell high.
    pub fn new(simulation: &Simulation, boundary: usize) -> Self {
        let b = &simulation.boundaries()[boundary];
        let bin_height = simulation.spacing();
        let bins = if b.height().is_finite() { (b.height() / bin_height).round() as usize + 1 } else { 0 };
        // The wall turns over when its crest moves away from the material, against the normal.
        let turn = (b.tangent.x * -b.normal.y - b.tangent.y * -b.normal.x).signum();
        Self {
            boundary,
            turn,
            impulse: [0.0; 2],
            moment: 0.0,
            duration: 0.0,
            largest: 0.0,
            peak_force: Peak::default(),
            peak_moment: Peak::default(),
            total_impulse: [0.0; 2],
            bin_height,
            profile: vec![0.0; bins],
            profile_duration: 0.0,
        }
    }

    /// Reads the last step.
    pub fn after_step(&mut self, simulation: &Simulation) {
        let dt = simulation.time_step().dt;
        let b = &simulation.boundaries()[self.boundary];
        let tally = &simulation.step_tallies()[self.boundary];
        let (px, py) = (-tally.impulse[0], -tally.impulse[1]);
        let normal = -(px * b.normal.x + py * b.normal.y);
        let tangential = px * b.tangent.x + py * b.tangent.y;
        let moment = -tally.moment * self.turn;
        self.impulse[0] += normal;
        self.impulse[1] += tangential;
        self.total_impulse[0] += normal;
        self.total_impulse[1] += tangential;
        self.moment += moment;
        self.duration += dt;
        self.largest = self.largest.max(normal / dt);
        if normal / dt > self.peak_force.value {
            self.peak_force = Peak { value: normal / dt, time: simulation.time() };
        }
        if moment / dt > self.peak_moment.value {
            self.peak_moment = Peak { value: moment / dt, time: simulation.time() };
        }
        self.profile_duration += dt;
        if normal != 0.0 || tangential != 0.0 {
            for hold in simulation.holds().filter(|h| h.boundary as usize == self.boundary) {
                let bin = (hold.along / self.bin_height).round();
                let p = hold.vector_impulse();
                if let Some(sum) = self.profile.get_mut(bin.max(0.0) as usize) {
                    *sum += p[0] * b.normal.x + p[1] * b.normal.y;
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

    /// Mean pressure by height since the last call, as (height above the foot in m, pressure in Pa). The bin at a node reaches
    /// half a cell up and down; at foot and crest only the half that lies on the wall.
    pub fn profile(&mut self, thickness: f64) -> Vec<(f64, f64)> {
        let last = self.profile.len().saturating_sub(1);
        let per = if self.profile_duration > 0.0 { 1.0 / (self.profile_duration * thickness) } else { 0.0 };
        let rows = self
            .profile
            .iter()
            .enumerate()
            .map(|(k, impulse)| {
                let height = if k == 0 || k == last { 0.5 * self.bin_height } else { self.bin_height };
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

    /// Largest overturning moment of a single step, N m, and when.
    pub fn peak_moment(&self) -> Peak {
        self.peak_moment
    }

    /// Impulse on the boundary since the start, normal and tangential, N s.
    pub fn total_impulse(&self) -> [f64; 2] {
        self.total_impulse
    }

    /// Index of the boundary.
    pub fn boundary(&self) -> usize {
        self.boundary
    }
}

#[cfg(test)]
#[path = "barrier_tests.rs"]
mod tests;
