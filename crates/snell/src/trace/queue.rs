//! The rays of a generation, as columns.

use super::lecture::T_MIN;
use crate::film::Rgb;
use crate::geometry::Vec3;
use crate::geometry::bvh::{PACKET, Packet};
use crate::lanes::{Columns, Lanes, Mask};

/// Where a ray comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayKind {
    /// From the eye.
    Camera,
    /// From a mirror.
    Mirror,
    /// From the far side of something transparent.
    Refracted,
}

/// What a ray carries: `a` and `f`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Weight<L: Lanes> {
    /// What the surfaces passed so far leave of the light: the lecture's `a`.
    pub attenuation: Rgb<L>,
    /// The product of the parents' factors, which the lecture applies besides `a`.
    pub factor: Rgb<L>,
}

impl<L: Lanes> Weight<L> {
    /// What can be added to the pixel for each unit of radiance: `factor·attenuation`.
    #[inline(always)]
    pub fn throughput(&self) -> Rgb<L> {
        self.factor * self.attenuation
    }
}

/// Rays in lanes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rays<L: Lanes> {
    pub origin: Vec3<L>,
    pub dir: Vec3<L>,
    pub t_min: L,
    pub weight: Weight<L>,
    /// Number of the pixel within the tile.
    pub pixel: L,
    /// The primitive that the ray leaves, −1 for none.
    pub source: L,
    /// Row of the parent ray in the generation before.
    pub parent: L,
}

/// Columns of the ways: origin and direction, then the pixel.
const PIXEL: usize = 6;
/// Columns of the loads: attenuation and factor, then `t_min`, source and parent.
const PARENT: usize = 8;

/// Rays that are traced together, in a fixed order: camera rays, or mirror rays and then refracted ones.
///
/// Whole numbers travel as `f64`, in which every `u32` is exact, so that all columns are of one kind.
#[derive(Debug, Default)]
pub(crate) struct RayQueue {
    /// Where the rays go.
    ways: Columns<7>,
    /// What they carry and where they come from; empty for camera rays, which all carry everything and come from nowhere.
    loads: Columns<9>,
    /// How many camera rays, or mirror rays, stand in front.
    camera: usize,
    mirror: usize,
}

/// What all camera rays share.
#[derive(Clone, Copy, Debug)]
struct Load<L: Lanes> {
    weight: Weight<L>,
    t_min: L,
    source: L,
    parent: L,
}

impl RayQueue {
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.ways.len()
    }

    #[inline(always)]
    pub fn clear(&mut self) {
        self.ways.clear();
        self.loads.clear();
        (self.camera, self.mirror) = (0, 0);
    }

    /// Appends camera rays. No others may be in the queue.
    #[inline(always)]
    pub fn push_camera_rays<L: Lanes>(&mut self, mask: L::Mask, origin: Vec3<L>, dir: Vec3<L>, pixel: L) {
        self.ways.push(mask, [origin.x, origin.y, origin.z, dir.x, dir.y, dir.z, pixel]);
        self.camera = self.len();
    }

    /// Appends the mirror or refracted rays that the mask names, mirror rays first. No camera rays may be in the queue.
    #[inline(always)]
    pub fn push<L: Lanes>(&mut self, kind: RayKind, mask: L::Mask, rays: &Rays<L>) {
        let Rays { origin: o, dir: d, t_min, weight: Weight { attenuation: a, factor: f }, pixel, source, parent } =
            *rays;
        if !mask.any() {
            return;
        }
        let before = self.len();
        self.ways.push(mask, [o.x, o.y, o.z, d.x, d.y, d.z, pixel]);
        self.loads.push(mask, [a.r, a.g, a.b, f.r, f.g, f.b, t_min, source, parent]);
        self.count(kind, self.len() - before);
    }

    fn count(&mut self, kind: RayKind, rays: usize) {
        match kind {
            RayKind::Camera => self.camera += rays,
            RayKind::Mirror => self.mirror += rays,
            RayKind::Refracted => {}
        }
    }

    /// Appends all rays of another queue, which must not be of an earlier kind.
    pub fn append(&mut self, other: &Self) {
        self.ways.append(&other.ways, 0..other.len());
        self.loads.append(&other.loads, 0..other.loads.len());
        (self.camera, self.mirror) = (self.camera + other.camera, self.mirror + other.mirror);
    }

    /// Appends one ray of another queue.
    pub fn copy_row(&mut self, from: &Self, row: usize) {
        self.ways.append(&from.ways, row..row + 1);
        if from.camera == 0 {
            self.loads.append(&from.loads, row..row + 1);
        }
        self.count(from.kind(row), 1);
    }

    #[inline(always)]
    fn load<L: Lanes>(&self, start: usize) -> Load<L> {
        if self.camera > 0 {
            let white = Rgb::gray(1.0).splat();
            let weight = Weight { attenuation: white, factor: white };
            return Load { weight, t_min: L::splat(T_MIN), source: L::splat(-1.0), parent: L::splat(0.0) };
        }
        let [r, g, b, fr, fg, fb, t_min, source, parent] = self.loads.group(0, start);
        Load { weight: Weight { attenuation: Rgb::new(r, g, b), factor: Rgb::new(fr, fg, fb) }, t_min, source, parent }
    }

    /// Rays from a row on, one in each lane; behind the last one they are of no meaning.
    #[inline(always)]
    pub fn rays<L: Lanes>(&self, start: usize) -> Rays<L> {
        let [x, y, z, dx, dy, dz, pixel] = self.ways.group(0, start);
        let Load { weight, t_min, source, parent } = self.load(start);
        Rays { origin: Vec3::new(x, y, z), dir: Vec3::new(dx, dy, dz), t_min, weight, pixel, source, parent }
    }

    /// Puts up to 64 rays from a row on into a packet, and says which places they take.
    #[inline(always)]
    pub fn fill<L: Lanes>(&self, packet: &mut Packet, first: usize, shear: bool) -> u64 {
        let count = (self.len() - first).min(PACKET);
        for start in (0..count).step_by(L::WIDTH) {
            let Rays { origin, dir, t_min, source, .. } = self.rays::<L>(first + start);
            packet.set(start, origin, dir, t_min, L::splat(f64::INFINITY), source, shear);
        }
        u64::MAX >> (PACKET - count)
    }

    pub fn kind(&self, row: usize) -> RayKind {
        if row < self.camera {
            RayKind::Camera
        } else if row < self.camera + self.mirror {
            RayKind::Mirror
        } else {
            RayKind::Refracted
        }
    }

    /// How many camera, mirror and refracted rays.
    pub fn counts(&self) -> [usize; 3] {
        [self.camera, self.mirror, self.len() - self.camera - self.mirror]
    }

    /// The pixels of the rays.
    #[inline(always)]
    pub fn pixels(&self) -> impl Iterator<Item = usize> + '_ {
        self.ways.column(PIXEL).iter().map(|&pixel| pixel as usize)
    }

    pub fn pixel(&self, row: usize) -> usize {
        self.ways.at(PIXEL, row) as usize
    }

    pub fn parent(&self, row: usize) -> usize {
        if self.camera > 0 { 0 } else { self.loads.at(PARENT, row) as usize }
    }
}
