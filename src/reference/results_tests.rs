//! What a run writes is on the pages, and a number has one name.

use super::results::{COMPUTED, columns_page, place, summary_page, summary_sections};
use super::tests::check_committed;
use crate::case;
use crate::run::{Summary, columns, files};
use crate::study::quantities::QUANTITIES;
use std::collections::BTreeSet;
use std::path::Path;

/// A block that slides down a floor against a fence that bends, with a wall behind it: everything that a run can write.
const EVERYTHING: &str = r#"
title = "everything"
gravity = { inclination_deg = 20 }
grid = { spacing_m = 0.05, thickness_m = 0.1 }
domain = { x_m = [-0.5, 0.8], y_m = [-0.3, 0.7] }
gauges = { barriers = ["fence", "The wall"], bases = ["floor", "The wall"], windows = [{ name = "Behind it", x_m = [0.3, 0.5], y_m = [0, 0.3] }], stations_m = [0.0, 0.05], window_x_m = [0.0, 0.1], window_y_m = [0, 0.3], field_times_s = [0, 0.1] }
output = { vtk_interval_s = 0.1 }
stages.run = { end_time_s = 0.3, stop_at_rest = false }
materials.rubber = { law = "linear_elastic", density_kg_per_m3 = 1000, young_pa = 1e5, poisson = 0.2 }
materials.fence = { law = "neo_hookean", density_kg_per_m3 = 1000, young_pa = 1e6, poisson = 0.2 }
bodies = [
    { name = "block", material = "rubber", x_m = [-0.25, -0.05], y_m = [0, 0.2], velocity_m_per_s = [1.5, 0] },
    { name = "fence", material = "fence", x_m = [0.1, 0.3], y_m = [-0.1, 0.4] },
]
boundaries = [
    { name = "floor", kind = "plane", point_m = [0, 0], normal_deg = 90, bodies = ["block"], contact = "coulomb", friction = 0.2 },
    { name = "clamp", kind = "plane", point_m = [0, 0], normal_deg = 90, bodies = ["fence"], contact = "bonded" },
    { name = "The wall", kind = "wall", foot_m = [0.6, 0], height_m = 0.4, contact = "smooth" },
]
contacts = [{ bodies = ["fence", "block"], friction = 0.3, normal = "nearest_face", structure = "fence", gap = "extents" }]
"#;

/// The names in its columns.
const NAMES: [&str; 4] = ["floor", "clamp", "the_wall", "fence_on_block"];

fn run(folder: &Path) -> Summary {
    let case = case::parse(EVERYTHING, "everything.toml").unwrap_or_else(|e| panic!("{e}")).case;
    files::run_into(&case, folder, &mut |_| true).unwrap_or_else(|e| panic!("{e}")).2
}

#[test]
fn what_is_committed_of_the_results_is_what_the_program_says() {
    check_committed("columns.md", &columns_page());
    check_committed("summary.md", &summary_page());
}

#[test]
fn all_that_a_run_writes_is_on_the_pages_and_a_quantity_has_the_name_of_its_key() {
    let folder = tempfile::tempdir().expect("a folder");
    let summary = run(folder.path());
    every_column_is_on_the_page(folder.path());
    let written: toml::Table =
        std::fs::read_to_string(folder.path().join("summary.toml")).expect("a file").parse().expect("TOML");
    every_key_is_on_the_page(&written);
    every_quantity_is_the_key_of_its_name(&written, &summary);
}

fn every_column_is_on_the_page(folder: &Path) {
    let page = columns_page();
    let mut seen = BTreeSet::new();
    for entry in folder.read_dir().expect("a folder").map(|e| e.expect("an entry").path()) {
        let name = entry.file_name().and_then(|n| n.to_str()).expect("a name").to_owned();
        if !name.ends_with(".csv") {
            continue;
        }
        let named = name.strip_suffix("_the_wall.csv").or_else(|| name.strip_suffix("_behind_it.csv"));
        let file = named.map_or(name.clone(), |kind| match kind {
            "history" | "base" | "window" => format!("{kind}_NAME.csv"),
            kind => format!("{kind}.csv"),
        });
        let section = page.split("\n## `").find(|s| s.starts_with(&format!("{file}`")));
        let section = section.unwrap_or_else(|| panic!("{name} is not on the page"));
        let header = std::fs::read_to_string(&entry).expect("a table").lines().next().expect("a header").to_owned();
        let listed = section.lines().filter_map(|l| l.strip_prefix("| `")?.split_once('`')).map(|(column, _)| column);
        let own = |column: &str| NAMES.map(|n| column.replace("{boundary}", n).replace("{surface}", n)).to_vec();
        let listed: BTreeSet<String> = listed.flat_map(own).collect();
        let missing: Vec<_> = header.split(',').filter(|column| !listed.contains(*column)).collect();
        assert!(missing.is_empty(), "{name}: {missing:?} are not on the page");
        seen.insert(file);
    }
    let all: BTreeSet<_> = columns().into_iter().map(|t| t.file.to_owned()).collect();
    assert_eq!(seen, all, "the run writes every table");
}

fn every_key_is_on_the_page(written: &toml::Table) {
    let (page, sections) = (summary_page(), summary_sections());
    let fields = |header: &str| {
        let found = sections.iter().find(|s| s.header == header).unwrap_or_else(|| panic!("no {header} on the page"));
        found.fields.iter().map(|f| f.key.as_str()).collect::<Vec<_>>()
    };
    for (key, value) in written {
        assert!(fields("").contains(&key.as_str()) && page.contains(&format!("| `{key}` |")), "{key}");
        let (header, tables) = match value {
            toml::Value::Table(table) if key != "case" => (format!("[{key}]"), vec![table]),
            toml::Value::Array(list) => (format!("[[{key}]]"), list.iter().filter_map(|v| v.as_table()).collect()),
            _ => continue,
        };
        for inner in tables.into_iter().flat_map(toml::Table::keys) {
            assert!(fields(&header).contains(&inner.as_str()), "{header} {inner}");
            assert!(page.contains(&format!("| `{inner}` |")), "{header} {inner} is not on the page");
        }
    }
    for section in &sections {
        assert!(!section.meaning.is_empty(), "{}", section.header);
        for f in &section.fields {
            assert!(f.meaning.ends_with('.'), "{} {}: {}", section.header, f.key, f.meaning);
        }
    }
}

/// So that a number cannot have two names. What is made of several keys, or of one of a list, is named in [`COMPUTED`].
fn every_quantity_is_the_key_of_its_name(written: &toml::Table, summary: &Summary) {
    let sections = summary_sections();
    for (name, _) in COMPUTED {
        assert!(QUANTITIES.iter().any(|q| q.name == name), "{name} is no quantity any more");
        assert!(place(&sections, name).is_none(), "{name} is a key of the summary and not computed");
    }
    let mut compared = 0;
    for q in QUANTITIES.iter().filter(|q| COMPUTED.iter().all(|c| c.0 != q.name)) {
        let header = place(&sections, q.name).unwrap_or_else(|| {
            panic!("`{}` is no key of a single table of the summary; if it is computed, name it in COMPUTED", q.name)
        });
        let value = &written[header.trim_matches(['[', ']'])][q.name];
        assert_eq!(value.as_float(), Some((q.of)(summary)), "{header} {}", q.name);
        compared += 1;
    }
    assert!(compared >= 35, "{compared} quantities");
}
