//! Contact of bodies that have velocity fields of their own: bars that strike each other, a block on an elastic base, a row of
//! Hertzian contacts, sand against an elastic wall.
//!
//! What is judged is the way a user gets: normals from the faces of the structure nearest to the other body's points, gaps from
//! the points' extents. The table shows the others beside it. Gradients take a corner for a face: at the heel and toe of a block
//! they hold it fast. Regression does so less. Mean positions let bodies into each other by a share of a cell that depends on
//! where the surface lies between the nodes, and take energy for it. Approach alone stops bodies up to a cell too early.

mod bars;
mod block;
mod deposit;
mod hertz;
mod scenes;

use super::report::named_csv;
use super::{Fault, FaultKind, Outcome, Rung, RungFailure};
use crate::figure::{Figure, curves, exact, measured};
use crate::of_module;
use checkdam::contact::rule::GapRule;
use checkdam::plot::curves::{Curves, panel};
use scenes::{GAPS, NORMALS, rule};

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "Bodies in contact: bars that strike each other, a block on an elastic base, Hertz's contact, sand against a wall",
    goal: "Bodies in contact: impulses of impact, friction on an elastic base, pressure of a row of Hertz contacts, sand on a wall",
    source: "Saint-Venant; Coulomb 1785; theory::hertz (Westergaard 1939); Newton's third law",
    sketch: r"
   [bar]-> [bar]     ____ block        _  _  _  wavy   |o o|wall
                   _|____|_->         / \/ \/ \        |o o||
                  |  base  |         -----------       |o o||
   rho c v          mu, work          p(x)              force
",
    run,
    covers: &[
        (FaultKind::Friction, 1.05),
        (FaultKind::ContactForce, 1.05),
        (FaultKind::Gravity, 1.05),
        (FaultKind::Modulus, 1.05),
    ],
    under_fault: "equal bars, the first block; Hertz's contact on the coarse grid (modulus: it alone; contact force)",
    figures: FIGURES,
};

/// Its figures.
const FIGURES: &[Figure] = &[
    curves(
        "contact_bars",
        "contact_bars_plot",
        Curves {
            x: "time_over_contact",
            x_title: "time over that of the contact",
            y_title: "force over the first exact one",
            curves: &[measured("force_over_first", "computed"), exact("force_exact_over_first", "exact")],
            panels: &[
                panel("an equal bar", &[("second_bar", "an equal bar")]),
                panel("twice as long", &[("second_bar", "a bar twice as long")]),
                panel("half the impedance", &[("second_bar", "a bar of half its impedance")]),
                panel("seven times the impedance", &[("second_bar", "a bar seven times its impedance")]),
            ],
            ..Curves::LINEAR
        },
    ),
    curves(
        "contact_hertz_pressure",
        "contact_hertz_pressure_plot",
        Curves {
            x: "x_over_half_width",
            x_title: "distance from the crest over the half width",
            y_title: "pressure over its peak",
            curves: &[
                measured("node_over_peak", "single nodes"),
                measured("smoothed_over_peak", "means (1, 2, 1)/4"),
                exact("exact_over_peak", "Westergaard"),
            ],
            panels: &[
                panel("40 cells, half width of 2.5", &[("cells_per_wavelength", "40"), ("load", "first")]),
                panel("40 cells, half width of 5", &[("cells_per_wavelength", "40"), ("load", "second")]),
                panel("80 cells, half width of 5", &[("cells_per_wavelength", "80"), ("load", "first")]),
                panel("80 cells, half width of 10", &[("cells_per_wavelength", "80"), ("load", "second")]),
            ],
            ..Curves::LINEAR
        },
    ),
];

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let mut outcome = Outcome::default();
    if fault.modulus != 1.0 {
        hertz::run(fault, &mut outcome)?;
        return Ok(outcome);
    }
    let mut rows = Vec::new();
    bars::run(fault, &mut outcome, &mut rows)?;
    let header = ["second_bar", "time_over_contact", "force_over_first", "force_exact_over_first"];
    let names = bars::names();
    outcome.tables.push(("contact_bars".into(), named_csv(&header, &[("second_bar", &names)], rows)));
    block::run(fault, &mut outcome)?;
    if *fault == Fault::NONE || fault.contact_force != 1.0 {
        hertz::run(fault, &mut outcome)?;
    }
    if *fault == Fault::NONE {
        deposit::run(fault, &mut outcome)?;
        options(&mut outcome);
    }
    Ok(outcome)
}

/// All ways to find normals and gaps, on the bars, the block, the deposit and Hertz's contact; NaN where a run breaks down.
fn options(outcome: &mut Outcome) {
    let setting = block::Setting { tilt: 23f64.to_radians(), slope: 40f64.to_radians(), friction: 0.4, pic: 1.0 };
    let equal = ("", super::scene::Material::new(1e6, 0.0, 1000.0), 1.0);
    let mut rows = Vec::new();
    for (n, (_, normal)) in NORMALS.into_iter().enumerate() {
        for (g, (_, gap)) in GAPS.into_iter().enumerate() {
            let none = &Fault::NONE;
            let with = |friction| rule(friction, normal, gap);
            let mut row = vec![n as f64, g as f64];
            row.extend(match bars::strike(&equal, 50, 0.3, with(0.4), none) {
                Ok(b) => [b.force, b.impulse, b.early, b.loss, b.residual],
                Err(_) => [f64::NAN; 5],
            });
            row.extend(match block::slide(&setting, with(0.4), none) {
                Ok(b) => [b.displacement, b.tangential, b.rise, b.residual],
                Err(_) => [f64::NAN; 4],
            });
            // Sand has no start that it was in contact at.
            let sand = (gap != GapRule::Displacements).then(|| deposit::run_against(5e5, with(0.4), 0.8, none));
            row.extend(match sand {
                Some(Ok(d)) => [d.force[0], d.force[1], d.deepest, d.residual],
                _ => [f64::NAN; 4],
            });
            // Neither has most of a wavy face.
            let pressed = (gap != GapRule::Displacements).then(|| hertz::of_option(with(0.0)));
            row.extend(match pressed {
                Some(Ok(found)) => found,
                _ => [f64::NAN; 2],
            });
            rows.push(row);
        }
    }
    let header = [
        "normal",
        "gap",
        "bars_force_over_exact",
        "bars_impulse_over_exact",
        "bars_late_steps",
        "bars_contact_loss",
        "bars_ledger_residual",
        "block_displacement_error",
        "block_friction_over_exact",
        "block_rise_cells",
        "block_ledger_residual",
        "deposit_force_at_rest_n",
        "deposit_force_peak_n",
        "deposit_penetration_cells",
        "deposit_ledger_residual",
        "hertz_load_over_exact",
        "hertz_half_width_over_exact",
    ];
    let (normals, gaps) = (NORMALS.map(|n| n.0), GAPS.map(|g| g.0));
    let codes: [(&str, &[&str]); 2] = [("normal", &normals), ("gap", &gaps)];
    outcome.tables.push(("contact_options".into(), named_csv(&header, &codes, rows)));
}

#[cfg(test)]
mod tests {
    use super::scenes::{Part, several, usual};
    use crate::Fault;
    use crate::scene::{Brick, Material};
    use checkdam::body::Particle;
    use checkdam::simulation::Simulation;

    /// A block that is thrown on a long bed, both in many bands, after eighty steps.
    fn thrown(threads: usize) -> (Vec<(usize, Particle)>, usize) {
        let (h, stone) = (0.01, Material::new(1e6, 0.2, 1000.0));
        let bed = Part::new(Brick::new([0.0, -0.08], [160, 8], h), stone);
        let block = Part::new(Brick::new([0.031, 0.0], [140, 10], h), stone).moving([3.0, -0.5]);
        let mut sim = Simulation::new(several(vec![bed, block], vec![usual(0.4)], vec![], &Fault::NONE));
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let touching = pool.install(|| {
            let mut step = || {
                sim.step().expect("a step");
                sim.contact_points().len()
            };
            (0..80).map(|_| step()).max().unwrap_or(0)
        });
        let mut points: Vec<_> = sim.particles().collect();
        points.sort_by_key(|(body, p)| (*body, p.id));
        (points, touching)
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
        let (one, touching) = thrown(1);
        assert!(touching > 100, "{touching}");
        for threads in [2, 3, 5] {
            assert!(thrown(threads).0 == one, "{threads} threads");
        }
    }

    #[test]
    fn bodies_far_apart_move_as_if_there_were_no_contact() {
        let moved = |contact: bool| {
            let (h, stone) = (0.05, Material::new(1e6, 0.2, 1000.0));
            let part = |x: f64| Part::new(Brick::new([x, 0.01], [6, 4], h), stone).moving([0.3, x]);
            let contacts = if contact { vec![usual(0.4)] } else { vec![] };
            let mut sim = Simulation::new(several(vec![part(0.0), part(3.0)], contacts, vec![], &Fault::NONE));
            (0..100).for_each(|_| sim.step().expect("a step"));
            let mut points: Vec<_> = sim.particles().collect();
            points.sort_by_key(|(body, p)| (*body, p.id));
            points
        };
        for ((_, a), (_, b)) in moved(true).iter().zip(moved(false)) {
            let near = |a: [f64; 2], b: [f64; 2]| (0..2).all(|d| (a[d] - b[d]).abs() < 1e-12);
            assert!(near(a.x, b.x) && near(a.v, b.v), "{a:?} {b:?}");
        }
    }
}
