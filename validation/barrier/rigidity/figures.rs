//! Figures of the rigidities.

use crate::barrier::records::{CALIBRATED, LITERAL};
use checkdam::plot::PlotError;
use checkdam::plot::curves::{self, Curve, Curves, Panel, panel};
use std::path::Path;

const RELEASES: &[Panel<'static>] =
    &[panel("literal release", &[("release", LITERAL)]), panel("calibrated release", &[("release", CALIBRATED)])];

const COEFFICIENT: Curves = Curves {
    x: "stiffness_1",
    x_title: "normalised stiffness 3 EI/H\u{b3}",
    y_title: "impact coefficient",
    curves: &[
        Curve { column: "alpha_1", label: "mean over 20 ms", exact: false },
        Curve { column: "alpha_step_1", label: "largest of a step", exact: false },
        Curve { column: "alpha_50hz_1", label: "samples every 20 ms", exact: false },
        Curve { column: "alpha_low_1", label: "one standard deviation", exact: true },
        Curve { column: "alpha_high_1", label: "one standard deviation", exact: true },
        Curve { column: "guideline_rigid_1", label: "guideline, rigid", exact: true },
        Curve { column: "guideline_flexible_1", label: "guideline, flexible", exact: true },
    ],
    panels: RELEASES,
    ..Curves::LOGARITHMIC
};

const DEFLECTION: Curves = Curves {
    x: "stiffness_1",
    x_title: "normalised stiffness 3 EI/H\u{b3}",
    y_title: "deflection over the height",
    curves: &[
        Curve { column: "tip_final_1", label: "tip, at the end", exact: false },
        Curve { column: "tip_max_1", label: "tip, largest", exact: false },
        Curve { column: "deflection_at_peak_1", label: "anywhere, at the largest force", exact: false },
    ],
    panels: RELEASES,
    ..Curves::LOGARITHMIC
};

const AGAINST_IMPEDANCE: Curves = Curves {
    x: "stiffness_1",
    x_title: "normalised stiffness 3 EI/H\u{b3}",
    y_title: "share",
    curves: &[
        Curve { column: "over_rigid_1", label: "force over that of a rigid wall", exact: false },
        Curve { column: "velocity_over_front_1", label: "barrier's velocity over the front's", exact: false },
        Curve { column: "impedance_over_rigid_1", label: "impedances: force", exact: true },
        Curve { column: "impedance_velocity_1", label: "impedances: velocity", exact: true },
    ],
    panels: RELEASES,
    ..Curves::LOGARITHMIC
};

pub(super) fn draw(folder: &Path) -> Result<Vec<String>, PlotError> {
    let figures = [
        ("barrier_rigidity_coefficient.svg", &COEFFICIENT),
        ("barrier_rigidity_deflection.svg", &DEFLECTION),
        ("barrier_rigidity_impedance.svg", &AGAINST_IMPEDANCE),
    ];
    for (name, what) in figures {
        curves::draw(folder.join("barrier_rigidity_runs.csv"), what, folder.join(name))?;
    }
    Ok(figures.map(|f| f.0.into()).into())
}
