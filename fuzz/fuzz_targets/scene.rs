//! Scene texts, TOML and JSON: whatever they say, reading ends with a scene or a report at a place in the text; a valid
//! scene can be written, read back the same, and drawn.
#![no_main]

use libfuzzer_sys::fuzz_target;
use snell::render::{Options, Settings, render};
use snell::world::World;
use snell_formats::Source;
use snell_formats::scene_file::{Syntax, parse, report, set, to_text};
use snell_formats::text::decode;

fuzz_target!(|bytes: &[u8]| {
    let (source, _) = decode("fuzz", bytes);
    for syntax in [Syntax::Toml, Syntax::Json] {
        let Ok(mut scene) = parse(&source, syntax) else { continue };
        match World::new(&scene) {
            Err(problems) => {
                for problem in &problems {
                    let place = report(problem, &source, syntax).place;
                    assert!(place.is_none_or(|(source, range)| source.text.get(range).is_some()));
                }
            }
            Ok(_) => {
                let again = parse(&Source::new("again", to_text(&scene, syntax).unwrap()), syntax).unwrap();
                assert!(again == scene, "a scene changes when it is written and read");
                // Any word of the text as a change: it is made or refused, and then nothing is changed.
                for word in source.text.split_whitespace().take(20) {
                    let mut changed = scene.clone();
                    assert!(set(&mut changed, word).is_ok() || changed == scene, "a refused change is made");
                }
                scene.render.size = [3, 2];
                scene.render.max_depth = scene.render.max_depth.min(5);
                let world = World::new(&scene).unwrap();
                render(&world, &Settings::from(&scene), &Options { threads: 1, ..Options::default() }).unwrap();
            }
        }
    }
});
