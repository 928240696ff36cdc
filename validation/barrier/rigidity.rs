//! Peak force, impact coefficient and deflection of the barrier against its rigidity (Fig. 6 of the paper), with the scatter of runs that
//! should be alike, and where "rigid" ends.

use super::PUBLISHED;
use super::records::{RIGID, RIGIDITY, SCATTER, impact_coefficient, impedance};
use crate::check::{Check, Expected, Kind};
use crate::plot::PlotError;
use crate::plot::curves::{self, Curve, Curves, Panel};
use crate::validation::flume::runs::Run;
use crate::validation::flume::scatter::Scatter;
use crate::validation::{Context, Failure, Validation, data};
use crate::verification::Outcome;
use crate::verification::report::number;
use std::path::Path;

/// The analysis of the recorded runs.
pub const VALIDATION: Validation = Validation {
    name: "barrier_rigidity",
    title: "Twelve rigidities of the barrier: impact coefficient, deflection, and where rigid ends",
    study: "80 runs, about 20 minutes",
    run,
    draw,
    covers: &[],
};

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
    /// Relative standard deviation of one run, as the repeated barriers have it.
    pub typical: f64,
}

/// Gap between neighbouring points from which a barrier counts as torn, cells.
const TORN: f64 = 0.25;
/// The literal release.
pub const LITERAL: &str = "60deg";

/// Reads the records.
///
/// # Errors
/// A record is not as it should be, or a study is stopped.
pub fn analyse(context: &mut Context) -> Result<Analysis, Failure> {
    let walls = RIGID.rows(context)?;
    let wall = |case: &str| {
        let own = walls.iter().filter(|r| r.case == case && r.set["cell_m"] == "0.01");
        Scatter::of(own.map(|r| r.get("peak_20ms_n")))
    };
    let rigid = [wall("60deg_rigid"), wall("60deg_rigid_calibrated")];
    let repeated = SCATTER.by_stiffness(context)?;
    let typical = relative_deviation(&repeated);
    let mut releases: Vec<(String, Vec<Point>)> = Vec::new();
    for (stiffness, run) in RIGIDITY.by_stiffness(context)? {
        let literal = run.case == LITERAL;
        let own = repeated.iter().filter(|(n, r)| literal && *n == stiffness && r.set["cell_m"] == "0.01");
        let mut peaks = Scatter::of(own.map(|(_, r)| r.get("peak_20ms_n")));
        if peaks.count == 0 {
            // A single run; under the literal release it is taken to scatter as much as those that were repeated there.
            let mean = run.get("peak_20ms_n");
            peaks = Scatter { mean, deviation: if literal { typical * mean } else { f64::NAN }, count: 1 };
        }
        let wall = rigid[usize::from(!literal)].mean;
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
        let own = repeated.iter().filter(|(m, r)| m == n && r.set["cell_m"] == "0.01");
        let s = Scatter::of(own.map(|(_, r)| r.get("peak_20ms_n")));
        squares += (s.deviation / s.mean) * (s.deviation / s.mean);
    }
    (squares / seen.len() as f64).sqrt()
}

/// Stiffness at which a curve through points, straight over the logarithm of the stiffness, first reaches a level; NaN where it
/// does not.
pub fn crossing(points: &[(f64, f64)], level: f64) -> f64 {
    let between = points.windows(2).find(|p| (p[0].1 < level) != (p[1].1 < level));
    between.map_or(f64::NAN, |p| {
        let share = (level - p[0].1) / (p[1].1 - p[0].1);
        libm::exp(libm::log(p[0].0) + share * libm::log(p[1].0 / p[0].0))
    })
}

/// Spearman's rank correlation of values with their places; without ties.
pub fn rank_correlation(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let rank = |v: f64| values.iter().filter(|w| **w < v).count() as f64;
    let squares: f64 = values.iter().enumerate().map(|(k, v)| (rank(*v) - k as f64) * (rank(*v) - k as f64)).sum();
    1.0 - 6.0 * squares / (n * (n * n - 1.0))
}

fn run(context: &mut Context) -> Result<Outcome, Failure> {
    let analysis = analyse(context)?;
    let mut outcome = Outcome { checks: checks(&analysis), ..Outcome::default() };
    outcome.tables.push(("barrier_rigidity".into(), table(&analysis)?));
    outcome.tables.push(("barrier_rigidity_threshold".into(), thresholds(&analysis)?));
    Ok(outcome)
}

/// Velocity and depth of the front, the same for all barriers: at the window, where the paper seems to read it, and at the barrier.
pub fn front(run: &Run) -> [[f64; 2]; 2] {
    [["front_velocity_m_per_s", "front_depth_m"], ["barrier_velocity_m_per_s", "barrier_depth_m"]]
        .map(|names| names.map(|n| run.get(n)))
}

fn table(analysis: &Analysis) -> Result<String, Failure> {
    let case = RIGIDITY.first_case()?;
    let (sand, barrier) = (&case.materials["sand"], &case.materials["barrier"]);
    let of_sand = impedance(sand.young_pa, sand.poisson, sand.density_kg_per_m3);
    let columns = [
        "release",
        "stiffness_1",
        "young_pa",
        "peak_20ms_n",
        "peak_mean_n",
        "peak_deviation_n",
        "runs",
        "peak_step_n",
        "peak_50hz_n",
        "alpha_1",
        "alpha_low_1",
        "alpha_high_1",
        "alpha_step_1",
        "alpha_50hz_1",
        "alpha_at_barrier_1",
        "over_rigid_1",
        "over_rigid_deviation_1",
        "impedance_over_rigid_1",
        "velocity_over_front_1",
        "impedance_velocity_1",
        "deflection_at_peak_1",
        "tip_final_1",
        "tip_max_1",
        "static_force_n",
        "static_clamp_n",
        "remaining_1",
        "dissipated_1",
        "energy_residual_1",
        "gap_cells",
        "guideline_rigid_1",
        "guideline_flexible_1",
        "ended",
    ];
    let guideline = ["B5", "B6"].map(|id| data::row(PUBLISHED, id).value);
    let mut text = columns.join(",") + "\n";
    for (release, points) in &analysis.releases {
        for p in points {
            let [window, at_barrier] = front(&p.run);
            let alpha = |force: f64| impact_coefficient(&case, force, window[0], window[1]);
            let young = p.stiffness * young_of_one(&case);
            let of_barrier = impedance(young, barrier.poisson, barrier.density_kg_per_m3);
            let share = of_barrier / (of_barrier + of_sand);
            let height = 0.6;
            let get = |name: &str| p.run.get(name);
            let values = [
                p.stiffness,
                young,
                get("peak_20ms_n"),
                p.peaks.mean,
                p.peaks.deviation,
                p.peaks.count as f64,
                get("peak_step_n"),
                get("peak_50hz_n"),
                alpha(p.peaks.mean),
                alpha(p.peaks.mean - p.peaks.deviation),
                alpha(p.peaks.mean + p.peaks.deviation),
                alpha(get("peak_step_n")),
                alpha(get("peak_50hz_n")),
                impact_coefficient(&case, p.peaks.mean, at_barrier[0], at_barrier[1]),
                p.over_rigid.mean,
                p.over_rigid.deviation,
                share,
                get("peak_barrier_velocity_m_per_s") / at_barrier[0],
                1.0 - share,
                get("peak_deflection_m") / height,
                get("tip_final_m") / height,
                get("tip_max_m") / height,
                get("static_force_n"),
                get("static_clamp_n"),
                1.0 - get("dissipated_1"),
                get("dissipated_1"),
                get("energy_residual_1"),
                get("gap_cells"),
                guideline[0],
                guideline[1],
            ];
            let cells = values.map(|x| if x.is_finite() { number(x) } else { String::new() });
            text += &format!("{release},{},{}\n", cells.join(","), p.run.ended);
        }
    }
    Ok(text)
}

/// Least stiffness from which the force of the single runs of the study stays within two standard deviations of the difference to the
/// stiffest barrier's; `deviation` is that of one run, relative.
pub fn plateau(points: &[Point], deviation: f64) -> f64 {
    let force = |p: &Point| p.run.get("peak_20ms_n");
    let stiffest = points.last().map_or(f64::NAN, force);
    let off = points.iter().rposition(|p| (force(p) / stiffest - 1.0).abs() > 2.0 * 2f64.sqrt() * deviation);
    points.get(off.map_or(0, |k| k + 1)).map_or(f64::NAN, |p| p.stiffness)
}

/// Least stiffness from which the tip never moves by 3 % of the height.
pub fn negligible(points: &[Point]) -> f64 {
    let off = points.iter().rposition(|p| p.run.get("tip_max_m") > 0.03 * 0.6);
    points.get(off.map_or(0, |k| k + 1)).map_or(f64::NAN, |p| p.stiffness)
}

/// Young's modulus of a barrier of the normalised stiffness 1, Pa, for the height and thickness of the case.
pub fn young_of_one(case: &crate::case::Case) -> f64 {
    let depth = case.bodies.iter().find(|b| b.name == "barrier").map_or(f64::NAN, |b| b.size_m()[0]);
    crate::theory::barrier::young_for(1.0, 0.6, depth, case.grid.thickness_m)
}

/// What is crossed, from a point and the force on it.
type Of<'a> = &'a dyn Fn(&Point, f64) -> f64;

/// Where the curve crosses what is said to part rigid from deformable, with the interval that one standard deviation leaves.
fn thresholds(analysis: &Analysis) -> Result<String, Failure> {
    let case = RIGIDITY.first_case()?;
    let alpha = |p: &Point, force: f64| {
        let [window, _] = front(&p.run);
        impact_coefficient(&case, force, window[0], window[1])
    };
    let over_rigid = |p: &Point, force: f64| force / analysis.rigid[usize::from(p.run.case != LITERAL)].mean;
    let stiffest = |case: &str| {
        let own = analysis.releases.iter().find(|(name, _)| name == case).and_then(|(_, points)| points.last());
        own.map_or(f64::NAN, |p| p.peaks.mean)
    };
    let over_stiffest = |p: &Point, force: f64| force / stiffest(&p.run.case);
    let levels: [(&str, f64, Of); 5] = [
        ("impact coefficient, front at 0.7 m", 2.0, &alpha),
        ("impact coefficient, front at 0.7 m", 2.5, &alpha),
        ("force over that of a rigid wall", 0.9, &over_rigid),
        ("force over that of a rigid wall", 0.6, &over_rigid),
        ("force over that of the stiffest barrier", 0.6, &over_stiffest),
    ];
    let mut text = String::from("release,level,value,stiffness_1,low_1,high_1\n");
    for (release, points) in &analysis.releases {
        let curve = |of: Of, deviations: f64| -> Vec<(f64, f64)> {
            // No interval where nothing was repeated.
            let spread = |p: &Point| if deviations == 0.0 { 0.0 } else { p.peaks.deviation };
            points.iter().map(|p| (p.stiffness, of(p, p.peaks.mean + deviations * spread(p)))).collect()
        };
        for (name, level, of) in levels {
            let at = [0.0, 1.0, -1.0].map(|d| crossing(&curve(of, d), level));
            let cells = at.map(|x| if x.is_finite() { number(x) } else { String::new() });
            text += &format!("{release},\"{name}\",{level},{}\n", cells.join(","));
        }
    }
    Ok(text)
}

fn checks(analysis: &Analysis) -> Vec<Check> {
    let all: Vec<&Run> = analysis.releases.iter().flat_map(|(_, points)| points.iter().map(|p| &p.run)).collect();
    let worst = |name: &str| {
        all.iter().map(|r| r.get(name).abs()).fold(0.0, |a: f64, x| if x.is_nan() { f64::NAN } else { a.max(x) })
    };
    // The softest barrier lies down under the fast flow of the literal release and tears at the clamp; the table says so.
    let softest = |p: &&Point| p.run.case == LITERAL && p.stiffness == analysis.releases[0].1[0].stiffness;
    let held = analysis.releases.iter().flat_map(|(_, points)| points).filter(|p| !softest(p));
    let torn =
        held.filter(|p| p.run.get("gap_cells").partial_cmp(&TORN) != Some(std::cmp::Ordering::Less)).count() as f64;
    let bound = |what: &str, measured: f64, limit: f64, reason: &str| {
        Check::at_most(what, measured, limit, "1")
            .because(reason)
            .from(Kind::Conservation, "ledgers and gauges of all runs")
    };
    let mut checks = vec![
        bound("momentum not accounted for, largest", worst("momentum_closure_1"), 1e-10, "round-off of sums"),
        bound(
            "contact less clamp and inertia over their sum, largest of all samples",
            worst("imbalance_1"),
            1e-9,
            "round-off of sums: two readings of the same force",
        ),
        bound(
            "energy not accounted for over E0, largest",
            worst("energy_residual_1"),
            0.02,
            "second-order terms of the transfers; 2 % is where forces would begin to suffer",
        ),
        bound(
            "barriers that tore, but for the softest under the literal release",
            torn,
            0.0,
            "a gap of a quarter of a cell between points",
        ),
        bound("deepest penetration, m", worst("penetration_m"), 0.01, "one cell of 10 mm"),
    ];
    for (release, points) in &analysis.releases {
        let at = |p: &Point| p.run.get("front_velocity_m_per_s");
        let (low, high) =
            points.iter().map(at).fold((f64::INFINITY, 0.0), |(a, b): (f64, f64), x| (a.min(x), b.max(x)));
        checks.push(
            Check::at_most(
                format!("{release}: spread of the front's velocity at 0.7 m over all barriers"),
                1.0 - low / high,
                0.01,
                "1",
            )
            .because("the barrier cannot be felt before the arrival; time steps differ")
            .from(Kind::Analytic, "causality"),
        );
        let peaks: Vec<f64> = points.iter().map(|p| p.peaks.mean).collect();
        checks.push(
            Check::new(
                format!("{release}: rank correlation of peak force and rigidity"),
                rank_correlation(&peaks),
                Expected::AtLeast(0.9),
                "1",
            )
            .because("stiff barriers differ by less than single runs scatter, so that neighbours may change places")
            .from(Kind::Published, "Ng et al., Fig. 6: the impact coefficient grows with rigidity"),
        );
    }
    checks
}

const fn panel(title: &'static str, only: &'static [(&'static str, &'static str)]) -> Panel<'static> {
    Panel { title, only }
}

const RELEASES: &[Panel<'static>] = &[
    panel("literal release", &[("release", "60deg")]),
    panel("calibrated release", &[("release", "60deg_calibrated")]),
];

const COEFFICIENT: Curves = Curves {
    x: "stiffness_1",
    x_title: "normalised stiffness 3 EI/H\u{b3}",
    y_title: "impact coefficient",
    curves: &[
        Curve { column: "alpha_1", label: "mean over 20 ms", exact: false },
        Curve { column: "alpha_step_1", label: "largest of a step", exact: false },
        Curve { column: "alpha_50hz_1", label: "samples every 20 ms", exact: false },
        Curve { column: "alpha_low_1", label: "one standard deviation", exact: true },
        Curve { column: "alpha_high_1", label: "one standard deviation", exact: true },
        Curve { column: "guideline_rigid_1", label: "guideline, rigid", exact: true },
        Curve { column: "guideline_flexible_1", label: "guideline, flexible", exact: true },
    ],
    panels: RELEASES,
    ..Curves::LOGARITHMIC
};

const DEFLECTION: Curves = Curves {
    x: "stiffness_1",
    x_title: "normalised stiffness 3 EI/H\u{b3}",
    y_title: "deflection over the height",
    curves: &[
        Curve { column: "tip_final_1", label: "tip, at the end", exact: false },
        Curve { column: "tip_max_1", label: "tip, largest", exact: false },
        Curve { column: "deflection_at_peak_1", label: "anywhere, at the largest force", exact: false },
    ],
    panels: RELEASES,
    ..Curves::LOGARITHMIC
};

const AGAINST_IMPEDANCE: Curves = Curves {
    x: "stiffness_1",
    x_title: "normalised stiffness 3 EI/H\u{b3}",
    y_title: "share",
    curves: &[
        Curve { column: "over_rigid_1", label: "force over that of a rigid wall", exact: false },
        Curve { column: "velocity_over_front_1", label: "barrier's velocity over the front's", exact: false },
        Curve { column: "impedance_over_rigid_1", label: "impedances: force", exact: true },
        Curve { column: "impedance_velocity_1", label: "impedances: velocity", exact: true },
    ],
    panels: RELEASES,
    ..Curves::LOGARITHMIC
};

fn draw(folder: &Path) -> Result<Vec<String>, PlotError> {
    let figures = [
        ("barrier_rigidity_coefficient.svg", &COEFFICIENT),
        ("barrier_rigidity_deflection.svg", &DEFLECTION),
        ("barrier_rigidity_impedance.svg", &AGAINST_IMPEDANCE),
    ];
    for (name, what) in figures {
        curves::draw(folder.join("barrier_rigidity.csv"), what, folder.join(name))?;
    }
    Ok(figures.map(|f| f.0.into()).into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crossing_lies_between_its_neighbours() {
        let curve = [(1e-6, 1.0), (1e-4, 2.0), (1e-2, 4.0)];
        assert!((crossing(&curve, 1.5) - 1e-5).abs() < 1e-18);
        assert!((crossing(&curve, 3.0) / 1e-3 - 1.0).abs() < 1e-12);
        assert!(crossing(&curve, 5.0).is_nan() && crossing(&curve, 0.5).is_nan());
    }

    #[test]
    fn ranks_follow_the_order() {
        assert_eq!(rank_correlation(&[1.0, 2.0, 5.0]), 1.0);
        assert_eq!(rank_correlation(&[5.0, 2.0, 1.0]), -1.0);
        // 1 - 6 x 2 / (3 x 8).
        assert_eq!(rank_correlation(&[2.0, 1.0, 5.0]), 0.5);
    }
}
