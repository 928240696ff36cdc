//! What the documents say is so: cases and studies that they print can be run, links lead somewhere, files that they name exist.

use crate::lab::Lab;
use checkdam::study::{Study, plan};
use checkdam_verification::RUNGS;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The most words of the README, code and tables included.
const README_WORDS: usize = 1000;
/// The name under which the guide has its reader save its first case.
pub const FIRST_CASE: &str = "sand.toml";

/// The folder of the repository, above that of this package.
pub fn root() -> &'static Path {
    let above = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    above.into_iter().find(|folder| folder.join("CONTRIBUTING.md").exists()).expect("a repository")
}

/// Texts by their names, seen from the root: all Markdown files that are written by hand.
pub fn documents() -> BTreeMap<String, String> {
    fn collect(at: &Path, found: &mut Vec<PathBuf>) {
        let Ok(entries) = fs::read_dir(at) else { return };
        for path in entries.map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                collect(&path, found);
            } else if path.extension().is_some_and(|kind| kind == "md") {
                found.push(path);
            }
        }
    }
    let mut found: Vec<PathBuf> = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md"].map(|name| root().join(name)).into();
    for folder in ["docs", "verification", "validation", "benches", "examples"] {
        collect(&root().join(folder), &mut found);
    }
    let name = |path: &Path| path.strip_prefix(root()).unwrap().display().to_string();
    found.iter().map(|path| (name(path), fs::read_to_string(path).unwrap())).collect()
}

/// The fenced blocks of a text whose first line is ``` and `kind`.
pub fn blocks(text: &str, kind: &str) -> Vec<String> {
    let mut blocks = Vec::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        let Some(found) = line.strip_prefix("```") else { continue };
        let block: String = lines.by_ref().take_while(|line| *line != "```").map(|line| format!("{line}\n")).collect();
        if found == kind {
            blocks.push(block);
        }
    }
    blocks
}

/// A text without its fenced blocks.
fn prose(text: &str) -> String {
    let outside = text.split("```").step_by(2);
    outside.collect::<Vec<_>>().join("\n")
}

/// What stands between single backticks.
fn quoted(text: &str) -> Vec<&str> {
    text.lines().flat_map(|line| line.split('`').skip(1).step_by(2)).collect()
}

/// The first case of the guide.
pub fn first_case() -> String {
    let guide = fs::read_to_string(root().join("docs/first-case.md")).unwrap();
    blocks(&guide, "toml case").remove(0)
}

pub fn none(what: &str, wrong: &[String]) {
    assert!(wrong.is_empty(), "{what}:\n{}", wrong.join("\n"));
}

#[test]
fn cases_in_the_documents_can_be_run() {
    let mut wrong = Vec::new();
    let mut count = 0;
    for (name, text) in documents() {
        for case in blocks(&text, "toml case") {
            count += 1;
            let outcome = Lab::new(&case).run(&["check", "case.toml"]);
            if outcome.code != Some(0) || outcome.err.contains("warning") {
                wrong.push(format!("{name}: {}", outcome.err));
            }
        }
    }
    none("cases that cannot be run", &wrong);
    assert!(count >= 4, "only {count} cases were found");
}

#[test]
fn studies_in_the_documents_can_be_planned() {
    let read = |name: &str| if name == FIRST_CASE { Ok(first_case()) } else { fs::read_to_string(root().join(name)) };
    let mut wrong = Vec::new();
    let mut count = 0;
    for (name, text) in documents() {
        for study in blocks(&text, "toml study") {
            count += 1;
            match Study::parse(&study, &name).and_then(|study| plan(&study, &name, &read)) {
                Ok(runs) => assert!(runs.len() > 1, "{name}: a study of {} runs", runs.len()),
                Err(error) => wrong.push(error.to_string()),
            }
        }
    }
    none("studies that cannot be run", &wrong);
    assert!(count >= 4, "only {count} studies were found");
}

/// Every command in a block of shell has the subcommand and the options that it is given, and the first case does what the guide
/// says.
#[test]
fn commands_in_the_documents_are_those_of_the_program() {
    let lab = Lab::new(&first_case());
    fs::rename(lab.path("case.toml"), lab.path(FIRST_CASE)).unwrap();
    let (mut wrong, mut count) = (Vec::new(), 0);
    let mut helps: BTreeMap<String, String> = BTreeMap::new();
    for (name, text) in documents() {
        let commands = blocks(&text, "sh");
        for line in commands.iter().flat_map(|block| block.lines()) {
            let line = line.split(" #").next().unwrap_or_default();
            let ours = ["checkdam ", "cargo run --release -- "].into_iter().find_map(|start| line.strip_prefix(start));
            let Some(arguments) = ours else { continue };
            count += 1;
            let words: Vec<&str> = arguments.split_whitespace().collect();
            let help = helps.entry(words[0].into()).or_insert_with(|| {
                let outcome = lab.run(&[words[0], "--help"]);
                if outcome.code == Some(0) { outcome.out } else { String::new() }
            });
            let options = words.iter().filter(|word| word.starts_with("--"));
            if help.is_empty() || options.into_iter().any(|option| !help.contains(option)) {
                wrong.push(format!("{name}: {line}"));
            }
            if matches!(words[..], ["check" | "run", FIRST_CASE]) {
                let outcome = lab.run(&words);
                // The README and the guide both run it; its folder is never written twice.
                let again = outcome.err.contains("exists and is not empty");
                assert!(outcome.code == Some(0) || again, "{name}: {line}\n{outcome:?}");
            }
        }
    }
    none("commands that the program does not have", &wrong);
    assert!(count >= 4, "only {count} commands were found");
    assert!(lab.path("out/sand/summary.toml").exists(), "nobody runs the first case");
}

/// The anchor of a heading, as forges make it.
fn anchor(heading: &str) -> String {
    let kept = heading.trim().chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.map(|c| if c == ' ' { '-' } else { c.to_ascii_lowercase() }).collect()
}

#[test]
fn links_lead_somewhere() {
    let documents = documents();
    let mut wrong = Vec::new();
    for (name, text) in &documents {
        let folder = root().join(name).parent().unwrap().to_path_buf();
        let prose = prose(text);
        for target in prose.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            if target.starts_with("http://") || target.starts_with("https://") {
                continue;
            }
            let (file, place) = target.split_once('#').map_or((target, None), |(file, place)| (file, Some(place)));
            let path = if file.is_empty() { root().join(name) } else { folder.join(file) };
            let Some(place) = place else {
                if !path.exists() {
                    wrong.push(format!("{name}: {target}"));
                }
                continue;
            };
            let there = fs::read_to_string(&path).unwrap_or_default();
            let there = self::prose(&there);
            let headings = there.lines().filter(|line| line.starts_with('#')).map(|line| line.trim_start_matches('#'));
            if !headings.into_iter().any(|heading| anchor(heading) == place) {
                wrong.push(format!("{name}: {target} (there is no such heading)"));
            }
        }
    }
    none("links that lead nowhere", &wrong);
}

#[test]
fn every_rung_stands_in_the_table_of_the_ladder() {
    let table = fs::read_to_string(root().join("verification/README.md")).unwrap();
    let rows = RUNGS.iter().map(|rung| format!("| `{}` | {} |", rung.name, rung.title));
    none("rungs that are not in verification/README.md", &rows.filter(|row| !table.contains(row)).collect::<Vec<_>>());
}

#[test]
fn the_readme_can_be_read_to_its_end() {
    let words = documents()["README.md"].split_whitespace().count();
    assert!(words <= README_WORDS, "the README has {words} words, more than {README_WORDS}");
}

#[test]
fn files_that_the_documents_name_exist() {
    let mut wrong = Vec::new();
    let documents = documents();
    let named = documents.iter().filter(|(name, _)| *name == "CONTRIBUTING.md" || name.starts_with("docs/theory/"));
    for (name, text) in named {
        for quote in quoted(&prose(text)) {
            let file =
                [".rs", ".md", ".toml", ".csv", ".py"].iter().any(|kind| quote.ends_with(kind)) || quote.ends_with('/');
            // What the command writes is not here, and names without a folder are names of outputs.
            if !file || !quote.contains('/') || quote.starts_with("out/") || quote.contains(' ') {
                continue;
            }
            // Of a pattern only the folder above it can be looked for.
            let fixed = match quote.find(['<', '*']) {
                Some(end) => quote[..end].rsplit_once('/').map_or("", |(folder, _)| folder),
                None => quote,
            };
            if !root().join(fixed).exists() {
                wrong.push(format!("{name}: {quote}"));
            }
        }
    }
    none("files that do not exist", &wrong);
}

/// The theory manual and the recipes name a file and the functions in it as `file`: `function`, `function`.
#[test]
fn functions_that_the_theory_names_exist() {
    let (mut wrong, mut count) = (Vec::new(), 0);
    for (name, text) in
        documents().iter().filter(|(name, _)| name.starts_with("docs/theory/") || *name == "CONTRIBUTING.md")
    {
        for found in prose(text).split("`src/").skip(1) {
            let Some((file, rest)) = found.split_once("`:") else { continue };
            let Ok(code) = fs::read_to_string(root().join("src").join(file)) else { continue };
            let mut rest = rest.trim_start();
            while let Some((function, after)) = rest.strip_prefix('`').and_then(|rest| rest.split_once('`')) {
                count += 1;
                let defined = ["fn ", "struct ", "enum ", "const ", "trait "].iter().any(|kind| {
                    let is_end = |c: char| !c.is_alphanumeric() && c != '_';
                    let start = format!("{kind}{function}");
                    code.match_indices(&start).any(|(k, _)| code[k + start.len()..].starts_with(is_end))
                });
                if !defined {
                    wrong.push(format!("{name}: src/{file}: {function}"));
                }
                let Some(more) = after.strip_prefix(',') else { break };
                rest = more.trim_start();
            }
        }
    }
    none("functions that do not exist", &wrong);
    assert!(count > 50, "only {count} functions were found");
}
