//! The tree as it is stored: nodes with eight boxes, leaves with up to eight primitives.

use crate::geometry::bounds::OuterBox;

/// Children of a node, and primitives of a leaf, at most.
pub const WIDTH: usize = 8;

/// No tree is deeper: no way down passes more nodes. Real ones have about ten levels. A builder halves nodes from a depth of 64 on, and
/// uses up 2^32 primitives in 32 more levels.
pub const MAX_DEPTH: usize = 64 + 33;
/// Boxes that can wait for a ray on its way down: all but one of each node that it passes.
pub const MOST_WAITING: usize = (WIDTH - 1) * MAX_DEPTH;

/// What is in a box of a node: another node, a leaf, or nothing.
#[derive(Clone, Copy, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(transparent)]
pub struct Child(u64);

impl Default for Child {
    fn default() -> Self {
        Self::NOTHING
    }
}

/// [`Child`], taken apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The number of a node.
    Node(u32),
    /// The number of a leaf, while the tree is built.
    Leaf(u32),
    /// The same leaf, when its primitives have found their place.
    Block(Block),
    /// There is none.
    Nothing,
}

/// Where the numbers of a leaf start, and what is there first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block {
    /// Place of its first number.
    pub at: usize,
    /// The first run.
    pub run: Run,
}

/// Some primitives of one kind in a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Run {
    /// Number of the kind of shape.
    pub kind: usize,
    /// How many, up to 8.
    pub count: usize,
    /// Does another run follow?
    pub more: bool,
}

/// The two highest bits say what it is; a block has 46 for its place, then those of its first run.
const TAG: u32 = 62;
const PLACE: u32 = 46;

/// Four bits for the count, one for whether there is more, the rest for the kind.
const COUNT: u32 = 4;

impl Run {
    fn bits(self) -> u64 {
        let Self { kind, count, more } = self;
        count as u64 | u64::from(more) << COUNT | (kind as u64) << (COUNT + 1)
    }

    #[inline(always)]
    fn of_bits(bits: u64) -> Self {
        let (kind, count) = ((bits >> (COUNT + 1)) as usize, (bits & ((1 << COUNT) - 1)) as usize);
        Self { kind, count, more: bits >> COUNT & 1 == 1 }
    }

    /// As it stands in a leaf in front of the run.
    #[inline]
    pub fn number(self) -> f64 {
        self.bits() as f64
    }

    /// The inverse of [`Run::number`].
    #[inline(always)]
    pub fn of_number(number: f64) -> Self {
        Self::of_bits(number as u64)
    }
}

impl Child {
    /// No child.
    pub const NOTHING: Self = Self(3 << TAG);
    /// The root of a tree.
    pub const ROOT: Self = Self(0);

    /// The node of this number.
    #[inline]
    pub fn node(index: usize) -> Self {
        Self(index as u64)
    }

    /// The leaf of this number, while the tree is built.
    #[inline]
    pub fn leaf(index: usize) -> Self {
        Self(index as u64 | 1 << TAG)
    }

    /// `at` is below 2⁴⁶, the count is at most 8.
    #[inline]
    pub fn block(Block { at, run }: Block) -> Self {
        Self(at as u64 | run.bits() << PLACE | 2 << TAG)
    }

    /// Is it another node?
    #[inline(always)]
    pub fn is_node(self) -> bool {
        self.0 >> TAG == 0
    }

    /// The number of a node.
    #[inline(always)]
    pub fn number(self) -> usize {
        self.0 as u32 as usize
    }

    /// Where a leaf with its place stands.
    #[inline(always)]
    pub fn place(self) -> Block {
        let Self(bits) = self;
        let run = Run::of_bits(bits >> PLACE & ((1 << (TAG - PLACE)) - 1));
        Block { at: (bits & ((1 << PLACE) - 1)) as usize, run }
    }

    /// What it is.
    #[inline(always)]
    pub fn kind(self) -> Kind {
        let Self(bits) = self;
        match bits >> TAG {
            0 => Kind::Node(bits as u32),
            1 => Kind::Leaf(bits as u32),
            2 => Kind::Block(self.place()),
            _ => Kind::Nothing,
        }
    }

    /// The same child in lists where `nodes` nodes and `leaves` leaves stand before it.
    #[inline]
    pub fn moved(self, nodes: usize, leaves: usize) -> Self {
        match self.kind() {
            Kind::Node(n) => Self::node(n as usize + nodes),
            Kind::Leaf(n) => Self::leaf(n as usize + leaves),
            Kind::Block(_) | Kind::Nothing => self,
        }
    }
}

impl core::fmt::Debug for Child {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        self.kind().fmt(f)
    }
}

/// Eight boxes and what is in them. Used places come first; an unused one holds a box that no ray meets.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct Node {
    /// Smallest and largest coordinates: `planes[2·axis][place]` and `planes[2·axis + 1][place]`.
    pub planes: [[f32; WIDTH]; 6],
    /// What is in each box.
    pub child: [Child; WIDTH],
}

impl Node {
    /// No boxes at all.
    pub const EMPTY: Self = {
        let (min, max) = ([f32::INFINITY; WIDTH], [f32::NEG_INFINITY; WIDTH]);
        Self { planes: [min, max, min, max, min, max], child: [Child::NOTHING; WIDTH] }
    };

    /// The box in a place.
    #[inline]
    pub fn bounds(&self, place: usize) -> OuterBox {
        let side = |side: usize| [0, 1, 2].map(|axis| self.planes[plane(axis, side)][place]);
        OuterBox { min: side(0), max: side(1) }
    }

    /// Puts a box into a place.
    #[inline]
    pub fn set_bounds(&mut self, place: usize, bounds: &OuterBox) {
        for axis in 0..3 {
            self.planes[plane(axis, 0)][place] = bounds.min[axis];
            self.planes[plane(axis, 1)][place] = bounds.max[axis];
        }
    }

    /// The places that are used, as bits.
    #[inline(always)]
    pub fn used(&self) -> u32 {
        (0..WIDTH).fold(0, |bits, place| bits | u32::from(self.child[place] != Child::NOTHING) << place)
    }
}

/// The number of a side of the boxes: 0 the smallest coordinates along an axis, 1 the largest.
#[inline(always)]
pub const fn plane(axis: usize, side: usize) -> usize {
    2 * axis + side
}
