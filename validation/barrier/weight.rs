//! Does it matter that gravity is off on the barrier? The same barriers with and without their own weight.
//!
//! An upright cantilever that carries its own weight is softer against what bends it slowly by 1 - rho/rho_c, where
//! rho_c is the density at which it would buckle (Greenhill 1881). What happens within milliseconds does not see that, so that
//! what is found lies between no change and that of a barrier so much softer under a slow load.

use super::records::{LITERAL, WEIGHT, barrier, height, young_of_one};
use crate::balances::Balances;
use crate::runs::Run;
use crate::scatter::Scatter;
use crate::{Context, Failure, Validation};
use checkdam::check::{Check, Expected, Kind};
use checkdam::plot::PlotError;
use checkdam::plot::curves::{self, Curve, Curves};
use checkdam::theory::barrier::buckling_density;
use checkdam_verification::Outcome;
use checkdam_verification::report::number;
use std::path::Path;

/// The analysis of the recorded runs.
pub const VALIDATION: Validation = Validation {
    name: "barrier_weight",
    title: "Barriers with and without their own weight",
    study: "40 runs, about 5 minutes",
    run,
    draw,
    covers: &[],
};

/// Share of the stiffness that a weight leaves from which on down its effect on the deflection must be seen.
const FELT: f64 = 0.7;
const DEFLECTION: &str = "largest deflection";
/// What is compared, with name and unit of its columns and in words.
const QUANTITIES: [(&str, &str, &str, &str); 2] =
    [("peak_20ms_n", "peak", "n", "force over 20 ms"), ("tip_max_m", "tip", "m", DEFLECTION)];

/// With weight over without, run by run on the same grid and with the same packing.
fn ratios(light: &[&Run], heavy: &[&Run], quantity: &str) -> Result<Scatter, Failure> {
    let ratio = |l: &&Run| {
        let same = heavy.iter().find(|h| h.replicate == l.replicate);
        let same =
            same.ok_or_else(|| Failure::Record(format!("no run with weight like replicate `{}`", l.replicate)))?;
        Ok::<f64, Failure>(same.get(quantity) / l.get(quantity))
    };
    Ok(Scatter::of(light.iter().map(ratio).collect::<Result<Vec<_>, _>>()?))
}

fn run(context: &mut Context) -> Result<Outcome, Failure> {
    let mut outcome = Outcome::default();
    let runs = WEIGHT.by_stiffness(context)?;
    let mut stiffnesses: Vec<(f64, String)> = runs.iter().map(|(n, r)| (*n, r.set["stiffness_1"].clone())).collect();
    stiffnesses.sort_by(|a, b| a.0.total_cmp(&b.0));
    stiffnesses.dedup();
    let mut header = String::from("log10_stiffness_1,stiffness_1,density_kg_per_m3,softer_by_1");
    for (_, name, unit, _) in QUANTITIES {
        header += &format!(",{name}_weightless_{unit},{name}_heavy_{unit},{name}_ratio_1,{name}_ratio_error_1");
    }
    let mut text = header + ",pairs\n";
    for (n, cell) in stiffnesses {
        let of = |weightless: &str| -> Vec<&Run> {
            runs.iter().filter(|(m, r)| *m == n && r.set["weightless"] == weightless).map(|(_, r)| r).collect()
        };
        let (light, heavy) = (of("true"), of("false"));
        let case = WEIGHT.planned(LITERAL, &cell)?.case;
        let density = case.materials["barrier"].density_kg_per_m3;
        let depth = barrier(&case).map_or(f64::NAN, |b| b.size_m()[0]);
        let section = depth * case.grid.thickness_m;
        let rigidity = n * young_of_one(&case) * section * depth * depth / 12.0;
        let critical = buckling_density(rigidity, height(&case), section, case.gravity.magnitude_m_per_s2);
        let softer = 1.0 - density / critical;
        let mut numbers = vec![libm::log10(n), n, density, softer];
        let mut pairs = 0;
        for (quantity, _, _, what) in QUANTITIES {
            let mean = |runs: &[&Run]| Scatter::of(runs.iter().map(|r| r.get(quantity))).mean;
            let ratio = ratios(&light, &heavy, quantity)?;
            let chance = 2.0 * ratio.standard_error();
            pairs = ratio.count;
            numbers.extend([mean(&light), mean(&heavy), ratio.mean, ratio.standard_error()]);
            // A force can fall by no more than the stiffness, a deflection grow by no more than one over it.
            let slow = if what == DEFLECTION { 1.0 / softer } else { softer };
            outcome.checks.push(
                Check::new(
                    format!("n = {cell}: {what} with weight over that without"),
                    ratio.mean,
                    Expected::Within(slow.min(1.0) - chance, slow.max(1.0) + chance),
                    "1",
                )
                .because(format!(
                    "from no change, as of a blow, to that of the stiffness, as of a slow load, and two standard errors of {pairs} pairs"
                ))
                .from(Kind::Analytic, "Greenhill 1881"),
            );
            if what == DEFLECTION && softer < FELT {
                outcome.checks.push(
                    Check::new(
                        format!("n = {cell}: {what} with weight over that without, so that it is felt"),
                        ratio.mean,
                        Expected::AtLeast(1.0 + chance),
                        "1",
                    )
                    .because(format!(
                        "the weight takes three tenths of the stiffness or more; two standard errors of {pairs} pairs"
                    ))
                    .from(Kind::Analytic, "Greenhill 1881"),
                );
            }
        }
        let cells = numbers.into_iter().map(number).collect::<Vec<_>>().join(",");
        text += &format!("{cells},{pairs}\n");
    }
    let cell = WEIGHT.first_case()?.grid.spacing_m;
    let balances = Balances::over(runs.iter().map(|(_, r)| r), |_| cell);
    outcome.checks.extend(balances.checks("", "ledgers and gauges of all runs"));
    outcome.tables.push(("barrier_weight_ratios".into(), text));
    Ok(outcome)
}

const RATIOS: Curves = Curves {
    x: "log10_stiffness_1",
    x_title: "power of ten of the normalised stiffness",
    y_title: "with weight over without",
    curves: &[
        Curve { column: "peak_ratio_1", label: "largest force over 20 ms", exact: false },
        Curve { column: "tip_ratio_1", label: "largest deflection of the tip", exact: false },
    ],
    ..Curves::LINEAR
};

fn draw(folder: &Path) -> Result<Vec<String>, PlotError> {
    let name = "barrier_weight_plot.svg";
    curves::draw(folder.join("barrier_weight_ratios.csv"), &RATIOS, folder.join(name))?;
    Ok(vec![name.into()])
}
