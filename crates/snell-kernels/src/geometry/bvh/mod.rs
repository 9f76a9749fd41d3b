//! The tree of boxes: eight to a node, up to eight primitives to a leaf, of whatever shape.
//!
//! The answer does not depend on the tree. Every box holds its primitives with a margin that is larger than the
//! rounding errors of the primitive tests (see `MARGIN`), and at equal distance the lower primitive id is hit,
//! so any tree, and no tree at all, finds the same hit to the last bit. Nor does it depend on the way down the tree, in a
//! packet or alone: the arithmetic of a ray with a primitive is the same, whichever of the two stands in lanes.

mod crossings;
mod few_spheres;
mod instance;
mod nearest;
pub mod node;
mod packet;
mod packet_traversal;
pub mod primitives;
mod single_ray;

pub use super::shape::Shapes;
use alloc::vec::Vec;
pub use few_spheres::FewSpheres;
pub use instance::Instance;
pub use nearest::Nearest;
pub use packet::{Packet, SIZE as PACKET};

use super::bounds::OuterBox;
use super::shape::{AnyShape, Kind};
use crate::lanes::prefetch;
use node::{Child, Node};
use primitives::Primitives;

/// Relative size of the margin around each primitive: 2⁻⁴⁸ of the farthest distance from which a ray can come, and of the
/// largest coordinate.
///
/// Where a coordinate is so large that this is lost beside it, the step to the next `f32` is larger: `reach·2⁻⁴⁸` is
/// lost beside `v` only if `|v| > reach·2⁻²⁴`, and then that step, at least `|v|·2⁻²⁴`, is more.
///
/// A primitive test places a hit within a few rounding errors, each `2⁻⁵³` of the distance between ray origin and
/// primitive (sphere: the perpendicular `T − v·d`; triangle: in its own box, with sixteen roundings of room). Thirty-two of
/// them are more than all of these together with those of the slab test. The textbook discriminant of near spheres errs by
/// more; their boxes come with that margin ([`sphere::MARGIN`](super::sphere::MARGIN)).
pub const MARGIN: f64 = 1.0 / (1u64 << 48) as f64;

/// Cache lines that are fetched ahead: a node has four, and a leaf of a mesh about six.
const FETCHED: usize = 8;

/// A tree of boxes over shapes, with its own copy of them.
#[derive(Clone, Debug, Default)]
pub struct Bvh {
    nodes: Vec<Node>,
    primitives: Primitives,
    depth: usize,
    /// Trees of their own, and where they stand.
    models: Vec<Bvh>,
    instances: Vec<Instance>,
    /// The spheres once more, if they are few and all there is.
    few_spheres: FewSpheres,
}

/// What a tree is made of, with those of its models.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TreeStatistics {
    /// Nodes of eight boxes.
    pub nodes: usize,
    /// Leaves of up to eight primitives.
    pub leaves: usize,
    /// Nodes on the longest way down.
    pub depth: usize,
    /// Bytes of the nodes.
    pub node_bytes: usize,
    /// Bytes of the primitives, which stand in the leaves.
    pub primitive_bytes: usize,
}

impl Bvh {
    /// A tree of its nodes and its primitives. `models`: the trees that stand at the instances; they have none of their own.
    pub fn new(nodes: Vec<Node>, primitives: Primitives, depth: usize, shapes: &Shapes<'_>, models: Vec<Self>) -> Self {
        let instances = shapes.instances.to_vec();
        Self { nodes, primitives, depth, models, instances, few_spheres: few_spheres::few_spheres(shapes) }
    }

    /// Fetches what is in a box while others are visited first: a tree of any size does not fit into a cache.
    #[inline(always)]
    fn prefetch(&self, child: Child) {
        let node = self.nodes.as_ptr().wrapping_add(child.number()).cast::<u8>();
        let leaf = self.primitives.numbers.as_ptr().wrapping_add(child.place().at).cast::<u8>();
        prefetch::<FETCHED>(if child.is_node() { node } else { leaf });
    }

    /// Is there anything whose test wants the shears of rays?
    pub fn needs_shears(&self) -> bool {
        self.primitives.has_sheared()
    }

    /// A model, by its number.
    pub fn model(&self, number: usize) -> &Self {
        &self.models[number]
    }

    /// A primitive, by its id; `None` for those of instances.
    pub fn shape(&self, id: usize) -> Option<AnyShape> {
        self.primitives.shape(id)
    }

    /// A primitive that may be of this kind, by its id.
    #[inline(always)]
    pub fn get<S: Kind>(&self, id: usize) -> Option<S> {
        self.primitives.get(id)
    }

    /// Nodes, leaves, depth, bytes.
    pub fn statistics(&self) -> TreeStatistics {
        let is_leaf = |child: &&Child| matches!(child.kind(), node::Kind::Block(_));
        let own = TreeStatistics {
            nodes: self.nodes.len(),
            leaves: self.nodes.iter().flat_map(|node| &node.child).filter(is_leaf).count(),
            depth: self.depth,
            node_bytes: size_of_val(self.nodes.as_slice()),
            primitive_bytes: self.primitives.memory() + size_of_val(self.instances.as_slice()),
        };
        self.models.iter().map(Self::statistics).fold(own, |all, model| TreeStatistics {
            nodes: all.nodes + model.nodes,
            leaves: all.leaves + model.leaves,
            depth: all.depth.max(own.depth + model.depth),
            node_bytes: all.node_bytes + model.node_bytes,
            primitive_bytes: all.primitive_bytes + model.primitive_bytes,
        })
    }

    /// The same primitives in boxes that hold everything: every ray meets every primitive. The oracle of the tests.
    #[must_use]
    pub fn flat(mut self) -> Self {
        self.few_spheres.clear();
        let everything = OuterBox { min: [f32::NEG_INFINITY; 3], max: [f32::INFINITY; 3] };
        for node in &mut self.nodes {
            for place in 0..node.used().count_ones() as usize {
                node.set_bounds(place, &everything);
            }
        }
        self.models = self.models.into_iter().map(Self::flat).collect();
        self
    }
}
