//! The split of a node by the surface area heuristic on bins (Wald, *On fast Construction of SAH-based Bounding Volume
//! Hierarchies*, 2007), along all three axes in one pass.

use super::item::{Extent, Item, four};
use crate::threads;

/// Bins on an axis. A node of `n` items gets `FEWEST_BINS + n / ITEMS_PER_BIN` of them, but no more than `MOST_BINS`.
/// More bins cost more time than their better trees save: measured, `measure.rs`.
const FEWEST_BINS: usize = 4;
const ITEMS_PER_BIN: usize = 8;
const MOST_BINS: usize = 32;
/// From so many items on it is worth while to share them out among threads.
pub(super) const MANY: usize = 1 << 16;

/// Where the centres of some items fall: into `count` bins on each axis.
#[derive(Clone, Copy)]
pub(super) struct Grid {
    count: usize,
    start: [f32; 4],
    scale: [f32; 4],
}

impl Grid {
    /// For `items` items, whose centres lie in `centers`.
    pub fn new(centers: &Extent, items: usize) -> Self {
        // Few items do not need many bins, and most nodes have few items.
        let count = (FEWEST_BINS + items / ITEMS_PER_BIN).min(MOST_BINS);
        let scale = four(|i| {
            let scale = (count - 1) as f32 / (centers.max[i] - centers.min[i]);
            // Where all centres coincide, or lie so far apart that this overflows, everything falls into one bin.
            if scale.is_finite() { scale } else { 0.0 }
        });
        Self { count, start: centers.min, scale }
    }

    /// The bin on each axis plus 2²³, rounded to a whole number, because beside 2²³ there is no place for a fraction.
    #[inline(always)]
    fn places(&self, item: &Item) -> [f32; 4] {
        let center = item.center();
        four(|i| (center[i] - self.start[i]) * self.scale[i] + WHOLE)
    }
}

/// 2²³: from here to its double the bits of an `f32` count the whole numbers.
const WHOLE: f32 = 8_388_608.0;

/// What fell into each bin, axis by axis.
pub(super) struct Bins {
    boxes: [[Extent; MOST_BINS]; 3],
    counts: [[u32; MOST_BINS]; 3],
}

impl Bins {
    pub const EMPTY: Self = Self { boxes: [[Extent::EMPTY; MOST_BINS]; 3], counts: [[0; MOST_BINS]; 3] };

    #[inline(always)]
    fn clear(&mut self, count: usize) {
        for axis in 0..3 {
            self.boxes[axis][..count].fill(Extent::EMPTY);
            self.counts[axis][..count].fill(0);
        }
    }

    #[inline(always)]
    fn add(&mut self, axis: usize, place: f32, item: &Item) {
        let bin = place.to_bits() as usize % MOST_BINS;
        let bounds = &mut self.boxes[axis][bin];
        *bounds = bounds.join(&item.0);
        let count = &mut self.counts[axis][bin];
        *count = count.wrapping_add(1);
    }

    /// All items by several threads.
    pub fn of_many(items: &[Item], grid: &Grid) -> Self {
        let some = |items| {
            let mut bins = Self::EMPTY;
            bins.fill(items, grid);
            bins
        };
        let chunks: Vec<&[Item]> = items.chunks(MANY / 8).collect();
        threads::map(true, chunks, some).iter().fold(Self::EMPTY, Self::join)
    }

    fn join(mut self, other: &Self) -> Self {
        for axis in 0..3 {
            for bin in 0..MOST_BINS {
                self.boxes[axis][bin] = self.boxes[axis][bin].join(&other.boxes[axis][bin]);
                self.counts[axis][bin] += other.counts[axis][bin];
            }
        }
        self
    }

    /// Empties the bins and puts the items in.
    pub fn fill(&mut self, items: &[Item], grid: &Grid) {
        self.clear(grid.count);
        for item in items {
            let places = grid.places(item);
            self.add(0, places[0], item);
            self.add(1, places[1], item);
            self.add(2, places[2], item);
        }
    }
}

/// A cut between two bins of an axis.
#[derive(Clone, Copy)]
pub(super) struct Split {
    axis: usize,
    start: f32,
    scale: f32,
    /// The place of the first bin of the right part.
    bin: f32,
}

impl Split {
    /// The cheapest for `items` items; `None` where all are in the same bins.
    pub fn best(bins: &Bins, grid: &Grid, items: usize) -> Option<Self> {
        let (all, last) = (items as u32, grid.count - 1);
        let mut best = f64::INFINITY;
        let mut split = None;
        for axis in 0..3 {
            let (boxes, counts) = (&bins.boxes[axis], &bins.counts[axis]);
            // Cost of everything from each bin on.
            let mut right_cost = [0.0; MOST_BINS];
            let (mut right, mut count) = (Extent::EMPTY, 0);
            let mut bin = last;
            while bin > 0 {
                right = right.join(&boxes[bin]);
                count += counts[bin];
                right_cost[bin] = f64::from(count) * right.area();
                bin -= 1;
            }
            let (mut left, mut count) = (Extent::EMPTY, 0);
            while bin < last {
                left = left.join(&boxes[bin]);
                count += counts[bin];
                bin += 1;
                let cost = f64::from(count) * left.area() + right_cost[bin];
                if cost < best && count > 0 && count < all {
                    best = cost;
                    split = Some((axis, bin));
                }
            }
        }
        let (axis, bin) = split?;
        Some(Self { axis, start: grid.start[axis], scale: grid.scale[axis], bin: WHOLE + bin as f32 })
    }

    /// In the middle of the longest side of the box of the centres; `None` where they coincide.
    pub fn middle(centers: &Extent) -> Option<Self> {
        let size = four(|i| centers.max[i] - centers.min[i]);
        let longer = |a: usize, b: usize| if size[b] > size[a] { b } else { a };
        let axis = longer(longer(0, 1), 2);
        let scale = 1.0 / size[axis];
        scale.is_finite().then_some(Self { axis, start: centers.min[axis], scale, bin: WHOLE + 1.0 })
    }

    /// Sorts the items into two parts; gives the size of the first, and where the centres of each part lie.
    pub fn partition(&self, items: &mut [Item]) -> (usize, [Extent; 2]) {
        let Self { axis, start, scale, bin } = *self;
        let axis = axis % 3; // no check in the loop
        partition(items, |item| ((item.0.min[axis] + item.0.max[axis]) - start) * scale + WHOLE < bin)
    }
}

/// Where the centres of some items lie.
pub(super) fn centers(items: &[Item]) -> Extent {
    items.iter().fold(Extent::EMPTY, |all, item| all.join_point(item.center()))
}

fn partition(items: &mut [Item], is_left: impl Fn(&Item) -> bool) -> (usize, [Extent; 2]) {
    let (mut left, mut right) = (Extent::EMPTY, Extent::EMPTY);
    let (mut start, mut end) = (0, items.len());
    loop {
        while start < end && is_left(&items[start]) {
            left = left.join_point(items[start].center());
            start += 1;
        }
        while start < end && !is_left(&items[end - 1]) {
            end -= 1;
            right = right.join_point(items[end].center());
        }
        if start >= end {
            return (start, [left, right]);
        }
        items.swap(start, end - 1);
    }
}
