//! Principal values of a tensor under plane strain, and the tensor of others with the same axes.

use super::Symmetric;
use super::opened::{max, min};

/// Principal values with their axes; one of these is the normal of the plane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Principal {
    /// From the largest to the smallest.
    pub values: [f64; 3],
    /// Cosine and sine of twice the angle from x to the axis of the larger value in the plane; both zero where the two are the same.
    axis: [f64; 2],
    /// Whether the value across the plane is larger than both in it, and whether it is smaller.
    across: [bool; 2],
}

impl Principal {
    /// Those of a tensor.
    #[inline(always)]
    pub fn of(s: &Symmetric) -> Self {
        let (centre, half) = (0.5 * (s.xx + s.yy), 0.5 * (s.xx - s.yy));
        let radius = (half * half + s.xy * s.xy).sqrt();
        let per = if radius > 0.0 { 1.0 / radius } else { 0.0 };
        let (a, b) = (centre + radius, centre - radius);
        Self {
            values: [max(a, s.zz), max(b, min(a, s.zz)), min(b, s.zz)],
            axis: [half * per, s.xy * per],
            across: [s.zz > a, s.zz < b],
        }
    }

    /// The tensor that has these values, in the same order, along the same axes.
    #[inline(always)]
    pub fn with(&self, [first, middle, last]: [f64; 3]) -> Symmetric {
        let [largest, smallest] = self.across;
        let a = if largest { middle } else { first };
        let b = if smallest { middle } else { last };
        let inner = if smallest { last } else { middle };
        let zz = if largest { first } else { inner };
        let (centre, half) = (0.5 * (a + b), 0.5 * (a - b));
        let [cos2, sin2] = self.axis;
        Symmetric { xx: centre + half * cos2, yy: centre - half * cos2, zz, xy: half * sin2 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constitutive::tests::{near, same};
    use crate::scaffold::Lcg;

    #[test]
    fn values_and_axes_make_the_tensor_again() {
        let mut random = Lcg::new(3);
        let mut places = [0; 3];
        for _ in 0..200 {
            let s =
                Symmetric { xx: random.signed(), yy: random.signed(), zz: 1.5 * random.signed(), xy: random.signed() };
            let p = Principal::of(&s);
            let [a, b, c] = p.values;
            assert!(a >= b && b >= c);
            same(p.with(p.values), s);
            // Invariants of the three values: trace, J2, determinant.
            near(a + b + c, 3.0 * s.mean());
            near(((a - b) * (a - b) + (b - c) * (b - c) + (c - a) * (c - a)) / 6.0, s.j2());
            assert!((a * b * c - s.zz * (s.xx * s.yy - s.xy * s.xy)).abs() < 1e-14);
            places[p.values.iter().position(|v| *v == s.zz).expect("one of the three")] += 1;
        }
        assert!(places.iter().all(|n| *n > 20), "{places:?}");
    }

    #[test]
    fn other_values_keep_the_axes() {
        let s = Symmetric { xx: 3.0, yy: 1.0, zz: 9.0, xy: 1.0 };
        let t = Principal::of(&s).with([7.0, 5.0, 1.0]);
        assert_eq!(t.zz, 7.0);
        // 2 xy / (xx - yy) is the tangent of twice the angle.
        near(2.0 * t.xy / (t.xx - t.yy), 1.0);
        near(t.xx + t.yy, 6.0);
        // No axis is needed where there is none.
        same(
            Principal::of(&Symmetric { xx: 2.0, yy: 2.0, zz: 1.0, xy: 0.0 }).with([5.0, 5.0, 4.0]),
            Symmetric { xx: 5.0, yy: 5.0, zz: 4.0, xy: 0.0 },
        );
    }
}
