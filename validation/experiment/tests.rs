//! What is not as it should be is refused with file, line and fix; what is, is run and compared.

use super::*;

const CASE: &str = r#"
title = "drop"
gravity = { inclination_deg = 0 }
grid = { spacing_m = 0.05, thickness_m = 0.1 }
domain = { x_m = [-0.5, 0.5], y_m = [-0.2, 0.6] }
materials.rubber = { law = "linear_elastic", density_kg_per_m3 = 1000, young_pa = 1e5, poisson = 0.2 }
bodies = [{ name = "block", material = "rubber", x_m = [-0.1, 0.1], y_m = [0.0, 0.2] }]
stages.run = { end_time_s = 0.1 }
gauges = { barrier = "floor", stations_m = [0.0] }
output = { vtk_interval_s = 0 }
[[boundaries]]
name = "floor"
kind = "plane"
point_m = [0.0, 0.0]
normal_deg = 90
contact = "smooth"
"#;
const STUDY: &str = "title = \"a block\"\ncases = [\"drop.toml\"]\n\
    [[variant]]\nfactor = \"modulus\"\nlabel = \"twice\"\nset = { \"materials.rubber.young_pa\" = 2e5 }\n";
const HEADER: &str = "case,quantity,value,unit,kind,uncertainty,where,how,id,ours,reduction";
const WEIGHT: &str =
    "drop,weight,39.2,N,theory,0.4,statics,density times volume times g,W,history.force_normal_n,mean 0.05 to 0.1";
const DEPTH: &str =
    "drop,height,0.2,m,theory,0.004,\"the case, file\",as it is drawn,H,stations.depth_m,last where x_m = 0";

fn experiment(study: &str, table: &str) -> Result<Experiment, ExperimentError> {
    experiment_of(CASE, study, table)
}

fn experiment_of(case: &str, study: &str, table: &str) -> Result<Experiment, ExperimentError> {
    Experiment::parse("block", "folder", &|file| match file {
        "study.toml" => Ok(study.into()),
        "published.csv" => Ok(table.into()),
        "drop.toml" => Ok(case.into()),
        other => Err(io::Error::other(format!("no {other}"))),
    })
}

fn refused(study: &str, table: &str) -> String {
    experiment(study, table).expect_err("a mistake").to_string()
}

/// The table with another text in one place of its second row.
fn with(cell: &str, other: &str) -> String {
    assert!(DEPTH.contains(cell), "{cell}");
    format!("{HEADER}\n{WEIGHT}\n{}\n", DEPTH.replacen(cell, other, 1))
}

#[test]
fn a_mistake_in_the_table_is_named_with_its_line_and_what_to_do() {
    for (cell, other, named) in [
        ("0.2,m", "0.2 m,m", "`value` is `0.2 m`, which is no number"),
        ("0.004", "", "`uncertainty` is ``, which is no number"),
        ("0.004", "0", "`uncertainty` is `0`"),
        ("theory", "heard", "`kind` is `heard`"),
        ("\"the case, file\"", "", "`where` is empty"),
        (",H,", ",W,", "the id `W` stands twice"),
        ("drop", "drip", "the study runs no case `drip`"),
        ("stations.depth_m", "station.depth_m", "the table `station`"),
        ("x_m = 0", "x_m = 0.1", "no station at x = 0.1 m"),
        ("last where", "finally where", "`reduction`"),
        (",H,stations.depth_m", ",H", "it cannot be read"),
    ] {
        let told = refused(STUDY, &with(cell, other));
        assert!(told.starts_with("error: folder/published.csv, line 3: "), "{told}");
        assert!(told.contains(named) && told.contains("\n  fix: "), "{named}: {told}");
    }
    let told = refused(STUDY, "case,value\ndrop,1\n");
    assert!(told.contains("line 1: there is no column `quantity`"), "{told}");
    let told = refused(STUDY, &format!("{HEADER}\n{}\n", DEPTH.replace("stations.depth_m,last where x_m = 0", ",")));
    assert!(told.contains("nothing in it has a counterpart"), "{told}");
}

#[test]
fn what_is_read_at_a_barrier_needs_one_by_itself_or_in_a_list() {
    let table = with("stations.depth_m,last where x_m = 0", "pressure_profile.pressure_pa,largest");
    let framed = CASE.replacen("vtk_interval_s = 0", "vtk_interval_s = 0.05", 1);
    let gauges = |text: &str| framed.replacen("barrier = \"floor\"", text, 1);
    for named in ["barrier = \"floor\"", "barriers = [\"floor\"]"] {
        experiment_of(&gauges(named), STUDY, &table).unwrap_or_else(|e| panic!("{named}: {e}"));
    }
    let told = experiment_of(&gauges("base = \"floor\""), STUDY, &table).expect_err("no barrier").to_string();
    assert!(told.contains("records no table `pressure_profile`"), "{told}");
    let told = experiment_of(CASE, STUDY, &table).expect_err("no frames").to_string();
    assert!(told.contains("records no row of `pressure_profile`") && told.contains("output.vtk_interval_s"), "{told}");
    for table in ["barrier.tip_deflection_m", "contact.area_m2"] {
        let table = with("stations.depth_m,last where x_m = 0", &format!("{table},largest"));
        let told = experiment_of(CASE, STUDY, &table).expect_err("no body").to_string();
        assert!(told.contains("records no table `"), "{told}");
    }
}

#[test]
fn a_mistake_in_the_study_and_a_file_that_is_not_there_are_named() {
    let table = format!("{HEADER}\n{WEIGHT}\n");
    let told =
        Experiment::parse("block", "folder", &|_| Err(io::Error::other("gone"))).expect_err("no file").to_string();
    assert!(told.contains("folder/study.toml: cannot be read: gone"), "{told}");
    assert!(refused("title = 3", &table).contains("folder/study.toml"));
    assert!(refused(&STUDY.replace("drop.toml", "drip.toml"), &table).contains("drip.toml"));
    let axis =
        format!("{STUDY}[[axis]]\nname = \"young_pa\"\nfields = [\"materials.rubber.young_pa\"]\nvalues = [1e5]\n");
    assert!(refused(&axis, &table).contains("takes one axis, cell_m"));
}

#[test]
fn what_is_published_stands_beside_what_is_computed() {
    let experiment = experiment(STUDY, &with("drop", "drop")).expect("an experiment");
    assert_eq!((experiment.runs(), experiment.title.as_str()), (2, "a block"));
    let folder = std::env::temp_dir().join(format!("checkdam_experiment_{}", std::process::id()));
    let outcome = experiment.run(&folder, &mut |_| true).expect("two runs");
    assert!(outcome.verdict("block", &folder).passes(), "{:?}", outcome.checks);
    let written = experiment.write(&outcome, &folder).expect("files");
    let names = ["block.csv", "block_runs.csv", "block_comparison.csv", "block_plot.svg", "block_page.md"];
    assert_eq!(written, names);
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).expect("what was just written");
    let (runs, comparison, page) = (read(names[1]), read(names[2]), read(names[4]));
    std::fs::remove_dir_all(&folder).expect("its own folder");
    assert!(runs.starts_with("case,factor,label,replicate,ended,W,H\ndrop,base,,0,") && runs.lines().count() == 3);
    // The block fills half of the strip of two cells on either side of its middle: its whole height.
    let row = comparison.lines().find(|l| l.starts_with("H,drop,height,m,theory,0.2,0.004,")).expect("a row");
    let ours: f64 = row.split(',').nth(7).and_then(|x| x.parse().ok()).expect("a number");
    assert!((ours - 0.2).abs() < 0.01, "{row}");
    assert!(row.contains(",modulus,"), "{row}");
    assert!(page.contains("| H | drop | height, m | 0.2 \u{b1} 0.004 (theory) |"), "{page}");
    assert!(page.contains("- H: the case, file: as it is drawn."), "{page}");
}
