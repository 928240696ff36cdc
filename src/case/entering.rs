//! What an inflow is in its case: how long it lasts, how much it brings, on what bed it stands, and where it is led.

use super::boundary::{Boundary, BoundaryKind};
use super::grid::Grid;
use super::inflow::{Inflow, Towards};
use super::schema::{Body, Case};

impl Inflow {
    /// Times (s), depths (m) and velocities (m/s) at them, linear in between. `None` if something is missing, which validation refuses.
    pub fn hydrograph(&self, case: &Case) -> Option<[Vec<f64>; 3]> {
        if let Some(times) = &self.times_s {
            return Some([times.clone(), self.depths_m.clone()?, self.velocities_m_per_s.clone()?]);
        }
        let (depth, velocity, start) = (self.depth_m?, self.velocity_m_per_s?, self.start_time_s.unwrap_or(0.0));
        let duration = match (self.duration_s, self.mass_kg) {
            (Some(duration), _) => duration,
            (None, Some(mass)) => {
                let density = case.materials.get(&self.material)?.density_kg_per_m3;
                let area = mass / (density * case.grid.thickness_m) + 0.5 * depth * self.wedge_m();
                area / (depth * velocity)
            }
            (None, None) => return None,
        };
        Some([vec![start, start + duration], vec![depth; 2], vec![velocity; 2]])
    }

    /// Area of all that enters in the plane of the simulation, m2; 0 where something is missing.
    pub fn area_m2(&self, case: &Case) -> f64 {
        let Some([times, depths, speeds]) = self.hydrograph(case) else { return 0.0 };
        let pieces = times.windows(2).zip(depths.windows(2)).zip(speeds.windows(2));
        // The product of two linear functions over an interval.
        let areas = pieces.map(|((t, d), u)| {
            (t[1] - t[0]) * (2.0 * d[0] * u[0] + d[0] * u[1] + d[1] * u[0] + 2.0 * d[1] * u[1]) / 6.0
        });
        (areas.sum::<f64>() - 0.5 * self.deepest_m() * self.wedge_m()).max(0.0)
    }

    /// About how many particles will enter.
    pub fn particle_count_estimate(&self, case: &Case) -> f64 {
        self.area_m2(case) / self.particle_spacing_m(&case.grid).powi(2)
    }

    /// The plane under the section.
    pub fn bed<'a>(&self, case: &'a Case) -> Option<&'a Boundary> {
        let along = |b: &&Boundary| {
            let normal = b.normal_deg.map(|n| n.rem_euclid(360.0));
            b.kind == BoundaryKind::Plane && normal == Some(90.0)
        };
        let under = |b: &&Boundary| {
            let off = b.point_m.map_or(f64::INFINITY, |p| (p[1] - self.foot_m[1]).abs());
            off <= 1.0e-9 * case.grid.spacing_m.max(1.0)
        };
        case.boundaries.iter().filter(along).find(under)
    }

    /// What is led behind the section, as a body that is not there at the start.
    pub fn behind(&self, grid: &Grid) -> Body {
        let ([x, y], far) = (self.foot_m, Self::DOMAIN_CELLS * grid.spacing_m);
        Body {
            name: self.name.clone(),
            material: self.material.clone(),
            x_m: Some(if self.towards == Towards::Right { [x - far, x] } else { [x, x + far] }),
            y_m: Some([y, y + self.deepest_m()]),
            polygon_m: None,
            polygon_file: None,
            centre_m: None,
            radius_m: None,
            inner_radius_m: None,
            foot_m: None,
            height_m: None,
            thickness_m: None,
            inclination_deg: None,
            material_side: None,
            rotation_deg: 0.0,
            spin_rad_per_s: None,
            velocity_gradient_per_s: None,
            velocity_m_per_s: [0.0; 2],
            particles_per_cell: self.particles_per_cell,
            jitter: 0.0,
            jitter_seed: 0,
            weightless: false,
            integration: Default::default(),
            kinematics: Default::default(),
            mass_kg: None,
        }
    }
}

impl Case {
    /// About how many particles enter with inflows.
    pub fn entering_count_estimate(&self) -> f64 {
        self.inflows.iter().map(|inflow| inflow.particle_count_estimate(self)).sum()
    }
}
