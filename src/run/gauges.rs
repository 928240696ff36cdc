//! The gauges of a case, as lists: barriers, bases, stations, windows.

use super::records::{HistoryRow, Recorder};
use super::scales::Scales;
use super::scene;
use crate::case::{Case, file_name};
use crate::gauge::structure::ProfilePoint;
use crate::gauge::{
    BarrierGauge, BaseGauge, ForceSample, FrontGauge, Passage, PassageGauge, StationGauge, StructureGauge,
    StructureSample, WindowGauge, layers, penetration, wall_state,
};
use crate::output::OutputError;
use crate::simulation::Simulation;

/// A barrier: the force on it, and, if it is a body, how it takes that.
#[derive(Debug, Clone)]
pub struct Barrier {
    name: String,
    force: BarrierGauge,
    structure: Option<StructureGauge>,
    /// Bodies that are barriers, by index: none of them flows.
    structures: Vec<usize>,
    passage: Option<PassageGauge>,
    peak: PeakProfile,
}

/// What is read at a barrier.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BarrierSample {
    /// Means over the interval.
    pub force: ForceSample,
    /// Normal force from the stress of the nearest 1, 2, 3 layers of material points, N.
    pub layers: [f64; 3],
    /// Highest material beside it, m above its foot.
    pub run_up: f64,
    /// 95th percentile of the heights of the points beside it, m above its foot.
    pub run_up_p95: f64,
    /// What has passed it since the release.
    pub passage: Passage,
    /// How it takes it, if it is a body.
    pub structure: Option<StructureSample>,
}

/// How a barrier was bent at its largest force.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PeakProfile {
    /// Mean normal force of the sample, N.
    pub force: f64,
    /// End of the sample, s.
    pub time: f64,
    /// The points of its face.
    pub points: Vec<ProfilePoint>,
}

impl Barrier {
    /// A gauge on the boundary or the body of this name; `None` if there is neither.
    fn new(case: &Case, simulation: &Simulation, name: &str, structures: &[usize]) -> Option<Self> {
        let mut structure = structure(case, simulation, name);
        if let Some(structure) = &mut structure {
            structure.leave_out(simulation, structures);
        }
        let force = match &structure {
            Some(s) => BarrierGauge::on_body(simulation, s.body(), s.face().clone()),
            None => BarrierGauge::new(simulation, simulation.boundary_index(name)?),
        };
        // Profiles are read at the frames.
        let force = if case.output.vtk_interval_s > 0.0 { force } else { force.without_profile() };
        let passage = force.boundary().map(|b| PassageGauge::new(simulation, b, structures));
        let structures = structures.to_vec();
        Some(Self { name: name.into(), force, structure, structures, passage, peak: PeakProfile::default() })
    }

    /// Its name in the case.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The gauge of the force on it.
    pub fn force(&self) -> &BarrierGauge {
        &self.force
    }

    /// The gauge of how it takes that, if it is a body.
    pub fn structure(&self) -> Option<&StructureGauge> {
        self.structure.as_ref()
    }

    /// How it was bent, if it is a body, when the mean force of a sample was largest.
    pub fn peak_profile(&self) -> &PeakProfile {
        &self.peak
    }

    /// Forgets what it has seen of a body while the material settled.
    fn open(&mut self, simulation: &Simulation) {
        if let Some(structure) = &mut self.structure {
            structure.open(simulation);
        }
        if let Some(passage) = &mut self.passage {
            passage.open(simulation);
        }
    }

    /// Reads the last step.
    fn after_step(&mut self, simulation: &Simulation) {
        self.force.after_step(simulation);
        if let Some(structure) = &mut self.structure {
            structure.after_step(simulation);
        }
        if let Some(passage) = &mut self.passage {
            passage.after_step(simulation);
        }
    }

    /// Means since the last call, and the state now.
    pub(super) fn sample(&mut self, simulation: &Simulation) -> BarrierSample {
        let force = self.force.sample();
        let mut sample = BarrierSample { force, ..BarrierSample::default() };
        if let Some(boundary) = self.force.boundary() {
            sample.layers = layers::normal_force(simulation, boundary);
            let state = wall_state(simulation, boundary, &self.structures);
            (sample.run_up, sample.run_up_p95) = (state.run_up, state.run_up_p95);
        }
        if let Some(passage) = &self.passage {
            sample.passage = passage.sample(simulation);
        }
        if let Some(structure) = &mut self.structure {
            let s = structure.sample(simulation);
            (sample.layers, sample.run_up) = (s.survey.layers, s.survey.run_up);
            sample.run_up_p95 = s.survey.run_up_p95;
            sample.passage = structure.passage(&s.survey);
            sample.structure = Some(s);
            if force.normal > self.peak.force {
                self.peak = PeakProfile { force: force.normal, time: simulation.time(), points: structure.profile() };
            }
        }
        sample
    }

    /// Mass that is behind it now, kg.
    pub(super) fn behind(&self, simulation: &Simulation) -> f64 {
        match (&self.structure, self.force.boundary()) {
            (Some(structure), _) => structure.behind(simulation),
            (_, Some(boundary)) => wall_state(simulation, boundary, &self.structures).behind,
            _ => 0.0,
        }
    }

    /// Mean pressure on it since the last call: (height above the foot in m, pressure in Pa).
    pub(super) fn pressure(&mut self, simulation: &Simulation) -> Vec<(f64, f64)> {
        self.force.profile(simulation.thickness())
    }
}

impl BarrierSample {
    /// What of it goes into a row of samples.
    pub(super) fn write(&self, row: &mut HistoryRow) {
        row.normal = self.force.normal;
        row.tangential = self.force.tangential;
        row.moment = self.force.moment;
        row.normal_max = self.force.normal_max;
        row.layers = self.layers;
        row.run_up = self.run_up;
        row.run_up_p95 = self.run_up_p95;
        row.passage = self.passage;
    }
}

/// A gauge with its name in the case.
#[derive(Debug, Clone)]
pub(super) struct Named<G> {
    /// The name.
    pub name: String,
    /// The gauge.
    pub gauge: G,
}

/// The gauges of a case.
#[derive(Debug, Clone)]
pub(super) struct Gauges {
    /// What the flow is measured by.
    pub scales: Scales,
    /// Barriers, the first of which is what is meant by the barrier.
    pub barriers: Vec<Barrier>,
    /// Indices of those that are bodies: what is said of the flow leaves them out.
    pub structures: Vec<usize>,
    /// Bases, the first of which is what is meant by the base.
    pub bases: Vec<Named<BaseGauge>>,
    /// Where depth and velocity are read.
    stations: Vec<StationGauge>,
    /// Where speeds are read that stand in the history.
    window: Option<WindowGauge>,
    /// Where others are read.
    pub windows: Vec<Named<WindowGauge>>,
    front: FrontGauge,
}

impl Gauges {
    /// Those of a case that has passed validation.
    pub fn new(case: &Case, simulation: &Simulation) -> Self {
        let gauges = &case.gauges;
        let structures: Vec<usize> =
            gauges.barrier_names().filter_map(|name| Some(structure(case, simulation, name)?.body())).collect();
        let barriers: Vec<_> =
            gauges.barrier_names().filter_map(|name| Barrier::new(case, simulation, name, &structures)).collect();
        let face = barriers.first().map(|b| b.force.face(simulation));
        let scales = Scales::new(case, simulation, &structures, face);
        let base = |name: &str| {
            let boundary = simulation.boundary_index(name)?;
            let gauge = BaseGauge::new(boundary, scales.along(&simulation.boundaries()[boundary]));
            Some(Named { name: name.into(), gauge })
        };
        let bases = gauges.base_names().filter_map(base).collect();
        let window = gauges.window_x_m.zip(gauges.window_y_m);
        let windows =
            gauges.windows.iter().map(|w| Named { name: w.name.clone(), gauge: WindowGauge::new(w.x_m, w.y_m) });
        Self {
            scales,
            structures,
            barriers,
            bases,
            stations: gauges.stations_m.iter().copied().map(StationGauge::new).collect(),
            window: window.map(|(x, y)| WindowGauge::new(x, y)),
            windows: windows.collect(),
            front: FrontGauge::new(scales.flow_direction_1, scales.front_length_m),
        }
    }

    /// The clock starts now.
    pub fn open(&mut self, simulation: &Simulation) {
        self.barriers.iter_mut().for_each(|b| b.open(simulation));
    }

    /// Reads the last step.
    pub fn after_step(&mut self, simulation: &Simulation) {
        self.barriers.iter_mut().for_each(|b| b.after_step(simulation));
        self.bases.iter_mut().for_each(|b| b.gauge.after_step(simulation));
    }

    /// Reads the gauges: means since the last call, and the state now. The row has what is read of the flow, at the first barrier and at
    /// the first base; what has tables of its own goes to the recorder.
    pub fn sample(&mut self, simulation: &Simulation, recorder: &mut dyn Recorder) -> Result<HistoryRow, OutputError> {
        let mut row = HistoryRow {
            time: simulation.time(),
            time_step: simulation.time_step().dt,
            front: self.front.sample(simulation, &self.structures),
            window: self.window.as_mut().map(|w| w.sample(simulation, &self.structures)).unwrap_or_default(),
            penetration: penetration::of_boundaries(simulation).0,
            entered: simulation.ledger().entered_mass,
            ..HistoryRow::default()
        };
        let own = HistoryRow { time: row.time, ..HistoryRow::default() };
        for (k, base) in self.bases.iter_mut().enumerate() {
            let base = base.gauge.sample();
            match k.checked_sub(1) {
                None => row.base = base,
                Some(further) => recorder.further_base(further, &HistoryRow { base, ..own })?,
            }
        }
        for (k, window) in self.windows.iter_mut().enumerate() {
            let window = window.gauge.sample(simulation, &self.structures);
            recorder.window(k, &HistoryRow { window, ..own })?;
        }
        for (k, barrier) in self.barriers.iter_mut().enumerate() {
            let sample = barrier.sample(simulation);
            if let Some(s) = &sample.structure {
                row.penetration = row.penetration.max(s.survey.penetration);
            }
            if k == 0 {
                sample.write(&mut row);
            }
            let Some(recorder) = of_barrier(recorder, k) else { continue };
            if k > 0 {
                let mut own = own;
                sample.write(&mut own);
                recorder.history(&own)?;
            }
            if let Some(s) = &sample.structure {
                recorder.structure(row.time, s)?;
            }
        }
        Ok(row)
    }

    /// Reads the stations.
    pub fn sample_stations(&self, simulation: &Simulation, recorder: &mut dyn Recorder) -> Result<(), OutputError> {
        let samples = self.stations.iter().map(|s| s.sample(simulation, &self.structures));
        samples.into_iter().try_for_each(|s| recorder.station(simulation.time(), &s))
    }
}

/// Who records what is read at a barrier, by its number.
pub(super) fn of_barrier(recorder: &mut dyn Recorder, barrier: usize) -> Option<&mut dyn Recorder> {
    match barrier.checked_sub(1) {
        None => Some(recorder),
        Some(further) => recorder.further(further),
    }
}

/// The gauge on the body of this name; `None` if a boundary has it.
fn structure(case: &Case, simulation: &Simulation, name: &str) -> Option<StructureGauge> {
    let (body, face) = (scene::index(case, name)?, scene::barrier_face(case, name)?);
    let b = &case.bodies[body];
    let counts = b.particle_counts(&case.grid).map(|n| n as usize);
    let rotation = b.rectangle()?.rotation_deg;
    Some(StructureGauge::new(simulation, body, face, counts, rotation.to_radians()))
}

/// What follows in the names of a barrier's files, by its number: nothing for the first, else its name.
pub(super) fn suffix(barrier: &Barrier, number: usize) -> String {
    if number == 0 { String::new() } else { format!("_{}", file_name(barrier.name())) }
}

#[cfg(test)]
#[path = "gauges_tests.rs"]
mod tests;
