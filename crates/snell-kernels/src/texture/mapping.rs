//! Where on a texture a point of a surface lies, or a direction on the picture of what is all around.

use crate::geometry::Vec3;
pub use crate::geometry::shape::sphere::uv as sphere_uv;
pub use crate::geometry::shape::triangle::barycentric;

/// Where on a panorama in latitude and longitude, seen from inside, a direction lies; `y` points up.
///
/// `u` is a part of a turn, 0 ≤ `u` < 1, and grows to the right for who stands inside with +y up, so that the panorama is not
/// mirrored. Its centre (`u` = ½) is in front at −z, its seam (`u` = 0) behind at +z; +x is at `u` = ¾. `v` runs from
/// straight down (0) over the horizon (½) to straight up (1). Length, poles, zero vector and error as for [`sphere_uv`].
pub fn latlong_uv(direction: Vec3) -> [f64; 2] {
    // What is seen from inside is the map of the mirrored sphere.
    sphere_uv(Vec3::new(direction.x, direction.y, -direction.z))
}

/// The texture coordinates at a point of a triangle, from those of its corners and the [`barycentric`] weights.
pub fn interpolate(weights: [f64; 3], uvs: [[f64; 2]; 3]) -> [f64; 2] {
    [0, 1].map(|i| weights[0] * uvs[0][i] + weights[1] * uvs[1][i] + weights[2] * uvs[2][i])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::elementary::sin_cos_degrees;
    use core::f64::consts::{PI, TAU};
    use proptest::prelude::*;

    fn v(x: f64, y: f64, z: f64) -> Vec3 {
        Vec3::new(x, y, z)
    }

    #[test]
    fn the_axes_and_the_poles_are_exact() {
        for (direction, outside, inside) in [
            (v(0.0, 0.0, 1.0), [0.5, 0.5], [0.0, 0.5]),
            (v(3.0, 0.0, 0.0), [0.75, 0.5], [0.75, 0.5]),
            (v(-3.0, 0.0, 0.0), [0.25, 0.5], [0.25, 0.5]),
            (v(0.0, 0.0, -1.0), [0.0, 0.5], [0.5, 0.5]),
            (v(-0.0, -0.0, -1.0), [0.0, 0.5], [0.5, 0.5]),
            (v(1.0, 0.0, 1.0), [0.625, 0.5], [0.875, 0.5]),
            (v(0.0, 2.0, 0.0), [0.5, 1.0], [0.5, 1.0]),
            (v(-0.0, -2.0, -0.0), [0.5, 0.0], [0.5, 0.0]),
            (v(0.0, 0.0, -0.0), [0.5, 0.5], [0.5, 0.5]),
        ] {
            assert_eq!((sphere_uv(direction), latlong_uv(direction)), (outside, inside), "{direction:?}");
        }
        // The largest and the smallest numbers there are.
        for size in [f64::MAX, f64::MIN_POSITIVE, 5e-324] {
            assert_eq!(sphere_uv(v(size, 0.0, size)), [0.625, 0.5]);
            assert_eq!(sphere_uv(v(0.0, size, size)), [0.5, 0.75]);
            assert_eq!(sphere_uv(v(0.0, -size, size)), [0.5, 0.25]);
        }
        // cos = 1/√3 to the corner of a cube; the arc sine of 1/√3 by another way, 35.26438968275465°.
        let corner = sphere_uv(v(f64::MAX, f64::MAX, f64::MAX))[1];
        assert!((corner - (0.5 + 35.264_389_682_754_65 / 180.0)).abs() < 1e-15, "{corner}");
    }

    #[test]
    fn small_circles_around_the_poles_are_round() {
        // At 1e-9 of the radius from the pole an arc sine of y = 1 is 90 degrees.
        let south = sphere_uv(v(1e-9, -1.0, 0.0))[1];
        assert!((south * PI / 1e-9 - 1.0).abs() < 1e-15, "relative to itself: {south}");
        let north = sphere_uv(v(0.0, 1.0, 1e-9))[1];
        assert!((north - (1.0 - 1e-9 / PI)).abs() < 2.0 * f64::EPSILON, "relative to 1: {north}");
    }

    proptest! {
        /// A step to the right of who looks is a step to the right on the picture.
        #[test]
        fn neither_map_is_mirrored(longitude in -179.0..179.0f64, latitude in -89.0..89.0f64) {
            let ((sin, cos), (up, level)) = (sin_cos_degrees(longitude), sin_cos_degrees(latitude));
            let dir = v(level * sin, up, level * cos);
            let north = v(0.0, 1.0, 0.0);
            let step = |right: Vec3, of: fn(Vec3) -> [f64; 2]| {
                let moved = of(dir + right.unit() * (level * 1e-3))[0] - of(dir)[0];
                moved - moved.round()
            };
            // From outside one looks along −dir, from inside along dir; right is the way of looking times up.
            // A step of 1e-3 radians, in turns; the tangent differs from the arc by a third of its cube.
            let (outside, inside) = (step((-dir).cross(north), sphere_uv), step(dir.cross(north), latlong_uv));
            prop_assert!((outside * TAU - 1e-3).abs() < 1e-9, "{}", outside);
            prop_assert!((inside * TAU - 1e-3).abs() < 1e-9, "{}", inside);
        }

        /// From angles to a direction and back. A few roundings of the direction, each 2⁻⁵³ of a radian or less.
        #[test]
        fn longitude_and_latitude_come_back(u in 0.0..1.0f64, latitude in -89.9..89.9f64, exponent in -300i32..300) {
            let ((sin, cos), (up, level)) = (sin_cos_degrees(360.0 * (u - 0.5)), sin_cos_degrees(latitude));
            let size = libm::exp2(f64::from(exponent));
            let [longitude, height] = sphere_uv(v(level * sin, up, level * cos) * size);
            prop_assert!((0.0..1.0).contains(&longitude));
            let off = longitude - u;
            prop_assert!((off - off.round()).abs() < 4.0 * f64::EPSILON, "{} {}", longitude, u);
            prop_assert!((height - (latitude / 180.0 + 0.5)).abs() < 4.0 * f64::EPSILON);
        }

        /// A point made of weights gives them back, far from the origin too.
        #[test]
        fn weights_come_back(
            corners in prop::array::uniform3(prop::array::uniform3(-1.0..1.0f64)),
            parts in prop::array::uniform3(0.0..1.0f64),
            offset in prop::array::uniform3(-1e6..1e6f64),
        ) {
            let offset = Vec3::from(offset);
            let [a, b, c] = corners.map(|corner| Vec3::from(corner) + offset);
            let sum = parts[0] + parts[1] + parts[2];
            prop_assume!(sum > 1e-3);
            let [_, beta, gamma] = parts.map(|part| part / sum);
            let point = a + (b - a) * beta + (c - a) * gamma;
            let weights = barycentric([a, b, c], point);
            prop_assert!(weights.iter().all(|w| (0.0..=1.0).contains(w)));
            prop_assert!((weights[0] + weights[1] + weights[2] - 1.0).abs() <= f64::EPSILON);
            // The point's coordinates, below 2²⁰, are off by 2⁻³³ at most after two sums. A weight is a distance from a side
            // relative to the height above it, which is at least area over longest side; twice for the flattest shadow.
            let (area, longest) = ((b - a).cross(c - a).length(), (b - a).length().max((c - a).length()).max((c - b).length()));
            prop_assume!(area > 1e-3 * longest);
            let bound = 8.0 * libm::exp2(-33.0) * longest / area;
            prop_assert!((weights[1] - beta).abs() < bound && (weights[2] - gamma).abs() < bound, "{:?}", weights);
        }
    }

    #[test]
    fn corners_edges_and_what_is_no_triangle() {
        let t = [v(1e6, 0.0, 5.0), v(1e6, 4.0, 5.0), v(1e6, 0.0, 9.0)];
        assert_eq!(barycentric(t, t[0]), [1.0, 0.0, 0.0]);
        assert_eq!(barycentric(t, t[1]), [0.0, 1.0, 0.0]);
        assert_eq!(barycentric(t, t[2]), [0.0, 0.0, 1.0]);
        assert_eq!(barycentric(t, v(1e6, 2.0, 7.0)), [0.0, 0.5, 0.5]);
        assert_eq!(barycentric(t, v(1e6, 1.0, 6.0)), [0.5, 0.25, 0.25]);
        assert_eq!(barycentric(t, v(1e6, 9.0, 9.0)), [0.0, 1.0, 0.0], "beside it: a place in it");
        assert_eq!(barycentric([t[0], t[1], t[1]], t[1]), [1.0, 0.0, 0.0], "no area");
        assert_eq!(barycentric(t, v(f64::NAN, f64::NAN, f64::NAN)), [1.0, 0.0, 0.0]);
        assert_eq!(interpolate([0.5, 0.25, 0.25], [[0.0, 0.0], [1.0, 0.0], [0.0, 2.0]]), [0.25, 0.5]);
    }
}
