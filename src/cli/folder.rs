//! What a finished run or study left in its folder: how `compare` and `report` read it.

use checkdam::output::Table;
use std::path::{Path, PathBuf};
use toml::Value;

/// A folder with results.
pub enum Folder {
    /// Of one run.
    Run(Run),
    /// Of a study: its table.
    Study(Table),
}

/// A run that has ended, in whatever way: it has a summary.
pub struct Run {
    /// Where it is.
    pub path: PathBuf,
    /// `summary.toml`.
    pub summary: toml::Table,
}

/// A value in `summary.toml`.
#[derive(Debug, Clone, PartialEq)]
pub enum Leaf {
    /// A number.
    Number(f64),
    /// A text, or whether something is true.
    Text(String),
}

impl Folder {
    /// Looks into a folder: a run has `summary.toml`, a study has `runs.csv`.
    ///
    /// # Errors
    /// In words: the folder is neither, or what it has cannot be read.
    pub fn open(path: &Path) -> Result<Self, String> {
        let shown = path.display();
        if !path.is_dir() {
            let what = if path.exists() { "is no folder" } else { "does not exist" };
            return Err(format!("{shown} {what}\n  = fix: name the folder of a run or of a study, such as out/sand"));
        }
        let [summary, runs] = ["summary.toml", "runs.csv"].map(|name| path.join(name));
        if summary.is_file() {
            return Run::read(path).map(Folder::Run);
        }
        if runs.is_file() {
            return Table::load(&runs).map(Folder::Study).map_err(|error| error.to_string());
        }
        Err(format!(
            "{shown} is no folder of a run or a study: it has neither summary.toml nor runs.csv\n  = fix: a run has its summary when it \
             has ended; wait for it, or run it anew into an empty folder"
        ))
    }
}

impl Run {
    fn read(path: &Path) -> Result<Self, String> {
        let file = path.join("summary.toml");
        let shown = file.display();
        let text = std::fs::read_to_string(&file).map_err(|error| format!("{shown} cannot be read: {error}"))?;
        let summary: toml::Table = text.parse().map_err(|error| format!("{shown} cannot be read: {error}"))?;
        let expected = [("trusted", "boolean"), ("status", "string"), ("case", "table"), ("stepping", "table")];
        for (key, kind) in expected {
            if summary.get(key).map(Value::type_str) != Some(kind) {
                return Err(format!("{shown} is no summary of a run: it has no `{key}`"));
            }
        }
        Ok(Self { path: path.to_path_buf(), summary })
    }

    /// Names of the tables (CSV), in order, the history first.
    pub fn tables(&self) -> Result<Vec<String>, String> {
        let fail = |error| format!("cannot look into {}: {error}", self.path.display());
        let mut names = Vec::new();
        for entry in std::fs::read_dir(&self.path).map_err(fail)? {
            let path = entry.map_err(fail)?.path();
            if path.is_file() && path.extension().is_some_and(|kind| kind == "csv") {
                names.extend(path.file_name().map(|name| name.to_string_lossy().into_owned()));
            }
        }
        names.sort_by_key(|name| (name != "history.csv", name.clone()));
        Ok(names)
    }

    /// A table of the run.
    ///
    /// # Errors
    /// It is not there, or is no table.
    pub fn table(&self, name: &str) -> Result<Table, String> {
        Table::load(self.path.join(name)).map_err(|error| error.to_string())
    }

    /// The inputs, with defaults: `case` of the summary.
    pub fn case(&self) -> Vec<(String, Leaf)> {
        self.summary.get("case").map_or_else(Vec::new, leaves)
    }

    /// The values of the summary but the inputs.
    pub fn results(&self) -> Vec<(String, Leaf)> {
        let all = self.summary.iter().filter(|(key, _)| *key != "case");
        let mut found = Vec::new();
        all.for_each(|(key, value)| collect(key, value, &mut found));
        found
    }
}

/// All values below one, by their paths: `barrier.static_force_n`, `front[0].depth_m`, and by name what has one, as in a study
/// (`boundaries.base.friction`).
pub fn leaves(value: &Value) -> Vec<(String, Leaf)> {
    let mut found = Vec::new();
    collect("", value, &mut found);
    found
}

fn collect(path: &str, value: &Value, found: &mut Vec<(String, Leaf)>) {
    let below = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
    match value {
        Value::Table(table) => table.iter().for_each(|(key, value)| collect(&below(key), value, found)),
        Value::Array(list) => {
            // Two of the same name are told apart by their places.
            let name = |value: &Value| Some(value.as_table()?.get("name")?.as_str()?.to_owned());
            let names: Vec<_> = list.iter().map(name).collect();
            for (k, value) in list.iter().enumerate() {
                let unique =
                    names[k].as_ref().filter(|_| names.iter().filter(|other| **other == names[k]).count() == 1);
                let path = unique.map_or_else(|| format!("{path}[{k}]"), |name| below(name));
                collect(&path, value, found);
            }
            if list.is_empty() {
                found.push((path.to_owned(), Leaf::Text("[]".into())));
            }
        }
        Value::Float(number) => found.push((path.to_owned(), Leaf::Number(*number))),
        Value::Integer(number) => found.push((path.to_owned(), Leaf::Number(*number as f64))),
        Value::String(text) => found.push((path.to_owned(), Leaf::Text(text.clone()))),
        other => found.push((path.to_owned(), Leaf::Text(other.to_string()))),
    }
}

impl std::fmt::Display for Leaf {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Leaf::Number(number) => f.write_str(&checkdam::check::significant(*number, 9)),
            Leaf::Text(text) => f.write_str(text),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_have_the_paths_of_their_keys() {
        let text = "a = 1\nb = [2.5, nan]\nlist = []\n[[c]]\nname = 'x'\nd = true\n[[c]]\nname = 'y'\nd = 'no'\n[[e]]\nf = 3\n";
        let found = leaves(&Value::Table(text.parse().expect("a table")));
        let of = |path: &str| found.iter().find(|(other, _)| other == path).map(|(_, leaf)| leaf.clone());
        assert_eq!(of("a"), Some(Leaf::Number(1.0)));
        assert!(matches!(of("b[1]"), Some(Leaf::Number(number)) if number.is_nan()));
        assert_eq!(of("c.x.d"), Some(Leaf::Text("true".into())));
        assert_eq!(of("c.y.d"), Some(Leaf::Text("no".into())));
        assert_eq!(of("e[0].f"), Some(Leaf::Number(3.0)));
        assert_eq!(of("list"), Some(Leaf::Text("[]".into())));
    }

    #[test]
    fn what_has_the_same_name_twice_goes_by_its_place() {
        let text = "[[c]]\nname = 'x'\nd = 1\n[[c]]\nname = 'x'\nd = 2\n";
        let found = leaves(&Value::Table(text.parse().expect("a table")));
        assert!(found.contains(&("c[1].d".into(), Leaf::Number(2.0))), "{found:?}");
    }
}
