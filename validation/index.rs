//! The pages that list what stands in `reports/`: every rung, validation, table and figure, with title, verdict and link.

use crate::VALIDATIONS;
use crate::experiment::Experiment;
use checkdam::output::Table;
use checkdam_verification::{RUNGS, Rung};
use std::fmt::Write;
use std::path::Path;

/// Where the pages stand below `reports/`, and their text, made from what stands there.
///
/// # Errors
/// A folder or a table of checks that cannot be read, in words.
pub fn pages(reports: &Path) -> Result<[(&'static str, String); 3], String> {
    let [rungs, validations] = [files(&reports.join("verification"))?, files(&reports.join("validation"))?];
    Ok([
        ("README.md", index(reports, &rungs, &validations)?),
        ("verification/README.md", ladder(reports, &rungs)?),
        ("validation/README.md", experiments(reports, &validations)?),
    ])
}

/// Names of the tables, figures and pages in a folder, in order.
fn files(folder: &Path) -> Result<Vec<String>, String> {
    let entries = std::fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let names = entries.filter_map(Result::ok).map(|e| e.file_name().to_string_lossy().into_owned());
    let mut names: Vec<String> = names.filter(|n| n != "README.md").collect();
    names.sort();
    Ok(names)
}

/// Names and titles of the experiments that are data alone.
fn data_alone(reports: &Path) -> Result<Vec<(String, String)>, String> {
    let folder = reports.join("../validation/experiments");
    let entries = std::fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut folders: Vec<_> = entries.filter_map(Result::ok).map(|e| e.path()).filter(|p| p.is_dir()).collect();
    folders.sort();
    let titled = |folder| Experiment::load(folder).map(|e| (e.name, e.title)).map_err(|e| e.to_string());
    folders.iter().map(|f| titled(f)).collect()
}

/// What the table of checks of a rung or a validation says.
fn verdict(reports: &Path, suite: &str, name: &str) -> Result<String, String> {
    let path = reports.join(suite).join(format!("{name}.csv"));
    let table = Table::load(&path).map_err(|e| e.to_string())?;
    let passes = table.cells("passes").map_err(|e| e.to_string())?;
    let failing = passes.iter().filter(|p| p.as_str() != "true").count();
    Ok(match failing {
        0 if passes.len() == 1 => "its check passes".into(),
        0 => format!("all {} checks pass", passes.len()),
        _ => format!("**{failing} of {} checks fail**", passes.len()),
    })
}

/// The figures of a rung or a validation, as links from the page above all suites.
fn figures(suite: &str, name: &str, all: &[&str], files: &[String]) -> String {
    let own = own(name, all, files).filter_map(|file| file.strip_suffix(".svg"));
    let called = |figure: &str| figure.strip_prefix(name).unwrap_or(figure).trim_start_matches('_').replace('_', " ");
    own.map(|figure| format!("[{}]({suite}/{figure}.svg)", called(figure))).collect::<Vec<_>>().join(", ")
}

fn index(reports: &Path, rungs: &[String], validations: &[String]) -> Result<String, String> {
    let mut page = String::from(
        "# What the two suites find\n\n\
         Made by `cargo reports` and compared byte for byte by `cargo test`. Each table of checks says what was measured, what should \
         come out, the tolerance and the reason for it.\n\n\
         ## Are the equations solved right?\n\n\
         Closed forms, exact fields, conservation laws and observed orders. Scenes, sources and figures: \
         [verification](verification/README.md). What each rung notices when the physics is wrong on purpose: \
         [faults](verification/faults.csv). All of them as a table: [ladder](verification/ladder.csv).\n\n\
         | rung | what it runs | verdict | figures |\n|---|---|---|---|\n",
    );
    let names: Vec<&str> = RUNGS.iter().map(|r| r.name).collect();
    for rung in RUNGS {
        let verdict = verdict(reports, "verification", rung.name)?;
        let (name, title) = (rung.name, rung.title);
        let figures = figures("verification", name, &names, rungs);
        let _ = writeln!(page, "| [{name}](verification/{name}.csv) | {title} | {verdict} | {figures} |");
    }
    page.push_str(
        "\n## Are they the right equations?\n\n\
         Experiments and published computations. A verdict here says that balances, bounds and sampling are as they must be; whether \
         the numbers agree with the source stands in the tables. All tables and figures: [validation](validation/README.md).\n\n\
         | validation | what it shows | verdict | figures |\n|---|---|---|---|\n",
    );
    let coded = VALIDATIONS.iter().map(|v| (v.name.to_string(), v.title.to_string(), ".csv"));
    let alone = data_alone(reports)?.into_iter().map(|(name, title)| (name, title, "_page.md"));
    let every: Vec<_> = coded.chain(alone).collect();
    let names: Vec<&str> = every.iter().map(|v| v.0.as_str()).collect();
    for (name, title, end) in &every {
        let verdict = verdict(reports, "validation", name)?;
        let figures = figures("validation", name, &names, validations);
        let _ = writeln!(page, "| [{name}](validation/{name}{end}) | {title} | {verdict} | {figures} |");
    }
    Ok(page)
}

fn ladder(reports: &Path, files: &[String]) -> Result<String, String> {
    let mut page = String::from("# The ladder\n\nFrom the bottom. [All suites](../README.md)\n");
    let all: Vec<&str> = RUNGS.iter().map(|r| r.name).collect();
    for rung in RUNGS {
        let Rung { name, title, goal, source, sketch, covers, under_fault, .. } = rung;
        let faults: Vec<&str> = covers.iter().map(|(kind, _)| kind.name()).collect();
        let verdict = verdict(reports, "verification", name)?;
        let sketch = sketch.trim_matches('\n');
        let _ = write!(
            page,
            "\n## {name}\n\n{title}.\n\n```text\n{sketch}\n```\n\n\
             - Goal: {goal}.\n- Source: {source}.\n- Verdict: {verdict}, [table]({name}.csv).\n\
             - Notices wrong {}, tried on {}.\n",
            faults.join(", ").replace('_', " "),
            if *under_fault == "all" { "all of it" } else { under_fault },
        );
        let tables = own(name, &all, files).filter(|f| f.ends_with(".csv") && **f != format!("{name}.csv"));
        let tables: Vec<String> = tables.map(link).collect();
        if !tables.is_empty() {
            let _ = writeln!(page, "- Tables: {}.", tables.join(", "));
        }
        for figure in rung.figures {
            let _ = write!(page, "\n![{name}: {0}]({0}.svg)\n", figure.name);
        }
    }
    Ok(page)
}

fn experiments(reports: &Path, files: &[String]) -> Result<String, String> {
    let mut page = String::from("# The validations\n\n[All suites](../README.md)\n");
    let coded = VALIDATIONS.iter().map(|v| (v.name.to_string(), v.title.to_string()));
    let every: Vec<(String, String)> = coded.chain(data_alone(reports)?).collect();
    let all: Vec<&str> = every.iter().map(|v| v.0.as_str()).collect();
    for (name, title) in &every {
        let verdict = verdict(reports, "validation", name)?;
        let _ = write!(page, "\n## {name}\n\n{title}.\n\n- Verdict: {verdict}, [table]({name}.csv).\n");
        for (kind, end) in [("Pages", ".md"), ("Tables", ".csv"), ("Figures", ".svg")] {
            let own = own(name, &all, files).filter(|f| f.ends_with(end) && **f != format!("{name}.csv"));
            let links: Vec<String> = own.map(link).collect();
            if !links.is_empty() {
                let _ = writeln!(page, "- {kind}: {}.", links.join(", "));
            }
        }
    }
    Ok(page)
}

fn link(file: impl AsRef<str>) -> String {
    let file = file.as_ref();
    format!("[{}]({file})", file.split('.').next().unwrap_or(file))
}

/// The files that begin with `name`, and with no longer name of all.
fn own<'a>(name: &'a str, all: &'a [&str], files: &'a [String]) -> impl Iterator<Item = &'a String> {
    let begins = |file: &str, name: &str| file.strip_prefix(name).is_some_and(|rest| rest.starts_with(['_', '.']));
    files
        .iter()
        .filter(move |f| begins(f, name) && !all.iter().any(|other| other.len() > name.len() && begins(f, other)))
}
