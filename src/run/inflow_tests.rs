//! What enters is what the case says: mass, momentum, energy, place, stress.

use super::*;
use crate::scaffold::INFLOW;
use crate::theory::uniform_flow;

fn case_of(changes: &[(&str, &str)]) -> Case {
    let mut text = INFLOW.to_owned();
    for (what, by) in changes {
        assert!(text.contains(what), "no {what:?}");
        text = text.replacen(what, by, 1);
    }
    case::parse(&text, "inflow.toml").unwrap_or_else(|e| panic!("{e}")).case
}

/// A flow on which nothing acts.
const FREE: [(&str, &str); 2] = [
    ("inclination_deg = 25", "inclination_deg = 0, magnitude_m_per_s2 = 0"),
    ("contact = \"coulomb\"\nfriction = 0.46630765815499864", "contact = \"smooth\""),
];

fn opened(case: &Case) -> Simulation {
    let mut sim = simulation(case);
    sim.open_ledger();
    sim.open_inflows();
    sim
}

#[test]
fn a_free_plug_enters_by_the_column_and_nothing_is_lost() {
    let case = case_of(&FREE);
    let mut sim = opened(&case);
    let whole = 1500.0 * 0.4 * 0.5 * 2.0;
    let column = whole * 0.025;
    while sim.time() < 1.1 {
        sim.step().expect("a step");
        let ledger = sim.ledger();
        let due = whole * sim.time().min(1.0);
        // A step is late at most.
        let late = whole * sim.time_step().dt;
        assert!(
            ledger.entered_mass <= due + 1e-9 && due - ledger.entered_mass < column + late + 1e-9,
            "{} {due}",
            sim.time()
        );
        let columns = ledger.entered_mass / column;
        assert!((columns - columns.round()).abs() < 1e-9, "{columns}");
        assert!((ledger.entered_momentum[0] - 2.0 * ledger.entered_mass).abs() < 1e-9 * whole);
        assert!((ledger.entered_energy - 2.0 * ledger.entered_mass).abs() < 1e-9 * whole);
        assert_eq!(ledger.entered_momentum[1], 0.0);
        assert!(ledger.inflow_impulse.iter().all(|p| p.abs() < 1e-9), "{:?}", ledger.inflow_impulse);
        assert!(ledger.inflow_work.abs() < 1e-9, "{}", ledger.inflow_work);
    }
    assert!(!sim.is_entering());
    assert!((sim.mass() / whole - 1.0).abs() < 1e-12 && (sim.stock().mass / whole - 1.0).abs() < 1e-12);
    // 40 columns of 8 points, the last of which was half a spacing behind the section after a second.
    let points: Vec<_> = sim.particles().collect();
    assert_eq!(points.len(), 40 * 8);
    let travel = 2.0 * sim.time();
    for (body, p) in points {
        assert_eq!(body, 0);
        let [column, row] = [p.id / 8, p.id % 8].map(f64::from);
        let place = [travel - (column + 0.5) * 0.05, (row + 0.5) * 0.05];
        assert!((0..2).all(|d| (p.x[d] - place[d]).abs() < 1e-9) && (p.v[0] - 2.0).abs() < 1e-9, "{p:?} {place:?}");
    }
}

/// What enters and what acts on it make up what is there, on a slope and with all that a step does.
#[test]
fn momentum_and_energy_close_while_it_enters() {
    for scheme in ["musl", "usl", "usf"] {
        let scheme = format!("[numerics]\nscheme = \"{scheme}\"\npic_fraction = 1.0e-3\n[stages.run]");
        let case = case_of(&[("[stages.run]", &scheme), ("inclination_deg = 25", "inclination_deg = 30")]);
        let mut sim = opened(&case);
        while sim.time() < 0.6 {
            sim.step().expect("a step");
        }
        let (ledger, now) = (sim.ledger(), sim.stock());
        let given = ledger.impulse();
        for d in 0..2 {
            assert!((now.momentum[d] - given[d]).abs() < 1e-10 * ledger.impulse_scale, "{:?} {given:?}", now.momentum);
        }
        assert!((ledger.entered_mass - now.mass).abs() < 1e-9 && now.mass > 300.0);
        let balance = sim.energy_balance(&now, [0.0, -3.0]);
        assert_eq!(balance.initial, 0.0);
        // What a run may leave open and be trusted, and half of it where boundaries are charged with what the points lose.
        let open = if scheme.contains("musl") { 0.01 } else { 0.02 };
        assert!(balance.residual.abs() < open * balance.released(), "{scheme}: {balance:?}");
        assert!(balance.released() > now.kinetic, "{balance:?}");
    }
}

/// The level at which gravitational energy is zero is no part of what was released.
#[test]
fn what_was_released_knows_no_level() {
    let case = case_of(&[]);
    let mut sim = opened(&case);
    (0..300).for_each(|_| sim.step().expect("a step"));
    let [a, b] = [[0.0; 2], [3.0, -7.0]].map(|datum| sim.energy_balance(&sim.stock(), datum));
    assert!((a.released() / b.released() - 1.0).abs() < 1e-9 && (a.residual - b.residual).abs() < 1e-9 * a.released());
    assert!((a.inflow - b.inflow).abs() > 0.1 * a.released(), "levels are told apart");
}

#[test]
fn numbers_are_the_same_bits_for_any_number_of_threads() {
    let case = case_of(&[("spacing_m = 0.1", "spacing_m = 0.05")]);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let mut sim = opened(&case);
            (0..500).for_each(|_| sim.step().expect("a step"));
            let points: Vec<_> = sim.particles().collect();
            (points, sim.ledger().clone())
        })
    };
    let one = run(1);
    assert!(one.0.len() > 250);
    assert!(one == run(3));
}

/// A layer in which every part is carried by the next: its stress is in the cone and across the bed that of its weight.
#[test]
fn stress_is_that_of_a_layer_and_lies_in_the_cone() {
    for (slope, friction, profile) in [
        (0.0, 0.0, "plug"),
        (25.0, 0.46630765815499864, "plug"),
        (25.0, 0.2, "plug"),
        (28.0, 0.9, "bagnold"),
        (36.0, 0.9, "linear"),
    ] {
        let (inclined, rubs) = (format!("inclination_deg = {slope}"), format!("friction = {friction}"));
        let shaped = format!("duration_s = 1.0\nprofile = \"{profile}\"");
        let case = case_of(&[
            ("inclination_deg = 25", &inclined),
            ("friction = 0.46630765815499864", &rubs),
            ("duration_s = 1.0", &shaped),
        ]);
        let s = layer(&case, &case.inflows[0]).expect("a stress");
        let AnyLaw::DruckerPrager(law) = scene::law(&case.materials["sand"]) else { panic!("another law") };
        let yields = s.j2().sqrt() + law.friction * s.mean();
        let weight = 1500.0 * 9.81 * libm::cos(f64::to_radians(slope));
        assert!(yields < 1e-9 * weight && (s.yy / -weight - 1.0).abs() < 1e-12, "{slope} {friction}: {s:?}");
        let across = s.zz / (s.xx + s.yy);
        assert!((across - if slope > 0.0 { 0.5 } else { 0.3 }).abs() < 1e-12, "{slope}: {s:?}");
        let steady = libm::tan(f64::to_radians(slope));
        let wanted = if profile == "plug" { friction } else { steady.min(friction) };
        if slope < 36.0 {
            assert!((s.xy / weight - wanted).abs() < 1e-9, "{slope}: {s:?}");
            let k = uniform_flow::active_ratio(35f64.to_radians(), wanted).max(3.0 / 7.0);
            assert!((s.xx / s.yy - k).abs() < 1e-6, "{slope}: {s:?} {k}");
        } else {
            // Steeper than its angle: tan(phi) of the pressure, with K = 1 + 2 tan(phi)^2, as Mohr and Coulomb have it.
            let limit = libm::tan(35f64.to_radians());
            assert!((s.xy / weight - limit).abs() < 1e-6 && steady > limit && yields > -1e-6 * weight, "{s:?}");
            assert!((s.xx / s.yy - (1.0 + 2.0 * limit * limit)).abs() < 1e-3, "{s:?}");
        }
    }
}

/// The energy of what enters knows its stress: on a level bed every column brings the same.
#[test]
fn points_enter_with_the_stress_of_the_layer() {
    let case = case_of(&[("inclination_deg = 25", "inclination_deg = 0")]);
    let mut sim = opened(&case);
    while sim.ledger().entered_mass < 9.5 * 8.0 * 1.875 {
        sim.step().expect("a step");
    }
    let one = layer(&case, &case.inflows[0]).expect("a stress");
    let (mass, volume) = (1.875, 0.05 * 0.05 * 0.5);
    let energy = |row: u32| {
        let height = (f64::from(row) + 0.5) * 0.05;
        let below = 0.4 - height;
        let stress = Stress { xx: below * one.xx, yy: below * one.yy, zz: below * one.zz, xy: below * one.xy };
        let state = crate::constitutive::PointState { stress, ..Default::default() };
        let stored = crate::constitutive::Law::stored_energy(&sim.bodies()[0].law, &state);
        mass * (0.5 * 2.0 * 2.0 + 9.81 * height) + volume * stored
    };
    let column: f64 = (0..8).map(energy).sum();
    let columns = (sim.ledger().entered_mass / (8.0 * mass)).round();
    assert!((sim.ledger().entered_energy / (columns * column) - 1.0).abs() < 1e-9, "{column} {columns}");
    // A thousandth of it is elastic.
    assert!(one.yy < -14_000.0);
}

#[test]
fn a_sheared_flow_has_the_mean_velocity_and_the_momentum_of_its_profile() {
    for (name, profile) in [("linear", Profile::Linear), ("bagnold", Profile::Bagnold), ("plug", Profile::Plug)] {
        let shaped = format!("duration_s = 1.0\nprofile = \"{name}\"");
        let case = case_of(&[("duration_s = 1.0", &shaped), ("depth_m = 0.4", "depth_m = 0.8")]);
        let entering = simulation(&case);
        let inflow = entering.inflows().next().expect("an inflow");
        // The last points of each row say how fast it is.
        let mut paces: Vec<(f64, f64)> = inflow.points.iter().map(|c| (c.height, c.pace)).collect();
        paces.sort_by(|a, b| a.0.total_cmp(&b.0));
        paces.dedup();
        assert_eq!(paces.len(), 16);
        let mean = paces.iter().map(|p| p.1).sum::<f64>() / 16.0;
        assert!((mean - 1.0).abs() < 1e-12, "{name}");
        let square = paces.iter().map(|p| p.1 * p.1).sum::<f64>() / 16.0;
        let exact = match profile {
            Profile::Plug => 1.0,
            Profile::Linear => 4.0 / 3.0,
            Profile::Bagnold => uniform_flow::BAGNOLD_MOMENTUM,
        };
        // Rows are means over their height: one over three times the square of their number is the share that a linear one lacks.
        assert!((square - exact).abs() <= 1.5 / (3.0 * 256.0), "{name}: {square} {exact}");
        for (height, pace) in paces {
            let share = height / 0.8;
            let local = match profile {
                Profile::Plug => 1.0,
                Profile::Linear => 2.0 * share,
                Profile::Bagnold => uniform_flow::bagnold(share),
            };
            assert!((pace - local).abs() < 2e-3, "{name} at {height}: {pace} {local}");
        }
        // As many points as the discharge asks for, to half a point a row.
        let count = inflow.points.len() as f64;
        assert!((count - 16.0 * 40.0).abs() <= 8.0, "{name}: {count}");
    }
}

#[test]
fn a_wedge_enters_from_its_toe_on() {
    let case = case_of(&[("duration_s = 1.0", "duration_s = 1.0\nfront_angle_deg = 45")]);
    let entering = simulation(&case);
    let inflow = entering.inflows().next().expect("an inflow");
    let spacing = 0.05;
    // Nothing before the face of the wedge, and all behind it.
    assert!(inflow.points.iter().all(|c| c.behind > c.height));
    let area = inflow.points.len() as f64 * spacing * spacing;
    assert!((area - (0.4 * 2.0 - 0.5 * 0.4 * 0.4)).abs() < 8.0 * 0.5 * spacing * spacing + 1e-12, "{area}");
    assert!((case.inflows[0].area_m2(&case) - (0.8 - 0.08)).abs() < 1e-12);
    // Where it is shallow it presses less.
    assert!(inflow.points.iter().all(|c| (c.depth - c.behind.min(0.4)).abs() < 1e-12));
}

#[test]
fn a_hydrograph_brings_the_area_below_it() {
    let keys = "depth_m = 0.4\nvelocity_m_per_s = 2\nduration_s = 1.0";
    let graph = "times_s = [0.1, 0.5, 1.0]\ndepths_m = [0.2, 0.6, 0.1]\nvelocities_m_per_s = [1.0, 3.0, 2.0]";
    let case = case_of(&[(keys, graph)]);
    let entering = simulation(&case);
    let inflow = entering.inflows().next().expect("an inflow");
    // Simpson's rule is exact for the product of two straight lines.
    let simpson = |t: f64, d: [f64; 2], u: [f64; 2]| {
        let middle = 0.25 * (d[0] + d[1]) * (u[0] + u[1]);
        t / 6.0 * (d[0] * u[0] + 4.0 * middle + d[1] * u[1])
    };
    let area = simpson(0.4, [0.2, 0.6], [1.0, 3.0]) + simpson(0.5, [0.6, 0.1], [3.0, 2.0]);
    assert!((case.inflows[0].area_m2(&case) - area).abs() < 1e-12);
    let made = inflow.points.len() as f64 * 0.05 * 0.05;
    // The last column may lack, and depths change within one.
    assert!((made - area).abs() < 0.1 * 0.05 + 0.005 * area, "{made} {area}");
    assert!((inflow.way.travel(1.0) - (0.4 * 2.0 + 0.5 * 2.5)).abs() < 1e-12);
    assert!((inflow.way.speed(0.3) - 2.0).abs() < 1e-12 && (inflow.way.travel(0.3) - 0.2 * 1.5).abs() < 1e-12);
    // Columns are as deep as the flow is when they pass.
    let deepest = inflow.points.iter().map(|c| c.depth).fold(0.0, f64::max);
    assert!((deepest - 0.6).abs() < 0.02, "{deepest}");
    assert!((inflow.points[0].depth - 0.2).abs() < 0.03);
    // All of it enters.
    let mut sim = opened(&case);
    while sim.is_entering() {
        sim.step().expect("a step");
    }
    assert_eq!(sim.particle_count(), inflow.points.len());
    assert!(sim.time() < 1.0 + 2.0 * sim.time_step().dt);
}

#[test]
fn a_mass_says_how_long_it_lasts() {
    let timed = case_of(&[]);
    let weighed = case_of(&[("duration_s = 1.0", "mass_kg = 600")]);
    let [a, b] = [&timed, &weighed].map(|c| c.inflows[0].hydrograph(c).expect("a hydrograph"));
    assert!((a[0][1] - b[0][1]).abs() < 1e-12);
    let wedge = case_of(&[("duration_s = 1.0", "mass_kg = 540\nfront_angle_deg = 45")]);
    assert!((wedge.inflows[0].area_m2(&wedge) * 1500.0 * 0.5 - 540.0).abs() < 1e-9);
}

/// An inflow waits for the release, enters beside a body that is there, and is no part of what is seen before it has passed its section.
#[test]
fn a_deposit_is_there_and_the_flow_comes_after_the_release() {
    let case = case_of(&[
        (
            "[[inflows]]",
            "[[bodies]]\nname = \"lump\"\nmaterial = \"sand\"\nx_m = [3, 3.5]\ny_m = [0, 0.3]\n\n[[inflows]]",
        ),
        ("duration_s = 1.0", "duration_s = 0.5\nstart_time_s = 0.2"),
        ("[stages.run]", "[stages.settle]\ndamping_per_s = 60\nresidual = 5.0e-2\nmax_time_s = 5\n[stages.run]"),
        ("inclination_deg = 25", "inclination_deg = 10"),
    ]);
    let (experiment, records, summary) = crate::run::run_in_memory(&case, &mut |_| true).expect("it runs");
    let entered = summary.inflow.as_ref().expect("an inflow");
    assert!((entered.entered_kg - 300.0).abs() < 1e-9 && entered.unfinished.is_empty(), "{entered:?}");
    assert_eq!(summary.stepping.particles, 10 * 6);
    let before = records.history.iter().filter(|r| r.time < 0.2).map(|r| r.entered).fold(0.0, f64::max);
    assert_eq!(before, 0.0);
    let late = records.history.last().expect("rows");
    assert!((late.entered - 300.0).abs() < 1e-9);
    assert!(summary.momentum.momentum_closure_1 < 1e-10, "{:?}", summary.momentum);
    assert!(summary.energy.residual_of_released_1 < 0.02, "{:?}", summary.energy);
    let names: Vec<_> = experiment.simulation().bodies().iter().map(|b| b.name.as_str()).collect();
    assert_eq!(names, ["lump", "flow"]);
}

/// What flows to the left is the mirror image of what flows to the right.
#[test]
fn a_flow_to_the_left_is_the_mirror_image() {
    let right = case_of(&[]);
    let left = case_of(&[
        ("inclination_deg = 25", "inclination_deg = -25"),
        ("x_m = [-1, 6]", "x_m = [-6, 1]"),
        ("depth_m = 0.4", "depth_m = 0.4\ntowards = \"left\""),
    ]);
    let [a, b] = [right, left].map(|case| {
        let mut sim = opened(&case);
        (0..400).for_each(|_| sim.step().expect("a step"));
        let mut points: Vec<_> = sim.particles().map(|(_, p)| p).collect();
        points.sort_by_key(|p| p.id);
        points
    });
    assert!(a.len() == b.len() && a.len() > 80);
    for (p, q) in a.iter().zip(&b) {
        assert!((p.x[0] + q.x[0]).abs() < 1e-6 && (p.x[1] - q.x[1]).abs() < 1e-6, "{p:?} {q:?}");
        assert!((p.v[0] + q.v[0]).abs() < 1e-5 && (p.v[1] - q.v[1]).abs() < 1e-5, "{p:?} {q:?}");
    }
}

/// A wall close to the section: what it holds grows back to the section, and the run says so.
#[test]
fn a_drowned_section_is_seen() {
    let wall = "[[boundaries]]\nname = \"wall\"\nkind = \"wall\"\nfoot_m = [0.8, 0]\nheight_m = 1.8\ncontact = \"smooth\"\n\n[stages.run]";
    let near = case_of(&[("[stages.run]", wall), ("inclination_deg = 25", "inclination_deg = 10")]);
    let (_, _, summary) = crate::run::run_in_memory(&near, &mut |_| true).expect("it runs");
    let beyond = summary.inflow.as_ref().expect("an inflow").velocity_beyond_1;
    assert!(beyond < 0.5 && summary.reasons.iter().any(|r| r.contains("drowned")), "{beyond} {:?}", summary.reasons);
    let (_, _, free) = crate::run::run_in_memory(&case_of(&[]), &mut |_| true).expect("it runs");
    let beyond = free.inflow.as_ref().expect("an inflow").velocity_beyond_1;
    assert!(beyond > 0.95 && !free.reasons.iter().any(|r| r.contains("drowned")), "{beyond} {:?}", free.reasons);
}

#[test]
fn a_run_that_ends_before_its_inflow_says_so() {
    let (_, _, summary) =
        crate::run::run_in_memory(&case_of(&[("end_time_s = 1.2", "end_time_s = 0.3")]), &mut |_| true)
            .expect("it runs");
    assert!(
        !summary.trusted && summary.reasons.iter().any(|r| r.contains("`flow` had not ended")),
        "{:?}",
        summary.reasons
    );
}

#[test]
fn no_place_is_passed_before_something_has_entered() {
    for (towards, way) in [("right", 1.0), ("left", -1.0)] {
        let mut case = case_of(&FREE);
        case.inflows[0].towards = if towards == "left" { case::Towards::Left } else { case::Towards::Right };
        let [x, _] = case.inflows[0].foot_m;
        case.gauges.stations_m = vec![x + way * 0.3];
        case.stages.run.end_time_s = 0.4;
        let (_, records, summary) = crate::run::run_in_memory(&case, &mut |_| true).expect("a run");
        let after = summary.front[0].edge_time_s;
        let first = records.history.iter().find(|r| r.front.x.is_finite()).expect("a flow").time;
        assert!(after > 0.3 / 2.0 - 0.03 && after < 0.3 / 2.0 + 0.03 && first > 0.0, "{towards}: {after} {first}");
    }
}
