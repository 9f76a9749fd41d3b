//! Patterns on surfaces, and the sky, as the kernels see them.

use super::World;
use super::material::NONE;
use crate::color::Rgb;
use crate::geometry::{Affine, Vec3};
use crate::scene::{Problem, Problems, Scene, Sky, Step, Texture};
use crate::texture::{Image, checker, latlong_uv, sphere_uv};
use std::sync::Arc;

/// A pattern that is ready to be looked at.
#[derive(Clone, Debug)]
pub(crate) struct Pattern {
    colors: Colors,
    repeat: [f64; 2],
}

#[derive(Clone, Debug)]
enum Colors {
    Checker([Rgb; 2]),
    Image(Arc<Image>),
    /// A picture that is not everywhere.
    WithAlpha(Arc<Image>),
}

impl Pattern {
    /// `None` where the picture has not been read. Alpha is drawn by real optics only.
    pub fn new(texture: &Texture, has_media: bool) -> Option<Self> {
        let image = || {
            let image = texture.pixels.clone()?;
            let has_alpha = image.alpha().is_some() && has_media;
            Some(if has_alpha { Colors::WithAlpha(image) } else { Colors::Image(image) })
        };
        let colors = texture.checker.map(Colors::Checker).or_else(image)?;
        Some(Self { colors, repeat: texture.repeat })
    }

    pub fn has_alpha(&self) -> bool {
        matches!(self.colors, Colors::WithAlpha(_))
    }

    /// The largest value of each channel, without its sign.
    pub fn largest(&self) -> Rgb {
        match &self.colors {
            Colors::Checker(colors) => brightest(colors.iter().copied()),
            Colors::Image(image) | Colors::WithAlpha(image) => brightest_texel(image),
        }
    }

    /// The colour at a place, and how much of the surface is there.
    fn at(&self, [u, v]: [f64; 2]) -> (Rgb, f64) {
        let (u, v) = (u * self.repeat[0], v * self.repeat[1]);
        match &self.colors {
            Colors::Checker(colors) => (colors[usize::from(checker(u, v))], 1.0),
            Colors::Image(image) => (image.bilinear(u, v), 1.0),
            Colors::WithAlpha(image) => image.bilinear_with_alpha(u, v),
        }
    }
}

fn brightest(colors: impl Iterator<Item = Rgb>) -> Rgb {
    colors.fold(Rgb::gray(0.0), |a, b| Rgb::new(a.r.max(b.r.abs()), a.g.max(b.g.abs()), a.b.max(b.b.abs())))
}

/// Of the texels that are seen.
fn brightest_texel(image: &Image) -> Rgb {
    let is_hole = |at: usize| image.alpha().is_some_and(|alpha| alpha[at] == 0.0);
    let seen = image.pixels().iter().enumerate().filter(|&(at, _)| !is_hole(at));
    brightest(seen.map(|(_, texel)| Rgb::from(texel.map(f64::from))))
}

/// Light from where nothing is.
#[derive(Clone, Debug)]
pub(crate) enum Background {
    /// The same from everywhere.
    Color(Rgb),
    /// By the height above the horizon.
    Gradient { horizon: Rgb, zenith: Rgb, nadir: Rgb },
    /// A picture by longitude and latitude, turned.
    Image { image: Arc<Image>, turn: Affine, brightness: f64 },
}

impl Background {
    /// `None` where the picture has not been read.
    pub fn new(color: Rgb, sky: Option<&Sky>) -> Option<Self> {
        let Some(sky) = sky else { return Some(Self::Color(color)) };
        if let Some(horizon) = sky.horizon {
            let (zenith, nadir) = (sky.zenith.unwrap_or(horizon), sky.nadir.unwrap_or(horizon));
            return Some(Self::Gradient { horizon, zenith, nadir });
        }
        // The direction is turned back, instead of the picture.
        let turn = Affine::rotation(Vec3::new(0.0, 1.0, 0.0), -sky.rotate)?;
        Some(Self::Image { image: sky.pixels.clone()?, turn, brightness: sky.brightness })
    }

    /// The largest value of each channel, without its sign.
    pub fn largest(&self) -> Rgb {
        match self {
            Self::Color(color) => *color,
            Self::Gradient { horizon, zenith, nadir } => brightest([*horizon, *zenith, *nadir].into_iter()),
            Self::Image { image, brightness, .. } => brightest_texel(image) * *brightness,
        }
    }

    /// Is there none?
    pub fn is_black(&self) -> bool {
        matches!(self, Self::Color(color) if *color == Rgb::gray(0.0))
    }

    /// What is seen in a direction of unit length.
    pub fn color(&self, dir: Vec3) -> Rgb {
        match self {
            Self::Color(color) => *color,
            Self::Gradient { horizon, zenith, nadir } => {
                let end = if dir.y < 0.0 { nadir } else { zenith };
                let share = dir.y.abs();
                *horizon * (1.0 - share) + *end * share
            }
            Self::Image { image, turn, brightness } => {
                let [u, v] = latlong_uv(turn.turn(dir));
                image.bilinear_latlong(u, v) * *brightness
            }
        }
    }
}

/// The patterns of all textures, in their order.
pub(super) fn patterns(scene: &Scene, has_media: bool) -> Result<Vec<Pattern>, Problems> {
    let of = |(name, texture): (&String, &Texture)| {
        let unread = || {
            let place = ["texture", name, "image"].map(Step::from).to_vec();
            Problem { place, message: "this picture has not been read".to_owned(), help: None, remedy: None }
        };
        Pattern::new(texture, has_media).ok_or_else(unread)
    };
    Ok(scene.textures.iter().map(of).collect::<Result<_, Problem>>()?)
}

impl World {
    /// Are there places on this material where not all of it is there?
    pub(crate) fn has_holes(&self, material: u32) -> bool {
        self.materials[material as usize].has_holes
    }

    /// How much of a surface is there at a point, from 0 to 1: its coverage.
    pub(crate) fn coverage(&self, primitive: usize, point: Vec3) -> f64 {
        if self.has_holes(self.material_of(primitive)) { self.pattern_at(primitive, point).1 } else { 1.0 }
    }

    /// The pattern on a material.
    pub(super) fn texture_of(&self, material: u32) -> Option<u32> {
        let pattern = self.materials[material as usize].pattern;
        (pattern != NONE).then_some(pattern)
    }

    /// By what the colour of a surface is multiplied at a point on it, and how much of the surface is there.
    pub(crate) fn pattern_at(&self, primitive: usize, point: Vec3) -> (Rgb, f64) {
        let Some(pattern) = self.texture_of(self.material_of(primitive)) else { return (Rgb::gray(1.0), 1.0) };
        let uv = if let (Some(sphere), Some(turn)) = (self.spheres.get(primitive), self.sphere_turns.get(primitive)) {
            sphere_uv(turn.turn(point - sphere.center))
        } else {
            let own @ [q, r] = self.shape(primitive).uv(point);
            self.corner_uvs(primitive).map_or(own, |[a, b, c]| {
                let p = 1.0 - q - r;
                [a[0] * p + b[0] * q + c[0] * r, a[1] * p + b[1] * q + c[1] * r]
            })
        };
        self.patterns[pattern as usize].at(uv)
    }
}
