//! The rays of a generation: those of a queue, as columns.

use crate::film::Rgb;
use crate::geometry::bvh::{PACKET, Packet};
use crate::geometry::{Sphere, Vec3};
use crate::lanes::{Columns, Lanes, Mask, index};

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
    pub load: Load<L>,
}

/// The rays of a generation, in a fixed order.
pub(crate) trait Generation {
    fn len(&self) -> usize;
    /// How many camera, mirror and refracted rays; they stand in this order.
    fn counts(&self) -> [usize; 3];
    /// Origins and directions from a row on, one in each lane; behind the last row they are of no meaning.
    fn ways<L: Lanes>(&self, start: usize) -> (Vec3<L>, Vec3<L>);
    /// What these rays carry and where they come from.
    fn loads<L: Lanes>(&self, start: usize) -> Load<L>;
    /// The pixel of a ray, within the tile.
    fn pixel(&self, row: usize) -> usize;
    /// Can any of the rays meet this sphere? Where it is not known, yes.
    fn may_meet(&self, _sphere: &Sphere) -> bool {
        true
    }

    /// Puts up to 64 rays from a row on into a packet, and says which places they take.
    #[inline(always)]
    fn fill<L: Lanes>(&self, packet: &mut Packet, first: usize, shear: bool) -> u64 {
        let count = (self.len() - first).min(PACKET);
        for start in (0..count).step_by(L::WIDTH) {
            let (origin, dir) = self.ways::<L>(first + start);
            let Load { t_min, source, .. } = self.loads(first + start);
            packet.set(start, origin, dir, t_min, L::splat(f64::INFINITY), source, shear);
        }
        u64::MAX >> (PACKET - count)
    }

    fn kind(&self, row: usize) -> RayKind {
        let [camera, mirror, _] = self.counts();
        if row < camera {
            RayKind::Camera
        } else if row < camera + mirror {
            RayKind::Mirror
        } else {
            RayKind::Refracted
        }
    }
}

/// What rays carry and where they come from, in lanes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Load<L: Lanes> {
    pub weight: Weight<L>,
    /// No hit up to here counts; with real optics none without a closer look ([`Leaving`](super::leaving::Leaving)).
    pub t_min: L,
    /// The primitive that the ray leaves, −1 for none.
    pub source: L,
    /// Row of the parent ray in the generation before.
    pub parent: L,
    /// Number of the pixel within the tile.
    pub pixel: L,
    /// In which solids the ray is: a handle of [`Media`](super::media::Media).
    pub medium: L,
    /// Which of the bands of light; [`WHITE`](super::media::WHITE) for all of it.
    pub band: L,
    /// With real optics, from the place that a mirrored ray leaves to where it is asked what it meets: [`back`](super::leaving::back)
    /// towards where its light came from. The same for one that goes on through what is only partly there
    /// ([`through`](super::leaving::through)). Zero for others.
    pub back: Vec3<L>,
}

/// Mirror rays, and behind them refracted ones.
///
/// Whole numbers travel as `f64`, in which every `u32` is exact, so that all columns are of one kind.
#[derive(Debug, Default)]
pub(crate) struct RayQueue {
    /// Origin, direction, attenuation, factor, `t_min`, source, parent, pixel, medium, band, `back`.
    rays: Columns<21>,
    /// How many mirror rays stand in front.
    mirror: usize,
}

const LOAD: usize = 6;
const PIXEL: usize = 15;

impl RayQueue {
    #[inline(always)]
    pub fn clear(&mut self) {
        self.rays.clear();
        self.mirror = 0;
    }

    /// Appends the mirror or refracted rays that the mask names, mirror rays first.
    #[inline(always)]
    pub fn push<L: Lanes>(&mut self, kind: RayKind, mask: L::Mask, rays: &Rays<L>) {
        if !mask.any() {
            return;
        }
        let Rays { origin: o, dir: d, load } = *rays;
        let Load { weight: Weight { attenuation: a, factor: f }, t_min, source, parent, pixel, medium, band, back: v } =
            load;
        let before = self.len();
        let row = [
            o.x, o.y, o.z, d.x, d.y, d.z, a.r, a.g, a.b, f.r, f.g, f.b, t_min, source, parent, pixel, medium, band,
            v.x, v.y, v.z,
        ];
        self.rays.push(mask, row);
        self.count(kind, self.len() - before);
    }

    #[inline(always)]
    fn count(&mut self, kind: RayKind, rays: usize) {
        if kind == RayKind::Mirror {
            self.mirror += rays;
        }
    }

    /// Appends all rays of another queue, which must not be of an earlier kind.
    #[inline(always)]
    pub fn append(&mut self, other: &Self) {
        self.rays.append(&other.rays);
        self.mirror += other.mirror;
    }

    /// Appends one ray of another queue.
    pub fn copy_row(&mut self, from: &Self, row: usize) {
        self.rays.copy_row(&from.rays, row);
        self.count(from.kind(row), 1);
    }

    /// The pixels of the rays.
    #[inline(always)]
    pub fn pixels(&self) -> impl Iterator<Item = usize> + '_ {
        self.rays.column(PIXEL).iter().map(|&pixel| index(pixel))
    }
}

impl Generation for RayQueue {
    #[inline(always)]
    fn len(&self) -> usize {
        self.rays.len()
    }

    #[inline(always)]
    fn counts(&self) -> [usize; 3] {
        [0, self.mirror, self.len() - self.mirror]
    }

    #[inline(always)]
    fn ways<L: Lanes>(&self, start: usize) -> (Vec3<L>, Vec3<L>) {
        let [x, y, z, dx, dy, dz] = self.rays.group(0, start);
        (Vec3::new(x, y, z), Vec3::new(dx, dy, dz))
    }

    #[inline(always)]
    fn loads<L: Lanes>(&self, start: usize) -> Load<L> {
        let [r, g, b, fr, fg, fb, t_min, source, parent, pixel, medium, band, x, y, z] = self.rays.group(LOAD, start);
        let weight = Weight { attenuation: Rgb::new(r, g, b), factor: Rgb::new(fr, fg, fb) };
        Load { weight, t_min, source, parent, pixel, medium, band, back: Vec3::new(x, y, z) }
    }

    #[inline(always)]
    fn pixel(&self, row: usize) -> usize {
        index(self.rays.at(PIXEL, row))
    }
}
