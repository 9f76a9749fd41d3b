//! Choosing the width at run time.

use super::{ArrayLanes, Kernel, Lanes};

/// How many numbers a kernel computes together. The picture does not depend on it, and every width runs on every machine:
/// as plain arrays where the instructions are missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LaneWidth {
    /// 1.
    One,
    /// 2: SSE2, NEON, WASM `simd128`.
    Two,
    /// 4: AVX2.
    Four,
    /// 8: AVX-512.
    Eight,
}

impl LaneWidth {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::One, Self::Two, Self::Four, Self::Eight];

    /// The widest for which this machine has instructions.
    pub fn best() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            if super::x86::has_avx512() {
                return Self::Eight;
            }
            if super::x86::has_avx2() {
                return Self::Four;
            }
            Self::Two
        }
        #[cfg(any(target_arch = "aarch64", all(target_arch = "wasm32", target_feature = "simd128")))]
        return Self::Two;
        #[cfg(not(any(
            target_arch = "x86_64",
            target_arch = "aarch64",
            all(target_arch = "wasm32", target_feature = "simd128")
        )))]
        Self::One
    }

    /// The width for this many numbers: 1, 2, 4 or 8.
    pub fn of(numbers: usize) -> Option<Self> {
        Self::ALL.into_iter().find(|width| width.numbers() == numbers)
    }

    /// How many numbers are computed together.
    pub fn numbers(self) -> usize {
        match self {
            Self::One => 1,
            Self::Two => 2,
            Self::Four => 4,
            Self::Eight => 8,
        }
    }
}

impl Default for LaneWidth {
    fn default() -> Self {
        Self::best()
    }
}

#[cfg(target_arch = "aarch64")]
type Two = super::neon::Neon;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
type Two = super::wasm::Simd128;
#[cfg(target_arch = "x86_64")]
type Two = super::x86::Sse2;
#[cfg(not(any(
    target_arch = "x86_64",
    target_arch = "aarch64",
    all(target_arch = "wasm32", target_feature = "simd128")
)))]
type Two = ArrayLanes<2>;

/// Does some work at a width, with the best instructions that the machine has for it.
pub fn dispatch<K: Kernel>(width: LaneWidth, kernel: K) -> K::Output {
    match width {
        LaneWidth::One => f64::call(kernel),
        LaneWidth::Two => Two::call(kernel),
        #[cfg(target_arch = "x86_64")]
        LaneWidth::Four if super::x86::has_avx2() => super::x86::Avx2::call(kernel),
        #[cfg(target_arch = "x86_64")]
        LaneWidth::Eight if super::x86::has_avx512() => super::x86::Avx512::call(kernel),
        LaneWidth::Four => ArrayLanes::<4>::call(kernel),
        LaneWidth::Eight => ArrayLanes::<8>::call(kernel),
    }
}
