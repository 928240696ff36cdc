//! What the records say of each rigidity under each release.

use crate::barrier::records::{LITERAL, RIGIDITY, SCATTER, SCATTER_CALIBRATED, on_rigid_wall, peaks};
use crate::runs::Run;
use crate::scatter::Scatter;
use crate::{Context, Failure};

/// One rigidity under one release.
#[derive(Debug, Clone)]
pub struct Point {
    /// Normalised stiffness.
    pub stiffness: f64,
    /// The run.
    pub run: Run,
    /// Largest force over 20 ms of the runs that should be alike, N.
    pub peaks: Scatter,
    /// Largest force over 20 ms over that of the rigid wall.
    pub over_rigid: Scatter,
}

/// The study as a whole.
pub struct Analysis {
    /// Release (name of the case) and its points, soft to stiff.
    pub releases: Vec<(String, Vec<Point>)>,
    /// Largest force over 20 ms on a rigid wall, N: literal and calibrated.
    pub rigid: [Scatter; 2],
    /// Relative standard deviation of one run, as the repeated barriers have it: literal and calibrated.
    pub typical: [f64; 2],
}

/// Reads the records.
///
/// # Errors
/// A record is not as it should be, or a study is stopped.
pub fn analyse(context: &mut Context) -> Result<Analysis, Failure> {
    let rigid = on_rigid_wall(context)?;
    let repeated = [SCATTER.by_stiffness(context)?, SCATTER_CALIBRATED.by_stiffness(context)?];
    let typical = repeated.each_ref().map(|r| relative_deviation(r));
    let mut releases: Vec<(String, Vec<Point>)> = Vec::new();
    for (stiffness, run) in RIGIDITY.by_stiffness(context)? {
        let release = usize::from(run.case != LITERAL);
        let mut peaks = peaks(repeated[release].iter().filter(|(n, _)| *n == stiffness).map(|(_, r)| r));
        if peaks.count == 0 {
            // A single run is taken to scatter as much as those that were repeated; so is that of the softest, on finer points.
            let mean = run.get("peak_20ms_n");
            peaks = Scatter { mean, deviation: typical[release] * mean, count: 1 };
        }
        let wall = rigid[release].mean;
        let over_rigid = Scatter { mean: peaks.mean / wall, deviation: peaks.deviation / wall, count: peaks.count };
        let point = Point { stiffness, peaks, over_rigid, run };
        match releases.last_mut().filter(|(case, _)| *case == point.run.case) {
            Some((_, points)) => points.push(point),
            None => releases.push((point.run.case.clone(), vec![point])),
        }
    }
    Ok(Analysis { releases, rigid, typical })
}

/// Root of the mean square of the relative standard deviations of the barriers that were repeated on cells of 10 mm.
fn relative_deviation(repeated: &[(f64, Run)]) -> f64 {
    let mut seen: Vec<f64> = Vec::new();
    let mut squares = 0.0;
    for (n, _) in repeated {
        if seen.contains(n) {
            continue;
        }
        seen.push(*n);
        let s = peaks(repeated.iter().filter(|(m, _)| m == n).map(|(_, r)| r));
        squares += (s.deviation / s.mean) * (s.deviation / s.mean);
    }
    (squares / seen.len() as f64).sqrt()
}

/// Velocity and depth of the front, the same for all barriers: at the window, where the paper seems to read it, and at the barrier.
pub fn front(run: &Run) -> [[f64; 2]; 2] {
    [["front_velocity_m_per_s", "front_depth_m"], ["barrier_velocity_m_per_s", "barrier_depth_m"]]
        .map(|names| names.map(|n| run.get(n)))
}
