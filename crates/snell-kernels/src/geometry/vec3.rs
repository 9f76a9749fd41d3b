//! Three-dimensional vectors, one or several lanes wide.

use crate::lanes::table::Field;
use crate::lanes::{Lanes, MAX_WIDTH};
use core::ops::{Add, Mul, Neg, Sub};

/// A point, direction or normal. `L` is `f64`, or several lanes of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Vec3<L = f64> {
    /// Component along the first axis.
    pub x: L,
    /// Component along the second axis.
    pub y: L,
    /// Component along the third axis.
    pub z: L,
}

impl<L> Vec3<L> {
    /// A vector of its three components.
    pub const fn new(x: L, y: L, z: L) -> Self {
        Self { x, y, z }
    }
}

impl Vec3<f64> {
    /// The same vector in every lane.
    #[inline(always)]
    pub fn splat<L: Lanes>(self) -> Vec3<L> {
        Vec3::new(L::splat(self.x), L::splat(self.y), L::splat(self.z))
    }

    /// Are all components finite?
    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.z.is_finite()
    }

    /// Component by number: 0 is x, 1 is y, anything else z.
    pub fn component(self, axis: usize) -> f64 {
        match axis {
            0 => self.x,
            1 => self.y,
            _ => self.z,
        }
    }
}

impl From<[f64; 3]> for Vec3<f64> {
    fn from([x, y, z]: [f64; 3]) -> Self {
        Self { x, y, z }
    }
}

impl<L> From<Vec3<L>> for [L; 3] {
    #[inline(always)]
    fn from(v: Vec3<L>) -> Self {
        [v.x, v.y, v.z]
    }
}

impl<L: Lanes> Field<L> for Vec3<L> {
    const COLUMNS: usize = 3;
    #[inline(always)]
    fn from_columns(columns: &[L]) -> Self {
        Self::new(columns[0], columns[1], columns[2])
    }
    #[inline(always)]
    fn to_columns(self, columns: &mut [L]) {
        columns[..3].copy_from_slice(&[self.x, self.y, self.z]);
    }
}

impl<L: Lanes> Vec3<L> {
    /// `value(lane)` in each lane.
    #[inline(always)]
    pub fn from_fn(value: impl Fn(usize) -> Vec3<f64>) -> Self {
        let mut columns = [[0.0; MAX_WIDTH]; 3];
        for lane in 0..L::WIDTH {
            let Vec3 { x, y, z } = value(lane);
            (columns[0][lane], columns[1][lane], columns[2][lane]) = (x, y, z);
        }
        Self::new(L::load(&columns[0]), L::load(&columns[1]), L::load(&columns[2]))
    }

    /// The vector in one lane.
    #[inline(always)]
    pub fn lane(self, lane: usize) -> Vec3<f64> {
        Vec3::new(self.x.lane(lane), self.y.lane(lane), self.z.lane(lane))
    }

    /// Scalar product, added in the order x, y, z.
    #[inline(always)]
    pub fn dot(self, other: Self) -> L {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Vector product, right-handed.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    /// Length.
    #[inline(always)]
    pub fn length(self) -> L {
        self.dot(self).sqrt()
    }

    /// The vector divided by its length; NaN for the zero vector.
    #[inline(always)]
    pub fn unit(self) -> Self {
        let length = self.length();
        Self::new(self.x / length, self.y / length, self.z / length)
    }

    /// `yes` where the mask says so, else `no`.
    #[inline(always)]
    pub fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self::new(L::select(mask, yes.x, no.x), L::select(mask, yes.y, no.y), L::select(mask, yes.z, no.z))
    }
}

impl<L: Lanes> Add for Vec3<L> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<L: Lanes> Sub for Vec3<L> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl<L: Lanes> Neg for Vec3<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

/// Scaling by a number.
impl<L: Lanes> Mul<L> for Vec3<L> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: L) -> Self {
        Self::new(self.x * factor, self.y * factor, self.z * factor)
    }
}
