//! Any width as a plain array: runs on every machine, and proves that the width does not matter.

use super::{Lanes, Mask};
use std::array::from_fn;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// `N` numbers in an array.
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
    fn first(count: usize) -> Self {
        Self(from_fn(|lane| lane < count))
    }
    #[inline(always)]
    fn from_fn(yes: impl FnMut(usize) -> bool) -> Self {
        Self(from_fn(yes))
    }
    #[inline(always)]
    fn any(self) -> bool {
        self.0.iter().any(|&yes| yes)
    }
    #[inline(always)]
    fn test(self, lane: usize) -> bool {
        self.0[lane]
    }
}

impl<const N: usize> Lanes for ArrayLanes<N> {
    type Mask = ArrayMask<N>;
    const WIDTH: usize = N;

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
    fn sqrt(self) -> Self {
        Self(self.0.map(f64::sqrt))
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
