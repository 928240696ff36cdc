use super::*;

fn number(value: f64) -> String {
    let mut text = Vec::new();
    push_number(&mut text, value, DIGITS);
    String::from_utf8(text).unwrap()
}

#[test]
fn numbers_are_rounded_short_and_plain() {
    let cases = [
        (0.0, "0"),
        (-0.0, "0"),
        (350.0, "350"),
        (-2.5, "-2.5"),
        (0.1 + 0.2, "0.3"),
        (1.0 / 3.0, "0.333333333"),
        (2.0 / 3.0 * 1e-3, "0.000666666667"),
        (1e-5, "0.00001"),
        (9.999_999_999_9e-6, "0.00001"),
        (2.5e-9, "2.5e-9"),
        (123_456_789_012.0, "123456789000"),
        (1e15, "1e15"),
        (-1.234e22, "-1.234e22"),
        (f64::NAN, ""),
        (f64::INFINITY, "inf"),
        (f64::NEG_INFINITY, "-inf"),
        (f64::MIN_POSITIVE, "2.22507386e-308"),
    ];
    for (value, text) in cases {
        assert_eq!(number(value), text);
    }
}

#[test]
fn the_plain_form_is_that_of_the_rounded_number() {
    // Digits moved about by hand against the standard library's shortest form of the number rounded.
    let mut state = 7u64;
    for k in 0..20_000 {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let share = (state >> 11) as f64 / (1u64 << 53) as f64;
        let power = 10f64.powi(k % 22 - 6);
        let value = if k % 3 == 0 { (share * 1000.0).round() * power } else { share * power };
        let value = if k % 2 == 0 { -value } else { value };
        for digits in [1, 2, 6, 9, 12, 13, 15] {
            let rounded: f64 = format!("{value:.*e}", digits - 1).parse().unwrap();
            if !(1e-5..1e15).contains(&rounded.abs()) {
                continue;
            }
            let mut text = b"x".to_vec();
            push_number(&mut text, value, digits);
            assert_eq!(String::from_utf8(text).unwrap(), format!("x{rounded}"), "{value:e} with {digits} digits");
        }
    }
}

#[test]
fn seventeen_digits_keep_every_bit() {
    for value in [0.1, 1.0 / 3.0, 6.022e23, f64::MAX, f64::MIN_POSITIVE, 5e-324] {
        let mut text = Vec::new();
        push_number(&mut text, value, 17);
        assert_eq!(String::from_utf8(text).unwrap().parse::<f64>().unwrap().to_bits(), value.to_bits());
    }
}

#[test]
fn places_far_from_the_origin_are_written_to_a_micrometre() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("places.csv");
    let northing = 5_234_567.123_456_7;
    let mut writer = TableWriter::create(&path, &["x_m", "front_x_m", "y_m", "max_m"]).unwrap();
    writer.row(&[northing, -northing, 1.0 / 3.0, northing]).unwrap();
    writer.finish().unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert_eq!(text.lines().nth(1), Some("5234567.123457,-5234567.123457,0.333333333,5234567.12"));
}

#[test]
fn what_is_written_is_read_back() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("history.csv");
    let mut writer = TableWriter::create(&path, &["time_s", "force_normal_n"]).unwrap();
    for k in 0..5000 {
        let time = f64::from(k) * 1e-3;
        writer.row(&[time, if k == 7 { f64::NAN } else { 100.0 * time }]).unwrap();
    }
    assert_eq!(writer.finish().unwrap(), 5000);
    let table = Table::load(&path).unwrap();
    assert_eq!(table.names(), ["time_s", "force_normal_n"]);
    assert_eq!(table.rows(), 5000);
    let (time, force) = (table.column("time_s").unwrap(), table.column("force_normal_n").unwrap());
    assert!((time[4321] - 4.321).abs() < 1e-12);
    assert!(force[7].is_nan());
    assert!((force[8] - 0.8).abs() < 1e-9);
}

#[test]
fn a_lone_empty_cell_is_still_a_row() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("one.csv");
    let mut writer = TableWriter::create(&path, &["depth_m"]).unwrap();
    for value in [1.0, f64::NAN, 2.0] {
        writer.row(&[value]).unwrap();
    }
    writer.finish().unwrap();
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "depth_m\n1\n\"\"\n2\n");
    assert!(Table::load(&path).unwrap().column("depth_m").unwrap()[1].is_nan());
}

#[test]
fn rows_are_in_the_file_after_a_flush_or_an_early_end() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("history.csv");
    let mut writer = TableWriter::create(&path, &["time_s"]).unwrap();
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "time_s\n");
    writer.row(&[1.23]).unwrap();
    writer.flush().unwrap();
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "time_s\n1.23\n");
    writer.row(&[2.0]).unwrap();
    drop(writer);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "time_s\n1.23\n2\n");
}

#[test]
fn names_and_rows_that_do_not_fit_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("t.csv");
    for columns in [&["a,b"][..], &["a", "a"], &[""], &[" a"], &[]] {
        assert!(matches!(TableWriter::create(&path, columns), Err(OutputError::Name { .. })));
    }
    let mut writer = TableWriter::create(&path, &["a", "b"]).unwrap();
    assert!(matches!(writer.row(&[1.0]), Err(OutputError::RowLength { expected: 2, found: 1, .. })));
}

#[test]
fn reading_errors_name_file_column_and_line() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("t.csv");
    std::fs::write(&path, "time_s,note\n1,good\n2,bad\n").unwrap();
    let table = Table::load(&path).unwrap();
    assert_eq!(table.column("time_s").unwrap(), [1.0, 2.0]);
    let message = table.column("note").unwrap_err().to_string();
    assert!(message.ends_with("t.csv, line 2, column \"note\": \"good\" is not a number"), "{message}");
    let message = table.column("force_n").unwrap_err().to_string();
    assert!(message.ends_with("t.csv has no column \"force_n\"; it has: time_s, note"), "{message}");
    std::fs::write(&path, "a,b\n1,2\n3\n").unwrap();
    let message = Table::load(&path).unwrap_err().to_string();
    assert!(message.contains("t.csv, line 3: 1 cells under a header of 2"), "{message}");
    let message = Table::load(directory.path().join("none.csv")).unwrap_err().to_string();
    assert!(message.contains("cannot read") && message.contains("none.csv"), "{message}");
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_reported_with_the_rows_that_are_safe() {
    // This device accepts an open and refuses every write.
    let error = TableWriter::create("/dev/full", &["time_s"]).unwrap_err();
    let message = error.to_string();
    assert!(matches!(error, OutputError::Append { rows: 0, .. }), "{message}");
    assert!(message.contains("0 complete rows") && message.contains("the disk is full"), "{message}");
}
