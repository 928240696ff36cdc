//! Waves in bars: how fast a pulse runs, and what a bar does to a rigid wall that it strikes.
//!
//! The pulse is a Gaussian of velocity v and stress -rho c v, which runs one way. Its arrival at a station is the centroid of
//! v^2 over time at the points there: it needs no threshold, and noise averages out. On the grid it lags by a known amount,
//! which is checked, too. The free bar has Poisson's ratio zero and
//! runs at sqrt(E/rho); the confined one lies between smooth walls and runs at sqrt(M/rho), 16 % faster at nu = 0.3.

use super::report::{named_csv, table_csv};
use super::scene::{Brick, Material, THICKNESS, points_by_number, scene};
use super::{Fault, FaultKind, Outcome, Rung, RungFailure};
use crate::figure::{Figure, curves, exact, measured};
use crate::of_module;
use checkdam::boundary::{Boundary, Friction};
use checkdam::check::{Check, Expected, Kind, Tolerance};
use checkdam::plot::curves::Curves;
use checkdam::simulation::Simulation;
use checkdam::theory::{bar, dispersion, elastic, order};
use nalgebra::Vector2;

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "Speed of a pulse in a free and a confined bar, three grids; a bar that strikes a rigid wall",
    goal: "A pulse runs at sqrt(E/rho) in a free bar and sqrt(M/rho) in a confined one; a bar pushes a wall by rho c v",
    source: "d'Alembert's wave equation; Saint-Venant's impact of a bar; dispersion of the scheme",
    sketch: r"
   pulse -->   1     2     3     4   stations
   +---/\------|-----|-----|-----|---------+
   |__/  \__________________________________|  free, or between
   +-----------------------------------------+ smooth walls
   bar --> v |wall:  rho c v A  for 2 L/c
",
    run,
    covers: &[(FaultKind::Modulus, 1.03), (FaultKind::Density, 1.03), (FaultKind::ContactForce, 1.03)],
    under_fault: "all",
    figures: FIGURES,
};

/// Its figures.
const FIGURES: &[Figure] = &[
    curves(
        "celerity_lag",
        "celerity_lag_plot",
        Curves {
            x: "cells",
            x_title: "cells along the bar",
            y_title: "lag of a pulse behind the wave speed",
            curves: &[measured("lag", ""), exact("lag_exact", "dispersion of the scheme")],
            split: &[("bar", "")],
            orders: &[2.0],
            ..Curves::LOGARITHMIC
        },
    ),
    curves(
        "celerity_impact",
        "celerity_impact_plot",
        Curves {
            x: "time_s",
            x_title: "time after contact (s)",
            y_title: "force on the wall (N)",
            curves: &[measured("force_n", "bar strikes wall"), exact("force_exact_n", "rho c v A for 2L/c")],
            ..Curves::LINEAR
        },
    ),
];

const FREE: Material = Material::new(1e6, 0.0, 1500.0);
const CONFINED: Material = Material::new(1e6, 0.3, 1500.0);
const LENGTH: f64 = 2.0;
/// Standard deviation of the pulse along the bar, m.
const WIDTH: f64 = 0.1;
/// Where the pulse starts, m.
const START: f64 = 0.45;
const COURANT: f64 = 0.4;
const STATIONS: [f64; 4] = [0.85, 1.05, 1.25, 1.45];
const GRIDS: [usize; 3] = [80, 160, 320];
/// Amplitude over wave speed: strains of 1e-4, so that the material is linear.
const MACH: f64 = 1e-4;

/// Smooth walls above and below a bar.
fn walls(height: f64) -> Vec<Boundary> {
    vec![
        Boundary::plane("below", Vector2::zeros(), Vector2::new(0.0, 1.0), Friction::Smooth),
        Boundary::plane("above", Vector2::new(0.0, height), Vector2::new(0.0, -1.0), Friction::Smooth),
    ]
}

/// Where (m) and when (s) the pulse passes the stations.
fn arrivals(bar: &Bar, cells: usize, fault: &Fault) -> Result<Vec<[f64; 2]>, RungFailure> {
    let Bar { material, speed, confined, .. } = *bar;
    let h = LENGTH / cells as f64;
    let brick = Brick::new([0.0, 0.0], [cells, 2], h);
    let mut points = brick.points();
    let lateral = if confined { -material.density * speed * material.elastic.lateral_ratio() } else { 0.0 };
    let mut stations = STATIONS.map(|x| Station { at: x, places: vec![], sums: [0.0; 2] });
    let mut station_of = Vec::new();
    for p in &mut points {
        let r = (p.x[0] - START) / WIDTH;
        let v = MACH * speed * libm::exp(-0.5 * r * r);
        p.v[0] = v;
        p.state.stress.xx = -material.density * speed * v;
        p.state.stress.yy = lateral * v;
        p.state.stress.zz = lateral * v;
        station_of.push(stations.iter().position(|s| (p.x[0] - s.at).abs() < 0.5 * h));
        if let Some(&Some(s)) = station_of.last() {
            stations[s].places.push(p.x[0]);
        }
    }
    let boundaries = if confined { walls(2.0 * h) } else { vec![] };
    let mut scene = scene(&brick, material.law(fault), material.density * fault.density, points, boundaries);
    scene.numerics.max_time_step = COURANT * h / speed;
    let mut sim = Simulation::new(scene);
    // Until the pulse has passed the last station by four widths and is still far from the end.
    let end = (STATIONS[3] - START + 4.0 * WIDTH) / speed;
    while sim.time() < end {
        sim.step()?;
        // In this scheme velocities belong to the middle of the step.
        let t = sim.time() - 0.5 * sim.time_step().dt;
        for (_, p) in sim.particles() {
            if let Some(s) = station_of[p.id as usize] {
                let square = p.v[0] * p.v[0];
                stations[s].sums[0] += square;
                stations[s].sums[1] += square * t;
            }
        }
    }
    let mean = |s: &Station| s.places.iter().sum::<f64>() / s.places.len() as f64;
    Ok(stations.iter().map(|s| [mean(s), s.sums[1] / s.sums[0]]).collect())
}

/// Points within half a cell of a place, with the sums of v^2 and v^2 t.
struct Station {
    at: f64,
    places: Vec<f64>,
    sums: [f64; 2],
}

#[derive(Clone, Copy)]
struct Bar {
    name: &'static str,
    material: Material,
    speed: f64,
    confined: bool,
    law: &'static str,
}

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let mut outcome = Outcome::default();
    let (mut rows, mut lags) = (Vec::new(), Vec::new());
    let free = elastic::bar_speed(&FREE.elastic, FREE.density);
    let confined = elastic::confined_speed(&CONFINED.elastic, CONFINED.density);
    for bar in [
        Bar { name: "free bar", material: FREE, speed: free, confined: false, law: "sqrt(E/rho)" },
        Bar { name: "confined bar", material: CONFINED, speed: confined, confined: true, law: "sqrt(M/rho)" },
    ] {
        pulse(&bar, fault, &mut outcome, &mut rows, &mut lags)?;
    }
    let names: [(&str, &[&str]); 1] = [("bar", &["free bar", "confined bar"])];
    outcome.tables.push(("celerity_lag".into(), named_csv(&["bar", "cells", "lag", "lag_exact"], &names, lags)));
    let header = ["bar", "cells", "station_m", "arrival_s", "speed_m_s", "speed_on_grid_m_s", "speed_exact_m_s"];
    outcome.tables.push(("celerity_arrivals".into(), named_csv(&header, &names, rows)));
    impact(fault, &mut outcome)?;
    Ok(outcome)
}

/// Speed between the stations on three grids.
fn pulse(
    bar: &Bar,
    fault: &Fault,
    outcome: &mut Outcome,
    rows: &mut Vec<Vec<f64>>,
    lags: &mut Vec<Vec<f64>>,
) -> Result<(), RungFailure> {
    let Bar { name, speed, .. } = *bar;
    let mut errors = Vec::new();
    for cells in GRIDS {
        let passed = arrivals(bar, cells, fault)?;
        let between = |a: usize, b: usize| (passed[b][0] - passed[a][0]) / (passed[b][1] - passed[a][1]);
        let lag = dispersion::pulse_speed_ratio(WIDTH * cells as f64 / LENGTH, COURANT);
        let kind = f64::from(u8::from(bar.confined));
        lags.push(vec![kind, cells as f64, 1.0 - between(0, 3) / speed, 1.0 - lag]);
        for k in 1..4 {
            rows.push(vec![kind, cells as f64, passed[k][0], passed[k][1], between(k - 1, k), lag * speed, speed]);
            if cells == GRIDS[1] {
                outcome.check(
                    Check::value(
                        format!("{name}: speed of a pulse up to {} m", STATIONS[k]),
                        between(k - 1, k),
                        speed,
                        "m/s",
                    )
                    .within(
                        Tolerance::Relative(0.005),
                        "dispersion of a pulse 8 cells wide, 0.3 %, and as much again for the stations",
                    )
                    .from(Kind::Analytic, bar.law),
                );
            }
        }
        errors.push((between(0, 3) / speed - 1.0).abs());
        outcome.check(
            Check::value(
                format!("{name}, {cells} cells: lag of the pulse, mean over 0.6 m"),
                1.0 - between(0, 3) / speed,
                1.0 - lag,
                "1",
            )
            .within(
                Tolerance::Relative(0.15),
                "a pulse that spreads has its centroid a little off; grows with the lag squared",
            )
            .from(Kind::Analytic, "dispersion of the scheme on points at rest, theory::dispersion"),
        );
    }
    for (pair, grids) in errors.windows(2).zip(["80 to 160 cells", "160 to 320 cells"]) {
        outcome.check(
            Check::value(
                format!("{name}: observed order of the speed, {grids}"),
                order::from_errors(pair[0], pair[1], 2.0),
                2.0,
                "1",
            )
            .within(
                Tolerance::Absolute(0.3),
                "second order in space and time; the pulse is 4 cells wide on the coarsest grid",
            )
            .from(Kind::Convergence, "dispersion of the scheme"),
        );
    }
    Ok(())
}

/// A bar that flew against a wall and is away from it again.
struct Bounce {
    /// Of the wall on the bar, N s.
    impulse: f64,
    /// Mean force between 20 and 80 % of the contact, N.
    mean_force: f64,
    /// How long the force was more than half of the plateau, s.
    held: f64,
    /// Velocity away from the wall, m/s.
    back: f64,
    mass: f64,
    /// Of the closed form, N.
    plateau: f64,
    /// Time (s), force and that of the closed form (N).
    rows: Vec<Vec<f64>>,
}

/// Length of the bar, m.
const BAR: f64 = 1.0;

/// A bar of so many cells flies against a rigid wall at `v` (m/s).
fn bounce(fault: &Fault, cells: usize, v: f64) -> Result<Bounce, RungFailure> {
    let h = BAR / cells as f64;
    let speed = elastic::bar_speed(&FREE.elastic, FREE.density);
    let brick = Brick::new([0.0, 0.0], [cells, 2], h);
    let mut points = brick.points();
    points.iter_mut().for_each(|p| p.v[0] = -v);
    let wall = Boundary::plane("wall", Vector2::zeros(), Vector2::new(1.0, 0.0), Friction::Smooth);
    let scene = scene(&brick, FREE.law(fault), FREE.density * fault.density, points, vec![wall]);
    let mut sim = Simulation::new(scene);
    let area = 2.0 * h * THICKNESS;
    let plateau = bar::impact_stress(FREE.density, speed, v) * area;
    let duration = bar::contact_duration(BAR, speed);
    let (mut impulse, mut held, mut mean) = (0.0, 0.0, [0.0; 2]);
    let (mut rows, mut window) = (Vec::new(), [0.0; 2]);
    while sim.time() < 1.5 * duration {
        sim.step()?;
        let dt = sim.time_step().dt;
        let push = sim.step_tallies()[0].impulse[0] * fault.contact_force;
        impulse += push;
        let share = sim.time() / duration;
        if (0.2..0.8).contains(&share) {
            mean = [mean[0] + push, mean[1] + dt];
        }
        // Force over 2 % of the duration, so that single steps do not count as contact.
        window = [window[0] + push, window[1] + dt];
        if window[1] >= 0.02 * duration {
            let force = window[0] / window[1];
            held += if force > 0.5 * plateau { window[1] } else { 0.0 };
            rows.push(vec![sim.time(), force, if share < 1.0 { plateau } else { 0.0 }]);
            window = [0.0; 2];
        }
    }
    let points = points_by_number(&sim);
    let back = points.iter().map(|p| p.v[0]).sum::<f64>() / points.len() as f64;
    Ok(Bounce { impulse, mean_force: mean[0] / mean[1], held, back, mass: FREE.density * BAR * area, plateau, rows })
}

/// The impact at 1 % of the bar's wave speed, on two grids. A sudden front spreads by the scheme's dispersion, of second order in h,
/// over (h/L)^(2/3) of its way (the Airy front of a dispersive wave, Whitham 1974). What has not come back to the wall when the bar
/// leaves it stays in the bar as ringing: the rebound tends to the exact one by that order.
fn impact(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    const ORDER: f64 = 2.0 / 3.0;
    let speed = elastic::bar_speed(&FREE.elastic, FREE.density);
    let v = 0.01 * speed;
    let duration = bar::contact_duration(BAR, speed);
    let [coarse, fine] = [bounce(fault, 100, v)?, bounce(fault, 200, v)?];
    outcome.check(
        Check::value(
            "bar on wall: mean force between 20 and 80 % of the contact",
            coarse.mean_force,
            coarse.plateau,
            "N",
        )
        .within(Tolerance::Relative(0.01), "strains of 1 % change impedance and area of the bar by about 0.5 %")
        .from(Kind::Analytic, "Saint-Venant 1867: rho c v A"),
    );
    outcome.check(
        Check::value("bar on wall: duration of contact", coarse.held, duration, "s")
            .within(Tolerance::Relative(0.04), "read in windows of 2 %, at either end")
            .from(Kind::Analytic, "2 L / c"),
    );
    let extrapolated = |of: &dyn Fn(&Bounce) -> f64| {
        let ratio = libm::pow(2.0, ORDER);
        (ratio * of(&fine) - of(&coarse)) / (ratio - 1.0)
    };
    outcome.check(
        Check::value(
            "bar on wall: impulse over that of perfect rebound, extrapolated from 100 and 200 cells",
            extrapolated(&|b| b.impulse / bar::rebound_impulse(b.mass, v, 1.0)),
            1.0,
            "1",
        )
        .within(Tolerance::Absolute(0.005), "strains of 1 % change impedance and area of the bar by about 0.5 %")
        .from(Kind::Analytic, "2 m v"),
    );
    outcome.check(
        Check::value(
            "bar on wall: restitution, extrapolated from 100 and 200 cells",
            extrapolated(&|b| b.back / v),
            1.0,
            "1",
        )
        .within(Tolerance::Absolute(0.005), "as the impulse")
        .from(Kind::Analytic, "an elastic bar gives all back"),
    );
    outcome.check(
        Check::value(
            "bar on wall: observed order of the loss in restitution, 100 to 200 cells",
            order::from_errors(1.0 - coarse.back / v, 1.0 - fine.back / v, 2.0),
            ORDER,
            "1",
        )
        .within(Tolerance::Absolute(0.1), "the next term of the front's spreading is smaller by (h/L)^(1/3) = 0.2")
        .from(Kind::Convergence, "Airy front of a dispersive wave"),
    );
    outcome.check(
        Check::new("bar on wall: restitution on 200 cells", fine.back / v, Expected::Within(0.0, 1.0 + 1e-3), "1")
            .because("more than 1 would be energy from nothing")
            .from(Kind::Conservation, "first law"),
    );
    let momentum = coarse.mass * (v + coarse.back);
    outcome.check(
        Check::value("bar on wall: impulse against change of momentum", coarse.impulse, momentum, "N s")
            .within(Tolerance::Relative(1e-10), "one is the sum of the other, step by step")
            .from(Kind::Conservation, "Newton's second law"),
    );
    outcome.tables.push(("celerity_impact".into(), table_csv(&["time_s", "force_n", "force_exact_n"], coarse.rows)));
    Ok(())
}
