use super::super::two_bodies::{BODIES, close, point, scene_of, simulation};
use super::super::{FrontGauge, StationGauge, StationSample, WindowGauge, WindowSample, velocity_field};
use super::*;
use crate::scaffold::THICKNESS;

#[test]
fn no_material_has_no_front() {
    let sim = simulation(0.02, [vec![], vec![]], vec![]);
    assert!(FrontGauge::new(1.0, 0.05).sample(&sim, &[]).x.is_nan());
    assert_eq!(StationGauge::new(0.0).sample(&sim, &[]), StationSample::default());
    assert!(velocity_field(&sim, &[]).is_empty());
}

#[test]
fn barriers_do_not_flow() {
    // The first body is the barrier, by its index or because it has no weight; it lies ahead and everywhere else.
    let grid = |k: i32| point(0.1 + 0.2 * f64::from(k), 0.1, [30.0, 40.0], 1.0);
    let light: Vec<Particle> = (0..20).map(grid).collect();
    let heavy = vec![point(1.0, 0.1, [3.0, 4.0], 1.0), point(1.05, 0.1, [3.0, 4.0], 1.0)];
    for weightless in [true, false] {
        let mut scene = scene_of(0.1, [light.clone(), heavy.clone()], vec![]);
        scene.bodies[0].0.weightless = weightless;
        let sim = Simulation::new(scene);
        let barrier: &[usize] = if weightless { &[] } else { &[0] };
        assert!(flowing(&sim, barrier).all(|(body, _)| body == 1) && flowing(&sim, barrier).count() == 2);
        let front = FrontGauge::new(1.0, 0.05).sample(&sim, barrier);
        assert!(front.x == 1.05 && front.velocity == 3.0, "{front:?}");
        let station = StationGauge::new(1.0).sample(&sim, barrier);
        assert!(
            close(station.depth, 2.0 * BODIES[1].1 / (0.2 * THICKNESS)) && close(station.velocity, 3.0),
            "{station:?}"
        );
        let window = WindowGauge::new([0.0, 5.0], [0.0, 1.0]).sample(&sim, barrier);
        assert_eq!(window, WindowSample { mean: 5.0, p95: 5.0 });
        let cells = velocity_field(&sim, barrier);
        assert!(cells.len() == 1 && close(cells[0].v[0], 3.0), "{cells:?}");
    }
}
