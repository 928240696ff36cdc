//! What a refusal proposes is done, as a user would do it with the report in hand: then that refusal is gone.

use super::{bad_input, changed, contacts, gauges, parse};
use std::collections::BTreeSet;

/// Fixes that leave something to decide: how each begins.
const BY_HAND: &[&str] = &[
    "remove it, or move it",
    "give both",
    "give the interval a length",
    "use the angle in degrees within",
    "add [stages.tilt] or leave",
    "leave [stages.settle] out",
    "move the body, or enlarge",
    "move it into the domain",
    "leave this time out",
    "sort the times",
    "enlarge the body",
    "refine the grid",
    "check the unit",
    "rename one of",
    "remove one of them",
    "add friction_angle_deg",
    "add poisson",
    "move the origin",
    "write a number; nan and inf",
    "add [[contacts]] with",
    "rename the boundary",
    "name two bodies",
    "name the other body",
    "name a body, or",
    "remove one of the two",
    "use the angle",
    "add a [",
    "add title",
    "add [[bodies]]",
    "give it a name such as",
    "add y_m",
    "add friction",
    "the same key or",
    "close the",
    "put text in",
    "write a value after",
    "write decimals",
    "write a number alone",
    "write numbers with a digit",
    "each line is",
    "give the material a name",
    "write [",
    "write one of the words",
    "choose one of these",
    "write a [table]",
    "write a list",
    "use numerics.boundary_contact",
];

/// A refusal as it is printed.
#[derive(Debug, Clone, PartialEq)]
struct Refusal {
    what: String,
    allowed: String,
    line: Option<usize>,
    column: usize,
    fix: String,
}

impl Refusal {
    /// What is wrong with which key, whatever the value.
    fn kind(&self) -> (&str, &str) {
        let what = self.what.split(" = ").next().unwrap_or_default();
        (what.split(" by ").next().unwrap_or_default(), &self.allowed)
    }
}

fn refusals(report: &str) -> Vec<Refusal> {
    let blocks = report.split("\n\n").filter(|block| block.starts_with("error: ") && block.contains("= fix: "));
    let read = |block: &str| {
        let what = block.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned();
        let place = block.lines().find_map(|l| l.split_once("case.toml:")).map(|(_, at)| at);
        let (line, column) = place.and_then(|at| at.split_once(':')).unzip();
        let note =
            |label: &str| block.lines().find_map(|l| l.split_once(label)).map_or("", |(_, text)| text).to_owned();
        let (allowed, fix) = (note(" = allowed: "), note(" = fix: "));
        let number = |text: &str| text.trim().parse().expect("a number");
        Refusal { what, allowed, line: line.map(number), column: column.map_or(1, number), fix }
    };
    blocks.map(read).collect()
}

/// The lines of the table that line `at` (from 0) is in.
fn table(lines: &[String], at: usize) -> std::ops::Range<usize> {
    let header = |l: &String| l.starts_with('[');
    let start = (0..=at).rev().find(|k| header(&lines[*k])).unwrap_or(0);
    let end = (start + 1..lines.len()).find(|k| header(&lines[*k])).unwrap_or(lines.len());
    start..end
}

fn key_of(line: &str) -> &str {
    line.split('=').next().unwrap_or_default().trim()
}

/// Writes `key = value` where `key` stands near line `at`, or below it.
fn set(lines: &mut Vec<String>, at: usize, key: &str, value: &str) {
    let (of, key) = key.rsplit_once('.').unwrap_or(("", key));
    let near = if of.is_empty() {
        table(lines, at)
    } else {
        let at = lines.iter().position(|l| l.starts_with(&format!("[{of}]"))).expect("a table");
        table(lines, at)
    };
    match near.clone().find(|k| key_of(&lines[*k]) == key) {
        Some(k) => lines[k] = format!("{key} = {value}"),
        None => lines.insert(near.start + 1, format!("{key} = {value}")),
    }
}

/// Puts `value` in place of the value, or of the word, that begins at this place.
fn replace(lines: &mut [String], at: usize, column: usize, value: &str) {
    let line: Vec<char> = lines[at].chars().collect();
    let (before, rest) = line.split_at(column - 1);
    let end = match rest.first() {
        Some('"') => 2 + rest[1..].iter().position(|c| *c == '"').unwrap_or(rest.len() - 2),
        Some('[') => 1 + rest.iter().position(|c| *c == ']').unwrap_or(rest.len() - 1),
        _ => rest.iter().position(|c| " ,]=#".contains(*c)).unwrap_or(rest.len()),
    };
    lines[at] = before.iter().collect::<String>() + value + &rest[end..].iter().collect::<String>();
}

/// The text with the fix made; `None` if it leaves something to decide.
fn fixed(text: &str, refusal: &Refusal) -> Option<String> {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let at = refusal.line? - 1;
    let fix = refusal.fix.as_str();
    let first = |text: &str| text.split([' ', ',']).next().unwrap_or_default().to_owned();
    let quoted = |text: &str| text.split('`').nth(1).map(str::to_owned);
    // `KEY = VALUE` at the start of a text; a value ends at its bracket or quote, or at the next blank.
    let assignment = |text: &str| {
        let (key, rest) = text.split_once(" = ")?;
        let end = match rest.as_bytes().first()? {
            b'[' => rest.find(']')? + 1,
            b'"' => rest[1..].find('"')? + 2,
            _ => rest.find([' ', ',', ';']).unwrap_or(rest.len()),
        };
        (!key.contains(' ')).then(|| (key.to_owned(), rest[..end].to_owned()))
    };
    if BY_HAND.iter().any(|by_hand| fix.starts_with(by_hand)) {
        return None;
    }
    if fix.starts_with("did you mean") || fix.starts_with("use one of `") {
        let name = quoted(fix)?;
        let is_text = lines[at].chars().nth(refusal.column - 1) == Some('"');
        replace(&mut lines, at, refusal.column, &if is_text { format!("{name:?}") } else { name });
    } else if fix.starts_with("remove the line") {
        lines.remove(at);
    } else if let Some(rest) = fix.strip_prefix("remove ").filter(|rest| rest.contains(", and write ")) {
        let (gone, wanted) = rest.split_once(", and write ")?;
        let (key, value) = assignment(wanted)?;
        set(&mut lines, at, &key, &value);
        let k = table(&lines, at).find(|k| key_of(&lines[*k]) == gone)?;
        lines.remove(k);
    } else if let Some(by) = fix.strip_prefix("move the body by [") {
        let by: Vec<f64> = by.split([',', ']']).take(2).map(|x| x.trim().parse().expect("a number")).collect();
        for (key, by) in ["x_m", "y_m"].iter().zip(by) {
            let k = table(&lines, at).find(|k| key_of(&lines[*k]) == *key)?;
            let edges =
                lines[k].split(['[', ']']).nth(1)?.split(',').map(|x| x.trim().parse::<f64>().expect("a number") + by);
            lines[k] = format!("{key} = {:?}", edges.collect::<Vec<_>>());
        }
    } else if let Some((key, value)) =
        ["use ", "swap the two: ", "add a line such as ", "write two numbers: ", "write ", "add ", ""]
            .iter()
            .filter_map(|begin| fix.strip_prefix(begin))
            .find_map(assignment)
    {
        set(&mut lines, at, &key, &value);
    } else {
        let begin = [
            "use a positive value such as ",
            "use a value such as ",
            "write a number such as ",
            "write it without quotes: ",
            "write one value, without brackets: ",
            "write large numbers with an exponent: ",
            "write two numbers such as ",
            "use ",
            "write true or false",
            "write ",
        ];
        let rest = begin.iter().find_map(|begin| fix.strip_prefix(begin).map(|rest| (begin, rest)))?;
        let value = match rest {
            (&"write true or false", _) => "true".to_owned(),
            (_, rest) if rest.starts_with(['[', '"']) => rest[..rest[1..].find([']', '"'])? + 2].to_owned(),
            (_, rest) => first(rest),
        };
        replace(&mut lines, at, refusal.column, &value);
    }
    Some(lines.join("\n") + "\n")
}

#[test]
fn what_a_refusal_proposes_removes_it() {
    let tables = bad_input::ALL.into_iter().chain([gauges::BASES]).flatten();
    let texts: Vec<String> = tables
        .map(|(from, to, ..)| changed(from, to))
        .chain(contacts::wrong().into_iter().map(|(text, _)| text))
        .chain(gauges::wrong_windows().into_iter().map(|(text, ..)| text))
        .chain(turned())
        .collect();
    let (mut done, mut by_hand, mut wrong) = (0, BTreeSet::new(), Vec::new());
    for text in &texts {
        let Err(error) = parse(text, "case.toml") else { continue };
        for refusal in refusals(&error.to_string()) {
            let Some(fixed) = fixed(text, &refusal) else {
                let known = BY_HAND.iter().any(|begin| refusal.fix.starts_with(begin));
                if !known && refusal.line.is_some() {
                    wrong.push(format!("not understood: {refusal:?}"));
                }
                by_hand.insert(refusal.fix);
                continue;
            };
            let after = parse(&fixed, "case.toml").err().map_or_else(String::new, |e| e.to_string());
            if refusals(&after).iter().any(|r| r.kind() == refusal.kind()) || after.contains("this is not TOML") {
                wrong.push(format!("{refusal:?} came back:\n{after}"));
            }
            done += 1;
        }
    }
    println!("{done} fixes made, {} by hand:\n{by_hand:#?}", by_hand.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(done > 100, "only {done} fixes were made");
}

/// The flume's sand turned and moved into what is around it, by odd amounts and far from the origin.
fn turned() -> Vec<String> {
    let mut all = Vec::new();
    for angle in ["3.7", "10", "33.3", "-12.9", "91"] {
        for x in ["[-0.2, 0.0]", "[-0.2, 0.0123456789]", "[-0.21234567891, 0.0]", "[0.95, 1.2777777]"] {
            let text = changed("mass_kg = 30", &format!("rotation_deg = {angle}"));
            all.push(text.replacen("x_m = [-0.2, 0.0]", &format!("x_m = {x}"), 1));
        }
    }
    for x in ["[-0.2, 0.0123456789]", "[-0.21234567891, 0.0]", "[-0.23333333333333, 0.0]", "[1.0, 1.2000012345]"] {
        all.push(changed("x_m = [-0.2, 0.0]", &format!("x_m = {x}")));
    }
    all
}
