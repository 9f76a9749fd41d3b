//! The nearest hits of rays in lanes, and a handful of spheres that need no tree.

use super::packet::Packet;
use super::{Bvh, Shapes};
use crate::geometry::{Sphere, Vec3, sphere};
use crate::lanes::{Lanes, Mask};

/// So few spheres cost less than boxes around them.
const FEW: usize = 8;

/// The nearest hits of some rays while primitives are tested one after the other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest<L: Lanes> {
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
    pub(super) fn leave(&self, id: f64) -> L::Mask {
        self.source.eq(L::splat(id))
    }

    /// Keeps a hit where it is nearer; at equal distance that of the lower id. The primitive that a ray leaves is not hit.
    #[inline(always)]
    pub(super) fn keep(&mut self, t: L, meets: L::Mask, id: f64) {
        let meets = meets & self.active;
        if meets.any() {
            self.keep_crossing(t, meets & !self.leave(id), id);
        }
    }

    /// The same, of a primitive that may be crossed by a ray that leaves it.
    #[inline(always)]
    pub(super) fn keep_crossing(&mut self, t: L, meets: L::Mask, id: f64) {
        let meets = meets & self.active;
        let id = L::splat(id);
        let closer = t.lt(self.t) | (t.eq(self.t) & id.lt(self.primitive));
        let kept = meets & t.gt(self.t_min) & closer;
        self.hit = self.hit | kept;
        self.t = L::select(kept, t, self.t);
        self.primitive = L::select(kept, id, self.primitive);
    }

    /// Tests a sphere: entered from outside only, or with `two_sided` crossed from either side.
    #[inline(always)]
    pub(super) fn sphere(
        &mut self,
        two_sided: bool,
        origin: Vec3<L>,
        dir: Vec3<L>,
        center: Vec3<L>,
        radius: L,
        id: f64,
    ) {
        if two_sided {
            let (t, meets) = sphere::crossing(origin, dir, center, radius, self.t_min, self.leave(id));
            self.keep_crossing(t, meets, id);
        } else {
            let (t, meets) = sphere::intersect(origin, dir, center, radius);
            self.keep(t, meets, id);
        }
    }
}

/// Some spheres and their ids, in ascending order.
pub(crate) type Few = Vec<(f64, Sphere)>;

/// The spheres, if there are only a few of them and nothing else.
pub(super) fn few(shapes: &Shapes<'_>) -> Few {
    let all = shapes.count() == shapes.spheres.len() && shapes.count() <= FEW;
    let spheres = if all { shapes.spheres } else { &[] };
    spheres.iter().enumerate().map(|(id, &sphere)| (id as f64, sphere)).collect()
}

impl Bvh {
    /// All there is, if it is a few spheres: then [`Nearest::among`] finds the same hits as the tree, without packets.
    #[inline(always)]
    pub(crate) fn few(&self) -> Option<&Few> {
        (!self.few.is_empty()).then_some(&self.few)
    }
}

impl<L: Lanes> Nearest<L> {
    /// The nearest hits of some rays among these spheres, entered from outside only or crossed from either side.
    #[inline(always)]
    pub fn among(mut self, two_sided: bool, spheres: &[(f64, Sphere)], origin: Vec3<L>, dir: Vec3<L>) -> Self {
        for (id, sphere) in spheres {
            self.sphere(two_sided, origin, dir, sphere.center.splat(), L::splat(sphere.radius), *id);
        }
        self
    }
}
