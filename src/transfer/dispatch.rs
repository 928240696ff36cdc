//! Runs the transfer loops for the shape function, the law and the processor at hand.
//!
//! Every loop is compiled three times: for the plain target, for AVX2 and for AVX-512. Only the width of the vectors differs;
//! no fused multiply-add is used, so the bits are the same (tested). Calling a function compiled for AVX2 or AVX-512 is
//! `unsafe`; it is done after the processor has said that it has it. The only other `unsafe` of the crate is in [`crate::vector`].
#![allow(unsafe_code)]

use super::kernels::{self, Shaped};
use super::{Scatter, StressUpdate, Transfer, VelocityUpdate};
use crate::band::{BandSums, NodeSum};
use crate::body::{Particle, Points};
use crate::constitutive::{AnyLaw, Law, with_law};
use crate::lanes::Lane;
use crate::shape::{AveragedHat, Hat, Shape1d};
use crate::vector::Plain;
#[cfg(target_arch = "x86_64")]
use crate::vector::{Avx2, Avx512};
use std::sync::atomic::{AtomicU8, Ordering};

/// Instruction sets that the loops are compiled for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum VectorUnit {
    /// Whatever the build target guarantees.
    Plain = 1,
    /// 256 bits.
    Avx2 = 2,
    /// 512 bits.
    Avx512 = 3,
}

static UNIT: AtomicU8 = AtomicU8::new(0);

/// The widest instruction set of this processor, found once.
pub fn vector_unit() -> VectorUnit {
    match UNIT.load(Ordering::Relaxed) {
        1 => VectorUnit::Plain,
        2 => VectorUnit::Avx2,
        3 => VectorUnit::Avx512,
        _ => {
            let found = detect();
            UNIT.store(found as u8, Ordering::Relaxed);
            found
        }
    }
}

/// Restricts the loops to `unit`, or to the widest available if that is less. For tests and benches.
pub fn limit_vector_unit(unit: VectorUnit) {
    UNIT.store(unit.min(detect()) as u8, Ordering::Relaxed);
}

fn detect() -> VectorUnit {
    #[cfg(target_arch = "x86_64")]
    {
        if is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512vl")
        {
            return VectorUnit::Avx512;
        }
        if is_x86_feature_detected!("avx2") {
            return VectorUnit::Avx2;
        }
    }
    VectorUnit::Plain
}

/// Compiles `$name` of [`kernels`] for each instruction set and calls the one found.
macro_rules! by_vector_unit {
    ($name:ident, [$($gen:ident : $bound:path),*], [$(const $c:ident),*], ($($arg:ident : $ty:ty),* $(,)?) $(-> $ret:ty)?) => {
        fn $name<$($gen: $bound,)* $(const $c: bool,)*>($($arg: $ty),*) $(-> $ret)? {
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2")]
                fn avx2<$($gen: $bound,)* $(const $c: bool,)*>($($arg: $ty),*) $(-> $ret)? {
                    kernels::$name::<Avx2, $($gen,)* $($c,)*>($($arg),*)
                }
                #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2")]
                fn avx512<$($gen: $bound,)* $(const $c: bool,)*>($($arg: $ty),*) $(-> $ret)? {
                    kernels::$name::<Avx512, $($gen,)* $($c,)*>($($arg),*)
                }
                match vector_unit() {
                    // SAFETY: `detect` has seen that this processor has AVX-512F, DQ and VL.
                    VectorUnit::Avx512 => return unsafe { avx512::<$($gen,)* $($c,)*>($($arg),*) },
                    // SAFETY: `detect` has seen that this processor has AVX2.
                    VectorUnit::Avx2 => return unsafe { avx2::<$($gen,)* $($c,)*>($($arg),*) },
                    VectorUnit::Plain => {}
                }
            }
            kernels::$name::<Plain, $($gen,)* $($c,)*>($($arg),*)
        }
    };
}

mod wide {
    use super::*;

    by_vector_unit!(scatter, [S: Shape1d], [const INERTIA, const FORCE], (
        with: Shaped<'_, S>, points: &Points, sums: &mut [NodeSum],
    ));
    by_vector_unit!(gather_velocity, [S: Shape1d], [const REMAP], (
        with: Shaped<'_, S>, update: VelocityUpdate, motion: &[[f64; 4]],
        points: &mut Points, displacement: &mut [[Lane; 2]], momentum: &mut [[f64; 2]],
    ) -> BandSums);
    by_vector_unit!(update_stress, [S: Shape1d, L: Law], [], (
        with: Shaped<'_, S>, law: L, update: StressUpdate,
        velocity: &[[f64; 2]], points: &mut Points, displacement: &mut [[Lane; 2]],
    ) -> BandSums);

    pub(super) fn scatter_what<S: Shape1d>(what: Scatter, with: Shaped<'_, S>, points: &Points, sums: &mut [NodeSum]) {
        match what {
            Scatter::All => scatter::<S, true, true>(with, points, sums),
            Scatter::Inertia => scatter::<S, true, false>(with, points, sums),
            Scatter::Force => scatter::<S, false, true>(with, points, sums),
        }
    }

    pub(super) fn gather<S: Shape1d>(
        with: Shaped<'_, S>,
        update: VelocityUpdate,
        motion: &[[f64; 4]],
        points: &mut Points,
        displacement: &mut [[Lane; 2]],
        momentum: &mut [[f64; 2]],
    ) -> BandSums {
        if update.remap {
            gather_velocity::<S, true>(with, update, motion, points, displacement, momentum)
        } else {
            gather_velocity::<S, false>(with, update, motion, points, displacement, momentum)
        }
    }

    pub(super) fn stress<S: Shape1d>(
        with: Shaped<'_, S>,
        law: AnyLaw,
        update: StressUpdate,
        velocity: &[[f64; 2]],
        points: &mut Points,
        displacement: &mut [[Lane; 2]],
    ) -> BandSums {
        with_law!(law, law => update_stress(with, law, update, velocity, points, displacement))
    }
}

/// What an expression is with the shape function of a transfer, of its own type.
macro_rules! with_shape {
    ($transfer:expr, $with:ident => $value:expr) => {{
        let Transfer { half_width, ref map, constants } = *$transfer;
        if half_width > 0.0 {
            let $with = Shaped { shape: AveragedHat::new(half_width), map, constants };
            $value
        } else {
            let $with = Shaped { shape: Hat, map, constants };
            $value
        }
    }};
}

// Points, displacements and nodal fields are arguments of their own: of borrows in a struct the compiler does not know that they
// are apart.
impl Transfer<'_> {
    /// Particle to grid.
    pub fn scatter(&self, what: Scatter, points: &Points, sums: &mut [NodeSum]) {
        with_shape!(self, with => wide::scatter_what(what, with, points, sums));
    }

    /// Particle to grid: the force of a field of accelerations (m/s2).
    pub fn scatter_field(&self, acceleration: &dyn Fn(&Particle) -> [f64; 2], points: &Points, force: &mut [[f64; 2]]) {
        with_shape!(self, with => kernels::scatter_field(with, acceleration, points, force));
    }

    /// Grid to particle: velocity, displacement, and (MUSL) the momentum mapped back, added to `momentum`.
    pub fn gather_velocity(
        &self,
        update: VelocityUpdate,
        motion: &[[f64; 4]],
        points: &mut Points,
        displacement: &mut [[Lane; 2]],
        momentum: &mut [[f64; 2]],
    ) -> BandSums {
        with_shape!(self, with => wide::gather(with, update, motion, points, displacement, momentum))
    }

    /// Grid to particle: strain, stress, volume, and the move of the step.
    pub fn update_stress(
        &self,
        law: AnyLaw,
        update: StressUpdate,
        velocity: &[[f64; 2]],
        points: &mut Points,
        displacement: &mut [[Lane; 2]],
    ) -> BandSums {
        with_shape!(self, with => wide::stress(with, law, update, velocity, points, displacement))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_kept_where_the_processor_goes_further() {
        // Other tests may run meanwhile: their numbers do not depend on it.
        for unit in [VectorUnit::Plain, VectorUnit::Avx2, VectorUnit::Avx512] {
            limit_vector_unit(unit);
            assert_eq!(vector_unit(), unit.min(detect()));
        }
    }
}
