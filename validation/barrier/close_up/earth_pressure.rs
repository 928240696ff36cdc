//! The pressure of the deposit on the barrier beside earth pressure theories (Fig. 11).

use super::super::records::RIGIDITY;
use crate::Failure;
use checkdam::output::Table;
use checkdam::theory::earth_pressure::{Wall, jaky, rankine_active, rankine_passive};
use checkdam_verification::report::number;

/// The pressure at rest, averaged over five cells as single nodes alternate, with the lines of the earth pressure theories beside it:
/// K rho g times the depth below the highest material at the wall.
pub(super) fn with_theory(at_rest: &Table) -> Result<String, Failure> {
    let case = RIGIDITY.first_case()?;
    let sand = &case.materials["sand"];
    let phi = sand.friction_angle_deg.unwrap_or(f64::NAN).to_radians();
    let delta = libm::atan(case.contacts.iter().map(|c| c.friction).next().unwrap_or(f64::NAN));
    let wall = Wall { friction_angle: phi, wall_friction_angle: delta, batter: 0.0, surface_slope: 0.0 };
    let unit_weight = sand.density_kg_per_m3 * case.gravity.magnitude_m_per_s2;
    let coefficients = [
        jaky(phi),
        rankine_active(phi),
        rankine_passive(phi),
        wall.coulomb_active() * libm::cos(delta),
        wall.coulomb_passive() * libm::cos(delta),
    ];
    let (height, top) = (at_rest.column("height_m")?, at_rest.column("run_up_m")?);
    let (barrier, pressure) = (at_rest.cells("barrier")?, at_rest.column("pressure_pa")?);
    let mut text = String::from(
        "barrier,height_m,pressure_kpa,at_rest_kpa,rankine_active_kpa,rankine_passive_kpa,coulomb_active_kpa,coulomb_passive_kpa\n",
    );
    let smooth = |k: usize| {
        let near = k.saturating_sub(2)..(k + 3).min(at_rest.rows());
        let own = near.filter(|&j| barrier[j] == barrier[k]).map(|j| pressure[j]);
        let (sum, count) = own.fold((0.0, 0.0), |(s, n), p| (s + p, n + 1.0));
        sum / count
    };
    for k in 0..at_rest.rows() {
        let weight = 1e-3 * unit_weight * (top[k] - height[k]).max(0.0);
        let lines = coefficients.map(|c| number(c * weight)).join(",");
        text += &format!("{},{},{},{lines}\n", barrier[k], number(height[k]), number(1e-3 * smooth(k)));
    }
    Ok(text)
}
