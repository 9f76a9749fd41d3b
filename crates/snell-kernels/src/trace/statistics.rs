//! What a render did: rays by kind and depth, and the light that was cut off.

use crate::color::Rgb;
use crate::geometry::Vec3;
use alloc::vec::Vec;
use core::cmp::Ordering;

/// Counts and losses of a render. Independent of threads, tiles and lanes.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Statistics {
    /// Rays by kind.
    pub rays: RayCounts,
    /// How many rays had 0, 1, 2, … bounces behind them. Shadow rays are not in it.
    pub depth: Vec<u64>,
    /// Branches that were cut short.
    pub lost: LostLight,
    /// Exits from solids that had not been entered.
    pub stray: StrayExits,
    /// Places where it is not said which of two media is there.
    pub overlaps: Overlaps,
}

/// Rays in two solids of the same priority and of different media that cross each other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Overlaps {
    /// How many such places rays have met.
    pub count: u64,
    /// The first of them.
    pub first: Option<Overlap>,
}

/// One of them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Overlap {
    /// The pixel whose ray met it: its number in the picture, row by row.
    pub pixel: u64,
    /// Primitives of the two solids: the one that is left, and one of the other.
    pub primitives: [u32; 2],
    /// Where the first ends within the second.
    pub point: Vec3,
}

impl Overlaps {
    /// Counts one.
    pub fn add(&mut self, overlap: Overlap) {
        self.merge(&Self { count: 1, first: Some(overlap) });
    }

    fn merge(&mut self, other: &Self) {
        self.count += other.count;
        // Of one pixel the one of the smallest coordinates: in which order rays are traced does not matter.
        let key = |o: &Overlap| (o.pixel, [o.point.x, o.point.y, o.point.z], o.primitives);
        let before = |a: &Overlap, b: &Overlap| key(a).partial_cmp(&key(b)).unwrap_or(Ordering::Equal);
        self.first = [self.first, other.first].into_iter().flatten().min_by(before);
    }
}

/// Rays that met a face from inside without having entered its solid, which was passed over, or that left the scene without
/// having left a solid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StrayExits {
    /// How many.
    pub count: u64,
    /// The first pixel of the picture that one of them belongs to: its number, row by row.
    pub first_pixel: Option<u64>,
}

impl StrayExits {
    /// Counts one.
    pub fn add(&mut self, pixel: usize) {
        self.merge(&Self { count: 1, first_pixel: Some(pixel as u64) });
    }

    fn merge(&mut self, other: &Self) {
        self.count += other.count;
        self.first_pixel = [self.first_pixel, other.first_pixel].into_iter().flatten().min();
    }
}

/// Rays by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RayCounts {
    /// From the eye.
    pub camera: u64,
    /// From a mirror.
    pub mirror: u64,
    /// From the far side of something transparent.
    pub refracted: u64,
    /// Towards a light.
    pub shadow: u64,
}

impl RayCounts {
    /// All rays together.
    pub fn total(&self) -> u64 {
        self.camera + self.mirror + self.refracted + self.shadow
    }

    /// Adds camera, mirror and refracted rays.
    pub fn add(&mut self, [camera, mirror, refracted]: [usize; 3]) {
        self.camera += camera as u64;
        self.mirror += mirror as u64;
        self.refracted += refracted as u64;
    }
}

/// Light behind branches that were cut off: at the depth limit, at the limit of rays per pixel, or below `min_throughput`.
///
/// Measured by the throughput of the rays that were not sent, as the mean of its channels without signs: a throughput of 0.05 means
/// that a white thing of radiance 1 behind that branch would have made the sample brighter by 0.05. What is really there was
/// not looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LostLight {
    /// Rays that were not sent.
    pub rays: u64,
    /// Sum of their throughput, in units of 2⁻³²: whole numbers add up to the same sum in any order. JSON has no numbers of this size.
    #[cfg_attr(feature = "serde", serde(with = "as_text"))]
    sum: u128,
    /// The worst pixel's sum over all of its samples, in the same units, and its number in row order.
    worst: (u64, u64),
}

#[cfg(feature = "serde")]
mod as_text {
    use alloc::string::{String, ToString};
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    pub fn serialize<S: Serializer>(sum: &u128, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&sum.to_string())
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u128, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(D::Error::custom)
    }
}

const UNIT: f64 = (1u64 << 32) as f64;

/// The throughput of a ray that is not sent, in whole units, which add up exactly.
pub fn lost_units(throughput: Rgb) -> u64 {
    // Saturates; NaN is 0.
    (Rgb::from(throughput.to_array().map(f64::abs)).mean() * UNIT) as u64
}

impl LostLight {
    /// Adds what one pixel lost, in whole units; `pixel` is its number in the whole picture, row by row.
    pub fn add(&mut self, pixel: u64, units: u64) {
        self.sum += u128::from(units);
        self.offer_worst((units, pixel));
    }

    /// The same, where the worst pixel is looked for anew among all: `pixels` are numbers and what was lost there.
    pub fn with_worst_of(self, pixels: impl Iterator<Item = (u64, u64)>) -> Self {
        let mut lost = Self { worst: (0, 0), ..self };
        pixels.for_each(|(pixel, units)| lost.offer_worst((units, pixel)));
        lost
    }

    /// The one of the two whose worst pixel is worse; of equally bad ones that of the first pixel.
    pub fn or_worse(mut self, other: &Self) -> Self {
        if other.worst.0 > 0 {
            self.offer_worst(other.worst);
        }
        self
    }

    /// The same, with the worst pixel of another.
    pub fn with_worst(self, other: &Self) -> Self {
        Self { worst: other.worst, ..self }
    }

    fn offer_worst(&mut self, (sum, pixel): (u64, u64)) {
        // Of equally bad pixels the first one in the picture.
        if sum > self.worst.0 || (sum == self.worst.0 && pixel < self.worst.1) {
            self.worst = (sum, pixel);
        }
    }

    /// Mean throughput lost per sample, of so many of them: pixels times samples per pixel.
    pub fn share(&self, samples: u64) -> f64 {
        self.sum as f64 / UNIT / samples.max(1) as f64
    }

    /// The largest throughput lost in one pixel of so many samples, as the mean of these.
    pub fn worst(&self, spp: u32) -> f64 {
        self.worst.0 as f64 / UNIT / f64::from(spp.max(1))
    }

    /// Column and row of that pixel in a picture of this width.
    pub fn worst_pixel(&self, width: u32) -> (u64, u64) {
        (self.worst.1 % u64::from(width.max(1)), self.worst.1 / u64::from(width.max(1)))
    }
}

impl Statistics {
    /// Adds what another worker did.
    pub fn merge(&mut self, other: &Self) {
        self.rays.camera += other.rays.camera;
        self.rays.mirror += other.rays.mirror;
        self.rays.refracted += other.rays.refracted;
        self.rays.shadow += other.rays.shadow;
        if self.depth.len() < other.depth.len() {
            self.depth.resize(other.depth.len(), 0);
        }
        for (sum, count) in self.depth.iter_mut().zip(&other.depth) {
            *sum += count;
        }
        self.stray.merge(&other.stray);
        self.overlaps.merge(&other.overlaps);
        self.lost.rays += other.lost.rays;
        self.lost.sum += other.lost.sum;
        if other.lost.rays > 0 {
            self.lost.offer_worst(other.lost.worst);
        }
    }

    /// Numbers of pixels in a tile become those in the picture, for what has been found out of the ordinary.
    pub fn renumber(&mut self, number_of: impl Fn(u64) -> u64) {
        self.stray.first_pixel = self.stray.first_pixel.map(&number_of);
        if let Some(overlap) = &mut self.overlaps.first {
            overlap.pixel = number_of(overlap.pixel);
        }
    }

    /// Counts the rays of a generation.
    pub fn count_generation(&mut self, depth: u32, rays: u64) {
        let depth = depth as usize;
        if self.depth.len() <= depth {
            self.depth.resize(depth + 1, 0);
        }
        self.depth[depth] += rays;
    }
}
