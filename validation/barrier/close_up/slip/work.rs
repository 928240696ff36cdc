//! Plastic work of single points.

use checkdam::constitutive::{PointState, Stress};

/// Plastic work density of a step from one state to the next, J per m3 of the current volume; for a cone without dilatancy.
///
/// The plastic strain is sqrt(3) dk s1/(2 tau1), with the change dk of the equivalent plastic shear strain, the deviator s1 that the
/// law returns to and tau1 = sqrt(J2) there; at the apex, where there is no deviator, only coming apart is left. How far the stress
/// turned with the point during the step is left out, which is of second order in that angle.
pub fn density(before: &PointState, after: &PointState) -> f64 {
    let (a, b) = (&before.stress, &after.stress);
    let tau = b.j2().sqrt();
    let sheared = after.plastic_shear - before.plastic_shear;
    let along = if tau > 0.0 { 0.5 * tau + deviators(a, b) / (4.0 * tau) } else { 0.0 };
    let apart = after.opened - before.opened;
    3f64.sqrt() * sheared * along + 0.5 * (a.mean() + b.mean()) * apart
}

/// Double contraction of the deviators of two stresses.
fn deviators(a: &Stress, b: &Stress) -> f64 {
    let (m, n) = (a.mean(), b.mean());
    (a.xx - m) * (b.xx - n) + (a.yy - m) * (b.yy - n) + (a.zz - m) * (b.zz - n) + 2.0 * a.xy * b.xy
}

#[cfg(test)]
mod tests {
    use super::*;
    use checkdam::constitutive::{Cone, DruckerPrager, Increment, Law, LinearElastic};

    /// Work less stored energy and our own plastic work over a path of strains, both summed, J/m3.
    fn path(spin: f64) -> [f64; 2] {
        let elastic = LinearElastic::new(1e6, 0.3);
        let sand = DruckerPrager::new(elastic, Cone::PlaneStrain, 31f64.to_radians(), 0.0, 0.0, 0.0, true);
        let mut state = PointState::default();
        let mut sums = [0.0; 2];
        for k in 0..4000 {
            let t = f64::from(k) * 0.01;
            // Compressed, sheared to and fro, torn apart and closed again.
            let d = Increment {
                dt: 0.01,
                xx: -1e-5 * libm::cos(0.7 * t),
                yy: -2e-5 * libm::cos(0.3 * t),
                xy: 4e-5 * libm::sin(1.3 * t),
                spin,
            };
            let before = state;
            let work = sand.update(&mut state, &d);
            sums[0] += work - (sand.stored_energy(&state) - sand.stored_energy(&before));
            sums[1] += density(&before, &state);
        }
        assert!(state.plastic_shear > 0.01 && sums[0] > 0.0, "{state:?}");
        sums
    }

    #[test]
    fn it_is_the_work_that_was_not_stored() {
        let [expected, ours] = path(0.0);
        // Steps that end at the apex lose what the deviator before did.
        assert!((ours / expected - 1.0).abs() < 1e-4, "{ours} {expected}");
        // Turning by half a degree a step, as sand does at most.
        let [expected, ours] = path(0.01);
        assert!((ours / expected - 1.0).abs() < 1e-3, "{ours} {expected}");
    }
}
