//! Runs the transfer loops for the shape function, the law and the processor at hand.
//!
//! Every loop is compiled three times: for the plain target, for AVX2 and for AVX-512. Only the width of the vectors differs;
//! no fused multiply-add is used, so the bits are the same (tested). Calling a function compiled for AVX2 or AVX-512 is
//! `unsafe`; it is done after the processor has said that it has it. The only other `unsafe` of the crate is in [`crate::vector`].
#![allow(unsafe_code)]
#![expect(clippy::too_many_arguments, reason = "of borrows in a struct the compiler does not know that they are apart")]

use super::{NodeMap, PointConstants, Scatter, StressUpdate, VelocityUpdate, kernels};
use crate::band::{BandSums, NodeSum};
use crate::body::{Particle, Points};
use crate::constitutive::{AnyLaw, Law};
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
        shape: S, map: &NodeMap, constants: PointConstants, points: &Points, sums: &mut [NodeSum],
    ));
    by_vector_unit!(gather_velocity, [S: Shape1d], [const REMAP], (
        shape: S, map: &NodeMap, constants: PointConstants, update: VelocityUpdate, motion: &[[f64; 4]],
        points: &mut Points, displacement: &mut [[Lane; 2]], momentum: &mut [[f64; 2]],
    ) -> BandSums);
    by_vector_unit!(update_stress, [S: Shape1d, L: Law], [], (
        shape: S, law: L, map: &NodeMap, constants: PointConstants, update: StressUpdate,
        velocity: &[[f64; 2]], points: &mut Points, displacement: &mut [[Lane; 2]],
    ) -> BandSums);

    pub(super) fn scatter_shape<S: Shape1d>(
        what: Scatter,
        shape: S,
        map: &NodeMap,
        constants: PointConstants,
        points: &Points,
        sums: &mut [NodeSum],
    ) {
        match what {
            Scatter::All => scatter::<S, true, true>(shape, map, constants, points, sums),
            Scatter::Inertia => scatter::<S, true, false>(shape, map, constants, points, sums),
            Scatter::Force => scatter::<S, false, true>(shape, map, constants, points, sums),
        }
    }

    pub(super) fn gather_shape<S: Shape1d>(
        shape: S,
        map: &NodeMap,
        constants: PointConstants,
        update: VelocityUpdate,
        motion: &[[f64; 4]],
        points: &mut Points,
        displacement: &mut [[Lane; 2]],
        momentum: &mut [[f64; 2]],
    ) -> BandSums {
        if update.remap {
            gather_velocity::<S, true>(shape, map, constants, update, motion, points, displacement, momentum)
        } else {
            gather_velocity::<S, false>(shape, map, constants, update, motion, points, displacement, momentum)
        }
    }

    pub(super) fn stress_shape<S: Shape1d>(
        shape: S,
        law: AnyLaw,
        map: &NodeMap,
        constants: PointConstants,
        update: StressUpdate,
        velocity: &[[f64; 2]],
        points: &mut Points,
        displacement: &mut [[Lane; 2]],
    ) -> BandSums {
        match law {
            AnyLaw::LinearElastic(law) => {
                update_stress(shape, law, map, constants, update, velocity, points, displacement)
            }
            AnyLaw::DruckerPrager(law) => {
                update_stress(shape, law, map, constants, update, velocity, points, displacement)
            }
            AnyLaw::NeoHookean(law) => {
                update_stress(shape, law, map, constants, update, velocity, points, displacement)
            }
        }
    }
}

/// Particle to grid. `half_width` is that of the shape function's averaging box in cells, 0 for linear shape functions.
pub fn scatter(
    what: Scatter,
    half_width: f64,
    map: &NodeMap,
    constants: PointConstants,
    points: &Points,
    sums: &mut [NodeSum],
) {
    if half_width > 0.0 {
        let shape = AveragedHat::new(half_width);
        wide::scatter_shape(what, shape, map, constants, points, sums);
    } else {
        wide::scatter_shape(what, Hat, map, constants, points, sums);
    }
}

/// Particle to grid: the force of a field of accelerations (m/s2) on points of the given mass.
pub fn scatter_field(
    half_width: f64,
    map: &NodeMap,
    mass: f64,
    acceleration: &dyn Fn(&Particle) -> [f64; 2],
    points: &Points,
    force: &mut [[f64; 2]],
) {
    if half_width > 0.0 {
        kernels::scatter_field(AveragedHat::new(half_width), map, mass, acceleration, points, force);
    } else {
        kernels::scatter_field(Hat, map, mass, acceleration, points, force);
    }
}

/// Grid to particle: velocity, displacement, and (MUSL) the momentum mapped back, added to `momentum`.
pub fn gather_velocity(
    half_width: f64,
    map: &NodeMap,
    constants: PointConstants,
    update: VelocityUpdate,
    motion: &[[f64; 4]],
    points: &mut Points,
    displacement: &mut [[Lane; 2]],
    momentum: &mut [[f64; 2]],
) -> BandSums {
    if half_width > 0.0 {
        let shape = AveragedHat::new(half_width);
        wide::gather_shape(shape, map, constants, update, motion, points, displacement, momentum)
    } else {
        wide::gather_shape(Hat, map, constants, update, motion, points, displacement, momentum)
    }
}

/// Grid to particle: strain, stress, volume, and the move of the step.
pub fn update_stress(
    half_width: f64,
    law: AnyLaw,
    map: &NodeMap,
    constants: PointConstants,
    update: StressUpdate,
    velocity: &[[f64; 2]],
    points: &mut Points,
    displacement: &mut [[Lane; 2]],
) -> BandSums {
    if half_width > 0.0 {
        let shape = AveragedHat::new(half_width);
        wide::stress_shape(shape, law, map, constants, update, velocity, points, displacement)
    } else {
        wide::stress_shape(Hat, law, map, constants, update, velocity, points, displacement)
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
