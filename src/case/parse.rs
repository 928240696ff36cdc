//! From text to a file's struct: syntax, keys and types, with reports in the same form as those of the checks.

use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::path::KeyPath;
use super::report::{Diagnostic, Place, Source, locate, path_at};
use super::suggest::nearest;
use super::validate::Problem;

/// So many unknown keys are looked for: each costs a look at the whole file.
const MOST_UNKNOWN_KEYS: usize = 20;

/// What is known of a kind of file before its keys are read.
#[derive(Clone, Copy, Debug)]
pub struct Format {
    /// What it is called: "case file".
    pub kind: &'static str,
    /// The page that explains its keys.
    pub page: &'static str,
    /// Keys at the top without which there is nothing to read.
    pub required: &'static [&'static str],
    /// Tables, lists of tables and pairs that are something else.
    pub misplaced: fn(&DeTable<'_>) -> Vec<Problem>,
}

/// A document and what is in it, or what is wrong with its syntax, keys or types.
pub fn document<'a, T: DeserializeOwned>(
    format: &Format,
    source: &Source<'a>,
) -> Result<(T, DeTable<'a>), Vec<Diagnostic>> {
    let document = DeTable::parse(source.text).map_err(|error| vec![syntax(format, source, &error)])?;
    let span = document.span();
    let root = document.into_inner();
    let misplaced = (format.misplaced)(&root);
    if !misplaced.is_empty() {
        return Err(misplaced.iter().map(|problem| source.diagnose(&root, problem)).collect());
    }

    // Serde stops at the first key it does not know. Correcting each such key shows the others.
    let mut corrected = root.clone();
    let mut unknown = Vec::new();
    loop {
        let attempt = Spanned::new(span.clone(), corrected.clone());
        match T::deserialize(toml::de::Deserializer::from(attempt)) {
            Ok(case) if unknown.is_empty() => return Ok((case, root)),
            Ok(_) => return Err(unknown),
            Err(error) => {
                let diagnostic = key_or_type(format, source, &root, &error);
                let (word, names) = quoted_names(error.message());
                let guess = nearest(word, names);
                let start = error.span().map(|span| span.start);
                if error.message().starts_with("unknown field")
                    && unknown.len() < MOST_UNKNOWN_KEYS
                    && start.is_some_and(|start| correct_key(&mut corrected, start, guess))
                {
                    unknown.push(diagnostic);
                } else if unknown.is_empty() {
                    return Err(with_all_that_is_missing(format, &root, &error, diagnostic));
                } else {
                    // What follows is likely the consequence: the key that was mistyped is missing.
                    return Err(unknown);
                }
            }
        }
    }
}

/// Serde stops at the first table that is missing at the top; here are all of them.
fn with_all_that_is_missing(
    format: &Format,
    root: &DeTable<'_>,
    error: &toml::de::Error,
    first: Diagnostic,
) -> Vec<Diagnostic> {
    let missing_key = error.message().starts_with("missing field").then(|| quoted_names(error.message()).0);
    let top = first.span.is_none();
    if !missing_key.is_some_and(|key| top && format.required.contains(&key)) {
        return vec![first];
    }
    let absent = format.required.iter().filter(|key| root.get(**key).is_none());
    absent
        .map(|key| {
            let (what, allowed, fix) = missing(format, &KeyPath::default(), key);
            Diagnostic { what, span: None, allowed, fix }
        })
        .collect()
}

/// The first name in backticks of a message of serde, and the others.
fn quoted_names(message: &str) -> (&str, Vec<&str>) {
    let mut quoted = message.split('`').skip(1).step_by(2);
    (quoted.next().unwrap_or_default(), quoted.collect())
}

/// Takes out the key that begins at this byte, or renames it if a name is given and free; false if there is no such key.
fn correct_key(table: &mut DeTable<'_>, start: usize, name: Option<&str>) -> bool {
    let found = table.iter().find(|(key, _)| key.span().start == start).map(|(key, _)| key.clone());
    let Some(key) = found else {
        return table.iter_mut().any(|(_, value)| correct_key_in(value.get_mut(), start, name));
    };
    if let (Some(value), Some(name)) = (table.remove(key.get_ref().as_ref()), name)
        && !table.contains_key(name)
    {
        table.insert(Spanned::new(key.span(), name.to_owned().into()), value);
    }
    true
}

fn correct_key_in(value: &mut DeValue<'_>, start: usize, name: Option<&str>) -> bool {
    match value {
        DeValue::Table(table) => correct_key(table, start, name),
        DeValue::Array(array) => array.iter_mut().any(|value| correct_key_in(value.get_mut(), start, name)),
        _ => false,
    }
}

fn syntax(format: &Format, source: &Source<'_>, error: &toml::de::Error) -> Diagnostic {
    let message = error.message();
    let start = error.span().map_or(0, |span| span.start);
    let rest = source.text.get(start..).unwrap_or_default();
    let before = source.text.get(..start).unwrap_or_default();
    let line = source.text.lines().nth(source.line_and_column(start).0 - 1).unwrap_or_default();
    let fix = if message.contains("duplicate key") {
        "the same key or [table] occurs above: remove or rename one of them"
    } else if rest.starts_with(',') && before.ends_with(|c: char| c.is_ascii_digit()) {
        "write decimals with a point: 0.3, not 0,3"
    } else if message.contains("string values must be quoted") && rest.trim_start_matches([' ', '\t', '\r']).is_empty()
        || message.contains("string values must be quoted") && rest.starts_with(['\n', '\r', '#'])
    {
        "write a value after the ="
    } else if message.contains("string values must be quoted")
        && rest.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
    {
        "write a number alone, without a unit: the unit is in the name of the key"
    } else if message.contains("string values must be quoted") {
        "put text in double quotes: key = \"text\""
    } else if line.matches('"').count() % 2 == 1 {
        "close the double quotes"
    } else if message.contains("unclosed table") {
        "close the bracket: [table]"
    } else if message.contains("unclosed array") {
        "close the bracket: [1.0, 2.0]"
    } else if message.contains("mantissa") || message.contains("leading zero") {
        "write numbers with a digit before and after the point, and without leading zeros: 0.5"
    } else {
        "each line is key = value, a [table], or a comment that begins with #"
    };
    let what = format!("this is not TOML: {message}");
    let toml = source.name.ends_with(".toml");
    let allowed = if toml { String::new() } else { format!("a {}, a text in TOML format", format.kind) };
    Diagnostic { what, span: error.span().or(Some(0..0)), allowed, fix: fix.to_owned() }
}

/// Turns an error of serde into a report. Its messages name the keys and variants that would have been right.
fn key_or_type(format: &Format, source: &Source<'_>, root: &DeTable<'_>, error: &toml::de::Error) -> Diagnostic {
    let message = error.message();
    let path = error.span().filter(|span| !span.is_empty()).and_then(|span| path_at(root, span.start));
    let path = path.unwrap_or_default();
    let (word, names) = quoted_names(message);
    let listed = names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    let written = error.span().and_then(|span| source.text.get(span)).unwrap_or_default();
    let span = error.span().filter(|_| path != KeyPath::default());
    let guess = nearest(word, names.iter().copied()).map(|guess| format!("did you mean `{guess}`?"));

    let (what, allowed, fix) = if message.starts_with("unknown field") {
        let there = |name: &str| matches!(locate(root, &path.beside(name)), Place::Value(_));
        let fix = match nearest(word, names.iter().copied()) {
            Some(name) if there(name) => format!("remove the line: `{name}` is given beside it"),
            _ => guess.unwrap_or_else(|| "remove it, or move it to the table it belongs to".to_owned()),
        };
        (format!("{path} is not a key of a {}", format.kind), listed, fix)
    } else if message.starts_with("missing field") {
        missing(format, &path, word)
    } else if message.starts_with("unknown variant") {
        let quoted: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
        let fix = guess.unwrap_or_else(|| "choose one of these".to_owned());
        (format!("{path} = {written} is not allowed"), quoted.join(", "), fix)
    } else if message.contains("overflow") {
        let fix = "write a number that fits: below 1e308".to_owned();
        (format!("{path} = {written} is too large"), "a number".to_owned(), fix)
    } else {
        let (allowed, fix) = expected(message, written);
        let short = written.len() <= 60 && !written.starts_with('[');
        let value = if short { format!(" = {written}") } else { String::new() };
        (format!("{path}{value} is not allowed"), allowed, fix)
    };
    Diagnostic { what, span, allowed, fix }
}

fn missing(format: &Format, path: &KeyPath, key: &str) -> (String, String, String) {
    let fix = match (path == &KeyPath::default(), key) {
        (true, "title") => "add title = \"...\" as the first line".to_owned(),
        (true, "cases") => "add cases = [\"NAME.toml\"], relative to the study file".to_owned(),
        (true, "bodies") => "add [[bodies]] with a body".to_owned(),
        (true, "materials") => "add a [materials.NAME] table".to_owned(),
        (true, _) => format!("add a [{key}] table"),
        (false, "run") => "add a [stages.run] table".to_owned(),
        (false, _) => format!("add {key} = ... below"),
    };
    let what = format!("{} is missing", path.key(key));
    (what, format!("this key has no default; {} explains all keys", format.page), fix)
}

/// What serde expected, in words, and what to do about it.
fn expected(message: &str, written: &str) -> (String, String) {
    let is_text = written.starts_with(['"', '\'']);
    let unquoted = written.trim_matches(['"', '\'']);
    let (allowed, fix) = match message.rsplit_once("expected ").map_or("", |(_, expected)| expected) {
        "f64" | "u32" | "usize" | "a string" | "a boolean" if written.starts_with('[') => {
            let inner = written.trim_matches(['[', ']']).trim();
            let single = !inner.is_empty() && !inner.contains([',', '[', '\n']);
            let fix = if single {
                format!("write one value, without brackets: {inner}")
            } else {
                "write one value, without brackets".to_owned()
            };
            ("one value, not a list", fix)
        }
        "f64" | "u32" | "usize" | "a string" | "a boolean" if written.starts_with('{') => {
            ("one value, not a table", "write one value, without braces".to_owned())
        }
        "f64" if is_text && unquoted.parse::<f64>().is_ok() => {
            ("a number", format!("write it without quotes: {unquoted}"))
        }
        "f64" if message.contains("i128") => ("a number", "write large numbers with an exponent: 1e20".to_owned()),
        "f64" => ("a number", "write a number such as 1.5 or 1.0e6".to_owned()),
        "u32" | "usize" => {
            ("a whole number, not negative", "write a number such as 4, without a decimal point".to_owned())
        }
        "a boolean" => ("true or false", "write true or false, without quotes".to_owned()),
        "a string" => ("text in double quotes", format!("write {:?}", unquoted)),
        "a sequence" => ("a list", "write a list such as [0.1, 0.2]".to_owned()),
        other if other.starts_with("an array of length 2") => {
            ("two numbers", "write two numbers such as [0.0, 1.0]".to_owned())
        }
        "a map" => ("a table", "write a [table], or { \"PATH\" = VALUE }".to_owned()),
        other if other.starts_with("struct ") => ("a table", "write a [table] with the keys of this part".to_owned()),
        _ => (
            "one of the words of the format, in double quotes",
            "write one of the words of the format, in double quotes".to_owned(),
        ),
    };
    (allowed.to_owned(), fix)
}
