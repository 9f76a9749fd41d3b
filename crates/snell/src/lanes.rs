//! Choosing the width of the lanes at run time.

pub use snell_kernels::lanes::*;

use snell_kernels::instructions_of_this_machine;

/// How many numbers a kernel computes together. The picture does not depend on it, and every width may be asked for
/// on every machine: where the instructions are missing, they are plain arrays, or in WASM single numbers.
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
        LaneWidth::of(instructions_of_this_machine!().widest()).unwrap_or(Self::One)
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

/// Does some work at a width, with the best instructions that the machine has for it.
pub fn dispatch<K: Kernel>(width: LaneWidth, kernel: K) -> K::Output {
    snell_kernels::lanes::dispatch(width.numbers(), instructions_of_this_machine!(), kernel)
}
