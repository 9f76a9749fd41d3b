//! For tests: answers about lines and triangles in exact arithmetic, of the numbers as they were rounded.

use crate::geometry::Vec3;
use dashu_float::FBig;

type Number = FBig<dashu_float::round::mode::Zero, 2>;

/// A vector without roundings.
#[derive(Clone, Debug)]
pub struct Exact([Number; 3]);

fn number(value: f64) -> Number {
    // An unlimited precision: sums, differences and products are exact.
    Number::try_from(value).unwrap_or(Number::ZERO).with_precision(0).value()
}

impl Exact {
    fn of(v: Vec3) -> Self {
        Self([v.x, v.y, v.z].map(number))
    }

    fn minus(&self, other: &Self) -> Self {
        Self(core::array::from_fn(|i| &self.0[i] - &other.0[i]))
    }

    fn cross(&self, other: &Self) -> Self {
        let ([ax, ay, az], [bx, by, bz]) = (&self.0, &other.0);
        Self([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])
    }

    fn dot(&self, other: &Self) -> Number {
        let ([ax, ay, az], [bx, by, bz]) = (&self.0, &other.0);
        ax * bx + ay * by + az * bz
    }

    fn rounded(&self) -> Vec3 {
        let [x, y, z] = &self.0;
        Vec3::new(x.to_f64().value(), y.to_f64().value(), z.to_f64().value())
    }

    /// `(b − a) × (c − a)`, rounded once.
    pub fn area_vector([a, b, c]: [Vec3; 3]) -> Vec3 {
        let [a, b, c] = [a, b, c].map(Self::of);
        b.minus(&a).cross(&c.minus(&a)).rounded()
    }

    /// For each corner the volume `det(dir, …)` of the other two as the line sees them, rounded once: all of one sign where the line
    /// goes through the triangle (Plücker).
    pub fn edge_functions(origin: Vec3, dir: Vec3, corners: [Vec3; 3]) -> [f64; 3] {
        let (o, dir) = (Self::of(origin), Self::of(dir));
        let [a, b, c] = corners.map(|v| Self::of(v).minus(&o));
        [c.cross(&b), a.cross(&c), b.cross(&a)].map(|cross| cross.dot(&dir).to_f64().value())
    }
}
