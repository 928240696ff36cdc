//! A bar strikes a bar that is a barrier, along its length. The force on its face is rho c v A/2 for as long as a wave takes to the end of
//! the striker and back. The clamp gets twice that L/c later. The striker comes to rest, the barrier has its momentum, the clamp takes it
//! twice.

use super::barrier::{Barrier, at, differences, dot, largest, mean_where};
use super::bars::{CLAMPED, DENSITY, H, HEIGHT, LENGTH, MASS, PIC_FRACTION, SPEED, STRIKER, Setting, WAVES, WIDTH};
use super::{balance, inside, shape};
use crate::from_file::Files;
use checkdam::check::{Check, Expected, Kind, Tolerance};
use checkdam::theory::elastic::confined_speed;

/// What must hold.
pub fn judge(s: &Setting, files: &Files) -> Vec<Check> {
    let spacing = H / s.per_cell as f64;
    let (normal, tangent) = (s.turned([-1.0, 0.0]), s.turned([0.0, 1.0]));
    let (near, far) = (0.5 * spacing, [LENGTH + CLAMPED - 0.5 * spacing, HEIGHT - 0.5 * spacing]);
    let corners = [[near, near], [far[0], near], far, [near, far[1]]].map(|x| s.turned(x));
    let bounds =
        |d: usize| corners.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |a, x| [a[0].min(x[d]), a[1].max(x[d])]);
    let b = Barrier {
        files,
        suffix: "",
        root: "",
        clamp: "clamp",
        normal,
        tangent,
        weight: [0.0; 2],
        height: HEIGHT,
        h: H,
        spacing,
        extent: [bounds(0), bounds(1)],
        crest: s.turned([near, far[1]]),
        points_along: (HEIGHT / spacing).round() as usize,
        settled: false,
        width: WIDTH,
    };
    let mut checks = balance::checks(&b, Some([0.0; 2]));
    checks.extend(shape::checks(&b, 1));
    checks.push(shape::velocities(&b));
    checks.extend(waves(s, &b));
    checks.extend(inside::stresses(s, files));
    if s.angle_deg == 0.0 {
        checks.extend(inside::in_the_middle(s, &b));
    }
    if s.gap > 0.0 {
        checks.extend(arrival(s, &b));
    }
    checks
}

/// Forces, impulses, delay, way.
fn waves(s: &Setting, b: &Barrier) -> Vec<Check> {
    let mut checks = Vec::new();
    let mut value = |what: &str, measured: f64, expected: f64, unit, allowed: f64, why: &str| {
        checks.push(
            Check::value(what, measured, expected, unit)
                .within(Tolerance::Relative(allowed), why)
                .from(Kind::Analytic, WAVES),
        );
    };
    let (c, start, force) = (s.wave_speed(), s.start(), s.force());
    let lasts = 2.0 * STRIKER / c;
    let time = b.body("time_s");
    let dt = differences(&time);
    let (contact, clamp) = (b.body("contact_normal_n"), b.body("clamp_normal_n"));
    let middle = |t: f64| t > start + 0.25 * lasts && t < start + 0.75 * lasts;
    let rough = if s.angle_deg == 0.0 { 0.0 } else { 0.01 };
    let strain =
        "a strain of half a percent changes the impedance by a quarter; ripples of a front on cells as much again";
    value("force on the face", mean_where(&time, &contact, middle), force, "N", 0.012 + rough, strain);
    let sharp = s.angle_deg == 0.0 && !s.implicit();
    if sharp {
        value(
            "velocity of its tip",
            mean_where(&time, &b.body("tip_velocity_m_per_s"), middle),
            0.5 * SPEED,
            "m/s",
            0.02,
            strain,
        );
    }
    // Until the wave is back at the face.
    let before = |t: f64| t < start + 1.9 * LENGTH / c;
    let part =
        |f: &[f64]| -> Vec<f64> { (0..time.len()).map(|k| if before(time[k]) { f[k] * dt[k] } else { 0.0 }).collect() };
    let (given, taken) = (part(&contact), part(&clamp));
    let [given_all, taken_all] = [&given, &taken].map(|p| p.iter().sum::<f64>());
    let cell = "the striker comes to rest or rebounds with a few percent of its speed, which is a cell of its eight in the contact";
    value("impulse on the face", given_all, MASS * SPEED, "N s", 0.03, cell);
    if sharp {
        let tail = "a tail of ripples has not come";
        value("impulse on the clamp over that on the face", taken_all / given_all, 2.0, "1", 0.02, tail);
        value("way of the tip", largest(&b.body("tip_deflection_m")), 0.5 * SPEED * lasts, "m", 0.03, "as the impulse");
    }
    // Damped in implicit steps the wave has not left the clamp yet.
    if s.implicit() {
        return checks;
    }
    let delay = dot(&taken, &time) / taken_all - dot(&given, &time) / given_all;
    value(
        "time from the face to the clamp, of the middles of impulses",
        delay,
        LENGTH / c,
        "s",
        0.012,
        "a step, and strains of half a percent",
    );
    let rows = b.files.column("energy.csv", "time_s");
    let energy = |name: &str| at(&rows, &b.files.column("energy.csv", name), start + 0.02);
    let equal = "a wave has as much of both; ripples of a front on cells have a little more of one";
    value(
        "elastic over kinetic energy when the face is free",
        energy("elastic_j") / energy("kinetic_j"),
        1.0,
        "1",
        0.025,
        equal,
    );
    checks
}

/// What is said of a flow that arrives.
fn arrival(s: &Setting, b: &Barrier) -> Vec<Check> {
    let number = |key: &str| b.files.number(key);
    let mut checks = Vec::new();
    let mut value = |what: &str, measured: f64, expected: f64, unit, allowed: f64, why: &str, source: &str| {
        checks.push(
            Check::value(what, measured, expected, unit)
                .within(Tolerance::Relative(allowed), why)
                .from(Kind::Analytic, source),
        );
    };
    let waves = number("scales.flow_wave_speed_m_per_s");
    value("speed of waves", waves, confined_speed(&s.elastic(), DENSITY), "m/s", 1e-6, "nine digits", "sqrt(M / rho)");
    let initial = 0.5 * MASS * SPEED * SPEED;
    value("energy at the start", number("energy.initial_j"), initial, "J", 1e-6, "nine digits", "m v^2/2");
    checks.push(
        Check::new(
            "arrival less gap over speed",
            number("barrier.arrival_s") - s.start(),
            Expected::Within(-5e-4, 1.6e-3),
            "s",
        )
        .because("the gap closes within a step; the row that shows it ends up to a millisecond and a step later")
        .from(Kind::Analytic, "gap over speed"),
    );
    checks
}

/// Force over the exact one on face (0) and clamp (1), time since the start, s, and the exact force over that on the face.
pub fn forces(s: &Setting, files: &Files) -> Vec<[f64; 4]> {
    let column = |name: &str| files.column("barrier.csv", name);
    let (time, contact, clamp) = (column("time_s"), column("contact_normal_n"), column("clamp_normal_n"));
    let (c, force) = (s.wave_speed(), s.force());
    let lasts = 2.0 * STRIKER / c;
    let pressed = |t: f64, from: f64| f64::from(u8::from(t >= from && t < from + lasts));
    let row = |k: usize| {
        let t = time[k] - s.start();
        // A row is the mean over a millisecond before its time.
        let middle = t - 5e-4;
        let exact = [pressed(middle, 0.0), 2.0 * pressed(middle, LENGTH / c)];
        [[0.0, t, contact[k] / force, exact[0]], [1.0, t, clamp[k] / force, exact[1]]]
    };
    let until = (0..time.len()).filter(|&k| time[k] - s.start() < 1.9 * LENGTH / c);
    until.flat_map(row).collect()
}

/// What must hold between a run with PIC as a rate and one with PIC by steps.
pub fn pic(files: &[Files]) -> Vec<Check> {
    let [rate, fraction] = files else { return Vec::new() };
    let taken = |f: &Files| largest(&f.column("energy.csv", "pic_j"));
    let step = rate.number("stepping.end_s") / rate.number("stepping.run_steps");
    vec![
        Check::value(
            "energy that PIC took as a rate, over that by steps",
            taken(rate) / taken(fraction),
            5.0 * step / PIC_FRACTION,
            "1",
        )
        .within(Tolerance::Relative(0.01), "losses go with the share; steps differ by half a percent among each other")
        .from(Kind::Analytic, "share of a step is rate times its length"),
    ]
}
