//! Boundaries: which fields belong to which kind, and their ranges.

use serde::Serialize;

use super::{Checker, toml_text};
use crate::boundary::BoundaryContact;
use crate::case::boundary::{Boundary, BoundaryKind, ContactKind, OpeningKind};
use crate::case::contact::BodyContact;
use crate::case::file_name;
use crate::case::path::KeyPath;
use crate::case::suggest::did_you_mean;

/// What else has columns in the table of momentum.
pub(crate) const AGENTS: [&str; 6] = ["gained", "gravity", "damping", "side_walls", "outflow", "residual"];

/// Whether a field belongs to a boundary.
#[derive(Clone, Copy, PartialEq)]
enum Need {
    Required,
    Optional,
    Refused,
}
use Need::{Optional, Refused, Required};

impl Checker<'_> {
    pub(super) fn boundaries(&mut self) {
        let list = KeyPath::top("boundaries");
        let names: Vec<&str> = self.case.boundaries.iter().map(|boundary| boundary.name.as_str()).collect();
        self.names(&list, &names);
        self.columns(&list, &names);
        for (index, boundary) in self.case.boundaries.iter().enumerate() {
            let at = list.index(index);
            self.fields_of_kind(&at, boundary);
            self.contact(&at, boundary);
            self.slip(&at, boundary);
            self.opening(&at, boundary);
            self.acts_on(&at, boundary);
            for (key, number, example) in [
                ("height_m", boundary.height_m, 0.6),
                ("lift_speed_m_per_s", boundary.lift_speed_m_per_s, 1.0),
                ("opening_m", boundary.opening_m, 0.05),
            ] {
                self.positive(&at.key(key), number.unwrap_or(example), example);
            }
            for (key, angle) in [("normal_deg", boundary.normal_deg), ("inclination_deg", boundary.inclination_deg)] {
                self.angle(&at.key(key), angle.unwrap_or(0.0), 360.0);
            }
        }
    }

    /// Each boundary has columns of its own, called by the letters and digits of its name.
    fn columns(&mut self, list: &KeyPath, names: &[&str]) {
        let of_bodies: Vec<&str> = self.case.bodies.iter().map(|b| b.name.as_str()).collect();
        self.one_column_each(&KeyPath::top("bodies"), &of_bodies);
        self.one_column_each(list, names);
        let pair =
            |c: &BodyContact| Some(format!("{}_on_{}", file_name(c.bodies.first()?), file_name(c.bodies.get(1)?)));
        let pairs: Vec<String> = self.case.contacts.iter().filter_map(pair).collect();
        for (index, name) in names.iter().enumerate() {
            let column = file_name(name);
            let taken = AGENTS.contains(&column.as_str()) || pairs.contains(&column);
            if taken {
                let allowed =
                    format!("a name that is no other column: {}, or BODY_on_BODY of a contact", AGENTS.join(", "));
                self.not_allowed(&list.index(index).key("name"), name, &allowed, &format!("write \"{name} 1\""));
            }
        }
        for (index, pair) in pairs.iter().enumerate().filter(|(k, pair)| pairs[..*k].contains(pair)) {
            let what = format!("contacts[{index}] would have the columns `{pair}` of another contact");
            let path = KeyPath::top("contacts").index(index).key("bodies");
            self.problem(
                &path,
                what,
                &"",
                "names of bodies that make columns which differ",
                "rename one of the bodies",
            );
        }
    }

    /// No two names whose letters and digits are the same.
    fn one_column_each(&mut self, list: &KeyPath, names: &[&str]) {
        let columns: Vec<String> = names.iter().map(|name| file_name(name)).collect();
        for (index, name) in names.iter().enumerate() {
            let same = |k: &usize| columns[*k] == columns[index] && names[*k] != *name;
            if let Some(first) = (0..index).find(same) {
                let allowed = format!(
                    "names whose letters and digits differ, as tables are written by them: {} is `{}`",
                    list.index(first),
                    names[first]
                );
                self.not_allowed(&list.index(index).key("name"), name, &allowed, &format!("write \"{name} {index}\""));
            }
        }
    }

    fn field<T: Serialize>(&mut self, at: &KeyPath, (key, given): (&str, &Option<T>), need: Need, of: &str) {
        let path = at.key(key);
        match (given, need) {
            (None, Required) => {
                let what = format!("{path} is missing");
                self.problem(
                    &path,
                    what,
                    &"",
                    &format!("required by {of}"),
                    &format!("add a line such as {key} = {}", example(key)),
                );
            }
            (Some(value), Refused) => {
                let what = format!("{path} = {} does not belong to {of}", toml_text(value));
                self.problem(&path, what, value, &format!("{of} does not use {key}"), "remove the line");
            }
            _ => {}
        }
    }

    fn fields_of_kind(&mut self, at: &KeyPath, boundary: &Boundary) {
        let (plane, wall, optional, of) = match boundary.kind {
            BoundaryKind::Plane => (Required, Refused, Refused, "kind = \"plane\""),
            BoundaryKind::Wall => (Refused, Required, Optional, "kind = \"wall\""),
            BoundaryKind::Gate => (Refused, Required, Optional, "kind = \"gate\""),
            BoundaryKind::Polyline => (Refused, Refused, Refused, "kind = \"polyline\""),
        };
        let (points, side) =
            if boundary.kind == BoundaryKind::Polyline { (Required, Optional) } else { (Refused, optional) };
        self.field(at, ("points_m", &boundary.points_m), points, of);
        self.field(at, ("point_m", &boundary.point_m), plane, of);
        self.field(at, ("normal_deg", &boundary.normal_deg), plane, of);
        self.field(at, ("foot_m", &boundary.foot_m), wall, of);
        self.field(at, ("height_m", &boundary.height_m), wall, of);
        self.field(at, ("inclination_deg", &boundary.inclination_deg), optional, of);
        self.field(at, ("material_side", &boundary.material_side), side, of);
        self.field(at, ("thickness_m", &boundary.thickness_m), optional, of);
    }

    fn contact(&mut self, at: &KeyPath, boundary: &Boundary) {
        let (need, of) = match boundary.contact {
            ContactKind::Smooth => (Refused, "contact = \"smooth\""),
            ContactKind::Coulomb => (Required, "contact = \"coulomb\""),
            ContactKind::Rough => (Refused, "contact = \"rough\""),
            ContactKind::Bonded => (Refused, "contact = \"bonded\""),
        };
        let path = at.key("friction");
        match boundary.friction {
            None if need == Required && boundary.friction_by_piece.is_none() => {
                let fix = "add a line such as friction = 0.4, or use contact = \"smooth\"";
                self.problem(&path, format!("{path} is missing"), &"", &format!("required by {of}"), fix);
            }
            Some(friction) if need == Refused => {
                let what = format!("{path} = {} does not belong to {of}", toml_text(&friction));
                let fix = "use contact = \"coulomb\", or remove the friction";
                self.problem(&path, what, &friction, "friction only with contact = \"coulomb\"", fix);
            }
            friction => self.not_negative(&path, friction.unwrap_or(0.0), 0.4),
        }
    }

    /// Friction that needs slip.
    fn slip(&mut self, at: &KeyPath, boundary: &Boundary) {
        let coulomb = boundary.contact == ContactKind::Coulomb;
        let refused = [("slip_length_m", boundary.slip_length_m), ("static_friction", boundary.static_friction)];
        for (key, given) in refused.into_iter().filter(|_| !coulomb) {
            let need = if given.is_some() { Refused } else { Optional };
            self.field(at, (key, &given), need, "a contact other than \"coulomb\"");
        }
        let path = at.key("slip_length_m");
        let length = boundary.slip_length_m.unwrap_or(0.0);
        self.not_negative(&path, length, 5e-4);
        if length > 0.0 && boundary.kind == BoundaryKind::Gate {
            let fix = "remove the line: a gate is in contact with material that waits";
            self.not_allowed(&path, &length, "planes and walls with slip", fix);
        } else if length > 0.0 && self.case.numerics.boundary_contact == BoundaryContact::Nodes {
            let fix = "use numerics.boundary_contact = \"surface\", or remove the line";
            self.not_allowed(&path, &length, "slip only with contact on the surface", fix);
        }
        let (Some(peak), Some(kinetic), true) = (boundary.static_friction, boundary.friction, coulomb) else { return };
        let path = at.key("static_friction");
        let allowed = format!("at least the kinetic coefficient, friction = {}", toml_text(&kinetic));
        self.require(&path, peak, peak >= kinetic, &allowed, "raise it, or remove the line");
        if peak > kinetic && length == 0.0 {
            let fix = "add a line such as slip_length_m = 0.0005";
            self.not_allowed(&path, &peak, "static friction only with a slip length, over which it falls", fix);
        }
    }

    fn acts_on(&mut self, at: &KeyPath, boundary: &Boundary) {
        self.names_of_bodies(&at.key("bodies"), boundary.bodies.as_deref());
    }

    /// A list that says which bodies something acts on.
    pub(super) fn names_of_bodies(&mut self, path: &KeyPath, names: Option<&[String]>) {
        let Some(names) = names else { return };
        if names.is_empty() {
            let fix = "name a body, or leave the line out for all bodies";
            self.not_allowed(path, &names, "at least one name", fix);
        }
        let most = self.case.bodies.len() + self.case.inflows.len() + 20;
        if names.len() > most {
            let what = format!("{path} has {} names", names.len());
            return self.problem(path, what, &"", "names of bodies, each once", "leave the line out for all bodies");
        }
        for (k, name) in names.iter().enumerate() {
            let of_inflows = self.case.inflows.iter().map(|i| i.name.as_str());
            let bodies = self.case.bodies.iter().map(|b| b.name.as_str()).chain(of_inflows);
            if !bodies.clone().any(|other| other == name) {
                let fix = did_you_mean(name, bodies);
                self.not_allowed(&path.index(k), name, "the name of one of [[bodies]]", &fix);
            }
        }
    }

    fn opening(&mut self, at: &KeyPath, boundary: &Boundary) {
        let opening = boundary.opening.unwrap_or_default();
        let (way, speed, height, of) = match (boundary.kind, opening) {
            (BoundaryKind::Plane, _) => (Refused, Refused, Refused, "kind = \"plane\""),
            (BoundaryKind::Wall, _) => (Refused, Refused, Refused, "kind = \"wall\""),
            (BoundaryKind::Polyline, _) => (Refused, Refused, Refused, "kind = \"polyline\""),
            (BoundaryKind::Gate, OpeningKind::Vanish) => (Optional, Refused, Refused, "opening = \"vanish\""),
            (BoundaryKind::Gate, OpeningKind::Lift) => (Optional, Required, Refused, "opening = \"lift\""),
            (BoundaryKind::Gate, OpeningKind::Raise) => (Optional, Optional, Required, "opening = \"raise\""),
        };
        self.field(at, ("opening", &boundary.opening), way, of);
        self.field(at, ("lift_speed_m_per_s", &boundary.lift_speed_m_per_s), speed, of);
        self.field(at, ("opening_m", &boundary.opening_m), height, of);
    }
}

fn example(key: &str) -> &'static str {
    match key {
        "point_m" | "foot_m" => "[0.0, 0.0]",
        "points_m" => "[[0.0, 0.4], [0.6, 0.1], [1.5, 0.0]]",
        "normal_deg" => "90",
        "height_m" => "0.6",
        "lift_speed_m_per_s" => "1.0",
        _ => "0.05",
    }
}
