//! WASM `simd128`: two numbers. The whole module is compiled with it, so nothing has to be asked at run time.

#![allow(unsafe_code, reason = "two intrinsics take pointers; each block says why it is sound")]
#![allow(clippy::wildcard_imports, reason = "intrinsics come by the dozen, and their names say where from")]

use super::{Kernel, Lanes, Mask};
use core::arch::wasm32::*;
use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Two numbers.
#[derive(Clone, Copy, Debug)]
pub struct Simd128(v128);
/// Two answers: all bits of a lane, or none.
#[derive(Clone, Copy, Debug)]
pub struct Simd128Mask(v128);

operators!(Simd128: Add add f64x2_add, Sub sub f64x2_sub, Mul mul f64x2_mul, Div div f64x2_div);
operators!(Simd128Mask: BitAnd bitand v128_and, BitOr bitor v128_or);

impl Neg for Simd128 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(f64x2_neg(self.0))
    }
}

impl Not for Simd128Mask {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(v128_not(self.0))
    }
}

impl Mask for Simd128Mask {
    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        let named = v128_and(i64x2_splat(i64::from(bits)), i64x2(1, 2));
        Self(i64x2_eq(named, i64x2(1, 2)))
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        u32::from(i64x2_bitmask(self.0))
    }
}

impl Lanes for Simd128 {
    type Mask = Simd128Mask;
    const WIDTH: usize = 2;

    fn call<K: Kernel>(kernel: K) -> K::Output {
        kernel.run::<Self>()
    }
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self(f64x2_splat(value))
    }
    #[inline(always)]
    fn from_fn(mut value: impl FnMut(usize) -> f64) -> Self {
        let first = value(0);
        Self(f64x2(first, value(1)))
    }
    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        if lane == 0 { f64x2_extract_lane::<0>(self.0) } else { f64x2_extract_lane::<1>(self.0) }
    }
    #[inline(always)]
    fn load(values: &[f64]) -> Self {
        let values = &values[..2];
        // SAFETY: two values are there, and unaligned is allowed.
        Self(unsafe { v128_load(values.as_ptr().cast()) })
    }
    #[inline(always)]
    fn load_f32(values: &[f32]) -> Self {
        Self(f64x2(f64::from(values[0]), f64::from(values[1])))
    }
    #[inline(always)]
    fn store(self, values: &mut [f64]) {
        let values = &mut values[..2];
        // SAFETY: there is room for two values, and unaligned is allowed.
        unsafe { v128_store(values.as_mut_ptr().cast(), self.0) }
    }
    #[inline(always)]
    fn compress(self, mask: Simd128Mask) -> Self {
        if mask.bits() == 2 { Self(i64x2_shuffle::<1, 1>(self.0, self.0)) } else { self }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(f64x2_sqrt(self.0))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Simd128Mask {
        Simd128Mask(f64x2_lt(self.0, other.0))
    }
    #[inline(always)]
    fn le(self, other: Self) -> Simd128Mask {
        Simd128Mask(f64x2_le(self.0, other.0))
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Simd128Mask {
        Simd128Mask(f64x2_eq(self.0, other.0))
    }
    #[inline(always)]
    fn select(mask: Simd128Mask, yes: Self, no: Self) -> Self {
        Self(v128_bitselect(yes.0, no.0, mask.0))
    }
    // `f64x2_pmin(a, b)` is `b < a ? b : a`, the other way round than ours.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(f64x2_pmin(other.0, self.0))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(f64x2_pmax(other.0, self.0))
    }
}
