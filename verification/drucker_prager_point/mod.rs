//! Drucker-Prager and the Jaumann rate at a single point, without grid.
//!
//! Strains are prescribed; where a stress is, the strain along it is found by secant iteration. Out-of-plane strain is zero
//! throughout, as in the solver. The meridians of the cone are reached all the same: confined compression along y keeps
//! sigma_xx = sigma_zz, which is triaxial compression as to stress, and unloading it is triaxial extension.

mod elastic_paths;
mod history;
mod strength;

use super::{Fault, FaultKind, Outcome, Rung, RungFailure};
use crate::figure::{Figure, curves, exact, measured};
use crate::of_module;
use checkdam::constitutive::{Cone, DruckerPrager, Increment, Law, LinearElastic, PointState};
use checkdam::plot::curves::Curves;
use checkdam::theory::elastic::Elastic;

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "One material point: strength on every path, dilatancy, apex, cohesion, opening and closing, Jaumann rate",
    goal: "The law at one point: strength on every path, dilatancy, apex, opening and closing, rate of turning",
    source: "Drucker and Prager 1952; Mohr-Coulomb at the same angle; Dienes 1979; Hughes and Winget 1980",
    sketch: r"
   sqrt(J2)  |      / cone
             |    /
             |  /    paths: compression, extension,
             |/      shear, opening, turning
   ---------apex------------ -p
",
    run,
    covers: &[(FaultKind::Friction, 1.02), (FaultKind::Modulus, 1.02)],
    under_fault: "all",
    figures: FIGURES,
};

/// Its figures.
const FIGURES: &[Figure] = &[
    curves(
        "drucker_prager_point_jaumann",
        "drucker_prager_point_jaumann_plot",
        Curves {
            x: "gamma",
            x_title: "shear strain",
            y_title: "stress (Pa)",
            curves: &[
                measured("sigma_xy_pa", "shear"),
                exact("sigma_xy_exact_pa", "G sin(gamma)"),
                measured("sigma_xx_pa", "normal"),
                exact("sigma_xx_exact_pa", "G (1 - cos(gamma))"),
            ],
            ..Curves::LINEAR
        },
    ),
    curves(
        "drucker_prager_point_angles",
        "drucker_prager_point_angles_plot",
        Curves {
            x: "friction_angle_deg",
            x_title: "friction angle that the cone is given (degrees)",
            y_title: "friction angle in plane strain (degrees)",
            curves: &[measured("plane_strain_angle_deg", ""), exact("plane_strain_angle_exact_deg", "closed form")],
            split: &[("cone", "")],
            ..Curves::LINEAR
        },
    ),
    curves(
        "drucker_prager_point_opening",
        "drucker_prager_point_opening_plot",
        Curves {
            x: "strain",
            x_title: "vertical strain, opened and closed again",
            y_title: "vertical pressure (Pa)",
            curves: &[measured("vertical_pressure_pa", "")],
            split: &[("void_tracking", "void tracking ")],
            ..Curves::LINEAR
        },
    ),
];

const SAND: Elastic = Elastic { young: 1e6, poisson: 0.3 };
/// Friction angle, rad.
const PHI: f64 = 31.0 * std::f64::consts::PI / 180.0;

/// A cone, by name.
#[derive(Clone, Copy)]
struct Case {
    name: &'static str,
    cone: Cone,
    /// Dilatancy angle, rad.
    psi: f64,
}

/// The solver's law with the fault in its stiffness and in the slope of its cone.
fn law(cone: Cone, psi: f64, cohesion: f64, poisson: f64, fault: &Fault) -> DruckerPrager {
    law_at(PHI, cone, psi, cohesion, poisson, fault)
}

/// The same at another friction angle (rad).
fn law_at(phi: f64, cone: Cone, psi: f64, cohesion: f64, poisson: f64, fault: &Fault) -> DruckerPrager {
    let elastic = LinearElastic::new(SAND.young * fault.modulus, poisson);
    let mut law = DruckerPrager::new(elastic, cone, phi, psi, cohesion, f64::INFINITY, true);
    law.friction *= fault.friction;
    if law.friction > 0.0 {
        law.tension_cutoff = law.cohesion / law.friction;
    }
    law
}

pub(crate) fn strain(xx: f64, yy: f64, xy: f64) -> Increment {
    Increment { xx, yy, xy, ..Increment::default() }
}

/// Advances `state` by an increment of which one component, set by `with`, is such that `stress` of the state vanishes:
/// secant iteration. NaN, which no check accepts, where it does not converge.
pub(crate) fn drive<L: Law>(
    law: &L,
    state: &mut PointState,
    guess: f64,
    with: impl Fn(f64) -> Increment,
    stress: impl Fn(&PointState) -> f64,
) -> f64 {
    let trial = |e: f64| {
        let mut s = *state;
        law.update(&mut s, &with(e));
        (stress(&s), s)
    };
    let (mut a, mut b) = (guess, guess + 1e-7);
    let (mut fa, (mut fb, mut end)) = (trial(a).0, trial(b));
    for _ in 0..100 {
        if fb.abs() < 1e-9 || fb == fa {
            break;
        }
        let next = b - fb * (b - a) / (fb - fa);
        (a, fa, b) = (b, fb, next);
        (fb, end) = trial(b);
    }
    *state = end;
    if fb.abs() < 1e-6 { b } else { f64::NAN }
}

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let mut outcome = Outcome::default();
    strength::run(fault, &mut outcome);
    history::run(fault, &mut outcome);
    elastic_paths::run(fault, &mut outcome);
    Ok(outcome)
}
