//! NFF texts: reading ends with a scene that can be drawn, or a report at a place in the text.
#![no_main]

use libfuzzer_sys::fuzz_target;
use snell::render::{Options, Settings, render};
use snell::world::World;
use snell_formats::nff::parse;
use snell_formats::text::decode;

fuzz_target!(|bytes: &[u8]| {
    let (source, _) = decode("fuzz", bytes);
    match parse(&source) {
        Err(report) => {
            let (source, range) = report.place.unwrap();
            assert!(source.text.get(range).is_some());
        }
        Ok(mut nff) => {
            nff.scene.render.size = [3, 2];
            nff.scene.render.max_depth = 2;
            if let Ok(world) = World::new(&nff.scene) {
                render(&world, &Settings::from(&nff.scene), &Options { threads: 1, ..Options::default() }).unwrap();
            }
        }
    }
});
