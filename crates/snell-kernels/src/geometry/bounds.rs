//! Axis-aligned boxes: `f64` for measuring a scene, `f32` rounded outward for the tree.

use super::Vec3;

/// An axis-aligned box in `f64`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates.
    pub min: Vec3,
    /// Largest coordinates.
    pub max: Vec3,
}

impl Bounds {
    /// The box that holds nothing.
    pub const EMPTY: Self = Self {
        min: Vec3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
        max: Vec3::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY),
    };

    /// The box of some points.
    #[inline]
    pub fn of(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| b.union(Self { min: p, max: p }))
    }

    /// The box of two boxes.
    #[inline]
    pub fn union(self, other: Self) -> Self {
        let (a, b) = (self, other);
        Self {
            min: Vec3::new(a.min.x.min(b.min.x), a.min.y.min(b.min.y), a.min.z.min(b.min.z)),
            max: Vec3::new(a.max.x.max(b.max.x), a.max.y.max(b.max.y), a.max.z.max(b.max.z)),
        }
    }

    /// Do two boxes have a point in common?
    #[inline]
    pub fn meets(&self, other: &Self) -> bool {
        let (a, b) = (self, other);
        let shared = |axis: usize| {
            a.min.component(axis) <= b.max.component(axis) && b.min.component(axis) <= a.max.component(axis)
        };
        shared(0) && shared(1) && shared(2)
    }

    /// The eight corners.
    #[inline]
    pub fn corners(&self) -> [Vec3; 8] {
        let (a, b) = (self.min, self.max);
        core::array::from_fn(|i| {
            let pick = |bit: usize, low: f64, high: f64| if i >> bit & 1 == 0 { low } else { high };
            Vec3::new(pick(0, a.x, b.x), pick(1, a.y, b.y), pick(2, a.z, b.z))
        })
    }

    /// The largest coordinate, whatever its sign.
    #[inline]
    pub fn farthest(&self) -> f64 {
        let numbers = [self.min.x, self.min.y, self.min.z, self.max.x, self.max.y, self.max.z];
        numbers.into_iter().map(f64::abs).fold(0.0, f64::max)
    }

    /// Length of the diagonal; 0 for the empty box.
    #[inline]
    pub fn diagonal(&self) -> f64 {
        if self.min.x > self.max.x { 0.0 } else { (self.max - self.min).length() }
    }
}

/// A box of the tree: `f32`, never smaller than what it holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OuterBox {
    /// Smallest coordinates, rounded down.
    pub min: [f32; 3],
    /// Largest coordinates, rounded up.
    pub max: [f32; 3],
}

impl OuterBox {
    /// Grows a box by `margin` on every side and rounds it outward, at least to the next `f32`: where the margin is
    /// below a unit in the last place of a coordinate, and would be lost, that step is larger than it.
    #[inline]
    pub fn around(bounds: &Bounds, margin: f64) -> Self {
        let b = bounds;
        Self {
            min: [b.min.x, b.min.y, b.min.z].map(|v| round_down(v - margin)),
            max: [b.max.x, b.max.y, b.max.z].map(|v| round_up(v + margin)),
        }
    }
}

#[inline]
fn round_down(value: f64) -> f32 {
    let near = value as f32;
    if f64::from(near) >= value { near.next_down() } else { near }
}

#[inline]
fn round_up(value: f64) -> f32 {
    -round_down(-value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn rounding_goes_outward_and_not_far(value in -1e15..1e15f64) {
            let (down, up) = (f64::from(round_down(value)), f64::from(round_up(value)));
            prop_assert!(down < value && value < up);
            prop_assert!(up - down <= value.abs() * 2.5e-7 + 1e-40); // two units in the last place of f32
        }
    }
}
