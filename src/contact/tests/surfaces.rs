//! Normals, gaps and areas between straight surfaces at any angle and place, and outlines.

use crate::contact::Vector;
use crate::contact::normal::{Sample, from_difference, from_larger, from_positions};
use crate::contact::regression;
use crate::contact::separation::{self, TOUCHING, area};
use crate::shape::{AveragedHat, STENCIL, Shape1d};
use crate::space::dot;

/// Half width of a point's domain in cells, two points per cell and direction.
const HALF: f64 = 0.25;

/// Points (in cells) on either side of a line through (`shift`, 0) at `angle` (rad) to y, `gap` apart; lattices along the line,
/// the second slid by a third of a spacing. The normal out of the first is (cos, sin) of the angle.
struct Pair {
    bodies: [Vec<Vector>; 2],
    normal: Vector,
}

impl Pair {
    fn new(angle: f64, shift: f64, gap: f64) -> Self {
        let (c, s) = (libm::cos(angle), libm::sin(angle));
        let body = |sign: f64, slid: f64| {
            let mut points = Vec::new();
            for row in 0..8 {
                let across = sign * (0.5 * gap + HALF + 2.0 * HALF * f64::from(row));
                for k in -16..16 {
                    let along = 2.0 * HALF * f64::from(k) + slid;
                    points.push([shift + c * across - s * along, s * across + c * along]);
                }
            }
            points
        };
        Self { bodies: [body(-1.0, 0.0), body(1.0, HALF / 1.5)], normal: [c, s] }
    }

    /// Samples of both bodies at a node, for points of unit mass and volume, and the points that it sees.
    fn at(&self, node: [i32; 2]) -> ([Sample; 2], [Vec<Vector>; 2]) {
        let mut seen = [Vec::new(), Vec::new()];
        let samples = [0, 1].map(|b| {
            let mut sample = Sample::default();
            for &x in &self.bodies[b] {
                let (s, g) = weight(x, node);
                sample.add(1.0, 1.0, x, s, g);
                if s > 0.0 {
                    seen[b].push(x);
                }
            }
            sample
        });
        (samples, seen)
    }

    /// Nodes near the middle that both bodies reach with more than `least` of a full node.
    fn shared(&self, least: f64) -> Vec<[i32; 2]> {
        let all = (-3..=3).flat_map(|i| (-3..=3).map(move |j| [i, j]));
        all.filter(|&n| self.at(n).0.iter().all(|s| s.volume > least * 4.0)).collect()
    }
}

/// Weight of a node for a point at `x` (cells) and its gradient.
fn weight(x: Vector, node: [i32; 2]) -> (f64, Vector) {
    let shape = AveragedHat::new(HALF);
    let along = |d: usize| {
        let u = x[d] + 100.0 - shape.shift();
        let (w, g) = shape.eval(u - u.floor());
        let k = node[d] + 100 - u.floor() as i32;
        if (0..STENCIL as i32).contains(&k) { (w[k as usize], g[k as usize]) } else { (0.0, 0.0) }
    };
    let ((wx, gx), (wy, gy)) = (along(0), along(1));
    (wx * wy, [gx * wy, wx * gy])
}

fn degrees_between(a: Vector, b: Vector) -> f64 {
    libm::acos(dot(a, b).clamp(-1.0, 1.0)).to_degrees()
}

/// Largest and root-mean-square error of a normal over angles and places, degrees.
fn errors(normal: impl Fn(&Pair, [i32; 2]) -> Option<Vector>, angle: f64) -> [f64; 2] {
    let (mut largest, mut squares, mut count) = (0.0f64, 0.0, 0.0);
    for shift in 0..10 {
        let pair = Pair::new(angle.to_radians(), 0.1 * f64::from(shift), 0.0);
        for node in pair.shared(0.01) {
            let e = normal(&pair, node).map_or(f64::NAN, |n| degrees_between(n, pair.normal));
            assert!(e.is_finite(), "no normal at {angle} degrees");
            largest = largest.max(e);
            squares += e * e;
            count += 1.0;
        }
    }
    assert!(count > 20.0);
    [largest, f64::sqrt(squares / count)]
}

#[test]
fn normals_of_straight_surfaces() {
    println!("angle, largest and rms error in degrees of: larger body, average, regression, positions");
    let mut worst = [[0.0f64; 2]; 4];
    for angle in [0.0, 7.3, 15.0, 23.0, 30.0, 40.0, 45.0, 60.0] {
        let gradient = |rule: fn(&Sample, &Sample, f64) -> Option<Vector>| {
            move |p: &Pair, n: [i32; 2]| {
                let ([a, b], _) = p.at(n);
                rule(&a, &b, 1e-12)
            }
        };
        let fitted = |p: &Pair, n: [i32; 2]| {
            let (_, [a, b]) = p.at(n);
            regression::normal(&a, &b, n.map(f64::from), 1.0)
        };
        let between = |p: &Pair, n: [i32; 2]| {
            let ([a, b], _) = p.at(n);
            from_positions(&a, &b)
        };
        let found = [
            errors(gradient(from_larger), angle),
            errors(gradient(from_difference), angle),
            errors(fitted, angle),
            errors(between, angle),
        ];
        println!("{angle:5.1}  {found:.2?}");
        if angle == 0.0 {
            assert!(found[0][0] < 1e-5 && found[1][0] < 1e-5, "gradients are exact along the grid");
        }
        for (w, f) in worst.iter_mut().zip(found) {
            *w = [w[0].max(f[0]), w[1].max(f[1])];
        }
    }
    println!("worst  {worst:.2?}");
    let [larger, average, regression, positions] = worst;
    assert!(regression[0] < 2.5 && regression[1] < 0.6, "{regression:?}");
    assert!(average[1] < 3.0 && average[1] < larger[1] && regression[1] < average[1]);
    assert!(
        larger[0] > 30.0 && positions[0] > 10.0,
        "that bad, which is why the others exist: {larger:?} {positions:?}"
    );
}

#[test]
fn regression_asks_where_points_are_and_not_how_many() {
    let pair = Pair::new(0.4, 0.3, 0.0);
    let (_, [a, b]) = pair.at([0, 0]);
    let once = regression::normal(&a, &b, [0.0; 2], 1.0).expect("a normal");
    let twice = regression::normal(&[&a[..], &a].concat(), &[&b[..], &b].concat(), [0.0; 2], 1.0).expect("a normal");
    assert!((0..2).all(|d| (once[d] - twice[d]).abs() < 1e-12), "{once:?} {twice:?}");
}

#[test]
fn regression_wants_two_clouds() {
    let x = [[0.1, 0.0], [0.2, 0.3]];
    assert_eq!(regression::normal(&x, &[], [0.0; 2], 1.0), None);
    assert_eq!(regression::normal(&[x[0]], &[x[0]], [0.0; 2], 1.0), None, "coincident");
    let n = regression::normal(&[[0.0, 0.0]], &[[3.0, 4.0]], [0.0; 2], 10.0);
    assert!(n.is_some_and(|n| degrees_between(n, [0.6, 0.8]) < 1e-5), "{n:?}");
}

#[test]
fn gaps_between_straight_surfaces() {
    println!("angle, gap, least share of a full node: error in cells from positions");
    for angle in [0.0, 15.0, 30.0, 45.0] {
        for (gap, least) in [(0.0, 0.01), (0.0, 0.1), (0.25, 0.1), (-0.1, 0.1)] {
            let mut seen = [f64::INFINITY, f64::NEG_INFINITY];
            for shift in 0..20 {
                let pair = Pair::new(f64::to_radians(angle), 0.05 * f64::from(shift), gap);
                for node in pair.shared(least) {
                    let ([a, b], _) = pair.at(node);
                    let off = separation::from_positions(&a, &b, pair.normal, TOUCHING, 1.0) - gap;
                    seen = [seen[0].min(off), seen[1].max(off)];
                }
            }
            println!("{angle:5.1} {gap:5.2} {least:5.2}  {seen:.3?}");
            // What a node sees of a gap that it lies in is less than the gap, and more at its rim.
            if least == 0.1 {
                assert!(seen[0] > -0.15 && seen[1] < 0.25, "{seen:?}");
            }
        }
    }
}

#[test]
fn mean_positions_and_displacements_tell_approach_from_parting() {
    let sample = |u: f64| Sample { mass: 2.0, moment: [2.0 * u, 0.0], ..Sample::default() };
    let n = [1.0, 0.0];
    let apart = separation::from_positions(&sample(0.1), &sample(0.3), n, TOUCHING, 0.2);
    assert!((apart - (0.2 - 0.8 * 0.2)).abs() < 1e-15, "in cells of 0.2 m: {apart}");
    assert!((separation::from_displacements(&sample(0.1), &sample(0.3), n) - 0.2).abs() < 1e-15);
    assert!(separation::from_displacements(&sample(0.3), &sample(0.1), n) < 0.0);
    assert_eq!((separation::slack(-0.1, 0.5), separation::slack(0.1, 0.5)), (0.0, 0.2));
}

#[test]
fn area_of_a_straight_surface_through_the_node() {
    let (h, t) = (0.01, 0.2);
    let half = 0.5 * h * h * t;
    assert!((area(half, half, h) - t * h).abs() < 1e-15);
    assert_eq!(area(0.0, half, h), 0.0);
    assert_eq!(area(0.3 * half, half, h), area(half, 0.3 * half, h));
}

#[test]
fn the_larger_body_decides_and_normals_point_out_of_the_first() {
    let sample = |volume: f64, gradient: Vector| Sample { volume, gradient, mass: 2.0, ..Sample::default() };
    let large = |a: f64, b: f64| from_larger(&sample(a, [3.0, 0.0]), &sample(b, [0.0, -4.0]), 0.1);
    assert_eq!(large(2.0, 1.0), Some([1.0, 0.0]));
    assert_eq!(large(1.0, 2.0), Some([0.0, 1.0]));
    let both = from_difference(&sample(2.0, [3.0, 0.0]), &sample(1.0, [0.0, -4.0]), 0.1);
    assert_eq!(both, Some([0.6, 0.8]));
    assert_eq!(from_difference(&sample(2.0, [0.05, 0.0]), &sample(2.0, [0.0; 2]), 0.1), None);
    let at = |x: Vector| Sample { mass: 2.0, moment: x.map(|x| 2.0 * x), ..Sample::default() };
    assert_eq!(from_positions(&at([1.0, 1.0]), &at([4.0, 5.0])), Some([0.6, 0.8]));
    assert_eq!(from_positions(&at([1.0, 1.0]), &at([1.0, 1.0])), None);
}
