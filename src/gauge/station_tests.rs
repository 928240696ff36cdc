use super::super::two_bodies::{BODIES, close, point, simulation};
use super::*;
use crate::scaffold::THICKNESS;

#[test]
fn stations_measure_volume_and_mean_velocity() {
    let light = vec![
        point(0.75, 0.0, [1.0, 9.0], 1.0),
        point(1.25, 0.3, [2.0, 9.0], 2.0),
        point(1.26, 0.3, [70.0, 9.0], 1.0),
        point(0.74, 0.3, [70.0, 9.0], 1.0),
    ];
    let heavy = vec![point(1.0, 0.1, [7.0, 0.0], 1.1)];
    let sim = simulation(0.25, [light, heavy], vec![]);
    let read = [1.0, 10.0].map(|x| StationGauge::new(x).sample(&sim, &[]));
    let volume = BODIES[0].1 * (1.0 + 1.5) + BODIES[1].1 * 1.1;
    assert!(close(read[0].depth, volume / (0.5 * THICKNESS)), "{read:?}");
    assert!(close(read[0].velocity, (1.0 + 2.0 + 2.0 * 7.0) / 4.0), "{read:?}");
    assert_eq!(read[1], StationSample { x: 10.0, depth: 0.0, velocity: 0.0 });
}
