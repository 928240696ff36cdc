//! What a wave in a barrier looks like from inside: stress, velocity and volume of the points of a frame, and where on its face forces act.

use super::barrier::{Barrier, Worst};
use super::bars::{AREA, CLAMPED, H, HEIGHT, LENGTH, SPEED, Setting, WAVES, YOUNG};
use crate::from_file::Files;
use checkdam::check::{Check, Kind, Tolerance};

/// Stress, velocity and volume of the points in the middle of the wave, from the VTK frame.
pub fn stresses(s: &Setting, files: &Files) -> Vec<Check> {
    let frame = (100.0 * (s.start() + 0.02)).round() as usize;
    let of = |name: &str| files.array(frame, name);
    let (bodies, x, y) = (of("body"), of("Points.x"), of("Points.y"));
    let along = s.turned([1.0, 0.0]);
    let inside = |k: usize| bodies[k] == 1.0 && (0.15..0.45).contains(&(x[k] * along[0] + y[k] * along[1]));
    let rows: Vec<usize> = (0..bodies.len()).filter(|&k| inside(k)).collect();
    let mean = |name: &str| {
        let values = of(name);
        rows.iter().map(|&k| values[k]).sum::<f64>() / rows.len() as f64
    };
    let stress = -s.force() / AREA;
    let [c, d] = along;
    let rough = if s.angle_deg == 0.0 { 0.015 } else { 0.02 };
    let mut checks = Vec::new();
    let mut value = |what: &str, measured: f64, expected: f64, unit, allowed: f64, source: &str| {
        checks.push(
            Check::value(format!("{what} in the wave"), measured, expected, unit)
                .within(
                    Tolerance::Absolute(allowed),
                    "ripples of a front are a tenth high and some cells long: a percent and a half in the mean over eight cells, two in a turned bar, whose faces are rough",
                )
                .from(Kind::Analytic, source),
        );
    };
    for (name, share) in [("xx", c * c), ("yy", d * d), ("zz", s.poisson), ("xy", c * d)] {
        value(
            &format!("stress {name}"),
            mean(&format!("stress_pa.{name}")),
            share * stress,
            "Pa",
            -rough * stress,
            WAVES,
        );
    }
    for (name, share) in [("x", c), ("y", d)] {
        value(
            &format!("velocity {name}"),
            mean(&format!("velocity_m_per_s.{name}")),
            0.5 * SPEED * share,
            "m/s",
            0.5 * rough * SPEED,
            WAVES,
        );
    }
    if s.angle_deg != 0.0 {
        let [xx, yy, xy] = ["xx", "yy", "xy"].map(|c| mean(&format!("stress_pa.{c}")));
        let along = 0.5 * libm::tan(2.0 * s.angle_deg.to_radians()) * (xx - yy);
        value("stress xy over that of a principal stress along the bar", xy / along, 1.0, "1", 0.015, "Mohr 1882");
    }
    let nu = s.poisson;
    let volume = 1.0 + stress * (1.0 - nu - 2.0 * nu * nu) / YOUNG;
    value("volume ratio", mean("volume_ratio"), volume, "1", 2e-4, "Hooke's law in plane strain");
    if s.law == "linear_elastic" {
        let [xx, yy, zz] = ["xx", "yy", "zz"].map(|c| of(&format!("stress_pa.{c}")));
        let mut worst = Worst::default();
        (0..bodies.len()).for_each(|k| worst.number(zz[k], nu * (xx[k] + yy[k]), -stress));
        checks.push(worst.check(
            "stress zz less nu (xx + yy), point by point, over that of the wave",
            1e-9,
            "an identity of the law, which turning leaves alone",
            Kind::Analytic,
            "Hooke's law in plane strain",
        ));
    }
    let count = (HEIGHT / H * s.per_cell as f64) * ((LENGTH + CLAMPED) / H * s.per_cell as f64);
    let found = bodies.iter().filter(|b| **b == 1.0).count() as f64;
    checks.push(
        Check::value("points of the barrier", found, count.round(), "1")
            .within(Tolerance::Absolute(0.5), "a whole number")
            .from(Kind::Analytic, "particles_per_cell of the body"),
    );
    checks
}

/// By symmetry forces act at half the height; what touches is the face.
pub fn in_the_middle(s: &Setting, b: &Barrier) -> Vec<Check> {
    let mut worst = Worst::default();
    let arm = 0.5 * HEIGHT;
    let lever = |values: Vec<f64>| values.into_iter().map(|f| f * arm).collect::<Vec<_>>();
    let scale = s.force() * arm;
    worst.lists(&b.history("overturning_moment_n_m"), &lever(b.body("contact_normal_n")), scale);
    worst.lists(&b.body("clamp_moment_n_m"), &lever(b.body("clamp_normal_n")), scale);
    worst.number(
        b.number("barrier.peak_moment_n_m"),
        arm * b.number("barrier.peak_step_n"),
        arm * b.number("barrier.peak_step_n"),
    );
    let column = |name: &str| b.files.column("contact.csv", name);
    let (t, y, p, a) = (column("time_s"), column("y_m"), column("pressure_pa"), column("area_m2"));
    let rows: Vec<usize> = (0..t.len()).filter(|&k| (t[k] - s.start() - 0.01).abs() < 1e-3).collect();
    let sum = |f: &dyn Fn(usize) -> f64| rows.iter().map(|&k| f(k)).sum::<f64>();
    let force = sum(&|k| p[k] * a[k]);
    worst.number(sum(&|k| p[k] * a[k] * y[k]) / force, arm, arm);
    let (nx, ny) = (column("normal_x_1"), column("normal_y_1"));
    worst.number(sum(&|k| p[k] * a[k] * nx[k]) / force, -1.0, 1.0);
    worst.number(sum(&|k| p[k] * a[k] * ny[k]) / force, 0.0, 1.0);
    let mut checks = vec![worst.check(
        "moments over force times half the height, less one; normals and places of nodes likewise",
        0.02,
        "Poisson's expansion against friction turns normals and shifts forces by a percent at most",
        Kind::Analytic,
        "symmetry",
    )];
    checks.push(
        Check::value("area of contact", sum(&|k| a[k]), AREA, "m2")
            .within(Tolerance::Relative(0.02), "the areas of both edges reach a little over them")
            .from(Kind::Analytic, "height times width"),
    );
    checks
}
