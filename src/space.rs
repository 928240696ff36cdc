//! Vectors in space: positions, velocities and impulses as `[f64; N]`, with operations in a fixed order.
//!
//! Sums begin with their first term, not with zero: `0.0 + -0.0` is `0.0`, and the bits of a result would then depend on how it was
//! written down.

use std::array::from_fn;

/// `a + b`.
#[inline(always)]
pub fn plus<const N: usize>(a: [f64; N], b: [f64; N]) -> [f64; N] {
    from_fn(|d| a[d] + b[d])
}

/// `a - b`.
#[inline(always)]
pub fn minus<const N: usize>(a: [f64; N], b: [f64; N]) -> [f64; N] {
    from_fn(|d| a[d] - b[d])
}

/// `a` times a number.
#[inline(always)]
pub fn scaled<const N: usize>(a: [f64; N], by: f64) -> [f64; N] {
    a.map(|x| by * x)
}

/// Half of `a + b`: of the velocities before and after a step, what an impulse is multiplied with to give its work.
#[inline(always)]
pub fn mean<const N: usize>(a: [f64; N], b: [f64; N]) -> [f64; N] {
    from_fn(|d| 0.5 * (a[d] + b[d]))
}

/// Scalar product.
#[inline(always)]
pub fn dot<const N: usize>(a: [f64; N], b: [f64; N]) -> f64 {
    let products: [f64; N] = from_fn(|d| a[d] * b[d]);
    products[1..].iter().fold(products[0], |sum, product| sum + product)
}

/// Length of a vector.
#[inline(always)]
pub fn norm<const N: usize>(a: [f64; N]) -> f64 {
    dot(a, a).sqrt()
}

/// The unit vector along `a`; none where `a` is not longer than `least`.
#[inline]
pub fn direction<const N: usize>(a: [f64; N], least: f64) -> Option<[f64; N]> {
    let length = norm(a);
    (length > least).then(|| a.map(|x| x / length))
}

/// A vector of the plane turned clockwise by a right angle: of a normal, the tangent along which friction acts.
#[inline(always)]
pub fn clockwise([x, y]: [f64; 2]) -> [f64; 2] {
    [y, -x]
}

/// Moment about the origin, counter-clockwise, of an impulse or a force at `arm` in the plane.
#[inline(always)]
pub fn moment(arm: [f64; 2], force: [f64; 2]) -> f64 {
    arm[0] * force[1] - arm[1] * force[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers whose sums and products are exact, and the zeros that are not alike.
    const PAIRS: [[f64; 2]; 6] = [[3.0, 4.0], [-0.0, 0.0], [0.0, -0.0], [-0.0, -0.0], [-1.5, 0.25], [1e-300, -7.0]];

    fn bits<const N: usize>(a: [f64; N]) -> [u64; N] {
        a.map(f64::to_bits)
    }

    #[test]
    fn the_bits_are_those_of_pairs_written_out() {
        for a in PAIRS {
            for b in PAIRS {
                assert_eq!(bits(plus(a, b)), bits([a[0] + b[0], a[1] + b[1]]));
                assert_eq!(bits(minus(a, b)), bits([a[0] - b[0], a[1] - b[1]]));
                assert_eq!(bits(scaled(a, b[0])), bits([a[0] * b[0], a[1] * b[0]]));
                assert_eq!(bits(mean(a, b)), bits([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]));
                assert_eq!(dot(a, b).to_bits(), (a[0] * b[0] + a[1] * b[1]).to_bits());
                assert_eq!(dot(a, clockwise(b)).to_bits(), (a[0] * b[1] - a[1] * b[0]).to_bits());
                assert_eq!(moment(a, b).to_bits(), (a[0] * b[1] - a[1] * b[0]).to_bits());
                let along = plus(scaled(a, b[0]), scaled(clockwise(a), b[1]));
                assert_eq!(bits(along), bits([a[0] * b[0] + a[1] * b[1], a[1] * b[0] - a[0] * b[1]]));
            }
        }
        assert_eq!(dot([-0.0], [1.0]).to_bits(), (-0.0f64).to_bits());
    }

    #[test]
    fn a_direction_needs_a_length() {
        assert_eq!(norm([2.0, 3.0, 6.0]), 7.0);
        assert_eq!(direction([3.0, 4.0], 4.9), Some([0.6, 0.8]));
        assert_eq!(direction([3.0, 4.0], 5.0), None);
        assert_eq!(direction([0.0; 3], 0.0), None);
    }
}
