//! Affine maps: rotate, scale, move, one after the other.

use super::Vec3;
use crate::lanes::Lanes;
use crate::lanes::elementary::sin_cos_degrees;

/// `p ↦ M·p + t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine {
    rows: [Vec3; 3],
    offset: Vec3,
}

impl Affine {
    /// The map that changes nothing.
    pub const IDENTITY: Self = Self {
        rows: [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0)],
        offset: Vec3::new(0.0, 0.0, 0.0),
    };

    /// Rotation about an axis through the origin, right-handed, in degrees (Rodrigues' formula
    /// `R = cos θ·I + sin θ·[k]× + (1 − cos θ)·k kᵀ`). `None` if the axis has no direction.
    pub fn rotation(axis: Vec3, degrees: f64) -> Option<Self> {
        let k = axis.unit();
        if !k.is_finite() {
            return None;
        }
        let (sin, cos) = sin_cos_degrees(degrees);
        let (s, c) = (k * sin, k * (1.0 - cos));
        Some(Self {
            rows: [
                Vec3::new(cos + k.x * c.x, k.x * c.y - s.z, k.x * c.z + s.y),
                Vec3::new(k.y * c.x + s.z, cos + k.y * c.y, k.y * c.z - s.x),
                Vec3::new(k.z * c.x - s.y, k.z * c.y + s.x, cos + k.z * c.z),
            ],
            offset: Vec3::default(),
        })
    }

    /// Scaling along the axes.
    pub fn scaling(factors: Vec3) -> Self {
        Self {
            rows: [Vec3::new(factors.x, 0.0, 0.0), Vec3::new(0.0, factors.y, 0.0), Vec3::new(0.0, 0.0, factors.z)],
            offset: Vec3::default(),
        }
    }

    /// Moving by a vector.
    pub fn translation(offset: Vec3) -> Self {
        Self { offset, ..Self::IDENTITY }
    }

    /// This map first, then `next`.
    pub fn then(self, next: Self) -> Self {
        let column = |axis: usize| Vec3::new(self.rows[0], self.rows[1], self.rows[2]).map_component(axis);
        let columns = [column(0), column(1), column(2)];
        let row = |r: Vec3| Vec3::new(r.dot(columns[0]), r.dot(columns[1]), r.dot(columns[2]));
        Self { rows: next.rows.map(row), offset: next.apply(self.offset) }
    }

    /// The image of a point.
    #[inline(always)]
    pub fn apply<L: Lanes>(&self, p: Vec3<L>) -> Vec3<L> {
        self.turn(p) + self.offset.splat()
    }

    /// The image of a direction: without the offset, and of another length.
    #[inline(always)]
    pub fn turn<L: Lanes>(&self, v: Vec3<L>) -> Vec3<L> {
        let [x, y, z] = self.rows;
        Vec3::new(x.splat().dot(v), y.splat().dot(v), z.splat().dot(v))
    }

    /// The image of a normal under the inverse of this map, of another length: across the image of the surface, and on the
    /// side from which its corners are still seen counter-clockwise, which a mirror swaps: `±Mᵀ·n`.
    pub fn turn_normal_back(&self, n: Vec3) -> Vec3 {
        let [x, y, z] = self.rows;
        let across = x * n.x + y * n.y + z * n.z;
        if self.mirrors() { -across } else { across }
    }

    /// Is the image of a body its mirror image, so that its faces look the other way?
    pub fn mirrors(&self) -> bool {
        let [x, y, z] = self.rows;
        x.cross(y).dot(z) < 0.0
    }

    /// The map that undoes this one; `None` where there is none, or none with finite numbers.
    ///
    /// By Gauss-Jordan elimination with partial pivoting, whose error is that of the condition of the map, `2⁻⁵³·‖M‖·‖M⁻¹‖`
    /// (Higham, *Accuracy and Stability of Numerical Algorithms*, 2002, section 14.4). Cofactors would lose all digits of
    /// the determinant where a map turns what it has stretched.
    pub fn inverse(&self) -> Option<Self> {
        let mut left = self.rows.map(<[f64; 3]>::from);
        let mut right = Self::IDENTITY.rows.map(<[f64; 3]>::from);
        for column in 0..3 {
            let size = |row: usize| left[row][column].abs();
            let pivot = (column..3).fold(column, |best, row| if size(row) > size(best) { row } else { best });
            left.swap(column, pivot);
            right.swap(column, pivot);
            // 0 makes numbers that are not finite.
            let divisor = left[column][column];
            let [own_left, own_right] = [left[column], right[column]].map(|row| row.map(|number| number / divisor));
            for row in 0..3 {
                let factor = left[row][column];
                for i in 0..3 {
                    left[row][i] -= factor * own_left[i];
                    right[row][i] -= factor * own_right[i];
                }
            }
            (left[column], right[column]) = (own_left, own_right);
        }
        let linear = Self { rows: right.map(Vec3::from), offset: Vec3::default() };
        let inverse = Self { offset: -linear.apply(self.offset), ..linear };
        inverse.rows.iter().chain([&inverse.offset]).all(|v| v.is_finite()).then_some(inverse)
    }

    /// By how much more than its own roundings a point is off that goes through this map and back through `inverse`, axis by axis:
    /// the largest sum of a row of `|M|·|M⁻¹|` (Skeel's condition; Higham, section 7.2). Stretching along axes costs nothing.
    pub fn condition(&self, inverse: &Self) -> f64 {
        let size = |v: Vec3| Vec3::new(v.x.abs(), v.y.abs(), v.z.abs());
        let [x, y, z] = inverse.rows.map(size);
        let sums = Vec3::new(x.x + x.y + x.z, y.x + y.y + y.z, z.x + z.y + z.z);
        self.rows.iter().map(|&row| size(row).dot(sums)).fold(0.0, f64::max)
    }

    /// The Frobenius norm of the map without its offset: no vector gets longer by more than this factor.
    pub fn norm(&self) -> f64 {
        self.rows.iter().map(|row| row.dot(*row)).sum::<f64>().sqrt()
    }
}

impl Vec3<Vec3> {
    /// One component of each of three rows: a column.
    fn map_component(self, axis: usize) -> Vec3 {
        Vec3::new(self.x.component(axis), self.y.component(axis), self.z.component(axis))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotate_scale_move_in_this_order() {
        let map = Affine::rotation(Vec3::new(1.0, 0.0, 0.0), 90.0)
            .unwrap()
            .then(Affine::scaling(Vec3::new(2.0, 3.0, 4.0)))
            .then(Affine::translation(Vec3::new(10.0, 0.0, 0.0)));
        // y turns to z (right-handed about x), then scales by 4, then moves.
        assert_eq!(map.apply(Vec3::new(0.0, 1.0, 0.0)), Vec3::new(10.0, 0.0, 4.0));
        assert_eq!(map.apply(Vec3::new(1.0, 0.0, 1.0)), Vec3::new(12.0, -3.0, 0.0));
        assert_eq!(Affine::rotation(Vec3::default(), 10.0), None);
    }

    #[test]
    fn the_inverse_undoes() {
        let map = Affine::rotation(Vec3::new(1.0, 2.0, 3.0), 50.0)
            .unwrap()
            .then(Affine::scaling(Vec3::new(2.0, -0.5, 4.0)))
            .then(Affine::translation(Vec3::new(10.0, 20.0, -3.0)));
        let inverse = map.inverse().unwrap();
        let p = Vec3::new(1.0, -2.0, 0.5);
        assert!(
            (inverse.apply(map.apply(p)) - p).length() < 1e-14,
            "a dozen roundings of numbers up to 30, scaled by 2"
        );
        // A tangent and a normal stay across each other.
        let (tangent, normal) = (Vec3::new(1.0, 1.0, 0.0), Vec3::new(1.0, -1.0, 3.0));
        assert!(map.turn(tangent).dot(inverse.turn_normal_back(normal)).abs() < 1e-14);
        // The map is a mirror: by the right-hand rule on the images of two tangents.
        let other = Vec3::new(3.0, 0.0, -1.0);
        let rule = map.turn(tangent).cross(map.turn(other));
        assert!(rule.dot(inverse.turn_normal_back(tangent.cross(other))) > 0.0);
        assert_eq!(Affine::scaling(Vec3::new(1.0, 0.0, 1.0)).inverse(), None);
        assert!(map.norm() >= 4.0);
    }

    #[test]
    fn a_third_of_a_turn_about_the_diagonal_permutes_the_axes() {
        let map = Affine::rotation(Vec3::new(1.0, 1.0, 1.0), 120.0).unwrap();
        let p = map.apply(Vec3::new(1.0, 2.0, 3.0)) - Vec3::new(3.0, 1.0, 2.0);
        assert!(p.length() < 3e-15, "a few roundings of numbers up to 3: {p:?}");
    }

    /// As near as the condition of the map allows, `2⁻⁵³·‖M‖·‖M⁻¹‖` of the inverse: hits of instances count on it.
    #[test]
    fn the_inverse_of_a_stretched_map_is_as_good_as_its_condition() {
        for exponent in 0..=6 {
            let long = libm::exp10(f64::from(exponent));
            let first = Affine::rotation(Vec3::new(1.0, -2.0, 0.5), 35.0).unwrap();
            let second = Affine::rotation(Vec3::new(0.3, 1.0, 1.0), 71.0).unwrap();
            let map = first.then(Affine::scaling(Vec3::new(long, 1.0, 1.0 / long))).then(second);
            let inverse = map.inverse().unwrap();
            let both = inverse.then(map);
            let off = Affine { rows: [0, 1, 2].map(|i| both.rows[i] - Affine::IDENTITY.rows[i]), ..both }.norm();
            let bound = 32.0 * f64::EPSILON * map.norm() * inverse.norm();
            assert!(off <= bound, "stretched by {long}: off by {off}, not {bound}");
        }
    }
}
