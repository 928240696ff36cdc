//! A flow enters through a section: what comes in is what the case says.
//!
//! Free of all forces a flow goes on as it comes in, so that its mass, momentum and energy have closed forms at every moment. A plug on a
//! slope whose bed has the friction of the slope keeps its velocity and its depth, and lies on the bed with its weight.

use super::report::{named_csv, table_csv};
use super::{Fault, FaultKind, Outcome, Rung, RungFailure};
use crate::figure::{Figure, curves, exact, measured};
use crate::of_module;
use checkdam::case::{self, Case};
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::plot::curves::{Curves, panel};
use checkdam::run::inflow::simulation;
use checkdam::simulation::Simulation;
use checkdam::theory::uniform_flow::{self, BAGNOLD_MOMENTUM, LINEAR_MOMENTUM};

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "A flow enters: mass, momentum, energy by profile, front and hydrograph; a plug on a slope of its friction",
    goal: "What enters is rho d u t; a plug on tan(theta) = mu keeps its speed, its depth and its stress",
    source: "continuity; equilibrium of an infinite slope; Bagnold (1954)",
    sketch: r"
    led :  u ->
    o o : o o o o o\     g
    o o : o o o o o o\    \
    ====:==================\  tan(theta) = mu
     section
",
    run,
    covers: &[(FaultKind::Density, 1.03), (FaultKind::Gravity, 1.03)],
    under_fault: "the free plug and the plug on the slope",
    figures: FIGURES,
};

/// Its figures.
const FIGURES: &[Figure] = &[
    curves(
        "inflow_mass",
        "inflow_mass_plot",
        Curves {
            x: "time_s",
            x_title: "time (s)",
            y_title: "mass that has entered (kg)",
            curves: &[measured("entered_kg", "entered"), exact("continuous_kg", "rho x area under the hydrograph")],
            panels: &[panel("plug", &[("scene", "plug")]), panel("hydrograph", &[("scene", "hydrograph")])],
            ..Curves::LINEAR
        },
    ),
    curves(
        "inflow_slope",
        "inflow_slope_plot",
        Curves {
            x: "x_m",
            x_title: "x from the section (m)",
            y_title: "velocity over that at the section, depth over that given",
            curves: &[measured("velocity_1", "velocity"), measured("depth_1", "depth")],
            ..Curves::LINEAR
        },
    ),
];

const DENSITY: f64 = 1500.0;
const GRAVITY: f64 = 9.81;
const WIDTH: f64 = 0.5;
const DEPTH: f64 = 0.4;
const SPEED: f64 = 3.0;
/// Of the cells, m; four points a cell.
const CELL: f64 = 0.1;
const SPACING: f64 = 0.05;
/// Friction of the bed and tangent of the slope.
const FRICTION: f64 = 0.4;
/// Where its velocity is judged: two and a half depths, m.
const NEAR: f64 = 1.0;
/// How long the flow on the slope enters, s, all the while.
const SLIDES: f64 = 1.5;

/// A scene: its case, with the faults, but not what should come out.
fn case_of(fault: &Fault, gravity: f64, inflow: &str) -> Result<Case, RungFailure> {
    let contact = if gravity > 0.0 {
        format!("\"coulomb\", friction = {}", FRICTION * fault.friction)
    } else {
        "\"smooth\"".to_owned()
    };
    let (g, slope) = (gravity * fault.gravity, libm::atan(FRICTION).to_degrees());
    let text = format!(
        "title = \"a flow enters\"
        gravity = {{ magnitude_m_per_s2 = {g}, inclination_deg = {slope} }}
        grid = {{ spacing_m = {CELL}, thickness_m = {WIDTH} }}
        domain = {{ x_m = [-1, 15], y_m = [-0.5, 3] }}
        materials.sand = {{ law = \"drucker_prager\", density_kg_per_m3 = {density}, young_pa = {young}, poisson = 0.3, friction_angle_deg = 35 }}
        inflows = [{{ name = \"flow\", material = \"sand\", foot_m = [0, 0], {inflow} }}]
        boundaries = [{{ name = \"bed\", kind = \"plane\", point_m = [0, 0], normal_deg = 90, contact = {contact} }}]
        stages.run = {{ end_time_s = 10 }}
        output.vtk_interval_s = 0",
        density = DENSITY * fault.density,
        young = 1e6 * fault.modulus,
    );
    Ok(case::parse(&text, "inflow.toml").map_err(|e| RungFailure::Files(e.to_string()))?.case)
}

fn opened(case: &Case) -> Simulation {
    let mut sim = simulation(case);
    sim.open_ledger();
    sim.open_inflows();
    sim
}

/// Mass of a column of a depth, kg: what has entered is behind by less.
fn column(depth: f64) -> f64 {
    DENSITY * depth * WIDTH * SPACING
}

/// A flow on which nothing acts, stepped until it has entered: mass that has entered over time, and the simulation.
fn free(fault: &Fault, inflow: &str, until: f64) -> Result<(Vec<[f64; 2]>, Simulation), RungFailure> {
    let mut sim = opened(&case_of(fault, 0.0, inflow)?);
    let mut rows = Vec::new();
    while sim.time() < until {
        sim.step()?;
        rows.push([sim.time(), sim.ledger().entered_mass]);
    }
    Ok((rows, sim))
}

fn constant(profile: &str, more: &str) -> String {
    format!("depth_m = {DEPTH}, velocity_m_per_s = {SPEED}, duration_s = 1.0, profile = \"{profile}\"{more}")
}

/// Lag of the mass that has entered behind the continuous one, kg: the least and the largest.
fn lag(rows: &[[f64; 2]], continuous: impl Fn(f64) -> f64) -> [f64; 2] {
    let lags = rows.iter().map(|[t, m]| continuous(*t) - m);
    lags.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], lag| [low.min(lag), high.max(lag)])
}

/// A plug without forces, and what it brings by profile, front and hydrograph.
fn enters(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let (rows, sim) = free(fault, &constant("plug", ""), 1.1)?;
    let continuous = |t: f64| uniform_flow::mass(DENSITY, DEPTH, WIDTH, SPEED, t.min(1.0));
    let whole = continuous(1.0);
    let [ahead, behind] = lag(&rows, continuous);
    let step = whole * sim.time_step().dt;
    let columns = Tolerance::Absolute(0.5 * column(DEPTH) + step);
    outcome.check(
        Check::value(
            "plug: mean of least and largest lag of the mass behind rho d u t",
            0.5 * (ahead + behind),
            0.5 * column(DEPTH),
            "kg",
        )
        .within(Tolerance::Absolute(step), "columns enter as a whole, in the first step in which they have passed")
        .from(Kind::Conservation, "continuity"),
    );
    outcome.check(
        Check::value("plug: mass in all", sim.ledger().entered_mass, whole, "kg")
            .within(Tolerance::Relative(1e-9), "round-off")
            .from(Kind::Conservation, "continuity"),
    );
    outcome.check(
        Check::value("plug: momentum in all", sim.stock().momentum[0], whole * SPEED, "N s")
            .within(Tolerance::Relative(1e-9), "round-off: nothing acts")
            .from(Kind::Conservation, "rho d u^2 t"),
    );
    outcome.check(
        Check::value("plug: kinetic energy in all", sim.stock().kinetic, 0.5 * whole * SPEED * SPEED, "J")
            .within(Tolerance::Relative(1e-9), "round-off: nothing acts")
            .from(Kind::Conservation, "rho d u^3 t / 2"),
    );
    let balance = sim.energy_balance(&sim.stock(), [0.0; 2]);
    let books = [sim.ledger().entered_momentum[0] / (whole * SPEED), balance.inflow / (0.5 * whole * SPEED * SPEED)];
    for (what, book) in ["momentum", "energy"].into_iter().zip(books) {
        outcome.check(
            Check::value(format!("plug: {what} as it is booked over that in all"), book, 1.0, "1")
                .within(Tolerance::Relative(1e-9), "round-off: nothing acts")
                .from(Kind::Conservation, "continuity"),
        );
    }
    let foremost = sim.particles().map(|(_, p)| p.x[0]).fold(0.0, f64::max);
    outcome.check(
        Check::value("plug: place of the foremost point", foremost, SPEED * sim.time() - 0.5 * SPACING, "m")
            .within(Tolerance::Absolute(1e-9), "round-off: nothing acts")
            .from(Kind::Analytic, "x = u t, less half a spacing"),
    );
    if *fault != Fault::NONE {
        return Ok(());
    }
    let mut table: Vec<Vec<f64>> = rows.iter().step_by(8).map(|[t, m]| vec![0.0, *t, *m, continuous(*t)]).collect();
    for (profile, factor) in [("linear", LINEAR_MOMENTUM), ("bagnold", BAGNOLD_MOMENTUM)] {
        let (_, sim) = free(fault, &constant(profile, ""), 1.1)?;
        let ledger = sim.ledger();
        outcome.check(
            Check::value(format!("{profile}: mass in all"), ledger.entered_mass, whole, "kg")
                .within(columns, "half a point in each row, half a column in all")
                .from(Kind::Conservation, "the mean over the depth is the velocity that is given"),
        );
        outcome.check(
            Check::value(
                format!("{profile}: momentum over that of a plug of the same mass"),
                ledger.entered_momentum[0] / (ledger.entered_mass * SPEED),
                factor,
                "1",
            )
            .within(
                Tolerance::Absolute(0.02),
                "half of one of 60 points in a row is open, and rows are means over an eighth of the depth",
            )
            .from(Kind::Analytic, "mean square over square of the mean of the profile"),
        );
    }
    let (_, sim) = free(fault, &constant("plug", ", front_angle_deg = 45"), 1.1)?;
    let wedge = whole - DENSITY * WIDTH * 0.5 * DEPTH * DEPTH;
    outcome.check(
        Check::value("front of 45 degrees: mass in all", sim.ledger().entered_mass, wedge, "kg")
            .within(columns, "half a point in each row")
            .from(Kind::Conservation, "the area of the wedge"),
    );
    hydrograph(fault, &mut table, outcome)?;
    outcome.tables.push((
        "inflow_mass".into(),
        named_csv(&["scene", "time_s", "entered_kg", "continuous_kg"], &[("scene", &["plug", "hydrograph"])], table),
    ));
    Ok(())
}

/// Depth and velocity that rise and fall together.
fn hydrograph(fault: &Fault, table: &mut Vec<Vec<f64>>, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let graph = "times_s = [0, 0.4, 1], depths_m = [0.4, 0.8, 0.4], velocities_m_per_s = [1, 3, 1]";
    let (rows, _) = free(fault, graph, 1.1)?;
    // Of two straight lines from d and u with the slopes a and b: d u t + (a u + b d) t^2 / 2 + a b t^3 / 3.
    let piece =
        |d: f64, u: f64, a: f64, b: f64, t: f64| d * u * t + 0.5 * (a * u + b * d) * t * t + a * b * t * t * t / 3.0;
    let area = |t: f64| {
        piece(0.4, 1.0, 1.0, 5.0, t.min(0.4)) + piece(0.8, 3.0, -0.4 / 0.6, -2.0 / 0.6, (t - 0.4).clamp(0.0, 0.6))
    };
    let continuous = |t: f64| DENSITY * WIDTH * area(t);
    let [ahead, behind] = lag(&rows, continuous);
    let columns = column(0.8) + DENSITY * WIDTH * 0.8 * 3.0 * rows[0][0];
    outcome.check(
        Check::at_most(
            "hydrograph: mass ahead of the area below it, or more than a column behind, over a column",
            (-ahead).max(behind - columns) / columns,
            0.5,
            "1",
        )
        .because("columns of changing depth are as long as their area asks for: half of one is open")
        .from(Kind::Conservation, "integral of rho d u"),
    );
    table.extend(rows.iter().step_by(8).map(|[t, m]| vec![1.0, *t, *m, continuous(*t)]));
    Ok(())
}

/// A plug on a slope of its friction.
fn slides(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let inflow = format!("depth_m = {DEPTH}, velocity_m_per_s = {SPEED}, duration_s = {SLIDES}");
    let mut sim = opened(&case_of(fault, GRAVITY, &inflow)?);
    let (mut normal, mut heavy) = (0.0, 0.0);
    let slope = libm::atan(FRICTION);
    let reach = case::Inflow::LED_CELLS * CELL;
    while sim.time() < SLIDES - 2.0 * SPACING / SPEED {
        sim.step()?;
        // What is there and what is led, once it has come to lie.
        if sim.time() > 0.5 * SLIDES {
            normal += sim.step_tallies()[0].impulse[1];
            let there = sim.time() * SPEED + reach;
            heavy += uniform_flow::pressure(DENSITY, GRAVITY, slope, DEPTH) * WIDTH * there * sim.time_step().dt;
        }
    }
    outcome.check(
        Check::value("slope: force of the bed over the weight across it, second half", normal / heavy, 1.0, "1")
            .within(
                Tolerance::Absolute(0.015),
                "half a column that has not appeared, of 50 and more that lie on the bed: 1 %; the rest swings",
            )
            .from(Kind::Analytic, "statics"),
    );
    // Beyond the reach of the front, which spreads backwards at the speed of long waves at most.
    let far = (SPEED - (GRAVITY * libm::cos(slope) * DEPTH).sqrt()) * sim.time();
    let body = &sim.bodies()[0];
    let (mass, volume) = (body.point_mass, body.point_volume);
    let (mut momentum, mut all, mut stress, mut weight) = (0.0, 0.0, 0.0, 0.0);
    let strips = (far / (2.0 * CELL)).floor() as usize;
    let mut strip = vec![[0.0; 3]; strips];
    for (_, p) in sim.particles() {
        if !(0.0..far).contains(&p.x[0]) {
            continue;
        }
        if p.x[0] < NEAR {
            momentum += mass * p.v[0];
            all += mass;
        }
        if p.x[0] < DEPTH {
            stress -= p.state.stress.yy;
            weight += uniform_flow::pressure(DENSITY, GRAVITY, slope, DEPTH - p.x[1]);
        }
        if let Some(s) = strip.get_mut((p.x[0] / (2.0 * CELL)) as usize) {
            s[0] += 1.0;
            s[1] += p.v[0];
            s[2] += volume;
        }
    }
    outcome.check(
        Check::value(
            "slope: mean velocity in the first metre beyond the section over that at it",
            momentum / all / SPEED,
            1.0,
            "1",
        )
        .within(
            Tolerance::Absolute(0.01),
            "a layer in equilibrium goes on as it came in; what it gains further on is in the table",
        )
        .from(Kind::Analytic, "equilibrium of an infinite slope"),
    );
    outcome.check(
        Check::value(
            "slope: stress across the bed in the first depth over that of the layer",
            stress / weight,
            1.0,
            "1",
        )
        .within(Tolerance::Absolute(0.03), "waves of less than half a point's weight, 1/16")
        .from(Kind::Analytic, "equilibrium of an infinite slope"),
    );
    // Of the first strip a column may not have entered.
    let depths = strip.iter().skip(1).map(|s| s[2] / (2.0 * CELL * WIDTH * DEPTH));
    outcome.check(
        Check::value(
            "slope: mean depth by mass over that given",
            depths.sum::<f64>() / (strips as f64 - 1.0),
            1.0,
            "1",
        )
        .within(Tolerance::Absolute(0.042), "one column of the 24 of these strips may lie beyond their ends")
        .from(Kind::Conservation, "continuity at one velocity"),
    );
    let (ledger, now) = (sim.ledger(), sim.stock());
    let balance = sim.energy_balance(&now, [0.0; 2]);
    outcome.check(
        Check::at_most(
            "slope: energy that is not accounted for over what was released",
            balance.residual.abs() / balance.released(),
            0.01,
            "1",
        )
        .because("half of what a run may leave open and be trusted")
        .from(Kind::Conservation, "first law"),
    );
    let given = ledger.impulse();
    let open = (now.momentum[0] - given[0]).hypot(now.momentum[1] - given[1]);
    outcome.check(
        Check::at_most(
            "slope: momentum that is not accounted for over all impulses",
            open / ledger.impulse_scale,
            1e-10,
            "1",
        )
        .because("round-off")
        .from(Kind::Conservation, "Newton's second law"),
    );
    if *fault == Fault::NONE {
        let rows = strip.iter().enumerate().map(|(k, s)| {
            let x = 2.0 * CELL * (k as f64 + 0.5);
            vec![x, s[1] / s[0] / SPEED, s[2] / (2.0 * CELL * WIDTH * DEPTH)]
        });
        outcome.tables.push(("inflow_slope".into(), table_csv(&["x_m", "velocity_1", "depth_1"], rows)));
    }
    Ok(())
}

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let mut outcome = Outcome::default();
    enters(fault, &mut outcome)?;
    slides(fault, &mut outcome)?;
    Ok(outcome)
}
