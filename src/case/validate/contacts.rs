//! Contacts of bodies: whose they are, which fields belong together, and that no body is forgotten.

use std::collections::BTreeSet;

use super::{Checker, toml_text};
use crate::case::contact::{BodyContact, GapKind, NormalKind};
use crate::case::path::KeyPath;
use crate::case::suggest::did_you_mean;
use crate::contact::rule::MAX_SIDES;

impl Checker<'_> {
    pub(super) fn contacts(&mut self) {
        let list = KeyPath::top("contacts");
        for (index, contact) in self.case.contacts.iter().enumerate() {
            let at = list.index(index);
            self.contact_bodies(&at, index, contact);
            self.not_negative(&at.key("friction"), contact.friction, 0.4);
            self.contact_fields(&at, contact);
            self.contact_structure(&at, contact);
        }
        if self.is_clean(&list) && self.is_clean(&KeyPath::top("bodies")) {
            self.forgotten(&list);
        }
    }

    fn contact_bodies(&mut self, at: &KeyPath, index: usize, contact: &BodyContact) {
        let path = at.key("bodies");
        let names = || self.case.bodies.iter().map(|b| b.name.as_str());
        let unknown: Vec<(usize, String)> = contact
            .bodies
            .iter()
            .enumerate()
            .take(2)
            .filter(|(_, name)| !names().any(|other| other == *name))
            .map(|(k, name)| (k, did_you_mean(name, names())))
            .collect();
        for (k, fix) in unknown {
            self.not_allowed(&path.index(k), &contact.bodies[k], "the name of one of [[bodies]]", &fix);
        }
        let [first, second] = &contact.bodies[..] else {
            let fix = "name two bodies: bodies = [\"barrier\", \"sand\"]";
            return self.not_allowed(&path, &contact.bodies, "two names", fix);
        };
        if first == second {
            return self.not_allowed(&path, &contact.bodies, "two different bodies", "name the other body");
        }
        let same = |other: &BodyContact| other.bodies.contains(first) && other.bodies.contains(second);
        if let Some(earlier) = self.case.contacts[..index].iter().position(same) {
            let fix = format!("remove one of them: contacts[{earlier}] has the same two bodies");
            self.not_allowed(&path, &contact.bodies, "one contact for two bodies", &fix);
        }
    }

    fn contact_fields(&mut self, at: &KeyPath, contact: &BodyContact) {
        let (normal, gap) = (contact.normal.unwrap_or_default(), contact.gap.unwrap_or_default());
        if let Some(structure) = &contact.structure {
            let path = at.key("structure");
            if normal != NormalKind::NearestFace {
                let what = format!("{path} = {} is not used", toml_text(structure));
                let fix = "remove the line, or use normal = \"nearest_face\"";
                self.problem(&path, what, structure, "only with normal = \"nearest_face\"", fix);
            } else if !contact.bodies.contains(structure) {
                let fix = did_you_mean(structure, contact.bodies.iter().map(String::as_str));
                self.not_allowed(&path, structure, "one of the two bodies of the contact", &fix);
            }
        }
        let path = at.key("normal_deg");
        match (normal, contact.normal_deg) {
            (NormalKind::Prescribed, None) => {
                let fix = "add a line such as normal_deg = 90";
                let what = format!("{path} is missing");
                self.problem(&path, what, &"", "required by normal = \"prescribed\"", fix);
            }
            (NormalKind::Prescribed, Some(angle)) => self.angle(&path, angle, 360.0),
            (_, Some(angle)) => {
                let what = format!("{path} = {} is not used", toml_text(&angle));
                let fix = "remove the line, or use normal = \"prescribed\"";
                self.problem(&path, what, &angle, "only with normal = \"prescribed\"", fix);
            }
            (_, None) => {}
        }
        if let Some(offset) = contact.offset_cells {
            let path = at.key("offset_cells");
            if gap == GapKind::Positions {
                self.positive(&path, offset, BodyContact::DEFAULT_OFFSET_CELLS);
            } else {
                let what = format!("{path} = {} is not used", toml_text(&offset));
                let fix = "remove the line, or use gap = \"positions\"";
                self.problem(&path, what, &offset, "only with gap = \"positions\"", fix);
            }
        }
    }

    /// The faces of a structure are those that it starts with: what flows has none to keep. Gradients of two bodies, with a gap from
    /// the extents of their points, let a block stick or slide half as far as it should (rung `contact`).
    fn contact_structure(&mut self, at: &KeyPath, contact: &BodyContact) {
        let granular = |name: &str| {
            let body = self.case.bodies.iter().find(|b| b.name == name);
            body.and_then(|b| self.case.materials.get(&b.material)).is_some_and(|m| m.law.flows())
        };
        let (normal, gap) = (contact.normal.unwrap_or_default(), contact.gap.unwrap_or_default());
        if normal == NormalKind::Average && gap == GapKind::Extents {
            let allowed = "normal = \"average\" only with another gap: with this one a block sticks, or slides half as far as it should";
            let fix = "use normal = \"nearest_face\", or gap = \"positions\" or \"approach\"";
            self.not_allowed(&at.key("normal"), &"average", allowed, fix);
        }
        let Some(structure) = contact.structure_name().filter(|_| normal == NormalKind::NearestFace) else { return };
        if !granular(structure) {
            return;
        }
        let allowed = "a structure that keeps its faces, so not a granular body or another one that flows";
        let other = contact.bodies.iter().find(|name| *name != structure && !granular(name));
        let fix = match other {
            Some(other) => format!("add structure = \"{other}\", or name `{other}` first"),
            None => "use normal = \"regression\": neither of the two keeps its faces".to_owned(),
        };
        let path = at.key(if contact.structure.is_some() { "structure" } else { "bodies" });
        let what =
            format!("{path}: `{structure}` would be the structure of the contact, and is granular or flows otherwise");
        self.problem(&path, what, &structure, allowed, &fix);
    }

    /// A body that is in a contact passes through bodies with which it has none.
    fn forgotten(&mut self, list: &KeyPath) {
        let (bodies, contacts) = (&self.case.bodies, &self.case.contacts);
        let in_contacts: BTreeSet<&String> = contacts.iter().flat_map(|c| &c.bodies).collect();
        let named = |name: &String| in_contacts.contains(name);
        let pairs = bodies.iter().enumerate().flat_map(|(k, b)| bodies[..k].iter().map(move |a| (&a.name, &b.name)));
        let missing = pairs
            .filter(|(a, b)| named(a) || named(b))
            .find(|(a, b)| !contacts.iter().any(|c| c.bodies.contains(a) && c.bodies.contains(b)));
        if let Some((a, b)) = missing {
            let what = format!("bodies `{a}` and `{b}` have no contact");
            let allowed = "a body that is in a contact passes through every body with which it has none";
            let fix = format!("add [[contacts]] with bodies = [\"{a}\", \"{b}\"]");
            self.problem(list, what, &"", allowed, &fix);
        }
        if bodies.iter().filter(|b| named(&b.name)).count() > MAX_SIDES {
            let what = format!("more than {MAX_SIDES} bodies are in contacts");
            let allowed = format!("at most {MAX_SIDES}: so many can meet at a node");
            self.problem(list, what, &"", &allowed, "leave bodies that may stick together out of the contacts");
        }
    }
}
