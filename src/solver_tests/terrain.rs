//! Terrain: as planes where it is made of what planes can be, and what planes cannot be.

use crate::boundary::{Boundary, Chain, Friction};
use crate::scaffold::{Brick, centre, elastic, points_by_number, run_until, scene};
use crate::simulation::{PicShare, Simulation};
use nalgebra::Vector2;

const H: f64 = 0.05;
const GRAVITY: f64 = 9.81;

fn terrain(points: &[[f64; 2]], friction: Friction) -> Boundary {
    let chain = Chain::new(points.to_vec(), &vec![friction; points.len() - 1]).expect("a chain");
    Boundary::terrain("terrain", chain)
}

fn on(brick: &Brick, velocity: [f64; 2], boundaries: Vec<Boundary>) -> Simulation {
    let mut points = brick.points();
    points.iter_mut().for_each(|p| p.v = velocity);
    let mut scene = scene(brick, elastic(1e5, 0.3), 1000.0, points, boundaries);
    scene.gravity = [0.0, -GRAVITY];
    scene.numerics.pic = PicShare::Fraction(0.0);
    Simulation::new(scene)
}

fn differ(a: &Simulation, b: &Simulation) -> f64 {
    let (a, b) = (points_by_number(a), points_by_number(b));
    assert_eq!(a.len(), b.len());
    let far = a.iter().zip(&b).map(|(p, q)| (p.x[0] - q.x[0]).abs().max((p.x[1] - q.x[1]).abs()));
    far.fold(0.0, f64::max)
}

/// A block slides down a slope that is one piece, or three in a row: as on a plane, to round-off. So does what walks the other way.
#[test]
fn pieces_in_a_row_are_a_plane() {
    for degrees in [0.0f64, 25.0, 44.0, 65.0, -30.0] {
        let (angle, friction) = (degrees.to_radians(), Friction::Coulomb(0.3));
        let way = Vector2::new(libm::cos(angle), -libm::sin(angle));
        let normal = Vector2::new(-way.y, way.x);
        let brick = Brick { angle: -angle, ..Brick::new([0.013, 0.027], [4, 3], H) };
        let foot = Vector2::from(brick.corner);
        let at = |s: f64| <[f64; 2]>::from(foot + way * s);
        let plane = Boundary::plane("plane", foot, normal, friction);
        let chain = terrain(&[at(-0.3), at(0.041), at(0.11), at(0.9)], friction);
        let mut all = [plane, chain].map(|b| on(&brick, [0.2 * way.x, 0.2 * way.y], vec![b]));
        all.iter_mut().for_each(|sim| run_until(sim, 0.1).expect("a run"));
        let [a, b] = &all;
        assert!(differ(a, b) < 1e-11, "{degrees}: {}", differ(a, b));
        let taken = [a, b].map(|sim| sim.ledger().boundaries[0].impulse);
        assert!((taken[0][1] - taken[1][1]).abs() < 1e-9 && taken[0][1] > 0.1, "{taken:?}");
    }
}

/// A block is thrown into a corner of 90 degrees that is one terrain, or two planes: what lies behind the corner is held by both.
#[test]
fn a_nook_is_two_planes() {
    let brick = Brick::new([0.512, 0.031], [4, 3], H);
    let (floor, wall) = (0.03, 0.763);
    let friction = Friction::Coulomb(0.4);
    let planes = vec![
        Boundary::plane("floor", Vector2::new(0.0, floor), Vector2::new(0.0, 1.0), friction),
        Boundary::plane("wall", Vector2::new(wall, 0.0), Vector2::new(-1.0, 0.0), friction),
    ];
    let chain = vec![terrain(&[[-1.0, floor], [wall, floor], [wall, 2.0]], friction)];
    let mut all = [planes, chain].map(|b| on(&brick, [1.0, -0.2], b));
    all.iter_mut().for_each(|sim| run_until(sim, 0.12).expect("a run"));
    let [a, b] = &all;
    // Planes go on behind each other without end, where hardly anything of the material reaches.
    assert!(differ(a, b) < 1e-6, "{}", differ(a, b));
    let sums = [a, b]
        .map(|sim| sim.ledger().boundaries.iter().fold([0.0; 2], |s, t| [s[0] + t.impulse[0], s[1] + t.impulse[1]]));
    assert!(sums[0][0] < -1.0 && (sums[0][0] - sums[1][0]).abs() < 1e-4 * sums[0][0].abs(), "{sums:?}");
}

/// A block slides without friction over a hill and through a hollow: its energy stays, and no point is in the ground by more than a corner
/// between two lines of the grid lets through.
#[test]
fn a_block_goes_over_a_hill_and_through_a_hollow() {
    let y = |x: f64| 0.1 * libm::cos(2.0 * std::f64::consts::PI * x / 1.6);
    let points: Vec<[f64; 2]> = (0..=160).map(|k| 0.025 * f64::from(k) - 1.0).map(|x| [x, y(x)]).collect();
    let brick = Brick::new([-0.1, 0.1], [4, 2], H);
    let mut sim = on(&brick, [1.2, 0.0], vec![terrain(&points, Friction::Smooth)]);
    let start = centre(&sim);
    let mut deepest = 0.0f64;
    while centre(&sim).0[0] < 1.5 {
        sim.step().expect("a step");
        assert!(sim.time() < 2.0, "stopped at {:?}", centre(&sim).0);
        deepest = sim.particles().map(|(_, p)| sim.boundaries()[0].depth(p.x)).fold(deepest, f64::max);
    }
    let end = centre(&sim);
    let energy = |(x, v): ([f64; 2], [f64; 2])| 0.5 * (v[0] * v[0] + v[1] * v[1]) + GRAVITY * x[1];
    // It comes to the next hill as it left the first, but for what it turns and shakes: it is soft, and lands in the hollow.
    let lost = 1.0 - energy(end) / energy(start);
    assert!((-0.005..0.1).contains(&lost), "{lost}: {start:?} {end:?}");
    let balance = sim.energy_balance(&sim.stock(), [0.0; 2]);
    assert!(balance.residual.abs() < 0.02 * balance.initial.abs(), "{balance:?}");
    assert!(deepest < 0.1 * H, "{deepest}");
}

/// Each piece rubs as it is said to: a block slides from a smooth piece onto a rough one. The work of friction is m g times, of each piece,
/// its coefficient and the way that the block's mass goes on it, so that it stops behind the joint after half its length and v^2 / (2 mu g).
#[test]
fn each_piece_has_its_friction() {
    // The joint lies in the middle between two lines, each of which stands for half a cell on either side.
    let (mu, speed, joint) = (0.3, 1.5, 0.625);
    let brick = Brick::new([0.2, 0.0], [8, 1], H);
    let points = vec![[-1.0, 0.0], [joint, 0.0], [3.0, 0.0]];
    let chain = Chain::new(points, &[Friction::Smooth, Friction::Coulomb(mu)]).expect("a chain");
    let mut sim = on(&brick, [speed, 0.0], vec![Boundary::terrain("terrain", chain)]);
    let stop = 0.5 * speed * speed / (mu * GRAVITY);
    run_until(&mut sim, (joint - 0.2) / speed + 2.0 * stop / speed + 0.3).expect("a run");
    let middle = centre(&sim).0[0];
    // Half its length comes before the joint and half behind it: the middle stops as if it were a point. Friction at its base loads its front
    // by a share of 3 mu h / L while it crosses, which takes 1 % of its energy.
    assert!((middle - joint - stop).abs() < 0.02 * stop, "{middle} {}", joint + stop);
}

/// A step down: a block slides over its edge and lands on the floor below; the riser, whose lines are horizontal, and the tread share the edge.
#[test]
fn a_block_falls_off_a_step() {
    let step = [[-1.0, 0.2], [0.3, 0.2], [0.3, 0.0], [2.0, 0.0]];
    let brick = Brick::new([0.0, 0.2], [4, 2], H);
    let mut sim = on(&brick, [1.5, 0.0], vec![terrain(&step, Friction::Coulomb(0.1))]);
    let mut deepest = 0.0f64;
    while sim.time() < 0.6 {
        sim.step().expect("a step");
        deepest = sim.particles().map(|(_, p)| sim.boundaries()[0].depth(p.x)).fold(deepest, f64::max);
    }
    let (x, _) = centre(&sim);
    assert!(x[0] > 0.5 && x[1] < 0.2, "{x:?}");
    // It tips about the last line before the edge, which is there, and may sink between that and the next by less than half a cell.
    assert!(deepest < 0.5 * H, "{deepest}");
}
