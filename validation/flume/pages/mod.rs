//! One page per figure of the paper: what was measured, what the authors computed, what we compute, our numerical error, and the
//! spread that the unstated inputs cause.
//!
//! [`tables`] puts the numbers side by side, from the records and the paper's table; [`write`] makes pages (Markdown) of them.
//! Nothing on a page is typed in but words.

mod extras;
mod table;
mod text;

use super::compare::Counterpart;

pub use table::tables;
pub use text::write;

/// A figure of the paper and what stands on its page.
struct Figure {
    /// Its number in the paper.
    number: &'static str,
    /// What it is about.
    title: &'static str,
    /// What our figures show, in words that no result can make wrong.
    shows: &'static str,
    /// Our figures: name behind `flume_<case>_`, and what it is called.
    drawn: &'static [(&'static str, &'static str)],
    /// Rows of its table.
    lines: &'static [Line],
}

impl Figure {
    /// Name of its page, without extension.
    fn stem(&self) -> String {
        format!("flume_fig_{}", self.number)
    }
}

/// A quantity of a figure.
struct Line {
    /// What it is.
    quantity: &'static str,
    /// Its unit; "1" where it has none.
    unit: &'static str,
    /// Ours.
    of: Counterpart,
    /// Names of the numbers beside which it stands, in `published.csv`.
    stated: &'static [&'static str],
}

const fn line(quantity: &'static str, unit: &'static str, of: Counterpart, stated: &'static [&'static str]) -> Line {
    Line { quantity, unit, of, stated }
}

const FIGURES: [Figure; 4] = [
    Figure {
        number: "2",
        title: "the flow before and after it meets the barrier",
        shows: "The flow at several instants, turned so that gravity points down, coloured by speed; below, the velocity of the \
                front along the flume beside that of a block that slides from rest with the base's friction. Times count from \
                the opening of the gate.",
        drawn: &[("flow_snapshots", "flow, coloured by speed"), ("front_plot", "velocity of the front")],
        lines: &[
            line("front velocity at 0.7 m", "m/s", |q| q("front_velocity_m_per_s"), &["F1"]),
            line("Froude number at 0.7 m", "1", |q| q("froude_1"), &["F2", "F3"]),
            line("flow depth at 0.7 m", "m", |q| q("front_depth_m"), &["F4"]),
            line("front velocity at the barrier", "m/s", |q| q("barrier_velocity_m_per_s"), &[]),
            line("time at which the front meets the barrier", "s", |q| q("arrival_s"), &[]),
            line("run-up on the barrier", "m", |q| q("run_up_m"), &[]),
        ],
    },
    Figure {
        number: "3",
        title: "where the energy goes",
        shows: "Shares of the energy that the sand has at release over that of its final place at the foot of the barrier (E0), \
                from the ledger of the run: what the sand loses in height goes into motion first, and then into plastic work and \
                the friction of the base. What remains as height at the end is the deposit's.",
        drawn: &[("energy_shares", "energy shares against time")],
        lines: &[
            line("share dissipated in all", "1", |q| q("dissipated_1"), &["F8"]),
            line("plastic work in the sand", "1", |q| q("plastic_1"), &[]),
            line("friction on base and barrier", "1", |q| q("friction_1"), &[]),
            line("normal impact on base and barrier", "1", |q| q("impact_1"), &[]),
            line("PIC damping", "1", |q| q("pic_1"), &[]),
            line("largest share in motion", "1", |q| q("kinetic_max_1"), &[]),
            line("not accounted for", "1", |q| q("energy_residual_1"), &[]),
        ],
    },
    Figure {
        number: "4",
        title: "the force on the barrier against time",
        shows: "Normal force on the barrier, from the grid's impulse and from the stress of two layers of material points. The \
                bands are what equilibrium allows at rest, between the base friction mobilised fully down and up the flume, and \
                the experiment; the lines are closed forms and what the authors computed.",
        drawn: &[("force_time", "force against time")],
        lines: &[
            line("static force", "N", |q| q("static_force_n"), &["F12", "F17"]),
            line("largest measured force (ours: mean over 20 ms)", "N", |q| q("peak_20ms_n"), &["F14"]),
            line("largest over static force", "1", |q| q("peak_20ms_n") / q("static_force_n"), &["F13", "F19"]),
            line("time to static force", "s", |q| q("time_to_static_s"), &["F15"]),
            line("time from impact to static force", "s", |q| q("time_to_static_s") - q("arrival_s"), &["F20"]),
            line("least force in equilibrium", "N", |q| q("weight_along_n") - q("friction_limit_n"), &["F11"]),
            line("greatest force in equilibrium", "N", |q| q("weight_along_n") + q("friction_limit_n"), &[]),
            line("mobilised share of the base friction, down the flume", "1", |q| q("mobilised_1"), &[]),
            line("largest force of a single step", "N", |q| q("peak_step_n"), &[]),
            line("impulse in the half second after impact", "N s", |q| q("impulse_half_second_n_s"), &[]),
        ],
    },
    Figure {
        number: "15",
        title: "the force from stress layers (Eq. 8)",
        shows: "The force on the barrier that is read off the stress of the nearest one, two and three layers of material points \
                (the paper's Eq. 8), beside the impulse that the barrier gave to the grid, means over 20 ms. The impulse is the \
                force, to round-off; the layers are an estimate of it.",
        drawn: &[("layers_plot", "force from the impulse and from layers")],
        lines: &[
            line("static force, from the impulse", "N", |q| q("static_force_n"), &[]),
            line("1 layer over impulse", "1", |q| q("static_layer1_n") / q("static_force_n"), &[]),
            line("2 layers over impulse", "1", |q| q("static_layer2_n") / q("static_force_n"), &[]),
            line("3 layers over impulse", "1", |q| q("static_layer3_n") / q("static_force_n"), &[]),
            line("2 layers over 1", "1", |q| q("static_layer2_n") / q("static_layer1_n"), &["F21"]),
            line("3 layers over 1", "1", |q| q("static_layer3_n") / q("static_layer1_n"), &["F22"]),
        ],
    },
];

#[cfg(test)]
mod tests {
    use super::super::compare;
    use super::*;

    /// What is compared elsewhere stands on one page, with the same number of ours beside it.
    #[test]
    fn every_number_that_is_compared_has_its_line() {
        let made_up = |name: &str| 1.0 + name.bytes().map(f64::from).sum::<f64>() % 97.0;
        let lines = || FIGURES.iter().flat_map(|f| f.lines);
        for case in ["40deg", "23deg"] {
            for (datum, of) in compare::published(case) {
                let own: Vec<&Line> = lines().filter(|l| l.stated.contains(&datum.id.as_str())).collect();
                assert_eq!(own.len(), 1, "{}", datum.id);
                assert_eq!(own[0].unit, datum.unit, "{}", datum.id);
                assert_eq!((own[0].of)(&made_up), of(&made_up), "{}", datum.id);
            }
        }
    }
}
