//! Simple polygons: area, centroid, what lies inside, and whether sides cross.

/// A point or a direction, m.
pub type Point = [f64; 2];

/// The corners of a rectangle from one of them along two of its sides.
pub fn rectangle(corner: Point, u: Point, length_u: f64, v: Point, length_v: f64) -> [Point; 4] {
    let at = |a: f64, b: f64| [corner[0] + a * u[0] + b * v[0], corner[1] + a * u[1] + b * v[1]];
    [at(0.0, 0.0), at(length_u, 0.0), at(length_u, length_v), at(0.0, length_v)]
}

fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

/// The sides, from corner to corner.
pub fn sides(points: &[Point]) -> impl Iterator<Item = [Point; 2]> {
    (0..points.len()).map(|k| [points[k], points[(k + 1) % points.len()]])
}

/// Area, m2, positive counter-clockwise (Gauss's formula, about the first corner so that places far from the origin lose no digits).
pub fn signed_area(points: &[Point]) -> f64 {
    let Some(&first) = points.first() else { return 0.0 };
    0.5 * sides(points).map(|[a, b]| cross(minus(a, first), minus(b, first))).sum::<f64>()
}

/// Area, m2.
pub fn area(points: &[Point]) -> f64 {
    signed_area(points).abs()
}

/// Centre of the area, m.
pub fn centroid(points: &[Point]) -> Point {
    let Some(&first) = points.first() else { return [f64::NAN; 2] };
    let mut sum = [0.0; 2];
    for [a, b] in sides(points) {
        let (a, b) = (minus(a, first), minus(b, first));
        (0..2).for_each(|d| sum[d] += cross(a, b) * (a[d] + b[d]));
    }
    let six = 6.0 * signed_area(points);
    [first[0] + sum[0] / six, first[1] + sum[1] / six]
}

/// Distance of a place from the piece between two others, m.
pub fn distance(x: Point, [a, b]: [Point; 2]) -> f64 {
    let (along, r) = (minus(b, a), minus(x, a));
    let square = along[0] * along[0] + along[1] * along[1];
    let share = if square > 0.0 { ((along[0] * r[0] + along[1] * r[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    (r[0] - share * along[0]).hypot(r[1] - share * along[1])
}

/// How deep a place lies inside, m; negative outside.
pub fn depth(points: &[Point], x: Point) -> f64 {
    let nearest = sides(points).map(|side| distance(x, side)).fold(f64::INFINITY, f64::min);
    // Whether a ray to the right crosses an odd number of sides.
    let crosses = |[a, b]: &[Point; 2]| {
        (a[1] > x[1]) != (b[1] > x[1]) && x[0] < a[0] + (x[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
    };
    if sides(points).filter(crosses).count() % 2 == 1 { nearest } else { -nearest }
}

/// Shares along two pieces at which they cross, if they do and are not parallel.
pub fn crossing([a, b]: [Point; 2], [c, d]: [Point; 2]) -> Option<[f64; 2]> {
    let (u, v, r) = (minus(b, a), minus(d, c), minus(c, a));
    let det = cross(u, v);
    let shares = [cross(r, v) / det, cross(r, u) / det];
    (det != 0.0 && shares.iter().all(|s| (0.0..=1.0).contains(s))).then_some(shares)
}

/// Least distance between two pieces, m.
pub fn apart(a: [Point; 2], b: [Point; 2]) -> f64 {
    if crossing(a, b).is_some() {
        return 0.0;
    }
    let ends = [distance(a[0], b), distance(a[1], b), distance(b[0], a), distance(b[1], a)];
    ends.into_iter().fold(f64::INFINITY, f64::min)
}

/// The first two pieces of a line through these points that touch but at a corner that they share, or fold back on each other; `closed`
/// if the last point is joined to the first.
pub fn tangled(points: &[Point], closed: bool) -> Option<[usize; 2]> {
    let n = points.len();
    let count = if closed { n } else { n.saturating_sub(1) };
    let piece = |k: usize| [points[k], points[(k + 1) % n]];
    let long = |[a, b]: [Point; 2]| (b[0] - a[0]).hypot(b[1] - a[1]);
    for k in 0..count {
        for j in 0..k {
            let (follows, around) = (j + 1 == k, closed && j == 0 && k + 1 == n);
            let tangled = if follows || around {
                let (first, second) = if follows { (piece(j), piece(k)) } else { (piece(k), piece(j)) };
                let (u, v) = (minus(first[1], first[0]), minus(second[1], second[0]));
                let along = u[0] * v[0] + u[1] * v[1];
                // Of a triangle all sides follow each other; others must part at their corner.
                along < 0.0 && cross(u, v).abs() <= FOLDED * long(first) * long(second)
            } else {
                apart(piece(j), piece(k)) <= TOUCH * (long(piece(j)) + long(piece(k)))
            };
            if tangled {
                return Some([j, k]);
            }
        }
    }
    None
}

/// Sine of the angle below which a corner is a fold.
const FOLDED: f64 = 1.0e-6;
/// Pieces nearer than this share of their lengths touch: round-off.
const TOUCH: f64 = 1.0e-12;

/// Triangles that make up a simple polygon that is counter-clockwise, by cutting off ears (Meisters 1975).
pub fn triangles(points: &[Point]) -> Vec<[Point; 3]> {
    let mut rest: Vec<Point> = points.to_vec();
    let mut found = Vec::with_capacity(points.len().saturating_sub(2));
    while rest.len() > 3 {
        let n = rest.len();
        let corner = |k: usize| [rest[(k + n - 1) % n], rest[k], rest[(k + 1) % n]];
        let turn = |[a, b, c]: [Point; 3]| cross(minus(b, a), minus(c, b));
        let is_ear = |k: usize| {
            let [a, b, c] = corner(k);
            let inside = |x: Point| [[a, b, x], [b, c, x], [c, a, x]].into_iter().all(|t| turn(t) >= 0.0);
            let other = |x: &Point| ![a, b, c].contains(x);
            turn([a, b, c]) > 0.0 && !rest.iter().copied().filter(|x| other(x)).any(inside)
        };
        let flat = || (0..n).min_by(|&a, &b| turn(corner(a)).abs().total_cmp(&turn(corner(b)).abs()));
        // Where round-off leaves no ear, what is left is flat.
        let Some(k) = (0..n).find(|&k| is_ear(k)).or_else(flat) else { break };
        found.push(corner(k));
        rest.remove(k);
    }
    if let [a, b, c] = rest[..] {
        found.push([a, b, c]);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An L of 3 m by 3 m with arms of 1 m, far from the origin: area 5, centroid by its two rectangles.
    #[test]
    fn an_l_has_its_area_and_its_centroid() {
        for [ox, oy] in [[0.0, 0.0], [1.0e6, -3.0e5]] {
            let l: Vec<Point> = [[0, 0], [3, 0], [3, 1], [1, 1], [1, 3], [0, 3]]
                .map(|[x, y]| [ox + f64::from(x), oy + f64::from(y)])
                .to_vec();
            assert_eq!((signed_area(&l), area(&l)), (5.0, 5.0));
            let [x, y] = centroid(&l);
            // (3 x 1.5 + 2 x 0.5) / 5 along each.
            assert!((x - ox - 1.1).abs() < 1e-9 && (y - oy - 1.1).abs() < 1e-9);
            let back: Vec<Point> = l.iter().rev().copied().collect();
            assert_eq!(signed_area(&back), -5.0);
            let parts = triangles(&l);
            assert_eq!(parts.len(), 4);
            let sum: f64 = parts.iter().map(|t| signed_area(t)).sum();
            assert!((sum - 5.0).abs() < 1e-12 && parts.iter().all(|t| signed_area(t) > 0.0));
            assert!((depth(&l, [ox + 0.5, oy + 2.0]) - 0.5).abs() < 1e-9);
            assert!((depth(&l, [ox + 2.0, oy + 2.0]) + 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn sides_that_cross_touch_or_fold_are_found() {
        let bow = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        assert_eq!(tangled(&bow, true), Some([0, 2]));
        assert_eq!(tangled(&[[0.0, 0.0], [1.0, 0.0], [0.5, 0.0], [0.5, 1.0]], true), Some([0, 1]));
        // A corner that touches another side.
        let pinched = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        assert_eq!(tangled(&pinched, true), Some([0, 2]));
        assert_eq!(tangled(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], true), None);
        assert_eq!(tangled(&bow[..3], false), None);
        assert!(tangled(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0]], true).is_some(), "a point twice");
    }
}
