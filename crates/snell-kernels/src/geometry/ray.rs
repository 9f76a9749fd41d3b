//! Rays, and the frame in which a ray is the z axis.

use super::Vec3;
use crate::lanes::Lanes;

/// Where a ray goes, as triangles need it: its components in the order `k`, the axis along which it goes farthest last.
///
/// The shear makes the ray the z axis (Woop, Benthin and Wald, *Watertight Ray/Triangle Intersection*, JCGT 2 (2013), section 3):
/// seen along it, a point `v` from its origin is at `x = v[k₀] + shear₀·v[k₂]`, `y = v[k₁] + shear₁·v[k₂]`.
///
/// Everything that is called *permuted* has its components in this order.
#[derive(Clone, Copy, Debug)]
pub struct Heading<L = f64> {
    /// The permuted direction.
    pub dir: Vec3<L>,
    /// The [`inverse`] of each of its components.
    pub inverse: Vec3<L>,
    /// `−dir[k₀]/dir[k₂]` and `−dir[k₁]/dir[k₂]`, from −1 to 1.
    pub shear: [L; 2],
}

/// A ray, or several, as shapes are tested against it: everything in the order `axes`, which is that of the axes themselves for
/// shapes that want no shear.
#[derive(Clone, Copy, Debug)]
pub struct Ray<L = f64> {
    /// Where it starts.
    pub origin: Vec3<L>,
    /// Where it goes; the shears are of meaning in the order of its main axis only.
    pub heading: Heading<L>,
    /// Which component stands where.
    pub axes: [usize; 3],
}

/// The order of the axes for a ray whose main axis, the one of its largest component, is this one.
pub const fn axes(main: usize) -> [usize; 3] {
    match main {
        0 => [1, 2, 0],
        1 => [0, 2, 1],
        _ => [0, 1, 2],
    }
}

/// The axis of the largest component; z before y before x among equals.
pub fn main_axis(dir: Vec3) -> usize {
    let size = |v: f64| if v < 0.0 { -v } else { v };
    let (x, y, z) = (size(dir.x), size(dir.y), size(dir.z));
    if z >= x && z >= y { 2 } else { usize::from(y >= x) }
}

/// `1/dir`, kept finite: 1/0 is infinite, and 0·∞ in a slab test is NaN. With the largest finite number instead an origin
/// between the planes is inside, one outside them is far away, and boxes have a margin that keeps origins off their planes.
#[inline(always)]
pub fn inverse<L: Lanes>(component: L) -> L {
    (L::splat(1.0) / component).min(L::splat(f64::MAX)).max(L::splat(-f64::MAX))
}

impl<L: Lanes> Ray<L> {
    /// For shapes that want no shears, and no inverse of the direction.
    #[inline(always)]
    pub fn unsheared(origin: Vec3<L>, dir: Vec3<L>) -> Self {
        let zero = L::splat(0.0);
        let heading = Heading { dir, inverse: Vec3::new(zero, zero, zero), shear: [zero; 2] };
        Self { origin, heading, axes: [0, 1, 2] }
    }
}

impl<L: Lanes> Heading<L> {
    /// That of a permuted direction.
    #[inline(always)]
    pub fn new(dir: Vec3<L>) -> Self {
        let inverse = Vec3::new(inverse(dir.x), inverse(dir.y), inverse(dir.z));
        Self { dir, inverse, shear: [-(dir.x / dir.z), -(dir.y / dir.z)] }
    }

    /// A permuted vector seen along the ray.
    #[inline(always)]
    pub fn seen(&self, v: Vec3<L>) -> [L; 2] {
        [v.x + self.shear[0] * v.z, v.y + self.shear[1] * v.z]
    }
}

impl Vec3 {
    /// The components in another order.
    #[inline(always)]
    pub fn permuted(self, [x, y, z]: [usize; 3]) -> Self {
        Self::new(self.component(x), self.component(y), self.component(z))
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
            let dir = v.unit().permuted(axes(main_axis(v)));
            let [x, y] = Heading::new(dir).seen(dir);
            // Two roundings per component of order one.
            prop_assert!(x.abs() < 5e-16 && y.abs() < 5e-16);
            prop_assert!(dir.z.abs() >= dir.x.abs() && dir.z.abs() >= dir.y.abs());
        }
    }

    #[test]
    fn no_inverse_is_infinite() {
        for component in [0.0, -0.0, 5e-324, -5e-324] {
            assert!(inverse(component).is_finite());
        }
        assert_eq!(inverse(-0.5), -2.0);
    }
}
