//! The tree of boxes. `obvhs` builds it (PLOC, Benthin et al. 2024); traversal is ours, because it must be exact.
//!
//! The answer does not depend on the tree. Every box holds its primitives with a margin that is larger than the
//! rounding errors of the primitive tests (see [`Bvh::build`]), and the caller decides ties at equal `t` by primitive
//! id, so any tree, and no tree at all, finds the same hit to the last bit.

use super::bounds::{Bounds, OuterBox};
use super::{Ray, RayFrame};
use crate::lanes::{Lanes, Mask};
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::leaf_collapser::collapse;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::PlocBuilder;

/// Relative size of the margin around each primitive: 2⁻⁴⁸ of the farthest distance from which a ray can come.
///
/// A primitive test places a hit within a few rounding errors, each `2⁻⁵³` of the distance between ray origin and
/// primitive (sphere: the perpendicular `T − v·d`; triangle: the three vertices in ray space). Thirty-two of them are
/// more than all of these together with those of the slab test. The textbook discriminant of near spheres errs by more;
/// their boxes come with that margin ([`sphere::MARGIN`](super::sphere::MARGIN)).
const MARGIN: f64 = 1.0 / (1u64 << 48) as f64;

/// Depth of the traversal stack. Two children go on it at each level; deeper trees than this are refused when built.
const STACK: usize = 128;

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: OuterBox,
    /// Leaf: where its primitives start. Inner node: its first child; the second is the next node.
    first: u32,
    /// How many primitives; 0 for an inner node.
    count: u32,
}

/// A binary tree of boxes over primitives that it knows only by number.
#[derive(Clone, Debug, Default)]
pub struct Bvh {
    nodes: Vec<Node>,
    primitives: Vec<u32>,
}

impl Bvh {
    /// Builds the tree over the boxes of all primitives, in the order of their ids. `reach` is the largest distance
    /// between a ray's origin and a primitive.
    pub fn build(boxes: &[Bounds], reach: f64) -> Self {
        if boxes.is_empty() {
            return Self::default();
        }
        let outer: Vec<obvhs::aabb::Aabb> = boxes
            .iter()
            .map(|b| {
                let OuterBox { min, max } = OuterBox::around(b, reach * MARGIN);
                obvhs::aabb::Aabb::new(min.into(), max.into())
            })
            .collect();
        let params = BvhBuildParams::medium_build();
        let ids = (0..boxes.len() as u32).collect();
        let mut tree: Bvh2 = PlocBuilder::with_capacity(boxes.len()).build(
            params.ploc_search_distance,
            &outer,
            ids,
            params.sort_precision,
            params.search_depth_threshold,
        );
        let mut optimizer = ReinsertionOptimizer::default();
        optimizer.run(&mut tree, params.reinsertion_batch_ratio, None);
        collapse(&mut tree, 4, params.collapse_traversal_cost);
        let nodes = tree
            .nodes
            .iter()
            .map(|n| Node {
                bounds: OuterBox { min: n.aabb.min.into(), max: n.aabb.max.into() },
                first: n.first_index,
                count: n.prim_count,
            })
            .collect();
        let bvh = Self { nodes, primitives: tree.primitive_indices };
        if bvh.depth() >= STACK { Self::flat(boxes.len()) } else { bvh }
    }

    /// No tree: one leaf with everything in it. The oracle of the tests, and the way out for a tree too deep to walk.
    pub fn flat(primitives: usize) -> Self {
        let everywhere = OuterBox { min: [f32::NEG_INFINITY; 3], max: [f32::INFINITY; 3] };
        if primitives == 0 {
            return Self::default();
        }
        Self {
            nodes: vec![Node { bounds: everywhere, first: 0, count: primitives as u32 }],
            primitives: (0..primitives as u32).collect(),
        }
    }

    fn depth(&self) -> usize {
        let mut deepest = 0;
        let mut stack = vec![(0usize, 1usize)];
        while let Some((node, depth)) = stack.pop() {
            deepest = deepest.max(depth);
            if self.nodes[node].count == 0 {
                let first = self.nodes[node].first as usize;
                stack.extend([(first, depth + 1), (first + 1, depth + 1)]);
            }
        }
        deepest
    }

    /// Bytes of the built tree.
    pub fn memory(&self) -> usize {
        size_of_val(self.nodes.as_slice()) + size_of_val(self.primitives.as_slice())
    }

    /// Visits the primitives whose boxes the rays of `active` meet, near boxes first. `visit` gets the primitive and
    /// the limits still open in each lane, and returns the new limits: the nearest hit so far, or anything below `t_min`
    /// to end a lane.
    #[inline(always)]
    pub fn traverse<L: Lanes>(
        &self,
        ray: &Ray<L>,
        frame: &RayFrame<L>,
        active: L::Mask,
        mut visit: impl FnMut(u32, L) -> L,
    ) {
        // A lane without a ray is one whose limit lies before everything.
        let mut limit = L::select(active, ray.t_max, L::splat(f64::NEG_INFINITY));
        let Some(root) = self.nodes.first() else { return };
        if !root.bounds.enter(ray.origin, frame, ray.t_min, limit).1.any() {
            return;
        }
        let mut stack = [0u32; STACK];
        let mut height = 0;
        let mut node = root;
        loop {
            if node.count > 0 {
                let first = node.first as usize;
                for &primitive in &self.primitives[first..first + node.count as usize] {
                    limit = visit(primitive, limit);
                }
            } else {
                let first = node.first as usize;
                let (left, right) = (&self.nodes[first], &self.nodes[first + 1]);
                let (left_t, left_met) = left.bounds.enter(ray.origin, frame, ray.t_min, limit);
                let (right_t, right_met) = right.bounds.enter(ray.origin, frame, ray.t_min, limit);
                match (left_met.any(), right_met.any()) {
                    (true, true) => {
                        // Where any ray that meets both enters the left one first, or only the left: left first.
                        let both = left_met & right_met;
                        let left_first = if both.any() { (both & left_t.le(right_t)).any() } else { true };
                        stack[height] = (if left_first { first + 1 } else { first }) as u32;
                        height += 1;
                        node = if left_first { left } else { right };
                        continue;
                    }
                    (true, false) => {
                        node = left;
                        continue;
                    }
                    (false, true) => {
                        node = right;
                        continue;
                    }
                    (false, false) => {}
                }
            }
            loop {
                if height == 0 {
                    return;
                }
                height -= 1;
                node = &self.nodes[stack[height] as usize];
                // Hits found meanwhile may have closed this box.
                if node.bounds.enter(ray.origin, frame, ray.t_min, limit).1.any() {
                    break;
                }
            }
        }
    }
}
