//! Shapes of bodies: that each has one, whole, and that it can be filled.

use super::{Checker, text, text_up};
use crate::case::drawing::Drawing;
use crate::case::grid::Filling;
use crate::case::path::KeyPath;
use crate::case::polygon;
use crate::case::schema::{Body, MAX_POINTS};

/// The ways to write a shape: the key that tells it, the keys that go with it, whether each of these is required.
const WAYS: [(&str, &[(&str, bool)]); 4] = [
    ("x_m", &[("y_m", true)]),
    ("polygon_m", &[]),
    ("centre_m", &[("radius_m", true), ("inner_radius_m", false)]),
    ("foot_m", &[("height_m", true), ("thickness_m", true), ("inclination_deg", false), ("material_side", false)]),
];

/// How much wider a polygon may be somewhere than twice its area over its outline.
const SLENDER: f64 = 4.0;

/// Whether a body has a key of its shape.
fn has(body: &Body, key: &str) -> bool {
    match key {
        "x_m" => body.x_m.is_some(),
        "y_m" => body.y_m.is_some(),
        "polygon_m" => body.polygon_m.is_some(),
        "centre_m" => body.centre_m.is_some(),
        "radius_m" => body.radius_m.is_some(),
        "inner_radius_m" => body.inner_radius_m.is_some(),
        "foot_m" => body.foot_m.is_some(),
        "height_m" => body.height_m.is_some(),
        "thickness_m" => body.thickness_m.is_some(),
        "inclination_deg" => body.inclination_deg.is_some(),
        "material_side" => body.material_side.is_some(),
        _ => false,
    }
}

fn example(key: &str) -> &'static str {
    match key {
        "x_m" => "[-0.2, 0.0]",
        "y_m" => "[0.0, 0.5]",
        "polygon_m" => "[[0.0, 0.0], [0.4, 0.0], [0.1, 0.3]]",
        "centre_m" | "foot_m" => "[1.2, 0.0]",
        "height_m" => "0.6",
        _ => "0.1",
    }
}

impl Checker<'_> {
    /// That a body has one shape, with all of its keys.
    pub(super) fn shape(&mut self, at: &KeyPath, body: &Body) {
        let given = |(first, more): &(&str, &[(&'static str, bool)])| {
            has(body, first) || more.iter().any(|(key, _)| has(body, key))
        };
        let ways: Vec<_> = WAYS.iter().filter(|way| given(way)).collect();
        let names = "x_m and y_m; polygon_m; centre_m and radius_m; foot_m, height_m and thickness_m";
        let [(first, more)] = ways[..] else {
            let allowed = format!("a body has one shape: {names}");
            let (path, what, fix) = match ways.get(1) {
                None => (
                    at.key("x_m"),
                    format!("{at} has no shape"),
                    "add x_m = ... and y_m = ... below, or another shape".to_owned(),
                ),
                Some((key, more)) => {
                    let all = std::iter::once(*key).chain(more.iter().map(|m| m.0)).filter(|key| has(body, key));
                    let all: Vec<&str> = all.collect();
                    let key = all.first().copied().unwrap_or(key);
                    (at.key(key), format!("{at} has more than one shape"), format!("remove {}", all.join(", ")))
                }
            };
            return self.problem(&path, what, &"", &allowed, &fix);
        };
        let required = std::iter::once((*first, true)).chain(more.iter().copied());
        for key in required.filter(|(key, needed)| *needed && !has(body, key)).map(|(key, _)| key) {
            let path = at.key(key);
            let of = more.iter().map(|m| m.0).chain([*first]).find(|key| has(body, key)).unwrap_or(first);
            let (what, allowed) = (format!("{path} is missing"), format!("required by {of}"));
            self.problem(&path, what, &"", &allowed, &format!("add {key} = {} below", example(key)));
        }
        [("x_m", body.x_m), ("y_m", body.y_m)]
            .into_iter()
            .filter_map(|(key, edges)| Some((key, edges?)))
            .for_each(|(key, edges)| self.interval(&at.key(key), edges));
        for (key, length) in [
            ("radius_m", body.radius_m),
            ("inner_radius_m", body.inner_radius_m),
            ("height_m", body.height_m),
            ("thickness_m", body.thickness_m),
        ] {
            self.positive(&at.key(key), length.unwrap_or(0.1), 0.1);
        }
        self.angle(&at.key("inclination_deg"), body.inclination_deg.unwrap_or(90.0), 360.0);
        self.angle(&at.key("rotation_deg"), body.rotation_deg, 360.0);
        if body.foot_m.is_some() && body.rotation_deg != 0.0 {
            let allowed = "0 with foot_m, which has inclination_deg";
            self.not_allowed(&at.key("rotation_deg"), &body.rotation_deg, allowed, "use inclination_deg");
        }
        if let Some(points) = &body.polygon_m {
            self.polygon(&at.key("polygon_m"), points);
        }
        if let (Some(inner), Some(outer)) = (body.inner_radius_m, body.radius_m) {
            let allowed = format!("less than radius_m = {}", text(outer));
            let path = at.key("inner_radius_m");
            self.require(&path, inner, inner < outer, &allowed, "make the hole smaller, or leave it out");
        }
        if body.rectangle().is_none() && self.case.grid.filling == Filling::Square {
            let what = format!("body `{}` is no rectangle, and grid.filling = \"square\"", body.name);
            let allowed = "rectangles alone with grid.filling = \"square\"";
            self.problem(&at.key(body.place_key()), what, &"", allowed, "use grid.filling = \"fitted\"");
        }
    }

    /// Corners that make a simple polygon.
    fn polygon(&mut self, path: &KeyPath, points: &[[f64; 2]]) {
        let count = points.len();
        if !(3..=MAX_POINTS).contains(&count) {
            let what = format!("{path} has {count} corners");
            let fix = "give the corners in order, each once";
            return self.problem(path, what, &"", &format!("3 to {MAX_POINTS} corners"), fix);
        }
        if let Some([a, b]) = polygon::tangled(points, true) {
            let what = format!("{path}: the sides from corner {a} and from corner {b} cross, touch or fold back");
            let allowed = "sides that meet at their corners alone";
            let fix = "give the corners in order, each once, and several bodies for what hangs together at a point";
            self.problem(path, what, &"", allowed, fix);
        }
    }

    /// Shapes other than rectangles that hold no particle's width.
    pub(super) fn fillable(&mut self, at: &KeyPath, body: &Body) {
        let spacing = body.particle_spacing_m(&self.case.grid);
        let Some(drawing) = body.drawing() else { return };
        let narrow = match &drawing {
            Drawing::Rectangle(_) => return,
            Drawing::Polygon(corners) => {
                let least = body.size_m().into_iter().fold(f64::INFINITY, f64::min);
                // A long strip is as wide as twice its area over its outline; an equilateral triangle has a third of its height.
                let around: f64 = polygon::sides(corners).map(|[a, b]| (b[0] - a[0]).hypot(b[1] - a[1])).sum();
                let width = least.min(SLENDER * 2.0 * polygon::area(corners) / around);
                (width < spacing).then_some(width)
            }
            Drawing::Ring(r) => {
                let width = r.radius_m - r.inner_radius_m;
                (width < spacing * (1.0 - 1.0e-9)).then_some(width)
            }
        };
        let Some(width) = narrow else { return };
        let per_side = spacing / self.case.grid.spacing_m;
        let what = format!("body `{}` is thinner than a particle", body.name);
        let allowed = format!("a width of at least the particle spacing of {} m", text_up(spacing));
        let fix = format!("enlarge the body, or use grid.spacing_m = {} or less", super::text_down(width / per_side));
        self.problem(&at.key(body.place_key()), what, &"", &allowed, &fix);
    }
}

/// Whether the shape of a body is in order, so that it has an extent and an area.
pub(super) fn has_geometry(body: &Body) -> bool {
    let positive = |numbers: &[f64]| numbers.iter().all(|x| x.is_finite() && *x > 0.0);
    match body.drawing() {
        None => false,
        Some(Drawing::Rectangle(r)) => {
            let [length, height] = r.size_m;
            positive(&[length, height, 1.0 / length, 1.0 / height, body.rotation_deg.abs() + 1.0])
        }
        Some(Drawing::Polygon(p)) => {
            (3..=MAX_POINTS).contains(&p.len())
                && positive(&[polygon::area(&p)])
                && polygon::tangled(&p, true).is_none()
        }
        Some(Drawing::Ring(r)) => positive(&[r.radius_m, r.radius_m - r.inner_radius_m]) && r.inner_radius_m >= 0.0,
    }
}
