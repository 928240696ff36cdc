//! What a run leaves, as two pages: the columns of its tables, and the numbers of a whole run.

use super::markdown::{Field, Section, sections, unit};
use super::schema::{Schema, Shape};
use crate::run::{Summary, columns};
use crate::study::quantities::QUANTITIES;
use std::fmt::Write as _;

const COLUMNS_HEAD: &str = "\
# Columns of the tables

Every column of every table (CSV) that a run writes. [Reading the results](../results.md) says which to look at, and
[the numbers of a whole run](summary.md) have a page of their own.

The unit of a number is the end of its name; 1 stands for a share or a ratio, - for a number that counts. Columns with `{boundary}` in
their names stand there once for each boundary. Those with `{surface}` stand there once for each boundary, and then for each contact
of two bodies (`A_on_B`). Names are in lower case, with `_` for what is neither letter nor digit.

NAME stands for a name in the same letters. Files of a barrier that is not the first end in its name: `pressure_profile_NAME.csv` has
the columns of `pressure_profile.csv`.

This page is made from the table of columns, `src/run/columns.rs`; `cargo reference` writes it anew.
";

const SUMMARY_HEAD: &str = "\
# The numbers of a whole run

A run leaves them in `summary.toml`. A study leaves those of all its runs in [`runs.csv`](#columns-of-runscsv), with the same names.

The unit of a number is the end of its name; 1 stands for a share or a ratio. Keys that make no sense in a case are left out.

This page is made from the doc comments in `src/run` and from `src/study/quantities.rs`; `cargo reference` writes it anew.
";

const RUNS_HEAD: &str = "
## Columns of `runs.csv`

A row is a run. The first columns are `case`, `factor`, `label` and `replicate`. A column for each axis and each range of the sample
follows, then `key` (of all inputs), `ended` (at rest, at the end time, or why it failed) and `trusted` (as in `summary.toml`). The numbers come last. Those that no
run has are left out, as those of a barrier that bends where there is none.

";

/// Quantities of a study that are no key of a summary, and what they are made of. All others have the name of their key.
pub const COMPUTED: [(&str, &str); 6] = [
    ("front_velocity_m_per_s", "`velocity_m_per_s` of the `[[front]]` at the start of the window"),
    ("front_depth_m", "`depth_m` of the `[[front]]` at the start of the window"),
    ("froude_1", "`froude_1` of the `[[front]]` at the start of the window"),
    ("barrier_velocity_m_per_s", "`velocity_m_per_s` of the last `[[front]]`, if the flow arrived"),
    ("barrier_depth_m", "`depth_m` of the last `[[front]]`, if the flow arrived"),
    ("dissipated_1", "1 less `kinetic_1`, `gravitational_1` and `elastic_1` of `[energy]`"),
];

/// The tables of a summary but the case, which has a page of its own. Barriers after the first have the tables of the first.
pub fn summary_sections() -> Vec<Section> {
    let all = sections(&Schema::of::<Summary>("checkdam summary"));
    let table = |header: &str| header.trim_matches(['[', ']']).to_owned();
    let own = |s: &Section| {
        let table = table(&s.header);
        table != "case" && !table.starts_with("case.") && !table.starts_with("further_barriers.")
    };
    all.into_iter().filter(own).collect()
}

/// The single table of a summary in which a quantity is a key.
pub fn place(sections: &[Section], quantity: &str) -> Option<String> {
    let single = |s: &&Section| s.header.starts_with('[') && !s.header.starts_with("[[");
    let mut found = sections.iter().filter(single).filter(|s| s.fields.iter().any(|f| f.key == quantity));
    let header = found.next()?.header.clone();
    found.next().is_none().then_some(header)
}

/// The page of all tables.
pub fn columns_page() -> String {
    let mut page = COLUMNS_HEAD.to_owned();
    for table in columns() {
        write!(page, "\n## `{}`\n\nA row is {}.\n\n", table.file, table.row).expect("a text grows");
        page += "| Column | Unit | Meaning |\n|---|---|---|\n";
        for c in &table.columns {
            writeln!(page, "| `{}` | {} | {} |", c.name, c.unit, c.meaning).expect("a text grows");
        }
    }
    page
}

/// The page of the numbers of a whole run.
pub fn summary_page() -> String {
    let mut page = SUMMARY_HEAD.to_owned();
    let sections = summary_sections();
    for section in &sections {
        let title = if section.header.is_empty() { "Top of `summary.toml`" } else { &format!("`{}`", section.header) };
        write!(page, "\n## {title}\n\n{}\n\n", section.meaning).expect("a text grows");
        page += "| Key | Type | Unit | Meaning |\n|---|---|---|---|\n";
        for f in &section.fields {
            writeln!(page, "| `{}` | {} | {} | {} |", f.key, f.kind, f.unit, meaning(f)).expect("a text grows");
        }
    }
    page += RUNS_HEAD;
    page += "| Column | Unit | Meaning | In `summary.toml` |\n|---|---|---|---|\n";
    for q in QUANTITIES {
        let unit = unit(q.name);
        let title = q.title.strip_suffix(&format!(" ({unit})")).unwrap_or(q.title);
        let computed = COMPUTED.iter().find(|c| c.0 == q.name).map(|c| c.1.to_owned());
        let source = computed.or_else(|| Some(format!("`{}`", place(&sections, q.name)?))).unwrap_or_default();
        writeln!(page, "| `{}` | {unit} | {title} | {source} |", q.name).expect("a text grows");
    }
    page
}

/// What a key means, without the unit that has a column of its own, and where a table stands.
fn meaning(field: &Field) -> String {
    let see = match field.shape {
        _ if field.key == "case" => " See [case files](case.md).".to_owned(),
        Shape::Value => String::new(),
        Shape::List => format!(" See `[[{}]]`.", field.key),
        Shape::Table | Shape::Named => format!(" See `[{}]`.", field.key),
    };
    let without_unit = |text: String, end: &str| text.replace(&format!(", {}{end}", field.unit), end);
    [".", ";", ":"].into_iter().fold(field.meaning.clone(), without_unit).replace('|', "\\|") + &see
}
