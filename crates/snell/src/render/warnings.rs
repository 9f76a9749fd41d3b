//! What is odd about a picture, and is known only when it has been rendered.

use super::Settings;
use crate::scene::{Integrator, Warning, WarningCode};
use crate::trace::Statistics;
use crate::world::World;

/// W007 and W008, where rays have met them, and W202, of what has been rendered of a picture.
pub fn warnings(statistics: &Statistics, world: &World, settings: &Settings) -> Vec<Warning> {
    let messages = [
        (WarningCode::LostLight, lost_light(statistics, world, settings)),
        (WarningCode::StrayExit, stray_exits(statistics, world)),
        (WarningCode::Overlap, overlap(statistics, world)),
    ];
    let found = messages.into_iter().filter_map(|(code, message)| Some((code, message?)));
    found.map(|(code, message)| Warning { code, place: Vec::new(), message }).collect()
}

fn lost_light(statistics: &Statistics, world: &World, settings: &Settings) -> Option<String> {
    let (lost, depth) = (statistics.lost, settings.max_depth);
    // With depth 0 that is what was asked for.
    (lost.rays > 0 && depth > 0).then(|| {
        let or = if settings.integrator == Integrator::Whitted { " or too little light" } else { "" };
        let (x, y) = lost.worst_pixel(world.camera.size[0]);
        format!(
            "depth {depth}{or} ended {} branches; what lies behind them weighs {:.2} % of a pixel on average, {:.1} % in \
             pixel {x},{y}",
            lost.rays,
            100.0 * lost.share(statistics.rays.camera),
            100.0 * lost.worst(settings.spp),
        )
    })
}

fn stray_exits(statistics: &Statistics, world: &World) -> Option<String> {
    statistics.stray.first_pixel.map(|pixel| {
        let (x, y) = column_and_row(world, pixel);
        format!(
            "{} rays lost count of the solids that they are in, first in pixel {x},{y}: does a mesh cross itself, or is \
             one with `inside` open?",
            statistics.stray.count,
        )
    })
}

fn overlap(statistics: &Statistics, world: &World) -> Option<String> {
    statistics.overlaps.first.map(|overlap| {
        let name = |primitive: u32| world.object_of(primitive).map_or("?", |object| object.name.as_str());
        let ([a, b], p) = (overlap.primitives.map(name), overlap.point);
        let (x, y) = column_and_row(world, overlap.pixel);
        format!(
            "`{a}` and `{b}` overlap with the same priority, first seen at ({}, {}, {}) in pixel {x},{y}: the one entered \
             last is there; give one of their materials a higher `priority`",
            p.x, p.y, p.z,
        )
    })
}

fn column_and_row(world: &World, pixel: u64) -> (u64, u64) {
    let width = u64::from(world.camera.size[0].max(1));
    (pixel % width, pixel / width)
}
