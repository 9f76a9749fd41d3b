//! The tree of boxes.
//!
//! The answer does not depend on the tree. Every box holds its primitives with a margin that is larger than the
//! rounding errors of the primitive tests (see [`Bvh::build`]), and the caller decides ties at equal `t` by primitive
//! id, so any tree, and no tree at all, finds the same hit to the last bit.

mod build;

use super::bounds::{Bounds, OuterBox};
use super::{Ray, RayFrame};
use crate::lanes::{Lanes, Mask};

/// Relative size of the margin around each primitive: 2⁻⁴⁸ of the farthest distance from which a ray can come.
///
/// Where a coordinate is so large that this is lost beside it, the step to the next `f32` is larger: `reach·2⁻⁴⁸` is
/// lost beside `v` only if `|v| > reach·2⁻²⁴`, and then that step, at least `|v|·2⁻²⁴`, is more.
///
/// A primitive test places a hit within a few rounding errors, each `2⁻⁵³` of the distance between ray origin and
/// primitive (sphere: the perpendicular `T − v·d`; triangle: the three vertices in ray space). Thirty-two of them are
/// more than all of these together with those of the slab test. The textbook discriminant of near spheres errs by more;
/// their boxes come with that margin ([`sphere::MARGIN`](super::sphere::MARGIN)).
const MARGIN: f64 = 1.0 / (1u64 << 48) as f64;

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

/// The box of a primitive that rays reach from at most `reach` away.
fn padded(bounds: &Bounds, reach: f64) -> OuterBox {
    OuterBox::around(bounds, reach * MARGIN)
}

impl Bvh {
    /// Builds the tree over the boxes of all primitives, in the order of their ids. `reach` is the largest distance
    /// between a ray's origin and a primitive.
    pub fn build(boxes: &[Bounds], reach: f64) -> Self {
        build::build(boxes.iter().map(|b| padded(b, reach)).collect())
    }

    /// No tree: one leaf with everything in it, the oracle of the tests.
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
        let mut stack = [0u32; build::MAX_DEPTH];
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Vec3, sphere, triangle};
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

    /// The claim on which everything rests: where a primitive test finds a hit, its box is entered before it.
    fn hit_lies_in_box(ray: &Ray, t: f64, bounds: &Bounds, reach: f64) {
        let (near, met) = padded(bounds, reach).enter(ray.origin, &RayFrame::new(ray.dir), ray.t_min, t);
        assert!(met && near < t, "hit at {t}, box entered at {near}: {met}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn spheres_are_hit_only_in_their_boxes(
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
            let ray = Ray { origin, dir, t_min: 0.0, t_max: f64::INFINITY };
            let (t, hit) = sphere::intersect(&ray, center, radius);
            if hit {
                let bounds = sphere::bounds(center, radius);
                let reach = Bounds::of([origin]).union(bounds).diagonal();
                hit_lies_in_box(&ray, t, &bounds, reach);
            }
        }

        #[test]
        fn triangles_are_hit_only_in_their_boxes(
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
            let ray = Ray { origin, dir, t_min: 0.0, t_max: f64::INFINITY };
            let found = triangle::intersect(&ray, &RayFrame::new(dir), corners);
            if found.hit {
                let bounds = Bounds::of(corners);
                let reach = Bounds::of([origin]).union(bounds).diagonal();
                hit_lies_in_box(&ray, found.t, &bounds, reach);
            }
        }
    }
}
