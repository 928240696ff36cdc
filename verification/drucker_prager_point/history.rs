//! What depends on the path: opening and closing, random paths, step size.

use super::super::report::named_csv;
use super::super::scene::Lcg;
use super::{Fault, Outcome, PHI, SAND, drive, law, strain};
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::constitutive::{Cone, DruckerPrager, Increment, Law, PointState, Stress};

const CONES: [Cone; 4] = [Cone::TriaxialCompression, Cone::TriaxialExtension, Cone::PlaneStrain, Cone::AsPrinted];

pub fn run(fault: &Fault, outcome: &mut Outcome) {
    opening(fault, outcome);
    random_paths(fault, outcome);
    step_size(fault, outcome);
}

/// Stretch by 5 %, press back by 5 %, go on to press by 0.2 %: log strains, steps of 0.01 %.
fn opening(fault: &Fault, outcome: &mut Outcome) {
    let (step, stretch, press) = (1e-4, 500, 520);
    let mut rows = Vec::new();
    let mut ends = Vec::new();
    let sand = SAND;
    for tracking in [true, false] {
        let law =
            DruckerPrager { void_tracking: tracking, ..law(Cone::TriaxialCompression, 0.0, 0.0, sand.poisson, fault) };
        let mut state = PointState::default();
        let (mut largest_open, mut at_closure) = (0.0f64, 0.0);
        for k in 1..=stretch + press {
            let sign = if k <= stretch { 1.0 } else { -1.0 };
            law.update(&mut state, &strain(0.0, sign * step, 0.0));
            let s = state.stress;
            if k <= 2 * stretch {
                largest_open = largest_open.max(s.xx.abs()).max(s.yy.abs()).max(s.zz.abs());
                at_closure = -s.mean();
            }
            if k % 20 == 0 {
                let strain = step * if k <= stretch { f64::from(k) } else { f64::from(2 * stretch - k) };
                rows.push(vec![f64::from(u8::from(tracking)), strain, -s.mean(), -s.yy, state.opened]);
            }
        }
        ends.push((largest_open, at_closure, -state.stress.yy, -state.stress.xx));
    }
    let beyond = step * f64::from(press - stretch);
    let source = "what came apart must close before it carries (Tampubolon et al. 2017)";
    outcome.check(
        Check::at_most(
            "opened by 5 % and closed: largest stress on the way, over Young's modulus",
            ends[0].0 / SAND.young,
            1e-14,
            "1",
        )
        .because("zero but for round-off of 1000 strain steps")
        .from(Kind::Analytic, source),
    );
    for (what, measured, exact) in [
        ("vertical", ends[0].2, sand.confined() * beyond),
        ("lateral", ends[0].3, sand.confined() * beyond * sand.lateral_ratio()),
    ] {
        outcome.check(
            Check::value(format!("pressed by 0.2 % beyond closure: {what} stress"), measured, exact, "Pa")
                .within(
                    Tolerance::Relative(1e-9),
                    "elastic in the outer cone; round-off of the closing strain of 5 %, 1e-12 of it",
                )
                .from(Kind::Analytic, "confined compression, M e and lambda e"),
        );
    }
    // Without tracking the pressure grows from the first step of closing: this is what tracking is for.
    outcome.check(
        Check::value("without tracking: spurious pressure when just closed", ends[1].1, sand.bulk() * 0.05, "Pa")
            .within(Tolerance::Relative(1e-9), "the whole closing strain is elastic")
            .from(Kind::Analytic, "K e"),
    );
    let header = ["void_tracking", "strain", "pressure_pa", "vertical_pressure_pa", "opened"];
    outcome
        .tables
        .push(("drucker_prager_point_opening".into(), named_csv(&header, &[("void_tracking", &["off", "on"])], rows)));
}

/// Elastic strain energy stored by an increment's stress change, C^-1 : dsigma, as (xx, yy, zz, xy).
fn elastic_strain(law: &DruckerPrager, a: &Stress, b: &Stress) -> [f64; 4] {
    let d = Stress { xx: b.xx - a.xx, yy: b.yy - a.yy, zz: b.zz - a.zz, xy: b.xy - a.xy };
    let m = d.mean();
    let (two_g, three_k) = (2.0 * law.elastic.shear, 3.0 * law.elastic.bulk);
    let normal = |s: f64| (s - m) / two_g + m / three_k;
    [normal(d.xx), normal(d.yy), normal(d.zz), d.xy / two_g]
}

/// Random strain paths: never outside the cone, never negative dissipation, nothing from nothing.
fn random_paths(fault: &Fault, outcome: &mut Outcome) {
    let mut random = Lcg::new(2024);
    let (mut outside, mut dissipation, mut change) = (0.0f64, 0.0f64, 0.0f64);
    let (mut plastic_steps, mut pressed_open) = (0u32, 0.0f64);
    for path in 0..400 {
        let cohesion = if path % 2 == 0 { 0.0 } else { 1e3 };
        let psi = [0.0, 0.1, PHI][path % 3];
        let law = DruckerPrager { void_tracking: path % 5 != 0, ..law(CONES[path % 4], psi, cohesion, 0.3, fault) };
        let mut state = PointState::default();
        let size = 1e-4 * libm::pow(10.0, 2.0 * random.unit());
        for _ in 0..100 {
            let d = strain(size * random.signed(), size * (random.signed() - 0.2), size * random.signed());
            let before = state;
            law.update(&mut state, &d);
            let s = state.stress;
            let scale = SAND.young * size;
            outside = outside.max((s.j2().sqrt() + law.friction * s.mean() - law.cohesion) / scale);
            let e = elastic_strain(&law, &before.stress, &s);
            // Stress at the end times the plastic strain of the step: the dissipation of the backward Euler scheme.
            let work = s.xx * (d.xx - e[0]) + s.yy * (d.yy - e[1]) - s.zz * e[2] + 2.0 * s.xy * (d.xy - e[3]);
            dissipation = dissipation.min(work / (scale * size));
            if s.mean() < -1e-12 * (SAND.young + s.j2().sqrt()) {
                pressed_open = pressed_open.max(state.opened / size);
            }
            plastic_steps += u32::from(state.plastic_shear > before.plastic_shear);
            let mut again = state;
            law.update(&mut again, &Increment::default());
            let t = again.stress;
            change = change.max(((t.xx - s.xx).abs() + (t.yy - s.yy).abs() + (t.zz - s.zz).abs()) / scale);
        }
    }
    let paths = "400 random paths of 100 steps, four cones, three dilatancies, with and without cohesion and tracking";
    for (what, measured, bound, source) in [
        ("yield function after a step, over E de", outside, 1e-12, "f <= 0"),
        ("negative dissipation of a step, over E de^2", -dissipation, 1e-11, "second law"),
        ("opened strain under pressure, over de", pressed_open, 1e-12, "opened material carries no pressure"),
        ("stress change without strain, over E de", change, 1e-11, "the return map is idempotent"),
    ] {
        outcome.check(
            Check::at_most(format!("random paths: {what}"), measured, bound, "1")
                .because("round-off relative to the trial stress; stresses reach some hundred times E de")
                .from(Kind::Conservation, format!("{source}; {paths}")),
        );
    }
    outcome.check(
        Check::new(
            "random paths: share of plastic steps",
            f64::from(plastic_steps) / 40_000.0,
            checkdam::check::Expected::Within(0.1, 1.0),
            "1",
        )
        .because("a guard: paths that stay elastic would prove nothing")
        .from(Kind::Analytic, "the scene"),
    );
}

/// The same biaxial path in steps of different size: stress on the way to failure and at 3 % strain.
fn step_size(fault: &Fault, outcome: &mut Outcome) {
    let law = law(Cone::PlaneStrain, 0.1, 0.0, 0.3, fault);
    let p = 1e3;
    let end = |steps: u32, strain_yy: f64| {
        let stress = Stress { xx: -p, yy: -p, zz: -p, xy: 0.0 };
        let mut state = PointState { stress, ..PointState::default() };
        let mut last = 0.0;
        for _ in 0..steps {
            last =
                drive(&law, &mut state, last, |e| strain(e, -strain_yy / f64::from(steps), 0.0), |s| s.stress.xx + p);
        }
        -state.stress.yy
    };
    let fine = end(2000, 0.03);
    for steps in [20, 200] {
        outcome.check(
            Check::value(format!("biaxial failure load in {steps} steps against 2000"), end(steps, 0.03), fine, "Pa")
                .within(
                    Tolerance::Relative(1e-4),
                    "failure does not depend on the path; backward Euler errs on the way there only",
                )
                .from(Kind::Convergence, "the same law in finer steps"),
        );
    }
    let reference = end(12_800, 0.003);
    let errors = [200, 400, 800].map(|n| (end(n, 0.003) - reference).abs());
    for pair in errors.windows(2) {
        outcome.check(
            Check::new(
                "biaxial load at 0.3 % strain, shortly after yield: observed order in the step",
                checkdam::theory::order::from_errors(pair[0], pair[1], 2.0),
                checkdam::check::Expected::AtLeast(0.8),
                "1",
            )
            .because("the return map is backward Euler, first order; a fifth of margin for where the yield point falls in a step")
            .from(Kind::Convergence, "Simo and Hughes 1998"),
        );
    }
}
