//! The flow over time, packed for the page: frames of points from the VTK files of a run, or of cells from `field.csv` without them.
//!
//! A point takes seven bytes a frame: two for each place, one each for speed, pressure and strain. Above a budget points are left
//! out first, down to four thousand, then frames.

use super::base64;
use crate::folder::Run;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;

/// Bytes of all frames.
const BUDGET: usize = 2_300_000;
/// Points that are kept whatever their number of frames.
const POINTS: usize = 4000;
const POINT_BYTES: usize = 7;
/// The share of values that the colours span; what is beyond has the last colour.
const SHOWN: f64 = 0.998;

/// A frame as it was read.
#[derive(Debug, Default)]
struct Frame {
    time: f64,
    points: Vec<Point>,
}

/// A material point, or a cell.
#[derive(Debug, Clone, Copy)]
struct Point {
    body: usize,
    at: [f64; 2],
    /// Speed (m/s), pressure (Pa), equivalent plastic shear strain; of a barrier that is a body speed and von Mises stress (Pa) twice.
    values: [f64; 3],
}

/// What the page needs to play the flow, or why there is nothing to play.
pub fn pack(run: &Run) -> Result<Value, String> {
    let solid = &structures(run)[..];
    let (frames, source, size, thinned) = match collection(run)? {
        Some(list) if !list.is_empty() => from_vtk(run, &list, solid)?,
        _ => from_field(run)?,
    };
    let shown = |of_solid: bool| {
        let points =
            || frames.iter().flat_map(|frame| &frame.points).filter(move |p| solid.contains(&p.body) == of_solid);
        [0, 1, 2].map(|k| top(points().map(|p| p.values[k])))
    };
    let [flow, body] = [shown(false), shown(true)];
    let places = || frames.iter().flat_map(|frame| &frame.points).map(|p| p.at);
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for at in places() {
        for axis in 0..2 {
            low[axis] = low[axis].min(at[axis]);
            high[axis] = high[axis].max(at[axis]);
        }
    }
    let mut bytes = Vec::new();
    let mut list = Vec::new();
    for frame in &frames {
        let n = frame.points.len();
        let solids = frame.points.iter().filter(|p| solid.contains(&p.body)).count();
        // What flows first, so that the page tells both apart by their number.
        let ordered = || {
            [false, true].into_iter().flat_map(|s| frame.points.iter().filter(move |p| solid.contains(&p.body) == s))
        };
        for axis in 0..2 {
            let span = (high[axis] - low[axis]).max(f64::MIN_POSITIVE);
            let place = |p: &Point| ((p.at[axis] - low[axis]) / span * 65535.0).round() as u16;
            ordered().for_each(|p| bytes.extend(place(p).to_le_bytes()));
        }
        for k in 0..3 {
            for p in ordered() {
                let most = if solid.contains(&p.body) { body[k] } else { flow[k] };
                bytes.push((p.values[k] / most * 255.0).round().clamp(0.0, 255.0) as u8);
            }
        }
        list.push(json!({"t": frame.time, "n": n, "solids": solids}));
    }
    Ok(json!({
        "frames": list, "low": low, "high": high, "flow": flow, "body": body, "size": size, "source": source,
        "thinned": thinned, "bytes": base64(&bytes),
    }))
}

/// The bodies of the case that are structures: those whose law is elastic.
fn structures(run: &Run) -> Vec<usize> {
    let case = run.summary.get("case");
    let bodies = case.and_then(|case| case.get("bodies")).and_then(toml::Value::as_array);
    let elastic = |body: &toml::Value| {
        let material = body.get("material")?.as_str()?;
        let law = case?.get("materials")?.get(material)?.get("law")?.as_str()?;
        Some(["linear_elastic", "neo_hookean"].contains(&law))
    };
    let bodies = bodies.into_iter().flatten().enumerate();
    bodies.filter(|(_, body)| elastic(body) == Some(true)).map(|(k, _)| k).collect()
}

/// The value below which nearly all are; above zero.
fn top(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.filter(|v| v.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let at = (SHOWN * sorted.len() as f64) as usize;
    sorted.get(at.min(sorted.len().saturating_sub(1))).copied().filter(|v| *v > 0.0).unwrap_or(1.0)
}

/// The frames that `flow.pvd` lists, with their times (s); none without it.
fn collection(run: &Run) -> Result<Option<Vec<(f64, String)>>, String> {
    let path = run.path.join("flow.pvd");
    if !path.exists() {
        return Ok(None);
    }
    let text = std::fs::read_to_string(&path).map_err(|error| format!("{} cannot be read: {error}", path.display()))?;
    let entry = |line: &str| Some((attribute(line, "timestep")?.parse().ok()?, attribute(line, "file")?.to_owned()));
    let lines = text.lines().filter(|line| line.contains("<DataSet "));
    let list: Option<Vec<_>> = lines.map(entry).collect();
    list.map(Some).ok_or_else(|| format!("{} is no collection of frames", path.display()))
}

/// The value of an XML attribute.
fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    tag.split(&format!(" {name}=\"")).nth(1)?.split('"').next()
}

type Packed = (Vec<Frame>, String, f64, String);

fn from_vtk(run: &Run, list: &[(f64, String)], solid: &[usize]) -> Result<Packed, String> {
    // Points may enter and leave.
    let counts = list.iter().map(|(_, name)| count(&run.path.join(name))).collect::<Result<Vec<_>, _>>()?;
    let points = counts.into_iter().max().unwrap_or(0);
    if points == 0 {
        return Err("no frame has a point".into());
    }
    let [every, kept] = thinning(points, list.len());
    let mut read = Vec::new();
    for (time, name) in (0..kept).map(|k| &list[k * (list.len() - 1) / (kept - 1).max(1)]) {
        let file = Vtp::read(&run.path.join(name))?;
        let [at, body, id] = [file.numbers("Points")?, file.numbers("body")?, file.numbers("id")?];
        let [speed, mean] = [file.numbers("speed_m_per_s")?, file.numbers("mean_stress_pa")?];
        let [strain, stress] = [file.numbers("plastic_shear_strain")?, file.numbers("stress_pa")?];
        let n = id.len();
        let whole = [at.len() == 3 * n, stress.len() == 6 * n, body.len() == n, speed.len() == n, mean.len() == n];
        if whole.contains(&false) || strain.len() != n {
            return Err(format!("{name}: its arrays are not of one length"));
        }
        let mut frame = Frame { time: *time, points: Vec::new() };
        for k in (0..n).filter(|k| (id[*k] as u64).is_multiple_of(every as u64)) {
            let body = body[k] as usize;
            let values = if solid.contains(&body) {
                let mises = von_mises(&stress[6 * k..6 * k + 6]);
                [speed[k], mises, mises]
            } else {
                [speed[k], -mean[k], strain[k]]
            };
            frame.points.push(Point { body, at: [at[3 * k], at[3 * k + 1]], values });
        }
        read.push(frame);
    }
    let mut said = Vec::new();
    if every > 1 {
        said.push(format!("one of {every} points"));
    }
    if kept < list.len() {
        said.push(format!("{kept} of {} frames", list.len()));
    }
    Ok((read, "flow.pvd and vtk/".into(), size(run)? * (every as f64).sqrt(), said.join(", ")))
}

/// The number of points of a frame, from its head.
fn count(path: &Path) -> Result<usize, String> {
    let mut head = [0; 2048];
    let read = std::fs::File::open(path).and_then(|mut file| file.read(&mut head));
    let read = read.map_err(|error| format!("{} cannot be read: {error}", path.display()))?;
    let text = String::from_utf8_lossy(&head[..read]);
    let count = attribute(&text, "NumberOfPoints").and_then(|text| text.parse().ok());
    count.ok_or(format!("{} is no frame of a run", path.display()))
}

/// Of how many points one is kept, and how many frames, so that all fit: points are left out down to [`POINTS`], then frames.
fn thinning(points: usize, frames: usize) -> [usize; 2] {
    let kept = (BUDGET / POINT_BYTES / frames.max(1)).max(POINTS);
    let every = points.div_ceil(kept).max(1);
    let fit = (BUDGET / POINT_BYTES / points.div_ceil(every).max(1)).max(1);
    [every, frames.min(fit)]
}

/// How wide a point is (m).
fn size(run: &Run) -> Result<f64, String> {
    let grid = run.summary.get("case").and_then(|case| case.get("grid"));
    let number = |key: &str| {
        let value = grid.and_then(|grid| grid.get(key))?;
        value.as_float().or_else(|| value.as_integer().map(|v| v as f64))
    };
    let spacing = number("spacing_m").ok_or("summary.toml: no case.grid.spacing_m")?;
    Ok(spacing / number("particles_per_cell").unwrap_or(4.0).sqrt())
}

/// The equivalent stress (Pa) of von Mises of xx, yy, zz, xy, yz, xz.
fn von_mises(s: &[f64]) -> f64 {
    let [xx, yy, zz, xy, yz, xz] = [s[0], s[1], s[2], s[3], s[4], s[5]];
    let normal = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
    (0.5 * normal + 3.0 * (xy * xy + yz * yz + xz * xz)).sqrt()
}

fn from_field(run: &Run) -> Result<Packed, String> {
    if !run.path.join("field.csv").exists() {
        return Err("the run has neither VTK frames nor field.csv (vtk_interval_s = 0, no field_times_s)".into());
    }
    let table = run.table("field.csv")?;
    let column = |name: &str| table.column(name).map_err(|error| error.to_string());
    let [time, x, y] = [column("time_s")?, column("x_m")?, column("y_m")?];
    let [speed, pressure, strain] = [column("speed_m_per_s")?, column("pressure_pa")?, column("plastic_shear_strain")?];
    let mut frames: Vec<Frame> = Vec::new();
    for k in 0..table.rows() {
        if frames.last().is_none_or(|frame| frame.time != time[k]) {
            frames.push(Frame { time: time[k], points: Vec::new() });
        }
        let point = Point { body: usize::MAX, at: [x[k], y[k]], values: [speed[k], pressure[k], strain[k]] };
        frames.last_mut().into_iter().for_each(|frame| frame.points.push(point));
    }
    if frames.is_empty() {
        return Err("field.csv has no row, and there are no VTK frames".into());
    }
    let cells: usize = frames.iter().map(|frame| frame.points.len()).sum();
    let every = (cells * POINT_BYTES).div_ceil(BUDGET).max(1);
    frames.iter_mut().for_each(|frame| frame.points = frame.points.iter().copied().step_by(every).collect());
    let said = if every > 1 { format!("one of {every} cells") } else { String::new() };
    let spacing = run.summary.get("case").and_then(|c| c.get("grid")).and_then(|g| g.get("spacing_m")?.as_float());
    Ok((frames, "field.csv".into(), spacing.ok_or("summary.toml: no case.grid.spacing_m")?, said))
}

/// The arrays of a VTK file as `checkdam run` writes them: appended, raw, doubles or integers of eight bytes.
struct Vtp {
    name: String,
    bytes: Vec<u8>,
    /// Where the first array begins.
    data: usize,
    /// Type and offset by name.
    arrays: BTreeMap<String, (bool, usize)>,
}

impl Vtp {
    fn read(path: &Path) -> Result<Self, String> {
        let name = path.display().to_string();
        let bytes = std::fs::read(path).map_err(|error| format!("{name} cannot be read: {error}"))?;
        let mark = b"<AppendedData encoding=\"raw\">";
        let at =
            bytes.windows(mark.len()).position(|part| part == mark).ok_or(format!("{name} is no frame of a run"))?;
        let head = String::from_utf8_lossy(&bytes[..at]).into_owned();
        let under = bytes[at..].iter().position(|byte| *byte == b'_').ok_or(format!("{name} has no data"))?;
        let mut arrays = BTreeMap::new();
        for tag in head.lines().filter(|line| line.contains("<DataArray ")) {
            let of = |key: &str| attribute(tag, key).ok_or(format!("{name}: {tag}"));
            let offset = of("offset")?.parse().map_err(|_| format!("{name}: {tag}"))?;
            arrays.insert(of("Name")?.to_owned(), (of("type")? == "Int64", offset));
        }
        Ok(Self { name, bytes, data: at + under + 1, arrays })
    }

    /// An array as numbers.
    fn numbers(&self, name: &str) -> Result<Vec<f64>, String> {
        let (integer, offset) = self.arrays.get(name).ok_or(format!("{} has no array `{name}`", self.name))?;
        let cut = || format!("{}: the array `{name}` is cut", self.name);
        let rest = self.bytes.get(self.data + offset..).ok_or_else(cut)?;
        let (length, rest) = rest.split_first_chunk::<8>().ok_or_else(cut)?;
        let data = rest.get(..u64::from_le_bytes(*length) as usize).ok_or_else(cut)?;
        let (words, _) = data.as_chunks::<8>();
        Ok(words
            .iter()
            .map(|w| if *integer { i64::from_le_bytes(*w) as f64 } else { f64::from_le_bytes(*w) })
            .collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use checkdam::output::{Field, Values, write_points};

    #[test]
    fn a_frame_is_read_as_it_was_written() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("flow.vtp");
        let fields = [
            Field { name: "speed_m_per_s", values: Values::Scalar(&|k| k as f64 + 0.5) },
            Field { name: "id", values: Values::Integer(&|k| 7 * k as i64) },
        ];
        write_points(&path, 0.25, 3, &|k| [k as f64, -1.0], &fields).expect("written");
        let file = Vtp::read(&path).expect("read");
        assert_eq!(file.numbers("TimeValue"), Ok(vec![0.25]));
        assert_eq!(file.numbers("Points").map(|p| p[3..6].to_vec()), Ok(vec![1.0, -1.0, 0.0]));
        assert_eq!(file.numbers("speed_m_per_s"), Ok(vec![0.5, 1.5, 2.5]));
        assert_eq!(file.numbers("id"), Ok(vec![0.0, 7.0, 14.0]));
        assert!(file.numbers("body").is_err());
        assert_eq!(count(&path), Ok(3));
    }

    #[test]
    fn the_equivalent_stress_of_tension_and_of_shear() {
        assert_eq!(von_mises(&[3.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 3.0);
        assert!((von_mises(&[0.0, 0.0, 0.0, 2.0, 0.0, 0.0]) - 2.0 * 3.0f64.sqrt()).abs() < 1e-15);
        assert_eq!(von_mises(&[5.0, 5.0, 5.0, 0.0, 0.0, 0.0]), 0.0);
    }

    #[test]
    fn whatever_a_run_has_fits() {
        // The flume: all of it.
        assert_eq!(thinning(4000, 81), [1, 81]);
        for points in [0, 1, 100, 4000, 4001, 30_000, 1_000_000] {
            for frames in [1, 10, 81, 500, 100_000] {
                let [every, kept] = thinning(points, frames);
                let bytes = points.div_ceil(every) * kept * POINT_BYTES;
                assert!(bytes <= BUDGET, "{points} points, {frames} frames: {bytes} bytes");
                assert!(kept > 0 && kept <= frames, "{points} points, {frames} frames: {kept} kept");
                assert!(every == 1 || points > POINTS, "{points} points, {frames} frames: one of {every}");
            }
        }
    }

    #[test]
    fn colours_span_nearly_all() {
        assert_eq!(top((0..1000).map(f64::from)), 998.0);
        assert_eq!(top(std::iter::empty()), 1.0);
        assert_eq!(top([0.0, 0.0].into_iter()), 1.0);
    }
}
