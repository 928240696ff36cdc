//! The directions inside the library: the table in `lib.rs` says which rooms each room may name; within a room, nobody names each other
//! in a circle, and nobody does in the command and in the suites.

use circles::{Graph, circle};
use std::collections::BTreeMap;
use std::path::Path;

mod circles;

/// Rooms whose instruments read a simulation and never touch it.
const READERS: [&str; 2] = ["gauge", "ledger"];

/// Rooms that nothing may spoil on purpose: what is expected, and who judges.
const UNSPOILT: [&str; 2] = ["theory", "check"];

/// The crates, by their folders: library, command, suites, and the tests of the command.
const CRATES: [&str; 5] = ["src", "src/cli", "verification", "verification/command_line", "validation"];

/// Reads the table between the fences of the map: lines `room: rooms`.
fn table(map: &str) -> Graph<'_> {
    let lines =
        map.lines().filter_map(|l| l.strip_prefix("//! ")).skip_while(|l| !l.starts_with("**Who may name whom."));
    let rows = lines.skip_while(|l| *l != "```text").skip(1).take_while(|l| *l != "```");
    rows.filter_map(|l| Some((l.split_once(':')?.0, l.split_once(':')?.1.split_whitespace().collect()))).collect()
}

/// A source without its tests and comments, which may name anything.
fn code(source: &str) -> String {
    let code = source.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default().lines();
    code.filter(|l| !l.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
}

/// What the file at `path`, counted from src/, does that it must not.
fn breaches(table: &Graph, path: &str, source: &str) -> Vec<String> {
    let room = path.split(['/', '.']).next().unwrap_or_default();
    let Some(allowed) = table.get(room) else { return vec![format!("{path}: no room `{room}` in the table")] };
    let code = code(source);
    let mut found = Vec::new();
    let depth = path.trim_end_matches("/mod.rs").split('/').count();
    for root in ["crate::".to_string(), "super::".repeat(depth)] {
        for (_, rest) in code.match_indices(&root).map(|(at, _)| code.split_at(at + root.len())) {
            let name = rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or_default();
            // Inside a file, a module of its own may say `super::` for the file.
            let known = root == "crate::" || table.contains_key(name);
            let seeds = name == "seeded" && !UNSPOILT.contains(&room);
            if known && name != room && !seeds && !allowed.contains(&name) {
                found.push(format!("{path}: `{room}` names `{name}`"));
            }
        }
    }
    if READERS.contains(&room) && (code.contains("mut Simulation") || code.contains("mut crate::simulation")) {
        found.push(format!("{path}: `{room}` reads and never touches"));
    }
    found
}

/// The files of a crate with their sources, by their paths from its root, without tests and without crates inside.
fn sources(root: &Path) -> BTreeMap<String, String> {
    fn collect(folder: &Path, root: &Path, found: &mut BTreeMap<String, String>) {
        for entry in folder.read_dir().expect("a folder of sources").map(|e| e.expect("an entry").path()) {
            let name = entry.file_stem().and_then(|n| n.to_str()).expect("a name");
            let test = name == "tests" || name.ends_with("_tests");
            if entry.is_dir() && !test && !entry.join("Cargo.toml").exists() {
                collect(&entry, root, found);
            } else if entry.extension().is_some_and(|e| e == "rs") && !test {
                let path = entry.strip_prefix(root).expect("below the root").to_str().expect("a path");
                found.insert(path.replace('\\', "/"), std::fs::read_to_string(&entry).expect("a source"));
            }
        }
    }
    let mut found = BTreeMap::new();
    collect(root, root, &mut found);
    found
}

#[test]
fn rooms_name_only_what_the_table_lets_them() {
    let table = table(include_str!("lib.rs"));
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut all = sources(&src);
    // The root names all rooms.
    all.remove("lib.rs");
    assert!(all.len() > 100, "{} files", all.len());
    let found: Vec<_> = all.iter().flat_map(|(path, source)| breaches(&table, path, source)).collect();
    assert!(found.is_empty(), "see \"Who may name whom\" in src/lib.rs:\n{}", found.join("\n"));
    for room in table.keys() {
        assert!(src.join(room).is_dir() || src.join(room).with_extension("rs").is_file(), "no room `{room}` any more");
    }
}

#[test]
fn the_table_has_no_circle() {
    assert_eq!(circle(&table(include_str!("lib.rs"))), [""; 0], "these name each other");
}

#[test]
fn no_folder_has_a_circle() {
    for name in CRATES {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
        let sources = sources(&root).into_iter().map(|(path, source)| (path, code(&source))).collect();
        let folders = circles::folders(&sources);
        assert!(!folders.is_empty() && folders.values().all(|graph| graph.len() > 1), "{name}: {folders:?}");
        for (folder, graph) in folders {
            assert_eq!(circle(&graph), [""; 0], "these name each other, in {name}/{folder}");
        }
    }
}

#[test]
fn breaches_are_found() {
    let table = table(include_str!("lib.rs"));
    let clean = |path: &str, source: &str| breaches(&table, path, source).is_empty();
    assert!(!clean("theory/bar.rs", "use crate::simulation::Simulation;\n"), "theory calls the solver");
    assert!(!clean("theory/bar.rs", "fn f() { crate::transfer::scatter() }\n"));
    assert!(!clean("theory/bar.rs", "use crate::seeded;\n") && !clean("check.rs", "use crate::seeded;\n"));
    assert!(clean("gauge/flow.rs", "use crate::seeded;\n"));
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
