use super::super::two_bodies::{close, point, simulation};
use super::*;

#[test]
fn window_takes_in_its_edges_and_nothing_else() {
    let mut gauge = WindowGauge::new([1.0, 2.0], [3.0, 4.0]);
    for (x, inside) in [
        ([1.0, 3.0], true),
        ([2.0, 4.0], true),
        ([1.5, 3.5], true),
        ([0.99, 3.5], false),
        ([2.01, 3.5], false),
        ([1.5, 2.99], false),
        ([1.5, 4.01], false),
    ] {
        let sim = simulation(0.1, [vec![point(x[0], x[1], [3.0, 4.0], 1.0)], vec![]], vec![]);
        assert_eq!(gauge.sample(&sim, &[]).mean, if inside { 5.0 } else { 0.0 }, "{x:?}");
    }
}

#[test]
fn window_speeds_are_mean_and_ninety_fifth_percentile() {
    // Speeds 0 ... 20 m/s in another order, in all directions; and one outside.
    let inside = (0..21).map(|k| {
        let speed = f64::from(k * 8 % 21);
        point(0.5, 0.5, [0.6 * speed, -0.8 * speed], 1.0)
    });
    let sim = simulation(0.1, [inside.collect(), vec![point(5.0, 0.5, [1e3, 0.0], 1.0)]], vec![]);
    let mut gauge = WindowGauge { speeds: vec![77.0], ..WindowGauge::new([0.0, 1.0], [0.0, 1.0]) };
    for _ in 0..2 {
        let read = gauge.sample(&sim, &[]);
        assert!(close(read.mean, 10.0) && close(read.p95, 19.0), "{read:?}");
    }
    assert_eq!(WindowGauge::new([8.0, 9.0], [0.0, 1.0]).sample(&sim, &[]), WindowSample::default());
}
