//! A law of one's own: a viscous fluid that remembers nothing but its pressure, at one point of a shear flow.
//!
//! A law maps a state and an increment to a state. It is generic: to let a case choose it, it becomes a line in the list of laws;
//! see "Add a constitutive law" in CONTRIBUTING.md.
//!
//! ```sh
//! cargo run --release --example own_law
//! ```

use checkdam::constitutive::{Increment, Law, PointState, Stress};

/// A compressible Newtonian fluid.
#[derive(Debug, Clone, Copy)]
struct Newtonian {
    /// Bulk modulus, Pa.
    bulk: f64,
    /// Shear viscosity, Pa s.
    viscosity: f64,
}

impl Law for Newtonian {
    fn update(&self, state: &mut PointState, increment: &Increment) -> f64 {
        let before = state.stress;
        // A fluid has no shear stress but that of the present rate, so there is nothing to turn with the material.
        let mean = before.mean() + self.bulk * increment.volumetric();
        state.stress = increment.deviator().times(2.0 * self.viscosity / increment.dt).plus_mean(mean);
        increment.midpoint_work(&before, &state.stress)
    }

    fn stored_energy(&self, state: &PointState) -> f64 {
        0.5 * state.stress.mean().powi(2) / self.bulk
    }

    fn lame(&self) -> [f64; 2] {
        [self.bulk, 0.0]
    }

    fn p_wave_modulus(&self) -> f64 {
        self.bulk
    }
}

/// Stress after a second of simple shear at `rate` (1/s), Pa.
fn sheared(law: &Newtonian, rate: f64) -> Stress {
    let (mut state, dt) = (PointState::default(), 1e-3);
    let increment = Increment { dt, xy: 0.5 * rate * dt, spin: -0.5 * rate * dt, ..Increment::default() };
    for _ in 0..1000 {
        law.update(&mut state, &increment);
    }
    state.stress
}

fn main() {
    let law = Newtonian { bulk: 1e6, viscosity: 20.0 };
    for rate in [1.0, 10.0, 100.0] {
        println!("shear rate {rate:5} 1/s: shear stress {:7.1} Pa", sheared(&law, rate).xy);
    }
}

#[test]
fn stress_is_viscosity_times_rate() {
    let law = Newtonian { bulk: 1e6, viscosity: 20.0 };
    for rate in [1.0, 100.0] {
        let stress = sheared(&law, rate);
        assert!((stress.xy - law.viscosity * rate).abs() < 1e-9 * stress.xy && stress.mean() == 0.0, "{stress:?}");
    }
}
