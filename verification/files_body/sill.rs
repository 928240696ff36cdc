//! A block on a body: at rest on a slope, and sliding down it.
//!
//! The sill is a body whose face looks up: it is turned by -90 degrees. On a grid of square cells the stress is one in each cell, so what
//! layers of points say of the force is exact. With two cells through the block and two layers a cell, the first two layers say 3/4 of the
//! weight, the third 1/4.

use super::barrier::{Barrier, dot, last, mean_where};
use super::{balance, shape};
use crate::Fault;
use crate::from_file::Files;
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::theory::sliding_block::sliding_acceleration;
use libm::{cos, sin};

const G: f64 = 10.0;
const H: f64 = 0.05;
const SPACING: f64 = 0.025;
const WIDTH: f64 = 0.2;
const BLOCK: f64 = 2000.0 * 0.6 * 0.1 * WIDTH;
const SILL: f64 = 1500.0 * 1.0 * 0.1 * WIDTH;
const COULOMB: &str = "Coulomb 1785";
const STATICS: &str = "statics of a block on a slope";

/// Slope (degrees), friction, residual at which settling ends.
pub struct Setting {
    slope_deg: f64,
    friction: f64,
    residual: f64,
    end: f64,
}

/// At rest below the angle of friction.
pub const REST: Setting = Setting { slope_deg: 20.0, friction: 0.5, residual: 1e-4, end: 0.35 };
/// Above it; damping makes it creep at a steady speed until the clock starts.
pub const SLIDE: Setting = Setting { slope_deg: 30.0, friction: 0.3, residual: 0.05, end: 0.2 };

/// The case.
pub fn text(s: &Setting, fault: &Fault) -> String {
    format!(
        r#"title = "A block on a body"
gravity = {{ magnitude_m_per_s2 = {g}, inclination_deg = {slope}, settle_inclination_deg = 0 }}
grid = {{ spacing_m = {H}, thickness_m = {WIDTH} }}
domain = {{ x_m = [-0.3, 1.4], y_m = [-0.3, 0.5] }}
materials.block = {{ law = "linear_elastic", density_kg_per_m3 = {block}, young_pa = {young}, poisson = 0 }}
materials.sill = {{ law = "linear_elastic", density_kg_per_m3 = {sill}, young_pa = {young}, poisson = 0 }}
bodies = [{{ name = "block", material = "block", x_m = [0.2, 0.8], y_m = [0.0, 0.1] }},
          {{ name = "sill", material = "sill", x_m = [0.0, 0.1], y_m = [0.0, 1.0], rotation_deg = -90 }}]
boundaries = [{{ name = "clamp", kind = "plane", point_m = [0, -0.05], normal_deg = 90, contact = "bonded", bodies = ["sill"] }}]
contacts = [{{ bodies = ["sill", "block"], friction = {friction} }}]
stages.settle = {{ damping_per_s = 100, residual = {residual}, max_time_s = 3 }}
stages.tilt = {{ duration_s = 0.1 }}
stages.run = {{ end_time_s = {end}, stop_at_rest = false }}
gauges = {{ barrier = "sill", field_times_s = [0.0, {end}] }}
output.vtk_interval_s = {frames}
numerics.pic_rate_per_s = 20
"#,
        g = G * fault.gravity,
        slope = s.slope_deg,
        block = 2000.0 * fault.density,
        sill = 1500.0 * fault.density,
        young = 5e5 * fault.modulus,
        friction = s.friction * fault.friction,
        residual = s.residual,
        end = s.end,
        frames = 0.5 * s.end,
    )
}

fn sill<'a>(files: &'a Files, s: &Setting) -> Barrier<'a> {
    let slope = s.slope_deg.to_radians();
    Barrier {
        files,
        suffix: "",
        root: "",
        clamp: "clamp",
        normal: [0.0, 1.0],
        tangent: [1.0, 0.0],
        weight: [SILL * G * sin(slope), -SILL * G * cos(slope)],
        height: 1.0,
        h: H,
        spacing: SPACING,
        extent: [[0.0; 2]; 2],
        crest: [1.0 - 0.5 * SPACING, -0.5 * SPACING],
        points_along: 40,
        settled: true,
        width: WIDTH,
    }
}

/// Mean of an array of a frame over the points of the block.
fn block(files: &Files, frame: usize, name: &str) -> f64 {
    mean_where(&files.array(frame, "body"), &files.array(frame, name), |b| b == 0.0)
}

/// Rows of `contact.csv` at its last time: place, pressure times area, shear times area, area.
fn touching(files: &Files) -> Vec<[f64; 4]> {
    let column = |name: &str| files.column("contact.csv", name);
    let (t, x, p, s, a) =
        (column("time_s"), column("x_m"), column("pressure_pa"), column("shear_pa"), column("area_m2"));
    let end = files.number("stepping.end_s");
    let rows = (0..t.len()).filter(|&k| (t[k] - end).abs() < 1e-7);
    rows.map(|k| [x[k], p[k] * a[k], s[k] * a[k], a[k]]).collect()
}

/// What must hold at rest.
pub fn rest(files: &Files) -> Vec<Check> {
    let s = &REST;
    let b = sill(files, s);
    let slope = s.slope_deg.to_radians();
    let weight = |mass: f64| [mass * G * cos(slope), mass * G * sin(slope)];
    let ([n, t], [own, along]) = (weight(BLOCK), weight(SILL));
    let mut checks = balance::checks(&b, Some([t, -n]));
    checks.extend(shape::checks(&b, 1));
    let mut value = |what: &str, measured: f64, expected: f64, unit, allowed: f64, why: &str, source: &str| {
        checks.push(
            Check::value(what, measured, expected, unit)
                .within(Tolerance::Relative(allowed), why)
                .from(Kind::Analytic, source),
        );
    };
    let settled = "a residual of 1e-4 leaves waves of a tenth of a percent of the weight";
    value("weight through the contact", last(&b.body("contact_normal_n")), n, "N", 0.005, settled, STATICS);
    value("its part down the slope", last(&b.body("contact_tangential_n")), t, "N", 0.005, settled, STATICS);
    value("clamp, against the face", last(&b.body("clamp_normal_n")), n + own, "N", 0.005, settled, STATICS);
    value("clamp, along the face", last(&b.body("clamp_tangential_n")), t + along, "N", 0.005, settled, STATICS);
    let frame = files.frames().saturating_sub(1);
    let [x, y] = ["Points.x", "Points.y"].map(|name| block(files, frame, name));
    value("middle of the block, x", x, 0.5, "m", 0.002, "it gives way by its strain of half a percent", "the case");
    value("middle of the block, y", y, 0.05, "m", 0.02, "it gives way by its strain and the sill's", "the case");
    let moment = n * x + t * y;
    value("moment of the block", last(&b.history("overturning_moment_n_m")), moment, "N m", 0.005, settled, STATICS);
    let clamped = moment + own * 0.5 - along * 0.05;
    value("moment on the clamp", last(&b.body("clamp_moment_n_m")), clamped, "N m", 0.005, settled, STATICS);
    value("largest moment", b.number("barrier.peak_moment_n_m"), moment, "N m", 0.005, settled, STATICS);
    value("largest clamp force", b.number("structure.peak_clamp_n"), (BLOCK + SILL) * G, "N", 0.005, settled, STATICS);
    let cells = "one stress a cell; the block is compressed by half a percent";
    for (k, share) in [0.75, 0.75, (0.75 + 0.75 + 0.25) / 3.0].into_iter().enumerate() {
        let layer = last(&b.history(&format!("force_layer{}_n", k + 1)));
        let what = format!("force from {} layers", k + 1);
        value(&what, layer, share * n, "N", 0.015, cells, "weight above the middle of a cell");
    }
    let rows = touching(files);
    let sum = |k: usize| rows.iter().map(|r| r[k]).sum::<f64>();
    let step = "a single step at rest";
    value("pressure times area of the nodes that touch", sum(1), n, "N", 0.005, step, STATICS);
    value("shear times area", sum(2), -t, "N", 0.005, step, STATICS);
    let action = rows.iter().map(|r| r[0] * r[1]).sum::<f64>();
    value("pressure times area times place", action, moment, "N m", 0.005, step, STATICS);
    let edges = "the nodes at both ends have between a half and a whole cell: half a cell of twelve";
    value("area of contact", sum(3), 0.6 * WIDTH, "m2", 0.042, edges, "length times width of the block");
    let column = |name: &str| files.column("contact.csv", name);
    let (up, weights) = (column("normal_y_1"), column("area_m2"));
    let normal = dot(&up, &weights) / weights.iter().sum::<f64>();
    value("normal out of the sill, y", normal, 1.0, "1", 0.001, "the sill's face turns by a thousandth", "the case");
    let rows = "lattice of the points, less the slip before friction holds";
    value("highest point at the face", last(&b.body("run_up_m")), 0.8 - 0.5 * SPACING, "m", 0.003, rows, "the case");
    let rank = "69th of 72 points: the last column has three";
    value("95 % of them", last(&b.history("run_up_p95_m")), 0.8 - 1.5 * SPACING, "m", 0.003, rank, "the case");
    let speed = "of the P-wave alone; points at rest";
    let dt = 0.3 * H / (5e5f64 / 1500.0).sqrt();
    value("longest time step", files.number("stepping.time_step_max_s"), dt, "s", 0.002, speed, "0.3 h / (c + v)");
    value("mass", files.number("stepping.mass_kg"), BLOCK + SILL, "kg", 1e-6, "the lattices fill both", "the case");
    checks
}

/// What must hold while it slides.
pub fn slide(files: &Files) -> Vec<Check> {
    let s = &SLIDE;
    let b = sill(files, s);
    let slope = s.slope_deg.to_radians();
    let (n, t) = (BLOCK * G * cos(slope), BLOCK * G * sin(slope));
    let mut checks = balance::checks(&b, Some([t, -n]));
    checks.extend(shape::checks(&b, 1));
    let mut value = |what: &str, measured: f64, expected: f64, unit, allowed: f64, why: &str, source: &str| {
        checks.push(
            Check::value(what, measured, expected, unit)
                .within(Tolerance::Relative(allowed), why)
                .from(Kind::Analytic, source),
        );
    };
    let dt = b.intervals();
    let [normal, tangential] = ["normal", "tangential"].map(|p| dot(&b.body(&format!("contact_{p}_n")), &dt));
    let slips = "every node slips; normals of the face turn by a thousandth";
    value("friction over normal force, of the impulses", tangential / normal, s.friction, "1", 0.01, slips, COULOMB);
    let end = last(&b.body("time_s"));
    let waves = "the rest of the waves of settling: a percent of the weight, over the run less";
    value("mean normal force", normal / end, n, "N", 0.005, waves, STATICS);
    let frame = files.frames().saturating_sub(1);
    let speed = |k| block(files, k, "velocity_m_per_s.x");
    let way = block(files, frame, "Points.x") - block(files, 0, "Points.x");
    let a = sliding_acceleration(G, slope, s.friction);
    let share = "1 % of friction is 0.01 mu / (tan slope - mu) = 1 % of the acceleration";
    value("gain of speed", speed(frame) - speed(0), a * end, "m/s", 0.015, share, COULOMB);
    value("way", way, speed(0) * end + 0.5 * a * end * end, "m", 0.015, share, COULOMB);
    let gained = files.column("momentum.csv", "gained_x_n_s");
    let rows = files.column("momentum.csv", "time_s");
    value("momentum gained", last(&gained), BLOCK * a * last(&rows), "N s", 0.015, share, COULOMB);
    let energy = |name: &str| files.column("energy.csv", name);
    let when = last(&energy("time_s"));
    let slid = speed(0) * when + 0.5 * a * when * when;
    let work = last(&energy("friction_sill_on_block_j"));
    value("work of friction", work, s.friction * n * slid, "J", 0.02, "force and way", COULOMB);
    let kinetic = 0.5 * BLOCK * (speed(0) + a * when).powi(2);
    value("kinetic energy", last(&energy("kinetic_j")), kinetic, "J", 0.03, "twice the speed's", COULOMB);
    let kinetic = 0.5 * BLOCK * (speed(0) + a * end).powi(2);
    value("kinetic energy of the flow", last(&b.history("kinetic_j")), kinetic, "J", 0.03, "the same", COULOMB);
    let rows = touching(files);
    let [pressed, sheared] = [1, 2].map(|k| rows.iter().map(|r| r[k]).sum::<f64>());
    value("shear over pressure of the last step", -sheared / pressed, s.friction, "1", 0.01, slips, COULOMB);
    let start = b.body("run_up_m")[0];
    let since = way - speed(0) * b.body("time_s")[0];
    let edge = last(&b.body("run_up_m")) - start;
    value(
        "way of its foremost point at the face",
        edge,
        since,
        "m",
        0.02,
        "of a point that the block's strain moves",
        "rigid motion",
    );
    checks
}
