//! Driver texts, in every dialect: reading ends with a scene or reports at places in the text.
#![no_main]

use libfuzzer_sys::fuzz_target;
use snell::render::{Options, Settings, render};
use snell::world::World;
use snell_formats::driver::{Dialect, parse};
use snell_formats::text::decode;

fuzz_target!(|bytes: &[u8]| {
    let (source, _) = decode("fuzz", bytes);
    for dialect in [None].into_iter().chain(Dialect::ALL.map(Some)) {
        match parse(&source, dialect) {
            Err(reports) => {
                for report in reports {
                    let (source, range) = report.place.unwrap();
                    assert!(source.text.get(range).is_some());
                }
            }
            Ok(mut driver) => {
                driver.scene.render.size = [3, 2];
                driver.scene.render.max_depth = driver.scene.render.max_depth.min(5);
                if let Ok(world) = World::new(&driver.scene) {
                    render(&world, &Settings::from(&driver.scene), &Options { threads: 1, ..Options::default() })
                        .unwrap();
                }
            }
        }
    }
});
