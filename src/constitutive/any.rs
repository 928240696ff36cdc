//! All laws under one type: the only place that lists them.

use super::{DruckerPrager, Finger, Increment, Law, LinearElastic, MohrCoulomb, MuI, NeoHookean, PointState};
use super::{SofteningDruckerPrager, SofteningMohrCoulomb, VonMises};

/// Makes of the list of laws the type of any of them, what any of them needs at most, and `with_law`.
macro_rules! laws {
    ($dollar:tt $($law:ident),* $(,)?) => {
        /// Any of the laws, chosen once for a body.
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub enum AnyLaw {
            $(
                #[doc = concat!("See [`", stringify!($law), "`].")]
                $law($law),
            )*
        }

        /// The most that any law has for [`Law::HISTORY`].
        const MOST: usize = {
            let mut most = 0;
            $(
                most = if $law::HISTORY > most { $law::HISTORY } else { most };
            )*
            most
        };

        /// What an expression is with the law at hand, of its own type: `with_law!(any, law => law.p_wave_modulus())`.
        macro_rules! with_law {
            ($dollar any:expr, $dollar own:ident => $dollar value:expr) => {
                match $dollar any {
                    $($crate::constitutive::AnyLaw::$law($dollar own) => $dollar value,)*
                }
            };
        }
    };
}

laws! { $
    LinearElastic,
    DruckerPrager,
    NeoHookean,
    MohrCoulomb,
    VonMises,
    SofteningDruckerPrager,
    SofteningMohrCoulomb,
    MuI,
}

pub(crate) use with_law;

impl AnyLaw {
    /// How many numbers of its own the law at hand keeps at a point, see [`Law::HISTORY`].
    pub fn history(&self) -> usize {
        fn of<L: Law>(_: &L) -> usize {
            L::HISTORY
        }
        with_law!(self, law => of(law))
    }
}

impl Law for AnyLaw {
    const HISTORY: usize = MOST;

    fn update(&self, state: &mut PointState, increment: &Increment) -> f64 {
        with_law!(self, law => law.update(state, increment))
    }

    fn volume_ratio(&self, state: &PointState, before: f64, increment: &Increment) -> f64 {
        with_law!(self, law => law.volume_ratio(state, before, increment))
    }

    fn deformation(&self, state: &PointState) -> Option<Finger> {
        with_law!(self, law => law.deformation(state))
    }

    fn stored_energy(&self, state: &PointState) -> f64 {
        with_law!(self, law => law.stored_energy(state))
    }

    fn lame(&self) -> [f64; 2] {
        with_law!(self, law => law.lame())
    }

    fn p_wave_modulus(&self) -> f64 {
        with_law!(self, law => law.p_wave_modulus())
    }
}
