//! The tree as it is stored: nodes with eight boxes, leaves with up to eight primitives.

/// Children of a node, and primitives of a leaf, at most.
pub(crate) const WIDTH: usize = 8;

/// What is in a box of a node: another node, a leaf, or nothing.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct Child(u64);

impl Default for Child {
    fn default() -> Self {
        Self::NOTHING
    }
}

/// [`Child`], taken apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// The number of a node.
    Node(u32),
    /// The number of a leaf, while the tree is built.
    Leaf(u32),
    /// The same leaf, when its primitives have found their place.
    Block(Block),
    Nothing,
}

/// Where the numbers of a leaf start, and how many primitives of which kind they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Block {
    pub at: usize,
    pub spheres: usize,
    pub triangles: usize,
    pub instances: usize,
}

/// The two highest bits say what it is; a block has four bits for each count and 46 for its place.
const TAG: u32 = 62;
const PLACE: u32 = 46;

impl Child {
    pub const NOTHING: Self = Self(u64::MAX);
    pub const ROOT: Self = Self(0);

    pub fn node(index: usize) -> Self {
        Self(index as u64)
    }

    pub fn leaf(index: usize) -> Self {
        Self(index as u64 | 1 << TAG)
    }

    /// `at` is below 2⁴⁶, the counts are at most 8.
    pub fn block(Block { at, spheres, triangles, instances }: Block) -> Self {
        let counts = spheres | triangles << 4 | instances << 8;
        Self(at as u64 | (counts as u64) << PLACE | 2 << TAG)
    }

    #[inline(always)]
    pub fn kind(self) -> Kind {
        let Self(bits) = self;
        match bits >> TAG {
            0 => Kind::Node(bits as u32),
            1 => Kind::Leaf(bits as u32),
            2 => Kind::Block(Block {
                at: (bits & ((1 << PLACE) - 1)) as usize,
                spheres: (bits >> PLACE & 15) as usize,
                triangles: (bits >> (PLACE + 4) & 15) as usize,
                instances: (bits >> (PLACE + 8) & 15) as usize,
            }),
            _ => Kind::Nothing,
        }
    }

    /// The same child in lists where `nodes` nodes and `leaves` leaves stand before it.
    pub fn moved(self, nodes: usize, leaves: usize) -> Self {
        match self.kind() {
            Kind::Node(n) => Self::node(n as usize + nodes),
            Kind::Leaf(n) => Self::leaf(n as usize + leaves),
            Kind::Block(_) | Kind::Nothing => self,
        }
    }
}

impl std::fmt::Debug for Child {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.kind().fmt(f)
    }
}

/// Eight boxes and what is in them. Used places come first; an unused one holds a box that no ray meets.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct Node {
    /// Smallest coordinates: `min[axis][place]`.
    pub min: [[f32; WIDTH]; 3],
    /// Largest coordinates.
    pub max: [[f32; WIDTH]; 3],
    pub child: [Child; WIDTH],
}

impl Node {
    pub const EMPTY: Self =
        Self { min: [[f32::INFINITY; WIDTH]; 3], max: [[f32::NEG_INFINITY; WIDTH]; 3], child: [Child::NOTHING; WIDTH] };

    /// The places that are used, as bits.
    #[inline(always)]
    pub fn used(&self) -> u32 {
        (0..WIDTH).fold(0, |bits, place| bits | u32::from(self.child[place] != Child::NOTHING) << place)
    }

    /// One side of the boxes along an axis: 0 the smallest coordinates, 1 the largest.
    #[inline(always)]
    pub fn side(&self, axis: usize, side: usize) -> &[f32; WIDTH] {
        if side == 0 { &self.min[axis] } else { &self.max[axis] }
    }
}

/// `count` (1..=8) primitives from `first` on in [`Tree::order`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leaf {
    pub first: u32,
    pub count: u32,
}

/// A tree over primitives that it knows only by number.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tree {
    /// The first is the root, also for a single primitive; without primitives there is none. Each stands before those
    /// below it.
    pub nodes: Vec<Node>,
    pub leaves: Vec<Leaf>,
    /// The primitives, leaf by leaf, in each leaf in ascending order.
    pub order: Vec<u32>,
    /// Nodes on the longest way down; at most [`MAX_DEPTH`](super::build::MAX_DEPTH).
    pub depth: usize,
}
