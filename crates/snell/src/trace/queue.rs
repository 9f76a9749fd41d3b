//! The rays of a generation, as columns.

use crate::film::Rgb;
use crate::geometry::Vec3;
use crate::geometry::bvh::{PACKET, Packet};
use crate::lanes::{Columns, Lanes};

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

/// Columns of the queue: origin, direction and `t_min`; attenuation and factor; pixel, source and parent.
const ORIGIN: usize = 0;
const ATTENUATION: usize = 7;
const PIXEL: usize = 13;
const SOURCE: usize = 14;
const PARENT: usize = 15;

/// Rays that are traced together, in a fixed order: camera rays, or mirror rays and then refracted ones.
///
/// Whole numbers travel as `f64`, in which every `u32` is exact, so that all columns are of one kind.
#[derive(Debug, Default)]
pub(crate) struct RayQueue {
    rays: Columns<16>,
    /// How many camera rays, and mirror rays, stand in front.
    camera: usize,
    mirror: usize,
}

impl RayQueue {
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.rays.len()
    }

    #[inline(always)]
    pub fn clear(&mut self) {
        self.rays.clear();
        (self.camera, self.mirror) = (0, 0);
    }

    /// Appends the rays that the mask names. Kinds must come in the order of [`RayKind`].
    #[inline(always)]
    pub fn push<L: Lanes>(&mut self, kind: RayKind, mask: L::Mask, rays: &Rays<L>) {
        let Rays { origin: o, dir: d, t_min, weight: Weight { attenuation: a, factor: f }, pixel, source, parent } =
            *rays;
        let before = self.len();
        let row = [o.x, o.y, o.z, d.x, d.y, d.z, t_min, a.r, a.g, a.b, f.r, f.g, f.b, pixel, source, parent];
        self.rays.push(mask, row);
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
        self.rays.append(&other.rays, 0..other.len());
        (self.camera, self.mirror) = (self.camera + other.camera, self.mirror + other.mirror);
    }

    /// Appends one ray of another queue.
    pub fn copy_row(&mut self, from: &Self, row: usize) {
        self.rays.append(&from.rays, row..row + 1);
        self.count(from.kind(row), 1);
    }

    /// Rays from a row on, one in each lane; behind the last one they are of no meaning.
    #[inline(always)]
    pub fn rays<L: Lanes>(&self, start: usize) -> Rays<L> {
        let [x, y, z, dx, dy, dz, t_min] = self.rays.group(ORIGIN, start);
        let [r, g, b, fr, fg, fb] = self.rays.group(ATTENUATION, start);
        let [pixel, source, parent] = self.rays.group(PIXEL, start);
        let weight = Weight { attenuation: Rgb::new(r, g, b), factor: Rgb::new(fr, fg, fb) };
        Rays { origin: Vec3::new(x, y, z), dir: Vec3::new(dx, dy, dz), t_min, weight, pixel, source, parent }
    }

    /// Puts up to 64 rays from a row on into a packet, and says which places they take.
    #[inline(always)]
    pub fn fill<L: Lanes>(&self, packet: &mut Packet, first: usize) -> u64 {
        let count = (self.len() - first).min(PACKET);
        for start in (0..count).step_by(L::WIDTH) {
            let [x, y, z, dx, dy, dz, t_min] = self.rays.group(ORIGIN, first + start);
            let source = self.rays.lanes(SOURCE, first + start);
            let t_max = L::splat(f64::INFINITY);
            packet.set(start, Vec3::new(x, y, z), Vec3::new(dx, dy, dz), t_min, t_max, source);
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
        self.rays.column(PIXEL)[..self.len()].iter().map(|&pixel| pixel as usize)
    }

    pub fn pixel(&self, row: usize) -> usize {
        self.rays.at(PIXEL, row) as usize
    }

    pub fn parent(&self, row: usize) -> usize {
        self.rays.at(PARENT, row) as usize
    }
}
