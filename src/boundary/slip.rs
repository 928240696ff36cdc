//! Friction that needs slip before it resists in full.
//!
//! The traction of Coulomb friction is elastic-plastic in slip. Its elastic part is the slip that springs back: traction over pressure
//! grows with it in proportion and is the static coefficient where it is the slip length. Beyond the strength, slip is plastic. The
//! strength falls from static to kinetic over one slip length of plastic slip, and is regained over one slip length of elastic slip.
//!
//! Sources: slip before sliding is in Mindlin 1949, and elastic slip over a length as a friction law of interfaces in Oden and Pires 1983.
//! With a stiffness in proportion to the pressure it is the *stiffness method* of general finite-element codes. Sand on steel needs 0.3 to
//! 1 mm until it slides (Uesugi and Kishida 1986). Linear slip weakening is in Ida 1972 and in Palmer and Rice 1973.
//!
//! Elsewhere: shear displacement to peak, elastic slip, penalty friction; breakdown or critical slip distance.

use crate::seeded::{self, Seed};

/// Friction that is mobilised by slip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlipLaw {
    /// Elastic slip at which the static coefficient is reached, m; above 0.
    pub length: f64,
    /// Friction coefficient of a contact that has not slid.
    pub peak: f64,
    /// Friction coefficient after a slip length of sliding, at most `peak`.
    pub kinetic: f64,
}

/// Slip of a piece of surface: what a contact remembers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Slipped {
    /// Elastic slip along the tangent, m.
    pub elastic: f64,
    /// Plastic slip that has weakened it, 0 to the slip length, m.
    pub worn: f64,
}

impl SlipLaw {
    /// Traction over pressure and elastic slip, 1/m.
    pub fn stiffness(&self) -> f64 {
        seeded::times(Seed::BoundarySlip, self.peak / self.length)
    }

    /// Largest traction over pressure of a contact that is worn so far (m).
    pub fn strength(&self, worn: f64) -> f64 {
        let worn = if seeded::is(Seed::BoundaryWear) { 0.0 } else { worn };
        self.kinetic + (self.peak - self.kinetic) * (1.0 - worn / self.length).clamp(0.0, 1.0)
    }

    /// Largest elastic slip of a contact that is worn so far (m), m.
    pub fn reach(&self, worn: f64) -> f64 {
        self.strength(worn) / self.stiffness()
    }

    /// The state after more slip (m).
    pub fn after(&self, at: Slipped, slip: f64) -> Slipped {
        let (reach, trial) = (self.reach(at.worn), at.elastic + slip);
        let elastic = trial.clamp(-reach, reach);
        let plastic = (trial - elastic).abs();
        let worn = if plastic > 0.0 { at.worn + plastic } else { at.worn - slip.abs() };
        let worn = worn.clamp(0.0, self.length);
        // The strength that is lost takes elastic slip with it.
        let reach = self.reach(worn);
        Slipped { elastic: elastic.clamp(-reach, reach), worn }
    }

    /// Friction impulse (N s) of a step of `dt` (s) under the normal impulse `normal` (N s), where without it the material would slip at
    /// `free` (m/s), and an impulse changes that by `mobility` (1/kg) of it.
    ///
    /// The force follows the slip at the beginning of the step, which conserves energy, where the step resolves how the mass swings on
    /// the elastic slip; where it does not, it follows the slip within the step so far that nothing oscillates. For a slip length of
    /// zero that is the rigid law.
    pub fn impulse(&self, at: Slipped, dt: f64, normal: f64, free: f64, mobility: f64) -> f64 {
        if normal <= 0.0 {
            return 0.0;
        }
        let stiffness = self.stiffness() * normal;
        let swing = stiffness * dt * mobility;
        let within = (1.0 - 1.0 / swing).max(0.0);
        let elastic = (at.elastic + within * dt * free) / (1.0 + within * swing);
        let limit = self.strength(at.worn) * normal;
        (-stiffness * elastic).clamp(-limit, limit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: SlipLaw = SlipLaw { length: 1e-3, peak: 0.5, kinetic: 0.4 };
    const PLAIN: SlipLaw = SlipLaw { length: 1e-3, peak: 0.4, kinetic: 0.4 };

    fn slide(law: &SlipLaw, mut at: Slipped, to: f64, steps: u32) -> (Slipped, f64) {
        let mut largest = 0.0f64;
        for _ in 0..steps {
            at = law.after(at, to / f64::from(steps));
            largest = largest.max(law.stiffness() * at.elastic.abs());
        }
        (at, largest)
    }

    #[test]
    fn traction_grows_to_the_static_coefficient_and_falls_to_the_kinetic_one() {
        let (half, _) = slide(&LAW, Slipped::default(), 0.5e-3, 1000);
        assert!((LAW.stiffness() * half.elastic - 0.25).abs() < 1e-12 && half.worn == 0.0);
        let (all, largest) = slide(&LAW, Slipped::default(), 3e-3, 30000);
        assert!((largest - 0.5).abs() < 1e-3, "{largest}");
        assert!((LAW.stiffness() * all.elastic - 0.4).abs() < 1e-12 && all.worn == LAW.length);
        // Springing back as far renews the static strength, on the other side.
        let (back, _) = slide(&LAW, all, -0.8e-3, 1000);
        assert!(back.elastic.abs() < 1e-12 && (back.worn - 0.2e-3).abs() < 1e-12);
        let (_, largest) = slide(&LAW, back, -3e-3, 30000);
        assert!((largest - 0.5).abs() < 1e-3, "{largest}");
    }

    #[test]
    fn either_way_is_the_same() {
        let one = slide(&LAW, Slipped { elastic: 2e-4, worn: 3e-4 }, 1.7e-3, 100).0;
        let other = slide(&LAW, Slipped { elastic: -2e-4, worn: 3e-4 }, -1.7e-3, 100).0;
        assert_eq!((one.elastic, one.worn), (-other.elastic, other.worn));
    }

    #[test]
    fn a_mass_swings_on_the_elastic_slip_without_loss() {
        // 2 kg, 100 N: 0.4 x 100 N / 1 mm.
        let (mass, dt, force) = (2.0, 1e-4, 100.0);
        let (mut at, mut v) = (Slipped { elastic: 0.9e-3, worn: 0.0 }, 0.0);
        let (mut turns, mut largest) = (0, 0.0f64);
        for step in 0..100_000 {
            let before = v;
            v += PLAIN.impulse(at, dt, force * dt, v, 1.0 / mass) / mass;
            at = PLAIN.after(at, dt * v);
            turns += usize::from(before * v < 0.0);
            if step > 99_000 {
                largest = largest.max(at.elastic.abs());
            }
        }
        let period = 2.0 * std::f64::consts::PI * (mass / (PLAIN.stiffness() * force)).sqrt();
        assert!((turns as f64 * 0.5 * period / 10.0 - 1.0).abs() < 0.01, "{turns} turns of {period} s");
        assert!((largest / 0.9e-3 - 1.0).abs() < 0.01, "{largest}");
    }

    #[test]
    fn without_length_it_is_the_rigid_law() {
        let law = SlipLaw { length: 1e-12, ..PLAIN };
        // 2 kg at 0.1 m/s: 0.2 N s would stop it.
        for (normal, expected) in [(1.0, -0.2), (0.1, -0.04), (0.0, 0.0)] {
            let given = law.impulse(Slipped::default(), 1e-4, normal, 0.1, 0.5);
            assert!((given - expected).abs() < 1e-6, "{given} for {normal} N s");
        }
    }
}
