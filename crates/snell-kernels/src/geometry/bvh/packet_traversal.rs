//! The rays of a packet through the tree together, as long as they go the same way.
//!
//! Rays of one tile, or of neighbouring hits towards one light, meet nearly the same boxes. Those of a packet that go into
//! the same octant along the same main axis descend together: the eight boxes of a node are first tested against the
//! whole beam by interval arithmetic, then each that may be met against the rays in lanes, which says who goes on. Where few
//! are left, each goes its own way ([`follow`](Bvh::follow)). After Wald, Benthin and Boulos, *Getting Rid of
//! Packets*, 2008; Benthin et al., *Combining Single and Packet-Ray Tracing for Arbitrary Ray Distributions*, 2012.

use super::Bvh;
use super::nearest::Nearest;
use super::node::{self, Block, Child, Kind, Node, plane};
use super::packet::{Octant, Packet, SIZE, groups};
use super::primitives::{INSTANCES, RunOf};
use crate::geometry::shape::{self, ForKind, One, of_common_kind, of_kind};
use crate::lanes::{Kernel, Lanes, Mask};
use core::marker::PhantomData;

/// So few rays of a packet are not worth a beam: they go alone from the root.
const ALIKE: u32 = 16;

/// So few rays of a beam go on alone.
const FEW: u32 = 8;

/// A box that some rays of a packet may enter, at `t` or later.
#[derive(Clone, Copy, Debug)]
pub struct BeamWaiting {
    t: f64,
    rays: u64,
    node: u32,
    slot: u32,
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
            let [low, high] = bounds[axis];
            beam.origin[axis] = [-(-low).largest(), high.largest()];
            let [low, high] = bounds[axis + 3];
            beam.inv_dir[axis] = [-(-low).largest(), high.largest()];
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
                let (side, first_plane) = (self.side[axis] & 1, plane(axis, self.side[axis] & 1));
                let (i_low, i_high) = (L::splat(self.inv_dir[axis][0]), L::splat(self.inv_dir[axis][1]));
                // The origin that is farthest along reaches a plane first.
                let (first, last) = (L::splat(self.origin[axis][1 - side]), L::splat(self.origin[axis][side]));
                let to_near = L::load_f32(&node.planes[first_plane][start..]) - first;
                let to_far = L::load_f32(&node.planes[first_plane ^ 1][start..]) - last;
                enter = (to_near * i_low).min(to_near * i_high).max(enter);
                leave = (to_far * i_low).max(to_far * i_high).min(leave);
            }
            enter.store(&mut near[start..]);
            met |= enter.le(leave).bits() << start;
        }
        met
    }
}

/// A function of its own, as a tree calls it for the trees within it.
struct Intersect<'a, const ANY: bool> {
    tree: &'a Bvh,
    packet: &'a mut Packet,
    rays: u64,
}

impl<const ANY: bool> Kernel for Intersect<'_, ANY> {
    type Output = u64;
    #[inline(always)]
    fn run<L: Lanes>(self) -> u64 {
        self.tree.intersect_here::<L, ANY>(self.packet, self.rays)
    }
}

impl Bvh {
    /// Finds the closest hit of each of these rays, or with `ANY` just some hit, and says which rays have one.
    #[inline(always)]
    pub fn intersect<L: Lanes, const ANY: bool>(&self, packet: &mut Packet, rays: u64) -> u64 {
        L::call(Intersect::<ANY> { tree: self, packet, rays })
    }

    #[inline(always)]
    fn intersect_here<L: Lanes, const ANY: bool>(&self, packet: &mut Packet, mut rays: u64) -> u64 {
        if self.nodes.is_empty() {
            return 0;
        }
        let (mut hit, mut loners) = (0, 0);
        while rays != 0 {
            let first = rays.trailing_zeros() as usize & (SIZE - 1);
            let octant = packet.octant(first);
            let mut alike = rays & packet.main[octant.axes[2]];
            for axis in 0..3 {
                let negative = packet.negative[axis];
                alike &= if octant.side[axis] == 1 { negative } else { !negative };
            }
            // The first is always like itself; said again, so that the loop surely ends.
            alike |= 1 << first;
            rays &= !alike;
            if alike.count_ones() <= ALIKE {
                loners |= alike;
            } else {
                hit |= self.descend::<L, ANY>(packet, alike, &octant);
            }
        }
        if loners != 0 {
            hit |= self.follow_each::<L, ANY>(packet, loners, Child::ROOT);
        }
        hit
    }

    /// Takes rays that go the same way down the tree together.
    #[inline(always)]
    fn descend<L: Lanes, const ANY: bool>(&self, packet: &mut Packet, all: u64, octant: &Octant) -> u64 {
        // A single node has nothing to leave out.
        let beam = (self.nodes.len() > 1).then(|| Beam::new::<L>(packet, all, octant.side));
        let mut farthest = packet.farthest::<L>(all);
        let mut near = [0.0; node::WIDTH];
        let (mut t, mut slots) = ([0.0; node::WIDTH], [0; node::WIDTH]);
        let (mut hit, mut rays, mut child) = (0, all, Child::ROOT);
        packet.waiting.clear();
        loop {
            let mut found = 0;
            match child.kind() {
                Kind::Nothing | Kind::Leaf(_) => {}
                Kind::Block(block) if self.alone::<L>(block, rays) => {
                    found = self.test_each::<L, ANY>(packet, rays, octant, block);
                }
                Kind::Block(block) => found = self.test_together::<L, ANY>(packet, rays, octant, block),
                Kind::Node(_) if rays.count_ones() <= FEW => {
                    found = self.follow_each::<L, ANY>(packet, rays, child);
                }
                Kind::Node(number) => {
                    let node = &self.nodes[number as usize];
                    let met = match &beam {
                        Some(beam) => beam.meet::<L>(node, farthest, &mut near),
                        None => node.used(),
                    };
                    L::sort_descending(met, &near, &[0, 1, 2, 3, 4, 5, 6, 7], (&mut t, &mut slots));
                    for (&t, &slot) in t.iter().zip(&slots).take(met.count_ones() as usize) {
                        self.prefetch(node.child[slot as usize & 7]);
                        packet.waiting.push(BeamWaiting { t, rays, node: number, slot: slot as u32 });
                    }
                }
            }
            hit |= found;
            if ANY && hit == all {
                return hit;
            }
            if !ANY && found != 0 {
                farthest = packet.farthest::<L>(all);
            }
            (rays, child) = loop {
                let Some(next) = packet.waiting.pop() else { return hit };
                if next.t > farthest {
                    continue;
                }
                let open = if ANY { next.rays & !hit } else { next.rays };
                let node = &self.nodes[next.node as usize];
                let met = enter::<L>(packet, node, next.slot as usize & 7, open, octant.side);
                if met != 0 {
                    break (met, node.child[next.slot as usize & 7]);
                }
            };
        }
    }

    /// Lets some rays go on alone from a node.
    #[inline(always)]
    fn follow_each<L: Lanes, const ANY: bool>(&self, packet: &mut Packet, rays: u64, from: Child) -> u64 {
        let mut walkers = core::mem::take(&mut packet.walkers);
        let hit = self.follow::<L, ANY>(packet, rays, from, &mut walkers);
        packet.walkers = walkers;
        hit
    }

    /// Tests the primitives of a leaf, in lanes, against one ray after the other.
    #[inline(always)]
    fn test_each<L: Lanes, const ANY: bool>(
        &self,
        packet: &mut Packet,
        mut rays: u64,
        octant: &Octant,
        block: Block,
    ) -> u64 {
        let mut hit = 0;
        while rays != 0 {
            let ray = rays.trailing_zeros() as usize & (SIZE - 1);
            rays &= rays - 1;
            hit |= u64::from(self.test_alone::<L, ANY>(packet, ray, octant, block)) << ray;
        }
        hit
    }

    /// Tests the primitives of a leaf one after the other against the rays in lanes.
    #[inline(always)]
    fn test_together<L: Lanes, const ANY: bool>(
        &self,
        packet: &mut Packet,
        rays: u64,
        octant: &Octant,
        block: Block,
    ) -> u64 {
        let run = self.primitives.first(block);
        if run.is_common() {
            return of_common_kind(run.kind, TestRun::<L> { packet, rays, octant, run, lanes: PhantomData });
        }
        L::call(TestRuns::<ANY> { tree: self, packet, rays, octant, run })
    }

    /// Is it cheaper to test the primitives of a leaf against one ray after the other than against the rays in lanes?
    #[inline(always)]
    fn alone<L: Lanes>(&self, block: Block, rays: u64) -> bool {
        let (mut one_by_one, mut together, mut run) = (0, 0, self.primitives.first(block));
        loop {
            if run.kind == INSTANCES {
                return false;
            }
            one_by_one += run.count.div_ceil(L::WIDTH);
            together += run.count;
            let Some(next) = run.next() else { break };
            run = next;
        }
        rays.count_ones() as usize * one_by_one <= groups::<L>(rays).count() * together
    }
}

/// Tests the primitives of all runs of a leaf, from the first one on.
struct TestRuns<'a, const ANY: bool> {
    tree: &'a Bvh,
    packet: &'a mut Packet,
    rays: u64,
    octant: &'a Octant,
    run: RunOf<'a>,
}

impl<const ANY: bool> Kernel for TestRuns<'_, ANY> {
    type Output = u64;
    #[inline(always)]
    fn run<L: Lanes>(self) -> u64 {
        let Self { tree, packet, rays, octant, mut run } = self;
        let mut hit = 0;
        loop {
            if run.kind == INSTANCES {
                let open = if ANY { rays & !hit } else { rays };
                hit |= tree.visit_each::<L, ANY>(packet, open, run.ids());
            } else {
                hit |= of_kind(run.kind, TestRun::<L> { packet, rays, octant, run, lanes: PhantomData });
            }
            let Some(next) = run.next() else { return hit };
            run = next;
        }
    }
}

/// Tests the primitives of a run, one after the other, against the rays in lanes.
struct TestRun<'a, L> {
    packet: &'a mut Packet,
    rays: u64,
    octant: &'a Octant,
    run: RunOf<'a>,
    lanes: PhantomData<L>,
}

impl<L: Lanes> ForKind for TestRun<'_, L> {
    type Output = u64;
    #[inline(always)]
    fn run<S: shape::Kind>(self) -> u64 {
        let Self { packet, rays, octant, run: RunOf { count, numbers, .. }, .. } = self;
        let mut hit = 0;
        for (start, active) in groups::<L>(rays) {
            let mut nearest = Nearest::<L>::load(packet, start, active);
            let ray = packet.rays::<S, L>(start, octant);
            for place in 0..count {
                let id = numbers[S::NUMBERS * count + place];
                nearest.offer::<S>(packet.two_sided, &ray, One { numbers, stride: count, place }, id);
            }
            hit |= u64::from(nearest.hit.bits()) << start;
            nearest.t.store(&mut packet.t[start..]);
            nearest.primitive.store(&mut packet.primitive[start..]);
        }
        hit
    }
}

/// Which of these rays meet one box of a node.
#[inline(always)]
fn enter<L: Lanes>(packet: &Packet, node: &Node, slot: usize, rays: u64, side: [usize; 3]) -> u64 {
    let mut met = 0;
    for (start, active) in groups::<L>(rays) {
        let (mut enter, mut leave) = (L::load(&packet.t_min[start..]), L::load(&packet.t[start..]));
        for axis in 0..3 {
            let first = plane(axis, side[axis] & 1);
            let near = L::splat(f64::from(node.planes[first][slot]));
            let far = L::splat(f64::from(node.planes[first ^ 1][slot]));
            let (o, i) = (L::load(&packet.origin[axis][start..]), L::load(&packet.inv_dir[axis][start..]));
            enter = ((near - o) * i).max(enter);
            leave = ((far - o) * i).min(leave);
        }
        met |= u64::from((active & enter.le(leave)).bits()) << start;
    }
    met
}
