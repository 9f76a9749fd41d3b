//! SSE2, AVX2 and AVX-512.
//!
//! The operations of these types compile to single instructions, and only within `Lanes::call`, which is compiled for
//! them. They must not run on a machine that lacks the instructions: the types are private to `lanes`, and only
//! [`dispatch`](super::dispatch) names them, for a machine that has them ([`Instructions`](super::Instructions)).

#![allow(unsafe_code, reason = "intrinsics; each block says why it is sound")]
#![allow(clippy::wildcard_imports, reason = "intrinsics come by the dozen, and their names say where from")]

use super::sort::by_insertion;
use super::{Kernel, LEAST, Lanes, Mask, ONE, TWO_TO_52};
use core::arch::x86_64::*;
use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Fetches some cache lines from this place on.
#[inline(always)]
pub(super) fn prefetch<const LINES: usize>(start: *const u8) {
    for line in 0..LINES {
        // SAFETY: a prefetch reads nothing that could be seen, and no address makes it fail.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(start.wrapping_add(64 * line).cast()) };
    }
}

/// Two numbers.
#[derive(Clone, Copy, Debug)]
pub struct Sse2(__m128d);
/// Two answers: all bits of a lane, or none.
#[derive(Clone, Copy, Debug)]
pub struct Sse2Mask(__m128d);
/// Four numbers.
#[derive(Clone, Copy, Debug)]
pub struct Avx2(__m256d);
/// Four answers: all bits of a lane, or none.
#[derive(Clone, Copy, Debug)]
pub struct Avx2Mask(__m256d);
/// Eight numbers.
#[derive(Clone, Copy, Debug)]
pub struct Avx512(__m512d);
/// Eight answers, one bit each.
#[derive(Clone, Copy, Debug)]
pub struct Avx512Mask(__mmask8);

operators!(Sse2: Add add _mm_add_pd, Sub sub _mm_sub_pd, Mul mul _mm_mul_pd, Div div _mm_div_pd);
operators!(Avx2: Add add _mm256_add_pd, Sub sub _mm256_sub_pd, Mul mul _mm256_mul_pd, Div div _mm256_div_pd);
operators!(Avx512: Add add _mm512_add_pd, Sub sub _mm512_sub_pd, Mul mul _mm512_mul_pd, Div div _mm512_div_pd);
operators!(Sse2Mask: BitAnd bitand _mm_and_pd, BitOr bitor _mm_or_pd);
operators!(Avx2Mask: BitAnd bitand _mm256_and_pd, BitOr bitor _mm256_or_pd);

impl BitAnd for Avx512Mask {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl BitOr for Avx512Mask {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl Not for Avx512Mask {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

impl Mask for Avx512Mask {
    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        Self(bits as __mmask8)
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        u32::from(self.0)
    }
}

macro_rules! wide_mask {
    ($mask:ident, $not:ident, $from_bits:ident, $movemask:ident) => {
        impl Not for $mask {
            type Output = Self;
            #[inline(always)]
            fn not(self) -> Self {
                // SAFETY: the machine has the instruction, see the top of the file.
                Self(unsafe { $not(self.0) })
            }
        }
        impl Mask for $mask {
            #[inline(always)]
            fn from_bits(bits: u32) -> Self {
                // SAFETY: the machine has the instructions, see the top of the file.
                Self(unsafe { $from_bits(bits) })
            }
            #[inline(always)]
            fn bits(self) -> u32 {
                // SAFETY: the machine has the instruction, see the top of the file.
                (unsafe { $movemask(self.0) }) as u32
            }
        }
    };
}
wide_mask!(Sse2Mask, not_sse2, from_bits_sse2, _mm_movemask_pd);
wide_mask!(Avx2Mask, not_avx2, from_bits_avx2, _mm256_movemask_pd);

macro_rules! lanes {
    (
        $type:ident($mask:ident), $width:literal, $features:literal, splat $splat:ident, load $load:ident,
        load_f32 $load_f32:ident, store $store:ident, sqrt $sqrt:ident, min $min:ident, max $max:ident,
        neg $neg:ident, compare $compare:ident, select $select:ident, compress $compress:ident, sort $sort:ident,
        integers $bits:ident $number:ident $splat64:ident $add64:ident $sub64:ident $and64:ident $or64:ident
        $shift_left:ident $shift_right:ident
    ) => {
        impl Neg for $type {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                // SAFETY: the machine has the instructions, see the top of the file.
                Self(unsafe { $neg(self.0) })
            }
        }
        impl Lanes for $type {
            type Mask = $mask;
            const WIDTH: usize = $width;

            fn call<K: Kernel>(kernel: K) -> K::Output {
                #[target_feature(enable = $features)]
                fn with_instructions<K: Kernel>(kernel: K) -> K::Output {
                    kernel.run::<$type>()
                }
                // SAFETY: the machine has the instructions, see the top of the file.
                unsafe { with_instructions(kernel) }
            }
            #[inline(always)]
            fn splat(value: f64) -> Self {
                // SAFETY: the machine has the instruction, see the top of the file.
                Self(unsafe { $splat(value) })
            }
            #[inline(always)]
            fn from_fn(value: impl FnMut(usize) -> f64) -> Self {
                Self::load(&core::array::from_fn::<f64, $width, _>(value))
            }
            #[inline(always)]
            fn lane(self, lane: usize) -> f64 {
                let mut values = [0.0; $width];
                self.store(&mut values);
                values[lane]
            }
            #[inline(always)]
            fn load(values: &[f64]) -> Self {
                let values = &values[..$width];
                // SAFETY: as many values are there, unaligned is allowed, and the machine has the instruction.
                Self(unsafe { $load(values.as_ptr()) })
            }
            #[inline(always)]
            fn load_f32(values: &[f32]) -> Self {
                let values = &values[..$width];
                // SAFETY: as many values are there, unaligned is allowed, and the machine has the instructions.
                Self(unsafe { $load_f32(values.as_ptr()) })
            }
            #[inline(always)]
            fn store(self, values: &mut [f64]) {
                let values = &mut values[..$width];
                // SAFETY: there is room for as many values, unaligned is allowed, and the machine has the instruction.
                unsafe { $store(values.as_mut_ptr(), self.0) }
            }
            #[inline(always)]
            fn compress(self, mask: $mask) -> Self {
                // SAFETY: the machine has the instructions, see the top of the file.
                Self(unsafe { $compress(mask.0, self.0) })
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                // SAFETY: the machine has the instruction, see the top of the file.
                Self(unsafe { $sqrt(self.0) })
            }
            #[inline(always)]
            fn lt(self, other: Self) -> $mask {
                // SAFETY: the machine has the instruction, see the top of the file.
                $mask(unsafe { $compare::<_CMP_LT_OQ>(self.0, other.0) })
            }
            #[inline(always)]
            fn le(self, other: Self) -> $mask {
                // SAFETY: the machine has the instruction, see the top of the file.
                $mask(unsafe { $compare::<_CMP_LE_OQ>(self.0, other.0) })
            }
            #[inline(always)]
            fn eq(self, other: Self) -> $mask {
                // SAFETY: the machine has the instruction, see the top of the file.
                $mask(unsafe { $compare::<_CMP_EQ_OQ>(self.0, other.0) })
            }
            #[inline(always)]
            fn select(mask: $mask, yes: Self, no: Self) -> Self {
                // SAFETY: the machine has the instructions, see the top of the file.
                Self(unsafe { $select(mask.0, yes.0, no.0) })
            }
            #[inline(always)]
            #[allow(unused_unsafe, reason = "only one of these needs instructions")]
            fn sort_descending(
                named: u32,
                numbers: &[f64; 8],
                tags: &[u64; 8],
                sorted: (&mut [f64; 8], &mut [u64; 8]),
            ) {
                // SAFETY: the machine has the instructions, see the top of the file.
                unsafe { $sort(named, numbers, tags, sorted) }
            }
            // As the definitions in the trait, on the patterns of all lanes at once.
            #[inline(always)]
            fn split_exponent(self) -> (Self, Self) {
                // SAFETY: the machine has the instructions, see the top of the file.
                unsafe {
                    let moved = $add64($bits(self.0), $splat64((ONE - LEAST) as i64));
                    let m = $add64($and64(moved, $splat64((1 << 52) - 1)), $splat64(LEAST as i64));
                    let e = $or64($shift_right::<52>(moved), $splat64(TWO_TO_52.to_bits() as i64));
                    (Self($number(m)), Self($number(e)) - Self::splat(TWO_TO_52 + 1023.0))
                }
            }
            #[inline(always)]
            fn head(self) -> Self {
                // SAFETY: the machine has the instruction, see the top of the file.
                Self(unsafe { $number($and64($bits(self.0), $splat64(-1 << 27))) })
            }
            #[inline(always)]
            fn times_exp2(self, k: Self) -> Self {
                let biased = k + Self::splat(TWO_TO_52 + 2046.0);
                // SAFETY: the machine has the instructions, see the top of the file.
                unsafe {
                    let biased = $bits(biased.0);
                    let half = $shift_right::<1>(biased);
                    let first = $number($shift_left::<52>(half));
                    let second = $number($shift_left::<52>($sub64(biased, half)));
                    self * Self(first) * Self(second)
                }
            }
            // MINPD and MAXPD are `a < b ? a : b` and `a > b ? a : b`, NaN and zeros included (Intel SDM, vol. 2).
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                // SAFETY: the machine has the instruction, see the top of the file.
                Self(unsafe { $min(self.0, other.0) })
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                // SAFETY: the machine has the instruction, see the top of the file.
                Self(unsafe { $max(self.0, other.0) })
            }
        }
    };
}

// What no single intrinsic does, width by width. Each of these needs the instructions in its name.

#[inline(always)]
unsafe fn neg_sse2(v: __m128d) -> __m128d {
    // SAFETY: see above.
    unsafe { _mm_xor_pd(v, _mm_set1_pd(-0.0)) }
}

#[inline(always)]
unsafe fn neg_avx2(v: __m256d) -> __m256d {
    // SAFETY: see above.
    unsafe { _mm256_xor_pd(v, _mm256_set1_pd(-0.0)) }
}

#[inline(always)]
unsafe fn neg_avx512(v: __m512d) -> __m512d {
    // SAFETY: see above.
    unsafe { _mm512_xor_pd(v, _mm512_set1_pd(-0.0)) }
}

#[inline(always)]
unsafe fn not_sse2(mask: __m128d) -> __m128d {
    // SAFETY: see above.
    unsafe { _mm_xor_pd(mask, _mm_castsi128_pd(_mm_set1_epi32(-1))) }
}

#[inline(always)]
unsafe fn not_avx2(mask: __m256d) -> __m256d {
    // SAFETY: see above.
    unsafe { _mm256_xor_pd(mask, _mm256_castsi256_pd(_mm256_set1_epi32(-1))) }
}

/// SSE2 has no comparison of 64-bit numbers: compares both halves with 32-bit ones.
#[inline(always)]
unsafe fn from_bits_sse2(bits: u32) -> __m128d {
    // SAFETY: see above.
    unsafe {
        let lanes = _mm_set_epi32(2, 2, 1, 1);
        _mm_castsi128_pd(_mm_cmpeq_epi32(_mm_and_si128(_mm_set1_epi32(bits as i32), lanes), lanes))
    }
}

#[inline(always)]
unsafe fn from_bits_avx2(bits: u32) -> __m256d {
    // SAFETY: see above.
    unsafe {
        let lanes = _mm256_set_epi64x(8, 4, 2, 1);
        let named = _mm256_and_si256(_mm256_set1_epi64x(i64::from(bits)), lanes);
        _mm256_castsi256_pd(_mm256_cmpeq_epi64(named, lanes))
    }
}

/// `_mm_cmp_pd` belongs to AVX; SSE2 has one intrinsic for each comparison.
#[inline(always)]
unsafe fn compare_sse2<const PREDICATE: i32>(a: __m128d, b: __m128d) -> __m128d {
    // SAFETY: see above.
    unsafe {
        match PREDICATE {
            _CMP_LT_OQ => _mm_cmplt_pd(a, b),
            _CMP_LE_OQ => _mm_cmple_pd(a, b),
            _ => _mm_cmpeq_pd(a, b),
        }
    }
}

#[inline(always)]
unsafe fn select_sse2(mask: __m128d, yes: __m128d, no: __m128d) -> __m128d {
    // SAFETY: see above.
    unsafe { _mm_or_pd(_mm_and_pd(mask, yes), _mm_andnot_pd(mask, no)) }
}

#[inline(always)]
unsafe fn select_avx2(mask: __m256d, yes: __m256d, no: __m256d) -> __m256d {
    // SAFETY: see above.
    unsafe { _mm256_blendv_pd(no, yes, mask) }
}

/// A bitonic network (Batcher 1968) of six steps: each compares all keys with another one, at a distance of 1, 2 or 4
/// places, and keeps the larger where the bit of `larger` is 1. There is nothing in it that depends on the numbers, so
/// nothing to predict. A key is the first half of a number, as the patterns of positive numbers are in their order, with its
/// place in the last bits: instructions for eight whole numbers of 32 bits answer much earlier than those for eight `f64`.
#[inline(always)]
unsafe fn sort_avx512(
    named: u32,
    numbers: &[f64; 8],
    tags: &[u64; 8],
    (sorted, sorted_tags): (&mut [f64; 8], &mut [u64; 8]),
) {
    // SAFETY: see above; as many numbers are there.
    unsafe {
        let numbers = _mm512_loadu_pd(numbers.as_ptr());
        let halves = _mm512_cvtepi64_epi32(_mm512_srli_epi64::<32>(_mm512_castpd_si512(numbers)));
        let places = _mm256_set_epi32(7, 6, 5, 4, 3, 2, 1, 0);
        let keys = _mm256_or_si256(_mm256_andnot_si256(_mm256_set1_epi32(7), halves), places);
        let mut keys = _mm256_mask_blend_epi32(named as __mmask8, _mm256_set1_epi32(-1), keys);
        macro_rules! step {
            ($other:expr, $larger:literal) => {
                let other = $other;
                keys = _mm256_blend_epi32::<$larger>(_mm256_min_epi32(keys, other), _mm256_max_epi32(keys, other));
            };
        }
        step!(_mm256_shuffle_epi32::<0b10_11_00_01>(keys), 0b1001_1001);
        step!(_mm256_shuffle_epi32::<0b01_00_11_10>(keys), 0b1100_0011);
        step!(_mm256_shuffle_epi32::<0b10_11_00_01>(keys), 0b1010_0101);
        step!(_mm256_permute2x128_si256::<1>(keys, keys), 0b0000_1111);
        step!(_mm256_shuffle_epi32::<0b01_00_11_10>(keys), 0b0011_0011);
        step!(_mm256_shuffle_epi32::<0b10_11_00_01>(keys), 0b0101_0101);
        // Only the last three bits of a place count.
        let places = _mm512_cvtepu32_epi64(keys);
        _mm512_storeu_pd(sorted.as_mut_ptr(), _mm512_permutexvar_pd(places, numbers));
        let tags = _mm512_permutexvar_epi64(places, _mm512_loadu_si512(tags.as_ptr().cast()));
        _mm512_storeu_si512(sorted_tags.as_mut_ptr().cast(), tags);
    }
}

#[inline(always)]
unsafe fn select_avx512(mask: __mmask8, yes: __m512d, no: __m512d) -> __m512d {
    // SAFETY: see above.
    unsafe { _mm512_mask_blend_pd(mask, no, yes) }
}

/// `at` must point to two numbers.
#[inline(always)]
unsafe fn load_f32_sse2(at: *const f32) -> __m128d {
    // SAFETY: see above.
    unsafe { _mm_set_pd(f64::from(*at.add(1)), f64::from(*at)) }
}

/// `at` must point to four numbers.
#[inline(always)]
unsafe fn load_f32_avx2(at: *const f32) -> __m256d {
    // SAFETY: see above.
    unsafe { _mm256_cvtps_pd(_mm_loadu_ps(at)) }
}

/// `at` must point to eight numbers.
#[inline(always)]
unsafe fn load_f32_avx512(at: *const f32) -> __m512d {
    // SAFETY: see above.
    unsafe { _mm512_cvtps_pd(_mm256_loadu_ps(at)) }
}

#[inline(always)]
unsafe fn compress_sse2(mask: __m128d, v: __m128d) -> __m128d {
    // SAFETY: see above.
    unsafe { if _mm_movemask_pd(mask) == 2 { _mm_unpackhi_pd(v, v) } else { v } }
}

#[inline(always)]
unsafe fn compress_avx2(mask: __m256d, v: __m256d) -> __m256d {
    // SAFETY: see above. Four answers are a number below 16.
    unsafe {
        let places = &PACKED[_mm256_movemask_pd(mask) as usize & 15];
        let places = _mm256_loadu_si256(places.as_ptr().cast());
        _mm256_castps_pd(_mm256_permutevar8x32_ps(_mm256_castpd_ps(v), places))
    }
}

/// For each of the 16 masks the places of its lanes, as pairs of 32-bit numbers.
const PACKED: [[i32; 8]; 16] = {
    let mut table = [[0; 8]; 16];
    let mut bits = 0;
    while bits < 16 {
        let (mut lane, mut place) = (0, 0);
        while lane < 4 {
            if bits >> lane & 1 == 1 {
                table[bits][2 * place] = 2 * lane;
                table[bits][2 * place + 1] = 2 * lane + 1;
                place += 1;
            }
            lane += 1;
        }
        bits += 1;
    }
    table
};

lanes!(
    Sse2(Sse2Mask), 2, "sse2", splat _mm_set1_pd, load _mm_loadu_pd, load_f32 load_f32_sse2,
    store _mm_storeu_pd, sqrt _mm_sqrt_pd, min _mm_min_pd, max _mm_max_pd, neg neg_sse2, compare compare_sse2,
    select select_sse2, compress compress_sse2, sort by_insertion,
    integers _mm_castpd_si128 _mm_castsi128_pd _mm_set1_epi64x _mm_add_epi64 _mm_sub_epi64 _mm_and_si128 _mm_or_si128
    _mm_slli_epi64 _mm_srli_epi64
);
lanes!(
    Avx2(Avx2Mask), 4, "avx2,popcnt,bmi1,bmi2,lzcnt", splat _mm256_set1_pd, load _mm256_loadu_pd,
    load_f32 load_f32_avx2, store _mm256_storeu_pd, sqrt _mm256_sqrt_pd, min _mm256_min_pd, max _mm256_max_pd,
    neg neg_avx2, compare _mm256_cmp_pd, select select_avx2, compress compress_avx2, sort by_insertion,
    integers _mm256_castpd_si256 _mm256_castsi256_pd _mm256_set1_epi64x _mm256_add_epi64 _mm256_sub_epi64 _mm256_and_si256 _mm256_or_si256
    _mm256_slli_epi64 _mm256_srli_epi64
);
lanes!(
    Avx512(Avx512Mask), 8, "avx512f,avx512dq,avx512vl,avx512bw,avx2,popcnt,bmi1,bmi2,lzcnt",
    splat _mm512_set1_pd, load _mm512_loadu_pd, load_f32 load_f32_avx512, store _mm512_storeu_pd,
    sqrt _mm512_sqrt_pd, min _mm512_min_pd, max _mm512_max_pd, neg neg_avx512, compare _mm512_cmp_pd_mask,
    select select_avx512, compress _mm512_maskz_compress_pd, sort sort_avx512,
    integers _mm512_castpd_si512 _mm512_castsi512_pd _mm512_set1_epi64 _mm512_add_epi64 _mm512_sub_epi64 _mm512_and_si512 _mm512_or_si512
    _mm512_slli_epi64 _mm512_srli_epi64
);
