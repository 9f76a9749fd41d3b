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
//! [`dispatch`] chooses at run time. Kernels are `#[inline(always)]` down to the last call, so that they are compiled into
//! [`Lanes::call`], the one function with the instructions of its width.

/// Operators of vector types, an intrinsic each. For modules that say why their intrinsics may be called.
macro_rules! operators {
    ($type:ident: $($operation:ident $method:ident $intrinsic:ident),*) => {$(
        impl $operation for $type {
            type Output = Self;
            #[inline(always)]
            #[allow(unused_unsafe, reason = "those of WASM are safe")]
            fn $method(self, other: Self) -> Self {
                // SAFETY: the machine has the instruction, see the top of the file.
                Self(unsafe { $intrinsic(self.0, other.0) })
            }
        }
    )*};
}

mod array;
mod columns;
mod dispatch;
pub mod elementary;
mod exp;
#[cfg(target_arch = "aarch64")]
mod neon;
mod pow;
mod scalar;
mod sort;
pub mod table;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
mod wasm;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use array::ArrayLanes;
pub use columns::Columns;
pub use dispatch::{Instructions, dispatch};
pub use exp::exp;
pub use pow::pow;
pub use scalar::sqrt;
pub use table::{Number, Record, Row, Table};
pub(crate) use table::{record, table};

use core::fmt::Debug;
use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// What [`Lanes::split_exponent`] is made of: the patterns of bits of 2^-¼ and 1, and 2^52.
const LEAST: u64 = 0x3fea_e89f_995a_d3ad;
const ONE: u64 = 1.0f64.to_bits();
const TWO_TO_52: f64 = 4_503_599_627_370_496.0;

/// No width is larger.
pub const MAX_WIDTH: usize = 8;

/// A whole number that travels as `f64`, below 2^32: quicker than a conversion that asks whether it is one.
#[inline(always)]
pub fn index(number: f64) -> usize {
    (number + TWO_TO_52).to_bits() as u32 as usize
}

/// Tells the machine that so many cache lines from this place on will soon be read, so that it fetches them while something
/// else is done.
#[inline(always)]
pub fn prefetch<const LINES: usize>(start: *const u8) {
    #[cfg(target_arch = "x86_64")]
    x86::prefetch::<LINES>(start);
    #[cfg(not(target_arch = "x86_64"))]
    let _ = start;
}

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
    /// `first`, `first + 1`, ...
    #[inline(always)]
    fn ramp(first: usize) -> Self {
        Self::load(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]) + Self::splat(first as f64)
    }
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

    /// `(m, e)` with `self = m·2^e`, `m` from 2^-¼ to below 2^¾, and `e` whole, for positive normal numbers.
    ///
    /// For every other pattern of bits too, `m` is in that range and `e` is whole, from -1023 to 3072: what the formula
    /// below gives, at every width.
    #[inline(always)]
    fn split_exponent(self) -> (Self, Self) {
        // The patterns of doubles have the exponent above 52 bits of the fraction: moved by the pattern of 2^-¼, all
        // that belongs to one `e` begins with the same 12 bits. Or-ing them to 2^52 makes them a number.
        let moved = |lane| self.lane(lane).to_bits().wrapping_add(ONE - LEAST);
        let m = Self::from_fn(|lane| f64::from_bits((moved(lane) & ((1 << 52) - 1)) + LEAST));
        let e = Self::from_fn(|lane| f64::from_bits((moved(lane) >> 52) | TWO_TO_52.to_bits()));
        (m, e - Self::splat(TWO_TO_52 + 1023.0))
    }

    /// The number without the last 27 of its 53 bits (of the pattern, whatever it stands for): what is left times
    /// another such number is exact, and so is the difference to the number itself.
    #[inline(always)]
    fn head(self) -> Self {
        Self::from_fn(|lane| f64::from_bits(self.lane(lane).to_bits() & (u64::MAX << 27)))
    }

    /// `self·2^k`, rounded once, for `self` from ½ to 2 and whole `k` from -1100 to 1100; NaN where `self` is NaN.
    /// Anything may come out for other `k`: it must be selected away.
    #[inline(always)]
    fn times_exp2(self, k: Self) -> Self {
        // k + 2046 in the last bits of a pattern, halved: two exponents, of which each fits. The first product is exact.
        let biased = k + Self::splat(TWO_TO_52 + 2046.0);
        let half = |lane| biased.lane(lane).to_bits() >> 1;
        let first = Self::from_fn(|lane| f64::from_bits(half(lane) << 52));
        let second = Self::from_fn(|lane| f64::from_bits((biased.lane(lane).to_bits() - half(lane)) << 52));
        self * first * second
    }

    /// Sorts the numbers that the bits of `named` name, none of which is negative or NaN, the largest first, and with each what
    /// belongs to it. Of numbers that agree in the first 18 of their 53 bits any may come first; what comes behind those that
    /// are named is of no meaning.
    #[inline(always)]
    fn sort_descending(named: u32, numbers: &[f64; 8], tags: &[u64; 8], sorted: (&mut [f64; 8], &mut [u64; 8])) {
        sort::by_insertion(named, numbers, tags, sorted);
    }

    /// The largest of all lanes, none of which is NaN.
    #[inline(always)]
    fn largest(self) -> f64 {
        let mut values = [f64::NEG_INFINITY; MAX_WIDTH];
        self.store(&mut values);
        let [a, b, c, d, e, f, g, h] = values;
        a.max(b).max(c.max(d)).max(e.max(f).max(g.max(h)))
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
                assert!(same(va.head().lane(i), x.head()));
                let ((m, e), (one_m, one_e)) = (va.split_exponent(), x.split_exponent());
                assert!(same(m.lane(i), one_m) && same(e.lane(i), one_e));
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
            for lanes in [1, 2, 4, 8] {
                dispatch(lanes, crate::instructions_of_this_machine!(), LikePlainNumbers { a, b, bits });
            }
            LikePlainNumbers { a, b, bits }.run::<ArrayLanes<2>>();
            LikePlainNumbers { a, b, bits }.run::<ArrayLanes<4>>();
            LikePlainNumbers { a, b, bits }.run::<ArrayLanes<8>>();
        }
    }

    struct TimesExp2(f64, i32);

    impl Kernel for TimesExp2 {
        type Output = ();
        #[inline(always)]
        fn run<L: Lanes>(self) {
            let scaled = L::splat(self.0).times_exp2(L::splat(f64::from(self.1)));
            assert_eq!(scaled.lane(L::WIDTH - 1), libm::ldexp(self.0, self.1));
        }
    }

    proptest! {
        #[test]
        fn the_parts_of_a_number_make_it_up(x in any::<f64>()) {
            let (m, e) = x.split_exponent();
            prop_assert!((0.840_896_415_253_714_5..1.681_792_830_507_429).contains(&m) && e == e.floor());
            prop_assert!((-1023.0..=3072.0).contains(&e));
            if x.is_normal() && x > 0.0 {
                prop_assert_eq!(libm::ldexp(m, e as i32), x);
            }
            // 26 bits are multiples of 2^-25 for a number from 1 to 2, and what is cut off is less than one.
            let unit = f64::from_bits(x.to_bits() >> 12 | 1f64.to_bits());
            let steps = unit.head() * 33_554_432.0;
            prop_assert!(steps == steps.floor() && (0.0..1.0).contains(&(unit * 33_554_432.0 - steps)));
        }

        #[test]
        fn a_power_of_two_rounds_once(x in 0.5..=2.0f64, k in -1100..=1100i32) {
            prop_assert_eq!(x.times_exp2(f64::from(k)), libm::ldexp(x, k));
            for lanes in [1, 2, 4, 8] {
                dispatch(lanes, crate::instructions_of_this_machine!(), TimesExp2(x, k));
            }
        }
    }

    struct Sort<'a>(u32, &'a [f64; 8]);

    impl Kernel for Sort<'_> {
        type Output = Vec<(f64, u64)>;
        #[inline(always)]
        fn run<L: Lanes>(self) -> Self::Output {
            let Self(named, numbers) = self;
            let (mut sorted, mut tags) = ([9.0; 8], [9; 8]);
            L::sort_descending(named, numbers, &[10, 11, 12, 13, 14, 15, 16, 17], (&mut sorted, &mut tags));
            sorted.into_iter().zip(tags).take(named.count_ones() as usize).collect()
        }
    }

    proptest! {
        #[test]
        fn every_width_sorts(
            numbers in prop::array::uniform8(prop_oneof![0.0..9.0f64, (0..4u32).prop_map(f64::from), Just(f64::INFINITY)]),
            named in 0..256u32,
        ) {
            let short = |x: f64| x.to_bits() >> 35;
            for lanes in [1, 2, 4, 8] {
                let found = dispatch(lanes, crate::instructions_of_this_machine!(), Sort(named, &numbers));
                prop_assert!(found.is_sorted_by(|a, b| short(a.0) >= short(b.0)));
                prop_assert!(found.iter().all(|&(x, tag)| x == numbers[tag as usize - 10]));
                let tags = found.iter().fold(0, |bits, &(_, tag)| bits | 1 << (tag - 10));
                prop_assert_eq!(tags, named, "all that are named, and no others");
            }
        }
    }

    #[test]
    fn whole_numbers_are_indices() {
        for number in [0, 1, 77, (1 << 31) + 1, u32::MAX] {
            assert_eq!(index(f64::from(number)), number as usize);
        }
        let ramp = ArrayLanes::<4>::ramp(5);
        assert_eq!([0, 1, 2, 3].map(|lane| ramp.lane(lane)), [5.0, 6.0, 7.0, 8.0]);
    }

    #[test]
    fn a_mask_of_the_first_lanes() {
        assert_eq!(<<ArrayLanes<8> as Lanes>::Mask as Mask>::first(8).bits(), 0xff);
        assert_eq!(<<ArrayLanes<8> as Lanes>::Mask as Mask>::first(3).bits(), 0b111);
        assert!(!<bool as Mask>::first(0).any());
    }
}
