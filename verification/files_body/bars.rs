//! A bar that strikes a bar: the scene in its ways of reckoning, and what waves make of it.

use crate::Fault;
use checkdam::theory::elastic::Elastic;
use libm::{cos, sin};

pub(super) const H: f64 = 0.04;
pub(super) const WIDTH: f64 = 0.2;
pub(super) const HEIGHT: f64 = 0.08;
pub(super) const AREA: f64 = HEIGHT * WIDTH;
/// Free length of the barrier, and how much of it is in the clamp.
pub(super) const LENGTH: f64 = 0.8;
pub(super) const CLAMPED: f64 = 0.08;
pub(super) const STRIKER: f64 = 0.32;
pub(super) const SPEED: f64 = 0.3;
pub(super) const YOUNG: f64 = 1e6;
pub(super) const DENSITY: f64 = 1000.0;
/// About five a second.
pub(super) const PIC_FRACTION: f64 = 0.002;
pub(super) const MASS: f64 = DENSITY * STRIKER * AREA;
pub(super) const WAVES: &str = "characteristics (Saint-Venant 1867)";

/// How the barrier is reckoned.
pub struct Setting {
    /// Of the checks.
    pub name: &'static str,
    pub(super) law: &'static str,
    /// What stands in its line besides.
    extra: &'static str,
    pub(super) poisson: f64,
    pub(super) angle_deg: f64,
    /// Points a cell and direction.
    pub(super) per_cell: usize,
    /// Way before it is struck, m.
    pub(super) gap: f64,
}

const EXPLICIT: Setting =
    Setting { name: "pulse", law: "linear_elastic", extra: "", poisson: 0.0, angle_deg: 0.0, per_cell: 2, gap: 0.003 };

/// Explicit, by its mesh, implicit, turned on the grid.
pub const SETTINGS: [Setting; 4] = [
    EXPLICIT,
    Setting {
        name: "pulse, by its mesh",
        law: "neo_hookean",
        extra: ", kinematics = \"total_lagrangian\"",
        gap: 0.0,
        ..EXPLICIT
    },
    Setting { name: "pulse, implicit", extra: ", integration = \"implicit\"", poisson: 0.3, gap: 0.0, ..EXPLICIT },
    Setting { name: "pulse, turned", angle_deg: 30.0, per_cell: 3, gap: 0.0, ..EXPLICIT },
];

impl Setting {
    pub(super) fn turned(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let angle = self.angle_deg.to_radians();
        [cos(angle) * u - sin(angle) * v, sin(angle) * u + cos(angle) * v]
    }

    pub(super) fn implicit(&self) -> bool {
        self.extra.contains("implicit")
    }

    pub(super) fn elastic(&self) -> Elastic {
        Elastic { young: YOUNG, poisson: self.poisson }
    }

    pub(super) fn wave_speed(&self) -> f64 {
        (self.elastic().plane_strain() / DENSITY).sqrt()
    }

    /// When it is struck, s.
    pub(super) fn start(&self) -> f64 {
        self.gap / SPEED
    }

    /// Force on its face while the bars press on each other, N.
    pub(super) fn force(&self) -> f64 {
        0.5 * DENSITY * self.wave_speed() * SPEED * AREA
    }
}

/// The case.
pub fn text(s: &Setting, fault: &Fault) -> String {
    let corner = |u: f64, long: f64| {
        let [x, y] = s.turned([u, 0.0]);
        format!("x_m = [{x}, {}], y_m = [{y}, {}], rotation_deg = {}", x + long, y + HEIGHT, s.angle_deg)
    };
    let [vx, vy] = s.turned([SPEED, 0.0]);
    let [px, py] = s.turned([LENGTH, 0.0]);
    let (density, young, nu) = (DENSITY * fault.density, YOUNG * fault.modulus, s.poisson);
    format!(
        r#"title = "A bar strikes a bar"
gravity = {{ magnitude_m_per_s2 = 0, inclination_deg = 0 }}
grid = {{ spacing_m = {H}, thickness_m = {WIDTH} }}
domain = {{ x_m = [-0.6, 1.2], y_m = [-0.4, 0.8] }}
materials.striker = {{ law = "linear_elastic", density_kg_per_m3 = {density}, young_pa = {young}, poisson = {nu} }}
materials.bar = {{ law = "{law}", density_kg_per_m3 = {density}, young_pa = {young}, poisson = {nu} }}
bodies = [{{ name = "striker", material = "striker", {striker}, velocity_m_per_s = [{vx}, {vy}] }},
          {{ name = "bar", material = "bar", {bar}, particles_per_cell = {per_cell}{extra} }}]
boundaries = [{{ name = "clamp", kind = "plane", point_m = [{px}, {py}], normal_deg = {normal}, contact = "bonded", bodies = ["bar"] }}]
contacts = [{{ bodies = ["bar", "striker"], friction = {friction} }}]
stages.run = {{ end_time_s = {end}, stop_at_rest = false }}
gauges = {{ barrier = "bar", field_times_s = [0.0, {touch}, {end}] }}
output.vtk_interval_s = 0.01
numerics.pic_rate_per_s = 5
"#,
        law = s.law,
        striker = corner(-STRIKER - s.gap, STRIKER),
        bar = corner(0.0, LENGTH + CLAMPED),
        per_cell = s.per_cell * s.per_cell,
        extra = s.extra,
        normal = 180.0 + s.angle_deg,
        friction = 0.4 * fault.friction,
        end = s.start() + 0.06,
        touch = s.start() + 0.01,
    )
}

/// The first of them with PIC as a rate, and with the share of a step that this is.
pub fn pic_texts(fault: &Fault) -> [String; 2] {
    let rate = text(&SETTINGS[0], fault);
    let fraction = rate.replace("numerics.pic_rate_per_s = 5", &format!("numerics.pic_fraction = {PIC_FRACTION}"));
    [rate, fraction]
}
