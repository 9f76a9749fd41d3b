//! Scene texts, TOML and JSON: whatever they say, reading ends with a scene or a report at a place in the text; a valid
//! scene can be written, read back the same, and drawn.
#![no_main]

use libfuzzer_sys::fuzz_target;
use snell::render::{Options, render};
use snell::world::World;
use snell_formats::Source;
use snell_formats::scene_file::{Syntax, parse, report, to_text};

fuzz_target!(|text: &str| {
    let source = Source::new("fuzz", text);
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
                scene.render.size = [3, 2];
                scene.render.max_depth = scene.render.max_depth.min(5);
                let world = World::new(&scene).unwrap();
                render(&world, &Options { threads: 1, ..Options::default() }).unwrap();
            }
        }
    }
});
