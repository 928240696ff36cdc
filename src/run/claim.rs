//! Whose the folder of a run is: new, empty, or left by an earlier run that may be replaced.

use super::columns;
use crate::case::file_name;
use crate::output::{LOCK, Lock, OutputError};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toml::{Table, Value};

/// The file of a run that says what it is and how it ended.
pub(super) const SUMMARY: &str = "summary.toml";
/// Pictures of a run; those of barriers after the first have its name behind.
const PICTURES: [&str; 6] =
    ["energy_shares", "flow_snapshots", "force_time", "pressure_profile", "barrier_forces", "barrier_deflection"];

/// A folder that belongs to this process until it is dropped.
#[derive(Debug)]
pub struct Claim {
    directory: PathBuf,
    lock: Arc<Lock>,
    /// Files of an earlier run.
    remains: Vec<PathBuf>,
}

impl Claim {
    /// Of a folder that is made if it is not there. One that is not empty is refused, unless `replace` says that an earlier run
    /// in it is to be replaced; files that are not of that run stay.
    ///
    /// # Errors
    /// In words: what is wrong and what to do. Nothing has changed then.
    pub fn new(directory: &Path, replace: bool) -> Result<Self, String> {
        let shown = directory.display();
        if directory.exists() && !directory.is_dir() {
            return Err(format!("{shown} is a file; --out names a folder"));
        }
        let existed = directory.is_dir();
        // What is not to be touched is not even locked.
        if existed && !replace && !directory.join(LOCK).exists() {
            may_begin(directory, false)?;
        }
        fs::create_dir_all(directory)
            .map_err(|e| format!("cannot create {shown}: {e}; choose another folder with --out"))?;
        let lock = Lock::alone(directory.join(LOCK)).map_err(|error| match error {
            OutputError::Create { source, .. } => {
                if !existed {
                    let _ = fs::remove_dir(directory);
                }
                format!("cannot write into {shown}: {source}; choose another folder with --out")
            }
            other => other.to_string(),
        })?;
        let remains = may_begin(directory, replace)?;
        Ok(Self { directory: directory.to_path_buf(), lock: Arc::new(lock), remains })
    }

    /// Of a folder whatever is in it; nothing of it is deleted.
    ///
    /// # Errors
    /// Another process works there, or it cannot be written.
    pub fn of(directory: &Path) -> Result<Self, OutputError> {
        let lock = Arc::new(Lock::alone(directory.join(LOCK))?);
        Ok(Self { directory: directory.to_path_buf(), lock, remains: Vec::new() })
    }

    /// The folder.
    pub fn directory(&self) -> &Path {
        &self.directory
    }

    /// What makes it this process's own.
    pub(super) fn lock(&self) -> &Arc<Lock> {
        &self.lock
    }

    /// Deletes what an earlier run left.
    ///
    /// # Errors
    /// A file cannot be deleted.
    pub(super) fn clear(&self) -> Result<(), OutputError> {
        for path in &self.remains {
            fs::remove_file(path).map_err(|source| OutputError::Write { path: path.clone(), source })?;
        }
        Ok(())
    }
}

/// Makes sure that `directory` exists, is empty and can be written.
///
/// # Errors
/// In words: what is wrong and what to do.
pub fn prepare_directory(directory: &Path) -> Result<(), String> {
    Claim::new(directory, false).map(drop)
}

/// The files that a run would have to delete in this folder: none if it is empty, those of an earlier run if that is to be replaced.
fn may_begin(directory: &Path, replace: bool) -> Result<Vec<PathBuf>, String> {
    let shown = directory.display();
    let look = |e| format!("cannot look into {shown}: {e}");
    let names = fs::read_dir(directory).map_err(look)?.map(|entry| entry.map(|e| e.file_name()));
    let names = names.collect::<Result<Vec<_>, _>>().map_err(look)?;
    let others: Vec<_> = names.iter().filter(|name| *name != LOCK).collect();
    if others.is_empty() {
        return Ok(Vec::new());
    }
    let summary = fs::read_to_string(directory.join(SUMMARY)).ok().and_then(|text| text.parse::<Table>().ok());
    let run = summary.filter(|s| s.contains_key("status") && s.contains_key("checkdam_version"));
    let case = run.as_ref().and_then(|s| s.get("case"));
    match (case, replace) {
        (Some(case), true) => Ok(remains(directory, case)),
        (Some(_), false) => Err(format!(
            "{shown} exists and is not empty: an earlier run is in it; results are never mixed or overwritten: choose another folder \
             with --out, move or delete this one, or replace that run with --force"
        )),
        (None, true) => Err(format!(
            "{shown} exists, is not empty and holds no run of checkdam (no {SUMMARY} of one): --force replaces nothing else; choose \
             another folder with --out"
        )),
        (None, false) => Err(format!(
            "{shown} exists and is not empty; results are never mixed or overwritten: choose another folder with --out, \
             or move or delete this one"
        )),
    }
}

/// The files of a run of this case that are in a folder, but for its summary.
fn remains(directory: &Path, case: &Value) -> Vec<PathBuf> {
    let mut names = BTreeSet::new();
    collect_names(case, &mut names);
    let is_picture = |stem: &str| PICTURES.contains(&stem);
    let tables = columns();
    let is_table =
        |stem: &str| tables.iter().any(|t| t.file.trim_end_matches(".csv").trim_end_matches("_NAME") == stem);
    let is_of_run = |name: &str| {
        let name = name.strip_suffix(".tmp").unwrap_or(name);
        let Some((stem, kind)) = name.rsplit_once('.') else { return false };
        let stems = std::iter::once(stem).chain(names.iter().filter_map(|n| stem.strip_suffix(n)?.strip_suffix('_')));
        match kind {
            "csv" => stems.into_iter().any(is_table),
            "svg" => stems.into_iter().any(is_picture),
            "pvd" => stem == "flow",
            _ => false,
        }
    };
    let is_frame = |name: &str| {
        let name = name.strip_suffix(".tmp").unwrap_or(name);
        name == "boundaries.vtp" || name.starts_with("flow_") && name.ends_with(".vtp")
    };
    let mut found = files(directory, &is_of_run);
    found.extend(files(&directory.join("vtk"), &is_frame));
    found
}

/// Files in a folder whose names are as wanted, in order.
fn files(folder: &Path, wanted: &dyn Fn(&str) -> bool) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok).map(|e| e.path());
    let is_wanted = |p: &PathBuf| p.is_file() && p.file_name().and_then(|n| n.to_str()).is_some_and(wanted);
    let mut found: Vec<_> = entries.filter(is_wanted).collect();
    found.sort();
    found
}

/// All texts below a value as files are named by them: among them are those of barriers, bases and windows.
fn collect_names(value: &Value, names: &mut BTreeSet<String>) {
    match value {
        Value::String(text) => {
            names.insert(file_name(text));
        }
        Value::Array(list) => list.iter().for_each(|v| collect_names(v, names)),
        Value::Table(table) => table.values().for_each(|v| collect_names(v, names)),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_an_earlier_run_all_its_files_go_and_no_other() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("vtk")).unwrap();
        let own = [
            "history.csv",
            "history_the_wall.csv",
            "window_behind_it.csv",
            "barrier_profile_at_peak.csv",
            "force_time_the_wall.svg",
            "energy_shares.svg",
            "flow.pvd",
            "energy.csv.tmp",
            "vtk/flow_00012.vtp",
            "vtk/boundaries.vtp",
        ];
        let others = ["notes.csv", "history_mine.csv", "force_time.png", "slurm-12.out", "vtk/state.pvsm"];
        own.iter().chain(&others).for_each(|name| fs::write(at(name), "x").unwrap());
        for replace in [false, true] {
            let told = Claim::new(folder.path(), replace).unwrap_err();
            assert!(told.contains("is not empty") && told.contains("no run") == replace, "{told}");
        }
        let summary = "status = \"running\"\ncheckdam_version = \"0\"\n[case]\ntitle = \"a\"\n\
                       gauges = { barriers = [\"fence\", \"The wall\"], windows = [{ name = \"Behind it\" }] }\n";
        fs::write(at(SUMMARY), summary).unwrap();
        let told = Claim::new(folder.path(), false).unwrap_err();
        assert!(told.contains("--force"), "{told}");
        let claim = Claim::new(folder.path(), true).unwrap();
        assert!(Claim::new(folder.path(), true).unwrap_err().contains("in use by process"));
        claim.clear().unwrap();
        drop(claim);
        assert!(own.iter().all(|name| !at(name).exists()));
        assert!(others.iter().all(|name| at(name).exists()) && at(SUMMARY).exists());
        assert!(!at(LOCK).exists());
    }
}
