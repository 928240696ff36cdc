//! The same block against the same wall, once a boundary and once a body that is clamped as a whole: boundary gauge against body gauge,
//! sample by sample, while the wave runs through the block. What the fixed body gets, its clamp has at once.

use super::barrier::{Worst, largest, mean_where};
use crate::Fault;
use crate::from_file::Files;
use checkdam::check::{Check, Kind, Tolerance};

const H: f64 = 0.05;
const WIDTH: f64 = 0.2;
const FRICTION: f64 = 0.3;
const SPEED: f64 = 0.3;
/// The wave is back in the block after 36 ms.
const END: f64 = 0.033;

/// The case, with the wall as a boundary and as a body.
pub fn texts(fault: &Fault) -> [String; 2] {
    let friction = FRICTION * fault.friction;
    let boundary = format!(
        "{{ name = \"wall\", kind = \"wall\", foot_m = [0.0, -0.1], height_m = 0.5, thickness_m = 0.2, contact = \"coulomb\", friction = {friction}, bodies = [\"block\"] }}"
    );
    let clamp = "{ name = \"clamp\", kind = \"plane\", point_m = [0.0, 0], normal_deg = 180, contact = \"bonded\", bodies = [\"wall\"] }";
    let body = ", { name = \"wall\", material = \"block\", x_m = [0.0, 0.1], y_m = [-0.1, 0.4] }";
    let contact = format!("contacts = [{{ bodies = [\"wall\", \"block\"], friction = {friction} }}]");
    [("", boundary.as_str(), ""), (body, clamp, contact.as_str())].map(|(body, wall, contacts)| {
        format!(
            r#"title = "A block against a wall"
gravity = {{ magnitude_m_per_s2 = {g}, inclination_deg = 30 }}
grid = {{ spacing_m = {H}, thickness_m = {WIDTH} }}
domain = {{ x_m = [-0.6, 0.4], y_m = [-0.3, 0.6] }}
materials.block = {{ law = "linear_elastic", density_kg_per_m3 = {density}, young_pa = {young}, poisson = 0 }}
bodies = [{{ name = "block", material = "block", x_m = [-0.4, 0.0], y_m = [0.0, 0.2], velocity_m_per_s = [{SPEED}, 0] }}{body}]
boundaries = [{{ name = "base", kind = "plane", point_m = [0, 0], normal_deg = 90, contact = "smooth", bodies = ["block"] }}, {wall}]
{contacts}
stages.run = {{ end_time_s = {END}, stop_at_rest = false }}
gauges = {{ barrier = "wall", base = "base", field_times_s = [0.0, {END}] }}
output.vtk_interval_s = 0.011
numerics.pic_rate_per_s = 20
"#,
            g = 10.0 * fault.gravity,
            density = 1000.0 * fault.density,
            young = 5e5 * fault.modulus,
        )
    })
}

const COLUMNS: [&str; 10] = [
    "force_normal_n",
    "force_tangential_n",
    "overturning_moment_n_m",
    "force_normal_max_n",
    "force_layer1_n",
    "force_layer2_n",
    "force_layer3_n",
    "run_up_m",
    "run_up_p95_m",
    "base_normal_n",
];

/// What must hold between both.
pub fn judge(files: &[Files]) -> Vec<Check> {
    let [boundary, body] = files else { return Vec::new() };
    let mut checks = Vec::new();
    let mut worst = Worst::default();
    let of = |files: &Files, name: &str| files.column("history.csv", name);
    for name in COLUMNS {
        let [a, b] = [boundary, body].map(|f| of(f, name));
        worst.lists(&b, &a, largest(&a));
    }
    let [a, b] = [boundary, body].map(|f| f.column("pressure_profile.csv", "pressure_pa"));
    worst.lists(&b, &a, largest(&a));
    for key in [
        "peak_step_n",
        "peak_20ms_n",
        "peak_20ms_by_steps_n",
        "static_force_n",
        "peak_moment_n_m",
        "impulse_normal_n_s",
    ] {
        let [a, b] = [boundary, body].map(|f| f.number(&format!("barrier.{key}")));
        worst.number(b, a, a);
    }
    checks.push(worst.check(
        "wall as a boundary and as a body: every column of forces, sample by sample, over its largest",
        1e-6,
        "both hold the same nodes by the same law while the block is pressed: round-off, nine digits",
        Kind::Conservation,
        "the same wall",
    ));
    let mut worst = Worst::default();
    let column = |name: &str| body.column("barrier.csv", name);
    let scale = largest(&column("contact_normal_n"));
    for part in ["normal", "tangential"] {
        let [contact, clamp] = ["contact", "clamp"].map(|of| column(&format!("{of}_{part}_n")));
        // The weight of the body goes into its clamp at once.
        let own = 1000.0 * 0.1 * 0.5 * WIDTH * 10.0;
        let weight = if part == "normal" { 0.5 * own } else { -own * 0.75f64.sqrt() };
        let expected: Vec<f64> = contact.iter().map(|c| c + weight).collect();
        worst.lists(&clamp, &expected, scale);
    }
    checks.push(worst.check(
        "fixed body: clamp less contact and weight, sample by sample, over the largest contact force",
        3e-6,
        "nothing of it moves: nine digits",
        Kind::Conservation,
        "Newton's second and third law",
    ));
    let c = (5e5f64 / 1000.0).sqrt();
    let force = 1000.0 * c * SPEED * 0.2 * WIDTH;
    let (time, normal) = (of(body, "time_s"), of(body, "force_normal_n"));
    // While the wave runs gravity adds m g sin t.
    let mean = mean_where(&time, &normal, |t| t > 0.005 && t < 0.03);
    let added = 1000.0 * c * 10.0 * 0.5 * 0.0175 * 0.2 * WIDTH;
    checks.push(
        Check::value("fixed body: mean force while the wave runs", mean, force + added, "N")
            .within(Tolerance::Relative(0.03), "strains of 1 %, and ripples of a front on eight cells")
            .from(Kind::Analytic, "rho c (v + g t sin) A: Saint-Venant 1867, with gravity along the bar"),
    );
    checks
}
