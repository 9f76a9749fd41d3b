//! The tree of boxes: eight to a node, up to eight primitives to a leaf, of whatever shape.
//!
//! The answer does not depend on the tree. Every box holds its primitives with a margin that is larger than the
//! rounding errors of the primitive tests (see `MARGIN`), and at equal distance the lower primitive id is hit,
//! so any tree, and no tree at all, finds the same hit to the last bit. Nor does it depend on the way down the tree, in a
//! packet or alone: the arithmetic of a ray with a primitive is the same, whichever of the two stands in lanes.

mod build;
mod crossings;
mod few_spheres;
mod instance;
mod nearest;
mod node;
mod packet;
mod packet_traversal;
mod primitives;
mod single_ray;

pub use super::shape::Shapes;
pub use build::Quality;
pub(crate) use few_spheres::FewSpheres;
pub use instance::Instance;
pub(crate) use nearest::Nearest;
pub(crate) use packet::{Packet, SIZE as PACKET};

use super::bounds::OuterBox;
use super::shape::{AnyShape, Kind};
use crate::lanes::prefetch;
use crate::threads;
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

/// Fewer primitives are done before threads have started.
const WORTH_THREADS: usize = 1 << 12;

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
    /// Builds the tree. `margin` is the room that each box has around its primitives: at least [`MARGIN`] times the largest
    /// distance between a ray's origin and a primitive.
    /// `models`: the trees that stand at the instances; they have none of their own. `threads`: 0 for as many as the
    /// machine has cores.
    pub fn build(shapes: &Shapes<'_>, models: Vec<Self>, margin: f64, quality: Quality, threads: usize) -> Self {
        let firsts = shapes.firsts();
        let padded = |i| OuterBox::around(&shapes.bounds_from(&firsts, i), margin);
        let threads = if shapes.count() < WORTH_THREADS { 1 } else { threads.min(shapes.count() / WORTH_THREADS + 1) };
        let (tree, primitives) = threads::share(threads, |parallel| {
            let mut tree = build::build(shapes.count(), padded, quality, parallel);
            let primitives = Primitives::new(shapes, &mut tree, parallel);
            (tree, primitives)
        });
        Self {
            nodes: tree.nodes,
            primitives,
            depth: tree.depth,
            models,
            instances: shapes.instances.to_vec(),
            few_spheres: few_spheres::few_spheres(shapes),
        }
    }

    /// Fetches what is in a box while others are visited first: a tree of any size does not fit into a cache.
    #[inline(always)]
    fn prefetch(&self, child: Child) {
        let node = self.nodes.as_ptr().wrapping_add(child.number()).cast::<u8>();
        let leaf = self.primitives.numbers.as_ptr().wrapping_add(child.place().at).cast::<u8>();
        prefetch::<FETCHED>(if child.is_node() { node } else { leaf });
    }

    /// Is there anything whose test wants the shears of rays?
    pub(crate) fn needs_shears(&self) -> bool {
        self.primitives.has_sheared()
    }

    /// A model, by its number.
    pub(crate) fn model(&self, number: usize) -> &Self {
        &self.models[number]
    }

    /// A primitive, by its id; `None` for those of instances.
    pub(crate) fn shape(&self, id: usize) -> Option<AnyShape> {
        self.primitives.shape(id)
    }

    /// A primitive that may be of this kind, by its id.
    #[inline(always)]
    pub(crate) fn get<S: Kind>(&self, id: usize) -> Option<S> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::ray::{Heading, axes, main_axis};
    use crate::geometry::shape::Triangles;
    use crate::geometry::{Bounds, Sphere, Vec3, sphere, triangle};
    use crate::lanes::{ArrayLanes, Lanes};
    use proptest::prelude::*;

    fn direction() -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(-1.0..1.0f64).prop_map(Vec3::from).prop_filter("short", |v| v.length() > 0.1)
    }

    /// Whole numbers and others, near the origin and far from it.
    fn point() -> impl Strategy<Value = Vec3> {
        let number = prop_oneof![-20.0..20.0f64, (-9..9i32).prop_map(f64::from)];
        let offset = prop_oneof![Just(0.0), Just(4096.0), Just(1e6), Just(-3e8)];
        (prop::array::uniform3(number), offset).prop_map(|(p, offset)| p.map(|c| c + offset).into())
    }

    /// What the primitive tests say, without any tree.
    fn alone(shapes: &Shapes<'_>, id: usize, origin: Vec3, dir: Vec3) -> Option<f64> {
        let (t, meets) = if let Some(s) = shapes.spheres.get(id) {
            sphere::intersect(origin, dir, s.center, s.radius)
        } else {
            let k = axes(main_axis(dir));
            let Triangles { vertices, faces } = shapes.triangles;
            let corners = faces[id - shapes.spheres.len()].map(|v| vertices[v as usize].permuted(k));
            let hit = triangle::intersect(origin.permuted(k), &Heading::new(dir.permuted(k)), corners);
            (hit.t, hit.meets)
        };
        (meets && t > 0.0).then_some(t)
    }

    /// One ray in `copies` places of a packet: few go down the tree alone, many together.
    fn in_tree<L: Lanes, const ANY: bool>(
        tree: &Bvh,
        origin: Vec3,
        dir: Vec3,
        t_max: f64,
        copies: usize,
    ) -> (u64, f64, f64) {
        let mut packet = Packet::default();
        for start in (0..PACKET).step_by(L::WIDTH) {
            packet.set(start, origin.splat(), dir.splat(), L::splat(0.0), L::splat(t_max), L::splat(-1.0), true);
        }
        let rays = u64::MAX >> (PACKET - copies);
        let hit = tree.intersect::<L, ANY>(&mut packet, rays);
        for i in 0..copies {
            assert_eq!((packet.t[i], packet.primitive[i]), (packet.t[0], packet.primitive[0]));
        }
        assert!(hit == rays || hit == 0);
        (hit, packet.t[0], packet.primitive[0])
    }

    /// The claim on which everything rests: the tree finds what the primitive tests find, also if nothing behind the hit
    /// counts any more, so that no box may be entered later than its hit.
    fn finds_the_same(shapes: &Shapes<'_>, origin: Vec3, dir: Vec3) {
        let hits = (0..shapes.count()).filter_map(|id| Some((alone(shapes, id, origin, dir)?, id)));
        let nearest = hits.min_by(|a, b| a.partial_cmp(b).unwrap());
        let everything = (0..shapes.count()).map(|i| shapes.bounds(i)).fold(Bounds::of([origin]), Bounds::union);
        let tree = Bvh::build(shapes, vec![], MARGIN * everything.diagonal(), Quality::Good, 1);
        let limit = nearest.map_or(f64::INFINITY, |(t, _)| t.next_up());
        for (t_max, copies) in [(f64::INFINITY, 1), (f64::INFINITY, PACKET), (limit, 1), (limit, PACKET)] {
            let found = [
                in_tree::<f64, false>(&tree, origin, dir, t_max, copies),
                in_tree::<ArrayLanes<4>, false>(&tree, origin, dir, t_max, copies),
            ];
            for (hit, t, id) in found {
                assert_eq!((hit != 0).then_some((t, id as usize)), nearest, "t_max {t_max}, {copies} rays");
            }
            let any = in_tree::<ArrayLanes<8>, true>(&tree, origin, dir, t_max, copies).0;
            assert_eq!(any != 0, nearest.is_some());
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn a_sphere_is_found_in_its_box(
            center in point(),
            exponent in -9..10i32,
            from in direction(),
            distance in -1.0..6.0f64,
            axis in 0..3usize,
            around in direction(),
            rim in prop_oneof![Just(0.0), -1e-12..1e-12f64, -1e-6..1e-6f64, -1.0..0.0f64],
        ) {
            // Aimed at the rim of the sphere, at one of the six points where it touches its box.
            let radius = libm::exp10(f64::from(exponent));
            let origin = center + from * (radius * (1.5 + libm::exp10(distance)));
            let mut pole = [0.0; 3];
            pole[axis] = if around.x < 0.0 { -1.0 } else { 1.0 };
            let target = center + Vec3::from(pole) * (radius * (1.0 + rim));
            let dir = (target - origin).unit();
            prop_assume!(dir.is_finite());
            finds_the_same(&Shapes { spheres: &[Sphere { center, radius }], ..Shapes::default() }, origin, dir);
        }

        #[test]
        fn a_triangle_is_found_in_its_box(
            origin in point(),
            corners in prop::array::uniform3(prop::array::uniform3(-9..9i32)),
            flat in 0..4usize,
            weights in prop::array::uniform3(prop_oneof![Just(0.0), 0.0..1.0f64]),
        ) {
            let mut corners = corners.map(|c| origin + Vec3::from(c.map(f64::from)) + Vec3::new(0.5, 2.0, 12.0));
            // Often in a plane across an axis, where the box has no thickness but its margin.
            let (_, rest) = corners.split_at_mut(1);
            match flat {
                0 => rest.iter_mut().for_each(|c| c.x = origin.x + 0.5),
                1 => rest.iter_mut().for_each(|c| c.y = origin.y + 2.0),
                2 => rest.iter_mut().for_each(|c| c.z = origin.z + 12.0),
                _ => {}
            }
            let sum: f64 = weights.iter().sum();
            prop_assume!(sum > 0.0);
            let target = (corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2]) * (1.0 / sum);
            let dir = (target - origin).unit();
            prop_assume!(dir.is_finite());
            finds_the_same(&Shapes { triangles: Triangles { vertices: &corners, faces: &[[0, 1, 2]] }, ..Shapes::default() }, origin, dir);
        }

        /// In the plane of a triangle the edge functions are noise.
        #[test]
        fn a_ray_in_the_plane_of_a_triangle_finds_the_same(
            corners in prop::array::uniform3(prop::array::uniform3(-9..9i32)),
            steps in prop::array::uniform4(-5..6i32),
        ) {
            let [a, b, c] = corners.map(|p| Vec3::from(p.map(f64::from)));
            let [to_b, to_c, from_b, from_c] = steps.map(f64::from);
            let origin = a + (b - a) * from_b + (c - a) * from_c;
            let dir = ((b - a) * to_b + (c - a) * to_c).unit();
            prop_assume!(dir.is_finite() && triangle::normal([a, b, c]).is_finite());
            finds_the_same(&Shapes { triangles: Triangles { vertices: &[a, b, c], faces: &[[0, 1, 2]] }, ..Shapes::default() }, origin, dir);
        }

        /// Enough primitives for several levels, and many rays at the same distance from two of them.
        #[test]
        fn the_nearest_of_many_is_found(
            centers in prop::collection::vec(prop::array::uniform3(-4..5i32), 1..120),
            corners in prop::collection::vec(prop::array::uniform3(-9..9i32), 3..120),
            origin in prop::array::uniform3(-12..12i32),
            dir in direction(),
        ) {
            let whole = |p: [i32; 3]| Vec3::from(p.map(f64::from));
            let spheres: Vec<Sphere> =
                centers.iter().map(|&c| Sphere { center: whole(c) * 2.0, radius: 1.0 }).collect();
            let vertices: Vec<Vec3> = corners.iter().map(|&c| whole(c)).collect();
            let faces: Vec<[u32; 3]> = (0..vertices.len() as u32 / 3).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
            let triangles = Triangles { vertices: &vertices, faces: &faces };
            let shapes = Shapes { spheres: &spheres, triangles, ..Shapes::default() };
            let origin = whole(origin) + Vec3::new(0.3, 0.3, 0.3);
            finds_the_same(&shapes, origin, dir.unit());
            // Along an axis: into the planes of boxes, and at several spheres at once.
            finds_the_same(&shapes, whole([0, 0, 30]), Vec3::new(0.0, 0.0, -1.0));
        }
    }
}
