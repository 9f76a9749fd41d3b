//! What is seen where nothing is hit.

use crate::color::Rgb;
use crate::texture::Image;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A sky around the scene: a gradient from `horizon` to `zenith`, or a picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Sky {
    /// The colour at the horizon. Give this or `image`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub horizon: Option<Rgb>,
    /// The colour straight up; between, it goes by the sine of the elevation. Left out: that of the horizon.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub zenith: Option<Rgb>,
    /// The colour straight down; left out: that of the horizon.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub nadir: Option<Rgb>,
    /// A picture of all directions by longitude and latitude, EXR or PNG, relative to the scene file; −z is in its middle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub image: Option<String>,
    /// By what the picture is multiplied.
    #[serde(default = "super::one", skip_serializing_if = "is_one")]
    pub brightness: f64,
    /// Degrees by which the picture is turned about the y axis, right-handed.
    #[serde(default, skip_serializing_if = "super::shape::is_zero")]
    pub rotate: f64,
    /// The picture itself, once the file has been read.
    #[serde(skip)]
    #[cfg_attr(feature = "schemars", schemars(skip))]
    pub pixels: Option<Arc<Image>>,
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "the signature of serde; what is small depends on the machine")]
fn is_one(value: &f64) -> bool {
    *value == 1.0
}
