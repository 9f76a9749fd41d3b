//! Rays of the caller's own against a world, without light: which primitive each one hits, or whether it hits any.

use crate::geometry::Vec3;
use crate::geometry::bvh::{PACKET, Packet};
use crate::lanes::{Kernel, LaneWidth, Lanes, MAX_WIDTH, dispatch};
use crate::threads;
use crate::world::{NO_PRIMITIVE, World};
use std::sync::{Mutex, PoisonError};

/// So many rays are taken by a thread at once.
const CHUNK: usize = 16 * PACKET;

/// Rays in columns, all of the same length. Neighbours that go nearly the same way are traced faster.
///
/// A ray with a NaN hits nothing. The boxes of the tree have margins for rays that start within the box of the scene and
/// of where its camera's rays start: from much farther away a hit at the very rim of a primitive may be missed, by the rounding of its
/// distance.
#[derive(Clone, Debug, Default)]
pub struct RayBatch {
    /// Where the rays start: x, y, z.
    pub origin: [Vec<f64>; 3],
    /// Where they go; spheres want unit length, and `t` counts in this length.
    pub dir: [Vec<f64>; 3],
    /// Hits must lie strictly beyond this distance; a negative one counts as 0, as rays have no part behind their origin.
    pub t_min: Vec<f64>,
    /// Hits must lie strictly before this distance.
    pub t_max: Vec<f64>,
}

/// The closest hit of each ray.
#[derive(Clone, Debug, Default)]
pub struct HitBatch {
    /// Distance; `t_max` of the ray where there is none.
    pub t: Vec<f64>,
    /// Primitive; [`NO_PRIMITIVE`] where there is none.
    pub primitive: Vec<u32>,
}

impl RayBatch {
    /// How many rays.
    pub fn len(&self) -> usize {
        self.t_max.len()
    }

    /// So many workers have something to do; all columns are of the same length.
    fn check(&self, threads: usize) -> usize {
        let columns = self.origin.iter().chain(&self.dir).chain([&self.t_min, &self.t_max]);
        assert!(columns.map(Vec::len).all(|len| len == self.len()), "the columns of the rays differ in length");
        threads.min(self.len().div_ceil(CHUNK).max(1))
    }

    /// Are there none?
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Appends a ray.
    pub fn push(&mut self, origin: Vec3, dir: Vec3, t_min: f64, t_max: f64) {
        for axis in 0..3 {
            self.origin[axis].push(origin.component(axis));
            self.dir[axis].push(dir.component(axis));
        }
        self.t_min.push(t_min);
        self.t_max.push(t_max);
    }

    /// Puts up to 64 rays from a row on into a packet, and says which places they take.
    #[inline(always)]
    fn fill<L: Lanes>(&self, packet: &mut Packet, first: usize, shear: bool) -> u64 {
        let count = (self.len() - first).min(PACKET);
        for start in (0..count).step_by(L::WIDTH) {
            let row = first + start;
            let [ox, oy, oz] = &self.origin;
            let [dx, dy, dz] = &self.dir;
            let origin = Vec3::new(lanes::<L>(ox, row), lanes(oy, row), lanes(oz, row));
            let dir = Vec3::new(lanes::<L>(dx, row), lanes(dy, row), lanes(dz, row));
            // Packets are made for this: a beam begins at 0. A NaN stays one.
            let t_min = L::splat(0.0).max(lanes(&self.t_min, row));
            let t_max = lanes(&self.t_max, row);
            packet.set(start, origin, dir, t_min, t_max, L::splat(-1.0), shear);
        }
        u64::MAX >> (PACKET - count)
    }
}

/// A column from a row on, zeros behind its end.
#[inline(always)]
fn lanes<L: Lanes>(column: &[f64], row: usize) -> L {
    let rest = &column[row..];
    if rest.len() >= L::WIDTH {
        return L::load(rest);
    }
    let mut last = [0.0; MAX_WIDTH];
    last[..rest.len()].copy_from_slice(rest);
    L::load(&last)
}

/// The closest hit of each ray, in the order of the rays. `threads` as in [`render::Options`](crate::render::Options).
///
/// # Panics
/// If the columns of the rays are not of the same length.
pub fn closest_hits(world: &World, rays: &RayBatch, threads: usize, width: LaneWidth, hits: &mut HitBatch) {
    let threads = rays.check(threads);
    hits.t.resize(rays.len(), 0.0);
    hits.primitive.resize(rays.len(), NO_PRIMITIVE);
    let chunks = hits.t.chunks_mut(CHUNK).zip(hits.primitive.chunks_mut(CHUNK)).enumerate();
    let chunks = Mutex::new(chunks);
    threads::run(threads, || {
        let mut packet = Box::default();
        while let Some((number, (t, primitive))) = next(&chunks) {
            dispatch(width, Closest { world, rays, first: number * CHUNK, packet: &mut packet, t, primitive });
        }
    });
}

/// Whether each ray hits anything, in the order of the rays. `threads` as in [`render::Options`](crate::render::Options).
///
/// # Panics
/// If the columns of the rays are not of the same length.
pub fn any_hits(world: &World, rays: &RayBatch, threads: usize, width: LaneWidth, blocked: &mut Vec<bool>) {
    let threads = rays.check(threads);
    blocked.resize(rays.len(), false);
    let chunks = Mutex::new(blocked.chunks_mut(CHUNK).enumerate());
    threads::run(threads, || {
        let mut packet = Box::default();
        while let Some((number, blocked)) = next(&chunks) {
            dispatch(width, Any { world, rays, first: number * CHUNK, packet: &mut packet, blocked });
        }
    });
}

fn next<T>(chunks: &Mutex<impl Iterator<Item = T>>) -> Option<T> {
    // A poisoned lock means that another worker panicked, which is passed on where the workers are waited for.
    chunks.lock().unwrap_or_else(PoisonError::into_inner).next()
}

struct Closest<'a> {
    world: &'a World,
    rays: &'a RayBatch,
    first: usize,
    packet: &'a mut Packet,
    t: &'a mut [f64],
    primitive: &'a mut [u32],
}

impl Kernel for Closest<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { world, rays, first, packet, t, primitive } = self;
        for start in (0..t.len()).step_by(PACKET) {
            let all = rays.fill::<L>(packet, first + start, world.tree.needs_shears());
            let hit = world.tree.intersect::<L, false>(packet, all);
            let end = t.len().min(start + PACKET);
            t[start..end].copy_from_slice(&packet.t[..end - start]);
            for (i, id) in primitive[start..end].iter_mut().enumerate() {
                *id = if hit >> i & 1 == 1 { packet.primitive[i] as u32 } else { NO_PRIMITIVE };
            }
        }
    }
}

struct Any<'a> {
    world: &'a World,
    rays: &'a RayBatch,
    first: usize,
    packet: &'a mut Packet,
    blocked: &'a mut [bool],
}

impl Kernel for Any<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { world, rays, first, packet, blocked } = self;
        for (number, blocked) in blocked.chunks_mut(PACKET).enumerate() {
            let all = rays.fill::<L>(packet, first + number * PACKET, world.tree.needs_shears());
            let hit = world.tree.intersect::<L, true>(packet, all);
            for (i, blocked) in blocked.iter_mut().enumerate() {
                *blocked = hit >> i & 1 == 1;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Camera, Integrator, Material, Render, Scene, Sphere};

    /// Thirty spheres of radius 1 in a row along z, ten apart.
    fn spheres() -> World {
        let camera = Camera::new([0.0, 0.0, 310.0], [0.0; 3], [0.0, 1.0, 0.0], [-1.0, 1.0, -1.0, 1.0], -5.0);
        World::new(&Scene {
            materials: [("grey".to_owned(), Material::default())].into(),
            spheres: (0..30).map(|i| Sphere::new([0.0, 0.0, 10.0 * f64::from(i)], 1.0, "grey")).collect(),
            ..Scene::new(Render::new(Integrator::Lecture, [1, 1]), camera)
        })
        .unwrap()
    }

    fn hits(world: &World, rays: &RayBatch, width: LaneWidth) -> Vec<u32> {
        let mut hits = HitBatch::default();
        closest_hits(world, rays, 1, width, &mut hits);
        let mut blocked = Vec::new();
        any_hits(world, rays, 1, width, &mut blocked);
        assert_eq!(blocked, hits.primitive.iter().map(|&p| p != NO_PRIMITIVE).collect::<Vec<_>>());
        hits.primitive
    }

    #[test]
    fn what_lies_behind_a_ray_is_the_same_alone_and_among_others() {
        let world = spheres();
        for width in LaneWidth::ALL {
            for (count, t_min) in [(1, -100.0), (64, -100.0), (64, -0.0), (64, f64::NAN)] {
                let mut rays = RayBatch::default();
                for _ in 0..count {
                    rays.push(Vec3::new(0.0, 0.0, 315.0), Vec3::new(0.0, 0.0, 1.0), t_min, 1e3);
                }
                assert_eq!(hits(&world, &rays, width), vec![NO_PRIMITIVE; count], "{count} rays from {t_min}");
            }
        }
    }

    #[test]
    fn limits_are_strict_and_nonsense_hits_nothing() {
        let world = spheres();
        let (origin, dir) = (Vec3::new(0.0, 0.0, -9.0), Vec3::new(0.0, 0.0, 1.0));
        for width in LaneWidth::ALL {
            for count in [1, 7, 64, 65, 3000] {
                for (t_min, t_max, expected) in [
                    (0.0, 8.0, NO_PRIMITIVE),
                    (0.0, 8.0f64.next_up(), 0),
                    (8.0, 20.0, 1),
                    (8.0, 8.0, NO_PRIMITIVE),
                    (9.0, 7.0, NO_PRIMITIVE),
                    (0.0, f64::NAN, NO_PRIMITIVE),
                    (f64::NAN, 20.0, NO_PRIMITIVE),
                    (0.0, f64::INFINITY, 0),
                    (f64::INFINITY, f64::INFINITY, NO_PRIMITIVE),
                ] {
                    let mut rays = RayBatch::default();
                    for i in 0..count {
                        // The same direction with zeros of both signs.
                        let zero = if i % 2 == 0 { 0.0 } else { -0.0 };
                        rays.push(origin, Vec3::new(zero, -zero, dir.z), t_min, t_max);
                    }
                    assert_eq!(hits(&world, &rays, width), vec![expected; count], "{t_min} to {t_max}");
                }
                for bad in [f64::NAN, 0.0] {
                    let mut rays = RayBatch::default();
                    (0..count).for_each(|_| rays.push(origin, Vec3::new(bad, bad, bad), 0.0, 1e9));
                    assert_eq!(hits(&world, &rays, width), vec![NO_PRIMITIVE; count]);
                }
            }
        }
        assert!(hits(&world, &RayBatch::default(), LaneWidth::Two).is_empty());
    }

    #[test]
    #[should_panic(expected = "columns of the rays")]
    fn columns_of_different_lengths_are_refused() {
        let mut rays = RayBatch::default();
        (0..9).for_each(|_| rays.push(Vec3::new(0.0, 0.0, -9.0), Vec3::new(0.0, 0.0, 1.0), 0.0, 1e9));
        rays.dir[2].pop();
        hits(&spheres(), &rays, LaneWidth::Four);
    }
}
