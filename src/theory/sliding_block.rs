//! A rigid block on a plane with Coulomb friction (Coulomb 1785).

use libm::{atan, cos, sin};

/// Acceleration down a plane inclined by `slope` (rad) while it slides down, g (sin - mu cos), m/s2; negative when it brakes.
pub fn sliding_acceleration(gravity: f64, slope: f64, friction: f64) -> f64 {
    gravity * (sin(slope) - friction * cos(slope))
}

/// Acceleration from rest: zero unless the slope is steeper than the friction angle.
pub fn acceleration_from_rest(gravity: f64, slope: f64, friction: f64) -> f64 {
    if slope > atan(friction) { sliding_acceleration(gravity, slope, friction) } else { 0.0 }
}

/// Distance run from rest in `time` (s) at constant acceleration, m.
pub fn distance(acceleration: f64, time: f64) -> f64 {
    0.5 * acceleration * time * time
}

/// Distance in which friction on level ground stops a block of `speed`, v^2 / (2 mu g), m.
pub fn stopping_distance(gravity: f64, friction: f64, speed: f64) -> f64 {
    speed * speed / (2.0 * friction * gravity)
}

/// Time in which friction on level ground stops a block of `speed`, v / (mu g), s.
pub fn stopping_time(gravity: f64, friction: f64, speed: f64) -> f64 {
    speed / (friction * gravity)
}

/// Work of friction on a slope over the distance `slip`, mu m g cos(slope) s, J.
pub fn friction_work(mass: f64, gravity: f64, slope: f64, friction: f64, slip: f64) -> f64 {
    friction * mass * gravity * cos(slope) * slip
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_accelerations() {
        for (degrees, known) in [(40.0f64, 3.2998), (60.0, 6.5337), (23.0, 0.2210)] {
            assert!((sliding_acceleration(9.81, degrees.to_radians(), 0.4) - known).abs() < 5e-5);
        }
        assert_eq!(acceleration_from_rest(9.81, 21.8f64.to_radians(), 0.4), 0.0);
        assert!(acceleration_from_rest(9.81, 21.9f64.to_radians(), 0.4) > 0.0);
    }

    #[test]
    fn front_speeds_of_the_flume() {
        // A block with mu = 0.4 released on 40 degrees passes 0.7 m at 2.149 m/s, and 1.2 m after 0.853 s.
        let a = sliding_acceleration(9.81, 40f64.to_radians(), 0.4);
        assert!(((2.0 * a * 0.7).sqrt() - 2.149).abs() < 5e-4);
        assert!((distance(a, 0.853) - 1.2).abs() < 1e-3);
    }

    #[test]
    fn stopping_turns_the_speed_into_heat() {
        let (m, g, mu, v) = (3.0, 9.81, 0.4, 1.7);
        let s = stopping_distance(g, mu, v);
        assert!((friction_work(m, g, 0.0, mu, s) - 0.5 * m * v * v).abs() < 1e-12);
        assert!((s - 0.5 * v * stopping_time(g, mu, v)).abs() < 1e-12);
    }
}
