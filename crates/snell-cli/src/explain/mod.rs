//! `snell explain`: why a pixel has the colour it has.

mod compare;
mod find;
mod light;

use crate::args::ExplainArgs;
use crate::excerpt::plain;
use crate::input::{self, what_is};
use crate::output::{self, refuse_inputs, write_text};
use crate::recipe::{of_picture, of_scene};
use crate::say::{self, FAILED, Failure, OrFail, Outcome, SCENE, USAGE, tell};
use snell::explain::text::{Piece, Style, Text, text};
use snell::explain::{Explanation, explain};
use snell::geometry::bvh::Quality;
use snell::scene::{WarningCode, is_unprintable};
use snell::world::{CompiledScene, World};
use snell_formats::figure::figure;
use snell_formats::given::Given;
use snell_formats::load::Loaded;
use snell_formats::page::page;
use snell_formats::recipe::{Changes, Recipe};
use snell_formats::report::known_names;
use snell_formats::{Report, disk};
use std::path::Path;

/// What is explained: a scene as a command line asks for it.
struct Asked {
    recipe: Recipe,
    /// The scene file, also where a picture remembers it.
    scene: String,
    loaded: Loaded,
    compiled: CompiledScene,
}

impl Asked {
    /// Refuses to write over anything that this comes from.
    fn refuse(&self, output: &Path, args: &ExplainArgs) -> Outcome {
        let named = [Path::new(&args.scene), Path::new(&self.scene)];
        refuse_inputs(output, self.loaded.files().chain(named).chain(input::standard(&args.scene)))?;
        if output::is_standard(output) { Ok(()) } else { disk::check_writable(output).or_fail(FAILED) }
    }

    /// Says what is odd about it.
    fn warn(&self) {
        say::reports(&self.loaded.warnings_with(self.compiled.world()));
    }

    /// Explains a pixel of the picture, which may be a part of the scene's.
    fn pixel(&self, [x, y]: [u32; 2]) -> Result<Explanation, Failure> {
        let [x, y] = self.in_whole([x, y])?;
        let found = explain(&self.compiled, x, y);
        found.map(|(explanation, _)| explanation).ok_or_else(|| no_pixel([x, y], self.compiled.world().camera.size))
    }

    /// A pixel of the picture in the whole one.
    fn in_whole(&self, [x, y]: [u32; 2]) -> Result<[u32; 2], Failure> {
        match self.recipe.crop {
            None => Ok([x, y]),
            Some(crop) if x < crop.width && y < crop.height => Ok([crop.x + x, crop.y + y]),
            Some(crop) => Err(no_pixel([x, y], [crop.width, crop.height])),
        }
    }
}

fn no_pixel([x, y]: [u32; 2], [width, height]: [u32; 2]) -> Failure {
    let message = format!("there is no pixel {x},{y} in a picture of {width} x {height}");
    let help = format!("columns are 0 to {}, rows 0 to {}, from the top left", width - 1, height - 1);
    Failure::new(USAGE, Report::error(message).help(help))
}

pub fn run(args: &ExplainArgs) -> Outcome {
    let changes = Changes::from(args);
    if let Some(object) = &args.find {
        let asked = ask(args, &changes)?;
        asked.warn();
        return find::run(&asked, object, args);
    }
    if args.mask.is_some() {
        let report = Report::error("--mask shows where --find finds an object");
        return Err(Failure::new(
            USAGE,
            report.help("like `snell explain lecture/default --find green --mask green.png`"),
        ));
    }
    let Some(pixel) = args.pixel else {
        let report =
            Report::error("which pixel?").help("like `snell explain lecture/default 256,256`, or --find OBJECT");
        return Err(Failure::new(USAGE, report));
    };
    // Of a pixel, `--set` and `--without` ask what would be if.
    if !changes.set.is_empty() || args.without.is_some() {
        return compare::run(args, &changes, pixel);
    }
    let asked = ask(args, &changes)?;
    asked.warn();
    if let Some(light) = &args.light {
        known_light(&asked, light)?;
    }
    for file in [&args.html, &args.svg].into_iter().flatten() {
        asked.refuse(file, args)?;
    }
    let explanation = asked.pixel(pixel)?;
    if let Some(light) = &args.light {
        return print(&asked, &light::text(&explanation, light));
    }
    if let Some(file) = &args.html {
        return write(file, &page(&explanation, &asked.compiled));
    }
    if let Some(file) = &args.svg {
        return write(file, &figure(&explanation));
    }
    if args.json {
        return say::print(&format!("{}\n", json(&explanation)));
    }
    let default = Style::default();
    let style = Style { top: args.top.unwrap_or(default.top), depth: args.depth.unwrap_or(default.depth) };
    print(&asked, &shown(&text(&explanation, style)))
}

/// Reads what is explained, of a scene or of a picture that knows its scene.
fn ask(args: &ExplainArgs, changes: &Changes) -> Result<Asked, Failure> {
    let (mut recipe, mut loaded) = if let Given::Picture(_) = what_is(&args.scene) {
        let (recipe, loaded, notes) = of_picture(Path::new(&args.scene), &args.reading.search, changes)?;
        for note in notes {
            tell(&format!("note: {note}"));
        }
        (recipe, loaded)
    } else {
        of_scene(&args.scene, &args.reading, changes)?
    };
    recipe.apply(loaded.scene_mut());
    let scene = recipe.name.clone();
    if recipe.name != args.scene && args.scene != output::STANDARD {
        // What a picture remembers.
        let changes: Vec<String> = recipe.set.iter().map(|change| format!(" with {change}")).collect();
        recipe.name = format!("{}, {scene}{}", args.scene, changes.concat());
    }
    let compiled = loaded.compile(&recipe.name, Quality::default(), 0).or_fail(SCENE)?;
    Ok(Asked { recipe, scene, loaded, compiled })
}

/// May stdout be coloured?
fn colored() -> bool {
    say::colored(&std::io::stdout())
}

/// A text as terminals show it.
fn shown(text: &Text) -> String {
    let colored = colored();
    let piece = |piece: &Piece| match piece {
        Piece::Words(words) => words.clone(),
        Piece::Patch([r, g, b]) if colored => format!("\x1b[48;2;{r};{g};{b}m  \x1b[0m "),
        Piece::Patch(_) => String::new(),
        Piece::MoreRays(count) => format!("  … {count} more rays; --top N and --depth N show more\n"),
    };
    text.pieces.iter().map(piece).collect()
}

/// Prints an explanation. Where names hold characters that steer a terminal, its own colours go with them.
fn print(asked: &Asked, text: &str) -> Outcome {
    let odd = asked.compiled.world().warnings.iter().any(|warning| warning.code == WarningCode::UnprintableName);
    if odd || !colored() { say::print(&plain(text)) } else { say::print(text) }
}

/// Fails with the names that there are, if a scene has no such object.
fn known_object(world: &World, object: &str) -> Outcome {
    known(object, "object", &world.object_names())
}

/// The same of lights.
fn known_light(asked: &Asked, light: &str) -> Outcome {
    let names: Vec<String> = (0..asked.loaded.scene.lights.len()).map(|number| asked.compiled.light(number)).collect();
    known(light, "light", &names.iter().map(String::as_str).collect::<Vec<_>>())
}

fn known(name: &str, what: &str, names: &[&str]) -> Outcome {
    if names.contains(&name) {
        return Ok(());
    }
    let help = if names.is_empty() {
        format!("there is no {what} in this scene")
    } else {
        known_names(name, names.iter().copied())
    };
    Err(Failure::new(USAGE, Report::error(format!("no {what} is called `{name}`")).help(help)))
}

/// The JSON form.
fn json(explanation: &Explanation) -> String {
    // Every number in it is finite: worlds hold no others, and what is infinite is left out.
    let text = serde_json::to_string(explanation).unwrap_or_default();
    // What stands in JSON as it is and steers a terminal is written as JSON writes other such characters.
    let escaped = |c: char| if is_unprintable(c) { format!("\\u{:04x}", u32::from(c)) } else { c.to_string() };
    if text.contains(is_unprintable) { text.chars().map(escaped).collect::<Vec<_>>().concat() } else { text }
}

fn write(file: &Path, text: &str) -> Outcome {
    write_text(file, text)?;
    if !output::is_standard(file) {
        tell(&file.display().to_string());
    }
    Ok(())
}
