//! A handful of spheres, which need no tree.

use super::nearest::Nearest;
use super::{Bvh, Shapes};
use crate::geometry::ray::Ray;
use crate::geometry::shape::One;
use crate::geometry::{Sphere, Vec3};
use crate::lanes::Lanes;
use alloc::vec::Vec;

/// So few spheres cost less than boxes around them.
const FEW: usize = 8;

/// Some spheres and their ids, in ascending order.
pub type FewSpheres = Vec<(f64, Sphere)>;

/// The spheres, if there are only a few of them and nothing else.
pub fn few_spheres(shapes: &Shapes<'_>) -> FewSpheres {
    let all = shapes.count() == shapes.spheres.len() && shapes.count() <= FEW;
    let spheres = if all { shapes.spheres } else { &[] };
    spheres.iter().enumerate().map(|(id, &sphere)| (id as f64, sphere)).collect()
}

impl Bvh {
    /// All there is, if it is a few spheres: then [`Nearest::among`] finds the same hits as the tree, without packets.
    #[inline(always)]
    pub fn few_spheres(&self) -> Option<&FewSpheres> {
        (!self.few_spheres.is_empty()).then_some(&self.few_spheres)
    }
}

impl<L: Lanes> Nearest<L> {
    /// The nearest hits of some rays among these spheres, entered from outside only or crossed from either side.
    #[inline(always)]
    pub fn among(mut self, two_sided: bool, spheres: &[(f64, Sphere)], origin: Vec3<L>, dir: Vec3<L>) -> Self {
        let ray = Ray::unsheared(origin, dir);
        for (id, Sphere { center, radius }) in spheres {
            let numbers = [center.x, center.y, center.z, *radius];
            self.offer::<Sphere>(two_sided, &ray, One { numbers: &numbers, stride: 1, place: 0 }, *id);
        }
        self
    }
}
