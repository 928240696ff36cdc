//! Blocks of eight: the width in which the hot loops work.
//!
//! A [`Lane`] holds one quantity of eight material points. Loops over lanes are plain Rust that the compiler turns into
//! vector instructions; every lane does the same IEEE operations whatever the vector width, so the bits do not depend on the
//! processor.
//!
//! Elsewhere: SIMD by autovectorisation.

/// Material points per block.
pub const LANES: usize = 8;

/// One scalar quantity of the material points of a block.
pub type Lane = [f64; LANES];

/// Largest double below which [`floor_to_int`] is exact: 1.5 x 2^52, whose unit in the last place is 1.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// Integer part and remainder of `u >= 0`: `(b, u - b)` with `b` an integer and the remainder in [0, 1].
///
/// The rounding is done by adding and subtracting 1.5 x 2^52, which every processor does alike and in vector registers. At an
/// integer `u` the remainder may be 1 instead of 0; shape functions are continuous there.
#[inline(always)]
pub fn floor_to_int(u: f64) -> (i32, f64) {
    let shifted = (u - 0.5) + ROUND;
    (shifted.to_bits() as i32, u - (shifted - ROUND))
}

#[cfg(test)]
mod tests {
    use super::floor_to_int;

    #[test]
    fn integer_part_and_remainder_reassemble() {
        for u in [0.0, 0.25, 0.999_999_9, 1.0, 1.5, 2.0, 17.3, 123_456.75] {
            let (b, r) = floor_to_int(u);
            assert_eq!(f64::from(b) + r, u);
            assert!((0.0..=1.0).contains(&r), "{u}: {r}");
            assert!(u == u.floor() || f64::from(b) == u.floor(), "{u}: {b}");
        }
    }
}
