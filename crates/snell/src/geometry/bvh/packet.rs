//! Up to 64 rays through the tree together, as long as they go the same way.
//!
//! Rays of one tile, or of neighbouring hits towards one light, meet nearly the same boxes. Those of a packet that go into
//! the same octant along the same main axis descend together: the eight boxes of a node are first tested against the
//! whole beam by interval arithmetic, then each that may be met against the rays in lanes, which says who goes on. Where few
//! are left, each goes its own way ([`follow`](Bvh::follow)). After Wald, Benthin and Boulos, *Getting Rid of
//! Packets*, 2008; Benthin et al., *Combining Single and Packet-Ray Tracing for Arbitrary Ray Distributions*, 2012.

use super::node::{self, Child, Node};
use super::primitives::Leaf;
use super::single::SingleRay;
use super::{Bvh, Waiting};
use crate::geometry::ray::{Shear, axes, inverse};
use crate::geometry::{Vec3, sphere, triangle};
use crate::lanes::{Lanes, Mask};
use std::marker::PhantomData;

/// Rays in a packet.
pub(crate) const SIZE: usize = 64;

/// So few rays go on alone.
const FEW: u32 = 4;

type Column = [f64; SIZE];

/// 64 rays in columns, and the nearest hit of each so far.
#[derive(Debug)]
#[repr(align(64))]
pub(crate) struct Packet {
    origin: [Column; 3],
    dir: [Column; 3],
    inv_dir: [Column; 3],
    /// First two numbers of the shears; the third is the inverse of the main component.
    shear: [Column; 2],
    t_min: Column,
    /// The primitive that a ray leaves and cannot hit.
    source: Column,
    /// Distance of the nearest hit so far; `t_max` without one.
    pub t: Column,
    /// The primitive hit there, −1 without one.
    pub primitive: Column,
    /// Which rays go towards smaller coordinates, by axis.
    negative: [u64; 3],
    /// Which rays have this axis as their main one.
    main: [u64; 3],
    /// Boxes that wait, of the packet and of a single ray.
    waiting: Vec<BeamWaiting>,
    waiting_single: Vec<Waiting>,
}

/// A box that some rays of a packet may enter, at `t` or later.
#[derive(Clone, Copy, Debug)]
struct BeamWaiting {
    t: f64,
    rays: u64,
    node: u32,
    slot: u32,
}

impl Default for Packet {
    fn default() -> Self {
        let zero = [0.0; SIZE];
        Self {
            origin: [zero; 3],
            dir: [zero; 3],
            inv_dir: [zero; 3],
            shear: [zero; 2],
            t_min: zero,
            source: zero,
            t: zero,
            primitive: zero,
            negative: [0; 3],
            main: [0; 3],
            waiting: Vec::new(),
            waiting_single: Vec::new(),
        }
    }
}

/// The groups of lanes that have rays among these: where each starts, and which of its lanes.
struct Groups<L> {
    rays: u64,
    lanes: PhantomData<L>,
}

#[inline(always)]
fn groups<L: Lanes>(rays: u64) -> Groups<L> {
    Groups { rays, lanes: PhantomData }
}

impl<L: Lanes> Iterator for Groups<L> {
    type Item = (usize, L::Mask);
    #[inline(always)]
    fn next(&mut self) -> Option<Self::Item> {
        if self.rays == 0 {
            return None;
        }
        let start = self.rays.trailing_zeros() as usize & (SIZE - L::WIDTH);
        let bits = (self.rays >> start) as u32 & (!0 >> (32 - L::WIDTH));
        self.rays &= !(u64::from(bits) << start);
        Some((start, L::Mask::from_bits(bits)))
    }
}

impl Packet {
    /// Sets the rays of one group of lanes.
    #[inline(always)]
    pub fn set<L: Lanes>(&mut self, start: usize, origin: Vec3<L>, dir: Vec3<L>, t_min: L, t_max: L, source: L) {
        let (x, y, z) = (dir.x, dir.y, dir.z);
        let (ax, ay, az) = (x.max(-x), y.max(-y), z.max(-z));
        let along_z = az.ge(ax) & az.ge(ay);
        let along_y = !along_z & ay.ge(ax);
        let along_x = !along_z & !along_y;
        let main = L::select(along_x, x, L::select(along_y, y, z));
        let keep = !(u64::MAX >> (SIZE - L::WIDTH) << start);
        let (origins, dirs): ([L; 3], [L; 3]) = (origin.into(), dir.into());
        let inverses = [inverse(x), inverse(y), inverse(z)];
        let mains = [along_x, along_y, along_z];
        for axis in 0..3 {
            origins[axis].store(&mut self.origin[axis][start..]);
            dirs[axis].store(&mut self.dir[axis][start..]);
            inverses[axis].store(&mut self.inv_dir[axis][start..]);
            let negative = inverses[axis].lt(L::splat(0.0));
            self.negative[axis] = self.negative[axis] & keep | u64::from(negative.bits()) << start;
            self.main[axis] = self.main[axis] & keep | u64::from(mains[axis].bits()) << start;
        }
        // The order of the axes as in `ray::axes`.
        (-(L::select(along_x, y, x) / main)).store(&mut self.shear[0][start..]);
        (-(L::select(along_z, y, z) / main)).store(&mut self.shear[1][start..]);
        t_min.store(&mut self.t_min[start..]);
        t_max.store(&mut self.t[start..]);
        source.store(&mut self.source[start..]);
        L::splat(-1.0).store(&mut self.primitive[start..]);
    }

    #[inline(always)]
    fn vector<L: Lanes>(columns: &[Column; 3], start: usize, [x, y, z]: [usize; 3]) -> Vec3<L> {
        Vec3::new(L::load(&columns[x][start..]), L::load(&columns[y][start..]), L::load(&columns[z][start..]))
    }

    #[inline(always)]
    fn single(&self, i: usize, main: usize, side: [usize; 3]) -> SingleRay {
        SingleRay {
            origin: [self.origin[0][i], self.origin[1][i], self.origin[2][i]],
            dir: [self.dir[0][i], self.dir[1][i], self.dir[2][i]],
            inv_dir: [self.inv_dir[0][i], self.inv_dir[1][i], self.inv_dir[2][i]],
            shear: [self.shear[0][i], self.shear[1][i]],
            main,
            side,
            t_min: self.t_min[i],
            source: self.source[i],
            t: self.t[i],
            primitive: self.primitive[i],
        }
    }

    /// The largest distance that still counts for any of these rays.
    #[inline(always)]
    fn farthest<L: Lanes>(&self, rays: u64) -> f64 {
        let none = L::splat(f64::NEG_INFINITY);
        let mut farthest = none;
        for (start, mask) in groups::<L>(rays) {
            farthest = L::select(mask, L::load(&self.t[start..]), none).max(farthest);
        }
        over_lanes([none, farthest])[1]
    }
}

/// Bounds of what some rays have in common: origins and inverse directions between these.
struct Beam {
    origin: [[f64; 2]; 3],
    inv_dir: [[f64; 2]; 3],
    side: [usize; 3],
}

impl Beam {
    #[inline(always)]
    fn new<L: Lanes>(packet: &Packet, rays: u64, side: [usize; 3]) -> Self {
        let (low, high) = (L::splat(f64::INFINITY), L::splat(f64::NEG_INFINITY));
        let mut bounds = [[low, high]; 6];
        for (start, mask) in groups::<L>(rays) {
            for (i, bound) in bounds.iter_mut().enumerate() {
                let column = if i < 3 { &packet.origin[i] } else { &packet.inv_dir[i - 3] };
                let value = L::load(&column[start..]);
                bound[0] = L::select(mask, value, low).min(bound[0]);
                bound[1] = L::select(mask, value, high).max(bound[1]);
            }
        }
        let mut beam = Self { origin: [[0.0; 2]; 3], inv_dir: [[0.0; 2]; 3], side };
        for axis in 0..3 {
            beam.origin[axis] = over_lanes(bounds[axis]);
            beam.inv_dir[axis] = over_lanes(bounds[axis + 3]);
        }
        beam
    }

    /// Which of the eight boxes any ray may meet up to `farthest`, and where the first may enter them.
    ///
    /// With all signs known the distance to a plane, `(plane − o)·i`, is monotonic in `o` and in `i`, rounding included, so
    /// that its extremes lie at the ends of the intervals.
    #[inline(always)]
    fn meet<L: Lanes>(&self, node: &Node, farthest: f64, near: &mut [f64; node::WIDTH]) -> u32 {
        let mut met = 0;
        for start in (0..node::WIDTH).step_by(L::WIDTH) {
            let (mut enter, mut leave) = (L::splat(0.0), L::splat(farthest));
            for axis in 0..3 {
                let side = self.side[axis] & 1;
                let (i_low, i_high) = (L::splat(self.inv_dir[axis][0]), L::splat(self.inv_dir[axis][1]));
                // The origin that is farthest along reaches a plane first.
                let (first, last) = (L::splat(self.origin[axis][1 - side]), L::splat(self.origin[axis][side]));
                let to_near = node.plane::<L>(axis, side, start) - first;
                let to_far = node.plane::<L>(axis, 1 - side, start) - last;
                enter = (to_near * i_low).min(to_near * i_high).max(enter);
                leave = (to_far * i_low).max(to_far * i_high).min(leave);
            }
            enter.store(&mut near[start..]);
            met |= enter.le(leave).bits() << start;
        }
        met
    }
}

impl Bvh {
    /// Finds the closest hit of each of these rays, or with `ANY` just some hit, and says which rays have one.
    #[inline(always)]
    pub(crate) fn intersect<L: Lanes, const ANY: bool>(&self, packet: &mut Packet, mut rays: u64) -> u64 {
        if self.nodes.is_empty() {
            return 0;
        }
        let mut hit = 0;
        while rays != 0 {
            let first = rays.trailing_zeros();
            let (mut alike, mut side, mut main) = (rays, [0; 3], 2);
            for axis in 0..3 {
                let negative = packet.negative[axis] >> first & 1 == 1;
                side[axis] = usize::from(negative);
                alike &= if negative { packet.negative[axis] } else { !packet.negative[axis] };
                if packet.main[axis] >> first & 1 == 1 {
                    main = axis;
                }
            }
            alike &= packet.main[main];
            // A direction without any sense has no main axis.
            alike |= 1 << first;
            rays &= !alike;
            hit |= self.descend::<L, ANY>(packet, alike, side, main);
        }
        hit
    }

    /// Takes rays that go the same way down the tree together.
    #[inline(always)]
    fn descend<L: Lanes, const ANY: bool>(&self, packet: &mut Packet, all: u64, side: [usize; 3], main: usize) -> u64 {
        let beam = Beam::new::<L>(packet, all, side);
        let mut farthest = packet.farthest::<L>(all);
        let mut near = [0.0; node::WIDTH];
        let (mut hit, mut rays, mut child) = (0, all, Child::ROOT);
        packet.waiting.clear();
        loop {
            let number = child.number();
            let alone = match number {
                Ok(leaf) => alone::<L>(self.primitives.leaves[leaf], rays),
                Err(_) => rays.count_ones() <= FEW,
            };
            let before = hit;
            if alone {
                let mut each = rays;
                while each != 0 {
                    let i = each.trailing_zeros() as usize & (SIZE - 1);
                    each &= each - 1;
                    let mut ray = packet.single(i, main, side);
                    let mut waiting = std::mem::take(&mut packet.waiting_single);
                    let blocked = self.follow::<L, ANY>(&mut ray, child, &mut waiting);
                    packet.waiting_single = waiting;
                    if ANY {
                        hit |= u64::from(blocked) << i;
                    } else {
                        hit |= u64::from(ray.t < packet.t[i] || ray.primitive >= 0.0) << i;
                        (packet.t[i], packet.primitive[i]) = (ray.t, ray.primitive);
                    }
                }
                if !ANY {
                    farthest = packet.farthest::<L>(all);
                }
            } else {
                match number {
                    Ok(leaf) => {
                        hit |= self.test_leaf::<L, ANY>(self.primitives.leaves[leaf], packet, rays, main);
                        if !ANY {
                            farthest = packet.farthest::<L>(all);
                        }
                    }
                    Err(number) => {
                        let mut met = beam.meet::<L>(&self.nodes[number], farthest, &mut near);
                        let first = packet.waiting.len();
                        while met != 0 {
                            let slot = met.trailing_zeros() & 7;
                            met &= met - 1;
                            packet.waiting.push(BeamWaiting {
                                t: near[slot as usize],
                                rays,
                                node: number as u32,
                                slot,
                            });
                        }
                        farthest_first(&mut packet.waiting[first..]);
                    }
                }
            }
            if ANY && hit != before && hit == all {
                return hit;
            }
            (rays, child) = loop {
                let Some(next) = packet.waiting.pop() else { return hit };
                if next.t > farthest {
                    continue;
                }
                let open = if ANY { next.rays & !hit } else { next.rays };
                let node = &self.nodes[next.node as usize];
                let met = enter::<L>(packet, node, next.slot as usize & 7, open, side);
                if met != 0 {
                    break (met, node.child[next.slot as usize & 7]);
                }
            };
        }
    }

    /// Tests the primitives of a leaf one after the other against the rays in lanes.
    #[inline(always)]
    fn test_leaf<L: Lanes, const ANY: bool>(&self, leaf: Leaf, packet: &mut Packet, rays: u64, main: usize) -> u64 {
        let (spheres, triangles) = (usize::from(leaf.spheres), usize::from(leaf.triangles));
        let numbers = &self.primitives.numbers[leaf.at as usize..];
        let ids = &self.primitives.ids[leaf.first as usize..][..spheres + triangles];
        let mut hit = 0;
        let k = axes(main);
        for (start, active) in groups::<L>(rays) {
            let mut nearest = Nearest::<L>::load(packet, start, active);
            if spheres > 0 {
                let origin = Packet::vector(&packet.origin, start, [0, 1, 2]);
                let dir = Packet::vector(&packet.dir, start, [0, 1, 2]);
                for i in 0..spheres {
                    let center = vector(numbers, spheres, i, [0, 1, 2]);
                    let radius = L::splat(numbers[3 * spheres + i]);
                    let (t, meets) = sphere::intersect(origin, dir, center, radius);
                    nearest.keep(t, meets, ids[i]);
                }
            }
            if triangles > 0 {
                let origin = Packet::vector(&packet.origin, start, k);
                let (x, y) = (L::load(&packet.shear[0][start..]), L::load(&packet.shear[1][start..]));
                let shear = Shear(Vec3::new(x, y, L::load(&packet.inv_dir[k[2]][start..])));
                let numbers = &numbers[4 * spheres..];
                for i in 0..triangles {
                    let a = vector(numbers, triangles, i, k);
                    let b = vector(numbers, triangles, i, [k[0] + 3, k[1] + 3, k[2] + 3]);
                    let c = vector(numbers, triangles, i, [k[0] + 6, k[1] + 6, k[2] + 6]);
                    let found = triangle::intersect(origin, &shear, [a, b, c]);
                    nearest.keep(found.t, found.meets, ids[spheres + i]);
                }
            }
            hit |= u64::from(nearest.hit.bits()) << start;
            nearest.t.store(&mut packet.t[start..]);
            nearest.primitive.store(&mut packet.primitive[start..]);
        }
        hit
    }
}

/// Is it cheaper to test the primitives of a leaf against one ray after the other than against the rays in lanes?
#[inline(always)]
fn alone<L: Lanes>(leaf: Leaf, rays: u64) -> bool {
    let (spheres, triangles) = (u32::from(leaf.spheres), u32::from(leaf.triangles));
    let width = L::WIDTH as u32;
    let single = rays.count_ones() * (spheres.div_ceil(width) + triangles.div_ceil(width));
    single <= groups::<L>(rays).count() as u32 * (spheres + triangles)
}

/// Three numbers of one primitive, from these columns of a leaf, in every lane.
#[inline(always)]
fn vector<L: Lanes>(numbers: &[f64], stride: usize, i: usize, columns: [usize; 3]) -> Vec3<L> {
    let [x, y, z] = columns;
    Vec3::new(numbers[x * stride + i], numbers[y * stride + i], numbers[z * stride + i]).splat()
}

/// The nearest hits of some rays while a leaf is tested.
struct Nearest<L: Lanes> {
    active: L::Mask,
    t_min: L,
    source: L,
    t: L,
    primitive: L,
    hit: L::Mask,
}

impl<L: Lanes> Nearest<L> {
    #[inline(always)]
    fn load(packet: &Packet, start: usize, active: L::Mask) -> Self {
        Self {
            active,
            t_min: L::load(&packet.t_min[start..]),
            source: L::load(&packet.source[start..]),
            t: L::load(&packet.t[start..]),
            primitive: L::load(&packet.primitive[start..]),
            hit: L::Mask::from_bits(0),
        }
    }

    /// Keeps a hit where it is nearer; at equal distance that of the lower id.
    #[inline(always)]
    fn keep(&mut self, t: L, meets: L::Mask, id: u32) {
        let meets = meets & self.active;
        if !meets.any() {
            return;
        }
        let id = L::splat(f64::from(id));
        let closer = t.lt(self.t) | (t.eq(self.t) & id.lt(self.primitive));
        let kept = meets & t.gt(self.t_min) & closer & !self.source.eq(id);
        self.hit = self.hit | kept;
        self.t = L::select(kept, t, self.t);
        self.primitive = L::select(kept, id, self.primitive);
    }
}

/// The extremes over all lanes.
#[inline(always)]
fn over_lanes<L: Lanes>([low, high]: [L; 2]) -> [f64; 2] {
    let mut ends = [f64::INFINITY, f64::NEG_INFINITY];
    for lane in 0..L::WIDTH {
        ends = [ends[0].min(low.lane(lane)), ends[1].max(high.lane(lane))];
    }
    ends
}

/// Which of these rays meet one box of a node.
#[inline(always)]
fn enter<L: Lanes>(packet: &Packet, node: &Node, slot: usize, rays: u64, side: [usize; 3]) -> u64 {
    let mut met = 0;
    for (start, active) in groups::<L>(rays) {
        let (mut enter, mut leave) = (L::load(&packet.t_min[start..]), L::load(&packet.t[start..]));
        for axis in 0..3 {
            let side = side[axis] & 1;
            let near = L::splat(f64::from(node.planes[2 * axis + side][slot]));
            let far = L::splat(f64::from(node.planes[2 * axis + 1 - side][slot]));
            let (o, i) = (L::load(&packet.origin[axis][start..]), L::load(&packet.inv_dir[axis][start..]));
            enter = ((near - o) * i).max(enter);
            leave = ((far - o) * i).min(leave);
        }
        met |= u64::from((active & enter.le(leave)).bits()) << start;
    }
    met
}

/// Insertion sort: few, and nearly in order.
#[inline(always)]
fn farthest_first(waiting: &mut [BeamWaiting]) {
    for i in 1..waiting.len() {
        let mut at = i;
        while at > 0 && waiting[at - 1].t < waiting[at].t {
            waiting.swap(at - 1, at);
            at -= 1;
        }
    }
}
