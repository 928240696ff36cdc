//! Closed forms of what slides: a block that strikes a wall, friction that needs slip.

use super::judge::{Judge, within};
use super::ledgers::row_at;
use super::rows::pick;
use super::setting::{Point, Setting, at};
use crate::from_file::{Files, count};

const COULOMB: &str = "Coulomb 1785";

pub fn sum(points: &[Point], of: impl Fn(&Point) -> f64) -> f64 {
    points.iter().map(of).sum()
}

/// Frames with their times and their points.
pub fn frames(set: &Setting, files: &Files) -> Vec<(f64, Vec<Point>)> {
    (0..files.frames()).map(|k| (files.array(k, "TimeValue")[0], set.points(files, k))).collect()
}

/// Mean place and velocity of a body.
pub fn centre(points: &[Point], body: usize) -> ([f64; 2], [f64; 2]) {
    let own: Vec<&Point> = points.iter().filter(|p| p.body == body).collect();
    let n = own.len() as f64;
    let mean = |of: &dyn Fn(&Point) -> f64| own.iter().map(|p| of(p)).sum::<f64>() / n;
    ([mean(&|p| p.x[0]), mean(&|p| p.x[1])], [mean(&|p| p.v[0]), mean(&|p| p.v[1])])
}

pub fn slide(set: &Setting, files: &Files, judge: &mut Judge) {
    let column = |name: &str| files.column("history.csv", name);
    let [time, normal, friction, edge, force, tangential] =
        ["time_s", "base_normal_n", "base_friction_n", "front_edge_x_m", "force_normal_n", "force_tangential_n"]
            .map(column);
    let rows: Vec<usize> = (0..time.len()).filter(|k| (0.1..0.5).contains(&time[*k])).collect();
    let mean = |values: &[f64]| rows.iter().map(|k| pick(values, *k)).sum::<f64>() / rows.len() as f64;
    let [gx, gy] = set.g();
    let m = set.mass();
    let mu = set.boundary("base").map_or(f64::NAN, |b| b.friction);
    judge.closed(
        "slide: base_normal_n on the way",
        mean(&normal),
        -m * gy,
        "N",
        within(1e-2, "the block still bounces by a hundredth", "Newton's second law: m g cos"),
    );
    judge.closed(
        "slide: base_friction_n over base_normal_n",
        mean(&friction) / mean(&normal),
        -mu,
        "1",
        within(1e-5, "every part of the base slides the same way", COULOMB),
    );
    // Side walls press with the stress out of the plane.
    let wall = at(&set.case, "side_walls.friction").unwrap_or(f64::NAN);
    let drag = |points: &[Point]| 2.0 * wall / set.width * sum(points, |p| (-p.stress[2]).max(0.0) * p.volume);
    let frames: Vec<_> = frames(set, files).into_iter().filter(|f| (0.149..0.501).contains(&f.0)).collect();
    let rubbed: f64 = frames.windows(2).map(|f| 0.5 * (drag(&f[0].1) + drag(&f[1].1)) * (f[1].0 - f[0].0)).sum();
    let ledger = files.column("momentum.csv", "time_s");
    let sides = files.column("momentum.csv", "side_walls_x_n_s");
    let taken = |t: f64| row_at(&ledger, t).map_or(f64::NAN, |k| pick(&sides, k));
    let (first, last) = (frames.first().map_or(f64::NAN, |f| f.0), frames.last().map_or(f64::NAN, |f| f.0));
    judge.closed(
        "slide: impulse of the side walls on the way",
        taken(first) - taken(last),
        rubbed,
        "N s",
        within(
            0.01,
            "eight frames stand for the steps between them, while the block bounces by a hundredth",
            "Coulomb: 2 mu / b over the volume's stress out of the plane",
        ),
    );
    // Elastic plane strain.
    let nu = set.bodies[0].poisson;
    let points: Vec<Point> = frames.last().map(|f| f.1.clone()).unwrap_or_default();
    let made = |of: &dyn Fn(&Point) -> f64| points.iter().map(of).collect::<Vec<_>>();
    judge.same(
        "slide: stress out of the plane",
        &made(&|p| p.stress[2]),
        &made(&|p| nu * (p.stress[0] + p.stress[1])),
        within(5e-3, "strains of 1e-3 and turns of the same size", "Hooke in plane strain"),
    );
    // The front goes as fast as it says.
    let speed = column("front_velocity_m_per_s");
    let went: f64 = rows.windows(2).map(|k| 0.5 * (speed[k[0]] + speed[k[1]]) * (time[k[1]] - time[k[0]])).sum();
    let way = pick(&edge, rows.last().copied().unwrap_or(0)) - pick(&edge, rows.first().copied().unwrap_or(0));
    judge.closed(
        "slide: way of the front's edge",
        way,
        went,
        "m",
        within(2e-3, "the block is not rigid: its edge swings by a thousandth of its way", "kinematics"),
    );
    let row = row_at(&time, last).unwrap_or(0);
    let v = set.bodies[0].v[0] + last * gx + (pick(&impulse(&time, &friction), row) + taken(last)) / m;
    judge.closed(
        "slide: front_velocity_m_per_s before the wall",
        pick(&speed, row),
        v,
        "m/s",
        within(
            5e-3,
            "the head swings against the rest by a few thousandths of its speed",
            "Newton's second law: gravity less friction of base and side walls",
        ),
    );
    // Friction works along the way, and the wall takes nothing before it is touched.
    let worked: f64 = rows.windows(2).map(|k| -friction[k[1]] * speed[k[1]] * (time[k[1]] - time[k[0]])).sum();
    let energy = files.column("energy.csv", "time_s");
    let lost = |name: &str, t: f64| row_at(&energy, t).map_or(f64::NAN, |k| pick(&files.column("energy.csv", name), k));
    let [begin, end] = [rows.first(), rows.last()].map(|k| k.map_or(f64::NAN, |k| time[*k]));
    let ends = |t: f64| energy.iter().rev().find(|e| **e <= t * (1.0 + 1e-8)).copied().unwrap_or(f64::NAN);
    let part = (ends(end) - ends(begin)) / (end - begin);
    judge.closed(
        "slide: energy.csv friction_base_j on the way",
        lost("friction_base_j", ends(end)) - lost("friction_base_j", ends(begin)),
        worked * part,
        "J",
        within(
            0.03,
            "the ledger has a row in ten, so that up to a fortieth of the way is reckoned by its share",
            "work of friction",
        ),
    );
    let wall: f64 = ["friction_wall_j", "contact_wall_j"].iter().map(|c| lost(c, ends(end)).abs()).sum();
    judge.at_most("slide: lost at the wall before it is touched", wall, 0.0, "nothing touches it");
    // It is felt within a cell of the wall, and does not pass it.
    let arrival = time.iter().position(|t| *t >= files.number("barrier.arrival_s") * (1.0 - 1e-8)).unwrap_or(0);
    let face = set.boundary("wall").map_or(f64::NAN, |b| b.foot[0]);
    let gap = (face - pick(&edge, arrival) - 0.25 * set.h) / set.h;
    judge.at_most(
        "slide: arrival before a cell from the wall, or behind its face",
        if gap.is_nan() { gap } else { (gap - 1.0).max(-gap).max(0.0) },
        0.0,
        "a grid feels a wall within a cell",
    );
    let held = set.boundary("wall").map_or(f64::NAN, |b| b.friction);
    let more: Vec<f64> =
        tangential.iter().zip(&force).map(|(t, n)| t.abs() - held * (0.5 * (n + n.abs())) * (1.0 + 1e-6)).collect();
    let slips = count(&more, |x| *x > 1e-9);
    judge.at_most("slide: rows whose force along the wall is more than its friction", slips, 0.0, "no more than mu N");
}

fn impulse(time: &[f64], force: &[f64]) -> Vec<f64> {
    let mut before = 0.0;
    let add = |sum: &mut f64, (t, f): (&f64, &f64)| {
        *sum += f * (t - before);
        before = *t;
        Some(*sum)
    };
    time.iter().zip(force).scan(0.0, add).collect()
}

pub fn slip(set: &Setting, files: &Files, judge: &mut Judge) {
    let [gx, gy] = set.g();
    let base = |key: &str| at(&set.case, &format!("boundaries.0.{key}")).unwrap_or(f64::NAN);
    let [kinetic, peak, length] = ["friction", "static_friction", "slip_length_m"].map(base);
    let frames = frames(set, files);
    // Of the row of points next to the base, above which the block shears.
    let floor = set.boundary("base").map_or(f64::NAN, |b| b.foot[1]);
    let foot = |points: &[Point]| {
        let low = points.iter().filter(|p| p.body == 0 && p.x[1] < floor + 0.5 * set.h);
        let low: Vec<Point> = low.copied().collect();
        let n = low.len() as f64;
        [sum(&low, |p| p.x[0]) / n, sum(&low, |p| p.v[0]) / n]
    };
    let start = frames.first().map_or(f64::NAN, |f| foot(&f.1)[0]);
    let mass = |k: usize| set.bodies[k].density * set.bodies[k].area() * set.width;
    let stiffness = peak / length * mass(0) * -gy;
    let time = files.column("history.csv", "time_s");
    let [friction, stored] = [files.column("history.csv", "base_friction_n"), files.column("energy.csv", "elastic_j")];
    let ledger = files.column("energy.csv", "time_s");
    let full = kinetic * mass(1) * -gy;
    let own = kinetic * length / peak;
    // Later than the first shear waves: place of the foot in the middle of a row and at its end, force of the row, energy.
    let late = frames.iter().filter(|f| f.0 > 0.1);
    let seen: Vec<[f64; 4]> = late
        .map(|(t, points)| {
            let [place, velocity] = foot(points);
            let row = row_at(&time, *t).unwrap_or(usize::MAX);
            let middle = place - 0.5 * velocity * (pick(&time, row) - pick(&time, row.wrapping_sub(1)));
            let elastic = row_at(&ledger, *t).map_or(f64::NAN, |k| pick(&stored, k)) - sum(points, |p| set.stored(p));
            // The block that slides has its own friction.
            [middle, place, pick(&friction, row) + full, elastic]
        })
        .collect();
    // What slipped before the block pressed is not elastic: one constant, within a hundredth of the swing.
    let zero = seen.iter().map(|[middle, _, force, _]| middle + force / stiffness).sum::<f64>() / seen.len() as f64;
    let early = (zero - start) / (length * gx / (peak * -gy));
    judge.at_most(
        "slip: slip before the block presses, over that at rest",
        early.abs(),
        0.05,
        "it falls on its base in a few ms",
    );
    let energy = |x: f64| 0.5 * stiffness * x * x + 0.5 * peak / length * mass(1) * -gy * own * own;
    let made = |of: &dyn Fn(&[f64; 4]) -> f64| seen.iter().map(of).collect::<Vec<_>>();
    let found =
        [made(&|s| s[2]), made(&|s| -stiffness * (s[0] - zero)), made(&|s| s[3]), made(&|s| energy(s[1] - zero))];
    let why = "the lowest points lie an eighth of the height above the base, and shear by that; the block bounces by a part of a hundredth";
    judge.same(
        "slip: base_friction_n against elastic slip and Coulomb",
        &found[0],
        &found[1],
        within(0.01, why, "elastic slip: mu N x over the slip length"),
    );
    judge.same(
        "slip: energy.csv elastic_j less that of the blocks against elastic slip",
        &found[2],
        &found[3],
        within(0.01, why, "half of stiffness times slip squared"),
    );
    let late: Vec<_> = frames.iter().filter(|f| f.0 > 0.1).collect();
    if let [first, .., last] = &late[..] {
        let gained = centre(&last.1, 1).1[0] - centre(&first.1, 1).1[0];
        let a = gx + kinetic * gy;
        judge.closed(
            "slip: deceleration of the block that slides",
            gained / (last.0 - first.0),
            a,
            "m/s2",
            within(
                0.01,
                "a hundredth of a difference of 1.2 m/s2 between two forces",
                "Coulomb 1785: g (sin - mu cos)",
            ),
        );
    }
}
