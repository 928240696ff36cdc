//! CSV tables: one header line, one row of numbers per line, an empty cell for "no value".

use std::fs::File;
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::OutputError;
use super::number::push_number;
use crate::seeded::{self, Seed};

/// Significant digits written.
pub const DIGITS: usize = 9;
/// Significant digits of a place that is a kilometre or more from the origin: a micrometre of a northing.
const PLACE_DIGITS: usize = 13;

/// Whether a column holds places, by its name: `x_m`, `front_x_m`, `y_m`.
fn is_place(name: &str) -> bool {
    let end = |end: &str| name.strip_suffix(end).is_some_and(|start| start.is_empty() || start.ends_with('_'));
    end("x_m") || end("y_m")
}

/// Significant digits of a value, of a place or not.
fn digits(value: f64, place: bool) -> usize {
    match () {
        () if seeded::is(Seed::OutputDigits) => 2,
        () if place && value.abs() >= 1000.0 => PLACE_DIGITS,
        () => DIGITS,
    }
}

/// Bytes collected before they are handed to the file.
const BUFFER_BYTES: usize = 1 << 16;

/// Streams rows of numbers to a CSV file.
///
/// Numbers are rounded to nine significant digits, places beyond a kilometre to thirteen, and then written in the shortest form that reads back as
/// the rounded value: plain (`0.00125`, `350`) from 1e-5 up to 1e15, with an exponent (`2.5e-9`) outside. NaN is an
/// empty cell. The file always ends in a complete row, also after a failed write.
#[derive(Debug)]
pub struct TableWriter {
    path: PathBuf,
    file: File,
    /// Which columns hold places, one for each.
    places: Vec<bool>,
    buffer: Vec<u8>,
    /// Length of the file, always the end of a row.
    bytes: u64,
    /// Lines in the file, the header among them.
    lines: u64,
    /// Lines in `buffer`.
    pending: u64,
}

impl TableWriter {
    /// Creates `path`, replacing what was there, and writes the header. A column name ends in its unit (`time_s`).
    ///
    /// # Errors
    /// [`OutputError::Name`] for a name that is empty, repeated, or holds a comma, a quote or a line break;
    /// [`OutputError::Create`] or [`OutputError::Append`] if the file cannot be written.
    pub fn create<S: AsRef<str>>(path: impl AsRef<Path>, columns: &[S]) -> Result<Self, OutputError> {
        let path = path.as_ref().to_path_buf();
        let mut header = String::new();
        let refuse = |name: &str, reason| OutputError::Name { path: path.clone(), name: name.to_owned(), reason };
        if columns.is_empty() {
            return Err(refuse("", "a table needs at least one column"));
        }
        for (k, name) in columns.iter().map(AsRef::as_ref).enumerate() {
            if name.is_empty() || name.trim() != name {
                return Err(refuse(name, "a column name is not empty and has no space at its ends"));
            }
            if name.contains([',', '"', '\n', '\r']) {
                return Err(refuse(name, "a column name has no comma, quote or line break"));
            }
            if columns[..k].iter().any(|other| other.as_ref() == name) {
                return Err(refuse(name, "a column name stands once in a table"));
            }
            header.push_str(if k == 0 { "" } else { "," });
            header.push_str(name);
        }
        header.push('\n');
        let file = File::create(&path).map_err(|source| OutputError::Create { path: path.clone(), source })?;
        let mut writer = Self {
            path,
            file,
            places: columns.iter().map(|name| is_place(name.as_ref())).collect(),
            buffer: header.into_bytes(),
            bytes: 0,
            lines: 0,
            pending: 1,
        };
        writer.flush()?;
        Ok(writer)
    }

    /// Adds a row, one value per column. It reaches the file when enough rows have collected or at [`flush`](Self::flush).
    ///
    /// # Errors
    /// [`OutputError::RowLength`] (the row is not taken), or [`OutputError::Append`] (it is held for the next attempt).
    pub fn row(&mut self, values: &[f64]) -> Result<(), OutputError> {
        if values.len() != self.places.len() {
            let (expected, found) = (self.places.len(), values.len());
            return Err(OutputError::RowLength { path: self.path.clone(), expected, found });
        }
        if let [value] = values
            && value.is_nan()
        {
            self.buffer.extend_from_slice(b"\"\""); // a blank line would be no row at all
        }
        for (k, (value, place)) in values.iter().zip(&self.places).enumerate() {
            if k > 0 {
                self.buffer.push(b',');
            }
            push_number(&mut self.buffer, *value, digits(*value, *place));
        }
        self.buffer.push(b'\n');
        self.pending += 1;
        if self.buffer.len() >= BUFFER_BYTES { self.flush() } else { Ok(()) }
    }

    /// Hands all rows to the file, so that another program can read them.
    ///
    /// # Errors
    /// [`OutputError::Append`], for example on a full disk. The file then ends in the last complete row that fitted; the
    /// other rows are kept and written by the next call that succeeds.
    pub fn flush(&mut self) -> Result<(), OutputError> {
        let mut taken = 0;
        let mut failure = None;
        while taken < self.buffer.len() {
            match self.file.write(&self.buffer[taken..]) {
                Ok(0) => failure = Some(std::io::ErrorKind::WriteZero.into()),
                Ok(count) => taken += count,
                Err(source) if source.kind() == std::io::ErrorKind::Interrupted => {}
                Err(source) => failure = Some(source),
            }
            if failure.is_some() {
                break;
            }
        }
        let whole = self.buffer[..taken].iter().rposition(|byte| *byte == b'\n').map_or(0, |k| k + 1);
        let rows = self.buffer[..whole].iter().filter(|byte| **byte == b'\n').count() as u64;
        self.bytes += whole as u64;
        self.lines += rows;
        self.pending -= rows;
        self.buffer.drain(..whole);
        let Some(source) = failure else { return Ok(()) };
        let _ = self.file.set_len(self.bytes);
        let _ = self.file.seek(SeekFrom::Start(self.bytes));
        let path = self.path.clone();
        Err(OutputError::Append { path, rows: self.lines.saturating_sub(1), pending: self.pending, source })
    }

    /// Writes what is left, syncs the file to the disk and returns the number of rows in it.
    ///
    /// # Errors
    /// [`OutputError::Append`].
    pub fn finish(mut self) -> Result<u64, OutputError> {
        self.flush()?;
        let rows = self.lines.saturating_sub(1);
        self.file.sync_all().map_err(|source| OutputError::Append {
            path: self.path.clone(),
            rows,
            pending: 0,
            source,
        })?;
        Ok(rows)
    }
}

impl Drop for TableWriter {
    /// Saves the rows still held when a run ends early. A failure has nobody left to hear of it.
    fn drop(&mut self) {
        let _ = self.flush();
    }
}

/// A column as read: its values, or the line and text of its first cell that is not a number.
type Column = Result<Vec<f64>, (u64, String)>;

/// A CSV table in memory, by named column.
#[derive(Debug, Clone)]
pub struct Table {
    path: PathBuf,
    text: String,
    names: Vec<String>,
    columns: Vec<Column>,
    rows: usize,
}

impl Table {
    /// Reads a table with a header line. An empty cell is NaN; a column of text only matters to those who ask for it.
    ///
    /// # Errors
    /// [`OutputError::Open`], or [`OutputError::Malformed`] for a line whose number of cells differs from the header's.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, OutputError> {
        let open = |source| OutputError::Open { path: path.as_ref().to_path_buf(), source };
        Self::parse(&std::fs::read_to_string(path.as_ref()).map_err(open)?, &path)
    }

    /// Reads the text of such a table; `path` stands for it in reports.
    ///
    /// # Errors
    /// [`OutputError::Malformed`] for a line whose number of cells differs from the header's.
    pub fn parse(text: &str, path: impl AsRef<Path>) -> Result<Self, OutputError> {
        let path = path.as_ref().to_path_buf();
        let malformed = |line, reason: String| OutputError::Malformed { path: path.clone(), line, reason };
        let mut reader = reader(text);
        let header = reader.headers().map_err(|error| malformed(1, error.to_string()))?;
        let names: Vec<String> = header.iter().map(str::to_owned).collect();
        if names.is_empty() {
            return Err(malformed(1, "there is no header".to_owned()));
        }
        let mut columns: Vec<Column> = names.iter().map(|_| Ok(Vec::new())).collect();
        let mut rows = 0;
        let mut record = csv::StringRecord::new();
        loop {
            let line = reader.position().line();
            if !reader.read_record(&mut record).map_err(|error| malformed(line, error.to_string()))? {
                break;
            }
            let line = record.position().map_or(line, csv::Position::line);
            if record.len() != names.len() {
                let reason = format!("{} cells under a header of {}", record.len(), names.len());
                return Err(malformed(line, reason));
            }
            for (column, cell) in columns.iter_mut().zip(&record) {
                let Ok(values) = column else { continue };
                match cell.parse() {
                    Ok(value) => values.push(value),
                    Err(_) if cell.is_empty() => values.push(f64::NAN),
                    Err(_) => *column = Err((line, cell.to_owned())),
                }
            }
            rows += 1;
        }
        Ok(Self { path, text: text.to_string(), names, columns, rows })
    }

    /// The file the table was read from.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Names of the columns, in the order of the file.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Number of rows below the header.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The cells of a column as text: names and parameters by which rows are told apart.
    ///
    /// # Errors
    /// [`OutputError::MissingColumn`] or [`OutputError::Malformed`].
    pub fn cells(&self, name: &str) -> Result<Vec<String>, OutputError> {
        let Some(k) = self.names.iter().position(|other| other == name) else {
            let available = self.names.join(", ");
            return Err(OutputError::MissingColumn { path: self.path.clone(), column: name.to_owned(), available });
        };
        let text = |(line, row): (usize, Result<csv::StringRecord, csv::Error>)| {
            let malformed = |reason| OutputError::Malformed { path: self.path.clone(), line: line as u64 + 2, reason };
            let row = row.map_err(|error| malformed(error.to_string()))?;
            row.get(k).map(str::to_owned).ok_or_else(|| malformed("a cell is missing".to_owned()))
        };
        reader(&self.text).records().enumerate().map(text).collect()
    }

    /// The values of a column, in the unit its name ends in; NaN where the cell is empty.
    ///
    /// # Errors
    /// [`OutputError::MissingColumn`], or [`OutputError::NotANumber`] if a cell of the column holds text.
    pub fn column(&self, name: &str) -> Result<&[f64], OutputError> {
        let path = || self.path.clone();
        let Some(k) = self.names.iter().position(|other| other == name) else {
            let available = self.names.join(", ");
            return Err(OutputError::MissingColumn { path: path(), column: name.to_owned(), available });
        };
        self.columns[k].as_deref().map_err(|(line, text)| OutputError::NotANumber {
            path: path(),
            column: name.to_owned(),
            line: *line,
            text: text.clone(),
        })
    }
}

fn reader(text: &str) -> csv::Reader<&[u8]> {
    csv::ReaderBuilder::new().flexible(true).trim(csv::Trim::All).from_reader(text.as_bytes())
}

#[cfg(test)]
#[path = "table_tests.rs"]
mod tests;
