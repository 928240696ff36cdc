use super::quantities::QUANTITIES;
use super::*;

/// A block of rubber that falls on a floor.
pub(super) const CASE: &str = r#"
title = "drop"
[gravity]
inclination_deg = 0
[grid]
spacing_m = 0.05
thickness_m = 0.1
[domain]
x_m = [-0.5, 0.5]
y_m = [-0.2, 0.6]
[materials.rubber]
law = "linear_elastic"
density_kg_per_m3 = 1000
young_pa = 1.0e5
poisson = 0.2
[[bodies]]
name = "block"
material = "rubber"
x_m = [-0.1, 0.1]
y_m = [0.0, 0.2]
[[boundaries]]
name = "floor"
kind = "plane"
point_m = [0.0, 0.0]
normal_deg = 90
contact = "smooth"
[stages.run]
end_time_s = 0.3
[gauges]
barrier = "floor"
"#;

pub(super) const STUDY: &str = r#"
title = "stiffness and friction of the floor"
cases = ["drop.toml"]
[base.set]
"numerics.cfl" = 0.2
[[axis]]
name = "young_pa"
fields = ["materials.rubber.young_pa"]
values = [1.0e5, 2.0e5]
[[variant]]
factor = "floor"
label = "rough"
set = { "boundaries.floor.contact" = "rough" }
"#;

pub(super) fn planned(study: &str) -> Result<(Study, Vec<PlannedRun>), StudyError> {
    let study = Study::parse(study, "study.toml")?;
    let runs = plan(&study, "study.toml", &|_| Ok(CASE.to_string()))?;
    Ok((study, runs))
}

#[test]
fn every_run_is_planned_with_its_change() {
    let (study, runs) = planned(STUDY).expect("a study");
    let told: Vec<&str> = runs.iter().map(|r| r.what.as_str()).collect();
    assert_eq!(
        told,
        ["drop, base", "drop, floor, rough", "drop, axis, young_pa 100000", "drop, axis, young_pa 200000"]
    );
    assert_eq!(study.columns(), ["young_pa"]);
    let young: Vec<f64> = runs.iter().map(|r| r.case.materials["rubber"].young_pa).collect();
    assert_eq!(young, [1e5, 1e5, 1e5, 2e5]);
    assert!(runs.iter().all(|r| r.case.numerics.cfl == 0.2));
    // The first value of the axis is the base.
    assert!(runs[0].key == runs[2].key && runs[0].key != runs[1].key && runs[2].key != runs[3].key);
}

#[test]
fn a_level_stands_for_several_changes() {
    let levels = "[[axis]]\nname = \"stiffness_1\"\n[[axis.level]]\nvalue = 1e-6\nset = { \"materials.rubber.young_pa\" = 2e5 }\n\
                  [[axis.level]]\nvalue = 2\nset = { \"materials.rubber.young_pa\" = 4e5, \"numerics.cfl\" = 0.1 }\n";
    let text = format!("title = \"levels\"\ncases = [\"drop.toml\"]\n{levels}");
    let (_, runs) = planned(&text).expect("a study");
    let seen: Vec<_> =
        runs.iter().map(|r| (r.values[0].as_str(), r.case.materials["rubber"].young_pa, r.case.numerics.cfl)).collect();
    assert_eq!(seen, [("1e-6", 2e5, 0.3), ("2", 4e5, 0.1)]);
}

#[test]
fn quantities_that_no_run_has_are_left_out_of_the_table() {
    let (study, runs) = planned(STUDY).expect("a study");
    let mut table = Runs::new(&study.columns());
    let mut numbers = vec![f64::NAN; QUANTITIES.len()];
    (numbers[2], numbers[5]) = (1.5, -2.0);
    table.insert(&runs[0], Row::new("at rest", true, &numbers));
    let text = table.csv(&runs);
    let header = format!("key,ended,trusted,{},{}", QUANTITIES[2].name, QUANTITIES[5].name);
    assert!(text.lines().next().is_some_and(|l| l.ends_with(&header)), "{text}");
}

#[test]
fn replicates_move_grid_and_particles() {
    let text =
        format!("{STUDY}\n[replicates]\ncount = 2\ngrid_offset_cells = 0.5\njitter = 0.2\nbodies = [\"block\"]\n");
    let (_, runs) = planned(&text).expect("a study");
    assert_eq!(runs.len(), 12);
    assert_eq!(runs[0].case.grid.origin_m, [0.0; 2]);
    // Halton's first point is (1/2, 1/3): no offset along x, a third of half a cell back along y.
    let [x, y] = runs[1].case.grid.origin_m;
    assert!(x.abs() < 1e-15 && (y + 0.05 * 0.5 / 3.0).abs() < 1e-12, "{x} {y}");
    assert_eq!((runs[2].case.bodies[0].jitter, runs[2].case.bodies[0].jitter_seed), (0.2, 2));
    let scene = crate::run::scene::build(&runs[2].case);
    let plain = crate::run::scene::build(&runs[0].case);
    let moved: Vec<f64> =
        scene.bodies[0].1.iter().zip(&plain.bodies[0].1).map(|(a, b)| (a.x[0] - b.x[0]) / 0.025).collect();
    let most = moved.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    assert!(most > 0.15 && most <= 0.2, "{most}");
    let mean = moved.iter().sum::<f64>() / moved.len() as f64;
    assert!(mean.abs() < 0.05, "{mean}");
}

#[test]
fn replicates_move_a_grid_whose_spacing_is_a_whole_number() {
    let study = "title = \"large\"\ncases = [\"drop.toml\"]\n[replicates]\ncount = 1\ngrid_offset_cells = 0.5\n";
    let study = Study::parse(study, "study.toml").expect("a study");
    let origins = ["1", "1.0"].map(|spacing| {
        let large = [
            ("spacing_m = 0.05", format!("spacing_m = {spacing}")),
            ("[-0.5, 0.5]", "[-10, 10]".into()),
            ("[-0.2, 0.6]", "[-4, 12]".into()),
            ("[-0.1, 0.1]", "[-2, 2]".into()),
            ("[0.0, 0.2]", "[0, 4]".into()),
        ];
        let case = large.iter().fold(CASE.to_string(), |text, (from, to)| text.replacen(from, to, 1));
        let runs = plan(&study, "study.toml", &|_| Ok(case.clone())).unwrap_or_else(|e| panic!("{e}"));
        runs[1].case.grid.origin_m
    });
    assert!((origins[0][1] + 0.5 / 3.0).abs() < 1e-12 && origins[0] == origins[1], "{origins:?}");
}

#[test]
fn a_sample_fills_its_ranges() {
    let text = r#"
title = "sample"
cases = ["drop.toml"]
[sample]
points = 3
[[sample.range]]
name = "young_pa"
fields = ["materials.rubber.young_pa"]
low = 1e4
high = 1e6
logarithmic = true
[[sample.choice]]
name = "floor"
option = [{ label = "smooth" }, { label = "rough", set = { "boundaries.floor.contact" = "rough" } }]
"#;
    let (_, runs) = planned(text).expect("a study");
    let values: Vec<&[String]> = runs.iter().map(|r| &r.values[..]).collect();
    assert_eq!(values, [["100000", "smooth"], ["31620", "rough"], ["316200", "smooth"]]);
}

#[test]
fn what_is_wrong_is_named() {
    for (from, to, words) in [
        ("materials.rubber", "materials.rubbr", "materials.rubbr"),
        (
            "boundaries.floor.contact",
            "boundaries.flor.contact",
            "no element of boundaries is named `flor`; there are floor",
        ),
        ("contact\" = \"rough\"", "contact\" = \"rouhg\"", "did you mean `rough`?"),
        ("cases = [\"drop.toml\"]", "cases = []", "it has no case"),
        ("values = [1.0e5, 2.0e5]", "values = []", "axis `young_pa`"),
        ("values = [1.0e5, 2.0e5]", "values = [-1.0e5]", "young_pa = -100000.0 is not allowed"),
        ("factor =", "fctor =", "fctor"),
        ("title = ", "titel = ", "titel"),
        ("[base.set]", "[figure]\nx = \"young_p\"\ny = \"run_up_m\"\n[base.set]", "did you mean `young_pa`?"),
        ("[base.set]", "[figure]\nx = \"young_pa\"\ny = \"peak_20ms\"\n[base.set]", "did you mean `peak_20ms_n`?"),
    ] {
        let text = STUDY.replacen(from, to, 1);
        let Err(error) = planned(&text) else { panic!("{to} is accepted") };
        let error = error.to_string();
        assert!(error.contains(words), "{to}: {error}");
    }
}

/// Refusals of studies have the form of those of cases.
#[test]
fn a_study_that_cannot_be_is_refused_with_its_line_and_a_fix() {
    for (from, to, parts) in [
        (
            "title = \"stiff",
            "titel = \"stiff",
            vec!["titel is not a key of a study file", "did you mean `title`?", "study.toml:2:"],
        ),
        ("cases = [\"drop.toml\"]", "cases = []", vec!["it has no case", "study.toml:3:"]),
        ("[[axis]]", "[axis]", vec!["axis is not a list of tables", "write [[axis]]"]),
        ("values = [1.0e5, 2.0e5]", "values = 1.0e5", vec!["a list", "study.toml:9:"]),
        ("values = [1.0e5, 2.0e5]", "", vec!["axis `young_pa` has no value or no field"]),
        (
            "[[variant]]",
            "[replicates]\ncount = 9000000000000000000\n[[variant]]",
            vec!["3.6e19 runs", "replicates.count", "at most 1e5 runs"],
        ),
        ("[[variant]]", "[replicates]\ncount = -1\n[[variant]]", vec!["count = -1", "a whole number, not negative"]),
        (
            "[[variant]]",
            "[replicates]\ncount = 1\njitter = 0.7\n[[variant]]",
            vec!["replicates.jitter = 0.7", "0 to 0.5"],
        ),
        (
            "[[variant]]",
            "[figure]\nx = \"young\"\ny = \"end_s\"\n[[variant]]",
            vec!["figure.x = \"young\"", "did you mean `young_pa`?"],
        ),
        (
            "[[variant]]",
            "[sample]\npoints = 1000000\n[[sample.range]]\nname = \"a\"\nfields = [\"numerics.cfl\"]\nlow = 0.1\nhigh = 0.2\n[[variant]]",
            vec!["1.0e6 runs"],
        ),
        (
            "[[variant]]",
            "[sample]\npoints = 4\n[[sample.range]]\nname = \"a\"\nfields = [\"numerics.cfl\"]\nlow = 0.3\nhigh = 0.2\n[[variant]]",
            vec!["range `a` from 0.3 to 0.2 is empty", "low = 0.2, high = 0.3"],
        ),
        ("label = \"rough\"", "label = \"rough\\u001b[31m\"", vec!["without control characters"]),
    ] {
        assert!(STUDY.contains(from), "{from}");
        let error = planned(&STUDY.replacen(from, to, 1)).expect_err(to).to_string();
        for part in parts.into_iter().chain([" = fix: ", "--> study.toml"]) {
            let part = if part.contains("replicates.count") { "count = 9" } else { part };
            assert!(error.contains(part), "no {part:?} in\n{error}");
        }
    }
}
