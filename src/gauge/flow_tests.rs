use super::*;
use crate::body::{Body, Particle};
use crate::boundary::{Boundary, Friction, Opening};
use crate::constitutive::{AnyLaw, LinearElastic};
use crate::scaffold::{Brick, THICKNESS, scene};
use crate::simulation::Scene;
use nalgebra::Vector2;

/// Mass (kg) and volume (m3) of a point of the two bodies: what is weighted wrongly shows.
const BODIES: [(f64, f64); 2] = [(1.0, 3e-5), (2.0, 5e-5)];

fn point(x: f64, y: f64, v: [f64; 2], volume_ratio: f64) -> Particle {
    Particle { v, volume_ratio, ..Particle::at_rest(0, [x, y]) }
}

/// Points of two bodies on a grid of spacing `h`, without forces.
fn scene_of(h: f64, points: [Vec<Particle>; 2], boundaries: Vec<Boundary>) -> Scene {
    let brick = Brick::new([0.0; 2], [1, 1], h);
    let law = AnyLaw::LinearElastic(LinearElastic::new(1e4, 0.0));
    let mut scene = scene(&brick, law, 1000.0, Vec::new(), boundaries);
    scene.bodies = points
        .into_iter()
        .zip(BODIES)
        .map(|(points, (point_mass, point_volume))| {
            (Body { point_mass, point_volume, ..brick.body(law, 1000.0) }, points)
        })
        .collect();
    scene
}

fn simulation(h: f64, points: [Vec<Particle>; 2], boundaries: Vec<Boundary>) -> Simulation {
    Simulation::new(scene_of(h, points, boundaries))
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * b.abs().max(1.0)
}

/// A vertical wall at `x` from y = 0, 1 m high, with the material on its left.
fn wall(x: f64) -> Boundary {
    Boundary::wall("wall", Vector2::new(x, 0.0), Vector2::new(0.0, 1.0), 1.0, 0.1, Friction::Smooth)
}

#[test]
fn no_material_has_no_front() {
    let sim = simulation(0.02, [vec![], vec![]], vec![]);
    assert_eq!(front(&sim, &[], &mut FrontScratch::default()), Front::default());
    assert_eq!(stations(&sim, &[], &[0.0]), [(0.0, 0.0)]);
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
        let front = front(&sim, barrier, &mut FrontScratch::default());
        assert!(front.x == 1.05 && front.velocity == 3.0, "{front:?}");
        let station = stations(&sim, barrier, &[1.0])[0];
        assert!(close(station.0, 2.0 * BODIES[1].1 / (0.2 * THICKNESS)) && close(station.1, 3.0), "{station:?}");
        let window = Window { x: [0.0, 5.0], y: [0.0, 1.0] };
        assert_eq!(window_speed(&sim, barrier, &window, &mut Vec::new()), (5.0, 5.0));
        let cells = velocity_field(&sim, barrier);
        assert!(cells.len() == 1 && close(cells[0].v[0], 3.0), "{cells:?}");
    }
}

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
    let mut scratch = FrontScratch { keys: vec![5], order: vec![(5, 5)], found: vec![[5.0; 4]], head: vec![[5.0; 4]] };
    let front = front(&sim, &[], &mut scratch);
    assert_eq!(front.x, 1.5);
    assert!(close(front.velocity, (9.0 + 8.0 + 2.0 * 7.0 + 2.0 * 1.0) / 6.0), "{front:?}");
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
        let front = front(&sim, &[], &mut FrontScratch::default());
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
    assert!(close(front(&sim, &[], &mut FrontScratch::default()).depth * 0.125 * THICKNESS, BODIES[0].1));
    // What is ahead of the front has no depth.
    let mut points = strip(0.0, &[1.0; 200]);
    points.extend(strip(-1.0, &[1.0, 1.0]));
    let sim = simulation(0.02, [points, vec![]], vec![]);
    let depth = front(&sim, &[], &mut FrontScratch::default()).depth;
    assert!(close(depth * 0.04 * THICKNESS, 200.0 * BODIES[0].1));
    // On a coarse grid one strip is left, wider than 0.1 m.
    let points = [strip(0.0, &[1.0]), strip(0.3, &[1.0])].concat();
    let sim = simulation(0.2, [points, vec![]], vec![]);
    assert!(close(front(&sim, &[], &mut FrontScratch::default()).depth * 0.4 * THICKNESS, 2.0 * BODIES[0].1));
}

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
    let read = stations(&sim, &[], &[1.0, 10.0]);
    let volume = BODIES[0].1 * (1.0 + 1.5) + BODIES[1].1 * 1.1;
    assert!(close(read[0].0, volume / (0.5 * THICKNESS)), "{read:?}");
    assert!(close(read[0].1, (1.0 + 2.0 + 2.0 * 7.0) / 4.0), "{read:?}");
    assert_eq!(read[1], (0.0, 0.0));
}

#[test]
fn run_up_counts_at_the_face_and_overtopping_behind_it() {
    // Distances from the face of the wall at x = 1: positive to its left. Cells of 0.25 m.
    let light = vec![
        point(0.75, 0.4, [0.0; 2], 1.0),
        point(0.625, 0.6, [0.0; 2], 1.0),
        point(0.5, 0.9, [0.0; 2], 1.0),
        point(1.25, 0.7, [0.0; 2], 1.0),
        point(1.375, 0.8, [0.0; 2], 1.0),
    ];
    let heavy = vec![point(3.0, 0.95, [0.0; 2], 1.0)];
    let sim = simulation(0.25, [light, heavy], vec![wall(1.0)]);
    let state = wall_state(&sim, 0);
    // One cell behind the face is not yet behind the wall; 1.5 cells before it still is at the wall.
    assert_eq!(state, WallState { run_up: 0.7, overtopped: 3.0 });
}

#[test]
fn overtopping_keeps_count_of_what_left_the_domain() {
    let light = vec![point(2.0, 2.0, [10.0, 0.0], 1.0), point(2.0, 2.5, [0.0, 0.0], 1.0)];
    let heavy = vec![point(0.5, 2.0, [-10.0, 0.0], 1.0)];
    let mut scene = scene_of(0.1, [light, heavy], vec![wall(1.0)]);
    scene.domain = [[0.0, 3.0], [-1.0, 3.0]];
    let mut sim = Simulation::new(scene);
    assert_eq!(wall_state(&sim, 0).overtopped, 2.0);
    while sim.time() < 0.15 {
        sim.step().unwrap();
    }
    assert!(close(sim.mass(), 1.0), "two of three points have left");
    assert_eq!(wall_state(&sim, 0).overtopped, 2.0);
}

#[test]
fn penetration_finds_the_deepest_point_and_skips_gates_that_are_gone() {
    let plane = |y: f64| Boundary::plane("base", Vector2::new(0.0, y), Vector2::new(0.0, 1.0), Friction::Smooth);
    let points = vec![point(0.0, -0.25, [0.0; 2], 1.0), point(0.0, 0.5, [0.0; 2], 1.0)];
    let heavy = vec![point(0.0, -0.125, [0.0; 2], 1.0)];
    let sim = simulation(0.1, [points.clone(), heavy.clone()], vec![plane(-1.0), plane(0.0), plane(-0.0625)]);
    assert_eq!(penetration(&sim), (0.25, 1));
    for above in [-1.0, -0.25] {
        // On the surface is not inside.
        let sim = simulation(0.1, [points.clone(), heavy.clone()], vec![plane(-2.0), plane(above)]);
        assert_eq!(penetration(&sim), (0.0, 0));
    }
    let mut gate = plane(0.0).gate(Opening::Vanish);
    gate.release();
    let sim = simulation(0.1, [points.clone(), heavy.clone()], vec![gate, plane(-0.0625)]);
    assert_eq!(penetration(&sim), (0.1875, 1));
    let clamp = Boundary { friction: Friction::Bonded, ..plane(0.0) };
    let sim = simulation(0.1, [points, heavy], vec![clamp, plane(0.0).only_for(&[1])]);
    assert_eq!(penetration(&sim), (0.125, 1), "clamps hold what lies in them; others act on their bodies alone");
}

#[test]
fn window_takes_in_its_edges_and_nothing_else() {
    let window = Window { x: [1.0, 2.0], y: [3.0, 4.0] };
    for (x, inside) in [
        ([1.0, 3.0], true),
        ([2.0, 4.0], true),
        ([1.5, 3.5], true),
        ([0.99, 3.5], false),
        ([2.01, 3.5], false),
        ([1.5, 2.99], false),
        ([1.5, 4.01], false),
    ] {
        assert_eq!(window.contains(x), inside, "{x:?}");
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
    let mut scratch = vec![77.0];
    let (mean, high) = window_speed(&sim, &[], &Window { x: [0.0, 1.0], y: [0.0, 1.0] }, &mut scratch);
    assert!(close(mean, 10.0) && close(high, 19.0), "{mean} {high}");
    assert_eq!(window_speed(&sim, &[], &Window { x: [8.0, 9.0], y: [0.0, 1.0] }, &mut scratch), (0.0, 0.0));
}

#[test]
fn field_gives_the_mean_velocity_and_fill_of_each_cell() {
    // Cells (-1, 2), (2, -1), (2, 2); points of both bodies in the last.
    let light =
        vec![point(0.6, 0.6, [3.0, 0.0], 1.0), point(-0.1, 0.7, [5.0, 6.0], 1.0), point(0.7, -0.2, [7.0, 8.0], 9.0)];
    let mut heavy = vec![point(0.7, 0.7, [0.0, 3.0], 1.2)];
    (heavy[0].state.stress.xx, heavy[0].state.plastic_shear) = (-6.0, 9.0);
    let sim = simulation(0.25, [light, heavy], vec![]);
    let field = velocity_field(&sim, &[]);
    let cell_volume = 0.0625 * THICKNESS;
    let expected = [
        ([-0.125, 0.625], BODIES[0].1, [5.0, 6.0]),
        ([0.625, -0.125], 1.5 * BODIES[0].1, [7.0, 8.0]),
        ([0.625, 0.625], BODIES[0].1 + 1.2 * BODIES[1].1, [1.0, 2.0]),
    ];
    assert_eq!(field.len(), 3);
    for (cell, (x, volume, v)) in field.iter().zip(expected) {
        assert!(close(cell.x[0], x[0]) && close(cell.x[1], x[1]), "{cell:?}");
        assert!(close(cell.fill, volume / cell_volume), "{cell:?}");
        assert!(close(cell.v[0], v[0]) && close(cell.v[1], v[1]), "{cell:?}");
    }
    // The heavy point is two thirds of the mass of the last cell; its mean stress is a third of -6 Pa.
    assert!(
        close(field[2].pressure, 2.0 * 2.0 / 3.0) && close(field[2].plastic_shear, 9.0 * 2.0 / 3.0),
        "{:?}",
        field[2]
    );
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
    for p in all.iter().take_while(|p| p.0 >= x - FRONT_LENGTH) {
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
    Front { x, velocity: momentum / head, depth }
}

#[test]
fn a_head_in_order_gives_the_bits_of_all_points_in_order() {
    let mut state = 3u64;
    let mut uniform = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut scratch = FrontScratch::default();
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
            let sim = simulation(0.02, [points(counts[0]), points(counts[1])], vec![]);
            assert_eq!(front(&sim, &[], &mut scratch), front_of_all(&sim), "{k}, {ties}");
        }
    }
}
