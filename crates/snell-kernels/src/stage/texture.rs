//! Patterns on surfaces, and the sky, as the kernels see them.

use super::Stage;
use super::material::NONE;
use crate::color::Rgb;
use crate::geometry::{Affine, Vec3};
use crate::texture::{Image, checker, latlong_uv, sphere_uv};
use alloc::sync::Arc;

/// A pattern that is ready to be looked at.
#[derive(Clone, Debug)]
pub struct Pattern {
    /// What it shows.
    pub colors: Colors,
    /// How often it stands between 0 and 1, along u and v.
    pub repeat: [f64; 2],
}

/// What a pattern shows.
#[derive(Clone, Debug)]
pub enum Colors {
    /// The two colours of a checkerboard.
    Checker([Rgb; 2]),
    /// A picture.
    Image(Arc<Image>),
    /// A picture that is not everywhere.
    WithAlpha(Arc<Image>),
}

impl Pattern {
    /// Has it places where the surface is not there?
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
pub enum Background {
    /// The same from everywhere.
    Color(Rgb),
    /// By the height above the horizon.
    Gradient {
        /// At the horizon.
        horizon: Rgb,
        /// Right above.
        zenith: Rgb,
        /// Right below.
        nadir: Rgb,
    },
    /// A picture by longitude and latitude, turned.
    Image {
        /// The picture.
        image: Arc<Image>,
        /// Turns a direction into the picture's.
        turn: Affine,
        /// By what its colours are multiplied.
        brightness: f64,
    },
}

impl Background {
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

impl Stage {
    /// Are there places on this material where not all of it is there?
    pub fn has_holes(&self, material: u32) -> bool {
        self.materials[material as usize].has_holes
    }

    /// How much of a surface is there at a point, from 0 to 1: its coverage.
    pub fn coverage(&self, primitive: usize, point: Vec3) -> f64 {
        if self.has_holes(self.material_of(primitive)) { self.pattern_at(primitive, point).1 } else { 1.0 }
    }

    /// The pattern on a material.
    pub fn texture_of(&self, material: u32) -> Option<u32> {
        let pattern = self.materials[material as usize].pattern;
        (pattern != NONE).then_some(pattern)
    }

    /// By what the colour of a surface is multiplied at a point on it, and how much of the surface is there.
    pub fn pattern_at(&self, primitive: usize, point: Vec3) -> (Rgb, f64) {
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
