//! The best split of a few items: of all there are.

use super::item::{Extent, Item};

/// No more items than this are tried in all ways.
pub(super) const FEW: usize = 4;

/// How many items each set has, in units of work.
const SIZE: [f64; 1 << FEW] = {
    let mut sizes = [0.0; 1 << FEW];
    let mut set = 1usize;
    while set < sizes.len() {
        sizes[set] = set.count_ones() as f64;
        set += 1;
    }
    sizes
};

/// Sorts 2 to [`FEW`] items into the two parts of least cost by the surface area heuristic; gives the size of the first.
pub(super) fn divide(items: &mut [Item]) -> usize {
    let last = (items.len() - 1).min(FEW - 1);
    let all = (2 << last) - 1;
    // Sets of items by the bits of a number. Each adds one item to a smaller set.
    let mut boxes = [Extent::EMPTY; 1 << FEW];
    let mut costs = [0.0; 1 << FEW];
    let mut lowest = 1;
    for (bit, item) in items[..=last].iter().enumerate() {
        for set in 0..lowest {
            let with = (set | 1 << bit) % boxes.len();
            boxes[with] = boxes[set].join(&item.0);
            costs[with] = boxes[with].area() * SIZE[with];
        }
        lowest <<= 1;
    }
    // The last item is right, so that nothing is tried twice.
    let (mut best, mut least) = (1usize, costs[1] + costs[all - 1]);
    for left in 2..1 << last {
        let cost = costs[left] + costs[all - left];
        if cost < least {
            (best, least) = (left, cost);
        }
    }
    let mut count = 0;
    for i in 0..last {
        if best >> i & 1 == 1 {
            items.swap(i, count);
            count += 1;
        }
    }
    count
}
