//! Checks of a case: ranges, cross references and geometry. All problems are found, not only the first.

mod bodies;
mod boundaries;
mod contacts;
mod cost;
mod gauges;
mod kinematics;
mod materials;
mod sections;
mod walls;
mod warnings;

use serde::Serialize;

use super::path::KeyPath;
use super::schema::Case;

/// Something in a case that cannot be run, or that looks like a mistake.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// The value at fault.
    pub path: KeyPath,
    /// One sentence that says what is wrong.
    pub what: String,
    /// The value at fault as TOML; empty if it is missing.
    pub value: String,
    /// What is allowed, and why.
    pub allowed: String,
    /// What to do.
    pub fix: String,
}

/// The outcome of all checks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// Reasons not to run the case.
    pub problems: Vec<Problem>,
    /// Values that are allowed and look like mistakes.
    pub warnings: Vec<Problem>,
}

/// Checks a case as deserialised, before [`Case::resolve`].
pub fn validate(case: &Case) -> Findings {
    let mut checker = Checker { case, problems: Vec::new() };
    checker.finite_numbers();
    checker.sections();
    checker.materials();
    checker.boundaries();
    checker.walls();
    checker.bodies();
    checker.contacts();
    checker.cost();
    let warnings = if checker.problems.is_empty() { warnings::warnings(case) } else { Vec::new() };
    Findings { problems: checker.problems, warnings }
}

struct Checker<'a> {
    case: &'a Case,
    problems: Vec<Problem>,
}

impl Checker<'_> {
    fn problem(&mut self, path: &KeyPath, what: String, value: &impl Serialize, allowed: &str, fix: &str) {
        self.problems.push(Problem {
            path: path.clone(),
            what,
            value: toml_text(value),
            allowed: allowed.to_owned(),
            fix: fix.to_owned(),
        });
    }

    fn not_allowed(&mut self, path: &KeyPath, value: &impl Serialize, allowed: &str, fix: &str) {
        let what = format!("{path} = {} is not allowed", toml_text(value));
        self.problem(path, what, value, allowed, fix);
    }

    /// Reports a number unless the condition holds; numbers that are not finite have been reported already.
    fn require(&mut self, path: &KeyPath, number: f64, holds: bool, allowed: &str, fix: &str) {
        if number.is_finite() && !holds {
            self.not_allowed(path, &number, allowed, fix);
        }
    }

    fn positive(&mut self, path: &KeyPath, number: f64, example: f64) {
        let allowed = format!("{} > 0", path.last_key());
        let fix = format!("use a positive value such as {}", text(example));
        self.require(path, number, number > 0.0, &allowed, &fix);
    }

    fn not_negative(&mut self, path: &KeyPath, number: f64, example: f64) {
        let allowed = format!("{} >= 0", path.last_key());
        let fix = format!("use a value such as {}", text(example));
        self.require(path, number, number >= 0.0, &allowed, &fix);
    }

    fn angle(&mut self, path: &KeyPath, number: f64, limit: f64) {
        let allowed = format!("-{limit} <= {} <= {limit}, in degrees", path.last_key());
        let fix = "use the angle in degrees within these limits";
        self.require(path, number, number.abs() <= limit, &allowed, fix);
    }

    /// An interval whose ends must increase.
    fn interval(&mut self, path: &KeyPath, [low, high]: [f64; 2]) {
        if low.is_finite() && high.is_finite() && low >= high {
            let fix = if low > high {
                format!("swap the two: {} = [{}, {}]", path.last_key(), text(high), text(low))
            } else {
                "give the interval a length".to_owned()
            };
            self.not_allowed(path, &[low, high], "[low, high] with low < high", &fix);
        }
    }

    /// Whether nothing has been found so far in this part of the case.
    fn is_clean(&self, part: &KeyPath) -> bool {
        !self.problems.iter().any(|problem| problem.path.is_in(part))
    }

    /// Names of bodies or boundaries: not empty, no two the same.
    fn names(&mut self, list: &KeyPath, names: &[&str]) {
        for (index, name) in names.iter().enumerate() {
            let path = list.index(index).key("name");
            if name.trim().is_empty() {
                self.not_allowed(&path, name, "a name that is not empty", "give it a name such as \"sand\"");
            } else if let Some(first) = names[..index].iter().position(|other| other == name) {
                let fix = format!("rename one of them: {} has the same name", list.index(first));
                let what = format!("{path} = {} is used twice", toml_text(name));
                self.problem(&path, what, name, "names that differ", &fix);
            }
        }
    }

    /// Every number of the case is finite; TOML can write nan and inf.
    fn finite_numbers(&mut self) {
        match toml::Value::try_from(self.case) {
            Ok(value) => self.finite_numbers_in(&KeyPath::default(), &value),
            Err(error) => {
                let what = format!("the case cannot be written as TOML: {error}");
                self.problem(&KeyPath::default(), what, &"", "a case that can be written back", "report this");
            }
        }
    }

    fn finite_numbers_in(&mut self, path: &KeyPath, value: &toml::Value) {
        match value {
            toml::Value::Float(number) if !number.is_finite() => {
                self.not_allowed(path, number, "a finite number", "write a number; nan and inf have no meaning here");
            }
            toml::Value::Array(values) => {
                values.iter().enumerate().for_each(|(i, value)| self.finite_numbers_in(&path.index(i), value));
            }
            toml::Value::Table(table) => {
                table.iter().for_each(|(key, value)| self.finite_numbers_in(&path.key(key), value));
            }
            _ => {}
        }
    }
}

/// A value as it would be written in the file.
fn toml_text(value: &impl Serialize) -> String {
    toml::Value::try_from(value).map(|value| value.to_string()).unwrap_or_default()
}

/// A number for a message: six significant digits.
fn text(number: f64) -> String {
    let rounded: f64 = format!("{number:.5e}").parse().unwrap_or(number);
    if rounded == 0.0 {
        "0".to_owned()
    } else if (1.0e-4..1.0e7).contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}
