//! Terrain: polylines whose pieces make sense, and what they cannot do.

use super::{Checker, text, text_down};
use crate::boundary::{BoundaryContact, Chain, Friction};
use crate::case::angle::direction;
use crate::case::boundary::{Boundary, BoundaryKind, ContactKind, MaterialSide};
use crate::case::path::KeyPath;
use crate::case::polygon;
use crate::case::schema::MAX_POINTS;

/// Ground that is thinner than so many cells has material on both sides that reaches the same nodes.
const THICK_CELLS: f64 = 3.0;
/// Scalar product of normals below which two pieces look away from each other.
const OPPOSITE: f64 = -0.5;
/// Scalar product of normals above which two surfaces go on from one another (`src/boundary/chain.rs`).
const SMOOTH: f64 = std::f64::consts::FRAC_1_SQRT_2;

impl Checker<'_> {
    pub(super) fn terrain(&mut self) {
        let list = KeyPath::top("boundaries");
        for (index, boundary) in self.case.boundaries.iter().enumerate() {
            let at = list.index(index);
            if boundary.kind != BoundaryKind::Polyline {
                if boundary.friction_by_piece.is_some() {
                    let allowed = "only with kind = \"polyline\"";
                    let path = at.key("friction_by_piece");
                    self.not_allowed(&path, &boundary.friction_by_piece, allowed, "use friction, or remove the line");
                }
                continue;
            }
            self.polyline(&at, boundary);
            self.pieces(&at, boundary);
            if self.is_clean(&at) {
                self.thick(&at, boundary);
                self.alone(&at, index, boundary);
            }
        }
    }

    /// What a polyline cannot be.
    fn polyline(&mut self, at: &KeyPath, boundary: &Boundary) {
        if boundary.contact == ContactKind::Bonded {
            let allowed = "\"smooth\", \"coulomb\" or \"rough\" for a polyline: clamps are planes and walls";
            self.not_allowed(&at.key("contact"), &boundary.contact, allowed, "use \"rough\", or a plane");
        }
        if boundary.slip_length_m.is_some_and(|l| l > 0.0) {
            let allowed = "no slip length on a polyline: planes and walls have one";
            self.not_allowed(&at.key("slip_length_m"), &boundary.slip_length_m, allowed, "remove the line");
        }
        if self.case.numerics.boundary_contact == BoundaryContact::Nodes {
            let allowed = "planes, walls and gates with numerics.boundary_contact = \"nodes\"";
            let fix = "use numerics.boundary_contact = \"surface\"";
            self.not_allowed(&at.key("kind"), &boundary.kind, allowed, fix);
        }
        for (key, names) in [
            ("barrier", self.case.gauges.barrier_names().collect::<Vec<_>>()),
            ("base", self.case.gauges.base_names().collect()),
        ] {
            if names.contains(&boundary.name.as_str()) {
                let what = format!("{} = \"{}\" is the {key} of the gauges", at.key("name"), boundary.name);
                let allowed = format!("a {key} with one face; the force on a polyline is in momentum.csv");
                self.problem(&at.key("name"), what, &boundary.name, &allowed, "name another boundary in [gauges]");
            }
        }
    }

    /// Points that make a line, and frictions that go with it.
    fn pieces(&mut self, at: &KeyPath, boundary: &Boundary) {
        let Some(points) = &boundary.points_m else { return };
        let path = at.key("points_m");
        if !(2..=MAX_POINTS).contains(&points.len()) {
            let what = format!("{path} has {} points", points.len());
            let fix = "give the points in order along the terrain";
            return self.problem(&path, what, &"", &format!("2 to {MAX_POINTS} points"), fix);
        }
        if let Some(k) = points.windows(2).position(|p| p[0] == p[1]) {
            let what = format!("{path}: points {k} and {} are the same", k + 1);
            return self.problem(&path, what, &"", "pieces with a length", "remove one of them");
        }
        if let Some([a, b]) = polygon::tangled(&prolonged(points), false) {
            let what = format!("{path}: the pieces from points {a} and {b} cross, touch or fold back");
            let allowed = "pieces that meet at their ends alone, also where the first and the last one go on straight";
            self.problem(&path, what, &"", allowed, "give the points in order, each once");
        }
        let Some(each) = &boundary.friction_by_piece else { return };
        let path = at.key("friction_by_piece");
        if boundary.contact != ContactKind::Coulomb {
            let fix = "use contact = \"coulomb\", or remove the line";
            return self.not_allowed(&path, each, "friction only with contact = \"coulomb\"", fix);
        }
        if boundary.friction.is_some() {
            let what = format!("{} and friction_by_piece are both given", at.key("friction"));
            self.problem(&path, what, each, "one of the two", "remove friction");
        }
        if each.len() + 1 != points.len() {
            let what = format!("{path} has {} numbers for {} pieces", each.len(), points.len() - 1);
            self.problem(&path, what, each, "one number for each piece", "give as many numbers as there are pieces");
        }
        for (k, friction) in each.iter().enumerate() {
            self.not_negative(&path.index(k), *friction, 0.4);
        }
    }

    /// Refuses ground between two surfaces that is thin for the grid.
    fn thick(&mut self, at: &KeyPath, boundary: &Boundary) {
        let (Some(chain), h) = (chain(boundary), self.case.grid.spacing_m) else { return };
        let pieces = chain.pieces();
        let ends = |k: usize| [<[f64; 2]>::from(pieces[k].from), pieces[k].to.into()];
        let mut thinnest = (f64::INFINITY, 0, 0);
        for (j, b) in pieces.iter().enumerate() {
            for (k, a) in pieces[..j].iter().enumerate() {
                // Behind the other's face: ground lies between them.
                let behind = ((b.from + b.to - a.from - a.to) * 0.5).dot(&a.normal) < 0.0;
                if behind && a.normal.dot(&b.normal) < OPPOSITE {
                    let apart = polygon::apart(ends(k), ends(j));
                    if apart < thinnest.0 {
                        thinnest = (apart, k, j);
                    }
                }
            }
        }
        let (apart, a, b) = thinnest;
        if apart < THICK_CELLS * h * (1.0 - 1.0e-9) {
            let path = at.key("points_m");
            let what = format!("{path}: the ground between pieces {a} and {b} is {} m thick", text(apart));
            let allowed = format!(
                "{} m or more, three cells, between pieces that look away from each other",
                text(THICK_CELLS * h)
            );
            let fix = if apart > 0.0 {
                format!("use grid.spacing_m = {} or less, or a wall", text_down(apart / THICK_CELLS))
            } else {
                "blunt the tip, or use a wall".to_owned()
            };
            self.problem(&path, what, &"", &allowed, &fix);
        }
    }

    /// Refuses what would go on from a polyline as another boundary: a plane or another polyline within 45 degrees of one of its pieces.
    fn alone(&mut self, at: &KeyPath, index: usize, boundary: &Boundary) {
        let Some(own) = chain(boundary) else { return };
        let together = |other: &Boundary| {
            let mut bodies = self.case.bodies.iter().map(|b| b.name.as_str());
            bodies.any(|name| boundary.acts_on(name) && other.acts_on(name))
        };
        let goes_on = |other: &Boundary| {
            let normals: Vec<[f64; 2]> = match other.kind {
                BoundaryKind::Plane => other.normal_deg.map(direction).into_iter().collect(),
                BoundaryKind::Polyline => {
                    chain(other).iter().flat_map(|c| c.pieces()).map(|p| p.normal.into()).collect()
                }
                BoundaryKind::Wall | BoundaryKind::Gate => Vec::new(),
            };
            let smooth = |n: &[f64; 2]| own.pieces().iter().any(|p| p.normal.x * n[0] + p.normal.y * n[1] > SMOOTH);
            other.contact != ContactKind::Bonded && normals.iter().any(smooth)
        };
        let others = self.case.boundaries.iter().enumerate();
        let other = others.filter(|(k, o)| *k != index && !(o.kind == BoundaryKind::Polyline && *k > index));
        let Some((_, other)) = other.into_iter().find(|(_, o)| together(o) && goes_on(o)) else { return };
        let what = format!("{} and boundary `{}` face the same way, within 45 degrees", at.key("points_m"), other.name);
        let allowed = "one polyline for what goes on from it; planes and polylines that make a corner beside it";
        let fix = format!("draw `{}` as pieces of the polyline, or name the bodies of each", other.name);
        self.problem(&at.key("points_m"), what, &"", allowed, &fix);
    }
}

/// The points, with the first and the last piece a thousand times as long as all of them.
fn prolonged(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let lengths = points.windows(2).map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1]));
    let far = 1.0e3 * lengths.sum::<f64>();
    let mut all = points.to_vec();
    let beyond = |from: [f64; 2], to: [f64; 2]| {
        let way = [to[0] - from[0], to[1] - from[1]];
        let length = way[0].hypot(way[1]);
        [to[0] + far * way[0] / length, to[1] + far * way[1] / length]
    };
    let n = points.len();
    (all[0], all[n - 1]) = (beyond(points[1], points[0]), beyond(points[n - 2], points[n - 1]));
    all
}

/// The chain of a polyline, whatever its friction.
fn chain(boundary: &Boundary) -> Option<Chain> {
    let mut points = boundary.points_m.clone()?;
    if boundary.material_side.unwrap_or_default() == MaterialSide::Right {
        points.reverse();
    }
    let frictions = vec![Friction::Smooth; points.len().saturating_sub(1)];
    Chain::new(points, &frictions)
}
