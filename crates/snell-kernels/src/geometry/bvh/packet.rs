//! Up to 64 rays in columns, as they go through the tree.

use super::packet_traversal::BeamWaiting;
use super::single_ray::Walkers;
use crate::geometry::Vec3;
use crate::geometry::ray::{Heading, Ray, axes, inverse};
use crate::geometry::shape::Shape;
use crate::lanes::{Lanes, Mask};
use alloc::boxed::Box;
use alloc::vec::Vec;
use core::marker::PhantomData;

/// Rays in a packet.
pub const SIZE: usize = 64;

type Column = [f64; SIZE];

/// 64 rays in columns, and the nearest hit of each so far. The columns come first and begin at cache lines, so that no group
/// of lanes lies in two of them.
#[derive(Debug)]
#[repr(C, align(64))]
pub struct Packet {
    pub(super) origin: [Column; 3],
    pub(super) dir: [Column; 3],
    pub(super) inv_dir: [Column; 3],
    /// First two numbers of the shears; the third is the inverse of the main component.
    pub(super) shear: [Column; 2],
    /// Hits lie strictly beyond this distance.
    pub t_min: Column,
    /// The primitive that a ray leaves and cannot hit.
    pub source: Column,
    /// Distance of the nearest hit so far; `t_max` without one.
    pub t: Column,
    /// The primitive hit there, −1 without one.
    pub primitive: Column,
    /// Are spheres crossed from either side, or entered from outside only?
    pub two_sided: bool,
    /// Which rays go towards smaller coordinates, by axis.
    pub(super) negative: [u64; 3],
    /// Which rays have this axis as their main one.
    pub(super) main: [u64; 3],
    /// Boxes that wait.
    pub(super) waiting: Vec<BeamWaiting>,
    /// Rays that go alone.
    pub(super) walkers: Walkers,
    /// Rays in the space of a model.
    pub(super) inner: Option<Box<Packet>>,
}

impl Default for Packet {
    fn default() -> Self {
        let zero = [0.0; SIZE];
        Self {
            origin: [zero; 3],
            dir: [zero; 3],
            inv_dir: [zero; 3],
            shear: [zero; 2],
            t_min: zero,
            source: zero,
            t: zero,
            primitive: zero,
            two_sided: false,
            negative: [0; 3],
            main: [0; 3],
            waiting: Vec::new(),
            walkers: None,
            inner: None,
        }
    }
}

/// The groups of lanes that have rays among these: where each starts, and which of its lanes.
pub struct Groups<L> {
    rays: u64,
    lanes: PhantomData<L>,
}

#[inline(always)]
pub fn groups<L: Lanes>(rays: u64) -> Groups<L> {
    Groups { rays, lanes: PhantomData }
}

impl<L: Lanes> Iterator for Groups<L> {
    type Item = (usize, L::Mask);
    #[inline(always)]
    fn next(&mut self) -> Option<Self::Item> {
        if self.rays == 0 {
            return None;
        }
        let start = self.rays.trailing_zeros() as usize & (SIZE - L::WIDTH);
        let bits = (self.rays >> start) as u32 & (!0 >> (32 - L::WIDTH));
        self.rays &= !(u64::from(bits) << start);
        Some((start, L::Mask::from_bits(bits)))
    }
}

impl Packet {
    /// Sets the rays of one group of lanes, with their shears if they are wanted, which not all shapes need.
    #[inline(always)]
    #[allow(clippy::too_many_arguments, reason = "a ray in lanes is many numbers, and nobody else wants them together")]
    pub fn set<L: Lanes>(
        &mut self,
        start: usize,
        origin: Vec3<L>,
        dir: Vec3<L>,
        t_min: L,
        t_max: L,
        source: L,
        shear: bool,
    ) {
        let (x, y, z) = (dir.x, dir.y, dir.z);
        let (ax, ay, az) = (x.max(-x), y.max(-y), z.max(-z));
        let along_z = az.ge(ax) & az.ge(ay);
        let along_y = !along_z & ay.ge(ax);
        let along_x = !along_z & !along_y;
        let keep = !(u64::MAX >> (SIZE - L::WIDTH) << start);
        let (origins, dirs): ([L; 3], [L; 3]) = (origin.into(), dir.into());
        let inverses = [inverse(x), inverse(y), inverse(z)];
        let mains = [along_x, along_y, along_z];
        for axis in 0..3 {
            origins[axis].store(&mut self.origin[axis][start..]);
            dirs[axis].store(&mut self.dir[axis][start..]);
            inverses[axis].store(&mut self.inv_dir[axis][start..]);
            let negative = inverses[axis].lt(L::splat(0.0));
            self.negative[axis] = self.negative[axis] & keep | u64::from(negative.bits()) << start;
            self.main[axis] = self.main[axis] & keep | u64::from(mains[axis].bits()) << start;
        }
        if shear {
            // The order of the axes as in `ray::axes`.
            let main = L::select(along_x, x, L::select(along_y, y, z));
            (-(L::select(along_x, y, x) / main)).store(&mut self.shear[0][start..]);
            (-(L::select(along_z, y, z) / main)).store(&mut self.shear[1][start..]);
        }
        t_min.store(&mut self.t_min[start..]);
        t_max.store(&mut self.t[start..]);
        source.store(&mut self.source[start..]);
        L::splat(-1.0).store(&mut self.primitive[start..]);
    }

    /// Lets one ray start elsewhere.
    #[inline(always)]
    pub fn start_at(&mut self, ray: usize, Vec3 { x, y, z }: Vec3) {
        (self.origin[0][ray], self.origin[1][ray], self.origin[2][ray]) = (x, y, z);
    }

    /// Moves the starts of the rays of one group of lanes.
    #[inline(always)]
    pub fn move_starts<L: Lanes>(&mut self, start: usize, by: Vec3<L>) {
        let by: [L; 3] = by.into();
        for axis in 0..3 {
            let column = &mut self.origin[axis][start..];
            (L::load(column) + by[axis]).store(column);
        }
    }

    /// Origins and directions of the rays of one group of lanes.
    #[inline(always)]
    pub fn lines<L: Lanes>(&self, start: usize) -> (Vec3<L>, Vec3<L>) {
        (Self::vector(&self.origin, start, [0, 1, 2]), Self::vector(&self.dir, start, [0, 1, 2]))
    }

    #[inline(always)]
    pub(super) fn vector<L: Lanes>(columns: &[Column; 3], start: usize, [x, y, z]: [usize; 3]) -> Vec3<L> {
        Vec3::new(L::load(&columns[x][start..]), L::load(&columns[y][start..]), L::load(&columns[z][start..]))
    }

    /// The rays of one group of lanes, as a shape wants them.
    #[inline(always)]
    pub(super) fn rays<S: Shape, L: Lanes>(&self, start: usize, octant: &Octant) -> Ray<L> {
        if !S::SHEARED {
            let (origin, dir) = self.lines(start);
            return Ray::unsheared(origin, dir);
        }
        let axes = octant.axes;
        let heading = Heading {
            dir: Self::vector(&self.dir, start, axes),
            inverse: Self::vector(&self.inv_dir, start, axes),
            shear: [L::load(&self.shear[0][start..]), L::load(&self.shear[1][start..])],
        };
        Ray { origin: Self::vector(&self.origin, start, axes), heading, axes }
    }

    /// One ray in every lane, as a shape wants it.
    #[inline(always)]
    pub(super) fn ray<S: Shape, L: Lanes>(&self, ray: usize, octant: &Octant) -> Ray<L> {
        if !S::SHEARED {
            let (origin, dir) = (Self::one(&self.origin, ray, [0, 1, 2]), Self::one(&self.dir, ray, [0, 1, 2]));
            return Ray::unsheared(origin, dir);
        }
        let axes = octant.axes;
        let heading = Heading {
            dir: Self::one(&self.dir, ray, axes),
            inverse: Self::one(&self.inv_dir, ray, axes),
            shear: [L::splat(self.shear[0][ray]), L::splat(self.shear[1][ray])],
        };
        Ray { origin: Self::one(&self.origin, ray, axes), heading, axes }
    }

    /// Where a ray goes.
    #[inline(always)]
    pub(super) fn octant(&self, ray: usize) -> Octant {
        let [x, y, z] = self.negative;
        let bit = |set: u64| (set >> ray & 1) as usize;
        let main = if bit(self.main[0]) == 1 { 0 } else { 2 - bit(self.main[1]) };
        Octant { side: [bit(x), bit(y), bit(z)], axes: axes(main) }
    }

    /// A vector of one ray in every lane.
    #[inline(always)]
    fn one<L: Lanes>(columns: &[Column; 3], ray: usize, [x, y, z]: [usize; 3]) -> Vec3<L> {
        Vec3::new(L::splat(columns[x][ray]), L::splat(columns[y][ray]), L::splat(columns[z][ray]))
    }

    /// The largest distance that still counts for any of these rays; at least 0, where boxes begin.
    #[inline(always)]
    pub(super) fn farthest<L: Lanes>(&self, rays: u64) -> f64 {
        let none = L::splat(0.0);
        let mut farthest = none;
        for (start, mask) in groups::<L>(rays) {
            farthest = L::select(mask, L::load(&self.t[start..]), none).max(farthest);
        }
        farthest.largest()
    }
}

/// What rays have in common that go the same way.
#[derive(Clone, Copy, Debug, Default)]
pub struct Octant {
    /// For each axis 1 where they go towards smaller coordinates.
    pub side: [usize; 3],
    /// The order of the axes for their shear, the main one last.
    pub axes: [usize; 3],
}
