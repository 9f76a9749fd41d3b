//! One ray through the tree: the boxes of a node, or the primitives of a leaf, in lanes.

use super::Bvh;
use super::node::MOST_WAITING;
use super::node::{Block, Child, Node, WIDTH, plane};
use super::packet::{Octant, Packet};
use super::primitives::{INSTANCES, RunOf};
use crate::geometry::shape::{ForKind, Kind, Neighbours, Query, of_common_kind, of_kind};
use crate::lanes::{Kernel, Lanes, Mask};
use alloc::boxed::Box;
use core::marker::PhantomData;

/// So many rays are on their way at the same time.
const WALKERS: usize = 8;

/// The walkers of a packet, made when they are first needed.
pub type Walkers = Option<Box<[Walker; WALKERS]>>;

/// A ray on its way through the tree alone.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub struct Walker {
    /// Which one of its packet.
    ray: usize,
    octant: Octant,
    origin: [f64; 3],
    inv_dir: [f64; 3],
    t_min: f64,
    /// What it visits next.
    child: Child,
    waiting: Stack,
}

/// Boxes that wait for a ray, the next one last.
#[derive(Clone, Debug)]
struct Stack {
    /// So many are waiting.
    count: usize,
    /// Where each is entered.
    t: [f64; ROOM],
    child: [Child; ROOM],
}

/// Room for the end and what waits, and for a node at the deepest place, which is written as a whole group of eight.
const ROOM: usize = 1 + MOST_WAITING + WIDTH;

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
        walkers: &mut Walkers,
    ) -> u64 {
        let walkers = walkers.get_or_insert_with(|| Box::new([(); WALKERS].map(|()| Walker::default())));
        let mut next_ray = || {
            let ray = (rays != 0).then_some(rays.trailing_zeros() as usize & 63);
            rays &= rays.wrapping_sub(1);
            ray
        };
        // Those that are on their way.
        let (mut walking, mut count) = ([0; WALKERS], 0);
        while count < WALKERS
            && let Some(ray) = next_ray()
        {
            walkers[count].start(packet, ray, from);
            walking[count] = count;
            count += 1;
        }
        let (mut hit, mut turn) = (0, 0);
        while count > 0 {
            let walker = &mut walkers[walking[turn] & (WALKERS - 1)];
            // Asked a turn after it was decided: a wrong guess costs nothing but itself, as the answer has long been there.
            if walker.child == Child::NOTHING {
                let Some(ray) = next_ray() else {
                    // Whoever takes its place makes the next step.
                    count -= 1;
                    walking[turn] = walking[count];
                    turn = if turn >= count { 0 } else { turn };
                    continue;
                };
                walker.start(packet, ray, from);
            }
            let ray = walker.ray & 63;
            if walker.child.is_node() {
                walker.open::<L>(&self.nodes[walker.child.number()], packet.t[ray].max(0.0));
            } else if self.test_alone::<L, ANY>(packet, ray, &walker.octant, walker.child.place()) {
                hit |= 1 << ray;
                if ANY {
                    walker.waiting.clear();
                }
            }
            // Hits found meanwhile may have closed boxes.
            walker.child = walker.waiting.pop(packet.t[ray].max(0.0));
            self.prefetch(walker.child);
            turn += 1;
            turn = if turn >= count { 0 } else { turn };
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
        let run = self.primitives.first(block);
        if run.is_common() {
            return of_common_kind(run.kind, TestRun::<L> { packet, ray, octant, run, lanes: PhantomData });
        }
        L::call(TestRuns::<ANY> { tree: self, packet, ray, octant, run })
    }
}

/// Tests one ray against all runs of a leaf, from the first one on.
struct TestRuns<'a, const ANY: bool> {
    tree: &'a Bvh,
    packet: &'a mut Packet,
    ray: usize,
    octant: &'a Octant,
    run: RunOf<'a>,
}

impl<const ANY: bool> Kernel for TestRuns<'_, ANY> {
    type Output = bool;
    #[inline(always)]
    fn run<L: Lanes>(self) -> bool {
        let Self { tree, packet, ray, octant, mut run } = self;
        let mut found = false;
        loop {
            if run.kind != INSTANCES {
                found |= of_kind(run.kind, TestRun::<L> { packet, ray, octant, run, lanes: PhantomData });
            } else if !(ANY && found) {
                found |= tree.visit_each::<L, ANY>(packet, 1 << ray, run.ids()) != 0;
            }
            let Some(next) = run.next() else { return found };
            run = next;
        }
    }
}

/// Tests one ray against the primitives of a run in lanes.
struct TestRun<'a, L> {
    packet: &'a mut Packet,
    ray: usize,
    octant: &'a Octant,
    run: RunOf<'a>,
    lanes: PhantomData<L>,
}

impl<L: Lanes> ForKind for TestRun<'_, L> {
    type Output = bool;
    #[inline(always)]
    fn run<S: Kind>(self) -> bool {
        let Self { packet, ray: number, octant, run: RunOf { count, numbers, .. }, .. } = self;
        let ray = packet.ray::<S, L>(number, octant);
        let two_sided = packet.two_sided;
        let mut found = false;
        for start in (0..count).step_by(L::WIDTH) {
            let ids = &numbers[S::NUMBERS * count + start..];
            let leaves = L::load(ids).eq(L::splat(packet.source[number]));
            let query = Query { two_sided, t_min: L::splat(packet.t_min[number]), leaves };
            let shapes = Neighbours { numbers: &numbers[start..], stride: count };
            let (t, mut meets) = S::intersect(&ray, shapes, &query);
            if !S::may_return(two_sided) {
                meets = meets & !leaves;
            }
            found |= keep::<L>(packet, number, t, meets & L::Mask::first(count - start), ids);
        }
        found
    }
}

impl Default for Walker {
    fn default() -> Self {
        Self {
            ray: 0,
            octant: Octant::default(),
            origin: [0.0; 3],
            inv_dir: [0.0; 3],
            t_min: 0.0,
            child: Child::NOTHING,
            waiting: Stack { count: 0, t: [0.0; ROOM], child: [Child::NOTHING; ROOM] },
        }
    }
}

impl Walker {
    #[inline(always)]
    fn start(&mut self, packet: &Packet, ray: usize, from: Child) {
        (self.ray, self.octant, self.child) = (ray, packet.octant(ray), from);
        for axis in 0..3 {
            (self.origin[axis], self.inv_dir[axis]) = (packet.origin[axis][ray], packet.inv_dir[axis][ray]);
        }
        // Boxes begin at 0: they hold what is hit a little behind an origin, too, and a hit there closes none of them.
        self.t_min = packet.t_min[ray].max(0.0);
        self.waiting.clear();
    }

    /// Lets the boxes of a node wait that the ray meets up to `limit`.
    ///
    /// The slab test of Kay and Kajiya (1986) in `f64` on the widened corners.
    #[inline(always)]
    fn open<L: Lanes>(&mut self, node: &Node, limit: f64) {
        let (mut met, mut near) = (0, [0.0; WIDTH]);
        for start in (0..WIDTH).step_by(L::WIDTH) {
            let (mut enter, mut leave) = (L::splat(self.t_min), L::splat(limit));
            for axis in 0..3 {
                let (o, i) = (L::splat(self.origin[axis]), L::splat(self.inv_dir[axis]));
                let first = plane(axis, self.octant.side[axis] & 1);
                enter = ((L::load_f32(&node.planes[first][start..]) - o) * i).max(enter);
                leave = ((L::load_f32(&node.planes[first ^ 1][start..]) - o) * i).min(leave);
            }
            enter.store(&mut near[start..]);
            met |= enter.le(leave).bits() << start;
        }
        self.waiting.push::<L>(met, &near, &node.child);
    }
}

impl Stack {
    /// Forgets all but the end, which is reached at any distance.
    #[inline(always)]
    fn clear(&mut self) {
        (self.t[0], self.child[0], self.count) = (f64::NEG_INFINITY, Child::NOTHING, 1);
    }

    /// Appends the boxes of a node that are met, the nearest last.
    #[inline(always)]
    fn push<L: Lanes>(&mut self, met: u32, near: &[f64; WIDTH], child: &[Child; WIDTH]) {
        let (t, children) = (&mut self.t[self.count..], &mut self.child[self.count..]);
        if let (Some(t), Some(children)) = (t.first_chunk_mut(), children.first_chunk_mut::<WIDTH>()) {
            L::sort_descending(met, near, bytemuck::must_cast_ref(child), (t, bytemuck::must_cast_mut(children)));
            self.count += met.count_ones() as usize;
        }
    }

    /// The next box that is not entered beyond `limit`, at last the end, also if `limit` is NaN.
    #[inline(always)]
    fn pop(&mut self, limit: f64) -> Child {
        loop {
            self.count -= 1;
            let beyond = self.t[self.count] > limit;
            if !beyond {
                return self.child[self.count];
            }
        }
    }
}

/// Keeps the nearest of some hits; at equal distance that of the lower id.
#[inline(always)]
fn keep<L: Lanes>(packet: &mut Packet, ray: usize, t: L, meets: L::Mask, ids: &[f64]) -> bool {
    let mut bits = (meets & t.gt(L::splat(packet.t_min[ray])) & t.le(L::splat(packet.t[ray]))).bits();
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
