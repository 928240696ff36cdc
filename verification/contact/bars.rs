//! Two bars that strike each other, and two that part.

use super::scenes::{Part, several, usual};
use crate::scene::{Brick, Material, THICKNESS};
use crate::{Fault, Outcome, RungFailure};
use checkdam::check::{Check, Expected, Kind, Tolerance};
use checkdam::contact::rule::ContactRule;
use checkdam::simulation::Simulation;
use checkdam::theory::elastic::bar_speed;
use checkdam::theory::impact::{Bar, exit_velocities, impulse, phases};

const SOFT: Material = Material::new(1e6, 0.0, 1000.0);
const LENGTH: f64 = 1.0;
const EXACT: &str = "characteristics, theory::impact (Saint-Venant 1867)";

/// A second bar: name, material, length (m).
type Second = (&'static str, Material, f64);

const SECONDS: [Second; 4] = [
    ("an equal bar", SOFT, 1.0),
    ("a bar twice as long", SOFT, 2.0),
    ("a bar of half its impedance", Material::new(0.25e6, 0.0, 1000.0), 1.0),
    ("a bar seven times its impedance", Material::new(20e6, 0.0, 2400.0), 1.0),
];

/// Names of the second bars.
pub fn names() -> [&'static str; SECONDS.len()] {
    SECONDS.map(|s| s.0)
}

/// What an impact did.
pub struct Impact {
    /// Mean force in the middle of the first phase over the exact one.
    pub force: f64,
    /// Impulse over the exact one.
    pub impulse: f64,
    /// Velocities of the two bars after they parted, over the velocity of the impact.
    pub after: [f64; 2],
    /// Largest change of the momentum of both, over the momentum.
    pub drift: f64,
    /// What the second bar's momentum and the sum of contact impulses differ by, over the impulse.
    pub mismatch: f64,
    /// When force first appeared, less when the gap should close, in time steps.
    pub early: f64,
    /// Residual of the energy ledger and loss in the contact, over the energy.
    pub residual: f64,
    /// See `residual`.
    pub loss: f64,
    /// Rows for a table: time over the duration of the contact, force over the first exact one, exact.
    pub rows: Vec<[f64; 3]>,
}

/// A bar of 1 m and `cells` cells strikes another at 1 % of its wave speed, after closing a gap of `gap` cells.
pub fn strike(
    second: &Second,
    cells: usize,
    gap: f64,
    rule: ContactRule,
    fault: &Fault,
) -> Result<Impact, RungFailure> {
    let h = LENGTH / cells as f64;
    let speed = bar_speed(&SOFT.elastic, SOFT.density);
    let v = 0.01 * speed;
    let (_, material, length) = *second;
    let first = Bar { density: SOFT.density, speed, length: LENGTH, velocity: v };
    let target =
        Bar { density: material.density, speed: bar_speed(&material.elastic, material.density), length, velocity: 0.0 };
    let exact = phases(&first, &target);
    let (part, end) = (exact[0].time[1], exact.last().map_or(0.0, |p| p.time[1]));
    let area = 2.0 * h * THICKNESS;

    // Off the nodes by odd shares of a cell.
    let (x, y) = (0.37 * h, 0.13 * h);
    let a = Part::new(Brick::new([x - LENGTH - gap * h, y], [cells, 2], h), SOFT).moving([v, 0.0]);
    let b = Part::new(Brick::new([x, y], [(length / h).round() as usize, 2], h), material);
    let mut sim = Simulation::new(several(vec![a, b], vec![rule], vec![], fault));
    let start = gap * h / v;
    let total = sim.stock().momentum[0];
    let (mut sum, mut middle, mut drift, mut met) = (0.0, [0.0; 2], 0.0f64, f64::NAN);
    let (mut rows, mut window) = (Vec::new(), [0.0; 2]);
    while sim.time() < start + 1.2 * end {
        sim.step()?;
        let dt = sim.time_step().dt;
        let push = sim.contact_tallies().map(|t| t.exchange.impulse[0]).sum::<f64>() * fault.contact_force;
        sum += push;
        if push != 0.0 && met.is_nan() {
            met = (sim.time() - start) / dt;
        }
        let now = sim.time() - start;
        if (0.2..0.8).contains(&(now / part)) {
            middle = [middle[0] + push, middle[1] + dt];
        }
        drift = drift.max((sim.stock().momentum[0] / total - 1.0).abs());
        window = [window[0] + push, window[1] + dt];
        if window[1] >= 0.02 * end {
            let then = now - 0.5 * window[1];
            let p = exact.iter().find(|p| p.time[0] <= then && then < p.time[1]).map_or(0.0, |p| p.pressure);
            rows.push([then / end, window[0] / window[1] / (exact[0].pressure * area), p / exact[0].pressure]);
            window = [0.0; 2];
        }
    }
    let stocks = [0, 1].map(|k| sim.stock_of(|b| b == k));
    let energy = sim.energy_balance(&sim.stock(), [0.0; 2]);
    Ok(Impact {
        force: middle[0] / middle[1] / (exact[0].pressure * area),
        impulse: sum / (impulse(&exact) * area),
        after: stocks.map(|s| s.momentum[0] / s.mass / v),
        drift,
        mismatch: (sum / stocks[1].momentum[0] - 1.0).abs(),
        early: met,
        residual: energy.residual / energy.initial,
        loss: (energy.contact[0] + energy.friction[0]) / energy.initial,
        rows,
    })
}

/// All impacts in the usual way, and bars that part.
pub fn run(fault: &Fault, outcome: &mut Outcome, rows: &mut Vec<Vec<f64>>) -> Result<(), RungFailure> {
    let all = if *fault == Fault::NONE { SECONDS.len() } else { 1 };
    for (index, second) in SECONDS[..all].iter().enumerate() {
        let found = [50, 100].map(|cells| strike(second, cells, 0.3, usual(0.4), fault));
        let [coarse, fine] = found;
        judge(second, &coarse?, &fine?, index, outcome, rows);
    }
    part(fault, outcome)
}

fn judge(
    second: &Second,
    coarse: &Impact,
    fine: &Impact,
    index: usize,
    outcome: &mut Outcome,
    rows: &mut Vec<Vec<f64>>,
) {
    let (name, material, length) = *second;
    rows.extend(fine.rows.iter().map(|r| vec![index as f64, r[0], r[1], r[2]]));
    outcome.check(
        Check::value(format!("{name}: force in the middle of the first phase, over rho c v A"), fine.force, 1.0, "1")
            .within(
                Tolerance::Relative(0.02),
                "strains of 1 % change impedance and area by half a percent; ripples of a front on cells, as much again",
            )
            .from(Kind::Analytic, EXACT),
    );
    outcome.check(
        Check::value(format!("{name}: impulse over the exact one"), fine.impulse, 1.0, "1")
            .within(
                Tolerance::Absolute(0.03),
                "a contact that is a cell thick loses of the order of one cell in a hundred",
            )
            .from(Kind::Analytic, EXACT),
    );
    let speed = bar_speed(&SOFT.elastic, SOFT.density);
    let bar = |m: &Material, length, velocity| Bar {
        density: m.density,
        speed: bar_speed(&m.elastic, m.density),
        length,
        velocity,
    };
    let exact = exit_velocities(&bar(&SOFT, LENGTH, 0.01 * speed), &bar(&material, length, 0.0));
    for (k, of) in ["first", "second"].into_iter().enumerate() {
        outcome.check(
            Check::value(
                format!("{name}: velocity of the {of} bar afterwards, over that of the impact"),
                fine.after[k],
                exact[k] / (0.01 * speed),
                "1",
            )
            .within(Tolerance::Absolute(0.03), "as the impulse")
            .from(Kind::Analytic, EXACT),
        );
    }
    outcome.check(
        Check::at_most(format!("{name}: change of the momentum of both"), fine.drift, 1e-12, "1")
            .because("round-off of some thousand steps")
            .from(Kind::Conservation, "Newton's third law"),
    );
    outcome.check(
        Check::at_most(
            format!("{name}: sum of contact impulses against the momentum of the second bar"),
            fine.mismatch,
            1e-11,
            "1",
        )
        .because("round-off of some thousand steps")
        .from(Kind::Conservation, "Newton's second law"),
    );
    outcome.check(
        Check::new(
            format!("{name}: first force after a gap of 0.3 cells, in time steps after it should have closed"),
            fine.early,
            Expected::Within(-1.0, 2.0),
            "1",
        )
        .because("the gap closes within a step")
        .from(Kind::Analytic, "gap over velocity"),
    );
    outcome.check(
        Check::at_most(format!("{name}: residual of the energy ledger"), fine.residual.abs(), 0.02, "1")
            .because("points' stresses follow velocities mapped back to the grid; at a front over one cell of a hundred this costs 1 %")
            .from(Kind::Conservation, "energy"),
    );
    outcome.check(
        Check::at_most(
            format!("{name}: residual on 100 cells over that on 50"),
            (fine.residual / coarse.residual).abs(),
            0.8,
            "1",
        )
        .because("first order in the cell size: 0.5, and ripples")
        .from(Kind::Convergence, "energy"),
    );
}

/// Two bars side by side that move apart from the start, with friction.
fn part(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let h = 0.05;
    let a = Part::new(Brick::new([0.013 - 0.5, 0.01], [10, 2], h), SOFT).moving([-0.2, 0.1]);
    let b = Part::new(Brick::new([0.013, 0.01], [10, 2], h), SOFT).moving([0.1, 0.0]);
    let mut sim = Simulation::new(several(vec![a, b], vec![usual(0.4)], vec![], fault));
    let (mut pulled, mut speed) = (0.0f64, 0.0f64);
    while sim.time() < 1.0 {
        sim.step()?;
        pulled = pulled.max(sim.contact_tallies().map(|t| t.exchange.impulse[0].abs()).fold(0.0, f64::max));
    }
    for (body, p) in sim.particles() {
        let v = [[-0.2, 0.1], [0.1, 0.0]][body];
        speed = speed.max((p.v[0] - v[0]).abs()).max((p.v[1] - v[1]).abs());
    }
    outcome.check(
        Check::at_most("bars that part: largest impulse between them", pulled, 0.0, "N s")
            .because("contact does not hold back")
            .from(Kind::Analytic, "Signorini 1933"),
    );
    outcome.check(
        Check::at_most("bars that part: largest change of a velocity", speed, 1e-12, "m/s")
            .because("round-off")
            .from(Kind::Conservation, "Newton's first law"),
    );
    Ok(())
}
