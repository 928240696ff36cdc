//! Straight bars: impact on a rigid wall, free vibration.

use std::f64::consts::PI;

/// Stress behind the front when a bar of impedance `density * speed` hits a rigid wall at `velocity`: rho c v, Pa, positive in
/// compression (Saint-Venant 1867; Johnson 1972).
pub fn impact_stress(density: f64, speed: f64, velocity: f64) -> f64 {
    density * speed * velocity
}

/// How long a bar of `length` (m) stays on the wall: until the wave reflected at the free end is back, 2 L / c, s.
pub fn contact_duration(length: f64, speed: f64) -> f64 {
    2.0 * length / speed
}

/// Impulse that stops a mass (kg) and sends it back with restitution `e`: m v (1 + e), N s.
pub fn rebound_impulse(mass: f64, velocity: f64, restitution: f64) -> f64 {
    mass * velocity * (1.0 + restitution)
}

/// Wave number of mode `n` (1, 2, ...) of a bar with free ends, n pi / L, 1/m; the velocity goes with cos(k x).
pub fn free_wave_number(mode: u32, length: f64) -> f64 {
    f64::from(mode) * PI / length
}

/// Angular frequency k c of a wave in a bar, rad/s (Rayleigh 1877).
pub fn angular_frequency(wave_number: f64, speed: f64) -> f64 {
    wave_number * speed
}

/// Energy of a free bar vibrating as v0 cos(k x) cos(w t): rho A L v0^2 / 4, J, for any mode.
pub fn vibration_energy(mass: f64, amplitude: f64) -> f64 {
    0.25 * mass * amplitude * amplitude
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bardenhagens_bar() {
        // E = 100, rho = 1, L = 25: c = 10; a wave runs there and back in 5 s, which is the period of the free bar's first mode.
        let k = free_wave_number(1, 25.0);
        assert!((2.0 * PI / angular_frequency(k, 10.0) - 5.0).abs() < 1e-12);
        assert!((contact_duration(25.0, 10.0) - 5.0).abs() < 1e-12);
    }

    #[test]
    fn plateau_times_duration_is_the_impulse() {
        let (rho, c, v, l, area) = (1500.0, 26.0, 0.2, 0.7, 0.03);
        let impulse = impact_stress(rho, c, v) * area * contact_duration(l, c);
        assert!((impulse - rebound_impulse(rho * l * area, v, 1.0)).abs() < 1e-9);
        assert!((vibration_energy(2.0, 0.1) - 0.005).abs() < 1e-15);
    }
}
