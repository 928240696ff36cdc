//! Figures of the ladder: what to draw from which table. They are drawn from the tables' text and from nothing else.

use checkdam::plot::PlotError;
use checkdam::plot::curves::{self, Curve, Curves, Panel, panel};
use checkdam::plot::heat_map::{self, HeatMap};
use std::path::Path;

/// A figure of a rung.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure {
    /// Rung.
    pub rung: &'static str,
    /// Table, without extension.
    pub table: &'static str,
    /// Name, without extension.
    pub name: &'static str,
    /// What to draw.
    pub drawing: Drawing,
}

/// What to draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drawing {
    /// Columns against a column.
    Curves(Curves<'static>),
    /// A column by two others.
    HeatMap(HeatMap),
}

const fn measured(column: &'static str, label: &'static str) -> Curve<'static> {
    Curve { column, label, exact: false }
}

const fn exact(column: &'static str, label: &'static str) -> Curve<'static> {
    Curve { column, label, exact: true }
}

const fn curves(rung: &'static str, table: &'static str, name: &'static str, curves: Curves<'static>) -> Figure {
    Figure { rung, table, name, drawing: Drawing::Curves(curves) }
}

const SHAPES: [Panel<'static>; 3] = [
    panel("linear", &[("shape", "linear")]),
    panel("uGIMP", &[("shape", "uGIMP")]),
    panel("B-spline", &[("shape", "B-spline")]),
];

/// All points of a manufactured solution at the first time, by shape function.
const MANUFACTURED: [Panel<'static>; 3] = [
    panel("linear", &[("shape", "linear"), ("ct_over_side", "0.3"), ("place", "all points")]),
    panel("uGIMP", &[("shape", "uGIMP"), ("ct_over_side", "0.3"), ("place", "all points")]),
    panel("B-spline", &[("shape", "B-spline"), ("ct_over_side", "0.3"), ("place", "all points")]),
];

/// All figures.
pub const FIGURES: &[Figure] = &[
    curves(
        "exactness",
        "exactness_spinning_disk",
        "exactness_spinning_disk_plot",
        Curves {
            x: "cells_per_radius",
            x_title: "cells per radius",
            y_title: "change of angular momentum in 0.35 turns, relative",
            curves: &[measured("angular_momentum_change", "spinning disk")],
            orders: &[2.0],
            ..Curves::LOGARITHMIC
        },
    ),
    curves(
        "neo_hookean",
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
    ),
    curves(
        "contact",
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
        "contact",
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
    curves(
        "self_weight",
        "self_weight_profile",
        "self_weight_profile_plot",
        Curves {
            x: "y_exact_m",
            x_title: "height (m)",
            y_title: "vertical stress (Pa)",
            curves: &[measured("stress_pa", "points"), exact("stress_exact_pa", "exact")],
            split: &[("cell_size_m", "cell size (m) ")],
            ..Curves::LINEAR
        },
    ),
    curves(
        "self_weight",
        "self_weight_convergence",
        "self_weight_convergence_plot",
        Curves {
            x: "cells",
            x_title: "cells over the height",
            y_title: "relative error",
            curves: &[
                measured("stress_error", "stress"),
                measured("position_error", "position"),
                measured("energy_error", "elastic energy"),
            ],
            panels: &[panel("soft column", &[("column", "soft")]), panel("stiff column", &[("column", "stiff")])],
            orders: &[1.0, 2.0],
            ..Curves::LOGARITHMIC
        },
    ),
    curves(
        "sliding_block",
        "sliding_block_slip",
        "sliding_block_slip_plot",
        Curves {
            x: "time_s",
            x_title: "time (s)",
            y_title: "displacement (m)",
            curves: &[measured("displacement_m", ""), exact("displacement_exact_m", "exact")],
            panels: &[
                panel("slope 40°", &[("slope_deg", "40")]),
                panel("slope 31°", &[("slope_deg", "31")]),
                panel("slope 23°", &[("slope_deg", "23")]),
            ],
            split: &[("block", ""), ("plane_to_grid_deg", "plane to grid (degrees) ")],
            ..Curves::LINEAR
        },
    ),
    curves(
        "drucker_prager_point",
        "drucker_prager_point_jaumann",
        "drucker_prager_point_jaumann_plot",
        Curves {
            x: "gamma",
            x_title: "shear strain",
            y_title: "stress (Pa)",
            curves: &[
                measured("sigma_xy_pa", "shear"),
                exact("sigma_xy_exact_pa", "G sin(gamma)"),
                measured("sigma_xx_pa", "normal"),
                exact("sigma_xx_exact_pa", "G (1 - cos(gamma))"),
            ],
            ..Curves::LINEAR
        },
    ),
    curves(
        "drucker_prager_point",
        "drucker_prager_point_angles",
        "drucker_prager_point_angles_plot",
        Curves {
            x: "friction_angle_deg",
            x_title: "friction angle that the cone is given (degrees)",
            y_title: "friction angle in plane strain (degrees)",
            curves: &[measured("plane_strain_angle_deg", ""), exact("plane_strain_angle_exact_deg", "closed form")],
            split: &[("cone", "")],
            ..Curves::LINEAR
        },
    ),
    curves(
        "drucker_prager_point",
        "drucker_prager_point_opening",
        "drucker_prager_point_opening_plot",
        Curves {
            x: "strain",
            x_title: "vertical strain, opened and closed again",
            y_title: "vertical pressure (Pa)",
            curves: &[measured("vertical_pressure_pa", "")],
            split: &[("void_tracking", "void tracking ")],
            ..Curves::LINEAR
        },
    ),
    curves(
        "celerity",
        "celerity_lag",
        "celerity_lag_plot",
        Curves {
            x: "cells",
            x_title: "cells along the bar",
            y_title: "lag of a pulse behind the wave speed",
            curves: &[measured("lag", ""), exact("lag_exact", "dispersion of the scheme")],
            split: &[("bar", "")],
            orders: &[2.0],
            ..Curves::LOGARITHMIC
        },
    ),
    curves(
        "celerity",
        "celerity_impact",
        "celerity_impact_plot",
        Curves {
            x: "time_s",
            x_title: "time after contact (s)",
            y_title: "force on the wall (N)",
            curves: &[measured("force_n", "bar strikes wall"), exact("force_exact_n", "rho c v A for 2L/c")],
            ..Curves::LINEAR
        },
    ),
    curves(
        "energy",
        "energy_drift",
        "energy_drift_plot",
        Curves {
            x: "cfl",
            x_title: "c dt / h",
            y_title: "energy to and fro within a period, relative",
            curves: &[measured("energy_to_and_fro", ""), exact("energy_to_and_fro_exact", "w dt / 2")],
            split: &[("scheme", ""), ("cells", "cells ")],
            ..Curves::LOGARITHMIC
        },
    ),
    curves(
        "energy",
        "energy_pic_decay",
        "energy_pic_decay_plot",
        Curves {
            x: "kh",
            x_title: "wave number times cell size",
            y_title: "rate of decay (1/s)",
            curves: &[measured("rate_1_s", "standing wave"), exact("rate_exact_1_s", "a (1 - T²)/dt")],
            ..Curves::LINEAR
        },
    ),
    curves(
        "earth_pressure",
        "earth_pressure_profile",
        "earth_pressure_profile_plot",
        Curves {
            x: "depth_m",
            x_title: "depth (m)",
            y_title: "lateral stress (Pa)",
            curves: &[measured("lateral_pa", ""), exact("lateral_exact_pa", "closed form")],
            split: &[("cone", "")],
            ..Curves::LINEAR
        },
    ),
    curves(
        "manufactured",
        "manufactured_space",
        "manufactured_space_plot",
        Curves {
            x: "cells",
            x_title: "cells per side",
            y_title: "error of displacement / amplitude",
            curves: &[measured("displacement_error", "")],
            panels: &MANUFACTURED,
            split: &[("amplitude_over_side", "amplitude / side ")],
            orders: &[1.0, 2.0],
            ..Curves::LOGARITHMIC
        },
    ),
    curves(
        "manufactured",
        "manufactured_space",
        "manufactured_stress_plot",
        Curves {
            x: "cells",
            x_title: "cells per side",
            y_title: "error of stress / (M k A)",
            curves: &[measured("stress_error", "")],
            panels: &MANUFACTURED,
            split: &[("amplitude_over_side", "amplitude / side ")],
            orders: &[1.0, 2.0],
            ..Curves::LOGARITHMIC
        },
    ),
    curves(
        "manufactured",
        "manufactured_time",
        "manufactured_time_plot",
        Curves {
            x: "c_dt_over_h",
            x_title: "c dt / h",
            y_title: "change of displacement / amplitude",
            curves: &[measured("displacement_change", "")],
            panels: &SHAPES,
            split: &[("amplitude_over_side", "amplitude / side ")],
            ..Curves::LOGARITHMIC
        },
    ),
    curves(
        "manufactured",
        "manufactured_vortex",
        "manufactured_vortex_plot",
        Curves {
            x: "cells",
            x_title: "cells per radius of the vortex",
            y_title: "relative error",
            curves: &[measured("displacement_error", "displacement"), measured("stress_error", "stress")],
            panels: &SHAPES,
            split: &[("angle_rad", "angle (rad) ")],
            orders: &[1.0, 2.0],
            ..Curves::LOGARITHMIC
        },
    ),
    curves(
        "cantilever",
        "cantilever_deflection",
        "cantilever_deflection_plot",
        Curves {
            x: "cells_through_depth",
            x_title: "cells through the depth",
            y_title: "error of the deflection, relative",
            curves: &[measured("deflection_error", "")],
            panels: &[panel("uGIMP", &[("shape", "uGIMP")]), panel("B-spline", &[("shape", "B-spline")])],
            split: &[("load", ""), ("length_over_depth", "L/t "), ("poisson", "nu ")],
            orders: &[1.0, 2.0],
            ..Curves::LOGARITHMIC
        },
    ),
    curves(
        "cantilever",
        "cantilever_elastica",
        "cantilever_elastica_plot",
        Curves {
            x: "cells_through_depth",
            x_title: "cells through the depth",
            y_title: "deflection / length, at 26° of the tip",
            curves: &[measured("deflection_over_length", ""), exact("deflection_exact", "elastica with shear")],
            split: &[("shape", "")],
            ..Curves::LINEAR
        },
    ),
    curves(
        "cantilever",
        "cantilever_frequency",
        "cantilever_frequency_plot",
        Curves {
            x: "cells_through_depth",
            x_title: "cells through the depth",
            y_title: "first frequency (Hz)",
            curves: &[measured("frequency_hz", ""), exact("frequency_exact_hz", "3.516, shear, rotary inertia")],
            split: &[("shape", "")],
            ..Curves::LINEAR
        },
    ),
    curves(
        "wall_pressure",
        "wall_pressure_stroke",
        "wall_pressure_stroke_plot",
        Curves {
            x: "stroke_percent",
            x_title: "stroke / height of the wall (%)",
            y_title: "normal force / (rho g H² / 2)",
            curves: &[
                measured("coefficient", ""),
                exact("coefficient_theory", "closed form of the fill's cone"),
                exact("coefficient_at_31_deg", "Rankine or Coulomb at 31°"),
            ],
            panels: &[
                panel("active, smooth base", &[("side", "active"), ("base", "smooth")]),
                panel("passive, smooth base", &[("side", "passive"), ("base", "smooth")]),
                panel("active, wedge on a rough base", &[("side", "active"), ("base", "rough")]),
                panel("passive, wedge on a rough base", &[("side", "passive"), ("base", "rough")]),
            ],
            split: &[("fill", "")],
            ..Curves::LINEAR
        },
    ),
    curves(
        "wall_pressure",
        "wall_pressure_wedge",
        "wall_pressure_wedge_plot",
        Curves {
            x: "height_over_height",
            x_title: "height / height of the wall",
            y_title: "distance / height of the wall",
            curves: &[
                measured("edge_over_height", ""),
                exact("coulomb_over_height", "Coulomb's wedge, smooth wall: 45° ± phi/2"),
                exact("roscoe_over_height", "45° ± psi/2"),
            ],
            panels: &[
                panel("active, constant volume", &[("side", "active"), ("flow", "constant volume")]),
                panel("passive, constant volume", &[("side", "passive"), ("flow", "constant volume")]),
                panel("active, associated flow", &[("side", "active"), ("flow", "associated")]),
                panel("passive, associated flow", &[("side", "passive"), ("flow", "associated")]),
            ],
            split: &[("fill", "")],
            ..Curves::LINEAR
        },
    ),
    curves(
        "collapse",
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
        "collapse",
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
    Figure {
        rung: "convergence",
        table: "convergence_grids",
        name: "convergence_grids_plot",
        drawing: Drawing::HeatMap(HeatMap {
            panel: "quantity",
            panels: &[
                ("bar_plateau_pa", "bar on a wall: force"),
                ("bar_impulse_over_2mv", "bar on a wall: impulse"),
                ("column_wall_force_n_per_m", "column: force on the wall"),
                ("column_settlement_m", "column: settlement"),
                ("flume_peak_20ms_n", "flume: peak force over 20 ms"),
                ("flume_static_n", "flume: static force"),
                ("flume_arrival_s", "flume: arrival"),
                ("flume_front_velocity_at_0.7m_m_per_s", "flume: front velocity at 0.7 m"),
            ],
            x: "h_m",
            x_title: "cell size (m)",
            y: "particles_per_cell",
            y_title: "points/cell",
            value: "deviation_percent",
            value_title: "deviation from the reference (%), colour by its size",
        }),
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
        let (table, path) = (folder.join(f.table).with_extension("csv"), folder.join(&file));
        match &f.drawing {
            Drawing::Curves(what) => curves::draw(table, what, path)?,
            Drawing::HeatMap(what) => heat_map::draw(table, what, path)?,
        }
        Ok(file)
    })
    .collect()
}
