//! The logarithm of the volume ratio, without branches.

// The series and the reduction are those of FreeBSD's s_log1p.c:
//
// Copyright (C) 1993 by Sun Microsystems, Inc. All rights reserved.
// Developed at SunPro, a Sun Microsystems, Inc. business. Permission to use, copy, modify, and distribute this software is freely
// granted, provided that this notice is preserved.

/// ln 2: its leading bits, and the rest.
const LN2: [f64; 2] = [f64::from_bits(0x3fe6_2e42_fee0_0000), f64::from_bits(0x3dea_39ef_3579_3c76)];
/// Coefficients of the even powers of f / (2 + f).
const SERIES: [f64; 7] = [
    f64::from_bits(0x3fe5_5555_5555_5593),
    f64::from_bits(0x3fd9_9999_9997_fa04),
    f64::from_bits(0x3fd2_4924_9422_9359),
    f64::from_bits(0x3fcc_71c5_1d8e_78af),
    f64::from_bits(0x3fc7_4664_96cb_03de),
    f64::from_bits(0x3fc3_9a09_d078_c69f),
    f64::from_bits(0x3fc2_f112_df3e_5244),
];
/// The upper half of the bits of sqrt(2)/2.
const ROOT: u64 = 0x3fe6_a09e << 32;
/// From -NEAR[0] to NEAR[1], 1 + x lies between sqrt(2)/2 and sqrt(2).
const NEAR: [f64; 2] = [f64::from_bits(0x3fd2_bec5 << 32), f64::from_bits(0x3fda_827a << 32)];
/// 2^52, to whose bits a small whole number can be added as such.
const WHOLE: f64 = 4_503_599_627_370_496.0;

/// ln(1 + x), the bits of [`libm::log1p`] for any x (but which of the bits of what is not a number). That decides case by case;
/// here all cases are computed and one is selected, so that a loop over points becomes vector instructions.
#[inline(always)]
pub fn log1p(x: f64) -> f64 {
    // 1 + x = 2^k (1 + f), and what rounding took from 1 + x.
    let sum = 1.0 + x;
    let bits = sum.to_bits().wrapping_add((0x3ff0_0000 << 32) - ROOT);
    let exponent = (bits >> 52) & 0xfff;
    let k = f64::from_bits(WHOLE.to_bits() | exponent) - (WHOLE + 1023.0);
    let reduced = f64::from_bits((bits & 0x000f_ffff_ffff_ffff) + ROOT) - 1.0;
    let lost = if k >= 2.0 { 1.0 - (sum - x) } else { x - (sum - 1.0) };
    let lost = if k < 54.0 { lost / sum } else { 0.0 };
    let near = (x > -NEAR[0]) & (x < NEAR[1]);
    let (f, k, lost) = (if near { x } else { reduced }, if near { 0.0 } else { k }, if near { 0.0 } else { lost });

    let half_square = 0.5 * f * f;
    let s = f / (2.0 + f);
    let z = s * s;
    let w = z * z;
    let even = w * (SERIES[1] + w * (SERIES[3] + w * SERIES[5]));
    let odd = z * (SERIES[0] + w * (SERIES[2] + w * (SERIES[4] + w * SERIES[6])));
    let y = s * (half_square + (odd + even)) + (k * LN2[1] + lost) - half_square + f + k * LN2[0];

    let y = if x.abs() < f64::EPSILON * 0.5 { x } else { y };
    // Infinity, and what is not a number.
    let y = if x < f64::INFINITY { y } else { x };
    let y = if x == -1.0 { f64::NEG_INFINITY } else { y };
    if x < -1.0 { f64::NAN } else { y }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scaffold::Lcg;

    fn same(x: f64) {
        let (found, expected) = (log1p(x), libm::log1p(x));
        let same = found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan();
        assert!(same, "{x:e}: {found:e} {expected:e}");
    }

    #[test]
    fn the_bits_are_those_of_libm() {
        let mut rng = Lcg::new(5);
        for _ in 0..200_000 {
            same(rng.signed());
            same(1e-3 * rng.signed());
            same(10.0 * rng.signed());
            // Any exponent.
            same(rng.signed() * f64::exp2((1023.0 * rng.signed()).round()));
        }
    }

    #[test]
    fn so_are_they_where_cases_meet() {
        let edges =
            [0.0, NEAR[0], NEAR[1], 0.5, 1.0, 3.0, WHOLE, 4.0 * WHOLE, f64::EPSILON, f64::MIN_POSITIVE, f64::MAX];
        for edge in edges.into_iter().chain([f64::EPSILON / 2.0, f64::EPSILON / 4.0, f64::INFINITY, f64::NAN]) {
            let (mut up, mut down) = (edge, edge);
            for _ in 0..1000 {
                [up, -up, down, -down].into_iter().for_each(same);
                (up, down) = (up.next_up(), down.next_down());
            }
        }
    }
}
