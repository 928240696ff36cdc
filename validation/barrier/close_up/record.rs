//! Makes the record anew: runs the four barriers under both releases and writes down what the figures need.

use super::collect::Collector;
use super::releases::{BARRIERS, FIELDS, Look, RELEASES, look};
use super::seen::Seen;
use super::{lines, slip};
use crate::watch::{WordsFn, side_by_side, watched};
use crate::{Context, Failure};
use checkdam::run::{Experiment, files, scene};

/// Tables by file.
pub(super) type Tables = Vec<(String, String)>;

/// Runs the barriers side by side; the tables of each release.
pub(super) fn make(context: &mut Context) -> Result<Vec<Tables>, Failure> {
    let mut looks: Vec<(&str, Look)> = Vec::new();
    for release in &RELEASES {
        for barrier in BARRIERS {
            looks.push((release.name, look(release, barrier)?));
        }
    }
    // The stiff barriers take longest, and stand last in each release.
    let seen = side_by_side(&looks, context.progress, |(release, look), words| see(release, look, words))?;
    Ok(seen.chunks(BARRIERS.len()).map(tables).collect())
}

fn see(release: &str, look: &Look, words: &mut WordsFn) -> Result<Seen, Failure> {
    let (case, barrier, arrival) = (&look.case, look.barrier, look.arrival);
    let none = |name: &str| Failure::Record(format!("the case has no {name}"));
    let body = |name: &str| scene::index(case, name).ok_or_else(|| none(name));
    let (sand, structure) = (body("sand")?, body("barrier")?);
    let mut experiment = Experiment::new(case);
    let datum = experiment.datum();
    let mut collector =
        Collector::new(move |simulation| slip::Observer::new(simulation, sand, structure, arrival, datum));
    watched(&format!("{release}, {barrier}"), words, |p| experiment.run(&mut collector, p))?;
    let face = experiment.structure().map(|s| s.face().clone()).ok_or_else(|| none("barrier"))?;
    let observer = collector.slip.take().ok_or_else(|| none("release"))?;
    let (rows, thresholds) = observer.finish(experiment.simulation());
    Ok(Seen {
        barrier,
        arrival,
        rows,
        thresholds,
        peak: experiment.barriers().first().map_or_else(Vec::new, |b| b.peak_profile().points.clone()),
        face,
        thickness: case.grid.thickness_m,
        spacing: case.grid.spacing_m,
        outlines: files::outlines(experiment.simulation()),
        collector,
    })
}

/// The tables of one release.
fn tables(seen: &[Seen]) -> Tables {
    let all = |header: &str, rows: &dyn Fn(&Seen) -> String| {
        header.to_string() + "\n" + &seen.iter().map(rows).collect::<String>()
    };
    let mut tables: Tables = vec![
        ("pressure.csv".into(), all("barrier,time_s,pressure_kpa", &lines::pressure)),
        ("wave.csv".into(), all("barrier,time_s,distance_m,pressure_pa", &lines::wave)),
        (
            "at_peak.csv".into(),
            all("barrier,height_m,height_over_depth_1,deflection_percent,velocity_over_front_1", &lines::at_peak),
        ),
        ("at_rest.csv".into(), all("barrier,height_m,pressure_pa,run_up_m", &lines::at_rest)),
        ("energy.csv".into(), all("barrier,time_s,kinetic_1,dissipated_1,barrier_1,residual_1", &lines::energy)),
        ("slip.csv".into(), all(slip::shares::COLUMNS, &lines::by_place)),
        (
            "slip_thresholds.csv".into(),
            all("barrier,rest_over_front_1,cells,deposit_j,slip_deposit_j,slip_flow_j,flow_j", &lines::by_threshold),
        ),
        ("geometry.csv".into(), lines::geometry(&seen[0])),
    ];
    for s in seen.iter().filter(|s| FIELDS.contains(&s.barrier)) {
        tables.push((format!("field_{}.csv", s.barrier), lines::field(s)));
        tables.push((format!("outline_{}.csv", s.barrier), lines::outline(s)));
        tables.push((format!("mechanisms_{}.csv", s.barrier), lines::mechanisms(s)));
    }
    tables
}
