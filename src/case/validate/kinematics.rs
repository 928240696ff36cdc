//! Bodies in total-Lagrangian kinematics: what they are made of, and what may act on them. Structures of either kinematics: their sides.

use super::{Checker, text};
use crate::case::angle::direction;
use crate::case::boundary::{Boundary, BoundaryKind, ContactKind};
use crate::case::grid::Filling;
use crate::case::material::Law;
use crate::case::path::KeyPath;
use crate::case::schema::{Body, Kinematics};

/// Cosine of the angle between a clamp and an edge of a body that is round-off.
const SQUARE: f64 = 1.0e-9;
/// Share of the distance of particles by which a clamp may miss an edge of a mesh and still hold it.
const HELD_WITHIN: f64 = crate::simulation::HELD_WITHIN;
/// Share of the distance of particles by which the side of a body may miss a multiple of it.
const MULTIPLE: f64 = 1.0e-6;

impl Checker<'_> {
    pub(super) fn kinematics(&mut self, at: &KeyPath, body: &Body) {
        let named = |name: Option<&str>| name == Some(body.name.as_str());
        let structure = self.case.contacts.iter().any(|c| named(c.structure_name()))
            || self.case.gauges.barrier_names().any(|name| name == body.name);
        let by_mesh = body.kinematics == Kinematics::TotalLagrangian;
        if (structure || by_mesh) && body.rectangle().is_none() && body.place_key() != "x_m" {
            let what = format!("body `{}` is no rectangle", body.name);
            let needed_by =
                if by_mesh { "kinematics = \"total_lagrangian\"" } else { "a barrier, or the structure of a contact" };
            let allowed = format!("a rectangle for {needed_by}");
            return self.problem(&at.key(body.place_key()), what, &"", &allowed, "draw it as a rectangle");
        }
        if by_mesh && body.turns_or_strains() {
            let key = if body.spin_rad_per_s.is_some() { "spin_rad_per_s" } else { "velocity_gradient_per_s" };
            let what = format!("{} is given with kinematics = \"total_lagrangian\"", at.key(key));
            let allowed = "one velocity for a body by its mesh";
            self.problem(&at.key(key), what, &"", allowed, "use velocity_m_per_s alone, or another kinematics");
        }
        if (structure || by_mesh) && body.jitter > 0.0 {
            let allowed = "0 for a structure, whose faces are traced along the lattice of its particles";
            let fix = "leave it out; in a study: replicates.bodies = [...] without it";
            self.not_allowed(&at.key("jitter"), &body.jitter, allowed, fix);
        }
        if !by_mesh {
            if structure && self.case.grid.filling == Filling::Fitted {
                self.multiples(at, body, "a structure, whose faces are traced along particles as far apart both ways");
            }
            return;
        }
        let path = at.key("kinematics");
        let acts = |b: &&Boundary| b.acts_on(&body.name);
        let spare =
            |b: &Boundary| format!("name the bodies of boundary `{}`: bodies = [...] without `{}`", b.name, body.name);
        let boundaries = || self.case.boundaries.iter().filter(acts);
        let law = self.case.materials.get(&body.material).map(|m| m.law);
        let alone = self.case.bodies.len() > 1 && !self.case.contacts.iter().any(|c| c.bodies.contains(&body.name));
        let walls = &self.case.side_walls;
        let near = HELD_WITHIN * body.particle_spacing_m(&self.case.grid);
        let (allowed, fix) = if law.is_some_and(|law| law != Law::NeoHookean) {
            (
                "\"total_lagrangian\" only for a body with law = \"neo_hookean\"",
                "use that law, or remove the line".to_owned(),
            )
        } else if alone {
            (
                "\"total_lagrangian\" only for a body in [[contacts]], or the only one",
                "add [[contacts]] with this body, or remove the line".to_owned(),
            )
        } else if let Some(boundary) = boundaries().find(|b| b.contact != ContactKind::Bonded) {
            ("\"total_lagrangian\" only for a body that no boundary but clamps acts on", spare(boundary))
        } else if let Some(boundary) = boundaries().find(|b| !is_square(b, body)) {
            let fix = format!("turn boundary `{}` to an edge of the body, or remove the line", boundary.name);
            ("\"total_lagrangian\" only with clamps that are planes along an edge of the body", fix)
        } else if let Some((boundary, gap)) =
            boundaries().find_map(|b| Some((b, beside(b, body)?)).filter(|(_, gap)| *gap > near))
        {
            let fix = format!("move boundary `{}` by {} m against its normal, or the body", boundary.name, text(gap));
            ("\"total_lagrangian\" only with clamps that reach the body", fix)
        } else if walls.friction > 0.0 && walls.act_on(&body.name) {
            let fix = format!("name the others: side_walls.bodies = [...] without `{}`", body.name);
            ("\"total_lagrangian\" only for a body that side walls do not touch", fix)
        } else {
            return self.multiples(at, body, "kinematics = \"total_lagrangian\"");
        };
        self.not_allowed(&path, &body.kinematics, allowed, &fix);
    }

    /// The particles fill the rectangle that is drawn.
    fn multiples(&mut self, at: &KeyPath, body: &Body, needed_by: &str) {
        let spacing = body.particle_spacing_m(&self.case.grid);
        let edges = match (body.x_m, body.y_m, body.rectangle()) {
            (Some(x), Some(y), _) => [("x_m", x), ("y_m", y)],
            (_, _, Some(r)) => [("thickness_m", [0.0, r.size_m[0]]), ("height_m", [0.0, r.size_m[1]])],
            _ => return,
        };
        for (key, [low, high]) in edges {
            let count = (high - low) / spacing;
            let nearest = count.round().max(1.0);
            if count.is_finite() && (count - nearest).abs() > MULTIPLE * count.max(1.0) {
                let what = format!("body `{}` is {} distances of its particles long", body.name, text(count));
                let allowed = format!("a multiple of {} m, for {needed_by}", text(spacing));
                if body.x_m.is_none() {
                    let fix = format!("use {key} = {}", text(nearest * spacing));
                    self.problem(&at.key(key), what, &high, &allowed, &fix);
                    continue;
                }
                let fix = format!("use {key} = [{}, {}]", text(low), text(low + nearest * spacing));
                self.problem(&at.key(key), what, &[low, high], &allowed, &fix);
            }
        }
    }
}

/// Whether a boundary is a plane along an edge of the body; also where it lacks what says so, which is refused elsewhere.
fn is_square(boundary: &Boundary, body: &Body) -> bool {
    let Some(angle) = boundary.normal_deg.filter(|_| boundary.kind == BoundaryKind::Plane) else {
        return boundary.kind == BoundaryKind::Plane;
    };
    let rotation = body.rectangle().map_or(body.rotation_deg, |r| r.rotation_deg);
    let [c, s] = direction(angle - rotation);
    c.abs().min(s.abs()) < SQUARE
}

/// How far a plane is from a body before it, m; negative where it reaches into the body, `None` where it lacks what says so.
fn beside(boundary: &Boundary, body: &Body) -> Option<f64> {
    let ([nx, ny], [x, y]) = (direction(boundary.normal_deg?), boundary.point_m?);
    let heights = body.corners_m().into_iter().map(|c| (c[0] - x) * nx + (c[1] - y) * ny);
    Some(heights.fold(f64::INFINITY, f64::min))
}
