//! Writes down the rays of a pixel while the engine traces them: there is no second tracer.

use super::hits::{Batch, Hits};
use super::leaving::{Leaving, back, until_clear};
use super::lecture::T_MIN;
use super::media::{Media, WHITE};
use super::observer::Observer;
use super::queue::{Generation, RayQueue};
use super::shading::{ShadowRays, light_on};
use super::tree::{Ended, Hit, Lit, Node, RayTree};
use super::whitted;
use crate::film::Rgb;
use crate::geometry::Vec3;
use crate::lanes::index;
use crate::scene::{Integrator, Shadows};
use crate::world::{LightSource, NO_SOLID, World};

/// Writes down every generation of a pixel.
#[derive(Debug, Default)]
pub(crate) struct Recorder {
    /// The trees of the samples that are done.
    pub samples: Vec<RayTree>,
    tree: RayTree,
    depth: u32,
    /// Where the previous generation starts.
    parents: usize,
    /// What the lights do at each hit of this generation.
    lights: Vec<Vec<Lit>>,
    /// The ambient part of the local colours of this generation.
    ambient: Vec<Rgb>,
}

impl Observer for Recorder {
    fn ambient(&mut self, hits: &Hits, world: &World) {
        self.ambient.clear();
        self.ambient.extend((0..hits.len()).map(|row| hits.batch::<f64>(world, row).local_color()));
        self.lights.clear();
        self.lights.resize(hits.len(), Vec::new());
    }

    fn light(&mut self, world: &World, light: &LightSource, hits: &Hits, shadow: &ShadowRays) {
        for row in 0..hits.len() {
            let batch = hits.batch::<f64>(world, row);
            let lit = shadow.is_lit(row);
            let (wi, distance) = light.seen_from(batch.point());
            let mut facing = batch.active && batch.normal().dot(wi) > 0.0;
            if world.render.integrator == Integrator::Whitted {
                if !whitted::has_local_color(&batch) {
                    // Clear surfaces do not ask for lights.
                    continue;
                }
                facing = facing && batch.geometric_normal().dot(wi) > 0.0;
            }
            let share = light.spot.as_ref().map_or(1.0, |spot| spot.share(wi));
            let [diffuse, highlight] =
                if lit { light_on::<f64>(&batch, light, shadow, row) } else { [Rgb::black(); 2] };
            let transmittance = if lit { shadow.left(row).unwrap_or(Rgb::gray(1.0)) * share } else { Rgb::black() };
            let between = if facing && share > 0.0 { between(world, &batch, wi, distance) } else { Vec::new() };
            self.lights[row].push(Lit { wi, distance, facing, transmittance, between, diffuse, highlight });
        }
    }

    fn generation(&mut self, rays: &impl Generation, hits: &Hits, media: &Media<'_>) {
        let (start, world) = (self.tree.nodes.len(), media.world());
        for row in 0..rays.len() {
            self.push(rays, row, None, media);
        }
        for row in 0..hits.len() {
            let batch = hits.batch::<f64>(world, row);
            let node = &mut self.tree.nodes[start + hits.ray(row)];
            (node.contribution, node.adds) = (hits.contribution(row), true);
            if hits.is_sky(row) {
                continue;
            }
            let (mut eta, mut outer) = ([world.eta_outside; 2], true);
            if world.render.integrator == Integrator::Whitted {
                let [before, after, band] = batch.media_of(0);
                eta = [media.eta(before, band), media.eta(after, band)];
                outer = batch.face().outer > 0.0;
            } else if world.materials[batch.material_number(0) as usize].is_transparent() && batch.is_sphere() {
                eta[1] = world.materials[batch.material_number(0) as usize].eta;
            }
            node.hit = Some(Hit {
                primitive: hits.primitive(row),
                material: batch.material_number(0),
                t: hits.t(row),
                point: batch.point(),
                normal: hits.normal(row),
                eta,
                outer,
                throughput: batch.weight().throughput(),
                local: batch.local_color(),
                ambient: self.ambient[row],
                emission: world.materials[batch.material_number(0) as usize].emission,
                lights: std::mem::take(&mut self.lights[row]),
            });
        }
        self.parents = start;
        self.depth += 1;
    }

    fn ended(&mut self, children: &RayQueue, row: usize, why: Ended, media: &Media<'_>) {
        self.push(children, row, Some(why), media);
    }

    fn sample(&mut self, lost: &[Rgb]) {
        let nodes = std::mem::take(&mut self.tree.nodes);
        self.samples.push(RayTree { nodes, lost: lost.first().copied().unwrap_or_default() });
        (self.depth, self.parents) = (0, 0);
    }
}

impl Recorder {
    fn push(&mut self, rays: &impl Generation, row: usize, ended: Option<Ended>, media: &Media<'_>) {
        let ((origin, dir), load) = (rays.ways::<f64>(row), rays.loads::<f64>(row));
        let (set, band) = (index(load.medium) as u32, index(load.band) as u32);
        let solid = media.top(set);
        self.tree.nodes.push(Node {
            kind: rays.kind(row),
            depth: self.depth,
            parent: (self.depth > 0).then(|| self.parents + index(load.parent)),
            origin,
            dir,
            band: Some(band).filter(|&band| band != WHITE),
            medium: (solid != NO_SOLID).then_some(solid),
            eta: media.eta(set, band),
            throughput: load.weight.throughput(),
            hit: None,
            contribution: Rgb::black(),
            ended,
            adds: false,
        });
    }
}

/// What lies between a hit and a light, up to what blocks it.
fn between(world: &World, hit: &Batch<'_, f64>, wi: Vec3, distance: f64) -> Vec<(u32, f64)> {
    if world.render.shadows() == Shadows::Off {
        return Vec::new();
    }
    let real_optics = world.render.integrator == Integrator::Whitted;
    let tinted = world.render.shadows() == Shadows::Tinted;
    let (mut origin, source, mut clear) = (hit.point(), hit.primitive(), T_MIN);
    if real_optics {
        origin = origin + hit.wo() * back(world, hit.t());
        clear = until_clear(world, hit.geometric_normal().dot(wi));
    }
    let leaving = Leaving { origin, dir: wi, source, clear, wo: hit.wo() };
    let mut crossings = Vec::new();
    world.tree.crossings(origin, wi, [-world.behind, distance], &mut crossings);
    crossings.retain(|&(t, primitive)| {
        if real_optics {
            let is_hole = tinted && world.is_hole(primitive as usize, origin + wi * t);
            return t < distance && leaving.meets(world, primitive, t) && !is_hole;
        }
        // The lecture's spheres are met from outside only.
        let sphere = world.spheres.get(primitive as usize);
        let enters = sphere.is_none_or(|sphere| t < (sphere.center - origin).dot(wi));
        t > T_MIN && t < distance && f64::from(primitive) != source && enters
    });
    let blocks = |&(t, primitive): &(f64, u32)| world.blocks_light_at(primitive, origin + wi * t);
    let end = crossings.iter().position(blocks).map_or(crossings.len(), |at| at + 1);
    crossings.truncate(end);
    crossings.into_iter().map(|(t, primitive)| (primitive, t)).collect()
}
