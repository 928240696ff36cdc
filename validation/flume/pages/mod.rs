//! One page per figure of the paper: what was measured, what the authors computed, what we compute, our numerical error, and the
//! spread that the unstated inputs cause.
//!
//! [`tables`] puts the numbers side by side, from the records and the paper's table; [`write`] makes pages (Markdown) of them.
//! Nothing on a page is typed in but words.

mod digits;
mod extras;
mod lines;
mod table;
mod text;

use lines::{LINES, Line};
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
}

impl Figure {
    /// Name of its page, without extension.
    fn stem(&self) -> String {
        format!("flume_fig_{}", self.number)
    }

    /// Rows of its table.
    fn lines(&self) -> impl Iterator<Item = &'static Line> {
        LINES.iter().filter(|l| l.figure == self.number)
    }
}

const FIGURES: [Figure; 4] = [
    Figure {
        number: "2",
        title: "the flow before and after it meets the barrier",
        shows: "The flow at several instants, turned so that gravity points down, coloured by speed; below, the velocity of the \
                front along the flume beside that of a block that slides from rest with the base's friction. Times count from \
                the opening of the gate.",
        drawn: &[("flow_snapshots", "flow, coloured by speed"), ("front_plot", "velocity of the front")],
    },
    Figure {
        number: "3",
        title: "where the energy goes",
        shows: "Shares of the energy that the sand has at release over that of its final place at the foot of the barrier (E0), \
                from the ledger of the run: what the sand loses in height goes into motion first, and then into plastic work and \
                the friction of the base. What remains as height at the end is the deposit's.",
        drawn: &[("energy_shares", "energy shares against time")],
    },
    Figure {
        number: "4",
        title: "the force on the barrier against time",
        shows: "Normal force on the barrier, from the grid's impulse and from the stress of two layers of material points. The \
                bands are what equilibrium allows at rest, between the base friction mobilised fully down and up the flume, and \
                the experiment; the lines are closed forms and what the authors computed.",
        drawn: &[("force_time", "force against time")],
    },
    Figure {
        number: "15",
        title: "the force from stress layers (Eq. 8)",
        shows: "The force on the barrier that is read off the stress of the nearest one, two and three layers of material points \
                (the paper's Eq. 8), beside the impulse that the barrier gave to the grid, means over 20 ms. The impulse is the \
                force, to round-off; the layers are an estimate of it.",
        drawn: &[("layers_plot", "force from the impulse and from layers")],
    },
];
