//! A block strikes a wall: a scene made from code, stepped, and read by a gauge.
//!
//! ```sh
//! cargo run --release --example step_and_gauge
//! ```

use checkdam::boundary::{Boundary, Friction};
use checkdam::gauge::BarrierGauge;
use checkdam::scaffold::{Brick, elastic, scene};
use checkdam::simulation::{Simulation, StepFailure};
use nalgebra::Vector2;

/// Cell size, m.
const H: f64 = 0.02;
/// Density of the block, kg/m3.
const DENSITY: f64 = 1500.0;
/// Its speed, m/s.
const SPEED: f64 = 0.5;

/// Impulse on the wall and what the block lost of its momentum along x, N s.
fn impact() -> Result<(f64, f64), StepFailure> {
    // Ten by five cells of four points, 1 MPa, on a smooth base, against a smooth wall.
    let block = Brick::new([0.0, 0.0], [10, 5], H);
    let mut points = block.points();
    points.iter_mut().for_each(|p| p.v = [SPEED, 0.0]);
    let base = Boundary::plane("base", Vector2::zeros(), Vector2::new(0.0, 1.0), Friction::Smooth);
    let face = Vector2::new(10.0 * H, 0.0);
    let wall = Boundary::plane("wall", face, Vector2::new(-1.0, 0.0), Friction::Smooth);
    let mut simulation = Simulation::new(scene(&block, elastic(1e6, 0.0), DENSITY, points, vec![base, wall]));

    // The gauge adds up what the wall gives to the material, step by step, and never touches it.
    let mut gauge = BarrierGauge::new(&simulation, 1);
    let (mut impulse, mut time) = (0.0, 0.0);
    let before = simulation.stock().momentum[0];
    for sample in 1..=20 {
        while simulation.time() < f64::from(sample) * 1e-3 {
            simulation.step()?;
            gauge.after_step(&simulation);
        }
        let force = gauge.sample();
        impulse += force.normal * force.duration;
        time += force.duration;
        println!("{time:.4} s  {:8.2} N  (largest step {:8.2} N)", force.normal, force.normal_max);
    }
    Ok((impulse, before - simulation.stock().momentum[0]))
}

fn main() -> Result<(), StepFailure> {
    let (impulse, lost) = impact()?;
    println!("impulse on the wall {impulse:.4} N s, momentum that the block lost {lost:.4} N s");
    Ok(())
}

#[test]
fn the_wall_takes_what_the_block_loses() {
    let (impulse, lost) = impact().expect("it runs");
    // Newton's third law, to round-off; a force that is read 3 % wrong fails.
    assert!((impulse - lost).abs() < 1e-10 * lost, "{impulse} and {lost} N s");
    // It is stopped and comes back.
    let came = DENSITY * 50.0 * H * H * checkdam::scaffold::THICKNESS * SPEED;
    assert!(impulse > came, "{impulse} N s of {came}");
}
