//! Material at rest behind a barrier that stands across an inclined bed: how little height it can keep.

use libm::{cos, sin, sqrt, tan};

/// Least mean height above the barrier's foot, m, of a cross-section of `area` (m2) behind a barrier perpendicular to a bed
/// inclined by `slope` (rad): with a level surface, a triangle between bed and barrier. Any other surface keeps the material
/// higher. The barrier is taken to be high enough.
pub fn least_mean_height(area: f64, slope: f64) -> f64 {
    // Legs along the barrier and along the bed; a level surface makes the angle `slope` with the bed.
    let along_barrier = sqrt(2.0 * area * tan(slope));
    let along_bed = along_barrier / tan(slope);
    (along_barrier * cos(slope) + along_bed * sin(slope)) / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_tilt_of_the_surface_raises_it() {
        let (area, slope) = (0.1, 40f64.to_radians());
        let least = least_mean_height(area, slope);
        for degrees in [-8.0f64, -3.0, 3.0, 10.0, 30.0] {
            // A surface that rises up the flume by this angle meets the bed at a smaller one.
            let angle = slope - degrees.to_radians();
            let across = sqrt(2.0 * area * tan(angle));
            let along = across / tan(angle);
            let height = (across * cos(slope) + along * sin(slope)) / 3.0;
            assert!(height > least, "{degrees}: {height} {least}");
        }
        // At 45 degrees, an isosceles triangle whose hypotenuse is level: a third of its height.
        let height = least_mean_height(0.5, 45f64.to_radians());
        assert!((height - 2.0 / 3.0 * 0.5f64.sqrt()).abs() < 1e-12, "{height}");
    }
}
