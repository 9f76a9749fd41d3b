//! The rays of a generation, as columns.

use crate::film::Rgb;
use crate::geometry::{Ray, Vec3};
use crate::lanes::{Lanes, Mask};
use crate::world::NO_PRIMITIVE;

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

/// Three columns of numbers: a vector or a colour per row.
#[derive(Debug, Default)]
pub(crate) struct Columns {
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    pub z: Vec<f64>,
}

impl Columns {
    pub fn clear(&mut self) {
        self.x.clear();
        self.y.clear();
        self.z.clear();
    }

    #[inline(always)]
    pub fn push(&mut self, [x, y, z]: [f64; 3]) {
        self.x.push(x);
        self.y.push(y);
        self.z.push(z);
    }

    #[inline(always)]
    pub fn vector<L: Lanes>(&self, start: usize) -> Vec3<L> {
        Vec3::new(L::load(&self.x[start..]), L::load(&self.y[start..]), L::load(&self.z[start..]))
    }

    #[inline(always)]
    pub fn color<L: Lanes>(&self, start: usize) -> Rgb<L> {
        Rgb::new(L::load(&self.x[start..]), L::load(&self.y[start..]), L::load(&self.z[start..]))
    }

    #[inline(always)]
    pub fn row(&self, row: usize) -> [f64; 3] {
        [self.x[row], self.y[row], self.z[row]]
    }

    /// Appends the lanes that the mask names.
    #[inline(always)]
    pub fn compress<L: Lanes>(&mut self, mask: L::Mask, v: [L; 3]) {
        v[0].compress(mask, &mut self.x);
        v[1].compress(mask, &mut self.y);
        v[2].compress(mask, &mut self.z);
    }

    /// Replaces the rows of the lanes that the mask names.
    #[inline(always)]
    pub fn overwrite<L: Lanes>(&mut self, start: usize, mask: L::Mask, v: [L; 3]) {
        for lane in (0..L::WIDTH).filter(|&i| mask.test(i)) {
            let row = start + lane;
            (self.x[row], self.y[row], self.z[row]) = (v[0].lane(lane), v[1].lane(lane), v[2].lane(lane));
        }
    }

    fn copy_row(&mut self, from: &Self, row: usize) {
        self.push(from.row(row));
    }
}

/// What a ray carries: `a` and `f`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Weight<L: Lanes> {
    pub attenuation: Rgb<L>,
    pub factor: Rgb<L>,
}

impl<L: Lanes> Weight<L> {
    /// Is there anything left of it?
    #[inline(always)]
    pub fn carries(&self) -> L::Mask {
        (self.factor * self.attenuation).not_black()
    }
}

/// Rays that are traced together, in a fixed order.
#[derive(Debug, Default)]
pub(crate) struct RayQueue {
    pub origin: Columns,
    pub dir: Columns,
    pub t_min: Vec<f64>,
    /// What the surfaces passed so far leave of the light: the lecture's `a`.
    pub attenuation: Columns,
    /// The product of the parents' factors, which the lecture applies besides `a`.
    pub factor: Columns,
    /// Number of the pixel within the tile.
    pub pixel: Vec<u32>,
    /// The primitive that the ray leaves.
    pub source: Vec<u32>,
    pub kind: Vec<RayKind>,
    /// Row of the parent ray in the generation before.
    pub parent: Vec<u32>,
}

impl RayQueue {
    pub fn len(&self) -> usize {
        self.pixel.len()
    }

    pub fn clear(&mut self) {
        let Self { origin, dir, t_min, attenuation, factor, pixel, source, kind, parent } = self;
        for columns in [origin, dir, attenuation, factor] {
            columns.clear();
        }
        t_min.clear();
        for column in [pixel, source, parent] {
            column.clear();
        }
        kind.clear();
    }

    pub fn push_camera_ray(&mut self, pixel: u32, origin: Vec3, dir: Vec3, t_min: f64) {
        self.origin.push(origin.into());
        self.dir.push(dir.into());
        self.t_min.push(t_min);
        self.attenuation.push([1.0; 3]);
        self.factor.push([1.0; 3]);
        self.pixel.push(pixel);
        self.source.push(NO_PRIMITIVE);
        self.kind.push(RayKind::Camera);
        self.parent.push(0);
    }

    pub fn copy_row(&mut self, from: &Self, row: usize) {
        self.origin.copy_row(&from.origin, row);
        self.dir.copy_row(&from.dir, row);
        self.t_min.push(from.t_min[row]);
        self.attenuation.copy_row(&from.attenuation, row);
        self.factor.copy_row(&from.factor, row);
        self.pixel.push(from.pixel[row]);
        self.source.push(from.source[row]);
        self.kind.push(from.kind[row]);
        self.parent.push(from.parent[row]);
    }

    /// What this ray can add to its pixel for each unit of radiance: `factor·attenuation`.
    pub fn throughput(&self, row: usize) -> Rgb {
        Rgb::from(self.factor.row(row)) * Rgb::from(self.attenuation.row(row))
    }

    /// `WIDTH` rays from a row on, the last one repeated at the end, and which of them are real.
    #[inline(always)]
    pub fn rays<L: Lanes>(&self, start: usize) -> (Ray<L>, L, L::Mask) {
        let ray = Ray {
            origin: self.origin.vector(start),
            dir: self.dir.vector(start),
            t_min: L::load(&self.t_min[start..]),
            t_max: L::splat(f64::INFINITY),
        };
        (ray, ids(&self.source, start), L::Mask::first(self.len() - start))
    }
}

/// A column of ids as lanes.
#[inline(always)]
pub(crate) fn ids<L: Lanes>(column: &[u32], start: usize) -> L {
    let last = column.len() - 1;
    L::from_fn(|i| f64::from(column[(start + i).min(last)]))
}
