use super::*;
use crate::case;
use crate::output::Table;

/// A block at rest on an elastic base as long, level.
const BLOCK_ON_BASE: &str = r#"
title = "block on a base"
[gravity]
inclination_deg = 0
[grid]
spacing_m = 0.05
thickness_m = 0.1
[domain]
x_m = [-0.5, 0.5]
y_m = [-0.2, 0.6]
[materials.rubber]
law = "linear_elastic"
density_kg_per_m3 = 1500
young_pa = 1.0e6
poisson = 0
[[bodies]]
name = "base"
material = "rubber"
x_m = [-0.2, 0.2]
y_m = [0.0, 0.2]
[[bodies]]
name = "block"
material = "rubber"
x_m = [-0.2, 0.2]
y_m = [0.2, 0.4]
[[boundaries]]
name = "floor"
kind = "plane"
point_m = [0.0, 0.0]
normal_deg = 90
contact = "rough"
[[contacts]]
bodies = ["base", "block"]
friction = 0.3
[stages.settle]
damping_per_s = 60
residual = 1.0e-4
max_time_s = 5.0
[stages.run]
end_time_s = 0.05
stop_at_rest = false
[gauges]
field_times_s = [0.05]
[numerics]
pic_rate_per_s = 50
[output]
vtk_interval_s = 0
"#;

/// From the case file to the file of results: pressures times areas between the bodies are the weight of the block.
#[test]
fn tractions_between_bodies_carry_the_weight() {
    let case = case::parse(BLOCK_ON_BASE, "block.toml").unwrap_or_else(|e| panic!("{e}")).case;
    let folder = tempfile::tempdir().expect("a folder");
    run_into(&case, folder.path(), &mut |_| true).unwrap_or_else(|e| panic!("{e}"));
    let table = Table::load(folder.path().join("contact.csv")).expect("a table");
    let column = |name: &str| table.column(name).unwrap_or_else(|e| panic!("{e}")).to_vec();
    let (area, pressure, shear) = (column("area_m2"), column("pressure_pa"), column("shear_pa"));
    let sum = |values: &[f64]| area.iter().zip(values).map(|(a, p)| a * p).sum::<f64>();
    let weight = 1500.0 * 0.4 * 0.2 * 0.1 * 9.81;
    // What still swings after settling is some thousandths; 3 % off fails.
    assert!((sum(&pressure) / weight - 1.0).abs() < 0.01, "{} of {weight} N", sum(&pressure));
    assert!(sum(&shear).abs() < 0.01 * weight, "{} N", sum(&shear));
    assert!(column("normal_y_1").iter().all(|y| (y - 1.0).abs() < 1e-6));
}
