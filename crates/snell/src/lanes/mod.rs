//! Lanes: several `f64` that are computed together.
//!
//! Every kernel is written once against [`Lanes`]. A width of 1 is a plain `f64`; wider ones do the same arithmetic
//! in each lane, so a picture has the same bits at every width (tested, not hoped). Rules that make this true:
//! no fused multiply-add, no reciprocal estimates, masks select and never multiply, and
//! `min(a, b) = a < b ? a : b`, so that a NaN in `a` gives `b` at every width.
//!
//! | width | instructions | else |
//! | --- | --- | --- |
//! | 1 | `f64` | |
//! | 2 | SSE2, NEON, WASM `simd128` | an array |
//! | 4 | AVX2 | an array |
//! | 8 | AVX-512 | an array |
//!
//! [`LaneWidth`] chooses at run time. Kernels are `#[inline(always)]` down to the last call, so that they are compiled into
//! [`Lanes::call`], the one function with the instructions of its width.

mod array;
mod columns;
pub mod elementary;
#[cfg(target_arch = "aarch64")]
mod neon;
mod scalar;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
mod wasm;
mod width;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use array::ArrayLanes;
pub(crate) use columns::Columns;
pub use width::LaneWidth;
pub(crate) use width::dispatch;

use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// No width is larger.
pub(crate) const MAX_WIDTH: usize = 8;

/// One yes or no per lane.
pub trait Mask: Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// Lane i is bit i; bits beyond the width are ignored.
    fn from_bits(bits: u32) -> Self;
    /// Lane i as bit i, zeros beyond the width.
    fn bits(self) -> u32;

    /// The first `count` lanes yes, the others no.
    #[inline(always)]
    fn first(count: usize) -> Self {
        Self::from_bits(if count >= MAX_WIDTH { !0 } else { (1 << count) - 1 })
    }
    /// Is any lane yes?
    #[inline(always)]
    fn any(self) -> bool {
        self.bits() != 0
    }
    /// Is this lane yes? `lane < WIDTH`.
    #[inline(always)]
    fn test(self, lane: usize) -> bool {
        self.bits() >> lane & 1 == 1
    }
}

/// Work that can be done at any width. `run` must be `#[inline(always)]`, and everything that it calls with lanes too.
pub trait Kernel {
    /// What comes out.
    type Output;
    /// Does the work.
    fn run<L: Lanes>(self) -> Self::Output;
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

    /// Does some work in a function that is compiled with the instructions of this width.
    fn call<K: Kernel>(kernel: K) -> K::Output;

    /// The same number in every lane.
    fn splat(value: f64) -> Self;
    /// `value(lane)` in each lane.
    fn from_fn(value: impl FnMut(usize) -> f64) -> Self;
    /// The number in one lane, `lane < WIDTH`.
    fn lane(self, lane: usize) -> f64;
    /// The first `WIDTH` of the values; there must be as many.
    fn load(values: &[f64]) -> Self;
    /// The first `WIDTH` of the values, converted without error; there must be as many.
    fn load_f32(values: &[f32]) -> Self;
    /// Replaces the first `WIDTH` of the values; there must be as many.
    fn store(self, values: &mut [f64]);
    /// The lanes that the mask names, in their order, from lane 0 on; the others are of no meaning.
    fn compress(self, mask: Self::Mask) -> Self;
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

    fn any_number() -> impl Strategy<Value = f64> {
        prop_oneof![any::<f64>(), Just(f64::NAN), Just(0.0), Just(-0.0), Just(f64::INFINITY), -1e3..1e3f64]
    }

    fn same(a: f64, b: f64) -> bool {
        a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
    }

    /// Checks every operation of a width against plain numbers.
    struct LikePlainNumbers {
        a: [f64; MAX_WIDTH],
        b: [f64; MAX_WIDTH],
        bits: u32,
    }

    impl Kernel for LikePlainNumbers {
        type Output = ();
        #[inline(always)]
        fn run<L: Lanes>(self) {
            let Self { a, b, bits } = self;
            let (va, vb) = (L::load(&a), L::from_fn(|i| b[i]));
            let mask = L::Mask::from_bits(bits);
            let singles = a.map(|x| x as f32);
            let mut stored = [9.0; MAX_WIDTH];
            va.store(&mut stored);
            for i in 0..L::WIDTH {
                let (x, y, yes) = (a[i], b[i], bits >> i & 1 == 1);
                let (least, most) = (if x < y { x } else { y }, if x > y { x } else { y });
                let pairs = [
                    (va + vb, x + y),
                    (va - vb, x - y),
                    (va * vb, x * y),
                    (va / vb, x / y),
                    (-va, -x),
                    (va.sqrt(), x.sqrt()),
                    (va.min(vb), least),
                    (va.max(vb), most),
                    (L::splat(y), b[i]),
                    (L::load_f32(&singles), f64::from(singles[i])),
                    (L::select(mask, va, vb), if yes { x } else { y }),
                ];
                for (which, (lanes, plain)) in pairs.into_iter().enumerate() {
                    let got = if which == 8 { L::splat(y).lane(i) } else { lanes.lane(i) };
                    assert!(same(got, plain), "operation {which} at width {}: {got} for {plain}", L::WIDTH);
                }
                assert!(same(stored[i], x));
                assert_eq!(va.lt(vb).test(i), x < y);
                assert_eq!(va.le(vb).test(i), x <= y);
                assert_eq!(va.gt(vb).test(i), x > y);
                assert_eq!(va.ge(vb).test(i), x >= y);
                assert_eq!(va.eq(vb).test(i), x == y);
                assert_eq!((mask & va.lt(vb)).test(i), yes && x < y);
                assert_eq!((mask | va.lt(vb)).test(i), yes || x < y);
                assert_eq!((!mask).test(i), !yes);
            }
            let all = if L::WIDTH == MAX_WIDTH { 0xff } else { (1 << L::WIDTH) - 1 };
            assert_eq!((mask.bits(), (!mask).bits()), (bits & all, !bits & all), "nothing beyond the width");
            assert_eq!(stored[L::WIDTH..], [9.0; MAX_WIDTH][L::WIDTH..], "nothing stored beyond the width");
            let named = (0..L::WIDTH).filter(|&i| mask.test(i));
            for (place, i) in named.enumerate() {
                assert!(same(va.compress(mask).lane(place), a[i]));
            }
        }
    }

    proptest! {
        /// What one lane computes is what the plain number computes, to the last bit, NaN and infinities included.
        #[test]
        fn every_lane_computes_what_a_scalar_computes(
            a in prop::array::uniform8(any_number()),
            b in prop::array::uniform8(any_number()),
            bits in 0..256u32,
        ) {
            for width in LaneWidth::ALL {
                dispatch(width, LikePlainNumbers { a, b, bits });
            }
            LikePlainNumbers { a, b, bits }.run::<ArrayLanes<2>>();
            LikePlainNumbers { a, b, bits }.run::<ArrayLanes<4>>();
            LikePlainNumbers { a, b, bits }.run::<ArrayLanes<8>>();
        }
    }

    #[test]
    fn a_mask_of_the_first_lanes() {
        assert_eq!(<<ArrayLanes<8> as Lanes>::Mask as Mask>::first(8).bits(), 0xff);
        assert_eq!(<<ArrayLanes<8> as Lanes>::Mask as Mask>::first(3).bits(), 0b111);
        assert!(!<bool as Mask>::first(0).any());
    }
}
