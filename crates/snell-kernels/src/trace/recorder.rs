//! Writes down the rays of a pixel while the engine traces them: there is no second tracer.

use super::hits::{Batch, Hits};
use super::integrator::Integrator;
use super::leaving::Leaving;
use super::observer::{Observer, StateOf};
use super::propagation::Propagation;
use super::queue::{Generation, RayQueue};
use super::shading::{ShadowRays, faces, light_on};
use super::tree::{Cutoff, Hit, LightAtHit, Node, RayTree};
use crate::color::Rgb;
use crate::geometry::Vec3;
use crate::lanes::index;
use crate::settings::Shadows;
use crate::stage::{LightSource, Stage};
use alloc::vec::Vec;

/// Writes down every generation of a pixel.
#[derive(Debug, Default)]
pub struct Recorder {
    /// The trees of the samples that are done.
    pub samples: Vec<RayTree>,
    tree: RayTree,
    depth: u32,
    /// Where the previous generation starts.
    parents: usize,
    /// What the lights do at each hit of this generation.
    lights: Vec<Vec<LightAtHit>>,
    /// The ambient part of the local colours of this generation.
    ambient: Vec<Rgb>,
}

impl Observer for Recorder {
    fn ambient<P: Propagation>(&mut self, hits: &Hits<P>, stage: &Stage) {
        self.ambient.clear();
        self.ambient.extend((0..hits.len()).map(|row| hits.batch::<f64>(stage, row).local_color()));
        self.lights.clear();
        self.lights.resize(hits.len(), Vec::new());
    }

    fn light<P: Propagation>(
        &mut self,
        stage: &Stage,
        shadows: Shadows,
        light: &LightSource,
        hits: &Hits<P>,
        asks: &[u64],
        shadow: &ShadowRays,
    ) {
        for row in 0..hits.len() {
            let batch = hits.batch::<f64>(stage, row);
            if asks[row / 64] >> (row % 64) & 1 == 0 {
                // Clear surfaces do not ask for lights.
                continue;
            }
            let lit = shadow.is_lit(row);
            let (wi, distance) = light.seen_from(batch.point());
            let facing = faces(&batch, wi);
            let falloff = light.spot.as_ref().map_or(1.0, |spot| spot.falloff(wi));
            let [diffuse, highlight] =
                if lit { light_on::<f64, P>(&batch, light, shadow, row) } else { [Rgb::black(); 2] };
            let transmittance = if lit { shadow.left(row).unwrap_or(Rgb::gray(1.0)) * falloff } else { Rgb::black() };
            let asks = facing && falloff > 0.0 && shadows != Shadows::Off;
            let between = if asks { between(stage, &batch, wi, distance, shadows) } else { Vec::new() };
            self.lights[row].push(LightAtHit { wi, distance, facing, transmittance, between, diffuse, highlight });
        }
    }

    fn generation<I: Integrator>(
        &mut self,
        stage: &Stage,
        rays: &impl Generation<I::Propagation>,
        hits: &Hits<I::Propagation>,
        state: &StateOf<'_, I>,
    ) {
        let start = self.tree.nodes.len();
        for row in 0..rays.len() {
            self.push::<I>(stage, rays, row, None, state);
        }
        for row in 0..hits.len() {
            let batch = hits.batch::<f64>(stage, row);
            let node = &mut self.tree.nodes[start + hits.ray(row)];
            (node.contribution, node.adds) = (hits.contribution(row), true);
            if hits.is_sky(row) {
                continue;
            }
            let (eta, outer) = I::Propagation::sides_of_hit(state, &batch);
            node.hit = Some(Hit {
                primitive: hits.primitive(row),
                material: batch.material_number(0),
                t: batch.t(),
                point: batch.point(),
                normal: batch.normal(),
                eta,
                outer,
                throughput: I::arriving(&batch),
                local: batch.local_color(),
                ambient: self.ambient[row],
                emission: stage.materials[batch.material_number(0) as usize].emission,
                lights: core::mem::take(&mut self.lights[row]),
            });
        }
        self.parents = start;
        self.depth += 1;
    }

    fn cut_off<I: Integrator>(
        &mut self,
        stage: &Stage,
        children: &RayQueue<I::Propagation>,
        row: usize,
        why: Cutoff,
        state: &StateOf<'_, I>,
    ) {
        self.push::<I>(stage, children, row, Some(why), state);
    }

    fn sample(&mut self, lost: &[Rgb]) {
        let nodes = core::mem::take(&mut self.tree.nodes);
        self.samples.push(RayTree { nodes, lost: lost.first().copied().unwrap_or_default() });
        (self.depth, self.parents) = (0, 0);
    }
}

impl Recorder {
    fn push<I: Integrator>(
        &mut self,
        stage: &Stage,
        rays: &impl Generation<I::Propagation>,
        row: usize,
        cutoff: Option<Cutoff>,
        state: &StateOf<'_, I>,
    ) {
        let (origin, dir) = rays.lines::<f64>(row);
        let (eta, medium, band) = I::Propagation::medium_of_ray(state, stage, &rays.travel(row));
        self.tree.nodes.push(Node {
            kind: rays.kind(row),
            depth: self.depth,
            parent: (self.depth > 0).then(|| self.parents + index(rays.parents(row))),
            origin,
            dir,
            band,
            medium,
            eta,
            throughput: I::throughput(&rays.carried::<f64, I::Carried>(row)),
            hit: None,
            contribution: Rgb::black(),
            cutoff,
            adds: false,
        });
    }
}

/// What lies between a hit and a light, up to what blocks it.
fn between<P: Propagation>(
    stage: &Stage,
    hit: &Batch<'_, f64, P>,
    wi: Vec3,
    distance: f64,
    shadows: Shadows,
) -> Vec<(u32, f64)> {
    let (origin, clear) = P::shadow_start(hit, wi);
    let ray = Leaving { origin, dir: wi, source: hit.primitive(), clear, wo: hit.wo() };
    let (mut crossings, tinted) = (Vec::new(), shadows == Shadows::Tinted);
    stage.tree.crossings(origin, wi, [-stage.exit_tolerance, distance], &mut crossings);
    crossings.retain(|&crossing| crossing.0 < distance && P::is_in_the_way(stage, &ray, crossing, tinted));
    let blocks = |&(t, primitive): &(f64, u32)| stage.blocks_light_at(primitive, origin + wi * t, shadows);
    let end = crossings.iter().position(blocks).map_or(crossings.len(), |at| at + 1);
    crossings.truncate(end);
    crossings.into_iter().map(|(t, primitive)| (primitive, t)).collect()
}
