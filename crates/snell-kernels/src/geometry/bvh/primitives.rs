//! The primitives of the leaves, in columns, so that several of a leaf are read at once.

use super::node::{Block, Run};
use crate::geometry::shape::{AnyShape, COMMON, ForKind, KINDS, Kind, NUMBERS, kind_of, of_kind};
use alloc::vec::Vec;

/// The kind of the runs of instances, whose numbers are those of the instances.
pub const INSTANCES: usize = KINDS;

/// How many numbers a primitive of a kind takes, its id with them.
pub const fn columns(kind: usize) -> usize {
    if kind < KINDS { NUMBERS[kind] + 1 } else { 1 }
}

/// All primitives of a tree.
///
/// A leaf is some runs of primitives of one kind, kind by kind, ids ascending: the columns of the kind's numbers, then that of the
/// ids; for instances their numbers only. The pointer to the leaf says what the first run is; between two runs stands what the
/// next one is. Every `u32` is exact as `f64`.
#[derive(Clone, Debug, Default)]
pub struct Primitives {
    /// The leaves' columns, and some zeros so that the last one can be read in full lanes.
    pub numbers: Vec<f64>,
    /// By primitive: the place of its first number, and in the last four bits the distance to the next ones, which is at
    /// most 8.
    pub places: Vec<u64>,
    /// The id of the first of each kind.
    pub firsts: [usize; KINDS + 2],
}

/// Some primitives of one kind in a leaf.
#[derive(Clone, Copy, Debug)]
pub struct RunOf<'a> {
    /// Number of the kind of shape.
    pub kind: usize,
    /// How many.
    pub count: usize,
    more: bool,
    /// From its first number on.
    pub numbers: &'a [f64],
}

impl<'a> RunOf<'a> {
    #[inline(always)]
    fn new(Run { kind, count, more }: Run, numbers: &'a [f64]) -> Self {
        Self { kind, count, more, numbers }
    }

    /// Is it all of its leaf, and of a common kind?
    #[inline(always)]
    pub fn is_common(&self) -> bool {
        !self.more && COMMON >> self.kind & 1 == 1
    }

    /// Its ids, or numbers of instances.
    #[inline(always)]
    pub fn ids(&self) -> &'a [f64] {
        &self.numbers[(columns(self.kind) - 1) * self.count..][..self.count]
    }

    /// The next run of its leaf.
    #[inline(always)]
    pub fn next(&self) -> Option<Self> {
        if !self.more {
            return None;
        }
        let rest = &self.numbers[columns(self.kind) * self.count..];
        Some(Self::new(Run::of_number(rest[0]), &rest[1..]))
    }
}

impl Primitives {
    /// The first run of a leaf.
    #[inline(always)]
    pub fn first(&self, block: Block) -> RunOf<'_> {
        RunOf::new(block.run, &self.numbers[block.at..])
    }

    /// All runs of a leaf.
    pub fn runs(&self, block: Block) -> impl Iterator<Item = RunOf<'_>> {
        core::iter::successors(Some(self.first(block)), RunOf::next)
    }

    /// A primitive of this kind, by its id.
    #[inline(always)]
    pub fn get<S: Kind>(&self, id: usize) -> Option<S> {
        let is_one = (self.firsts[S::KIND]..self.firsts[S::KIND + 1]).contains(&id);
        is_one.then(|| {
            let place = self.places[id];
            let (at, stride) = ((place >> 4) as usize, (place & 15) as usize);
            S::read(
                #[inline(always)]
                |column| self.numbers[at + column * stride],
            )
        })
    }

    /// A primitive, by its id.
    pub fn shape(&self, id: usize) -> Option<AnyShape> {
        of_kind(kind_of(&self.firsts, id), Read { primitives: self, id })
    }

    /// Is there anything whose test wants the shears of rays?
    pub fn has_sheared(&self) -> bool {
        (0..KINDS).any(|kind| self.firsts[kind] < self.firsts[kind + 1] && of_kind(kind, IsSheared))
    }

    /// Bytes.
    pub fn memory(&self) -> usize {
        size_of_val(self.numbers.as_slice()) + size_of_val(self.places.as_slice())
    }
}

struct IsSheared;

impl ForKind for IsSheared {
    type Output = bool;
    fn run<S: Kind>(self) -> bool {
        S::SHEARED
    }
}

struct Read<'a> {
    primitives: &'a Primitives,
    id: usize,
}

impl ForKind for Read<'_> {
    type Output = Option<AnyShape>;
    fn run<S: Kind>(self) -> Option<AnyShape> {
        self.primitives.get::<S>(self.id).map(S::any)
    }
}
