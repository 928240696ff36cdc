//! The neo-Hookean law at one point, and a square of it that spins.
//!
//! At a point, stresses are held against the closed form from the deformation gradient, whatever the path and the number of
//! steps. The square turns freely at strains of a percent: its energy must stay. A law in rate form has no energy to return to,
//! so what it gains or loses adds up from turn to turn; the table shows it beside. Neither law keeps the angular momentum of
//! the points: grids of lumped mass lose some in every transfer, which goes into motion that the grid does not see.

use super::report::named_csv;
use super::scene::{Brick, Material, scene};
use super::{Fault, FaultKind, Outcome, Rung, RungFailure};
use crate::figure::{Figure, curves, measured};
use crate::of_module;
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::constitutive::{AnyLaw, Increment, Law, NeoHookean, PointState};
use checkdam::plot::curves::Curves;
use checkdam::shape::ShapeFunction;
use checkdam::simulation::Simulation;
use checkdam::theory::elastic::bar_speed;
use checkdam::theory::neo_hookean as theory;
use std::f64::consts::PI;

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "Neo-Hookean law at a point: stretch, shear, rotation, energy; a square that spins keeps its energy",
    goal: "The hyperelastic law gives the stress of the deformation gradient, and gives back the energy of a square that spins",
    source: "P = mu (F - F^-T) + lambda ln J F^-T, Simo and Pister 1984",
    sketch: r"
   one point:  F = stretch, shear, turn, in any steps
                  __
                /o o\     spins freely at 1 % strain:
               |o o o|    its energy stays
                \o_o/
",
    run,
    covers: &[(FaultKind::Modulus, 1.02)],
    under_fault: "one point",
    figures: FIGURES,
};

/// Its figures.
const FIGURES: &[Figure] = &[curves(
    "neo_hookean_spin",
    "neo_hookean_spin_plot",
    Curves {
        x: "turns",
        x_title: "turns",
        y_title: "over the initial value",
        curves: &[measured("energy_over_initial", "energy"), measured("size_over_initial", "size")],
        split: &[("law", "")],
        ..Curves::LINEAR
    },
)];

const RUBBER: Material = Material::new(1e6, 0.3, 1000.0);
const SOURCE: &str = "P = mu (F - F^-T) + lambda ln J F^-T, Simo and Pister 1984";

fn law(fault: &Fault) -> NeoHookean {
    NeoHookean::new(RUBBER.elastic.young * fault.modulus, RUBBER.elastic.poisson)
}

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let mut outcome = Outcome::default();
    paths(fault, &mut outcome);
    turned(fault, &mut outcome);
    if *fault == Fault::NONE {
        let mut rows = Vec::new();
        spin(0, AnyLaw::NeoHookean(law(fault)), Some(&mut outcome), &mut rows)?;
        spin(1, RUBBER.law(fault), None, &mut rows)?;
        let header = ["law", "turns", "energy_over_initial", "angular_momentum_over_initial", "size_over_initial"];
        let laws: (&str, &[&str]) = ("law", &["neo-Hookean", "rate form"]);
        outcome.tables.push(("neo_hookean_spin".into(), named_csv(&header, &[laws], rows)));
    }
    Ok(outcome)
}

/// Advances by the gradient `l` of a displacement against the present place.
fn advance(law: &NeoHookean, state: &mut PointState, l: [f64; 4]) -> f64 {
    let increment = Increment { dt: 0.0, xx: l[0], yy: l[3], xy: 0.5 * (l[1] + l[2]), spin: 0.5 * (l[2] - l[1]) };
    law.update(state, &increment)
}

/// Stretches and shears, each in fifty equal steps of the deformation gradient.
fn paths(fault: &Fault, outcome: &mut Outcome) {
    let (law, e) = (law(fault), &RUBBER.elastic);
    let free = theory::free_lateral_stretch(e, 1.3);
    for (name, f, component) in [
        ("confined stretch of 1.4: axial stress", [1.4, 0.0, 0.0, 1.0], 0),
        ("confined compression to 0.6: axial stress", [0.6, 0.0, 0.0, 1.0], 0),
        ("confined compression to 0.6: lateral stress", [0.6, 0.0, 0.0, 1.0], 1),
        ("stretch of 1.3 with free faces: axial stress", [1.3, 0.0, 0.0, free], 0),
        ("stretch of 1.3 with free faces: stress out of the plane", [1.3, 0.0, 0.0, free], 2),
        ("simple shear of 0.8: shear stress", [1.0, 0.8, 0.0, 1.0], 3),
        ("simple shear of 0.8: normal stress (Poynting's effect)", [1.0, 0.8, 0.0, 1.0], 0),
    ] {
        let mut state = PointState::default();
        let (steps, mut now) = (50, [1.0, 0.0, 0.0, 1.0]);
        for k in 1..=steps {
            let share = f64::from(k) / f64::from(steps);
            let next = [0, 1, 2, 3].map(|i| [1.0, 0.0, 0.0, 1.0][i] * (1.0 - share) + f[i] * share);
            let j = now[0] * now[3] - now[1] * now[2];
            let inverse = [now[3] / j, -now[1] / j, -now[2] / j, now[0] / j];
            let at = |i: usize, k: usize| next[2 * i] * inverse[k] + next[2 * i + 1] * inverse[2 + k];
            advance(&law, &mut state, [at(0, 0) - 1.0, at(0, 1), at(1, 0), at(1, 1) - 1.0]);
            now = next;
        }
        let s = &state.stress;
        outcome.check(
            Check::value(name, [s.xx, s.yy, s.zz, s.xy][component], theory::stress(e, &f)[component], "Pa")
                .within(Tolerance::Absolute(1e-6), "round-off of fifty products")
                .from(Kind::Analytic, SOURCE),
        );
    }
    let mut state = PointState::default();
    advance(&law, &mut state, [0.2, 0.3, -0.1, -0.1]);
    outcome.check(
        Check::value(
            "stored energy of a stretch with shear and rotation",
            law.stored_energy(&state) * law.volume_ratio(&state, 1.0, &Increment::default()),
            theory::energy(e, &[1.2, 0.3, -0.1, 0.9]),
            "J/m3",
        )
        .within(Tolerance::Relative(1e-12), "round-off")
        .from(Kind::Analytic, SOURCE),
    );
}

/// A stretched point that turns ten times.
fn turned(fault: &Fault, outcome: &mut Outcome) {
    let law = law(fault);
    let mut state = PointState::default();
    advance(&law, &mut state, [0.3, 0.1, 0.0, -0.2]);
    let (before, energy) = (state.stress, law.stored_energy(&state));
    let steps = 4000;
    let angle = 20.0 * PI / f64::from(steps);
    let (c, s) = (libm::cos(angle), libm::sin(angle));
    let work: f64 = (0..steps).map(|_| advance(&law, &mut state, [c - 1.0, -s, s, c - 1.0]).abs()).sum();
    let off = |a: f64, b: f64| (a - b).abs() / before.xx.abs();
    let now = &state.stress;
    let error =
        off(now.xx, before.xx).max(off(now.yy, before.yy)).max(off(now.zz, before.zz)).max(off(now.xy, before.xy));
    outcome.check(
        Check::at_most("ten turns in 4000 steps: change of the stress, over the stress", error, 1e-9, "1")
            .because("round-off of 4000 products")
            .from(Kind::Analytic, "objectivity"),
    );
    outcome.check(
        Check::at_most(
            "ten turns in 4000 steps: sum of the sizes of the works, over the energy",
            work / energy,
            1e-9,
            "1",
        )
        .because("round-off of 4000 products")
        .from(Kind::Conservation, "objectivity"),
    );
}

/// A square of 1 m, 20 cells a side, turns twice at a fifth of the wave speed per metre.
fn spin(index: usize, law: AnyLaw, outcome: Option<&mut Outcome>, rows: &mut Vec<Vec<f64>>) -> Result<(), RungFailure> {
    let cells = 20;
    let omega = 0.2 * bar_speed(&RUBBER.elastic, RUBBER.density);
    let brick = Brick::new([-0.5, -0.5], [cells, cells], 1.0 / cells as f64);
    let mut points = brick.points();
    points.iter_mut().for_each(|p| p.v = [-omega * p.x[1], omega * p.x[0]]);
    let mut scene = scene(&brick, law, RUBBER.density, points, vec![]);
    scene.numerics.shape = ShapeFunction::Bspline;
    let mut sim = Simulation::new(scene);
    let whole = |sim: &Simulation| {
        let (stock, m) = (sim.stock(), sim.bodies()[0].point_mass);
        let (mut turn, mut square) = (0.0, 0.0);
        for (_, p) in sim.particles() {
            turn += m * (p.x[0] * p.v[1] - p.x[1] * p.v[0]);
            square += p.x[0] * p.x[0] + p.x[1] * p.x[1];
        }
        [stock.kinetic + stock.elastic, turn, square]
    };
    let start = whole(&sim);
    let (turns, mut next, mut worst) = (2.0, 0.0, 0.0f64);
    while sim.time() * omega < 2.0 * PI * turns {
        sim.step()?;
        let turned = sim.time() * omega / (2.0 * PI);
        if turned >= next {
            let now = whole(&sim);
            worst = worst.max((now[0] / start[0] - 1.0).abs());
            rows.push(vec![index as f64, turned, now[0] / start[0], now[1] / start[1], (now[2] / start[2]).sqrt()]);
            next += 0.02;
        }
    }
    let Some(outcome) = outcome else { return Ok(()) };
    let energy = sim.energy_balance(&sim.stock(), [0.0; 2]);
    outcome.check(
        Check::at_most("spinning square, two turns: largest change of the energy", worst, 0.005, "1")
            .because("second order in the time step, as a vibrating bar sways; nothing that adds up")
            .from(Kind::Conservation, "energy"),
    );
    outcome.check(
        Check::at_most(
            "spinning square: work that is not stored, over the energy",
            energy.plastic.abs() / start[0],
            1e-11,
            "1",
        )
        .because("round-off of some thousand steps")
        .from(Kind::Conservation, "an elastic body dissipates nothing"),
    );
    Ok(())
}
