//! One ray through the tree: the boxes of a node, or the primitives of a leaf, in lanes.

use super::node::{self, Block, Child, Kind, Node};
use super::packet::{Octant, Packet};
use super::primitives::{SPHERE, TRIANGLE};
use super::{Bvh, Waiting, farthest_first};
use crate::geometry::ray::Shear;
use crate::geometry::{Vec3, sphere, triangle};
use crate::lanes::{Lanes, Mask};

/// So many rays are on their way at the same time.
const WALKERS: usize = 8;

/// A ray on its way through the tree alone.
#[derive(Debug, Default)]
pub(super) struct Walker {
    ray: usize,
    octant: Octant,
    /// What it visits next.
    child: Child,
    /// What it visits later.
    waiting: Vec<Waiting>,
}

impl Bvh {
    /// Follows some rays of a packet from a node on, each its own way, near boxes first. With `ANY` a ray stops at its first
    /// hit. Says which rays found one.
    ///
    /// A ray alone often waits for memory. So several are on their way in turns: while the next node of one is being
    /// fetched, the others make a step.
    #[inline(always)]
    pub(super) fn follow<L: Lanes, const ANY: bool>(
        &self,
        packet: &mut Packet,
        mut rays: u64,
        from: Child,
        walkers: &mut Vec<Walker>,
    ) -> u64 {
        walkers.resize_with(WALKERS, Walker::default);
        let (mut near, mut keys) = ([0.0; node::WIDTH], [0; node::WIDTH]);
        let mut hit = 0;
        let mut walking = 0;
        while walking < WALKERS && rays != 0 {
            let ray = rays.trailing_zeros() as usize & 63;
            rays &= rays - 1;
            walkers[walking].start(packet, ray, from);
            walking += 1;
        }
        let mut turn = 0;
        while walking > 0 {
            let walker = &mut walkers[turn];
            let (ray, octant) = (walker.ray, &walker.octant);
            let mut done = false;
            let mut next = Child::NOTHING;
            match walker.child.kind() {
                Kind::Nothing | Kind::Leaf(_) => {}
                Kind::Block(block) => {
                    let found = self.test_alone::<L, ANY>(packet, ray, octant, block);
                    hit |= u64::from(found) << ray;
                    done = ANY && found;
                }
                Kind::Node(number) => {
                    let node = &self.nodes[number as usize];
                    let met = Boxes::<L>::new(packet, ray, octant).meet(node, packet.t[ray], &mut near);
                    if met & met.wrapping_sub(1) == 0 {
                        if met != 0 {
                            next = node.child[met.trailing_zeros() as usize & 7];
                        }
                    } else {
                        let count = farthest_first(met, &near, &mut keys);
                        for &key in &keys[..count - 1] {
                            let slot = key as usize & 7;
                            walker.waiting.push(Waiting { t: near[slot], child: node.child[slot] });
                        }
                        next = node.child[keys[count - 1] as usize & 7];
                    }
                }
            }
            while !done && next == Child::NOTHING {
                match walker.waiting.pop() {
                    None => done = true,
                    // Hits found meanwhile may have closed this box.
                    Some(waiting) if waiting.t <= packet.t[ray] => next = waiting.child,
                    Some(_) => {}
                }
            }
            if !done {
                self.prefetch(next);
                walker.child = next;
                turn += 1;
            } else if rays != 0 {
                let ray = rays.trailing_zeros() as usize & 63;
                rays &= rays - 1;
                walker.start(packet, ray, from);
                turn += 1;
            } else {
                walking -= 1;
                walkers.swap(turn, walking);
            }
            if turn >= walking {
                turn = 0;
            }
        }
        hit
    }

    /// Tests the primitives of a leaf against one ray and keeps the nearest hit; says whether there was one.
    #[inline(always)]
    pub(super) fn test_alone<L: Lanes, const ANY: bool>(
        &self,
        packet: &mut Packet,
        ray: usize,
        octant: &Octant,
        block: Block,
    ) -> bool {
        let Block { at, spheres, triangles, instances } = block;
        let mut found = false;
        let numbers = &self.primitives.numbers[at..];
        if spheres > 0 {
            let (origin, dir) = (Packet::one(&packet.origin, ray, [0, 1, 2]), Packet::one(&packet.dir, ray, [0, 1, 2]));
            for start in (0..spheres).step_by(L::WIDTH) {
                let center = vectors(&numbers[start..], spheres, [0, 1, 2]);
                let radius = L::load(&numbers[3 * spheres + start..]);
                let (t, meets) = sphere::intersect(origin, dir, center, radius);
                let meets = meets & L::Mask::first(spheres - start);
                found |= keep::<L, ANY>(packet, ray, t, meets, &numbers[4 * spheres + start..]);
            }
        }
        if triangles > 0 {
            let k = octant.axes;
            let origin = Packet::one(&packet.origin, ray, k);
            let (x, y) = (L::splat(packet.shear[0][ray]), L::splat(packet.shear[1][ray]));
            let shear = Shear(Vec3::new(x, y, L::splat(packet.inv_dir[k[2]][ray])));
            let numbers = &numbers[SPHERE * spheres..];
            for start in (0..triangles).step_by(L::WIDTH) {
                let a = vectors(&numbers[start..], triangles, k);
                let b = vectors(&numbers[start..], triangles, [k[0] + 3, k[1] + 3, k[2] + 3]);
                let c = vectors(&numbers[start..], triangles, [k[0] + 6, k[1] + 6, k[2] + 6]);
                let hit = triangle::intersect(origin, &shear, [a, b, c]);
                let meets = hit.meets & L::Mask::first(triangles - start);
                found |= keep::<L, ANY>(packet, ray, hit.t, meets, &numbers[(TRIANGLE - 1) * triangles + start..]);
            }
        }
        if instances > 0 && !(ANY && found) {
            let numbers = &numbers[SPHERE * spheres + TRIANGLE * triangles..][..instances];
            found |= self.visit_each::<L, ANY>(packet, 1 << ray, numbers) != 0;
        }
        found
    }
}

impl Walker {
    #[inline(always)]
    fn start(&mut self, packet: &Packet, ray: usize, from: Child) {
        (self.ray, self.octant, self.child) = (ray, packet.octant(ray), from);
        self.waiting.clear();
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
    fn new(packet: &Packet, ray: usize, octant: &Octant) -> Self {
        Self {
            origin: Packet::one(&packet.origin, ray, [0, 1, 2]).into(),
            inv_dir: Packet::one(&packet.inv_dir, ray, [0, 1, 2]).into(),
            side: octant.side,
            t_min: L::splat(packet.t_min[ray]),
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
                enter = ((L::load_f32(&node.side(axis, side)[start..]) - o) * i).max(enter);
                leave = ((L::load_f32(&node.side(axis, 1 - side)[start..]) - o) * i).min(leave);
            }
            enter.store(&mut near[start..]);
            met |= enter.le(leave).bits() << start;
        }
        met
    }
}

/// Three numbers of neighbouring primitives, from these columns of a leaf.
#[inline(always)]
fn vectors<L: Lanes>(numbers: &[f64], stride: usize, [x, y, z]: [usize; 3]) -> Vec3<L> {
    Vec3::new(L::load(&numbers[x * stride..]), L::load(&numbers[y * stride..]), L::load(&numbers[z * stride..]))
}

/// Keeps the nearest of some hits; at equal distance that of the lower id.
#[inline(always)]
fn keep<L: Lanes, const ANY: bool>(packet: &mut Packet, ray: usize, t: L, meets: L::Mask, ids: &[f64]) -> bool {
    let id = L::load(ids);
    let open = meets & t.gt(L::splat(packet.t_min[ray])) & t.le(L::splat(packet.t[ray]));
    let mut bits = (open & !id.eq(L::splat(packet.source[ray]))).bits();
    let mut found = false;
    while bits != 0 {
        let lane = bits.trailing_zeros() as usize;
        bits &= bits - 1;
        let (t, id) = (t.lane(lane), ids[lane]);
        if t < packet.t[ray] || (t == packet.t[ray] && id < packet.primitive[ray]) {
            (packet.t[ray], packet.primitive[ray], found) = (t, id, true);
        }
    }
    found
}
