//! The explanation of a pixel as plain data, which is also its JSON form, version 1.
//!
//! Colours and throughputs are linear red, green, blue; angles are in degrees; lengths in scene units.

use super::angles::{Angles, angles};
use super::{bound, sentence};
use crate::color::Rgb;
use crate::film::transfer::Transfer;
use crate::render::trace_pixel;
use crate::scene::Integrator;
use crate::trace::{Cutoff, Hit, Node, PixelTrace, RayKind, RayTree};
use crate::world::CompiledScene;
use serde::Serialize;

/// The version of this form.
const VERSION: u32 = 1;

/// Why a pixel has the colour it has.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub struct Explanation {
    /// The version of this form.
    #[cfg_attr(feature = "schemars", schemars(extend("const" = VERSION)))]
    pub snell_ray_tree: u32,
    /// The name of the scene.
    pub scene: String,
    /// The model of light.
    pub integrator: Integrator,
    /// Column and row, from the top left.
    pub pixel: [u32; 2],
    /// Width and height of the picture.
    pub size: [u32; 2],
    /// The pixel, as in the film.
    pub color: [f64; 3],
    /// The curve by which it is shown.
    pub transfer: Transfer,
    /// Samples of the pixel.
    pub spp: u32,
    /// What a person would say first.
    pub sentence: String,
    /// The samples, in the order of addition.
    pub samples: Vec<ExplainedSample>,
}

/// One sample: contributions add up to its colour in the order of the nodes, and samples to the pixel times `spp`.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub struct ExplainedSample {
    /// Its sum.
    pub color: [f64; 3],
    /// The throughput of the rays that were not followed.
    pub lost: [f64; 3],
    /// The rays; parents come before their children.
    pub nodes: Vec<ExplainedNode>,
}

/// What kind of ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum NodeKind {
    /// From the eye.
    Camera,
    /// From a mirror, in the open.
    Mirror,
    /// Out of something transparent, or through a thin pane.
    Refracted,
    /// Within a solid.
    Inside,
}

/// Why nothing follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Ending {
    /// It met nothing.
    Missed,
    /// Too many bounces.
    Depth,
    /// It carried too little.
    Threshold,
    /// The pixel had got all of its rays.
    Rays,
    /// What it met sends nothing on.
    Absorbed,
}

/// One ray.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub struct ExplainedNode {
    /// Its place in the list.
    pub id: usize,
    /// That of the ray before it.
    pub parent: Option<usize>,
    /// Bounces behind it.
    pub depth: u32,
    /// What kind of ray.
    pub kind: NodeKind,
    /// Where it starts.
    pub origin: [f64; 3],
    /// Where it goes, of unit length.
    pub dir: [f64; 3],
    /// The object that it is in, or `outside`.
    pub medium: String,
    /// The index of refraction there.
    pub eta: f64,
    /// The wavelength, if dispersion has split it.
    pub band_nm: Option<f64>,
    /// What it can add to the sample for each unit of radiance, where it starts.
    pub throughput: [f64; 3],
    /// What it met.
    pub hit: Option<ExplainedHit>,
    /// The light that the surface itself sends along it.
    pub local: Option<LocalLight>,
    /// What its end adds to the sample.
    pub contribution: [f64; 3],
    /// The same with everything below it.
    pub subtotal: [f64; 3],
    /// Why nothing follows; `None` if something does.
    pub ended: Option<Ending>,
    /// The most that it could still have added within ten more levels, if it was not followed.
    pub bound: Option<[f64; 3]>,
}

/// What a ray met.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub struct ExplainedHit {
    /// The object.
    pub object: String,
    /// The number of the primitive.
    pub primitive: u32,
    /// How far away.
    pub t: f64,
    /// Where.
    pub point: [f64; 3],
    /// Of unit length, towards the ray.
    pub normal: [f64; 3],
    /// Angle to the normal before the surface.
    pub angle_in: f64,
    /// Behind it, if anything goes through.
    pub angle_out: Option<f64>,
    /// The index before the surface.
    pub eta_before: f64,
    /// And behind.
    pub eta_behind: f64,
    /// Does it all come back?
    pub total_reflection: bool,
    /// The material.
    pub material: String,
    /// The ray's throughput where it arrives: a medium may have absorbed some.
    pub throughput: [f64; 3],
}

/// The light that a surface itself sends out, before opacity and throughput weigh it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub struct LocalLight {
    /// Of the light from everywhere.
    pub ambient: [f64; 3],
    /// Of its own.
    pub emission: [f64; 3],
    /// Of each light.
    pub lights: Vec<LightAtHit>,
}

/// What a light does there.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub struct LightAtHit {
    /// The light.
    pub name: String,
    /// Does the surface face it?
    pub facing: bool,
    /// What of it arrives.
    pub transmittance: [f64; 3],
    /// What stands in its way, if nothing arrives.
    pub blocked_by: Option<String>,
    /// Where.
    pub block_point: Option<[f64; 3]>,
    /// What it shines through.
    pub through: Vec<String>,
    /// What it adds.
    pub diffuse: [f64; 3],
    /// And in its highlight.
    pub highlight: [f64; 3],
    /// Where it stands, or the direction towards it.
    pub point: [f64; 3],
    /// Which of the two.
    pub at_infinity: bool,
}

/// Explains a pixel, by column and row from the top left; `None` where the picture has no such pixel. The second is what it was
/// made of.
pub fn explain(compiled: &CompiledScene, x: u32, y: u32) -> Option<(Explanation, PixelTrace)> {
    let (world, render) = (compiled.world(), &compiled.scene().render);
    let trace = trace_pixel(world, &compiled.settings(), x, y)?;
    let bound = bound::per_throughput(world, render.integrator);
    let samples = trace.samples.iter().map(|tree| sample(compiled, bound, tree)).collect();
    let explanation = Explanation {
        snell_ray_tree: VERSION,
        scene: compiled.name().to_owned(),
        integrator: render.integrator,
        pixel: [x, y],
        size: world.camera.size,
        color: trace.radiance.to_array(),
        transfer: render.transfer,
        spp: render.spp,
        sentence: sentence::of(compiled, &trace),
        samples,
    };
    Some((explanation, trace))
}

fn sample(compiled: &CompiledScene, bound: Rgb, tree: &RayTree) -> ExplainedSample {
    let mut subtotals: Vec<Rgb> = tree.nodes.iter().map(|node| node.contribution).collect();
    let mut has_children = vec![false; tree.nodes.len()];
    for (id, node) in tree.nodes.iter().enumerate().rev() {
        if let Some(parent) = node.parent {
            subtotals[parent] = subtotals[parent] + subtotals[id];
            has_children[parent] = true;
        }
    }
    let nodes = tree.nodes.iter().enumerate().map(|(id, node)| {
        let size = |c: Rgb| Rgb::new(c.r.abs(), c.g.abs(), c.b.abs());
        let ended = match (node.cutoff, &node.hit) {
            (Some(Cutoff::Depth), _) => Some(Ending::Depth),
            (Some(Cutoff::Threshold), _) => Some(Ending::Threshold),
            (Some(Cutoff::Rays), _) => Some(Ending::Rays),
            (None, None) => Some(Ending::Missed),
            (None, Some(_)) => (!has_children[id]).then_some(Ending::Absorbed),
        };
        ExplainedNode {
            id,
            parent: node.parent,
            depth: node.depth,
            kind: kind(node),
            origin: node.origin.into(),
            dir: node.dir.into(),
            medium: compiled.medium(node.medium).to_owned(),
            eta: node.eta,
            band_nm: node.band.map(|band| compiled.world().bands[band as usize].wavelength_nm),
            throughput: node.throughput.to_array(),
            hit: node.hit.as_ref().map(|hit| explained(compiled, node, hit)),
            local: node.hit.as_ref().filter(|hit| hit.outer).map(|hit| local(compiled, hit)),
            contribution: node.contribution.to_array(),
            subtotal: subtotals[id].to_array(),
            ended,
            bound: node.cutoff.map(|_| (size(node.throughput) * bound).to_array()),
        }
    });
    ExplainedSample { color: tree.sum().to_array(), lost: tree.lost.to_array(), nodes: nodes.collect() }
}

fn kind(node: &Node) -> NodeKind {
    match node.kind {
        RayKind::Camera => NodeKind::Camera,
        _ if node.medium.is_some() => NodeKind::Inside,
        RayKind::Mirror => NodeKind::Mirror,
        RayKind::Refracted => NodeKind::Refracted,
    }
}

fn explained(compiled: &CompiledScene, node: &Node, hit: &Hit) -> ExplainedHit {
    let Angles { before, behind, total_reflection } = angles(node.dir, hit);
    ExplainedHit {
        object: compiled.object(hit.primitive).to_owned(),
        primitive: hit.primitive,
        t: hit.t,
        point: hit.point.into(),
        normal: hit.normal.into(),
        angle_in: before,
        angle_out: behind,
        eta_before: hit.eta[0],
        eta_behind: hit.eta[1],
        total_reflection,
        material: compiled.material(hit.material).to_owned(),
        throughput: hit.throughput.to_array(),
    }
}

fn local(compiled: &CompiledScene, hit: &Hit) -> LocalLight {
    let lights = hit.lights.iter().enumerate().map(|(number, lit)| {
        let dark = lit.transmittance == Rgb::gray(0.0);
        let blocker = lit.between.last().filter(|_| dark && lit.facing);
        let through = if blocker.is_some() { &lit.between[..lit.between.len() - 1] } else { &lit.between[..] };
        let mut passed: Vec<String> = through.iter().map(|&(p, _)| compiled.object(p).to_owned()).collect();
        passed.dedup();
        let source = &compiled.world().lights[number];
        LightAtHit {
            name: compiled.light(number),
            facing: lit.facing,
            transmittance: lit.transmittance.to_array(),
            blocked_by: blocker.map(|&(primitive, _)| compiled.object(primitive).to_owned()),
            block_point: blocker.map(|&(_, t)| (hit.point + lit.wi * t).into()),
            through: passed,
            diffuse: lit.diffuse.to_array(),
            highlight: lit.highlight.to_array(),
            point: source.at.into(),
            at_infinity: source.at_infinity,
        }
    });
    LocalLight { ambient: hit.ambient.to_array(), emission: hit.emission.to_array(), lights: lights.collect() }
}
