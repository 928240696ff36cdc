use std::collections::BTreeMap;

use super::*;

/// Arrays of a file by name, decoded from the header's offsets and the lengths in front of the bytes.
fn arrays(path: &Path) -> BTreeMap<String, (usize, Vec<[u8; 8]>)> {
    let bytes = std::fs::read(path).unwrap();
    let marker = b"<AppendedData encoding=\"raw\">\n_";
    let start = bytes.windows(marker.len()).position(|window| window == marker).unwrap() + marker.len();
    let header = std::str::from_utf8(&bytes[..start]).unwrap();
    let attribute = |line: &str, name: &str| -> String {
        let from = line.find(&format!(" {name}=\"")).unwrap() + name.len() + 3;
        line[from..].split('"').next().unwrap().to_owned()
    };
    let mut end = 0;
    let mut found = BTreeMap::new();
    for (k, line) in header.lines().filter(|line| line.contains("<DataArray")).enumerate() {
        let offset: usize = attribute(line, "offset").parse().unwrap();
        assert_eq!(offset, end, "arrays follow each other without a gap");
        let at = start + offset;
        let length = u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
        let data = &bytes[at + 8..at + 8 + length];
        end = offset + 8 + length;
        let values = data.chunks(8).map(|chunk| chunk.try_into().unwrap()).collect();
        let components = attribute(line, "NumberOfComponents").parse().unwrap();
        found.insert(format!("{k}:{}", attribute(line, "Name")), (components, values));
    }
    assert_eq!(&bytes[start + end..], b"\n  </AppendedData>\n</VTKFile>\n");
    found
}

fn floats(array: &(usize, Vec<[u8; 8]>)) -> Vec<f64> {
    array.1.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect()
}

fn integers(array: &(usize, Vec<[u8; 8]>)) -> Vec<i64> {
    array.1.iter().map(|bytes| i64::from_le_bytes(*bytes)).collect()
}

#[test]
fn points_and_fields_are_where_the_header_says() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("points.vtp");
    let fields = [
        Field { name: "material", values: Values::Integer(&|k| k as i64 - 1) },
        Field { name: "mass_kg", values: Values::Scalar(&|k| 1.0 / (k as f64 + 3.0)) },
        Field { name: "velocity_m_per_s", values: Values::Vector(&|k| [k as f64, -0.1]) },
        Field { name: "stress_pa", values: Values::SymmetricTensor(&|k| [1.0, 2.0, 3.0, 4.0, 0.0, k as f64]) },
    ];
    write_points(&path, 0.1, 3, &|k| [0.1 * k as f64, 0.7], &fields).unwrap();
    let arrays = arrays(&path);
    assert_eq!(floats(&arrays["0:TimeValue"]), [0.1]);
    assert_eq!(floats(&arrays["1:Points"]), [0.0, 0.7, 0.0, 0.1, 0.7, 0.0, 0.2, 0.7, 0.0]);
    assert_eq!(integers(&arrays["2:connectivity"]), [0, 1, 2]);
    assert_eq!(integers(&arrays["3:offsets"]), [1, 2, 3]);
    assert_eq!(integers(&arrays["4:material"]), [-1, 0, 1]);
    assert_eq!(floats(&arrays["5:mass_kg"])[1].to_bits(), 0.25f64.to_bits());
    assert_eq!(arrays["6:velocity_m_per_s"].0, 3);
    assert_eq!(floats(&arrays["6:velocity_m_per_s"])[3..6], [1.0, -0.1, 0.0]);
    assert_eq!(arrays["7:stress_pa"].0, 6);
    assert_eq!(floats(&arrays["7:stress_pa"])[12..], [1.0, 2.0, 3.0, 4.0, 0.0, 2.0]);
    assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 1, "no temporary file stays");
}

#[test]
fn no_points_make_a_valid_file() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("empty.vtp");
    write_points(&path, 0.0, 0, &|_| [0.0; 2], &[]).unwrap();
    assert!(floats(&arrays(&path)["1:Points"]).is_empty());
}

#[test]
fn open_outlines_come_before_closed_ones() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("boundaries.vtp");
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let line = [[-1.0, 0.0], [2.0, 0.0]];
    let outlines = [
        Polyline { boundary: 7, points_m: &square, closed: true },
        Polyline { boundary: 3, points_m: &line, closed: false },
    ];
    write_polylines(&path, &outlines).unwrap();
    let arrays = arrays(&path);
    assert_eq!(floats(&arrays["0:Points"]).len(), 18);
    assert_eq!(integers(&arrays["1:connectivity"]), [0, 1]);
    assert_eq!(integers(&arrays["2:offsets"]), [2]);
    assert_eq!(integers(&arrays["3:connectivity"]), [2, 3, 4, 5]);
    assert_eq!(integers(&arrays["4:offsets"]), [4]);
    assert_eq!(integers(&arrays["5:boundary"]), [3, 7]);
}

#[test]
fn a_repeated_field_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let field = Field { name: "mass_kg", values: Values::Scalar(&|_| 0.0) };
    let error = write_points(directory.path().join("p.vtp"), 0.0, 1, &|_| [0.0; 2], &[field, field]).unwrap_err();
    assert!(matches!(error, OutputError::Name { .. }));
}
