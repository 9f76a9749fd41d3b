//! The pinhole camera with its image plane.

use crate::geometry::Vec3;
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
    /// Left, right, bottom and top edge of the picture on the image plane.
    pub bounds: [f64; 4],
    /// Position of the image plane along `W`: negative, in front of the eye.
    pub near: f64,
    /// Read and ignored, as in the lecture.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub far: Option<f64>,
}

impl Camera {
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
