//! Cases that run and whose numbers would mean little.

use super::{changed, parse};

fn warnings_of(text: &str) -> Vec<String> {
    parse(text, "some/case.toml").unwrap_or_else(|error| panic!("{error}")).warnings
}

fn fence(depth: f64, clamp: bool) -> String {
    let clamp = if clamp {
        "[[boundaries]]\nname = \"clamp\"\nkind = \"plane\"\npoint_m = [1.4, 0]\nnormal_deg = 90\ncontact = \"bonded\"\nbodies = [\"fence\"]\n"
    } else {
        ""
    };
    let text = changed("barrier = \"barrier\"", "barrier = \"fence\"");
    let text = text.replacen("name = \"base\"", "name = \"base\"\nbodies = [\"sand\"]", 1);
    format!(
        "{text}\n[[bodies]]\nname = \"fence\"\nmaterial = \"plastic\"\nx_m = [1.4, {}]\ny_m = [-0.02, 0.3]\n{clamp}\
         [[contacts]]\nbodies = [\"fence\", \"sand\"]\nfriction = 0.4\n\
         [materials.plastic]\nlaw = \"neo_hookean\"\ndensity_kg_per_m3 = 1200\nyoung_pa = 5.0e5\npoisson = 0.2\n",
        1.4 + depth
    )
}

#[test]
fn a_barrier_that_nothing_holds_or_that_is_thin_is_a_warning() {
    assert_eq!(warnings_of(&fence(0.06, true)), Vec::<String>::new());
    for (depth, clamp, part) in
        [(0.06, false, "no clamp holds the barrier `fence`"), (0.05, true, "the barrier `fence` is 5 cells thick")]
    {
        let warnings = warnings_of(&fence(depth, clamp));
        assert!(warnings.len() == 1 && warnings[0].contains(part), "{warnings:?}");
    }
    let friction = warnings_of(&fence(0.06, true).replace("friction = 0.4\n[materials", "friction = 22\n[materials"));
    assert!(friction.len() == 1 && friction[0].contains("contacts[0].friction = 22"), "{friction:?}");
}

#[test]
fn a_case_without_a_boundary_is_a_warning() {
    let flume = super::FLUME;
    let (start, end) = (flume.find("[[boundaries]]").unwrap(), flume.find("[side_walls]").unwrap());
    let text = format!("{}{}", &flume[..start], &flume[end..]);
    let text = text.replacen("barrier = \"barrier\"", "", 1).replacen("base = \"base\"", "", 1);
    let warnings = warnings_of(&text);
    assert!(warnings.len() == 1 && warnings[0].contains("the case has no boundary"), "{warnings:?}");
}

/// The threshold is that of [`theory::pic`](crate::theory::pic): half of a motion with half a wave over the body's smaller side,
/// while it falls through it.
#[test]
fn pic_that_moves_the_material_is_a_warning() {
    use crate::theory::pic::numerical_viscosity;
    let of = |line: &str| warnings_of(&changed("pic_fraction = 5.0e-4", line));
    let dt = parse(super::FLUME, "a").unwrap().case.time_step_estimate_s();
    let (depth, g) = (0.2_f64, 9.81_f64);
    let decay = |share: f64| {
        2.0 * numerical_viscosity(share, 0.01, dt, 2) * (std::f64::consts::PI / depth).powi(2) * (depth / g).sqrt()
    };
    let limit = std::f64::consts::LN_2 / decay(1.0);
    assert!(limit > 0.01 && limit < 0.1, "{limit}");
    for (line, warned) in [
        (format!("pic_fraction = {}", 0.99 * limit), false),
        (format!("pic_fraction = {}", 1.01 * limit), true),
        (format!("pic_rate_per_s = {}", 0.99 * limit / dt), false),
        (format!("pic_rate_per_s = {}", 1.01 * limit / dt), true),
    ] {
        let warnings = of(&line);
        assert_eq!(warnings.len(), usize::from(warned), "{line}: {warnings:?}");
        assert!(warnings.iter().all(|w| w.contains("brakes the flow by itself")), "{warnings:?}");
    }
}

#[test]
fn a_structure_whose_sides_its_particles_do_not_divide_is_refused() {
    let odd = fence(0.063, true);
    let refused = parse(&odd, "some/case.toml").expect_err("its faces would be lost").to_string();
    assert!(refused.contains("for a structure, whose faces are traced along particles"), "{refused}");
    assert!(refused.contains("fix: use x_m = [1.4, 1.465]"), "{refused}");
    // With the particles of the cells it is as it was, and its mass another.
    let square = odd.replacen("[grid]", "[grid]\nfilling = \"square\"", 1);
    let warnings = warnings_of(&square);
    assert!(warnings.iter().all(|w| !w.contains("multiple")), "{warnings:?}");
}
