//! The primitives of the leaves, in columns, so that several of a leaf are read at once.

use super::node::{Block, Child, Kind as ChildKind, Run, Tree};
use crate::geometry::shape::{AnyShape, COMMON, ForKind, KINDS, Kind, NUMBERS, ShapeList, Shapes, kind_of, of_kind};
use crate::lanes::MAX_WIDTH;
use crate::memory;

/// The kind of the runs of instances, whose numbers are those of the instances.
pub(super) const INSTANCES: usize = KINDS;

/// How many numbers a primitive of a kind takes, its id with them.
const fn columns(kind: usize) -> usize {
    if kind < KINDS { NUMBERS[kind] + 1 } else { 1 }
}

/// All primitives of a tree.
///
/// A leaf is some runs of primitives of one kind, kind by kind, ids ascending: the columns of the kind's numbers, then that of the
/// ids; for instances their numbers only. The pointer to the leaf says what the first run is; between two runs stands what the
/// next one is. Every `u32` is exact as `f64`.
#[derive(Clone, Debug, Default)]
pub(super) struct Primitives {
    /// The leaves' columns, and some zeros so that the last one can be read in full lanes.
    pub numbers: Vec<f64>,
    /// By primitive: the place of its first number, and in the last four bits the distance to the next ones, which is at
    /// most 8.
    places: Vec<u64>,
    /// The id of the first of each kind.
    firsts: [usize; KINDS + 2],
}

/// Some primitives of one kind in a leaf.
#[derive(Clone, Copy, Debug)]
pub(super) struct RunOf<'a> {
    pub kind: usize,
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
    /// Copies the primitives, leaf by leaf, and makes the leaves of the tree point to them.
    pub fn new(shapes: &Shapes<'_>, tree: &mut Tree, parallel: bool) -> Self {
        let firsts = shapes.firsts();
        let mut jobs = Vec::with_capacity(tree.leaves.len());
        let mut places = vec![0; firsts[KINDS]];
        let mut at = 0;
        for child in tree.nodes.iter_mut().flat_map(|node| &mut node.child) {
            let ChildKind::Leaf(leaf) = child.kind() else { continue };
            let leaf = tree.leaves[leaf as usize];
            let ids = &tree.order[leaf.first as usize..(leaf.first + leaf.count) as usize];
            let Some(first) = run(&firsts, ids) else { continue };
            *child = Child::block(Block { at, run: first });
            jobs.push((at, ids));
            let mut rest = ids;
            while let Some(Run { kind, count, more }) = run(&firsts, rest) {
                for (place, &id) in rest[..count].iter().enumerate().filter(|_| kind != INSTANCES) {
                    places[id as usize] = ((at + place) as u64) << 4 | count as u64;
                }
                at += columns(kind) * count + usize::from(more);
                rest = &rest[count..];
            }
        }
        let mut numbers = memory::zeros(at + MAX_WIDTH).unwrap_or_else(|| vec![0.0; at + MAX_WIDTH]);
        fill(&Source { shapes, firsts: &firsts }, &jobs, &mut numbers, parallel);
        Self { numbers, places, firsts }
    }

    /// The first run of a leaf.
    #[inline(always)]
    pub fn first(&self, block: Block) -> RunOf<'_> {
        RunOf::new(block.run, &self.numbers[block.at..])
    }

    /// All runs of a leaf.
    pub fn runs(&self, block: Block) -> impl Iterator<Item = RunOf<'_>> {
        std::iter::successors(Some(self.first(block)), RunOf::next)
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

/// The first run of some primitives, in ascending order of their ids.
fn run(firsts: &[usize; KINDS + 2], ids: &[u32]) -> Option<Run> {
    let kind = kind_of(firsts, *ids.first()? as usize);
    let count = ids.partition_point(|&id| (id as usize) < firsts[kind + 1]);
    Some(Run { kind, count, more: count < ids.len() })
}

struct Source<'s, 'a> {
    shapes: &'s Shapes<'a>,
    firsts: &'s [usize; KINDS + 2],
}

/// Writes the numbers of some leaves, which start with those of the first one.
fn fill(source: &Source<'_, '_>, jobs: &[(usize, &[u32])], numbers: &mut [f64], parallel: bool) {
    const ALONE: usize = 1 << 10;
    if parallel && jobs.len() > ALONE {
        let (left, right) = jobs.split_at(jobs.len() / 2);
        let (left_numbers, right_numbers) = numbers.split_at_mut(right[0].0 - left[0].0);
        rayon::join(|| fill(source, left, left_numbers, true), || fill(source, right, right_numbers, true));
        return;
    }
    let mut rest = numbers;
    for (_, ids) in jobs {
        let mut ids = *ids;
        while let Some(Run { kind, count, more }) = run(source.firsts, ids) {
            let (block, after) = rest.split_at_mut(columns(kind) * count);
            let (own, others) = ids.split_at(count);
            let (numbers, id_column) = block.split_at_mut((columns(kind) - 1) * count);
            let first = source.firsts[kind];
            for (column, &id) in id_column.iter_mut().zip(own) {
                *column = if kind == INSTANCES { (id as usize - first) as f64 } else { f64::from(id) };
            }
            of_kind(kind, Write { shapes: source.shapes, first, ids: own, columns: numbers });
            rest = after;
            if more && let Some(next) = run(source.firsts, others) {
                let (header, after) = rest.split_at_mut(1);
                header[0] = next.number();
                rest = after;
            }
            ids = others;
        }
    }
}

/// Writes the numbers of a run into its columns.
struct Write<'w, 'a> {
    shapes: &'w Shapes<'a>,
    first: usize,
    ids: &'w [u32],
    columns: &'w mut [f64],
}

impl ForKind for Write<'_, '_> {
    type Output = ();
    fn run<S: Kind>(self) {
        let list = S::list(self.shapes);
        for (place, &id) in self.ids.iter().enumerate() {
            let mut at = place;
            list.get(id as usize - self.first).write(|number| {
                self.columns[at] = number;
                at += self.ids.len();
            });
        }
    }
}
