//! Where along a ray a flat shape is, once it is known that the ray goes through; and where a box around a shape is.

use crate::geometry::Vec3;
use crate::geometry::ray::Heading;
use crate::lanes::Lanes;

/// How far outside of its box a flat shape may be hit, relative to its distance: sixteen roundings, those with which its points are
/// seen ([`SEEN`](super::triangle::SEEN)) and those of the distances to the sides of the box. The boxes of the tree have room for
/// more than this.
const SLACK: f64 = 1.0 / (1u64 << 49) as f64;

/// Where a ray meets the plane across `normal` through `point`, moved into the box between `low` and `high`, which all are seen from
/// the origin of the ray; and whether there is such a place. Grazing rays meet a plane anywhere, but the box only near the shape.
#[inline(always)]
pub fn meet_plane<L: Lanes>(
    heading: &Heading<L>,
    normal: Vec3<L>,
    point: Vec3<L>,
    low: Vec3<L>,
    high: Vec3<L>,
) -> (L, L::Mask) {
    let t = normal.dot(point) / normal.dot(heading.dir);
    let [enter, leave] = box_along(heading.inverse, low, high);
    // 0/0 without area, and for a ray that starts in the plane and stays there.
    (t.max(enter).min(leave), t.eq(t) & enter.le(leave))
}

/// Where a ray whose direction has this inverse enters and leaves a box, seen from its origin, with [`SLACK`]: the slab test of the tree,
/// by the same operations, so that its larger boxes are entered no later and left no earlier.
#[inline(always)]
pub fn box_along<L: Lanes>(i: Vec3<L>, low: Vec3<L>, high: Vec3<L>) -> [L; 2] {
    let far = high.x.max(-low.x).max(high.y.max(-low.y)).max(high.z.max(-low.z));
    let slack = L::splat(SLACK) * far;
    let (x0, x1) = ((low.x - slack) * i.x, (high.x + slack) * i.x);
    let (y0, y1) = ((low.y - slack) * i.y, (high.y + slack) * i.y);
    let (z0, z1) = ((low.z - slack) * i.z, (high.z + slack) * i.z);
    [x0.min(x1).max(y0.min(y1)).max(z0.min(z1)), x0.max(x1).min(y0.max(y1)).min(z0.max(z1))]
}
