//! Rays of the caller's own against a world, many at a time.

use crate::geometry::{Ray, Vec3};
use crate::lanes::{ArrayLanes, Lanes, Mask};
use crate::render::LaneWidth;
use crate::world::{NO_PRIMITIVE, World};
use std::sync::{Mutex, PoisonError};

/// Rays of the caller's own, in columns of equal length.
#[derive(Clone, Debug, Default)]
pub struct RayBatch {
    /// Where each ray starts.
    pub origin: [Vec<f64>; 3],
    /// Where it goes. Distances are in units of its length, which need not be 1 if there are only triangles.
    pub dir: [Vec<f64>; 3],
    /// Hits must lie strictly beyond this distance.
    pub t_min: Vec<f64>,
    /// Hits must lie strictly before this distance.
    pub t_max: Vec<f64>,
}

/// The closest hit of each ray.
#[derive(Clone, Debug, Default)]
pub struct HitBatch {
    /// Its distance; the ray's `t_max` where there is none.
    pub t: Vec<f64>,
    /// What was hit; [`NO_PRIMITIVE`] where nothing was.
    pub primitive: Vec<u32>,
}

/// Finds the closest hit of each ray. `hits` is overwritten; its memory is used again.
pub fn closest_hits(world: &World, rays: &RayBatch, threads: usize, lanes: LaneWidth, hits: &mut HitBatch) {
    hits.t.resize(rays.t_max.len(), 0.0);
    hits.primitive.resize(rays.t_max.len(), NO_PRIMITIVE);
    let rows: Vec<_> = hits.t.chunks_mut(CHUNK).zip(hits.primitive.chunks_mut(CHUNK)).collect();
    share(rows, threads, |chunk, (t, primitive)| match lanes {
        LaneWidth::One => closest::<f64>(world, rays, chunk, t, primitive),
        LaneWidth::Four => closest::<ArrayLanes<4>>(world, rays, chunk, t, primitive),
    });
}

/// Finds out which rays hit anything at all. `blocked` is overwritten; its memory is used again.
pub fn any_hits(world: &World, rays: &RayBatch, threads: usize, lanes: LaneWidth, blocked: &mut Vec<bool>) {
    blocked.resize(rays.t_max.len(), false);
    let rows = blocked.chunks_mut(CHUNK).collect();
    share(rows, threads, |chunk, blocked| match lanes {
        LaneWidth::One => any::<f64>(world, rays, chunk, blocked),
        LaneWidth::Four => any::<ArrayLanes<4>>(world, rays, chunk, blocked),
    });
}

/// Rays that a thread takes at a time.
const CHUNK: usize = 1024;

/// Hands out the chunks of a result, by their numbers, to some threads.
fn share<T: Send>(chunks: Vec<T>, threads: usize, work: impl Fn(usize, T) + Sync) {
    let waiting = Mutex::new(chunks.into_iter().enumerate());
    let next = || waiting.lock().unwrap_or_else(PoisonError::into_inner).next();
    let worker = || {
        while let Some((number, chunk)) = next() {
            work(number, chunk);
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..threads {
            scope.spawn(worker);
        }
        worker();
    });
}

fn closest<L: Lanes>(world: &World, rays: &RayBatch, chunk: usize, t: &mut [f64], primitive: &mut [u32]) {
    for start in (0..t.len()).step_by(L::WIDTH) {
        let active = L::Mask::first(t.len() - start);
        let found = world.intersect(&load::<L>(rays, chunk * CHUNK + start), L::splat(f64::from(NO_PRIMITIVE)), active);
        for lane in 0..L::WIDTH.min(t.len() - start) {
            t[start + lane] = found.t.lane(lane);
            primitive[start + lane] = found.primitive.lane(lane) as u32;
        }
    }
}

fn any<L: Lanes>(world: &World, rays: &RayBatch, chunk: usize, blocked: &mut [bool]) {
    for start in (0..blocked.len()).step_by(L::WIDTH) {
        let active = L::Mask::first(blocked.len() - start);
        let found = world.occluded(&load::<L>(rays, chunk * CHUNK + start), L::splat(f64::from(NO_PRIMITIVE)), active);
        for lane in 0..L::WIDTH.min(blocked.len() - start) {
            blocked[start + lane] = found.test(lane);
        }
    }
}

#[inline(always)]
fn load<L: Lanes>(rays: &RayBatch, row: usize) -> Ray<L> {
    let vector = |[x, y, z]: &[Vec<f64>; 3]| Vec3::new(L::load(&x[row..]), L::load(&y[row..]), L::load(&z[row..]));
    Ray {
        origin: vector(&rays.origin),
        dir: vector(&rays.dir),
        t_min: L::load(&rays.t_min[row..]),
        t_max: L::load(&rays.t_max[row..]),
    }
}
