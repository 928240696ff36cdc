use super::transform::{Factors, moved, scaled, turned};
use super::*;

/// How a transformation that is done wrongly is judged, by the transformation of this name.
fn judged(name: &str, wrongly: impl Fn(&Case, &mut Pair)) -> (f64, String) {
    let case = &base(Scene::Flume).case;
    let mut pair = pairs(Scene::Flume, case).into_iter().find(|p| p.name == name).unwrap_or_else(|| panic!("{name}"));
    wrongly(case, &mut pair);
    let seen = run_pair(&pair);
    let done = Done::new(Scene::Flume, pair, seen);
    let worst = worst(&done.compared).expect("numbers");
    assert_eq!(done.check().passes(), worst.share() <= 1.0);
    (worst.share(), worst.name.clone())
}

#[test]
fn every_scene_and_its_transformations_are_cases() {
    for scene in Scene::ALL {
        let case = &base(scene).case;
        for (name, case) in pairs(scene, case).iter().map(|p| (p.name, &p.case)).chain([("as it is", case)]) {
            let problems = checkdam::case::validate(case).problems;
            assert!(problems.is_empty(), "{} {name}: {problems:?}", scene.name());
        }
        assert!(base(scene).reading.number("barrier: peak_step_n") > 100.0, "it strikes");
    }
}

#[test]
fn gravity_turned_by_a_degree_less_is_seen() {
    let (share, _) = judged("turned by -90 degrees", |case, pair| {
        pair.case = turned(case, -90.0);
        pair.case.gravity.inclination_deg += 1.0;
    });
    assert!(share > 1e3, "{share}");
}

#[test]
fn stiffness_that_is_scaled_by_three_percent_too_much_is_seen() {
    let (share, _) = judged("lengths x 10, equal Froude number", |_, pair| {
        pair.case.materials.values_mut().for_each(|m| m.young_pa *= 1.03);
    });
    assert!(share > 1e3, "{share}");
}

#[test]
fn a_metre_or_a_newton_in_a_gauge_is_seen() {
    let four = Factors::froude(4.0);
    let of_case = |case: &Case| {
        let scales = &base(Scene::Flume).reading;
        let mut case = scaled(case, &four);
        case.gauges.front_length_m = Some(scales.number("scales: front_length_m"));
        case
    };
    let (share, name) = judged("lengths x 4, equal Froude number", |case, pair| pair.case = of_case(case));
    assert!(share.is_infinite(), "{share} {name}");
    let (share, name) =
        judged("lengths x 4, equal Froude number", |_, pair| pair.case.gauges.arrival_force_n = Some(0.49));
    assert!(share.is_infinite(), "{share} {name}");
}

#[test]
fn the_place_of_a_node_is_seen() {
    let (share, _) = judged("moved with the grid by broken cells", |case, pair| {
        let h = case.grid.spacing_m;
        pair.case = moved(case, [3.37 * h, -1.21 * h], true);
        pair.case.grid.origin_m[0] += 0.03 * h;
    });
    assert!(share > 1e3, "{share}");
}

#[test]
fn an_origin_in_an_energy_and_the_length_of_a_row_in_a_mean_are_seen() {
    let scene = base(Scene::Flume);
    let find = |name: &str| pairs(Scene::Flume, &scene.case).into_iter().find(|p| p.name == name).expect("a pair");
    let share = |pair: Pair, seen: Reading| {
        let done = Done::new(Scene::Flume, pair, seen);
        worst(&done.compared).map_or(0.0, Compared::share)
    };
    // Above the origin, and not above the level of the barrier's foot.
    let pair = find("moved by whole cells");
    let mut seen = run_pair(&pair);
    let lift = -7.0 * scene.case.grid.spacing_m * 40f64.to_radians().cos() * 9.81 * 30.0;
    for (_, x) in seen.summary.iter_mut().filter(|q| q.0 == "energy: initial_j") {
        *x += lift;
    }
    assert!(share(pair, seen) > 1e3);
    // What has a name, taken from the rows of the tables.
    let pair = find("names, rows of tables, threads");
    let seen = run_pair(&pair);
    let by_rows = Reading { summary: seen.by_rows.clone(), ..seen };
    assert!(share(pair, by_rows).is_infinite());
}
