//! The place that a ray leaves, and what of it a ray that has just left does not meet.
//!
//! A computed hit is off the plane of its face by some roundings. So near an edge a ray may start a little beyond the
//! neighbouring face. It would meet it at a distance of nothing, and a wall would shade itself along the edges of its triangles; or it
//! would pass behind it, out of the corner of a room. To leave out the face that a ray comes from is not enough, and to leave
//! out all that is near would let light through.
//!
//! ```text
//!        convex                 concave           What a ray meets while it is within the tolerance of the plane
//!       n↑   ↗ d                n↑  ↗ d │         of its face is looked at. It is a real obstacle only if
//!   ─────┴──●╲                 ────┴──●┤          it rises above that plane, as the wall on the right does and
//!    source   ╲ neighbour       source │ wall     the neighbour on the left does not; and where the place itself
//!              ╲                       │          lies on the obstacle, only if the ray goes to its other side.
//! ```
//!
//! "Within" is [`Stage::coincidence_tolerance`](crate::stage::Stage), what a hit may be off. Everything farther away blocks light.
//!
//! And what is in the way of a ray that goes back, to a light or from a mirror, is asked from a place a little [`back`] along
//! the ray that reached the surface: there it is surely on the right side of whatever else is there. The direction stays that of
//! the place itself, and so do distances, except that tinted light is dimmed from where it is asked for.

use crate::geometry::Vec3;
use crate::geometry::shape::Departure;
use crate::lanes::{Lanes, index};
use crate::settings::Shadows;
use crate::stage::Stage;
use alloc::vec::Vec;

/// How far a ray goes that leaves a face, at an angle of this cosine to its normal, until it is clear of its plane.
#[inline(always)]
pub(super) fn until_clear<L: Lanes>(stage: &Stage, cos: L) -> L {
    L::splat(stage.coincidence_tolerance) / cos.max(-cos)
}

/// How far back along a ray that reaches a surface after `t` a place is that is surely in front of the surface, by more than a hit may
/// be off. In a corner that ray is short.
#[inline(always)]
pub(super) fn back<L: Lanes>(stage: &Stage, t: L) -> L {
    // Spheres have no edges.
    let far = if stage.primitive_count() > stage.spheres.len() { 4.0 * stage.coincidence_tolerance } else { 0.0 };
    L::splat(far).min(t * L::splat(0.5))
}

/// How far back along a ray of length `t` the one starts that goes on through a face that is only partly there, and how far it then goes
/// until it is clear of that face's plane. What else is in the place of the face, like a wall behind a picture, is then in front of
/// it, and nothing else is: the ray that ended here has passed there.
#[inline(always)]
pub(super) fn through<L: Lanes>(stage: &Stage, cos: L, t: L) -> [L; 2] {
    let off = until_clear(stage, cos).min(L::splat(SLANTED * stage.coincidence_tolerance));
    let back = (L::splat(4.0) * off).min(t * L::splat(0.5));
    [back, back + off]
}

/// A face met at a cosine of 1/2048 or less may be met farther from where it is than other faces of its place are looked for.
const SLANTED: f64 = 2048.0;

/// Faces that are farther from each other along a ray are never in one place.
pub(super) fn together_at_most(stage: &Stage) -> f64 {
    2.0 * SLANTED * stage.coincidence_tolerance
}

/// Could two faces that a ray meets be in one place? Each is met as far from where it is as a hit may be off its plane, over the cosine
/// at which it is met.
pub(super) fn are_in_one_place(stage: &Stage, (origin, dir): (Vec3, Vec3), a: (f64, u32), b: (f64, u32)) -> bool {
    let off = |(t, primitive): (f64, u32)| {
        let cos = stage.geometric_normal(primitive as usize, origin + dir * t).dot(dir);
        until_clear(stage, cos).min(SLANTED * stage.coincidence_tolerance)
    };
    let gap = (b.0 - a.0).abs();
    gap <= stage.coincidence_tolerance || (gap <= together_at_most(stage) && gap <= off(a) + off(b))
}

/// A ray that leaves a surface, or the eye.
#[derive(Clone, Copy, Debug)]
pub struct Leaving {
    pub origin: Vec3,
    /// Of unit length.
    pub dir: Vec3,
    /// The primitive that it leaves, −1 for none.
    pub source: f64,
    /// Where it is clear of the plane of that primitive: [`until_clear`], 0 for none.
    pub clear: f64,
    /// Towards where the light came from that it carries on or answers.
    pub wo: Vec3,
}

impl Leaving {
    /// Does it really meet a primitive that the tests find at `t`, perhaps behind its origin?
    pub fn meets(&self, stage: &Stage, primitive: u32, t: f64) -> bool {
        if t > self.clear || self.source < 0.0 {
            return t > 0.0;
        }
        let shape = stage.shape(primitive as usize);
        let n = self.normal(stage);
        let up = if n.dot(self.dir) < 0.0 { -n } else { n };
        let from =
            Departure { origin: self.origin, dir: self.dir, wo: self.wo, up, tolerance: stage.coincidence_tolerance };
        if f64::from(primitive) == self.source { shape.is_met_again(&from, t) } else { shape.is_met(&from, t) }
    }

    /// Does anything up to `distance` through which no light goes really stand in its way, where it is not yet clear?
    pub fn is_blocked(&self, stage: &Stage, distance: f64, shadows: Shadows) -> bool {
        let (mut crossings, end) = (Vec::new(), self.clear.min(distance));
        stage.tree.crossings(self.origin, self.dir, [-stage.exit_tolerance, end], &mut crossings);
        crossings
            .into_iter()
            .any(|(t, primitive)| stage.blocks_light(primitive, shadows) && self.meets(stage, primitive, t))
    }

    fn normal(&self, stage: &Stage) -> Vec3 {
        stage.geometric_normal(index(self.source), self.origin)
    }
}
