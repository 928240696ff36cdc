//! Closed forms of what is free or is set free: blocks in flight, blocks behind gates that lift.

use super::judge::{Judge, within};
use super::motion::{centre, frames, sum};
use super::rows::pick;
use super::setting::{Point, Setting, at};
use crate::from_file::Files;

pub fn flight(set: &Setting, files: &Files, judge: &mut Judge) {
    let g = set.g();
    let frames = frames(set, files);
    let start = frames.first().map(|f| f.1.clone()).unwrap_or_default();
    for (k, body) in set.bodies.iter().enumerate() {
        let own: Vec<&Point> = start.iter().filter(|p| p.body == k).collect();
        // A lattice of n points on a length L: mean square L^2 (1 - 1/n^2) / 12 about its middle.
        let square = |length: f64| (length * length - (set.h * set.h / body.per_cell)) / 12.0;
        let [along, across] = body.size().map(square);
        let (c, s) = (libm::cos(body.rotation), libm::sin(body.rotation));
        let half = body.size().map(|l| 0.5 * l);
        let middle = [body.x[0] + c * half[0] - s * half[1], body.y[0] + s * half[0] + c * half[1]];
        let centred = centre(&start, k).0;
        let moment = |i: usize, j: usize| {
            own.iter().map(|p| (p.x[i] - centred[i]) * (p.x[j] - centred[j])).sum::<f64>() / own.len() as f64
        };
        let drawn = [c * c * along + s * s * across, s * s * along + c * c * across, c * s * (along - across)];
        let share = at(&set.case, &format!("bodies.{k}.jitter")).unwrap_or(0.0);
        if share == 0.0 {
            let found = [moment(0, 0), moment(1, 1), moment(0, 1)];
            let what = "flight: second moments of a body at release";
            judge.same(what, &found, &drawn, within(1e-9, "round-off", "a lattice that fills the drawing"));
            judge.same(
                "flight: middle of a body at release",
                &centred,
                &middle,
                within(1e-9, "round-off", "the drawing"),
            );
        } else {
            // Column by column, from the lower left corner.
            let spacing = set.h / body.per_cell.sqrt();
            let rows = (body.size()[1] / spacing).round() as usize;
            let place = |n: usize| [(n / rows) as f64, (n % rows) as f64];
            let moved = own
                .iter()
                .enumerate()
                .flat_map(|(n, p)| [0, 1].map(|d| (p.x[d] - [body.x[0], body.y[0]][d]) / spacing - place(n)[d] - 0.5));
            judge.closed(
                "flight: farthest that a point was moved from its lattice",
                moved.map(f64::abs).fold(0.0, f64::max),
                share * (1.0 - 1.0 / (2.0 * own.len() as f64 + 1.0)),
                "1",
                within(
                    0.02,
                    "the largest of 144 uniform draws lies 0.7 +- 0.7 % below the largest there can be",
                    "order statistics",
                ),
            );
        }
        for (t, points) in frames.iter().filter(|f| f.0 > 0.0 && f.1.len() == start.len()) {
            let (x, v) = centre(points, k);
            let fallen = [0, 1].map(|d| centred[d] + body.v[d] * t + 0.5 * g[d] * t * t);
            judge.same(
                "flight: place",
                &x,
                &fallen,
                within(2e-3, "a step of half a millisecond is a thousandth of the way", "Galilei 1638"),
            );
            judge.same(
                "flight: velocity",
                &v,
                &[0, 1].map(|d| body.v[d] + g[d] * t),
                within(1e-6, "gravity is uniform, and nothing else acts", "Galilei 1638"),
            );
        }
    }
    let mass = |k: usize| set.bodies[k].density * set.bodies[k].area() * set.width;
    for (key, name, made) in
        [("barrier", "screen", [mass(0), mass(1)]), ("further_barriers.0.barrier", "second screen", [mass(0), mass(1)])]
    {
        let found = ["overtopped_kg", "passed_under_kg", "passed_kg"].map(|c| files.number(&format!("{key}.{c}")));
        judge.same(
            &format!("flight: what passed the {name}, over, under and in all"),
            &found,
            &[made[0], made[1], set.mass()],
            within(1e-9, "all points on one way", "the drawing"),
        );
    }
    judge.closed(
        "flight: momentum.outflow_kg",
        files.number("momentum.outflow_kg"),
        set.mass(),
        "kg",
        within(1e-9, "all of it", "conservation of mass"),
    );
    // Speeds at the edge of the domain from the height of fall along x.
    let edge = at(&set.case, "domain.x_m.0").unwrap_or(f64::NAN);
    let leaving = |p: &Point| -(p.v[0] * p.v[0] + 2.0 * g[0] * (edge - p.x[0])).sqrt();
    let gone = files.column("momentum.csv", "outflow_x_n_s").last().copied().unwrap_or(f64::NAN);
    judge.closed(
        "flight: momentum.csv outflow_x_n_s",
        gone,
        -sum(&start, |p| p.mass * leaving(p)),
        "N s",
        within(2e-3, "what left is seen when points are sorted anew, at most half a cell later", "Galilei 1638"),
    );
    let rise = |p: &Point| {
        let t = (leaving(p) - p.v[0]) / g[0];
        p.mass * (p.v[1] + g[1] * t)
    };
    let gone = files.column("momentum.csv", "outflow_y_n_s").last().copied().unwrap_or(f64::NAN);
    let scale = set.mass() * set.gravity * set.h / set.bodies[1].v[0].abs();
    judge.near(
        "flight: momentum.csv outflow_y_n_s",
        &[gone],
        &[-sum(&start, rise)],
        scale,
        within(0.5, "what left is seen when points are sorted anew, at most half a cell later", "Galilei 1638"),
    );
    let energy = |c: &str| files.column("energy.csv", c);
    let first = pick(&energy("kinetic_j"), 0) + pick(&energy("gravitational_j"), 0);
    judge.closed(
        "flight: energy.csv outflow_j",
        energy("outflow_j").last().copied().unwrap_or(f64::NAN),
        first,
        "J",
        within(2e-3, "what PIC takes while points leave", "conservation of energy"),
    );
}

pub fn gate(set: &Setting, files: &Files, judge: &mut Judge) {
    let [gx, _] = set.g();
    let mut opened = Vec::new();
    let start = set.points(files, 0);
    for (k, (body, file)) in set.bodies.iter().zip(["history.csv", "history_second.csv"]).enumerate() {
        let (time, force) = (files.column(file, "time_s"), files.column(file, "force_normal_n"));
        let push = body.density * body.area() * set.width * gx;
        let early: Vec<f64> = time.iter().zip(&force).filter(|(t, _)| **t < 0.08).map(|(_, f)| *f).collect();
        let mean = early.iter().sum::<f64>() / early.len() as f64;
        judge.closed(
            &format!("gate: force on gate {k} while it lifts"),
            mean,
            push,
            "N",
            within(0.1,
            "a gate that moves is held at nodes, half a cell from where its surface was: the block swings by a sixth",
            "equilibrium: m g sin after tilting"),
        );
        let gate = set.boundaries[k + 1].foot[0];
        let own: Vec<Point> = start.iter().filter(|p| p.body == k).copied().collect();
        judge.closed(
            &format!("gate: volume integral of stress xx of block {k} at release"),
            sum(&own, |p| p.stress[0] * p.volume),
            sum(&own, |p| p.mass * gx * (p.x[0] - gate)),
            "J",
            within(
                5e-3,
                "settled to 1e-4 of a free fall; exact for linear velocities",
                "equilibrium after tilting: the volume integral of stress is the moment of the forces (Clausius 1870)",
            ),
        );
        // The force swings about its mean while it is held.
        opened.push(time.iter().zip(&force).rfind(|(_, f)| **f > 0.5 * push).map_or(f64::NAN, |(t, _)| *t));
    }
    let speed = at(&set.case, "boundaries.1.lift_speed_m_per_s").unwrap_or(f64::NAN);
    let taller = set.bodies[1].size()[1] - set.bodies[0].size()[1];
    judge.closed(
        "gate: a taller block is free later",
        opened[1] - opened[0],
        taller / speed,
        "s",
        within(
            0.02,
            "both tops lie on rows of nodes, so that edges are off by the same; a row has 2 ms of 200",
            "height over the speed of lifting",
        ),
    );
    // Afterwards nothing holds it.
    let late: Vec<_> = frames(set, files).into_iter().filter(|f| f.0 > 0.25).collect();
    if let [first, .., last] = &late[..] {
        let gained = centre(&last.1, 0).1[0] - centre(&first.1, 0).1[0];
        judge.closed(
            "gate: acceleration of the free block",
            gained / (last.0 - first.0),
            gx,
            "m/s2",
            within(0.005, "a smooth base", "g sin"),
        );
    }
    let interval = files.column("history.csv", "time_s");
    let mean = (interval.last().copied().unwrap_or(f64::NAN) - interval[0]) / (interval.len() as f64 - 1.0);
    let rate = at(&set.case, "gauges.sample_rate_hz").unwrap_or(f64::NAN);
    judge.closed(
        "gate: rows a second",
        1.0 / mean,
        rate,
        "1/s",
        within(0.005, "a row ends with a step", "the case file"),
    );
    let tilt = at(&set.case, "stages.tilt.duration_s").unwrap_or(f64::NAN);
    let rest = files.number("stepping.settle_time_s") - tilt;
    let period = 4.0 * set.bodies[1].size()[1] / set.bodies[1].wave_speed();
    judge.check(
        checkdam::check::Check::new(
            "gate: time of settling, before and after tilting",
            rest,
            checkdam::check::Expected::Within(2.0 * period, 6.0 * period),
            "s",
        )
        .because("each takes a period at least, and damped as it is no more than three")
        .from(checkdam::check::Kind::Analytic, "an overdamped bar"),
    );
}
