//! The directions inside the library: the table in `lib.rs` says which rooms each room may name.

use std::collections::BTreeMap;
use std::path::Path;

/// Who may name whom, a room after those that it may name.
type Table<'a> = BTreeMap<&'a str, Vec<&'a str>>;

/// Rooms whose instruments read a simulation and never touch it.
const READERS: [&str; 2] = ["gauge", "ledger"];

/// Reads the table between the fences of the map: lines `room: rooms`.
fn table(map: &str) -> Table<'_> {
    let lines =
        map.lines().filter_map(|l| l.strip_prefix("//! ")).skip_while(|l| !l.starts_with("**Who may name whom."));
    let rows = lines.skip_while(|l| *l != "```text").skip(1).take_while(|l| *l != "```");
    rows.filter_map(|l| Some((l.split_once(':')?.0, l.split_once(':')?.1.split_whitespace().collect()))).collect()
}

/// What the file at `path`, counted from src/, does that it must not.
fn breaches(table: &Table, path: &str, source: &str) -> Vec<String> {
    let room = path.split(['/', '.']).next().unwrap_or_default();
    let Some(allowed) = table.get(room) else { return vec![format!("{path}: no room `{room}` in the table")] };
    // Tests may name anything, and so may comments.
    let code: Vec<_> = source.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default().lines().collect();
    let code = code.into_iter().filter(|l| !l.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n");
    let mut found = Vec::new();
    let depth = path.trim_end_matches("/mod.rs").split('/').count();
    for root in ["crate::".to_string(), "super::".repeat(depth)] {
        for (_, rest) in code.match_indices(&root).map(|(at, _)| code.split_at(at + root.len())) {
            let name = rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or_default();
            // Inside a file, a module of its own may say `super::` for the file.
            let known = root == "crate::" || table.contains_key(name);
            if known && name != room && !allowed.contains(&name) {
                found.push(format!("{path}: `{room}` names `{name}`"));
            }
        }
    }
    if READERS.contains(&room) && (code.contains("mut Simulation") || code.contains("mut crate::simulation")) {
        found.push(format!("{path}: `{room}` reads and never touches"));
    }
    found
}

/// The files of a folder and what is below it, without tests and without the command, which is a crate of its own.
fn files(folder: &Path, found: &mut Vec<std::path::PathBuf>) {
    for entry in folder.read_dir().expect("a folder of sources").map(|e| e.expect("an entry").path()) {
        let name = entry.file_stem().and_then(|n| n.to_str()).expect("a name");
        let test = name == "tests" || name.ends_with("_tests");
        if entry.is_dir() && !test && !entry.join("Cargo.toml").exists() {
            files(&entry, found);
        } else if entry.extension().is_some_and(|e| e == "rs") && !test && name != "lib" {
            found.push(entry);
        }
    }
}

#[test]
fn rooms_name_only_what_the_table_lets_them() {
    let table = table(include_str!("lib.rs"));
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut all = Vec::new();
    files(&src, &mut all);
    assert!(all.len() > 100, "{} files", all.len());
    let mut found = Vec::new();
    for file in &all {
        let path = file.strip_prefix(&src).expect("below src").to_str().expect("a path").replace('\\', "/");
        found.extend(breaches(&table, &path, &std::fs::read_to_string(file).expect("a source")));
    }
    assert!(found.is_empty(), "see \"Who may name whom\" in src/lib.rs:\n{}", found.join("\n"));
    for room in table.keys() {
        assert!(src.join(room).is_dir() || src.join(room).with_extension("rs").is_file(), "no room `{room}` any more");
    }
}

#[test]
fn the_table_has_no_circle() {
    let table = table(include_str!("lib.rs"));
    let mut open: Vec<_> = table.keys().collect();
    while !open.is_empty() {
        let before = open.len();
        let left = open.clone();
        open.retain(|room| table[*room].iter().any(|named| left.contains(&named)));
        assert!(open.len() < before, "these name each other: {open:?}");
    }
}

#[test]
fn breaches_are_found() {
    let table = table(include_str!("lib.rs"));
    let clean = |path: &str, source: &str| breaches(&table, path, source).is_empty();
    assert!(!clean("theory/bar.rs", "use crate::simulation::Simulation;\n"), "theory calls the solver");
    assert!(!clean("theory/bar.rs", "fn f() { crate::transfer::scatter() }\n"));
    for room in ["case", "plot", "output", "run", "study", "check"] {
        assert!(!clean("simulation/sweep/mod.rs", &format!("use crate::{room}::Thing;\n")), "the solver names {room}");
    }
    assert!(!clean("band.rs", "use super::plot::style;\n") && !clean("contact/pair.rs", "use super::super::case;\n"));
    assert!(!clean("contact/mod.rs", "use super::case;\n") && !clean("momentum.rs", "use crate::{band, plot};\n"));
    let touches = "use crate::simulation::Simulation;\nfn read(s: &mut Simulation) {}\n";
    assert!(!clean("gauge/flow.rs", touches) && !clean("ledger/mod.rs", "fn f(s: &'a mut Simulation) {}\n"));
    assert!(!clean("cellar/mod.rs", "\n"), "a room that is not in the table");

    assert!(clean("gauge/flow.rs", &touches.replace("&mut ", "&")));
    assert!(clean("theory/bar.rs", "//! See [`crate::simulation`].\nuse super::beam;\nuse crate::theory::jump;\n"));
    assert!(clean("band.rs", "use crate::body::Points;\n#[cfg(test)]\nmod tests {\n    use crate::run;\n}\n"));
}
