//! The kernels' areas and normals of triangles against exact arithmetic.

use super::exact::Exact;
use crate::geometry::Vec3;
use crate::geometry::area::*;
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    /// Against exact arithmetic of the corners as they were rounded: slivers of every kind, near and far.
    #[test]
    fn it_is_that_of_the_corners(
        a in prop::array::uniform3(-1.0..1.0f64),
        along in prop::array::uniform3(-1.0..1.0f64),
        across in prop::array::uniform3(-1.0..1.0f64),
        place in -1.0..2.0f64,
        thinness in 0.0..9.0f64,
        offset in prop_oneof![Just(0.0), Just(1e3), Just(1e6)],
    ) {
        let offset = Vec3::new(offset, -offset, offset);
        let (a, along, across) = (Vec3::from(a) + offset, Vec3::from(along), Vec3::from(across));
        let corners = [a, a + along, a + along * place + across * libm::exp10(-thinness)];
        let exact = Exact::area_vector(corners);
        prop_assume!(exact.length() > 0.0);
        let found = area_vector(corners);
        // Above 30 degrees: differences, products, their difference, each with a rounding, against a sine of ½ at least:
        // 4·2⁻⁵³·2, on each of three axes.
        prop_assert!((found - exact).length() <= 16.0 / (1u64 << 53) as f64 * exact.length());
    }
}
