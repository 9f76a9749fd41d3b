//! Rays, and the frame in which a ray is the z axis.

use super::Vec3;
use crate::lanes::Lanes;

/// `origin + t·dir` for `t_min < t < t_max`, with `dir` of unit length.
#[derive(Clone, Copy, Debug)]
pub struct Ray<L = f64> {
    /// Where the ray starts.
    pub origin: Vec3<L>,
    /// Where it goes, of unit length.
    pub dir: Vec3<L>,
    /// Hits must lie strictly beyond this distance.
    pub t_min: L,
    /// Hits must lie strictly before this distance.
    pub t_max: L,
}

impl<L: Lanes> Ray<L> {
    /// The point at distance `t`.
    #[inline(always)]
    pub fn at(&self, t: L) -> Vec3<L> {
        self.origin + self.dir * t
    }
}

/// What box and triangle tests need of a ray, computed once per ray.
///
/// `to_ray` is a linear map that takes `dir` to (0, 0, 1): a shear along the ray's largest component, as in Woop,
/// Benthin and Wald, *Watertight Ray/Triangle Intersection*, JCGT 2 (2013), section 3. Its three rows are stored in
/// full, so that no permutation of axes is needed: a product with a stored zero or one is exact.
#[derive(Clone, Copy, Debug)]
pub struct RayFrame<L = f64> {
    /// `1/dir` per component, kept finite (see [`RayFrame::new`]).
    pub inv_dir: Vec3<L>,
    /// Rows of the map into ray space.
    pub to_ray: [Vec3<L>; 3],
}

impl<L: Lanes> RayFrame<L> {
    /// The frame of a ray direction.
    #[inline(always)]
    pub fn new(dir: Vec3<L>) -> Self {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let abs = |v: L| v.max(-v);
        let (ax, ay, az) = (abs(dir.x), abs(dir.y), abs(dir.z));
        let along_z = az.ge(ax) & az.ge(ay);
        let along_y = !along_z & ay.ge(ax);
        let along_x = !along_z & !along_y;

        let main = L::select(along_x, dir.x, L::select(along_y, dir.y, dir.z));
        let (sx, sy, sz) = (-(dir.x / main), -(dir.y / main), -(dir.z / main));
        let when = |mask: L::Mask, value: L| L::select(mask, value, zero);
        // First row: the x axis, or y where x is the main axis; second row: the z axis, or y where z is the main one.
        let first =
            Vec3::new(L::select(along_x, sy, one), L::select(along_x, one, when(along_y, sx)), when(along_z, sx));
        let second =
            Vec3::new(when(along_x, sz), L::select(along_z, one, when(along_y, sz)), L::select(along_z, sy, one));
        let third = Vec3::new(when(along_x, one / dir.x), when(along_y, one / dir.y), when(along_z, one / dir.z));

        // 1/0 is infinite, and 0·inf in a slab test is NaN. With the largest finite number instead an origin between the
        // planes is inside, one outside them is far away, and boxes have a margin that keeps origins off their planes.
        let finite = |v: L| (one / v).min(L::splat(f64::MAX)).max(L::splat(-f64::MAX));
        let inv_dir = Vec3::new(finite(dir.x), finite(dir.y), finite(dir.z));
        Self { inv_dir, to_ray: [first, second, third] }
    }

    /// A vector in ray space: z is the distance along the ray in units of `dir`.
    #[inline(always)]
    pub fn apply(&self, v: Vec3<L>) -> Vec3<L> {
        Vec3::new(self.to_ray[0].dot(v), self.to_ray[1].dot(v), self.to_ray[2].dot(v))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_ray_is_the_z_axis_of_its_own_frame(x in -1.0..1.0f64, y in -1.0..1.0f64, z in -1.0..1.0f64) {
            let v = Vec3::new(x, y, z);
            prop_assume!(v.length() > 1e-3);
            let dir = v.unit();
            let image = RayFrame::new(dir).apply(dir);
            // Two roundings per component of order one.
            prop_assert!(image.x.abs() < 5e-16 && image.y.abs() < 5e-16 && (image.z - 1.0).abs() < 5e-16);
        }
    }

    #[test]
    fn axis_parallel_rays_have_finite_inverses() {
        for dir in [Vec3::new(1.0, 0.0, -0.0), Vec3::new(0.0, -1.0, 0.0), Vec3::new(-0.0, 0.0, 1.0)] {
            let frame = RayFrame::new(dir);
            assert!(frame.inv_dir.is_finite());
            assert_eq!(frame.apply(dir), Vec3::new(0.0, 0.0, 1.0));
        }
    }
}
