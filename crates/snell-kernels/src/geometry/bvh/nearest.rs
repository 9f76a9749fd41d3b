//! The nearest hits of rays in lanes.

use super::packet::Packet;
use crate::geometry::ray::Ray;
use crate::geometry::shape::{Numbers, Query, Shape};
use crate::lanes::{Lanes, Mask};

/// The nearest hits of some rays while primitives are tested one after the other.
#[derive(Clone, Copy, Debug)]
pub struct Nearest<L: Lanes> {
    active: L::Mask,
    t_min: L,
    source: L,
    /// Where the nearest hit so far is; `t_max` without one.
    pub t: L,
    /// The primitive hit there, −1 without one.
    pub primitive: L,
    /// Which rays have a hit.
    pub hit: L::Mask,
}

impl<L: Lanes> Nearest<L> {
    /// No hits so far, for rays that leave the primitive `source`, between `t_min` and `t_max`.
    #[inline(always)]
    pub fn none(active: L::Mask, t_min: L, t_max: L, source: L) -> Self {
        Self { active, t_min, source, t: t_max, primitive: L::splat(-1.0), hit: L::Mask::from_bits(0) }
    }

    /// What some rays of a packet have found so far.
    #[inline(always)]
    pub(super) fn load(packet: &Packet, start: usize, active: L::Mask) -> Self {
        Self {
            active,
            t_min: L::load(&packet.t_min[start..]),
            source: L::load(&packet.source[start..]),
            t: L::load(&packet.t[start..]),
            primitive: L::load(&packet.primitive[start..]),
            hit: L::Mask::from_bits(0),
        }
    }

    /// Which rays leave this primitive?
    #[inline(always)]
    fn leave(&self, id: f64) -> L::Mask {
        self.source.eq(L::splat(id))
    }

    /// Keeps a hit where it is nearer; at equal distance that of the lower id. The primitive that a ray leaves is not hit.
    #[inline(always)]
    fn keep(&mut self, t: L, meets: L::Mask, id: f64) {
        let meets = meets & self.active;
        if meets.any() {
            self.keep_crossing(t, meets & !self.leave(id), id);
        }
    }

    /// The same, of a primitive that may be crossed by a ray that leaves it.
    #[inline(always)]
    fn keep_crossing(&mut self, t: L, meets: L::Mask, id: f64) {
        let meets = meets & self.active;
        let id = L::splat(id);
        let closer = t.lt(self.t) | (t.eq(self.t) & id.lt(self.primitive));
        let kept = meets & t.gt(self.t_min) & closer;
        self.hit = self.hit | kept;
        self.t = L::select(kept, t, self.t);
        self.primitive = L::select(kept, id, self.primitive);
    }

    /// Tests a shape that is the same in all lanes.
    #[inline(always)]
    pub(super) fn offer<S: Shape>(&mut self, two_sided: bool, ray: &Ray<L>, shape: impl Numbers<L>, id: f64) {
        if S::may_return(two_sided) {
            let query = Query { two_sided, t_min: self.t_min, leaves: self.leave(id) };
            let (t, meets) = S::intersect(ray, shape, &query);
            self.keep_crossing(t, meets, id);
        } else {
            let query = Query { two_sided, t_min: self.t_min, leaves: L::Mask::from_bits(0) };
            let (t, meets) = S::intersect(ray, shape, &query);
            self.keep(t, meets, id);
        }
    }
}
