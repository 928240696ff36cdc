//! Active and passive earth pressure: a wall moves out of the fill, or into it, until the fill yields.
//!
//! What the force tends to is a matter of the cone. The one matched in plane strain gives Rankine's coefficients at 31 degrees,
//! 0.320 and 3.124; the one through the compression meridian acts as 45.9 degrees, 0.164 and 6.09. To expect 0.320 of it is
//! the classical false failure; the tables show both numbers.
//!
//! Two kinds of fill. On a *smooth base* the fill stretches equally everywhere: Rankine's state, principal stresses horizontal and
//! vertical, is an exact solution, and force and point of action are judged closely. At constant volume that state is not stable for ever,
//! least of all at 45.9 degrees: slip lines form, and the force leaves the closed form towards the bound named below. So the outer cone is
//! judged by the extreme of the force on the way: actively it gets to the closed form; passively, slip lines stop it at 5.06 instead of
//! 6.09, with 3.80 as the bound. On a *rough base* a wedge breaks out through the toe of the wall. Rankine's field is still in equilibrium,
//! but flow at constant volume does not follow its characteristics. Slip lines turn towards the planes of simple shear, on which the cone
//! has tan(phi*) = sin(phi): 27.25 instead of 31 degrees, 35.7 instead of 45.9 (Davis 1968). So force and angle lie between two bounds.
//! With *associated* flow the characteristics of stress and velocity are the same, and the wedge is Rankine's. Its edge is inclined by 45 +
//! phi/2 on the active side, 45 - phi/2 on the passive one, and is judged closely. The force comes near Rankine's by first order in h and
//! is extrapolated. The toe itself is held by the base, too, which adds or takes about half a cell of pressure where it is greatest. A
//! wedge that slides as one piece does not have Rankine's distribution either: the force acts higher than H/3, which is reported and not
//! judged.
//!
//! A limit load does not depend on stiffness, so the fill may be as stiff as is convenient. Full strength needs more strain than elasticity
//! alone suggests. The cone knows the out-of-plane stress, which tends to the mean of the others as exp(-strain G/tau). That takes a strain
//! of 0.5 % at 1 MPa, and a tenth of it at 10 MPa. Strokes stay below half a cell, within which a wall acts through the same nodes. The
//! wall moves at a 100,000th to a 5,000th of the speed of P-waves, the slower the shorter the fill. A part of the damping that settled the
//! fill stays on. Its force is rho d A V^2 / v for a wedge of area A that moves at V when the wall moves at v. It is below 1 % of the
//! active force and 2 % of the passive one (dilating: 2 %, with V = 2 v).

mod stroke;

use super::report::number;
use super::scene::Material;
use super::{Fault, FaultKind, Outcome, Rung, RungFailure};
use crate::figure::{Figure, curves, exact, measured};
use crate::of_module;
use checkdam::boundary::Friction;
use checkdam::check::{Check, Expected, Kind, Tolerance};
use checkdam::constitutive::Cone;
use checkdam::plot::curves::{Curves, panel};
use checkdam::theory::{drucker_prager, earth_pressure};
use rayon::prelude::*;
use stroke::{GRAVITY, HEIGHT, Moment, PHI, Setup, Stroke};

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "A wall moves out of sand and into it: Rankine and Coulomb coefficients by cone, point of action, wedge angle",
    goal: "Active and passive force of sand on a wall that moves, where it acts, and the edge of the wedge",
    source: "Rankine 1857; Coulomb 1776; Davis 1968 for flow at constant volume",
    sketch: r"
   <- wall ->
          |o o o o o o o o
     H    |o o o o o/ o o     wedge at 45 deg +/- phi/2
   F -->  |o o o / o o o
   H/3    |o o/o o o o o
   -------+----------------   smooth or rough base
",
    run,
    covers: &[
        (FaultKind::Friction, 1.05),
        (FaultKind::Gravity, 1.03),
        (FaultKind::Density, 1.03),
        (FaultKind::ContactForce, 1.03),
    ],
    under_fault: "the smooth base: closed forms without a wedge",
    figures: FIGURES,
};

/// Its figures.
const FIGURES: &[Figure] = &[
    curves(
        "wall_pressure_stroke",
        "wall_pressure_stroke_plot",
        Curves {
            x: "stroke_percent",
            x_title: "stroke / height of the wall (%)",
            y_title: "normal force / (rho g H² / 2)",
            curves: &[
                measured("coefficient", ""),
                exact("coefficient_theory", "closed form of the fill's cone"),
                exact("coefficient_at_31_deg", "Rankine or Coulomb at 31°"),
            ],
            panels: &[
                panel("active, smooth base", &[("side", "active"), ("base", "smooth")]),
                panel("passive, smooth base", &[("side", "passive"), ("base", "smooth")]),
                panel("active, wedge on a rough base", &[("side", "active"), ("base", "rough")]),
                panel("passive, wedge on a rough base", &[("side", "passive"), ("base", "rough")]),
            ],
            split: &[("fill", "")],
            ..Curves::LINEAR
        },
    ),
    curves(
        "wall_pressure_wedge",
        "wall_pressure_wedge_plot",
        Curves {
            x: "height_over_height",
            x_title: "height / height of the wall",
            y_title: "distance / height of the wall",
            curves: &[
                measured("edge_over_height", ""),
                exact("coulomb_over_height", "Coulomb's wedge, smooth wall: 45° ± phi/2"),
                exact("roscoe_over_height", "45° ± psi/2"),
            ],
            panels: &[
                panel("active, constant volume", &[("side", "active"), ("flow", "constant volume")]),
                panel("passive, constant volume", &[("side", "passive"), ("flow", "constant volume")]),
                panel("active, associated flow", &[("side", "active"), ("flow", "associated")]),
                panel("passive, associated flow", &[("side", "passive"), ("flow", "associated")]),
            ],
            split: &[("fill", "")],
            ..Curves::LINEAR
        },
    ),
];

const SOFT: Material = Material::new(1e6, 0.3, 1500.0);
const STIFF: Material = Material::new(1e7, 0.3, 1500.0);
const WALL_FRICTION: f64 = 0.4;

/// On a smooth base.
const ACTIVE: Setup = Setup {
    cone: Cone::PlaneStrain,
    dilatancy: 0.0,
    fill: STIFF,
    wall: Friction::Smooth,
    smooth_base: true,
    along: 4,
    cells: 20,
    stroke: -6e-4,
    mach: 1e-5,
    damping: 0.1,
};
const PASSIVE: Setup = Setup { along: 20, stroke: 4e-3, mach: 1e-4, ..ACTIVE };
/// With a wedge.
const ACTIVE_WEDGE: Setup =
    Setup { fill: SOFT, smooth_base: false, along: 80, cells: 40, stroke: -1.5e-3, mach: 2e-4, ..ACTIVE };
const PASSIVE_WEDGE: Setup = Setup { smooth_base: false, along: 80, stroke: 6e-3, mach: 2e-4, ..PASSIVE };
/// A wedge that dilates moves up to twice as fast as the wall, and waves last longer in it: a slower wall, less damping.
const ACTIVE_ASSOCIATED: Setup = Setup { dilatancy: PHI, mach: 1e-4, ..ACTIVE_WEDGE };
const PASSIVE_ASSOCIATED: Setup = Setup { dilatancy: PHI, mach: 1e-4, damping: 0.05, ..PASSIVE_WEDGE };

/// Sine of the friction angle in plane strain.
fn sine(cone: Cone) -> f64 {
    match cone {
        Cone::TriaxialCompression => drucker_prager::plane_strain_sine(drucker_prager::outer_slope(PHI), 0.0),
        _ => libm::sin(PHI),
    }
}

/// Rankine's coefficient for a stroke in that direction.
fn rankine(angle: f64, stroke: f64) -> f64 {
    if stroke < 0.0 { earth_pressure::rankine_active(angle) } else { earth_pressure::rankine_passive(angle) }
}

/// The force per width at coefficient 1 in the fill as it is built.
fn unit_force() -> f64 {
    earth_pressure::triangular_force(1.0, SOFT.density, GRAVITY, HEIGHT)
}

/// Strength in simple shear, tan(phi*) = sin(phi) cos(psi) / (1 - sin(phi) sin(psi)) (Davis 1968), as an angle: phi itself for
/// associated flow.
fn davis(angle: f64, dilatancy: f64) -> f64 {
    libm::atan(libm::sin(angle) * libm::cos(dilatancy) / (1.0 - libm::sin(angle) * libm::sin(dilatancy)))
}

struct Report {
    outcome: Outcome,
    summary: String,
    curves: String,
    edges: String,
    /// Coefficient of the thrust of the next case on cells twice as large, where that has been run.
    coarse: Option<f64>,
}

/// Side, base, flow and fill of a case.
fn words(setup: &Setup) -> String {
    let side = if setup.stroke < 0.0 { "active" } else { "passive" };
    let base = if setup.smooth_base { "smooth" } else { "rough" };
    let cone = if setup.cone == Cone::PlaneStrain { "plane-strain cone" } else { "outer cone" };
    let flow = if setup.dilatancy > 0.0 { "associated" } else { "constant volume" };
    let psi = if setup.dilatancy > 0.0 { " associated" } else { "" };
    let wall = if setup.wall == Friction::Smooth { "" } else { " on a wall with friction 0.4" };
    format!("{side},{base},{flow},{cone}{psi}{wall}")
}

impl Report {
    fn add(&mut self, name: &str, setup: &Setup, stroke: &Stroke, theory: f64, naive: f64, angle: Option<f64>) {
        self.summarise(name, setup, stroke, theory, naive, angle);
        for m in &stroke.moments {
            let k = m.normal / unit_force();
            let row = [100.0 * m.stroke / HEIGHT, k, theory, naive, m.shear / unit_force(), m.arm / HEIGHT];
            let cells = row.map(number).join(",");
            self.curves += &format!("{name},{},{cells}\n", words(setup));
        }
    }

    fn summarise(&mut self, name: &str, setup: &Setup, stroke: &Stroke, theory: f64, naive: f64, angle: Option<f64>) {
        let end = stroke.end();
        let numbers = |xs: &[f64]| xs.iter().map(|&x| number(x)).collect::<Vec<_>>().join(",");
        let angle = angle.unwrap_or(f64::INFINITY);
        let k = end.normal / unit_force();
        let case = format!("{name},{}", words(setup));
        self.summary += &format!(
            "{case},{}\n",
            numbers(&[HEIGHT / setup.cells as f64, end.stroke / HEIGHT, k, theory, naive, end.arm / HEIGHT, angle])
        );
    }

    /// The edge of what moves, beside planes that are inclined as Coulomb's wedge and as Roscoe's zero extension line, rad.
    fn edge(&mut self, name: &str, setup: &Setup, stroke: &Stroke, planes: [f64; 2]) {
        for [y, x] in stroke.edge() {
            let cells = [y, x, y / libm::tan(planes[0]), y / libm::tan(planes[1])].map(|z| number(z / HEIGHT));
            self.edges += &format!("{name},{},{}\n", words(setup), cells.join(","));
        }
    }
}

/// Turns a stroke into checks.
type Judge = fn(&str, &Setup, &Stroke, &mut Report);

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let mut report = Report {
        outcome: Outcome::default(),
        summary:
            "case,side,base,flow,fill,cell_size_m,stroke_over_height,coefficient,coefficient_theory,coefficient_at_31_deg,\
                  height_of_action_over_height,wedge_angle_deg\n"
                .into(),
        curves: "case,side,base,flow,fill,stroke_percent,coefficient,coefficient_theory,coefficient_at_31_deg,\
                 shear_coefficient,height_of_action_over_height\n"
            .into(),
        coarse: None,
        edges: "case,side,base,flow,fill,height_over_height,edge_over_height,coulomb_over_height,roscoe_over_height\n"
            .into(),
    };
    let outer = Cone::TriaxialCompression;
    let mut cases: Vec<(&str, Setup, Judge)> = vec![
        ("active plane-strain cone", ACTIVE, homogeneous),
        ("passive plane-strain cone", PASSIVE, homogeneous),
        ("active outer cone", Setup { cone: outer, ..ACTIVE }, extreme),
        ("passive outer cone", Setup { cone: outer, ..PASSIVE }, extreme),
    ];
    // The closed forms above notice every fault that is claimed; what follows is bounded more widely.
    if *fault == Fault::NONE {
        cases.extend([
            ("active wedge plane-strain cone", ACTIVE_WEDGE, wedge as Judge),
            ("passive wedge plane-strain cone", PASSIVE_WEDGE, wedge),
            ("active wedge outer cone", Setup { cone: outer, ..ACTIVE_WEDGE }, wedge),
            ("passive wedge outer cone", Setup { cone: outer, along: 100, stroke: 8e-3, ..PASSIVE_WEDGE }, wedge),
            ("active wedge associated on coarse cells", Setup { along: 40, cells: 20, ..ACTIVE_ASSOCIATED }, coarse),
            ("active wedge associated", ACTIVE_ASSOCIATED, wedge),
            ("passive wedge associated on coarse cells", Setup { along: 40, cells: 10, ..PASSIVE_ASSOCIATED }, coarse),
            ("passive wedge associated", PASSIVE_ASSOCIATED, wedge),
            (
                "active wedge with wall friction",
                Setup { wall: Friction::Coulomb(WALL_FRICTION), ..ACTIVE_WEDGE },
                coulomb,
            ),
            (
                "active wedge associated with wall friction on coarse cells",
                Setup { along: 40, cells: 20, wall: Friction::Coulomb(WALL_FRICTION), ..ACTIVE_ASSOCIATED },
                coarse,
            ),
            (
                "active wedge associated with wall friction",
                Setup { wall: Friction::Coulomb(WALL_FRICTION), ..ACTIVE_ASSOCIATED },
                coulomb,
            ),
        ]);
    }
    let strokes: Result<Vec<_>, _> = cases.par_iter().with_max_len(1).map(|(_, setup, _)| setup.run(fault)).collect();
    for ((name, setup, judge), stroke) in cases.iter().zip(strokes?) {
        judge(name, setup, &stroke, &mut report);
    }
    let Report { mut outcome, summary, curves, edges, .. } = report;
    outcome.tables.push(("wall_pressure_summary".into(), summary));
    outcome.tables.push(("wall_pressure_stroke".into(), curves));
    outcome.tables.push(("wall_pressure_wedge".into(), edges));
    Ok(outcome)
}

/// Smooth wall, smooth base: the whole fill yields at once.
fn homogeneous(name: &str, setup: &Setup, stroke: &Stroke, report: &mut Report) {
    let end = stroke.end();
    let k = rankine(libm::asin(sine(setup.cone)), setup.stroke);
    report.add(name, setup, stroke, k, rankine(PHI, setup.stroke), None);
    // At constant volume the fill is as much higher as it is shorter; its weight per length grows with it.
    let length = HEIGHT * setup.along as f64 / setup.cells as f64;
    let height = HEIGHT / (1.0 - end.stroke / length);
    report.outcome.check(
        Check::value(
            format!("{name}, smooth base: force on the wall per width"),
            end.normal,
            earth_pressure::triangular_force(k, setup.fill.density, GRAVITY, height),
            "N/m",
        )
        .within(
            Tolerance::Relative(0.02),
            "an exact solution; exp(-4) is left of the change of the out-of-plane stress, 1 %; the surface, damping, waves, 1 %",
        )
        .from(Kind::Analytic, "Rankine 1857 with the cone's angle in plane strain"),
    );
    report.outcome.check(
        Check::value(format!("{name}, smooth base: height of the point of action"), end.arm, height / 3.0, "m")
            .within(
                Tolerance::Absolute(0.5 * HEIGHT / setup.cells as f64),
                "half a cell, to which a node's share of the wall is known",
            )
            .from(Kind::Analytic, "H / 3"),
    );
}

/// Smooth wall, smooth base, a cone so steep that slip lines end the homogeneous stretch: the least active, the greatest
/// passive force.
fn extreme(name: &str, setup: &Setup, stroke: &Stroke, report: &mut Report) {
    let angle = libm::asin(sine(setup.cone));
    let [k, bound] = [angle, davis(angle, 0.0)].map(|phi| rankine(phi, setup.stroke));
    report.add(name, setup, stroke, k, rankine(PHI, setup.stroke), None);
    let found = stroke.extreme() / unit_force();
    let check = if setup.stroke < 0.0 {
        Check::value(format!("{name}, smooth base: least force over rho g H^2 / 2"), found, k, "1").within(
            Tolerance::Relative(0.05),
            "the out-of-plane stress is within 2 % when slip lines form; at this steepness it counts twice",
        )
    } else {
        Check::new(
            format!("{name}, smooth base: greatest force over rho g H^2 / 2"),
            found,
            Expected::Within(bound, k),
            "1",
        )
        .within(Tolerance::Relative(0.02), "bounds; fill higher by the stroke, 0.8 % twice")
    };
    let source = "Rankine 1857 with the cone's angle in plane strain; slip lines at constant volume, Davis 1968";
    report.outcome.check(check.from(Kind::Analytic, source));
    report.outcome.check(
        Check::at_most(
            format!("{name}: the 31-degree coefficient is refuted, ratio of the smaller to the larger"),
            (found / rankine(PHI, setup.stroke)).min(rankine(PHI, setup.stroke) / found),
            0.75,
            "1",
        )
        .because("0.164/0.320 and 3.124/6.09 are a half; even the bounds differ by a fifth")
        .from(Kind::Analytic, "cone through the compression meridian, in plane strain"),
    );
}

/// The same wedge on cells twice as large: for the table and the extrapolation.
fn coarse(name: &str, setup: &Setup, stroke: &Stroke, report: &mut Report) {
    let k = rankine(libm::asin(sine(setup.cone)), setup.stroke);
    report.summarise(name, setup, stroke, k, rankine(PHI, setup.stroke), Some(stroke.wedge_angle()));
    report.coarse = Some(stroke.end().normal.hypot(stroke.end().shear) / unit_force());
}

/// Smooth wall, rough base: a wedge.
fn wedge(name: &str, setup: &Setup, stroke: &Stroke, report: &mut Report) {
    let Moment { normal, .. } = stroke.end();
    let angle = libm::asin(sine(setup.cone));
    let [a, b] = [angle, davis(angle, setup.dilatancy)].map(|phi| rankine(phi, setup.stroke));
    let found = stroke.wedge_angle();
    report.add(name, setup, stroke, a, rankine(PHI, setup.stroke), Some(found));
    let active = setup.stroke < 0.0;
    let sign = if active { 0.5 } else { -0.5 };
    // Planes of the wedge: Coulomb's from the stresses, Roscoe's from the strains; one for associated flow.
    let planes = [angle, setup.dilatancy].map(|of| std::f64::consts::FRAC_PI_4 + sign * of);
    report.edge(name, setup, stroke, planes);
    let tolerance = if active { 0.05 } else { 0.10 };
    // First order: the toe. Where both grids have been run, what is judged is extrapolated.
    let fine = normal / unit_force();
    let (what, force) = match report.coarse.take() {
        Some(coarse) => ("force on the wall over rho g H^2 / 2, extrapolated from two grids", 2.0 * fine - coarse),
        None => ("force on the wall over rho g H^2 / 2", fine),
    };
    report.outcome.check(
        Check::new(format!("{name}: {what}"), force, Expected::Within(a.min(b), a.max(b)), "1")
            .within(
                Tolerance::Absolute(tolerance * a),
                "the toe is shared with the base: half a cell at the foot carries h/H of the force, 2.5 % active, \
                 5 % passive; as much again for waves of the stroke and damping",
            )
            .from(Kind::Analytic, "Rankine 1857; slip lines at constant volume, Davis 1968"),
    );
    let [high, low] = planes.map(f64::to_degrees);
    report.outcome.check(
        Check::new(
            format!("{name}: inclination of the edge of what moves"),
            found,
            Expected::Within(f64::min(low, high), f64::max(low, high)),
            "deg",
        )
        .within(
            Tolerance::Absolute((2.0 / setup.cells as f64).to_degrees()),
            "the edge is a band of about two cells, over the height",
        )
        .from(
            Kind::Analytic,
            "between Roscoe's 45 + psi/2 and Coulomb's 45 + phi/2 (passive: minus), Vardoulakis 1980",
        ),
    );
}

/// A wall with friction moves out.
fn coulomb(name: &str, setup: &Setup, stroke: &Stroke, report: &mut Report) {
    let end = stroke.end();
    let delta = libm::atan(WALL_FRICTION);
    let with = |phi: f64| {
        earth_pressure::Wall { friction_angle: phi, wall_friction_angle: delta, batter: 0.0, surface_slope: 0.0 }
            .coulomb_active()
    };
    let (k, bound) = (with(PHI), with(davis(PHI, setup.dilatancy)));
    let found = stroke.wedge_angle();
    report.add(name, setup, stroke, k * libm::cos(delta), k * libm::cos(delta), Some(found));
    let wall =
        earth_pressure::Wall { friction_angle: PHI, wall_friction_angle: delta, batter: 0.0, surface_slope: 0.0 };
    let straight = std::f64::consts::FRAC_PI_4 + 0.5 * setup.dilatancy;
    report.edge(name, setup, stroke, [wall.active_plane(), straight]);
    // Wall friction turns the stress at the wall by this much (Sokolovskii 1965); at the surface it is Rankine's.
    let turned = 0.5 * (libm::asin(libm::sin(delta) / libm::sin(PHI)) - delta);
    report.outcome.check(
        Check::new(
            format!("{name}: inclination of the edge of what moves"),
            found,
            Expected::Within((straight - turned).to_degrees(), 45.0 + 0.5 * PHI.to_degrees()),
            "deg",
        )
        .within(
            Tolerance::Absolute((2.0 / setup.cells as f64).to_degrees()),
            "the edge is a band of about two cells, over the height",
        )
        .from(
            Kind::Analytic,
            "a slip line is between its inclination in Rankine's zone and at the wall; Coulomb's plane is one of these",
        ),
    );
    let fine = end.normal.hypot(end.shear) / unit_force();
    // As for the smooth wall.
    let single = (0.05, "as for the smooth wall: h/H = 2.5 % at the toe, as much again for waves");
    let (what, thrust, (share, why)) = match report.coarse.take() {
        Some(coarse) => (
            "thrust over rho g H^2 / 2, extrapolated from two grids",
            2.0 * fine - coarse,
            (
                0.08,
                "a disagreement that stands, of -5.6 % with contact at nodes and -7.2 % on the surface: not explained",
            ),
        ),
        None => ("thrust over rho g H^2 / 2", fine, single),
    };
    report.outcome.check(
        Check::new(format!("{name}: {what}"), thrust, Expected::Within(k, bound), "1")
            .within(Tolerance::Absolute(share * k), why)
            .from(
                Kind::Analytic,
                "Coulomb 1776, Mueller-Breslau 1906, tan(delta) = 0.4; slip lines at constant volume",
            ),
    );
    report.outcome.check(
        Check::value(format!("{name}: shear over normal force"), -end.shear / end.normal, WALL_FRICTION, "1")
            .within(
                Tolerance::Absolute(WALL_FRICTION * if setup.dilatancy > 0.0 { 0.05 } else { 0.025 }),
                "the fill slides down along all of the wall but its foot: half a cell, which carries h/H = 2.5 % of the force; \
                 twice that where it dilates, for a band of two cells",
            )
            .from(Kind::Analytic, "Coulomb friction"),
    );
}
