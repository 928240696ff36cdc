//! A simulation that is driven and read from Python.

use crate::failure::run_error;
use crate::run::{checked_threads, dictionary, goes_on, listen, with_threads};
use checkdam::body::Particle;
use checkdam::gauge::velocity_field;
use checkdam::run::{Experiment, Progress};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::{PyKeyError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A case, step by step.
#[pyclass(module = "checkdam._checkdam", unsendable)]
pub struct Simulation {
    experiment: Experiment,
    released: bool,
    /// Whether settling was interrupted or a step failed: what follows would be of a state that nobody asked for.
    broken: bool,
}

impl Simulation {
    pub fn new(case: &checkdam::case::Case) -> Self {
        Self { experiment: Experiment::new(case), released: false, broken: false }
    }

    /// Points of all bodies or of one, in the order of bodies and numbers.
    fn ordered(&self, body: Option<&str>) -> PyResult<Vec<(usize, Particle)>> {
        let sim = self.experiment.simulation();
        let chosen = body.map(|name| {
            let names = || sim.bodies().iter().map(|b| b.name.as_str()).collect::<Vec<_>>().join(", ");
            let found = sim.bodies().iter().position(|b| b.name == name);
            found.ok_or_else(|| PyKeyError::new_err(format!("no body is named `{name}`; there are {}", names())))
        });
        let chosen = chosen.transpose()?;
        let mut points: Vec<_> = sim.particles().filter(|(b, _)| chosen.is_none_or(|k| k == *b)).collect();
        points.sort_by_key(|(body, p)| (*body, p.id));
        Ok(points)
    }
}

/// An array with a row for each value.
fn rows<'py, const N: usize>(
    py: Python<'py>,
    values: impl Iterator<Item = [f64; N]>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let flat: Vec<f64> = values.flatten().collect();
    let count = flat.len() / N;
    PyArray1::from_vec(py, flat).reshape([count, N])
}

fn column<'py>(py: Python<'py>, values: impl Iterator<Item = f64>) -> Bound<'py, PyArray1<f64>> {
    PyArray1::from_iter(py, values)
}

#[pymethods]
impl Simulation {
    /// Settles and tilts, if the case has these stages, then opens gates and inflows and starts the clock.
    #[pyo3(signature = (threads=None, progress=None))]
    fn release(&mut self, py: Python<'_>, threads: Option<i64>, progress: Option<Py<PyAny>>) -> PyResult<()> {
        if self.released {
            return Err(PyRuntimeError::new_err("the simulation has been released already"));
        }
        self.check_whole()?;
        self.broken = true;
        let threads = checked_threads(threads)?;
        let experiment = &mut self.experiment;
        let ended = listen(
            py,
            |line| {
                with_threads(threads, || {
                    let mut stopped = false;
                    let prepared = experiment.prepare(&mut |p: &Progress| {
                        stopped = !line.tell(*p);
                        !stopped
                    });
                    prepared.map(|()| stopped).map_err(|error| error.to_string())
                })
                .and_then(|ended| ended)
            },
            |py, p| progress.as_ref().map_or(Ok(true), |callback| goes_on(callback, py, dictionary(py, p)?)),
        )?;
        if ended.map_err(|error| run_error(py, &format!("error: {error}")))? {
            return Err(run_error(py, "error: settling was stopped; make a new simulation"));
        }
        self.experiment.release();
        (self.released, self.broken) = (true, false);
        Ok(())
    }

    /// Makes steps, with the interpreter's lock released.
    #[pyo3(signature = (count=1))]
    fn step(&mut self, py: Python<'_>, count: u64) -> PyResult<()> {
        self.drive(py, |_, made| made < count)
    }

    /// Steps until a time since the release, s; the last step goes beyond it by less than its length.
    fn advance(&mut self, py: Python<'_>, time_s: f64) -> PyResult<()> {
        if !time_s.is_finite() {
            return Err(PyValueError::new_err(format!("time_s = {time_s}: give a time in seconds")));
        }
        self.drive(py, |time, _| time < time_s)
    }

    #[getter]
    fn time_s(&self) -> f64 {
        self.experiment.simulation().time()
    }

    #[getter]
    fn steps(&self) -> u64 {
        self.experiment.simulation().steps()
    }

    #[getter]
    fn time_step_s(&self) -> f64 {
        self.experiment.simulation().time_step().dt
    }

    #[getter]
    fn bodies(&self) -> Vec<String> {
        self.experiment.simulation().bodies().iter().map(|b| b.name.clone()).collect()
    }

    /// The material points, in the order of bodies and of their numbers.
    #[pyo3(signature = (body=None))]
    fn points<'py>(&self, py: Python<'py>, body: Option<&str>) -> PyResult<Bound<'py, PyDict>> {
        let points = self.ordered(body)?;
        let all = || points.iter().map(|(_, p)| p);
        let found = PyDict::new(py);
        found.set_item("body", PyArray1::from_iter(py, points.iter().map(|(b, _)| *b as i64)))?;
        found.set_item("id", PyArray1::from_iter(py, all().map(|p| i64::from(p.id))))?;
        found.set_item("x_m", rows(py, all().map(|p| p.x))?)?;
        found.set_item("velocity_m_per_s", rows(py, all().map(|p| p.v))?)?;
        let stress = |p: &Particle| [p.state.stress.xx, p.state.stress.yy, p.state.stress.zz, p.state.stress.xy];
        found.set_item("stress_pa", rows(py, all().map(stress))?)?;
        found.set_item("volume_ratio_1", column(py, all().map(|p| p.volume_ratio)))?;
        found.set_item("plastic_shear_strain_1", column(py, all().map(|p| p.state.plastic_shear)))?;
        let bodies = self.experiment.simulation().bodies();
        found.set_item("mass_kg", column(py, points.iter().map(|(b, _)| bodies[*b].point_mass)))?;
        Ok(found)
    }

    /// Means in the cells of the grid that hold what flows.
    fn field<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let cells = velocity_field(self.experiment.simulation(), self.experiment.structures());
        let found = PyDict::new(py);
        found.set_item("x_m", rows(py, cells.iter().map(|c| c.x))?)?;
        found.set_item("velocity_m_per_s", rows(py, cells.iter().map(|c| c.v))?)?;
        found.set_item("fill_1", column(py, cells.iter().map(|c| c.fill)))?;
        found.set_item("pressure_pa", column(py, cells.iter().map(|c| c.pressure)))?;
        found.set_item("plastic_shear_strain_1", column(py, cells.iter().map(|c| c.plastic_shear)))?;
        Ok(found)
    }

    /// Force of each boundary on the material in the last step, N, along x and y.
    fn boundary_forces_n<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let sim = self.experiment.simulation();
        let dt = sim.time_step().dt;
        let found = PyDict::new(py);
        for (boundary, tally) in sim.boundaries().iter().zip(sim.step_tallies()) {
            let force = if dt > 0.0 { tally.impulse.map(|p| p / dt) } else { [0.0; 2] };
            found.set_item(&boundary.name, PyArray1::from_slice(py, &force))?;
        }
        Ok(found)
    }

    /// Normal force on the gauged barrier in the last step, N; None without one.
    #[getter]
    fn barrier_force_n(&self) -> Option<f64> {
        Some(self.experiment.barrier()?.step_force(self.experiment.simulation()))
    }

    /// Largest normal force on the gauged barrier in a step since the release, N, and its time, s.
    #[getter]
    fn barrier_peak(&self) -> Option<(f64, f64)> {
        let peak = self.experiment.barrier()?.peak_force();
        Some((peak.value, peak.time))
    }

    /// The energy ledger now, J.
    fn energy_j<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        if !self.released {
            return Err(PyRuntimeError::new_err("the ledger is opened by release()"));
        }
        let sim = self.experiment.simulation();
        let b = sim.energy_balance(&sim.stock(), self.experiment.datum());
        let found = PyDict::new(py);
        let single = [
            ("kinetic", b.kinetic),
            ("gravitational", b.gravitational),
            ("elastic", b.elastic),
            ("plastic", b.plastic),
            ("friction", b.friction.iter().sum()),
            ("contact", b.contact.iter().sum()),
            ("pic", b.pic),
            ("damping", b.damping),
            ("side_walls", b.side_walls),
            ("outflow", b.outflow),
            ("inflow", b.inflow),
            ("field", b.field),
            ("initial", b.initial),
            ("residual", b.residual),
        ];
        for (name, value) in single {
            found.set_item(name, value)?;
        }
        Ok(found)
    }

    fn __repr__(&self) -> String {
        let sim = self.experiment.simulation();
        format!("<checkdam.Simulation at t = {} s, {} points, {} steps>", sim.time(), sim.particle_count(), sim.steps())
    }
}

/// Steps between looks for Ctrl-C.
const LOOK: u64 = 25;

impl Simulation {
    fn check_whole(&self) -> PyResult<()> {
        let what = "settling was interrupted or a step failed: make a new simulation";
        if self.broken { Err(PyRuntimeError::new_err(what)) } else { Ok(()) }
    }

    /// Steps as long as `goes_on` says so of the time (s) and the steps made.
    fn drive(&mut self, py: Python<'_>, goes_on: impl Fn(f64, u64) -> bool + Send + Sync) -> PyResult<()> {
        if !self.released {
            return Err(PyRuntimeError::new_err("call release() first: it settles the material and opens the gates"));
        }
        self.check_whole()?;
        let experiment = &mut self.experiment;
        let result = listen(
            py,
            |line| {
                // On a thread of the pool, as in a run.
                rayon::scope(|_| {
                    let mut made = 0;
                    while goes_on(experiment.simulation().time(), made) {
                        experiment.step().map_err(|error| error.to_string())?;
                        made += 1;
                        if made.is_multiple_of(LOOK) && !line.tell(()) {
                            break;
                        }
                    }
                    Ok(())
                })
            },
            |_, ()| Ok(true),
        )?;
        self.broken = result.is_err();
        result.map_err(|error: String| run_error(py, &format!("error: {error}")))
    }
}
