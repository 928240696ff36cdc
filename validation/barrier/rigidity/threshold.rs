//! Where "rigid" ends: stiffnesses at which a curve crosses a level or joins that of the stiffest barrier.

use super::{Analysis, Point, front};
use crate::Failure;
use crate::barrier::records::{LITERAL, RIGIDITY, height, impact_coefficient};
use checkdam_verification::report::number;

/// Deflection over the height that the paper calls negligible.
const NEGLIGIBLE: f64 = 0.03;

/// Stiffness at which a curve through points, straight over the logarithm of the stiffness, first reaches a level; NaN where it
/// does not.
pub fn crossing(points: &[(f64, f64)], level: f64) -> f64 {
    let between = points.windows(2).find(|p| (p[0].1 < level) != (p[1].1 < level));
    between.map_or(f64::NAN, |p| {
        let share = (level - p[0].1) / (p[1].1 - p[0].1);
        libm::exp(libm::log(p[0].0) + share * libm::log(p[1].0 / p[0].0))
    })
}

/// Least stiffness from which the force of the single runs of the study stays within two standard deviations of the difference to the
/// stiffest barrier's; `deviation` is that of one run, relative.
pub fn plateau(points: &[Point], deviation: f64) -> f64 {
    let force = |p: &Point| p.run.get("peak_20ms_n");
    let stiffest = points.last().map_or(f64::NAN, force);
    let off = points.iter().rposition(|p| (force(p) / stiffest - 1.0).abs() > 2.0 * 2f64.sqrt() * deviation);
    points.get(off.map_or(0, |k| k + 1)).map_or(f64::NAN, |p| p.stiffness)
}

/// Least stiffness from which the tip never moves by 3 % of the height, which the paper calls negligible.
pub fn negligible(points: &[Point]) -> f64 {
    let limit = NEGLIGIBLE * RIGIDITY.first_case().map_or(f64::NAN, |case| height(&case));
    let off = points.iter().rposition(|p| p.run.get("tip_max_m") > limit);
    points.get(off.map_or(0, |k| k + 1)).map_or(f64::NAN, |p| p.stiffness)
}

/// What is crossed, from a point and the force on it.
type Of<'a> = &'a dyn Fn(&Point, f64) -> f64;

/// Where the curve crosses what is said to part rigid from deformable, with the interval that one standard deviation leaves.
pub(super) fn table(analysis: &Analysis) -> Result<String, Failure> {
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
            points.iter().map(|p| (p.stiffness, of(p, p.peaks.mean + deviations * p.peaks.deviation))).collect()
        };
        for (name, level, of) in levels {
            let at = [0.0, 1.0, -1.0].map(|d| crossing(&curve(of, d), level));
            let cells = at.map(|x| if x.is_finite() { number(x) } else { String::new() });
            text += &format!("{release},\"{name}\",{level},{}\n", cells.join(","));
        }
    }
    Ok(text)
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
}
