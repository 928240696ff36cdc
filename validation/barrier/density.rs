//! Is it 3 EI/H^3 that decides how much a barrier takes, as the paper says, or its impedance? Barriers of equal rigidity and other
//! mass.
//!
//! For some milliseconds a barrier answers as a half-space: what meets shares the velocity by impedances Z = sqrt(M rho), pressure
//! Z_b/(Z_b + Z_s) of that on a rigid wall and velocity Z_s/(Z_b + Z_s) of the flow's (Saint-Venant 1867). Were rigidity all, density
//! would not matter.

use super::records::{DENSITY, SCATTER, height, impedance, on_rigid_wall, peaks, young_of_one};
use crate::{Context, Failure, Validation};
use checkdam::check::{Check, Expected, Kind};
use checkdam::plot::PlotError;
use checkdam::plot::curves::{self, Curve, Curves, panel};
use checkdam_verification::Outcome;
use checkdam_verification::report::number;
use std::path::Path;

/// The analysis of the recorded runs.
pub const VALIDATION: Validation = Validation {
    name: "barrier_density",
    title: "Barriers of equal rigidity and other mass: does 3 EI/H^3 decide, or the impedance?",
    study: "18 runs, about 4 minutes",
    run,
    draw,
    covers: &[],
};

/// Force over that of a rigid wall for the lightest and the heaviest barrier of a rigidity.
pub struct Range {
    /// Normalised stiffness, as in the table.
    pub stiffness: String,
    /// Density (kg/m3) and share.
    pub ends: [(f64, f64); 2],
    /// What impedances say of these shares.
    pub impedances: [f64; 2],
}

/// Reads the record.
///
/// # Errors
/// A record is not as it should be, or a study is stopped.
pub fn analyse(context: &mut Context) -> Result<(String, Vec<Range>), Failure> {
    let rigid = on_rigid_wall(context)?[0].mean;
    let case = DENSITY.first_case()?;
    let (sand, barrier) = (&case.materials["sand"], &case.materials["barrier"]);
    let of_sand = impedance(sand.young_pa, sand.poisson, sand.density_kg_per_m3);
    let (young_of_one, height) = (young_of_one(&case), height(&case));
    let mut text = String::from(
        "stiffness_1,density_kg_per_m3,peak_20ms_n,peak_step_n,over_rigid_1,impedance_over_rigid_1,velocity_over_front_1,\
         impedance_velocity_1,deflection_at_peak_1,tip_max_1\n",
    );
    let mut ranges: Vec<Range> = Vec::new();
    for (n, run) in DENSITY.by_stiffness(context)? {
        let density: f64 = run.set["density_kg_per_m3"].parse().unwrap_or(f64::NAN);
        let of_barrier = impedance(n * young_of_one, barrier.poisson, density);
        let share = of_barrier / (of_barrier + of_sand);
        let [_, front] = super::rigidity::front(&run);
        let over = run.get("peak_20ms_n") / rigid;
        let numbers = [
            density,
            run.get("peak_20ms_n"),
            run.get("peak_step_n"),
            over,
            share,
            run.get("peak_barrier_velocity_m_per_s") / front[0],
            1.0 - share,
            run.get("peak_deflection_m") / height,
            run.get("tip_max_m") / height,
        ];
        let stiffness = run.set["stiffness_1"].clone();
        text += &format!("{stiffness},{}\n", numbers.map(number).join(","));
        match ranges.iter_mut().find(|r| r.stiffness == stiffness) {
            Some(range) => (range.ends[1], range.impedances[1]) = ((density, over), share),
            None => ranges.push(Range { stiffness, ends: [(density, over); 2], impedances: [share; 2] }),
        }
    }
    Ok((text, ranges))
}

fn run(context: &mut Context) -> Result<Outcome, Failure> {
    let (text, ranges) = analyse(context)?;
    let mut outcome = Outcome::default();
    outcome.tables.push(("barrier_density_shares".into(), text));
    let repeated = SCATTER.rows(context)?;
    for r in &ranges {
        let [light, heavy] = r.ends;
        let peaks = peaks(repeated.iter().filter(|s| s.set["stiffness_1"] == r.stiffness));
        // Two standard deviations of the ratio of two single runs.
        let chance = 2.0 * 2f64.sqrt() * peaks.deviation / peaks.mean;
        // Where waves return sooner than the force grows, the barrier is no half-space; what it does then is in the table.
        let soft = ranges[0].stiffness == r.stiffness;
        if !soft {
            continue;
        }
        outcome.checks.push(
            Check::new(
                format!("n = {}: force at {} over that at {} kg/m3", r.stiffness, heavy.0, light.0),
                heavy.1 / light.1,
                Expected::AtLeast(1.0 + chance),
                "1",
            )
            .because(
                "were rigidity all, the ratio would be one; two single runs differ by chance, two standard deviations",
            )
            .from(Kind::Analytic, "impedances of the first contact (Saint-Venant 1867)"),
        );
    }
    Ok(outcome)
}

const SHARES: Curves = Curves {
    x: "density_kg_per_m3",
    x_title: "density of the barrier (kg/m\u{b3})",
    y_title: "share",
    curves: &[
        Curve { column: "over_rigid_1", label: "force over that of a rigid wall", exact: false },
        Curve { column: "velocity_over_front_1", label: "barrier's velocity over the front's", exact: false },
        Curve { column: "impedance_over_rigid_1", label: "impedances: force", exact: true },
        Curve { column: "impedance_velocity_1", label: "impedances: velocity", exact: true },
    ],
    panels: &[
        panel("n = 2.5e-6", &[("stiffness_1", "2.5e-6")]),
        panel("n = 1e-5", &[("stiffness_1", "1e-5")]),
        panel("n = 1e-4", &[("stiffness_1", "0.0001")]),
    ],
    ..Curves::LOGARITHMIC
};

fn draw(folder: &Path) -> Result<Vec<String>, PlotError> {
    let name = "barrier_density_plot.svg";
    curves::draw(folder.join("barrier_density_shares.csv"), &SHARES, folder.join(name))?;
    Ok(vec![name.into()])
}
