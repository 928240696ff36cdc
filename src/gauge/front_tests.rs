use super::super::flow::flowing;
use super::super::two_bodies::{BODIES, close, point, simulation};
use super::*;
use crate::body::Particle;
use crate::scaffold::THICKNESS;

/// Length behind the front, m.
const LENGTH: f64 = 0.05;

#[test]
fn front_is_where_one_percent_of_the_mass_has_passed() {
    // 300 kg: grains of 1 and 1 kg are not the front, the next of 2 kg is. The rest lies far behind.
    let light = vec![point(2.0, 0.0, [9.0, 1.0], 1.0), point(1.9, 0.0, [8.0, 1.0], 1.0)];
    let mut heavy = vec![
        point(1.5, 0.0, [7.0, 1.0], 1.0),
        // Within 0.05 m behind it, and just beyond.
        point(1.46, 0.0, [1.0, 0.0], 1.0),
        point(1.44, 0.0, [-50.0, 0.0], 1.0),
    ];
    heavy.extend((0..146).map(|k| point(1.0 - 1e-3 * f64::from(k), 0.0, [-100.0, 0.0], 1.0)));
    let sim = simulation(0.02, [light, heavy], vec![]);
    assert!(close(sim.mass(), 300.0));
    // What is left of another look, also of one farther ahead, does not matter.
    let mut gauge = FrontGauge { begin: 1.7, ..FrontGauge::new(1.0, LENGTH) };
    let front = gauge.sample(&sim, &[]);
    assert_eq!((front.x, front.edge), (1.5, 2.0));
    assert!(close(front.velocity, (9.0 + 8.0 + 2.0 * 7.0 + 2.0 * 1.0) / 6.0), "{front:?}");
}

#[test]
fn where_nothing_flows_the_front_has_passed_no_place() {
    let sim = simulation(0.02, [vec![point(2.0, 0.0, [1.0, 0.0], 1.0)], vec![]], vec![]);
    for way in [1.0, -1.0] {
        let front = FrontGauge::new(way, LENGTH).sample(&sim, &[0]);
        let passed = |x: &f64| way * front.x >= way * x || way * front.edge >= way * x;
        assert!(![-9.0, 0.0, 9.0].iter().any(passed), "{front:?}");
        assert!(front.velocity.is_nan() && front.depth == 0.0, "{front:?}");
    }
}

#[test]
fn the_front_of_a_thousand_points_is_the_tenth() {
    let points = (0..1000).map(|k| point(1e-3 * f64::from(k * 7 % 1000), 0.0, [1.0, 0.0], 1.0)).collect();
    let front = FrontGauge::new(1.0, LENGTH).sample(&simulation(0.02, [points, vec![]], vec![]), &[]);
    assert_eq!((front.x, front.edge), (0.99, 0.999));
}

#[test]
fn depth_of_the_front_is_that_of_the_fullest_strip() {
    // Strips of 0.04 m; 0.12 m of them count, as 0.1 m are 2.5. Volumes in units of a point's.
    let strip = |back: f64, ratios: &[f64]| -> Vec<Particle> {
        ratios.iter().map(|&r| point(1.5 - back, 0.0, [0.0; 2], r)).collect()
    };
    let deepest = |behind: &[(f64, &[f64])]| {
        let points = behind.iter().flat_map(|&(back, ratios)| strip(back, ratios)).collect();
        let sim = simulation(0.02, [points, vec![]], vec![]);
        let front = FrontGauge::new(1.0, LENGTH).sample(&sim, &[]);
        assert_eq!(front.x, 1.5);
        front.depth * 0.04 * THICKNESS / BODIES[0].1
    };
    // Torn material counts with a volume ratio of at most 1.5, dense material with its own.
    assert!(close(deepest(&[(0.0, &[1.0, 1.0]), (0.05, &[0.9, 1.2, 3.0]), (0.09, &[1.0])]), 3.6));
    assert!(close(deepest(&[(0.0, &[1.0, 0.5]), (0.03, &[1.0]), (0.05, &[1.0, 1.0])]), 2.5));
    assert!(close(deepest(&[(0.0, &[1.0]), (0.119, &[1.0, 1.0]), (0.121, &[1.0; 9])]), 2.0));
    // The far end of the last strip is open.
    let points = [strip(0.0, &[1.0]), strip(0.125, &[1.0])].concat();
    let sim = simulation(0.0625, [points, vec![]], vec![]);
    assert!(close(FrontGauge::new(1.0, LENGTH).sample(&sim, &[]).depth * 0.125 * THICKNESS, BODIES[0].1));
    // What is ahead of the front has no depth.
    let mut points = strip(0.0, &[1.0; 200]);
    points.extend(strip(-1.0, &[1.0, 1.0]));
    let sim = simulation(0.02, [points, vec![]], vec![]);
    let depth = FrontGauge::new(1.0, LENGTH).sample(&sim, &[]).depth;
    assert!(close(depth * 0.04 * THICKNESS, 200.0 * BODIES[0].1));
    // On a coarse grid one strip is left, wider than 0.1 m.
    let points = [strip(0.0, &[1.0]), strip(0.3, &[1.0])].concat();
    let sim = simulation(0.2, [points, vec![]], vec![]);
    assert!(close(FrontGauge::new(1.0, LENGTH).sample(&sim, &[]).depth * 0.4 * THICKNESS, 2.0 * BODIES[0].1));
}

/// The front as it was first written: all points in order.
fn front_of_all(simulation: &Simulation) -> Front {
    let mut all: Vec<(f64, f64, f64, f64)> = flowing(simulation, &[])
        .map(|(b, p)| {
            let body = &simulation.bodies()[b];
            (p.x[0], p.v[0], body.point_mass, body.point_volume * p.volume_ratio.min(MAX_VOLUME_RATIO))
        })
        .collect();
    all.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
    let mass: f64 = all.iter().map(|p| p.2).sum();
    let mut passed = 0.0;
    let first = all.iter().find(|p| {
        passed += p.2;
        passed >= FRONT_SHARE * mass
    });
    let x = first.map_or(0.0, |p| p.0);
    let (mut momentum, mut head) = (0.0, 0.0);
    for p in all.iter().take_while(|p| p.0 >= x - LENGTH) {
        momentum += p.2 * p.1;
        head += p.2;
    }
    let strip = 2.0 * simulation.spacing();
    let strips = (0.1 / strip).round().max(1.0) as usize;
    let mut volumes = vec![0.0; strips];
    for p in all.iter().skip_while(|p| p.0 > x).take_while(|p| p.0 > x - strips as f64 * strip) {
        volumes[(((x - p.0) / strip) as usize).min(strips - 1)] += p.3;
    }
    let depth = volumes.iter().fold(0.0, |a: f64, v| a.max(v / (strip * simulation.thickness())));
    Front { x, edge: all[0].0, velocity: momentum / head, depth }
}

#[test]
fn a_head_gives_what_all_points_in_order_give() {
    let mut state = 3u64;
    let mut uniform = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let (mut gauge, mut leftward) = (FrontGauge::new(1.0, LENGTH), FrontGauge::new(-1.0, LENGTH));
    for (k, counts) in [[1, 0], [7, 0], [300, 0], [2000, 0], [300, 200]].into_iter().enumerate() {
        for ties in [false, true] {
            let mut points = |count: usize| -> Vec<Particle> {
                let mut one = || {
                    let x = uniform() - 0.6;
                    let x = if ties { (50.0 * x).round() / 50.0 } else { x };
                    point(x, 0.2 * uniform(), [3.0 * uniform(), 0.0], 0.9 + uniform())
                };
                (0..count).map(|_| one()).collect()
            };
            let both = [points(counts[0]), points(counts[1])];
            let sim = simulation(0.02, both.clone(), vec![]);
            let front = gauge.sample(&sim, &[]);
            let of_all = front_of_all(&sim);
            assert_eq!((front.x, front.edge), (of_all.x, of_all.edge), "{k}, {ties}");
            assert!(close(front.velocity, of_all.velocity) && close(front.depth, of_all.depth), "{k}, {ties}");
            // The same flow to the left; sums come in another order.
            let mirrored = |points: &[Particle]| -> Vec<Particle> {
                points.iter().map(|p| Particle { x: [-p.x[0], p.x[1]], v: [-p.v[0], p.v[1]], ..*p }).collect()
            };
            let sim = simulation(0.02, both.each_ref().map(|p| mirrored(p)), vec![]);
            let left = leftward.sample(&sim, &[]);
            assert_eq!((left.x, left.edge), (-front.x, -front.edge), "{k}, {ties}");
            assert!(close(left.velocity, front.velocity) && close(left.depth, front.depth), "{k}, {ties}");
        }
    }
}
