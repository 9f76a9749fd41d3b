//! What can be wrong with a scene, and where.

macro_rules! place {
    ($($step:expr),+) => { Vec::from([$(Step::from($step)),+]) };
}

mod material;
mod name;
mod shape;
mod view;

pub use name::is_unprintable;

use super::{Integrator, Problem, Problems, Scene, Shadows, Step, Warning, WarningCode};
use crate::color::Rgb;

/// Numbers beyond this are refused: their squares must fit into the `f32` boxes of the tree.
pub const LARGEST_NUMBER: f64 = 1e15;

/// The deepest recursion that is accepted.
pub const MAX_DEPTH: u32 = 1000;

/// More bands than this are refused: each is a ray at every split.
pub const MAX_BANDS: u32 = 64;

/// More samples per pixel are refused: Sobol's sequence has no more.
pub const MAX_SPP: u32 = 1 << 16;

#[derive(Default)]
struct Findings {
    problems: Vec<Problem>,
    warnings: Vec<Warning>,
}

impl Findings {
    fn problem(&mut self, place: Vec<Step>, message: impl Into<String>, help: &str) {
        let help = (!help.is_empty()).then(|| help.to_owned());
        self.problems.push(Problem { place, message: message.into(), help, remedy: None });
    }

    fn warning(&mut self, code: WarningCode, place: Vec<Step>, message: impl Into<String>) {
        self.warnings.push(Warning { code, place, message: message.into() });
    }

    fn number(&mut self, place: Vec<Step>, value: f64) -> bool {
        let fine = value.abs() <= LARGEST_NUMBER;
        if !fine {
            let message = format!("expected a number between -1e15 and 1e15, read {value}");
            self.problem(place, message, "");
        }
        fine
    }

    fn numbers(&mut self, place: &[Step], values: &[f64]) -> bool {
        // The list as a whole is the place: `[1, nan, 3]` is short enough to look at.
        let bad = values.iter().find(|v| v.is_nan() || v.abs() > LARGEST_NUMBER);
        bad.is_none_or(|&value| self.number(place.to_vec(), value))
    }

    fn color(&mut self, place: &[Step], value: Rgb) {
        self.numbers(place, &value.to_array());
    }

    fn not_negative(&mut self, place: Vec<Step>, value: f64, what: &str) {
        if self.number(place.clone(), value) && value < 0.0 {
            self.problem(place, format!("{what} must not be negative, read {value}"), "");
        }
    }

    fn positive(&mut self, place: Vec<Step>, value: f64, what: &str, help: &str) {
        if self.number(place.clone(), value) && value <= 0.0 {
            self.problem(place, format!("{what} must be above 0, read {value}"), help);
        }
    }
}

/// Everything that is wrong with a scene, or the warnings if nothing is.
///
/// # Errors
/// All problems, in the order of the scene.
pub fn validate(scene: &Scene) -> Result<Vec<Warning>, Problems> {
    let mut found = Findings::default();
    settings(scene, &mut found);
    view::camera(scene, &mut found);
    view::lights(scene, &mut found);
    view::sky(scene, &mut found);
    material::materials(scene, &mut found);
    material::emission(scene, &mut found);
    material::textures(scene, &mut found);
    shape::spheres(scene, &mut found);
    shape::meshes(scene, &mut found);
    shape::planes(scene, &mut found);
    shape::boxes(scene, &mut found);
    shape::discs(scene, &mut found);
    shape::lathes(scene, &mut found);
    material::indices(scene, &mut found);
    only_whitted(scene, &mut found);
    name::names(scene, &mut found);
    Problems::of(found.problems).map_or(Ok(found.warnings), Err)
}

fn settings(scene: &Scene, found: &mut Findings) {
    if scene.snell != super::SCHEMA_VERSION {
        let message = format!("version {} of the scene format; this program reads version 1", scene.snell);
        found.problem(place!["snell"], message, "write `snell = 1`, or use a newer Snell");
    }
    found.color(&place!["ambient"], scene.ambient);
    found.color(&place!["background"], scene.background);
    found.not_negative(place!["render", "min_throughput"], scene.render.min_throughput, "a throughput");
    let help = "1.0 is empty space, 1.33 water";
    found.positive(place!["eta_outside"], scene.eta_outside, "an index of refraction", help);
    let [width, height] = scene.render.size;
    if width == 0 || height == 0 {
        let message = format!("a picture of {width} x {height} pixels has none");
        found.problem(place!["render", "size"], message, "both must be at least 1, like [512, 512]");
    }
    if !(1..=MAX_SPP).contains(&scene.render.spp) {
        let message = format!("expected 1 to {MAX_SPP} samples per pixel, read {}", scene.render.spp);
        found.problem(place!["render", "spp"], message, "16 makes smooth edges; 1 is the lecture's grid");
    }
    if scene.render.shadows == Some(Shadows::Caustic) {
        let message = "light that glass focuses is not built yet";
        found.problem(
            place!["render", "shadows"],
            message,
            "choose `tinted`: straight through, with what is lost on the way",
        );
    }
    if !(1..=MAX_BANDS).contains(&scene.render.bands) {
        let message = format!("expected 1 to {MAX_BANDS} bands, read {}", scene.render.bands);
        found.problem(place!["render", "bands"], message, "16 is enough for most pictures; 1 is no dispersion");
    }
    if scene.render.max_depth > MAX_DEPTH {
        let message = format!("max_depth {} is above {MAX_DEPTH}", scene.render.max_depth);
        found.problem(place!["render", "max_depth"], message, "");
    }
}

/// What the lecture's models would silently leave out.
fn only_whitted(scene: &Scene, found: &mut Findings) {
    if scene.render.integrator == Integrator::Whitted {
        return;
    }
    let mut unused = |place: Vec<Step>, used: bool| {
        if used {
            let message = "only the integrator `whitted` has this; here it changes nothing".to_owned();
            found.warning(WarningCode::NotInThisModel, place, message);
        }
    };
    unused(place!["sky"], scene.sky.is_some());
    unused(place!["background"], scene.background != Rgb::gray(0.0));
    unused(place!["render", "bands"], scene.render.bands != super::BANDS);
    unused(place!["render", "min_throughput"], scene.render.min_throughput != super::MIN_THROUGHPUT);
    let sides = scene.meshes.iter().map(|m| &m.inside).enumerate().map(|(i, inside)| ("mesh", i, inside));
    let sides = sides.chain(scene.planes.iter().enumerate().map(|(i, p)| ("plane", i, &p.inside)));
    let sides = sides.chain(scene.discs.iter().enumerate().map(|(i, d)| ("disc", i, &d.inside)));
    for (kind, i, inside) in sides.chain(scene.lathes.iter().enumerate().map(|(i, l)| ("lathe", i, &l.inside))) {
        unused(place![kind, i, "inside"], inside.is_some());
    }
    for (name, m) in &scene.materials {
        let at = |key: &str| place!["material", name.as_str(), key];
        unused(at("emission"), m.emission != Rgb::gray(0.0));
        unused(at("attenuation_color"), m.attenuation_color.is_some());
        unused(at("sigma_a"), m.sigma_a.is_some());
        unused(at("priority"), m.priority != 0);
        unused(at("tinted_transmission"), m.tinted_transmission);
        unused(at("abbe"), m.abbe.is_some());
        unused(at("thickness"), m.thickness.is_some());
    }
    for (name, texture) in &scene.textures {
        if texture.pixels.as_ref().is_some_and(|image| image.alpha().is_some()) {
            let message =
                "only the integrator `whitted` draws the alpha of a texture; here the surface is everywhere".to_owned();
            found.warning(WarningCode::NotInThisModel, place!["texture", name.as_str(), "image"], message);
        }
    }
    if scene.render.shadows == Some(Shadows::Tinted) {
        let message = "shadows `tinted` need the integrator `whitted`";
        found.problem(place!["render", "shadows"], message, "choose `opaque` or `off`, or integrator = \"whitted\"");
    }
}

/// More names than this are counted.
const NAMED: usize = 20;

/// Names in a message.
fn names<'a>(names: impl ExactSizeIterator<Item = &'a String>) -> String {
    let more = names.len().saturating_sub(NAMED);
    let known: Vec<String> = names.take(NAMED).map(|k| format!("`{k}`")).collect();
    match (known.is_empty(), more) {
        (true, _) => "none".to_owned(),
        (false, 0) => known.join(", "),
        (false, more) => format!("{} and {more} more", known.join(", ")),
    }
}
