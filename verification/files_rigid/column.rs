//! Closed forms of a column that yields and dilates under its weight between smooth walls.

use super::judge::{Judge, within};
use super::setting::{Point, Setting, at};
use super::statics::{EQUILIBRIUM, VIRIAL, WAVES, integral, last, sum};
use crate::from_file::{Files, largest};
use crate::report::table_csv;
use checkdam::theory::drucker_prager as theory;

/// The cone of the column and what its state is below a weight.
struct Oedometer {
    poisson: f64,
    bulk: f64,
    shear: f64,
    /// Slopes of the cone and of the potential, strength without pressure (Pa).
    cone: f64,
    flow: f64,
    strength: f64,
}

impl Oedometer {
    fn new(set: &Setting) -> Self {
        let material = |key: &str| at(&set.case, &format!("materials.sand.{key}")).unwrap_or(f64::NAN);
        let [friction, dilatancy] = ["friction_angle_deg", "dilatancy_angle_deg"].map(|k| material(k).to_radians());
        let cone = theory::inner_slope(friction);
        // The apex is that of Mohr-Coulomb.
        let strength = cone * material("cohesion_pa") * libm::cos(friction) / libm::sin(friction);
        let [bulk, shear] = set.bodies[0].moduli();
        Self { poisson: set.bodies[0].poisson, bulk, shear, cone, flow: theory::inner_slope(dilatancy), strength }
    }

    /// Plastic multiplier where lateral strain is none, of a mean stress and the difference of lateral and vertical stress, Pa.
    fn multiplier(&self, mean: f64, difference: f64) -> f64 {
        -(mean / (3.0 * self.bulk) + difference / (6.0 * self.shear)) / (self.flow / 3.0 + 0.5 / 3f64.sqrt())
    }

    /// Lateral stress (Pa, compression positive) and volume strain under a weight (Pa): elastic, or on the cone where that presses more.
    fn under(&self, weight: f64) -> (f64, f64) {
        let root = 3f64.sqrt();
        let elastic = self.poisson / (1.0 - self.poisson) * weight;
        let cone = (weight * (1.0 / root - self.cone / 3.0) - self.strength) / (1.0 / root + 2.0 * self.cone / 3.0);
        let lateral = elastic.max(cone);
        let mean = -(weight + 2.0 * lateral) / 3.0;
        let multiplier = if cone > elastic { self.multiplier(mean, weight - lateral) } else { 0.0 };
        (lateral, mean / self.bulk + self.flow * multiplier)
    }
}

/// Stress over height, of the points beside the left wall.
pub fn profile(set: &Setting, files: &Files) -> String {
    let (law, body) = (Oedometer::new(set), &set.bodies[0]);
    let mut points: Vec<Point> = last(set, files).into_iter().filter(|p| p.x[0] < 0.5 * p.spacing * 1.5).collect();
    points.sort_by(|a, b| a.x[1].total_cmp(&b.x[1]));
    let rows = points.iter().map(|p| {
        let weight = body.density * set.gravity * (body.size()[1] - p.x[1]).max(0.0);
        vec![p.x[1], -p.stress[1], weight, -p.stress[0], law.under(weight).0]
    });
    table_csv(&["height_m", "vertical_pa", "vertical_exact_pa", "lateral_pa", "lateral_exact_pa"], rows)
}

pub fn judge(set: &Setting, files: &Files, judge: &mut Judge) {
    let (body, g, law) = (&set.bodies[0], set.gravity, Oedometer::new(set));
    let root = 3f64.sqrt();
    let (mut force, mut moment, mut y) = (0.0, 0.0, 0.0);
    let slices = 2000;
    let d = body.size()[1] / f64::from(slices);
    for i in 0..slices {
        let (h, strain) = law.under(body.density * g * (body.size()[1] - (f64::from(i) + 0.5) * d));
        let now = d * (1.0 + strain);
        force += h * now * set.width;
        moment += h * now * set.width * (y + 0.5 * now);
        y += now;
    }
    let why = "stress is the same within a cell: that of its middle, on a column of twelve cells; the surface cell is a hundredth of the force";
    let source = "oedometric state of a cone: Drucker and Prager 1952, Jaky 1944";
    let number = |key: &str| files.number(key);
    for key in ["barrier", "further_barriers.0.barrier"] {
        let name = key.rsplit('.').next().unwrap_or(key);
        judge.closed(
            &format!("column: {name}.static_force_n"),
            number(&format!("{key}.static_force_n")),
            force,
            "N",
            within(5e-3, why, source),
        );
        judge.closed(
            &format!("column: {name}.static_moment_n_m"),
            number(&format!("{key}.static_moment_n_m")),
            moment,
            "N m",
            within(1e-2, why, source),
        );
        for layer in 1..=3 {
            let what = format!("static_layer{layer}_n");
            judge.closed(
                &format!("column: {name}.{what}"),
                number(&format!("{key}.{what}")),
                force,
                "N",
                within(1e-2, why, source),
            );
        }
    }
    let base = files.column("history.csv", "base_normal_n").last().copied().unwrap_or(f64::NAN);
    judge.closed("column: history.csv base_normal_n", base, set.mass() * g, "N", within(3e-4, WAVES, EQUILIBRIUM));
    let points = last(set, files);
    let yielded: Vec<Point> = points.iter().filter(|p| p.shear > 0.0).copied().collect();
    let made = |of: &dyn Fn(&Point) -> f64| yielded.iter().map(of).collect::<Vec<_>>();
    judge.same(
        "column: points on the cone",
        &made(&Point::tau),
        &made(&|p| law.strength - law.cone * p.mean()),
        within(1e-3, "waves of 3e-4 of the stress unload a point below the cone", "Drucker and Prager 1952"),
    );
    judge.same(
        "column: stress along x and z",
        &made(&|p| p.stress[0]),
        &made(&|p| p.stress[2]),
        within(1e-6, "the same confinement", "symmetry"),
    );
    // Plastic shear strain is a root of three less than the multiplier.
    let small = "strains of 3e-3 squared over themselves";
    let mean = |of: &dyn Fn(&Point) -> f64| made(of).iter().sum::<f64>() / yielded.len() as f64;
    judge.closed(
        "column: strength without pressure",
        mean(&|p| p.tau() + law.cone * p.mean()),
        law.strength,
        "Pa",
        within(
            0.01,
            "waves of 3e-4 of a stress that is ten times the strength, on a mean of a hundred points",
            "cohesion: the apex of Mohr and Coulomb",
        ),
    );
    judge.closed(
        "column: volume gained over plastic shear",
        mean(&|p| libm::log(p.ratio) - p.mean() / law.bulk) / mean(&|p| root * p.shear),
        law.flow,
        "1",
        within(1e-3, "logarithmic strains add up", "slope of the potential, from the dilatancy angle"),
    );
    judge.same(
        "column: volume ratio against stress and dilatancy",
        &made(&|p| p.ratio - 1.0),
        &made(&|p| p.mean() / law.bulk + law.flow * root * p.shear),
        within(5e-3, small, "volume gained is the slope of the potential times the multiplier"),
    );
    let lateral = |p: &Point| law.multiplier(p.mean(), p.stress[0] - p.stress[1]) / root;
    judge.same(
        "column: plastic shear strain where lateral strain is none",
        &made(&|p| p.shear),
        &made(&lateral),
        within(1e-2, small, source),
    );
    let wall = body.size()[0];
    let x = files.column("history.csv", "force_normal_n").last().copied().unwrap_or(f64::NAN);
    judge.closed(
        "column: volume integral of stress xx",
        integral(&points, 0),
        -x * wall,
        "J",
        within(2e-3, "exact for linear velocities", VIRIAL),
    );
    let height = sum(&points, |p| -p.mass * g * p.x[1]);
    judge.closed(
        "column: volume integral of stress yy",
        integral(&points, 1),
        height,
        "J",
        within(5e-4, WAVES, VIRIAL),
    );
    judge.at_most(
        "column: opened strain",
        largest(points.iter().map(|p| p.opened)),
        0.0,
        "nothing came apart under compression",
    );
    judge.at_most(
        "column: not trusted",
        f64::from(u8::from(files.flag("trusted") != Some(true))),
        0.0,
        "nothing is wrong with it",
    );
}
