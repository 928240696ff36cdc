//! The case file: everything a user can write, one struct per TOML table.
//!
//! Field names are the keys of the file and end in their unit. The structs say what a key means and what it is when left
//! out; whether a value makes sense is decided in [`validate`](super::validate). Unknown keys are refused everywhere.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::boundary::{Boundary, MaterialSide};
use super::contact::BodyContact;
use super::gauges::Gauges;
use super::grid::{Domain, Filling, Grid};
use super::inflow::Inflow;
use super::material::Material;
use crate::boundary::BoundaryContact;
use crate::simulation::{OpenedVolume, PicShare, Scheme};

/// Most particles a case may have; above this it is refused before any memory is asked for.
pub const MAX_PARTICLES: f64 = 2.0e7;
/// Most points of a polygon or a polyline: each of its pieces is compared with each of the others.
pub const MAX_POINTS: usize = 1000;
/// Most grid cells the domain may hold.
pub const MAX_GRID_CELLS: f64 = 5.0e7;
/// Most time steps a run may take.
pub const MAX_TIME_STEPS: f64 = 1.0e9;

/// A complete case: what is simulated, how it is measured and with which numerical settings.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// One line that names the case in reports and plots. Allowed: any text. Example: `"Sand against a wall"`.
    pub title: String,
    /// Gravity and the inclination of the flume.
    pub gravity: Gravity,
    /// Background grid and the number of particles per cell.
    pub grid: Grid,
    /// The box outside which material is removed.
    pub domain: Domain,
    /// Materials by name; bodies refer to them. At least one.
    pub materials: BTreeMap<String, Material>,
    /// What there is at the start. Left out: nothing but inflows. At most 2e7 particles together with these.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<Body>,
    /// Flows that enter through a section during the run. Left out: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub inflows: Vec<Inflow>,
    /// Rigid planes, walls and gates.
    #[serde(default)]
    pub boundaries: Vec<Boundary>,
    /// Contacts of bodies that slide on each other or part. Left out: all bodies stick together where they meet.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub contacts: Vec<BodyContact>,
    /// Friction of the channel's side walls.
    #[serde(default)]
    pub side_walls: SideWalls,
    /// Settling, tilting and the run itself.
    pub stages: Stages,
    /// What is measured.
    #[serde(default)]
    pub gauges: Gauges,
    /// Files written besides the results.
    #[serde(default)]
    pub output: Output,
    /// Numerical settings.
    #[serde(default)]
    pub numerics: Numerics,
}

/// Gravity, in the frame of the flume: x runs down the bed, y is perpendicular to it.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Gravity {
    /// Magnitude. Default: `9.81`. Allowed: 0 or more; above 0 with `[stages.settle]`. Example: `9.81`.
    #[serde(default = "default_gravity_magnitude")]
    pub magnitude_m_per_s2: f64,
    /// Angle of the x axis below the horizontal during the run. Allowed: -90 to 90. Example: `40`.
    pub inclination_deg: f64,
    /// The same angle while the material settles. Default: that of `inclination_deg`. Allowed: -90 to 90; another than
    /// `inclination_deg` only with `[stages.tilt]`. Example: `0`.
    pub settle_inclination_deg: Option<f64>,
}

/// A body of one material at the start: a rectangle, a polygon, a disk or a ring.
///
/// It is written in one of four ways: `x_m` and `y_m`; `foot_m`, `height_m` and `thickness_m` as a wall; `polygon_m`; `centre_m` and
/// `radius_m`. In a rectangle particles sit on a lattice in its axes, the first one half a spacing inside its lower left corner. The
/// spacing is h / sqrt(particles per cell), or the nearest to it that fills the side, so that the particles carry the mass of
/// the rectangle and end where it ends; `grid.filling = "square"` leaves it at the former. Other shapes are cut into pieces of one area,
/// whose number comes nearest to that spacing, and each piece has a particle at its centre.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Name. Allowed: not empty, and different from that of every other body. Example: `"sand"`.
    pub name: String,
    /// Name of its material. Allowed: the name of one of `[materials.NAME]`. Example: `"sand"`.
    pub material: String,
    /// Left and right edge before rotation. Default: none; a body has one shape. Allowed: `[low, high]` with low < high; the body inside
    /// the domain, outside boundaries that act on it (but clamps) and other bodies, or touching them. Example: `[-0.2, 0.0]`.
    pub x_m: Option<[f64; 2]>,
    /// Lower and upper edge before rotation. Default: none; required by `x_m`. Allowed: as `x_m`; both sides at least the spacing of the
    /// particles. Example: `[0.0, 0.5]`.
    pub y_m: Option<[f64; 2]>,
    /// Corners of a polygon, in order either way round. Default: none. Allowed: 3 to 1000 pairs `[x, y]`; sides that neither cross nor
    /// touch; at least a spacing of the particles wide and high, and no sliver. Example: `[[0.0, 0.0], [0.4, 0.0], [0.1, 0.3]]`.
    pub polygon_m: Option<Vec<[f64; 2]>>,
    /// CSV file that has the corners of the polygon, in columns `x_m` and `y_m` under these names; relative to the case file. Default:
    /// none. Allowed: instead of `polygon_m`; not in studies. Example: `"heap.csv"`.
    pub polygon_file: Option<String>,
    /// Centre of a disk or a ring. Default: none. Allowed: `[x, y]`. Example: `[0.0, 0.3]`.
    pub centre_m: Option<[f64; 2]>,
    /// Radius of a disk, outer radius of a ring. Default: none; required by `centre_m`. Allowed: at least the spacing of the particles.
    /// Example: `0.1`.
    pub radius_m: Option<f64>,
    /// Radius of the hole of a ring. Default: none, a disk. Allowed: above 0, and less than `radius_m` by at least the spacing of the
    /// particles. Example: `0.05`.
    pub inner_radius_m: Option<f64>,
    /// Lower end of the face of a rectangle that is written as a wall is. Default: none. Allowed: `[x, y]`. Example: `[1.2, 0.0]`.
    pub foot_m: Option<[f64; 2]>,
    /// Distance from foot to crest. Default: none; required by `foot_m`. Allowed: above 0. Example: `0.6`.
    pub height_m: Option<f64>,
    /// Thickness on the side away from the material. Default: none; required by `foot_m`. Allowed: above 0. Example: `0.1`.
    pub thickness_m: Option<f64>,
    /// Direction from foot to crest, from the x axis, counter-clockwise. Default: `90.0`. Allowed: only with `foot_m`; -360 to 360.
    /// Example: `120`.
    pub inclination_deg: Option<f64>,
    /// The side of the face on which the material is, seen from foot to crest. Default: `"left"`. Allowed: only with `foot_m`.
    /// Example: `"right"`.
    pub material_side: Option<MaterialSide>,
    /// Rotation, counter-clockwise: of a rectangle about the corner (`x_m[0]`, `y_m[0]`); of the rows of particles in a polygon, a disk or a
    /// ring, which stay where they are drawn. Default: `0.0`. Allowed: -360 to 360; not with `foot_m`. Example: `60`.
    #[serde(default)]
    pub rotation_deg: f64,
    /// Velocity at the start, `[x, y]`. Default: `[0.0, 0.0]`. Allowed: any. Example: `[1.5, 0.0]`.
    #[serde(default)]
    pub velocity_m_per_s: [f64; 2],
    /// Rotation at the start about the centre of its area, counter-clockwise, added to the velocity. Default: none. Allowed: any; not with
    /// `kinematics = "total_lagrangian"`. Example: `2.0`.
    pub spin_rad_per_s: Option<f64>,
    /// Gradient of the velocity at the start, `[[dvx/dx, dvx/dy], [dvy/dx, dvy/dy]]`, about the centre of its area and added to the velocity.
    /// Default: none. Allowed: any; not with `kinematics = "total_lagrangian"`. Example: `[[0.0, 5.0], [0.0, 0.0]]`.
    pub velocity_gradient_per_s: Option<[[f64; 2]; 2]>,
    /// Particles of this body in a full cell. Default: that of `[grid]`. Allowed: 1, 4, 9 or 16. Example: `16`.
    pub particles_per_cell: Option<u32>,
    /// Largest displacement of a particle from its lattice, in either direction and at random, as a share of the
    /// lattice's spacing. Another packing says how much a result owes to the lattice. Default: `0.0`. Allowed: 0 to
    /// 0.5. Example: `0.2`.
    #[serde(default)]
    pub jitter: f64,
    /// Which of the random packings. Default: `0`. Allowed: a whole number from 0 to 4294967295. Example: `3`.
    #[serde(default)]
    pub jitter_seed: u32,
    /// Whether gravity leaves the body alone, as a barrier whose density is not known may need. Default: `false`.
    /// Allowed: true only for a body in `[[contacts]]`. Example: `true`.
    #[serde(default)]
    pub weightless: bool,
    /// How it moves through a time step. Default: `"explicit"`. Allowed: `"implicit"` only for a body in `[[contacts]]`
    /// with an elastic law, on which no boundary but clamps acts. Example: `"implicit"`.
    #[serde(default)]
    pub integration: Integration,
    /// In which configuration its deformation is reckoned. Default: `"updated_lagrangian"`. Allowed: `"total_lagrangian"` only for a body
    /// with `law = "neo_hookean"`, in `[[contacts]]` or the only one, with sides that are multiples of the
    /// distance of its particles, on which nothing acts but clamps that are planes along its edges. Example:
    /// `"total_lagrangian"`.
    #[serde(default)]
    pub kinematics: Kinematics,
    /// The mass the body is meant to have. A check, not an input. Default: none. Allowed: above 0, and density x area x
    /// thickness to 0.1 %. Example: `30`.
    pub mass_kg: Option<f64>,
}

/// How a body moves through a time step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Integration {
    /// As everything else: its P-wave limits the time step of all.
    #[default]
    Explicit,
    /// Implicitly, together with its contacts: no limit, and more work per step. For stiff elastic bodies in `contacts` that only
    /// clamps hold; bodies in `"updated_lagrangian"` kinematics that deform much within half a cell of motion need short explicit steps
    /// anyhow.
    Implicit,
}

/// In which configuration the deformation of a body is reckoned.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Kinematics {
    /// In the present one: particles keep their own deformation and cross the cells of the grid. For everything that flows.
    #[default]
    UpdatedLagrangian,
    /// In that of the start: the body has elements of its own, two cells wide, and its particles go with their nodes. For structures: they
    /// do not tear, they keep their energy, and their stiffness depends neither on the grid nor on the number of particles.
    TotalLagrangian,
}

/// The channel's two side walls, whose friction is averaged over its width.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct SideWalls {
    /// Coulomb friction coefficient; 0 for no side walls. Default: `0.0`. Allowed: 0 or more. Example: `0.3`.
    pub friction: f64,
    /// Names of the bodies that touch them. Default: all bodies. Allowed: at least one name of `[[bodies]]`. Example:
    /// `["sand"]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bodies: Option<Vec<String>>,
}

impl SideWalls {
    /// Whether a body touches them.
    pub fn act_on(&self, body: &str) -> bool {
        self.bodies.as_ref().is_none_or(|names| names.iter().any(|name| name == body))
    }
}

/// The stages of a run, in the order in which they happen.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Stages {
    /// Settling under gravity with the gate closed. Left out: the run starts from zero stress.
    pub settle: Option<Settle>,
    /// Tilting from `settle_inclination_deg` to `inclination_deg`, only with `[stages.settle]`. Left out: settles at
    /// `inclination_deg` directly.
    pub tilt: Option<Tilt>,
    /// The run; the gate opens and the clock starts at its beginning.
    pub run: Run,
}

/// Settling under gravity with damping.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Settle {
    /// Rate at which the damping removes momentum. Allowed: 0 or more. Example: `60`.
    pub damping_per_s: f64,
    /// The stage ends when rms speed / sqrt(g x height) of what flows has stayed below this for a period of its slowest
    /// oscillation. Allowed: above 0. Example: `1.0e-4`.
    pub residual: f64,
    /// An error if the residual is not reached by this time. Allowed: above 0. Example: `5.0`.
    pub max_time_s: f64,
    /// What has the height and the period by which the residual is judged. Default: `"flow"`. Example: `"flow"`.
    #[serde(default)]
    pub scale: SettleScale,
}

/// What has the height and the period by which settling is judged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum SettleScale {
    /// Everything that flows, as one: from its lowest corner to its highest, whether it is written as one body or as several.
    #[default]
    Flow,
    /// The tallest of all bodies, structures among them, with the slowest waves of any of them: as checkdam did first. Then a body that is
    /// written as two settles to another residual.
    TallestBody,
}

/// Tilting of the flume, followed by a second settling.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Tilt {
    /// Time over which the direction of gravity turns at a steady rate. Allowed: above 0. Example: `0.5`.
    pub duration_s: f64,
}

/// The run itself.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// The run ends at this time after the gate opens. Allowed: above 0; at most 1e9 time steps, 1e8 samples and 1e5
    /// VTK files. Example: `6.0`.
    pub end_time_s: f64,
    /// End earlier, when the kinetic energy is below 1e-4 of what was released, forces balance to 0.2 % of the weight
    /// and the force on the barrier is steady. Default: `true`.
    #[serde(default = "yes")]
    pub stop_at_rest: bool,
}

/// Files written besides the results.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Output {
    /// Time between VTK files, and between the rows of `pressure_profile.csv` and `barrier_profile.csv`; 0 writes none of them.
    /// Default: `0.02`. Allowed: 0 or more; at most 1e5 files in a run. Example:
    /// `0`.
    pub vtk_interval_s: f64,
}

impl Default for Output {
    fn default() -> Self {
        Output { vtk_interval_s: 0.02 }
    }
}

/// Numerical settings.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Numerics {
    /// Order of the stress update in a step. Default: `"musl"`.
    pub scheme: Scheme,
    /// Time step as a share of h / (P-wave speed + particle speed). Default: `0.3`. Allowed: above 0, at most 1.
    /// Example: `0.2`.
    pub cfl: f64,
    /// Share of the PIC velocity update in each step. Default: `5.0e-4`, or none where `pic_rate_per_s` is given.
    /// Allowed: 0 to 1; not together with `pic_rate_per_s`. Example: `1.0e-3`.
    pub pic_fraction: Option<f64>,
    /// The same per second, independent of the time step. Default: none. Allowed: 0 or more; not together with
    /// `pic_fraction`. Example: `5.0`.
    pub pic_rate_per_s: Option<f64>,
    /// Upper bound of the time step. Default: none. Allowed: above 0. Example: `1.0e-4`.
    pub max_time_step_s: Option<f64>,
    /// Where boundaries act. Default: `"surface"`. Example: `"nodes"`.
    pub boundary_contact: BoundaryContact,
    /// What the opened strain of material that came apart follows, where `void_tracking` is on. Default: `"occupied"`.
    /// Example: `"strain"`.
    pub opened_volume: OpenedVolume,
}

impl Default for Numerics {
    fn default() -> Self {
        Numerics {
            scheme: Scheme::Musl,
            cfl: 0.3,
            pic_fraction: None,
            pic_rate_per_s: None,
            max_time_step_s: None,
            boundary_contact: BoundaryContact::Surface,
            opened_volume: OpenedVolume::Occupied,
        }
    }
}

impl Numerics {
    /// `pic_fraction` when none is given, as in the paper.
    pub const DEFAULT_PIC_FRACTION: f64 = 5.0e-4;

    /// The PIC share in force.
    pub fn pic(&self) -> PicShare {
        match (self.pic_fraction, self.pic_rate_per_s) {
            (Some(fraction), _) => PicShare::Fraction(fraction),
            (None, Some(rate)) => PicShare::Rate(rate),
            (None, None) => PicShare::Fraction(Self::DEFAULT_PIC_FRACTION),
        }
    }
}

impl Gravity {
    /// Inclination while the material settles, degrees.
    pub fn settle_inclination_or_default_deg(&self) -> f64 {
        self.settle_inclination_deg.unwrap_or(self.inclination_deg)
    }
}

impl Body {
    /// Particles per grid cell.
    pub fn particles_per_cell(&self, grid: &Grid) -> u32 {
        self.particles_per_cell.unwrap_or(grid.particles_per_cell)
    }

    /// Distance between neighbouring particles in cells that are filled evenly, m.
    pub fn particle_spacing_m(&self, grid: &Grid) -> f64 {
        grid.spacing_m / f64::from(self.particles_per_cell(grid)).sqrt()
    }

    /// The lattice that fills the rectangle: as many particles along each side as come nearest to the wanted spacing, and their
    /// distances, which fill the side to its end. None along a side that is shorter than the spacing. Of other shapes it says nothing.
    pub fn lattice(&self, grid: &Grid) -> Lattice {
        let wanted = self.particle_spacing_m(grid);
        let sides = self.size_m().map(|length| {
            if grid.filling == Filling::Square {
                // Points at (i + 1/2) s inside the length L: i + 1/2 <= L/s, with room for rounding.
                return ((length / wanted + 0.5 + 1.0e-9).floor().max(0.0), wanted);
            }
            let count = (length / wanted).round();
            let off = (count * wanted - length).abs() / length;
            if length < wanted * (1.0 - FILLED_TO) {
                (0.0, wanted)
            } else if off <= FILLED_TO {
                (count, wanted)
            } else {
                (count, length / count)
            }
        });
        Lattice { counts: sides.map(|s| s.0), spacing_m: sides.map(|s| s.1) }
    }

    /// Particles along the length and the height of the rectangle as whole numbers. Kept as floats because a mistyped case
    /// may ask for more than an integer holds.
    pub fn particle_counts(&self, grid: &Grid) -> [f64; 2] {
        self.lattice(grid).counts
    }

    /// Number of particles, a whole number: of a rectangle those of its lattice, of other shapes as many as come nearest to the wanted
    /// spacing, and at least one.
    pub fn particle_count(&self, grid: &Grid) -> f64 {
        if self.rectangle().is_some() {
            let [nx, ny] = self.particle_counts(grid);
            return nx * ny;
        }
        nearest_whole(self.area_m2() / self.particle_spacing_m(grid).powi(2)).max(1.0)
    }
}

/// The nearest whole number; the lower one of what lies in the middle between two but for round-off, so that a shape that is moved or turned
/// is cut into the same pieces.
pub fn nearest_whole(number: f64) -> f64 {
    (number - 1.0e-6).round()
}

/// Spacings that fill a side to this share of it count as filling it: cell sizes are written with few digits, 0.0133333 m for a
/// seventy-fifth.
const FILLED_TO: f64 = 1.0e-5;

/// The particles of a body at the start, in the axes of its rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    /// How many along its length and its height, as whole numbers.
    pub counts: [f64; 2],
    /// Their distances, m; the first particle lies half of them inside the lower left corner.
    pub spacing_m: [f64; 2],
}

impl Case {
    /// Fills in every default that depends on another value, so that the case written back to TOML shows all inputs.
    pub fn resolve(&mut self) {
        self.gravity.settle_inclination_deg.get_or_insert(self.gravity.inclination_deg);
        if self.numerics.pic_rate_per_s.is_none() {
            self.numerics.pic_fraction.get_or_insert(Numerics::DEFAULT_PIC_FRACTION);
        }
        self.materials.values_mut().for_each(Material::resolve);
        for boundary in &mut self.boundaries {
            boundary.resolve(&self.grid);
        }
        self.bodies.iter_mut().for_each(Body::resolve);
        self.contacts.iter_mut().for_each(BodyContact::resolve);
        self.inflows.iter_mut().for_each(Inflow::resolve);
    }

    /// The case as a TOML document.
    pub fn to_toml(&self) -> Result<String, toml::ser::Error> {
        toml::to_string(self)
    }

    /// Number of particles at the start.
    pub fn particle_count_estimate(&self) -> f64 {
        self.bodies.iter().map(|body| body.particle_count(&self.grid)).sum()
    }

    /// The time step the run starts with, s: cfl x h / (P-wave speed + particle speed), at most `max_time_step_s`. Waves in
    /// bodies that move in implicit steps do not limit it. With inflows, that as they begin. Infinite if there is neither body nor inflow.
    pub fn time_step_estimate_s(&self) -> f64 {
        let speed = |body: &Body| {
            let explicit = self.materials.get(&body.material).filter(|_| body.integration == Integration::Explicit);
            let wave = explicit.map_or(0.0, Material::p_wave_speed_m_per_s);
            wave + body.fastest_m_per_s()
        };
        let entering = |inflow: &Inflow| {
            let wave = self.materials.get(&inflow.material).map_or(0.0, Material::p_wave_speed_m_per_s);
            wave + inflow.fastest_m_per_s()
        };
        let fastest = self.bodies.iter().map(speed).chain(self.inflows.iter().map(entering)).fold(0.0, f64::max);
        let step = self.numerics.cfl * self.grid.spacing_m / fastest;
        step.min(self.numerics.max_time_step_s.unwrap_or(f64::INFINITY))
    }
}

fn default_gravity_magnitude() -> f64 {
    9.81
}

fn yes() -> bool {
    true
}
