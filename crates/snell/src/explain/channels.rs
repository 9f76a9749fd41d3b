//! What the rays of each pixel met: distances, normals, objects; and how many surfaces.

use super::survey::{of_each_pixel, rows};
use crate::render::{Options, PixelTracer, Settings};
use crate::trace::PixelTrace;
use crate::world::World;

/// What the camera's rays met, pixel by pixel and row by row. Of several samples the first one counts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Channels {
    /// How far the ray goes, in scene units: from the eye in `whitted`, from the image plane in the models of the lecture and the
    /// course; infinite where it meets nothing.
    pub depth: Vec<f64>,
    /// The normal there, of unit length and towards the ray; zero where nothing is.
    pub normal: Vec<[f64; 3]>,
    /// The number of the object in [`World::objects`]; -1 where nothing is.
    pub object: Vec<i32>,
}

/// Of a whole picture or its crop; `None` if cancelled, or if the world was compiled for other models of light.
pub fn channels(world: &World, settings: &Settings, options: &Options<'_>) -> Option<Channels> {
    let tracer = || PixelTracer::of_first_hits(world, settings);
    let mut channels = Channels::default();
    for (depth, normal, object) in rows(world.camera.size, tracer, options, |trace| first_hit(world, trace))? {
        channels.depth.push(depth);
        channels.normal.push(normal);
        channels.object.push(object);
    }
    Some(channels)
}

fn first_hit(world: &World, trace: &PixelTrace) -> (f64, [f64; 3], i32) {
    let hit = trace.samples.first().and_then(|sample| sample.nodes.first()?.hit.as_ref());
    hit.map_or((f64::INFINITY, [0.0; 3], -1), |hit| {
        let after = world.objects.partition_point(|object| object.first <= hit.primitive);
        (hit.t, hit.normal.into(), after as i32 - 1)
    })
}

/// How many surfaces all rays of each pixel met, those to lights apart; `None` as for [`channels`].
pub fn hits(world: &World, settings: &Settings, options: &Options<'_>) -> Option<Vec<u32>> {
    of_each_pixel(world, settings, options, |trace| {
        let nodes = trace.samples.iter().flat_map(|sample| &sample.nodes);
        nodes.filter(|node| node.hit.is_some()).count() as u32
    })
}
