//! The settings that must not change a bit.

use snell::render::{LaneWidth, Options, Rendered, Settings, render};
use snell::scene::Scene;
use snell::world::World;
use snell_formats::files::sha256;

/// Threads, where there are any: alone, a few, and more than most pictures here have tiles.
pub const THREADS: &[usize] = &[1, 2, 7];

/// Edges of tiles: one that divides the pictures, one that does not, and one tile for everything.
pub const TILE_SIZES: &[u32] = &[8, 16, 33];

/// Renders a scene on one thread, as [`line`] of the result.
///
/// # Panics
/// When the scene cannot be rendered.
pub fn once(name: &str, scene: &Scene) -> String {
    let options = Options { threads: 1, ..Options::default() };
    line(name, &rendered(&World::new(scene).unwrap(), &Settings::from(scene), &options))
}

/// Renders a scene with all lanes, tiles and the `threads` asked for, and without the tree.
///
/// # Panics
/// When two of the pictures or their statistics differ, and says which.
pub fn all_ways(name: &str, scene: &Scene, threads: &[usize]) -> String {
    let (world, settings) = (World::new(scene).unwrap(), Settings::from(scene));
    let expected = rendered(&world, &settings, &Options { threads: 1, lanes: LaneWidth::One, ..Options::default() });
    let same = |world: &World, options: Options<'_>, tree: &str| {
        let actual = rendered(world, &settings, &options);
        let different = different_pixels(&expected, &actual);
        assert!(different.is_empty(), "{name}, {tree}, {options:?}: other pixels at {different:?}");
        assert_eq!(actual.statistics, expected.statistics, "{name}, {tree}, {options:?}");
    };
    for lanes in LaneWidth::ALL {
        for &threads in threads {
            for &tile_size in TILE_SIZES {
                same(&world, Options { threads, tile_size, lanes, ..Options::default() }, "with the tree");
            }
        }
    }
    // Once, for it is slow.
    same(&world.brute_force(), Options { threads: 1, ..Options::default() }, "without the tree");
    line(name, &expected)
}

fn rendered(world: &World, settings: &Settings, options: &Options<'_>) -> Rendered {
    let rendered = render(world, settings, options).unwrap();
    assert!(rendered.film.is_finished());
    rendered
}

/// Columns and rows of the first few pixels whose bytes differ.
fn different_pixels(a: &Rendered, b: &Rendered) -> Vec<(usize, usize)> {
    let different = a.film.bytes().zip(b.film.bytes()).enumerate().filter(|(_, (a, b))| a != b);
    let mut pixels: Vec<usize> = different.map(|(i, _)| i / 3).collect();
    pixels.dedup();
    pixels.into_iter().take(4).map(|p| (p % a.film.width(), p / a.film.width())).collect()
}

/// The SHA-256 of the film, the start of that of the statistics, and the name.
fn line(name: &str, rendered: &Rendered) -> String {
    let statistics = sha256([format!("{:?}", rendered.statistics)]);
    format!("{} {} {name}", sha256(rendered.film.bytes()), &statistics[..16])
}
