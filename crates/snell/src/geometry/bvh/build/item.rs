//! Boxes while a tree is built: four numbers a corner, so that one instruction works on all of a corner.

use crate::geometry::bounds::OuterBox;

/// `[f(0), f(1), f(2), f(3)]`. The compiler makes vectors of this form, but calls of `std::array::from_fn`.
#[inline(always)]
pub(super) fn four<T>(f: impl Fn(usize) -> T) -> [T; 4] {
    [f(0), f(1), f(2), f(3)]
}

/// `a < b ? a : b` in each place: one `minps` on x86, which `f32::min` with its rule for NaN is not.
#[inline(always)]
fn min4(a: [f32; 4], b: [f32; 4]) -> [f32; 4] {
    four(
        #[inline(always)]
        |i| if a[i] < b[i] { a[i] } else { b[i] },
    )
}

#[inline(always)]
fn max4(a: [f32; 4], b: [f32; 4]) -> [f32; 4] {
    four(
        #[inline(always)]
        |i| if a[i] > b[i] { a[i] } else { b[i] },
    )
}

/// A box; its fourth coordinate means nothing.
#[derive(Clone, Copy, Debug)]
#[repr(align(16))]
pub(super) struct Extent {
    pub min: [f32; 4],
    pub max: [f32; 4],
}

impl Extent {
    pub const EMPTY: Self = Self { min: [f32::INFINITY; 4], max: [f32::NEG_INFINITY; 4] };

    #[inline(always)]
    pub fn join(&self, other: &Self) -> Self {
        Self { min: min4(self.min, other.min), max: max4(self.max, other.max) }
    }

    #[inline(always)]
    pub fn join_point(&self, point: [f32; 4]) -> Self {
        Self { min: min4(point, self.min), max: max4(point, self.max) } // a NaN leaves it as it is
    }

    /// Half the surface, in `f64`, where the square of no `f32` overflows; 0 for the empty box.
    #[inline(always)]
    pub fn area(&self) -> f64 {
        let size = |axis: usize| {
            let size = f64::from(self.max[axis]) - f64::from(self.min[axis]);
            if size > 0.0 { size } else { 0.0 }
        };
        let (x, y, z) = (size(0), size(1), size(2));
        x * y + y * z + z * x
    }
}

/// A primitive that is being sorted into the tree. The fourth coordinates hold its number, as two halves that `f32`
/// represents exactly: their bits as they are would be subnormal numbers, with which some processors compute slowly.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item(pub Extent);

impl Item {
    pub fn new(id: u32, bounds: &OuterBox) -> Self {
        let ([a, b, c], [d, e, f]) = (bounds.min, bounds.max);
        Self(Extent { min: [a, b, c, (id >> 16) as f32], max: [d, e, f, (id & 0xffff) as f32] })
    }

    pub fn id(&self) -> u32 {
        (self.0.min[3] as u32) << 16 | self.0.max[3] as u32
    }

    /// Twice the centre.
    #[inline(always)]
    pub fn center(&self) -> [f32; 4] {
        four(
            #[inline(always)]
            |i| self.0.min[i] + self.0.max[i],
        )
    }
}
