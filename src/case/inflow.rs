//! Flows that enter through a section during the run: the `[[inflows]]` tables of a case file.

use serde::{Deserialize, Serialize};

use super::grid::Grid;

/// A flow that enters through a section normal to the bed.
///
/// What enters has the density of its material, the velocity that is given, and the stress of a uniform layer on the slope. Behind the
/// section it is led at that velocity, over five cells that have to lie in the domain and that no gauge sees. The bed there is a plane along x
/// through the foot of the section.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Inflow {
    /// Name. Allowed: not empty, and different from that of every body and every other inflow. Example: `"debris"`.
    pub name: String,
    /// Name of its material. Allowed: the name of one of `[materials.NAME]` with `law = "drucker_prager"`. Example: `"sand"`.
    pub material: String,
    /// Foot of the section, on the bed. Allowed: `[x, y]` on a boundary with `kind = "plane"` and `normal_deg = 90`; five cells inside the
    /// domain on the side from which the flow comes. Example: `[-20.0, 0.0]`.
    pub foot_m: [f64; 2],
    /// Where the flow runs along x. Default: `"right"`. Example: `"left"`.
    #[serde(default)]
    pub towards: Towards,
    /// Depth, perpendicular to the bed. Default: none; required unless there is a hydrograph. Allowed: not below the distance of the
    /// particles; not together with `times_s`. Example: `3.0`.
    pub depth_m: Option<f64>,
    /// Velocity along the bed, the mean over the depth. Default: none; required unless there is a hydrograph. Allowed: above 0; not together
    /// with `times_s`. Example: `10.0`.
    pub velocity_m_per_s: Option<f64>,
    /// When it begins, after the release. Default: `0.0`. Allowed: 0 or more; not together with `times_s`. Example: `0.5`.
    pub start_time_s: Option<f64>,
    /// How long it lasts. Default: none; required unless there is `mass_kg` or a hydrograph. Allowed: above 0; not together with `mass_kg`
    /// or `times_s`. Example: `20.0`.
    pub duration_s: Option<f64>,
    /// The mass that enters in all, instead of a duration. Default: none. Allowed: above 0; not together with `duration_s` or `times_s`.
    /// Example: `7.2e6`.
    pub mass_kg: Option<f64>,
    /// Hydrograph: moments after the release. Depth and velocity are linear in between. Default: none. Allowed: two or more that increase,
    /// from 0 on; with `depths_m` and `velocities_m_per_s`. Example: `[0.0, 2.0, 20.0]`.
    pub times_s: Option<Vec<f64>>,
    /// Hydrograph: depths at these moments. Default: none; required by `times_s`. Allowed: as many, none below the distance of the
    /// particles. Depths that differ only with `profile = "plug"` and a vertical front. Example: `[1.0, 3.0, 0.5]`.
    pub depths_m: Option<Vec<f64>>,
    /// Hydrograph: velocities at these moments, means over the depth. Default: none; required by `times_s`. Allowed: as many, 0 or more and
    /// not all 0. Example: `[10.0, 12.0, 4.0]`.
    pub velocities_m_per_s: Option<Vec<f64>>,
    /// How the velocity is distributed over the depth. Its mean is that which is given. Default: `"plug"`. Example: `"bagnold"`.
    #[serde(default)]
    pub profile: Profile,
    /// Angle between the bed and the face of the front as it passes the section: a wedge below 90. Default: `90.0`, a vertical face.
    /// Allowed: above 0, at most 90; a wedge that is shorter than the flow. Example: `45`.
    pub front_angle_deg: Option<f64>,
    /// Particles of this inflow in a full cell. Default: that of `[grid]`. Allowed: 1, 4, 9 or 16. Example: `16`.
    pub particles_per_cell: Option<u32>,
}

/// Where an inflow runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Towards {
    /// Along x.
    #[default]
    Right,
    /// Against x.
    Left,
}

/// Velocity over the depth, with the share of the depth from the bed up and a mean of 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Profile {
    /// The same everywhere: the flow slides.
    #[default]
    Plug,
    /// In proportion to the height above the bed.
    Linear,
    /// 5/3 (1 - (1 - y/d)^(3/2)): steady flow of grains whose stress goes with the square of the shear rate (Bagnold 1954).
    Bagnold,
}

impl Profile {
    /// What flows below a share of the depth, over what flows in all.
    pub fn discharge_below(self, share: f64) -> f64 {
        match self {
            Profile::Plug => share,
            Profile::Linear => share * share,
            Profile::Bagnold => (5.0 * share - 2.0 * (1.0 - libm::pow(1.0 - share, 2.5))) / 3.0,
        }
    }

    /// Largest velocity over the mean.
    pub fn fastest(self) -> f64 {
        match self {
            Profile::Plug => 1.0,
            Profile::Linear => 2.0,
            Profile::Bagnold => 5.0 / 3.0,
        }
    }
}

impl Inflow {
    /// So many cells behind the section is the flow led.
    pub const LED_CELLS: f64 = 4.0;
    /// So many have to lie in the domain.
    pub const DOMAIN_CELLS: f64 = 5.0;

    pub(super) fn resolve(&mut self) {
        if self.times_s.is_none() {
            self.start_time_s.get_or_insert(0.0);
        }
        self.front_angle_deg.get_or_insert(90.0);
    }

    /// 1 along x, -1 against it.
    pub fn direction(&self) -> f64 {
        if self.towards == Towards::Right { 1.0 } else { -1.0 }
    }

    /// Angle of the front, degrees; 90 for a vertical face.
    pub fn front_angle_or_default_deg(&self) -> f64 {
        self.front_angle_deg.unwrap_or(90.0)
    }

    /// Particles per grid cell.
    pub fn particles_per_cell(&self, grid: &Grid) -> u32 {
        self.particles_per_cell.unwrap_or(grid.particles_per_cell)
    }

    /// Distance between neighbouring particles in cells that are filled evenly, m.
    pub fn particle_spacing_m(&self, grid: &Grid) -> f64 {
        grid.spacing_m / f64::from(self.particles_per_cell(grid)).sqrt()
    }

    /// Length of the wedge of the front, m.
    pub fn wedge_m(&self) -> f64 {
        let angle = self.front_angle_or_default_deg();
        if angle >= 90.0 { 0.0 } else { self.deepest_m() / libm::tan(angle.to_radians()) }
    }

    /// Largest depth, m.
    pub fn deepest_m(&self) -> f64 {
        self.depth_m.into_iter().chain(self.depths_m.iter().flatten().copied()).fold(0.0, f64::max)
    }

    /// Largest velocity of any of its points, m/s.
    pub fn fastest_m_per_s(&self) -> f64 {
        let given = self.velocity_m_per_s.into_iter().chain(self.velocities_m_per_s.iter().flatten().copied());
        given.fold(0.0, f64::max) * self.profile.fastest()
    }

    /// Whether its depth changes.
    pub fn is_varied(&self) -> bool {
        self.depths_m.as_ref().is_some_and(|d| d.windows(2).any(|two| two[0] != two[1]))
    }
}
