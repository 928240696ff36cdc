//! A stiff block on a plane whose friction needs slip before it resists in full: it hangs on the elastic slip, swings on it, slides,
//! springs back, and goes round a loop.
//!
//! The closed form is a rigid block on an elastic-perfectly-plastic spring. The block is made rigid by full PIC, as in `sliding_block`,
//! where nothing else is said. Static friction above kinetic has an onset, and lets go as it falls.

mod scenes;

use super::report::named_csv;
use super::scene::run_until;
use super::{Fault, FaultKind, Outcome, Rung, RungFailure};
use crate::figure::{Figure, curves, exact, measured};
use crate::of_module;
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::plot::curves::{Curves, panel};
use checkdam::simulation::{AccelerationField, Simulation};
use checkdam::theory::slip::{self as theory, Slider, Sliding};
use rayon::prelude::*;
use scenes::{Block, GRAVITY};
use std::sync::Arc;

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "A block whose friction needs slip: holds, swings, springs back, goes round a loop; static friction above kinetic",
    goal: "Elastic slip stores and gives back, plastic slip dissipates, and fast sliding loses no friction",
    source: "rigid block on an elastic-perfectly-plastic spring; Coulomb 1785; Palmer and Rice 1973",
    sketch: r"
        ____        traction
       |o o o|-->     |  ,-----
   ____|o_o_o|____    | /
                      |/____ slip
",
    run,
    covers: &[(FaultKind::Friction, 1.03), (FaultKind::SlipLength, 1.03), (FaultKind::Gravity, 1.03)],
    under_fault: "all, with one block that turns round",
    figures: &[TURN, LOOP],
};

const TURN: Figure = curves(
    "slip_turn",
    "slip_turn_plot",
    Curves {
        x: "time_s",
        x_title: "time (s)",
        y_title: "displacement (m)",
        curves: &[measured("displacement_m", ""), exact("displacement_exact_m", "exact")],
        panels: &[panel("pushed up the slope", &[("pushed", "up")]), panel("let go", &[("pushed", "not")])],
        split: &[("block", "")],
        ..Curves::LINEAR
    },
);

const LOOP: Figure = curves(
    "slip_loop",
    "slip_loop_plot",
    Curves {
        x: "displacement_m",
        x_title: "displacement (m)",
        y_title: "friction over weight",
        curves: &[measured("friction_over_weight", "")],
        ..Curves::LINEAR
    },
);

/// The blocks that turn round, in the order in which they run.
const BLOCKS: [&str; 5] =
    ["on the grid's line", "to the left", "at 17 degrees to the grid", "at -40 degrees, to the left", "twice as large"];
const CLOSED_FORM: &str = "elastic-perfectly-plastic slider";

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    // A fault is looked for in the first block alone.
    let blocks = [
        (0.0, 0.14, false, 1.0),
        (0.0, 0.14, true, 1.0),
        (17.0, 0.5, false, 1.0),
        (-40.0, 0.8, true, 1.0),
        (0.0, 0.14, false, 2.0),
    ];
    let blocks = if *fault == Fault::NONE { &blocks[..] } else { &blocks[..1] };
    let turned: Vec<Result<_, RungFailure>> = (blocks.par_iter().enumerate())
        .map(|(k, &(plane, offset, leftward, size))| {
            let (mut outcome, mut rows, mut ends) = (Outcome::default(), Vec::new(), Vec::new());
            let l = Block::LEVEL;
            let block =
                Block { plane, offset, leftward, slope: 10.0, cell: size * l.cell, length: size * l.length, ..l };
            for (pushed, speed) in [(0.0, -0.8), (1.0, 0.0)] {
                let end = turn(&block, speed * size.sqrt(), pushed, fault, &mut rows, &mut outcome)?;
                ends.push(end / size);
            }
            rows.iter_mut().for_each(|row: &mut Vec<f64>| row[1] = k as f64);
            Ok((outcome, rows, ends))
        })
        .collect();
    let (mut outcome, mut rows, mut ends) = (Outcome::default(), Vec::new(), Vec::new());
    for turned in turned {
        let (of_block, its_rows, its_ends) = turned?;
        outcome.merge(of_block);
        rows.extend(its_rows);
        ends.extend(its_ends);
    }
    for (k, what) in [(2, "mirrored"), (8, "twice as large, in sqrt(2) the time")] {
        let Some(other) = ends.get(k..k + 2) else { continue };
        let off = (other[0] - ends[0]).abs().max((other[1] - ends[1]).abs());
        outcome.check(
            Check::at_most(format!("{what}: displacement, largest difference"), off, 1e-9, "m")
                .because("the same but for round-off")
                .from(Kind::Conservation, "symmetry and similarity"),
        );
    }
    let header = ["pushed", "block", "size", "time_s", "displacement_m", "displacement_exact_m"];
    outcome
        .tables
        .push(("slip_turn".into(), named_csv(&header, &[("pushed", &["up", "not"]), ("block", &BLOCKS)], rows)));
    hold(fault, &mut outcome)?;
    cycle(fault, &mut outcome)?;
    fast(fault, &mut outcome)?;
    onset(fault, &mut outcome)?;
    Ok(outcome)
}

/// On a slope that friction holds, pushed up it or let go: follows the slider; the displacement at the end.
fn turn(
    block: &Block,
    speed: f64,
    pushed: f64,
    fault: &Fault,
    rows: &mut Vec<Vec<f64>>,
    outcome: &mut Outcome,
) -> Result<f64, RungFailure> {
    let slope = block.slope.to_radians();
    let (pull, grip) = (GRAVITY * libm::sin(slope), block.friction[0] * GRAVITY * libm::cos(slope));
    let slider = Slider { pull, grip, length: block.length };
    let size = block.cell / Block::LEVEL.cell;
    let mut sim = block.launch(speed, fault)?;
    let [start, _] = block.centre(&sim);
    let (mut worst, mut last) = (0.0f64, 0.0);
    for k in 1..=25 {
        run_until(&mut sim, 0.02 * f64::from(k) * size.sqrt())?;
        let x = block.centre(&sim)[0] - start;
        let exact = slider.after(Sliding { v: speed, ..Sliding::default() }, sim.time()).x;
        worst = worst.max((x - exact).abs());
        rows.push(vec![pushed, 0.0, size, sim.time(), x, exact]);
        last = x;
    }
    let name = format!(
        "{}, plane at {} deg, {} cells between nodes{}{}",
        if speed == 0.0 { "let go" } else { "pushed up the slope" },
        block.plane,
        block.offset,
        if block.leftward { ", falls to the left" } else { "" },
        if size == 1.0 { "" } else { ", twice as large" }
    );
    outcome.check(
        Check::at_most(
            format!("{name}: displacement off the closed form, largest over the slip length"),
            worst / block.length,
            0.03,
            "1",
        )
        .because("the block shears by a hundredth of the slip length, and steps are finite")
        .from(Kind::Analytic, CLOSED_FORM),
    );
    let balance = sim.energy_balance(&sim.stock(), [0.0; 2]);
    let given = 0.5 * block.mass() * speed * speed + block.mass() * pull * block.length;
    outcome.check(
        Check::at_most(
            format!("{name}: energy residual over what was given"),
            balance.residual.abs() / given,
            0.005,
            "1",
        )
        .because("points move with one velocity in a step")
        .from(Kind::Conservation, "energy balance"),
    );
    Ok(last)
}

/// Below the friction angle the block hangs on the elastic slip, and stays there.
fn hold(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    for slope in [10.0, 21.4] {
        let block = Block { slope, ..Block::LEVEL };
        let mut sim = block.launch(0.0, fault)?;
        let [start, _] = block.centre(&sim);
        drop(sim);
        sim = block.hung(fault)?;
        let hung = block.centre(&sim)[0] - start;
        let exact = block.length * libm::tan(slope.to_radians()) / block.friction[0];
        outcome.check(
            Check::value(format!("slope {slope} deg: displacement that holds the block"), hung, exact, "m")
                .within(Tolerance::Relative(0.015), "F / K; the block shears by a hundredth of it")
                .from(Kind::Analytic, "F / K"),
        );
        let stored = 0.5 * block.mass() * GRAVITY * libm::sin(slope.to_radians()) * exact;
        outcome.check(
            Check::value(
                format!("slope {slope} deg: energy of the elastic slip"),
                sim.ledger().elastic_slip[0],
                stored,
                "J",
            )
            .within(Tolerance::Relative(0.02), "as the displacement")
            .from(Kind::Analytic, "F^2 / 2K"),
        );
        let end = sim.time() + 0.5;
        run_until(&mut sim, end)?;
        let creep = (block.centre(&sim)[0] - start - hung).abs() / block.length;
        outcome.check(
            Check::at_most(format!("slope {slope} deg: creep in 0.5 s over the slip length"), creep, 1e-3, "1")
                .because("none in theory; what the damped approach leaves is 1e-4")
                .from(Kind::Analytic, "Coulomb 1785: sticks where mu > tan"),
        );
    }
    Ok(())
}

/// Driven to and fro: the area of the loop, and what the slip stores at its end.
fn cycle(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    const AMPLITUDE: f64 = 0.02;
    const PERIOD: f64 = 0.5;
    /// Of the spring that drives every point, 1/s.
    const STIFF: f64 = 1000.0;
    let block = Block::LEVEL;
    let mut sim = block.launch(0.0, fault)?;
    let start: Vec<[f64; 2]> = super::scene::points_by_number(&sim).iter().map(|p| p.x).collect();
    let [begin, _] = block.centre(&sim);
    let along = block.tangent();
    let drive = move |p: &checkdam::body::Particle, t: f64| {
        let w = 2.0 * std::f64::consts::PI / PERIOD;
        let (place, speed) = (AMPLITUDE * (1.0 - libm::cos(w * t)), AMPLITUDE * w * libm::sin(w * t));
        let from = start[p.id as usize];
        let x = (p.x[0] - from[0]) * along.x + (p.x[1] - from[1]) * along.y;
        let v = p.v[0] * along.x + p.v[1] * along.y;
        let a = STIFF * STIFF * (place - x) + 2.0 * STIFF * (speed - v);
        [a * along.x, a * along.y]
    };
    sim.set_field(Some(AccelerationField(Arc::new(drive))));
    let force = block.friction[0] * block.normal_force();
    let spent = |sim: &Simulation| {
        let balance = sim.energy_balance(&sim.stock(), [0.0; 2]);
        [sim.ledger().field.work, balance.friction[0]]
    };
    let mut rows = Vec::new();
    let mut before = [0.0; 2];
    let mut stored = 0.0;
    for k in 1..=100u32 {
        let (t, impulse) = (sim.time(), sim.ledger().boundaries[0].impulse);
        run_until(&mut sim, 0.02 * PERIOD * f64::from(k))?;
        if k == 50 {
            before = spent(&sim);
        }
        // A quarter before the end of the loop it slides at full friction.
        if k == 85 {
            stored = sim.ledger().elastic_slip[0];
        }
        if k > 50 {
            let gained = sim.ledger().boundaries[0].impulse;
            let mean = [0, 1].map(|d| (gained[d] - impulse[d]) / (sim.time() - t));
            let friction = -(mean[0] * along.x + mean[1] * along.y) / block.normal_force();
            rows.push(vec![sim.time(), block.centre(&sim)[0] - begin, friction]);
        }
    }
    let after = spent(&sim);
    let area = theory::loop_area(force, AMPLITUDE, block.length);
    for (k, what) in ["work that drives it round", "friction in the ledger"].into_iter().enumerate() {
        outcome.check(
            Check::value(format!("loop of 20 mm: {what}"), after[k] - before[k], area, "J")
                .within(
                    Tolerance::Relative(0.01),
                    "the drive follows its path to 4 micrometres, the block shears by 40",
                )
                .from(Kind::Analytic, "4 mu N (A - u)"),
        );
    }
    outcome.check(
        Check::value(
            "loop of 20 mm: energy of the elastic slip while it slides",
            stored,
            theory::stored(force, block.length),
            "J",
        )
        .within(Tolerance::Relative(0.01), "the weight on the plane still swings by less")
        .from(Kind::Analytic, "mu N u / 2"),
    );
    let header = ["time_s", "displacement_m", "friction_over_weight"];
    outcome.tables.push(("slip_loop".into(), named_csv(&header, &[], rows)));
    Ok(())
}

/// Slides fast over many cells: all of Coulomb's friction but what it takes to mobilise it.
fn fast(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let (speed, time) = (2.0, 0.3);
    let mut worst = [1.0f64; 2];
    for k in 0..12u32 {
        for (which, pic) in [1.0, 5e-4].into_iter().enumerate() {
            let block = Block {
                plane: 30.0 * f64::from(k),
                offset: f64::from(5 * k % 8) / 8.0,
                length: 1e-3,
                leftward: k % 2 == 1,
                pic,
                ..Block::LEVEL
            };
            let mut sim = block.launch(speed, fault)?;
            let [_, before] = block.centre(&sim);
            run_until(&mut sim, time)?;
            let lost = before - block.centre(&sim)[1];
            let slider = Slider { pull: 0.0, grip: block.friction[0] * GRAVITY, length: block.length };
            let exact = speed - slider.after(Sliding { v: speed, ..Sliding::default() }, sim.time()).v;
            let ratio = lost / exact;
            if (ratio - 1.0).abs() > (worst[which] - 1.0).abs() {
                worst[which] = ratio;
            }
        }
    }
    for (which, what) in ["", ", with little PIC"].into_iter().enumerate() {
        outcome.check(
            Check::value(
                format!("2 m/s at twelve angles and places{what}: friction over Coulomb's, the worst"),
                worst[which],
                1.0,
                "1",
            )
            .within(Tolerance::Absolute(0.005), "what moved on must not leave its friction behind")
            .from(Kind::Analytic, CLOSED_FORM),
        );
    }
    Ok(())
}

/// Static friction above kinetic on a slope that is slowly made steeper, and what follows.
fn onset(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let block = Block { slope: 24.0, friction: [0.4, 0.5], length: 1e-3, ..Block::LEVEL };
    let mut sim = block.hung(fault)?;
    let [hung, _] = block.centre(&sim);
    let end = sim.time() + 0.3;
    run_until(&mut sim, end)?;
    let creep = (block.centre(&sim)[0] - hung).abs() / block.length;
    outcome.check(
        Check::at_most("slope between both coefficients: creep in 0.3 s over the slip length", creep, 1e-2, "1")
            .because("it has not slid, and holds")
            .from(Kind::Analytic, "tan < static coefficient"),
    );
    let (mut slope, begin) = (block.slope, sim.time());
    let start = block.centre(&block.launch(0.0, fault)?)[0];
    while block.centre(&sim)[0] - start < 1.1 * block.length && slope < 30.0 {
        slope = block.slope + 2.0 * (sim.time() - begin);
        sim.set_gravity(block.gravity(slope, fault));
        sim.step()?;
    }
    outcome.check(
        Check::value(
            "made steeper by 2 degrees a second: tangent of the slope at which slip is a tenth above the slip length",
            libm::tan(slope.to_radians()),
            block.friction[1],
            "1",
        )
        .within(
            Tolerance::Relative(0.015),
            "0.2 s pass from the first plastic slip until friction has fallen enough to move the block",
        )
        .from(Kind::Analytic, "static coefficient"),
    );
    let friction = |slope: f64| GRAVITY * (libm::sin(slope.to_radians()) - 0.4 * libm::cos(slope.to_radians()));
    while block.centre(&sim)[0] - start < 3.0 * block.length && sim.time() < 10.0 {
        sim.step()?;
    }
    let ([_, v], t) = (block.centre(&sim), sim.time());
    run_until(&mut sim, t + 0.3)?;
    let a = (block.centre(&sim)[1] - v) / (sim.time() - t);
    outcome.check(
        Check::value("after three slip lengths: acceleration over 0.3 s", a, friction(slope), "m/s2")
            .within(
                Tolerance::Absolute(0.01 * GRAVITY * libm::sin(slope.to_radians())),
                "1 % of what gravity alone would do",
            )
            .from(Kind::Analytic, "Coulomb 1785: g (sin - mu cos), kinetic"),
    );
    // The slope that held it does not hold it in motion.
    let mut sim = block.launch(0.5, fault)?;
    run_until(&mut sim, 0.05)?;
    let ([_, v], t) = (block.centre(&sim), sim.time());
    run_until(&mut sim, t + 0.3)?;
    let a = (block.centre(&sim)[1] - v) / (sim.time() - t);
    outcome.check(
        Check::value("in motion on the slope that held it: acceleration", a, friction(block.slope), "m/s2")
            .within(
                Tolerance::Absolute(0.01 * GRAVITY * libm::sin(block.slope.to_radians())),
                "1 % of what gravity alone would do",
            )
            .from(Kind::Analytic, "Coulomb 1785: g (sin - mu cos), kinetic"),
    );
    Ok(())
}
