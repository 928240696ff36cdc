//! Tensors at a material point, and what laws do with them.
//!
//! Under plane strain a symmetric tensor has four components; here and nowhere in the laws they are taken by name. Laws are
//! written in invariants, deviators and turns.

use super::History;

/// Symmetric tensor under plane strain; its `yz` and `zx` components vanish.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Symmetric {
    /// Normal component along x.
    pub xx: f64,
    /// Normal component along y.
    pub yy: f64,
    /// Out-of-plane normal component.
    pub zz: f64,
    /// In-plane shear.
    pub xy: f64,
}

/// Cauchy stress, in Pa, tension positive.
pub type Stress = Symmetric;

impl Symmetric {
    /// Third of the trace; of a stress the mean stress, tension positive.
    #[inline(always)]
    pub fn mean(&self) -> f64 {
        (self.xx + self.yy + self.zz) * (1.0 / 3.0)
    }

    /// What is left without the mean.
    #[inline(always)]
    pub fn deviator(&self) -> Self {
        let m = self.mean();
        Self { xx: self.xx - m, yy: self.yy - m, zz: self.zz - m, xy: self.xy }
    }

    /// Second invariant of the deviator, J2 = s:s/2.
    #[inline(always)]
    pub fn j2(&self) -> f64 {
        let s = self.deviator();
        0.5 * (s.xx * s.xx + s.yy * s.yy + s.zz * s.zz) + s.xy * s.xy
    }

    /// The sum of two.
    #[inline(always)]
    pub fn plus(&self, other: &Self) -> Self {
        Self { xx: self.xx + other.xx, yy: self.yy + other.yy, zz: self.zz + other.zz, xy: self.xy + other.xy }
    }

    /// The sum with `mean` times the identity.
    #[inline(always)]
    pub fn plus_mean(&self, mean: f64) -> Self {
        Self { xx: self.xx + mean, yy: self.yy + mean, zz: self.zz + mean, xy: self.xy }
    }

    /// All components times a factor.
    #[inline(always)]
    pub fn times(&self, factor: f64) -> Self {
        Self { xx: factor * self.xx, yy: factor * self.yy, zz: factor * self.zz, xy: factor * self.xy }
    }

    /// Of each component of two what a rule makes of the pair.
    #[inline(always)]
    pub fn zip(&self, other: &Self, rule: impl Fn(f64, f64) -> f64) -> Self {
        Self {
            xx: rule(self.xx, other.xx),
            yy: rule(self.yy, other.yy),
            zz: rule(self.zz, other.zz),
            xy: rule(self.xy, other.xy),
        }
    }

    /// The tensor that turns with the material.
    #[inline(always)]
    pub fn turned(&self, by: HalfTurn) -> Self {
        let centre = 0.5 * (self.xx + self.yy);
        let half = 0.5 * (self.xx - self.yy);
        let d = half * by.cos2 - self.xy * by.sin2;
        Self { xx: centre + d, yy: centre - d, zz: self.zz, xy: half * by.sin2 + self.xy * by.cos2 }
    }
}

/// Rotation by half of an increment's spin, see [`Increment::half_turn`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfTurn {
    /// Cosine of twice its angle.
    pub(super) cos2: f64,
    /// Sine of twice its angle.
    pub(super) sin2: f64,
}

/// What the grid tells a material point in one step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Increment {
    /// Time that it takes, s; laws that do not depend on the rate leave it alone.
    pub dt: f64,
    /// Normal strain along x: dt dvx/dx.
    pub xx: f64,
    /// Normal strain along y: dt dvy/dy.
    pub yy: f64,
    /// Tensor shear strain: dt (dvx/dy + dvy/dx) / 2.
    pub xy: f64,
    /// Rotation, counter-clockwise: dt (dvy/dx - dvx/dy) / 2.
    pub spin: f64,
}

impl Increment {
    /// Volumetric strain; the out-of-plane strain is zero.
    #[inline(always)]
    pub fn volumetric(&self) -> f64 {
        self.xx + self.yy
    }

    /// Deviator of the strain.
    #[inline(always)]
    pub fn deviator(&self) -> Symmetric {
        let third = self.volumetric() * (1.0 / 3.0);
        Symmetric { xx: self.xx - third, yy: self.yy - third, zz: -third, xy: self.xy }
    }

    /// Rotation by half of the spin, in the Cayley form (Hughes and Winget 1980), which keeps invariants to round-off: the tangent
    /// of half an angle is replaced by half the angle.
    #[inline(always)]
    pub fn half_turn(&self) -> HalfTurn {
        let quarter = 0.25 * self.spin * self.spin;
        let per = 1.0 / (1.0 + quarter);
        HalfTurn { cos2: (1.0 - quarter) * per, sin2: self.spin * per }
    }

    /// Work of the mean of two stresses over the strain, per unit volume, J/m3.
    #[inline(always)]
    pub fn midpoint_work(&self, a: &Stress, b: &Stress) -> f64 {
        0.5 * ((a.xx + b.xx) * self.xx + (a.yy + b.yy) * self.yy) + (a.xy + b.xy) * self.xy
    }
}

/// Left Cauchy-Green tensor b = F F^T less the identity, in the plane; nothing happens across it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Finger {
    /// b_xx - 1.
    pub xx: f64,
    /// b_yy - 1.
    pub yy: f64,
    /// b_xy.
    pub xy: f64,
}

impl Finger {
    /// Numbers that it takes to keep it.
    pub const NUMBERS: usize = 3;

    /// As it is kept in a history, from the first number on.
    #[inline(always)]
    pub fn kept_in(history: &History) -> Self {
        Self { xx: history[0], yy: history[1], xy: history[2] }
    }

    /// Keeps it so.
    #[inline(always)]
    pub fn keep_in(&self, history: &mut History) {
        (history[0], history[1], history[2]) = (self.xx, self.yy, self.xy);
    }

    /// f b f^T with f = I + the increment's gradient.
    #[inline(always)]
    pub fn advanced(&self, d: &Increment) -> Self {
        // The gradient by its rows, and the gradient times b.
        let (a, b, c, e) = (d.xx, d.xy - d.spin, d.xy + d.spin, d.yy);
        let (bx, by) = (1.0 + self.xx, 1.0 + self.yy);
        let (g00, g01) = (a * bx + b * self.xy, a * self.xy + b * by);
        let (g10, g11) = (c * bx + e * self.xy, c * self.xy + e * by);
        Self {
            xx: self.xx + (2.0 * g00 + (g00 * a + g01 * b)),
            yy: self.yy + (2.0 * g11 + (g10 * c + g11 * e)),
            xy: self.xy + ((g01 + g10) + (g00 * c + g01 * e)),
        }
    }

    /// tr b - 3.
    #[inline(always)]
    pub fn trace_less_three(&self) -> f64 {
        self.xx + self.yy
    }

    /// J^2 - 1 with the volume ratio J.
    #[inline(always)]
    pub fn determinant_less_one(&self) -> f64 {
        self.xx + self.yy + (self.xx * self.yy - self.xy * self.xy)
    }

    /// Current over reference volume, J.
    #[inline(always)]
    pub fn volume_ratio(&self) -> f64 {
        (1.0 + self.determinant_less_one()).sqrt()
    }

    /// `factor` (b - I) + `mean` I.
    #[inline(always)]
    pub fn times_plus_mean(&self, factor: f64, mean: f64) -> Symmetric {
        Symmetric { xx: factor * self.xx + mean, yy: factor * self.yy + mean, zz: mean, xy: factor * self.xy }
    }

    /// Largest principal stretch in the plane; 1 where nothing is deformed.
    pub fn largest_stretch(&self) -> f64 {
        let (mean, half) = (0.5 * (self.xx + self.yy), 0.5 * (self.xx - self.yy));
        (1.0 + mean + (half * half + self.xy * self.xy).sqrt()).max(0.0).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constitutive::tests::{near, same};

    #[test]
    fn invariants_of_a_stress() {
        let s = Stress { xx: 7.0, yy: -2.0, zz: 1.0, xy: 3.0 };
        assert_eq!(s.deviator(), Stress { xx: 5.0, yy: -4.0, zz: -1.0, xy: 3.0 });
        assert_eq!((s.mean(), s.j2()), (2.0, 0.5 * (25.0 + 16.0 + 1.0) + 9.0));
        // Uniaxial tension along x seen after a turn by 30 degrees.
        let turned = Stress { xx: 4.0, ..Stress::default() }.turned(HalfTurn { cos2: 0.5, sin2: 0.75f64.sqrt() });
        same(turned, Stress { xx: 3.0, yy: 1.0, zz: 0.0, xy: 3f64.sqrt() });
        let turned = s.turned(HalfTurn { cos2: 0.28, sin2: 0.96 });
        near(turned.mean(), s.mean());
        near(turned.j2(), s.j2());
        // Shear alone, turned by 45 degrees.
        let turned = Stress { xy: 2.0, ..Stress::default() }.turned(HalfTurn { cos2: 0.0, sin2: 1.0 });
        same(turned, Stress { xx: -2.0, yy: 2.0, ..Stress::default() });
    }

    #[test]
    fn sums_and_multiples() {
        let (a, b) = (Stress { xx: 1.0, yy: 2.0, zz: 3.0, xy: 4.0 }, Stress { xx: 10.0, yy: 20.0, zz: 30.0, xy: 40.0 });
        assert_eq!(a.plus(&b), Stress { xx: 11.0, yy: 22.0, zz: 33.0, xy: 44.0 });
        assert_eq!(a.plus_mean(0.5), Stress { xx: 1.5, yy: 2.5, zz: 3.5, xy: 4.0 });
        assert_eq!(a.times(-2.0), Stress { xx: -2.0, yy: -4.0, zz: -6.0, xy: -8.0 });
        let f = Finger { xx: 1.0, yy: 2.0, xy: 3.0 };
        assert_eq!(f.times_plus_mean(2.0, 0.25), Stress { xx: 2.25, yy: 4.25, zz: 0.25, xy: 6.0 });
        assert_eq!((f.trace_less_three(), f.determinant_less_one()), (3.0, 3.0 + 2.0 - 9.0));
        let mut history = History::default();
        f.keep_in(&mut history);
        assert_eq!(Finger::kept_in(&history), f);
    }

    #[test]
    fn strains_have_nothing_across_the_plane() {
        let d = Increment { xx: 0.3, yy: -0.1, xy: 5.0, spin: 7.0, ..Increment::default() };
        assert_eq!(d.volumetric(), 0.3 - 0.1);
        same(d.deviator(), Symmetric { xx: 0.3, yy: -0.1, zz: 0.0, xy: 5.0 }.deviator());
        near(d.deviator().mean(), 0.0);
    }

    #[test]
    fn cayleys_rotation_is_one() {
        let turn = |spin: f64| Increment { spin, ..Increment::default() }.half_turn();
        assert_eq!(turn(0.0), HalfTurn { cos2: 1.0, sin2: 0.0 });
        assert_eq!(turn(2.0), HalfTurn { cos2: 0.0, sin2: 1.0 });
        for w in [1e-3, -0.4, 1.0] {
            let HalfTurn { cos2: c, sin2: s } = turn(w);
            near(c * c + s * s, 1.0);
            // tan(a/2) = w/2.
            near(s / (1.0 + c), 0.5 * w);
        }
    }

    #[test]
    fn work_is_that_of_the_mean_stress() {
        let a = Stress { xx: 1.0, yy: 2.0, zz: 100.0, xy: 3.0 };
        let b = Stress { xx: 3.0, yy: 6.0, zz: -50.0, xy: 5.0 };
        let d = Increment { dt: 7.0, xx: 0.1, yy: 0.2, xy: 0.3, spin: 9.0 };
        near(d.midpoint_work(&a, &b), 2.0 * 0.1 + 4.0 * 0.2 + 2.0 * 4.0 * 0.3);
    }
}
