//! Plane geometry for the checks: rectangles, half spaces, and how deep one lies in the other.

use super::angle::direction;
use super::boundary::{Boundary, MaterialSide, Shape, Wall};
use super::grid::Grid;
use super::schema::Body;

/// A point or a direction, m.
pub type Point = [f64; 2];

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

fn rectangle(corner: Point, u: Point, length_u: f64, v: Point, length_v: f64) -> [Point; 4] {
    let at = |a: f64, b: f64| [corner[0] + a * u[0] + b * v[0], corner[1] + a * u[1] + b * v[1]];
    [at(0.0, 0.0), at(length_u, 0.0), at(length_u, length_v), at(0.0, length_v)]
}

impl Body {
    /// The four corners, m, counter-clockwise from the lower left one, after rotation.
    pub fn corners_m(&self) -> [Point; 4] {
        let [length, height] = self.size_m();
        let u = direction(self.rotation_deg);
        rectangle([self.x_m[0], self.y_m[0]], u, length, [-u[1], u[0]], height)
    }
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
        let corners = body.corners_m();
        Some(match self.shape(grid)? {
            Shape::Plane { point_m, normal_deg } => penetration_of_plane(&corners, point_m, normal_deg),
            Shape::Wall(wall) | Shape::Gate(wall, _) => penetration_of_rectangle(&corners, &wall.corners_m()),
        })
    }
}

/// How deep the corners lie behind a plane; negative depth: nowhere.
fn penetration_of_plane(corners: &[Point; 4], point_m: Point, normal_deg: f64) -> Penetration {
    let normal = direction(normal_deg);
    let depth = |p: &Point| -dot([p[0] - point_m[0], p[1] - point_m[1]], normal);
    Penetration { depth_m: corners.iter().map(depth).fold(f64::NEG_INFINITY, f64::max), way_out: normal }
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

fn extent(corners: &[Point; 4], axis: Point) -> [f64; 2] {
    corners
        .iter()
        .map(|&p| dot(p, axis))
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], s| [low.min(s), high.max(s)])
}
