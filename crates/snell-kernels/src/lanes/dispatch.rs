//! From a number of lanes to the type that has as many.

#![allow(unsafe_code, reason = "a function that says what it asks for")]

use super::{Kernel, Lanes};

/// Instructions that not every machine has. Whoever calls [`dispatch`] asks the machine: that takes the standard library.
#[derive(Clone, Copy, Debug, Default)]
pub struct Instructions {
    avx2: bool,
    avx512: bool,
}

impl Instructions {
    /// `avx2`: AVX2, POPCNT, BMI1, BMI2 and LZCNT. `avx512`: these, and AVX-512 F, DQ, VL and BW.
    ///
    /// # Safety
    /// The machine must have what is said to be there.
    pub const unsafe fn new(avx2: bool, avx512: bool) -> Self {
        Self { avx2, avx512 }
    }

    /// The largest number of lanes for which they are: 1 where there are only plain arrays.
    pub const fn widest(self) -> usize {
        if self.avx512 {
            8
        } else if self.avx2 {
            4
        } else if cfg!(any(
            target_arch = "x86_64",
            target_arch = "aarch64",
            all(target_arch = "wasm32", target_feature = "simd128")
        )) {
            2
        } else {
            1
        }
    }
}

/// Asks the machine for its [`Instructions`](crate::lanes::Instructions). A macro, because asking takes the standard library, which the
/// caller has.
#[macro_export]
macro_rules! instructions_of_this_machine {
    () => {{
        #[cfg(target_arch = "x86_64")]
        #[allow(unsafe_code, reason = "the machine has just been asked for what it is said to have")]
        // SAFETY: as above.
        let instructions = unsafe {
            let avx2 = is_x86_feature_detected!("avx2")
                && is_x86_feature_detected!("popcnt")
                && is_x86_feature_detected!("bmi1")
                && is_x86_feature_detected!("bmi2")
                && is_x86_feature_detected!("lzcnt");
            let avx512 = avx2
                && is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512vl")
                && is_x86_feature_detected!("avx512bw");
            $crate::lanes::Instructions::new(avx2, avx512)
        };
        #[cfg(not(target_arch = "x86_64"))]
        let instructions = $crate::lanes::Instructions::default();
        instructions
    }};
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
type Two = super::ArrayLanes<2>;

/// Does some work with so many lanes, 1, 2, 4 or 8, and with the best of these instructions; another number counts as 1. So
/// do 4 and 8 in WASM, which has no instructions for them: they would only be downloaded.
pub fn dispatch<K: Kernel>(lanes: usize, instructions: Instructions, kernel: K) -> K::Output {
    #[cfg(not(target_arch = "x86_64"))]
    let Instructions { .. } = instructions;
    match lanes {
        2 => Two::call(kernel),
        #[cfg(target_arch = "x86_64")]
        4 if instructions.avx2 => super::x86::Avx2::call(kernel),
        #[cfg(target_arch = "x86_64")]
        8 if instructions.avx512 => super::x86::Avx512::call(kernel),
        #[cfg(not(target_family = "wasm"))]
        4 => super::ArrayLanes::<4>::call(kernel),
        #[cfg(not(target_family = "wasm"))]
        8 => super::ArrayLanes::<8>::call(kernel),
        _ => f64::call(kernel),
    }
}
