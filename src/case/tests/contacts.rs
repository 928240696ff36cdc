//! Contacts of bodies, clamps and bodies of boundaries, added to the flume.

use super::{FLUME, parse, report_of};
use crate::case::{GapKind, NormalKind};

const BARRIER: &str = r#"
[[bodies]]
name = "fence"
material = "plastic"
x_m = [1.4, 1.5]
y_m = [-0.02, 0.3]

[[boundaries]]
name = "clamp"
kind = "plane"
point_m = [1.4, 0.0]
normal_deg = 90
contact = "bonded"
bodies = ["fence"]

[materials.plastic]
law = "neo_hookean"
density_kg_per_m3 = 1200
young_pa = 5.0e5
poisson = 0.2
"#;

const CONTACT: &str = "\n[[contacts]]\nbodies = [\"fence\", \"sand\"]\nfriction = 0.4\n";

/// The flume with a fence whose clamp does not meet the sand, and the base for the sand alone.
fn with(contact: &str) -> String {
    let base = FLUME.replacen("name = \"base\"", "name = \"base\"\nbodies = [\"sand\"]", 1);
    format!("{base}{BARRIER}{contact}")
}

#[test]
fn a_fence_in_contact_loads_with_its_defaults() {
    let loaded = parse(&with(CONTACT), "fence.toml").unwrap_or_else(|e| panic!("{e}"));
    let [contact] = &loaded.case.contacts[..] else { panic!("{:?}", loaded.case.contacts) };
    assert_eq!((contact.normal, contact.gap), (Some(NormalKind::NearestFace), Some(GapKind::Extents)));
    assert_eq!(contact.structure.as_deref(), Some("fence"));
    let text = loaded.case.to_toml().expect("TOML");
    assert_eq!(parse(&text, "again.toml").expect("the same").case, loaded.case);
}

/// Cases with a contact that cannot be, and parts of their reports.
pub fn wrong() -> Vec<(String, Vec<&'static str>)> {
    let line = |replace: &str, by: &str| with(&CONTACT.replacen(replace, by, 1));
    vec![
        (line("\"sand\"]", "\"snad\"]"), vec!["contacts[0].bodies[1] = \"snad\"", "sand"]),
        (
            line("\"fence\", \"sand\"", "\"sand\", \"fence\""),
            vec!["contacts[0].bodies: `sand` would be the structure", "granular", "structure = \"fence\""],
        ),
        (
            with(&format!("{CONTACT}structure = \"sand\"\n")),
            vec!["contacts[0].structure: `sand` would be the structure", "name `fence` first"],
        ),
        (with(&format!("{CONTACT}normal = \"average\"\n")), vec!["contacts[0].normal", "slides half as far"]),
        (line(", \"sand\"]", "]"), vec!["contacts[0].bodies", "two names", "name two bodies"]),
        (line("\"sand\"]", "\"fence\"]"), vec!["two different bodies"]),
        (line("0.4", "-0.4"), vec!["contacts[0].friction = -0.4", "friction >= 0"]),
        (line("friction = 0.4", ""), vec!["contacts.friction is missing"]),
        (with(&format!("{CONTACT}{CONTACT}")), vec!["contacts[1].bodies", "contacts[0] has the same two bodies"]),
        (
            with(&format!("{CONTACT}structure = \"gate\"\n")),
            vec!["contacts[0].structure = \"gate\"", "one of the two bodies"],
        ),
        (with(&format!("{CONTACT}normal = \"average\"\nstructure = \"fence\"\n")), vec!["is not used", "nearest_face"]),
        (
            with(&format!("{CONTACT}normal = \"prescribed\"\n")),
            vec!["contacts[0].normal_deg is missing", "normal_deg = 90"],
        ),
        (with(&format!("{CONTACT}normal_deg = 90\n")), vec!["normal_deg = 90 is not used", "prescribed"]),
        (with(&format!("{CONTACT}offset_cells = 0.8\n")), vec!["offset_cells = 0.8 is not used", "positions"]),
        (with(&format!("{CONTACT}gap = \"positions\"\noffset_cells = -1\n")), vec!["offset_cells > 0"]),
        (with(&format!("{CONTACT}frictoin = 0.4\n")), vec!["frictoin", "friction"]),
        (
            with(CONTACT).replacen("bodies = [\"fence\"]", "bodies = [\"fenc\"]", 1),
            vec!["boundaries[4].bodies[0]", "fence"],
        ),
        (with(CONTACT).replacen("bodies = [\"fence\"]", "bodies = []", 1), vec!["at least one name"]),
        (
            with(CONTACT).replacen("contact = \"bonded\"", "contact = \"bonded\"\nfriction = 1", 1),
            vec!["does not belong to contact = \"bonded\""],
        ),
        (
            with(CONTACT).replacen("poisson = 0.2", "poisson = 0.2\ncohesion_pa = 1", 1),
            vec!["is not used by law = \"neo_hookean\""],
        ),
        (
            with(&CONTACT.replacen("[[contacts]]", "[contacts]", 1)),
            vec!["contacts is not a list of tables", "[[contacts]]"],
        ),
    ]
}

#[test]
fn what_is_wrong_with_a_contact_is_said() {
    for (text, parts) in wrong() {
        let report = report_of(&text);
        println!("{report}");
        assert!(report.contains(" = fix: "), "{report}");
        for part in parts {
            assert!(report.contains(part), "no {part:?} in\n{report}");
        }
    }
}

#[test]
fn a_barrier_may_be_a_body_in_a_contact() {
    let gauge = |name: &str, text: &str| {
        let from = text.find("barrier = \"barrier\"").expect("a gauge");
        let (before, after) = text.split_at(from);
        format!("{before}{}", after.replacen("barrier = \"barrier\"", &format!("barrier = \"{name}\""), 1))
    };
    let loaded = parse(&gauge("fence", &with(CONTACT)), "fence.toml").unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(loaded.case.gauges.barrier.as_deref(), Some("fence"));
    for (text, parts) in [
        (gauge("fense", &with(CONTACT)), vec!["gauges.barrier = \"fense\"", "or of a body in [[contacts]]", "fence"]),
        (gauge("fence", &with("")), vec!["gauges.barrier = \"fence\"", "add [[contacts]] with `fence`"]),
        (
            gauge("gate", &with(CONTACT).replace("\"fence\"", "\"gate\"")),
            vec!["gauges.barrier = \"gate\"", "both have this name"],
        ),
    ] {
        let report = report_of(&text);
        println!("{report}");
        for part in parts {
            assert!(report.contains(part), "no {part:?} in\n{report}");
        }
    }
}

#[test]
fn several_barriers_are_a_list() {
    let gauge = |line: &str| {
        let text = with(CONTACT);
        let from = text.find("barrier = \"barrier\"").expect("a gauge");
        let (before, after) = text.split_at(from);
        format!("{before}{}", after.replacen("barrier = \"barrier\"", line, 1))
    };
    let loaded = parse(&gauge("barriers = [\"barrier\", \"fence\"]"), "fence.toml").unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(loaded.case.gauges.barrier_names().collect::<Vec<_>>(), ["barrier", "fence"]);
    // One barrier is written as it always was.
    let one = parse(&gauge("barrier = \"fence\""), "fence.toml").unwrap_or_else(|e| panic!("{e}")).case;
    assert!(!one.to_toml().expect("TOML").contains("barriers"));
    for (line, parts) in [
        ("barriers = [\"barrier\", \"fense\"]", vec!["gauges.barriers[1] = \"fense\"", "did you mean `fence`?"]),
        ("barriers = [\"barrier\", \"barrier\"]", vec!["gauges.barriers[1] = \"barrier\"", "remove one of them"]),
        (
            "barrier = \"fence\"\nbarriers = [\"barrier\"]",
            vec!["gauges.barrier and gauges.barriers are both given", "write barriers = [\"fence\", \"barrier\"]"],
        ),
    ] {
        let text = gauge(line);
        let report = report_of(&text);
        let place = 1 + text[..text.find("barriers = ").expect("a line")].matches('\n').count();
        assert!(report.contains(&format!(".toml:{place}:")), "not line {place} in\n{report}");
        for part in parts {
            assert!(report.contains(part), "no {part:?} in\n{report}");
        }
    }
    let text = gauge("barriers = [\"fence\", \"back wall\", \"back_wall\"]")
        .replace("name = \"gate\"", "name = \"back_wall\"");
    let report = report_of(&text);
    assert!(report.contains("gauges.barriers[2] = \"back_wall\"") && report.contains("rename one"), "{report}");
    let text =
        gauge("barriers = [\"fence\", \"Profile of it\"]").replace("name = \"gate\"", "name = \"Profile of it\"");
    assert!(report_of(&text).contains("begins with neither `profile` nor `outline`"));
}

#[test]
fn side_walls_touch_the_bodies_that_are_named() {
    let walls = |names: &str| {
        let text = with(CONTACT);
        assert!(text.contains("friction = 0.0\n"));
        text.replacen("friction = 0.0\n", &format!("friction = 0.3\nbodies = [{names}]\n"), 1)
    };
    let case = parse(&walls("\"sand\""), "fence.toml").unwrap_or_else(|e| panic!("{e}")).case;
    assert!(case.side_walls.act_on("sand") && !case.side_walls.act_on("fence"));
    assert!(parse(&with(CONTACT), "fence.toml").expect("valid").case.side_walls.act_on("fence"));
    let report = report_of(&walls("\"snad\""));
    assert!(report.contains("side_walls.bodies[0] = \"snad\"") && report.contains("sand"), "{report}");
    assert!(report_of(&walls("")).contains("at least one name"));
}

#[test]
fn only_a_body_in_a_contact_can_be_weightless() {
    let light = |contact: &str| {
        with(contact).replacen("material = \"plastic\"", "material = \"plastic\"\nweightless = true", 1)
    };
    assert!(parse(&light(CONTACT), "fence.toml").expect("valid").case.bodies[1].weightless);
    let report = report_of(&light(""));
    assert!(report.contains("bodies[1].weightless = true") && report.contains("[[contacts]]"), "{report}");
}

#[test]
fn implicit_steps_are_for_clamped_elastic_bodies_in_contact() {
    // All boundaries for the sand alone, but the clamp.
    let apart = |text: &str| {
        text.replace("kind = \"wall\"", "kind = \"wall\"\nbodies = [\"sand\"]")
            .replace("kind = \"gate\"", "kind = \"gate\"\nbodies = [\"sand\"]")
    };
    let implicit =
        |text: String| text.replacen("material = \"plastic\"", "material = \"plastic\"\nintegration = \"implicit\"", 1);
    let loaded = parse(&apart(&implicit(with(CONTACT))), "fence.toml").unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(loaded.case.bodies[1].integration, crate::case::Integration::Implicit);
    // Its waves, made fifty times as fast, do not limit the step that is foreseen.
    let mut case = loaded.case;
    let step = case.time_step_estimate_s();
    let stiff = case.bodies[1].material.clone();
    case.materials.get_mut(&stiff).expect("a material").young_pa *= 2500.0;
    assert_eq!(case.time_step_estimate_s(), step);
    case.bodies[1].integration = crate::case::Integration::Explicit;
    assert!(case.time_step_estimate_s() < 0.5 * step);
    for (text, part) in [
        (implicit(with(CONTACT)), "no boundary but clamps acts on"),
        (apart(&implicit(with(""))), "only for a body in [[contacts]]"),
        (
            apart(&implicit(with(CONTACT)).replacen("material = \"plastic\"", "material = \"sand\"", 1)),
            "only for an elastic law",
        ),
    ] {
        let report = report_of(&text);
        assert!(report.contains(part) && report.contains("bodies[1].integration = \"implicit\""), "{report}");
    }
}

#[test]
fn a_mesh_is_for_neo_hookean_bodies_that_clamps_alone_hold() {
    let apart = |text: &str| {
        text.replace("kind = \"wall\"", "kind = \"wall\"\nbodies = [\"sand\"]")
            .replace("kind = \"gate\"", "kind = \"gate\"\nbodies = [\"sand\"]")
    };
    let meshed = |text: String| {
        text.replacen("material = \"plastic\"", "material = \"plastic\"\nkinematics = \"total_lagrangian\"", 1)
    };
    let good = apart(&meshed(with(CONTACT)));
    let loaded = parse(&good, "fence.toml").unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(loaded.case.bodies[1].kinematics, crate::case::Kinematics::TotalLagrangian);
    let implicit = good.replace("\nkinematics", "\nintegration = \"implicit\"\nkinematics");
    let loaded = parse(&implicit, "fence.toml").unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(loaded.case.bodies[1].integration, crate::case::Integration::Implicit);
    let clamp = |angle: u32| format!("normal_deg = {angle}\ncontact = \"bonded\"");
    for (text, part) in [
        (meshed(with(CONTACT)), "no boundary but clamps acts on"),
        (apart(&meshed(with(""))), "in [[contacts]], or the only one"),
        (good.replace("law = \"neo_hookean\"", "law = \"linear_elastic\""), "law = \"neo_hookean\""),
        (good.replace(&clamp(90), &clamp(80)), "planes along an edge"),
        (good.replace("point_m = [1.4, 0.0]", "point_m = [1.4, -0.03]"), "clamps that reach the body"),
        (good.replacen("friction = 0.0\n", "friction = 0.3\n", 1), "side walls do not touch"),
    ] {
        let report = report_of(&text);
        assert!(report.contains(part) && report.contains("bodies[1].kinematics = \"total_lagrangian\""), "{report}");
    }
    let beside = good.replace("point_m = [1.4, 0.0]", "point_m = [1.4, -0.0200001]");
    parse(&beside, "fence.toml").unwrap_or_else(|e| panic!("{e}"));
    let report = report_of(&good.replace("\nkinematics", "\njitter = 0.2\nkinematics"));
    assert!(report.contains("0 for a structure") && report.contains("bodies[1].jitter = 0.2"), "{report}");
    let report = report_of(&good.replace("x_m = [1.4, 1.5]", "x_m = [1.4, 1.502]"));
    assert!(report.contains("distances of its particles") && report.contains("use x_m = [1.4, 1.5]"), "{report}");
}

#[test]
fn no_body_may_be_forgotten() {
    let third = BARRIER
        .split("[[boundaries]]")
        .next()
        .expect("a body")
        .replace("fence", "stone")
        .replace("1.4, 1.5", "1.6, 1.7");
    let report = report_of(&with(&format!("{CONTACT}{}", third.replace("-0.02", "0.0"))));
    for part in ["passes through every body", "add [[contacts]] with bodies = [\"sand\", \"stone\"]"] {
        assert!(report.contains(part), "{report}");
    }
}
