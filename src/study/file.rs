//! The study file.

use super::change::Change;
use crate::seeded::{self, Seed};
use serde::Deserialize;
use toml::Value;

/// What a study varies. All of `[[axis]]`, `[[variant]]` and `[sample]` may be given: their runs are added up.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// One line that names the study. Allowed: any text. Example: `"Friction of the base"`.
    pub title: String,
    /// Case files, relative to the study file; every design point is run on each. Allowed: at least one path. Example:
    /// `["../40deg.toml"]`.
    pub cases: Vec<String>,
    /// Changes of all runs, before any other.
    #[serde(default)]
    pub base: Change,
    /// Every combination of the values of all axes.
    #[serde(default, rename = "axis")]
    pub axes: Vec<Axis>,
    /// Changes made one at a time, besides the unchanged cases.
    #[serde(default, rename = "variant")]
    pub variants: Vec<Variant>,
    /// A space-filling sample.
    pub sample: Option<Sample>,
    /// Repetitions of every design point on other grids and packings.
    pub replicates: Option<Replicates>,
    /// What to draw.
    pub figure: Option<Figure>,
}

/// A field and its values.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// Column of the table; ends in the unit. Allowed: a name that no other axis, range or choice has. Example:
    /// `"friction_1"`.
    pub name: String,
    /// Fields that take the value. Default: `[]`. Allowed: paths in the case; given if `values` is, and only then.
    /// Example: `["boundaries.base.friction"]`.
    #[serde(default)]
    pub fields: Vec<String>,
    /// The values, as they would be written in a case file. Default: `[]`. Allowed: at least one of `values` or one
    /// `[[axis.level]]`. Example: `[0.3, 0.4, 0.5]`.
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "Vec<serde_json::Value>"))]
    pub values: Vec<Value>,
    /// Values that stand for several changes at once, after those of `values`.
    #[serde(default, rename = "level")]
    pub levels: Vec<Level>,
}

/// A value of an axis and what it stands for.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Level {
    /// What stands in the column. Allowed: a number or text. Example: `1.0e-3`.
    #[cfg_attr(test, schemars(with = "serde_json::Value"))]
    pub value: Value,
    /// Fields and their new values. Default: none. Allowed: paths in the case, quoted, and values as in a case file.
    /// Example: `{ "materials.sand.young_pa" = 2.0e6 }`.
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "serde_json::Map<String, serde_json::Value>"))]
    pub set: toml::Table,
    /// Fields that are taken out. Default: none. Allowed: paths of fields that stand in the case. Example:
    /// `["bodies.sand.mass_kg"]`.
    #[serde(default)]
    pub unset: Vec<String>,
}

impl Axis {
    /// Number of values.
    pub fn len(&self) -> usize {
        self.values.len() + self.levels.len()
    }

    /// Whether it has no value.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A value and what it changes.
    pub fn point(&self, k: usize) -> (&Value, Vec<Change>) {
        match self.values.get(k) {
            Some(value) => (value, self.fields.iter().map(|f| Change::field(f, given(value))).collect()),
            None => {
                let Level { value, set, unset } = &self.levels[k - self.values.len()];
                (value, vec![Change { set: set.clone(), unset: unset.clone(), ..Change::default() }])
            }
        }
    }
}

/// A value as a run gets it.
fn given(value: &Value) -> Value {
    match value {
        Value::Float(number) => Value::Float(seeded::times(Seed::StudyChange, *number)),
        other => other.clone(),
    }
}

/// One change with a name.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Variant {
    /// What is varied: variants of the same factor belong together. Allowed: any text. Example: `"cone"`.
    pub factor: String,
    /// To what. Allowed: any text. Example: `"plane strain"`.
    pub label: String,
    /// Fields and their new values. Default: none. Allowed: paths in the case, quoted, and values as in a case file.
    /// Example: `{ "materials.sand.young_pa" = 2.0e6 }`.
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "serde_json::Map<String, serde_json::Value>"))]
    pub set: toml::Table,
    /// Fields that are taken out. Default: none. Allowed: paths of fields that stand in the case. Example:
    /// `["bodies.sand.mass_kg"]`.
    #[serde(default)]
    pub unset: Vec<String>,
    /// Lists and the elements that are added to them. Default: none. Allowed: paths of lists, quoted, and lists of
    /// values. Example: `{ "gauges.stations_m" = [0.9] }`.
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "serde_json::Map<String, serde_json::Value>"))]
    pub append: toml::Table,
}

impl Variant {
    /// What it changes.
    pub fn change(&self) -> Change {
        Change { set: self.set.clone(), unset: self.unset.clone(), append: self.append.clone() }
    }
}

/// Points that fill the space of some ranges and choices evenly (Halton 1960).
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Sample {
    /// How many. Allowed: a whole number above 0; the sample needs 1 to 12 ranges and choices, and a study has at most
    /// 100000 runs. Example: `64`.
    pub points: usize,
    /// Ranges of numbers.
    #[serde(default, rename = "range")]
    pub ranges: Vec<Range>,
    /// Choices between changes.
    #[serde(default, rename = "choice")]
    pub choices: Vec<Choice>,
}

/// A field whose number is drawn between two.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Range {
    /// Column of the table; ends in the unit. Allowed: a name that no other axis, range or choice has. Example:
    /// `"friction_1"`.
    pub name: String,
    /// Fields that take the number. Allowed: at least one path in the case. Example: `["boundaries.base.friction"]`.
    pub fields: Vec<String>,
    /// Least, in the unit of the fields. Allowed: below `high`; above 0 if `logarithmic`. Example: `0.3`.
    pub low: f64,
    /// Greatest, in the unit of the fields. Allowed: above `low`. Example: `0.5`.
    pub high: f64,
    /// Evenly in the logarithm. Default: `false`.
    #[serde(default)]
    pub logarithmic: bool,
}

/// A choice between changes, each as likely as the others.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Choice {
    /// Column of the table. Allowed: a name that no other axis, range or choice has. Example: `"cone"`.
    pub name: String,
    /// The options. At least one.
    #[serde(rename = "option")]
    pub options: Vec<Option_>,
}

/// One of a choice.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Option_ {
    /// What stands in the table. Allowed: any text. Example: `"plane strain"`.
    pub label: String,
    /// Fields and their new values. Default: none. Allowed: paths in the case, quoted, and values as in a case file.
    /// Example: `{ "materials.sand.young_pa" = 2.0e6 }`.
    #[serde(default)]
    #[cfg_attr(test, schemars(with = "serde_json::Map<String, serde_json::Value>"))]
    pub set: toml::Table,
    /// Fields that are taken out. Default: none. Allowed: paths of fields that stand in the case. Example:
    /// `["bodies.sand.mass_kg"]`.
    #[serde(default)]
    pub unset: Vec<String>,
}

/// Repetitions that should not matter: the grid moved by a part of a cell, the particles moved by a part of their spacing.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Replicates {
    /// How many besides the design point itself. Allowed: a whole number, 0 or more; at most 100000 runs in a study. Example:
    /// `4`.
    pub count: usize,
    /// Largest displacement of the grid, in either direction. Default: `0.0`. Allowed: 0 to 1. Example: `0.5`.
    #[serde(default)]
    pub grid_offset_cells: f64,
    /// Largest displacement of the particles over their spacing; see `jitter` in `[[bodies]]`. Default: `0.0`. Allowed:
    /// 0 to 0.5. Example: `0.2`.
    #[serde(default)]
    pub jitter: f64,
    /// Bodies whose particles are moved. Default: `[]`. Allowed: names of bodies of the case. Example: `["sand"]`.
    #[serde(default)]
    pub bodies: Vec<String>,
}

/// A quantity against an axis, one curve per case.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Figure {
    /// Column along the horizontal axis. Allowed: a column of the study's table. Example: `"friction_1"`.
    pub x: String,
    /// Column of the quantity. Allowed: a column of the study's table. Example: `"static_force_n"`.
    pub y: String,
    /// Whether both axes are logarithmic. Default: `false`.
    #[serde(default)]
    pub logarithmic: bool,
}

/// Why a study cannot be run. `Display` gives the report for the user, several lines long.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A file cannot be read.
    #[error("{0}")]
    Unreadable(String),
    /// The text is not TOML, or its keys or types are not those of a study.
    #[error("{0}")]
    Malformed(String),
    /// The values make no sense.
    #[error("{0}")]
    Invalid(String),
    /// A change makes a case that cannot be run.
    #[error("error in {name}: {run} cannot be run\n{report}")]
    Case {
        /// The file.
        name: String,
        /// The run.
        run: String,
        /// The report on the case.
        report: String,
    },
    /// A file of the results.
    #[error(transparent)]
    Output(#[from] crate::output::OutputError),
    /// A figure.
    #[error(transparent)]
    Plot(#[from] crate::plot::PlotError),
}

impl Study {
    /// How many runs it asks for.
    pub fn run_count(&self) -> f64 {
        let base = f64::from(u8::from(self.axes.is_empty() && self.sample.is_none() || !self.variants.is_empty()));
        let combinations: f64 = self.axes.iter().map(|axis| axis.len() as f64).product();
        let axes = if self.axes.is_empty() { 0.0 } else { combinations };
        let sample = self.sample.as_ref().map_or(0.0, |s| s.points as f64);
        let repetitions = 1.0 + self.replicates.as_ref().map_or(0.0, |r| r.count as f64);
        self.cases.len() as f64 * (base + self.variants.len() as f64 + axes + sample) * repetitions
    }

    /// Columns of what varies, besides factor and label.
    pub fn columns(&self) -> Vec<&str> {
        let sample = self
            .sample
            .iter()
            .flat_map(|s| s.ranges.iter().map(|r| r.name.as_str()).chain(s.choices.iter().map(|c| c.name.as_str())));
        self.axes.iter().map(|a| a.name.as_str()).chain(sample).collect()
    }
}
