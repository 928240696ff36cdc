//! A confined elastic column settles under its own weight.
//!
//! Equilibrium fixes the vertical stress whatever the law; the settlement tells the logarithmic law from others: at the load
//! number q = 0.087 of the soft column, small-strain elasticity would settle 2.8 % more. The column rests on a plane between
//! smooth side walls; it settles with damping near critical until its kinetic energy is gone.
//!
//! The order of the stress is measured on a column five times as stiff. On the soft one the domains of uGIMP do not shrink with the points
//! and come to overlap by up to q. The stress then scatters from point to point by 0.3 % of rho0 g L on any grid finer than 40 cells. The
//! position on the stiff column is right to 0.03 % on all grids, too good for an order. The table of convergence shows all of it.

use super::report::{named_csv, table_csv};
use super::scene::{Brick, Material, THICKNESS, points_by_number, run_until, scene};
use super::{Fault, FaultKind, Outcome, Rung, RungFailure};
use crate::figure::{Figure, curves, exact, measured};
use crate::of_module;
use checkdam::boundary::{Boundary, Friction};
use checkdam::check::{Check, Expected, Kind, Tolerance};
use checkdam::plot::curves::{Curves, panel};
use checkdam::simulation::{PicShare, Simulation};
use checkdam::theory::elastic::confined_speed;
use checkdam::theory::order;
use checkdam::theory::self_weight::Column;
use nalgebra::Vector2;

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "A confined column under its own weight: stress, settlement, energy and weight on the base, three grids",
    goal: "Stress, settlement, stored energy and the force on the base of a column in equilibrium",
    source: "equilibrium, sigma = -rho0 g (L - Y), and the logarithmic law of rates in theory::self_weight",
    sketch: r"
   smooth  |o o|  smooth      |
           |o o|              | g
           |o o|              v
           |o o|   L
   --------+---+--------  base: the column's weight
",
    run,
    covers: &[
        (FaultKind::Gravity, 1.03),
        (FaultKind::Density, 1.03),
        (FaultKind::Modulus, 1.05),
        (FaultKind::ContactForce, 1.02),
    ],
    under_fault: "all",
    figures: FIGURES,
};

/// Its figures.
const FIGURES: &[Figure] = &[
    curves(
        "self_weight_profile",
        "self_weight_profile_plot",
        Curves {
            x: "y_exact_m",
            x_title: "height (m)",
            y_title: "vertical stress (Pa)",
            curves: &[measured("stress_pa", "points"), exact("stress_exact_pa", "exact")],
            split: &[("cell_size_m", "cell size (m) ")],
            ..Curves::LINEAR
        },
    ),
    curves(
        "self_weight_convergence",
        "self_weight_convergence_plot",
        Curves {
            x: "cells",
            x_title: "cells over the height",
            y_title: "relative error",
            curves: &[
                measured("stress_error", "stress"),
                measured("position_error", "position"),
                measured("energy_error", "elastic energy"),
            ],
            panels: &[panel("soft column", &[("column", "soft")]), panel("stiff column", &[("column", "stiff")])],
            orders: &[1.0, 2.0],
            ..Curves::LOGARITHMIC
        },
    ),
];

const SOFT: Material = Material::new(1e5, 0.3, 1500.0);
const STIFF: Material = Material::new(5e5, 0.3, 1500.0);
const HEIGHT: f64 = 0.8;
const GRAVITY: f64 = 9.81;
const GRIDS: [usize; 3] = [20, 40, 80];
const CELLS_WIDE: usize = 2;

/// What one grid gives.
struct Settled {
    /// Sum of |stress error| x volume over weight x volume.
    stress_error: f64,
    /// Mean |error of position| over the exact settlement of the top.
    position_error: f64,
    /// Height of the top: that of the topmost points plus the half of their height now.
    top: f64,
    energy: f64,
    base_force: f64,
    /// Mean vertical stress of the lowest layer of points, and what it should be there.
    bottom_stress: [f64; 2],
    kinetic: f64,
    profile: Vec<Vec<f64>>,
}

fn column(soil: &Material) -> Column {
    Column { height: HEIGHT, density: soil.density, gravity: GRAVITY, modulus: soil.elastic.confined() }
}

fn settle(soil: &Material, cells: usize, fault: &Fault) -> Result<Settled, RungFailure> {
    let exact = column(soil);
    let h = HEIGHT / cells as f64;
    let brick = Brick::new([0.0, 0.0], [CELLS_WIDE, cells], h);
    let width = CELLS_WIDE as f64 * h;
    let at = Vector2::new;
    let boundaries = vec![
        Boundary::plane("base", at(0.0, 0.0), at(0.0, 1.0), Friction::Smooth),
        Boundary::plane("left", at(0.0, 0.0), at(1.0, 0.0), Friction::Smooth),
        Boundary::plane("right", at(width, 0.0), at(-1.0, 0.0), Friction::Smooth),
    ];
    let start = brick.points();
    let density = soil.density * fault.density;
    let mut scene = scene(&brick, soil.law(fault), density, start.clone(), boundaries);
    scene.gravity = [0.0, -GRAVITY * fault.gravity];
    // Damping acts on the nodes; motion of the points that no node sees needs a little PIC.
    scene.numerics.pic = PicShare::Fraction(0.02);
    let mut sim = Simulation::new(scene);
    // Critical damping of the first mode, of quarter wave length L.
    let speed = confined_speed(&soil.elastic, soil.density);
    sim.set_damping(std::f64::consts::PI * speed / HEIGHT);
    run_until(&mut sim, 15.0 * HEIGHT / speed)?;

    let dt = sim.time_step().dt;
    let base_force = sim.step_tallies()[0].impulse[1] / dt * fault.contact_force;
    let volume = sim.bodies()[0].point_volume;
    let scale = exact.density * GRAVITY * HEIGHT;
    let (mut error, mut position_error, mut total, mut profile) = (0.0, 0.0, 0.0, Vec::new());
    let (mut top, mut bottom, mut in_row) = (0.0, [0.0; 2], 0.0);
    for (p, p0) in points_by_number(&sim).iter().zip(&start) {
        let (y0, stress) = (p0.x[1], p.state.stress.yy);
        position_error += (p.x[1] - exact.position(y0)).abs() / (HEIGHT - exact.settled_height());
        error += (stress - exact.stress(y0)).abs() * volume;
        total += scale * volume;
        let half = 0.25 * h;
        if y0 > HEIGHT - h * 0.5 {
            top += p.x[1] + half * p.volume_ratio;
            in_row += 1.0;
        }
        if y0 < 0.5 * h {
            bottom = [bottom[0] + stress, exact.stress(y0)];
        }
        if p0.x[0] < 0.5 * h {
            profile.push(vec![h, y0, p.x[1], exact.position(y0), stress, exact.stress(y0)]);
        }
    }
    let stock = sim.stock();
    Ok(Settled {
        stress_error: error / total,
        position_error: position_error / start.len() as f64,
        top: top / in_row,
        energy: stock.elastic / (width * THICKNESS),
        base_force: base_force / (width * THICKNESS),
        bottom_stress: [bottom[0] / in_row, bottom[1]],
        kinetic: stock.kinetic / stock.elastic,
        profile,
    })
}

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let mut outcome = Outcome::default();
    let soft = GRIDS.iter().map(|&n| settle(&SOFT, n, fault)).collect::<Result<Vec<_>, _>>()?;
    let stiff = GRIDS.iter().map(|&n| settle(&STIFF, n, fault)).collect::<Result<Vec<_>, _>>()?;
    judge(&soft[2], &mut outcome);
    let mut rows = convergence(&SOFT, &soft, &["position", "elastic energy"], &mut outcome);
    rows.extend(convergence(&STIFF, &stiff, &["stress"], &mut outcome));
    for (k, row) in rows.iter_mut().enumerate() {
        row.insert(0, (k / GRIDS.len()) as f64);
    }
    let header = [
        "column",
        "load_number",
        "cells",
        "stress_error",
        "stress_order",
        "position_error",
        "position_order",
        "energy_error",
        "energy_order",
    ];
    outcome
        .tables
        .push(("self_weight_convergence".into(), named_csv(&header, &[("column", &["soft", "stiff"])], rows)));
    let header = ["cell_size_m", "y0_m", "y_m", "y_exact_m", "stress_pa", "stress_exact_pa"];
    let profiles = soft.into_iter().flat_map(|r| r.profile);
    outcome.tables.push(("self_weight_profile".into(), table_csv(&header, profiles)));
    Ok(outcome)
}

/// The soft column on the finest grid.
fn judge(fine: &Settled, outcome: &mut Outcome) {
    let exact = column(&SOFT);
    let h = HEIGHT / GRIDS[2] as f64;

    outcome.check(
        Check::at_most("kinetic over elastic energy at the end, finest grid", fine.kinetic, 1e-9, "1")
            .because("15 L/c of critical damping leave exp(-23) of the amplitude")
            .from(Kind::Analytic, "damped oscillator"),
    );
    let weight = exact.density * GRAVITY * HEIGHT;
    outcome.check(
        Check::value("force on the base over its area", fine.base_force, weight, "Pa")
            .within(
                Tolerance::Relative(1e-4),
                "at rest the impulse of a step is the weight; kinetic over elastic energy of 1e-9 leaves 3e-5 of it moving",
            )
            .from(Kind::Conservation, "Newton's third law: rho0 g L"),
    );
    outcome.check(
        Check::at_most("stress: mean error over rho0 g L, finest grid", fine.stress_error, h / HEIGHT, "1")
            .because("first order: the weight of one cell of L/80 bounds the error of the profile")
            .from(Kind::Analytic, "equilibrium: sigma = -rho0 g (L - Y)"),
    );
    outcome.check(
        Check::value("stress of the lowest points, finest grid", fine.bottom_stress[0], fine.bottom_stress[1], "Pa")
            .within(Tolerance::Relative(h / HEIGHT), "half the weight of a cell either way, at the points' own depth")
            .from(Kind::Analytic, "equilibrium: sigma = -rho0 g (L - Y)"),
    );
    outcome.check(
        Check::value("settlement of the top, finest grid", HEIGHT - fine.top, HEIGHT - exact.settled_height(), "m")
            .within(Tolerance::Relative(h / HEIGHT), "first order: one cell in the height that carries")
            .from(Kind::Analytic, "logarithmic law: L (1 - exp(-q)) / q"),
    );
    outcome.check(
        Check::value("elastic energy over the base area, finest grid", fine.energy, exact.elastic_energy(), "J/m2")
            .within(Tolerance::Relative(2.0 * h / HEIGHT), "quadratic in the stress: twice its tolerance")
            .from(Kind::Analytic, "logarithmic law: integral of sigma^2 / (2 M)"),
    );
}

/// Errors by grid with their orders, as rows of a table; those of the quantities `judged` become checks.
fn convergence(soil: &Material, results: &[Settled], judged: &[&str], outcome: &mut Outcome) -> Vec<Vec<f64>> {
    let exact = column(soil);
    let quantities: [(&str, Vec<f64>); 3] = [
        ("stress", results.iter().map(|r| r.stress_error).collect()),
        ("position", results.iter().map(|r| r.position_error).collect()),
        ("elastic energy", results.iter().map(|r| (r.energy / exact.elastic_energy() - 1.0).abs()).collect()),
    ];
    for (what, e) in quantities.iter().filter(|q| judged.contains(&q.0)) {
        for (pair, grids) in e.windows(2).zip(["20 to 40 cells", "40 to 80 cells"]) {
            outcome.check(
                Check::new(
                    format!("q = {:.4}: observed order of {what}, {grids}", exact.load()),
                    order::from_errors(pair[0], pair[1], 2.0),
                    Expected::Within(0.75, 2.25),
                    "1",
                )
                .because("first order at the boundaries, second inside, a quarter of an order of margin")
                .from(Kind::Convergence, "Steffen, Kirby and Berzins 2008"),
            );
        }
    }
    (0..GRIDS.len())
        .map(|i| {
            let mut row = vec![exact.load(), GRIDS[i] as f64];
            for (_, e) in &quantities {
                row.extend([e[i], if i > 0 { order::from_errors(e[i - 1], e[i], 2.0) } else { f64::INFINITY }]);
            }
            row
        })
        .collect()
}
