//! Finds problems in the text of a case file and renders them with the line at fault.

use std::fmt::Write as _;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::path::{KeyPath, PathSegment};
use super::validate::Problem;

/// Longer lines are not shown, characters.
const LONGEST_LINE: usize = 200;
/// Longest value taken from the text into a headline, characters.
const LONGEST_VALUE: usize = 60;

/// Whether a report stops the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// The case cannot be run.
    Error,
    /// The case can be run and looks like a mistake.
    Warning,
}

/// One report: what is wrong, where, what is allowed and what to do.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// One sentence that says what is wrong.
    pub what: String,
    /// The bytes at fault; `None`: the file as a whole.
    pub span: Option<Range<usize>>,
    /// What is allowed; may be empty.
    pub allowed: String,
    /// What to do.
    pub fix: String,
}

/// The text of a case file under the name by which the user knows it.
#[derive(Clone, Copy, Debug)]
pub struct Source<'a> {
    /// Name in reports: the path as given.
    pub name: &'a str,
    /// The text.
    pub text: &'a str,
}

/// Where a path leads in a document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// To this value.
    Value(Range<usize>),
    /// To nothing; this is the innermost table or array on the way that exists.
    Enclosing(Range<usize>),
    /// To the document itself, or to a key missing at its top.
    Document,
}

/// Looks a path up in a document.
pub fn locate(root: &DeTable<'_>, path: &KeyPath) -> Place {
    let mut inner: Option<&Spanned<DeValue<'_>>> = None;
    for segment in &path.0 {
        let next = match (segment, inner) {
            (PathSegment::Key(key), None) => root.get(key.as_str()),
            (PathSegment::Key(key), Some(value)) => value.get_ref().get(key.as_str()),
            (PathSegment::Index(index), Some(value)) => value.get_ref().get(*index),
            (PathSegment::Index(_), None) => None,
        };
        match (next, inner) {
            (Some(value), _) => inner = Some(value),
            (None, Some(value)) => return Place::Enclosing(value.span()),
            (None, None) => return Place::Document,
        }
    }
    inner.map_or(Place::Document, |value| Place::Value(value.span()))
}

/// The path of the value, or else of the key, that begins at this byte.
pub fn path_at(root: &DeTable<'_>, start: usize) -> Option<KeyPath> {
    path_in_table(root, start, &KeyPath::default())
}

fn path_in_table(table: &DeTable<'_>, start: usize, at: &KeyPath) -> Option<KeyPath> {
    table.iter().find_map(|(key, value)| {
        let path = at.key(key.get_ref());
        if key.span().start == start { Some(path) } else { path_in_value(value, start, &path) }
    })
}

fn path_in_value(value: &Spanned<DeValue<'_>>, start: usize, at: &KeyPath) -> Option<KeyPath> {
    if value.span().start == start {
        return Some(at.clone());
    }
    match value.get_ref() {
        DeValue::Table(table) => path_in_table(table, start, at),
        DeValue::Array(array) => {
            array.iter().enumerate().find_map(|(index, value)| path_in_value(value, start, &at.index(index)))
        }
        _ => None,
    }
}

impl Source<'_> {
    /// Places a problem in the text. The headline quotes the value as the user wrote it.
    pub fn diagnose(&self, root: &DeTable<'_>, problem: &Problem) -> Diagnostic {
        let mut what = problem.what.clone();
        let span = match locate(root, &problem.path) {
            Place::Document => None,
            Place::Enclosing(span) => Some(span),
            Place::Value(span) => {
                let written = self.text.get(span.clone()).unwrap_or_default();
                let short = written.chars().count() <= LONGEST_VALUE && !written.contains(['\n', '\r']);
                if short && !problem.value.is_empty() {
                    let assignment = |value: &str| format!("{} = {value} ", problem.path);
                    what = what.replacen(&assignment(&problem.value), &assignment(written), 1);
                }
                Some(span)
            }
        };
        Diagnostic { what, span, allowed: problem.allowed.clone(), fix: problem.fix.clone() }
    }

    /// Line and column, from 1, in characters.
    pub fn line_and_column(&self, byte: usize) -> (usize, usize) {
        let before = self.text.get(..byte).unwrap_or(self.text);
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
    }

    /// Renders a report, ending in a newline.
    pub fn render(&self, level: Level, diagnostic: &Diagnostic) -> String {
        let level = match level {
            Level::Error => "error",
            Level::Warning => "warning",
        };
        let mut out = format!("{level}: {}\n", printable(&diagnostic.what));
        let mut gutter = 1;
        if let Some(span) = &diagnostic.span {
            let (line, column) = self.line_and_column(span.start);
            gutter = line.to_string().len();
            let _ = writeln!(out, "{:gutter$}--> {}:{line}:{column}", "", printable(self.name));
            self.render_line(&mut out, line, column, span);
        } else {
            let _ = writeln!(out, "{:gutter$}--> {}", "", printable(self.name));
        }
        for (label, note) in [("allowed", &diagnostic.allowed), ("fix", &diagnostic.fix)] {
            if !note.is_empty() {
                let _ = writeln!(out, "{:gutter$} = {label}: {}", "", printable(note));
            }
        }
        out
    }

    fn render_line(&self, out: &mut String, line: usize, column: usize, span: &Range<usize>) {
        let content = self.text.split('\n').nth(line - 1).unwrap_or_default().trim_end_matches('\r');
        let length = content.chars().count();
        if length > LONGEST_LINE {
            return;
        }
        let gutter = line.to_string().len();
        let marked = self.text.get(span.clone()).map_or(0, |text| text.chars().count());
        let marks = marked.min((length + 1).saturating_sub(column)).max(1);
        let _ = writeln!(out, "{:gutter$} |", "");
        let _ = writeln!(out, "{line} | {}", printable(content));
        let _ = writeln!(out, "{:gutter$} | {:indent$}{}", "", "", "^".repeat(marks), indent = column - 1);
    }
}

/// Text without control characters, which could garble a terminal; each becomes a space, so that columns stay.
pub fn printable(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}
