//! The ray tree of one pixel: what the engine's [`Recorder`](super::recorder::Recorder) writes down while it renders.

use super::pairwise::pairwise_sum;
use super::queue::RayKind;
use crate::color::Rgb;
use crate::geometry::Vec3;
use alloc::vec::Vec;

/// One ray, and what it added.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Where it comes from.
    pub kind: RayKind,
    /// Bounces behind it.
    pub depth: u32,
    /// Number of the parent node; `None` for the camera ray.
    pub parent: Option<usize>,
    /// Where it starts.
    pub origin: Vec3,
    /// Where it goes, of unit length.
    pub dir: Vec3,
    /// Which band of light, counted from violet; `None` for all of it.
    pub band: Option<u32>,
    /// The number of the solid whose medium it travels in; `None` for the space between the objects.
    pub medium: Option<u32>,
    /// The index of refraction there.
    pub eta: f64,
    /// What it can add to the pixel for each unit of radiance, where it starts.
    pub throughput: Rgb,
    /// What it hit; `None` also for the background.
    pub hit: Option<Hit>,
    /// What that surface, or the background, adds to the pixel.
    pub contribution: Rgb,
    /// Why it was not followed; `None` for one that was.
    pub cutoff: Option<Cutoff>,
    /// Is it added? Not where there is nothing to be seen.
    pub(super) adds: bool,
}

/// Why a ray was not followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cutoff {
    /// `max_depth` bounces were behind it.
    Depth,
    /// It carried less than `min_throughput`.
    Threshold,
    /// The pixel had got all of its rays.
    Rays,
}

/// Where a ray met something.
#[derive(Clone, Debug, PartialEq)]
pub struct Hit {
    /// What.
    pub primitive: u32,
    /// The number of its material.
    pub material: u32,
    /// How far from the ray's origin.
    pub t: f64,
    /// Where.
    pub point: Vec3,
    /// Of unit length, facing the ray.
    pub normal: Vec3,
    /// The indices of refraction on the side of the ray and behind; the same where nothing is behind.
    pub eta: [f64; 2],
    /// Is it the outer side of the surface, which shows its own colour?
    pub outer: bool,
    /// What the ray carries where it arrives: with real optics less than where it starts, if the medium absorbs.
    pub throughput: Rgb,
    /// The surface's own colour, before anything weighs it.
    pub local: Rgb,
    /// The part of it that is light from everywhere.
    pub ambient: Rgb,
    /// The light that it sends out by itself, before anything weighs it.
    pub emission: Rgb,
    /// What each light does there, in the order of the scene; empty for a surface that has no colour of its own.
    pub lights: Vec<LightAtHit>,
}

/// What a light does at a point of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct LightAtHit {
    /// Towards the light, of unit length, and how far it is.
    pub wi: Vec3,
    /// Infinite for a light at infinity.
    pub distance: f64,
    /// Does the surface face it?
    pub facing: bool,
    /// The share of the light that arrives, in the shadow of what is between and within its cone.
    pub transmittance: Rgb,
    /// What lies between, from the surface on: primitives and distances. The last one blocks the light if nothing arrives.
    pub between: Vec<(u32, f64)>,
    /// What it adds to the surface's own colour.
    pub diffuse: Rgb,
    /// The same for its highlight.
    pub highlight: Rgb,
}

/// All rays of one sample of a pixel, in the order in which they are traced and added.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RayTree {
    /// The rays, generation by generation; those that were not followed after the generation that sent them.
    pub nodes: Vec<Node>,
    /// The throughput of the rays that were not followed: too deep, too many, or carrying too little.
    pub lost: Rgb,
}

impl RayTree {
    /// The contributions added up in the engine's order: the sample, bit for bit.
    pub fn sum(&self) -> Rgb {
        // What adds nothing is not added: 0 and -0 are not the same bits.
        let contributions = self.nodes.iter().filter(|node| node.adds).map(|node| node.contribution);
        contributions.fold(Rgb::black(), |sum, contribution| sum + contribution)
    }
}

/// All rays of all samples of one pixel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PixelTrace {
    /// What the engine made of it: the film's value.
    pub radiance: Rgb,
    /// The tree of each sample.
    pub samples: Vec<RayTree>,
}

impl PixelTrace {
    /// The trees added up in the engine's order: the pixel, bit for bit.
    pub fn sum(&self) -> Rgb {
        let sum = pairwise_sum(self.samples.iter().map(RayTree::sum), |sum, other| *sum = *sum + *other);
        sum.map_or(Rgb::black(), |sum| mean(sum, self.samples.len() as u32))
    }
}

/// The mean of so many samples, from their sum.
pub fn mean(sum: Rgb, spp: u32) -> Rgb {
    let share = |sum: f64| sum / f64::from(spp);
    Rgb::new(share(sum.r), share(sum.g), share(sum.b))
}
