//! The ray tree of one pixel, recorded by the engine that renders: there is no second tracer.

use super::generation::{Observer, mean};
use super::hits::Hits;
use super::media::WHITE;
use super::queue::{Generation, RayKind};
use crate::film::Rgb;
use crate::geometry::Vec3;
use crate::lanes::index;

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
    /// Where it goes.
    pub dir: Vec3,
    /// Which band of light, counted from violet; `None` for all of it.
    pub band: Option<u32>,
    /// What it can add to the pixel for each unit of radiance.
    pub throughput: Rgb,
    /// What it hit: primitive, distance, and the unit normal that faces the ray; `None` also for the background.
    pub hit: Option<(u32, f64, Vec3)>,
    /// What that surface, or the background, adds to the pixel.
    pub contribution: Rgb,
    /// Is it added? Not where there is nothing to be seen.
    adds: bool,
}

/// All rays of one pixel, in the order in which they are traced and added.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RayTree {
    /// The rays, generation by generation.
    pub nodes: Vec<Node>,
    /// The throughput of the rays that were not followed: too deep, too many, or carrying too little.
    pub lost: Rgb,
}

impl RayTree {
    /// The contributions added up in the engine's order: the pixel, bit for bit.
    pub fn sum(&self) -> Rgb {
        // What adds nothing is not added: 0 and -0 are not the same bits.
        let contributions = self.nodes.iter().filter(|n| n.adds).map(|n| n.contribution);
        contributions.fold(Rgb::black(), |sum, c| sum + c)
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
        match self.samples.as_slice() {
            [only] => only.sum(),
            all => mean(all.iter().fold(Rgb::black(), |sum, tree| sum + tree.sum()), all.len() as u32),
        }
    }
}

/// Writes down every generation of a pixel.
#[derive(Debug, Default)]
pub(crate) struct Recorder {
    /// The trees of the samples that are done.
    pub samples: Vec<RayTree>,
    tree: RayTree,
    depth: u32,
    /// Where the previous generation starts.
    parents: usize,
}

impl Observer for Recorder {
    fn generation(&mut self, rays: &impl Generation, hits: &Hits) {
        let start = self.tree.nodes.len();
        for row in 0..rays.len() {
            let ((origin, dir), load) = (rays.ways::<f64>(row), rays.loads::<f64>(row));
            self.tree.nodes.push(Node {
                kind: rays.kind(row),
                depth: self.depth,
                parent: (self.depth > 0).then(|| self.parents + index(load.parent)),
                origin,
                dir,
                band: Some(index(load.band) as u32).filter(|&band| band != WHITE),
                throughput: load.weight.throughput(),
                hit: None,
                contribution: Rgb::black(),
                adds: false,
            });
        }
        for hit in 0..hits.len() {
            let node = &mut self.tree.nodes[start + hits.ray(hit)];
            if !hits.is_sky(hit) {
                node.hit = Some((hits.primitive(hit), hits.t(hit), hits.normal(hit)));
            }
            (node.contribution, node.adds) = (hits.contribution(hit), true);
        }
        self.parents = start;
        self.depth += 1;
    }

    fn sample(&mut self, lost: &[Rgb]) {
        let nodes = std::mem::take(&mut self.tree.nodes);
        self.samples.push(RayTree { nodes, lost: lost.first().copied().unwrap_or_default() });
        (self.depth, self.parents) = (0, 0);
    }
}
