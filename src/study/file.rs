//! The study file.

use super::change::Change;
use super::quantities::QUANTITIES;
use super::sampling::MOST_DIMENSIONS;
use crate::case::did_you_mean;
use serde::Deserialize;
use std::path::Path;
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
            Some(value) => (value, self.fields.iter().map(|f| Change::field(f, value.clone())).collect()),
            None => {
                let Level { value, set, unset } = &self.levels[k - self.values.len()];
                (value, vec![Change { set: set.clone(), unset: unset.clone(), ..Change::default() }])
            }
        }
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
    /// How many. Allowed: a whole number above 0; the sample needs 1 to 12 ranges and choices. Example: `64`.
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
    /// How many besides the design point itself. Allowed: a whole number, 0 or more. Example: `4`.
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

/// Why a study cannot be run.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A file cannot be read.
    #[error(
        "error: {name} cannot be read: {source}\n  fix: give the path of a study file, NAME.toml; cases are named relative to it"
    )]
    Unreadable {
        /// The file.
        name: String,
        /// Why.
        source: std::io::Error,
    },
    /// The text is not TOML, or its keys or types are not those of a study.
    #[error("error in {name}: {report}")]
    Malformed {
        /// The file.
        name: String,
        /// The line and what is wrong with it.
        report: String,
    },
    /// The values make no sense.
    #[error("error in {name}: {what}\n  fix: {fix}")]
    Invalid {
        /// The file.
        name: String,
        /// What is wrong.
        what: String,
        /// What to do.
        fix: String,
    },
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
    /// Reads a study file.
    ///
    /// # Errors
    /// The file cannot be read, or [`Study::parse`] refuses it.
    pub fn load(path: &Path) -> Result<Self, StudyError> {
        let name = path.display().to_string();
        let text =
            std::fs::read_to_string(path).map_err(|source| StudyError::Unreadable { name: name.clone(), source })?;
        Self::parse(&text, &name)
    }

    /// Reads the text of a study file; `name` stands for it in reports.
    ///
    /// # Errors
    /// [`StudyError::Malformed`] and [`StudyError::Invalid`].
    pub fn parse(text: &str, name: &str) -> Result<Self, StudyError> {
        let study: Self = toml::from_str(text)
            .map_err(|e| StudyError::Malformed { name: name.into(), report: e.to_string().trim_end().into() })?;
        match study.objection() {
            None => Ok(study),
            Some((what, fix)) => Err(StudyError::Invalid { name: name.into(), what, fix }),
        }
    }

    /// What is wrong and what to do about it.
    fn objection(&self) -> Option<(String, String)> {
        let say = |what: &str, fix: &str| Some((what.to_string(), fix.to_string()));
        if self.cases.is_empty() {
            return say("it has no case", "cases = [\"NAME.toml\"], relative to the study file");
        }
        for axis in &self.axes {
            if axis.is_empty() || axis.fields.is_empty() != axis.values.is_empty() {
                return say(
                    &format!("axis `{}` has no value or no field", axis.name),
                    "values = [...], fields = [\"grid.spacing_m\"]",
                );
            }
        }
        let names: Vec<&str> = self.columns();
        if let Some(k) = (1..names.len()).find(|&k| names[..k].contains(&names[k])) {
            return say(&format!("`{}` is the name of two things that vary", names[k]), "give each its own name");
        }
        if let Some(figure) = &self.figure {
            // Every other column of the table is text.
            let numbers = || names.iter().copied().chain(QUANTITIES.iter().map(|q| q.name));
            for (key, column) in [("x", &figure.x), ("y", &figure.y)] {
                if !numbers().any(|name| name == column) {
                    let what = format!("figure.{key} = \"{column}\" is neither an axis of the study nor a quantity");
                    return say(&what, &did_you_mean(column, numbers().collect::<Vec<_>>()));
                }
            }
        }
        if let Some(sample) = &self.sample {
            let dimensions = sample.ranges.len() + sample.choices.len();
            if sample.points == 0 || dimensions == 0 || dimensions > MOST_DIMENSIONS {
                let fix = format!("points > 0, and 1 to {MOST_DIMENSIONS} of [[sample.range]] and [[sample.choice]]");
                return say("the sample is empty or has too many dimensions", &fix);
            }
            for r in &sample.ranges {
                let low = if r.logarithmic { 0.0 } else { f64::NEG_INFINITY };
                if !(r.low > low && r.low < r.high && r.high.is_finite()) || r.fields.is_empty() {
                    let what = format!("range `{}` from {} to {} is empty, or it has no field", r.name, r.low, r.high);
                    return say(&what, "low < high, both positive on a logarithmic range, and fields = [...]");
                }
            }
            if let Some(c) = sample.choices.iter().find(|c| c.options.is_empty()) {
                return say(&format!("choice `{}` has no option", c.name), "add [[sample.choice.option]]");
            }
        }
        if let Some(r) = &self.replicates
            && !(0.0..=1.0).contains(&r.grid_offset_cells)
        {
            return say(&format!("replicates.grid_offset_cells = {}", r.grid_offset_cells), "0 to 1");
        }
        None
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
