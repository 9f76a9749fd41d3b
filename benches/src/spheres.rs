//! Spheres scattered in a cube: as many as you like, always equally dense.

use crate::flake::Ball;
use crate::uniform;
use snell::geometry::Vec3;
use std::f64::consts::PI;

/// Share of the cube that the spheres fill, if none overlapped.
const FILLED: f64 = 0.05;

/// `count` spheres in the cube from −1 to 1. Their radius shrinks with the cube root of their number, so that a ray
/// goes past as many sphere diameters at every number.
pub fn scattered(count: u32) -> Vec<Ball> {
    // count · 4/3·π·r³ = FILLED · 2³
    let radius = libm::cbrt(FILLED * 8.0 * 3.0 / (4.0 * PI * f64::from(count)));
    let ball = |i: u32| {
        let coordinate = |axis: u32| 2.0 * uniform(3 * i + axis) - 1.0;
        Ball { center: Vec3::new(coordinate(0), coordinate(1), coordinate(2)), radius }
    };
    (0..count).map(ball).collect()
}
