use super::super::two_bodies::{BODIES, point, scene_of};
use super::*;
use crate::body::Particle;
use crate::boundary::{Boundary, Friction};
use nalgebra::Vector2;

/// A vertical wall at x = 1 from y = 0, 1 m high, with the material on its left; it holds nothing back.
fn wall() -> Boundary {
    Boundary::wall("wall", Vector2::new(1.0, 0.0), Vector2::new(0.0, 1.0), 1.0, 0.1, Friction::Smooth).only_for(&[9])
}

/// Points that fly past each other in straight lines, on cells of 0.1 m.
fn fly(points: &[Particle], body: usize) -> Simulation {
    let mut bodies = [Vec::new(), Vec::new()];
    bodies[body] = points.iter().enumerate().map(|(k, p)| Particle { id: k as u32, ..*p }).collect();
    let mut scene = scene_of(0.1, bodies, vec![wall()]);
    scene.domain = [[-3.0, 3.0], [-3.0, 5.0]];
    scene.numerics.max_time_step = 2e-3;
    Simulation::new(scene)
}

/// What has passed after 0.1 s at 10 m/s, seen after every so many steps.
fn passed(points: &[Particle], body: usize, every: u64) -> Passage {
    let mut sim = fly(points, body);
    let mut gauge = PassageGauge::new(&sim, 0, &[]);
    while sim.time() < 0.1 {
        sim.step().expect("a step");
        gauge.after_step(&sim);
        if sim.steps().is_multiple_of(every) {
            gauge.sample(&sim);
        }
    }
    gauge.sample(&sim)
}

#[test]
fn the_way_is_that_at_the_face() {
    let go = |x: f64, y: f64, slope: f64| point(x, y, [10.0, 10.0 * slope], 1.0);
    for (body, (mass, _)) in BODIES.into_iter().enumerate() {
        let of = |over: f64, under: f64, past: f64| Passage { over, under, past }.scaled(mass);
        for (points, expected) in [
            (vec![go(0.5, 1.3, 0.0)], of(1.0, 0.0, 1.0)),
            (vec![go(0.5, -0.3, 0.0)], of(0.0, 1.0, 1.0)),
            (vec![go(0.5, 0.5, 0.0)], of(0.0, 0.0, 1.0)),
            // It goes up or down at the face, where it is 3 or 7 cm below the crest: half a cell is 5 cm.
            (vec![go(0.5, 0.47, 1.0)], of(1.0, 0.0, 1.0)),
            (vec![go(0.5, 0.43, 1.0)], of(0.0, 0.0, 1.0)),
            (vec![go(0.5, 1.47, -1.0)], of(1.0, 0.0, 1.0)),
            (vec![go(0.5, 1.43, -1.0)], of(0.0, 0.0, 1.0)),
            // The foot.
            (vec![go(0.5, 0.53, -1.0)], of(0.0, 1.0, 1.0)),
            (vec![go(0.5, 0.57, -1.0)], of(0.0, 0.0, 1.0)),
            // It does not get there; it gets no farther than half a cell.
            (vec![go(-0.5, 2.0, 0.0), go(0.05, 1.3, 0.0)], of(0.0, 0.0, 0.0)),
            // It was there before; it came back.
            (vec![go(1.5, 0.3, 0.0)], of(0.0, 0.0, 0.0)),
            (vec![point(1.5, 0.3, [-10.0, 0.0], 1.0)], of(0.0, 0.0, 0.0)),
            // It leaves the domain.
            (vec![point(0.5, 2.0, [30.0, 0.0], 1.0), go(0.5, -1.0, 0.0)], of(1.0, 1.0, 2.0)),
        ] {
            for every in [1, 7, u64::MAX] {
                assert_eq!(passed(&points, body, every), expected, "{points:?} {every}");
            }
        }
    }
}

#[test]
fn what_comes_back_has_not_passed() {
    let mut sim = fly(&[point(0.9, 1.3, [10.0, 0.0], 1.0)], 0);
    let mut gauge = PassageGauge::new(&sim, 0, &[]);
    let mut fly_until = |time: f64, field: f64| {
        sim.set_gravity([field, 0.0]);
        while sim.time() < time {
            sim.step().expect("a step");
            gauge.after_step(&sim);
        }
        gauge.sample(&sim)
    };
    assert_eq!(fly_until(0.05, 0.0).over, 1.0);
    // Forty centimetres behind, it turns back: v t - g t^2 / 2.
    assert_eq!(fly_until(0.2, -200.0), Passage::default());
}

#[test]
fn structures_do_not_count() {
    let mut sim = fly(&[point(0.5, 1.3, [10.0, 0.0], 1.0)], 1);
    let mut gauges = [vec![], vec![0], vec![1]].map(|structures: Vec<usize>| PassageGauge::new(&sim, 0, &structures));
    while sim.time() < 0.1 {
        sim.step().expect("a step");
        gauges.iter_mut().for_each(|g| g.after_step(&sim));
    }
    assert_eq!(gauges.map(|g| g.sample(&sim).past), [2.0, 2.0, 0.0]);
}

impl Passage {
    fn scaled(self, by: f64) -> Self {
        Self { over: by * self.over, under: by * self.under, past: by * self.past }
    }
}
