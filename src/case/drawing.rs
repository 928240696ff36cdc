//! What a body looks like at the start: a rectangle, written by its edges or as walls are, a polygon, or a disk or ring.

use super::angle::direction;
use super::boundary::MaterialSide;
use super::polygon::{self, Point, rectangle};
use super::schema::Body;
use crate::seeded::{self, Seed};

/// The rectangle of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// The corner about which it is turned, m: the lower left one, had it not been turned.
    pub corner_m: Point,
    /// Length and height, along its own axes, m.
    pub size_m: [f64; 2],
    /// Its own x axis from the x axis, degrees, counter-clockwise.
    pub rotation_deg: f64,
}

/// A disk, or a ring around a hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// Centre, m.
    pub centre_m: Point,
    /// Outer radius, m.
    pub radius_m: f64,
    /// Radius of the hole, m; 0 for a disk.
    pub inner_radius_m: f64,
}

/// What a body looks like at the start.
#[derive(Clone, Debug, PartialEq)]
pub enum Drawing {
    /// Filled by a lattice.
    Rectangle(Rectangle),
    /// A simple polygon, counter-clockwise, m.
    Polygon(Vec<Point>),
    /// A disk or a ring.
    Ring(Ring),
}

impl Rectangle {
    /// Its corners, m, counter-clockwise from the one about which it is turned.
    pub fn corners_m(&self) -> [Point; 4] {
        let [[length, height], u] = [self.size_m, direction(self.rotation_deg)];
        rectangle(self.corner_m, u, length, [-u[1], u[0]], height)
    }
}

impl Drawing {
    /// Area, m2.
    pub fn area_m2(&self) -> f64 {
        match self {
            Drawing::Rectangle(r) => r.size_m[0] * r.size_m[1],
            Drawing::Polygon(p) => polygon::area(p),
            Drawing::Ring(r) => {
                // As a product: of a thin ring, the difference of squares has lost digits.
                std::f64::consts::PI * (r.radius_m - r.inner_radius_m) * (r.radius_m + r.inner_radius_m)
            }
        }
    }

    /// Centre of the area, m.
    pub fn centroid_m(&self) -> Point {
        match self {
            Drawing::Rectangle(r) => {
                let [a, _, b, _] = r.corners_m();
                [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
            }
            Drawing::Polygon(p) => polygon::centroid(p),
            Drawing::Ring(r) => r.centre_m,
        }
    }

    /// Corners, m, counter-clockwise; none of a disk or a ring.
    pub fn corners_m(&self) -> Vec<Point> {
        match self {
            Drawing::Rectangle(r) => r.corners_m().to_vec(),
            Drawing::Polygon(p) => p.clone(),
            Drawing::Ring(_) => Vec::new(),
        }
    }

    /// The place that lies farthest along a unit vector, m.
    pub fn farthest_m(&self, way: Point) -> Point {
        let along = |p: Point| p[0] * way[0] + p[1] * way[1];
        match self {
            Drawing::Ring(r) => [0, 1].map(|d| r.centre_m[d] + r.radius_m * way[d]),
            _ => {
                let farther = |a: Point, b: Point| if along(b) > along(a) { b } else { a };
                self.corners_m().into_iter().reduce(farther).unwrap_or([f64::NAN; 2])
            }
        }
    }

    /// Least and greatest place along a unit vector, m.
    pub fn extent_m(&self, way: Point) -> [f64; 2] {
        let along = |p: Point| p[0] * way[0] + p[1] * way[1];
        [along(self.farthest_m(way.map(|x| -x))), along(self.farthest_m(way))]
    }
}

impl Body {
    /// Its rectangle, if it is written as one, by its edges or by its foot.
    pub fn rectangle(&self) -> Option<Rectangle> {
        if let (Some([left, right]), Some([low, high])) = (self.x_m, self.y_m) {
            let rotation_deg = self.rotation_deg;
            return Some(Rectangle { corner_m: [left, low], size_m: [right - left, high - low], rotation_deg });
        }
        let (foot, height, thickness) = (self.foot_m?, self.height_m?, self.thickness_m?);
        let rotation_deg = self.inclination_deg.unwrap_or(90.0) - 90.0;
        let away = direction(rotation_deg);
        // With the material on its right a body begins a thickness to the left of its face.
        let back = match self.material_side.unwrap_or_default() {
            MaterialSide::Left => 0.0,
            MaterialSide::Right => -thickness,
        };
        let back = if seeded::is(Seed::CaseBodyFoot) { back + 0.1 * thickness } else { back };
        let corner_m = [foot[0] + back * away[0], foot[1] + back * away[1]];
        Some(Rectangle { corner_m, size_m: [thickness, height], rotation_deg })
    }

    /// What it looks like at the start; `None` if what says so is missing, which validation refuses.
    pub fn drawing(&self) -> Option<Drawing> {
        if let Some(points) = &self.polygon_m {
            let mut points = points.clone();
            if polygon::signed_area(&points) < 0.0 {
                // Counter-clockwise from the same point.
                points[1..].reverse();
            }
            return Some(Drawing::Polygon(points));
        }
        if let (Some(centre_m), Some(radius_m)) = (self.centre_m, self.radius_m) {
            let inner_radius_m = self.inner_radius_m.unwrap_or(0.0);
            return Some(Drawing::Ring(Ring { centre_m, radius_m, inner_radius_m }));
        }
        self.rectangle().map(Drawing::Rectangle)
    }

    /// Length and height: of a rectangle along its own axes, of other shapes along x and y, m; not a number without a shape.
    pub fn size_m(&self) -> [f64; 2] {
        match self.drawing() {
            Some(Drawing::Rectangle(r)) => r.size_m,
            Some(other) => [[1.0, 0.0], [0.0, 1.0]].map(|way| {
                let [low, high] = other.extent_m(way);
                high - low
            }),
            None => [f64::NAN; 2],
        }
    }

    /// Its corners, m, counter-clockwise: of a rectangle from the one about which it is turned, of a polygon from its first point; none of
    /// a disk or a ring.
    pub fn corners_m(&self) -> Vec<Point> {
        self.drawing().map(|d| d.corners_m()).unwrap_or_default()
    }

    /// Area, m2; not a number without a shape.
    pub fn area_m2(&self) -> f64 {
        self.drawing().map_or(f64::NAN, |d| d.area_m2())
    }

    /// Fills in what a rectangle by its foot leaves out.
    pub(super) fn resolve(&mut self) {
        if self.foot_m.is_some() {
            self.inclination_deg.get_or_insert(90.0);
            self.material_side.get_or_insert_default();
        }
    }

    /// The key that says where it is, for reports.
    pub(super) fn place_key(&self) -> &'static str {
        match () {
            () if self.polygon_m.is_some() => "polygon_m",
            () if self.centre_m.is_some() => "centre_m",
            () if self.foot_m.is_some() => "foot_m",
            () => "x_m",
        }
    }

    /// Velocity at a place of the start, m/s, if `centre` is the middle of the body.
    pub fn velocity_at(&self, x: Point, centre: Point) -> [f64; 2] {
        let [vx, vy] = self.velocity_m_per_s;
        if self.spin_rad_per_s.is_none() && self.velocity_gradient_per_s.is_none() {
            return [vx, vy];
        }
        let spin = seeded::times(Seed::CaseSpin, self.spin_rad_per_s.unwrap_or(0.0));
        let [[xx, xy], [yx, yy]] = self.velocity_gradient_per_s.unwrap_or_default();
        let [xy, yx] = seeded::exchanged(Seed::CaseGradient, [xy, yx]);
        let [a, b] = [x[0] - centre[0], x[1] - centre[1]];
        [vx + xx * a + (xy - spin) * b, vy + (yx + spin) * a + yy * b]
    }

    /// The largest speed anywhere in it at the start, m/s.
    pub fn fastest_m_per_s(&self) -> f64 {
        let [vx, vy] = self.velocity_m_per_s;
        let uniform = vx.hypot(vy);
        let Some(drawing) = self.drawing().filter(|_| self.turns_or_strains()) else { return uniform };
        let centre = drawing.centroid_m();
        let speed = |v: [f64; 2]| v[0].hypot(v[1]);
        match &drawing {
            // Speed is convex where velocity is linear: it is largest at a corner.
            Drawing::Rectangle(_) | Drawing::Polygon(_) => {
                drawing.corners_m().into_iter().map(|x| speed(self.velocity_at(x, centre))).fold(0.0, f64::max)
            }
            Drawing::Ring(r) => {
                let [[xx, xy], [yx, yy]] = self.velocity_gradient_per_s.unwrap_or_default();
                let spin = self.spin_rad_per_s.unwrap_or(0.0);
                let squares = xx * xx + (xy - spin) * (xy - spin) + (yx + spin) * (yx + spin) + yy * yy;
                uniform + r.radius_m * squares.sqrt()
            }
        }
    }

    /// Whether its velocity at the start differs from place to place.
    pub fn turns_or_strains(&self) -> bool {
        self.spin_rad_per_s.is_some() || self.velocity_gradient_per_s.is_some()
    }
}
