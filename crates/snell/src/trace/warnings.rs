//! What is odd about a picture, and is known only when it has been rendered.

use super::{Settings, Statistics};
use crate::scene::{Integrator, Warning, WarningCode};
use crate::world::World;

impl Statistics {
    /// W007 and W008, where rays have met them, and W202, of what has been rendered of a picture.
    pub fn warnings(&self, world: &World, settings: &Settings) -> Vec<Warning> {
        let messages = [
            (WarningCode::LostLight, self.lost_light(world, settings)),
            (WarningCode::StrayExit, self.stray_exits(world)),
            (WarningCode::Overlap, self.overlap(world)),
        ];
        let found = messages.into_iter().filter_map(|(code, message)| Some((code, message?)));
        found.map(|(code, message)| Warning { code, place: Vec::new(), message }).collect()
    }

    fn lost_light(&self, world: &World, settings: &Settings) -> Option<String> {
        let (lost, depth) = (self.lost, settings.max_depth);
        // With depth 0 that is what was asked for.
        (lost.rays > 0 && depth > 0).then(|| {
            let or = if settings.integrator == Integrator::Whitted { " or too little light" } else { "" };
            let (x, y) = lost.worst_pixel(world.camera.size[0]);
            format!(
                "depth {depth}{or} ended {} branches; what lies behind them weighs {:.2} % of a pixel on average, {:.1} % in \
                 pixel {x},{y}",
                lost.rays,
                100.0 * lost.share(self.rays.camera),
                100.0 * lost.worst(settings.spp),
            )
        })
    }

    fn stray_exits(&self, world: &World) -> Option<String> {
        self.stray.first_pixel.map(|pixel| {
            let (x, y) = column_and_row(world, pixel);
            format!(
                "{} rays lost count of the solids that they are in, first in pixel {x},{y}: does a mesh cross itself, or is \
                 one with `inside` open?",
                self.stray.count,
            )
        })
    }

    fn overlap(&self, world: &World) -> Option<String> {
        self.overlaps.first.map(|overlap| {
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
}

fn column_and_row(world: &World, pixel: u64) -> (u64, u64) {
    let width = u64::from(world.camera.size[0].max(1));
    (pixel % width, pixel / width)
}
