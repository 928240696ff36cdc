//! Collapse of a granular column in a channel: laws fitted to experiments.
//!
//! Lengths over the initial length r0 of the column, by its aspect ratio a = h0/r0. Coefficients depend on the material and
//! on the width of the channel; the laws of two laboratories show by how much.

use libm::pow;

/// Run-out (r - r0)/r0 after Lube, Huppert, Sparks and Freundt (2005): 1.2 a below 1.8, 1.9 a^(2/3) above 2.8; linear between.
pub fn lube_run_out(a: f64) -> f64 {
    let (low, high) = (1.2 * 1.8, 1.9 * pow(2.8, 2.0 / 3.0));
    match a {
        _ if a < 1.8 => 1.2 * a,
        _ if a > 2.8 => 1.9 * pow(a, 2.0 / 3.0),
        _ => low + (high - low) * (a - 1.8),
    }
}

/// Final height h/r0 after Lube et al. (2005): a below 1.15, a^(2/5) above 1.15; the law jumps there by 8 %.
pub fn lube_height(a: f64) -> f64 {
    if a < 1.15 { a } else { pow(a, 0.4) }
}

/// Run-out (r - r0)/r0 of glass beads after Lajeunesse, Monnier and Homsy (2005), as Lagree, Staron and Popinet (2011) quote it:
/// 1.8 a below 3, 2.3 a^(2/3) above. Beads come to rest at 22 degrees and run farther than sand.
pub fn lajeunesse_run_out(a: f64) -> f64 {
    if a < 3.0 { 1.8 * a } else { 2.3 * pow(a, 2.0 / 3.0) }
}

/// Final height h/r0 after Lajeunesse et al. (2005): a below 0.7, a^(1/3) above.
pub fn lajeunesse_height(a: f64) -> f64 {
    if a < 0.7 { a } else { pow(a, 1.0 / 3.0) }
}

/// Time until a column of `height` (m) has come to rest, 3.3 sqrt(h0/g), s (Lube et al. 2005).
pub fn duration(height: f64, gravity: f64) -> f64 {
    3.3 * (height / gravity).sqrt()
}

/// Run-out from the gate (m) of a column of `height` (m) on a rough slope (rad) of grains with friction angle `angle` (rad):
/// 2 k h0 / (tan(angle) - tan(slope)).
///
/// k = 1 is where the front of a dam break with Coulomb friction stops that has material enough behind it: it starts at
/// 2 sqrt(g' h0), with g' across the slope, and is braked by g' (tan(angle) - tan(slope)) (Mangeney, Heinrich and Roche 2000).
/// k = 1/4 is where the foot of a deposit lies whose surface is inclined by the friction angle and halves the face of the column,
/// for small angles. Experiments with glass beads have k = 1/2 (Mangeney et al. 2010).
pub fn slope_run_out(height: f64, slope: f64, angle: f64, k: f64) -> f64 {
    2.0 * k * height / (libm::tan(angle) - libm::tan(slope))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_branches() {
        assert!((lube_run_out(1.0) - 1.2).abs() < 1e-12);
        assert!((lube_run_out(8.0) - 7.6).abs() < 1e-12);
        assert!((lube_run_out(1.8) - 2.16).abs() < 1e-12 && (lube_run_out(2.8) - 3.7745).abs() < 1e-4);
        assert!((lajeunesse_run_out(8.0) - 9.2).abs() < 1e-12 && (lajeunesse_run_out(1.0) - 1.8).abs() < 1e-12);
        assert!((lajeunesse_height(8.0) - 2.0).abs() < 1e-12);
        assert!((lube_height(4.0) - 1.7411).abs() < 1e-4);
        // Beads of 25.5 degrees on level ground, 0.14 m high.
        assert!((slope_run_out(0.14, 0.0, 25.5f64.to_radians(), 0.5) - 0.2935).abs() < 1e-4);
        assert!((duration(0.981, 9.81) - 1.04355).abs() < 1e-5);
    }
}
