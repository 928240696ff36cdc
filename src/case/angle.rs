//! Directions from angles in degrees, as case files have them.

/// Unit vector at this angle from the x axis; exact for multiples of 90 degrees.
pub fn direction(angle_deg: f64) -> [f64; 2] {
    let quarter_turns = angle_deg / 90.0;
    if quarter_turns.fract() == 0.0 {
        match quarter_turns.rem_euclid(4.0) as u8 {
            0 => [1.0, 0.0],
            1 => [0.0, 1.0],
            2 => [-1.0, 0.0],
            _ => [0.0, -1.0],
        }
    } else {
        let angle = angle_deg.to_radians();
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        [cos, sin]
    }
}
