//! Changes to the 40 degree case, one at a time, and what their reports must contain.

use super::{FLUME, changed, line_of, report_of};
use crate::case::parse;

/// Text to replace, by what, text on the line that must be reported (empty: the file as a whole), parts of the report.
pub type Bad = (&'static str, &'static str, &'static str, &'static [&'static str]);

/// All of them.
pub const ALL: [&[Bad]; 6] = [
    VALUES_OUT_OF_RANGE,
    NAN_AND_INFINITY_ANYWHERE,
    NAMES_AND_COMBINATIONS,
    GEOMETRY_AND_TIMES,
    SYNTAX_KEYS_AND_TYPES,
    ACCEPTED_BEFORE,
];

pub fn check(table: &[Bad]) {
    for (replace, by, at, contains) in table {
        let text = changed(replace, by);
        let report = report_of(&text);
        println!("{report}");
        let place = match *at {
            "" => "--> some/case.toml\n".to_owned(),
            at => format!("--> some/case.toml:{}:", line_of(&text, at)),
        };
        for expected in [place.as_str(), " = fix: "].iter().chain(*contains) {
            assert!(report.contains(expected), "no {expected:?} for {by:?} in\n{report}");
        }
    }
}

#[rustfmt::skip]
const VALUES_OUT_OF_RANGE: &[Bad] = &[
    ("poisson = 0.3", "poisson = -1", "poisson = -1", &["poisson = -1 is not allowed"]),
    ("mass_kg = 30", "mass_kg = -30", "mass_kg = -30", &["bodies[0].mass_kg = -30", "mass_kg > 0"]),
    ("mass_kg = 30", "mass_kg = 0", "mass_kg = 0", &["mass_kg > 0"]),
    ("_m3 = 1500", "_m3 = -1500", "-1500", &["density_kg_per_m3 = -1500", "use a positive value such as 1500"]),
    ("young_pa = 1.0e6", "young_pa = -1.0e6", "-1.0e6", &["young_pa = -1.0e6 is not allowed"]),
    ("spacing_m = 0.01", "spacing_m = 0", "spacing_m = 0", &["grid.spacing_m = 0 ", "spacing_m > 0"]),
    ("thickness_m = 0.2", "thickness_m = -0.2", "thickness_m = -0.2", &["grid.thickness_m = -0.2"]),
    ("angle_deg = 31", "angle_deg = 90", "angle_deg = 90\n", &["friction_angle_deg = 90", "0 <= friction_angle_deg < 90"]),
    ("angle_deg = 31", "angle_deg = 43", "= 43", &["friction_angle_deg = 43", "42.2", "cone = \"plane_strain\""]),
    ("dilatancy_angle_deg = 0", "dilatancy_angle_deg = 32", "= 32", &["<= friction_angle_deg = 31", "use 0"]),
    ("cohesion_pa = 0", "cohesion_pa = -5", "= -5", &["cohesion_pa = -5", "cohesion_pa >= 0"]),
    ("per_cell = 4", "per_cell = 5", "per_cell = 5", &["particles_per_cell = 5", "1, 4, 9 or 16", "use 4"]),
    ("mass_kg = 30", "particles_per_cell = 5", "per_cell = 5", &["bodies[0].particles_per_cell = 5", "use 4"]),
    ("x_m = [-0.4, 1.8]", "x_m = [1.8, -0.4]", "[1.8, -0.4]", &["swap the two: x_m = [-0.4, 1.8]"]),
    ("x_m = [-0.2, 0.0]", "x_m = [-0.2, -0.2]", "[-0.2, -0.2]", &["bodies[0].x_m", "low < high"]),
    ("cfl = 0.3", "cfl = 1.5", "cfl = 1.5", &["0 < cfl <= 1"]), ("pic_fraction = 5.0e-4", "pic_fraction = 2", "pic_fraction = 2", &["0 <= pic_fraction <= 1"]),
    ("residual = 1.0e-4", "residual = 0", "residual = 0", &["residual > 0"]),
    ("rate_hz = 1000", "rate_hz = 0", "rate_hz = 0", &["sample_rate_hz = 0"]),
    ("rate_hz = 1000", "rate_hz = 1e9", "rate_hz = 1e9", &["6.0e9", "or less"]),
    ("interval_s = 0.02", "interval_s = -1", "interval_s = -1", &["vtk_interval_s >= 0"]),
    ("friction = 0.0", "friction = -0.1", "friction = -0.1", &["side_walls.friction = -0.1"]),
    ("duration_s = 0.5", "duration_s = 0", "duration_s = 0", &["stages.tilt.duration_s"]),
    ("inclination_deg = 40", "inclination_deg = 140", "= 140", &["-90 <= inclination_deg <= 90"]),
    ("magnitude_m_per_s2 = 9.81", "magnitude_m_per_s2 = 0", "s2 = 0", &["nothing settles without gravity"]),
    ("height_m = 0.5", "height_m = 0", "height_m = 0\n", &["boundaries[2].height_m = 0"]),
];

#[rustfmt::skip]
const FRICTION_THAT_NEEDS_SLIP: &[Bad] = &[
    ("normal_deg = 90", "normal_deg = 90\nslip_length_m = 0.001", "slip_length_m = 0.001", &["boundaries[0].slip_length_m = 0.001", "contact on the surface", "boundary_contact = \"surface\""]),
    ("normal_deg = 90", "normal_deg = 90\nslip_length_m = -0.001", "slip_length_m = -0.001", &["slip_length_m >= 0"]),
    ("normal_deg = 90", "normal_deg = 90\nstatic_friction = 0.5", "static_friction = 0.5", &["boundaries[0].static_friction", "only with a slip length", "slip_length_m = 0.0005"]),
    ("normal_deg = 90", "normal_deg = 90\nstatic_friction = 0.3", "static_friction = 0.3", &["at least the kinetic coefficient, friction = 0.4"]),
    ("material_side = \"right\"", "material_side = \"right\"\nslip_length_m = 0.001", "slip_length_m = 0.001", &["boundaries[1].slip_length_m", "a contact other than \"coulomb\"", "remove the line"]),
    ("height_m = 0.5\ncontact = \"smooth\"", "height_m = 0.5\nslip_length_m = 0.001\nfriction = 0.1\ncontact = \"coulomb\"", "slip_length_m = 0.001", &["boundaries[2].slip_length_m", "planes and walls with slip"]),
];

#[test]
fn friction_that_needs_slip() {
    check(FRICTION_THAT_NEEDS_SLIP);
}

#[test]
fn values_out_of_range() {
    check(VALUES_OUT_OF_RANGE);
}

#[rustfmt::skip]
const NAN_AND_INFINITY_ANYWHERE: &[Bad] = &[
    ("young_pa = 1.0e6", "young_pa = nan", "nan", &["young_pa = nan is not allowed", "a finite number"]),
    ("[0.3, 0.5, 0.7", "[0.3, inf, 0.7", "inf, 0.7", &["gauges.stations_m[1] = inf"]),
    ("x_m = [-0.2, 0.0]", "x_m = [-inf, 0.0]", "-inf", &["bodies[0].x_m[0] = -inf"]),
    ("end_time_s = 6.0", "end_time_s = inf", "= inf", &["stages.run.end_time_s = inf"]),
    ("spacing_m = 0.01", "spacing_m = nan", "= nan", &["grid.spacing_m = nan"]),
    ("foot_m = [1.2, 0.0]", "foot_m = [nan, 0.0]", "[nan", &["boundaries[3].foot_m[0] = nan"]),
];

#[test]
fn nan_and_infinity_anywhere() {
    check(NAN_AND_INFINITY_ANYWHERE);
}

#[rustfmt::skip]
const NAMES_AND_COMBINATIONS: &[Bad] = &[
    ("material = \"sand\"", "material = \"snad\"", "\"snad\"", &["did you mean `sand`?"]),
    ("barrier = \"barrier\"", "barrier = \"barier\"", "\"barier\"", &["gauges.barrier", "did you mean `barrier`?"]),
    ("base = \"base\"", "base = \"floor\"", "\"floor\"", &["use one of `base`, `back wall`, `gate`, `barrier`"]),
    ("name = \"gate\"", "name = \"base\"", "name = \"base\"\nkind = \"gate\"", &["used twice", "boundaries[0]"]),
    ("name = \"sand\"", "name = \"\"", "name = \"\"", &["not empty"]),
    ("pic_fraction = 5.0e-4", "pic_rate_per_s = 1\npic_fraction = 0.1", "pic_rate", &["both given", "remove one"]),
    ("opening = \"vanish\"", "opening = \"raise\"", "[[boundaries]]\nname = \"gate\"", &["opening_m is missing"]),
    ("opening = \"vanish\"", "opening = \"lift\"", "[[boundaries]]\nname = \"gate\"", &["lift_speed_m_per_s is missing"]),
    ("opening = \"vanish\"", "opening_m = 0.1", "opening_m = 0.1", &["does not belong to opening = \"vanish\""]),
    ("thickness_m = 0.1\ncontact = \"coulomb\"", "opening = \"lift\"\ncontact = \"coulomb\"", "opening = \"lift\"", &["does not belong to kind = \"wall\""]),
    ("friction = 0.4", "#", "[[boundaries]]\nname = \"base\"", &["boundaries[0].friction is missing"]),
    ("contact = \"smooth\"", "contact = \"smooth\"\nfriction = 0.2 #", "friction = 0.2 #", &["friction = 0.2 does not belong", "contact = \"coulomb\""]),
    ("normal_deg = 90", "foot_m = [0, 0]", "foot_m = [0, 0]", &["normal_deg is missing", "foot_m = [0, 0] does not belong to kind = \"plane\""]),
    ("law = \"drucker_prager\"", "law = \"linear_elastic\"", "cohesion_pa", &["cohesion_pa is not used by law", "6 problems"]),
    ("friction_angle_deg = 31", "#", "[materials.sand]", &["friction_angle_deg is missing"]),
    ("window_y_m = [0.0, 0.6]", "#", "[gauges]", &["gauges.window_y_m is missing", "give both"]),
    ("[stages.tilt]", "[other]", "other", &["other is not a key"]), ("[stages.tilt]", "#", "duration_s", &["stages.settle.duration_s is not a key"]),
    ("settle_inclination_deg = 0", "settle_inclination_deg = 95", "= 95", &["settle_inclination_deg = 95"]),
];

#[test]
fn names_and_combinations() {
    check(NAMES_AND_COMBINATIONS);
    let without_tilt = changed("[stages.tilt]", "#").replacen("duration_s = 0.5", "#", 1);
    assert!(report_of(&without_tilt).contains("add [stages.tilt] or leave settle_inclination_deg out"));
}

#[rustfmt::skip]
const GEOMETRY_AND_TIMES: &[Bad] = &[
    ("x_m = [-0.2, 0.0]", "x_m = [-0.2, 0.05]", "[-0.2, 0.05]", &["body `sand` overlaps boundary `gate`", "use x_m = [-0.2, 0]"]),
    ("foot_m = [1.2, 0.0]", "foot_m = [-0.1, 0.0]", "x_m = [-0.2, 0.0]", &["overlaps boundary `barrier` by 0.1 m", "use x_m = [-0.2, -0.1]"]),
    ("y_m = [0.0, 0.5]", "y_m = [-0.01, 0.49]", "[-0.01, 0.49]", &["overlaps boundary `base` by 0.01 m", "use y_m = [0, 0.49]"]),
    ("mass_kg = 30", "rotation_deg = 10", "x_m = [-0.2, 0.0]", &["overlaps boundary `back wall`", "move the body by ["]),
    ("x_m = [-0.4, 1.8]", "x_m = [-0.1, 1.8]", "x_m = [-0.2, 0.0]", &["reaches 0.1 m out of the domain"]),
    ("y_m = [-0.1, 1.5]", "y_m = [-0.1, 0.4]", "y_m = [0.0, 0.5]", &["out of the domain", "window_y_m[1] = 0.6"]),
    ("[[boundaries]]", "[[bodies]]\nname = \"b\"\nmaterial = \"sand\"\nx_m = [-0.1, 0.0]\ny_m = [0.4, 0.6]\n[[boundaries]]", "y_m = [0.4, 0.6]", &["body `b` overlaps body `sand`", "use y_m = [0.5, 0.6]"]),
    ("0.9, 1.1]", "0.9, 11]", "0.9, 11]", &["gauges.stations_m[4] = 11", "inside the domain"]),
    ("window_x_m = [0.7, 1.2]", "window_x_m = [0.7, 12]", "12]", &["window_x_m[1] = 12"]),
    ("1.0, 1.5]", "1.5, 1.0]", "1.5, 1.0]", &["field_times_s[7] = 1.0", "the one before is 1.5", "sort"]),
    ("1.0, 1.5]", "1.0, 15]", "1.0, 15]", &["time <= stages.run.end_time_s = 6"]),
    ("mass_kg = 30", "mass_kg = 33", "mass_kg = 33", &["mass_kg = 33 differs", "30 kg", "density_kg_per_m3 = 1650", "y_m = [0, 0.55]"]),
    ("x_m = [-0.2, 0.0]", "x_m = [-0.2, -0.199]", "-0.199]", &["body `sand` is thinner than a particle", "grid.spacing_m = 0.002 or less"]),
    ("spacing_m = 0.01", "spacing_m = 2.0e-5", "2.0e-5", &["1.0e9 particles", "at most 2.0e7 particles", "spacing_m >= 0.00015", "8.8e9 grid cells", "use spacing_m = 0.00027 or more"]),
    ("end_time_s = 6.0", "end_time_s = 6.0e6", "6.0e6", &["time steps", "or less"]),
];

#[test]
fn geometry_and_times() {
    check(GEOMETRY_AND_TIMES);
    // A difference in mass below 0.1 % and an overlap by rounding are accepted.
    assert!(parse(&changed("mass_kg = 30", "mass_kg = 30.02"), "a").is_ok());
    assert!(parse(&changed("x_m = [-0.2, 0.0]", "x_m = [-0.2, 1.0e-12]"), "a").is_ok());
    // The suggested spacing is accepted.
    let fine = changed("spacing_m = 0.01", "spacing_m = 0.00027");
    assert!(parse(&fine, "a").is_ok());
}

#[rustfmt::skip]
const SYNTAX_KEYS_AND_TYPES: &[Bad] = &[
    ("poisson = 0.3", "poison = 0.3", "poison = 0.3", &["materials.sand.poison is not a key", "did you mean `poisson`?"]),
    ("friction = 0.4", "frction = 0.4", "frction", &["did you mean `friction`?"]),
    ("young_pa", "young", "young =", &["did you mean `young_pa`?"]),
    ("[gravity]", "[gravty]", "[gravty]", &["did you mean `gravity`?"]),
    ("poisson = 0.3", "#", "[materials.sand]", &["materials.sand.poisson is missing", "add poisson"]),
    ("title = ", "#", "", &["title is missing"]), ("poisson = 0.3", "poisson = \"0.3\"", "\"0.3\"", &["poisson = \"0.3\" is not allowed", "a number", "without quotes: 0.3"]),
    ("poisson = 0.3", "poisson = 0,3", "0,3", &["write decimals with a point"]),
    ("poisson = 0.3", "poisson = 0.3\npoisson = 0.2", "poisson = 0.2", &["duplicate key", "remove or rename"]),
    ("poisson = 0.3", "poisson = ", "poisson = ", &["write a value after the ="]),
    ("young_pa = 1.0e6", "young_pa = 1 MPa", "1 MPa", &["without a unit"]),
    ("poisson = 0.3", "poisson = .3", "poisson = .3", &["0.5"]), ("law = \"drucker_prager\"", "law = drucker_prager", "law = ", &["put text in double quotes"]),
    ("law = \"drucker_prager\"", "law = \"druker_prager\"", "druker", &["did you mean `drucker_prager`?"]),
    ("law = \"drucker_prager\"", "law = 5", "law = 5", &["double quotes"]),
    ("scheme = \"musl\"", "scheme = \"rk4\"", "rk4", &["\"usf\", \"usl\", \"musl\""]),
    ("[gravity]", "[gravity", "[gravity", &["close the bracket"]), ("name = \"gate\"", "name = \"gate", "name = \"gate", &["close the double quotes"]),
    ("per_cell = 4", "per_cell = -4", "per_cell = -4", &["a whole number, not negative"]),
    ("per_cell = 4", "per_cell = 4.0", "per_cell = 4.0", &["without a decimal point"]),
    ("at_rest = true", "at_rest = \"yes\"", "\"yes\"", &["write true or false"]),
    ("x_m = [-0.4, 1.8]", "x_m = [-0.4]", "[-0.4]", &["domain.x_m has 1 values", "two numbers"]),
    ("x_m = [-0.4, 1.8]", "x_m = [-0.4, 1, 2]", "[-0.4, 1, 2]", &["domain.x_m has 3 values"]),
    ("thickness_m = 0.2", "origin_m = [0.004, 0.0, 5.0]\nthickness_m = 0.2", "origin_m", &["grid.origin_m has 3 values", "two numbers"]),
    ("x_m = [-0.4, 1.8]", "x_m = 1.8", "x_m = 1.8", &["two numbers such as"]),
    ("[[bodies]]", "[bodies]", "[bodies]", &["write [[bodies]], with double brackets"]),
    ("[gravity]", "[[gravity]]", "[[gravity]]", &["write [gravity], with single brackets"]),
    ("[materials.sand]", "[materials]", "[materials]", &["materials has no named material", "[materials.sand] instead"]),
    ("title = ", "domain = [[0, 1], [0, 1]]\n#", "domain]", &["duplicate key"]),
    ("title = ", "title = 5 #", "title = 5", &["write \"5\""]), ("end_time_s = 6.0", "end_time_s = 12:00:00", "12:00", &["a number"]),
];

#[test]
fn syntax_keys_and_types() {
    check(SYNTAX_KEYS_AND_TYPES);
    // Serde would take the list for the one field of the table.
    let list = changed("title = ", "output = [0.02]\ntitle = ").replacen("[output]", "#", 1).replacen("vtk_", "#", 1);
    assert!(report_of(&list).contains("write [output], with single brackets"));
    assert!(report_of("").contains("title is missing"));
    assert!(report_of("# vtk DataFile Version 3.0\nframe\nASCII\n").contains("each line is key = value"));
    assert!(parse(&format!("\u{feff}{FLUME}"), "with a byte order mark").is_ok());
    let crlf = FLUME.replace('\n', "\r\n").replacen("poisson = 0.3", "poisson = 0.5", 1);
    assert!(report_of(&crlf).contains("poisson = 0.5"));
    assert!(!report_of(&crlf).contains('\r'));
}

#[rustfmt::skip]
const ACCEPTED_BEFORE: &[Bad] = &[
    ("name = \"back wall\"", "name = \"side walls\"", "side walls", &["boundaries[1].name = \"side walls\"", "no other column", "write \"side walls 1\""]),
    ("name = \"back wall\"", "name = \"Gravity\"", "Gravity", &["boundaries[1].name = \"Gravity\""]),
    ("name = \"back wall\"", "name = \"BASE\"", "BASE", &["letters and digits differ", "boundaries[0] is `base`"]),
    ("name = \"back wall\"", "name = \"back\\u001b[31m\"", "back\\u001b", &["without control characters", "write \"back[31m\""]),
    ("title = \"", "title = \"\\u0007", "title = ", &["without control characters"]),
    ("thickness_m = 0.1\ncontact = \"coulomb\"", "material_side = \"right\"\ncontact = \"coulomb\"", "material_side = \"right\"\ncontact = \"coulomb\"", &["looks away from all material", "use material_side = \"left\""]),
    ("duration_s = 0.5", "duration_s = 1e308", "1e308", &["stages.tilt.duration_s = 1e308", "1e30"]),
    ("duration_s = 0.5", "duration_s = 1e7", "1e7", &["1.0e11 time steps", "use duration_s = "]),
    ("max_time_s = 5.0", "max_time_s = 5e7", "5e7", &["stages.settle.max_time_s", "time steps"]),
    ("x_m = [-0.2, 0.0]", "x_m = [-1e308, 1e308]", "[-1e308", &["bodies[0].x_m[0] = -1e308", "check the unit"]),
    ("x_m = [-0.4, 1.8]", "x_m = [-0.4, 1e15]", "1e15", &["domain.x_m[1] = 1e15"]),
    ("x_m = [-0.4, 1.8]", "x_m = [-0.4, 1e8]", "1e8", &["1.0e10 cells away", "subtract a constant"]),
    ("height_m = 0.6\nthickness_m", "height_m = 1e8 # high\nthickness_m", "1e8 # high", &["1e6 cells", "use height_m = 10000 or less"]),
    ("barrier = \"barrier\"", "barrier = [\"barrier\"]", "[\"barrier\"]", &["one value, not a list", "without brackets: \"barrier\""]),
    ("x_m = [-0.2, 0.0]", "x_m = [-0.2, 0.00012345678]", "0.00012345678", &["overlaps boundary `gate`", "use x_m = [-0.2, 0]"]),
];

#[test]
fn what_was_accepted_before() {
    check(ACCEPTED_BEFORE);
    // All that is missing at the top, not only the first of it.
    let report = report_of("title = \"a\"\n[grid]\nspacing_m = 1\nthickness_m = 1\n");
    for key in ["gravity", "domain", "materials", "stages"] {
        assert!(report.contains(&format!("error: {key} is missing")), "{report}");
    }
    assert!(report.contains("4 problems"), "{report}");
    // Warnings stand beside errors.
    let both = changed("poisson = 0.3", "poisson = 0.6").replacen("friction = 0.4", "friction = 22", 1);
    let report = report_of(&both);
    assert!(
        report.contains("error: materials.sand.poisson") && report.contains("warning: boundaries[0].friction"),
        "{report}"
    );
}

/// As many keys that nobody knows as a file can hold, and as many of everything else that is compared with each other.
#[test]
fn long_files_are_refused_soon() {
    let start = std::time::Instant::now();
    let keys: String = (0..100_000).map(|k| format!("wrong_{k} = 1\n")).collect();
    let report = report_of(&FLUME.replacen("[gravity]", &format!("{keys}[gravity]"), 1));
    assert!(report.contains("wrong_0 is not a key") && report.len() < 100_000, "{}", report.len());
    let many: String = (0..30_000)
        .map(|k| {
            format!(
                "[[boundaries]]\nname = \"{k}\"\nkind = \"wall\"\nfoot_m = [0, 0]\nheight_m = 1\ncontact = \"rough\"\n"
            )
        })
        .collect();
    assert!(report_of(&format!("{FLUME}{many}")).contains("boundaries has 30004 elements"));
    let outside: String = (0..100_000).map(|k| format!("{}, ", k + 10)).collect();
    let report = report_of(&changed("stations_m = [0.3", &format!("stations_m = [{outside}0.3")));
    assert!(report.contains("100000 problems") && report.contains("the first 50"), "{}", report.len());
    assert!(start.elapsed().as_secs() < 30, "{:?}", start.elapsed());
}
