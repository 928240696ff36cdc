//! The flume of Ng et al. from its case files: what must hold whatever the paper says (conservation, equilibrium, bounds), and
//! beside it, ungated, what the paper printed.
//!
//! The comparison is kept in `reports/validation`; it is judged after the physics. To accept a change that is meant, run with
//! `INSTA_UPDATE=always`.

use checkdam::check::{Check, Expected, Kind, Tolerance, Verdict};
use checkdam::run::files::run_into;
use checkdam::run::{Experiment, Records, Summary};
use checkdam::theory::sliding_block::acceleration_from_rest;
use checkdam::validation::data;
use std::path::{Path, PathBuf};

/// A flume case, run as the command runs it, with its folder.
struct Flume {
    name: &'static str,
    experiment: Experiment,
    records: Records,
    summary: Summary,
    folder: tempfile::TempDir,
}

fn flume(name: &'static str) -> Flume {
    let path = root().join("validation/flume").join(name).with_extension("toml");
    let case = checkdam::case::load(&path).unwrap_or_else(|e| panic!("{e}")).case;
    let folder = tempfile::tempdir().expect("a temporary folder");
    let run = rayon::scope(|_| run_into(&case, folder.path(), &mut |_| true));
    let (experiment, records, summary) = run.unwrap_or_else(|e| panic!("{name}: {e}"));
    Flume { name, experiment, records, summary, folder }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).to_path_buf()
}

/// What any run of the flume must satisfy.
fn physics(flume: &Flume) -> Vec<Check> {
    let Flume { experiment, records, summary, .. } = flume;
    let case = &summary.case;
    let barrier = summary.barrier.as_ref().expect("a barrier gauge");
    let deposit = summary.deposit.as_ref().expect("a base gauge");
    let exact = |what: &str, measured: f64, bound: f64, reason: &str| {
        Check::at_most(what, measured, bound, "1").because(reason).from(Kind::Conservation, "balance of the ledger")
    };
    let mut checks = vec![
        exact(
            "momentum residual / sum of impulses",
            summary.momentum.closure_max,
            1e-10,
            "every impulse is booked where it acts: only round-off over 25,000 steps remains",
        ),
        exact(
            "energy residual / E0, largest",
            summary.energy.residual_max,
            0.02,
            "second-order terms of the transfers are booked nowhere; 2 % is the share at which forces would begin to suffer",
        ),
        exact(
            "|mass in the domain + mass that left - mass released| / mass",
            (experiment.simulation().stock().mass + summary.momentum.outflow_kg - summary.stepping.mass_kg).abs()
                / summary.stepping.mass_kg,
            1e-12,
            "a grain may be thrown over the barrier, but it is counted; round-off of 4000 summands",
        ),
        exact(
            "deepest penetration / cell size",
            summary.momentum.penetration_max_m / case.grid.spacing_m,
            1.0,
            "a wall acts on its nodes; a point within one cell behind them is still pushed back",
        ),
    ];

    // Samples are means over their intervals, so they must add up to the impulse in the momentum ledger.
    let last = records.momentum.last().expect("a ledger");
    let gauge = experiment.barrier().expect("a gauge").boundary();
    let boundary = &experiment.simulation().boundaries()[gauge];
    let [px, py] = last.ledger.boundaries[gauge].impulse;
    let ledger = boundary.normal.x * px + boundary.normal.y * py;
    let mut before = 0.0;
    let mut sampled = 0.0;
    for row in records.history.iter().filter(|r| r.time <= last.time) {
        sampled += row.normal * (row.time - before);
        before = row.time;
    }
    checks.push(
        Check::value("impulse of the sampled force", sampled, ledger, "N s")
            .within(Tolerance::Relative(1e-9), "the same sums in another order")
            .from(Kind::Conservation, "impulse of the barrier in the momentum ledger"),
    );

    let weight = deposit.weight_along_flume_n;
    checks.push(
        Check::at_most(
            "|weight + base friction - other walls| / weight",
            deposit.equilibrium_residual_n.abs() / weight,
            0.01,
            "1",
        )
        .because("at rest, with less than 1e-4 of the energy kinetic; means over 0.3 s")
        .from(Kind::Conservation, "equilibrium along the flume"),
    );
    let [low, high] = deposit.friction_limits_n;
    checks.push(
        Check::new("static force", barrier.static_force_n, Expected::Within(low, high), "N")
            .because("Coulomb's law bounds the base friction by mu N either way")
            .from(Kind::Analytic, "limit equilibrium, m g sin -/+ mu N"),
    );

    // A front cannot be slower than a block from rest at the gate: pressure from behind only adds.
    let angle = case.gravity.inclination_deg.to_radians();
    let (g, mu) = (case.gravity.magnitude_m_per_s2, 0.4);
    for passage in summary.front.iter().take(case.gauges.stations_m.len()) {
        let block = (2.0 * acceleration_from_rest(g, angle, mu) * passage.x_m).sqrt();
        checks.push(
            Check::new(
                format!("front velocity at {} m", passage.x_m),
                passage.velocity_m_per_s,
                Expected::Within(block, (2.0 * g * (passage.x_m * angle.sin() + 0.5 * angle.cos())).sqrt()),
                "m/s",
            )
            .because("faster than a frictional block, slower than free fall from the top of the container")
            .from(Kind::Analytic, "energy of a block with and without friction"),
        );
    }
    checks
}

fn judge(name: &str, checks: Vec<Check>) {
    let verdict = Verdict { name: name.into(), checks, artefacts: vec!["validation/flume_against_paper.csv".into()] };
    println!("{verdict}");
    assert!(verdict.passes(), "{verdict}");
}

/// Our value of a published quantity, where we have it.
fn ours(quantity: &str, summary: &Summary) -> Option<f64> {
    let barrier = summary.barrier.as_ref().expect("a barrier gauge");
    let deposit = summary.deposit.as_ref().expect("a base gauge");
    let at_window = summary.front.iter().find(|f| f.x_m == 0.7).expect("a station at 0.7 m");
    Some(match quantity {
        "front velocity before impact" => at_window.velocity_m_per_s,
        "Froude number before impact" => at_window.froude,
        "flow depth before impact" => at_window.depth_m,
        "largest over static force" => barrier.peak_force_20ms_n / barrier.static_force_n,
        "static force" => barrier.static_force_n,
        // The experiment's largest force stands beside the largest mean over 20 ms.
        "largest measured force" => barrier.peak_force_20ms_n,
        "time to static force" => summary.stepping.end_time_s - 0.3,
        "theoretical static force" => deposit.theoretical_static_force_n,
        "share of the initial energy dissipated" => 1.0 - summary.energy.gravitational,
        "time from impact to static force" => {
            summary.stepping.end_time_s - 0.3 - barrier.arrival_time_s.expect("an arrival")
        }
        _ => return None,
    })
}

/// The published numbers with ours beside them, as CSV.
fn against_paper(summaries: &[(&str, &Summary)]) -> String {
    let mut rows = String::from("case,quantity,unit,kind,published,checkdam,difference_percent\n");
    for r in data::rows(data::SOURCES[0]) {
        let Some((_, summary)) = summaries.iter().find(|(name, _)| *name == r.case) else { continue };
        let Some(value) = ours(&r.quantity, summary) else { continue };
        // Adding zero turns a rounded -0.0 into 0.0.
        let difference = (1000.0 * (value / r.value - 1.0)).round() / 10.0 + 0.0;
        let unit = if r.unit == "1" { "" } else { &r.unit };
        rows += &format!("{},{},{unit},{},{},{value:.4},{difference:.1}\n", r.case, r.quantity, r.kind, r.value);
    }
    rows
}

/// Compares a file with the one kept in `reports/validation`. The physics has been judged by now.
macro_rules! keep {
    ($name:expr, $bytes:expr) => {
        insta::with_settings!({ snapshot_path => root().join("reports/validation"), prepend_module_to_snapshot => false }, {
            insta::assert_binary_snapshot!($name, $bytes);
        });
    };
}

#[test]
fn flume_at_40_and_23_degrees() {
    let (steep, gentle) = rayon::join(|| flume("40deg"), || flume("23deg"));
    judge("flume at 40 degrees", physics(&steep));
    judge("flume at 23 degrees", physics(&gentle));

    let table = against_paper(&[("40deg", &steep.summary), ("23deg", &gentle.summary)]);
    println!("{table}");
    keep!("flume_against_paper.csv", table.into_bytes());
    for flume in [steep, gentle] {
        for figure in ["force_time", "energy_shares", "flow_snapshots", "pressure_profile"] {
            let file = flume.folder.path().join(figure).with_extension("svg");
            let bytes = std::fs::read(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
            let name = format!("flume_{}_{figure}.svg", flume.name);
            keep!(name.as_str(), bytes);
        }
    }
}
