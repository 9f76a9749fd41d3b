//! The rays of a generation: those of a queue, as columns.

use super::Propagation;
use super::carried::Carried;
use crate::geometry::bvh::{PACKET, Packet};
use crate::geometry::{Sphere, Vec3};
use crate::lanes::{Lanes, Mask, Number, Record, Row, Table, index, table};
use alloc::vec::Vec;
use core::ops::Range;

/// Where a ray comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayKind {
    /// From the eye.
    Camera,
    /// From a mirror.
    Mirror,
    /// From the far side of something transparent.
    Refracted,
}

table! {
    /// What there is of every ray.
    Ray,
    /// The same in columns.
    Rays {
        origin: Vec3,
        /// Of unit length.
        dir: Vec3,
        /// The primitive that the ray leaves, −1 for none.
        source: Number,
        /// Row of the parent ray in the generation before.
        parent: Number,
        /// Number of the pixel within the tile.
        pixel: Number,
    }
}

/// Rays that leave a surface, in lanes.
#[derive(Clone, Copy, Debug)]
pub struct Outgoing<L: Lanes, P: Propagation> {
    /// Its line and the primitive that it leaves.
    pub ray: Ray<L>,
    /// What the propagation has of it.
    pub travel: Row<P::Travel, L>,
}

/// The rays of a generation, in a fixed order.
pub trait Generation<P: Propagation> {
    fn len(&self) -> usize;
    /// How many camera, mirror and refracted rays; they stand in this order.
    fn counts(&self) -> [usize; 3];
    /// Origins and directions from a row on, one in each lane; behind the last row they are of no meaning.
    fn lines<L: Lanes>(&self, start: usize) -> (Vec3<L>, Vec3<L>);
    /// The primitives that these rays leave.
    fn sources<L: Lanes>(&self, start: usize) -> L;
    /// Rows of their parents in the generation before.
    fn parents<L: Lanes>(&self, start: usize) -> L;
    /// Their pixels, within the tile.
    fn pixels<L: Lanes>(&self, start: usize) -> L;
    /// What they have for their propagation.
    fn travel<L: Lanes>(&self, start: usize) -> Row<P::Travel, L>;
    /// What they carry.
    fn carried<L: Lanes, T: Record>(&self, start: usize) -> Row<T, L>;
    /// Appends what those carry, from a row on, that the mask names.
    fn copy_carried<L: Lanes>(&self, mask: L::Mask, start: usize, to: &mut Carried);
    /// Can any of the rays meet this sphere? Where it is not known, yes.
    fn may_meet(&self, _sphere: &Sphere) -> bool {
        true
    }

    /// Puts up to 64 rays from a row on into a packet, and says which places they take.
    #[inline(always)]
    fn fill<L: Lanes>(&self, packet: &mut Packet, first: usize, shear: bool) -> u64 {
        let count = (self.len() - first).min(PACKET);
        let (t_min, t_max) = (L::splat(P::T_MIN), L::splat(f64::INFINITY));
        for start in (0..count).step_by(L::WIDTH) {
            let (origin, dir) = self.lines::<L>(first + start);
            packet.set(start, origin, dir, t_min, t_max, self.sources(first + start), shear);
        }
        u64::MAX >> (PACKET - count)
    }

    fn kind(&self, row: usize) -> RayKind {
        let [camera, mirror, _] = self.counts();
        if row < camera {
            RayKind::Camera
        } else if row < camera + mirror {
            RayKind::Mirror
        } else {
            RayKind::Refracted
        }
    }
}

/// Mirror rays, and behind them refracted ones.
#[derive(Debug)]
pub struct RayQueue<P: Propagation> {
    rays: Rays,
    travel: P::Travel,
    carried: Carried,
    /// How many mirror rays stand in front.
    mirror: usize,
}

impl<P: Propagation> Default for RayQueue<P> {
    fn default() -> Self {
        Self { rays: Rays::default(), travel: P::Travel::default(), carried: Carried::default(), mirror: 0 }
    }
}

impl<P: Propagation> RayQueue<P> {
    #[inline(always)]
    pub fn clear(&mut self) {
        self.rays.clear();
        self.travel.clear();
        self.carried.clear();
        self.mirror = 0;
    }

    /// Appends the mirror or refracted rays that the mask names, mirror rays first, and what they carry.
    #[inline(always)]
    pub fn push<L: Lanes, T: Record>(
        &mut self,
        kind: RayKind,
        mask: L::Mask,
        rays: &Outgoing<L, P>,
        carried: &Row<T, L>,
    ) {
        if !mask.any() {
            return;
        }
        let before = self.len();
        self.rays.push(mask, &rays.ray);
        self.travel.push(mask, &rays.travel);
        self.carried.push::<L, T>(mask, carried);
        if kind == RayKind::Mirror {
            self.mirror += self.len() - before;
        }
    }

    /// Appends neighbouring rays of another queue, which must not be of an earlier kind.
    #[inline(always)]
    pub fn copy_rows(&mut self, other: &Self, rows: Range<usize>) {
        if rows.is_empty() {
            return;
        }
        self.rays.copy_rows(&other.rays, rows.clone());
        self.travel.copy_rows(&other.travel, rows.clone());
        self.carried.copy_rows(&other.carried, rows.clone());
        self.mirror += rows.end.min(other.mirror) - rows.start.min(other.mirror);
    }

    /// Appends all rays of another queue, which must not be of an earlier kind.
    #[inline(always)]
    pub fn append(&mut self, other: &Self) {
        self.copy_rows(other, 0..other.len());
    }

    /// The pixel of a ray, within the tile.
    #[inline(always)]
    pub fn pixel(&self, row: usize) -> usize {
        index(self.rays.pixel::<f64>(row))
    }
}

impl<P: Propagation> Generation<P> for RayQueue<P> {
    #[inline(always)]
    fn len(&self) -> usize {
        self.rays.len()
    }

    #[inline(always)]
    fn counts(&self) -> [usize; 3] {
        [0, self.mirror, self.len() - self.mirror]
    }

    #[inline(always)]
    fn lines<L: Lanes>(&self, start: usize) -> (Vec3<L>, Vec3<L>) {
        (self.rays.origin(start), self.rays.dir(start))
    }

    #[inline(always)]
    fn sources<L: Lanes>(&self, start: usize) -> L {
        self.rays.source(start)
    }

    #[inline(always)]
    fn parents<L: Lanes>(&self, start: usize) -> L {
        self.rays.parent(start)
    }

    #[inline(always)]
    fn pixels<L: Lanes>(&self, start: usize) -> L {
        self.rays.pixel(start)
    }

    #[inline(always)]
    fn travel<L: Lanes>(&self, start: usize) -> Row<P::Travel, L> {
        self.travel.rows(start)
    }

    #[inline(always)]
    fn carried<L: Lanes, T: Record>(&self, start: usize) -> Row<T, L> {
        self.carried.rows::<L, T>(start)
    }

    #[inline(always)]
    fn copy_carried<L: Lanes>(&self, mask: L::Mask, start: usize, to: &mut Carried) {
        to.push_rows::<L>(mask, &self.carried, start);
    }
}

/// The rays that leave the hits of a generation, on their way into a queue.
#[derive(Debug)]
pub struct Children<P: Propagation> {
    mirror: RayQueue<P>,
    refracted: RayQueue<P>,
    /// Refracted rays of white ones that have split, by bands; none where nothing disperses.
    bands: Vec<RayQueue<P>>,
}

impl<P: Propagation> Children<P> {
    /// For light that splits into so many bands.
    pub fn new(bands: usize) -> Self {
        let bands = (0..bands).map(|_| RayQueue::default()).collect();
        Self { mirror: RayQueue::default(), refracted: RayQueue::default(), bands }
    }

    /// Appends the rays of a kind that the mask names.
    #[inline(always)]
    pub fn push<L: Lanes, T: Record>(
        &mut self,
        kind: RayKind,
        mask: L::Mask,
        rays: &Outgoing<L, P>,
        carried: &Row<T, L>,
    ) {
        let queue = if kind == RayKind::Mirror { &mut self.mirror } else { &mut self.refracted };
        queue.push::<L, T>(kind, mask, rays, carried);
    }

    /// Into how many bands light may split; 0 where nothing disperses.
    #[inline(always)]
    pub fn bands(&self) -> usize {
        self.bands.len()
    }

    /// Appends refracted rays of a band, which the mask names, of white ones that split here.
    #[inline(always)]
    pub fn push_band<L: Lanes, T: Record>(
        &mut self,
        band: usize,
        mask: L::Mask,
        rays: &Outgoing<L, P>,
        carried: &Row<T, L>,
    ) {
        self.bands[band].push::<L, T>(RayKind::Refracted, mask, rays, carried);
    }

    /// All of them: mirror rays, refracted rays, then those of the bands, each in the order of their parents. Nothing is left;
    /// the memory of the empty queue is used for the next ones.
    #[inline(always)]
    pub fn take(&mut self, empty: RayQueue<P>) -> RayQueue<P> {
        let mut all = core::mem::replace(&mut self.mirror, empty);
        all.append(&self.refracted);
        self.refracted.clear();
        for band in &mut self.bands {
            all.append(band);
            band.clear();
        }
        all
    }
}
