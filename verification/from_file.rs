//! Runs a case given as text, as the command does, and reads back by name every number that it left in its folder.
//!
//! The folder is a fresh one below the system's folder for temporary files, and is gone when [`Files::run`] returns. Every number has one
//! name, its key: `summary.toml/barrier.static_force_n`, `history.csv/front_x_m`, `flow.vtp/stress_pa.xx`, `boundaries.vtp/Points.x`,
//! `flow.pvd/timestep`. A number that is not there reads as NaN; [`largest`] keeps it, and no check passes with it.
//!
//! What is read can be made [wrong](Wrong) on its way: what a judgement makes of that says which numbers it closes.

use super::RungFailure;
use checkdam::case;
use checkdam::output::Table;
use checkdam::run;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// The largest magnitude; NaN where one is.
pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |a: f64, x| if a.is_nan() || x.is_nan() { f64::NAN } else { a.max(x.abs()) })
}

/// How many; NaN where one of the values is.
pub fn count(values: &[f64], of: impl Fn(&f64) -> bool) -> f64 {
    if values.iter().any(|x| x.is_nan()) { f64::NAN } else { values.iter().filter(|x| of(x)).count() as f64 }
}

/// A mistake in what is read.
#[derive(Debug, Clone, PartialEq)]
pub enum Wrong {
    /// All values of a key are multiplied by this.
    Scaled(String, f64),
    /// Each of two keys has the values of the other.
    Exchanged(String, String),
}

/// What a run left in its folder.
#[derive(Debug, Clone)]
pub struct Files {
    data: Arc<Data>,
    wrong: Option<Wrong>,
}

#[derive(Debug, Default)]
struct Data {
    summary: toml::Table,
    /// By name of the file.
    tables: BTreeMap<String, Table>,
    /// Of `flow.pvd`: the time of each frame, s, and its arrays.
    frames: Vec<(f64, Vtk)>,
    outlines: Option<Vtk>,
    /// All files, below the folder.
    names: Vec<String>,
}

impl Files {
    /// Runs the case of this text to its end.
    ///
    /// # Errors
    /// Its text is no case, the run fails, or a file cannot be written or read back.
    pub fn run(text: &str) -> Result<Self, RungFailure> {
        let case = case::parse(text, "case.toml").map_err(failed)?.case;
        let folder = Folder::new()?;
        run::files::prepare_directory(&folder.0).map_err(failed)?;
        run::run(&case, Some(&folder.0), &mut |_| true).map_err(failed)?;
        Ok(Self { data: Arc::new(Data::read(&folder.0)?), wrong: None })
    }

    /// The same files, of which something is wrong.
    pub fn made_wrong(&self, wrong: Wrong) -> Self {
        Self { data: self.data.clone(), wrong: Some(wrong) }
    }

    /// Names of all files, in order; those in folders with the folder before them.
    pub fn names(&self) -> &[String] {
        &self.data.names
    }

    /// Keys of all numbers, in order. Those of the inputs, which stand in the summary below `case`, are among them.
    pub fn keys(&self) -> Vec<String> {
        let mut keys = Vec::new();
        leaves("", &toml::Value::Table(self.data.summary.clone()), &mut |key, value| {
            keys.extend(number(value).map(|_| format!("summary.toml/{key}")));
        });
        for (file, table) in &self.data.tables {
            keys.extend(table.names().iter().map(|name| format!("{file}/{name}")));
        }
        let mut vtk = |file: &str, vtk: &Vtk| keys.extend(vtk.names().iter().map(|name| format!("{file}/{name}")));
        self.data.frames.first().into_iter().for_each(|frame| vtk("flow.vtp", &frame.1));
        self.data.outlines.iter().for_each(|outlines| vtk("boundaries.vtp", outlines));
        if !self.data.frames.is_empty() {
            keys.push("flow.pvd/timestep".into());
        }
        keys
    }

    /// The number of the summary with these keys, dots between them: `barrier.static_force_n`, `front.0.x_m`. NaN if it is not there, or no
    /// number.
    pub fn number(&self, key: &str) -> f64 {
        self.values(&format!("summary.toml/{key}")).first().copied().unwrap_or(f64::NAN)
    }

    /// Whether the summary has something with these keys.
    pub fn has(&self, key: &str) -> bool {
        self.leaf(key).is_some()
    }

    /// A text of the summary; empty if it is not there.
    pub fn text(&self, key: &str) -> &str {
        self.leaf(key).and_then(toml::Value::as_str).unwrap_or_default()
    }

    /// A yes or no of the summary.
    pub fn flag(&self, key: &str) -> Option<bool> {
        self.leaf(key).and_then(toml::Value::as_bool)
    }

    /// The summary as it was read, whatever is wrong.
    pub fn summary(&self) -> &toml::Table {
        &self.data.summary
    }

    /// Number of rows of a table; 0 without it.
    pub fn rows(&self, file: &str) -> usize {
        self.data.tables.get(file).map_or(0, Table::rows)
    }

    /// A column of a table; one NaN if it is not there or has no rows.
    pub fn column(&self, file: &str, name: &str) -> Vec<f64> {
        or_nan(self.values(&format!("{file}/{name}")))
    }

    /// Number of VTK frames.
    pub fn frames(&self) -> usize {
        self.data.frames.len()
    }

    /// Times of the frames as `flow.pvd` has them, s.
    pub fn frame_times(&self) -> Vec<f64> {
        or_nan(self.values("flow.pvd/timestep"))
    }

    /// An array of a frame, one value a point: `Points.x`, `velocity_m_per_s.y`, `stress_pa.xy`, `volume_ratio`, `id`, `TimeValue`. One NaN
    /// if it is not there.
    pub fn array(&self, frame: usize, name: &str) -> Vec<f64> {
        or_nan(self.distorted(&format!("flow.vtp/{name}"), |key| {
            let name = key.strip_prefix("flow.vtp/")?;
            self.data.frames.get(frame)?.1.array(name)
        }))
    }

    /// All values of a key; those of a frame's array in all frames after each other. Empty if it is not there.
    pub fn values(&self, key: &str) -> Vec<f64> {
        self.distorted(key, |key| self.data.values(key))
    }

    /// What `read` makes of a key, made wrong.
    fn distorted(&self, key: &str, read: impl Fn(&str) -> Option<Vec<f64>>) -> Vec<f64> {
        let (key, factor) = match &self.wrong {
            Some(Wrong::Scaled(of, factor)) if of == key => (key, *factor),
            Some(Wrong::Exchanged(a, b)) if a == key => (b.as_str(), 1.0),
            Some(Wrong::Exchanged(a, b)) if b == key => (a.as_str(), 1.0),
            _ => (key, 1.0),
        };
        let mut values = read(key).unwrap_or_default();
        values.iter_mut().for_each(|v| *v *= factor);
        values
    }

    fn leaf(&self, key: &str) -> Option<&toml::Value> {
        self.data.leaf(key)
    }
}

impl Data {
    fn read(folder: &Path) -> Result<Self, RungFailure> {
        let text = |name: &str| std::fs::read_to_string(folder.join(name)).map_err(|e| failed(format!("{name}: {e}")));
        let mut data = Self { summary: text("summary.toml")?.parse().map_err(failed)?, ..Self::default() };
        collect(folder, "", &mut data.names)?;
        data.names.sort_unstable();
        for name in data.names.iter().filter(|n| n.ends_with(".csv")) {
            data.tables.insert(name.clone(), Table::load(folder.join(name)).map_err(failed)?);
        }
        if data.names.iter().any(|n| n == "flow.pvd") {
            for line in text("flow.pvd")?.lines().filter(|l| l.contains("<DataSet")) {
                let of = |name| attribute(line, name).ok_or_else(|| failed(format!("flow.pvd: {line}")));
                data.frames.push((of("timestep")?.parse().map_err(failed)?, Vtk::read(&folder.join(of("file")?))?));
            }
            data.outlines = Some(Vtk::read(&folder.join("vtk/boundaries.vtp"))?);
        }
        Ok(data)
    }

    fn leaf(&self, key: &str) -> Option<&toml::Value> {
        let mut parts = key.split('.');
        let first = self.summary.get(parts.next()?)?;
        parts.try_fold(first, |value, part| match value {
            toml::Value::Table(table) => table.get(part),
            toml::Value::Array(array) => array.get(part.parse::<usize>().ok()?),
            _ => None,
        })
    }

    fn values(&self, key: &str) -> Option<Vec<f64>> {
        match key.split_once('/')? {
            ("summary.toml", key) => self.leaf(key).and_then(number).map(|x| vec![x]),
            ("flow.pvd", "timestep") => Some(self.frames.iter().map(|f| f.0).collect()),
            ("flow.vtp", name) => Some(self.frames.iter().filter_map(|f| f.1.array(name)).flatten().collect()),
            ("boundaries.vtp", name) => self.outlines.as_ref()?.array(name),
            (file, name) => self.tables.get(file)?.column(name).ok().map(<[f64]>::to_vec),
        }
    }
}

fn or_nan(values: Vec<f64>) -> Vec<f64> {
    if values.is_empty() { vec![f64::NAN] } else { values }
}

/// A number, whole or not.
fn number(value: &toml::Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|n| n as f64))
}

/// Hands out everything that is neither a table nor a list, with its keys joined by dots.
pub fn leaves(key: &str, value: &toml::Value, found: &mut impl FnMut(&str, &toml::Value)) {
    let below = |name: &str| if key.is_empty() { name.to_string() } else { format!("{key}.{name}") };
    match value {
        toml::Value::Table(table) => table.iter().for_each(|(name, v)| leaves(&below(name), v, found)),
        toml::Value::Array(list) => list.iter().enumerate().for_each(|(k, v)| leaves(&below(&k.to_string()), v, found)),
        _ => found(key, value),
    }
}

/// A VTK file as it is written: raw arrays after an XML header.
#[derive(Debug, Clone, Default)]
struct Vtk {
    /// Name, names of its components, values of all of them tuple by tuple.
    arrays: Vec<(String, Vec<&'static str>, Vec<f64>)>,
}

impl Vtk {
    fn read(path: &Path) -> Result<Self, RungFailure> {
        let bad = || failed(format!("{}: no VTK file as it should be", path.display()));
        let bytes = std::fs::read(path).map_err(|e| failed(format!("{}: {e}", path.display())))?;
        let marker = b"<AppendedData encoding=\"raw\">\n_";
        let start = bytes.windows(marker.len()).position(|w| w == marker).ok_or_else(bad)? + marker.len();
        let header = std::str::from_utf8(&bytes[..start]).map_err(failed)?;
        let eight = |at: usize| bytes.get(at..at + 8).and_then(|b| <[u8; 8]>::try_from(b).ok()).ok_or_else(bad);
        let mut arrays = Vec::new();
        for line in header.lines().filter(|line| line.contains("<DataArray")) {
            let of = |name: &str| attribute(line, name).ok_or_else(bad);
            let at = start + of("offset")?.parse::<usize>().map_err(failed)?;
            let count = u64::from_le_bytes(eight(at)?) as usize / 8;
            let whole = of("type")? == "Int64";
            let value = |k: usize| {
                let bytes = eight(at + 8 + 8 * k)?;
                Ok(if whole { i64::from_le_bytes(bytes) as f64 } else { f64::from_le_bytes(bytes) })
            };
            let components: Vec<&'static str> = match &*of("NumberOfComponents")? {
                "1" => vec![""],
                "3" => vec!["x", "y", "z"],
                // By the names that stand in the file, which ParaView shows.
                "6" => (0..6)
                    .map(|k| tensor(of(&format!("ComponentName{k}"))?).ok_or_else(bad))
                    .collect::<Result<_, _>>()?,
                _ => return Err(bad()),
            };
            arrays.push((of("Name")?, components, (0..count).map(value).collect::<Result<_, RungFailure>>()?));
        }
        Ok(Self { arrays })
    }

    fn names(&self) -> BTreeSet<String> {
        let full = |name: &str, c: &str| if c.is_empty() { name.to_string() } else { format!("{name}.{c}") };
        self.arrays.iter().flat_map(|(name, components, _)| components.iter().map(move |c| full(name, c))).collect()
    }

    /// Lines and polygons have arrays of the same names: one follows the other.
    fn array(&self, name: &str) -> Option<Vec<f64>> {
        let (name, component) = name.split_once('.').unwrap_or((name, ""));
        let mut found = None;
        for (_, components, values) in self.arrays.iter().filter(|a| a.0 == name) {
            let k = components.iter().position(|c| *c == component)?;
            found.get_or_insert_with(Vec::new).extend(values.iter().skip(k).step_by(components.len()));
        }
        found
    }
}

/// The name of a component of a symmetric tensor.
fn tensor(name: String) -> Option<&'static str> {
    ["xx", "yy", "zz", "xy", "yz", "xz"].into_iter().find(|n| **n == name)
}

/// An attribute of an XML tag.
fn attribute(line: &str, name: &str) -> Option<String> {
    let value = line.split_once(&format!(" {name}=\""))?.1;
    value.split_once('"').map(|(value, _)| value.to_string())
}

fn failed(why: impl std::fmt::Display) -> RungFailure {
    RungFailure::Files(why.to_string())
}

/// Names of the files below a folder.
fn collect(root: &Path, below: &str, names: &mut Vec<String>) -> Result<(), RungFailure> {
    for entry in std::fs::read_dir(root.join(below)).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        let name = format!("{below}{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() { collect(root, &format!("{name}/"), names)? } else { names.push(name) }
    }
    Ok(())
}

/// A folder that nobody else has, until it is dropped.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Result<Self, RungFailure> {
        static NUMBER: AtomicU64 = AtomicU64::new(0);
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let folder = std::env::temp_dir().join(format!("checkdam-files-{}-{number}", std::process::id()));
        // What a process of this number left when it was killed.
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir(&folder).map_err(|e| failed(format!("{}: {e}", folder.display())))?;
        Ok(Self(folder))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
