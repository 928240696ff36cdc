//! VTK XML PolyData (`.vtp`): material points and outlines, as raw little-endian binary after the XML header.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::Path;

use super::{AtomicFile, OutputError};
use crate::seeded::{self, Seed};

/// Values of a field, asked for point by point so that any storage layout can be written without a copy.
#[derive(Clone, Copy)]
pub enum Values<'a> {
    /// An integer, such as the number of a material.
    Integer(&'a dyn Fn(usize) -> i64),
    /// A number.
    Scalar(&'a dyn Fn(usize) -> f64),
    /// A vector in the plane; its third component is written as 0.
    Vector(&'a dyn Fn(usize) -> [f64; 2]),
    /// A symmetric tensor in the order of VTK: xx, yy, zz, xy, yz, xz.
    SymmetricTensor(&'a dyn Fn(usize) -> [f64; 6]),
}

impl Values<'_> {
    fn components(&self) -> usize {
        match self {
            Values::Integer(_) | Values::Scalar(_) => 1,
            Values::Vector(_) => 3,
            Values::SymmetricTensor(_) => 6,
        }
    }

    fn type_name(&self) -> &'static str {
        if matches!(self, Values::Integer(_)) { "Int64" } else { "Float64" }
    }

    fn write(&self, out: &mut impl Write, k: usize) -> io::Result<()> {
        match self {
            Values::Integer(value) => out.write_all(&value(k).to_le_bytes()),
            Values::Scalar(value) => out.write_all(&value(k).to_le_bytes()),
            Values::Vector(value) => {
                let [x, y] = value(k);
                let [y, z] = seeded::exchanged(Seed::OutputVector, [y, 0.0]);
                [x, y, z].iter().try_for_each(|v: &f64| out.write_all(&v.to_le_bytes()))
            }
            Values::SymmetricTensor(value) => value(k).iter().try_for_each(|v| out.write_all(&v.to_le_bytes())),
        }
    }
}

/// A named field over the points.
#[derive(Clone, Copy)]
pub struct Field<'a> {
    /// Name with its unit at the end, as in `velocity_m_per_s`.
    pub name: &'a str,
    /// The values.
    pub values: Values<'a>,
}

/// A line or polygon of a rigid boundary.
#[derive(Debug, Clone, Copy)]
pub struct Polyline<'a> {
    /// Number of the boundary; it becomes the cell array `boundary`.
    pub boundary: i64,
    /// Corners (m), in order; the first is not repeated at the end.
    pub points_m: &'a [[f64; 2]],
    /// Whether the last corner joins the first and the inside is filled.
    pub closed: bool,
}

/// Writes `count` material points with their fields as one frame at `time_s` (s); `position_m` gives coordinates in m.
///
/// One vertex cell per point. The file appears by rename once it is complete. Doubles are stored to the last bit.
///
/// # Errors
/// [`OutputError::Name`] for an empty or repeated field name, [`OutputError::Create`] or [`OutputError::Write`].
pub fn write_points(
    path: impl AsRef<Path>,
    time_s: f64,
    count: usize,
    position_m: &dyn Fn(usize) -> [f64; 2],
    fields: &[Field<'_>],
) -> Result<(), OutputError> {
    for (k, field) in fields.iter().enumerate() {
        let repeated = fields[..k].iter().any(|other| other.name == field.name);
        if field.name.is_empty() || repeated {
            let (path, name) = (path.as_ref().to_path_buf(), field.name.to_owned());
            return Err(OutputError::Name { path, name, reason: "a field name is not empty and stands once" });
        }
    }
    let time = |_| seeded::times(Seed::OutputTime, time_s);
    let index = |k: usize| k as i64;
    let end = |k: usize| k as i64 + 1;
    let mut file = PolyData::default();
    file.open("<FieldData>");
    file.array("TimeValue", 1, Values::Scalar(&time));
    file.close("</FieldData>");
    file.open(&format!(
        "<Piece NumberOfPoints=\"{count}\" NumberOfVerts=\"{count}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" \
         NumberOfPolys=\"0\">"
    ));
    file.open("<Points>");
    file.array("Points", count, Values::Vector(position_m));
    file.close("</Points>");
    file.open("<Verts>");
    file.array("connectivity", count, Values::Integer(&index));
    file.array("offsets", count, Values::Integer(&end));
    file.close("</Verts>");
    file.open("<PointData>");
    for field in fields {
        file.array(field.name, count, field.values);
    }
    file.close("</PointData>");
    file.close("</Piece>");
    file.write(path.as_ref())
}

/// Writes outlines of rigid boundaries: open ones as lines, closed ones as polygons, with the cell array `boundary`.
///
/// # Errors
/// [`OutputError::Create`] or [`OutputError::Write`].
pub fn write_polylines(path: impl AsRef<Path>, outlines: &[Polyline<'_>]) -> Result<(), OutputError> {
    // VTK numbers the cells of a piece lines first, polygons after them.
    let mut cells: Vec<&Polyline<'_>> = outlines.iter().collect();
    cells.sort_by_key(|outline| outline.closed);
    let lines = cells.iter().filter(|outline| !outline.closed).count();
    let points: Vec<[f64; 2]> = cells.iter().flat_map(|outline| outline.points_m.iter().copied()).collect();
    let ends: Vec<i64> = cells
        .iter()
        .scan(0, |end, outline| {
            *end += outline.points_m.len() as i64;
            Some(*end)
        })
        .collect();
    let line_points = lines.checked_sub(1).map_or(0, |last| ends[last] as usize);

    let position = |k: usize| points[k];
    let index = |k: usize| k as i64;
    let line_end = |k: usize| ends[k];
    let polygon_index = |k: usize| (line_points + k) as i64;
    let polygon_end = |k: usize| ends[lines + k] - line_points as i64;
    let boundary = |k: usize| cells[k].boundary;
    let mut file = PolyData::default();
    file.open(&format!(
        "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{lines}\" NumberOfStrips=\"0\" \
         NumberOfPolys=\"{}\">",
        points.len(),
        cells.len() - lines
    ));
    file.open("<Points>");
    file.array("Points", points.len(), Values::Vector(&position));
    file.close("</Points>");
    file.open("<Lines>");
    file.array("connectivity", line_points, Values::Integer(&index));
    file.array("offsets", lines, Values::Integer(&line_end));
    file.close("</Lines>");
    file.open("<Polys>");
    file.array("connectivity", points.len() - line_points, Values::Integer(&polygon_index));
    file.array("offsets", cells.len() - lines, Values::Integer(&polygon_end));
    file.close("</Polys>");
    file.open("<CellData>");
    file.array("boundary", cells.len(), Values::Integer(&boundary));
    file.close("</CellData>");
    file.close("</Piece>");
    file.write(path.as_ref())
}

/// Text as it may stand in an XML attribute.
pub(super) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// The XML part of a file and the arrays that follow it, in the order of their offsets.
#[derive(Default)]
struct PolyData<'a> {
    xml: String,
    depth: usize,
    arrays: Vec<(usize, Values<'a>)>,
    offset: usize,
}

impl<'a> PolyData<'a> {
    fn line(&mut self, text: &str) {
        let _ = writeln!(self.xml, "{:indent$}{text}", "", indent = 4 + 2 * self.depth);
    }

    fn open(&mut self, tag: &str) {
        self.line(tag);
        self.depth += 1;
    }

    fn close(&mut self, tag: &str) {
        self.depth = self.depth.saturating_sub(1);
        self.line(tag);
    }

    /// Declares an array of `tuples` entries; its bytes are produced when the file is written.
    fn array(&mut self, name: &str, tuples: usize, values: Values<'a>) {
        let mut tag = format!(
            "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"",
            values.type_name(),
            escape(name),
            values.components()
        );
        if matches!(values, Values::SymmetricTensor(_)) {
            for (k, component) in ["xx", "yy", "zz", "xy", "yz", "xz"].iter().enumerate() {
                let _ = write!(tag, " ComponentName{k}=\"{component}\"");
            }
        }
        if name == "TimeValue" {
            tag.push_str(" NumberOfTuples=\"1\"");
        }
        let _ = write!(tag, " format=\"appended\" offset=\"{}\"/>", self.offset);
        self.line(&tag);
        self.offset += LENGTH_BYTES + tuples * values.components() * VALUE_BYTES;
        self.arrays.push((tuples, values));
    }

    fn write(&self, path: &Path) -> Result<(), OutputError> {
        let mut file = AtomicFile::create(path)?;
        self.stream(&mut file).map_err(|source| file.failure(source))?;
        file.commit()
    }

    fn stream(&self, out: &mut impl Write) -> io::Result<()> {
        write!(
            out,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" \
             header_type=\"UInt64\">\n  <PolyData>\n{}  </PolyData>\n  <AppendedData encoding=\"raw\">\n_",
            self.xml
        )?;
        for (tuples, values) in &self.arrays {
            let length = tuples * values.components() * VALUE_BYTES;
            out.write_all(&(length as u64).to_le_bytes())?;
            (0..*tuples).try_for_each(|k| values.write(out, k))?;
        }
        out.write_all(b"\n  </AppendedData>\n</VTKFile>\n")
    }
}

/// Bytes of the length that precedes every array (`header_type`).
const LENGTH_BYTES: usize = 8;
/// Bytes of an `Int64` or a `Float64`.
const VALUE_BYTES: usize = 8;

#[cfg(test)]
#[path = "vtk_tests.rs"]
mod tests;
