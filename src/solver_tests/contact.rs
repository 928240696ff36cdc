//! Bodies in contact: two halves that stick are one body, and an impact is that of two masses.

use super::*;
use crate::body::Particle;
use crate::boundary::Friction;
use crate::contact::rule::{ContactRule, GapRule, NormalRule};
use crate::scaffold::{THICKNESS, elastic, points_by_number, run_until};
use crate::simulation::{AccelerationField, PicShare, Scheme};
use nalgebra::Vector2;
use std::sync::Arc;

fn rule(friction: f64, normal: NormalRule, gap: GapRule) -> ContactRule {
    ContactRule { bodies: [0, 1], friction, normal, gap }
}

/// The same scene with its points in two bodies: the first has those for which `first` holds, and its points keep their numbers.
fn in_two(mut scene: Scene, rule: ContactRule, first: impl Fn(&Particle) -> bool) -> Scene {
    let (body, points) = scene.bodies.pop().unwrap();
    let (a, b): (Vec<_>, Vec<_>) = points.into_iter().partition(first);
    scene.bodies = vec![(body.clone(), a), (body, b)];
    scene.contacts = vec![rule];
    scene
}

/// A part of the block below, and the normal out of it.
type Cut = (fn(&Particle) -> bool, [f64; 2]);
const CUTS: [Cut; 2] = [(|p| p.x[1] < 0.3, [0.0, 1.0]), (|p| p.x[0] < 4.0, [1.0, 0.0])];

/// A block that is compressed by its own motion, to the left and down, and wide enough for several bands.
fn squeezed(scheme: Scheme, boundaries: Vec<Boundary>) -> Scene {
    let brick = Brick::new([0.0; 2], [80, 6], H);
    let mut points = brick.points();
    points.iter_mut().for_each(|p| p.v = [-0.5 * p.x[0], -2.0 * p.x[1] + 0.05 * p.x[0]]);
    let law = AnyLaw::LinearElastic(LinearElastic::new(1e5, 0.2));
    let mut scene = scene(&brick, law, DENSITY, points, boundaries);
    scene.numerics.max_time_step = DT;
    scene.numerics.scheme = scheme;
    // A velocity that a point carries by itself is not the same in one field as in two.
    scene.numerics.pic = PicShare::Fraction(1.0);
    scene
}

fn forced(scene: Scene) -> Simulation {
    let mut sim = Simulation::new(scene);
    sim.set_damping(5.0);
    sim.set_field(Some(AccelerationField(Arc::new(|p: &Particle, _| [3.0 * p.x[1], -2.0]))));
    sim.set_gravity([0.3, -1.0]);
    sim.open_ledger();
    stepped(sim, 3)
}

#[test]
fn two_halves_that_stick_are_one_body() {
    let floor = || Boundary::plane("floor", Vector2::zeros(), Vector2::new(0.0, 1.0), Friction::Coulomb(0.3));
    let clamp = || Boundary::plane("clamp", Vector2::new(0.15, 0.0), Vector2::new(1.0, 0.0), Friction::Bonded);
    for scheme in [Scheme::Usl, Scheme::Musl] {
        for boundaries in [vec![], vec![floor()], vec![clamp()]] {
            let whole = forced(squeezed(scheme, boundaries.clone()));
            let expected = points_by_number(&whole);
            for (cut, normal) in CUTS {
                let stick = rule(f64::INFINITY, NormalRule::Prescribed(normal), GapRule::Approach);
                let halves = forced(in_two(squeezed(scheme, boundaries.clone()), stick, cut));
                assert!(halves.contact_points().len() > 3);
                for (a, b) in expected.iter().zip(points_by_number(&halves)) {
                    for d in 0..2 {
                        assert!(
                            (a.x[d] - b.x[d]).abs() < 1e-8 && (a.v[d] - b.v[d]).abs() < 1e-6,
                            "{scheme:?} {normal:?} {boundaries:?} {a:?} {b:?}"
                        );
                    }
                    let (s, t) = (a.state.stress, b.state.stress);
                    let off = (s.xx - t.xx).abs() + (s.yy - t.yy).abs() + (s.zz - t.zz).abs() + (s.xy - t.xy).abs();
                    assert!(off < 1e-2, "{scheme:?} {normal:?}: {a:?} {b:?}");
                }
                let (one, two) = (whole.ledger(), halves.ledger());
                let drags = [(one.damping, two.damping), (one.field, two.field)];
                let mut pairs: Vec<[f64; 2]> = Vec::new();
                for (a, b) in drags {
                    pairs.extend([[a.impulse[0], b.impulse[0]], [a.impulse[1], b.impulse[1]]]);
                }
                for (a, b) in one.boundaries.iter().zip(&two.boundaries) {
                    pairs.extend([[a.impulse[0], b.impulse[0]], [a.impulse[1], b.impulse[1]], [a.moment, b.moment]]);
                }
                for [a, b] in pairs {
                    assert!((a - b).abs() < 1e-8 * (1.0 + a.abs()), "{scheme:?} {normal:?}: {a} {b}");
                }
                books_balance(&halves);
            }
        }
    }
}

/// A block of 4 by 3 cells that comes with `v` from the left on one at rest, `gap` (m) away; `turns` quarter turns of all that.
fn impact(v: [f64; 2], gap: f64, turns: usize, rule: ContactRule) -> Scene {
    let turned = |x: [f64; 2]| (0..turns).fold(x, |[x, y], _| [-y, x]);
    let mut scene = block([0.0; 2], vec![]);
    let (body, points) = scene.bodies.pop().unwrap();
    let placed = |dx: f64, v: [f64; 2]| -> Vec<Particle> {
        let moved = |p: &Particle| Particle { x: turned([p.x[0] + dx, p.x[1]]), v: turned(v), ..*p };
        points.iter().map(moved).collect()
    };
    scene.bodies = vec![(body.clone(), placed(-4.0 * H - gap, v)), (body, placed(0.0, [0.0; 2]))];
    let normal = match rule.normal {
        NormalRule::Prescribed(n) => NormalRule::Prescribed(turned(n)),
        other => other,
    };
    scene.contacts = vec![ContactRule { normal, ..rule }];
    scene
}

const RULES: [NormalRule; 6] = [
    NormalRule::Prescribed([1.0, 0.0]),
    NormalRule::LargerBody,
    NormalRule::Average,
    NormalRule::Regression,
    NormalRule::NearestFace(0),
    NormalRule::NearestFace(1),
];

#[test]
fn every_normal_finds_the_face_between_two_blocks() {
    for turns in 0..4 {
        for normal in RULES {
            let mut sim = Simulation::new(impact([1.0, 0.0], 0.0, turns, rule(0.2, normal, GapRule::Approach)));
            assert_eq!(sim.contacts().count(), 1);
            sim.step().unwrap();
            let tally = *sim.contact_tallies().next().unwrap();
            let [n, t] = [[1.0, 0.0], [0.0, 1.0]].map(|x| (0..turns).fold(x, |[x, y]: [f64; 2], _| [-y, x]));
            let along = |p: [f64; 2], n: [f64; 2]| p[0] * n[0] + p[1] * n[1];
            // The nodes between carry half a cell of either block, and both stop at half of the speed.
            let mass = 0.5 * H * 3.0 * H * DENSITY * THICKNESS;
            let p = tally.exchange.impulse;
            if normal == NormalRule::LargerBody {
                // At the ends of the face the gradient of one body alone turns around its corner.
                assert!(along(p, n) < 0.5 * mass && along(p, n) > 0.4 * mass && along(p, t).abs() < 1e-12);
                continue;
            }
            assert!(close(along(p, n), 0.5 * mass) && along(p, t).abs() < 1e-8, "{turns} {normal:?}: {p:?}");
            let (normal_work, friction_work) = (tally.exchange.normal_work, tally.exchange.friction_work);
            assert!((normal_work + 0.25 * mass).abs() < 1e-8 && friction_work.abs() < 1e-8);
            assert_eq!(tally.nodes as usize, sim.contact_points().len());
            let pressed = sim.contact_points().iter().filter(|at| along(at.impulse, n) > 1e-9);
            assert_eq!(pressed.count(), 4);
            assert!(close(tally.moment, -1.5 * H * 0.5 * mass), "{turns} {normal:?}: {}", tally.moment);
            let mut sum = [0.0; 2];
            for at in sim.contact_points() {
                assert_eq!(at.contact, 0);
                let straight = along(at.normal, n) > 1.0 - 1e-9 && along(at.x, n).abs() < 1e-12;
                assert!(straight || along(at.impulse, n) < 1e-9, "{turns} {normal:?}: {at:?}");
                (0..2).for_each(|d| sum[d] += at.impulse[d]);
            }
            assert!((0..2).all(|d| (sum[d] - p[d]).abs() < 1e-12));
            assert_eq!(sim.ledger().contacts[0], tally);
            assert!(close(sim.ledger().impulse_scale, p[0].abs() + p[1].abs()));
            books_balance(&sim);
        }
    }
}

#[test]
fn friction_takes_its_share_of_the_pressure_and_can_be_changed() {
    for turns in 0..4 {
        for (mu, share, sliding) in [(0.2, 0.1, 0.3), (f64::INFINITY, 0.25, 0.0)] {
            for normal in [NormalRule::Average, NormalRule::NearestFace(1)] {
                let mut sim = Simulation::new(impact([1.0, 0.5], 0.0, turns, rule(0.7, normal, GapRule::Extents)));
                sim.set_contact_friction(0, mu);
                assert_eq!(sim.contacts().next().unwrap().friction, mu);
                sim.step().unwrap();
                let [n, t] = [[1.0, 0.0], [0.0, 1.0]].map(|x| (0..turns).fold(x, |[x, y]: [f64; 2], _| [-y, x]));
                let along = |p: [f64; 2], n: [f64; 2]| p[0] * n[0] + p[1] * n[1];
                let mass = 0.5 * H * 3.0 * H * DENSITY * THICKNESS;
                let done = sim.contact_tallies().next().unwrap().exchange;
                assert!((along(done.impulse, n) - 0.5 * mass).abs() < 1e-9, "{done:?}");
                assert!((along(done.impulse, t) - share * mass).abs() < 1e-9, "{done:?}");
                // Sliding at 0.5 m/s before and `sliding` after.
                assert!((done.friction_work + share * mass * 0.5 * (0.5 + sliding)).abs() < 1e-9, "{done:?}");
            }
        }
    }
}

#[test]
fn what_a_clamped_body_takes_goes_into_the_clamp() {
    for clamped in [0, 1] {
        let mut scene = impact([1.0, 0.5], 0.0, 0, rule(0.2, NormalRule::NearestFace(1), GapRule::Extents));
        if clamped == 0 {
            scene.bodies.swap(0, 1);
        }
        let clamp = Boundary::plane("clamp", Vector2::new(-1.0, 0.0), Vector2::new(-1.0, 0.0), Friction::Bonded);
        scene.boundaries = vec![clamp.only_for(&[clamped])];
        let sim = run(scene, 1);
        let mass = 0.5 * H * 3.0 * H * DENSITY * THICKNESS;
        let tally = sim.contact_tallies().next().unwrap().exchange;
        let sign = if clamped == 1 { 1.0 } else { -1.0 };
        let expected = [sign * mass, sign * 0.2 * mass];
        assert!((0..2).all(|d| (tally.impulse[d] - expected[d]).abs() < 1e-9), "{tally:?}");
        let taken = sim.ledger().boundaries[0].impulse;
        assert!((taken[0] + mass).abs() < 1e-9 && (taken[1] + 0.2 * mass).abs() < 1e-9, "{taken:?}");
        assert!(sim.particles().all(|(body, p)| body != clamped || p.v == [0.0; 2]));
        books_balance(&sim);
    }
}

#[test]
fn bodies_that_part_move_as_if_they_were_alone() {
    // Side walls, damping, a field, gravity and a floor with friction, but nothing between the bodies.
    let floor = || Boundary::plane("floor", Vector2::zeros(), Vector2::new(0.0, 1.0), Friction::Coulomb(0.3));
    for scheme in [Scheme::Usf, Scheme::Usl, Scheme::Musl] {
        for (cut, n) in CUTS {
            let mut both = squeezed(scheme, vec![floor()]);
            both.numerics.pic = PicShare::Fraction(0.1);
            both.side_wall_friction = 0.2;
            for p in &mut both.bodies[0].1 {
                let away = if cut(p) { -0.5 } else { 0.5 };
                p.v = [away * n[0] + 0.1, away * n[1] - 0.2];
                p.state.stress.zz = -500.0;
            }
            let touching = rule(0.3, NormalRule::Prescribed(n), GapRule::Approach);
            let both = in_two(both, touching, cut);
            let alone = |k: usize| {
                let mut scene = both.clone();
                scene.bodies = vec![scene.bodies.swap_remove(k)];
                scene.contacts.clear();
                forced(scene)
            };
            let (a, b, sim) = (alone(0), alone(1), forced(both.clone()));
            assert!(sim.contact_points().is_empty());
            let of = |k: usize| sim.particles().filter(move |(body, _)| *body == k).map(|(_, p)| p).collect::<Vec<_>>();
            for (found, alone) in [(of(0), &a), (of(1), &b)] {
                let mut found = found;
                found.sort_by_key(|p| p.id);
                assert_eq!(found, points_by_number(alone), "{scheme:?} {n:?}");
            }
            let sum = |f: &dyn Fn(&Simulation) -> [f64; 3]| {
                let (a, b, both) = (f(&a), f(&b), f(&sim));
                (0..3).for_each(|d| {
                    assert!((both[d] - a[d] - b[d]).abs() < 1e-11 * (1.0 + both[d].abs()), "{scheme:?} {n:?}")
                });
                assert!(both[2] != 0.0);
            };
            sum(&|s| [s.ledger().damping.impulse[0], s.ledger().damping.impulse[1], s.ledger().damping.work]);
            sum(&|s| [s.ledger().side_walls.impulse[0], s.ledger().side_walls.impulse[1], s.ledger().side_walls.work]);
            sum(&|s| [s.ledger().field.impulse[0], s.ledger().field.impulse[1], s.ledger().field.work]);
            sum(&|s| {
                [
                    s.ledger().boundaries[0].impulse[0],
                    s.ledger().boundaries[0].impulse[1],
                    s.ledger().boundaries[0].moment,
                ]
            });
            sum(&|s| [s.ledger().pic_loss, s.ledger().internal_work, s.stock().kinetic]);
        }
    }
}

#[test]
fn bodies_touch_again_when_the_gap_is_closed() {
    // The first body leaves with 5 m/s, is turned around by 200 m/s2 and is back where it touched after 50 steps; its approach
    // begins after 25.
    for turns in [0, 3] {
        for (normal, gap, earliest, latest) in [
            (NormalRule::Average, GapRule::Approach, 25, 27),
            (NormalRule::Average, GapRule::POSITIONS, 40, 52),
            (NormalRule::Prescribed([1.0, 0.0]), GapRule::Displacements, 49, 51),
            (NormalRule::Average, GapRule::Extents, 47, 51),
            (NormalRule::Regression, GapRule::Extents, 49, 51),
            (NormalRule::NearestFace(0), GapRule::Extents, 49, 51),
            (NormalRule::NearestFace(1), GapRule::Extents, 49, 51),
        ] {
            let mut scene = impact([-5.0, 0.0], 0.0, turns, rule(0.0, normal, gap));
            scene.bodies[1].1.iter_mut().for_each(|p| p.id += 1000);
            let mut sim = Simulation::new(scene);
            let a = (0..turns).fold([200.0, 0.0], |[x, y]: [f64; 2], _| [-y, x]);
            let pull = move |p: &Particle, _| if p.id < 1000 { a } else { [0.0; 2] };
            sim.set_field(Some(AccelerationField(Arc::new(pull))));
            let first = (1..60).find(|_| {
                sim.step().unwrap();
                let p = sim.contact_tallies().next().unwrap().exchange.impulse;
                p[0].hypot(p[1]) > 1e-6
            });
            assert!(first.is_some_and(|k| (earliest..=latest).contains(&k)), "{turns} {normal:?} {gap:?}: {first:?}");
        }
    }
}

/// A block of 8 by 4 cells at rest on an elastic base as wide: what the base feels is the weight over the area, and friction has
/// nothing to hold. A density or an area that is 3 % off fails.
#[test]
fn traction_on_a_base_is_the_weight_over_the_area() {
    let (h, g, density) = (0.05, 9.81, 1500.0);
    let lower = Brick::new([1.0, 1.0], [8, 4], h);
    let upper = Brick::new([1.0, 1.0 + 4.0 * h], [8, 4], h);
    let floor = Boundary::plane("floor", Vector2::new(0.0, 1.0), Vector2::new(0.0, 1.0), Friction::Smooth);
    let law = elastic(1e6, 0.0);
    let mut scene = scene(&lower, law, density, lower.points(), vec![floor]);
    scene.bodies.push((upper.body(law, density), upper.points()));
    scene.contacts = vec![ContactRule::with_structure(0, 1, 0.3)];
    scene.gravity = [0.0, -g];
    scene.numerics.pic = PicShare::Fraction(0.01);
    let mut sim = Simulation::new(scene);
    sim.set_damping(60.0);
    run_until(&mut sim, 1.0).expect("it runs");
    sim.step().expect("a step");
    let (dt, points) = (sim.time_step().dt, sim.contact_points());
    let area: f64 = points.iter().map(|p| p.area).sum();
    let [pressure, shear] = [0, 1].map(|k| points.iter().map(|p| p.area * p.traction(dt)[k]).sum::<f64>() / area);
    // Under its weight the surface sinks by some hundredths of a cell, and its nodes no longer see two equal halves.
    assert!((area / (8.0 * h * THICKNESS) - 1.0).abs() < 0.02, "{area} m2");
    assert!((pressure / (density * g * 4.0 * h) - 1.0).abs() < 0.02, "{pressure} Pa");
    assert!(shear.abs() < 1e-3 * pressure, "{shear} Pa");
    // The nodes in the middle of the surface.
    let inner = points.iter().filter(|p| (p.x[0] - 1.2).abs() < 0.11 && p.x[1] > 1.0 + 3.9 * h);
    inner.for_each(|p| assert!((p.area / (h * THICKNESS) - 1.0).abs() < 0.02, "{p:?}"));
}
