//! What every run of the flume must satisfy, whatever the paper says.

use crate::runs::Run;
use checkdam::check::{Check, Expected, Kind};

/// What the energy that is not accounted for is a share of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Energy {
    /// The largest kinetic energy, with which the force of an impact goes.
    Kinetic,
    /// The energy released, where inputs vary: a gate that opens slowly leaves next to no kinetic energy, and schemes are tried that lose some.
    Released,
}

/// What every run must satisfy; limit equilibrium only where the base and the barrier alone hold the deposit.
pub fn judge(rows: &[Run], energy: Energy, by_base_alone: &dyn Fn(&Run) -> bool) -> Vec<Check> {
    let worst = |of: &dyn Fn(&Run) -> f64| {
        rows.iter().map(of).fold(0.0, |a: f64, x| if x.is_nan() || a.is_nan() { f64::NAN } else { a.max(x) })
    };
    let at_rest = rows.iter().filter(|r| r.ended == "at rest").count() as f64 / rows.len() as f64;
    let bound = |what: &str, measured, limit, reason: &str| {
        Check::at_most(what, measured, limit, "1").because(reason).from(Kind::Conservation, "ledgers of all runs")
    };
    let mut checks = vec![
        Check::new("share of the runs that came to rest", at_rest, Expected::AtLeast(0.95), "1")
            .because(
                "runs that creep or chatter to the end time are left out; many of them would bias what is concluded",
            )
            .from(Kind::Conservation, "rest: 1e-4 of the energy, balanced and steady forces"),
        bound(
            "momentum not accounted for, largest",
            worst(&|r| r.get("momentum_closure_1")),
            1e-10,
            "round-off of sums",
        ),
        match energy {
            Energy::Kinetic => bound(
                "energy not accounted for over the largest kinetic energy, largest",
                worst(&|r| r.get("energy_residual_1") / r.get("kinetic_max_1")),
                0.03,
                "second-order terms of the transfers; the force of an impact goes with the kinetic energy, and more of it must not pass",
            ),
            Energy::Released => bound(
                "energy not accounted for over E0, largest",
                worst(&|r| r.get("energy_residual_1")),
                0.02,
                "second-order terms of the transfers; 2 % is where forces would begin to suffer",
            ),
        },
    ];
    if rows.iter().any(by_base_alone) {
        let share = |r: &Run| (r.get("static_force_n") - r.get("weight_along_n")).abs() / r.get("friction_limit_n");
        checks.push(bound(
            "|static force along the flume less weight| over what the base can give, largest",
            worst(&|r| if by_base_alone(r) && r.ended == "at rest" { share(r) } else { 0.0 }),
            1.02,
            "Coulomb's law at the base; 2 % for the unbalanced force that counts as rest",
        ));
    }
    checks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_that_breaks_a_law_is_seen() {
        let sound = [
            ("momentum_closure_1", 1e-15),
            ("energy_residual_1", 1e-3),
            ("kinetic_max_1", 0.2),
            ("static_force_n", 250.0),
            ("weight_along_n", 190.0),
            ("friction_limit_n", 90.0),
        ];
        let run = |numbers: &[(&'static str, f64)]| Run::with("40deg", "base", "", numbers);
        assert!(judge(&[run(&sound)], Energy::Kinetic, &|_| true).iter().all(Check::passes));
        let wrong = [
            ("momentum_closure_1", 1e-6),
            ("energy_residual_1", f64::NAN),
            ("energy_residual_1", 0.0063),
            ("static_force_n", 290.0),
        ];
        for (wrong, value) in wrong {
            let numbers: Vec<_> = sound.iter().map(|&(q, v)| (q, if q == wrong { value } else { v })).collect();
            assert_eq!(
                judge(&[run(&sound), run(&numbers)], Energy::Kinetic, &|_| true).iter().filter(|c| !c.passes()).count(),
                1,
                "{wrong}"
            );
        }
        let mut restless = run(&sound);
        restless.ended = "end time".into();
        assert!(judge(&[restless], Energy::Kinetic, &|_| true).iter().any(|c| !c.passes()));
    }
}
