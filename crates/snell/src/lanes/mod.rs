//! Lanes: several `f64` that are computed together.
//!
//! Every kernel is written once against [`Lanes`]. A width of 1 is a plain `f64`; wider ones do the same arithmetic
//! in each lane, so a picture has the same bits at every width (tested, not hoped). Rules that make this true:
//! no fused multiply-add, no reciprocal estimates, masks select and never multiply, and
//! `min(a, b) = a < b ? a : b`, so that a NaN in `a` gives `b` at every width.

mod array;
pub mod elementary;
mod scalar;

pub use array::ArrayLanes;

use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// One yes or no per lane.
pub trait Mask: Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// The first `count` lanes yes, the others no.
    fn first(count: usize) -> Self;
    /// `yes(lane)` for each lane.
    fn from_fn(yes: impl FnMut(usize) -> bool) -> Self;
    /// Is any lane yes?
    fn any(self) -> bool;
    /// Is this lane yes? `lane < WIDTH`.
    fn test(self, lane: usize) -> bool;
}

/// `WIDTH` numbers of 64 bits, computed together and independently of each other.
pub trait Lanes:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Send
    + Sync
    + 'static
{
    /// One yes or no per lane.
    type Mask: Mask;
    /// How many numbers are computed together.
    const WIDTH: usize;

    /// The same number in every lane.
    fn splat(value: f64) -> Self;
    /// `value(lane)` in each lane.
    fn from_fn(value: impl FnMut(usize) -> f64) -> Self;
    /// The number in one lane, `lane < WIDTH`.
    fn lane(self, lane: usize) -> f64;
    /// Square root, correctly rounded.
    fn sqrt(self) -> Self;
    /// `self < other`; no where either is NaN.
    fn lt(self, other: Self) -> Self::Mask;
    /// `self <= other`; no where either is NaN.
    fn le(self, other: Self) -> Self::Mask;
    /// `self == other`; no where either is NaN.
    fn eq(self, other: Self) -> Self::Mask;
    /// `yes` where the mask says so, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// The first `WIDTH` values of a column. A column that ends early repeats its last value, so that a lane without
    /// a ray of its own traces a copy of its neighbour and no made-up numbers arise. An empty column gives zeros.
    #[inline(always)]
    fn load(column: &[f64]) -> Self {
        Self::from_fn(|lane| column.get(lane).or(column.last()).copied().unwrap_or(0.0))
    }

    /// Appends the lanes that the mask names, in lane order.
    #[inline(always)]
    fn compress(self, mask: Self::Mask, column: &mut Vec<f64>) {
        for lane in 0..Self::WIDTH {
            if mask.test(lane) {
                column.push(self.lane(lane));
            }
        }
    }

    /// `self > other`.
    #[inline(always)]
    fn gt(self, other: Self) -> Self::Mask {
        other.lt(self)
    }
    /// `self >= other`.
    #[inline(always)]
    fn ge(self, other: Self) -> Self::Mask {
        other.le(self)
    }
    /// `self < other ? self : other`.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(self.lt(other), self, other)
    }
    /// `self > other ? self : other`.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(other.lt(self), self, other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    type Four = ArrayLanes<4>;

    fn any_number() -> impl Strategy<Value = f64> {
        prop_oneof![any::<f64>(), Just(f64::NAN), Just(0.0), Just(-0.0), Just(f64::INFINITY), -1e3..1e3f64]
    }

    fn same(a: f64, b: f64) -> bool {
        a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
    }

    proptest! {
        /// What one lane computes is what the plain number computes, to the last bit, NaN and infinities included.
        #[test]
        fn every_lane_computes_what_a_scalar_computes(
            a in prop::array::uniform4(any_number()),
            b in prop::array::uniform4(any_number()),
        ) {
            let (va, vb) = (Four::from_fn(|i| a[i]), Four::from_fn(|i| b[i]));
            for i in 0..4 {
                let (x, y) = (a[i], b[i]);
                let (least, most) = (if x < y { x } else { y }, if x > y { x } else { y });
                prop_assert!(same((va + vb).lane(i), x + y));
                prop_assert!(same((va - vb).lane(i), x - y));
                prop_assert!(same((va * vb).lane(i), x * y));
                prop_assert!(same((va / vb).lane(i), x / y));
                prop_assert!(same((-va).lane(i), -x));
                prop_assert!(same(va.sqrt().lane(i), x.sqrt()));
                prop_assert!(same(va.min(vb).lane(i), least));
                prop_assert!(same(va.max(vb).lane(i), most));
                prop_assert_eq!(va.lt(vb).test(i), x < y);
                prop_assert_eq!(va.le(vb).test(i), x <= y);
                prop_assert_eq!(va.eq(vb).test(i), x == y);
                prop_assert!(same(Lanes::min(x, y), least));
                prop_assert!(same(Lanes::max(x, y), most));
            }
        }
    }

    #[test]
    fn compress_keeps_lane_order_and_load_repeats_the_last() {
        let v = Four::load(&[1.0, 2.0, 3.0]);
        assert_eq!([0, 1, 2, 3].map(|i| v.lane(i)), [1.0, 2.0, 3.0, 3.0]);
        let mut out = vec![9.0];
        v.compress(Mask::from_fn(|i| i != 1), &mut out);
        assert_eq!(out, [9.0, 1.0, 3.0, 3.0]);
        assert_eq!(<f64 as Lanes>::load(&[]), 0.0);
    }
}
