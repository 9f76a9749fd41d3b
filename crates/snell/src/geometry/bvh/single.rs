//! One ray through the tree: the boxes of a node, or the primitives of a leaf, in lanes.

use super::node::{self, Child, Node};
use super::primitives::{Leaf, Primitives};
use super::{Bvh, Waiting};
use crate::geometry::ray::{Shear, axes};
use crate::geometry::{Vec3, sphere, triangle};
use crate::lanes::{Lanes, Mask};

/// One ray, taken from a packet.
#[derive(Clone, Copy, Debug)]
pub(super) struct SingleRay {
    pub origin: [f64; 3],
    pub dir: [f64; 3],
    pub inv_dir: [f64; 3],
    /// First two numbers of its shear; the third is the inverse of its main component.
    pub shear: [f64; 2],
    /// Its main axis.
    pub main: usize,
    /// For each axis 1 where it goes towards smaller coordinates.
    pub side: [usize; 3],
    pub t_min: f64,
    /// The primitive that it leaves and cannot hit.
    pub source: f64,
    /// The nearest hit so far: distance and primitive, less than any id if there is none.
    pub t: f64,
    pub primitive: f64,
}

impl Bvh {
    /// Follows one ray from a node or leaf on; near boxes first. With `ANY` it stops at the first hit and says so.
    #[inline(always)]
    pub(super) fn follow<L: Lanes, const ANY: bool>(
        &self,
        ray: &mut SingleRay,
        from: Child,
        waiting: &mut Vec<Waiting>,
    ) -> bool {
        let boxes = Boxes::<L>::new(ray);
        let mut near = [0.0; node::WIDTH];
        let mut child = from;
        waiting.clear();
        loop {
            match child.number() {
                Ok(leaf) => {
                    if test_leaf::<L, ANY>(&self.primitives, self.primitives.leaves[leaf], ray) && ANY {
                        return true;
                    }
                }
                Err(number) => {
                    let node = &self.nodes[number];
                    let mut met = boxes.meet(node, ray.t, &mut near);
                    if met & met.wrapping_sub(1) == 0 {
                        if met != 0 {
                            child = node.child[met.trailing_zeros() as usize & 7];
                            continue;
                        }
                    } else {
                        let first = waiting.len();
                        while met != 0 {
                            let slot = met.trailing_zeros() as usize & 7;
                            waiting.push(Waiting { t: near[slot], child: node.child[slot] });
                            met &= met - 1;
                        }
                        if !ANY {
                            farthest_first(&mut waiting[first..]);
                        }
                    }
                }
            }
            child = loop {
                match waiting.pop() {
                    None => return false,
                    // Hits found meanwhile may have closed this box.
                    Some(next) if next.t <= ray.t => break next.child,
                    Some(_) => {}
                }
            };
        }
    }
}

/// Insertion sort: mostly two or three.
#[inline(always)]
fn farthest_first(waiting: &mut [Waiting]) {
    for i in 1..waiting.len() {
        let mut at = i;
        while at > 0 && waiting[at - 1].t < waiting[at].t {
            waiting.swap(at - 1, at);
            at -= 1;
        }
    }
}

/// What the boxes of a node need of a ray, in every lane.
struct Boxes<L> {
    origin: [L; 3],
    inv_dir: [L; 3],
    side: [usize; 3],
    t_min: L,
}

impl<L: Lanes> Boxes<L> {
    #[inline(always)]
    fn new(ray: &SingleRay) -> Self {
        Self {
            origin: Vec3::from(ray.origin).splat().into(),
            inv_dir: Vec3::from(ray.inv_dir).splat().into(),
            side: ray.side,
            t_min: L::splat(ray.t_min),
        }
    }

    /// Which of the eight boxes the ray meets up to `limit`, as bits, and where it enters them.
    ///
    /// The slab test of Kay and Kajiya (1986) in `f64` on the widened corners.
    #[inline(always)]
    fn meet(&self, node: &Node, limit: f64, near: &mut [f64; node::WIDTH]) -> u32 {
        let limit = L::splat(limit);
        let mut met = 0;
        for start in (0..node::WIDTH).step_by(L::WIDTH) {
            let (mut enter, mut leave) = (self.t_min, limit);
            for axis in 0..3 {
                let (side, o, i) = (self.side[axis] & 1, self.origin[axis], self.inv_dir[axis]);
                enter = ((node.plane::<L>(axis, side, start) - o) * i).max(enter);
                leave = ((node.plane::<L>(axis, 1 - side, start) - o) * i).min(leave);
            }
            enter.store(&mut near[start..]);
            met |= enter.le(leave).bits() << start;
        }
        met
    }
}

/// Tests the primitives of a leaf and keeps the nearest hit; says whether there was one.
#[inline(always)]
fn test_leaf<L: Lanes, const ANY: bool>(primitives: &Primitives, leaf: Leaf, ray: &mut SingleRay) -> bool {
    let (spheres, triangles) = (usize::from(leaf.spheres), usize::from(leaf.triangles));
    let mut found = false;
    let numbers = &primitives.numbers[leaf.at as usize..];
    if spheres > 0 {
        let (origin, dir) = (Vec3::from(ray.origin).splat::<L>(), Vec3::from(ray.dir).splat::<L>());
        for start in (0..spheres).step_by(L::WIDTH) {
            let center = vectors(&numbers[start..], spheres, [0, 1, 2]);
            let radius = L::load(&numbers[3 * spheres + start..]);
            let (t, meets) = sphere::intersect(origin, dir, center, radius);
            found |= keep::<L, ANY>(primitives, leaf.first as usize + start, spheres - start, t, meets, ray);
            if found && ANY {
                return true;
            }
        }
    }
    if triangles > 0 {
        let k = axes(ray.main);
        let origin = Vec3::new(L::splat(ray.origin[k[0]]), L::splat(ray.origin[k[1]]), L::splat(ray.origin[k[2]]));
        let shear = Shear(Vec3::new(ray.shear[0], ray.shear[1], ray.inv_dir[k[2]]).splat::<L>());
        let numbers = &numbers[4 * spheres..];
        for start in (0..triangles).step_by(L::WIDTH) {
            let a = vectors(&numbers[start..], triangles, k);
            let b = vectors(&numbers[start..], triangles, [k[0] + 3, k[1] + 3, k[2] + 3]);
            let c = vectors(&numbers[start..], triangles, [k[0] + 6, k[1] + 6, k[2] + 6]);
            let hit = triangle::intersect(origin, &shear, [a, b, c]);
            let first = leaf.first as usize + spheres + start;
            found |= keep::<L, ANY>(primitives, first, triangles - start, hit.t, hit.meets, ray);
            if found && ANY {
                return true;
            }
        }
    }
    found
}

/// Three numbers of neighbouring primitives, from these columns of a leaf.
#[inline(always)]
fn vectors<L: Lanes>(numbers: &[f64], stride: usize, [x, y, z]: [usize; 3]) -> Vec3<L> {
    Vec3::new(L::load(&numbers[x * stride..]), L::load(&numbers[y * stride..]), L::load(&numbers[z * stride..]))
}

/// Keeps the nearest of some hits; at equal distance that of the lower id.
#[inline(always)]
fn keep<L: Lanes, const ANY: bool>(
    primitives: &Primitives,
    first: usize,
    count: usize,
    t: L,
    meets: L::Mask,
    ray: &mut SingleRay,
) -> bool {
    let open = meets & t.gt(L::splat(ray.t_min)) & t.le(L::splat(ray.t)) & L::Mask::first(count);
    let mut bits = open.bits();
    let mut found = false;
    while bits != 0 {
        let lane = bits.trailing_zeros() as usize;
        bits &= bits - 1;
        let (t, id) = (t.lane(lane), f64::from(primitives.ids[first + lane]));
        if id != ray.source && (t < ray.t || (t == ray.t && id < ray.primitive)) {
            (ray.t, ray.primitive, found) = (t, id, true);
            if ANY {
                return true;
            }
        }
    }
    found
}
