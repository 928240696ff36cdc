//! Circles within a folder: modules beside each other, files or folders, that name each other, be it by way of others or of what their
//! parent hands on by `use`. A module and its children may name each other: in Rust they share what is private.

use std::collections::{BTreeMap, BTreeSet};

/// Who names whom.
pub type Graph<'a> = BTreeMap<&'a str, Vec<&'a str>>;

/// Path of the module of the file at `path`, counted from the root of its crate.
fn module(path: &str) -> Vec<&str> {
    let parts = path.trim_end_matches(".rs").split('/');
    parts.filter(|part| !["mod", "main", "lib"].contains(part)).collect()
}

/// Names, `::`, and every other sign for itself.
fn tokens(code: &str) -> Vec<&str> {
    let mut found = Vec::new();
    let mut rest = code.trim_start();
    while let Some(first) = rest.chars().next() {
        let named = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        let length = if named > 0 { named } else { first.len_utf8() + usize::from(rest.starts_with("::")) };
        found.push(&rest[..length]);
        rest = rest[length..].trim_start();
    }
    found
}

/// The paths in a code, with those between braces written out, and whether each stands after `use`.
fn paths(code: &str) -> Vec<(bool, Vec<&str>)> {
    /// Reads what begins after `before` and returns where it ends.
    fn read<'a>(tokens: &[&'a str], mut at: usize, mut before: Vec<&'a str>, found: &mut Vec<Vec<&'a str>>) -> usize {
        while let Some(token) = tokens.get(at) {
            at += 1;
            if *token == "{" {
                while tokens.get(at).is_some_and(|t| *t != "}") {
                    at = if tokens[at] == "," { at + 1 } else { read(tokens, at, before.clone(), found) };
                }
                return at + 1;
            }
            before.push(token);
            if tokens.get(at) != Some(&"::") {
                break;
            }
            at += 1;
        }
        found.push(before);
        at
    }
    let tokens = tokens(code);
    let (mut at, mut all) = (0, Vec::new());
    while at < tokens.len() {
        if !tokens[at].starts_with(|c: char| c.is_alphabetic() || c == '_') {
            at += 1;
            continue;
        }
        let mut found = Vec::new();
        let used = at > 0 && tokens[at - 1] == "use";
        at = read(&tokens, at, Vec::new(), &mut found);
        all.extend(found.into_iter().map(|path| (used, path)));
    }
    all
}

/// The modules of a crate with the paths that each names, counted from the root.
struct Map<'a> {
    named: BTreeMap<Vec<&'a str>, Vec<(bool, Vec<&'a str>)>>,
    /// All modules, also those that have no file of their own.
    known: BTreeSet<Vec<&'a str>>,
}

impl<'a> Map<'a> {
    fn new(sources: &'a BTreeMap<String, String>) -> Self {
        let modules = || sources.keys().map(|path| module(path));
        let known = modules().flat_map(|m| (0..=m.len()).map(move |length| m[..length].to_vec())).collect();
        let mut map = Map { named: BTreeMap::new(), known };
        for (module, code) in modules().zip(sources.values()) {
            let paths = paths(code).into_iter();
            let absolute = paths.filter_map(|(used, path)| Some((used, map.of_the_root(&module, &path)?))).collect();
            map.named.insert(module, absolute);
        }
        map
    }

    fn knows(&self, module: &[&'a str]) -> bool {
        self.known.contains(module)
    }

    /// A path that `module` names, counted from the root; `None` if it leads out of the crate or into the file itself.
    fn of_the_root(&self, module: &[&'a str], path: &[&'a str]) -> Option<Vec<&'a str>> {
        let up = path.iter().take_while(|part| **part == "super").count();
        let (base, rest) = match path[0] {
            "crate" => (&[][..], &path[1..]),
            "self" => (module, &path[1..]),
            "super" => (&module[..module.len().checked_sub(up)?], &path[up..]),
            _ => (module, path),
        };
        let whole = [base, rest].concat();
        (matches!(path[0], "crate" | "self" | "super") || self.knows(&whole[..base.len() + 1])).then_some(whole)
    }

    /// Where a path leads if modules on its way hand on what they `use`.
    fn followed(&self, path: &[&'a str]) -> Vec<&'a str> {
        let parent = (0..path.len()).rev().find(|length| self.knows(&path[..*length])).unwrap_or(0);
        let (Some(name), Some(own)) = (path.get(parent), self.named.get(&path[..parent])) else { return path.to_vec() };
        let from_below = |to: &[&str]| to.len() > parent + 1 && to.starts_with(&path[..parent]);
        match own.iter().find(|(used, to)| *used && to.last() == Some(name) && from_below(to)) {
            Some((_, to)) if !self.knows(&path[..parent + 1]) => self.followed(to),
            _ => path.to_vec(),
        }
    }
}

/// Who names whom in each folder of a crate; `sources` are its files by their paths from the root, without tests and comments.
pub fn folders(sources: &BTreeMap<String, String>) -> BTreeMap<String, Graph<'_>> {
    let map = Map::new(sources);
    let mut found: BTreeMap<String, Graph> = BTreeMap::new();
    for (module, named) in &map.named {
        for to in named.iter().map(|(_, path)| map.followed(path)) {
            let common = module.iter().zip(&to).take_while(|(a, b)| a == b).count();
            let (Some(from), Some(into)) = (module.get(common), to.get(common)) else { continue };
            if map.knows(&to[..=common]) {
                let folder = found.entry(module[..common].join("/")).or_default();
                folder.entry(from).or_default().push(into);
                folder.entry(into).or_default();
            }
        }
    }
    found
}

/// Those who name each other in a circle, and those on a way between two circles.
pub fn circle<'a>(graph: &Graph<'a>) -> Vec<&'a str> {
    let mut left: Vec<&str> = graph.keys().copied().collect();
    loop {
        let before = left.clone();
        let names = |from: &str, to: &str| graph[from].contains(&to);
        left.retain(|x| before.iter().any(|y| names(x, y)) && before.iter().any(|y| names(y, x)));
        if left.len() == before.len() {
            return left;
        }
    }
}

#[test]
fn circles_are_found() {
    let found = |files: &[(&str, &str)]| -> Vec<String> {
        let sources = files.iter().map(|(path, code)| (path.to_string(), code.to_string())).collect();
        let all = folders(&sources);
        all.iter().map(|(folder, graph)| format!("{folder}: {}", circle(graph).join(" "))).collect()
    };
    let peak = ("gauge/peak.rs", "pub struct Peak;");
    let gauges = |barrier, running, parent| {
        found(&[("gauge/barrier.rs", barrier), ("gauge/running.rs", running), ("gauge/mod.rs", parent), peak])
    };
    let circle = ["gauge: barrier running"];
    let uses = "use super::running::RunningMean;";
    assert_eq!(gauges(uses, "use super::barrier::Peak;", ""), circle, "two files");
    assert_eq!(gauges(uses, "use crate::gauge::barrier;", ""), circle);
    assert_eq!(gauges(uses, "use super::{passage, barrier::{self, Peak}};", ""), circle);
    assert_eq!(gauges(uses, "fn f() -> Vec<super::barrier::Peak> { todo!() }", ""), circle);
    assert_eq!(
        gauges(uses, "use super::Peak;", "pub use barrier::{ForceSample, Peak};"),
        circle,
        "by way of the parent"
    );
    assert_eq!(gauges(uses, "use crate::gauge::Peak;", "pub use self::barrier::Peak;"), circle);
    let of_three = [("run/a.rs", "use super::b;"), ("run/b.rs", "use super::c::x;"), ("run/c.rs", "use super::a::y;")];
    assert_eq!(found(&of_three), ["run: a b c"]);
    let with_folders =
        [("run/a/mod.rs", "mod c;"), ("run/a/c.rs", "use super::super::b;"), ("run/b.rs", "use super::a;")];
    assert_eq!(found(&with_folders), ["run: a b"], "a folder beside a file");
    let outer = [
        ("run/a.rs", "use crate::run::inner::x;"),
        ("run/inner.rs", "mod c;"),
        ("run/inner/c.rs", "use crate::run::a;"),
    ];
    assert_eq!(found(&outer), ["run: a inner"]);

    assert_eq!(gauges(uses, "use super::peak::Peak;", "pub use barrier::ForceSample;"), ["gauge: "]);
    assert_eq!(gauges(uses, "use super::Peak;", "pub use peak::Peak;"), ["gauge: "]);
    let into_it = [("run/d.rs", "use super::a;"), of_three[0], of_three[1], of_three[2], ("run/e.rs", "")];
    assert_eq!(found(&into_it), ["run: a b c"]);
    let parent = [("run/mod.rs", "mod a; use a::X; pub struct Y;"), ("run/a.rs", "use super::Y; use std::run::a;")];
    assert!(found(&parent).is_empty(), "a module and its child");
}
