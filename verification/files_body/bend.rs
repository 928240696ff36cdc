//! A weight on a cantilever: gravity acts along x, so that a block lies on the face of an upright barrier. What the contact gives is the
//! weight, the clamp has its moment, the deflection is Timoshenko's for the pressure that the file has.
//!
//! By its mesh a beam is too stiff by some thousandths. On a grid, two cells through the depth, it is too stiff by 0.125/n^2 = 3.1 % (rung
//! `cantilever`). The points of such a beam sum up y^2 too low by (2 n)^-2 = 1/16, and so do the moments of their stresses.

use super::barrier::{Barrier, between, last, mean_where};
use super::line::{DEPTH, H, LENGTH, Line, WIDTH, YOUNG};
use super::{balance, shape};
use crate::Fault;
use crate::from_file::Files;
use checkdam::check::{Check, Kind, Tolerance};

const G: f64 = 10.0;
const SPACING: f64 = 0.025;
const CLAMPED: f64 = 0.1;
const WEIGHT: f64 = 1000.0 * 0.1 * 0.2 * WIDTH * G;
/// Steps as a share of what waves need for a cell.
const CFL: f64 = 0.5;
/// Weight of the plate along its height, N/m.
const OWN: f64 = 1000.0 * DEPTH * WIDTH * G;
const TIMOSHENKO: &str = "Timoshenko 1921 with the coefficient of Cowper 1966, under the pressure in the file";

/// How the plate is reckoned.
pub struct Setting {
    law: &'static str,
    /// What stands in its line besides.
    extra: &'static str,
    heavy: bool,
    mesh: bool,
}

/// By its mesh without weight, implicitly with weight.
pub const SETTINGS: [Setting; 2] = [
    Setting {
        law: "neo_hookean",
        extra: "kinematics = \"total_lagrangian\", weightless = true",
        heavy: false,
        mesh: true,
    },
    Setting { law: "linear_elastic", extra: "integration = \"implicit\"", heavy: true, mesh: false },
];

/// The case.
pub fn text(s: &Setting, fault: &Fault) -> String {
    format!(
        r#"title = "A weight on a cantilever"
gravity = {{ magnitude_m_per_s2 = {g}, inclination_deg = 90 }}
grid = {{ spacing_m = {H}, thickness_m = {WIDTH} }}
domain = {{ x_m = [-0.5, 0.5], y_m = [-0.3, 0.8] }}
materials.weight = {{ law = "linear_elastic", density_kg_per_m3 = {density}, young_pa = {soft}, poisson = 0 }}
materials.plate = {{ law = "{law}", density_kg_per_m3 = {density}, young_pa = {young}, poisson = 0 }}
bodies = [{{ name = "weight", material = "weight", x_m = [-0.1, 0.0], y_m = [0.2, 0.4] }},
          {{ name = "plate", material = "plate", x_m = [0.0, {DEPTH}], y_m = [-{CLAMPED}, {LENGTH}], {extra} }}]
boundaries = [{{ name = "clamp", kind = "plane", point_m = [0, 0], normal_deg = 90, contact = "bonded", bodies = ["plate"] }}]
contacts = [{{ bodies = ["plate", "weight"], friction = {friction} }}]
stages.settle = {{ damping_per_s = 70, residual = 2e-4, max_time_s = 3 }}
stages.run = {{ end_time_s = 0.1, stop_at_rest = false }}
gauges = {{ barrier = "plate", field_times_s = [0.0, 0.1] }}
output.vtk_interval_s = 0.05
numerics = {{ pic_rate_per_s = 20, cfl = {CFL} }}
"#,
        g = G * fault.gravity,
        density = 1000.0 * fault.density,
        soft = 1e6 * fault.modulus,
        young = YOUNG * fault.modulus,
        law = s.law,
        extra = s.extra,
        friction = 0.5 * fault.friction,
    )
}

/// Weight of the plate along its height, N/m.
fn own(s: &Setting) -> f64 {
    if s.heavy { OWN } else { 0.0 }
}

fn plate<'a>(s: &Setting, files: &'a Files) -> Barrier<'a> {
    Barrier {
        files,
        suffix: "",
        root: "",
        clamp: "clamp",
        normal: [-1.0, 0.0],
        tangent: [0.0, 1.0],
        weight: [own(s) * (LENGTH + CLAMPED), 0.0],
        height: LENGTH,
        h: H,
        spacing: SPACING,
        extent: [[0.0; 2]; 2],
        crest: [0.5 * SPACING, LENGTH - 0.5 * SPACING],
        points_along: 24,
        settled: true,
        width: WIDTH,
    }
}

/// What must hold.
pub fn judge(s: &Setting, files: &Files) -> Vec<Check> {
    let own = own(s);
    let whole = own * (LENGTH + CLAMPED);
    let b = plate(s, files);
    let mut checks = balance::checks(&b, Some([WEIGHT, 0.0]));
    checks.extend(shape::checks(&b, 1));
    let frame = files.frames().saturating_sub(1);
    let middle = mean_where(&files.array(frame, "body"), &files.array(frame, "Points.y"), |k| k == 0.0);
    let mut value = |what: &str, measured: f64, expected: f64, unit, allowed: f64, why: &str, source: &str| {
        checks.push(
            Check::value(what, measured, expected, unit)
                .within(Tolerance::Relative(allowed), why)
                .from(Kind::Analytic, source),
        );
    };
    const STATICS: &str = "statics of a cantilever";
    let settled = "a residual of 2e-4 leaves swings of a few thousandths of the weight";
    value(
        "height of the weight",
        middle,
        0.3,
        "m",
        0.01,
        "it goes with the plate, which turns by a hundredth",
        "the case",
    );
    value("force on the face", last(&b.body("contact_normal_n")), WEIGHT, "N", 0.005, settled, STATICS);
    value("force on the clamp", last(&b.body("clamp_normal_n")), WEIGHT + whole, "N", 0.005, settled, STATICS);
    value(
        "largest force on the clamp",
        b.number("structure.peak_clamp_n"),
        WEIGHT + whole,
        "N",
        0.01,
        settled,
        STATICS,
    );
    let moment = WEIGHT * middle;
    value("moment of the force", last(&b.history("overturning_moment_n_m")), moment, "N m", 0.005, settled, STATICS);
    value("largest moment", b.number("barrier.peak_moment_n_m"), moment, "N m", 0.01, settled, STATICS);
    let plate = 0.5 * own * (LENGTH * LENGTH - CLAMPED * CLAMPED);
    value("moment on the clamp", last(&b.body("clamp_moment_n_m")), moment + plate, "N m", 0.005, settled, STATICS);
    value(
        "largest mean over 20 ms, of steps",
        b.number("barrier.peak_20ms_by_steps_n"),
        WEIGHT,
        "N",
        0.01,
        settled,
        STATICS,
    );
    let (young, spare) = if s.mesh { (YOUNG, 1.0) } else { (1e6, 0.97) };
    let dt = spare * CFL * H / (young / 1000.0f64).sqrt();
    let wave = "of the fastest P-wave of bodies in explicit steps; up to 6 % shorter beside a body in implicit steps, which keep their length";
    value(
        "longest time step",
        files.number("stepping.time_step_max_s"),
        dt,
        "s",
        1.002 - spare,
        wave,
        "the share of cfl of h / c",
    );

    let line = Line::of(&b, own);
    let profile = |name: &str| {
        let (t, values) = (b.profile("time_s"), b.profile(name));
        let end = last(&t);
        (0..t.len()).filter(|&k| t[k] == end).map(|k| values[k]).collect::<Vec<f64>>()
    };
    let (z, w) = (profile("height_m"), profile("deflection_m"));
    let (stiff, why, allowed) = if s.mesh {
        (0.0, "0.4 % of shear in one element through the depth, parabolas along the height, and the swings", 0.01)
    } else {
        (-0.03125, "half of it: next order of 1/n^2 on two cells, and warping at the clamp", 0.0156)
    };
    let bend = |z: f64| (1.0 + stiff) * line.deflection(z);
    value(
        "deflection of the tip",
        last(&b.body("tip_deflection_m")),
        bend(LENGTH - 0.5 * SPACING),
        "m",
        allowed,
        why,
        TIMOSHENKO,
    );
    let half = z.iter().position(|z| *z > 0.5 * LENGTH).unwrap_or(0);
    let low = if s.mesh { 0.02 } else { allowed };
    value("deflection at half the height", w[half], bend(z[half]), "m", low, why, TIMOSHENKO);
    if s.mesh {
        let rows = &line.forces;
        let work: f64 = rows.iter().map(|[z_f, f]| 0.5 * f * between(&z, &w, *z_f)).sum();
        // A slab pressed by its own weight along its depth: W^2 d / (6 E A).
        let slab = WEIGHT * WEIGHT * 0.1 / (6.0 * 1e6 * 0.2 * WIDTH);
        let energy = last(&files.column("energy.csv", "elastic_j"));
        let why = "deflections in a straight line between points; what the contact presses in besides";
        value("elastic energy", energy, work + slab, "J", 0.015, why, "Clapeyron 1834: half of force times way");
        for (what, found, expected, unit) in inside(files, frame, middle) {
            let rows = "points of two elements: their rows differ by what an element cannot follow, less in the mean";
            value(what, found, expected, unit, 0.025, rows, STATICS);
        }
    } else {
        let place = last(&b.body("gap_height_m"));
        let strain =
            (1.0 + stiff) * line.moment(place + 0.5 * SPACING) * 0.5 * (DEPTH - SPACING) / (YOUNG * line.inertia());
        let why = "the grid's 3 % is taken into account; half of it";
        value(
            "gap of stretched points",
            last(&b.body("gap_cells")),
            strain * SPACING / H,
            "cells",
            allowed,
            why,
            "Hooke's law: a law without stretch shows strain as gaps",
        );
    }
    checks
}

/// Shear force and bending moment below the weight from the stresses of the points, in the mean over two elements.
fn inside(files: &Files, frame: usize, middle: f64) -> Vec<(&'static str, f64, f64, &'static str)> {
    let of = |name: &str| files.array(frame, name);
    let (bodies, id, x, y) = (of("body"), of("id"), of("Points.x"), of("Points.y"));
    let (yy, xy) = (of("stress_pa.yy"), of("stress_pa.xy"));
    let own: Vec<usize> = (0..bodies.len()).filter(|&k| bodies[k] == 1.0).collect();
    let (mut shear, mut moment) = (0.0, 0.0);
    // Rows from the clamp to 0.2 m: the fifth to twelfth of 24, four points each.
    let rows: Vec<usize> = (4..12).collect();
    for row in &rows {
        let points: Vec<usize> = own.iter().copied().filter(|&k| id[k] as usize % 24 == *row).collect();
        let count = points.len() as f64;
        let axis = points.iter().map(|&k| x[k]).sum::<f64>() / count;
        let height = points.iter().map(|&k| y[k]).sum::<f64>() / count;
        shear += points.iter().map(|&k| xy[k]).sum::<f64>() / count * DEPTH * WIDTH;
        let sum = points.iter().map(|&k| -yy[k] * (x[k] - axis)).sum::<f64>() * SPACING * WIDTH;
        moment += sum / (1.0 - 1.0 / 16.0) / (WEIGHT * (middle - height));
    }
    let n = rows.len() as f64;
    vec![
        ("shear force below it, from stresses", shear / n, WEIGHT, "N"),
        ("bending moment below it, from stresses, over the exact one", moment / n, 1.0, "1"),
    ]
}

/// Deflection of the face and what the beam should have: height, found, exact, m.
pub fn profile(files: &Files, s: &Setting) -> Vec<[f64; 3]> {
    let own = own(s);
    let column = |table: &str, name: &str| files.column(&format!("{table}.csv"), name);
    let (t, z, w) = (
        column("barrier_profile", "time_s"),
        column("barrier_profile", "height_m"),
        column("barrier_profile", "deflection_m"),
    );
    let b = plate(s, files);
    let line = Line::of(&b, own);
    let end = last(&t);
    (0..t.len()).filter(|&k| t[k] == end).map(|k| [z[k], w[k], line.deflection(z[k])]).collect()
}
