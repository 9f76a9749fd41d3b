//! Patterns on surfaces, and the sky, as the kernels see them.

use super::World;
use crate::film::Rgb;
use crate::geometry::{Affine, Vec3};
use crate::scene::{Material, Problem, Scene, Sky, Step, Texture};
use crate::texture::{Image, barycentric, checker, latlong_uv, sphere_uv};
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
}

impl Pattern {
    /// `None` where the picture has not been read.
    pub fn new(texture: &Texture) -> Option<Self> {
        let image = || texture.pixels.clone().map(Colors::Image);
        let colors = texture.checker.map(Colors::Checker).or_else(image)?;
        Some(Self { colors, repeat: texture.repeat })
    }

    /// The largest value of each channel, without its sign.
    pub fn largest(&self) -> Rgb {
        match &self.colors {
            Colors::Checker(colors) => brightest(colors.iter().copied()),
            Colors::Image(image) => brightest_texel(image),
        }
    }

    fn color(&self, [u, v]: [f64; 2]) -> Rgb {
        let (u, v) = (u * self.repeat[0], v * self.repeat[1]);
        match &self.colors {
            Colors::Checker(colors) => colors[usize::from(checker(u, v))],
            Colors::Image(image) => image.bilinear(u, v),
        }
    }
}

fn brightest(colors: impl Iterator<Item = Rgb>) -> Rgb {
    colors.fold(Rgb::gray(0.0), |a, b| Rgb::new(a.r.max(b.r.abs()), a.g.max(b.g.abs()), a.b.max(b.b.abs())))
}

fn brightest_texel(image: &Image) -> Rgb {
    brightest(image.pixels().iter().map(|texel| Rgb::from(texel.map(f64::from))))
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

impl World {
    /// Finds the patterns of all materials.
    pub(super) fn find_patterns(&mut self, scene: &Scene) -> Result<(), Vec<Problem>> {
        for (name, texture) in &scene.textures {
            let unread = || {
                let place = ["texture", name, "image"].map(Step::from).to_vec();
                vec![Problem { place, message: "this picture has not been read".to_owned(), help: None }]
            };
            self.patterns.push(Pattern::new(texture).ok_or_else(unread)?);
        }
        let of = |m: &Material| m.texture.as_ref().and_then(|name| scene.textures.get_index_of(name));
        self.pattern_of = self.materials.iter().map(|m| of(m).map(|at| at as u32)).collect();
        Ok(())
    }

    /// The pattern on a material.
    pub(super) fn texture_of(&self, material: u32) -> Option<u32> {
        self.pattern_of.get(material as usize).copied().flatten()
    }

    /// By what the colour of a surface is multiplied at a point on it.
    pub(crate) fn tint(&self, primitive: usize, point: Vec3) -> Rgb {
        let Some(pattern) = self.texture_of(self.material_of(primitive)) else { return Rgb::gray(1.0) };
        let uv = match self.spheres.get(primitive) {
            Some(sphere) => {
                let from_center = point - sphere.center;
                sphere_uv(self.sphere_turns.get(primitive).map_or(from_center, |turn| turn.turn(from_center)))
            }
            None => self.corner_uvs(primitive).map_or([0.0; 2], |[a, b, c]| {
                let [p, q, r] = barycentric(self.corners(primitive), point);
                [a[0] * p + b[0] * q + c[0] * r, a[1] * p + b[1] * q + c[1] * r]
            }),
        };
        self.patterns[pattern as usize].color(uv)
    }
}
