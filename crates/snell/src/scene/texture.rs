//! Patterns on surfaces.

use crate::color::Rgb;
use crate::texture::Image;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A pattern on a surface: squares of two colours, or a picture.
///
/// It lies on planes, discs and the sides of boxes once, on spheres by longitude and latitude, around what a lathe made, and on
/// meshes by the texture coordinates of the model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Texture {
    /// Two colours of squares. Give this or `image`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub checker: Option<[Rgb; 2]>,
    /// A picture, PNG, PPM or EXR, relative to the scene file. `whitted`: where its alpha is 0, the surface is not there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub image: Option<String>,
    /// How many squares or pictures lie beside and above each other.
    #[serde(default = "once", skip_serializing_if = "is_once")]
    pub repeat: [f64; 2],
    /// Are the numbers of a PNG or PPM linear light, and not those of the sRGB curve?
    #[serde(default, skip_serializing_if = "is_false")]
    pub linear: bool,
    /// The picture itself, once the file has been read.
    #[serde(skip)]
    #[cfg_attr(feature = "schemars", schemars(skip))]
    pub pixels: Option<Arc<Image>>,
}

fn once() -> [f64; 2] {
    [1.0, 1.0]
}

fn is_once(value: &[f64; 2]) -> bool {
    *value == once()
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature that serde asks for")]
fn is_false(value: &bool) -> bool {
    !*value
}
