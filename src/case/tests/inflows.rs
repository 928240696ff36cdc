//! Inflows of a case: what is accepted, and what is refused with a way out.

use super::*;
use crate::scaffold::INFLOW;

fn with(replace: &str, by: &str) -> String {
    assert!(INFLOW.contains(replace), "the inflow has no {replace:?}");
    INFLOW.replacen(replace, by, 1)
}

#[test]
fn an_inflow_alone_is_a_case() {
    let loaded = parse(INFLOW, "inflow.toml").unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(loaded.warnings, Vec::<String>::new());
    let case = loaded.case;
    assert_eq!((case.bodies.len(), case.inflows.len()), (0, 1));
    assert!((case.entering_count_estimate() - 320.0).abs() < 1e-9);
    // 0.1 m over the P-wave and the velocity.
    let wave = case.materials["sand"].p_wave_speed_m_per_s();
    assert!((case.time_step_estimate_s() - 0.3 * 0.1 / (wave + 2.0)).abs() < 1e-15);
    let text = case.to_toml().expect("TOML");
    assert_eq!(parse(&text, "again.toml").expect("the same"), LoadedCase { case, warnings: Vec::new() });
}

#[test]
fn a_case_without_inflows_does_not_know_of_them() {
    assert!(!parse(FLUME, "flume.toml").expect("a case").case.to_toml().expect("TOML").contains("inflow"));
}

const GRAPH: &str = "times_s = [0, 1]\ndepths_m = [0.4, 0.4]\nvelocities_m_per_s = [2, 1]";
const GIVEN: &str = "depth_m = 0.4\nvelocity_m_per_s = 2\nduration_s = 1.0";

const LAW: &str =
    "law = \"drucker_prager\"\ndensity_kg_per_m3 = 1500\nyoung_pa = 1.0e6\npoisson = 0.3\nfriction_angle_deg = 35";

/// What is replaced, by what, a text on the line that is reported, and what the report says.
#[rustfmt::skip]
const BAD: &[(&str, &str, &str, &[&str])] = &[
    ("depth_m = 0.4", "depth_m = 0.04", "depth_m = 0.04", &["at least the distance of the particles, 0.05 m", "use 0.05 or more"]),
    ("depth_m = 0.4\n", "", "[[inflows]]", &["inflows[0].depth_m is missing", "add a line such as depth_m"]),
    ("velocity_m_per_s = 2", "velocity_m_per_s = 0", "velocity_m_per_s = 0", &["velocity_m_per_s > 0"]),
    ("velocity_m_per_s = 2", "velocity_m_per_s = -2", "velocity_m_per_s = -2", &["velocity_m_per_s > 0"]),
    ("duration_s = 1.0\n", "", "[[inflows]]", &["inflows[0].duration_s is missing", "mass_kg"]),
    ("duration_s = 1.0", "duration_s = 0.0", "duration_s = 0.0", &["duration_s > 0"]),
    ("duration_s = 1.0", "duration_s = 1.0\nmass_kg = 5", "mass_kg = 5", &["one of duration_s and mass_kg"]),
    ("duration_s = 1.0", "duration_s = 1.0\nstart_time_s = -1", "start_time_s = -1", &["start_time_s >= 0"]),
    ("duration_s = 1.0", "duration_s = 1.0\nstart_time_s = 1.2", "start_time_s = 1.2", &["begins at 1.2 s, and the run ends at 1.2 s"]),
    ("duration_s = 1.0", "duration_s = 1.0\nfront_angle_deg = 0", "front_angle_deg = 0", &["0 < front_angle_deg <= 90"]),
    ("duration_s = 1.0", "duration_s = 1.0\nfront_angle_deg = 10", "front_angle_deg = 10", &["makes a wedge of 2.26851 m of a flow of 2 m", "use 11.31"]),
    ("duration_s = 1.0", "duration_s = 1.0\nparticles_per_cell = 5", "particles_per_cell = 5", &["1, 4, 9 or 16"]),
    ("duration_s = 1.0", "duration_s = 1.0\ndepths_m = [1, 2]", "depths_m", &["only with times_s"]),
    ("duration_s = 1.0", "duration_s = 1.0\nspeed = 2", "speed = 2", &["speed"]),
    ("duration_s = 1.0", "duration_s = 1.0\ntowards = \"up\"", "towards", &["up"]),
    ("duration_s = 1.0", "duration_s = 1e9", "spacing_m = 0.1", &["particles", "use spacing_m"]),
    ("material = \"sand\"", "material = \"mud\"", "\"mud\"", &["inflows[0].material = \"mud\""]),
    ("name = \"flow\"", "name = \"\"", "name = \"\"", &["a name that is not empty"]),
    (LAW, "law = \"linear_elastic\"\ndensity_kg_per_m3 = 1500\nyoung_pa = 1.0e6\npoisson = 0.3", "material = \"sand\"", &["a material that flows"]),
    ("foot_m = [0, 0]", "foot_m = [-0.6, 0]", "foot_m = [-0.6", &["is led from x = -1.1", "five cells behind the section"]),
    ("foot_m = [0, 0]", "foot_m = [5.95, 0]", "foot_m = [5.95", &["out of the domain"]),
    ("foot_m = [0, 0]", "foot_m = [0, 0.2]", "foot_m = [0, 0.2]", &["no plane lies under the section", "use foot_m = [0, 0], on `bed`"]),
    ("y_m = [-0.5, 2]", "y_m = [-0.5, 0.3]", "foot_m = [0, 0]", &["reaches from y = 0 to 0.4 m, out of the domain"]),
    ("normal_deg = 90", "normal_deg = 80", "foot_m = [0, 0]", &["no plane lies under the section"]),
    ("[[boundaries]]", "[[bodies]]\nname = \"lump\"\nmaterial = \"sand\"\nx_m = [-0.3, 0.1]\ny_m = [0, 0.2]\n[[boundaries]]", "foot_m = [0, 0]", &["body `lump` lies within five cells behind the section"]),
    ("[[boundaries]]", "[[bodies]]\nname = \"flow\"\nmaterial = \"sand\"\nx_m = [1, 2]\ny_m = [0, 0.2]\n[[boundaries]]", "name = \"flow\"", &["is used twice", "bodies[0] has the same name"]),
    ("[[boundaries]]", "[[boundaries]]\nname = \"wall\"\nkind = \"wall\"\nfoot_m = [-0.2, 0]\nheight_m = 1\ncontact = \"smooth\"\n[[boundaries]]", "foot_m = [0, 0]", &["boundary `wall` lies within five cells behind"]),
    ("[[boundaries]]", "[[inflows]]\nname = \"two\"\nmaterial = \"sand\"\nfoot_m = [0.2, 0]\ndepth_m = 0.4\nvelocity_m_per_s = 2\nduration_s = 1\n[[boundaries]]", "foot_m = [0.2, 0]", &["inflow `flow` lies within five cells behind the section of inflow `two`"]),
    ("[stages.run]", "[stages.settle]\ndamping_per_s = 60\nresidual = 1e-3\nmax_time_s = 5\n[stages.run]", "[stages.settle]", &["nothing is there to settle"]),
    (GIVEN, "duration_s = 1\ntimes_s = [0, 1]\ndepths_m = [0.4, 0.4]\nvelocities_m_per_s = [2, 1]", "duration_s = 1", &["left out with times_s"]),
    (GIVEN, "times_s = [0]\ndepths_m = [0.4]\nvelocities_m_per_s = [2]", "times_s", &["has 1 moments"]),
    (GIVEN, "times_s = [1, 1]\ndepths_m = [0.4, 0.4]\nvelocities_m_per_s = [2, 1]", "times_s", &["moments that increase"]),
    (GIVEN, "times_s = [0, 1]\nvelocities_m_per_s = [2, 1]", "[[inflows]]", &["depths_m is missing"]),
    (GIVEN, "times_s = [0, 1]\ndepths_m = [0.4, 0.4, 0.4]\nvelocities_m_per_s = [2, 1]", "depths_m", &["has 3 numbers and times_s has 2"]),
    (GIVEN, "times_s = [0, 1]\ndepths_m = [0.4, 0.0]\nvelocities_m_per_s = [2, 1]", "depths_m", &["depths_m[1] = 0"]),
    (GIVEN, "times_s = [0, 1]\ndepths_m = [0.4, 0.4]\nvelocities_m_per_s = [0, 0]", "velocities_m_per_s", &["not all 0"]),
    (GIVEN, "profile = \"linear\"\ntimes_s = [0, 1]\ndepths_m = [0.4, 0.5]\nvelocities_m_per_s = [2, 1]", "profile", &["rows of a sheared flow have one height"]),
    (GIVEN, "front_angle_deg = 45\ntimes_s = [0, 1]\ndepths_m = [0.4, 0.5]\nvelocities_m_per_s = [2, 1]", "front_angle_deg", &["90, a vertical face, where the depth changes"]),
];

#[test]
fn inflows_that_cannot_be() {
    for (replace, by, at, contains) in BAD {
        let text = with(replace, by);
        let report = report_of(&text);
        let place = format!("--> some/case.toml:{}:", line_of(&text, at));
        for expected in [place.as_str(), " = fix: "].iter().chain(*contains) {
            assert!(report.contains(expected), "no {expected:?} for {by:?} in\n{report}");
        }
    }
}

#[test]
fn a_case_of_nothing_is_refused() {
    let at = INFLOW.find("[[inflows]]").expect("an inflow");
    let end = INFLOW.find("[[boundaries]]").expect("a boundary");
    let report = report_of(&format!("{}{}", &INFLOW[..at], &INFLOW[end..]));
    assert!(report.contains("bodies is missing") && report.contains("[[bodies]] or [[inflows]]"), "{report}");
}

#[test]
fn hydrographs_of_one_depth_may_be_sheared_and_have_a_wedge() {
    let text = with(GIVEN, &format!("{GRAPH}\nprofile = \"bagnold\"\nfront_angle_deg = 60"));
    let case = parse(&text, "inflow.toml").unwrap_or_else(|error| panic!("{error}")).case;
    assert!((case.inflows[0].area_m2(&case) - (0.6 - 0.5 * 0.16 / 3f64.sqrt())).abs() < 1e-12);
}

/// Bodies in contact have velocities of their own, and what enters would pass through them.
#[test]
fn bodies_in_contact_and_inflows_exclude_each_other() {
    let inflow = "[[inflows]]\nname = \"flow\"\nmaterial = \"sand\"\nfoot_m = [-1, 0]\ndepth_m = 0.4\nvelocity_m_per_s = 2\nduration_s = 1\n";
    let text = format!("{}\n{inflow}", crate::scaffold::BARRIER);
    let report = report_of(&text);
    assert!(
        report.contains("a case with inflows has contacts of bodies") && report.contains("kind = \"wall\""),
        "{report}"
    );
}
