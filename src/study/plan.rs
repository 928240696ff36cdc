//! From a study to its runs.

use super::change::Change;
use super::file::{Axis, Study, StudyError};
use super::sampling::halton;
use crate::case::{self, Case};
use toml::{Table, Value};

/// One run of a study.
#[derive(Debug, Clone)]
pub struct PlannedRun {
    /// Number within the study, from 0.
    pub number: usize,
    /// Name of the case, without folder and extension.
    pub case_name: String,
    /// Factor and label of a variant; "base" and "" for an unchanged case, "axis" and "sample" for the others.
    pub factor: String,
    /// See `factor`.
    pub label: String,
    /// Which repetition; 0 is the design point itself.
    pub replicate: usize,
    /// Values of what varies, parallel to [`Study::columns`]; empty where it does not apply.
    pub values: Vec<String>,
    /// All of this in a line.
    pub what: String,
    /// The case.
    pub case: Case,
    /// Fingerprint of the case: a run with the same is the same run.
    pub key: String,
}

/// In a line, for progress and reports.
fn describe(columns: &[&str], case_name: &str, point: &Point, replicate: usize) -> String {
    let values = columns.iter().zip(&point.values).filter(|(_, v)| !v.is_empty()).map(|(c, v)| format!("{c} {v}"));
    let words = [case_name, &point.factor, &point.label].map(String::from);
    let replicate = (replicate > 0).then(|| format!("replicate {replicate}"));
    words.into_iter().filter(|w| !w.is_empty()).chain(values).chain(replicate).collect::<Vec<_>>().join(", ")
}

/// A design point: what it is called and what it changes.
struct Point {
    factor: String,
    label: String,
    values: Vec<String>,
    changes: Vec<Change>,
}

/// All runs of a study, in the order of its table. `read` gives the text of a case by the name that the study uses.
///
/// # Errors
/// The first case that cannot be read or changed, or that does not pass its checks.
pub fn plan(
    study: &Study,
    name: &str,
    read: &dyn Fn(&str) -> std::io::Result<String>,
) -> Result<Vec<PlannedRun>, StudyError> {
    let columns = study.columns();
    let points = points(study, columns.len());
    let mut runs = Vec::new();
    for file in &study.cases {
        let text = read(file).map_err(|source| {
            StudyError::Unreadable(format!(
                "error: {file} cannot be read: {source}\n --> {name}\n  = fix: cases are named relative to the study file"
            ))
        })?;
        let table: Table = toml::from_str(&text).map_err(|e| {
            StudyError::Malformed(case::parse(&text, file).err().map_or(e.to_string(), |e| e.to_string()))
        })?;
        let case_name = file.rsplit('/').next().unwrap_or(file).trim_end_matches(".toml").to_string();
        for point in &points {
            for replicate in 0..=study.replicates.as_ref().map_or(0, |r| r.count) {
                let what = describe(&columns, &case_name, point, replicate);
                let mut changed = table.clone();
                let fail = |report: String| StudyError::Case { name: name.into(), run: what.clone(), report };
                let bad_path = |what: String| {
                    fail(format!(
                        "  {what}\n  = fix: write the path as in the case, names of list elements included: bodies.sand.mass_kg"
                    ))
                };
                for change in std::iter::once(&study.base).chain(&point.changes) {
                    change.apply(&mut changed).map_err(&bad_path)?;
                }
                repetition(study, replicate, &changed).apply(&mut changed).map_err(&bad_path)?;
                let (case, key) = parse(&changed, file, name, &what)?;
                runs.push(PlannedRun {
                    number: runs.len(),
                    case_name: case_name.clone(),
                    factor: point.factor.clone(),
                    label: point.label.clone(),
                    replicate,
                    values: point.values.clone(),
                    what,
                    case,
                    key,
                });
            }
        }
    }
    Ok(runs)
}

fn parse(table: &Table, file: &str, name: &str, run: &str) -> Result<(Case, String), StudyError> {
    let fail = |report: String| StudyError::Case { name: name.into(), run: run.into(), report };
    let text = toml::to_string(table).map_err(|e| fail(e.to_string()))?;
    let loaded = case::parse(&text, &format!("{file}, as changed")).map_err(|e| fail(e.to_string()))?;
    Ok((loaded.case, format!("{:016x}", fingerprint(text.as_bytes()))))
}

/// FNV-1a, 64 bits.
pub(super) fn fingerprint(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &b| (hash ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3))
}

fn points(study: &Study, columns: usize) -> Vec<Point> {
    let empty = || vec![String::new(); columns];
    let point = |factor: &str, label: &str| Point {
        factor: factor.into(),
        label: label.into(),
        values: empty(),
        changes: Vec::new(),
    };
    let mut points = Vec::new();
    if study.axes.is_empty() && study.sample.is_none() || !study.variants.is_empty() {
        points.push(point("base", ""));
    }
    points.extend(study.variants.iter().map(|v| Point { changes: vec![v.change()], ..point(&v.factor, &v.label) }));
    let combinations: usize = study.axes.iter().map(Axis::len).product();
    for k in 0..if study.axes.is_empty() { 0 } else { combinations } {
        let mut p = point("axis", "");
        let mut rest = k;
        // The last axis varies fastest.
        for (column, axis) in study.axes.iter().enumerate().rev() {
            let (value, changes) = axis.point(rest % axis.len());
            rest /= axis.len();
            p.values[column] = shown(value);
            p.changes.extend(changes);
        }
        points.push(p);
    }
    let Some(sample) = &study.sample else { return points };
    for index in 0..sample.points {
        let mut p = point("sample", &index.to_string());
        for (d, r) in sample.ranges.iter().enumerate() {
            let share = halton(index, d);
            let value = if r.logarithmic {
                libm::exp(libm::log(r.low) + share * libm::log(r.high / r.low))
            } else {
                r.low + share * (r.high - r.low)
            };
            // Four digits are what a person would type to repeat the run.
            let text = crate::check::significant(value, 4);
            let value: f64 = text.parse().unwrap_or(value);
            p.values[study.axes.len() + d] = text;
            p.changes.extend(r.fields.iter().map(|f| Change::field(f, value)));
        }
        for (k, choice) in sample.choices.iter().enumerate() {
            let share = halton(index, sample.ranges.len() + k);
            let option = &choice.options[(share * choice.options.len() as f64) as usize];
            p.values[study.axes.len() + sample.ranges.len() + k].clone_from(&option.label);
            let (set, unset) = (option.set.clone(), option.unset.clone());
            p.changes.push(Change { set, unset, ..Change::default() });
        }
        points.push(p);
    }
    points
}

fn shown(value: &Value) -> String {
    match value {
        Value::Float(x) => crate::check::significant(*x, 9),
        Value::String(s) => s.clone(),
        other => other.to_string(),
    }
}

/// A number, whether it is written as 0.5 or as 1.
fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|n| n as f64))
}

/// The change that makes a replicate; none for the design point itself.
fn repetition(study: &Study, replicate: usize, case: &Table) -> Change {
    let mut change = Change::default();
    let Some(r) = study.replicates.as_ref().filter(|_| replicate > 0) else { return change };
    let spacing = case.get("grid").and_then(|g| g.get("spacing_m")).and_then(number);
    if let Some(h) = spacing.filter(|_| r.grid_offset_cells > 0.0) {
        let moved = |d| Value::Float(h * r.grid_offset_cells * (2.0 * halton(replicate - 1, d) - 1.0));
        change.set.insert("grid.origin_m".into(), Value::Array(vec![moved(0), moved(1)]));
    }
    for body in r.bodies.iter().filter(|_| r.jitter > 0.0) {
        change.set.insert(format!("bodies.{body}.jitter"), Value::Float(r.jitter));
        change.set.insert(format!("bodies.{body}.jitter_seed"), Value::Integer(replicate as i64));
    }
    change
}
