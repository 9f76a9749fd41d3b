//! Cones and cylinders, with flat sides.

use snell::geometry::Vec3;
use snell::lanes::elementary::sin_cos_degrees;

/// Sides of a cone: its outline is off by 1 − cos(π/64), a thousandth of its radius.
const SIDES: usize = 64;

/// The sides of an open cone between two circles, each with its middle and radius, counter-clockwise seen from outside;
/// from inside where a radius is negative.
pub(super) fn faces(ends: [(Vec3, f64); 2]) -> Result<Vec<Vec<Vec3>>, String> {
    let [(base, base_radius), (apex, apex_radius)] = ends;
    let axis = (apex - base).unit();
    if !axis.is_finite() {
        return Err("the base and the apex of a cone are in one place, so it has no axis".to_owned());
    }
    // Any direction across will do; the shortest component of the axis leads to one that is well defined.
    let shortest = (0..3).min_by(|&a, &b| axis.component(a).abs().total_cmp(&axis.component(b).abs())).unwrap_or(0);
    let other = [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0)][shortest];
    let u = axis.cross(other).unit();
    let v = axis.cross(u);
    let circle = |middle: Vec3, radius: f64, i: usize| {
        let (sin, cos) = sin_cos_degrees(360.0 * (i % SIDES) as f64 / SIDES as f64);
        middle + u * (radius.abs() * cos) + v * (radius.abs() * sin)
    };
    let inside = base_radius < 0.0 || apex_radius < 0.0;
    let side = |i: usize| {
        let below = [circle(base, base_radius, i), circle(base, base_radius, i + 1)];
        let above = [circle(apex, apex_radius, i + 1), circle(apex, apex_radius, i)];
        let mut corners = [below, above].concat();
        corners.dedup();
        if inside {
            corners.reverse();
        }
        corners
    };
    Ok((0..SIDES).map(side).filter(|corners| corners.len() > 2).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_look_outward_unless_a_radius_is_negative() {
        let (base, apex) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(1.0, 2.0, 5.0));
        for (radii, outward, corners) in [([1.0, 1.0], 1.0, 4), ([1.0, 0.0], 1.0, 3), ([-1.0, -0.5], -1.0, 4)] {
            let faces = faces([(base, radii[0]), (apex, radii[1])]).unwrap();
            assert_eq!(faces.len(), SIDES);
            for f in faces {
                assert_eq!(f.len(), corners);
                let normal = (f[1] - f[0]).cross(f[2] - f[0]);
                let away = f[0] - Vec3::new(1.0, 2.0, f[0].z);
                assert!(normal.dot(away) * outward > 0.0);
            }
        }
        assert!(faces([(base, 1.0), (base, 2.0)]).is_err());
    }
}
