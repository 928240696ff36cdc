//! Numbers and lists that no case can have: refused before anything is computed with them, or memory asked for.

use super::Checker;
use crate::case::path::KeyPath;

/// No quantity of a case in SI units is larger: squares and products of such numbers are still numbers.
const LARGEST_NUMBER: f64 = 1.0e30;
/// No length or coordinate is larger, m: further away, a number holds no tenth of a micrometre.
const LARGEST_LENGTH_M: f64 = 1.0e9;
/// The farthest place in the domain, in cells from the origin: cells are counted in 32 bits.
const FARTHEST_CELL: f64 = 1.0e9;
/// Most bodies, and most boundaries: each is compared with each of the others.
const MOST_IN_A_LIST: usize = 1000;

impl Checker<'_> {
    /// Every number of the case is finite (TOML can write nan and inf) and not absurdly large.
    pub(super) fn numbers(&mut self) {
        match toml::Value::try_from(self.case) {
            Ok(value) => self.numbers_in(&KeyPath::default(), &value),
            Err(error) => {
                let what = format!("the case cannot be written as TOML: {error}");
                self.problem(&KeyPath::default(), what, &"", "a case that can be written back", "report this");
            }
        }
    }

    fn numbers_in(&mut self, path: &KeyPath, value: &toml::Value) {
        match value {
            toml::Value::Float(number) if !number.is_finite() => {
                self.not_allowed(path, number, "a finite number", "write a number; nan and inf have no meaning here");
            }
            toml::Value::Float(number) => {
                let length = path.last_key().ends_with("_m");
                let largest = if length { LARGEST_LENGTH_M } else { LARGEST_NUMBER };
                if number.abs() > largest {
                    let allowed = format!("numbers between -{largest:e} and {largest:e}");
                    self.not_allowed(path, number, &allowed, "check the unit, which is in the name of the key");
                }
            }
            toml::Value::Array(values) => {
                values.iter().enumerate().for_each(|(i, value)| self.numbers_in(&path.index(i), value));
            }
            toml::Value::Table(table) => {
                table.iter().for_each(|(key, value)| self.numbers_in(&path.key(key), value));
            }
            _ => {}
        }
    }

    /// Lists in which each element is compared with each other.
    pub(super) fn too_many(&mut self) {
        let case = self.case;
        let lists = [
            ("materials", case.materials.len()),
            ("bodies", case.bodies.len()),
            ("inflows", case.inflows.len()),
            ("boundaries", case.boundaries.len()),
            ("contacts", case.contacts.len()),
            ("windows", case.gauges.windows.len()),
            ("barriers", case.gauges.barriers.len()),
            ("bases", case.gauges.bases.len()),
        ];
        for (key, count) in lists.into_iter().filter(|(_, count)| *count > MOST_IN_A_LIST) {
            let in_gauges = ["windows", "barriers", "bases"].contains(&key);
            let list = if in_gauges { KeyPath::top("gauges").key(key) } else { KeyPath::top(key) };
            let what = format!("{list} has {count} elements");
            let allowed = format!("at most {MOST_IN_A_LIST}");
            self.problem(&list, what, &"", &allowed, "join what touches and is alike, or leave some out");
        }
    }

    /// The domain in cells of the grid.
    pub(super) fn farthest_cell(&mut self) {
        let (h, domain) = (self.case.grid.spacing_m, &self.case.domain);
        if h <= 0.0 {
            return;
        }
        for (key, edges) in [("x_m", domain.x_m), ("y_m", domain.y_m)] {
            let farthest = edges[0].abs().max(edges[1].abs()) / h;
            if farthest > FARTHEST_CELL {
                let allowed =
                    format!("edges within {FARTHEST_CELL:e} cells of the origin; one lies {farthest:.1e} cells away");
                let fix = "move the origin to the material: subtract a constant from all coordinates";
                self.not_allowed(&KeyPath::top("domain").key(key), &edges, &allowed, fix);
            }
        }
    }
}
