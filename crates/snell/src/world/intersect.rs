//! Rays against the world: closest hit, any hit, and the surface found there.

use super::{FLAT, World};
use crate::geometry::{Ray, RayFrame, Vec3, sphere, triangle};
use crate::lanes::{Lanes, Mask};

/// "No primitive", where an id is expected.
pub const NO_PRIMITIVE: u32 = u32::MAX;

/// The closest hit of each lane. Ids travel as `f64`, in which every `u32` is exact, so that one `select` serves.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ClosestHit<L: Lanes> {
    pub t: L,
    pub primitive: L,
    pub hit: L::Mask,
}

impl World {
    #[inline(always)]
    fn test<L: Lanes>(&self, primitive: u32, ray: &Ray<L>, frame: &RayFrame<L>) -> (L, L::Mask) {
        let index = primitive as usize;
        if let Some(s) = self.spheres.get(index) {
            return sphere::intersect(ray, s.center, s.radius);
        }
        let found = triangle::intersect(ray, frame, self.corners(index - self.spheres.len()));
        (found.t, found.hit)
    }

    fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.faces[triangle].map(|v| self.vertices[v as usize])
    }

    /// The closest hit of each active ray. `source` is the primitive that the ray leaves, which it cannot hit again:
    /// it is flat, or a sphere left on the outside.
    #[inline(always)]
    pub(crate) fn intersect<L: Lanes>(&self, ray: &Ray<L>, source: L, active: L::Mask) -> ClosestHit<L> {
        let frame = RayFrame::new(ray.dir);
        let none = L::splat(f64::from(NO_PRIMITIVE));
        let (mut best_t, mut best) = (ray.t_max, none);
        self.tree.traverse(ray, &frame, active, |primitive, limit| {
            let (t, hit) = self.test(primitive, ray, &frame);
            let id = L::splat(f64::from(primitive));
            let closer = hit & !source.eq(id) & (t.lt(limit) | (t.eq(limit) & id.lt(best)));
            best_t = L::select(closer, t, best_t);
            best = L::select(closer, id, best);
            L::select(closer, t, limit)
        });
        ClosestHit { t: best_t, primitive: best, hit: active & !best.eq(none) }
    }

    /// Which active rays hit anything at all before `t_max`.
    #[inline(always)]
    pub(crate) fn occluded<L: Lanes>(&self, ray: &Ray<L>, source: L, active: L::Mask) -> L::Mask {
        let frame = RayFrame::new(ray.dir);
        let mut blocked = L::Mask::first(0);
        self.tree.traverse(ray, &frame, active, |primitive, limit| {
            let (_, hit) = self.test(primitive, ray, &frame);
            blocked = blocked | (hit & !source.eq(L::splat(f64::from(primitive))));
            L::select(blocked, L::splat(f64::NEG_INFINITY), limit)
        });
        blocked & active
    }

    /// The normal at a hit, turned to face a ray of this direction, not yet of unit length. The geometric normal
    /// decides the side.
    pub(crate) fn facing_normal(&self, primitive: u32, point: Vec3, dir: Vec3) -> Vec3 {
        let index = primitive as usize;
        if let Some(s) = self.spheres.get(index) {
            // Only near roots count, so the ray is outside.
            return point - s.center;
        }
        let index = index - self.spheres.len();
        let flat = self.face_normals[index];
        let normal = match self.corner_normals_of[index] {
            FLAT => flat,
            at => {
                // The barycentric weights do not depend on where the ray starts: start it at the hit.
                let ray = Ray { origin: point, dir, t_min: 0.0, t_max: f64::INFINITY };
                let hit = triangle::intersect(&ray, &RayFrame::new(dir), self.corners(index));
                let [a, b, c] = self.corner_normals[at as usize];
                let smooth = a * (1.0 - hit.beta - hit.gamma) + b * hit.beta + c * hit.gamma;
                // Opposite normals at the corners can cancel, and a grazing ray can find no weights.
                if smooth.is_finite() && smooth != Vec3::default() { smooth } else { flat }
            }
        };
        if flat.dot(dir) > 0.0 { -normal } else { normal }
    }
}
