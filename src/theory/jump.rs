//! A shallow flow that is stopped by a wall: momentum flux and granular jump (bore) of no length, frictionless, hydrostatic.
//!
//! Flow of depth h and velocity u meets a wall across a channel of width w; a jump of depth gamma h runs back from the wall at u / (gamma -
//! 1), with the material at rest behind it. Balance of mass and momentum gives Fr^2 = (gamma - 1)^2 (gamma + 1) / (2 gamma) with Fr = u /
//! sqrt(g' h) and g' = g cos(slope). The wall carries rho g' (gamma h)^2 w / 2 (Stoker 1957, section 10.7; Faug 2015 for granular jumps).

/// Momentum flux rho u^2 h w, N: the force of a jet that the wall turns aside, Eq. 1 of design guides with alpha = 1.
pub fn momentum_flux(density: f64, velocity: f64, depth: f64, width: f64) -> f64 {
    density * velocity * velocity * depth * width
}

/// Depth behind the jump over the depth before it, for Fr > 0.
pub fn depth_ratio(froude: f64) -> f64 {
    let wanted = froude * froude;
    let of = |gamma: f64| (gamma - 1.0) * (gamma - 1.0) * (gamma + 1.0) / (2.0 * gamma);
    // Grows without bound from 0 at gamma = 1.
    let (mut low, mut high) = (1.0, 2.0);
    while of(high) < wanted {
        high *= 2.0;
    }
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if of(middle) < wanted { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Force of the material behind the jump on the wall, N; `gravity` is its component across the bed, m/s2.
pub fn force(density: f64, velocity: f64, depth: f64, width: f64, gravity: f64) -> f64 {
    let behind = depth * depth_ratio(velocity / (gravity * depth).sqrt());
    0.5 * density * gravity * behind * behind * width
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_of_a_table() {
        for (froude, ratio, alpha) in
            [(2.0, 3.494, 1.526), (3.5, 5.557, 1.260), (5.0, 7.650, 1.170), (7.0, 10.458, 1.116)]
        {
            let gamma = depth_ratio(froude);
            assert!((gamma - ratio).abs() < 6e-4, "{froude}: {gamma}");
            assert!((gamma * gamma / (2.0 * froude * froude) - alpha).abs() < 6e-4);
        }
    }

    #[test]
    fn mass_and_momentum_balance() {
        let (rho, u, h, w, g) = (1500.0, 2.2, 0.05, 0.2, 7.5);
        let gamma = depth_ratio(u / f64::sqrt(g * h));
        let celerity = u / (gamma - 1.0);
        // What arrives fills the step between the two depths.
        assert!((h * (u + celerity) - gamma * h * celerity).abs() < 1e-12);
        let pressure = |depth: f64| 0.5 * rho * g * depth * depth * w;
        let arriving = rho * h * w * (u + celerity) * u;
        assert!((force(rho, u, h, w, g) - pressure(h) - arriving).abs() < 1e-9 * arriving);
        assert!((momentum_flux(rho, u, h, w) - 72.6).abs() < 1e-9);
        assert!((depth_ratio(1e-9) - 1.0).abs() < 1e-6);
    }
}
