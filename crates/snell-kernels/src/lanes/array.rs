//! Any width as a plain array: for machines that lack the instructions, and to prove that the width does not matter.

use super::{Kernel, Lanes, Mask, sqrt};
use core::array::from_fn;
use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// `N` numbers in an array, up to 8.
#[derive(Clone, Copy, Debug)]
pub struct ArrayLanes<const N: usize>([f64; N]);

/// `N` answers in an array.
#[derive(Clone, Copy, Debug)]
pub struct ArrayMask<const N: usize>([bool; N]);

macro_rules! lane_by_lane {
    ($operation:ident, $method:ident, $type:ident) => {
        impl<const N: usize> $operation for $type<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(from_fn(|i| $operation::$method(self.0[i], other.0[i])))
            }
        }
    };
}
lane_by_lane!(Add, add, ArrayLanes);
lane_by_lane!(Sub, sub, ArrayLanes);
lane_by_lane!(Mul, mul, ArrayLanes);
lane_by_lane!(Div, div, ArrayLanes);
lane_by_lane!(BitAnd, bitand, ArrayMask);
lane_by_lane!(BitOr, bitor, ArrayMask);

impl<const N: usize> Neg for ArrayLanes<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}

impl<const N: usize> Not for ArrayMask<N> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(self.0.map(|yes| !yes))
    }
}

impl<const N: usize> Mask for ArrayMask<N> {
    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        Self(from_fn(|lane| bits >> lane & 1 == 1))
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        (0..N).fold(0, |bits, lane| bits | u32::from(self.0[lane]) << lane)
    }
}

impl<const N: usize> Lanes for ArrayLanes<N> {
    type Mask = ArrayMask<N>;
    const WIDTH: usize = N;

    fn call<K: Kernel>(kernel: K) -> K::Output {
        kernel.run::<Self>()
    }
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; N])
    }
    #[inline(always)]
    fn from_fn(value: impl FnMut(usize) -> f64) -> Self {
        Self(from_fn(value))
    }
    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        self.0[lane]
    }
    #[inline(always)]
    fn load(values: &[f64]) -> Self {
        let values = &values[..N];
        Self(from_fn(|i| values[i]))
    }
    #[inline(always)]
    fn load_f32(values: &[f32]) -> Self {
        let values = &values[..N];
        Self(from_fn(|i| f64::from(values[i])))
    }
    #[inline(always)]
    fn store(self, values: &mut [f64]) {
        values[..N].copy_from_slice(&self.0);
    }
    #[inline(always)]
    fn compress(self, mask: ArrayMask<N>) -> Self {
        let (mut packed, mut place) = (self.0, 0);
        for lane in 0..N {
            packed[place] = self.0[lane];
            place += usize::from(mask.0[lane] && place + 1 < N);
        }
        Self(packed)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(sqrt))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Self::Mask {
        ArrayMask(from_fn(|i| self.0[i] < other.0[i]))
    }
    #[inline(always)]
    fn le(self, other: Self) -> Self::Mask {
        ArrayMask(from_fn(|i| self.0[i] <= other.0[i]))
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Self::Mask {
        ArrayMask(from_fn(|i| self.0[i] == other.0[i]))
    }
    #[inline(always)]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self {
        Self(from_fn(|i| if mask.0[i] { yes.0[i] } else { no.0[i] }))
    }
}
