//! Building a tree, on top of the kernels, which traverse it.

mod build;
mod pack;
#[cfg(test)]
mod tests;

pub use build::Quality;
pub use snell_kernels::geometry::bvh::{
    Bvh, Instance, MARGIN, PACKET, Packet, Shapes, TreeStatistics, node, primitives,
};

use crate::geometry::bounds::OuterBox;
use crate::threads;

/// Fewer primitives are done before threads have started.
const WORTH_THREADS: usize = 1 << 12;

/// Builds the tree. `margin` is the room that each box has around its primitives: at least [`MARGIN`] times the largest
/// distance between a ray's origin and a primitive.
/// `models`: the trees that stand at the instances; they have none of their own. `threads`: 0 for those by default.
pub fn build(shapes: &Shapes<'_>, models: Vec<Bvh>, margin: f64, quality: Quality, threads: usize) -> Bvh {
    let firsts = shapes.firsts();
    let padded = |i| OuterBox::around(&shapes.bounds_from(&firsts, i), margin);
    let threads = if shapes.count() < WORTH_THREADS { 1 } else { threads.min(shapes.count() / WORTH_THREADS + 1) };
    let (tree, primitives) = threads::share(threads, |parallel| {
        let mut tree = build::build(shapes.count(), padded, quality, parallel);
        let primitives = pack::pack(shapes, &mut tree, parallel);
        (tree, primitives)
    });
    Bvh::new(tree.nodes, primitives, tree.depth, shapes, models)
}
