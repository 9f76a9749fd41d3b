//! From the textures and the sky of a scene to those of the kernels.

use crate::color::Rgb;
use crate::geometry::{Affine, Vec3};
use crate::scene::{Problem, Problems, Scene, Sky, Step, Texture};
use crate::stage::{Background, Colors, Pattern};

/// `None` where the picture has not been read. Alpha is drawn by real optics only.
fn pattern(texture: &Texture, has_media: bool) -> Option<Pattern> {
    let image = || {
        let image = texture.pixels.clone()?;
        let has_alpha = image.alpha().is_some() && has_media;
        Some(if has_alpha { Colors::WithAlpha(image) } else { Colors::Image(image) })
    };
    let colors = texture.checker.map(Colors::Checker).or_else(image)?;
    Some(Pattern { colors, repeat: texture.repeat })
}

/// `None` where the picture has not been read.
pub(super) fn background(color: Rgb, sky: Option<&Sky>) -> Option<Background> {
    let Some(sky) = sky else { return Some(Background::Color(color)) };
    if let Some(horizon) = sky.horizon {
        let (zenith, nadir) = (sky.zenith.unwrap_or(horizon), sky.nadir.unwrap_or(horizon));
        return Some(Background::Gradient { horizon, zenith, nadir });
    }
    // The direction is turned back, instead of the picture.
    let turn = Affine::rotation(Vec3::new(0.0, 1.0, 0.0), -sky.rotate)?;
    Some(Background::Image { image: sky.pixels.clone()?, turn, brightness: sky.brightness })
}

/// The patterns of all textures, in their order.
pub(super) fn patterns(scene: &Scene, has_media: bool) -> Result<Vec<Pattern>, Problems> {
    let of = |(name, texture): (&String, &Texture)| {
        let unread = || {
            let place = ["texture", name, "image"].map(Step::from).to_vec();
            Problem { place, message: "this picture has not been read".to_owned(), help: None, remedy: None }
        };
        pattern(texture, has_media).ok_or_else(unread)
    };
    Ok(scene.textures.iter().map(of).collect::<Result<_, Problem>>()?)
}
