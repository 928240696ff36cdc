//! Outlines of lattices, and distances from them.

use crate::contact::Vector;
use crate::contact::boxes::Segments;
use crate::contact::outline::{Nearest, Outline, Surface, foot_on, nearest, penetration};
use crate::space::{dot, minus};

const S: f64 = 0.05;

/// Points of a lattice whose cells satisfy a condition, turned by `angle` about the origin.
fn lattice(n: [i32; 2], angle: f64, keep: impl Fn(i32, i32) -> bool) -> Vec<(u32, Vector)> {
    let (c, s) = (libm::cos(angle), libm::sin(angle));
    let mut points = Vec::new();
    for j in 0..n[1] {
        for i in 0..n[0] {
            if keep(i, j) {
                let (x, y) = (S * (f64::from(i) + 0.5), S * (f64::from(j) + 0.5));
                points.push(((i + n[0] * j) as u32, [c * x - s * y, s * x + c * y]));
            }
        }
    }
    points
}

fn places(ring: &[u32], points: &[(u32, Vector)]) -> Vec<Vector> {
    ring.iter().map(|id| points.iter().find(|p| p.0 == *id).expect("a point").1).collect()
}

fn area(ring: &[Vector]) -> f64 {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0])).sum()
}

#[test]
fn the_ring_of_a_rectangle_at_any_angle() {
    for angle in [0.0, 0.4, -2.0] {
        let points = lattice([12, 5], angle, |_, _| true);
        let outline = Outline::trace(&points, S, angle);
        let [ring] = &outline.rings[..] else { panic!("{outline:?}") };
        assert_eq!(ring.len(), 2 * (12 + 5) - 4);
        assert_eq!(outline.points().len(), ring.len());
        let enclosed = area(&places(ring, &points));
        assert!((enclosed - 11.0 * 4.0 * S * S).abs() < 1e-12, "counter-clockwise, through the points: {enclosed}");
    }
}

#[test]
fn rings_of_other_shapes() {
    // The point in the re-entrant corner of an L has no free side, the ring passes it; a frame has a hole, traced clockwise; a thin strip is walked there and back.
    let l = Outline::trace(&lattice([6, 6], 0.0, |i, j| i < 3 || j < 3), S, 0.0);
    assert_eq!((l.rings.len(), l.rings[0].len()), (1, 19));
    let points = lattice([6, 6], 0.0, |i, j| !(2..4).contains(&i) || !(2..4).contains(&j));
    let frame = Outline::trace(&points, S, 0.0);
    let areas: Vec<f64> = frame.rings.iter().map(|r| area(&places(r, &points))).collect();
    assert_eq!(frame.rings.len(), 2);
    assert!(areas.iter().any(|&a| a > 0.0) && areas.iter().any(|&a| a < 0.0), "{areas:?}");
    let strip = Outline::trace(&lattice([5, 1], 0.0, |_, _| true), S, 0.0);
    assert_eq!((strip.rings[0].len(), strip.points().len()), (8, 5));
    let apart = Outline::trace(&lattice([5, 2], 0.0, |i, _| i != 2), S, 0.0);
    assert_eq!(apart.rings.len(), 2);
    // Squares that meet at a corner only are not one body there.
    let corner = Outline::trace(&lattice([2, 2], 0.0, |i, j| i == j), S, 0.0);
    assert_eq!(corner.rings, [[0], [3]]);
    assert_eq!(Outline::trace(&[], S, 0.0), Outline::default());
    assert_eq!(Outline::trace(&[(7, [1.0, 2.0])], S, 0.0).rings, [[7]]);
}

#[test]
fn distances_from_a_rectangle() {
    let angle = 0.5;
    let (c, s) = (libm::cos(angle), libm::sin(angle));
    let turned = |x: Vector| [c * x[0] - s * x[1], s * x[0] + c * x[1]];
    let points = lattice([12, 5], angle, |_, _| true);
    let ring = places(&Outline::trace(&points, S, angle).rings[0], &points);
    let (length, height) = (12.0 * S, 5.0 * S);
    for (at, distance, normal) in [
        ([0.3, height + 0.02], 0.02, [0.0, 1.0]),
        ([0.3, -0.3], 0.3, [0.0, -1.0]),
        ([length + 0.01, 0.1], 0.01, [1.0, 0.0]),
        ([-0.4, 0.1], 0.4, [-1.0, 0.0]),
        // Between surface and ring, on the ring, and well inside.
        ([0.3, height - 0.01], -0.01, [0.0, 1.0]),
        ([0.31, height - 0.5 * S], -0.5 * S, [0.0, 1.0]),
        ([length - 0.06, 0.1], -0.06, [1.0, 0.0]),
    ] {
        let Nearest { distance: d, normal: n, .. } = nearest(&ring, 0.5 * S, turned(at)).expect("a ring");
        assert!((d - distance).abs() < 1e-12, "{at:?}: {d}");
        assert!(dot(n, turned(normal)) > 1.0 - 1e-12, "{at:?}: {n:?}");
        let deep = penetration(&ring, 0.5 * S, turned(at), 0.02);
        assert!((deep - (0.02 - distance).max(0.0)).abs() < 1e-12);
    }
    assert_eq!(nearest(&[], S, [0.0; 2]), None);
    assert_eq!(Surface::default().nearest([0.0; 2]), None);
}

#[test]
fn a_bent_bar_keeps_its_surface() {
    // A bar of 40 by 6 points bent into a quarter of a ring of mean radius R: its faces lie at R -/+ half its depth.
    let (n, depth) = (40, 6);
    let length = f64::from(n) * S;
    let radius = length / std::f64::consts::FRAC_PI_2;
    let straight = lattice([n, depth], 0.0, |_, _| true);
    let bent: Vec<(u32, Vector)> = straight
        .iter()
        .map(|&(id, x)| {
            let (r, t) = (radius + x[1] - 0.5 * f64::from(depth) * S, x[0] / radius);
            (id, [r * libm::sin(t), r * libm::cos(t)])
        })
        .collect();
    let ring = places(&Outline::trace(&straight, S, 0.0).rings[0], &bent);
    let outer = radius + 0.5 * f64::from(depth) * S;
    let mut worst = [0.0f64; 2];
    for k in 0..200 {
        let t = 0.2 + 1.1 * f64::from(k) / 200.0;
        let out = [libm::sin(t), libm::cos(t)];
        let seen = nearest(&ring, 0.5 * S, out.map(|c| (outer + 0.03) * c)).expect("a ring");
        worst[0] = worst[0].max((seen.distance - 0.03).abs() / S);
        worst[1] = worst[1].max(libm::acos(dot(seen.normal, out).min(1.0)).to_degrees());
        assert!(minus(seen.foot, out.map(|c| (outer - 0.5 * S) * c)).iter().all(|e| e.abs() < S));
    }
    println!("largest errors: distance {:.4} spacings, normal {:.2} degrees", worst[0], worst[1]);
    // Chords of length S on the outer ring sag by S^2/8R; a normal is off by half the turn between two chords.
    assert!(worst[0] < 0.15 * S / radius * 1.5 && worst[1] < 0.6 * (S / radius).to_degrees());
}

#[test]
fn boxes_find_what_a_full_search_finds() {
    let shape = |i: i32, j: i32| i < 6 || j < 4 || (i > 18 && j > 9);
    let points = lattice([24, 14], 0.3, shape);
    for ring in Outline::trace(&points, S, 0.3).rings {
        let ring = places(&ring, &points);
        let mut surface = Surface::new(0.5 * S);
        surface.follow(ring.iter().copied());
        for k in 0..3000 {
            let x = [-0.9 + 0.04 * f64::from(k % 60), -0.2 + 0.043 * f64::from(k / 60)];
            let (a, b) = (nearest(&ring, 0.5 * S, x).expect("a ring"), surface.nearest(x).expect("a ring"));
            assert!((a.distance - b.distance).abs() < 1e-12, "{x:?} {a:?} {b:?}");
            // Where two places are equally near, either normal is right.
            let apart = minus(a.foot, b.foot);
            let turned = minus(a.normal, b.normal);
            assert!(dot(apart, apart) > 1e-12 || dot(turned, turned) < 1e-18, "{x:?} {a:?} {b:?}");
        }
    }
}

#[test]
fn segments_in_boxes_are_found_as_by_looking_at_all_of_them() {
    // Rings up to three levels of boxes deep around a crooked star, some of whose points coincide, and places on all sides.
    let noise = |k: usize| (libm::sin(12.9898 * k as f64) * 43758.5453).rem_euclid(1.0);
    for n in [1, 2, 7, 8, 9, 64, 65, 440, 513, 1200] {
        let ring: Vec<Vector> = (0..n)
            .map(|k| {
                let (k, t) = (k / 2 * 2, std::f64::consts::TAU * k as f64 / n as f64);
                let r = 0.5 + 0.3 * libm::sin(5.0 * t) + 0.02 * noise(k);
                if k % 5 == 0 { [r, 0.1] } else { [r * libm::cos(t), r * libm::sin(t)] }
            })
            .collect();
        let mut segments = Segments::default();
        segments.follow(&ring);
        for k in 0..2000 {
            let x = if k < n { ring[k] } else { [3.0 * noise(2 * k) - 1.5, 3.0 * noise(2 * k + 1) - 1.5] };
            let to_segment = |k: usize| {
                let (foot, along, _) = foot_on(ring[k], ring[(k + 1) % n], x);
                let r = minus(x, foot);
                if dot(along, along) > 0.0 { dot(r, r) } else { f64::INFINITY }
            };
            let to_box = |run: usize| {
                let ends = || (8 * run..=(8 * run + 8).min(n)).map(|k| ring[k % n]);
                let outside = |d: usize| {
                    let low = ends().map(|e| e[d]).fold(f64::INFINITY, f64::min);
                    let high = ends().map(|e| e[d]).fold(f64::NEG_INFINITY, f64::max);
                    (low - x[d]).max(x[d] - high).max(0.0)
                };
                outside(0) * outside(0) + outside(1) * outside(1)
            };
            let runs = 0..n.div_ceil(8);
            let first = runs.min_by(|&a, &b| to_box(a).total_cmp(&to_box(b))).expect("a run");
            let (mut best, mut nearest) = (f64::INFINITY, None);
            for k in (8 * first..(8 * first + 8).min(n)).chain(0..n) {
                if to_segment(k) < best {
                    (best, nearest) = (to_segment(k), Some(k));
                }
            }
            assert_eq!(segments.nearest(x), nearest, "{n} points, {x:?}");
        }
    }
}

#[test]
fn sharp_corners_have_an_inside_and_an_outside() {
    // A triangle with corners of 60 degrees: beyond a corner, one face alone would say inside.
    let ring = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.75f64.sqrt()]];
    let mut surface = Surface::new(0.1);
    surface.follow(ring.into_iter());
    for k in 0..3000 {
        let x = [-0.5 + 0.0331 * f64::from(k % 60), -0.4 + 0.0337 * f64::from(k / 60)];
        let (a, b) = (nearest(&ring, 0.1, x).expect("a ring"), surface.nearest(x).expect("a ring"));
        assert!((a.distance - b.distance).abs() < 1e-12, "{x:?} {a:?} {b:?}");
    }
    // On the ring itself, where nothing points away: the normal of the face, and at a corner what lies between.
    for (on, normal) in [([0.5, 0.0], [0.0, -1.0]), ([0.25, 0.75f64.sqrt() / 2.0], [-(0.75f64.sqrt()), 0.5])] {
        let found = surface.nearest(on).expect("a ring");
        assert!(dot(found.normal, normal) > 1.0 - 1e-12 && (found.distance + 0.1).abs() < 1e-12, "{found:?}");
    }
    let top = surface.nearest(ring[2]).expect("a ring").normal;
    assert!(top[0].abs() < 1e-12 && (top[1] - 1.0).abs() < 1e-12, "{top:?}");
}

#[test]
fn the_surface_of_a_grain_of_a_few_micrometres() {
    let ring = [[0.0, 0.0], [4e-5, 0.0], [4e-5, 4e-5], [0.0, 4e-5]];
    let mut surface = Surface::new(1e-5);
    surface.follow(ring.into_iter());
    // Beyond a corner the normal points away from the corner.
    let x = [4e-5 + 3e-6, 4e-5 + 4e-6];
    for found in [nearest(&ring, 1e-5, x), surface.nearest(x)] {
        let found = found.expect("a ring");
        assert!((found.distance + 5e-6).abs() < 1e-18, "{found:?}");
        assert!(dot(found.normal, [0.6, 0.8]) > 1.0 - 1e-9, "{found:?}");
    }
}

#[test]
fn one_point_is_a_disc_without_faces() {
    let found = nearest(&[[1.0, 2.0]], 0.5, [4.0, 6.0]).expect("a ring");
    assert_eq!(found, Nearest { distance: 4.5, normal: [0.6, 0.8], foot: [1.0, 2.0] });
    let mut surface = Surface::new(0.5);
    surface.follow([[1.0, 2.0]; 2].into_iter());
    assert_eq!(surface.nearest([4.0, 6.0]), None);
}
