//! What must not depend on how a case is written: transformations that leave the physics as it is, on the flume and on one elastic barrier.
//!
//! Each transformation is done to the case; what a user reads of the run is then compared with what it makes of the numbers of the case as
//! it was: every number of `summary.toml` and every row of the tables.

mod judge;
mod notes;
mod pairs;
mod reading;
mod scatter;
mod scenes;
mod tables;
pub(crate) mod transform;

use super::{Fault, FaultKind, Outcome, Rung};
use crate::RungFailure;
use crate::figure::{Figure, curves, measured};
use crate::of_module;
use checkdam::case::Case;
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::plot::curves::{Curves, panel};
use judge::{Compared, DISPLACED, TWINS, compare, worst};
use pairs::{Near, Pair, pairs};
use rayon::prelude::*;
use reading::Reading;
use scatter::Sets;
use scenes::Scene;
use std::sync::OnceLock;

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "Flume and elastic barrier mirrored, turned, moved, scaled, written otherwise: the same numbers, to bits, round-off or scatter",
    goal: "What a run reports is a property of the flow, not of the file, the grid's place, the unit or the sampling",
    source: "invariance to reflection, rotation, translation; similarity at equal Froude number; linearity in density and stiffness",
    sketch: r"
   |oo|                     |        |                  |oo|
   |oo|gate       barrier   |        |  barrier     gate|oo|
  -+--+---------------------+--     -+------------------+--+-
        g at 40 or 60 degrees          mirrored, turned, moved,
                                       4 times as large
",
    run,
    covers: &[
        (FaultKind::Gravity, 1.02),
        (FaultKind::Density, 1.02),
        (FaultKind::Modulus, 1.02),
        (FaultKind::Friction, 1.02),
        (FaultKind::ContactForce, 1.02),
    ],
    under_fault: "the flume and its mirror image, of which only the image has the fault",
    figures: FIGURES,
};

/// Its figures.
const FIGURES: &[Figure] = &[
    curves(
        "invariance_growth",
        "invariance_growth_plot",
        Curves {
            x: "time_s",
            x_title: "time after release (s)",
            y_title: "difference of kinetic energy, share",
            curves: &[measured("difference_1", "")],
            panels: &[panel("flume", &[("scene", "flume")]), panel("elastic barrier", &[("scene", "elastic barrier")])],
            split: &[("transformation", "")],
            ..Curves::LOGARITHMIC
        },
    ),
    curves(
        "invariance_ranks",
        "invariance_ranks_plot",
        Curves {
            x: "rank_1",
            x_title: "numbers, the worst first",
            y_title: "difference over what is allowed",
            curves: &[measured("used_1", "")],
            panels: &[panel("flume", &[("scene", "flume")]), panel("elastic barrier", &[("scene", "elastic barrier")])],
            split: &[("transformation", "")],
            ..Curves::LOGARITHMIC
        },
    ),
];

/// A scene as it stands in its file, and its twins.
struct Base {
    case: Case,
    reading: Reading,
    twins: Vec<Reading>,
}

fn base(scene: Scene) -> &'static Base {
    static BASES: [OnceLock<Base>; 2] = [const { OnceLock::new() }; 2];
    BASES[scene as usize].get_or_init(|| {
        let case = scene.case();
        let twin = |seed: u32| {
            let mut twin = case.clone();
            (twin.bodies[0].jitter, twin.bodies[0].jitter_seed) = (DISPLACED, seed);
            twin
        };
        let cases: Vec<Case> = std::iter::once(case.clone()).chain((1..=TWINS).map(twin)).collect();
        let mut readings = cases.par_iter().map(run_or_say).collect::<Vec<_>>().into_iter();
        Base { case, reading: readings.next().unwrap_or_default(), twins: readings.collect() }
    })
}

/// A run as it is read. One that fails has no numbers, and every comparison with it fails.
fn run_or_say(case: &Case) -> Reading {
    reading::run(case).unwrap_or_else(|e| {
        eprintln!("{}: {e}", case.title);
        Reading::default()
    })
}

fn run_pair(pair: &Pair) -> Reading {
    match rayon::ThreadPoolBuilder::new().num_threads(3).build() {
        Ok(pool) if pair.threads => pool.install(|| run_or_say(&pair.case)),
        _ => run_or_say(&pair.case),
    }
}

/// A transformation that was done, and its numbers beside those of the scene as it was.
struct Done {
    scene: Scene,
    name: &'static str,
    near: Near,
    compared: Vec<Compared>,
    /// The pair and its run, but for means of several.
    pair: Option<(Pair, Reading)>,
}

impl Done {
    fn new(scene: Scene, pair: Pair, after: Reading) -> Self {
        let base = base(scene);
        let compared = compare(&pair, &base.reading, &base.twins, &after);
        Self { scene, name: pair.name, near: pair.near, compared, pair: Some((pair, after)) }
    }

    fn check(&self) -> Check {
        let count = self.compared.len();
        let what = format!("{}: {}", self.scene.name(), self.name);
        let most = worst(&self.compared).map_or(f64::NAN, Compared::share);
        match self.near {
            Near::Bits => {
                let off = if count == 0 { f64::NAN } else { self.compared.iter().filter(|c| c.difference != 0.0).count() as f64 };
                Check::value(format!("{what}: numbers of {count} that are not the same bits"), off, 0.0, "1")
                    .within(
                        Tolerance::Absolute(0.0),
                        "factors are powers of two, and names, rows and threads no part of any sum",
                    )
            }
            Near::RoundOff => {
                let what = format!("{what}: largest difference over what is allowed, of {count} numbers");
                Check::at_most(what, most, 1.0, "1").because(
                    "what twins differ by whose points lie elsewhere by 1e-11 of their distance: twenty times what \
                     round-off displaces them by",
                )
            }
            Near::Scatter => {
                let what = format!("{what}: largest difference of means over what is allowed, of {count} numbers");
                Check::at_most(what, most, 1.0, "1").because(
                    "6.21 standard errors of six runs and six: Student's t at 1e-4, as two hundred numbers are compared",
                )
            }
        }
        .from(Kind::Conservation, "invariance")
    }
}

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let mut outcome = Outcome::default();
    if *fault != Fault::NONE {
        for mut pair in pairs(Scene::Flume, &base(Scene::Flume).case).into_iter().filter(|p| p.name == "mirrored") {
            wrong(&mut pair.case, fault);
            let mut seen = run_pair(&pair);
            misread(&mut seen, fault);
            outcome.check(Done::new(Scene::Flume, pair, seen).check());
        }
        return Ok(outcome);
    }
    let all: Vec<(Scene, Pair)> =
        Scene::ALL.into_iter().flat_map(|s| pairs(s, &base(s).case).into_iter().map(move |p| (s, p))).collect();
    let (mut all, (sets, further)) = rayon::join(
        || {
            all.into_par_iter()
                .map(|(s, p)| (run_pair(&p), s, p))
                .map(|(r, s, p)| Done::new(s, p, r))
                .collect::<Vec<_>>()
        },
        || {
            let [flume, barrier] = Scene::ALL.map(base);
            let sets = Sets::run(&flume.case, run_or_say);
            let further = notes::of_runs(&barrier.case, &sets, run_or_say);
            (sets, further)
        },
    );
    let means = |name, compared| Done { scene: Scene::Flume, name, near: Near::Scatter, compared, pair: None };
    all.push(means("moved by broken cells over the grid", sets.moved()));
    all.push(means("turned by -17 degrees", sets.turned(0)));
    all.push(means("turned by -45 degrees", sets.turned(1)));
    all.iter().for_each(|d| outcome.check(d.check()));
    let own = |d: &Done| d.pair.as_ref().map(|(p, after)| notes::of_pair(d.scene, p, &base(d.scene).reading, after));
    let noted = all.iter().filter_map(own).flatten().chain(further).collect::<Vec<_>>();
    outcome.tables.push(("invariance_pairs".into(), tables::pairs(&all, &noted)));
    outcome.tables.push(("invariance_growth".into(), tables::growth(&all)));
    outcome.tables.push(("invariance_ranks".into(), tables::ranks(&all)));
    Ok(outcome)
}

/// The physics of a case, wrong.
fn wrong(case: &mut Case, fault: &Fault) {
    case.gravity.magnitude_m_per_s2 *= fault.gravity;
    for m in case.materials.values_mut() {
        m.density_kg_per_m3 *= fault.density;
        m.young_pa *= fault.modulus;
        let steeper = |a: &mut f64| *a = (fault.friction * a.to_radians().tan()).atan().to_degrees();
        m.friction_angle_deg.iter_mut().for_each(steeper);
    }
    case.boundaries.iter_mut().filter_map(|b| b.friction.as_mut()).for_each(|f| *f *= fault.friction);
}

/// The force on the barrier as it is read, wrong.
fn misread(reading: &mut Reading, fault: &Fault) {
    let force =
        |name: &str| name.starts_with("barrier: ") && name.ends_with("_n") || name == "history.csv: force_normal_n";
    for (_, x) in reading.summary.iter_mut().chain(&mut reading.by_rows).filter(|q| force(&q.0)) {
        *x *= fault.contact_force;
    }
    for (_, column) in reading.columns.iter_mut().filter(|q| force(&q.0)) {
        column.iter_mut().for_each(|x| *x *= fault.contact_force);
    }
}

#[cfg(test)]
mod tests;
