//! The transformations: what is changed in a case, and what becomes of the numbers that are read.

use super::scenes::Scene;
use super::transform::{Factors, exchanged, in_three, mirrored, moved, renamed, scaled, tables_reversed, turned};
use checkdam::case::Case;

/// How near the numbers of a pair must be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Near {
    /// The same bits.
    Bits,
    /// The same but for round-off, as the flow has let it grow.
    RoundOff,
    /// The same in the mean of several runs, within their scatter.
    Scatter,
}

impl Near {
    /// In a word.
    pub fn name(self) -> &'static str {
        match self {
            Near::Bits => "bits",
            Near::RoundOff => "round-off",
            Near::Scatter => "scatter",
        }
    }
}

/// A transformation of a scene.
#[derive(Debug, Clone)]
pub struct Pair {
    /// What was done.
    pub name: &'static str,
    /// How near the numbers must be.
    pub near: Near,
    /// The case, transformed.
    pub case: Case,
    /// Factors of what is read, by its unit.
    pub factors: Factors,
    /// 1, or -1 where right and left are exchanged.
    pub sense: f64,
    /// By how much places along x are moved, m.
    pub shift: f64,
    /// Quantities of which it says nothing, by parts of their names.
    pub silent: &'static [&'static [&'static str]],
    /// Whether the run has three threads to itself.
    pub threads: bool,
}

/// What is defined by a time in seconds, which is no property of a model at equal Froude number: means over 0.3 s and 20 ms, an impulse of
/// half a second, the row of 1 ms with the largest force.
pub const BY_SECONDS: &[&str] = &[
    "static_",
    "base_shear_n",
    "peak_20ms",
    "time_to_static",
    "half_second",
    "peak_50hz",
    "tip_final",
    "resolution_s",
    "deposit: base_",
    "friction_limit_n",
    "mobilised_1",
    "equilibrium",
    "held_along",
    "side_walls_n",
    "peak_deflection",
    "peak_barrier_velocity",
];
/// What belongs to the axes: the front along x and its depth across it, what is compared with it, stations, windows.
pub const BY_AXES: &[&str] =
    &["front", "window", "alpha_1", "elastic_impact_n", "flow_direction_1", "_x_n_s", "_y_n_s"];
/// Which of two boundaries that act on one node takes what, and calls it friction or impact, depends on their order: see `notes`.
pub const BY_ORDER: &[&str] =
    &["energy: friction_1", "energy: impact_1", "energy.csv: friction_j", "energy.csv: contact_j"];

/// In one step of the impact the ledger of the boundaries takes a hundredth of a joule more or less, and no force does: see `notes`.
pub const BY_LEDGER: &[&str] = &[
    "energy: residual_end_1",
    "energy: energy_residual_1",
    "residual_of_released_1",
    "energy.csv: residual_j",
    "energy.csv: boundaries_j",
];

/// Numbers that are round-off themselves, and names: compared where bits are.
pub const ROUND_OFF: &[&str] = &["momentum_closure_1", "imbalance_1"];

/// All transformations of a scene.
pub fn pairs(scene: Scene, base: &Case) -> Vec<Pair> {
    let h = base.grid.spacing_m;
    let pair = |name, near, case: Case| Pair {
        name,
        near,
        case,
        factors: Factors::ONE,
        sense: 1.0,
        shift: 0.0,
        silent: if near == Near::Bits { &[] } else { &[BY_ORDER] },
        threads: false,
    };
    let (twice, froude) = (Factors { mass: 2.0, width: 4.0, ..Factors::ONE }, Factors::froude(4.0));
    let mut named = renamed(base);
    (named.gauges.sample_rate_hz, named.gauges.field_times_s) = (250.0, vec![0.1, 0.2]);
    let mut pairs = vec![
        Pair { threads: true, silent: &[&[".csv"]], ..pair("names, rows of tables, threads", Near::Bits, named) },
        Pair { factors: twice, ..pair("density, stiffness x 2, width x 4", Near::Bits, scaled(base, &twice)) },
        Pair {
            factors: froude,
            silent: &[BY_SECONDS],
            ..pair("lengths x 4, equal Froude number", Near::Bits, scaled(base, &froude))
        },
        pair(
            "order of tables, bodies, boundaries",
            Near::RoundOff,
            exchanged(&scene.read(&tables_reversed(scene.text()))),
        ),
        Pair { sense: -1.0, ..pair("mirrored", Near::RoundOff, mirrored(base)) },
        Pair {
            shift: 25.0 * h,
            ..pair("moved by whole cells", Near::RoundOff, moved(base, [25.0 * h, -7.0 * h], false))
        },
        Pair {
            shift: 3.37 * h,
            ..pair("moved with the grid by broken cells", Near::RoundOff, moved(base, [3.37 * h, -1.21 * h], true))
        },
        Pair { silent: &[BY_AXES, BY_ORDER], ..pair("turned by -90 degrees", Near::RoundOff, turned(base, -90.0)) },
    ];
    if scene == Scene::Flume {
        let ten = Factors::froude(10.0);
        pairs.push(pair("the sand in three bodies", Near::RoundOff, in_three(base, 0.25, -0.1)));
        pairs.push(Pair {
            factors: ten,
            silent: &[BY_SECONDS, BY_ORDER, BY_LEDGER],
            ..pair("lengths x 10, equal Froude number", Near::RoundOff, scaled(base, &ten))
        });
    }
    pairs
}
