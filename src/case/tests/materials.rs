//! Laws that a case can choose: their keys, what is refused, and that what flows is told apart.

use super::bad_input::{Bad, check};
use super::{FLUME, Law, parse, report_of};
use crate::scaffold::BARRIER;

/// The keys of the material of the flume from its law on.
const KEYS: &str = "law = \"drucker_prager\"";

/// The flume with other keys for its law, and without those of the cone.
fn with_law(keys: &str) -> String {
    let own = |line: &str| {
        ["cone", "friction_angle_deg", "cohesion_pa", "dilatancy_angle_deg", "tension_cutoff_pa", "void_tracking"]
            .iter()
            .any(|key| line.starts_with(&format!("{key} ")))
    };
    let text: String = FLUME.lines().filter(|line| !own(line)).map(|line| format!("{line}\n")).collect();
    assert!(text.contains(KEYS), "{text}");
    text.replacen(KEYS, keys, 1)
}

const MOHR: &str = "law = \"mohr_coulomb\"\nfriction_angle_deg = 31";
const CLAY: &str = "law = \"von_mises\"\nshear_strength_pa = 2000";
const BEADS: &str =
    "law = \"mu_i\"\nmu_s = 0.38\nmu_2 = 0.64\ni_0 = 0.279\ngrain_diameter_m = 5.3e-4\ngrain_density_kg_per_m3 = 2450";

#[test]
fn each_law_loads_with_its_own_keys() {
    let softens = "critical_friction_angle_deg = 28\nsoftening_strain = 0.1";
    for (keys, law) in [
        (MOHR.to_owned(), Law::MohrCoulomb),
        (format!("{MOHR}\n{softens}\ncohesion_pa = 50\ntension_cutoff_pa = 10"), Law::MohrCoulomb),
        (format!("{KEYS}\nfriction_angle_deg = 31\n{softens}"), Law::DruckerPrager),
        (format!("{KEYS}\nfriction_angle_deg = 31\npore_pressure_ratio = 0.4"), Law::DruckerPrager),
        (CLAY.to_owned(), Law::VonMises),
        (format!("{CLAY}\nhardening_pa = 1e4\nviscosity_pa_s = 3"), Law::VonMises),
        (BEADS.to_owned(), Law::MuI),
        (format!("{BEADS}\nvoid_tracking = false"), Law::MuI),
    ] {
        let loaded = parse(&with_law(&keys), "flume.toml").unwrap_or_else(|e| panic!("{keys}: {e}"));
        let material = &loaded.case.materials["sand"];
        assert_eq!((material.law, &loaded.warnings), (law, &Vec::<String>::new()), "{keys}");
        assert!(law.flows());
        // The resolved case says what was left out, and is read again.
        let text = loaded.case.to_toml().expect("TOML");
        assert_eq!(parse(&text, "again.toml").unwrap_or_else(|e| panic!("{text}\n{e}")).case, loaded.case);
        match law {
            Law::VonMises => assert!(material.hardening_pa.is_some() && material.viscosity_pa_s.is_some()),
            _ => assert!(material.void_tracking.is_some()),
        }
        assert_eq!(material.cone.is_some(), law == Law::DruckerPrager);
    }
}

#[rustfmt::skip]
const OF_A_CONE: &[Bad] = &[
    ("law = \"drucker_prager\"", "law = \"mohr_coulomb\"", "cone = ", &["cone is not used by law = \"mohr_coulomb\"", "only with law = \"drucker_prager\""]),
    ("friction_angle_deg = 31", "friction_angle_deg = 31\nsoftening_strain = 0.1", "[materials.sand]", &["critical_friction_angle_deg is missing", "give both"]),
    ("friction_angle_deg = 31", "friction_angle_deg = 31\ncritical_friction_angle_deg = 30", "[materials.sand]", &["softening_strain is missing", "give both"]),
    ("friction_angle_deg = 31", "friction_angle_deg = 31\nsoftening_strain = 0.1\ncritical_friction_angle_deg = 32", "= 32", &["critical_friction_angle_deg <= friction_angle_deg = 31", "falls from the peak"]),
    ("friction_angle_deg = 31", "friction_angle_deg = 31\nsoftening_strain = 0\ncritical_friction_angle_deg = 30", "softening_strain = 0", &["softening_strain > 0"]),
    ("cone = \"triaxial_compression\"", "cone = \"as_printed\"\nsoftening_strain = 0.1\ncritical_friction_angle_deg = 30", "critical_friction_angle_deg = 30", &["not with cone = \"as_printed\""]),
    ("friction_angle_deg = 31", "friction_angle_deg = 31\npore_pressure_ratio = 1", "pore_pressure_ratio = 1", &["0 <= pore_pressure_ratio < 1", "nothing rubs"]),
    ("friction_angle_deg = 31", "friction_angle_deg = 31\nmu_s = 0.4", "mu_s = 0.4", &["mu_s is not used by law = \"drucker_prager\"", "use law = \"mu_i\""]),
    ("friction_angle_deg = 31", "friction_angle_deg = 31\nviscosity_pa_s = 4", "viscosity_pa_s = 4", &["viscosity_pa_s is not used", "only with law = \"von_mises\""]),
];

#[test]
fn keys_of_a_cone() {
    check(OF_A_CONE);
}

#[test]
fn numbers_of_other_laws() {
    for (keys, expected) in [
        ("law = \"mohr_coulomb\"".to_owned(), "friction_angle_deg is missing"),
        (MOHR.replace("31", "90"), "0 <= friction_angle_deg < 90"),
        (format!("{MOHR}\ndilatancy_angle_deg = 32"), "dilatancy_angle_deg <= friction_angle_deg = 31"),
        (format!("{MOHR}\ncohesion_pa = -1"), "cohesion_pa >= 0"),
        (format!("{MOHR}\npore_pressure_ratio = 0.3"), "pore_pressure_ratio is not used by law = \"mohr_coulomb\""),
        (format!("{MOHR}\nshear_strength_pa = 1"), "shear_strength_pa is not used by law = \"mohr_coulomb\""),
        ("law = \"von_mises\"".to_owned(), "shear_strength_pa is missing"),
        (CLAY.replace("2000", "0"), "shear_strength_pa > 0"),
        (format!("{CLAY}\nviscosity_pa_s = -1"), "viscosity_pa_s >= 0"),
        (format!("{CLAY}\nhardening_pa = -1"), "hardening_pa >= 0"),
        (format!("{CLAY}\nvoid_tracking = true"), "void_tracking is not used by law = \"von_mises\""),
        (format!("{CLAY}\nsoftening_strain = 0.1"), "softening_strain is not used by law = \"von_mises\""),
        (BEADS.replace("mu_s = 0.38", ""), "mu_s is missing"),
        (BEADS.replace("mu_2 = 0.64", ""), "mu_2 is missing"),
        (BEADS.replace("i_0 = 0.279", ""), "i_0 is missing"),
        (BEADS.replace("grain_diameter_m = 5.3e-4", ""), "grain_diameter_m is missing"),
        (BEADS.replace("grain_density_kg_per_m3 = 2450", ""), "grain_density_kg_per_m3 is missing"),
        (BEADS.replace("0.38", "-0.1"), "mu_s >= 0"),
        (BEADS.replace("0.64", "0.3"), "mu_s = 0.38 <= mu_2 < 1"),
        (BEADS.replace("0.64", "1"), "mu_s = 0.38 <= mu_2 < 1"),
        (BEADS.replace("0.279", "0"), "i_0 > 0"),
        (BEADS.replace("5.3e-4", "0"), "grain_diameter_m > 0"),
        (BEADS.replace("2450", "1400"), "density_kg_per_m3 = 1500 or more"),
        (format!("{BEADS}\ndilatancy_angle_deg = 5"), "dilatancy_angle_deg is not used by law = \"mu_i\""),
        (format!("{BEADS}\ncohesion_pa = 5"), "cohesion_pa is not used by law = \"mu_i\""),
    ] {
        let report = report_of(&with_law(&keys));
        assert!(report.contains(expected) && report.contains(" = fix: "), "no {expected:?} for\n{keys}\nin\n{report}");
    }
}

/// What flows is no structure: neither in implicit steps, nor by a mesh, nor with faces that a contact keeps.
#[test]
fn what_flows_is_no_structure() {
    let start = BARRIER.find("[materials.barrier]").unwrap_or_else(|| panic!("{BARRIER}"));
    let end = start + 1 + BARRIER[start + 1..].find("\n[").expect("another table");
    for keys in [MOHR, CLAY, BEADS] {
        let soft = format!("[materials.barrier]\n{keys}\ndensity_kg_per_m3 = 1500\nyoung_pa = 1e7\npoisson = 0.3\n");
        let text = format!("{}{soft}{}", &BARRIER[..start], &BARRIER[end..]);
        let report = report_of(&text);
        assert!(report.contains("would be the structure of the contact"), "{keys}\n{report}");
        for (key, expected) in [
            ("integration = \"implicit\"", "\"implicit\" only for an elastic law"),
            ("kinematics = \"total_lagrangian\"", "\"total_lagrangian\" only for a body with law = \"neo_hookean\""),
        ] {
            let text = text.replacen("name = \"barrier\"", &format!("name = \"barrier\"\n{key}"), 1);
            let report = report_of(&text);
            assert!(report.contains(expected), "{keys} {key}\n{report}");
        }
    }
}
