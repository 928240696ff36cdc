//! Tables and figures of the flume: what a reader of the paper's Figs. 2, 3, 4 and 15 looks for.

use super::{CASES, compare, run_folder};
use crate::case_run::{CaseRun, base_friction};
use checkdam::output::Table;
use checkdam::plot::curves::{self, Curve, Curves};
use checkdam::plot::force_time::{self, ReferenceLine};
use checkdam::plot::{PlotError, energy_shares, flow_snapshots, pressure_profile};
use checkdam::theory::jump;
use checkdam::theory::sliding_block::acceleration_from_rest;
use checkdam_verification::report::{quoted, table_csv};
use std::path::Path;

/// Samples of the history in a row of the table of layers: 20 ms.
const SAMPLES: usize = 20;

/// Tables of a run that the figures are drawn from, besides those in its folder.
pub fn tables(flume: &CaseRun) -> Vec<(String, String)> {
    let name = flume.name;
    vec![
        (format!("flume_{name}_references"), references(flume)),
        (format!("flume_{name}_front"), front(flume)),
        (format!("flume_{name}_layers"), layers(flume)),
    ]
}

/// Forces to compare with: limits of equilibrium, closed forms, the experiment.
fn references(flume: &CaseRun) -> String {
    let case = &flume.summary.case;
    let mut text = String::from("label,value_n,half_width_n\n");
    let mut add = |label: &str, value: f64, half: f64| text += &format!("{},{value:.4},{half:.4}\n", quoted(label));
    if let Some(d) = &flume.summary.deposit {
        if let Some([low, high]) = d.equilibrium_limits_n {
            add(
                "what equilibrium allows at rest, m g sin \u{3b8} \u{2213} \u{3bc} N",
                0.5 * (low + high),
                0.5 * (high - low),
            );
        }
        add("m g (sin \u{3b8} \u{2212} \u{3bc} cos \u{3b8})", d.theoretical_static_force_n, 0.0);
    }
    let window = case.gauges.window_x_m.map(|w| w[0]);
    if let (Some(f), Some(material)) =
        (flume.summary.front.iter().find(|f| Some(f.x_m) == window), case.materials.values().next())
    {
        let (rho, width) = (material.density_kg_per_m3, case.grid.thickness_m);
        let gravity = case.gravity.magnitude_m_per_s2 * libm::cos(case.gravity.inclination_deg.to_radians());
        let (u, h) = (f.velocity_m_per_s, f.depth_m);
        add("momentum flux (Eq. 1, \u{3b1} = 1), our front at 0.7 m", jump::momentum_flux(rho, u, h, width), 0.0);
        add("granular jump of no length, our front at 0.7 m", jump::force(rho, u, h, width, gravity), 0.0);
    }
    for (datum, _) in compare::published(flume.name) {
        if ["largest measured force", "static force"].contains(&datum.quantity.as_str()) {
            add(&format!("paper, {}: {}", datum.kind, datum.quantity), datum.value, datum.uncertainty);
        }
    }
    text
}

/// Velocity of the front along the flume, beside a block that slides from rest with the base's friction.
fn front(flume: &CaseRun) -> String {
    let case = &flume.summary.case;
    let angle = case.gravity.inclination_deg.to_radians();
    let acceleration = acceleration_from_rest(case.gravity.magnitude_m_per_s2, angle, base_friction(case));
    let rows = flume.summary.front.iter().map(|f| {
        let block = (2.0 * acceleration * f.x_m).sqrt();
        vec![f.x_m, f.time_s, f.velocity_m_per_s, f.depth_m, f.froude_1, block]
    });
    table_csv(&["x_m", "time_s", "front_velocity_m_per_s", "front_depth_m", "froude_1", "block_velocity_m_per_s"], rows)
}

/// Force from the impulse and from the stress of 1, 2, 3 layers, means over 20 ms (Eq. 8 and Fig. 15 of the paper).
fn layers(flume: &CaseRun) -> String {
    let rows = flume.records.history.chunks(SAMPLES).filter(|c| c.len() == SAMPLES).map(|chunk| {
        let mean = |value: fn(&checkdam::run::records::HistoryRow) -> f64| {
            chunk.iter().map(value).sum::<f64>() / SAMPLES as f64
        };
        vec![mean(|r| r.time), mean(|r| r.normal), mean(|r| r.layers[0]), mean(|r| r.layers[1]), mean(|r| r.layers[2])]
    });
    table_csv(&["time_s", "impulse_n", "layers_1_n", "layers_2_n", "layers_3_n"], rows)
}

const fn curve(column: &'static str, label: &'static str, exact: bool) -> Curve<'static> {
    Curve { column, label, exact }
}

const FRONT: Curves = Curves {
    x: "x_m",
    x_title: "distance from the gate (m)",
    y_title: "velocity (m/s)",
    curves: &[
        curve("front_velocity_m_per_s", "front, first 0.05 m", false),
        curve("block_velocity_m_per_s", "block from rest with the base's friction", true),
    ],
    ..Curves::LINEAR
};

const LAYERS: Curves = Curves {
    x: "time_s",
    x_title: "time (s)",
    y_title: "normal force on the barrier (N)",
    curves: &[
        curve("impulse_n", "impulse", false),
        curve("layers_1_n", "stress, 1 layer", false),
        curve("layers_2_n", "stress, 2 layers", false),
        curve("layers_3_n", "stress, 3 layers", false),
    ],
    ..Curves::LINEAR
};

/// Draws all figures of both cases.
///
/// # Errors
/// The first that cannot be drawn.
pub fn draw(folder: &Path) -> Result<Vec<String>, PlotError> {
    let mut names = Vec::new();
    for (name, _) in CASES {
        let run = run_folder(folder, name);
        let mut at = |figure: &str| {
            names.push(format!("flume_{name}_{figure}.svg"));
            folder.join(format!("flume_{name}_{figure}.svg"))
        };
        let table = |stem: &str| folder.join(format!("flume_{name}_{stem}.csv"));
        let references = Table::load(table("references"))?;
        let lines: Vec<ReferenceLine> = (references.cells("label")?.into_iter())
            .zip(references.column("value_n")?.iter().zip(references.column("half_width_n")?))
            .map(|(label, (&value_n, &half_width_n))| ReferenceLine { label, value_n, half_width_n })
            .collect();
        force_time::draw(run.join("history.csv"), &lines, at("force_time"))?;
        energy_shares::draw(run.join("energy.csv"), at("energy_shares"))?;
        let angle = name.trim_end_matches("deg").parse().unwrap_or(0.0);
        flow_snapshots::draw(run.join("field.csv"), run.join("geometry.csv"), angle, at("flow_snapshots"))?;
        pressure_profile::draw(run.join("pressure_profile.csv"), at("pressure_profile"))?;
        curves::draw(table("front"), &FRONT, at("front_plot"))?;
        curves::draw(table("layers"), &LAYERS, at("layers_plot"))?;
    }
    Ok(names)
}
