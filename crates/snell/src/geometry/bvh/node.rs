//! Eight boxes side by side, and what is in them.

use crate::lanes::Lanes;

/// Boxes of a node.
pub(crate) const WIDTH: usize = 8;

/// Eight boxes and what is in them.
///
/// A place that is not used holds a box that no ray meets.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Node {
    /// Smallest x of the eight boxes, largest x, smallest y, largest y, smallest z, largest z.
    pub planes: [[f32; WIDTH]; 6],
    pub child: [Child; WIDTH],
}

impl Node {
    pub const EMPTY: Self = {
        let (low, high) = ([f32::INFINITY; WIDTH], [f32::NEG_INFINITY; WIDTH]);
        Self { planes: [low, high, low, high, low, high], child: [Child::NOTHING; WIDTH] }
    };

    /// One side of the boxes from one place on, along an axis: 0 the smaller coordinates, 1 the larger ones.
    #[inline(always)]
    pub fn plane<L: Lanes>(&self, axis: usize, side: usize, start: usize) -> L {
        L::load_f32(&self.planes[2 * axis + side][start..])
    }
}

/// What is in a box: another node, or a leaf, by number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Child(u32);

const LEAF: u32 = 1 << 31;

impl Child {
    pub const NOTHING: Self = Self(u32::MAX);
    pub const ROOT: Self = Self(0);

    pub fn node(number: usize) -> Self {
        Self(number as u32)
    }

    pub fn leaf(number: usize) -> Self {
        Self(number as u32 | LEAF)
    }

    /// The number of the leaf, or of the node.
    #[inline(always)]
    pub fn number(self) -> Result<usize, usize> {
        if self.0 & LEAF != 0 { Ok((self.0 & !LEAF) as usize) } else { Err(self.0 as usize) }
    }
}
