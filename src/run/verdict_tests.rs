use super::super::{Experiment, run_in_memory};
use super::*;
use crate::case::Case;

/// Sand that lies before a wall, is let go and comes to rest.
const HEAP: &str = r#"
title = "heap"
[gravity]
inclination_deg = 20
[grid]
spacing_m = 0.02
thickness_m = 0.2
[domain]
x_m = [-0.5, 0.5]
y_m = [-0.1, 0.6]
[materials.sand]
law = "drucker_prager"
cone = "triaxial_compression"
density_kg_per_m3 = 1500
young_pa = 2.0e5
poisson = 0.3
friction_angle_deg = 31
[[bodies]]
name = "sand"
material = "sand"
x_m = [-0.2, 0.0]
y_m = [0.0, 0.2]
[[boundaries]]
name = "base"
kind = "plane"
point_m = [0.0, 0.0]
normal_deg = 90
contact = "coulomb"
friction = 0.4
[[boundaries]]
name = "wall"
kind = "wall"
foot_m = [0.1, 0.0]
height_m = 0.3
contact = "coulomb"
friction = 0.4
[stages.run]
end_time_s = 4
[gauges]
barrier = "wall"
base = "base"
[output]
vtk_interval_s = 0
"#;

/// On these cells it keeps every limit; on those of 20 mm, 5 % of what is released is missing.
const FINE: (&str, &str) = ("spacing_m = 0.02", "spacing_m = 0.01");

fn case(changes: &[(&str, &str)]) -> Case {
    let text = changes.iter().fold(HEAP.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "no {from:?}");
        text.replacen(from, to, 1)
    });
    case::parse(&text, "heap.toml").unwrap_or_else(|e| panic!("{e}")).case
}

/// A run with what doubts it.
fn run(changes: &[(&str, &str)]) -> (Experiment, Records, Summary, Vec<Kind>) {
    let (experiment, records, summary) = run_in_memory(&case(changes), &mut |_| true).expect("a run");
    let end = if summary.status.contains("at rest") { End::Rest } else { End::Time };
    let kinds = doubts(&notes(&summary, &experiment, &records, Some(end)));
    assert_eq!(summary.trusted, kinds.is_empty());
    assert_eq!(summary.reasons.len(), kinds.len(), "{:?}", summary.reasons);
    println!("{changes:?}: {:?} {:?}", summary.reasons, tracked_over_occupied(&experiment));
    (experiment, records, summary, kinds)
}

fn doubts(notes: &[Note]) -> Vec<Kind> {
    notes.iter().filter(|n| n.kind.doubts()).map(|n| n.kind).collect()
}

#[test]
fn a_run_that_keeps_every_limit_is_trusted_and_says_so_first() {
    let (_, _, summary, kinds) = run(&[FINE]);
    assert_eq!(kinds, [], "{:?}", summary.reasons);
    assert!(summary.to_toml().starts_with("trusted = true\nreasons = []\nstatus = \"completed: at rest\"\n"));
}

#[test]
fn each_reason_is_met_by_a_run() {
    let quick = ("end_time_s = 4", "end_time_s = 0.3");
    for (kind, changes) in [
        (Kind::Rest, vec![quick]),
        // The domain ends before the wall does.
        (
            Kind::Mass,
            vec![quick, ("y_m = [-0.1, 0.6]", "y_m = [-0.1, 0.2]"), ("inclination_deg = 20", "inclination_deg = -80")],
        ),
        (
            Kind::Front,
            vec![("y_m = [0.0, 0.2]", "y_m = [0.0, 0.03]"), ("inclination_deg = 20", "inclination_deg = 35"), quick],
        ),
        (Kind::Cells, vec![quick, ("foot_m = [0.1, 0.0]", "foot_m = [0.1, 0.1]")]),
        (Kind::Pic, vec![quick, ("[output]", "[numerics]\npic_fraction = 0.5\n[output]")]),
        // A block that comes back faster than it came (docs/limits.md, "Impacts across a gap").
        (
            Kind::Energy,
            vec![
                quick,
                ("law = \"drucker_prager\"\ncone = \"triaxial_compression\"", "law = \"linear_elastic\""),
                ("friction_angle_deg = 31\n", ""),
                ("young_pa = 2.0e5", "young_pa = 1.0e6"),
                ("poisson = 0.3", "poisson = 0.0"),
                ("inclination_deg = 20", "inclination_deg = 0\nmagnitude_m_per_s2 = 0"),
                ("y_m = [0.0, 0.2]", "y_m = [0.1, 0.2]\nvelocity_m_per_s = [0.5, 0.0]"),
                ("[output]", "[numerics]\npic_fraction = 0\ncfl = 0.4\nboundary_contact = \"nodes\"\n[output]"),
            ],
        ),
    ] {
        let (_, _, summary, kinds) = run(&changes);
        assert!(kinds.contains(&kind), "{kind:?}: {:?}", summary.reasons);
        assert!(!summary.trusted && summary.to_toml().starts_with("trusted = false\nreasons = [\""));
    }
}

/// Two bodies at one place, which no case file may have: their points fill the cells twice.
#[test]
fn points_that_fill_more_than_there_is_are_a_reason() {
    let mut case = case(&[("end_time_s = 4", "end_time_s = 1.0e-3")]);
    let of = |case: &Case| {
        let (experiment, records, summary) = run_in_memory(case, &mut |_| true).expect("a run");
        let ratio = tracked_over_occupied(&experiment).expect("cells inside");
        (ratio, doubts(&notes(&summary, &experiment, &records, Some(End::Rest))))
    };
    let (ratio, kinds) = of(&case);
    assert!((ratio - 1.0).abs() < 0.01 && kinds.is_empty(), "{ratio} {kinds:?}");
    let again = crate::case::Body { name: "again".into(), ..case.bodies[0].clone() };
    case.bodies.push(again);
    let (ratio, kinds) = of(&case);
    assert!((ratio - 2.0).abs() < 0.02 && kinds.contains(&Kind::Volume), "{ratio} {kinds:?}");
}

/// Where a run that meets it would show an error of the program, the number of a run that is right is put wrong.
#[test]
fn each_number_has_its_limit() {
    let (experiment, mut records, summary, kinds) = run(&[FINE]);
    assert_eq!(kinds, []);
    let h = experiment.simulation().spacing();
    type Change = fn(&mut Summary, f64, f64);
    let table: [(Kind, Change); 4] = [
        (Kind::Momentum, |s, x, _| s.momentum.momentum_closure_1 = x * MOMENTUM_OPEN),
        (Kind::Penetration, |s, x, h| s.momentum.penetration_m = x * PENETRATION_CELLS * h),
        (Kind::Mass, |s, x, _| s.momentum.outflow_kg = x * MASS_LOST * s.stepping.mass_kg),
        (Kind::Front, |s, x, h| s.front.last_mut().expect("a front").depth_m = FRONT_CELLS * h / x),
    ];
    for (kind, change) in table {
        for (x, expected) in [(0.99, vec![]), (1.01, vec![kind])] {
            let mut changed = summary.clone();
            change(&mut changed, x, h);
            assert_eq!(doubts(&notes(&changed, &experiment, &records, Some(End::Rest))), expected, "{kind:?} {x}");
        }
    }
    let through = |mass: f64| {
        let mut changed = summary.clone();
        let barrier = changed.barrier.as_mut().expect("a barrier");
        barrier.passed_kg = barrier.overtopped_kg + barrier.passed_under_kg + mass;
        doubts(&notes(&changed, &experiment, &records, Some(End::Rest)))
    };
    let little = MASS_LOST * summary.stepping.mass_kg;
    assert_eq!((through(0.99 * little), through(1.01 * little)), (vec![], vec![Kind::Through]));
    let mut settled = summary.clone();
    let settle = crate::case::Settle { damping_per_s: 1.0, residual: 1e-4, max_time_s: 1.0, scale: Default::default() };
    settled.case.stages.settle = Some(settle);
    for (residual, expected) in
        [(0.9e-4, vec![]), (1.1e-4, vec![Kind::Settling]), (f64::INFINITY, vec![Kind::Settling])]
    {
        settled.stepping.settle_residual = residual;
        assert_eq!(doubts(&notes(&settled, &experiment, &records, Some(End::Rest))), expected, "{residual}");
    }
    for (end, kind) in [(None, Kind::Failed), (Some(End::Stopped), Kind::Stopped), (Some(End::Time), Kind::Rest)] {
        assert_eq!(doubts(&notes(&summary, &experiment, &records, end)), [kind]);
    }
    // Energy that is missing counts against what was released, wherever heights are counted from.
    let released = summary.energy.released_j;
    assert!(released > summary.stepping.mass_kg * summary.case.gravity.magnitude_m_per_s2 * h);
    let rows = records.energy.len();
    for (x, expected) in [(0.99, vec![]), (1.01, vec![Kind::Energy])] {
        for datum in [0.0, 1e6] {
            let row = &mut records.energy[rows / 2].balance;
            row.residual = x * ENERGY_OPEN * released;
            row.gravitational += datum;
            assert_eq!(doubts(&notes(&summary, &experiment, &records, Some(End::Rest))), expected, "{x} {datum}");
        }
    }
}

#[test]
fn what_is_odd_about_a_structure_is_a_reason() {
    let mut found = Vec::new();
    let mut torn = super::super::structure::for_tests();
    torn.note("it", &mut |kind, _| found.push(kind));
    assert_eq!(found, []);
    (torn.torn, torn.imbalance_1) = (true, 1e-8);
    torn.note("it", &mut |kind, _| found.push(kind));
    assert_eq!(found, [Kind::Torn, Kind::Balance]);
    assert!(found.iter().all(|kind| kind.doubts()));
}

/// Bodies with a mesh are not removed outside the domain; one that is there is no barrier any more.
#[test]
fn a_mesh_that_falls_out_of_the_domain_is_said() {
    let stone = "[materials.stone]\nlaw = \"neo_hookean\"\ndensity_kg_per_m3 = 1500\nyoung_pa = 2.0e5\npoisson = 0.3\n\
        [[bodies]]\nname = \"stone\"\nmaterial = \"stone\"\nx_m = [0.3, 0.4]\ny_m = [0.1, 0.2]\nkinematics = \"total_lagrangian\"\n\
        [[contacts]]\nbodies = [\"stone\", \"sand\"]\nfriction = 0.4\n[stages.run]";
    let of_sand = |name: &str| format!("name = \"{name}\"\nbodies = [\"sand\"]");
    let run = |end: &str| {
        let changes = [
            ("name = \"base\"", &*of_sand("base")),
            ("name = \"wall\"", &*of_sand("wall")),
            ("[stages.run]", stone),
            ("end_time_s = 4", end),
        ];
        run(&changes).3
    };
    assert!(!run("end_time_s = 0.1").contains(&Kind::Mass));
    assert!(run("end_time_s = 0.5").contains(&Kind::Mass));
}
