//! The stages of a run: how far it is, how it ended, what it was.

use crate::output::OutputError;
use crate::plot::PlotError;
use crate::simulation::StepFailure;
use crate::timestep::TimeStep;

/// A stage of the run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Coming to rest behind the gate.
    Settle,
    /// The flume is being tilted.
    Tilt,
    /// The gate is open.
    Run,
}

impl Stage {
    /// In one word.
    pub fn name(self) -> &'static str {
        match self {
            Stage::Settle => "settle",
            Stage::Tilt => "tilt",
            Stage::Run => "run",
        }
    }
}

/// How far a run is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Stage.
    pub stage: Stage,
    /// Time within the stage, s.
    pub time: f64,
    /// Longest the stage can last, s.
    pub end: f64,
    /// Steps since the start of the first stage.
    pub steps: u64,
    /// Material points.
    pub particles: usize,
    /// Normal force on the barrier now, N.
    pub force: f64,
    /// Settling: residual; run: kinetic energy over the energy at release.
    pub residual: f64,
}

/// Why a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The material came to rest.
    Rest,
    /// The end time was reached.
    Time,
    /// The user stopped it.
    Stopped,
}

/// What can go wrong in a run.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The simulation failed.
    #[error("the simulation failed: {0}")]
    Step(Box<StepFailure>),
    /// The material did not settle.
    #[error(
        "the material did not settle: after {time} s the residual is {residual:.3e}, wanted {wanted:.3e}\n  \
         raise stages.settle.max_time_s or stages.settle.damping_per_s, or accept a larger stages.settle.residual"
    )]
    Unsettled {
        /// Time allowed, s.
        time: f64,
        /// Residual reached.
        residual: f64,
        /// Residual wanted.
        wanted: f64,
    },
    /// A file could not be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A figure could not be drawn.
    #[error(transparent)]
    Plot(#[from] PlotError),
}

impl From<StepFailure> for RunError {
    fn from(failure: StepFailure) -> Self {
        RunError::Step(Box::new(failure))
    }
}

/// Facts of the stages before the release, and of the stepping.
#[derive(Debug, Clone, Copy, Default)]
pub struct StageFacts {
    /// Material points at release.
    pub particles: usize,
    /// Time spent settling and tilting, s.
    pub settle_time: f64,
    /// Steps spent settling and tilting.
    pub settle_steps: u64,
    /// Residual at release.
    pub settle_residual: f64,
    /// Shortest and longest time step after release, s.
    pub time_step: [f64; 2],
    /// Steps after release.
    pub run_steps: u64,
    /// What limited the shortest time step.
    pub shortest: Option<TimeStep>,
    /// Time at the end, s after release.
    pub end_time: f64,
}
