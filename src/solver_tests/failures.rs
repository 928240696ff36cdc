//! Steps that fail.

use super::*;

/// The step that fails, in words.
fn failure(scene: Scene) -> String {
    let mut sim = Simulation::new(scene);
    for _ in 0..50 {
        if let Err(failure) = sim.step() {
            return failure.to_string();
        }
    }
    panic!("no failure")
}

#[test]
fn failures_say_what_where_and_why() {
    let mut broken = block([1.0, 0.0], vec![]);
    broken.bodies[0].1[17].v[1] = f64::NAN;
    let text = failure(broken);
    assert!(text.starts_with("a velocity is not a number at t = 1.000000e-3 s (step 1): particle"), "{text}");
    assert!(text.contains("body `brick`") && text.contains("the time step of 1.0000e-3 s"), "{text}");
    assert!(text.contains("limited by the largest time step allowed"), "{text}");

    let mut crushed = block([1.0, 0.0], vec![]);
    crushed.bodies[0].1[17].volume_ratio = 0.05;
    let text = failure(crushed);
    assert!(text.contains("crushed or inverted") && text.contains("particle 17 "), "{text}");
    assert!(
        text.contains("x = 0.076000 m, y = 0.125000 m") && text.contains("speed 1.0000e0 m/s, volume ratio 5.0000e-2"),
        "{text}"
    );
    let mut dense = block([1.0, 0.0], vec![]);
    dense.bodies[0].1[17].volume_ratio = 0.0501;
    run(dense, 10);

    let mut fast = block([1.0, 0.0], vec![]);
    fast.numerics.cfl = 1.5;
    fast.numerics.max_time_step = 1.0;
    let law = LinearElastic::new(10.0, 0.0);
    fast.bodies[0].0.law = AnyLaw::LinearElastic(law);
    let text = failure(fast.clone());
    assert!(text.contains("moves more than a cell in one step"), "{text}");
    assert!(text.contains("the particle speed in body `brick` (1.0000 m/s)"), "{text}");
    fast.numerics.cfl = 0.9;
    run(fast, 10);

    let mut sim = Simulation::new(block([1.0, 0.0], vec![]));
    assert!(sim.time_step().dt == DT && sim.steps() == 0);
    sim.step().unwrap();
    let mut waves = block([1.0, 0.0], vec![]);
    waves.numerics.max_time_step = 1.0;
    let sim = run(waves, 1);
    let text = sim.describe_limit(&sim.time_step());
    assert_eq!(text, "the P-wave of body `brick` (10.0000 m/s; its points reach 1.000 m/s)");
    assert!(close(sim.time_step().dt, 0.4 * H / 11.0));
}
