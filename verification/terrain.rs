//! Shapes and terrain from the text of a case to the files of its run.
//!
//! - A disk, a ring and a polygon in free flight: their masses by the impulse of gravity, their moments of inertia by the energy of their rotation.
//! - A block, written by its foot, slides without friction down y = x^2 that is a polyline: the rung `other_codes` has it on planes.
//! - A block slides from a smooth piece onto a rough one. While it crosses the joint friction grows with the way, so that it swings like a mass on
//!   a spring; then it is Coulomb's.
//! - A heap that is a polygon rests in a pit with a corner of 90 degrees, a slope and a crest: the ground carries its weight, and no more.
//! - The same heap let fall, mirrored, turned and moved: the same flow.

use super::{Fault, FaultKind, Outcome, Rung, RungFailure};
use crate::figure::{Figure, curves, exact, measured};
use crate::from_file::{Files, largest};
use crate::invariance::transform::{mirrored, moved, turned};
use crate::of_module;
use crate::report::table_csv;
use checkdam::case;
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::plot::curves::Curves;
use checkdam::run::scene::build;
use checkdam::theory::parabola::Bowl;
use std::f64::consts::PI;

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "From the text: disk, ring and polygon in flight; a slide down a polyline; friction by piece; a heap in a pit, and its image",
    goal: "Bodies have the mass and the inertia of their drawing, and terrain holds, guides and rubs as it is drawn",
    source: "geometry; energy of a rigid block; Coulomb 1785; statics; invariance to reflection, rotation and translation",
    sketch: r"
    (o)   \o\              o o        |oooo
   o   o    \ \     /     o   o       | oooo   /
    (o)      ' . . '    -------=====  |______ /
   flight    y = x^2    smooth rough    a heap
",
    run,
    covers: &[(FaultKind::Gravity, 1.03), (FaultKind::Density, 1.03), (FaultKind::Friction, 1.03)],
    under_fault: "the flight, and the block on two pieces",
    figures: FIGURES,
};

const FIGURES: &[Figure] = &[
    curves(
        "terrain_joint",
        "terrain_joint_plot",
        Curves {
            x: "time_s",
            x_title: "time (s)",
            y_title: "speed (m/s)",
            curves: &[measured("speed_m_per_s", "computed"), exact("exact_m_per_s", "rigid block")],
            ..Curves::LINEAR
        },
    ),
    curves(
        "terrain_bowl",
        "terrain_bowl_plot",
        Curves {
            x: "time_s",
            x_title: "time (s)",
            y_title: "energy of motion over what gravity gives to the bottom",
            curves: &[measured("kinetic_1", "")],
            ..Curves::LINEAR
        },
    ),
];

const G: f64 = 10.0;
const WIDTH: f64 = 0.2;
const DENSITY: f64 = 1000.0;

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let mut outcome = Outcome::default();
    flight(fault, &mut outcome)?;
    joint(fault, &mut outcome)?;
    if *fault == Fault::NONE {
        bowl(&mut outcome)?;
        pit(&mut outcome)?;
        images(&mut outcome)?;
    }
    Ok(outcome)
}

fn elastic(density: f64) -> String {
    format!("{{ law = \"linear_elastic\", density_kg_per_m3 = {density}, young_pa = 1000000, poisson = 0.3 }}")
}

/// The last of a column.
fn last(files: &Files, file: &str, name: &str) -> f64 {
    files.column(file, name).last().copied().unwrap_or(f64::NAN)
}

/// Mass and energy of motion of bodies in free flight: name, lines of the body, area, the second moment of it that moves, and its rate.
fn flight(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let (outer, inner, spin): (f64, f64, f64) = (0.2, 0.1, 3.0);
    let disk = PI * outer * outer;
    let ring = PI * (outer * outer - inner * inner);
    // A triangle with legs of 0.4 and 0.3 m along the axes: second moments about its centroid b^3 h / 36, and -b^2 h^2 / 72.
    let (b, h): (f64, f64) = (0.4, 0.3);
    let [xx, yy] = [b * b * b * h / 36.0, h * h * h * b / 36.0];
    let shear = 5.0;
    let scenes = [
        (
            "disk, spinning",
            format!("centre_m = [0.05, 0.1], radius_m = {outer}, spin_rad_per_s = {spin}"),
            disk,
            0.5 * disk * outer * outer,
            spin,
        ),
        (
            "ring, stretching",
            format!(
                "centre_m = [0.05, 0.1], radius_m = {outer}, inner_radius_m = {inner}, velocity_gradient_per_s = [[{spin}, 0], [0, {spin}]]"
            ),
            ring,
            0.5 * ring * (outer * outer + inner * inner),
            spin,
        ),
        (
            "triangle, shearing",
            format!("polygon_m = [[0, 0], [0, {h}], [{b}, 0]], velocity_gradient_per_s = [[0, {shear}], [0, 0]]"),
            0.5 * b * h,
            yy,
            shear,
        ),
        (
            "triangle, spinning",
            format!("polygon_m = [[0, 0], [0, {h}], [{b}, 0]], rotation_deg = 20, spin_rad_per_s = {spin}"),
            0.5 * b * h,
            xx + yy,
            spin,
        ),
    ];
    let spacing = 0.01;
    for (name, lines, area, second_moment, rate) in scenes {
        let text = format!(
            r#"title = "{name}"
gravity = {{ magnitude_m_per_s2 = {g}, inclination_deg = 0 }}
grid = {{ spacing_m = {cell}, thickness_m = {WIDTH} }}
domain = {{ x_m = [-1, 1], y_m = [-1, 1] }}
materials.stuff = {material}
bodies = [{{ name = "body", material = "stuff", {lines} }}]
stages.run = {{ end_time_s = 0.01, stop_at_rest = false }}
output.vtk_interval_s = 0
"#,
            g = G * fault.gravity,
            cell = 2.0 * spacing,
            material = elastic(DENSITY * fault.density),
        );
        let files = Files::run(&text)?;
        let loaded = case::parse(&text, name).map_err(|e| RungFailure::Files(e.to_string()))?;
        let drawn = DENSITY * area * WIDTH;
        let points = build(&loaded.case).bodies;
        let filled = points.iter().map(|(body, points)| body.point_mass * points.len() as f64).sum();
        let fallen = -last(&files, "momentum.csv", "gravity_y_n_s") / (G * last(&files, "momentum.csv", "time_s"));
        for (what, mass, within, why) in [
            ("mass of its points", filled, 1e-12, "round-off: pieces of one area"),
            ("mass by the impulse of gravity", fallen, 1e-8, "two numbers of nine digits"),
        ] {
            outcome.check(
                Check::value(format!("flight, {name}: {what}"), mass, drawn, "kg")
                    .within(Tolerance::Relative(within), why)
                    .from(Kind::Analytic, "area of the shape"),
            );
        }
        let kinetic = files.column("energy.csv", "kinetic_j").first().copied().unwrap_or(f64::NAN);
        let energy = 0.5 * DENSITY * WIDTH * second_moment * rate * rate;
        outcome.check(
            Check::value(format!("flight, {name}: energy of motion at the start"), kinetic, energy, "J")
                .within(
                    Tolerance::Relative(2.0 * spacing * spacing * area / (6.0 * second_moment)),
                    "twice what points lack of the inertia of squares of their spacing, a^2/6 each",
                )
                .from(Kind::Analytic, "second moments of area"),
        );
    }
    Ok(())
}

/// From a smooth piece onto a rough one. The block is flat: friction at its base loads its front, by a share of 3 mu h / L, where it has crossed.
fn joint(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let (mu, speed, length, height): (f64, f64, f64, f64) = (0.5, 2.0, 0.3, 0.05);
    let cell = 0.025;
    let text = format!(
        r#"title = "A block on two pieces"
gravity = {{ magnitude_m_per_s2 = {g}, inclination_deg = 0 }}
grid = {{ spacing_m = {cell}, thickness_m = {WIDTH}, origin_m = [0.003, 0.007] }}
domain = {{ x_m = [-1, 2], y_m = [-0.2, 0.5] }}
materials.stuff = {material}
bodies = [{{ name = "block", material = "stuff", x_m = [-0.4, -0.1], y_m = [0, {height}], velocity_m_per_s = [{speed}, 0] }}]
boundaries = [{{ name = "bed", kind = "polyline", points_m = [[-0.5, 0], [0, 0], [1, 0]], contact = "coulomb", friction_by_piece = [0, {mu}] }}]
stages.run = {{ end_time_s = 0.4, stop_at_rest = false }}
output.vtk_interval_s = 0
numerics.pic_fraction = 0.01
"#,
        g = G * fault.gravity,
        mu = mu * fault.friction,
        material = elastic(DENSITY * fault.density),
    );
    let files = Files::run(&text)?;
    let mass = DENSITY * length * height * WIDTH;
    let rate = (mu * G / length).sqrt();
    let begin = 0.1 / speed;
    let crossed = begin + libm::asin(rate * length / speed) / rate;
    let exact = |t: f64| match t {
        t if t < begin => speed,
        t if t < crossed => speed * libm::cos(rate * (t - begin)),
        t => speed * libm::cos(rate * (crossed - begin)) - mu * G * (t - crossed),
    };
    let times = files.column("momentum.csv", "time_s");
    let impulses = files.column("momentum.csv", "bed_x_n_s");
    let row = |(t, p): (&f64, &f64)| vec![*t, speed + p / (mass * fault.density), exact(*t)];
    let rows: Vec<Vec<f64>> = times.iter().zip(&impulses).map(row).collect();
    let off =
        |from: f64, to: f64| largest(rows.iter().filter(|r| (from..to).contains(&r[0])).map(|r| (r[1] - r[2]) / speed));
    // What friction takes while the block crosses is mu g L / (2 v); the joint lies within half a cell.
    let pitching = 0.25 * mu * height / length * mu * G * length / speed;
    let place = 0.5 * cell * mu * G / speed;
    outcome.check(
        Check::at_most(
            "two pieces: largest error of the speed on the smooth one, share",
            off(0.0, begin - cell / speed),
            1e-3,
            "1",
        )
        .because("nothing rubs until a cell before the joint: waves of the start")
        .from(Kind::Analytic, "no friction"),
    );
    outcome.check(
        Check::at_most("two pieces: largest error of the speed, share", off(0.0, 0.4), (pitching + place) / speed, "1")
            .because("half a cell in the place of the joint, and the load on the block's front while it crosses")
            .from(Kind::Analytic, "Coulomb 1785; a mass on a spring while it crosses the joint"),
    );
    let late: Vec<&Vec<f64>> = rows.iter().filter(|r| r[0] > crossed + 0.03).collect();
    let slowing = match (late.first(), late.last()) {
        (Some(a), Some(b)) => (a[1] - b[1]) / (b[0] - a[0]),
        _ => f64::NAN,
    };
    outcome.check(
        Check::value("two pieces: deceleration on the rough one", slowing, mu * G, "m/s2")
            .within(
                Tolerance::Relative(0.01),
                "a wave across the block, 4 h / c of 8 ms, at one end of 0.16 s by a fifth of the load",
            )
            .from(Kind::Analytic, "Coulomb 1785"),
    );
    outcome.tables.push(("terrain_joint".into(), table_csv(&["time_s", "speed_m_per_s", "exact_m_per_s"], rows)));
    Ok(())
}

/// Down a parabola of pieces 5 mm apart.
fn bowl(outcome: &mut Outcome) -> Result<(), RungFailure> {
    let bowl = Bowl { curvature: 1.0, side: 0.05, gravity: G };
    let start = -0.7;
    let angle = bowl.angle(start);
    let [x, y] = bowl.centre(start);
    let (c, s, half) = (libm::cos(angle), libm::sin(angle), 0.5 * bowl.side);
    let corner = [x - c * half + s * half, y - s * half - c * half];
    let points: Vec<String> = (-160..=40).map(|k| 0.005 * f64::from(k)).map(|x| format!("[{x}, {}]", x * x)).collect();
    // Corners of a chord lie on the curve, its middle a piece squared over eight above it: a tenth of that is room for the block to stand.
    let foot = [corner[0], corner[1] + 1e-5];
    let text = format!(
        r#"title = "A slide down a parabola"
gravity = {{ magnitude_m_per_s2 = {G}, inclination_deg = 0 }}
grid = {{ spacing_m = 0.01, thickness_m = {WIDTH} }}
domain = {{ x_m = [-0.9, 0.4], y_m = [-0.1, 0.8] }}
materials.stuff = {material}
bodies = [{{ name = "block", material = "stuff", foot_m = [{}, {}], height_m = {side}, thickness_m = {side}, inclination_deg = {} }}]
boundaries = [{{ name = "bowl", kind = "polyline", points_m = [{}], contact = "smooth" }}]
stages.run = {{ end_time_s = 0.5, stop_at_rest = false }}
output.vtk_interval_s = 0
numerics.pic_fraction = 0
"#,
        foot[0],
        foot[1],
        angle.to_degrees() + 90.0,
        points.join(", "),
        material = elastic(DENSITY),
        side = bowl.side,
    );
    let files = Files::run(&text)?;
    let given = DENSITY * bowl.side * bowl.side * WIDTH * G * (bowl.centre(start)[1] - bowl.centre(0.0)[1]);
    let kinetic: Vec<f64> = files.column("energy.csv", "kinetic_j").iter().map(|k| k / given).collect();
    let times = files.column("energy.csv", "time_s");
    outcome.check(
        Check::value(
            "slide down y = x^2: largest energy of motion over what gravity gives",
            largest(kinetic.clone()),
            1.0,
            "1",
        )
        .within(
            Tolerance::Absolute(2.0 * 0.67 * 0.005),
            "twice the share of the speed that kinks between pieces of 5 mm may take (rung `other_codes`)",
        )
        .from(Kind::Conservation, "energy"),
    );
    let residual = largest(files.column("energy.csv", "residual_j")) / given;
    outcome.check(
        Check::at_most("the same: largest energy residual, share", residual, 2e-3, "1")
            .because("what a bowl of planes left on cells of 10 mm (docs/limits.md)")
            .from(Kind::Conservation, "energy balance"),
    );
    let rows = times.iter().zip(&kinetic).map(|(t, k)| vec![*t, *k]).collect::<Vec<_>>();
    outcome.tables.push(("terrain_bowl".into(), table_csv(&["time_s", "kinetic_1"], rows)));
    Ok(())
}

/// A heap in a pit: its lower side is the pit's.
const HEAP: &str = "[0, 0.4], [0, 0], [0.5, 0], [0.8, 0.15], [0.6, 0.35]";
/// The pit: a wall, a floor, a slope, a crest.
const PIT: &str = "[0, 1], [0, 0], [0.5, 0], [1.1, 0.3], [1.6, 0.2]";

/// Friction is more than the slope, on which the toe of the heap would creep.
fn heap(stages: &str, law: &str) -> String {
    format!(
        r#"title = "A heap in a pit"
gravity = {{ magnitude_m_per_s2 = {G}, inclination_deg = 0 }}
grid = {{ spacing_m = 0.05, thickness_m = {WIDTH}, origin_m = [0.013, -0.017] }}
domain = {{ x_m = [-0.5, 2], y_m = [-0.5, 1.5] }}
materials.stuff = {law}
bodies = [{{ name = "heap", material = "stuff", polygon_m = [{HEAP}] }}]
boundaries = [{{ name = "pit", kind = "polyline", points_m = [{PIT}], contact = "coulomb", friction = 0.8 }}]
{stages}
output.vtk_interval_s = 0
"#
    )
}

/// At rest the pit carries the weight.
fn pit(outcome: &mut Outcome) -> Result<(), RungFailure> {
    let stages = "stages.settle = { damping_per_s = 60, residual = 1e-3, max_time_s = 3 }\nstages.run = { end_time_s = 0.1, stop_at_rest = false }";
    let files = Files::run(&heap(stages, &elastic(1500.0)))?;
    // Gauss's formula for the corners of the heap.
    let area = 0.5 * (0.5 * 0.15 + (0.8 * 0.35 - 0.6 * 0.15) + 0.6 * 0.4);
    let impulse = 1500.0 * area * WIDTH * G * last(&files, "momentum.csv", "time_s");
    let [along, up] = ["pit_x_n_s", "pit_y_n_s"].map(|name| last(&files, "momentum.csv", name) / impulse);
    // At the residual r all moves at r sqrt(g H) at most, which may turn round in the time.
    let moves = 2.0 * 1e-3 * (0.4f64 / G).sqrt() / 0.1;
    let still = "what moves at the residual of the settling may turn round in a tenth of a second: 2 r sqrt(H / g) / t";
    outcome.check(
        Check::value("heap in a pit: what the pit carries over the weight", up, 1.0, "1")
            .within(Tolerance::Absolute(moves), still)
            .from(Kind::Conservation, "statics"),
    );
    outcome.check(
        Check::value("the same: horizontal force over the weight", along, 0.0, "1")
            .within(Tolerance::Absolute(moves), still)
            .from(Kind::Conservation, "statics: the pit is the only boundary"),
    );
    Ok(())
}

/// The heap let go, and its images.
fn images(outcome: &mut Outcome) -> Result<(), RungFailure> {
    let law = "{ law = \"drucker_prager\", density_kg_per_m3 = 1500, young_pa = 1000000, poisson = 0.3, friction_angle_deg = 20 }";
    let text = heap("stages.run = { end_time_s = 0.1, stop_at_rest = false }", law);
    let base = case::parse(&text, "heap").map_err(|e| RungFailure::Files(e.to_string()))?.case;
    // The grid turns with it.
    let mut on_its_side = turned(&base, 90.0);
    let [x, y] = base.grid.origin_m;
    on_its_side.grid.origin_m = [-y, x];
    let digits = "round-off: tables have nine digits";
    let sweeps = "crossings that share nodes are found in 24 sweeps in the order of the nodes, which leaves 2^-24 of an impulse where each halves \
                  what is left, in a hundred steps";
    let images = [
        ("mirrored", mirrored(&base), [[-1.0, 0.0], [0.0, 1.0]], 1e-5, sweeps),
        ("turned by 90 degrees", on_its_side, [[0.0, -1.0], [1.0, 0.0]], 1e-5, sweeps),
        ("moved with the grid", moved(&base, [0.137, -0.061], true), [[1.0, 0.0], [0.0, 1.0]], 1e-8, digits),
    ];
    let written = |case: &case::Case| case.to_toml().map_err(|e| RungFailure::Files(e.to_string()));
    let own = Files::run(&text)?;
    let read = |files: &Files| {
        [("energy.csv", "kinetic_j"), ("momentum.csv", "pit_x_n_s"), ("momentum.csv", "pit_y_n_s")]
            .map(|(file, name)| files.column(file, name))
    };
    let [kinetic, x, y] = read(&own);
    let most = |values: &[f64]| largest(values.iter().copied());
    for (name, image, [[a, b], [c, d]], within, why) in images {
        let files = Files::run(&written(&image)?)?;
        let [seen, sx, sy] = read(&files);
        let same = seen.len() == kinetic.len();
        let pairs = || x.iter().zip(&y).zip(sx.iter().zip(&sy));
        let energy = largest(seen.iter().zip(&kinetic).map(|(p, q)| p - q)) / most(&kinetic);
        let impulse = largest(pairs().flat_map(|((x, y), (p, q))| [a * x + b * y - p, c * x + d * y - q])) / most(&y);
        let off = if same { largest([energy, impulse]) } else { f64::NAN };
        outcome.check(
            Check::at_most(
                format!("heap let go, {name}: largest difference of energy and impulse, share"),
                off,
                within,
                "1",
            )
            .because(why)
            .from(Kind::Conservation, "invariance"),
        );
    }
    Ok(())
}
