//! What does depend on how a case is written, with its size: shown, and not judged.
//!
//! - A wall's crest half a cell from a row of nodes: a crossing that the wall covers by nothing is free, and one that it covers by next to
//!   nothing is shut where no material lies beyond it. A hair's breadth decides.
//! - Of two boundaries at one node the first takes the impulse: what is called friction and what impact depends on their order, and not
//!   the sum. In the flume on cells of 40 mm 1.2 J of the 6.2 J of impact; on those of the rung next to nothing.
//! - In one step of the impact the ledger of a boundary that slides or sticks by round-off books another work; no force differs.
//! - `impulse_scale_n_s` adds magnitudes along the axes.
//! - Means over 20 ms and 0.3 s, and rows of 1 ms, are no ratios to the times of a model: by definition.

use super::pairs::Pair;
use super::reading::Reading;
use super::scatter::Sets;
use super::scenes::Scene;
use checkdam::case::Case;
use rayon::prelude::*;

/// A number of both runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Noted {
    /// What was done.
    pub transformation: &'static str,
    /// To what.
    pub scene: Scene,
    /// Name of the number.
    pub name: &'static str,
    /// What the transformation makes of the first run's.
    pub before: f64,
    /// What the second run says.
    pub after: f64,
}

fn noted(
    transformation: &'static str,
    scene: Scene,
    [before, after]: [&Reading; 2],
    names: &[&'static str],
    factor: impl Fn(&str) -> f64,
) -> Vec<Noted> {
    let of = |name: &'static str| {
        let (before, after) = (factor(name) * before.number(name), after.number(name));
        Noted { transformation, scene, name, before, after }
    };
    names.iter().map(|name| of(name)).collect()
}

/// What is seen in pairs that are judged for the rest: the reading of the scene and of a transformed one.
pub fn of_pair(scene: Scene, pair: &Pair, base: &Reading, after: &Reading) -> Vec<Noted> {
    let names: &[&'static str] = match pair.name {
        "order of tables, bodies, boundaries" => &["energy: friction_1", "energy: impact_1"],
        "lengths x 10, equal Froude number" => &["energy: residual_end_1", "energy: residual_of_released_1"],
        "lengths x 4, equal Froude number" => &[
            "barrier: arrival_s",
            "barrier: peak_20ms_by_steps_n",
            "barrier: static_force_n",
            "barrier: run_up_m",
            "front 3: velocity_m_per_s",
        ],
        _ => &[],
    };
    noted(pair.name, scene, [base, after], names, |name| pair.factors.of(name))
}

/// What needs runs of its own.
pub fn of_runs(barrier: &Case, sets: &Sets, run: impl Fn(&Case) -> Reading + Sync + Send) -> Vec<Noted> {
    const FORCES: &[&str] = &["stepping: settle_steps", "barrier: peak_step_n", "barrier: impulse_normal_n_s"];
    let gate = |raised: f64| {
        let mut case = barrier.clone();
        for b in case.boundaries.iter_mut().filter(|b| b.name == "gate") {
            b.height_m = Some(12.5 * case.grid.spacing_m);
            b.foot_m.iter_mut().for_each(|foot| foot[1] += raised);
        }
        case
    };
    let cases = [gate(0.0), gate(1e-13)];
    let readings: Vec<Reading> = cases.par_iter().map(run).collect();
    let one = |_: &str| 1.0;
    let mut all = Vec::new();
    if let [low, high] = &readings[..] {
        let crest = "a gate with its crest half a cell from a node raised by 1e-13 m";
        all.extend(noted(crest, Scene::Barrier, [low, high], FORCES, one));
    }
    let name = "momentum: impulse_scale_n_s";
    let [before, after] = sets.of(name);
    all.push(Noted { transformation: "turned by -17 degrees, means", scene: Scene::Flume, name, before, after });
    all
}
