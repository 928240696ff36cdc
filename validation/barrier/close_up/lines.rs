//! The lines of the record, from what was seen of a barrier.

use super::releases::{INSTANTS, WAVE_TIME};
use super::seen::Seen;
use super::slip;
use checkdam::check::significant;
use checkdam::gauge::structure::ProfilePoint;
use std::fmt::Write;

/// Length of the means at the end, s.
const LATE: f64 = 0.3;
/// Around the arrival, the pressure is shown from so long before it (every sample) until the second time (every sample) and the third
/// (every tenth), s.
const SHOWN: [f64; 3] = [0.034, 0.126, 0.9];
/// How far up the flow the wave is read, and how far behind where the face stood, m.
const WAVE_REACH: [f64; 2] = [0.3, 0.1];

/// A line of numbers, to six digits: figures need no more.
fn row(name: &str, values: &[f64]) -> String {
    let cells: Vec<String> =
        values.iter().map(|x| if x.is_finite() { significant(*x, 6) } else { String::new() }).collect();
    format!("{name},{}\n", cells.join(","))
}

/// Force over the area of the face.
pub(super) fn pressure(s: &Seen) -> String {
    let area = s.thickness * s.face.height();
    let [before, fast, slow] = SHOWN;
    let shown = s.collector.history.iter().enumerate().filter(|(k, r)| {
        let t = r.time - s.arrival.time;
        t > -before && t < slow && (t < fast || k % 10 == 0)
    });
    shown.map(|(_, r)| row(s.barrier, &[r.time, 1e-3 * r.normal / area])).collect()
}

/// Pressure up the flow from where the face stood at the start, in the row of cells at half the depth of the flow that arrives.
pub(super) fn wave(s: &Seen) -> String {
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

pub(super) fn at_peak(s: &Seen) -> String {
    let (velocity, depth) = front(s);
    let height = s.face.height();
    let values = |p: &ProfilePoint| [p.height, p.height / depth, 100.0 * p.deflection / height, p.velocity / velocity];
    s.peak.iter().map(|p| row(s.barrier, &values(p))).collect()
}

/// Mean pressure by height over the last 0.3 s, and the highest material at the barrier at the end.
pub(super) fn at_rest(s: &Seen) -> String {
    let profiles = &s.collector.profiles;
    let (Some(last), Some((_, bins))) = (s.collector.history.last(), profiles.last()) else { return String::new() };
    let late: Vec<_> = profiles.iter().filter(|(t, _)| *t > last.time - LATE).collect();
    let mean = |k: usize| late.iter().map(|(_, rows)| rows[k].1).sum::<f64>() / late.len() as f64;
    (0..bins.len()).map(|k| row(s.barrier, &[bins[k].0, mean(k), last.run_up])).collect()
}

/// Shares of the energy at release.
pub(super) fn energy(s: &Seen) -> String {
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
pub(super) fn by_place(s: &Seen) -> String {
    let line = |r: &slip::Row| {
        let (b, [base, on_barrier]) = (&r.balance, frictions(r));
        let ledger = [b.plastic, base, on_barrier, b.side_walls, b.contact.iter().sum(), b.pic];
        row(s.barrier, &[&[r.time], &r.work[..], &ledger, &[r.deposit]].concat())
    };
    s.rows.iter().map(line).collect()
}

/// Plastic work after the arrival by place, J, with other thresholds.
pub(super) fn by_threshold(s: &Seen) -> String {
    let line = |(t, work): (&slip::regions::Threshold, &[f64; 4])| {
        row(s.barrier, &[&[t.rest, t.cells as f64], &work[..]].concat())
    };
    slip::THRESHOLDS.iter().zip(&s.thresholds).map(line).collect()
}

/// Where the energy is, J.
pub(super) fn mechanisms(s: &Seen) -> String {
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

pub(super) fn field(s: &Seen) -> String {
    let mut text = String::from("time_s,x_m,y_m,pressure_pa,plastic_shear_strain\n");
    for (time, cells) in instants(s, &s.collector.fields) {
        for c in cells {
            let at = [*time, c.x[0], c.x[1]].map(|x| significant(x, 6)).join(",");
            _ = writeln!(text, "{at},{:.0},{:.2}", c.pressure, c.plastic_shear);
        }
    }
    text
}

pub(super) fn outline(s: &Seen) -> String {
    let mut text = String::from("time_s,x_m,y_m\n");
    for (time, points) in instants(s, &s.collector.outlines) {
        let time = significant(*time, 6);
        points.iter().for_each(|x| _ = writeln!(text, "{time},{:.4},{:.4}", x[0], x[1]));
    }
    text
}

pub(super) fn geometry(s: &Seen) -> String {
    let mut text = String::from("boundary,x_m,y_m\n");
    for (index, corners) in &s.outlines {
        corners.iter().for_each(|c| _ = writeln!(text, "{index},{:.4},{:.4}", c[0], c[1]));
    }
    text
}
