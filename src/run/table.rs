//! A table of a run: columns that say what they are, and a file that grows row by row.

use crate::output::{OutputError, TableWriter};
use std::path::Path;

/// A column of a table whose rows are made of `R`.
pub struct Column<R: 'static> {
    /// Name in the header; ends in the unit. `{boundary}` and `{surface}` stand for a name, see [`Per`].
    pub name: &'static str,
    /// Unit; "1" for a share or a ratio.
    pub unit: &'static str,
    /// What the number is.
    pub meaning: &'static str,
    /// The number, of the boundary or surface with this index where there is one column for each.
    pub(super) value: fn(&R, usize) -> f64,
}

/// How often some columns stand in a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Per {
    /// Once.
    Table,
    /// Once if the case has an inflow.
    Inflow,
    /// Once for each boundary, whose name replaces `{boundary}`.
    Boundary,
    /// Once for each boundary, then for each contact of two bodies, `A_on_B`; its name replaces `{surface}`.
    Surface,
}

/// Columns that follow each other.
pub(super) struct Group<R: 'static>(pub Per, pub &'static [Column<R>]);

/// A kind of table.
pub struct TableKind<R: 'static> {
    /// Name of the file.
    pub file: &'static str,
    /// What a row is.
    pub row: &'static str,
    pub(super) groups: &'static [Group<R>],
}

/// Names that stand in columns of which there is one for each.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Names {
    /// Of the boundaries.
    pub boundaries: Vec<String>,
    /// Of the boundaries and of the contacts of two bodies.
    pub surfaces: Vec<String>,
    /// Whether there is an inflow.
    pub inflow: bool,
}

impl Names {
    /// Names for columns that stand so often, and what they replace.
    fn of(&self, per: Per) -> (&str, &[String]) {
        match per {
            Per::Inflow if !self.inflow => ("", &[]),
            Per::Table | Per::Inflow => ("", const { &[String::new()] }),
            Per::Boundary => ("{boundary}", &self.boundaries),
            Per::Surface => ("{surface}", &self.surfaces),
        }
    }
}

impl<R> TableKind<R> {
    /// Names of the columns.
    pub(super) fn header(&self, names: &Names) -> Vec<String> {
        let mut header = Vec::new();
        for Group(per, columns) in self.groups {
            let (place, names) = names.of(*per);
            for name in names {
                let own = |c: &Column<R>| if place.is_empty() { c.name.into() } else { c.name.replace(place, name) };
                header.extend(columns.iter().map(own));
            }
        }
        header
    }

    /// Numbers of a row, in their order.
    pub(super) fn values(&self, names: &Names, row: &R, values: &mut Vec<f64>) {
        values.clear();
        for Group(per, columns) in self.groups {
            for k in 0..names.of(*per).1.len() {
                values.extend(columns.iter().map(|c| (c.value)(row, k)));
            }
        }
    }

    /// What it holds.
    pub(super) fn describe(&self) -> TableText {
        let columns = self.groups.iter().flat_map(|g| g.1);
        let columns = columns.map(|c| ColumnText { name: c.name, unit: c.unit, meaning: c.meaning }).collect();
        TableText { file: self.file, row: self.row, columns }
    }
}

/// A table on disk that grows row by row.
#[derive(Debug)]
pub(super) struct OpenTable<R: 'static> {
    kind: &'static TableKind<R>,
    names: Names,
    writer: TableWriter,
    values: Vec<f64>,
}

impl<R> OpenTable<R> {
    /// Creates the file with its header.
    pub fn create(kind: &'static TableKind<R>, path: &Path, names: Names) -> Result<Self, OutputError> {
        let writer = TableWriter::create(path, &kind.header(&names))?;
        Ok(Self { kind, names, writer, values: Vec::new() })
    }

    /// Adds a row.
    pub fn row(&mut self, row: &R) -> Result<(), OutputError> {
        self.kind.values(&self.names, row, &mut self.values);
        self.writer.row(&self.values)
    }

    /// Hands all rows to the file.
    pub fn flush(&mut self) -> Result<(), OutputError> {
        self.writer.flush()
    }

    /// Writes what is left and closes the file.
    pub fn finish(self) -> Result<(), OutputError> {
        self.writer.finish().map(|_| ())
    }
}

/// A table that is there if it is wanted.
pub(super) fn optional<R>(
    wanted: bool,
    kind: &'static TableKind<R>,
    path: &Path,
) -> Result<Option<OpenTable<R>>, OutputError> {
    wanted.then(|| OpenTable::create(kind, path, Names::default())).transpose()
}

/// Hands all rows of a table to its file, if it is there.
pub(super) fn flush<R>(table: &mut Option<OpenTable<R>>) -> Result<(), OutputError> {
    table.as_mut().map_or(Ok(()), OpenTable::flush)
}

impl<R> std::fmt::Debug for TableKind<R> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.file)
    }
}

/// What a table of a run holds.
#[derive(Debug, Clone, PartialEq)]
pub struct TableText {
    /// Name of the file. NAME stands for that of a barrier or a base that is not the first, or of a window. Of such a barrier it follows
    /// in the names of its other files, too.
    pub file: &'static str,
    /// What a row is.
    pub row: &'static str,
    /// Its columns in order.
    pub columns: Vec<ColumnText>,
}

/// What a column of a table holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ColumnText {
    /// Name in the header. Columns with `{boundary}` in it stand there once for each boundary, those with `{surface}` once for each
    /// boundary and then for each contact of two bodies (`A_on_B`), with its name in lower case and `_` for what is neither letter
    /// nor digit.
    pub name: &'static str,
    /// Unit; "1" for a share or a ratio, "-" for a number that counts.
    pub unit: &'static str,
    /// What the number is.
    pub meaning: &'static str,
}
