//! Laws that flow, other than a plain cone, at one point: Mohr-Coulomb, friction that softens, von Mises with hardening and viscosity, and
//! mu(I).
//!
//! Strains are prescribed, as in `drucker_prager_point`; where a stress is, the strain along it is found by secant iteration.

use super::drucker_prager_point::{drive, strain};
use super::report::{named_csv, table_csv};
use super::{Fault, FaultKind, Outcome, Rung, RungFailure};
use crate::figure::{Figure, curves, exact, measured};
use crate::of_module;
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::constitutive::{
    AnyLaw, Cone, DruckerPrager, Increment, Law, LinearElastic, MohrCoulomb, MuI, PointState, Softening, Stress,
    VonMises,
};
use checkdam::plot::curves::Curves;
use checkdam::theory::mu_i::MuI as Beads;
use checkdam::theory::{elastic::Elastic, mohr_coulomb as theory};

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "One material point of Mohr-Coulomb, of friction that softens, of von Mises with viscosity, of mu(I)",
    goal: "Each law has the strength of its closed form: on every edge, on the way to the critical state, at every rate",
    source: "Davis 1968; Hill 1950; Perzyna 1966; Jop, Forterre and Pouliquen 2006",
    sketch: r"
       ____            tau   peak            mu    ____ mu_2
      /    \            |   /\ critical       |  /
     / o    \  corners  |  /  \________       | /
     \  ____/           | /                   |/ mu_s
      \/                |/______ gamma        |________ I
",
    run,
    covers: &[(FaultKind::Friction, 1.02), (FaultKind::Modulus, 1.02)],
    under_fault: "all",
    figures: &[SOFTENING, RATES],
};

const SOFTENING: Figure = curves(
    "law_points_softening",
    "law_points_softening_plot",
    Curves {
        x: "gamma",
        x_title: "shear strain",
        y_title: "shear stress over pressure",
        curves: &[measured("ratio", ""), exact("ratio_exact", "closed form")],
        split: &[("law", "")],
        ..Curves::LINEAR
    },
);

const RATES: Figure = curves(
    "law_points_mu_i",
    "law_points_mu_i_plot",
    Curves {
        x: "inertial_number",
        x_title: "inertial number",
        y_title: "shear stress over pressure",
        curves: &[measured("friction", "steady shear"), exact("friction_exact", "mu(I)")],
        ..Curves::LINEAR
    },
);

const SAND: Elastic = Elastic { young: 1e6, poisson: 0.3 };
/// Friction angle, rad.
const PHI: f64 = 31.0 * std::f64::consts::PI / 180.0;
/// Of the critical state, rad.
const CRITICAL: f64 = 26.0 * std::f64::consts::PI / 180.0;
/// Equivalent plastic shear strain over which it softens.
const OVER: f64 = 0.02;
/// Glass beads of Jop, Forterre and Pouliquen (2006).
const BEADS: Beads = Beads { least: 0.3819, most: 0.6435, half_way: 0.279, diameter: 5.3e-4, grain_density: 2450.0 };

const ITERATED: &str =
    "the path ends in the state of failure, approached exponentially; the stress is iterated to 1e-6 Pa";
const ROUND_OFF: &str = "the return is exact in any step: round-off";

fn elastic(poisson: f64, fault: &Fault) -> LinearElastic {
    LinearElastic::new(SAND.young * fault.modulus, poisson)
}

/// Mohr-Coulomb, with the fault in the sine of its angle.
fn pyramid(psi: f64, cohesion: f64, poisson: f64, fault: &Fault) -> MohrCoulomb {
    let mut law = MohrCoulomb::new(elastic(poisson, fault), PHI, psi, cohesion, f64::INFINITY, true);
    law.friction *= fault.friction;
    law.tension_cutoff = law.cohesion / law.friction;
    law
}

fn pressed(p: f64) -> PointState {
    PointState { stress: Stress { xx: -p, yy: -p, zz: -p, xy: 0.0 }, ..PointState::default() }
}

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let mut outcome = Outcome::default();
    failure(fault, &mut outcome);
    meridians(fault, &mut outcome);
    softening(fault, &mut outcome);
    von_mises(fault, &mut outcome);
    rates(fault, &mut outcome);
    Ok(outcome)
}

/// Mohr-Coulomb at failure in the plane, at several angles of dilatancy.
fn failure(fault: &Fault, outcome: &mut Outcome) {
    let mut rows = Vec::new();
    let p = 1e3;
    for degrees in [0.0f64, 10.0, 31.0] {
        let psi = degrees.to_radians();
        let law = pyramid(psi, 0.0, SAND.poisson, fault);
        let (mut state, mut last) = (pressed(p), 0.0);
        for _ in 0..4000 {
            last = drive(&law, &mut state, last, |e| strain(e, -2e-5, 0.0), |s| s.stress.xx + p);
        }
        let biaxial = state.stress.yy / state.stress.xx;
        let (mut state, mut last) = (pressed(p), 0.0);
        let step = 1e-5;
        for _ in 0..10_000 {
            last = drive(&law, &mut state, last, |e| strain(0.0, e, step), |s| s.stress.yy + p);
        }
        let (shear, gained) = (state.stress.xy / -state.stress.yy, libm::atan(last / (2.0 * step)));
        let free = pyramid(psi, 500.0, SAND.poisson, fault);
        let (mut state, mut last) = (PointState::default(), 0.0);
        for _ in 0..4000 {
            last = drive(&free, &mut state, last, |e| strain(e, -2e-5, 0.0), |s| s.stress.xx);
        }
        let strength = -state.stress.yy;
        let expected =
            [theory::passive_ratio(PHI), theory::simple_shear_ratio(PHI, psi), theory::unconfined_strength(PHI, 500.0)];
        for (what, found, exact, unit) in [
            ("biaxial, sigma_1/sigma_3 at failure", biaxial, expected[0], "1"),
            ("simple shear, tau/sigma_n at failure", shear, expected[1], "1"),
            ("unconfined strength of 500 Pa of cohesion", strength, expected[2], "Pa"),
        ] {
            outcome.check(
                Check::value(format!("Mohr-Coulomb, psi {degrees} deg: {what}"), found, exact, unit)
                    .within(Tolerance::Relative(1e-5), ITERATED)
                    .from(Kind::Analytic, "Davis 1968; Terzaghi 1943"),
            );
        }
        outcome.check(
            Check::value(
                format!("Mohr-Coulomb, psi {degrees} deg: dilatancy angle in simple shear"),
                gained.to_degrees(),
                degrees,
                "deg",
            )
            .within(Tolerance::Absolute(1e-3), ITERATED)
            .from(Kind::Analytic, "flow rule with no strain along the shear plane"),
        );
        rows.push(vec![degrees, biaxial, expected[0], shear, expected[1], gained.to_degrees(), strength, expected[2]]);
    }
    let header = [
        "dilatancy_deg",
        "biaxial_ratio",
        "biaxial_ratio_exact",
        "simple_shear_ratio",
        "simple_shear_ratio_exact",
        "simple_shear_dilatancy_deg",
        "unconfined_strength_pa",
        "unconfined_strength_exact_pa",
    ];
    outcome.tables.push(("law_points_failure".into(), table_csv(&header, rows)));
}

/// Mohr-Coulomb where two principal stresses are the same: its edges, and its apex.
fn meridians(fault: &Fault, outcome: &mut Outcome) {
    let ratio = theory::passive_ratio(PHI);
    for psi in [0.0, PHI] {
        let law = pyramid(psi, 0.0, 0.1, fault);
        let mut state = PointState::default();
        let mut ratios = Vec::new();
        for (steps, xx, yy) in [(50, 0.0, -1e-4), (47, 0.0, 1e-4)] {
            (0..steps).for_each(|_| {
                law.update(&mut state, &strain(xx, yy, 0.0));
            });
            ratios.push(state.stress.yy / state.stress.xx);
        }
        let mut both = PointState::default();
        (0..50).for_each(|_| {
            law.update(&mut both, &strain(-1e-4, -1e-4, 0.0));
        });
        ratios.push(both.stress.xx / both.stress.zz);
        let paths = [
            ("triaxial compression (pressed)", ratio),
            ("triaxial extension (unloaded)", 1.0 / ratio),
            ("least pressure across the plane", ratio),
        ];
        for ((what, exact), found) in paths.into_iter().zip(ratios) {
            outcome.check(
                Check::value(
                    format!("Mohr-Coulomb, psi {:.0} deg, {what}: stress ratio", psi.to_degrees()),
                    found,
                    exact,
                    "1",
                )
                .within(Tolerance::Relative(1e-9), ROUND_OFF)
                .from(Kind::Analytic, "(1 + sin phi)/(1 - sin phi), on every edge"),
            );
        }
    }
    let law = pyramid(0.1, 500.0, 0.3, fault);
    let mut state = PointState::default();
    law.update(&mut state, &strain(0.01, 0.02, 0.01));
    // Torn material has no tensile strength left; without tracking the apex stays.
    let kept = MohrCoulomb { void_tracking: false, ..law };
    let mut held = PointState::default();
    kept.update(&mut held, &strain(0.01, 0.02, 0.01));
    for (what, found, exact) in [
        ("torn, with void tracking: mean stress", state.stress.mean(), 0.0),
        ("at the apex, without void tracking: mean stress", held.stress.mean(), theory::apex(PHI, 500.0)),
        ("at the apex: root of J2", held.stress.j2().sqrt(), 0.0),
    ] {
        outcome.check(
            Check::value(format!("Mohr-Coulomb, {what}"), found, exact, "Pa")
                .within(Tolerance::Absolute(1e-6), ROUND_OFF)
                .from(Kind::Analytic, "c cot(phi)"),
        );
    }
}

/// Simple shear at constant volume on the way from the peak to the critical state.
fn softening(fault: &Fault, outcome: &mut Outcome) {
    let p = 1e4;
    let (peak, critical) = (libm::sin(PHI), libm::sin(CRITICAL));
    let stiff = elastic(SAND.poisson, fault);
    let cone = |phi| DruckerPrager::new(stiff, Cone::PlaneStrain, phi, 0.0, 0.0, 0.0, true);
    let mut of_cone = Softening { peak: cone(PHI), critical: cone(CRITICAL).friction * fault.friction, over: OVER };
    of_cone.peak.friction *= fault.friction;
    let of_pyramid =
        Softening { peak: pyramid(0.0, 0.0, SAND.poisson, fault), critical: critical * fault.friction, over: OVER };
    let laws = [AnyLaw::SofteningDruckerPrager(of_cone), AnyLaw::SofteningMohrCoulomb(of_pyramid)];
    let names = ["Drucker-Prager", "Mohr-Coulomb"];
    // Of simple shear, the equivalent strain is gamma / sqrt(3).
    let over = OVER * 3f64.sqrt();
    let (points, steps) = (40, 100);
    let increment = 0.06 / f64::from(points * steps);
    // The share of a step lags by the plastic shear of that step, which is larger than its strain by k/(k - h).
    let stiffness = SAND.shear() / p;
    let fall = (peak - critical) / over;
    let lag = fall * increment * stiffness / (stiffness - fall);
    let mut rows = Vec::new();
    for (k, (law, name)) in laws.iter().zip(names).enumerate() {
        let (mut state, mut worst) = (pressed(p), 0.0f64);
        for point in 1..=points {
            (0..steps).for_each(|_| {
                law.update(&mut state, &strain(0.0, 0.0, 0.5 * increment));
            });
            let gamma = f64::from(point * steps) * increment;
            let found = state.stress.xy / p;
            let exact = theory::softened_ratio(gamma, stiffness, peak, peak - critical, over);
            worst = worst.max((found - exact).abs());
            rows.push(vec![k as f64, gamma, found, exact]);
        }
        outcome.check(
            Check::at_most(format!("{name} that softens: largest difference of tau/p to the closed form"), worst, 1.5 * lag, "1")
                .because("strength is that of the plastic shear at the start of a step: one step behind, and half of one for its begin")
                .from(Kind::Analytic, "bilinear descent at constant volume"),
        );
        outcome.check(
            Check::value(
                format!("{name} that softens: tau/p in the critical state"),
                state.stress.xy / p,
                critical,
                "1",
            )
            .within(Tolerance::Relative(1e-9), ROUND_OFF)
            .from(Kind::Analytic, "sin of the critical friction angle"),
        );
    }
    let header = ["law", "gamma", "ratio", "ratio_exact"];
    outcome.tables.push(("law_points_softening".into(), named_csv(&header, &[("law", &names)], rows)));
}

/// Hardening without a rate, and steady shear with one.
fn von_mises(fault: &Fault, outcome: &mut Outcome) {
    let law = VonMises { elastic: elastic(SAND.poisson, fault), strength: 2e3, hardening: 1e5, viscosity: 0.0 };
    let (g, h) = (SAND.shear(), law.hardening);
    let gamma = 0.2;
    let mut state = PointState::default();
    (0..10).for_each(|_| {
        law.update(&mut state, &strain(0.0, 0.0, 0.05 * gamma));
    });
    outcome.check(
        Check::value(
            "von Mises that hardens: shear stress",
            state.stress.xy,
            2e3 + g * h / (g + h) * (gamma - 2e3 / g),
            "Pa",
        )
        .within(Tolerance::Relative(1e-9), ROUND_OFF)
        .from(Kind::Analytic, "bilinear curve, Hill 1950"),
    );
    let fluid = VonMises { hardening: 0.0, viscosity: 50.0, ..law };
    for rate in [1.0, 20.0, 400.0] {
        let dt = 1e-3 / rate;
        let mut state = pressed(1e3);
        let d = Increment { dt, xy: 0.5 * rate * dt, ..Increment::default() };
        (0..1000).for_each(|_| {
            fluid.update(&mut state, &d);
        });
        outcome.check(
            Check::value(
                format!("von Mises with viscosity, {rate} per second: shear stress"),
                state.stress.xy,
                2e3 + 50.0 * rate,
                "Pa",
            )
            .within(
                Tolerance::Relative(1e-6),
                "steady after a strain of 1, many times what the stress needs to build up",
            )
            .from(Kind::Analytic, "Bingham: strength and viscosity times rate"),
        );
    }
}

/// Steady simple shear of mu(I) under several pressures and at several rates.
fn rates(fault: &Fault, outcome: &mut Outcome) {
    let friction = [BEADS.least, BEADS.most].map(|mu| mu * fault.friction);
    let law =
        MuI::new(elastic(SAND.poisson, fault), friction, BEADS.half_way, BEADS.diameter, BEADS.grain_density, true);
    let mut rows = Vec::new();
    for pressure in [200.0, 2000.0] {
        for rate in [1.0, 30.0, 100.0, 300.0, 1000.0, 3000.0] {
            let dt = 1e-4 / rate;
            let mut state = pressed(pressure);
            let d = Increment { dt, xy: 0.5 * rate * dt, ..Increment::default() };
            (0..5000).for_each(|_| {
                law.update(&mut state, &d);
            });
            let number = BEADS.number(rate, pressure);
            let found = state.stress.xy / pressure;
            rows.push(vec![number, pressure, rate, found, BEADS.friction(number)]);
            outcome.check(
                Check::value(format!("mu(I), {pressure} Pa, {rate} per second: tau/p"), found, BEADS.friction(number), "1")
                    .within(
                        Tolerance::Relative(1e-6),
                        "steady after a strain of 0.5, many times what the stress needs to build up; the step does not matter then",
                    )
                    .from(Kind::Analytic, "Jop, Forterre and Pouliquen 2006"),
            );
        }
    }
    rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let header = ["inertial_number", "pressure_pa", "rate_per_s", "friction", "friction_exact"];
    outcome.tables.push(("law_points_mu_i".into(), table_csv(&header, rows)));
}
