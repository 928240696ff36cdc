//! The figures, from the tables of a release.

use super::releases::{FIELDS, RELEASES, Release};
use super::{derived_folder, record_folder};
use crate::barrier::INCLINATION_DEG;
use checkdam::plot::curves::{self, Curve, Curves, Panel, panel};
use checkdam::plot::flow_snapshots::{self, Shown};
use checkdam::plot::{PlotError, energy_shares};
use std::path::Path;

const fn curve(column: &'static str, label: &'static str, exact: bool) -> Curve<'static> {
    Curve { column, label, exact }
}

const EACH: &[Panel<'static>] = &[
    panel("plastic, n = 2.5e-6", &[("barrier", "plastic")]),
    panel("fibre glass, n = 1e-5", &[("barrier", "fibre glass")]),
    panel("steel, n = 1e-4", &[("barrier", "steel")]),
    panel("concrete, n = 1", &[("barrier", "concrete")]),
];
const SPLIT: &[(&str, &str)] = &[("barrier", "")];

const PRESSURE: Curves = Curves {
    x: "time_s",
    x_title: "time after release (s)",
    y_title: "mean pressure on the barrier (kPa)",
    curves: &[curve("pressure_kpa", "", false)],
    split: SPLIT,
    ..Curves::LINEAR
};
const WAVES: Curves = Curves {
    x: "distance_m",
    x_title: "distance up the flow from the face (m)",
    y_title: "pressure (Pa)",
    curves: &[curve("pressure_pa", "", false)],
    panels: EACH,
    split: &[("shown", "after the arrival: ")],
    ..Curves::LINEAR
};
const VELOCITY: Curves = Curves {
    x: "velocity_over_front_1",
    x_title: "velocity of the barrier over that of the front",
    y_title: "height over the depth of the flow",
    curves: &[curve("height_over_depth_1", "", false)],
    split: SPLIT,
    ..Curves::LINEAR
};
const BENT: Curves = Curves {
    x: "deflection_percent",
    x_title: "deflection over the height of the barrier (%)",
    y_title: "height over the depth of the flow",
    curves: &[curve("height_over_depth_1", "", false)],
    split: SPLIT,
    ..Curves::LINEAR
};
const AT_REST: Curves = Curves {
    x: "height_m",
    x_title: "height above the foot (m)",
    y_title: "pressure (kPa)",
    curves: &[
        curve("pressure_kpa", "mean over the last 0.3 s and 50 mm", false),
        curve("at_rest_kpa", "at rest, Jaky", true),
        curve("rankine_active_kpa", "Rankine, active", true),
        curve("rankine_passive_kpa", "Rankine, passive", true),
        curve("coulomb_active_kpa", "Coulomb, active", true),
    ],
    panels: EACH,
    ..Curves::LINEAR
};
const ENERGY: Curves = Curves {
    x: "time_s",
    x_title: "time after release (s)",
    y_title: "share of the energy at release",
    curves: &[
        curve("kinetic_1", "kinetic", false),
        curve("dissipated_1", "dissipated", false),
        curve("barrier_1", "kinetic and elastic, of the barrier", false),
        curve("residual_1", "not accounted for", true),
    ],
    panels: EACH,
    ..Curves::LINEAR
};
const SLIP: Curves = Curves {
    x: "time_s",
    x_title: "time after release (s)",
    y_title: "share of all that is dissipated",
    curves: &[
        curve("deposit_1", "plastic: deposit", false),
        curve("slip_surface_1", "plastic: slip surface", false),
        curve("flow_1", "plastic: flow", false),
        curve("friction_base_1", "friction: base", false),
        curve("friction_barrier_1", "friction: barrier", false),
        curve("side_walls_1", "friction: side walls", false),
    ],
    panels: EACH,
    ..Curves::LINEAR
};
const STRESS: Shown = Shown { column: "pressure_pa", title: "pressure (Pa)", top: None, logarithmic_from: Some(100.0) };
const SHEAR: Shown =
    Shown { column: "plastic_shear_strain", title: "plastic shear strain", top: Some(8.0), logarithmic_from: None };

/// Draws those of both releases; their names.
pub(super) fn draw(folder: &Path) -> Result<Vec<String>, PlotError> {
    let mut names = Vec::new();
    for release in &RELEASES {
        names.extend(draw_release(folder, release)?);
    }
    Ok(names)
}

fn draw_release(folder: &Path, release: &Release) -> Result<Vec<String>, PlotError> {
    let (tables, derived) = (record_folder(folder, release), derived_folder(folder, release));
    let mut names = Vec::new();
    let mut at = |name: &str| {
        names.push(format!("{}_{name}.svg", release.figures));
        folder.join(format!("{}_{name}.svg", release.figures))
    };
    let curves: [(&Path, &str, &Curves, &str); 7] = [
        (&tables, "pressure.csv", &PRESSURE, "pressure"),
        (&derived, "wave_shown.csv", &WAVES, "wave"),
        (&tables, "at_peak.csv", &VELOCITY, "velocity"),
        (&tables, "at_peak.csv", &BENT, "deflection"),
        (&derived, "at_rest_lines.csv", &AT_REST, "at_rest"),
        (&tables, "energy.csv", &ENERGY, "energy"),
        (&derived, "slip_shares.csv", &SLIP, "slip"),
    ];
    for (folder, table, what, name) in curves {
        curves::draw(folder.join(table), what, at(name))?;
    }
    for barrier in FIELDS {
        let [field, outline, mechanisms] =
            ["field", "outline", "mechanisms"].map(|what| tables.join(format!("{what}_{barrier}.csv")));
        for (shown, name) in [(&STRESS, "stress"), (&SHEAR, "shear")] {
            let (geometry, out) = (tables.join("geometry.csv"), at(&format!("{name}_{barrier}")));
            flow_snapshots::draw_with_barrier(&field, shown, geometry, Some(&outline), INCLINATION_DEG, out)?;
        }
        energy_shares::draw(mechanisms, at(&format!("mechanisms_{barrier}")))?;
    }
    Ok(names)
}
