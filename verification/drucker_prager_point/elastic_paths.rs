//! The Jaumann rate: simple shear to large angles, rigid rotation of a stressed point.

use super::super::report::table_csv;
use super::{Fault, Outcome, PHI, SAND};
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::constitutive::{Cone, DruckerPrager, Increment, Law, LinearElastic, PointState, Stress};
use checkdam::theory::{jaumann, order};

pub fn run(fault: &Fault, outcome: &mut Outcome) {
    let elastic = LinearElastic::new(SAND.young * fault.modulus, SAND.poisson);
    // So much cohesion that it stays elastic: the plastic law must turn stress in the same way.
    let strong = DruckerPrager::new(elastic, Cone::PlaneStrain, PHI, 0.0, 1e9, f64::INFINITY, true);
    let mut rows = Vec::new();
    simple_shear("elastic", &elastic, outcome, &mut rows);
    simple_shear("Drucker-Prager below yield", &strong, outcome, &mut Vec::new());
    let header = ["gamma", "sigma_xy_pa", "sigma_xy_exact_pa", "sigma_xx_pa", "sigma_xx_exact_pa"];
    outcome.tables.push(("drucker_prager_point_jaumann".into(), table_csv(&header, rows)));
    rotation("elastic", &elastic, outcome);
    rotation("Drucker-Prager below yield", &strong, outcome);
}

/// v_x = gamma y to an engineering shear of 2.5, past the peak at pi/2.
fn simple_shear<L: Law>(name: &str, law: &L, outcome: &mut Outcome, rows: &mut Vec<Vec<f64>>) {
    let (gamma, g) = (2.5, SAND.shear());
    let mut errors = Vec::new();
    for steps in [50u32, 100, 200] {
        let d = gamma / f64::from(steps);
        let mut state = PointState::default();
        let mut worst = 0.0f64;
        for k in 1..=steps {
            law.update(&mut state, &Increment { xy: 0.5 * d, spin: -0.5 * d, ..Increment::default() });
            let now = d * f64::from(k);
            let (xy, xx) = (jaumann::shear_stress(g, now), jaumann::normal_stress(g, now));
            let s = state.stress;
            worst = worst.max((s.xy - xy).abs()).max((s.xx - xx).abs()).max((s.yy + xx).abs());
            if steps == 200 && k % 10 == 0 {
                rows.push(vec![now, s.xy, xy, s.xx, xx]);
            }
        }
        errors.push(worst / g);
        if steps == 200 {
            outcome.check(
                Check::value(
                    format!("{name}: shear stress at gamma = 2.5"),
                    state.stress.xy,
                    jaumann::shear_stress(g, gamma),
                    "Pa",
                )
                .within(Tolerance::Relative(1e-4), "second order: gamma dgamma^2 / 12 = 3e-5, three times that")
                .from(Kind::Analytic, "Dienes 1979: G sin(gamma)"),
            );
        }
    }
    outcome.check(
        Check::at_most(format!("{name}: largest error of any stress over G, 200 steps"), errors[2], 1e-4, "1")
            .because("second order: gamma dgamma^2 / 12 = 3e-5, three times that")
            .from(Kind::Analytic, "Dienes 1979: G sin(gamma), G (1 - cos(gamma))"),
    );
    for pair in errors.windows(2) {
        outcome.check(
            Check::value(
                format!("{name}: observed order in the shear step"),
                order::from_errors(pair[0], pair[1], 2.0),
                2.0,
                "1",
            )
            .within(
                Tolerance::Absolute(0.05),
                "second order; a spin that is applied before or after the strain gives 1",
            )
            .from(Kind::Convergence, "Hughes and Winget 1980"),
        );
    }
}

/// A stressed point turns by 0.7 of a revolution.
fn rotation<L: Law>(name: &str, law: &L, outcome: &mut Outcome) {
    let start = Stress { xx: -3e3, yy: -1e3, zz: -1.5e3, xy: 700.0 };
    let angle = 0.7 * 2.0 * std::f64::consts::PI;
    let mut errors = Vec::new();
    for steps in [100u32, 200, 400] {
        let spin = angle / f64::from(steps);
        let mut state = PointState { stress: start, ..PointState::default() };
        for _ in 0..steps {
            law.update(&mut state, &Increment { spin, ..Increment::default() });
        }
        let s = state.stress;
        if steps == 400 {
            let drift = ((s.mean() / start.mean() - 1.0).abs()).max((s.j2() / start.j2() - 1.0).abs());
            outcome.check(
                Check::at_most(format!("{name}: drift of the invariants in 400 rotations"), drift, 1e-13, "1")
                    .because("each rotation is orthogonal to round-off; 800 of 1.1e-16")
                    .from(Kind::Conservation, "Hughes and Winget 1980"),
            );
        }
        let [xx, yy, xy] = jaumann::turned(start.xx, start.yy, start.xy, angle);
        errors.push((s.xx - xx).abs().max((s.yy - yy).abs()).max((s.xy - xy).abs()));
    }
    outcome.check(
        Check::at_most(
            format!("{name}: stress after 0.7 revolutions in 400 steps, error over its size"),
            errors[2] / 3e3,
            1e-4,
            "1",
        )
        .because("each step turns w - w^3/12: angle w^2/12 = 4.4e-5 in all, twice that in the stress")
        .from(Kind::Analytic, "R sigma R^T"),
    );
    for pair in errors.windows(2) {
        outcome.check(
            Check::value(
                format!("{name}: observed order in the rotation step"),
                order::from_errors(pair[0], pair[1], 2.0),
                2.0,
                "1",
            )
            .within(Tolerance::Absolute(0.05), "the Cayley form of a rotation is second order")
            .from(Kind::Convergence, "Hughes and Winget 1980"),
        );
    }
}
