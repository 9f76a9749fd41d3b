//! From a binary tree to one with eight children a node: of all the ways to leave out inner nodes, and to join the
//! primitives below a node into one leaf, the cheapest (Ylitie, Karras, Laine, *Efficient Incoherent Ray Traversal on
//! GPUs Through Compressed Wide BVHs*, 2017, section 3.1).

use super::item::Extent;
use super::{Leaf, Tree};
use crate::geometry::bounds::OuterBox;
use crate::geometry::bvh::node::{Child, Node, WIDTH};
use crate::threads;

/// Cost of visiting a node: of testing a ray against its eight boxes.
pub(super) const NODE_COST: f64 = 1.0;
/// Cost of visiting a leaf.
const LEAF_COST: f64 = 0.6;
/// Cost of each primitive in it, besides.
const PRIMITIVE_COST: f64 = 0.15;

/// No part is larger that is made in one go by one thread.
const LARGEST_PART: usize = 1 << 14;

/// A node of the binary tree. They stand in the order in which a walk comes by: a node, then all below its left
/// child, then all below its right child.
#[derive(Clone, Copy, Debug)]
pub(super) struct Binary {
    min: [f32; 3],
    max: [f32; 3],
    /// Primitives below it.
    pub count: u32,
    /// How far behind it its right child stands; 0 for a leaf. The left one is the next node.
    pub right: u32,
    /// With at most `i + 1` places for what is below this node (`i = 7`: for the children of a wide node in its
    /// place), how many go to the left child; 0: as with one place less. `[0]`: is the node itself a leaf (1) or a wide
    /// node (0)?
    left_places: [u8; WIDTH],
}

/// The lowest cost of what is below a binary node if it gets at most 1, 2, … 8 places.
#[derive(Clone, Copy, Debug)]
pub(super) struct Costs([f64; WIDTH]);

pub(super) fn leaf_cost(count: u32, area: f64) -> f64 {
    (LEAF_COST + PRIMITIVE_COST * f64::from(count)) * area
}

impl Binary {
    pub const UNFINISHED: Self = Self { min: [0.0; 3], max: [0.0; 3], count: 0, right: 0, left_places: [0; WIDTH] };

    fn new(extent: &Extent, count: usize, right: usize, left_places: [u8; WIDTH]) -> Self {
        let ([a, b, c, _], [d, e, f, _]) = (extent.min, extent.max);
        Self { min: [a, b, c], max: [d, e, f], count: count as u32, right: right as u32, left_places }
    }

    fn is_leaf(&self) -> bool {
        self.left_places[0] == 1
    }

    pub fn extent(&self) -> Extent {
        let ([a, b, c], [d, e, f]) = (self.min, self.max);
        Extent { min: [a, b, c, 0.0], max: [d, e, f, 0.0] }
    }

    pub fn leaf(extent: &Extent, count: usize) -> (Self, Costs) {
        let mut places = [0; WIDTH];
        places[0] = 1;
        (Self::new(extent, count, 0, places), Costs([leaf_cost(count as u32, extent.area()); WIDTH]))
    }

    /// `count`: primitives below it.
    pub fn inner(extent: &Extent, count: usize, right: usize, costs: [&Costs; 2]) -> (Self, Costs) {
        let [Costs(l), Costs(r)] = costs;
        let mut all = [f64::INFINITY; WIDTH];
        let mut left_places = [0; WIDTH];
        for places in 2..=WIDTH {
            // With infinite boxes no cost is below another; then there must be some answer.
            let (mut best, mut left_best) = (l[0] + r[places - 2], 1);
            for left in 2..places {
                let cost = l[left - 1] + r[places - left - 1];
                if cost < best {
                    (best, left_best) = (cost, left as u8);
                }
            }
            (all[places - 1], left_places[places - 1]) = (best, left_best);
        }
        let area = extent.area();
        let as_leaf = leaf_cost(count as u32, area);
        all[0] = all[WIDTH - 1] + NODE_COST * area;
        if count <= WIDTH && as_leaf <= all[0] {
            (all[0], left_places[0]) = (as_leaf, 1);
        }
        for i in 1..WIDTH - 1 {
            if all[i - 1] <= all[i] {
                (all[i], left_places[i]) = (all[i - 1], 0);
            }
        }
        (Self::new(extent, count, right, left_places), Costs(all))
    }
}

impl Costs {
    /// Of the tree that is made of the part alone.
    #[cfg(test)]
    pub fn least(&self) -> f64 {
        self.0[0]
    }
}

/// A binary tree, in pieces as they were made by several threads.
pub(super) enum Piece {
    Whole(Vec<Binary>),
    Joined { root: Binary, children: Box<[Piece; 2]> },
}

impl Piece {
    /// How many nodes it has.
    pub fn len(&self) -> usize {
        match self {
            Self::Whole(nodes) => nodes.len(),
            Self::Joined { children, .. } => 1 + children[0].len() + children[1].len(),
        }
    }

    /// All nodes in one list.
    pub fn flatten(self) -> Vec<Binary> {
        fn append(piece: Piece, all: &mut Vec<Binary>) {
            match piece {
                Piece::Whole(nodes) => all.extend(nodes),
                Piece::Joined { root, children } => {
                    all.push(root);
                    children.into_iter().for_each(|child| append(child, all));
                }
            }
        }
        if let Self::Whole(nodes) = self {
            return nodes;
        }
        let mut all = Vec::with_capacity(self.len());
        append(self, &mut all);
        all
    }
}

/// A node in a tree of pieces: in a whole piece the one at `at`.
#[derive(Clone, Copy)]
struct Place<'a> {
    piece: &'a Piece,
    at: usize,
}

impl<'a> Place<'a> {
    fn node(self) -> &'a Binary {
        match self.piece {
            Piece::Whole(nodes) => &nodes[self.at],
            Piece::Joined { root, .. } => root,
        }
    }

    fn children(self) -> [Self; 2] {
        match self.piece {
            Piece::Whole(nodes) => {
                let right = self.at + nodes[self.at].right as usize;
                [Self { at: self.at + 1, ..self }, Self { at: right, ..self }]
            }
            Piece::Joined { children, .. } => {
                [Self { piece: &children[0], at: 0 }, Self { piece: &children[1], at: 0 }]
            }
        }
    }
}

/// What is made of a part of the binary tree.
#[derive(Default)]
struct Part {
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
    depth: usize,
}

/// A part to be made: below the binary node `at`, of the primitives of `order`, which are those from `first` on.
struct Job<'a> {
    at: Place<'a>,
    first: usize,
    depth: usize,
    order: &'a mut [u32],
    /// Where it hangs: a node of the part above, and a place in it.
    parent: (usize, usize),
}

/// Children of a wide node: binary nodes.
struct Children<'a> {
    found: [Place<'a>; WIDTH],
    count: usize,
}

impl<'a> Children<'a> {
    /// Of the wide node that stands in place of the binary node `at`.
    fn of(at: Place<'a>) -> Self {
        let mut all = Self { found: [at; WIDTH], count: 0 };
        // A root that is a leaf becomes the only child of a node.
        all.find(at, if at.node().is_leaf() { 1 } else { WIDTH });
        all
    }

    fn find(&mut self, at: Place<'a>, mut places: usize) {
        let node = at.node();
        // It may not be worth while to use them all.
        while places > 1 && node.left_places[places - 1] == 0 {
            places -= 1;
        }
        if places == 1 {
            self.found[self.count] = at;
            self.count += 1;
            return;
        }
        let ([left, right], left_places) = (at.children(), usize::from(node.left_places[places - 1]));
        self.find(left, left_places);
        self.find(right, places - left_places);
    }
}

/// Makes the wide tree. `order` has the primitives in the order of the binary tree.
pub(super) fn collapse(binary: &Piece, mut order: Vec<u32>, parallel: bool) -> Tree {
    // First the nodes near the root, then everything below them, part by part.
    let (mut top, mut jobs) = (Part::default(), Vec::new());
    let root = Place { piece: binary, at: 0 };
    make(Job { at: root, first: 0, depth: 1, order: &mut order, parent: (0, 0) }, LARGEST_PART, &mut top, &mut jobs);
    let places: Vec<_> = jobs.iter().map(|job| job.parent).collect();
    let part = |job| {
        let mut part = Part::default();
        make(job, 0, &mut part, &mut Vec::new());
        part
    };
    let parts: Vec<Part> = threads::map(parallel, jobs, part);
    let Part { mut nodes, mut leaves, mut depth } = top;
    nodes.reserve_exact(parts.iter().map(|p| p.nodes.len()).sum());
    leaves.reserve_exact(parts.iter().map(|p| p.leaves.len()).sum());
    for ((parent, place), part) in places.into_iter().zip(parts) {
        let (nodes_before, leaves_before) = (nodes.len(), leaves.len());
        nodes[parent].child[place] = Child::node(nodes_before);
        leaves.extend(part.leaves);
        nodes.extend(part.nodes);
        for child in nodes[nodes_before..].iter_mut().flat_map(|node| &mut node.child) {
            *child = child.moved(nodes_before, leaves_before);
        }
        depth = depth.max(part.depth);
    }
    Tree { nodes, leaves, order, depth }
}

/// Makes the wide node in place of `job.at` and what is below it, but leaves parts of at most `largest_part` primitives
/// to other jobs.
fn make<'a>(job: Job<'a>, largest_part: usize, part: &mut Part, jobs: &mut Vec<Job<'a>>) {
    let Job { at, mut first, depth, mut order, .. } = job;
    let index = part.nodes.len();
    part.nodes.push(Node::EMPTY);
    part.depth = part.depth.max(depth);
    let children = Children::of(at);
    for (place, &at) in children.found[..children.count].iter().enumerate() {
        let child = at.node();
        let (own, rest) = order.split_at_mut(child.count as usize);
        order = rest;
        part.nodes[index].set_bounds(place, &OuterBox { min: child.min, max: child.max });
        if child.is_leaf() {
            own.sort_unstable();
            part.nodes[index].child[place] = Child::leaf(part.leaves.len());
            part.leaves.push(Leaf { first: first as u32, count: child.count });
        } else {
            let job = Job { at, first, depth: depth + 1, order: own, parent: (index, place) };
            if child.count as usize <= largest_part {
                jobs.push(job);
            } else {
                part.nodes[index].child[place] = Child::node(part.nodes.len());
                make(job, largest_part, part, jobs);
            }
        }
        first += child.count as usize;
    }
}
