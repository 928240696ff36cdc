//! Shapes of bodies and terrain: what is accepted and what it means, and what is refused.

use super::{changed, report_of};
use crate::boundary::Friction;
use crate::case::{Case, Drawing, Shape, load, parse};

/// A block on a slope, in metres, of 2 cm cells.
const BLOCK: &str = r#"
title = "a body on terrain"
gravity = { inclination_deg = 0 }
grid = { spacing_m = 0.02, thickness_m = 0.5 }
domain = { x_m = [-1, 3], y_m = [-1, 2] }
materials.sand = { law = "linear_elastic", density_kg_per_m3 = 2000, young_pa = 1e6, poisson = 0.2 }
stages.run = { end_time_s = 1 }

[[bodies]]
name = "heap"
material = "sand"
SHAPE

[[boundaries]]
name = "bed"
kind = "polyline"
points_m = [[0, 0], [1, 0], [2, 0.5]]
contact = "coulomb"
friction = 0.4
"#;

const HEAP: &str = "polygon_m = [[0.1, 0], [1, 0], [1.4, 0.2], [0.6, 0.5]]";

fn with(shape: &str) -> String {
    BLOCK.replacen("SHAPE", shape, 1)
}

fn case(text: &str) -> Case {
    parse(text, "heap.toml").unwrap_or_else(|e| panic!("{e}")).case
}

/// Text of the shape of the body, what is changed in the case besides, words of the report.
type Bad = (&'static str, Option<(&'static str, &'static str)>, &'static [&'static str]);

#[rustfmt::skip]
const REFUSED: &[Bad] = &[
    ("", None, &["bodies[0] has no shape", "add x_m = ... and y_m"]),
    ("x_m = [0, 1]", None, &["bodies[0].y_m is missing", "required by x_m"]),
    ("y_m = [0, 1]", None, &["bodies[0].x_m is missing", "required by y_m"]),
    ("radius_m = 0.1", None, &["bodies[0].centre_m is missing", "required by radius_m"]),
    ("centre_m = [0.5, 0.3]", None, &["bodies[0].radius_m is missing"]),
    ("foot_m = [0.5, 0.3]\nheight_m = 0.2", None, &["bodies[0].thickness_m is missing"]),
    ("inclination_deg = 100", None, &["foot_m is missing", "height_m is missing"]),
    ("x_m = [0, 1]\ny_m = [0, 1]\nradius_m = 0.3", None, &["more than one shape", "remove radius_m"]),
    ("x_m = [0, 1]\ny_m = [0, 1]\nfoot_m = [0, 0]", None, &["more than one shape", "remove foot_m"]),
    ("polygon_m = [[0, 0.1], [1, 0.1]]", None, &["polygon_m has 2 corners", "3 to 1000"]),
    ("polygon_m = [[0, 0.1], [1, 0.1], [1]]", None, &["polygon_m[2] is not a pair"]),
    ("polygon_m = [[0, 0.1], [1, 0.1, 3], [1, 2]]", None, &["polygon_m[1] is not a pair"]),
    ("polygon_m = [[0, 0.1], [1, 1.1], [1, 0.1], [0, 1.1]]", None, &["sides from corner 0 and from corner 2 cross"]),
    ("polygon_m = [[0, 0.1], [1, 0.1], [0.5, 0.1]]", None, &["cross, touch or fold back"]),
    ("polygon_m = [[0, 0.1], [1, 0.1], [0.5, nan]]", None, &["a finite number"]),
    ("polygon_m = [[0, 0.1], [1, 0.1], [0.5, 0.105]]", None, &["thinner than a particle", "0.01 m"]),
    // A sliver, long enough both ways.
    ("polygon_m = [[0, 0.5], [1, 1.5], [1, 1.501]]", None, &["thinner than a particle"]),
    ("polygon_m = [[0, 0.1], [5, 0.1], [0.5, 0.5]]", None, &["reaches 2 m out of the domain"]),
    ("centre_m = [0.5, 0.3]\nradius_m = 0", None, &["radius_m = 0", "radius_m > 0"]),
    ("centre_m = [0.5, 0.3]\nradius_m = 0.2\ninner_radius_m = 0.2", None, &["less than radius_m = 0.2"]),
    ("centre_m = [0.5, 0.3]\nradius_m = 0.2\ninner_radius_m = 0.195", None, &["thinner than a particle"]),
    ("centre_m = [0.5, 0.1]\nradius_m = 0.2", None, &["overlaps boundary `bed` by 0.1 m"]),
    ("foot_m = [0.5, 0.3]\nheight_m = 0.2\nthickness_m = 0.1\nrotation_deg = 10", None, &["use inclination_deg"]),
    ("foot_m = [0.5, 0.3]\nheight_m = 0.2\nthickness_m = 0.001", None, &["thickness_m", "thinner than a particle"]),
    ("polygon_m = [[0.1, 0], [1, -0.1], [1.4, 0.2], [0.6, 0.5]]", None, &["overlaps boundary `bed` by 0.1 m"]),
    // Its corners are outside, its sides pass through the ground.
    ("polygon_m = [[-0.5, 0.2], [3, 0.9], [3, 1.5]]", Some(("[[0, 0], [1, 0], [2, 0.5]]", "[[0, 0], [1, 1], [2, 0]]")), &["overlaps boundary `bed`"]),
    (HEAP, Some(("spacing_m = 0.02", "spacing_m = 0.02, filling = \"square\"")), &["no rectangle", "filling = \"fitted\""]),
    ("polygon_m = [[0.1, 0], [1, 0], [1.4, 0.2], [0.6, 0.5]]\nmass_kg = 300", None, &["differs from density x area", "density_kg_per_m3 = "]),
    ("polygon_m = [[0.1, 0], [1, 0], [1.4, 0.2], [0.6, 0.5]]\nkinematics = \"total_lagrangian\"", None, &["no rectangle", "total_lagrangian"]),
    ("x_m = [0.1, 0.3]\ny_m = [0, 0.2]\nspin_rad_per_s = 2\nkinematics = \"total_lagrangian\"", None, &["spin_rad_per_s is given with kinematics"]),
    ("x_m = [0.1, 0.3]\ny_m = [0, 0.2]\nvelocity_gradient_per_s = [[1, 0]]", None, &["has 1 rows instead of two"]),
    ("polygon_file = \"heap.csv\"", None, &["is not read here", "polygon_m = [[X, Y], ...]"]),
    ("polygon_m = [[0.1, 0], [1, 0], [1.4, 0.2]]\npolygon_file = \"heap.csv\"", None, &["polygon_file and polygon_m are both given"]),
    // Terrain.
    (HEAP, Some(("points_m = [[0, 0], [1, 0], [2, 0.5]]", "")), &["points_m is missing", "kind = \"polyline\""]),
    (HEAP, Some(("[[0, 0], [1, 0], [2, 0.5]]", "[[0, 0]]")), &["points_m has 1 points"]),
    (HEAP, Some(("[[0, 0], [1, 0], [2, 0.5]]", "[[0, 0], [1, 0], [1, 0], [2, 0.5]]")), &["points 1 and 2 are the same"]),
    (HEAP, Some(("[[0, 0], [1, 0], [2, 0.5]]", "[[0, 0], [1, 0], [1, 1], [0.5, 1], [0.5, -1]]")), &["cross, touch or fold back"]),
    // The last piece goes on straight, into the first.
    (HEAP, Some(("[[0, 0], [1, 0], [2, 0.5]]", "[[0, 0], [1, 0], [1, 1], [0.9, 0.9]]")), &["cross, touch or fold back", "go on straight"]),
    (HEAP, Some(("[[0, 0], [1, 0], [2, 0.5]]", "[[0, -0.3], [0.5, -0.3], [0.5, -0.1], [0.54, -0.1], [0.54, -0.3], [2, -0.3]]")), &["the ground between pieces 1 and 3 is 0.04 m thick", "or a wall"]),
    (HEAP, Some(("[[0, 0], [1, 0], [2, 0.5]]", "[[0, -0.3], [0.5, -0.3], [0.55, -0.1], [0.6, -0.3]]")), &["blunt the tip"]),
    (HEAP, Some(("friction = 0.4", "friction = 0.4\nfriction_by_piece = [0.1, 0.2]")), &["are both given", "remove friction"]),
    (HEAP, Some(("friction = 0.4", "friction_by_piece = [0.1]")), &["has 1 numbers for 2 pieces"]),
    (HEAP, Some(("friction = 0.4", "friction_by_piece = [0.1, -0.2]")), &["friction_by_piece[1] = -0.2"]),
    (HEAP, Some(("contact = \"coulomb\"\nfriction = 0.4", "contact = \"rough\"\nfriction_by_piece = [0.1, 0.2]")), &["only with contact = \"coulomb\""]),
    (HEAP, Some(("friction = 0.4", "friction = 0.4\nslip_length_m = 0.001")), &["no slip length on a polyline"]),
    (HEAP, Some(("contact = \"coulomb\"\nfriction = 0.4", "contact = \"bonded\"")), &["clamps are planes and walls"]),
    (HEAP, Some(("friction = 0.4", "friction = 0.4\nheight_m = 2")), &["height_m = 2 does not belong to kind = \"polyline\""]),
    (HEAP, Some(("friction = 0.4", "friction = 0.4\npoints_file = \"bed.csv\"")), &["points_file and points_m are both given"]),
    (HEAP, Some(("friction = 0.4", "friction = 0.4\n[gauges]\nbase = \"bed\"")), &["is the base of the gauges", "momentum.csv"]),
    (HEAP, Some(("friction = 0.4", "friction = 0.4\n[gauges]\nbarrier = \"bed\"")), &["is the barrier of the gauges"]),
    (HEAP, Some(("friction = 0.4", "friction = 0.4\n[numerics]\nboundary_contact = \"nodes\"")), &["boundary_contact = \"surface\""]),
    (HEAP, Some(("friction = 0.4", "friction = 0.4\n[[boundaries]]\nname = \"floor\"\nkind = \"plane\"\npoint_m = [0, -0.5]\nnormal_deg = 90\ncontact = \"smooth\"")), &["boundary `floor` face the same way", "draw `floor` as pieces"]),
    (HEAP, Some(("friction = 0.4", "friction = 0.4\n[[boundaries]]\nname = \"wall\"\nkind = \"plane\"\npoint_m = [-0.5, 0]\nnormal_deg = 0\nfriction_by_piece = [0.1]\ncontact = \"smooth\"")), &["only with kind = \"polyline\""]),
];

#[test]
fn shapes_that_make_no_sense() {
    for (shape, change, words) in REFUSED {
        let mut text = with(shape);
        if let Some((from, to)) = change {
            assert!(text.contains(from), "{from}");
            text = text.replacen(from, to, 1);
        }
        let report = report_of(&text);
        assert!(report.contains("some/case.toml:"), "no place in\n{report}");
        for word in words.iter().chain(&[" = fix: "]) {
            assert!(report.contains(word), "no {word:?} for {shape} {change:?} in\n{report}");
        }
    }
}

/// Two bodies: whether they overlap.
#[test]
fn bodies_overlap_by_their_true_shape() {
    let beside = |other: &str| {
        let more = format!("{HEAP}\n\n[[bodies]]\nname = \"other\"\nmaterial = \"sand\"\n{other}");
        parse(&with(&more), "two.toml").err().map(|e| e.to_string())
    };
    // The heap is a quadrilateral with its crest at (0.6, 0.5): these lie in its box, beside it.
    for free in [
        "centre_m = [0.15, 0.4]\nradius_m = 0.15",
        "x_m = [1.1, 1.3]\ny_m = [0.35, 0.5]",
        "polygon_m = [[0.1, 0.05], [0.5, 0.5], [0.1, 0.5]]",
        "centre_m = [0.7, 0.25]\nradius_m = 1.6\ninner_radius_m = 1.0",
    ] {
        let told = beside(free).unwrap_or_default();
        assert!(!told.contains("overlaps body"), "{free}: {told}");
    }
    for overlapping in [
        "centre_m = [0.15, 0.4]\nradius_m = 0.3",
        "x_m = [0.5, 0.7]\ny_m = [0.2, 0.3]",
        "polygon_m = [[0.1, 0.05], [0.6, 0.4], [0.1, 0.5]]",
        "centre_m = [0.6, 0.2]\nradius_m = 0.4\ninner_radius_m = 0.3",
        "foot_m = [0.6, 0.45]\nheight_m = 0.3\nthickness_m = 0.1",
    ] {
        let told = beside(overlapping).unwrap_or_default();
        assert!(told.contains("overlaps body `heap`"), "{overlapping}: {told}");
    }
    // Disks and rings: beside each other, one in the hole of the other, and neither.
    let rings = |first: &str, second: &str| {
        let text = with(&format!("{first}\n\n[[bodies]]\nname = \"other\"\nmaterial = \"sand\"\n{second}"));
        parse(&text, "rings.toml").err().map(|e| e.to_string()).unwrap_or_default().contains("overlaps body")
    };
    let ring = "centre_m = [0.5, 0.9]\nradius_m = 0.5\ninner_radius_m = 0.3";
    assert!(!rings(ring, "centre_m = [0.6, 0.9]\nradius_m = 0.2"));
    assert!(!rings(ring, "centre_m = [1.3, 0.9]\nradius_m = 0.3"));
    assert!(
        rings(ring, "centre_m = [0.7, 0.9]\nradius_m = 0.2") && rings(ring, "centre_m = [1.2, 0.9]\nradius_m = 0.3")
    );
    assert!(!rings(ring, "x_m = [0.4, 0.6]\ny_m = [0.8, 1.0]") && rings(ring, "x_m = [0.4, 0.85]\ny_m = [0.8, 1.0]"));
}

/// A rectangle by its foot is the same as by its edges, on either side, to the last bit where the angle is a right one.
#[test]
fn a_body_by_its_foot() {
    let drawn = |shape: &str| case(&with(shape)).bodies[0].drawing().expect("a drawing").corners_m();
    let edges = drawn("x_m = [0.5, 0.6]\ny_m = [0.3, 0.7]");
    assert_eq!(drawn("foot_m = [0.5, 0.3]\nheight_m = 0.4\nthickness_m = 0.1")[0], edges[0]);
    let near = |a: &[[f64; 2]], b: &[[f64; 2]]| {
        a.len() == b.len() && a.iter().zip(b).all(|(p, q)| (p[0] - q[0]).hypot(p[1] - q[1]) < 1e-14)
    };
    assert!(near(&drawn("foot_m = [0.5, 0.3]\nheight_m = 0.4\nthickness_m = 0.1"), &edges));
    let right = "foot_m = [0.6, 0.3]\nheight_m = 0.4\nthickness_m = 0.1\nmaterial_side = \"right\"";
    assert!(near(&drawn(right), &edges));
    // Leaning back by 30 degrees: as a wall with the same words has it.
    let leaning = "foot_m = [0.5, 0.5]\nheight_m = 0.4\nthickness_m = 0.1\ninclination_deg = 60";
    let turned = drawn("x_m = [0.5, 0.6]\ny_m = [0.5, 0.9]\nrotation_deg = -30");
    assert!(near(&drawn(leaning), &turned));
    let wall = BLOCK.replacen("SHAPE", HEAP, 1)
        + &format!(
            "\n[[boundaries]]\nname = \"w\"\nkind = \"wall\"\ncontact = \"smooth\"\nbodies = [\"heap\"]\n{leaning}"
        );
    let wall = wall.replacen(
        "polygon_m = [[0.1, 0], [1, 0], [1.4, 0.2], [0.6, 0.5]]",
        "x_m = [0.1, 0.2]\ny_m = [0.1, 0.2]",
        1,
    );
    let Some(Shape::Wall(w)) = case(&wall).boundaries[1].shape(&case(&wall).grid) else { panic!("a wall") };
    let (mut of_wall, mut of_body) = (w.corners_m().to_vec(), turned);
    let by_place = |a: &[f64; 2], b: &[f64; 2]| a[0].total_cmp(&b[0]);
    of_wall.sort_by(by_place);
    of_body.sort_by(by_place);
    assert!(near(&of_wall, &of_body), "{of_wall:?} {of_body:?}");
}

/// Numbers of particles, areas, and the fastest place.
#[test]
fn what_a_case_says_of_its_shapes() {
    let disk = case(&with("centre_m = [0.5, 0.5]\nradius_m = 0.2\nspin_rad_per_s = 3\nvelocity_m_per_s = [1, 0]"));
    let area = std::f64::consts::PI * 0.04;
    assert!((disk.bodies[0].area_m2() - area).abs() < 1e-15);
    assert_eq!(disk.particle_count_estimate(), (area / 1e-4).round());
    // At the rim at least (1 + 3 x 0.2) m/s.
    let fastest = disk.bodies[0].fastest_m_per_s();
    assert!((1.6..1.9).contains(&fastest), "{fastest}");
    let square = case(&with("x_m = [0.5, 0.7]\ny_m = [0.5, 0.7]\nspin_rad_per_s = 3"));
    assert!((square.bodies[0].fastest_m_per_s() - 0.3 * 2f64.sqrt()).abs() < 1e-14);
    let sheared = case(&with("x_m = [0.5, 0.7]\ny_m = [0.5, 0.7]\nvelocity_gradient_per_s = [[0, 5], [0, 0]]"));
    assert_eq!(sheared.bodies[0].velocity_at([0.6, 0.7], [0.6, 0.6]).map(|v| (v * 1e9).round()), [0.5e9, 0.0]);
    assert!((sheared.bodies[0].fastest_m_per_s() - 0.5).abs() < 1e-14);
    // Each piece of a terrain has its friction, whichever way one walks.
    for (points, frictions, side) in
        [("[[0, 0], [1, 0], [2, 0.5]]", "[0.1, 0.2]", "left"), ("[[2, 0.5], [1, 0], [0, 0]]", "[0.2, 0.1]", "right")]
    {
        let own = format!("friction_by_piece = {frictions}\nmaterial_side = \"{side}\"");
        let text = with(HEAP).replacen("friction = 0.4", &own, 1).replacen("[[0, 0], [1, 0], [2, 0.5]]", points, 1);
        let loaded = case(&text);
        let Some(Shape::Terrain(chain)) = loaded.boundaries[0].shape(&loaded.grid) else { panic!("a terrain") };
        let rub = |x: [f64; 2]| chain.pieces()[chain.nearest(x).piece].friction;
        assert_eq!([rub([0.5, 0.1]), rub([1.5, 0.3])], [0.1, 0.2].map(Friction::Coulomb));
        assert!((chain.nearest([0.5, 0.1]).distance - 0.1).abs() < 1e-15);
    }
    // Either way round, from the same corner.
    let Some(Drawing::Polygon(p)) = case(&with("polygon_m = [[0.1, 0], [0.6, 0.5], [1, 0]]")).bodies[0].drawing()
    else {
        panic!("a polygon")
    };
    assert_eq!(p, [[0.1, 0.0], [1.0, 0.0], [0.6, 0.5]]);
}

/// Points come from a file beside the case, and the case that is written back has them.
#[test]
fn points_from_files() {
    let folder = std::env::temp_dir().join(format!("checkdam-points-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let text = with("polygon_file = \"heap.csv\"").replacen(
        "points_m = [[0, 0], [1, 0], [2, 0.5]]",
        "points_file = \"bed.csv\"",
        1,
    );
    std::fs::write(folder.join("case.toml"), &text).expect("a case");
    std::fs::write(folder.join("heap.csv"), "x_m,y_m\n0.1,0\n1,0\n1.4,0.2\n0.6,0.5\n").expect("points");
    let told = load(&folder.join("case.toml")).expect_err("no bed").to_string();
    assert!(told.contains("bed.csv cannot be read") && told.contains("points_file = \"bed.csv\""), "{told}");
    std::fs::write(folder.join("bed.csv"), "y_m,x_m\n0,0\n0,1\n0.5,2\n").expect("points");
    let loaded = load(&folder.join("case.toml")).unwrap_or_else(|e| panic!("{e}")).case;
    assert_eq!(loaded, case(&with(HEAP)));
    assert_eq!(case(&loaded.to_toml().expect("TOML")), loaded);
    std::fs::remove_dir_all(&folder).expect("a folder that can go");
}

/// The flume's keys are what they were.
#[test]
fn a_rectangle_needs_nothing_new() {
    let flume = parse(&changed("mass_kg = 30", ""), "flume.toml").expect("a case").case;
    let text = flume.to_toml().expect("TOML");
    for key in ["polygon", "centre", "radius", "spin", "gradient", "points", "by_piece"] {
        assert!(!text.contains(key), "{key}");
    }
}
