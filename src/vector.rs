//! Vectors of four and eight doubles, for the loops over the nodes of one point.
//!
//! The compiler vectorises loops over lanes by itself; short loops over the components of a node it takes apart, so those are
//! written with explicit vectors. There are three implementations: arrays, AVX2 and AVX-512. All do the same IEEE operations, one
//! rounding each and no fused multiply-add, so the bits are the same (tested).
//!
//! The methods of the AVX types may only run on processors that have the instructions. [`crate::transfer`] sees to that: it names
//! [`Avx2`] and [`Avx512`] only inside functions that it calls after asking the processor. Everything between such a function
//! and an operation must be inlined, or the operation becomes a call: so no closures here, nor around these types elsewhere.
//!
//! Elsewhere: SIMD intrinsics.
#![allow(unsafe_code)]

/// Four doubles.
pub trait Pack4: Copy {
    /// The same number four times.
    fn splat(x: f64) -> Self;
    /// From memory.
    fn load(from: &[f64; 4]) -> Self;
    /// To memory.
    #[cfg(test)]
    fn array(self) -> [f64; 4];
    /// Component-wise sum.
    fn add(self, other: Self) -> Self;
    /// Component-wise product.
    fn mul(self, other: Self) -> Self;
    /// a0 + a2, a1 + a3, b0 + b2, b1 + b3.
    fn fold(a: Self, b: Self) -> Self;
}

/// Eight doubles.
pub trait Pack8: Copy {
    /// Four doubles of the same kind.
    type Half: Pack4;
    /// The same number eight times.
    fn splat(x: f64) -> Self;
    /// a a a a b b c c.
    fn four_two_two(a: f64, b: f64, c: f64) -> Self;
    /// a a b b c c 0 0.
    fn pairs(a: f64, b: f64, c: f64) -> Self;
    /// a b a b a b a b.
    fn alternate(a: f64, b: f64) -> Self;
    /// From memory.
    fn load(from: &[f64; 8]) -> Self;
    /// To memory.
    fn store(self, to: &mut [f64; 8]);
    /// The first and the last four.
    fn halves(self) -> [Self::Half; 2];
    /// Component-wise sum.
    fn add(self, other: Self) -> Self;
    /// Component-wise product.
    fn mul(self, other: Self) -> Self;
    /// Columns of a matrix given by its rows.
    fn transpose(rows: [Self; 8]) -> [Self; 8];
    /// Columns of a matrix of eight rows and four columns.
    fn columns(rows: [Self::Half; 8]) -> [Self; 4];
}

/// An instruction set.
pub trait Unit {
    /// Its four doubles.
    type Pack4: Pack4;
    /// Its eight doubles.
    type Pack8: Pack8<Half = Self::Pack4>;
    /// Asks for something that will be read soon, a cache line at a time.
    fn prefetch<T>(_soon: &T) {}
}

/// No vector instructions beyond those of the build target.
#[derive(Debug, Clone, Copy)]
pub struct Plain;

impl Unit for Plain {
    type Pack4 = [f64; 4];
    type Pack8 = [f64; 8];
}

impl Pack4 for [f64; 4] {
    #[inline(always)]
    fn splat(x: f64) -> Self {
        [x; 4]
    }
    #[inline(always)]
    fn load(from: &[f64; 4]) -> Self {
        *from
    }
    #[inline(always)]
    #[cfg(test)]
    fn array(self) -> [f64; 4] {
        self
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        std::array::from_fn(|k| self[k] + other[k])
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        std::array::from_fn(|k| self[k] * other[k])
    }
    #[inline(always)]
    fn fold(a: Self, b: Self) -> Self {
        [a[0] + a[2], a[1] + a[3], b[0] + b[2], b[1] + b[3]]
    }
}

impl Pack8 for [f64; 8] {
    type Half = [f64; 4];
    #[inline(always)]
    fn splat(x: f64) -> Self {
        [x; 8]
    }
    #[inline(always)]
    fn four_two_two(a: f64, b: f64, c: f64) -> Self {
        [a, a, a, a, b, b, c, c]
    }
    #[inline(always)]
    fn pairs(a: f64, b: f64, c: f64) -> Self {
        [a, a, b, b, c, c, 0.0, 0.0]
    }
    #[inline(always)]
    fn alternate(a: f64, b: f64) -> Self {
        [a, b, a, b, a, b, a, b]
    }
    #[inline(always)]
    fn load(from: &[f64; 8]) -> Self {
        *from
    }
    #[inline(always)]
    fn store(self, to: &mut [f64; 8]) {
        *to = self;
    }
    #[inline(always)]
    fn halves(self) -> [[f64; 4]; 2] {
        let [a, b, c, d, e, f, g, h] = self;
        [[a, b, c, d], [e, f, g, h]]
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        std::array::from_fn(|k| self[k] + other[k])
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        std::array::from_fn(|k| self[k] * other[k])
    }
    #[inline(always)]
    fn transpose(rows: [Self; 8]) -> [Self; 8] {
        std::array::from_fn(|k| rows.map(|row| row[k]))
    }
    #[inline(always)]
    fn columns(rows: [[f64; 4]; 8]) -> [Self; 4] {
        std::array::from_fn(|k| rows.map(|row| row[k]))
    }
}

#[cfg(target_arch = "x86_64")]
pub use x86::{Avx2, Avx512};

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::{Pack4, Pack8, Unit};
    use std::arch::x86_64::*;

    /// Vectors of 256 bits.
    #[derive(Debug, Clone, Copy)]
    pub struct Avx2;

    impl Unit for Avx2 {
        type Pack4 = __m256d;
        type Pack8 = [__m256d; 2];
        #[inline(always)]
        fn prefetch<T>(soon: &T) {
            prefetch(soon);
        }
    }

    /// Vectors of 512 bits.
    #[derive(Debug, Clone, Copy)]
    pub struct Avx512;

    impl Unit for Avx512 {
        type Pack4 = __m256d;
        type Pack8 = __m512d;
        #[inline(always)]
        fn prefetch<T>(soon: &T) {
            prefetch(soon);
        }
    }

    #[inline(always)]
    fn prefetch<T>(soon: &T) {
        const LINE: usize = 64;
        let start = std::ptr::from_ref(soon).cast::<i8>();
        for line in 0..size_of::<T>() / LINE {
            // SAFETY: a hint that reads nothing; the address lies within `soon`.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(start.add(LINE * line)) };
        }
    }

    // SAFETY, here and below: the instructions are there, see the module's text; the loads and stores are unaligned and stay
    // within the array that is borrowed.
    impl Pack4 for __m256d {
        #[inline(always)]
        fn splat(x: f64) -> Self {
            unsafe { _mm256_set1_pd(x) }
        }
        #[inline(always)]
        fn load(from: &[f64; 4]) -> Self {
            unsafe { _mm256_loadu_pd(from.as_ptr()) }
        }
        #[inline(always)]
        #[cfg(test)]
        fn array(self) -> [f64; 4] {
            let mut to = [0.0; 4];
            unsafe { _mm256_storeu_pd(to.as_mut_ptr(), self) };
            to
        }
        #[inline(always)]
        fn add(self, other: Self) -> Self {
            unsafe { _mm256_add_pd(self, other) }
        }
        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            unsafe { _mm256_mul_pd(self, other) }
        }
        #[inline(always)]
        fn fold(a: Self, b: Self) -> Self {
            unsafe { _mm256_add_pd(_mm256_permute2f128_pd::<0x20>(a, b), _mm256_permute2f128_pd::<0x31>(a, b)) }
        }
    }

    /// Columns of a matrix of four rows and columns.
    #[inline(always)]
    fn transpose4([a, b, c, d]: [__m256d; 4]) -> [__m256d; 4] {
        unsafe {
            let (ab, cd) = (_mm256_unpacklo_pd(a, b), _mm256_unpacklo_pd(c, d));
            let (ba, dc) = (_mm256_unpackhi_pd(a, b), _mm256_unpackhi_pd(c, d));
            [
                _mm256_permute2f128_pd::<0x20>(ab, cd),
                _mm256_permute2f128_pd::<0x20>(ba, dc),
                _mm256_permute2f128_pd::<0x31>(ab, cd),
                _mm256_permute2f128_pd::<0x31>(ba, dc),
            ]
        }
    }

    #[inline(always)]
    fn pair(a: f64, b: f64) -> __m256d {
        unsafe { _mm256_blend_pd::<0b1100>(_mm256_set1_pd(a), _mm256_set1_pd(b)) }
    }

    impl Pack8 for [__m256d; 2] {
        type Half = __m256d;
        #[inline(always)]
        fn splat(x: f64) -> Self {
            [Pack4::splat(x); 2]
        }
        #[inline(always)]
        fn four_two_two(a: f64, b: f64, c: f64) -> Self {
            [Pack4::splat(a), pair(b, c)]
        }
        #[inline(always)]
        fn pairs(a: f64, b: f64, c: f64) -> Self {
            [pair(a, b), pair(c, 0.0)]
        }
        #[inline(always)]
        fn alternate(a: f64, b: f64) -> Self {
            [unsafe { _mm256_blend_pd::<0b1010>(_mm256_set1_pd(a), _mm256_set1_pd(b)) }; 2]
        }
        #[inline(always)]
        fn load(from: &[f64; 8]) -> Self {
            unsafe { [_mm256_loadu_pd(from.as_ptr()), _mm256_loadu_pd(from.as_ptr().add(4))] }
        }
        #[inline(always)]
        fn store(self, to: &mut [f64; 8]) {
            unsafe {
                _mm256_storeu_pd(to.as_mut_ptr(), self[0]);
                _mm256_storeu_pd(to.as_mut_ptr().add(4), self[1]);
            }
        }
        #[inline(always)]
        fn halves(self) -> [__m256d; 2] {
            self
        }
        #[inline(always)]
        fn add(self, other: Self) -> Self {
            [self[0].add(other[0]), self[1].add(other[1])]
        }
        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            [self[0].mul(other[0]), self[1].mul(other[1])]
        }
        #[inline(always)]
        fn transpose(rows: [Self; 8]) -> [Self; 8] {
            let [a, b, c, d, e, f, g, h] = rows;
            let upper = [transpose4([a[0], b[0], c[0], d[0]]), transpose4([a[1], b[1], c[1], d[1]])];
            let lower = [transpose4([e[0], f[0], g[0], h[0]]), transpose4([e[1], f[1], g[1], h[1]])];
            let ([u, v], [p, q]) = (upper, lower);
            [
                [u[0], p[0]],
                [u[1], p[1]],
                [u[2], p[2]],
                [u[3], p[3]],
                [v[0], q[0]],
                [v[1], q[1]],
                [v[2], q[2]],
                [v[3], q[3]],
            ]
        }
        #[inline(always)]
        fn columns([a, b, c, d, e, f, g, h]: [__m256d; 8]) -> [Self; 4] {
            let (upper, lower) = (transpose4([a, b, c, d]), transpose4([e, f, g, h]));
            [[upper[0], lower[0]], [upper[1], lower[1]], [upper[2], lower[2]], [upper[3], lower[3]]]
        }
    }

    /// The four vectors of quarters 0, 1, 2, 3 of the four given.
    #[inline(always)]
    fn join([a, b]: [__m512d; 2], [c, d]: [__m512d; 2]) -> [__m512d; 4] {
        unsafe {
            let (even_ab, even_cd) = (_mm512_shuffle_f64x2::<0x88>(a, b), _mm512_shuffle_f64x2::<0x88>(c, d));
            let (odd_ab, odd_cd) = (_mm512_shuffle_f64x2::<0xdd>(a, b), _mm512_shuffle_f64x2::<0xdd>(c, d));
            [
                _mm512_shuffle_f64x2::<0x88>(even_ab, even_cd),
                _mm512_shuffle_f64x2::<0x88>(odd_ab, odd_cd),
                _mm512_shuffle_f64x2::<0xdd>(even_ab, even_cd),
                _mm512_shuffle_f64x2::<0xdd>(odd_ab, odd_cd),
            ]
        }
    }

    impl Pack8 for __m512d {
        type Half = __m256d;
        #[inline(always)]
        fn splat(x: f64) -> Self {
            unsafe { _mm512_set1_pd(x) }
        }
        #[inline(always)]
        fn four_two_two(a: f64, b: f64, c: f64) -> Self {
            unsafe {
                let ab = _mm512_mask_mov_pd(_mm512_set1_pd(a), 0b0011_0000, _mm512_set1_pd(b));
                _mm512_mask_mov_pd(ab, 0b1100_0000, _mm512_set1_pd(c))
            }
        }
        #[inline(always)]
        fn pairs(a: f64, b: f64, c: f64) -> Self {
            unsafe {
                let a = _mm512_maskz_mov_pd(0b0000_0011, _mm512_set1_pd(a));
                let ab = _mm512_mask_mov_pd(a, 0b0000_1100, _mm512_set1_pd(b));
                _mm512_mask_mov_pd(ab, 0b0011_0000, _mm512_set1_pd(c))
            }
        }
        #[inline(always)]
        fn alternate(a: f64, b: f64) -> Self {
            unsafe { _mm512_mask_mov_pd(_mm512_set1_pd(a), 0b1010_1010, _mm512_set1_pd(b)) }
        }
        #[inline(always)]
        fn load(from: &[f64; 8]) -> Self {
            unsafe { _mm512_loadu_pd(from.as_ptr()) }
        }
        #[inline(always)]
        fn store(self, to: &mut [f64; 8]) {
            unsafe { _mm512_storeu_pd(to.as_mut_ptr(), self) }
        }
        #[inline(always)]
        fn halves(self) -> [__m256d; 2] {
            unsafe { [_mm512_castpd512_pd256(self), _mm512_extractf64x4_pd::<1>(self)] }
        }
        #[inline(always)]
        fn add(self, other: Self) -> Self {
            unsafe { _mm512_add_pd(self, other) }
        }
        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            unsafe { _mm512_mul_pd(self, other) }
        }
        #[inline(always)]
        fn transpose(rows: [Self; 8]) -> [Self; 8] {
            // Rows interleaved two by two give the even and the odd columns in pieces of 128 bits.
            let [a, b, c, d, e, f, g, h] = rows;
            let [c0, c2, c4, c6] = unsafe {
                join(
                    [_mm512_unpacklo_pd(a, b), _mm512_unpacklo_pd(c, d)],
                    [_mm512_unpacklo_pd(e, f), _mm512_unpacklo_pd(g, h)],
                )
            };
            let [c1, c3, c5, c7] = unsafe {
                join(
                    [_mm512_unpackhi_pd(a, b), _mm512_unpackhi_pd(c, d)],
                    [_mm512_unpackhi_pd(e, f), _mm512_unpackhi_pd(g, h)],
                )
            };
            [c0, c1, c2, c3, c4, c5, c6, c7]
        }
        #[inline(always)]
        fn columns(rows: [__m256d; 8]) -> [Self; 4] {
            unsafe {
                let a = _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(rows[0]), rows[4]);
                let b = _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(rows[1]), rows[5]);
                let c = _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(rows[2]), rows[6]);
                let d = _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(rows[3]), rows[7]);
                let (ab, cd) = (_mm512_unpacklo_pd(a, b), _mm512_unpacklo_pd(c, d));
                let (ba, dc) = (_mm512_unpackhi_pd(a, b), _mm512_unpackhi_pd(c, d));
                // Blocks 0 and 2 of the first beside those of the second; then blocks 1 and 3.
                const EVEN: i32 = 0b10_10_00_00;
                const ODD: i32 = 0b11_11_01_01;
                [
                    _mm512_mask_shuffle_f64x2::<EVEN>(ab, 0b1100_1100, cd, cd),
                    _mm512_mask_shuffle_f64x2::<EVEN>(ba, 0b1100_1100, dc, dc),
                    _mm512_mask_shuffle_f64x2::<ODD>(cd, 0b0011_0011, ab, ab),
                    _mm512_mask_shuffle_f64x2::<ODD>(dc, 0b0011_0011, ba, ba),
                ]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every operation against its definition.
    fn check<U: Unit>() {
        let x = [0.5, -1.25, 3.0, 7.5, 1e-3, -2e5, 11.0, 0.1];
        let y = [2.0, 0.75, -1.0, 0.3, 4.0, 1e-9, 5.5, -6.0];
        let out = |p: U::Pack8| {
            let mut to = [f64::NAN; 8];
            p.store(&mut to);
            to
        };
        let (a, b) = (U::Pack8::load(&x), U::Pack8::load(&y));
        assert_eq!(out(a), x);
        assert_eq!(out(a.add(b)), std::array::from_fn(|k| x[k] + y[k]));
        assert_eq!(out(a.mul(b)), std::array::from_fn(|k| x[k] * y[k]));
        assert_eq!(out(U::Pack8::splat(1.5)), [1.5; 8]);
        assert_eq!(out(U::Pack8::four_two_two(1.0, 2.0, 3.0)), [1.0, 1.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0]);
        assert_eq!(out(U::Pack8::pairs(1.0, 2.0, 3.0)), [1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 0.0, 0.0]);
        assert_eq!(out(U::Pack8::alternate(1.0, 2.0)), [1.0, 2.0, 1.0, 2.0, 1.0, 2.0, 1.0, 2.0]);
        let [low, high] = a.halves();
        assert_eq!([low.array(), high.array()].as_flattened(), x);
        assert_eq!(low.add(high).array(), std::array::from_fn(|k| x[k] + x[k + 4]));
        assert_eq!(low.mul(high).array(), std::array::from_fn(|k| x[k] * x[k + 4]));
        assert_eq!(U::Pack4::fold(low, high).array(), [x[0] + x[2], x[1] + x[3], x[4] + x[6], x[5] + x[7]]);
        let number = |row: usize, column: usize| (10 * row + column) as f64;
        let rows: [[f64; 8]; 8] = std::array::from_fn(|i| std::array::from_fn(|j| number(i, j)));
        let columns = U::Pack8::transpose(rows.map(|row| U::Pack8::load(&row))).map(out);
        assert_eq!(columns, std::array::from_fn(|j| std::array::from_fn(|i| number(i, j))));
        let short: [U::Pack4; 8] = rows.map(|row| U::Pack8::load(&row).halves()[0]);
        assert_eq!(U::Pack8::columns(short).map(out), std::array::from_fn(|j| std::array::from_fn(|i| number(i, j))));
        assert_eq!(U::Pack4::splat(2.5).array(), [2.5; 4]);
        assert_eq!(U::Pack4::load(&[1.0, 2.0, 3.0, 4.0]).array(), [1.0, 2.0, 3.0, 4.0]);
    }

    #[test]
    fn arrays() {
        check::<Plain>();
    }

    #[test]
    #[cfg(target_arch = "x86_64")]
    fn avx2() {
        if is_x86_feature_detected!("avx2") {
            check::<Avx2>();
        }
    }

    #[test]
    #[cfg(target_arch = "x86_64")]
    fn avx512() {
        if is_x86_feature_detected!("avx512f") {
            check::<Avx512>();
        }
    }
}
