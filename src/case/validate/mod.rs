//! Checks of a case: ranges, cross references and geometry. All problems are found, not only the first.

mod bodies;
mod boundaries;
mod contacts;
mod cost;
mod doubts;
mod gauges;
mod inflows;
mod kinematics;
mod materials;
mod sections;
mod shapes;
mod sizes;
mod terrain;
mod walls;
mod warnings;

use serde::Serialize;

use super::path::KeyPath;
use super::schema::Case;

#[cfg(test)]
pub(crate) use boundaries::AGENTS;
pub use doubts::too_few_cells;

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
    checker.numbers();
    if !checker.problems.is_empty() {
        // Geometry with such numbers says nothing.
        return Findings { problems: checker.problems, warnings: Vec::new() };
    }
    checker.too_many();
    if !checker.problems.is_empty() {
        return Findings { problems: checker.problems, warnings: Vec::new() };
    }
    checker.title();
    checker.sections();
    checker.materials();
    checker.boundaries();
    checker.walls();
    checker.terrain();
    checker.bodies();
    checker.inflows();
    checker.contacts();
    checker.cost();
    // What is refused needs no warning on top.
    let refused =
        |warning: &Problem| checker.problems.iter().any(|p| p.path.is_in(&warning.path) || warning.path.is_in(&p.path));
    let warnings = warnings::warnings(case, checker.problems.is_empty()).into_iter().filter(|w| !refused(w)).collect();
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
                format!("swap the two: {} = [{high}, {low}]", path.last_key())
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

    /// Text that goes to terminals, tables and pictures as it is.
    fn control_characters(&mut self, path: &KeyPath, text: &str) {
        let plain: String = text.chars().filter(|c| !c.is_control()).collect();
        let allowed = "one line without control characters: it goes to terminals, tables and pictures as it is";
        self.not_allowed(path, &text, allowed, &format!("write {plain:?}"));
    }

    fn title(&mut self) {
        if self.case.title.contains(char::is_control) {
            self.control_characters(&KeyPath::top("title"), &self.case.title);
        }
    }

    /// Names of bodies or boundaries: not empty, no two the same.
    fn names(&mut self, list: &KeyPath, names: &[&str]) {
        for (index, name) in names.iter().enumerate() {
            let path = list.index(index).key("name");
            if name.trim().is_empty() {
                self.not_allowed(&path, name, "a name that is not empty", "give it a name such as \"sand\"");
            } else if name.contains(char::is_control) {
                self.control_characters(&path, name);
            } else if let Some(first) = names[..index].iter().position(|other| other == name) {
                let fix = format!("rename one of them: {} has the same name", list.index(first));
                let what = format!("{path} = {} is used twice", toml_text(name));
                self.problem(&path, what, name, "names that differ", &fix);
            }
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

/// A positive number for a message that is at least this one: six significant digits, rounded up, so that it is accepted when a user
/// copies it.
fn text_up(number: f64) -> String {
    text_away(number, f64::ceil, -1.0e-9)
}

/// The same, rounded down: at most this number.
fn text_down(number: f64) -> String {
    text_away(number, f64::floor, 1.0e-9)
}

fn text_away(number: f64, round: fn(f64) -> f64, slack: f64) -> String {
    if number == 0.0 || !number.is_finite() {
        return text(number);
    }
    let exponent = number.abs().log10().floor() as i32;
    let digits = number / 10.0_f64.powi(exponent) * 1.0e5;
    let rounded: f64 = format!("{}e{}", round(digits + slack * digits.abs()), exponent - 5).parse().unwrap_or(number);
    if (1.0e-4..1.0e7).contains(&rounded.abs()) { rounded.to_string() } else { format!("{rounded:e}") }
}
