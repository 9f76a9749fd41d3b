//! Building the tree from the top, by the surface area heuristic on bins (Wald, *On fast Construction of SAH-based
//! Bounding Volume Hierarchies*, 2007).
//!
//! The work is bounded for any input, also for a million primitives in the same place: below [`SAH_DEPTH`] levels, and
//! where all centres coincide, a node is cut into halves by count.

use super::{Bvh, Node};
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
/// No tree is deeper.
pub(super) const MAX_DEPTH: usize = SAH_DEPTH + 33;

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

pub(super) fn build(boxes: Vec<OuterBox>) -> Bvh {
    let mut items: Vec<Item> = (0..).zip(boxes).map(|(id, bounds)| Item { bounds, id }).collect();
    if items.is_empty() {
        return Bvh::default();
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
    Bvh { nodes, primitives: items.iter().map(|item| item.id).collect() }
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

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(x: f32, y: f32, z: f32) -> OuterBox {
        OuterBox { min: [x, y, z], max: [x + 0.5, y + 0.5, z + 0.5] }
    }

    /// Every primitive is in exactly one leaf, every box holds what is below it; returns depth and largest leaf.
    fn check(bvh: &Bvh, boxes: &[OuterBox]) -> (usize, usize) {
        let mut seen = vec![0; boxes.len()];
        let (mut deepest, mut largest) = (0, 0);
        let mut stack = vec![(0usize, 1usize)];
        while let Some((index, depth)) = stack.pop() {
            let node = &bvh.nodes[index];
            let holds = |inner: &OuterBox| assert_eq!(merge(&node.bounds, inner), node.bounds);
            deepest = deepest.max(depth);
            let first = node.first as usize;
            if node.count == 0 {
                holds(&bvh.nodes[first].bounds);
                holds(&bvh.nodes[first + 1].bounds);
                stack.extend([(first, depth + 1), (first + 1, depth + 1)]);
            } else {
                largest = largest.max(node.count as usize);
                for &id in &bvh.primitives[first..first + node.count as usize] {
                    holds(&boxes[id as usize]);
                    seen[id as usize] += 1;
                }
            }
        }
        assert!(seen.iter().all(|&n| n == 1));
        (deepest, largest)
    }

    #[test]
    fn a_grid_becomes_a_balanced_tree() {
        let boxes: Vec<_> = (0..4096).map(|i| cube((i % 16) as f32, (i / 16 % 16) as f32, (i / 256) as f32)).collect();
        let (depth, leaf) = check(&build(boxes.clone()), &boxes);
        assert!(depth <= 16 && leaf <= LARGEST_LEAF, "2^12 boxes: depth {depth}, leaves of {leaf}");
    }

    #[test]
    fn hostile_crowds_stay_shallow() {
        // All in one place; one place and a few far away; distances that double, where each split takes off one.
        let same = vec![cube(1.0, 2.0, 3.0); 100_000];
        let far = [same.clone(), vec![cube(1e15, 0.0, 0.0); 3]].concat();
        let doubling: Vec<_> = (0..2000).map(|i| cube((1u64 << (i % 50)) as f32, 0.0, 0.0)).collect();
        for boxes in [same, far, doubling, vec![cube(0.0, 0.0, 0.0)]] {
            let (depth, leaf) = check(&build(boxes.clone()), &boxes);
            assert!(depth <= MAX_DEPTH && leaf <= LARGEST_LEAF, "depth {depth}, leaves of {leaf}");
        }
        assert!(build(Vec::new()).nodes.is_empty());
    }
}
