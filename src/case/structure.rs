//! Whether tables are where tables belong, before serde sees the document: serde would take an array for a struct, and
//! ignore the third of three numbers where two belong.

use toml::de::{DeTable, DeValue};

use super::path::{KeyPath, PathSegment};
use super::validate::Problem;

const TABLES: [&str; 9] =
    ["gravity", "grid", "domain", "materials", "side_walls", "stages", "gauges", "output", "numerics"];
const TABLES_OF_STAGES: [&str; 3] = ["settle", "tilt", "run"];
const LISTS: [&str; 4] = ["bodies", "inflows", "boundaries", "contacts"];
const LISTS_OF_GAUGES: [&str; 1] = ["windows"];
const PAIRS: [&str; 9] =
    ["origin_m", "x_m", "y_m", "velocity_m_per_s", "point_m", "foot_m", "centre_m", "window_x_m", "window_y_m"];
/// Lists of pairs: corners, and the rows of a gradient.
const LISTS_OF_PAIRS: [&str; 3] = ["polygon_m", "points_m", "velocity_gradient_per_s"];

/// Tables, lists of tables and pairs of numbers of a case that are something else.
pub fn misplaced(root: &DeTable<'_>) -> Vec<Problem> {
    let mut problems = Vec::new();
    for (key, value) in root.iter() {
        let (key, value) = (key.get_ref().as_ref(), value.get_ref());
        let path = KeyPath::top(key);
        if TABLES.contains(&key) {
            tables(&path, value, &mut problems);
        } else if LISTS.contains(&key) {
            list(&path, value, &mut problems);
        }
    }
    problems
}

const TABLES_OF_STUDIES: [&str; 4] = ["base", "sample", "replicates", "figure"];
const LISTS_OF_STUDIES: [(&str, &str); 2] = [("axis", "level"), ("variant", "")];
const LISTS_OF_SAMPLES: [(&str, &str); 2] = [("range", ""), ("choice", "option")];

/// Tables and lists of tables of a study that are something else.
pub fn misplaced_in_study(root: &DeTable<'_>) -> Vec<Problem> {
    let mut problems = Vec::new();
    for (key, value) in root.iter() {
        let (key, value) = (key.get_ref().as_ref(), value.get_ref());
        let path = KeyPath::top(key);
        if TABLES_OF_STUDIES.contains(&key) {
            let table = expect_table(&path, value, &mut problems);
            for (key, value) in table.filter(|_| key == "sample").into_iter().flat_map(|table| table.iter()) {
                let key = key.get_ref().as_ref();
                nested_lists(LISTS_OF_SAMPLES, &path, key, value.get_ref(), &mut problems);
            }
        } else {
            nested_lists(LISTS_OF_STUDIES, &KeyPath::default(), key, value, &mut problems);
        }
    }
    problems
}

/// A list of tables that may hold another one.
fn nested_lists(known: [(&str, &str); 2], at: &KeyPath, key: &str, value: &DeValue<'_>, problems: &mut Vec<Problem>) {
    let Some((_, inner)) = known.into_iter().find(|(outer, _)| *outer == key) else { return };
    let path = at.key(key);
    list(&path, value, problems);
    for (index, element) in value.as_array().into_iter().flatten().enumerate() {
        if let Some(value) = element.get_ref().as_table().and_then(|table| table.get(inner)) {
            list(&path.index(index).key(inner), value.get_ref(), problems);
        }
    }
}

fn tables(path: &KeyPath, value: &DeValue<'_>, problems: &mut Vec<Problem>) {
    let Some(table) = expect_table(path, value, problems) else {
        return;
    };
    let is_materials = path.last_key() == "materials";
    if is_materials && !table.is_empty() && !table.values().any(|value| value.get_ref().is_table()) {
        return problems.push(Problem {
            path: path.clone(),
            what: "materials has no named material".to_owned(),
            value: String::new(),
            allowed: "[materials.NAME] tables".to_owned(),
            fix: "give the material a name: [materials.sand] instead of [materials]".to_owned(),
        });
    }
    for (key, value) in table.iter() {
        let key = key.get_ref().as_ref();
        if is_materials || path.last_key() == "stages" && TABLES_OF_STAGES.contains(&key) {
            expect_table(&path.key(key), value.get_ref(), problems);
        } else if path.last_key() == "gauges" && LISTS_OF_GAUGES.contains(&key) {
            list(&path.key(key), value.get_ref(), problems);
        }
    }
    pairs(path, table, problems);
}

fn list(path: &KeyPath, value: &DeValue<'_>, problems: &mut Vec<Problem>) {
    let keys = path.0.iter().filter_map(|segment| match segment {
        PathSegment::Key(key) => Some(key.as_str()),
        PathSegment::Index(_) => None,
    });
    let header = keys.collect::<Vec<_>>().join(".");
    let tables = value.as_array().filter(|array| array.iter().all(|value| value.get_ref().is_table()));
    match tables {
        Some(array) => {
            for (index, table) in array.iter().enumerate() {
                if let Some(table) = table.get_ref().as_table() {
                    pairs(&path.index(index), table, problems);
                }
            }
        }
        None => problems.push(Problem {
            path: path.clone(),
            what: format!("{path} is not a list of tables"),
            value: String::new(),
            allowed: format!("any number of [[{header}]] tables"),
            fix: format!("write [[{header}]], with double brackets, above each of them"),
        }),
    }
}

fn expect_table<'a, 'i>(
    path: &KeyPath,
    value: &'a DeValue<'i>,
    problems: &mut Vec<Problem>,
) -> Option<&'a DeTable<'i>> {
    let table = value.as_table();
    if table.is_none() {
        let header = if path.to_string() == "materials" { "materials.NAME".to_owned() } else { path.to_string() };
        problems.push(Problem {
            path: path.clone(),
            what: format!("{path} is not a table"),
            value: String::new(),
            allowed: format!("one [{header}] table"),
            fix: format!("write [{header}], with single brackets, above its keys"),
        });
    }
    table
}

fn pairs(path: &KeyPath, table: &DeTable<'_>, problems: &mut Vec<Problem>) {
    for (key, value) in table.iter() {
        let key = key.get_ref().as_ref();
        let count = value.get_ref().as_array().map_or(2, |array| array.len());
        if LISTS_OF_PAIRS.contains(&key) {
            list_of_pairs(&path.key(key), value.get_ref(), problems);
        }
        if PAIRS.contains(&key) && count != 2 {
            let path = path.key(key);
            problems.push(Problem {
                what: format!("{path} has {count} values instead of two"),
                path,
                value: String::new(),
                allowed: "two numbers".to_owned(),
                fix: format!("write two numbers: {key} = [0.0, 1.0]"),
            });
        }
    }
}

/// A list of pairs of numbers, and a gradient, which has two.
fn list_of_pairs(path: &KeyPath, value: &DeValue<'_>, problems: &mut Vec<Problem>) {
    let Some(rows) = value.as_array() else { return };
    let is_pair = |row: &DeValue<'_>| row.as_array().is_some_and(|pair| pair.len() == 2);
    let wrong = rows.iter().position(|row| !is_pair(row.get_ref()));
    let gradient = path.last_key() == "velocity_gradient_per_s";
    let (path, what) = match wrong {
        Some(row) => (path.index(row), format!("{} is not a pair of numbers", path.index(row))),
        None if gradient && rows.len() != 2 => (path.clone(), format!("{path} has {} rows instead of two", rows.len())),
        None => return,
    };
    let example = if gradient { "[[0.0, 5.0], [0.0, 0.0]]" } else { "[[0.0, 0.0], [1.0, 0.0], [0.5, 1.0]]" };
    let key = path.last_key().to_owned();
    problems.push(Problem {
        path,
        what,
        value: String::new(),
        allowed: if gradient { "two rows of two numbers" } else { "a list of pairs of numbers" }.to_owned(),
        fix: format!("write pairs of numbers: {key} = {example}"),
    });
}
