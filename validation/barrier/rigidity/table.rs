//! Every rigidity in numbers.

use super::{Analysis, front};
use crate::Failure;
use crate::barrier::records::{RIGIDITY, height, impact_coefficient, impedance, young_of_one};
use crate::barrier::{PUBLISHED, data};
use checkdam_verification::report::number;

pub(super) fn table(analysis: &Analysis) -> Result<String, Failure> {
    let case = RIGIDITY.first_case()?;
    let (sand, barrier) = (&case.materials["sand"], &case.materials["barrier"]);
    let of_sand = impedance(sand.young_pa, sand.poisson, sand.density_kg_per_m3);
    let columns = [
        "release",
        "stiffness_1",
        "young_pa",
        "peak_20ms_n",
        "peak_mean_n",
        "peak_deviation_n",
        "runs",
        "peak_step_n",
        "peak_50hz_n",
        "alpha_1",
        "alpha_low_1",
        "alpha_high_1",
        "alpha_step_1",
        "alpha_50hz_1",
        "alpha_at_barrier_1",
        "over_rigid_1",
        "over_rigid_deviation_1",
        "impedance_over_rigid_1",
        "velocity_over_front_1",
        "impedance_velocity_1",
        "deflection_at_peak_1",
        "tip_final_1",
        "tip_max_1",
        "static_force_n",
        "static_clamp_n",
        "remaining_1",
        "dissipated_1",
        "energy_residual_1",
        "gap_cells",
        "guideline_rigid_1",
        "guideline_flexible_1",
        "ended",
    ];
    let height = height(&case);
    let guideline = ["B5", "B6"].map(|id| data::row(PUBLISHED, id).value);
    let mut text = columns.join(",") + "\n";
    for (release, points) in &analysis.releases {
        for p in points {
            let [window, at_barrier] = front(&p.run);
            let alpha = |force: f64| impact_coefficient(&case, force, window[0], window[1]);
            let young = p.stiffness * young_of_one(&case);
            let of_barrier = impedance(young, barrier.poisson, barrier.density_kg_per_m3);
            let share = of_barrier / (of_barrier + of_sand);
            let get = |name: &str| p.run.get(name);
            let values = [
                p.stiffness,
                young,
                get("peak_20ms_n"),
                p.peaks.mean,
                p.peaks.deviation,
                p.peaks.count as f64,
                get("peak_step_n"),
                get("peak_50hz_n"),
                alpha(p.peaks.mean),
                alpha(p.peaks.mean - p.peaks.deviation),
                alpha(p.peaks.mean + p.peaks.deviation),
                alpha(get("peak_step_n")),
                alpha(get("peak_50hz_n")),
                impact_coefficient(&case, p.peaks.mean, at_barrier[0], at_barrier[1]),
                p.over_rigid.mean,
                p.over_rigid.deviation,
                share,
                get("peak_barrier_velocity_m_per_s") / at_barrier[0],
                1.0 - share,
                get("peak_deflection_m") / height,
                get("tip_final_m") / height,
                get("tip_max_m") / height,
                get("static_force_n"),
                get("static_clamp_n"),
                1.0 - get("dissipated_1"),
                get("dissipated_1"),
                get("energy_residual_1"),
                get("gap_cells"),
                guideline[0],
                guideline[1],
            ];
            let cells = values.map(|x| if x.is_finite() { number(x) } else { String::new() });
            text += &format!("{release},{},{}\n", cells.join(","), p.run.ended);
        }
    }
    Ok(text)
}
