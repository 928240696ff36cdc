//! Makes the record anew: runs the four barriers under both releases and writes down what the figures need.

use super::collect::Collector;
use super::releases::{Arrival, BARRIERS, FIELDS, INSTANTS, Look, RELEASES, WAVE_TIME, look};
use super::slip;
use crate::boundary::Boundary;
use crate::check::significant;
use crate::gauge::structure::ProfilePoint;
use crate::run::{Experiment, files, scene};
use crate::validation::watch::{WordsFn, side_by_side, watched};
use crate::validation::{Context, Failure};
use std::fmt::Write;

/// Length of the means at the end, s.
const LATE: f64 = 0.3;
/// Around the arrival, the pressure is shown from so long before it (every sample) until the second time (every sample) and the third
/// (every tenth), s.
const SHOWN: [f64; 3] = [0.034, 0.126, 0.9];
/// How far up the flow the wave is read, and how far behind where the face stood, m.
const WAVE_REACH: [f64; 2] = [0.3, 0.1];

/// Tables by file.
pub(super) type Tables = Vec<(String, String)>;

/// What was seen of a barrier.
struct Seen {
    barrier: &'static str,
    arrival: Arrival,
    collector: Collector,
    rows: Vec<slip::Row>,
    /// Plastic work after the arrival by threshold and region, J.
    thresholds: [[f64; 4]; slip::THRESHOLDS.len()],
    peak: Vec<ProfilePoint>,
    face: Boundary,
    thickness: f64,
    spacing: f64,
    outlines: Vec<(usize, Vec<[f64; 2]>)>,
}

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
        peak: experiment.peak_profile().points.clone(),
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
        ("pressure.csv".into(), all("barrier,time_s,pressure_kpa", &pressure)),
        ("wave.csv".into(), all("barrier,time_s,distance_m,pressure_pa", &wave)),
        (
            "at_peak.csv".into(),
            all("barrier,height_m,height_over_depth_1,deflection_percent,velocity_over_front_1", &at_peak),
        ),
        ("at_rest.csv".into(), all("barrier,height_m,pressure_pa,run_up_m", &at_rest)),
        ("energy.csv".into(), all("barrier,time_s,kinetic_1,dissipated_1,barrier_1,residual_1", &energy)),
        ("slip.csv".into(), all(slip::shares::COLUMNS, &by_place)),
        (
            "slip_thresholds.csv".into(),
            all("barrier,rest_over_front_1,cells,deposit_j,slip_deposit_j,slip_flow_j,flow_j", &by_threshold),
        ),
        ("geometry.csv".into(), geometry(&seen[0])),
    ];
    for s in seen.iter().filter(|s| FIELDS.contains(&s.barrier)) {
        tables.push((format!("field_{}.csv", s.barrier), field(s)));
        tables.push((format!("outline_{}.csv", s.barrier), outline(s)));
        tables.push((format!("mechanisms_{}.csv", s.barrier), mechanisms(s)));
    }
    tables
}

/// A line of numbers, to six digits: figures need no more.
fn row(name: &str, values: &[f64]) -> String {
    let cells: Vec<String> =
        values.iter().map(|x| if x.is_finite() { significant(*x, 6) } else { String::new() }).collect();
    format!("{name},{}\n", cells.join(","))
}

/// Force over the area of the face.
fn pressure(s: &Seen) -> String {
    let area = s.thickness * s.face.height();
    let [before, fast, slow] = SHOWN;
    let shown = s.collector.history.iter().enumerate().filter(|(k, r)| {
        let t = r.time - s.arrival.time;
        t > -before && t < slow && (t < fast || k % 10 == 0)
    });
    shown.map(|(_, r)| row(s.barrier, &[r.time, 1e-3 * r.normal / area])).collect()
}

/// Pressure up the flow from where the face stood at the start, in the row of cells at half the depth of the flow that arrives.
fn wave(s: &Seen) -> String {
    let height = ((0.5 * s.arrival.depth / s.spacing).floor() + 0.5) * s.spacing;
    let foot = s.face.foot();
    // The face at this height.
    let at = foot.x + s.face.tangent.x / s.face.tangent.y * (height - foot.y);
    let end = s.arrival.time + WAVE_TIME + 1e-3;
    let mut text = String::new();
    for (time, cells) in s.collector.fields.iter().filter(|(t, _)| *t >= s.arrival.time && *t < end) {
        let own = cells.iter().filter(|c| (c.x[1] - height).abs() < 1e-6);
        for c in own.filter(|c| at - c.x[0] > -WAVE_REACH[1] && at - c.x[0] < WAVE_REACH[0]) {
            let time = significant(*time, 6);
            _ = writeln!(text, "{},{time},{:.4},{:.0}", s.barrier, at - c.x[0], c.pressure);
        }
    }
    text
}

/// Velocity and depth of the front just before the barrier is touched.
fn front(s: &Seen) -> (f64, f64) {
    let history = &s.collector.history;
    let arrival = history.iter().position(|r| r.normal > 0.5).unwrap_or(1).max(1);
    let front = history[arrival - 1].front;
    (front.velocity, front.depth)
}

fn at_peak(s: &Seen) -> String {
    let (velocity, depth) = front(s);
    let height = s.face.height();
    let values = |p: &ProfilePoint| [p.height, p.height / depth, 100.0 * p.deflection / height, p.velocity / velocity];
    s.peak.iter().map(|p| row(s.barrier, &values(p))).collect()
}

/// Mean pressure by height over the last 0.3 s, and the highest material at the barrier at the end.
fn at_rest(s: &Seen) -> String {
    let profiles = &s.collector.profiles;
    let (Some(last), Some((_, bins))) = (s.collector.history.last(), profiles.last()) else { return String::new() };
    let late: Vec<_> = profiles.iter().filter(|(t, _)| *t > last.time - LATE).collect();
    let mean = |k: usize| late.iter().map(|(_, rows)| rows[k].1).sum::<f64>() / late.len() as f64;
    (0..bins.len()).map(|k| row(s.barrier, &[bins[k].0, mean(k), last.run_up])).collect()
}

/// Shares of the energy at release.
fn energy(s: &Seen) -> String {
    let line = |r: &slip::Row| {
        let b = &r.balance;
        let dissipated = b.initial - b.kinetic - b.gravitational - b.elastic;
        let held = r.barrier.kinetic + r.barrier.elastic;
        let shares = [b.kinetic, dissipated, held, b.residual].map(|e| e / b.initial);
        row(s.barrier, &[&[r.time], &shares[..]].concat())
    };
    s.rows.iter().map(line).collect()
}

/// What friction took on boundaries, of which only the base is rough, and on the barrier, J.
fn frictions(r: &slip::Row) -> [f64; 2] {
    let on_barrier = r.balance.friction.last().copied().unwrap_or(0.0);
    [r.balance.friction.iter().sum::<f64>() - on_barrier, on_barrier]
}

/// Dissipation since the release by place, J.
fn by_place(s: &Seen) -> String {
    let line = |r: &slip::Row| {
        let (b, [base, on_barrier]) = (&r.balance, frictions(r));
        let ledger = [b.plastic, base, on_barrier, b.side_walls, b.contact.iter().sum(), b.pic];
        row(s.barrier, &[&[r.time], &r.work[..], &ledger, &[r.deposit]].concat())
    };
    s.rows.iter().map(line).collect()
}

/// Plastic work after the arrival by place, J, with other thresholds.
fn by_threshold(s: &Seen) -> String {
    let line = |(t, work): (&slip::regions::Threshold, &[f64; 4])| {
        row(s.barrier, &[&[t.rest, t.cells as f64], &work[..]].concat())
    };
    slip::THRESHOLDS.iter().zip(&s.thresholds).map(line).collect()
}

/// Where the energy is, J.
fn mechanisms(s: &Seen) -> String {
    let mut text = String::from(
        "time_s,kinetic_j,gravitational_j,elastic_j,plastic_j,friction_base_j,friction_barrier_j,side_walls_j,contact_all_j,\
         pic_j,residual_j\n",
    );
    for r in &s.rows {
        let (b, [base, on_barrier]) = (&r.balance, frictions(r));
        let contact = b.contact.iter().sum();
        let stored = [b.kinetic, b.gravitational, b.elastic];
        let spent = [b.plastic, base, on_barrier, b.side_walls, contact, b.pic, b.residual];
        let cells: Vec<String> = stored.iter().chain(&spent).map(|j| format!("{j:.3}")).collect();
        _ = writeln!(text, "{},{}", significant(r.time, 6), cells.join(","));
    }
    text
}

/// The instants that are drawn, the last of them the end.
fn instants<'a, T>(s: &Seen, all: &'a [(f64, T)]) -> Vec<&'a (f64, T)> {
    let mut found: Vec<_> =
        INSTANTS.iter().filter_map(|t| all.iter().find(|(time, _)| *time >= s.arrival.time + t)).collect();
    found.extend(all.last());
    found
}

fn field(s: &Seen) -> String {
    let mut text = String::from("time_s,x_m,y_m,pressure_pa,plastic_shear_strain\n");
    for (time, cells) in instants(s, &s.collector.fields) {
        for c in cells {
            let at = [*time, c.x[0], c.x[1]].map(|x| significant(x, 6)).join(",");
            _ = writeln!(text, "{at},{:.0},{:.2}", c.pressure, c.plastic_shear);
        }
    }
    text
}

fn outline(s: &Seen) -> String {
    let mut text = String::from("time_s,x_m,y_m\n");
    for (time, points) in instants(s, &s.collector.outlines) {
        let time = significant(*time, 6);
        points.iter().for_each(|x| _ = writeln!(text, "{time},{:.4},{:.4}", x[0], x[1]));
    }
    text
}

fn geometry(s: &Seen) -> String {
    let mut text = String::from("boundary,x_m,y_m\n");
    for (index, corners) in &s.outlines {
        corners.iter().for_each(|c| _ = writeln!(text, "{index},{:.4},{:.4}", c[0], c[1]));
    }
    text
}
