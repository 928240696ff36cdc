//! Every fault has a site, and exact tests of the library notice those that the table says they notice.

use super::{ALL, COMPILED};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

#[path = "ask.rs"]
mod ask;

/// Unit tests that compare with exact answers: a history, a field or a body whose mean, peak, impulse, moment or place is known without
/// the program. Begins of their names. What else fails under a fault is no physics.
const EXACT: &[&str] = &[
    "boundary::chain::tests::",
    "boundary::nodes::tests::",
    "boundary::slip::tests::",
    "boundary::tests::",
    "case::tests::shapes::a_body_by_its_foot",
    "case::tests::shapes::what_a_case_says",
    "constitutive::",
    "contact::tests::",
    "gauge::barrier::tests::",
    "gauge::field::tests::",
    "gauge::front::tests::depth_of_the_front",
    "gauge::front::tests::front_is_where",
    "gauge::layers::tests::",
    "gauge::passage::tests::",
    "gauge::penetration::tests::",
    "gauge::running::tests::",
    "gauge::station::tests::",
    "gauge::structure::tests::",
    "gauge::wall_state::tests::",
    "gauge::window::tests::",
    "ledger::tests::",
    "output::table::tests::what_is_written_is_read_back",
    "output::vtk::tests::points_and_fields_are_where",
    "run::clock::tests::",
    "run::filling::tests::",
    "run::inflow::tests::a_free_plug",
    "run::inflow::tests::points_enter_with",
    "run::gauges::tests::a_further_barrier_changes_nothing",
    "run::gauges::tests::each_of_two_bases",
    "run::means::tests::",
    "run::rest::tests::",
    "run::summary::passages_tests::",
    "run::scene::tests::a_raised_gate",
    "run::scene::tests::cohesion_of_the_case",
    "run::scene::tests::points_carry_the_mass",
    "run::scene::tests::the_numbers_of_a_law",
    "simulation::implicit::tests::alone::",
    "simulation::lagrangian::tests::implicit::a_step_obeys",
    "simulation::occupied::tests::dense_sand",
    "solver_tests::contact::bodies_touch_again",
    "solver_tests::contact::every_normal_finds",
    "solver_tests::contact::friction_takes",
    "solver_tests::contact::what_a_clamped_body_takes",
    "solver_tests::forces::",
    "solver_tests::motion::",
    "solver_tests::surface::",
    "study::quantities::tests::",
    "study::tests::every_run_is_planned",
    "timestep::tests::",
];

/// Tests that take long, or do not judge numbers of the library.
const LEFT_OUT: &[&str] = &[
    "seeded::",
    "directions_tests::",
    "reference::",
    "plot::",
    "theory::",
    "fuzz_tests::",
    "case::tests::bad_input::long_files",
    "contact::tests::rings::",
    "gauge::structure::tests::contact_clamp_and_inertia",
    "run::invariance_tests::",
    "run::verdict::tests::",
    "simulation::implicit::tests::a_free_swing",
    "simulation::implicit::tests::a_stiff_wall",
    "simulation::implicit::tests::in_equal_steps",
    "simulation::sweep::tests::",
    "solver_tests::edges::",
    "solver_tests::surface::nothing_gets_through",
];

/// How long all of them may take under one fault: they take minutes.
const ALL_AT_ONCE: Duration = Duration::from_secs(3 * 3600);

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for path in folder.read_dir().expect("a folder").map(|e| e.expect("an entry").path()) {
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

#[test]
fn every_fault_has_one_name_and_one_site() {
    const { assert!(COMPILED, "tests have the switch") };
    let names: BTreeSet<&str> = ALL.iter().map(|e| e.name).collect();
    assert_eq!(names.len(), ALL.len());
    let mut files = Vec::new();
    sources(&root().join("src"), &mut files);
    let own = root().join("src/seeded");
    let code = files.iter().filter(|f| !f.starts_with(&own)).map(|f| std::fs::read_to_string(f).expect("a source"));
    let code: String = code.collect();
    let sites: Vec<&str> = code
        .match_indices("Seed::")
        .map(|(at, _)| code[at + 6..].split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default())
        .collect();
    for entry in ALL {
        let name = format!("{:?}", entry.seed);
        assert_eq!(sites.iter().filter(|s| **s == name).count(), 1, "sites of {name}");
    }
    assert_eq!(sites.len(), ALL.len());
}

/// Tests that failed in a check of their own: their names. A test that broke down in the program, or for lack of a value, has judged nothing.
fn failed(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (at, _) in text.match_indices("panicked at ") {
        let place = text[at..].trim_start_matches("panicked at ").split_whitespace().next().unwrap_or_default();
        let mut parts = place.split(':');
        let (Some(file), Some(line)) = (parts.next(), parts.next().and_then(|l| l.parse::<usize>().ok())) else {
            continue;
        };
        let source = std::fs::read_to_string(root().join(file)).unwrap_or_default();
        let tests = if file.contains("tests") { Some(0) } else { source.lines().position(|l| l == "mod tests {") };
        let asserts = source.lines().nth(line - 1).is_some_and(|l| l.contains("assert"));
        let own = asserts && tests.is_some_and(|first| first < line);
        let test = text[..at].rsplit("thread '").next().and_then(|t| t.split('\'').next()).unwrap_or_default();
        if own && test.contains("::") && text.contains(&format!("test {test} ... FAILED")) {
            found.push(test.to_string());
        }
    }
    found.sort();
    found.dedup();
    found
}

fn is_exact(test: &str) -> bool {
    EXACT.iter().any(|begin| test.starts_with(begin))
}

#[test]
fn exact_tests_notice_what_the_table_says() {
    let rows: Vec<_> = ask::table(root()).into_iter().filter(|r| r.judge == "exact" || r.judge == "unit").collect();
    let wrong = ask::two_at_a_time(&rows, |row| {
        let answer = ask::under(&row.fault, &[], &["--exact", &row.by, "--test-threads=1"], ask::LIMIT);
        let seen = failed(&answer.text).contains(&row.by) && is_exact(&row.by) == (row.judge == "exact");
        (!seen).then(|| format!("{} is not seen by {}:\n{}", row.fault, row.by, answer.text))
    });
    let wrong: Vec<String> = wrong.into_iter().flatten().collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
#[ignore = "a child of the test below: does not end within a day"]
fn no_end() {
    std::thread::sleep(Duration::from_secs(24 * 3600));
}

#[test]
fn who_does_not_answer_is_killed() {
    let start = Instant::now();
    let arguments = ["--ignored", "--exact", "seeded::tests::no_end", "--nocapture"];
    let asked = std::panic::catch_unwind(|| ask::under("run.mean", &[], &arguments, Duration::from_secs(2)));
    let message = *asked.expect_err("no answer").downcast::<String>().expect("words");
    assert!(message.contains("run.mean") && message.ends_with("was killed after 2s"), "{message}");
    assert!(start.elapsed() < ask::LIMIT);
}

#[test]
#[ignore = "asks all unit tests about all faults, for the table; CONTRIBUTING.md says how"]
fn ask_all_unit_tests() {
    let names = ask::chosen("CHECKDAM_SEEDED_ONLY", ALL.iter().map(|e| e.name));
    let skip: Vec<String> = LEFT_OUT.iter().flat_map(|name| ["--skip".into(), (*name).into()]).collect();
    let mut arguments: Vec<&str> = skip.iter().map(String::as_str).collect();
    arguments.push("--test-threads=1");
    ask::two_at_a_time(&names, |name| {
        let seen = failed(&ask::under(name, &[], &arguments, ALL_AT_ONCE).text);
        let mut lines = format!("{name},anew,,\n");
        for test in seen {
            let judge = if is_exact(&test) { "exact" } else { "unit" };
            let seconds = ask::under(name, &[], &["--exact", &test, "--test-threads=1"], ask::LIMIT).seconds;
            lines += &format!("{name},{judge},{test},{seconds:.2}\n");
        }
        ask::note(root(), &lines);
    });
}
