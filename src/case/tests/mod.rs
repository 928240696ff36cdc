//! Every kind of mistake must be reported with its line and a way out; correct files must load without a warning.

use super::suggest::{edit_distance, nearest};
use super::*;
use crate::boundary::{Friction, Opening};
use crate::scaffold::FLUME;
use crate::shape::ShapeFunction;
use crate::simulation::{PicShare, Scheme};

mod bad_input;
mod contacts;
mod doubts;
mod fixes;
mod gauges;
mod inflows;
mod materials;
mod shapes;

fn line_of(text: &str, marker: &str) -> usize {
    let position = text.find(marker).unwrap_or_else(|| panic!("no {marker:?} in the text"));
    text[..position].matches('\n').count() + 1
}

fn changed(replace: &str, by: &str) -> String {
    assert!(FLUME.contains(replace), "the flume has no {replace:?}");
    FLUME.replacen(replace, by, 1)
}

fn report_of(text: &str) -> String {
    parse(text, "some/case.toml").expect_err("accepted").to_string()
}

#[test]
fn a_case_loads_without_warnings() {
    let loaded = parse(FLUME, "flume.toml").unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(loaded.warnings, Vec::<String>::new());
    assert_eq!(loaded.case.bodies[0].particle_spacing_m(&loaded.case.grid), 0.005);
    assert_eq!(loaded.case.particle_count_estimate(), 4000.0);
}

#[test]
fn written_and_read_again_a_case_is_the_same() {
    let case = parse(FLUME, "flume.toml").unwrap().case;
    let text = case.to_toml().unwrap();
    assert_eq!(parse(&text, "again.toml").unwrap(), LoadedCase { case, warnings: Vec::new() });
}

#[test]
fn defaults_are_filled_in_and_shown() {
    let text = r#"
        title = "a block"
        gravity = { inclination_deg = 10 }
        grid = { spacing_m = 0.1, thickness_m = 1 }
        domain = { x_m = [0, 2], y_m = [0, 1] }
        materials.rock = { law = "linear_elastic", density_kg_per_m3 = 2000, young_pa = 1e8, poisson = 0.2 }
        bodies = [{ name = "block", material = "rock", x_m = [0, 1], y_m = [0, 0.5] }]
        boundaries = [{ name = "stop", kind = "gate", foot_m = [1, 0], height_m = 1, contact = "rough" }]
        stages.run = { end_time_s = 1 }
    "#;
    let case = parse(text, "block.toml").unwrap_or_else(|error| panic!("{error}")).case;
    assert_eq!(
        case.gravity,
        Gravity { magnitude_m_per_s2: 9.81, inclination_deg: 10.0, settle_inclination_deg: Some(10.0) }
    );
    assert_eq!((case.grid.shape_function, case.grid.particles_per_cell), (ShapeFunction::Ugimp, 4));
    assert_eq!((case.numerics.scheme, case.numerics.cfl), (Scheme::Musl, 0.3));
    assert_eq!(case.numerics.pic(), PicShare::Fraction(5.0e-4));
    assert_eq!(case.output.vtk_interval_s, 0.02);
    assert_eq!(case.gauges, Gauges::default());
    assert!(case.stages.run.stop_at_rest);
    let wall = Wall {
        foot_m: [1.0, 0.0],
        height_m: 1.0,
        inclination_deg: 90.0,
        material_side: MaterialSide::Left,
        thickness_m: 0.4,
    };
    assert_eq!(case.boundaries[0].shape(&case.grid), Some(Shape::Gate(wall, Opening::Vanish)));
    assert_eq!(case.boundaries[0].contact_law(), Some(Friction::Rough));
    assert_eq!(wall.normal(), [-1.0, 0.0]);
    assert_eq!(wall.corners_m(), [[1.0, 0.0], [1.0, 1.0], [1.4, 1.0], [1.4, 0.0]]);
    let wave_speed = (1.0e8_f64 * 0.8 / (1.2 * 0.6) / 2000.0).sqrt();
    approx::assert_relative_eq!(case.time_step_estimate_s(), 0.3 * 0.1 / wave_speed);
    assert!(case.to_toml().unwrap().contains("pic_fraction = 0.0005"));
}

#[test]
fn the_report_has_the_form_of_a_compiler_error() {
    let text = "title = 1.0e400\n";
    let expected = "\
error: title = 1.0e400 is too large
 --> a.toml:1:9
  |
1 | title = 1.0e400
  |         ^^^^^^^
  = allowed: a number
  = fix: write a number that fits: below 1e308
";
    assert_eq!(parse(text, "a.toml").unwrap_err().to_string(), expected);

    let report = report_of(&changed("poisson = 0.3", "poisson = 0.5"));
    let line = line_of(FLUME, "poisson = 0.3");
    assert!(report.starts_with(&format!(
        "error: materials.sand.poisson = 0.5 is not allowed\n  --> some/case.toml:{line}:11\n   |\n{line} | poisson = 0.5"
    )));
    assert!(report.contains("\n   |           ^^^\n   = allowed: -1 < poisson < 0.5 (0.5 is incompressible"));
    assert!(report.ends_with("\n   = fix: use a value such as 0.49\n"));
}

#[test]
fn all_problems_are_reported_in_the_order_of_the_file() {
    let text = changed("poisson = 0.3", "poisson = 0.7").replacen("cfl = 0.3", "cfl = 0", 1).replacen(
        "spacing_m = 0.01",
        "spacing_m = -1",
        1,
    );
    let Err(CaseError::Invalid { report, problems }) = parse(&text, "a.toml") else { panic!("accepted") };
    assert_eq!(problems.len(), 3);
    let position = |text: &str| report.find(text).unwrap_or_else(|| panic!("no {text} in\n{report}"));
    assert!(position("spacing_m = -1 ") < position("poisson = 0.7 "));
    assert!(position("poisson = 0.7 ") < position("cfl = 0 "));
    assert!(report.ends_with("error: 3 problems in a.toml\n"));

    let two = changed("poisson = 0.3", "poison = 0.3").replacen("cfl = 0.3", "clf = 0.3", 1);
    let report = report_of(&two);
    assert!(report.contains("`poisson`") && report.contains("`cfl`"), "{report}");
}

#[test]
fn implausible_values_are_warnings() {
    for (replace, by, fix) in [
        ("young_pa = 1.0e6", "young_pa = 1", "if the value is in MPa, write 1000000"),
        ("friction_angle_deg = 31", "friction_angle_deg = 0.54", "in radians, write 30.9"),
        ("inclination_deg = 40", "inclination_deg = 0.7", "in radians, write 40.1"),
        ("friction = 0.4", "friction = 21.8", "write its tangent, 0.39997"),
        ("settle_inclination_deg = 0", "", "leave [stages.tilt] out"),
        ("foot_m = [1.2, 0.0]", "foot_m = [12, 0.0]", "move the wall, or enlarge the domain"),
        ("tension_cutoff_pa = 0", "tension_cutoff_pa = 10", "apex"),
        ("inclination_deg = 90", "inclination_deg = 1.5", "in radians"),
    ] {
        let text = changed(replace, by);
        let text =
            if by.contains("1.5") { text.replacen("foot_m = [-0.2, 0.0]", "foot_m = [0.5, 1.2]", 1) } else { text };
        let warnings = parse(&text, "some/case.toml").unwrap_or_else(|error| panic!("{error}")).warnings;
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        let at = if by.is_empty() { "duration_s" } else { by };
        let line = format!("--> some/case.toml:{}:", line_of(&text, at));
        assert!(warnings[0].starts_with("warning: ") && warnings[0].contains(&line), "{}", warnings[0]);
        assert!(warnings[0].contains(fix), "{}", warnings[0]);
    }
    let light = changed("_m3 = 1500", "_m3 = 1.5").replacen("mass_kg = 30", "", 1);
    assert!(parse(&light, "a").unwrap().warnings[0].contains("write 1500"));
}

/// The flume's gate is filled to its brim: on a grid line that holds, between two of them it does not.
#[test]
fn a_fill_up_to_a_crest_between_grid_lines_is_a_warning() {
    let of = |text: &str| {
        let on_surface = text.replacen("boundary_contact = \"nodes\"", "boundary_contact = \"surface\"", 1);
        let warnings = [on_surface.as_str(), text]
            .map(|t| parse(t, "some/case.toml").unwrap_or_else(|error| panic!("{error}")).warnings);
        assert_eq!(warnings[0], warnings[1], "wherever boundaries act");
        warnings[1].clone()
    };
    let gate = |height: &str, cell: &str| {
        let gate = "height_m = 0.5\n";
        let thick = changed(gate, &format!("height_m = {height}\n")).replace("thickness_m = 0.1", "thickness_m = 0.2");
        thick.replacen("spacing_m = 0.01", &format!("spacing_m = {cell}"), 1)
    };
    // 0.5 m is 37.5 cells of 13.33 mm, 12.5 of 40 mm; 0.52 m is within a cell of the fill, 0.54 m is not.
    for (height, cell, fix) in [
        ("0.5", "0.0133333", Some("height_m = 0.514")),
        ("0.5", "0.04", Some("height_m = 0.54")),
        ("0.53", "0.04", Some("height_m = 0.54")),
        ("0.48", "0.01", None),
        ("0.5", "0.02", None),
        ("0.54", "0.04", None),
        ("0.6", "0.0133333", None),
    ] {
        let text = gate(height, cell);
        let warnings = of(&text);
        let Some(fix) = fix else {
            assert_eq!(warnings, Vec::<String>::new(), "{height} {cell}");
            continue;
        };
        let [warning] = &warnings[..] else { panic!("{warnings:?}") };
        let line = format!("--> some/case.toml:{}:", line_of(&text, &format!("height_m = {height}\n")));
        let words = ["warning: boundaries[2].height_m", "`sand` reaches up to 0.5 m", &line, "raise the gate", fix];
        assert!(words.iter().all(|w| warning.contains(w)), "{warning}");
    }
    // A moved grid; another body's gate; a fill that stands away from it.
    let moved = changed("thickness_m = 0.2", "origin_m = [0.0, 0.004]\nthickness_m = 0.2");
    assert_eq!(of(&moved).len(), 1);
    let away = moved.replacen("foot_m = [0.0, 0.0]", "foot_m = [0.1, 0.0]", 1);
    assert_eq!(of(&away).len(), 0);
}

#[test]
fn a_wall_that_its_contact_cannot_hold_is_refused() {
    let thin = |thickness: &str, contact: &str| {
        let text = changed(
            "thickness_m = 0.1\ncontact = \"coulomb\"",
            &format!("thickness_m = {thickness}\ncontact = \"coulomb\""),
        );
        text.replacen("boundary_contact = \"nodes\"", &format!("boundary_contact = \"{contact}\""), 1)
    };
    for thickness in ["0", "0.008", "0.029"] {
        let text = thin(thickness, "nodes");
        let report = report_of(&text);
        let line = format!("--> some/case.toml:{}:", line_of(&text, &format!("thickness_m = {thickness}\n")));
        for part in [line.as_str(), "boundaries[3].thickness_m", "0.03 m or more, three cells", "\"surface\""] {
            assert!(report.contains(part), "no {part:?} in\n{report}");
        }
        assert!(parse(&thin(thickness, "surface"), "a").is_ok());
    }
    assert!(parse(&thin("0.03", "nodes"), "a").is_ok());
    assert!(report_of(&thin("-0.01", "surface")).contains("thickness_m >= 0"));
    let low = changed("height_m = 0.6\nthickness_m", "height_m = 0.009 # low\nthickness_m");
    assert!(report_of(&low).contains("one cell: the flow does not see a lower wall"), "{}", report_of(&low));
}

#[test]
fn an_opening_of_few_cells_is_a_warning() {
    let of = |text: &str| parse(text, "some/case.toml").unwrap_or_else(|error| panic!("{error}")).warnings;
    for (foot, open) in [("[1.2, 0.03]", Some("0.03 m open below `barrier`: 3 cells")), ("[1.2, 0.13]", None)] {
        let warnings = of(&changed("foot_m = [1.2, 0.0]", &format!("foot_m = {foot}")));
        assert_eq!(warnings.len(), usize::from(open.is_some()), "{warnings:?}");
        assert!(
            warnings.iter().all(|w| w.contains(open.unwrap_or_default()) && w.contains("boundaries[3].foot_m")),
            "{warnings:?}"
        );
    }
    let raised = of(&changed("opening = \"vanish\"", "opening = \"raise\"\nopening_m = 0.04"));
    assert!(raised.len() == 1 && raised[0].contains("0.04 m open below gate `gate`: 4 cells"), "{raised:?}");
    assert!(of(&changed("opening = \"vanish\"", "opening = \"raise\"\nopening_m = 0.12")).is_empty());
}

#[test]
fn files_that_are_no_case_files() {
    let directory = tempfile::tempdir().unwrap();
    let image = directory.path().join("plot.png");
    std::fs::write(&image, b"\x89PNG\r\n\x1a\n").unwrap();
    let large = directory.path().join("large.toml");
    std::fs::write(&large, vec![b'#'; 5 << 20]).unwrap();
    for (path, expected) in [
        (directory.path().join("none.toml"), "does not exist"),
        (directory.path().to_owned(), "is a directory"),
        (image, "is not text in UTF-8: byte 0"),
        (large, "longer than 4 MiB"),
    ] {
        let report = load(&path).expect_err("loaded").to_string();
        for part in [expected, path.to_str().unwrap(), "= fix: ", ".toml"] {
            assert!(report.contains(part), "no {part:?} in\n{report}");
        }
    }
}

#[test]
fn no_prefix_of_a_case_panics() {
    for end in (0..FLUME.len()).filter(|end| FLUME.is_char_boundary(*end)).step_by(7) {
        let _ = parse(&FLUME[..end], "part.toml").map_err(|error| error.to_string());
    }
    for odd in [
        "é = ",
        "\"é\" = 1",
        "\u{feff}title = 1",
        "a.b.c = 1",
        "\0",
        "[[",
        "x = [1,",
        "=",
        "bodies = []",
        "[materials.\"\"]",
    ] {
        assert!(!report_of(odd).is_empty());
    }
}

#[test]
fn nearest_names() {
    assert_eq!(edit_distance("kitten", "sitting"), 3);
    assert_eq!(nearest("frction", ["cohesion", "friction"]), Some("friction"));
    assert_eq!(nearest("height", ["height_m", "weight"]), Some("height_m"));
    assert_eq!(nearest("velocity", ["x_m", "y_m"]), None);
}
