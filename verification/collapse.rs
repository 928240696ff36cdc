//! Columns of sand that collapse in a channel, against the laws that two laboratories fitted to their experiments.
//!
//! The column rests between a smooth wall and a gate on a rough base; the gate vanishes. How far the front gets and what height is left
//! depend on the aspect ratio a = h0/r0. The laws have no parameter for the grains, but differ with them: sand, rice and sugar run 1.2 a
//! (Lube et al.), glass beads, which come to rest at 22 degrees, 1.8 a (Lajeunesse et al.). Ours are sand, and its run-out is judged by the
//! first; experiments scatter by 15 % around it. Ours slide in simple shear at 0.515, the slope of a cone that has 31 degrees in plane
//! strain, not at the experiments' tan(31 degrees) = 0.60. That is worth 17 % of a run-out that goes with 1/mu; together it is 22.5 %.
//! Heights of the two laboratories differ by up to 13 %; the band is between them, and 15 % around. What the data are worth, and what ours
//! are, is the validation `column_level`.
//!
//! What is found: by mass the front is 16 % short at a = 0.5 (1 % of the mass is a longer part of a low front) to 12 % too far at a = 6. By
//! depth, the end of the last cell that holds half a cell of sand, it is 9 to 28 % too far. Its exponent from a = 0.5 to 2 is 1.09 or 1.13
//! instead of 1, depending on the order of sums alone: a few points decide it. So the depth stands in the table, and the front by mass is
//! judged. Run-out grows with refinement (second table), and no grid is fine enough to say where to. A plane-strain channel has no side
//! walls; wide channels have the larger exponent, 0.9.
//!
//! The front is where 1 % of the mass has passed, and, by another definition, where the deposit is a layer of points deep.
//! Cells are r0/16 to r0/32, the cone is that of 31 degrees in plane strain, and the fill is stiff enough not to settle by its weight.

use super::report::table_csv;
use super::scene::{Material, THICKNESS};
use super::{Fault, FaultKind, Outcome, Rung, RungFailure};
use crate::figure::{Figure, curves, exact, measured};
use crate::of_module;
use crate::release::{Column, GRAVITY, depth_between, fronts};
use checkdam::boundary::{Friction, Opening};
use checkdam::check::{Check, Expected, Kind, Tolerance};
use checkdam::plot::curves::Curves;
use checkdam::run::records::MomentumRow;
use checkdam::simulation::PicShare;
use checkdam::theory::collapse as law;
use rayon::prelude::*;

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "Columns of five aspect ratios collapse: run-out and height against two laboratories, ledgers",
    goal: "Run-out and height of columns that collapse, five aspect ratios, against two laboratories",
    source: "Lube et al. 2005; Lajeunesse et al. 2005; Balmforth and Kerswell 2005",
    sketch: r"
   |o o| gate vanishes
   |o o|                        .___
   |o o| h0 = a r0        ->    |   `---.____
   |o o|                        |            `---..
   -r0---------------------   -----------------------  rough base
",
    run,
    covers: &[(FaultKind::Gravity, 1.03), (FaultKind::Density, 1.03), (FaultKind::ContactForce, 1.03)],
    under_fault: "the column with a = 0.5",
    figures: FIGURES,
};

/// Its figures.
const FIGURES: &[Figure] = &[
    curves(
        "collapse_laws",
        "collapse_laws_plot",
        Curves {
            x: "aspect_ratio",
            x_title: "height over half width of the column",
            y_title: "run-out over half width",
            curves: &[
                measured("run_out_by_mass", "by mass"),
                measured("run_out_by_depth", "by depth"),
                exact("run_out_lube_2005", "Lube 2005"),
                exact("run_out_lajeunesse_2005", "Lajeunesse 2005"),
            ],
            ..Curves::LINEAR
        },
    ),
    curves(
        "collapse_laws",
        "collapse_height_plot",
        Curves {
            x: "aspect_ratio",
            x_title: "height over half width of the column",
            y_title: "final height over half width",
            curves: &[
                measured("height", "at the wall"),
                exact("height_lube_2005", "Lube 2005"),
                exact("height_lajeunesse_2005", "Lajeunesse 2005"),
            ],
            ..Curves::LINEAR
        },
    ),
];

const SAND: Material = Material::new(1e6, 0.3, 1500.0);
const PHI: f64 = 31.0 * std::f64::consts::PI / 180.0;
const RADIUS: f64 = 0.1;
const ASPECTS: [f64; 5] = [0.5, 1.0, 2.0, 4.0, 6.0];
/// Cells over r0: finer for the low columns, whose run-out is short.
const CELLS: [usize; 5] = [32, 32, 24, 16, 16];
/// Length of the run over sqrt(h0/g): twice the time that a collapse takes.
const DURATION: f64 = 6.6;

/// What is left of a column.
struct Deposit {
    /// Run-out over r0 by mass and by depth.
    run_out: [f64; 2],
    /// Height at the wall over r0.
    height: f64,
    /// Kinetic energy at the end over energy at release.
    kinetic: f64,
    /// Energy not accounted for over energy at release.
    residual: f64,
    /// Momentum not accounted for over the sum of all impulses.
    closure: f64,
    /// Force on the base over weight, mean of the last fifth of the run.
    base: f64,
    /// Shares of the energy at release: kept, plastic, PIC.
    shares: [f64; 3],
}

fn collapse(aspect: f64, cells: usize, fault: &Fault) -> Result<Deposit, RungFailure> {
    let height = RADIUS * aspect;
    let column = Column {
        length: RADIUS,
        height,
        slope: 0.0,
        cells,
        per_cell: 2,
        material: SAND,
        friction_angle: PHI,
        bed: Friction::Rough,
        opening: Opening::Vanish,
        side_walls: 0.0,
        // The share of the paper's runs.
        pic: PicShare::Fraction(5e-4),
        cfl: 0.4,
    };
    let h = column.spacing();
    let mut sim = column.released(fault)?;
    let end = DURATION * (height / GRAVITY).sqrt();
    let (mut residual, mut push, mut time, mut next) = (0.0f64, 0.0, 0.0, 0.0);
    let initial = sim.energy_balance(sim.opening(), [0.0; 2]).initial;
    while sim.time() < end {
        sim.step()?;
        if sim.time() > 0.8 * end {
            push += sim.step_tallies()[1].impulse[1] * fault.contact_force;
            time += sim.time_step().dt;
        }
        if sim.time() >= next {
            next += 0.02 * end;
            residual = residual.max((sim.energy_balance(&sim.stock(), [0.0; 2]).residual / initial).abs());
        }
    }
    let now = sim.stock();
    let balance = sim.energy_balance(&now, [0.0; 2]);
    let mass = SAND.density * RADIUS * height * THICKNESS;
    let [by_mass, _, by_depth] = fronts(&sim, h);
    Ok(Deposit {
        run_out: [by_mass, by_depth].map(|x| x / RADIUS - 1.0),
        height: depth_between(&sim, 0.0, 2.0 * h) / RADIUS,
        kinetic: now.kinetic / initial,
        residual,
        closure: MomentumRow::new(end, sim.ledger(), sim.opening(), &now).closure(),
        base: push / time / (mass * GRAVITY),
        shares: [balance.gravitational / initial, balance.plastic / initial, balance.pic / initial],
    })
}

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let mut outcome = Outcome::default();
    let mut rows = Vec::new();
    // What notices a fault is the force on the base, and one column is enough for that.
    let aspects = if *fault == Fault::NONE { &ASPECTS[..] } else { &ASPECTS[..1] };
    let mut run_outs = Vec::new();
    let deposits: Result<Vec<_>, _> =
        aspects.par_iter().zip(CELLS).with_max_len(1).map(|(&a, cells)| collapse(a, cells, fault)).collect();
    for (&a, deposit) in aspects.iter().zip(deposits?) {
        judge(a, &deposit, &mut outcome);
        let [lube, other] = [law::lube_run_out(a), law::lajeunesse_run_out(a)];
        rows.push(vec![
            a,
            deposit.run_out[0],
            deposit.run_out[1],
            lube,
            other,
            deposit.height,
            law::lube_height(a),
            law::lajeunesse_height(a),
            deposit.shares[0],
            deposit.shares[1],
            deposit.shares[2],
            deposit.residual,
        ]);
        run_outs.push(deposit.run_out);
    }
    if *fault == Fault::NONE {
        exponent(&run_outs, &mut outcome);
        outcome.tables.push(("collapse_grids".into(), grids(fault)?));
    }
    let header = [
        "aspect_ratio",
        "run_out_by_mass",
        "run_out_by_depth",
        "run_out_lube_2005",
        "run_out_lajeunesse_2005",
        "height",
        "height_lube_2005",
        "height_lajeunesse_2005",
        "energy_gravitational",
        "energy_plastic",
        "energy_pic",
        "energy_residual_max",
    ];
    outcome.tables.push(("collapse_laws".into(), table_csv(&header, rows)));
    Ok(outcome)
}

/// The exponent of run-out with aspect ratio.
fn exponent(run_outs: &[[f64; 2]], outcome: &mut Outcome) {
    let between = |i: usize, j: usize| libm::log(run_outs[j][0] / run_outs[i][0]) / libm::log(ASPECTS[j] / ASPECTS[i]);
    outcome.check(
        Check::new("exponent of the run-out by mass, a = 4 to 6", between(3, 4), Expected::Within(2.0 / 3.0, 0.9), "1")
            .within(
                Tolerance::Absolute(0.1),
                "fits of other laboratories: 2/3 and 0.65 in narrow channels, 0.9 in wide ones",
            )
            .from(Kind::Measured, "Lube et al. 2005, Lajeunesse et al. 2005, Balmforth and Kerswell 2005"),
    );
}

/// The column with a = 1 on three grids.
fn grids(fault: &Fault) -> Result<String, RungFailure> {
    let deposits: Result<Vec<_>, _> = [8, 16, 32].par_iter().map(|&cells| collapse(1.0, cells, fault)).collect();
    let rows = deposits?
        .into_iter()
        .zip([8.0, 16.0, 32.0])
        .map(|(d, n)| vec![RADIUS / n, d.run_out[0], d.run_out[1], d.height]);
    Ok(table_csv(&["h_m", "run_out_by_mass", "run_out_by_depth", "height"], rows))
}

fn judge(a: f64, deposit: &Deposit, outcome: &mut Outcome) {
    let span = |x: [f64; 2]| Expected::Within(x[0].min(x[1]), x[0].max(x[1]));
    // Scatter and friction, independent of each other.
    let share = 0.15f64.hypot(libm::tan(PHI) / libm::sin(PHI) - 1.0);
    outcome.check(
        Check::new(
            format!("a = {a}: run-out over r0, by 1 % of the mass"),
            deposit.run_out[0],
            Expected::Value(law::lube_run_out(a)),
            "1",
        )
        .within(
            Tolerance::Relative(share),
            "scatter of the experiments, 15 %, and the friction of these grains in simple shear, 0.515 instead of 0.60, 17 %",
        )
        .from(Kind::Measured, "Lube et al. 2005"),
    );
    outcome.check(
        Check::new(
            format!("a = {a}: height of the deposit over r0"),
            deposit.height,
            span([law::lube_height(a), law::lajeunesse_height(a)]),
            "1",
        )
        .within(Tolerance::Relative(0.15), "scatter around either law; a cell is 6 % of r0")
        .from(Kind::Measured, "Lube et al. 2005, Lajeunesse et al. 2005"),
    );
    outcome.check(
        Check::at_most(format!("a = {a}: kinetic energy left over energy at release"), deposit.kinetic, 1e-3, "1")
            .because("a collapse takes 3.3 sqrt(h0/g); the run lasts twice as long")
            .from(Kind::Measured, "Lube et al. 2005"),
    );
    outcome.check(
        Check::at_most(format!("a = {a}: energy not accounted for, largest at any time"), deposit.residual, 0.02, "1")
            .because("second order in the time step; what is neither stored nor booked is an error of the scheme")
            .from(Kind::Conservation, "first law"),
    );
    outcome.check(
        Check::at_most(format!("a = {a}: momentum not accounted for"), deposit.closure, 1e-10, "1")
            .because("booked node by node; only round-off remains")
            .from(Kind::Conservation, "Newton's second law"),
    );
    outcome.check(
        Check::value(format!("a = {a}: force on the base over weight, last fifth of the run"), deposit.base, 1.0, "1")
            .within(
                Tolerance::Relative(0.01),
                "at rest but for creeping grains; 1e-3 of the energy would be 3 % of a g",
            )
            .from(Kind::Conservation, "Newton's third law"),
    );
}
