//! Linear colour.

use crate::lanes::table::Field;
use crate::lanes::{Lanes, MAX_WIDTH};
use core::ops::{Add, Mul, Sub};

/// Red, green and blue, linear, 1 for white. In a file: `0.5`, or `[0.5, 0.2, 0.1]`.
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Zeroable)]
#[repr(C)] // three numbers in a row: see `memory::numbers`
pub struct Rgb<L = f64> {
    /// Red.
    pub r: L,
    /// Green.
    pub g: L,
    /// Blue.
    pub b: L,
}

impl<L> Rgb<L> {
    /// A colour of its three components.
    pub const fn new(r: L, g: L, b: L) -> Self {
        Self { r, g, b }
    }
}

impl Rgb<f64> {
    /// The same value three times.
    pub const fn gray(value: f64) -> Self {
        Self::new(value, value, value)
    }

    /// Red, green, blue.
    pub const fn to_array(self) -> [f64; 3] {
        [self.r, self.g, self.b]
    }

    /// The same colour in every lane.
    #[inline(always)]
    pub fn splat<L: Lanes>(self) -> Rgb<L> {
        Rgb::new(L::splat(self.r), L::splat(self.g), L::splat(self.b))
    }

    /// Mean of the three components.
    pub fn mean(self) -> f64 {
        (self.r + self.g + self.b) / 3.0
    }
}

impl From<[f64; 3]> for Rgb<f64> {
    fn from([r, g, b]: [f64; 3]) -> Self {
        Self { r, g, b }
    }
}

impl<L> From<Rgb<L>> for [L; 3] {
    #[inline(always)]
    fn from(c: Rgb<L>) -> Self {
        [c.r, c.g, c.b]
    }
}

impl<L: Lanes> Field<L> for Rgb<L> {
    const COLUMNS: usize = 3;
    #[inline(always)]
    fn from_columns(columns: &[L]) -> Self {
        Self::new(columns[0], columns[1], columns[2])
    }
    #[inline(always)]
    fn to_columns(self, columns: &mut [L]) {
        columns[..3].copy_from_slice(&[self.r, self.g, self.b]);
    }
}

impl<L: Lanes> Rgb<L> {
    /// No light.
    #[inline(always)]
    pub fn black() -> Self {
        Self::new(L::splat(0.0), L::splat(0.0), L::splat(0.0))
    }

    /// `value(lane)` in each lane.
    #[inline(always)]
    pub fn from_fn(value: impl Fn(usize) -> Rgb<f64>) -> Self {
        let mut columns = [[0.0; MAX_WIDTH]; 3];
        for lane in 0..L::WIDTH {
            let Rgb { r, g, b } = value(lane);
            (columns[0][lane], columns[1][lane], columns[2][lane]) = (r, g, b);
        }
        Self::new(L::load(&columns[0]), L::load(&columns[1]), L::load(&columns[2]))
    }

    /// The colour in one lane.
    #[inline(always)]
    pub fn lane(self, lane: usize) -> Rgb<f64> {
        Rgb::new(self.r.lane(lane), self.g.lane(lane), self.b.lane(lane))
    }

    /// `yes` where the mask says so, else `no`.
    #[inline(always)]
    pub fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self::new(L::select(mask, yes.r, no.r), L::select(mask, yes.g, no.g), L::select(mask, yes.b, no.b))
    }

    /// Is any component other than zero?
    #[inline(always)]
    pub fn not_black(self) -> L::Mask {
        let zero = L::splat(0.0);
        !(self.r.eq(zero) & self.g.eq(zero) & self.b.eq(zero))
    }
}

impl<L: Lanes> Add for Rgb<L> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.r + other.r, self.g + other.g, self.b + other.b)
    }
}

impl<L: Lanes> Sub for Rgb<L> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.r - other.r, self.g - other.g, self.b - other.b)
    }
}

/// Component by component: a filter.
impl<L: Lanes> Mul for Rgb<L> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::new(self.r * other.r, self.g * other.g, self.b * other.b)
    }
}

/// Scaling by a number.
impl<L: Lanes> Mul<L> for Rgb<L> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: L) -> Self {
        Self::new(self.r * factor, self.g * factor, self.b * factor)
    }
}

#[cfg(feature = "serde")]
mod as_value {
    use super::Rgb;
    use core::fmt;
    use serde::de::{Error, SeqAccess, Visitor};
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    impl Serialize for Rgb<f64> {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            // Gray is written as people write it.
            if self.r.to_bits() == self.g.to_bits() && self.g.to_bits() == self.b.to_bits() {
                self.r.serialize(serializer)
            } else {
                self.to_array().serialize(serializer)
            }
        }
    }

    impl<'de> Deserialize<'de> for Rgb<f64> {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            struct NumberOrThree;
            impl<'de> Visitor<'de> for NumberOrThree {
                type Value = Rgb<f64>;
                fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                    f.write_str("a colour: one number or three, like 0.5 or [1.0, 0.5, 0.0]")
                }
                fn visit_f64<E: Error>(self, v: f64) -> Result<Self::Value, E> {
                    Ok(Rgb::gray(v))
                }
                fn visit_i64<E: Error>(self, v: i64) -> Result<Self::Value, E> {
                    Ok(Rgb::gray(v as f64))
                }
                fn visit_u64<E: Error>(self, v: u64) -> Result<Self::Value, E> {
                    Ok(Rgb::gray(v as f64))
                }
                fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Self::Value, A::Error> {
                    let mut c = [0.0; 3];
                    for (i, component) in c.iter_mut().enumerate() {
                        *component = seq.next_element()?.ok_or_else(|| Error::invalid_length(i, &self))?;
                    }
                    if seq.next_element::<f64>()?.is_some() {
                        return Err(Error::invalid_length(4, &self));
                    }
                    Ok(c.into())
                }
            }
            deserializer.deserialize_any(NumberOrThree)
        }
    }
}

#[cfg(feature = "schemars")]
mod as_schema {
    use super::Rgb;
    use alloc::borrow::Cow;
    use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};

    impl JsonSchema for Rgb<f64> {
        fn schema_name() -> Cow<'static, str> {
            "Rgb".into()
        }
        fn json_schema(_: &mut SchemaGenerator) -> Schema {
            json_schema!({
                "description": "Linear colour, 1 for white: one number for gray, or red, green, blue.",
                "anyOf": [
                    { "type": "number" },
                    { "type": "array", "items": { "type": "number" }, "minItems": 3, "maxItems": 3 }
                ]
            })
        }
    }
}
