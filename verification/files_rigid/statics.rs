//! Closed forms of what is at rest: a block against a wall, bars that hang.

use super::judge::{Judge, within};
use super::setting::{Point, Setting, at};
use crate::from_file::{Files, count, largest};

pub const REST: &str = "at rest to 1e-5 of a free fall; the contact of a wall acts where the wall is";
pub const WAVES: &str = "1e-5 of a free fall at release is waves of 3e-4 of the stress";
pub const EQUILIBRIUM: &str = "equilibrium";
pub const VIRIAL: &str = "equilibrium: the volume integral of stress is the moment of the forces (Clausius 1870)";

/// The points at the last frame.
pub fn last(set: &Setting, files: &Files) -> Vec<Point> {
    set.points(files, files.frames().saturating_sub(1))
}

pub fn sum(points: &[Point], of: impl Fn(&Point) -> f64) -> f64 {
    points.iter().map(of).sum()
}

/// The volume integral of a component of the stress, J.
pub fn integral(points: &[Point], component: usize) -> f64 {
    sum(points, |p| p.stress[component] * p.volume)
}

pub fn rest(set: &Setting, files: &Files, judge: &mut Judge) {
    let [gx, gy] = set.g();
    let (m, body) = (set.mass(), &set.bodies[0]);
    let number = |key: &str| files.number(key);
    let push = m * gx;
    judge.closed(
        "rest: barrier.static_force_n",
        number("barrier.static_force_n"),
        push,
        "N",
        within(1e-6, REST, "equilibrium: m g sin"),
    );
    judge.closed(
        "rest: deposit.base_normal_n",
        number("deposit.base_normal_n"),
        -m * gy,
        "N",
        within(1e-6, REST, "equilibrium: m g cos"),
    );
    // Smooth walls and no lateral strain: stresses are linear, and the pressure on each wall is uniform.
    let height = body.size()[1] * (1.0 + 0.5 * body.density * gy * body.size()[1] / body.young);
    let why = "uniform pressure of a block without lateral strain; the grid's corner carries a half cell of base and wall at once";
    judge.closed(
        "rest: barrier.static_height_of_action_m",
        number("barrier.static_height_of_action_m"),
        0.5 * height,
        "m",
        within(1e-3, why, "uniform pressure"),
    );
    judge.closed(
        "rest: barrier.static_moment_n_m",
        number("barrier.static_moment_n_m"),
        0.5 * push * height,
        "N m",
        within(1e-3, why, "uniform pressure"),
    );
    judge.closed(
        "rest: barrier.impulse_normal_n_s",
        number("barrier.impulse_normal_n_s"),
        push * number("stepping.end_s"),
        "N s",
        within(1e-6, REST, "force times time"),
    );
    let half = "a half second is cut at rows of a millisecond or two steps";
    judge.closed(
        "rest: barrier.impulse_half_second_n_s",
        number("barrier.impulse_half_second_n_s"),
        0.5 * push,
        "N s",
        within(3e-3, half, "force times time"),
    );
    let scale = 2.0 * m * (gx.abs() + gy.abs()) * number("stepping.end_s");
    judge.closed(
        "rest: momentum.impulse_scale_n_s",
        number("momentum.impulse_scale_n_s"),
        scale,
        "N s",
        within(1e-5, REST, "gravity and what balances it, along x and y"),
    );
    for name in ["peak_step_n", "peak_20ms_n", "peak_20ms_by_steps_n"] {
        judge.closed(
            &format!("rest: barrier.{name}"),
            number(&format!("barrier.{name}")),
            push,
            "N",
            within(1e-5, REST, "a steady force is its peak"),
        );
    }
    judge.closed(
        "rest: stepping.end_s",
        number("stepping.end_s"),
        0.7,
        "s",
        within(5e-3, "a window ends with a row, of a step or two", "three windows of 0.1 s from half a second on"),
    );
    let odd = files.flag("trusted") != Some(true) || files.text("status") != "completed: at rest";
    judge.at_most("rest: not trusted, or not at rest", f64::from(u8::from(odd)), 0.0, "nothing is wrong with it");
    // Stress, component by component.
    let points = last(set, files);
    let wall = set.boundary("wall").map_or(f64::NAN, |b| b.foot[0]);
    let moment = files.column("history.csv", "overturning_moment_n_m").last().copied().unwrap_or(f64::NAN);
    let why = "exact for a grid whose velocities are linear in places, where boundaries act on their surface";
    let near = |judge: &mut Judge, name: &str, k: usize, expected: f64| {
        judge.closed(
            &format!("rest: volume integral of stress {name}"),
            integral(&points, k),
            expected,
            "J",
            within(2e-3, why, VIRIAL),
        );
    };
    near(judge, "xx", 0, sum(&points, |p| p.mass * gx * (p.x[0] - wall)));
    near(judge, "yy", 1, sum(&points, |p| p.mass * gy * p.x[1]));
    let shear = sum(&points, |p| p.mass * gx * p.x[1]) - moment;
    let scale = sum(&points, |p| p.mass * gx * p.x[1]);
    judge.near(
        "rest: volume integral of stress xy",
        &[integral(&points, 3)],
        &[shear],
        scale,
        within(1e-4, why, VIRIAL),
    );
    judge.near(
        "rest: volume integral of stress zz",
        &[integral(&points, 2)],
        &[0.0],
        integral(&points, 1).abs(),
        within(1e-6, "Poisson's ratio is zero", "plane strain"),
    );
    let strain: Vec<f64> = points.iter().map(|p| p.ratio - 1.0).collect();
    let hooke: Vec<f64> = points.iter().map(|p| 3.0 * p.mean() / body.young).collect();
    judge.same(
        "rest: volume ratio against Hooke",
        &strain,
        &hooke,
        within(5e-3, "strains of 4e-3 squared over themselves", "Hooke: trace of stress over E"),
    );
}

pub fn hang(set: &Setting, files: &Files, judge: &mut Judge) {
    let weight = set.mass() * set.gravity;
    judge.closed(
        "hang: barrier.static_force_n",
        files.number("barrier.static_force_n"),
        -weight,
        "N",
        within(2e-3, "it swings, with 2e-3 of a free fall at release", EQUILIBRIUM),
    );
    let points = last(set, files);
    for (k, body) in set.bodies.iter().enumerate() {
        let own: Vec<Point> = points.iter().filter(|p| p.body == k).copied().collect();
        let height = sum(&own, |p| -p.mass * set.gravity * p.x[1]);
        let name = &body.name;
        let own_at = |frame: usize| set.points(files, frame).into_iter().filter(|p| p.body == k).collect::<Vec<_>>();
        let pulled: f64 = (0..files.frames()).map(|frame| integral(&own_at(frame), 1)).sum();
        judge.closed(
            &format!("hang: {name}: volume integral of stress yy"),
            pulled / files.frames() as f64,
            height,
            "J",
            within(
                1e-2,
                "exact for linear velocities; the torn bar swings by a hundredth, of which five frames are the mean",
                VIRIAL,
            ),
        );
        let cut = at(&set.case, &format!("materials.{name}.tension_cutoff_pa")).unwrap_or(f64::NAN);
        let means: Vec<f64> = own.iter().map(|p| p.mean()).collect();
        let above = count(&means, |m| *m > cut * (1.0 + 1e-9));
        judge.at_most(
            &format!("hang: {name}: points above the cut-off"),
            above,
            0.0,
            "no mean stress lies above the cut-off",
        );
        let opened = largest(own.iter().map(|p| p.opened));
        // The mean stress of the uppermost cell, whose middle carries what hangs below it.
        let least = body.density * set.gravity * (body.size()[1] - 0.5 * set.h) / 3.0;
        let tears = least > cut;
        let why =
            "the upper cell pulls 1.6 % less than the cut-off of the one bar and 1.6 % more than that of the other";
        judge.at_most(
            &format!("hang: {name}: opened, or not, against the cut-off"),
            f64::from(u8::from(tears != (opened > 1e-4))),
            0.0,
            why,
        );
        // Torn points are open by as much as they have grown: their elastic part is a hundredth of that.
        let torn: Vec<&Point> = own.iter().filter(|p| p.opened > 1e-3).collect();
        if !torn.is_empty() {
            let made = |of: &dyn Fn(&Point) -> f64| torn.iter().map(|p| of(p)).collect::<Vec<_>>();
            let [bulk, _] = body.moduli();
            judge.same(
                "hang: opened strain against volume ratio",
                &made(&|p| p.opened),
                &made(&|p| libm::log(p.ratio) - p.mean() / bulk),
                within(
                    1e-2,
                    "what is not stored is open; bounded by what the points occupy",
                    "opened strain is the part of the volume strain that is not elastic",
                ),
            );
        }
    }
}
