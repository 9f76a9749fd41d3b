//! Haines' sphereflake, the "balls" of the Standard Procedural Databases (Haines, *A Proposal for Standard Graphics
//! Environments*, IEEE CG&A 7, 1987).

use snell::geometry::Vec3;
use std::f64::consts::PI;

/// A sphere of the flake.
#[derive(Clone, Copy, Debug)]
pub struct Ball {
    /// Centre.
    pub center: Vec3,
    /// Radius.
    pub radius: f64,
}

/// All `(9^(levels + 1) − 1)/8` spheres: one of radius 1/2 around the origin, on each sphere nine of a third of its
/// radius.
pub fn balls(levels: u32) -> Vec<Ball> {
    let mut balls = Vec::new();
    let root = Ball { center: Vec3::default(), radius: 0.5 };
    grow(levels, root, Vec3::new(0.0, 0.0, 1.0), &directions(), &mut balls);
    balls
}

fn grow(levels: u32, ball: Ball, axis: Vec3, directions: &[Vec3; 9], balls: &mut Vec<Ball>) {
    balls.push(ball);
    if levels == 0 {
        return;
    }
    for &direction in directions {
        let out = turned(direction, axis);
        let child = Ball { center: ball.center + out * (ball.radius * 4.0 / 3.0), radius: ball.radius / 3.0 };
        grow(levels - 1, child, out, directions, balls);
    }
}

/// Where the children of a sphere with axis z sit: six on the equator, three at elevation asin(2/√6).
fn directions() -> [Vec3; 9] {
    std::array::from_fn(|i| {
        let (azimuth, elevation) = if i < 6 {
            (15.0 + 60.0 * i as f64, 0.0)
        } else {
            (45.0 + 120.0 * (i - 6) as f64, libm::asin(2.0 / 6f64.sqrt()))
        };
        let ((sin, cos), (up, out)) = (libm::sincos(azimuth * PI / 180.0), libm::sincos(elevation));
        Vec3::new(out * cos, out * sin, up)
    })
}

/// The vector under the smallest rotation that takes +z to `axis`.
fn turned(v: Vec3, axis: Vec3) -> Vec3 {
    let cos = axis.z;
    if cos <= -1.0 {
        return Vec3::new(-v.x, v.y, -v.z);
    }
    if cos >= 1.0 {
        return v;
    }
    // Rodrigues' formula with k = z × axis, of length sin.
    let k = Vec3::new(-axis.y, axis.x, 0.0);
    v * cos + k.cross(v) + k * (k.dot(v) / (1.0 + cos))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn children_touch_their_parents_and_point_away_from_them() {
        let balls = balls(2);
        assert_eq!(balls.len(), 91);
        let root = balls[0];
        // Depth first: each child of the root is followed by its own nine.
        for child in balls[1..].chunks(10) {
            let out = child[0].center - root.center;
            // A few roundings of numbers around one.
            assert!((out.length() - root.radius - child[0].radius).abs() < 1e-15);
            for grandchild in &child[1..] {
                let further = grandchild.center - child[0].center;
                assert!((further.length() - child[0].radius - grandchild.radius).abs() < 1e-15);
                assert!(further.dot(out) > -1e-15, "none grows back towards the parent");
            }
        }
    }
}
