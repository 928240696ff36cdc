//! The law at a node against closed forms and its own conditions.

use crate::contact::Vector;
use crate::contact::node::{project, solve, solve_held};
use crate::contact::pair::{Exchange, State, Touch};
use crate::contact::side::Side;
use crate::scaffold::Lcg;
use crate::space::{dot, minus};

fn side(mass: f64, old: Vector, velocity: Vector) -> Side {
    Side { mass, old, velocity, fixed: false, held: false }
}

fn momentum(sides: &[Side]) -> Vector {
    let sum = |d: usize| sides.iter().map(|s| s.mass * s.velocity[d]).sum();
    [sum(0), sum(1)]
}

fn kinetic(sides: &[Side]) -> f64 {
    sides.iter().map(|s| 0.5 * s.mass * dot(s.velocity, s.velocity)).sum()
}

/// Bodies, touches between all of them with normals of any direction, and velocities that other agents have changed.
fn random(rng: &mut Lcg, bodies: usize) -> (Vec<Side>, Vec<Touch>) {
    let mut vector = |scale: f64| [scale * rng.signed(), scale * rng.signed()];
    let sides: Vec<Side> = (0..bodies).map(|_| side(1.0, vector(1.0), vector(1.0))).collect();
    let sides: Vec<Side> = sides.into_iter().map(|s| Side { mass: 0.1 + 2.0 * rng.unit(), ..s }).collect();
    let mut touches = Vec::new();
    for a in 0..bodies {
        for b in a + 1..bodies {
            let angle = 4.0 * rng.signed();
            touches.push(Touch::new([a, b], [libm::cos(angle), libm::sin(angle)], rng.unit()));
        }
    }
    (sides, touches)
}

#[test]
fn impact_without_friction_is_that_of_newton() {
    let (m1, m2, v) = (2.0, 3.0, [4.0, 1.0]);
    let mut sides = [side(m1, v, v), side(m2, [0.0; 2], [0.0; 2])];
    let mut touches = [Touch::new([0, 1], [1.0, 0.0], 0.0)];
    solve(&mut sides, &mut touches);
    let common = m1 * v[0] / (m1 + m2);
    for (side, along) in sides.iter().zip([v[1], 0.0]) {
        assert!((side.velocity[0] - common).abs() < 1e-15 && side.velocity[1] == along);
    }
    let reduced = m1 * m2 / (m1 + m2);
    let e = touches[0].exchange(&sides);
    assert!((e.impulse[0] - reduced * v[0]).abs() < 1e-15 && e.impulse[1] == 0.0);
    assert!((e.normal_work + 0.5 * reduced * v[0] * v[0]).abs() < 1e-14, "the loss of a plastic impact");
    assert_eq!((e.friction_work, touches[0].state()), (0.0, State::Slipping));
}

#[test]
fn exchanges_add_up() {
    let mut sum = Exchange { impulse: [1.0, 2.0], friction_work: 3.0, normal_work: 4.0 };
    sum.add(&Exchange { impulse: [10.0, 20.0], friction_work: 30.0, normal_work: 40.0 });
    assert_eq!(sum, Exchange { impulse: [11.0, 22.0], friction_work: 33.0, normal_work: 44.0 });
}

#[test]
fn a_solution_does_not_depend_on_the_last() {
    let mut rng = Lcg::new(23);
    for bodies in [2, 2, 2, 2, 3, 4] {
        let (sides, mut touches) = random(&mut rng, bodies);
        let (mut first, mut second) = (sides.clone(), sides);
        solve(&mut first, &mut touches);
        let solved = touches.clone();
        solve(&mut second, &mut touches);
        assert_eq!((first, solved), (second, touches));
    }
}

#[test]
fn without_friction_nothing_sticks_even_where_nothing_slides() {
    let mut sides = [side(1.0, [1.0, 0.0], [1.0, 0.0]), side(1.0, [0.0; 2], [0.0; 2])];
    let mut touches = [Touch::new([0, 1], [1.0, 0.0], 0.0)];
    solve(&mut sides, &mut touches);
    assert_eq!(touches[0].state(), State::Slipping);
    sides[0].velocity = [1.0, 3.0];
    sides[1].velocity = [0.0, 1.0];
    project(&mut sides, &touches);
    assert_eq!(sides.map(|s| s.velocity), [[0.5, 3.0], [0.5, 1.0]]);
}

#[test]
fn bodies_that_part_or_have_not_met_are_left_alone() {
    for (velocity, slack) in [([-0.1, 5.0], 0.0), ([0.0, 5.0], 0.0), ([0.3, 5.0], 0.3)] {
        let start = [side(1.0, velocity, velocity), side(2.0, [0.0; 2], [0.0; 2])];
        let mut sides = start;
        let mut touches = [Touch::new([0, 1], [1.0, 0.0], f64::INFINITY).with_slack(slack)];
        solve(&mut sides, &mut touches);
        assert_eq!(sides, start);
        assert_eq!(touches[0].exchange(&sides), Exchange::default());
        project(&mut sides, &touches);
        assert_eq!(sides, start);
    }
}

#[test]
fn a_gap_is_closed_and_no_further() {
    let mut sides = [side(1.0, [1.0, 0.0], [1.0, 0.0]), side(1.0, [0.0; 2], [0.0; 2])];
    let mut touches = [Touch::new([0, 1], [1.0, 0.0], 0.0).with_slack(0.4)];
    solve(&mut sides, &mut touches);
    assert!((sides[0].velocity[0] - sides[1].velocity[0] - 0.4).abs() < 1e-15);
}

#[test]
fn friction_sticks_up_to_its_coefficient_and_slips_beyond() {
    // Approach 1 across, sliding 0.5 along: sticks for mu > 0.5.
    for (mu, state, left) in [(0.3, State::Slipping, 0.2), (0.49, State::Slipping, 0.01), (0.51, State::Sticking, 0.0)]
    {
        for turn in [0.0, 0.7, 2.5, -1.9] {
            let n = [libm::cos(turn), libm::sin(turn)];
            let t = [n[1], -n[0]];
            let v = [n[0] + 0.5 * t[0], n[1] + 0.5 * t[1]];
            let mut sides = [side(1.0, v, v), side(3.0, [0.0; 2], [0.0; 2])];
            let mut touches = [Touch::new([0, 1], n, mu)];
            solve(&mut sides, &mut touches);
            let relative = minus(sides[0].velocity, sides[1].velocity);
            assert!(dot(relative, n).abs() < 1e-15);
            assert!((dot(relative, t) - left).abs() < 1e-15, "{mu}: {}", dot(relative, t));
            assert_eq!(touches[0].state(), state);
            let e = touches[0].exchange(&sides);
            let slid = 0.5 * (0.5 + left);
            assert!((e.friction_work + 0.75 * (0.5 - left) * slid).abs() < 1e-15);
        }
    }
}

#[test]
fn momentum_is_kept_and_work_is_the_change_of_kinetic_energy() {
    let mut rng = Lcg::new(7);
    for bodies in [2, 2, 2, 3, 4] {
        for _ in 0..200 {
            let (mut sides, mut touches) = random(&mut rng, bodies);
            let free = sides.clone();
            solve(&mut sides, &mut touches);
            let (before, after) = (momentum(&free), momentum(&sides));
            let scale: f64 = free.iter().map(|s| s.mass * dot(s.velocity, s.velocity).sqrt()).sum();
            assert!((0..2).all(|d| (after[d] - before[d]).abs() < 4e-15 * scale));
            // What the other agents did: impulse times the same mean velocities.
            let others: f64 =
                sides.iter().zip(&free).map(|(s, f)| s.mass * dot(minus(f.velocity, f.old), s.mean())).sum();
            let mut exchanged = Exchange::default();
            touches.iter().for_each(|t| exchanged.add(&t.exchange(&sides)));
            let old: f64 = sides.iter().map(|s| 0.5 * s.mass * dot(s.old, s.old)).sum();
            let change = kinetic(&sides) - old;
            let works = others + exchanged.friction_work + exchanged.normal_work;
            assert!((change - works).abs() < 2e-14 * (old + kinetic(&sides)), "{change} {works}");
        }
    }
}

#[test]
fn solutions_meet_the_conditions_of_signorini_and_coulomb() {
    let mut rng = Lcg::new(11);
    let mut seen = [0; 3];
    // Three and four bodies whose normals contradict each other keep the iteration busy to its end now and then.
    for (bodies, close) in [(2, 1e-14), (3, 1e-4), (4, 1e-3)] {
        for _ in 0..300 {
            let (mut sides, mut touches) = random(&mut rng, bodies);
            solve(&mut sides, &mut touches);
            for touch in &touches {
                let [a, b] = touch.sides;
                let relative = minus(sides[a].velocity, sides[b].velocity);
                let p = touch.vector_impulse();
                let n = touch.normal;
                let t = [n[1], -n[0]];
                let (approach, sliding) = (dot(relative, n), dot(relative, t));
                let (normal, tangential) = (dot(p, n), dot(p, t));
                assert!(approach < close && normal >= 0.0, "no approach {approach}, no pull {normal}");
                assert!(normal * approach.abs() < close, "pressure only where they touch");
                assert!(tangential.abs() <= touch.friction * normal + 1e-12);
                seen[touch.state() as usize] += 1;
                match touch.state() {
                    State::Apart => assert!(normal == 0.0),
                    State::Sticking => assert!(sliding.abs() < close),
                    State::Slipping => assert!(tangential * sliding >= -close, "friction opposes sliding"),
                }
            }
        }
    }
    assert!(seen.iter().all(|&n| n > 100), "{seen:?}");
}

#[test]
fn three_in_a_row_end_up_together() {
    let masses = [1.0, 0.1, 5.0];
    let velocities = [[3.0, 0.0], [0.0, 0.0], [-1.0, 0.0]];
    let mut sides = [0, 1, 2].map(|k| side(masses[k], velocities[k], velocities[k]));
    let mut touches = [Touch::new([0, 1], [1.0, 0.0], 0.0), Touch::new([1, 2], [1.0, 0.0], 0.0)];
    let common = momentum(&sides)[0] / masses.iter().sum::<f64>();
    solve(&mut sides, &mut touches);
    assert!(sides.iter().all(|s| (s.velocity[0] - common).abs() < 1e-12), "{sides:?}");
}

#[test]
fn a_clamped_body_acts_as_one_of_infinite_mass() {
    let v = [2.0, 1.0];
    let clamped = Side { fixed: true, ..side(0.3, [0.0; 2], [0.0; 2]) };
    let mut sides = [side(1.5, v, v), clamped];
    let mut touches = [Touch::new([0, 1], [1.0, 0.0], 0.2)];
    solve(&mut sides, &mut touches);
    assert_eq!(sides[1], clamped);
    let p = touches[0].vector_impulse();
    assert!((p[0] - 3.0).abs() < 1e-15 && (p[1] - 0.6).abs() < 1e-15, "{p:?}");

    // The same when the clamp is a boundary that is visited in turn.
    let free = Side { fixed: false, held: true, ..clamped };
    let mut visited = [side(1.5, v, v), free];
    let mut taken = [0.0; 2];
    solve_held(
        &mut visited,
        &mut touches,
        Some(|k: usize, m: f64, v: &mut Vector, _: bool| {
            if k == 1 {
                for d in 0..2 {
                    taken[d] -= m * v[d];
                    v[d] = 0.0;
                }
            }
        }),
    );
    for d in 0..2 {
        assert!((visited[0].velocity[d] - sides[0].velocity[d]).abs() < 1e-12);
        assert!((taken[d] + p[d]).abs() < 1e-12, "what the contact gives goes into the clamp");
    }
}

#[test]
fn a_floor_under_one_of_two_bodies_carries_what_the_other_presses_down() {
    // A body pushed by another along a slope into a smooth floor: the conditions at both surfaces hold together.
    let n = [0.6, -0.8];
    let mut sides = [side(1.0, [0.0; 2], [1.0, -1.0]), side(2.0, [0.0; 2], [0.0, -0.1])];
    sides[1].held = true;
    let mut touches = [Touch::new([0, 1], n, 0.0)];
    let mut floor = 0.0;
    solve_held(
        &mut sides,
        &mut touches,
        Some(|k: usize, m: f64, v: &mut Vector, _: bool| {
            if k == 1 {
                let new = f64::max(floor - m * v[1], 0.0);
                v[1] += (new - floor) / m;
                floor = new;
            }
        }),
    );
    assert!(sides[1].velocity[1].abs() < 1e-12 && floor > 0.2);
    assert!(dot(minus(sides[0].velocity, sides[1].velocity), n).abs() < 1e-12);
    let total = momentum(&sides);
    assert!((total[0] - 1.0).abs() < 1e-12 && (total[1] + 1.2 - floor).abs() < 1e-12);
}

#[test]
fn the_two_bodies_are_equals() {
    let mut rng = Lcg::new(3);
    for _ in 0..100 {
        let (mut sides, mut touches) = random(&mut rng, 2);
        let mut swapped = [sides[1], sides[0]];
        let n = touches[0].normal;
        let mut back = [Touch::new([0, 1], [-n[0], -n[1]], touches[0].friction)];
        solve(&mut sides, &mut touches);
        solve(&mut swapped, &mut back);
        assert_eq!([swapped[1], swapped[0]], [sides[0], sides[1]], "to the last bit");
    }
}

#[test]
fn projection_keeps_momentum_and_creates_no_energy() {
    let mut rng = Lcg::new(5);
    for bodies in [2, 3] {
        for _ in 0..200 {
            let (mut sides, mut touches) = random(&mut rng, bodies);
            solve(&mut sides, &mut touches);
            let (others, _) = random(&mut rng, bodies);
            let mut remapped: Vec<Side> =
                sides.iter().zip(&others).map(|(s, o)| Side { velocity: o.velocity, ..*s }).collect();
            let before = (momentum(&remapped), kinetic(&remapped));
            project(&mut remapped, &touches);
            let after = (momentum(&remapped), kinetic(&remapped));
            assert!((0..2).all(|d| (before.0[d] - after.0[d]).abs() < 1e-14));
            assert!(after.1 <= before.1 * (1.0 + 1e-15));
            if let [touch] = touches[..] {
                let relative = minus(remapped[0].velocity, remapped[1].velocity);
                match touch.state() {
                    State::Apart => assert_eq!(before, after),
                    State::Sticking => assert!(dot(relative, relative) < 1e-28),
                    State::Slipping => assert!(dot(relative, touch.normal) < 1e-14),
                }
            }
        }
    }
}

#[test]
fn a_corner_of_floor_and_contact_for_any_masses() {
    // A body between a floor with friction and another body with friction, of which either may be ten times lighter.
    let mut rng = Lcg::new(17);
    for _ in 0..2000 {
        let (mut sides, mut touches) = random(&mut rng, 2);
        sides[1].mass = sides[0].mass * 10f64.powf(rng.signed());
        sides[1].held = true;
        let start = kinetic(&sides);
        let (mu, mut p) = (0.4, [0.0; 2]);
        solve_held(
            &mut sides,
            &mut touches,
            Some(|_: usize, m: f64, v: &mut Vector, with_friction: bool| {
                let normal = f64::max(p[1] - m * v[1], 0.0);
                v[1] += (normal - p[1]) / m;
                p[1] = normal;
                let limit = if with_friction { mu * normal } else { 0.0 };
                let along = (p[0] - m * v[0]).clamp(-limit, limit);
                v[0] += (along - p[0]) / m;
                p[0] = along;
            }),
        );
        assert!(kinetic(&sides) <= start * (1.0 + 1e-9), "no energy from nothing");
        let touch = &touches[0];
        let relative = minus(sides[0].velocity, sides[1].velocity);
        let scale = start.sqrt() / sides[0].mass.min(sides[1].mass).sqrt();
        assert!(dot(relative, touch.normal) < 1e-6 * scale, "{relative:?} {touch:?}");
        assert!(sides[1].velocity[1] > -1e-6 * scale);
    }
}

#[test]
fn solutions_scale_with_the_velocities() {
    let mut rng = Lcg::new(29);
    let scale = 2f64.powi(-40);
    for _ in 0..20 {
        let (mut sides, mut touches) = random(&mut rng, 3);
        let mut slow: Vec<Side> = sides.clone();
        for s in &mut slow {
            (s.old, s.velocity) = (s.old.map(|v| scale * v), s.velocity.map(|v| scale * v));
        }
        solve(&mut sides, &mut touches);
        solve(&mut slow, &mut touches);
        for (s, t) in sides.iter().zip(&slow) {
            assert_eq!(s.velocity.map(|v| scale * v), t.velocity);
        }
    }
}

#[test]
fn projection_visits_every_pair_of_a_row_often_enough() {
    let mut sides = [3.0, 0.0, -2.0].map(|v| side(1.0, [v, 0.0], [v, 0.0]));
    let mut touches = [Touch::new([0, 1], [1.0, 0.0], 1.0), Touch::new([1, 2], [1.0, 0.0], 1.0)];
    solve(&mut sides, &mut touches);
    for (s, v) in sides.iter_mut().zip([1.0, 0.0, 0.0]) {
        s.velocity = [v, 0.0];
    }
    project(&mut sides, &touches);
    assert!(sides.iter().all(|s| (s.velocity[0] - 1.0 / 3.0).abs() < 0.01), "{sides:?}");
}

#[test]
fn projection_leaves_an_approach_that_closes_the_gap() {
    let mut sides = [side(1.0, [1.0, 0.0], [1.0, 0.0]), side(1.0, [0.0; 2], [0.0; 2])];
    let mut touches = [Touch::new([0, 1], [1.0, 0.0], 0.0).with_slack(0.4)];
    solve(&mut sides, &mut touches);
    (sides[0].velocity, sides[1].velocity) = ([0.9, 0.0], [0.1, 0.0]);
    project(&mut sides, &touches);
    assert!((sides[0].velocity[0] - sides[1].velocity[0] - 0.4).abs() < 1e-15, "{sides:?}");
}
