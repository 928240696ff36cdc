//! Figures of made-up runs: same bytes twice, moderate size, nothing of the machine that drew them.

use std::path::{Path, PathBuf};

use super::curves::{Curve, Curves, Panel};
use super::heat_map::HeatMap;
use super::*;
use crate::output::TableWriter;

/// Where the figures go: a directory removed afterwards, or the one named by `CHECKDAM_FIGURES`, to look at them.
struct Bench {
    directory: tempfile::TempDir,
    keep: Option<PathBuf>,
}

impl Bench {
    fn new() -> Self {
        let keep = std::env::var_os("CHECKDAM_FIGURES").map(PathBuf::from);
        Self { directory: tempfile::tempdir().unwrap(), keep }
    }

    fn table(&self, name: &str, columns: &[&str], rows: impl IntoIterator<Item = Vec<f64>>) -> PathBuf {
        let path = self.directory.path().join(name);
        let mut writer = TableWriter::create(&path, columns).unwrap();
        rows.into_iter().for_each(|row| writer.row(&row).unwrap());
        writer.finish().unwrap();
        path
    }

    /// Draws twice and checks what every figure promises.
    fn check(&self, name: &str, limit: usize, draw: impl Fn(&Path) -> Result<(), PlotError>) -> String {
        let path = self.directory.path().join(name);
        draw(&path).unwrap();
        let svg = std::fs::read_to_string(&path).unwrap();
        draw(&path).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), svg, "{name} differs when drawn again");
        assert!(svg.starts_with("<svg width=\"800\" height=\""));
        assert!(svg.len() < limit, "{name} has {} bytes", svg.len());
        let place = self.directory.path().display().to_string();
        for word in [place.as_str(), "/tmp", "/home", "file:", "date", "NaN", "inf,"] {
            assert!(!svg.contains(word), "{name} contains {word:?}");
        }
        let fonts = svg.matches("font-family=").count();
        assert!(fonts > 0 && fonts == svg.matches("font-family=\"sans-serif\"").count());
        if let Some(keep) = &self.keep {
            std::fs::copy(&path, keep.join(name)).unwrap();
        }
        svg
    }
}

/// A number between -1 and 1 that looks random and is always the same.
fn noise(k: usize) -> f64 {
    let mut z = (k as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

fn history(bench: &Bench, rows: usize, scale: f64) -> PathBuf {
    let columns = [
        "time_s",
        "force_normal_n",
        "force_tangential_n",
        "force_layer1_n",
        "force_layer2_n",
        "force_layer3_n",
        "force_normal_max_n",
    ];
    let row = |k: usize| {
        let t = 6.0 * k as f64 / rows as f64;
        let s = (t - 0.55).max(0.0);
        let gone = (-s / 0.22f64).exp();
        let smooth = scale * (150.0 * (1.0 - gone) + 3000.0 * s * gone * s / (s + 0.1));
        let force = smooth * (1.0 + 0.04 * gone.max(0.1) * noise(k));
        let layer = smooth * (0.95 + 0.08 * gone.max(0.1) * noise(k + 7919));
        vec![t, force, 0.3 * force, layer, layer, layer, force * 1.2]
    };
    bench.table("history.csv", &columns, (0..rows).map(row))
}

#[test]
fn force_against_time() {
    let bench = Bench::new();
    let history = history(&bench, 20_000, 1.0);
    let reference = |label: &str, value_n| force_time::ReferenceLine::new(label, value_n);
    let lines = [
        reference("measured peak force on the rigid barrier", 262.0),
        reference("hydrodynamic, \u{3b1} = 1", 248.0),
        reference("static, K0", 48.0),
        reference("deposit behind the wall, static", 151.0),
    ];
    let svg = bench.check("force_time.svg", 300_000, |out| force_time::draw(&history, &lines, out));
    assert!(svg.contains("peak ") && svg.contains("hydrodynamic"));
    bench.check("force_time_bare.svg", 300_000, |out| force_time::draw(&history, &[], out));
}

#[test]
fn large_forces_are_given_in_kilonewtons() {
    let bench = Bench::new();
    let history = history(&bench, 300, 1e3);
    let svg = bench.check("force_time_large.svg", 300_000, |out| force_time::draw(&history, &[], out));
    assert!(svg.contains("normal force (kN)"));
}

#[test]
fn shares_of_the_energy() {
    let bench = Bench::new();
    let columns = [
        "time_s",
        "kinetic_j",
        "gravitational_j",
        "elastic_j",
        "plastic_j",
        "friction_base_j",
        "friction_back_wall_j",
        "friction_barrier_j",
        "contact_base_j",
        "contact_barrier_j",
        "pic_j",
        "damping_j",
        "side_walls_j",
        "outflow_j",
        "residual_j",
    ];
    let row = |k: usize| {
        let t = k as f64 * 1e-3;
        let ramp = |from: f64, to: f64| {
            let s = ((t - from) / (to - from)).clamp(0.0, 1.0);
            s * s * (3.0 - 2.0 * s)
        };
        let fallen = 200.0 * ramp(0.0, 1.2);
        let plastic = 90.5 * ramp(0.1, 1.5);
        let base = 62.0 * ramp(0.1, 1.4);
        let barrier = 6.0 * ramp(0.6, 1.5);
        let contact = 21.0 * ramp(0.55, 1.1);
        let pic = 22.0 * ramp(0.3, 1.5);
        let elastic = 0.9 * (1.0 - ramp(0.0, 0.2));
        let residual = -0.6 * ramp(0.5, 1.0);
        let lost = plastic + base + barrier + contact + pic + residual;
        let kinetic = fallen + 0.9 - elastic - lost;
        let gravitational = 250.0 - fallen;
        vec![
            t,
            kinetic,
            gravitational,
            elastic,
            plastic,
            base,
            0.1 * ramp(0.0, 0.5),
            barrier,
            0.05,
            contact,
            pic,
            0.0,
            0.0,
            0.0,
            residual,
        ]
    };
    let energy = bench.table("energy.csv", &columns, (0..2500).map(row));
    let svg = bench.check("energy_shares.svg", 300_000, |out| energy_shares::draw(&energy, out));
    for text in ["gravitational", "kinetic", "friction, base", "other", "residual of the balance"] {
        assert!(svg.contains(text), "{text} is not named");
    }
}

fn geometry(bench: &Bench) -> PathBuf {
    let rectangle = |id: f64, x: [f64; 2], y: [f64; 2]| {
        [[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]].map(|[x, y]| vec![id, x, y]).to_vec()
    };
    let rows = [
        rectangle(0.0, [-0.3, 1.4], [-0.04, 0.0]),
        rectangle(1.0, [-0.3, -0.2], [0.0, 0.6]),
        rectangle(3.0, [1.2, 1.3], [0.0, 0.6]),
    ];
    bench.table("geometry.csv", &["boundary", "x_m", "y_m"], rows.into_iter().flatten())
}

fn field(bench: &Bench, times: &[f64]) -> PathBuf {
    let columns =
        ["time_s", "x_m", "y_m", "solid_fraction", "velocity_x_m_per_s", "velocity_y_m_per_s", "speed_m_per_s"];
    let mut rows = Vec::new();
    for t in times {
        let front = (-0.0 + 2.2 * t * t + 0.6 * t).min(1.2);
        for i in 0..140 {
            for j in 0..60 {
                let (x, y) = (-0.195 + 0.01 * f64::from(i), 0.005 + 0.01 * f64::from(j));
                let depth =
                    0.55 * (1.0 - (x + 0.2) / (front + 0.2)).max(0.0).powf(0.2 + 1.2 * t.min(0.8)) / (1.0 + 3.0 * t);
                if y < depth && x < front {
                    let speed = 3.0 * t * (x + 0.2) * (0.6 + y) * (1.0 + 0.05 * noise(i as usize * 60 + j as usize));
                    rows.push(vec![*t, x, y, 0.6, speed, 0.0, speed]);
                }
            }
        }
    }
    bench.table("field.csv", &columns, rows)
}

#[test]
fn snapshots_of_the_flow() {
    let bench = Bench::new();
    let geometry = geometry(&bench);
    let field_of_8 = field(&bench, &[0.0, 0.2, 0.4, 0.5, 0.6, 0.8, 1.0, 1.5]);
    bench.check("flow_snapshots.svg", 600_000, |out| flow_snapshots::draw(&field_of_8, &geometry, 40.0, out));
    let field_of_3 = field(&bench, &[0.0, 0.25, 0.5]);
    let svg =
        bench.check("flow_snapshots_level.svg", 400_000, |out| flow_snapshots::draw(&field_of_3, &geometry, 0.0, out));
    assert!(svg.contains("t = 0.25 s"));
}

#[test]
fn profiles_of_pressure() {
    let bench = Bench::new();
    let rows = (0..6).flat_map(|k| {
        let t = 0.5 + 0.1 * f64::from(k);
        (0..30).map(move |j| {
            let h = 0.01 * f64::from(j) + 0.005;
            vec![t, h, (4e3 * t * (0.1 * t + 0.12 - h)).max(0.0) * (1.0 + 0.1 * noise(j as usize))]
        })
    });
    let profile = bench.table("pressure_profile.csv", &["time_s", "height_m", "pressure_pa"], rows);
    let svg = bench.check("pressure_profile.svg", 300_000, |out| pressure_profile::draw(&profile, out));
    assert!(svg.contains("normal pressure (Pa)") && svg.contains("0.9 s"));
}

#[test]
fn tables_that_cannot_be_drawn_are_refused_with_their_name() {
    let bench = Bench::new();
    let out = bench.directory.path().join("out.svg");
    let empty = bench.table("empty.csv", &["time_s", "height_m", "pressure_pa"], []);
    let message = pressure_profile::draw(&empty, &out).unwrap_err().to_string();
    assert!(message.contains("empty.csv: no row has"), "{message}");
    let message = force_time::draw(&empty, &[], &out).unwrap_err().to_string();
    assert!(message.contains("no column \"force_normal_n\""), "{message}");
    let columns = ["time_s", "kinetic_j", "gravitational_j", "elastic_j", "residual_j"];
    let still = bench.table("still.csv", &columns, [vec![0.0; 5]]);
    let message = energy_shares::draw(&still, &out).unwrap_err().to_string();
    assert!(message.contains("not positive"), "{message}");
    let message = flow_snapshots::draw(&empty, &empty, f64::NAN, &out).unwrap_err().to_string();
    assert!(message.contains("inclination"), "{message}");
    assert!(!out.exists());
}

#[test]
fn a_single_row_is_enough() {
    let bench = Bench::new();
    let history = history(&bench, 1, 1.0);
    bench.check("one_force.svg", 100_000, |out| force_time::draw(&history, &[], out));
    let geometry = geometry(&bench);
    let cell = bench.table("cell.csv", &["time_s", "x_m", "y_m", "speed_m_per_s"], [vec![0.0, 0.1, 0.1, 0.0]]);
    bench.check("one_cell.svg", 100_000, |out| flow_snapshots::draw(&cell, &geometry, 40.0, out));
    let columns = ["time_s", "kinetic_j", "gravitational_j", "elastic_j", "residual_j"];
    let energy = bench.table("energy.csv", &columns, [vec![0.0, 0.0, 10.0, 0.1, 0.0]]);
    bench.check("one_energy.svg", 100_000, |out| energy_shares::draw(&energy, out));
}

/// A table with a column of names, as the ladder writes them.
fn named_table(bench: &Bench) -> PathBuf {
    let path = bench.directory.path().join("named.csv");
    let mut text = String::from("shape,cells,points,error,exact,note\n");
    for (shape, order) in [("linear", 1), ("spline", 2)] {
        for cells in [8u32, 16, 32] {
            for points in [1u32, 4] {
                let error = 1.0 / f64::from(cells * points).powi(order);
                text += &format!("{shape},{cells},{points},{error},0.001,\n");
            }
        }
    }
    std::fs::write(&path, text).unwrap();
    path
}

const BY_SHAPE: [Panel; 2] = [
    Panel { title: "first panel", only: &[("shape", "linear")] },
    Panel { title: "second panel", only: &[("shape", "spline")] },
];

#[test]
fn curves_are_split_into_panels_and_named_series() {
    let bench = Bench::new();
    let table = named_table(&bench);
    let what = Curves {
        x: "cells",
        x_title: "cells",
        y_title: "error",
        curves: &[
            Curve { column: "error", label: "", exact: false },
            Curve { column: "exact", label: "closed form", exact: true },
        ],
        panels: &BY_SHAPE,
        split: &[("points", "points ")],
        orders: &[2.0],
        ..Curves::LOGARITHMIC
    };
    let svg = bench.check("curves.svg", 100_000, |out| curves::draw(&table, &what, out));
    for text in ["first panel", "second panel", "points 1", "points 4", "closed form", "order 2", "10⁻³", "16"] {
        assert!(svg.contains(text), "no {text:?}");
    }
    // One name in the legend for what should come out, whatever is varied; markers for measured points only.
    assert_eq!(svg.matches("closed form").count(), 1);
    assert_eq!(svg.matches("<circle").count(), 12);
    let linear = Curves { logarithmic: false, panels: &[], ..what };
    let svg = bench.check("linear.svg", 100_000, |out| curves::draw(&table, &linear, out));
    assert!(svg.contains("points 4") && !svg.contains("10⁻³"));
}

#[test]
fn a_heat_map_has_a_cell_for_every_number() {
    let bench = Bench::new();
    let table = named_table(&bench);
    let what = HeatMap {
        panel: "shape",
        panels: &[("linear", "Linear functions"), ("spline", "Splines")],
        x: "cells",
        x_title: "cells",
        y: "points",
        y_title: "points",
        value: "error",
        value_title: "error (1)",
    };
    let svg = bench.check("heat_map.svg", 100_000, |out| heat_map::draw(&table, &what, out));
    for text in ["Linear functions", "Splines", "0.031", "error (1)", "10⁻²"] {
        assert!(svg.contains(text), "no {text:?}");
    }
    let absent = HeatMap { panels: &[("cubic", "Cubic")], ..what };
    let message = heat_map::draw(&table, &absent, bench.directory.path().join("no.svg")).unwrap_err().to_string();
    assert!(message.contains("no number for cubic"), "{message}");
    let panels = &[Panel { title: "", only: &[("shape", "cubic")] }];
    let nothing =
        Curves { x: "cells", panels, curves: &[Curve { column: "error", label: "", exact: false }], ..Curves::LINEAR };
    let message = curves::draw(&table, &nothing, bench.directory.path().join("no.svg")).unwrap_err().to_string();
    assert!(message.contains("no row has a value on both axes"), "{message}");
}
