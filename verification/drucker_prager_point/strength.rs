//! Strength: meridians, plane strain, simple shear, at rest, cohesion, apex.

use super::super::report::named_csv;
use super::{Case, Fault, Outcome, PHI, SAND, drive, law, law_at, strain};
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::constitutive::{Cone, DruckerPrager, Increment, Law, PointState, Stress};
use checkdam::theory::drucker_prager as theory;

const ITERATED: &str =
    "the path ends in the state of failure, approached exponentially; the stress is iterated to 1e-6 Pa";
const RADIAL: &str = "the path is straight from zero stress, so that the return is exact at any step";

fn cases() -> Vec<Case> {
    let ten = 10f64.to_radians();
    vec![
        Case { name: "outer cone", cone: Cone::TriaxialCompression, psi: 0.0 },
        Case { name: "outer cone, psi 10 deg", cone: Cone::TriaxialCompression, psi: ten },
        Case { name: "outer cone, associated", cone: Cone::TriaxialCompression, psi: PHI },
        Case { name: "inner cone", cone: Cone::TriaxialExtension, psi: 0.0 },
        Case { name: "inner cone, psi 10 deg", cone: Cone::TriaxialExtension, psi: ten },
        Case { name: "plane-strain cone", cone: Cone::PlaneStrain, psi: 0.0 },
        Case { name: "plane-strain cone, psi 10 deg", cone: Cone::PlaneStrain, psi: ten },
        Case { name: "plane-strain cone, associated", cone: Cone::PlaneStrain, psi: PHI },
        Case { name: "cone as printed", cone: Cone::AsPrinted, psi: 0.0 },
    ]
}

/// Slopes of cone and potential as the theory has them.
fn slopes(case: &Case) -> (f64, f64) {
    match case.cone {
        Cone::TriaxialCompression => (theory::outer_slope(PHI), theory::outer_slope(case.psi)),
        Cone::TriaxialExtension => (theory::inner_slope(PHI), theory::inner_slope(case.psi)),
        Cone::AsPrinted => (theory::outer_slope(PHI) / 3.0, theory::outer_slope(case.psi) / 3.0),
        // Chosen so that failure in plane strain is Mohr-Coulomb's: checked below, not assumed.
        Cone::PlaneStrain => {
            let q_psi = theory::plane_strain_potential(case.psi);
            (theory::plane_strain_slope(PHI, q_psi), q_psi)
        }
    }
}

/// The law without the constant that the printed cone adds, so that ratios are ratios.
fn cohesionless(case: &Case, poisson: f64, fault: &Fault) -> DruckerPrager {
    let mut law = law(case.cone, case.psi, 0.0, poisson, fault);
    law.cohesion = 0.0;
    law.tension_cutoff = 0.0;
    law
}

pub fn run(fault: &Fault, outcome: &mut Outcome) {
    let mut rows = Vec::new();
    for (index, case) in cases().iter().enumerate() {
        let (q, q_psi) = slopes(case);
        let biaxial = biaxial(case, fault);
        let (shear, dilatancy) = simple_shear(case, fault);
        let rest = at_rest(case, fault);
        let expected = [
            theory::plane_strain_ratio(q, q_psi),
            theory::simple_shear_ratio(q, q_psi),
            theory::oedometric_ratio(0.3, q),
        ];
        let quantities = [
            ("biaxial, sigma_1/sigma_3 at failure", biaxial, expected[0]),
            ("simple shear, tau/sigma_n at failure", shear, expected[1]),
        ];
        for (what, measured, exact) in quantities {
            outcome.check(
                Check::value(format!("{}: {what}", case.name), measured, exact, "1")
                    .within(Tolerance::Relative(1e-5), ITERATED)
                    .from(Kind::Analytic, "Davis 1968; plane strain of the cone"),
            );
        }
        if case.psi > 0.0 {
            outcome.check(
                Check::value(
                    format!("{}: dilatancy angle in simple shear", case.name),
                    dilatancy.to_degrees(),
                    theory::simple_shear_dilatancy(q_psi).to_degrees(),
                    "deg",
                )
                .within(Tolerance::Absolute(1e-3), ITERATED)
                .from(Kind::Analytic, "flow rule with no strain along the shear plane"),
            );
        } else {
            outcome.check(
                Check::value(format!("{}: coefficient at rest", case.name), rest, expected[2], "1")
                    .within(Tolerance::Relative(1e-9), RADIAL)
                    .from(Kind::Analytic, "nu/(1 - nu), or the cone's (sqrt 3 - q)/(sqrt 3 + 2 q)"),
            );
        }
        rows.push(vec![index as f64, q, q_psi, biaxial, expected[0], shear, expected[1], rest, expected[2]]);
    }
    let names: Vec<&str> = cases().iter().map(|c| c.name).collect();
    let header = [
        "case",
        "q",
        "q_psi",
        "biaxial_ratio",
        "biaxial_ratio_exact",
        "simple_shear_ratio",
        "simple_shear_ratio_exact",
        "at_rest",
        "at_rest_without_dilatancy",
    ];
    outcome.tables.push(("drucker_prager_point_strength".into(), named_csv(&header, &[("case", &names)], rows)));
    angles(fault, outcome);
    mohr_coulomb(fault, outcome);
    meridians(fault, outcome);
    cohesive(fault, outcome);
}

/// The friction angle in plane strain that a cone really has, against the one that it was given, without dilatancy.
fn angles(fault: &Fault, outcome: &mut Outcome) {
    type Slope = fn(f64) -> f64;
    let cones: [(&str, Cone, Slope); 4] = [
        ("outer cone", Cone::TriaxialCompression, theory::outer_slope),
        ("inner cone", Cone::TriaxialExtension, theory::inner_slope),
        ("plane-strain cone", Cone::PlaneStrain, libm::sin),
        ("cone as printed", Cone::AsPrinted, |phi| theory::outer_slope(phi) / 3.0),
    ];
    let mut rows = Vec::new();
    for (index, (name, cone, slope)) in cones.into_iter().enumerate() {
        for degrees in [20.0f64, 25.0, 31.0, 35.0] {
            let phi = degrees.to_radians();
            let mut law = law_at(phi, cone, 0.0, 0.0, 0.3, fault);
            (law.cohesion, law.tension_cutoff) = (0.0, 0.0);
            let angle = theory::angle_of_ratio(compressed(&law)).to_degrees();
            let exact = theory::plane_strain_angle(slope(phi), 0.0).to_degrees();
            rows.push(vec![index as f64, degrees, angle, exact]);
            if degrees == 31.0 {
                outcome.check(
                    Check::value(format!("{name} given 31 deg: friction angle in plane strain"), angle, exact, "deg")
                        .within(Tolerance::Absolute(1e-3), ITERATED)
                        .from(Kind::Analytic, "sin = q at constant volume, Davis 1968"),
                );
            }
        }
    }
    let header = ["cone", "friction_angle_deg", "plane_strain_angle_deg", "plane_strain_angle_exact_deg"];
    let names = cones.map(|c| c.0);
    outcome.tables.push(("drucker_prager_point_angles".into(), named_csv(&header, &[("cone", &names)], rows)));
}

fn biaxial(case: &Case, fault: &Fault) -> f64 {
    compressed(&cohesionless(case, 0.3, fault))
}

/// Compression along y at a constant confining pressure along x, until nothing changes any more.
fn compressed(law: &DruckerPrager) -> f64 {
    let p = 1e3;
    let mut state = PointState { stress: Stress { xx: -p, yy: -p, zz: -p, xy: 0.0 }, ..PointState::default() };
    let mut last = 0.0;
    for _ in 0..8000 {
        last = drive(law, &mut state, last, |e| strain(e, -2e-5, 0.0), |s| s.stress.xx + p);
    }
    state.stress.yy / state.stress.xx
}

/// Simple shear at a constant normal stress along y: shear over normal stress, dilatancy angle.
fn simple_shear(case: &Case, fault: &Fault) -> (f64, f64) {
    let law = cohesionless(case, 0.3, fault);
    let p = 1e3;
    let mut state = PointState { stress: Stress { xx: -p, yy: -p, zz: -p, xy: 0.0 }, ..PointState::default() };
    let (mut last, shear) = (0.0, 1e-5);
    for _ in 0..20_000 {
        last = drive(&law, &mut state, last, |e| strain(0.0, e, shear), |s| s.stress.yy + p);
    }
    (state.stress.xy / -state.stress.yy, libm::atan(last / (2.0 * shear)))
}

/// Confined compression from zero stress: lateral over vertical stress.
fn at_rest(case: &Case, fault: &Fault) -> f64 {
    let law = cohesionless(case, 0.3, fault);
    let mut state = PointState::default();
    for _ in 0..50 {
        law.update(&mut state, &strain(0.0, -1e-4, 0.0));
    }
    state.stress.xx / state.stress.yy
}

/// The plane-strain cone is Mohr-Coulomb in plane strain for every dilatancy.
fn mohr_coulomb(fault: &Fault, outcome: &mut Outcome) {
    for degrees in [0.0f64, 5.0, 15.0, 31.0] {
        let case = Case { name: "", cone: Cone::PlaneStrain, psi: degrees.to_radians() };
        let angle = theory::angle_of_ratio(biaxial(&case, fault)).to_degrees();
        outcome.check(
            Check::value(
                format!("plane-strain cone, psi {degrees} deg: friction angle in biaxial compression"),
                angle,
                31.0,
                "deg",
            )
            .within(Tolerance::Absolute(1e-3), ITERATED)
            .from(Kind::Analytic, "Mohr-Coulomb at the same angle"),
        );
    }
}

/// Triaxial stress paths by confined compression and unloading, at a Poisson's ratio low enough for the cone to be met.
fn meridians(fault: &Fault, outcome: &mut Outcome) {
    let (outer, inner) = (theory::outer_slope(PHI), theory::inner_slope(PHI));
    let associated = theory::plane_strain_slope(PHI, theory::plane_strain_potential(PHI));
    for (name, cone, psi, q, compression, extension) in [
        ("outer cone", Cone::TriaxialCompression, 0.0, outer, Some(31.0), None),
        ("outer cone, associated", Cone::TriaxialCompression, PHI, outer, Some(31.0), None),
        ("inner cone", Cone::TriaxialExtension, 0.0, inner, None, Some(31.0)),
        ("inner cone, associated", Cone::TriaxialExtension, PHI, inner, None, Some(31.0)),
        ("plane-strain cone", Cone::PlaneStrain, 0.0, libm::sin(PHI), None, None),
        ("plane-strain cone, associated", Cone::PlaneStrain, PHI, associated, None, None),
        ("cone as printed", Cone::AsPrinted, 0.0, outer / 3.0, None, None),
    ] {
        let law = cohesionless(&Case { name, cone, psi }, 0.2, fault);
        let mut state = PointState::default();
        for _ in 0..50 {
            law.update(&mut state, &strain(0.0, -1e-4, 0.0));
        }
        let loaded = state.stress.yy / state.stress.xx;
        // Unload along y until the stress path has turned through the other meridian.
        while state.stress.yy < -1.0 && state.stress.xx / state.stress.yy < theory::extension_ratio(q) * (1.0 - 1e-9) {
            law.update(&mut state, &strain(0.0, 1e-6, 0.0));
        }
        let unloaded = state.stress.xx / state.stress.yy;
        for (what, ratio, exact, angle) in [
            ("compression", loaded, theory::compression_ratio(q), compression),
            ("extension", unloaded, theory::extension_ratio(q), extension),
        ] {
            outcome.check(
                Check::value(format!("{name}: stress ratio in triaxial {what}"), ratio, exact, "1")
                    .within(
                        Tolerance::Relative(1e-6),
                        "on the cone after the first plastic step; the stresses are 1 Pa or more",
                    )
                    .from(Kind::Analytic, "Drucker and Prager 1952"),
            );
            if let Some(angle) = angle {
                outcome.check(
                    Check::value(
                        format!("{name}: friction angle in triaxial {what}"),
                        theory::angle_of_ratio(ratio).to_degrees(),
                        angle,
                        "deg",
                    )
                    .within(Tolerance::Absolute(1e-4), "where this cone is matched to Mohr-Coulomb")
                    .from(Kind::Analytic, "Mohr-Coulomb at the same angle"),
                );
            }
        }
    }
}

/// Unconfined strength, apex, cut-off.
fn cohesive(fault: &Fault, outcome: &mut Outcome) {
    let c = 2e3;
    let plane_strain = law(Cone::PlaneStrain, 0.0, c, 0.3, fault);
    let mut state = PointState::default();
    let mut last = 0.0;
    for _ in 0..8000 {
        last = drive(&plane_strain, &mut state, last, |e| strain(e, -2e-5, 0.0), |s| s.stress.xx);
    }
    let strength = 2.0 * c * libm::cos(PHI) / (1.0 - libm::sin(PHI));
    outcome.check(
        Check::value("plane-strain cone, c = 2 kPa: unconfined strength", -state.stress.yy, strength, "Pa")
            .within(Tolerance::Relative(1e-5), ITERATED)
            .from(Kind::Analytic, "Mohr-Coulomb: 2 c cos / (1 - sin)"),
    );
    for (name, cone) in [
        ("outer cone", Cone::TriaxialCompression),
        ("inner cone", Cone::TriaxialExtension),
        ("plane-strain cone", Cone::PlaneStrain),
    ] {
        for (cut, limit) in [(f64::INFINITY, c / libm::tan(PHI)), (500.0, 500.0)] {
            // Without tracking: with it, material that comes apart loses its tension.
            let mut law = DruckerPrager { void_tracking: false, ..law(cone, 0.1, c, 0.3, fault) };
            law.tension_cutoff = law.tension_cutoff.min(cut);
            let mut state = PointState::default();
            for _ in 0..200 {
                // Not purely volumetric: the shear must go as well.
                law.update(&mut state, &Increment { xx: 1.2e-4, yy: 0.9e-4, xy: 0.2e-4, ..Increment::default() });
            }
            let at = if cut.is_finite() { "at the cut-off of 500 Pa" } else { "at the apex" };
            outcome.check(
                Check::value(format!("{name}, c = 2 kPa: mean stress {at}"), state.stress.mean(), limit, "Pa")
                    .within(Tolerance::Relative(1e-12), "the return to the apex or cut-off is explicit")
                    .from(Kind::Analytic, "c cot(phi), or the cut-off"),
            );
            if !cut.is_finite() {
                outcome.check(
                    Check::at_most(
                        format!("{name}, c = 2 kPa: shear {at}"),
                        state.stress.j2().sqrt() / SAND.young,
                        1e-12,
                        "1",
                    )
                    .because("round-off of stresses of kPa over Young's modulus")
                    .from(Kind::Analytic, "the apex has no deviator"),
                );
            }
        }
    }
}
