//! NEON: two numbers. Every 64-bit ARM has it, so nothing has to be asked at run time, and its intrinsics may be called
//! anywhere.

#![allow(unsafe_code, reason = "intrinsics; each block says why it is sound")]
#![allow(clippy::wildcard_imports, reason = "intrinsics come by the dozen, and their names say where from")]

use super::{Kernel, Lanes, Mask};
use core::arch::aarch64::*;
use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Two numbers.
#[derive(Clone, Copy, Debug)]
pub struct Neon(float64x2_t);
/// Two answers: all bits of a lane, or none.
#[derive(Clone, Copy, Debug)]
pub struct NeonMask(uint64x2_t);

operators!(Neon: Add add vaddq_f64, Sub sub vsubq_f64, Mul mul vmulq_f64, Div div vdivq_f64);
operators!(NeonMask: BitAnd bitand vandq_u64, BitOr bitor vorrq_u64);

impl Neg for Neon {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: every 64-bit ARM has the instruction.
        Self(unsafe { vnegq_f64(self.0) })
    }
}

impl Not for NeonMask {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        // SAFETY: every 64-bit ARM has the instruction.
        Self(unsafe { veorq_u64(self.0, vdupq_n_u64(!0)) })
    }
}

impl Mask for NeonMask {
    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        let lane = |i: u32| if bits >> i & 1 == 1 { !0 } else { 0 };
        // SAFETY: every 64-bit ARM has the instruction.
        Self(unsafe { vsetq_lane_u64::<1>(lane(1), vdupq_n_u64(lane(0))) })
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        // SAFETY: every 64-bit ARM has the instruction.
        let lanes = unsafe { [vgetq_lane_u64::<0>(self.0), vgetq_lane_u64::<1>(self.0)] };
        (lanes[0] & 1 | lanes[1] & 2) as u32
    }
}

impl Lanes for Neon {
    type Mask = NeonMask;
    const WIDTH: usize = 2;

    fn call<K: Kernel>(kernel: K) -> K::Output {
        kernel.run::<Self>()
    }
    #[inline(always)]
    fn splat(value: f64) -> Self {
        // SAFETY: every 64-bit ARM has the instruction.
        Self(unsafe { vdupq_n_f64(value) })
    }
    #[inline(always)]
    fn from_fn(value: impl FnMut(usize) -> f64) -> Self {
        Self::load(&core::array::from_fn::<f64, 2, _>(value))
    }
    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        // SAFETY: every 64-bit ARM has the instruction.
        unsafe { if lane == 0 { vgetq_lane_f64::<0>(self.0) } else { vgetq_lane_f64::<1>(self.0) } }
    }
    #[inline(always)]
    fn load(values: &[f64]) -> Self {
        let values = &values[..2];
        // SAFETY: two values are there.
        Self(unsafe { vld1q_f64(values.as_ptr()) })
    }
    #[inline(always)]
    fn load_f32(values: &[f32]) -> Self {
        Self::from_fn(|i| f64::from(values[i]))
    }
    #[inline(always)]
    fn store(self, values: &mut [f64]) {
        let values = &mut values[..2];
        // SAFETY: there is room for two values.
        unsafe { vst1q_f64(values.as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn compress(self, mask: NeonMask) -> Self {
        // SAFETY: every 64-bit ARM has the instruction.
        if mask.bits() == 2 { Self(unsafe { vdupq_laneq_f64::<1>(self.0) }) } else { self }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: every 64-bit ARM has the instruction.
        Self(unsafe { vsqrtq_f64(self.0) })
    }
    #[inline(always)]
    fn lt(self, other: Self) -> NeonMask {
        // SAFETY: every 64-bit ARM has the instruction.
        NeonMask(unsafe { vcltq_f64(self.0, other.0) })
    }
    #[inline(always)]
    fn le(self, other: Self) -> NeonMask {
        // SAFETY: every 64-bit ARM has the instruction.
        NeonMask(unsafe { vcleq_f64(self.0, other.0) })
    }
    #[inline(always)]
    fn eq(self, other: Self) -> NeonMask {
        // SAFETY: every 64-bit ARM has the instruction.
        NeonMask(unsafe { vceqq_f64(self.0, other.0) })
    }
    #[inline(always)]
    fn select(mask: NeonMask, yes: Self, no: Self) -> Self {
        // SAFETY: every 64-bit ARM has the instruction.
        Self(unsafe { vbslq_f64(mask.0, yes.0, no.0) })
    }
}
