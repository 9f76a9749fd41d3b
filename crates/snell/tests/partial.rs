//! A picture in parts, of any pixels and any samples, rendered anywhere and put together in any order, is the picture to the bit.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use snell::film::{Crop, Rgb};
use snell::render::{Grid, JoinError, LaneWidth, Options, PartialFilm, Piece, RenderError, Rendered, Settings, render};
use snell::scene::Scene;
use snell::trace::Twice;
use snell::world::World;
use snell_test_scenes::glass;
use std::cell::Cell;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

/// Numbers below a limit that look like chance, the same each time (xorshift, Marsaglia 2003).
struct Chance(Cell<u64>);

impl Chance {
    fn below(&self, limit: u32) -> u32 {
        let mut x = self.0.get();
        x ^= x << 13;
        x ^= x >> 7;
        x ^= x << 17;
        self.0.set(x);
        (x % u64::from(limit.max(1))) as u32
    }
}

fn scene(spp: u32) -> Scene {
    let mut scene = glass::windows();
    (scene.render.size, scene.render.spp, scene.render.max_depth) = ([37, 23], spp, 3);
    scene
}

/// All of a part, as a file has it: pieces with their sums and what they have lost.
fn stored(part: &PartialFilm) -> Vec<(Piece, Vec<Rgb>, Vec<u64>)> {
    let of = |piece: Piece| {
        let (mut sums, mut lost) = (Vec::new(), Vec::new());
        for y in piece.rect.y..piece.rect.y + piece.rect.height {
            part.row(&piece, y, &mut sums);
            part.lost_row(&piece, y, &mut lost);
        }
        assert_eq!(sums.len() as u64, piece.pixel_count() * piece.blocks().len() as u64);
        (piece, sums, lost)
    };
    part.pieces().into_iter().map(of).collect()
}

fn join(parts: &[&PartialFilm], size: [u32; 2], crop: Crop, tile_size: u32) -> Result<PartialFilm, Twice> {
    let edges = parts.iter().flat_map(|part| part.pieces()).map(|piece| piece.rect);
    let mut whole = PartialFilm::new(size, crop, Grid::new(crop, tile_size, edges));
    for part in parts {
        for (piece, sums, lost) in stored(part) {
            whole.insert(&piece, &sums, &lost)?;
        }
        whole.count(&part.statistics());
    }
    Ok(whole)
}

fn assert_same(part: &PartialFilm, whole: &Rendered, spp: u32, what: &str) {
    assert!(part.has(0..spp), "{what}");
    let film = part.film(spp).unwrap();
    assert!(film.is_finished() && film.pixels == whole.film.pixels, "{what}: other pixels");
    assert_eq!(part.statistics(), whole.statistics, "{what}");
}

#[test]
fn any_rectangles_and_samples_make_the_whole() {
    let chance = Chance(Cell::new(88_172_645_463_325_252));
    for spp in [1, 2, 3, 5, 8, 13] {
        let scene = scene(spp);
        let (world, settings) = (World::new(&scene).unwrap(), Settings::from(&scene));
        let whole = render(&world, &settings, &Options::default()).unwrap();
        let size = world.camera.size;
        for round in 0..4 {
            // The picture is cut along some columns and rows, and the samples of each part at some places.
            let cuts = |length: u32| {
                let mut cuts: Vec<u32> =
                    (0..chance.below(3)).map(|_| chance.below(length)).chain([0, length]).collect();
                cuts.sort_unstable();
                cuts.dedup();
                cuts
            };
            let (columns, rows) = (cuts(size[0]), cuts(size[1]));
            let mut parts = Vec::new();
            for (x, y) in columns.windows(2).flat_map(|x| rows.windows(2).map(move |y| (x, y))) {
                let crop = Crop { x: x[0], y: y[0], width: x[1] - x[0], height: y[1] - y[0] };
                for samples in cuts(spp).windows(2) {
                    let lanes = LaneWidth::ALL[chance.below(4) as usize];
                    let options = Options { threads: 1 + chance.below(3) as usize, lanes, ..Options::default() };
                    let grid = Grid::new(crop, 1 + chance.below(40), []);
                    let mut part = PartialFilm::new(size, crop, grid);
                    part.render(&world, &settings, samples[0]..samples[1], &options, None).unwrap();
                    let at = chance.below(parts.len() as u32 + 1) as usize;
                    parts.insert(at, part);
                }
            }
            let all = Crop { x: 0, y: 0, width: size[0], height: size[1] };
            let what = format!("{spp} samples, round {round}, {} parts", parts.len());
            let together = join(&parts.iter().collect::<Vec<_>>(), size, all, 16).unwrap();
            assert_same(&together, &whole, spp, &what);
            // As a tree: two and two, in memory or as from a file.
            let mut trees: Vec<PartialFilm> = parts.clone();
            while trees.len() > 1 {
                let (a, b) = (trees.remove(0), trees.pop().unwrap());
                let from_file = |tile_size: u32| join(&[&a, &b], size, all, tile_size).unwrap();
                let joined = (chance.below(2) == 0).then(|| from_file(1 + chance.below(40)));
                trees.push(joined.unwrap_or_else(|| a.joined(&[&b]).unwrap()));
            }
            assert_same(&trees[0], &whole, spp, &what);
            assert!(join(&[&together, &parts[0]], size, all, 16).is_err(), "{what}: twice");
            assert!(matches!(together.joined(&[&parts[0]]), Err(JoinError::Twice(_))), "{what}: twice");
        }
    }
}

#[test]
fn what_is_there_so_far_is_shown_and_not_called_finished() {
    let scene = scene(4);
    let (world, settings) = (World::new(&scene).unwrap(), Settings::from(&scene));
    let (size, options) = (world.camera.size, Options::default());
    let part = |y: u32, height: u32, samples: std::ops::Range<u32>| {
        let crop = Crop { x: 0, y, width: size[0], height };
        let mut part = PartialFilm::new(size, crop, Grid::new(crop, 8, []));
        part.render(&world, &settings, samples, &options, None).unwrap();
        part
    };
    // The first sample of some rows, all of others, and of some rows only a later one, whose mean says nothing.
    let all = part(0, 5, 0..1).joined(&[&part(5, 8, 0..4), &part(15, 3, 2..3)]).unwrap();
    let film = all.film(4).unwrap();
    assert_eq!(film.crop, Crop { x: 0, y: 0, width: size[0], height: 18 });
    let whole = render(&world, &settings, &options).unwrap().film;
    let first = part(0, 5, 0..1).film(4).unwrap();
    for (at, pixel) in film.pixels.iter().enumerate() {
        let (row, finished) = (at / size[0] as usize, film.finished[at]);
        match row {
            0..5 => assert!(!finished && *pixel == first.pixels[at]),
            5..13 => assert!(finished && *pixel == whole.pixels[at]),
            _ => assert!(!finished && *pixel == Rgb::black()),
        }
    }
    let other = PartialFilm::new([8, 8], Crop { width: 8, height: 8, x: 0, y: 0 }, Grid::new(film.crop, 8, []));
    assert!(matches!(all.joined(&[&other]), Err(JoinError::OtherSize(..))));
    for samples in [0..5, 3..3] {
        let mut part = PartialFilm::new(size, film.crop, Grid::new(film.crop, 8, []));
        let refused = part.render(&world, &settings, samples.clone(), &options, None).unwrap_err();
        assert!(matches!(refused, RenderError::SamplesOutside { .. }), "{samples:?}: {refused}");
    }
}

#[test]
fn an_unfinished_render_goes_on_wherever_it_was_stopped() {
    let scene = scene(6);
    let (world, settings) = (World::new(&scene).unwrap(), Settings::from(&scene));
    let whole = render(&world, &settings, &Options::default()).unwrap();
    let (size, all) = (world.camera.size, Crop { x: 0, y: 0, width: 37, height: 23 });
    let mut part = PartialFilm::new(size, all, Grid::new(all, 7, []));
    let mut stops = 0;
    while !part.has(0..6) {
        assert!(stops < 500, "{:?}", part.pieces());
        // Some are told that it is late, others are cancelled within a tile, after so many of them.
        let (cancel, calls) = (AtomicBool::new(false), AtomicU64::new(0));
        let progress = |_| cancel.store(calls.fetch_add(1, Ordering::Relaxed) >= 4 * (stops % 5), Ordering::Relaxed);
        let lanes = LaneWidth::ALL[stops as usize % 4];
        let threads = 1 + stops as usize % 3;
        let options =
            Options { threads, lanes, cancel: Some(&cancel), progress: Some(&progress), ..Options::default() };
        let until = (stops % 3 == 2).then(Instant::now);
        part.render(&world, &settings, 0..6, &options, until).unwrap();
        // As from a file, and with other tiles.
        part = join(&[&part], size, all, 5 + (stops % 11) as u32).unwrap();
        stops += 1;
    }
    assert!(stops > 10);
    assert_same(&part, &whole, 6, "stopped and continued");

    // Good, but more of it: as if it had been asked for in the first place.
    let more = Settings { spp: 11, ..settings };
    part.render(&world, &more, 0..11, &Options::default(), None).unwrap();
    assert_same(&part, &render(&world, &more, &Options::default()).unwrap(), 11, "more samples");
}
