//! Two elastic bars that strike each other end on: the exact wave solution by characteristics.
//!
//! The first bar lies at x < 0 and moves at v1, the second at x > 0 and moves at v2 < v1; both are free of stress and of equal
//! cross-section. Along dx/dt = +c the sum p + Z v of pressure and impedance times velocity stays constant, along dx/dt = -c
//! the difference p - Z v. At a free end p = 0, so what arrives at the interface is what left it one round trip earlier, with
//! its pressure reversed. Both bars together give pressure and velocity at the interface, constant between the arrivals
//! (Saint-Venant 1867; Johnson 1972).

/// A bar.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bar {
    /// Density, kg/m3.
    pub density: f64,
    /// Wave speed, m/s.
    pub speed: f64,
    /// Length, m.
    pub length: f64,
    /// Velocity before the impact, m/s.
    pub velocity: f64,
}

impl Bar {
    /// Impedance rho c, Pa s/m.
    pub fn impedance(&self) -> f64 {
        self.density * self.speed
    }

    /// Time of a wave to the free end and back, s.
    pub fn round_trip(&self) -> f64 {
        2.0 * self.length / self.speed
    }
}

/// A stretch of time with constant pressure at the interface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Phase {
    /// Start and end since the impact, s.
    pub time: [f64; 2],
    /// Pressure, Pa.
    pub pressure: f64,
    /// Velocity of the interface, m/s.
    pub velocity: f64,
}

/// Pressure (Pa, positive in compression) and velocity (m/s) of the interface right after the impact: the two impedances share
/// the difference of the velocities.
pub fn first_contact(first: &Bar, second: &Bar) -> (f64, f64) {
    let (z1, z2) = (first.impedance(), second.impedance());
    let pressure = z1 * z2 / (z1 + z2) * (first.velocity - second.velocity);
    (pressure, first.velocity - pressure / z1)
}

/// All phases of the impact until the bars part. A phase without pressure means that they move along together.
pub fn phases(first: &Bar, second: &Bar) -> Vec<Phase> {
    let (z1, z2) = (first.impedance(), second.impedance());
    let (t1, t2) = (first.round_trip(), second.round_trip());
    let mut phases: Vec<Phase> = Vec::new();
    let mut start = 0.0;
    // Pressure or tension below this share of the first contact's is round-off.
    let nothing = 1e-9 * first_contact(first, second).0;
    loop {
        // What arrives now: from the undisturbed bar, or from the interface one round trip ago.
        let now = start + 1e-9 * t1.min(t2);
        let earlier = |trip: f64| {
            let then = now - trip;
            phases.iter().find(|p| p.time[0] <= then && then < p.time[1]).copied()
        };
        let right = earlier(t1).map_or(z1 * first.velocity, |p| z1 * p.velocity - p.pressure);
        let left = earlier(t2).map_or(-z2 * second.velocity, |p| -(z2 * p.velocity + p.pressure));
        let velocity = (right - left) / (z1 + z2);
        let pressure = right - z1 * velocity;
        if pressure < -nothing {
            return phases;
        }
        let pressure = if pressure < nothing { 0.0 } else { pressure };
        // Until the next arrival: one round trip after the start of any phase.
        let arrivals = phases.iter().map(|p| p.time[0]).chain([start]).flat_map(|s| [s + t1, s + t2]);
        let end = arrivals.filter(|&t| t > now).fold(f64::INFINITY, f64::min);
        phases.push(Phase { time: [start, end], pressure, velocity });
        start = end;
    }
}

/// Impulse per area that the first bar gives to the second until they part, Pa s.
pub fn impulse(phases: &[Phase]) -> f64 {
    phases.iter().map(|p| p.pressure * (p.time[1] - p.time[0])).sum()
}

/// Mean velocities of the two bars after they have parted, m/s. Bars that vibrate keep energy that their mean motion misses.
pub fn exit_velocities(first: &Bar, second: &Bar) -> [f64; 2] {
    let j = impulse(&phases(first, second));
    [first.velocity - j / (first.density * first.length), second.velocity + j / (second.density * second.length)]
}

/// Share of the relative velocity with which two bars part.
pub fn restitution(first: &Bar, second: &Bar) -> f64 {
    let [after1, after2] = exit_velocities(first, second);
    (after2 - after1) / (first.velocity - second.velocity)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bar(density: f64, speed: f64, length: f64, velocity: f64) -> Bar {
        Bar { density, speed, length, velocity }
    }

    #[test]
    fn equal_bars_swap_their_velocities() {
        let (a, b) = (bar(1000.0, 50.0, 0.6, 3.0), bar(1000.0, 50.0, 0.6, 0.5));
        let all = phases(&a, &b);
        assert_eq!(all.len(), 1);
        assert!((all[0].time[1] - 0.024).abs() < 1e-12, "2 L / c");
        assert!((all[0].pressure - 0.5 * 5e4 * 2.5).abs() < 1e-9);
        let [va, vb] = exit_velocities(&a, &b);
        assert!((va - 0.5).abs() < 1e-12 && (vb - 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_short_bar_stops_and_waits_for_the_wave_in_the_long_one() {
        // The same material, L2 = 2.5 L1: the force lasts 2 L1/c, the contact 2 L2/c, restitution L1/L2.
        let (a, b) = (bar(1000.0, 50.0, 0.4, 1.0), bar(1000.0, 50.0, 1.0, 0.0));
        let all = phases(&a, &b);
        let pressed: f64 = all.iter().filter(|p| p.pressure > 0.0).map(|p| p.time[1] - p.time[0]).sum();
        assert!((pressed - 0.016).abs() < 1e-9 && (all.last().expect("a phase").time[1] - 0.04).abs() < 1e-9);
        assert!((restitution(&a, &b) - 0.4).abs() < 1e-9);
        assert!(exit_velocities(&a, &b)[0].abs() < 1e-12);
    }

    #[test]
    fn impedances_share_the_impact() {
        // Sand of 1 MPa and 1530 kg/m3 against barriers of 2400 kg/m3: velocity of the interface over that of the flow.
        for (young, share) in [(0.5e6, 0.530), (2e6, 0.361), (10e6, 0.202), (20e6, 0.151)] {
            let sand = bar(1530.0, (1e6f64 / 1530.0).sqrt(), 1.0, 3.0);
            let barrier = bar(2400.0, (young / 2400.0f64).sqrt(), 1.0, 0.0);
            let (pressure, velocity) = first_contact(&sand, &barrier);
            assert!((velocity / 3.0 - share).abs() < 5e-4, "{young}: {}", velocity / 3.0);
            assert!((pressure - barrier.impedance() * velocity).abs() < 1e-9);
        }
    }

    #[test]
    fn bars_of_unequal_impedance() {
        // Impedances 1 : 3 and equal round trips: one phase.
        let (a, b) = (bar(1000.0, 10.0, 1.0, 1.0), bar(1500.0, 20.0, 2.0, 0.0));
        let all = phases(&a, &b);
        assert_eq!(all.len(), 1);
        let [va, vb] = exit_velocities(&a, &b);
        // p = 7500 Pa for 0.2 s on 1000 and 3000 kg/m2: both are back to uniform motion, and no energy is lost.
        assert!((va + 0.5).abs() < 1e-12 && (vb - 0.5).abs() < 1e-12);
        assert!((1000.0 * va * va + 3000.0 * vb * vb - 1000.0).abs() < 1e-9);
        // A short hard bar pushes a long soft one step by step, each (Z1 - Z2)/(Z1 + Z2) = 1/3 of the one before.
        let (a, b) = (bar(2000.0, 10.0, 1.0, 1.0), bar(1000.0, 10.0, 5.0, 0.0));
        let all = phases(&a, &b);
        let pushes: Vec<f64> = all.iter().map(|p| p.pressure).collect();
        assert!(pushes.len() >= 4, "{all:?}");
        for pair in pushes.windows(2).take(3) {
            assert!((pair[1] / pair[0] - 1.0 / 3.0).abs() < 1e-6, "{pushes:?}");
        }
        assert!((pushes[0] - 2e4 / 3.0).abs() < 1e-9);
    }
}
