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
#[derive(Clone, Debug, Default)]
pub struct RayBatch {
    /// Where the rays start: x, y, z.
    pub origin: [Vec<f64>; 3],
    /// Where they go; spheres want unit length, and `t` counts in this length.
    pub dir: [Vec<f64>; 3],
    /// Hits must lie strictly beyond this distance.
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
            let (t_min, t_max) = (lanes(&self.t_min, row), lanes(&self.t_max, row));
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
            let all = rays.fill::<L>(packet, first + start, world.tree.has_triangles());
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
            let all = rays.fill::<L>(packet, first + number * PACKET, world.tree.has_triangles());
            let hit = world.tree.intersect::<L, true>(packet, all);
            for (i, blocked) in blocked.iter_mut().enumerate() {
                *blocked = hit >> i & 1 == 1;
            }
        }
    }
}
