//! The pinhole camera with its image plane.

use crate::geometry::Vec3;
use crate::lanes::elementary::sin_cos_degrees;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A pinhole camera. The image plane stands in front of the eye at distance `-near`; rays start on it.
///
/// `W = unit(eye − look_at)`, `U = unit(up × W)`, `V = W × U`. Pixel (i, j), row 0 on top, looks through
/// `eye + near·W + px·U + py·V` with `px = left + i/(w−1)·(right−left)` and `py = top − j/(h−1)·(top−bottom)`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
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
    /// Position of the image plane along `W`: negative, in front of the eye.
    #[serde(default = "default_near")]
    pub near: f64,
    /// Read and ignored, as in the lecture.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub far: Option<f64>,
}

fn default_near() -> f64 {
    -1.0
}

impl Camera {
    /// A camera with bounds.
    pub fn new(eye: [f64; 3], look_at: [f64; 3], up: [f64; 3], bounds: [f64; 4], near: f64) -> Self {
        Self { eye, look_at, up, bounds: Some(bounds), fov: None, near, far: None }
    }

    /// Left, right, bottom and top edge on the image plane of a picture of this size: the outermost pixels look through them.
    pub fn window(&self, [width, height]: [u32; 2]) -> [f64; 4] {
        match (self.bounds, self.fov) {
            (Some(bounds), _) => bounds,
            (None, fov) => {
                let (sin, cos) = sin_cos_degrees(fov.unwrap_or(0.0) / 2.0);
                let top = self.near.abs() * sin / cos;
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
