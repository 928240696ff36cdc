//! A layer of mu(I) that flows down a rough incline: from rest to Bagnold's profile.
//!
//! The layer is finite, since nothing here is periodic: 48 depths long, and looked at in the middle before its ends have a say there, as the
//! velocity on both sides of the middle shows. Grains are twice as large as the layer is deep, which is no layer of grains but the same
//! equations: the time to the steady state is that in which a depth falls through itself, times H/d.
//!
//! Velocities are displacements over a time. Those that points carry differ from cell to cell beside a base that holds: there the nodes
//! lose what points map to them, which FLIP takes off the points, until a point a quarter of a cell above the base carries a third
//! of what the next one does, backwards.

use super::report::named_csv;
use super::scene::{Brick, Material, points_by_number, run_until, scene};
use super::{Fault, FaultKind, Outcome, Rung, RungFailure};
use crate::figure::{Figure, curves, exact, measured};
use crate::of_module;
use checkdam::boundary::{Boundary, Friction};
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::constitutive::{AnyLaw, MuI};
use checkdam::plot::curves::Curves;
use checkdam::simulation::{PicShare, Simulation};
use checkdam::theory::mu_i::MuI as Beads;
use nalgebra::Vector2;

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "A layer of mu(I) on a rough incline comes to Bagnold's profile",
    goal: "Velocity at the surface and shape of the profile, on two grids",
    source: "GDR MiDi 2004; Jop, Forterre and Pouliquen 2006",
    sketch: r"
   o o o o o o o o   -->   velocity ~ H^1.5 - (H - y)^1.5
   o o o o o o o o  -->
   o o o o o o o o ->
   ===============  rough, at 25 degrees
",
    run,
    covers: &[(FaultKind::Friction, 1.02)],
    under_fault: "the coarse grid",
    figures: &[PROFILE],
};

const PROFILE: Figure = curves(
    "bagnold_profile",
    "bagnold_profile_plot",
    Curves {
        x: "height_over_depth",
        x_title: "height over the base, in depths",
        y_title: "velocity over that of the surface",
        curves: &[
            measured("velocity", ""),
            exact("velocity_exact", "Bagnold"),
            exact("velocity_on_elastic", "on an elastic skeleton"),
        ],
        split: &[("grid", "")],
        ..Curves::LINEAR
    },
);

const GRAVITY: f64 = 9.81;
const DENSITY: f64 = 1500.0;
const DEPTH: f64 = 0.1;
/// Length over depth.
const LONG: usize = 48;
/// rad.
const SLOPE: f64 = 25.0 * std::f64::consts::PI / 180.0;
const BEADS: Beads =
    Beads { least: 0.3819, most: 0.6435, half_way: 0.279, diameter: 2.0 * DEPTH, grain_density: 2500.0 };
/// P-wave speed over sqrt(g cos(slope) H). An elastic skeleton that is sheared in rate form presses less along its normal by tau^2/G, which
/// makes the flow 2 % faster at the base, and four times as much at half of this speed.
const STIFF: f64 = 16.0;
/// End, in units of sqrt(H / (g cos(slope))). The slowest motion about the steady state decays with a time of 0.46 of these (d/H = 2; the
/// first zero of J_(-1/3) in the linearised balance): two thousandths are left.
const UNTIL: f64 = 3.0;
/// The share of it at the end over which velocities are taken.
const LATE: f64 = 0.2;
/// Cells over the depth.
const GRIDS: [usize; 2] = [4, 8];
const NAMES: [&str; 2] = ["4 cells", "8 cells"];

/// What one grid gives: rows of the profile, velocity of the topmost layer over what it should be, root mean square of the difference to
/// the profile over the velocity of the surface, and to that on an elastic skeleton, largest difference of both halves of the middle over the same, exponent of the profile.
struct Seen {
    rows: Vec<Vec<f64>>,
    surface: f64,
    rms: f64,
    on_elastic: f64,
    halves: f64,
    exponent: f64,
}

fn exact_velocity(height: f64) -> f64 {
    BEADS.incline_velocity(DENSITY, GRAVITY, SLOPE, DEPTH, height).unwrap_or(f64::NAN)
}

/// On an elastic skeleton with a shear modulus (Pa).
fn elastic_velocity(height: f64, shear: f64) -> f64 {
    BEADS.incline_velocity_on_elastic(DENSITY, GRAVITY, SLOPE, [DEPTH, height], shear).unwrap_or(f64::NAN)
}

fn flow(grid: usize, fault: &Fault) -> Result<Seen, RungFailure> {
    let cells = GRIDS[grid];
    let h = DEPTH / cells as f64;
    let (down, along) = (GRAVITY * libm::cos(SLOPE), GRAVITY * libm::sin(SLOPE));
    // M = E (1 - nu) / ((1 + nu)(1 - 2 nu)) = 1.346 E at nu = 0.3.
    let modulus = DENSITY * STIFF * STIFF * down * DEPTH;
    let soil = Material::new(modulus * 1.3 * 0.4 / 0.7, 0.3, DENSITY);
    let friction = [BEADS.least, BEADS.most].map(|mu| mu * fault.friction);
    let law = MuI::new(soil.linear_elastic(fault), friction, BEADS.half_way, BEADS.diameter, BEADS.grain_density, true);
    let brick = Brick::new([0.0, 0.0], [LONG * cells, cells], h);
    // The pressure of the layer is there from the start: nothing has to be compressed first.
    let mut points = brick.points();
    for p in &mut points {
        let pressure = -DENSITY * down * (DEPTH - p.x[1]);
        let s = &mut p.state.stress;
        (s.xx, s.yy, s.zz) = (pressure, pressure, pressure);
    }
    let base = Boundary::plane("base", Vector2::new(0.0, 0.0), Vector2::new(0.0, 1.0), Friction::Bonded);
    let mut scene = scene(&brick, AnyLaw::MuI(law), DENSITY * fault.density, points, vec![base]);
    scene.gravity = [along, -down].map(|g| g * fault.gravity);
    scene.numerics.pic = PicShare::Fraction(5e-4);
    let mut sim = Simulation::new(scene);
    let end = UNTIL * (DEPTH / down).sqrt();
    run_until(&mut sim, (1.0 - LATE) * end)?;
    let (before, since) = (points_by_number(&sim), sim.time());
    run_until(&mut sim, end)?;

    // Means over layers of points, by their numbers, in the middle; each half of it for itself.
    let layers = 2 * cells;
    let mut sums = vec![[[0.0; 3]; 2]; layers];
    let (middle, reach) = (0.5 * LONG as f64 * DEPTH, 4.0 * DEPTH);
    for (was, p) in before.iter().zip(points_by_number(&sim)) {
        let layer = p.id as usize / (2 * LONG * cells);
        let off = p.x[0] - middle;
        if off.abs() < reach {
            let sum = &mut sums[layer][usize::from(off > 0.0)];
            *sum = [sum[0] + 1.0, sum[1] + (p.x[0] - was.x[0]) / (sim.time() - since), sum[2] + p.x[1]];
        }
    }
    let top = exact_velocity(DEPTH);
    let mut rows = Vec::new();
    let (mut squares, mut on_elastic, mut halves) = (0.0, 0.0, 0.0f64);
    for [left, right] in &sums {
        let n = left[0] + right[0];
        let (v, y) = ((left[1] + right[1]) / n, (left[2] + right[2]) / n);
        let exact = exact_velocity(y.min(DEPTH));
        let elastic = elastic_velocity(y.min(DEPTH), soil.elastic.shear());
        squares += (v - exact).powi(2) / layers as f64;
        on_elastic += (v - elastic).powi(2) / layers as f64;
        halves = halves.max((left[1] / left[0] - right[1] / right[0]).abs() / top);
        rows.push(vec![grid as f64, y / DEPTH, v / top, exact / top, elastic / top]);
    }
    // Deficits to the surface go with a power of the depth below it: from the lower half of the layer, where they are large.
    let [lowest, half] = [0, cells].map(|k| [rows[k][1], rows[k][2]]);
    let last = &rows[layers - 1];
    let exponent = libm::log((1.0 - lowest[1]) / (1.0 - half[1])) / libm::log((1.0 - lowest[0]) / (1.0 - half[0]));
    let [rms, on_elastic] = [squares, on_elastic].map(|s: f64| s.sqrt() / top);
    Ok(Seen { surface: last[2] / last[3], rms, on_elastic, halves, exponent, rows })
}

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let mut outcome = Outcome::default();
    let grids = if *fault == Fault::NONE { 0..2 } else { 0..1 };
    let mut rows = Vec::new();
    for grid in grids {
        let seen = flow(grid, fault)?;
        let (name, cells) = (NAMES[grid], GRIDS[grid] as f64);
        // The outermost cell shears by this much of the velocity of the surface.
        let outermost = libm::pow(cells, -1.5);
        let why =
            "the outermost cell, where the pressure on the grid is not that of the depth, shears by cells^-1.5 of it";
        outcome.check(
            Check::value(format!("{name}: velocity of the topmost points over Bagnold's"), seen.surface, 1.0, "1")
                .within(Tolerance::Absolute(outermost), why)
                .from(Kind::Analytic, "2/3 I/d sqrt(rho g cos(theta)/rho_s) (H^1.5 - (H - y)^1.5)"),
        );
        outcome.check(
            Check::at_most(
                format!("{name}: difference to the profile over the velocity of the surface, rms"),
                seen.rms,
                outermost,
                "1",
            )
            .because(why)
            .from(Kind::Analytic, "Bagnold's profile"),
        );
        outcome.check(
            Check::at_most(
                format!("{name}: difference to the profile on an elastic skeleton over the same, rms"),
                seen.on_elastic,
                outermost / cells.sqrt(),
                "1",
            )
            .because("of the outermost cell, which is one of so many")
            .from(Kind::Analytic, "Bagnold's profile, the pressure less by tau^2/G"),
        );
        outcome.check(
            Check::value(format!("{name}: exponent of the profile"), seen.exponent, 1.5, "1")
                .within(
                    Tolerance::Absolute(2.0 * outermost),
                    "twice the share of the outermost cell, over a logarithm of about one half",
                )
                .from(Kind::Analytic, "Bagnold's profile"),
        );
        outcome.check(
            Check::at_most(format!("{name}: difference between both sides of the middle"), seen.halves, 0.01, "1")
                .because("ends that had a say would make a slope along the layer; a percent is less than is asked of the profile")
                .from(Kind::Conservation, "the profile does not depend on the place"),
        );
        rows.extend(seen.rows);
    }
    let header = ["grid", "height_over_depth", "velocity", "velocity_exact", "velocity_on_elastic"];
    outcome.tables.push(("bagnold_profile".into(), named_csv(&header, &[("grid", &NAMES)], rows)));
    Ok(outcome)
}
