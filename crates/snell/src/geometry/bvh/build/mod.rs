//! Building the tree: a binary one from the top (`binned`, `division`), made better where there is time for it
//! (`reinsertion`), and from it one with eight children a node (`collapse`).
//!
//! The work is bounded for any input, also for a million primitives in the same place: below [`SAH_DEPTH`] levels, and
//! where all centres coincide, a node is cut into halves by count. The tree does not depend on the number of threads:
//! they share out work that is divided in the same way for all numbers, and join only boxes and counts, which are exact.

mod binned;
mod collapse;
mod division;
mod item;
mod reinsertion;

use super::node::{MAX_DEPTH, Node};
use crate::geometry::bounds::OuterBox;
use crate::threads;
use binned::{Bins, Grid, Split};
use collapse::{Binary, Costs, Piece};
use item::{Extent, Item};

/// From this depth on nodes are halved, and 2^32 primitives are used up after 32 more levels.
const SAH_DEPTH: usize = 64;
/// Fewer primitives are not worth a second thread.
const PARALLEL: usize = 1 << 12;

/// How much work goes into the tree. It changes times only, never the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// Boxes are cut in the middle. Built in less than half the time; traversal visits about a tenth more.
    Fast,
    /// The surface area heuristic.
    #[default]
    Good,
    /// The surface area heuristic down to single primitives, then every part of the tree is tried elsewhere. Takes five
    /// to ten times as long; traversal visits up to a tenth less, where primitives are of different sizes.
    Best,
}

/// Builds the tree over `count` primitives, fewer than 2³¹, whose boxes are `bounds(primitive)`; they have no NaN.
/// `parallel`: with all threads of the pool it is called in.
pub(super) fn build(count: usize, bounds: impl Fn(usize) -> OuterBox + Sync, quality: Quality, parallel: bool) -> Tree {
    Builder { quality, parallel: parallel && count > PARALLEL }.build(count, &bounds)
}

/// `count` (1..=8) primitives from `first` on in [`Tree::order`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Leaf {
    pub first: u32,
    pub count: u32,
}

/// A tree over primitives that it knows only by number.
#[derive(Clone, Debug, Default)]
pub(super) struct Tree {
    /// The first is the root, also for a single primitive; without primitives there is none. Each stands before those
    /// below it.
    pub nodes: Vec<Node>,
    pub leaves: Vec<Leaf>,
    /// The primitives, leaf by leaf, in each leaf in ascending order.
    pub order: Vec<u32>,
    /// Nodes on the longest way down; at most [`MAX_DEPTH`].
    pub depth: usize,
}

struct Builder {
    quality: Quality,
    parallel: bool,
}

/// What was made of some items: a part of the binary tree, where their boxes lie, and the costs of the part.
struct Grown<Part> {
    part: Part,
    extent: Extent,
    costs: Costs,
}

impl Builder {
    fn build(&self, count: usize, bounds: &(impl Fn(usize) -> OuterBox + Sync)) -> Tree {
        if count == 0 {
            return Tree::default();
        }
        let item = |id: usize| Item::new(id as u32, &bounds(id));
        let mut items: Vec<Item> = threads::map(self.parallel, 0..count, item);
        let chunks: Vec<&[Item]> = items.chunks(PARALLEL).collect();
        let centers = threads::map(self.parallel, chunks, binned::centers);
        let centers = centers.iter().fold(Extent::EMPTY, |all, some| all.join(some));
        let mut binary = self.grow_pieces(&mut items, &centers, 1).part;
        let mut order: Vec<u32> = threads::map(self.parallel, &items, Item::id);
        drop(items);
        if self.quality == Quality::Best {
            let improved;
            (improved, order) = reinsertion::improve(binary.flatten(), order, MAX_DEPTH, self.parallel);
            binary = Piece::Whole(improved);
        }
        collapse::collapse(&binary, order, self.parallel)
    }

    /// The part over some items, with both children of a large node at the same time.
    fn grow_pieces(&self, items: &mut [Item], centers: &Extent, depth: usize) -> Grown<Piece> {
        let (count, mut bins) = (items.len(), Bins::EMPTY);
        if !self.parallel || count <= PARALLEL {
            let mut nodes = Vec::with_capacity(count);
            let Grown { extent, costs, .. } = self.grow(items, centers, depth, &mut nodes, &mut bins);
            return Grown { part: Piece::Whole(nodes), extent, costs };
        }
        let (left, [left_centers, right_centers]) = self.split(items, centers, depth, &mut bins);
        let (left, right) = items.split_at_mut(left);
        let (left, right) = threads::join(
            || self.grow_pieces(left, &left_centers, depth + 1),
            || self.grow_pieces(right, &right_centers, depth + 1),
        );
        let extent = left.extent.join(&right.extent);
        let (root, costs) = Binary::inner(&extent, count, 1 + left.part.len(), [&left.costs, &right.costs]);
        Grown { part: Piece::Joined { root, children: Box::new([left.part, right.part]) }, extent, costs }
    }

    /// Appends the part over some items. `bins`: room to work.
    fn grow(
        &self,
        items: &mut [Item],
        centers: &Extent,
        depth: usize,
        nodes: &mut Vec<Binary>,
        bins: &mut Bins,
    ) -> Grown<()> {
        let (index, count) = (nodes.len(), items.len());
        nodes.push(Binary::UNFINISHED);
        let (extent, (node, costs));
        if count <= self.smallest() {
            extent = items.iter().fold(Extent::EMPTY, |all, item| all.join(&item.0));
            (node, costs) = Binary::leaf(&extent, count);
        } else {
            let (left, [left_centers, right_centers]) = self.split(items, centers, depth, bins);
            let (left, right) = items.split_at_mut(left);
            let left = self.grow(left, &left_centers, depth + 1, nodes, bins);
            let right_index = nodes.len();
            let right = self.grow(right, &right_centers, depth + 1, nodes, bins);
            extent = left.extent.join(&right.extent);
            (node, costs) = Binary::inner(&extent, count, right_index - index, [&left.costs, &right.costs]);
        }
        nodes[index] = node;
        Grown { part: (), extent, costs }
    }

    /// So few items are not split any more. Whether larger leaves are better, `collapse` finds out.
    fn smallest(&self) -> usize {
        match self.quality {
            Quality::Fast => 4,
            Quality::Good => 2,
            Quality::Best => 1,
        }
    }

    /// Sorts the items of a node, more than one, into two parts, of which none is empty; gives the size of the first,
    /// and where the centres of each part lie.
    fn split(&self, items: &mut [Item], centers: &Extent, depth: usize, bins: &mut Bins) -> (usize, [Extent; 2]) {
        let count = items.len();
        if self.quality != Quality::Fast && count <= division::FEW {
            // What follows needs no centres.
            return (division::divide(items), [Extent::EMPTY; 2]);
        }
        let split = if depth >= SAH_DEPTH {
            None
        } else if self.quality == Quality::Fast {
            Split::middle(centers)
        } else {
            let grid = Grid::new(centers, count);
            if self.parallel && count > binned::MANY {
                *bins = Bins::of_many(items, &grid);
            } else {
                bins.fill(items, &grid);
            }
            Split::best(bins, &grid, count)
        };
        // Both parts have items, as the same numbers come out each time. Where they are infinite, who knows.
        if let Some((left, centers)) = split.map(|split| split.partition(items))
            && (1..count).contains(&left)
        {
            return (left, centers);
        }
        let (left, right) = items.split_at(count / 2);
        (left.len(), [binned::centers(left), binned::centers(right)])
    }
}

#[cfg(test)]
mod measure;
#[cfg(test)]
mod tests;
