//! What can be wrong with a scene, and where.

use super::{Integrator, Material, Scene, Shadows, Transform, Warning, WarningCode};
use crate::film::Rgb;
use crate::geometry::Vec3;
use crate::optics::dispersion::LINE_D_NM;
use crate::optics::spectrum;
use std::fmt;

/// Numbers beyond this are refused: their squares must fit into the `f32` boxes of the tree.
pub const LARGEST_NUMBER: f64 = 1e15;

/// The deepest recursion that is accepted.
pub const MAX_DEPTH: u32 = 1000;

/// More bands than this are refused: each is a ray at every split.
pub const MAX_BANDS: u32 = 64;

/// One step on the way to a value in a scene: `sphere`, `2`, `radius`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// A key of a table.
    Key(String),
    /// An element of a list, counted from 0.
    Index(usize),
}

impl From<&str> for Step {
    fn from(key: &str) -> Self {
        Self::Key(key.to_owned())
    }
}

impl From<usize> for Step {
    fn from(index: usize) -> Self {
        Self::Index(index)
    }
}

/// Why a scene cannot be drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Where in the scene, from the root.
    pub place: Vec<Step>,
    /// What was read and what was expected.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, step) in self.place.iter().enumerate() {
            match step {
                Step::Key(key) if i == 0 => write!(f, "{key}")?,
                Step::Key(key) => write!(f, ".{key}")?,
                Step::Index(index) => write!(f, "[{index}]")?,
            }
        }
        write!(f, ": {}", self.message)
    }
}

impl std::error::Error for Problem {}

macro_rules! place {
    ($($step:expr),+) => { Vec::from([$(Step::from($step)),+]) };
}

#[derive(Default)]
struct Findings {
    problems: Vec<Problem>,
    warnings: Vec<Warning>,
}

impl Findings {
    fn problem(&mut self, place: Vec<Step>, message: impl Into<String>, help: &str) {
        let help = (!help.is_empty()).then(|| help.to_owned());
        self.problems.push(Problem { place, message: message.into(), help });
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
pub fn validate(scene: &Scene) -> Result<Vec<Warning>, Vec<Problem>> {
    let mut found = Findings::default();
    settings(scene, &mut found);
    camera(scene, &mut found);
    lights(scene, &mut found);
    materials(scene, &mut found);
    spheres(scene, &mut found);
    meshes(scene, &mut found);
    indices(scene, &mut found);
    only_whitted(scene, &mut found);
    if found.problems.is_empty() { Ok(found.warnings) } else { Err(found.problems) }
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
    if !(1..=MAX_BANDS).contains(&scene.render.bands) {
        let message = format!("expected 1 to {MAX_BANDS} bands, read {}", scene.render.bands);
        found.problem(place!["render", "bands"], message, "16 is enough for most pictures; 1 is no dispersion");
    }
    if scene.render.max_depth > MAX_DEPTH {
        let message = format!("max_depth {} is above {MAX_DEPTH}", scene.render.max_depth);
        found.problem(place!["render", "max_depth"], message, "");
    }
}

fn camera(scene: &Scene, found: &mut Findings) {
    let camera = &scene.camera;
    let at = |key: &str| place!["camera", key];
    let mut fine = true;
    for (key, value) in [("eye", &camera.eye), ("look_at", &camera.look_at), ("up", &camera.up)] {
        fine &= found.numbers(&at(key), value);
    }
    if let Some(far) = camera.far {
        found.number(at("far"), far);
    }
    if found.number(at("near"), camera.near) && camera.near >= 0.0 {
        let message = format!("near must be negative, read {}", camera.near);
        found.problem(at("near"), message, "the image plane stands in front of the eye, on the negative side, like -5");
    }
    let [left, right, bottom, top] = camera.bounds;
    if found.numbers(&at("bounds"), &camera.bounds) && (left == right || bottom == top) {
        let message = format!("the bounds have no area: left {left}, right {right}, bottom {bottom}, top {top}");
        found.problem(at("bounds"), message, "the order is left, right, bottom, top, like [-2, 2, -2, 2]");
    }
    if !fine {
        return;
    }
    let (eye, look_at, up) = (Vec3::from(camera.eye), Vec3::from(camera.look_at), Vec3::from(camera.up));
    if !(eye - look_at).unit().is_finite() {
        found.problem(
            at("look_at"),
            "look_at is where the eye is, or too near, so there is no direction to look in",
            "",
        );
    } else if !up.unit().is_finite() {
        found.problem(at("up"), "up is (0, 0, 0), or too short to be a direction", "try [0, 1, 0]");
    } else if camera.axes().is_none() {
        let message = "up is parallel to the view, so there is no upright picture";
        found.problem(at("up"), message, "choose another up, like [0, 0, 1] when looking straight down y");
    }
}

fn lights(scene: &Scene, found: &mut Findings) {
    for (i, light) in scene.lights.iter().enumerate() {
        found.color(&place!["light", i, "color"], light.color);
        match (light.position, light.direction) {
            (Some(position), None) => {
                found.numbers(&place!["light", i, "position"], &position);
            }
            (None, Some(direction)) => {
                let at = place!["light", i, "direction"];
                if found.numbers(&at, &direction) && !Vec3::from(direction).unit().is_finite() {
                    found.problem(at, "direction is (0, 0, 0), or too short to be one", "");
                }
            }
            (Some(_), Some(_)) => {
                let message = "a light has a position or a direction, not both";
                found.problem(place!["light", i, "direction"], message, "remove one of them");
            }
            (None, None) => {
                let help = "add `position = [x, y, z]`, or `direction = [x, y, z]` for a light at infinity";
                found.problem(place!["light", i], "a light needs a position or a direction", help);
            }
        }
    }
}

fn materials(scene: &Scene, found: &mut Findings) {
    for (name, m) in &scene.materials {
        let at = |key: &str| place!["material", name.as_str(), key];
        for (key, value) in [("ka", m.ka), ("kd", m.kd), ("ks", m.ks), ("kr", m.kr), ("ko", m.ko)] {
            found.color(&at(key), value);
        }
        if m.ko.to_array().iter().any(|&ko| ko > 1.0) {
            let message = format!("material `{name}` is more than opaque: its transparent share 1 - ko is negative");
            found.warning(WarningCode::OpacityAboveOne, at("ko"), message);
        }
        found.not_negative(at("spow"), m.spow, "an exponent");
        found.color(&at("emission"), m.emission);
        absorption(found, &at, m);
        dispersion(scene, found, &at, m);
        found.positive(at("eta"), m.eta, "an index of refraction", "glass is about 1.5, water 1.33");
    }
}

fn dispersion(scene: &Scene, found: &mut Findings, at: &impl Fn(&str) -> Vec<Step>, m: &Material) {
    let given = [("glass", m.glass.is_some()), ("abbe", m.abbe.is_some()), ("cauchy", m.cauchy.is_some())];
    let mut given = given.into_iter().filter(|(_, given)| *given).map(|(key, _)| key);
    let Some(key) = given.next() else { return };
    if let Some(other) = given.next() {
        found.problem(
            at(other),
            format!("dispersion is given twice: by `{key}` and by `{other}`"),
            "remove one of them",
        );
        return;
    }
    if key != "abbe" && m.eta != 1.0 {
        let message = format!("the index is given twice: by `{key}` and by `eta`");
        found.problem(at("eta"), message, "remove one of them");
    }
    if m.abbe.is_some_and(|abbe| !found.number(at("abbe"), abbe) || abbe <= 0.0) {
        found.problem(at("abbe"), "an Abbe number must be above 0", "crown glass has about 60, flint about 30");
        return;
    }
    if m.cauchy.is_some_and(|cauchy| !found.numbers(&at("cauchy"), &cauchy)) {
        return;
    }
    let dispersion = match m.dispersion() {
        Ok(dispersion) => dispersion,
        Err(unknown) => return found.problem(at("glass"), unknown.to_string(), "docs/glasses.md lists them all"),
    };
    let bands = if scene.render.integrator == Integrator::Whitted { scene.render.bands } else { 1 };
    if (1..=MAX_BANDS).contains(&bands) {
        let mut wavelengths =
            spectrum::bands(bands as usize).into_iter().map(|band| band.wavelength_nm).chain([LINE_D_NM]);
        if let Some(error) = wavelengths.find_map(|nm| dispersion.eta(nm).err()) {
            found.problem(at(key), format!("{error}; pictures need it from 380 to 780 nm"), "give the index by `eta`");
        }
    }
}

fn absorption(found: &mut Findings, at: &impl Fn(&str) -> Vec<Step>, m: &Material) {
    if let Some(distance) = m.attenuation_distance {
        found.positive(at("attenuation_distance"), distance, "a thickness", "");
    }
    let colors = [("attenuation_color", m.attenuation_color), ("sigma_a", m.sigma_a)];
    for (key, color) in colors.into_iter().filter_map(|(key, color)| Some((key, color?))) {
        found.color(&at(key), color);
        for value in color.to_array() {
            found.not_negative(at(key), value, if key == "sigma_a" { "an absorption" } else { "a colour" });
            if key == "attenuation_color" && value > 1.0 {
                found.problem(at(key), format!("glass does not make light: read {value}, expected 0 to 1"), "");
            }
        }
    }
    if m.sigma_a.is_some() && m.attenuation_color.is_some() {
        let message = "absorption is given twice: by `sigma_a`, and by a colour at a distance";
        found.problem(at("sigma_a"), message, "remove one of them");
    }
    if m.attenuation_color.is_some() != m.attenuation_distance.is_some() {
        let key = if m.attenuation_color.is_some() { "attenuation_color" } else { "attenuation_distance" };
        let message =
            "`attenuation_color` is the colour of white light after `attenuation_distance`: one says nothing alone";
        found.problem(
            at(key),
            message,
            "give both, like attenuation_color = [0.9, 1, 0.95] and attenuation_distance = 10",
        );
    }
}

/// Real optics squares indices, and nothing known is beyond these.
const INDICES: std::ops::RangeInclusive<f64> = 1e-3..=1e3;

fn indices(scene: &Scene, found: &mut Findings) {
    if scene.render.integrator != Integrator::Whitted {
        return;
    }
    let outside = (place!["eta_outside"], scene.eta_outside);
    let materials = scene.materials.iter().map(|(name, m)| (place!["material", name.as_str(), "eta"], m.eta));
    for (place, eta) in materials.chain([outside]) {
        if eta > 0.0 && !INDICES.contains(&eta) {
            found.problem(place, format!("expected an index of refraction from 0.001 to 1000, read {eta}"), "");
        }
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
    unused(place!["background"], scene.background != Rgb::gray(0.0));
    unused(place!["render", "bands"], scene.render.bands != super::BANDS);
    unused(place!["render", "min_throughput"], scene.render.min_throughput != super::MIN_THROUGHPUT);
    for (name, m) in &scene.materials {
        let at = |key: &str| place!["material", name.as_str(), key];
        unused(at("emission"), m.emission != Rgb::gray(0.0));
        unused(at("attenuation_color"), m.attenuation_color.is_some());
        unused(at("sigma_a"), m.sigma_a.is_some());
        unused(at("priority"), m.priority != 0);
        unused(at("dyed"), m.dyed);
        unused(at("abbe"), m.abbe.is_some());
    }
    if scene.render.shadows == Shadows::Tinted {
        let message = "shadows `tinted` need the integrator `whitted`";
        found.problem(place!["render", "shadows"], message, "choose `opaque` or `off`, or integrator = \"whitted\"");
    }
}

fn spheres(scene: &Scene, found: &mut Findings) {
    for (i, sphere) in scene.spheres.iter().enumerate() {
        found.numbers(&place!["sphere", i, "center"], &sphere.center);
        found.not_negative(place!["sphere", i, "radius"], sphere.radius, "a radius");
        if sphere.radius == 0.0 {
            let at = place!["sphere", i, "radius"];
            found.warning(WarningCode::InvisibleSphere, at, "a sphere of radius 0 is invisible");
        }
        known_material(scene, found, place!["sphere", i, "material"], &sphere.material);
    }
}

fn known_material(scene: &Scene, found: &mut Findings, at: Vec<Step>, name: &str) {
    if !scene.materials.contains_key(name) {
        let known: Vec<String> = scene.materials.keys().map(|k| format!("`{k}`")).collect();
        let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
        let message = format!("no material is called `{name}`");
        found.problem(at, message, &format!("materials of this scene: {known}; or add [material.{name}]"));
    }
}

fn transform_step(found: &mut Findings, at: Vec<Step>, step: &Transform) {
    let fine = match step {
        Transform::Rotate { axis, degrees } => found.numbers(&at, axis) && found.number(at.clone(), *degrees),
        Transform::Scale(v) | Transform::Move(v) => found.numbers(&at, v),
    };
    if fine && step.map().is_none() {
        found.problem(at, "a rotation needs an axis, read [0, 0, 0]", "[0, 1, 0] turns about the y axis");
    }
}

fn meshes(scene: &Scene, found: &mut Findings) {
    for (i, mesh) in scene.meshes.iter().enumerate() {
        let at = |key: &str| place!["mesh", i, key];
        found.not_negative(at("smooth_angle"), mesh.smooth_angle, "an angle");
        if let Some(name) = &mesh.material {
            known_material(scene, found, at("material"), name);
        }
        for (slot, name) in &mesh.materials {
            known_material(scene, found, place!["mesh", i, "materials", slot.as_str()], name);
        }
        for (k, step) in mesh.transform.iter().enumerate() {
            transform_step(found, place!["mesh", i, "transform", k], step);
        }
        for (n, steps) in mesh.instances.iter().enumerate() {
            for (k, step) in steps.iter().enumerate() {
                transform_step(found, place!["mesh", i, "instances", n, k], step);
            }
        }
        let written_out = !mesh.vertices.is_empty() || !mesh.faces.is_empty();
        match (mesh.file.is_some(), written_out) {
            (true, true) => {
                found.problem(at("file"), "a mesh has a file or vertices and faces, not both", "remove one of them");
            }
            (false, false) if mesh.geometry.is_none() => {
                let help = "add `file = \"model.obj\"`, or `vertices` and `faces`";
                found.problem(place!["mesh", i], "a mesh needs a file, or vertices and faces", help);
            }
            (false, true) => inline_mesh(mesh, i, found),
            _ => {}
        }
    }
}

fn inline_mesh(mesh: &super::Mesh, i: usize, found: &mut Findings) {
    for (k, vertex) in mesh.vertices.iter().enumerate() {
        found.numbers(&place!["mesh", i, "vertices", k], vertex);
    }
    let count = mesh.vertices.len();
    if mesh.faces.is_empty() {
        found.problem(place!["mesh", i, "vertices"], "a mesh with vertices needs faces", "like `faces = [[0, 1, 2]]`");
    }
    for (k, face) in mesh.faces.iter().enumerate() {
        if let Some(bad) = face.iter().find(|&&v| v as usize >= count) {
            let message = format!("face asks for vertex {bad}, but there are {count}, counted from 0");
            found.problem(place!["mesh", i, "faces", k], message, "");
        }
    }
    if mesh.material.is_none() {
        let help = "add `material = \"name\"`";
        found.problem(place!["mesh", i], "a mesh that is written out needs a material", help);
    }
}
