//! The pinhole camera with its image plane.

use super::Render;
use crate::geometry::Vec3;
use crate::lanes::elementary::sin_cos_degrees;
use crate::stage::CameraFrame;
use serde::{Deserialize, Serialize};

/// Where the image plane stands if a camera with an angle of view does not say: this share of the way from the eye to the point
/// that it looks at.
const NEAR_SHARE: f64 = 0.1;

/// A pinhole camera. The image plane stands in front of the eye at distance `-near`.
///
/// `W = unit(eye − look_at)`, `U = unit(up × W)`, `V = W × U`. Pixel (i, j), row 0 on top, looks through
/// `eye + near·W + px·U + py·V` with `px = left + i/(w−1)·(right−left)` and `py = top − j/(h−1)·(top−bottom)`.
/// In `whitted` rays start at the eye, in the models of the lecture and the course at that point of the image plane.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Camera {
    /// Where the eye is.
    pub eye: [f64; 3],
    /// A point that it looks at.
    pub look_at: [f64; 3],
    /// A direction that is up in the picture.
    pub up: [f64; 3],
    /// Left, right, bottom and top edge of the picture on the image plane. Give this or `fov`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bounds: Option<[f64; 4]>,
    /// Instead of `bounds`: the angle in degrees between the highest and the lowest row of pixels, which are square then.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fov: Option<f64>,
    /// Position of the image plane along `W`: negative, in front of the eye. Needed with `bounds`; with `fov` a tenth of the way
    /// from `eye` to `look_at` if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub near: Option<f64>,
    /// Read and ignored, as in the lecture.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub far: Option<f64>,
}

impl Camera {
    /// A camera with bounds.
    pub fn new(eye: [f64; 3], look_at: [f64; 3], up: [f64; 3], bounds: [f64; 4], near: f64) -> Self {
        Self { eye, look_at, up, bounds: Some(bounds), fov: None, near: Some(near), far: None }
    }

    /// The camera, placed, for a picture that is made like this. It has been validated.
    pub fn frame(&self, render: &Render) -> CameraFrame {
        let (axes, bounds) = (self.axes().unwrap_or_default(), self.window(render.size));
        let from_eye = render.integrator.starts_at_eye();
        CameraFrame { eye: self.eye.into(), axes, bounds, size: render.size, near: self.image_plane(), from_eye }
    }

    /// Where the image plane stands along W.
    pub fn image_plane(&self) -> f64 {
        let way = Vec3::from(self.eye) - Vec3::from(self.look_at);
        self.near.unwrap_or_else(|| -NEAR_SHARE * way.length())
    }

    /// Left, right, bottom and top edge on the image plane of a picture of this size: the outermost pixels look through them.
    pub fn window(&self, [width, height]: [u32; 2]) -> [f64; 4] {
        match (self.bounds, self.fov) {
            (Some(bounds), _) => bounds,
            (None, fov) => {
                let (sin, cos) = sin_cos_degrees(fov.unwrap_or(0.0) / 2.0);
                let top = self.image_plane().abs() * sin / cos;
                // Between n pixels there are n − 1 steps.
                let (across, up) = (f64::from(width) - 1.0, f64::from(height) - 1.0);
                let right = top * if up > 0.0 { across / up } else { f64::from(width) };
                [-right, right, -top, top]
            }
        }
    }

    /// The axes U (right), V (up), W (backwards), or `None` where the view is parallel to `up`.
    pub fn axes(&self) -> Option<[Vec3; 3]> {
        let w = (Vec3::from(self.eye) - Vec3::from(self.look_at)).unit();
        let across = Vec3::from(self.up).cross(w);
        // Below this the direction of `up × W` is rounding noise.
        let upright = across.length() > 1e-12 * Vec3::from(self.up).length();
        let u = across.unit();
        upright.then(|| [u, w.cross(u), w])
    }
}

/// Bounds of a picture of another size, widened so that pixels are square; `None` if the size has the old one's shape, or the
/// bounds' own.
pub(super) fn widened(bounds: [f64; 4], before: [u32; 2], size: [u32; 2]) -> Option<[f64; 4]> {
    let [left, right, bottom, top] = bounds;
    let (width, height) = (right - left, top - bottom);
    let [w, h] = size.map(f64::from);
    let same_shape = u64::from(before[0]) * u64::from(size[1]) == u64::from(before[1]) * u64::from(size[0]);
    let no_area = width == 0.0 || height == 0.0; // which is an error, and stays one
    if same_shape || no_area || w * height.abs() == h * width.abs() {
        return None;
    }
    // Pixels sit on the corners of the grid: n of them span n − 1 steps. A single pixel spans nothing.
    let steps = size.map(|n| f64::from(n.max(2) - 1));
    let step = (width.abs() / steps[0]).max(height.abs() / steps[1]);
    let around = |a: f64, b: f64, span: f64| {
        let (middle, half) = (f64::midpoint(a, b), span / 2.0 * (b - a).signum());
        (middle - half, middle + half)
    };
    if step * steps[0] > width.abs() {
        let (left, right) = around(left, right, step * steps[0]);
        Some([left, right, bottom, top])
    } else {
        let (bottom, top) = around(bottom, top, step * steps[1]);
        Some([left, right, bottom, top])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Integrator;

    #[test]
    fn another_shape_shows_more_and_keeps_pixels_square() {
        let square = [-2.0, 2.0, -2.0, 2.0];
        assert_eq!(widened(square, [512, 512], [64, 64]), None);
        // 100 steps as wide as the 50 steps of 0.08 upwards.
        assert_eq!(widened(square, [512, 512], [101, 51]), Some([-4.0, 4.0, -2.0, 2.0]));
        let upside_down = [0.0, 2.0, 1.0, -1.0];
        assert_eq!(widened(upside_down, [512, 512], [51, 101]), Some([0.0, 2.0, 2.0, -2.0]), "and stays so");
        assert_eq!(widened([-2.0, 2.0, -1.0, 1.0], [512, 512], [200, 100]), None, "the bounds' own shape");
    }

    fn camera(eye: [f64; 3], look_at: [f64; 3]) -> Camera {
        Camera::new(eye, look_at, [0.0, 1.0, 0.0], [-2.0, 4.0, -1.0, 3.0], -5.0)
    }

    fn frame(size: [u32; 2]) -> CameraFrame {
        camera([0.0, 0.0, 10.0], [0.0; 3]).frame(&Render::new(Integrator::Lecture, size))
    }

    #[test]
    fn pixels_sit_on_the_corners_of_the_grid() {
        let camera = frame([3, 5]);
        assert_eq!(camera.axes[0], Vec3::new(1.0, 0.0, 0.0));
        assert_eq!(camera.ray(0, 0).0, Vec3::new(-2.0, 3.0, 5.0), "top left");
        assert_eq!(camera.ray(2, 4).0, Vec3::new(4.0, -1.0, 5.0), "bottom right");
        assert_eq!(camera.ray(1, 2).0, Vec3::new(1.0, 1.0, 5.0), "the middle");
    }

    /// The lecture's point of the image plane is `eye + …`, and loses digits with the eye; an eye's own rays need no such sum.
    #[test]
    fn rays_from_the_eye_have_the_same_directions_however_far_away() {
        let rays = |far: f64, near: Option<f64>| {
            let at = |[x, y, z]: [f64; 3]| [x + far, y - far, z + far];
            let camera = Camera { fov: Some(40.0), bounds: None, near, ..camera(at([0.0, 2.0, 10.0]), at([1.0; 3])) };
            let frame = camera.frame(&Render::new(Integrator::Whitted, [5, 4]));
            (0..20).map(|i| frame.ray(i % 5, i / 5)).collect::<Vec<_>>()
        };
        for far in [0.0, 1e6, 1e12] {
            let found = rays(far, None);
            assert!(found.iter().all(|(origin, _)| *origin == Vec3::new(far, 2.0 - far, 10.0 + far)));
            assert!(found.iter().zip(rays(0.0, None)).all(|((_, found), (_, expected))| *found == expected), "{far}");
        }
        // Where the plane stands changes nothing but a few roundings of numbers below 1.
        for (found, expected) in rays(0.0, Some(-1e3)).into_iter().zip(rays(0.0, None)) {
            assert!(found.0 == expected.0 && (found.1 - expected.1).length() < 1e-15);
        }
    }

    #[test]
    fn a_single_pixel_looks_through_the_middle() {
        assert_eq!(frame([1, 1]).ray(0, 0).0, Vec3::new(1.0, 1.0, 5.0));
    }
}
