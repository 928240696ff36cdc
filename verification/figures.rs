//! Figures of the ladder: which curves to draw from which table. They are drawn from the tables' text and from nothing else.

use crate::plot::PlotError;
use crate::plot::curves::{Curve, Curves, draw};
use std::path::Path;

/// A figure of a rung.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Figure {
    /// Rung.
    pub rung: &'static str,
    /// Table, without extension.
    pub table: &'static str,
    /// Name, without extension.
    pub name: &'static str,
    /// What to draw.
    pub curves: Curves,
}

const fn measured(column: &'static str, label: &'static str) -> Curve {
    Curve { column, label, exact: false }
}

const fn exact(column: &'static str, label: &'static str) -> Curve {
    Curve { column, label, exact: true }
}

/// All figures.
pub const FIGURES: &[Figure] = &[
    Figure {
        rung: "exactness",
        table: "exactness_spinning_disk",
        name: "exactness_spinning_disk_plot",
        curves: Curves {
            x: "cells_per_radius",
            x_title: "cells per radius",
            y_title: "relative change of angular momentum in 0.35 revolutions",
            curves: &[measured("angular_momentum_change", "spinning disk")],
            split: None,
            logarithmic: true,
        },
    },
    Figure {
        rung: "self_weight",
        table: "self_weight_profile",
        name: "self_weight_profile_plot",
        curves: Curves {
            x: "y_exact_m",
            x_title: "height (m)",
            y_title: "vertical stress (Pa)",
            curves: &[measured("stress_pa", "points"), exact("stress_exact_pa", "exact")],
            split: Some(("cell_size_m", "h = ")),
            logarithmic: false,
        },
    },
    Figure {
        rung: "sliding_block",
        table: "sliding_block_slip",
        name: "sliding_block_slip_plot",
        curves: Curves {
            x: "time_s",
            x_title: "time (s)",
            y_title: "displacement (m)",
            curves: &[measured("displacement_m", "block"), exact("displacement_exact_m", "exact")],
            split: Some(("slope_deg", "slope ")),
            logarithmic: false,
        },
    },
    Figure {
        rung: "drucker_prager_point",
        table: "drucker_prager_point_jaumann",
        name: "drucker_prager_point_jaumann_plot",
        curves: Curves {
            x: "gamma",
            x_title: "shear strain",
            y_title: "stress (Pa)",
            curves: &[
                measured("sigma_xy_pa", "shear"),
                exact("sigma_xy_exact_pa", "G sin(gamma)"),
                measured("sigma_xx_pa", "normal"),
                exact("sigma_xx_exact_pa", "G (1 - cos(gamma))"),
            ],
            split: None,
            logarithmic: false,
        },
    },
    Figure {
        rung: "celerity",
        table: "celerity_impact",
        name: "celerity_impact_plot",
        curves: Curves {
            x: "time_s",
            x_title: "time after contact (s)",
            y_title: "force on the wall (N)",
            curves: &[measured("force_n", "bar strikes wall"), exact("force_exact_n", "rho c v A for 2L/c")],
            split: None,
            logarithmic: false,
        },
    },
    Figure {
        rung: "energy",
        table: "energy_pic_decay",
        name: "energy_pic_decay_plot",
        curves: Curves {
            x: "kh",
            x_title: "wave number times cell size",
            y_title: "rate of decay (1/s)",
            curves: &[measured("rate_1_s", "shear wave"), exact("rate_exact_1_s", "theory")],
            split: None,
            logarithmic: false,
        },
    },
    Figure {
        rung: "earth_pressure",
        table: "earth_pressure_profile",
        name: "earth_pressure_profile_plot",
        curves: Curves {
            x: "depth_m",
            x_title: "depth (m)",
            y_title: "lateral stress (Pa)",
            curves: &[measured("lateral_pa", "points"), exact("lateral_exact_pa", "exact")],
            split: Some(("cone_outer_plane_strain_printed", "cone ")),
            logarithmic: false,
        },
    },
    Figure {
        rung: "manufactured",
        table: "manufactured_space",
        name: "manufactured_space_plot",
        curves: Curves {
            x: "cells",
            x_title: "cells per side",
            y_title: "error of the displacement over the amplitude",
            curves: &[measured("displacement_error", "all cases")],
            split: Some(("shape_linear_ugimp_bspline", "shape ")),
            logarithmic: true,
        },
    },
    Figure {
        rung: "cantilever",
        table: "cantilever_deflection",
        name: "cantilever_deflection_plot",
        curves: Curves {
            x: "cells_through_depth",
            x_title: "cells through the depth",
            y_title: "relative error of the deflection",
            curves: &[measured("deflection_error", "all cases")],
            split: Some(("shape_ugimp_bspline", "shape ")),
            logarithmic: true,
        },
    },
    Figure {
        rung: "wall_pressure",
        table: "wall_pressure_stroke",
        name: "wall_pressure_stroke_plot",
        curves: Curves {
            x: "stroke_over_height",
            x_title: "stroke over height",
            y_title: "earth pressure coefficient",
            curves: &[measured("coefficient", "all cases")],
            split: None,
            logarithmic: false,
        },
    },
    Figure {
        rung: "collapse",
        table: "collapse_laws",
        name: "collapse_laws_plot",
        curves: Curves {
            x: "aspect_ratio",
            x_title: "height over half width of the column",
            y_title: "run-out over half width",
            curves: &[
                measured("run_out_by_mass", "by mass"),
                measured("run_out_by_depth", "by depth"),
                exact("run_out_lube_2005", "Lube 2005"),
                exact("run_out_lajeunesse_2005", "Lajeunesse 2005"),
            ],
            split: None,
            logarithmic: false,
        },
    },
];

/// Draws the figures of a rung into the folder that holds its tables; returns their names with extension.
///
/// # Errors
/// The first figure that could not be drawn.
pub fn draw_figures(rung: &str, folder: &Path) -> Result<Vec<String>, PlotError> {
    let own = FIGURES.iter().filter(|f| f.rung == rung);
    own.map(|f| {
        let file = format!("{}.svg", f.name);
        draw(folder.join(f.table).with_extension("csv"), &f.curves, folder.join(&file))?;
        Ok(file)
    })
    .collect()
}
