//! Copying primitives into the leaves of a tree.

use super::build::Tree;
use crate::geometry::bvh::node::{Block, Child, Kind as ChildKind, Run};
use crate::geometry::bvh::primitives::{INSTANCES, Primitives, columns};
use crate::geometry::shape::{ForKind, KINDS, Kind, ShapeList, Shapes, kind_of, of_kind};
use crate::lanes::MAX_WIDTH;
use crate::memory;
use crate::threads;

/// Copies the primitives, leaf by leaf, and makes the leaves of the tree point to them.
pub(super) fn pack(shapes: &Shapes<'_>, tree: &mut Tree, parallel: bool) -> Primitives {
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
    Primitives { numbers, places, firsts }
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
        threads::join(|| fill(source, left, left_numbers, true), || fill(source, right, right_numbers, true));
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
