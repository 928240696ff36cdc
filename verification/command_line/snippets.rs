//! What the documents print is what comes out: the output of the first case, columns that a script reads, targets of cargo.

use crate::documents::{FIRST_CASE, blocks, documents, first_case, none, root};
use crate::lab::Lab;
use checkdam::study::quantities::QUANTITIES;
use std::fs;

/// The guide's page of the first case.
const GUIDE: &str = "docs/first-case.md";

#[test]
fn the_first_case_prints_what_the_guide_says() {
    let lab = Lab::new(&first_case());
    fs::rename(lab.path("case.toml"), lab.path(FIRST_CASE)).unwrap();
    let printed = blocks(&documents()[GUIDE], "");
    let outcome = lab.run(&["run", FIRST_CASE]);
    // After this comes how long it took.
    let (results, _) = outcome.out.split_once("results in ").unwrap_or_else(|| panic!("{outcome:?}"));
    assert!(printed.iter().any(|block| block == results), "{GUIDE} does not print\n{results}");

    let wrong = first_case().replacen("poisson = 0.3", "poisson = 0.5", 1);
    fs::write(lab.path(FIRST_CASE), wrong).unwrap();
    let report = lab.run(&["check", FIRST_CASE]).err;
    let shown = |block: &&String| block.starts_with("error: ") && report.contains(*block);
    assert!(printed.iter().any(|block| shown(&block)), "{GUIDE} does not print\n{report}");
}

/// A script may read what a study of the same page has in its table.
#[test]
fn columns_that_a_script_reads_are_those_of_its_study() {
    let (mut wrong, mut count) = (Vec::new(), 0);
    for (name, text) in documents() {
        let studies = blocks(&text, "toml study").concat();
        for script in blocks(&text, "python") {
            for column in script.split("row[\"").skip(1).filter_map(|rest| Some(rest.split_once('"')?.0)) {
                count += 1;
                let axis = studies.contains(&format!("name = \"{column}\""));
                if column != "case" && !axis && QUANTITIES.iter().all(|q| q.name != column) {
                    wrong.push(format!("{name}: {column}"));
                }
            }
        }
    }
    none("columns that no table has", &wrong);
    assert!(count >= 3, "only {count} columns were found");
}

/// Whether `text` has `name` in a place that a target of cargo or a test may have.
fn is_there(kind: &str, name: &str) -> bool {
    let file = match kind {
        "--example" => format!("examples/{name}.rs"),
        "--bench" => format!("benches/{name}.rs"),
        "--test" => format!("{name}/tests.rs"),
        _ => return true,
    };
    root().join(file).exists()
}

/// Every function of the repository's tests whose name begins so.
fn is_test(start: &str) -> bool {
    let (mut folders, function) =
        (vec![root().join("src")], format!("fn {}", start.rsplit("::").next().unwrap_or(start)));
    folders.extend(["verification", "validation"].map(|folder| root().join(folder)));
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|kind| kind == "rs")
                && fs::read_to_string(&path).unwrap().contains(&function)
            {
                return true;
            }
        }
    }
    false
}

#[test]
fn targets_and_tests_that_cargo_is_given_exist() {
    let (mut wrong, mut count) = (Vec::new(), 0);
    for (name, text) in documents() {
        for line in blocks(&text, "sh").iter().flat_map(|block| block.lines()).filter(|l| l.starts_with("cargo ")) {
            let words: Vec<&str> = line.split(" #").next().unwrap_or_default().split_whitespace().collect();
            let targets =
                words.windows(2).filter(|pair| pair[0].starts_with("--")).all(|pair| is_there(pair[0], pair[1]));
            let ignored = words.iter().position(|word| *word == "--ignored");
            let filter = ignored.and_then(|at| words[at + 1..].iter().find(|word| !word.starts_with("--")));
            count += 1;
            if !targets || filter.is_some_and(|start| !is_test(start)) {
                wrong.push(format!("{name}: {line}"));
            }
        }
    }
    none("targets or tests that do not exist", &wrong);
    assert!(count > 10, "only {count} commands were found");
}
