//! Sums of samples that come out the same whoever has added up which of them.
//!
//! Additions of `f64` do not associate, so their order is part of what a pixel is: samples are added pairwise over aligned dyadic
//! ranges, `S(a, 2^k) = S(a, 2^(k−1)) + S(a + 2^(k−1), 2^(k−1))` with `a` a multiple of `2^k`. The samples 0 to below n are the
//! left fold of the largest such ranges that fit, which stand in the order of their sizes: `(S(0, 8) + S(8, 4)) + S(12, 1)` for 13.
//! Any range of samples is the sums of at most 2·log₂ n aligned ones, from which those of any larger range follow exactly.

use alloc::vec::Vec;
use core::ops::Range;

/// The samples from `first` to below `first + 2^log2`; `first` is a multiple of `2^log2`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Block {
    /// The first sample.
    pub first: u32,
    /// The number of samples is 2 to this power.
    pub log2: u32,
}

impl Block {
    /// The samples in it.
    pub fn samples(self) -> Range<u64> {
        u64::from(self.first)..u64::from(self.first) + (1u64 << self.log2)
    }

    /// The block of twice the size that begins with this one and ends with the other, if there is one.
    fn joined_with(self, next: Self) -> Option<Self> {
        let joins = self.log2 == next.log2
            && self.samples().end == next.samples().start
            && self.samples().start.is_multiple_of(2u64 << self.log2);
        joins.then_some(Self { first: self.first, log2: self.log2 + 1 })
    }

    /// The largest blocks that make up a range, in its order.
    pub fn of(samples: Range<u32>) -> Vec<Self> {
        let (mut blocks, mut first) = (Vec::new(), samples.start);
        while first < samples.end {
            let log2 = first.trailing_zeros().min((samples.end - first).ilog2());
            blocks.push(Self { first, log2 });
            first += 1 << log2;
        }
        blocks
    }
}

/// Sums of disjoint blocks of samples, by their order. Siblings are added up as soon as both are there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PairwiseSum<T> {
    blocks: Vec<(Block, T)>,
}

/// Samples that are there twice.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the samples {} to {} are there twice", .0.start, .0.end - 1)]
pub struct Twice(pub Range<u64>);

impl<T> PairwiseSum<T> {
    /// Of no samples.
    pub fn new() -> Self {
        Self { blocks: Vec::new() }
    }

    /// The sums of the largest blocks, by their order.
    pub fn blocks(&self) -> &[(Block, T)] {
        &self.blocks
    }

    /// The same, which may be changed.
    pub fn blocks_mut(&mut self) -> &mut [(Block, T)] {
        &mut self.blocks
    }

    /// Takes all sums out.
    pub fn take(&mut self) -> Vec<(Block, T)> {
        core::mem::take(&mut self.blocks)
    }

    /// Is this block surely apart from all that are there?
    ///
    /// # Errors
    /// If some of them are there already.
    pub fn check(&self, block: Block) -> Result<usize, Twice> {
        let at = self.blocks.partition_point(|(other, _)| other.first < block.first);
        let neighbours = [at.checked_sub(1), Some(at)].into_iter().flatten().filter_map(|at| self.blocks.get(at));
        for (other, _) in neighbours {
            let (a, b) = (block.samples(), other.samples());
            let both = a.start.max(b.start)..a.end.min(b.end);
            if !both.is_empty() {
                return Err(Twice(both));
            }
        }
        Ok(at)
    }

    /// Adds the sum of a block; `add` adds a sum to the one before it. Sums that are no longer needed go to `spare`.
    ///
    /// # Errors
    /// When some of these samples are there already.
    pub fn insert(
        &mut self,
        block: Block,
        sum: T,
        add: impl Fn(&mut T, &T),
        mut spare: impl FnMut(T),
    ) -> Result<(), Twice> {
        let mut at = self.check(block)?;
        self.blocks.insert(at, (block, sum));
        loop {
            let joins = |at: usize| {
                let (first, second) = (self.blocks.get(at)?, self.blocks.get(at + 1)?);
                first.0.joined_with(second.0)
            };
            let pair = [at.checked_sub(1), Some(at)].into_iter().flatten().find_map(|at| Some((at, joins(at)?)));
            let Some((first, joined)) = pair else { return Ok(()) };
            let (_, right) = self.blocks.remove(first + 1);
            let (block, left) = &mut self.blocks[first];
            add(left, &right);
            *block = joined;
            spare(right);
            at = first;
        }
    }

    /// Which samples are there, in as few ranges as possible.
    pub fn samples(&self) -> Vec<Range<u64>> {
        let mut ranges: Vec<Range<u64>> = Vec::new();
        for (block, _) in &self.blocks {
            let samples = block.samples();
            match ranges.last_mut() {
                Some(last) if last.end == samples.start => last.end = samples.end,
                _ => ranges.push(samples),
            }
        }
        ranges
    }
}

/// The pairwise sum of the samples 0 to below `count`.
pub fn pairwise_sum<T: Clone>(values: impl Iterator<Item = T>, add: impl Fn(&mut T, &T)) -> Option<T> {
    let mut sums = PairwiseSum::new();
    for (first, value) in (0..).zip(values) {
        // Each sample comes once.
        let _ = sums.insert(Block { first, log2: 0 }, value, &add, drop);
    }
    let mut blocks = sums.take().into_iter().map(|(_, sum)| sum);
    let first = blocks.next()?;
    Some(blocks.fold(first, |mut sum, block| {
        add(&mut sum, &block);
        sum
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A sum that remembers its brackets.
    fn bracket(sum: &mut String, other: &String) {
        *sum = format!("({sum}{other})");
    }

    fn name(sample: u32) -> String {
        char::from_u32('a' as u32 + sample).unwrap().to_string()
    }

    #[test]
    fn the_order_of_addition_is_that_of_the_definition() {
        let sum = |n: u32| pairwise_sum((0..n).map(name), bracket);
        let expected =
            ["a", "(ab)", "((ab)c)", "((ab)(cd))", "(((ab)(cd))e)", "(((ab)(cd))(ef))", "((((ab)(cd))(ef))g)"];
        for (n, expected) in (1..).zip(expected) {
            assert_eq!(sum(n).unwrap(), expected);
        }
        assert_eq!(sum(13).unwrap(), "(((((ab)(cd))((ef)(gh)))((ij)(kl)))m)");
        assert_eq!(sum(0), None);
    }

    proptest! {
        /// Samples in any pieces and in any order make the same sums.
        #[test]
        fn pieces_make_the_whole(
            cuts in prop::collection::btree_set(0..23u32, 0..9),
            order in Just((0..24).collect::<Vec<usize>>()).prop_shuffle(),
        ) {
            let ends: Vec<u32> = [0].into_iter().chain(cuts.into_iter().filter(|&cut| cut > 0)).chain([23]).collect();
            let mut parts: Vec<Range<u32>> = ends.windows(2).map(|w| w[0]..w[1]).collect();
            let keys = order;
            let mut numbered: Vec<(usize, Range<u32>)> = keys.into_iter().zip(parts.drain(..)).collect();
            numbered.sort_by_key(|(key, _)| *key);
            let mut whole = PairwiseSum::new();
            for (_, part) in numbered {
                let mut of_part = PairwiseSum::new();
                for first in part {
                    of_part.insert(Block { first, log2: 0 }, name(first), bracket, drop).unwrap();
                }
                for (block, sum) in of_part.take() {
                    whole.insert(block, sum, bracket, drop).unwrap();
                }
            }
            let mut expected = PairwiseSum::new();
            (0..23).for_each(|first| expected.insert(Block { first, log2: 0 }, name(first), bracket, drop).unwrap());
            prop_assert_eq!(&whole, &expected);
            prop_assert_eq!(whole.samples(), vec![0..23]);
            let blocks: Vec<Block> = whole.blocks().iter().map(|(block, _)| *block).collect();
            prop_assert_eq!(blocks, Block::of(0..23));
            for first in 0..23 {
                let twice = whole.insert(Block { first, log2: 0 }, name(first), bracket, drop);
                prop_assert_eq!(twice, Err(Twice(u64::from(first)..u64::from(first) + 1)));
            }
        }

        #[test]
        fn a_range_is_few_blocks(start in 0..5000u32, length in 1..5000u32) {
            let blocks = Block::of(start..start + length);
            prop_assert!(blocks.len() as u32 <= 2 * (start + length).ilog2() + 2);
            let mut next = u64::from(start);
            for block in blocks {
                prop_assert!(block.samples().start == next && next % (1 << block.log2) == 0);
                next = block.samples().end;
            }
            prop_assert_eq!(next, u64::from(start + length));
        }
    }
}
