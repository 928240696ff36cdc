//! Plane geometry for the checks: rectangles, polygons, rings, half spaces, and how deep one lies in the other.

use super::angle::direction;
use super::boundary::{Boundary, MaterialSide, Shape, Wall};
use super::drawing::{Drawing, Ring};
use super::grid::Grid;
use super::polygon::{self, Point, rectangle};
use super::schema::Body;
use crate::boundary::Chain;

/// How far a body lies inside something, and the direction in which it is nearest to getting out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Penetration {
    /// Depth, m.
    pub depth_m: f64,
    /// Unit vector along which moving the body by `depth_m` frees it.
    pub way_out: Point,
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

impl Wall {
    /// Unit vector from the face into the material.
    pub fn normal(&self) -> Point {
        let [x, y] = direction(self.inclination_deg);
        match self.material_side {
            MaterialSide::Left => [-y, x],
            MaterialSide::Right => [y, -x],
        }
    }

    /// The four corners of the solid, m: foot, crest, and the two behind them.
    pub fn corners_m(&self) -> [Point; 4] {
        let normal = self.normal();
        let behind = [-normal[0], -normal[1]];
        rectangle(self.foot_m, direction(self.inclination_deg), self.height_m, behind, self.thickness_m)
    }
}

impl Boundary {
    /// How deep a body lies in it; `None` if a required field is missing, which validation refuses.
    pub(super) fn penetration(&self, body: &Body, grid: &Grid) -> Option<Penetration> {
        let drawing = body.drawing()?;
        Some(match self.shape(grid)? {
            Shape::Plane { point_m, normal_deg } => penetration_of_plane(&drawing, point_m, normal_deg),
            Shape::Wall(wall) | Shape::Gate(wall, _) => match drawing {
                Drawing::Rectangle(r) => penetration_of_rectangle(&r.corners_m(), &wall.corners_m()),
                other => penetration(&other, &Drawing::from(wall)),
            },
            Shape::Terrain(terrain) => penetration_of_terrain(&drawing, &terrain),
        })
    }
}

impl From<Wall> for Drawing {
    fn from(wall: Wall) -> Self {
        let corners = wall.corners_m().to_vec();
        let counter_clockwise = polygon::signed_area(&corners) >= 0.0;
        Drawing::Polygon(if counter_clockwise { corners } else { corners.into_iter().rev().collect() })
    }
}

/// How deep a body lies behind a plane; negative depth: nowhere.
fn penetration_of_plane(drawing: &Drawing, point_m: Point, normal_deg: f64) -> Penetration {
    let normal = direction(normal_deg);
    let depth = |p: &Point| -dot([p[0] - point_m[0], p[1] - point_m[1]], normal);
    let corners = match drawing {
        Drawing::Ring(_) => vec![drawing.farthest_m(normal.map(|x| -x))],
        _ => drawing.corners_m(),
    };
    Penetration { depth_m: corners.iter().map(depth).fold(f64::NEG_INFINITY, f64::max), way_out: normal }
}

/// How deep a body lies behind a terrain: the deepest of its corners, of the middles of what its sides have between two pieces of it, and of
/// the corners of the terrain in the body.
fn penetration_of_terrain(drawing: &Drawing, terrain: &Chain) -> Penetration {
    let mut deepest = Penetration { depth_m: f64::NEG_INFINITY, way_out: [0.0, 1.0] };
    let mut at = |x: Point, more: f64| {
        let near = terrain.nearest(x);
        if more - near.distance > deepest.depth_m {
            deepest = Penetration { depth_m: more - near.distance, way_out: near.normal };
        }
    };
    let corners = match drawing {
        Drawing::Ring(r) => {
            at(r.centre_m, r.radius_m);
            return deepest;
        }
        _ => drawing.corners_m(),
    };
    for side in polygon::sides(&corners) {
        let [a, b] = side;
        let mut cuts = vec![0.0, 1.0];
        cuts.extend(terrain.segments().filter_map(|s| polygon::crossing(side, s)).map(|[share, _]| share));
        cuts.sort_by(f64::total_cmp);
        let place = |s: f64| [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])];
        cuts.windows(2).for_each(|w| at(place(0.5 * (w[0] + w[1])), 0.0));
        at(a, 0.0);
    }
    for corner in terrain.points() {
        let depth_m = polygon::depth(&corners, *corner);
        if depth_m > deepest.depth_m {
            deepest = Penetration { depth_m, way_out: terrain.nearest(*corner).normal };
        }
    }
    deepest
}

/// How deep one shape lies in another, at least; depth not above zero: they do not overlap.
pub fn penetration(a: &Drawing, b: &Drawing) -> Penetration {
    match (a, b) {
        (Drawing::Rectangle(a), Drawing::Rectangle(b)) => penetration_of_rectangle(&a.corners_m(), &b.corners_m()),
        (Drawing::Ring(a), Drawing::Ring(b)) => {
            let away = [a.centre_m[0] - b.centre_m[0], a.centre_m[1] - b.centre_m[1]];
            let apart = away[0].hypot(away[1]);
            let way_out = if apart > 0.0 { away.map(|x| x / apart) } else { [1.0, 0.0] };
            let beside = a.radius_m + b.radius_m - apart;
            let within = |hole: &Ring, other: &Ring| other.radius_m + apart - hole.inner_radius_m;
            Penetration { depth_m: beside.min(within(a, b)).min(within(b, a)), way_out }
        }
        (Drawing::Ring(ring), other) => {
            let (depth_m, way_out) = penetration_of_ring(ring, &other.corners_m());
            Penetration { depth_m, way_out }
        }
        (other, Drawing::Ring(ring)) => {
            let (depth_m, way_out) = penetration_of_ring(ring, &other.corners_m());
            Penetration { depth_m, way_out: way_out.map(|x| -x) }
        }
        (a, b) => {
            let mut deepest = Penetration { depth_m: f64::NEG_INFINITY, way_out: [0.0, 0.0] };
            for part in parts(a) {
                for other in parts(b) {
                    let found = penetration_of_convex(&part, &other);
                    if found.depth_m > deepest.depth_m {
                        deepest = found;
                    }
                }
            }
            deepest
        }
    }
}

/// The convex parts of what has corners.
fn parts(drawing: &Drawing) -> Vec<Vec<Point>> {
    match drawing {
        Drawing::Rectangle(r) => vec![r.corners_m().to_vec()],
        Drawing::Polygon(p) => polygon::triangles(p).into_iter().map(|t| t.to_vec()).collect(),
        Drawing::Ring(_) => Vec::new(),
    }
}

/// How deep a ring and a polygon lie in each other, and the way out of the ring; a polygon in the hole lies in it nowhere.
fn penetration_of_ring(ring: &Ring, corners: &[Point]) -> (f64, Point) {
    let depth = polygon::depth(corners, ring.centre_m);
    let far = |p: &Point| (p[0] - ring.centre_m[0]).hypot(p[1] - ring.centre_m[1]);
    let farthest = corners.iter().map(far).fold(0.0, f64::max);
    let middle = polygon::centroid(corners);
    let away = [ring.centre_m[0] - middle[0], ring.centre_m[1] - middle[1]];
    let length = away[0].hypot(away[1]);
    let way_out = if length > 0.0 { away.map(|x| x / length) } else { [1.0, 0.0] };
    ((ring.radius_m + depth).min(farthest - ring.inner_radius_m), way_out)
}

/// How deep one convex polygon lies in another, both counter-clockwise (separating axes); depth not above zero: they do not overlap.
fn penetration_of_convex(a: &[Point], b: &[Point]) -> Penetration {
    let mut least = Penetration { depth_m: f64::INFINITY, way_out: [0.0, 0.0] };
    for (corners, sign) in [(b, 1.0), (a, -1.0)] {
        for [from, to] in polygon::sides(corners) {
            let edge = [to[0] - from[0], to[1] - from[1]];
            let length = edge[0].hypot(edge[1]);
            let outward = [edge[1] / length, -edge[0] / length];
            let other = if sign > 0.0 { a } else { b };
            let depth_m = dot(from, outward) - extent(other, outward)[0];
            if depth_m < least.depth_m {
                least = Penetration { depth_m, way_out: outward.map(|x| sign * x) };
            }
        }
    }
    least
}

/// How deep rectangle `a` lies in rectangle `b` (separating axes); depth not above zero: they do not overlap.
pub fn penetration_of_rectangle(a: &[Point; 4], b: &[Point; 4]) -> Penetration {
    let mut least = Penetration { depth_m: f64::INFINITY, way_out: [0.0, 0.0] };
    for corners in [b, a] {
        for [from, to] in [[corners[0], corners[1]], [corners[1], corners[2]]] {
            let edge = [to[0] - from[0], to[1] - from[1]];
            let length = edge[0].hypot(edge[1]);
            let axis = [-edge[1] / length, edge[0] / length];
            let ([low_a, high_a], [low_b, high_b]) = (extent(a, axis), extent(b, axis));
            for (depth_m, way_out) in [(high_b - low_a, axis), (high_a - low_b, [-axis[0], -axis[1]])] {
                if depth_m < least.depth_m {
                    least = Penetration { depth_m, way_out };
                }
            }
        }
    }
    least
}

fn extent(corners: &[Point], axis: Point) -> [f64; 2] {
    corners
        .iter()
        .map(|&p| dot(p, axis))
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], s| [low.min(s), high.max(s)])
}
