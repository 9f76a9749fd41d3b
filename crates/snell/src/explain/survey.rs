//! All pixels of a picture by their paths: one layer for each, and where an object is seen.

use super::Path;
use crate::color::Rgb;
use crate::film::Crop;
use crate::render::{Options, PixelTracer, Progress, Settings};
use crate::threads;
use crate::trace::{PixelTrace, mean};
use crate::world::{CompiledScene, World};
use indexmap::IndexMap;
use std::sync::atomic::{AtomicU64, Ordering};

/// A picture in layers that add up to it.
#[derive(Clone, Debug, Default)]
pub struct Layers {
    /// The strongest paths, the strongest first, each with its own picture, row by row.
    pub layers: Vec<(Path, Vec<Rgb>)>,
    /// All other paths together.
    pub rest: Vec<Rgb>,
    /// The picture itself.
    pub picture: Vec<Rgb>,
}

/// In how many pixels an object is seen, by each path that ends there; and in which.
#[derive(Clone, Debug, Default)]
pub struct Sightings {
    /// The paths, the one of most pixels first.
    pub paths: Vec<(Path, u64)>,
    /// For each pixel, row by row, the share of it that is the object.
    pub mask: Vec<f64>,
}

/// What each pixel's trees are made into, row by row; `None` if that was cancelled, or if the world was compiled for other models
/// of light. Of the options only the tiles and the lanes do not matter.
pub(super) fn of_each_pixel<T: Send>(
    world: &World,
    settings: &Settings,
    options: &Options<'_>,
    of: impl Fn(&PixelTrace) -> T + Sync,
) -> Option<Vec<T>> {
    rows(world.camera.size, || PixelTracer::new(world, settings), options, of)
}

/// The same with tracers of any kind.
pub(super) fn rows<'a, T: Send>(
    [width, height]: [u32; 2],
    tracer: impl Fn() -> Option<PixelTracer<'a>> + Sync,
    options: &Options<'_>,
    of: impl Fn(&PixelTrace) -> T + Sync,
) -> Option<Vec<T>> {
    let crop = options.crop.unwrap_or(Crop { x: 0, y: 0, width, height });
    let total_pixels = u64::from(crop.width) * u64::from(crop.height);
    let [pixels, rays] = [AtomicU64::new(0), AtomicU64::new(0)];
    let cancelled = || options.cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed));
    let row = |y: u32| {
        let mut tracer = tracer()?;
        let columns = (crop.x..crop.x.saturating_add(crop.width)).take_while(|_| !cancelled());
        let row: Vec<T> = columns.filter_map(|x| tracer.trace(x, y)).map(|trace| of(&trace)).collect();
        if let Some(progress) = options.progress {
            let pixels = pixels.fetch_add(row.len() as u64, Ordering::Relaxed) + row.len() as u64;
            let rays = rays.fetch_add(tracer.rays(), Ordering::Relaxed) + tracer.rays();
            progress(Progress { pixels, total_pixels, rays });
        }
        Some(row)
    };
    let all = crop.y..crop.y.saturating_add(crop.height);
    let rows = threads::share(options.threads, |parallel| threads::map(parallel, all, row));
    let rows: Vec<Vec<T>> = rows.into_iter().collect::<Option<_>>()?;
    (!cancelled()).then(|| rows.into_iter().flatten().collect())
}

/// The paths of a pixel, each with what it adds, by the engine's order of addition.
pub fn by_path(compiled: &CompiledScene, trace: &PixelTrace) -> Vec<(Path, Rgb)> {
    let mut sums: IndexMap<Path, Rgb> = IndexMap::new();
    for tree in &trace.samples {
        let mut of_sample: IndexMap<Path, Rgb> = IndexMap::new();
        for (number, node) in tree.nodes.iter().enumerate().filter(|(_, n)| n.contribution != Rgb::gray(0.0)) {
            let sum = of_sample.entry(Path::of(compiled, tree, number)).or_default();
            *sum = *sum + node.contribution;
        }
        for (path, sample) in of_sample {
            let sum = sums.entry(path).or_default();
            *sum = *sum + sample;
        }
    }
    let spp = trace.samples.len() as u32;
    sums.into_iter().map(|(path, sum)| (path, if spp == 1 { sum } else { mean(sum, spp) })).collect()
}

/// Splits a picture by paths: the `most` strongest of them, and the rest. `None` if cancelled.
pub fn layers(compiled: &CompiledScene, most: usize, options: &Options<'_>) -> Option<Layers> {
    let split = |trace: &PixelTrace| (trace.radiance, by_path(compiled, trace));
    let pixels = of_each_pixel(compiled.world(), &compiled.settings(), options, split)?;
    let mut strength: IndexMap<&Path, f64> = IndexMap::new();
    for (path, color) in pixels.iter().flat_map(|(_, paths)| paths) {
        *strength.entry(path).or_insert(0.0) += color.mean().abs();
    }
    strength.sort_by(|_, a, _, b| b.total_cmp(a));
    let black = vec![Rgb::gray(0.0); pixels.len()];
    let mut layers: IndexMap<Path, Vec<Rgb>> =
        strength.keys().take(most).map(|&path| (path.clone(), black.clone())).collect();
    let mut rest = black;
    for (pixel, (_, paths)) in pixels.iter().enumerate() {
        for (path, color) in paths {
            let layer = layers.get_mut(path).unwrap_or(&mut rest);
            layer[pixel] = layer[pixel] + *color;
        }
    }
    Some(Layers {
        layers: layers.into_iter().collect(),
        rest,
        picture: pixels.into_iter().map(|(radiance, _)| radiance).collect(),
    })
}

/// What one path alone adds to each pixel, row by row. `None` if cancelled.
pub fn only(compiled: &CompiledScene, path: &Path, options: &Options<'_>) -> Option<Vec<Rgb>> {
    of_each_pixel(compiled.world(), &compiled.settings(), options, |trace| {
        let all = by_path(compiled, trace);
        all.into_iter().find(|(other, _)| other == path).map_or(Rgb::gray(0.0), |(_, color)| color)
    })
}

/// Where an object is seen, directly or by others. A pixel counts once for each path that it has. `None` if cancelled.
pub fn find(compiled: &CompiledScene, object: &str, options: &Options<'_>) -> Option<Sightings> {
    let pixels = of_each_pixel(compiled.world(), &compiled.settings(), options, |trace| {
        let all = by_path(compiled, trace);
        let total: f64 = all.iter().map(|(_, color)| color.mean().abs()).sum();
        let seen: Vec<(Path, Rgb)> = all.into_iter().filter(|(path, _)| path.end == object).collect();
        let share: f64 = seen.iter().map(|(_, color)| color.mean().abs()).sum();
        (seen, if total > 0.0 { share / total } else { 0.0 })
    })?;
    let mut paths: IndexMap<Path, u64> = IndexMap::new();
    for (path, _) in pixels.iter().flat_map(|(seen, _)| seen) {
        *paths.entry(path.clone()).or_insert(0) += 1;
    }
    paths.sort_by(|_, a, _, b| b.cmp(a));
    let mask = pixels.into_iter().map(|(_, share)| share).collect();
    Some(Sightings { paths: paths.into_iter().collect(), mask })
}
