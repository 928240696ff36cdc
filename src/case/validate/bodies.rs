//! Bodies: their names, materials and masses, and what they may not overlap.

use super::shapes::has_geometry;
use super::{Checker, text, text_up};
use crate::case::boundary::{Boundary, ContactKind};
use crate::case::geometry::{Penetration, penetration};
use crate::case::path::KeyPath;
use crate::case::schema::{Body, Integration};
use crate::case::suggest::did_you_mean;

/// Overlap up to this depth is rounding, m.
const OVERLAP_TOLERANCE_M: f64 = 1.0e-9;
/// Largest relative difference between `mass_kg` and density x area x thickness.
pub(super) const MASS_TOLERANCE: f64 = 1.0e-3;

impl Checker<'_> {
    pub(super) fn bodies(&mut self) {
        let list = KeyPath::top("bodies");
        if self.case.bodies.is_empty() && self.case.inflows.is_empty() {
            let what = "bodies is missing, and nothing flows in".to_owned();
            self.problem(
                &list,
                what,
                &"",
                "at least one of [[bodies]] or [[inflows]]",
                "add [[bodies]] with a material to simulate",
            );
        }
        let names: Vec<&str> = self.case.bodies.iter().map(|body| body.name.as_str()).collect();
        self.names(&list, &names);
        for (index, body) in self.case.bodies.iter().enumerate() {
            let at = list.index(index);
            self.shape(&at, body);
            if let Some(count) = body.particles_per_cell {
                self.particles_per_cell(&at, count);
            }
            if !(0.0..=0.5).contains(&body.jitter) {
                let allowed = "0 to 0.5: beyond half a spacing, neighbours change places";
                self.not_allowed(&at.key("jitter"), &body.jitter, allowed, "use 0.2, or leave it out");
            }
            let names = self.case.materials.keys().map(String::as_str);
            if !self.case.materials.contains_key(&body.material) {
                let fix = did_you_mean(&body.material, names);
                self.not_allowed(&at.key("material"), &body.material, "the name of one of [materials.NAME]", &fix);
            }
            self.mass(&at, body);
            self.integration(&at, body);
            self.kinematics(&at, body);
            if body.weightless && !self.case.contacts.iter().any(|c| c.bodies.contains(&body.name)) {
                let allowed = "true only for a body in [[contacts]]: others share their motion on the grid";
                let fix = "remove the line, or add [[contacts]] with this body";
                self.not_allowed(&at.key("weightless"), &true, allowed, fix);
            }
        }
        let grid = self.is_clean(&KeyPath::top("grid").key("spacing_m"));
        let boundaries = KeyPath::top("boundaries");
        let usable: Vec<bool> =
            (0..self.case.boundaries.len()).map(|k| grid && self.is_clean(&boundaries.index(k))).collect();
        for (index, body) in self.case.bodies.iter().enumerate().filter(|(_, body)| has_geometry(body)) {
            let at = list.index(index);
            self.inside_domain(&at, body);
            self.clear_of_boundaries(&at, body, &usable);
            let others = self.case.bodies[..index].iter().filter(|other| has_geometry(other));
            for other in others {
                let (Some(own), Some(others)) = (body.drawing(), other.drawing()) else { continue };
                let penetration = penetration(&own, &others);
                self.overlap(&at, body, penetration, &format!("body `{}`", other.name));
            }
        }
    }

    /// A body in implicit steps has a velocity field of its own, is elastic, and is held by clamps alone.
    fn integration(&mut self, at: &KeyPath, body: &Body) {
        if body.integration != Integration::Implicit {
            return;
        }
        let path = at.key("integration");
        let elastic = self.case.materials.get(&body.material).is_none_or(|m| !m.law.flows());
        let loose = |b: &&Boundary| b.acts_on(&body.name) && b.contact != ContactKind::Bonded;
        let (allowed, fix) = if !self.case.contacts.iter().any(|c| c.bodies.contains(&body.name)) {
            (
                "\"implicit\" only for a body in [[contacts]]",
                "add [[contacts]] with this body, or remove the line".to_owned(),
            )
        } else if !elastic {
            ("\"implicit\" only for an elastic law", "use law = \"neo_hookean\", or remove the line".to_owned())
        } else if let Some(boundary) = self.case.boundaries.iter().find(loose) {
            let fix =
                format!("name the bodies of boundary `{}`: bodies = [...] without `{}`", boundary.name, body.name);
            ("\"implicit\" only for a body that no boundary but clamps acts on", fix)
        } else if self.case.bodies.iter().all(|b| b.integration == Integration::Implicit)
            && self.case.numerics.max_time_step_s.is_none()
        {
            (
                "\"implicit\" only beside a body in explicit steps, whose waves give the length of a step",
                "remove the line".to_owned(),
            )
        } else {
            return;
        };
        self.not_allowed(&path, &body.integration, allowed, &fix);
    }

    fn mass(&mut self, at: &KeyPath, body: &Body) {
        let Some(mass) = body.mass_kg else { return };
        let path = at.key("mass_kg");
        self.positive(&path, mass, 30.0);
        let Some(material) = self.case.materials.get(&body.material) else {
            return;
        };
        let (density, thickness) = (material.density_kg_per_m3, self.case.grid.thickness_m);
        let [length, height] = body.size_m();
        // Of a rectangle as it always was, to the last bit.
        let (area, actual) = match body.rectangle() {
            Some(_) => (length * height, density * length * height * thickness),
            None => (body.area_m2(), density * body.area_m2() * thickness),
        };
        let usable = has_geometry(body) && [density, thickness, mass].iter().all(|x| *x > 0.0) && actual.is_finite();
        if usable && (mass - actual).abs() > MASS_TOLERANCE * actual {
            let what = format!(
                "{path} = {} differs from density x area x thickness = {} x {} x {} = {} kg",
                text(mass),
                text(density),
                text(area),
                text(thickness),
                text(actual),
            );
            let edge = body.y_m.map_or(String::new(), |[low, _]| {
                let top = rounded(low + mass / (density * length * thickness), height, f64::round);
                format!(", or y_m = [{low}, {top}]")
            });
            let fix = format!(
                "materials.{}.density_kg_per_m3 = {}{edge}, or leave mass_kg out",
                body.material,
                text(mass / (area * thickness)),
            );
            self.problem(&path, what, &mass, "equal to 0.1 %", &fix);
        }
    }

    fn inside_domain(&mut self, at: &KeyPath, body: &Body) {
        let domain = &self.case.domain;
        for (axis, key, [low, high]) in [(0, "x_m", domain.x_m), (1, "y_m", domain.y_m)] {
            let Some(drawing) = body.drawing() else { return };
            let [least, greatest] = drawing.extent_m([[1.0, 0.0], [0.0, 1.0]][axis]);
            let outside = (low - least).max(greatest - high);
            if low < high && outside > OVERLAP_TOLERANCE_M {
                let what = format!("body `{}` reaches {} m out of the domain", body.name, text(outside));
                let allowed = format!("inside domain.{key} = [{}, {}]", text(low), text(high));
                let fix = "move the body, or enlarge the domain";
                match if axis == 0 { body.x_m } else { body.y_m } {
                    Some(edges) => self.problem(&at.key(key), what, &edges, &allowed, fix),
                    None => self.problem(&at.key(body.place_key()), what, &"", &allowed, fix),
                }
            }
        }
    }

    fn clear_of_boundaries(&mut self, at: &KeyPath, body: &Body, usable: &[bool]) {
        // A clamp is there to hold what lies in it.
        let solid = |b: &&Boundary| b.acts_on(&body.name) && b.contact != ContactKind::Bonded;
        let usable = self.case.boundaries.iter().zip(usable).filter(|(b, usable)| **usable && solid(b));
        for (boundary, _) in usable {
            let Some(penetration) = boundary.penetration(body, &self.case.grid) else { continue };
            self.overlap(at, body, penetration, &format!("boundary `{}`", boundary.name));
        }
    }

    fn overlap(&mut self, at: &KeyPath, body: &Body, penetration: Penetration, other: &str) {
        let Penetration { depth_m, way_out } = penetration;
        if depth_m <= OVERLAP_TOLERANCE_M {
            return;
        }
        let what = format!("body `{}` overlaps {other} by {} m", body.name, text(depth_m));
        let axis = usize::from(way_out[1].abs() > way_out[0].abs());
        let (key, edges) = if axis == 0 { ("x_m", body.x_m) } else { ("y_m", body.y_m) };
        let straight = body.rotation_deg == 0.0 && way_out[axis].abs() == 1.0;
        let fix = match edges.and_then(|edges| cut(edges, way_out[axis] * depth_m)) {
            Some([low, high]) if straight => format!("use {key} = [{low}, {high}]"),
            _ => {
                let by = |component: f64| match component * depth_m {
                    0.0 => "0".to_owned(),
                    by => format!("{}{}", if by < 0.0 { "-" } else { "" }, text_up(by.abs())),
                };
                // Of rectangles this is the way out; of other shapes it is one that may lead into something else.
                let more = if body.rectangle().is_some() { "" } else { " or more, or draw it otherwise" };
                format!("move the body by [{}, {}] m{more}", by(way_out[0]), by(way_out[1]))
            }
        };
        let allowed = format!("outside {other}, or touching it");
        match edges {
            Some(edges) => self.problem(&at.key(key), what, &edges, &allowed, &fix),
            None => self.problem(&at.key(body.place_key()), what, &"", &allowed, &fix),
        }
    }
}

/// An interval shortened by this much at its lower end, or, if negative, at its upper end; `None` if nothing is left.
fn cut([low, high]: [f64; 2], by: f64) -> Option<[f64; 2]> {
    let length = high - low;
    let shorter = if by > 0.0 {
        [rounded(low + by, length, f64::ceil), high]
    } else {
        [low, rounded(high + by, length, f64::floor)]
    };
    (shorter[1] - shorter[0] > OVERLAP_TOLERANCE_M).then_some(shorter)
}

/// A coordinate to a millionth of a length or finer, in as few digits.
fn rounded(coordinate: f64, length: f64, round: fn(f64) -> f64) -> f64 {
    let digits = (6.0 - length.log10().floor()).clamp(0.0, 15.0);
    let scaled = coordinate * 10.0_f64.powf(digits);
    // Not what lies beyond a digit by the rounding of a subtraction alone.
    let whole = if (scaled - scaled.round()).abs() < 1.0e-6 { scaled.round() } else { round(scaled) };
    // Without the rounding of a division: 0.3, not 0.30000000000000004. An added 0 takes the sign from -0.
    format!("{whole}e-{digits}").parse().unwrap_or(coordinate) + 0.0
}
