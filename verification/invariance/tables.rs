//! The rung's tables.

use super::judge::{Compared, worst};
use super::notes::Noted;
use super::scenes::Scene;
use super::{Done, base};
use crate::report::{number, quoted};
use checkdam::check::significant;

/// What a user reads first, of all numbers that are compared; the worst of a pair is shown besides.
const SHOWN: &[&str] = &[
    "stepping: settle_residual",
    "stepping: end_s",
    "scales: front_length_m",
    "scales: arrival_force_n",
    "barrier: arrival_s",
    "barrier: peak_step_n",
    "barrier: peak_20ms_n",
    "barrier: static_force_n",
    "barrier: static_moment_n_m",
    "barrier: impulse_normal_n_s",
    "barrier: run_up_m",
    "barrier: overtopped_kg",
    "barrier: elastic_impact_n",
    "structure: tip_max_m",
    "structure: peak_clamp_n",
    "deposit: weight_along_n",
    "deposit: base_friction_n",
    "energy: initial_j",
    "energy: released_j",
    "energy: plastic_1",
    "energy: kinetic_max_1",
    "energy: residual_of_released_1",
    "front 1: x_m",
    "front 1: velocity_m_per_s",
    "front 1: froude_1",
    "history.csv: force_normal_n",
    "history.csv: front_edge_x_m",
    "history.csv: kinetic_j",
];

/// Transformations that figures show: as many as can be told apart.
const DRAWN: [&str; 5] = [
    "mirrored",
    "moved by whole cells",
    "moved with the grid by broken cells",
    "turned by -90 degrees",
    "lengths x 10, equal Froude number",
];

/// Transformation, scene, quantity, before, after, difference, allowed, kind.
pub fn pairs(all: &[Done], noted: &[Noted]) -> String {
    let mut text = String::from("transformation,scene,quantity,before,after,difference,allowed,kind\n");
    for d in all {
        let worst = worst(&d.compared).filter(|c| c.difference > 0.0).map(|c| c.name.as_str());
        for c in d.compared.iter().filter(|c| SHOWN.contains(&c.name.as_str()) || Some(c.name.as_str()) == worst) {
            let cells = [
                quoted(d.name),
                d.scene.name().into(),
                quoted(&c.name),
                number(c.before),
                number(c.after),
                significant(c.difference, 2),
                significant(c.allowed, 2),
                d.near.name().into(),
            ];
            text.push_str(&cells.join(","));
            text.push('\n');
        }
    }
    for n in noted {
        let apart = significant((n.after - n.before).abs(), 2);
        let [name, quantity] = [n.transformation, n.name].map(quoted);
        let (before, after) = (number(n.before), number(n.after));
        text.push_str(&[&name, n.scene.name(), &quantity, &before, &after, &apart, "", "not judged"].join(","));
        text.push('\n');
    }
    text
}

/// Largest difference of the kinetic energy so far, over its largest, of each transformation with round-off and of a twin.
pub fn growth(all: &[Done]) -> String {
    let mut text = String::from("scene,transformation,time_s,difference_1\n");
    for scene in Scene::ALL {
        let base = base(scene);
        let own = all.iter().filter(|d| d.scene == scene && DRAWN.contains(&d.name));
        let runs = own.filter_map(|d| d.pair.as_ref()).map(|(p, after)| (p.name, p.factors.of("_j"), after));
        let twin = base.twins.first().map(|t| ("points elsewhere by 1e-11 of their distance", 1.0, t));
        for (name, factor, after) in twin.into_iter().chain(runs) {
            let [time, before] = ["history.csv: time_s", "history.csv: kinetic_j"].map(|n| base.reading.column(n));
            let after = after.column("history.csv: kinetic_j");
            let most = before.iter().copied().fold(0.0, f64::max);
            let mut so_far = 0.0f64;
            for (k, ((t, a), b)) in time.iter().zip(before).zip(after).enumerate() {
                so_far = so_far.max((b / factor - a).abs() / most);
                if (k + 1) % 20 == 0 {
                    let cells = [scene.name().into(), quoted(name), significant(*t, 4), significant(so_far, 2)];
                    text.push_str(&cells.join(","));
                    text.push('\n');
                }
            }
        }
    }
    text
}

/// Difference over what is allowed, the worst numbers first.
pub fn ranks(all: &[Done]) -> String {
    let mut text = String::from("scene,transformation,rank_1,used_1\n");
    for d in all.iter().filter(|d| DRAWN.contains(&d.name)) {
        let mut shares: Vec<f64> = d.compared.iter().map(Compared::share).collect();
        shares.sort_by(|a, b| b.total_cmp(a));
        for (k, share) in shares.iter().enumerate().filter(|(k, _)| k % 4 == 0) {
            let cells = [d.scene.name().into(), quoted(d.name), (k + 1).to_string(), significant(*share, 2)];
            text.push_str(&cells.join(","));
            text.push('\n');
        }
    }
    text
}
