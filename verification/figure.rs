//! A figure of a rung: what to draw from which table. Figures are drawn from the tables' text and from nothing else.

use checkdam::plot::PlotError;
use checkdam::plot::curves::{self, Curve, Curves};
use checkdam::plot::heat_map::{self, HeatMap};
use std::path::Path;

/// A figure of a rung.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure {
    /// Table, without extension.
    pub table: &'static str,
    /// Name, without extension.
    pub name: &'static str,
    /// What to draw.
    pub drawing: Drawing,
}

/// What to draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drawing {
    /// Columns against a column.
    Curves(Curves<'static>),
    /// A column by two others.
    HeatMap(HeatMap),
}

/// A column that was computed.
pub(crate) const fn measured(column: &'static str, label: &'static str) -> Curve<'static> {
    Curve { column, label, exact: false }
}

/// A column of what should come out.
pub(crate) const fn exact(column: &'static str, label: &'static str) -> Curve<'static> {
    Curve { column, label, exact: true }
}

/// A figure of curves from a table.
pub(crate) const fn curves(table: &'static str, name: &'static str, curves: Curves<'static>) -> Figure {
    Figure { table, name, drawing: Drawing::Curves(curves) }
}

impl Figure {
    /// Draws it into the folder that holds its table; returns its name with extension.
    ///
    /// # Errors
    /// If the table cannot be read or the figure cannot be written.
    pub fn draw(&self, folder: &Path) -> Result<String, PlotError> {
        let file = format!("{}.svg", self.name);
        let (table, path) = (folder.join(self.table).with_extension("csv"), folder.join(&file));
        match &self.drawing {
            Drawing::Curves(what) => curves::draw(table, what, path)?,
            Drawing::HeatMap(what) => heat_map::draw(table, what, path)?,
        }
        Ok(file)
    }
}
