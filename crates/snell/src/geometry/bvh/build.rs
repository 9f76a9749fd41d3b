//! Building the tree from the top, by the surface area heuristic on bins (Wald, *On fast Construction of SAH-based
//! Bounding Volume Hierarchies*, 2007).
//!
//! The work is bounded for any input, also for a million primitives in the same place: below [`SAH_DEPTH`] levels, and
//! where all centres coincide, a node is cut into halves by count.

use super::node::{self, Child, Node as Wide};
use crate::geometry::bounds::OuterBox;

/// Bins on each axis. More give hardly better trees (Wald 2007, section 3).
const BINS: usize = 16;
/// A leaf has at most this many primitives, unless it costs less than its best split.
const LEAF: usize = 2;
/// No leaf is larger than this.
const LARGEST_LEAF: usize = 8;
/// Cost of visiting a node, in units of testing a primitive.
const NODE_COST: f64 = 1.0;
/// From this depth on nodes are halved, and 2^32 primitives are used up after 32 more levels.
const SAH_DEPTH: usize = 64;

/// A primitive that is being sorted into the tree.
#[derive(Clone, Copy)]
struct Item {
    bounds: OuterBox,
    id: u32,
}

impl Item {
    /// Twice the centre along an axis.
    fn center(&self, axis: usize) -> f64 {
        f64::from(self.bounds.min[axis]) + f64::from(self.bounds.max[axis])
    }
}

/// A node that is not built yet: its place in the list, its items, its depth.
struct Task {
    node: usize,
    start: usize,
    end: usize,
    depth: usize,
}

/// `count` primitives from `first` on.
pub(super) struct Range {
    pub first: u32,
    pub count: u32,
}

#[derive(Clone, Copy)]
struct Node {
    bounds: OuterBox,
    first: u32,
    count: u32,
}

#[derive(Default)]
pub(super) struct Tree {
    pub nodes: Vec<Wide>,
    pub leaves: Vec<Range>,
    pub order: Vec<u32>,
}

fn collapse(binary: &[Node], mut order: Vec<u32>) -> Tree {
    let mut tree = Tree { nodes: vec![Wide::EMPTY], leaves: vec![], order: vec![] };
    let mut tasks = vec![(0usize, 0usize)];
    while let Some((wide, at)) = tasks.pop() {
        let mut kids = vec![at];
        loop {
            let open = kids.iter().enumerate().filter(|(_, k)| binary[**k].count == 0);
            let Some((i, _)) = open.max_by(|a, b| area(&binary[*a.1].bounds).total_cmp(&area(&binary[*b.1].bounds)))
            else {
                break;
            };
            if kids.len() == node::WIDTH {
                break;
            }
            let first = binary[kids[i]].first as usize;
            kids[i] = first;
            kids.push(first + 1);
        }
        for (slot, &k) in kids.iter().enumerate() {
            let n = binary[k];
            for axis in 0..3 {
                tree.nodes[wide].planes[2 * axis][slot] = n.bounds.min[axis];
                tree.nodes[wide].planes[2 * axis + 1][slot] = n.bounds.max[axis];
            }
            tree.nodes[wide].child[slot] = if n.count > 0 {
                order[n.first as usize..(n.first + n.count) as usize].sort_unstable();
                tree.leaves.push(Range { first: n.first, count: n.count });
                Child::leaf(tree.leaves.len() - 1)
            } else {
                tree.nodes.push(Wide::EMPTY);
                tasks.push((tree.nodes.len() - 1, k));
                Child::node(tree.nodes.len() - 1)
            };
        }
    }
    tree.order = order;
    tree
}

pub(super) fn build(boxes: Vec<OuterBox>) -> Tree {
    let mut items: Vec<Item> = (0..).zip(boxes).map(|(id, bounds)| Item { bounds, id }).collect();
    if items.is_empty() {
        return Tree::default();
    }
    let leaf =
        |start: usize, end: usize, bounds: OuterBox| Node { bounds, first: start as u32, count: (end - start) as u32 };
    let mut nodes = vec![leaf(0, items.len(), union(&items))];
    let mut tasks = vec![Task { node: 0, start: 0, end: items.len(), depth: 1 }];
    while let Some(Task { node, start, end, depth }) = tasks.pop() {
        let Some(count) = split(&mut items[start..end], &nodes[node].bounds, depth) else { continue };
        let (middle, first) = (start + count, nodes.len());
        (nodes[node].first, nodes[node].count) = (first as u32, 0);
        for (child, (start, end)) in [(start, middle), (middle, end)].into_iter().enumerate() {
            nodes.push(leaf(start, end, union(&items[start..end])));
            tasks.push(Task { node: first + child, start, end, depth: depth + 1 });
        }
    }
    collapse(&nodes, items.iter().map(|item| item.id).collect())
}

/// Sorts the items of a node into two parts and returns the size of the first; `None` for a leaf.
fn split(items: &mut [Item], bounds: &OuterBox, depth: usize) -> Option<usize> {
    if items.len() <= LEAF {
        return None;
    }
    let halves = |items: &[Item]| (items.len() > LARGEST_LEAF).then_some(items.len() / 2);
    if depth >= SAH_DEPTH {
        return halves(items);
    }
    let Some(best) = best_split(items) else { return halves(items) };
    let leaf_cost = items.len() as f64 * area(bounds);
    if best.cost + NODE_COST * area(bounds) >= leaf_cost && items.len() <= LARGEST_LEAF {
        return None;
    }
    let is_left = |item: &Item| best.bins.of(item) <= best.last_left;
    let mut left = 0;
    for i in 0..items.len() {
        if is_left(&items[i]) {
            items.swap(left, i);
            left += 1;
        }
    }
    Some(left)
}

/// Bins along an axis, over the centres of some items.
#[derive(Clone, Copy)]
struct Bins {
    axis: usize,
    start: f64,
    scale: f64,
}

impl Bins {
    /// `None` where all centres coincide.
    fn over(items: &[Item], axis: usize) -> Option<Self> {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for item in items {
            (low, high) = (low.min(item.center(axis)), high.max(item.center(axis)));
        }
        let scale = BINS as f64 / (high - low);
        (high > low && scale.is_finite()).then_some(Self { axis, start: low, scale })
    }

    fn of(&self, item: &Item) -> usize {
        (((item.center(self.axis) - self.start) * self.scale) as usize).min(BINS - 1)
    }
}

struct Split {
    bins: Bins,
    /// The last bin of the left part.
    last_left: usize,
    cost: f64,
}

fn best_split(items: &[Item]) -> Option<Split> {
    let mut best: Option<Split> = None;
    for bins in (0..3).filter_map(|axis| Bins::over(items, axis)) {
        let mut bounds = [EMPTY; BINS];
        let mut counts = [0usize; BINS];
        for item in items {
            let bin = bins.of(item);
            bounds[bin] = merge(&bounds[bin], &item.bounds);
            counts[bin] += 1;
        }
        // Cost of everything right of each bin, then of everything up to it, along the way back.
        let mut right_cost = [0.0; BINS];
        let (mut right, mut count) = (EMPTY, 0);
        for bin in (1..BINS).rev() {
            right = merge(&right, &bounds[bin]);
            count += counts[bin];
            right_cost[bin - 1] = count as f64 * area(&right);
        }
        let (mut left, mut count) = (EMPTY, 0);
        for bin in 0..BINS - 1 {
            left = merge(&left, &bounds[bin]);
            count += counts[bin];
            let cost = count as f64 * area(&left) + right_cost[bin];
            let both = count > 0 && count < items.len();
            if both && best.as_ref().is_none_or(|b| cost < b.cost) {
                best = Some(Split { bins, last_left: bin, cost });
            }
        }
    }
    best
}

const EMPTY: OuterBox = OuterBox { min: [f32::INFINITY; 3], max: [f32::NEG_INFINITY; 3] };

fn merge(a: &OuterBox, b: &OuterBox) -> OuterBox {
    let (mut min, mut max) = (a.min, a.max);
    for axis in 0..3 {
        min[axis] = min[axis].min(b.min[axis]);
        max[axis] = max[axis].max(b.max[axis]);
    }
    OuterBox { min, max }
}

fn union(items: &[Item]) -> OuterBox {
    items.iter().fold(EMPTY, |all, item| merge(&all, &item.bounds))
}

/// Half the surface; 0 for the empty box.
fn area(b: &OuterBox) -> f64 {
    let [x, y, z] = [0, 1, 2].map(|axis| (f64::from(b.max[axis]) - f64::from(b.min[axis])).max(0.0));
    x * y + y * z + z * x
}
