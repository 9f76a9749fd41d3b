//! What JavaScript holds: a scene, and its picture as far as it has come.

use crate::findings::{json, thrown};
use crate::picture::{Asked, Changed, Picture};
use crate::ready::{Given, GivenScene, Ready};
use js_sys::{Array, Uint8Array, try_iter};
use serde_json::json;
use snell::explain::{Sightings, ViewScene, black_picture, explain, find};
use snell::film::{Crop, Film};
use snell::render::{Options, Progress};
use snell::world::CompiledScene;
use snell_formats::files::{InMemory, MAX_SCENE_BYTES, in_memory, sha256};
use snell_formats::picture::{self, Format};
use snell_formats::recipe::Changes;
use snell_formats::report::known_names;
use snell_formats::scene_file::{self, Syntax};
use snell_formats::{Report, builtin, memory};
use std::sync::Arc;
use wasm_bindgen::prelude::*;
use wasm_bindgen::{Clamped, JsCast};

/// A scene that may be edited, and its picture.
#[wasm_bindgen]
pub struct Session {
    given: Given,
    edits: Vec<String>,
    /// What `ready` was made with: the edits, and what was asked of the picture.
    changes: Changes,
    ready: Ready,
    picture: Option<Picture>,
}

/// What a function for JavaScript returns.
type Answer<T> = Result<T, JsValue>;

/// Throws what is refused.
fn or_throw<T, E: Into<Vec<Report>>>(result: Result<T, E>) -> Answer<T> {
    result.map_err(|reports| thrown(&reports.into()))
}

#[wasm_bindgen]
impl Session {
    /// Reads a scene from the bytes of its file. `files` are the models and pictures that it names, and more if need be: a `Map`, or
    /// a list of pairs, of a name and bytes. Names may have folders; those in a scene are relative to the folder of `name`.
    pub fn load(
        name: String,
        text: &Uint8Array,
        #[wasm_bindgen(unchecked_optional_param_type = "Iterable<[string, Uint8Array]>")] files: JsValue,
    ) -> Answer<Self> {
        let bytes = or_throw(copy(&name, text, MAX_SCENE_BYTES))?;
        Self::new(GivenScene::File { name, bytes }, read_files(&files)?)
    }

    /// A built-in scene.
    pub fn builtin(name: &str) -> Answer<Self> {
        Self::new(GivenScene::Builtin(or_throw(builtin::find(name))?), InMemory::default())
    }

    /// The built-in scenes: a list of `name` and `text`, in JSON.
    pub fn scenes() -> String {
        let scenes = builtin::SCENES.iter().map(|(name, text)| json!({ "name": name, "text": text }));
        scenes.collect::<serde_json::Value>().to_string()
    }

    /// Changes one value of the scene, as `--set key=value` does. What was rendered is gone; what is refused leaves all as it was.
    pub fn edit(&mut self, key: &str, value: &str) -> Answer<()> {
        let change = format!("{key}={value}");
        // What was asked of the picture before must not hide a setting of the scene.
        let is_setting = scene_file::keys(&change).first().is_some_and(|table| table == "render");
        let asked = if is_setting { Changes::default() } else { self.changes.clone() };
        let edits = with_edit(&self.edits, change);
        let changes = Changes { set: edits.clone(), ..asked };
        let ready = self.prepared(&changes)?;
        self.take(changes, ready);
        (self.edits, self.picture) = (edits, None);
        Ok(())
    }

    /// Begins a picture. `options` are an object in JSON: `size`, `spp`, `depth`, `integrator`, `shadows`, as of a scene's `render`;
    /// `coarsest`, with which the first sample of every so many-th pixel comes first; and `crop`, a part of the picture by `x`, `y`,
    /// `width`, `height`. What is left out is as the scene has it. What is refused leaves the scene as it was.
    pub fn begin(&mut self, options: Option<String>) -> Answer<()> {
        self.begin_with(options, Picture::begin)
    }

    /// Begins a picture that other instances render: it is put together from their `values`. The options are those of
    /// `begin`.
    pub fn gather(&mut self, options: Option<String>) -> Answer<()> {
        self.begin_with(options, Picture::gather)
    }

    /// Renders for so many milliseconds, at least a tile. Returns which parts of the picture have changed, five numbers for each: left,
    /// top, width, height, and how many pixels apart those are that were rendered.
    pub fn step(&mut self, milliseconds: f64) -> Vec<u32> {
        let changed = self.picture.as_mut().map(|picture| picture.step(milliseconds)).unwrap_or_default();
        changed.iter().flat_map(Changed::numbers).collect()
    }

    /// Puts a part, which another instance has rendered to its end, into a gathered picture.
    pub fn put(&mut self, x: u32, y: u32, width: u32, height: u32, values: &[f64]) -> Answer<()> {
        let Some(picture) = &mut self.picture else { return Err(thrown(&[nothing_begun()])) };
        or_throw(picture.put(Crop { x, y, width, height }, values))
    }

    /// Width and height of the whole picture.
    #[wasm_bindgen(getter)]
    pub fn size(&self) -> Vec<u32> {
        self.ready.compiled.world().camera.size.to_vec()
    }

    /// Is everything rendered?
    #[wasm_bindgen(getter)]
    pub fn is_finished(&self) -> bool {
        self.picture.as_ref().is_some_and(Picture::is_finished)
    }

    /// How far the picture is, in JSON: `pixels` of `total_pixels`, and the `rays` that it took.
    pub fn progress(&self) -> String {
        let nothing = Progress { pixels: 0, total_pixels: 0, rays: 0 };
        let Progress { pixels, total_pixels, rays } = self.picture.as_ref().map_or(nothing, Picture::progress);
        json!({ "pixels": pixels, "total_pixels": total_pixels, "rays": rays }).to_string()
    }

    /// SHA-256 of the numbers of the finished picture, as `snell render` has it.
    #[wasm_bindgen(getter)]
    pub fn film_sha256(&self) -> Option<String> {
        self.picture.as_ref().filter(|picture| picture.is_finished()).map(|picture| sha256(picture.film().bytes()))
    }

    /// A part of the picture as a canvas shows it: red, green, blue and 255 of each pixel, by the curve of the scene.
    pub fn rgba(&self, x: u32, y: u32, width: u32, height: u32) -> Answer<Clamped<Vec<u8>>> {
        let part = self.part(Crop { x, y, width, height })?;
        let encoding = self.ready.compiled.scene().render.encoding();
        let bytes = part.pixels.iter().flat_map(|pixel| {
            let [r, g, b] = pixel.to_array().map(|value| encoding.encode(value, 255) as u8);
            [r, g, b, 255]
        });
        Ok(Clamped(bytes.collect()))
    }

    /// The numbers of a part of the picture: linear red, green and blue of each pixel.
    pub fn values(&self, x: u32, y: u32, width: u32, height: u32) -> Answer<Vec<f64>> {
        Ok(self.part(Crop { x, y, width, height })?.numbers().to_vec())
    }

    /// Why a pixel of the whole picture has its colour: its ray tree in JSON, as `snell explain --json` has it.
    pub fn explain(&self, x: u32, y: u32) -> Answer<String> {
        let Some((explanation, _)) = explain(&self.ready.compiled, x, y) else {
            let [width, height] = self.ready.compiled.world().camera.size;
            let message = format!("there is no pixel {x},{y} in a picture of {width} x {height}");
            return Err(thrown(&[Report::error(message)]));
        };
        // Every number in it is finite, so that there is always one.
        Ok(serde_json::to_string(&explanation).unwrap_or_default())
    }

    /// The scene as the viewer draws it, in JSON.
    pub fn view(&self) -> String {
        serde_json::to_string(&ViewScene::of(&self.ready.compiled)).unwrap_or_default()
    }

    /// Where an object is seen. It looks at every pixel of the whole picture, which takes much longer than rendering.
    pub fn find(&self, object: &str) -> Answer<Seen> {
        let world = self.ready.compiled.world();
        let known = world.object_names();
        if !known.contains(&object) {
            let report = Report::error(format!("no object is called `{object}`"));
            return Err(thrown(&[report.help(known_names(object, known))]));
        }
        let pixels = world.camera.size.map(u64::from).iter().product::<u64>();
        or_throw(memory::check("to look at all pixels", pixels.saturating_mul(BYTES_OF_SIGHTINGS)))?;
        let seen = find(&self.ready.compiled, object, &Options::default());
        // Only a render that was cancelled has none.
        let Sightings { paths, mask } = seen.ok_or_else(|| thrown(&[nothing_begun()]))?;
        let paths = paths.iter().map(|(path, pixels)| json!({ "path": path.to_string(), "pixels": pixels }));
        Ok(Seen { paths: paths.collect::<serde_json::Value>().to_string(), mask })
    }

    /// What is odd about the scene, and about its picture once that is finished: a list in JSON.
    pub fn validate(&self) -> String {
        let Ready { compiled, warnings, .. } = &self.ready;
        let finished = self.picture.iter().filter(|picture| picture.is_finished());
        let of_picture = finished
            .flat_map(|picture| picture.warnings(compiled).into_iter().chain(black_picture(compiled, picture.film())));
        let of_picture = of_picture.map(|warning| Report::warning(warning.code, warning.message));
        json(&warnings.iter().cloned().chain(of_picture).collect::<Vec<_>>())
    }

    /// The scene with its edits as TOML, without what was asked of a picture.
    pub fn save(&self) -> Answer<String> {
        let scene = or_throw(self.given.edited(&self.edits))?;
        or_throw(scene_file::to_text(&scene, Syntax::Toml))
    }

    /// The picture so far as a PNG of 8 bit, with its recipe.
    pub fn png(&self) -> Answer<Vec<u8>> {
        self.file(Format::Png { sixteen_bit: false })
    }

    /// The picture so far as an EXR, with its recipe.
    pub fn exr(&self) -> Answer<Vec<u8>> {
        self.file(Format::Exr)
    }
}

/// What finding takes for each pixel, where a few paths lead to an object.
const BYTES_OF_SIGHTINGS: u64 = 400;

impl Session {
    fn new(scene: GivenScene, files: InMemory) -> Answer<Self> {
        let given = Given { scene, files: Arc::new(files), cache: Arc::default() };
        let changes = Changes::default();
        let ready = or_throw(Ready::new(&given, &changes, None))?;
        Ok(Self { given, edits: Vec::new(), changes, ready, picture: None })
    }

    /// The scene with these changes, if it is another one than there is.
    fn prepared(&self, changes: &Changes) -> Answer<Option<Ready>> {
        let make = || Ready::new(&self.given, changes, Some(&self.ready.compiled));
        or_throw((*changes != self.changes).then(make).transpose())
    }

    fn take(&mut self, changes: Changes, ready: Option<Ready>) {
        self.changes = changes;
        if let Some(ready) = ready {
            self.ready = ready;
        }
    }

    fn begin_with(
        &mut self,
        options: Option<String>,
        begin: impl Fn(&CompiledScene, &Asked) -> Result<Picture, Report>,
    ) -> Answer<()> {
        let asked = or_throw(Asked::parse(options.as_deref()))?;
        let changes = asked.changes(&self.edits);
        let ready = self.prepared(&changes)?;
        // The memory of the picture before is free for the next one.
        self.picture = None;
        let compiled = &ready.as_ref().unwrap_or(&self.ready).compiled;
        self.picture = Some(or_throw(begin(compiled, &asked))?);
        self.take(changes, ready);
        Ok(())
    }

    fn film(&self) -> Answer<&Film> {
        self.picture.as_ref().map(Picture::film).ok_or_else(|| thrown(&[nothing_begun()]))
    }

    fn part(&self, part: Crop) -> Answer<Film> {
        self.film()?.part(part).ok_or_else(|| {
            let Crop { x, y, width, height } = part;
            thrown(&[Report::error(format!("{width} x {height} pixels at {x},{y} are no part of the picture"))])
        })
    }

    fn file(&self, format: Format) -> Answer<Vec<u8>> {
        let film = self.film()?;
        let mut recipe = self.ready.recipe.clone();
        recipe.remember(film);
        let (text, encoding) = (recipe.to_json(), self.ready.compiled.scene().render.encoding());
        let written = in_memory(|out| picture::write_to(out, format, film, encoding, Some(&text)));
        or_throw(written.map_err(|error| Report::error(format!("the picture cannot be written: {error}"))))
    }
}

/// Edits with one more. A slider changes one value again and again: only its last value counts, unless what was edited since may
/// build upon the one before. Tables and names decide what other keys mean.
fn with_edit(edits: &[String], change: String) -> Vec<String> {
    let keys = scene_file::keys(&change);
    let is_value =
        |change: &str, keys: &[String]| !change.contains('{') && keys.last().is_some_and(|key| key != "name");
    let mut edits = edits.to_vec();
    if let Some(at) = edits.iter().rposition(|edit| scene_file::keys(edit) == keys)
        && is_value(&change, &keys)
        && is_value(&edits[at], &keys)
        && edits[at + 1..]
            .iter()
            .map(|edit| scene_file::keys(edit))
            .all(|other| !other.starts_with(&keys) && !keys.starts_with(&other))
    {
        edits.remove(at);
    }
    edits.push(change);
    edits
}

fn nothing_begun() -> Report {
    Report::error("there is no picture yet").help("begin one")
}

/// Where an object is seen.
#[wasm_bindgen]
pub struct Seen {
    paths: String,
    mask: Vec<f64>,
}

#[wasm_bindgen]
impl Seen {
    /// The paths by which it is seen, a list of `path` and `pixels` in JSON, the one of most pixels first.
    #[wasm_bindgen(getter)]
    pub fn paths(&self) -> String {
        self.paths.clone()
    }

    /// For each pixel, row by row, the share of it that is the object.
    #[wasm_bindgen(getter)]
    pub fn mask(&self) -> Vec<f64> {
        self.mask.clone()
    }
}

/// Copies the bytes of a file, if they are not too many.
fn copy(name: &str, bytes: &Uint8Array, limit: u64) -> Result<Vec<u8>, Report> {
    let length = u64::from(bytes.length());
    if length > limit {
        return Err(Report::error(format!("`{name}` is larger than {limit} bytes")));
    }
    // While it is read it is there twice.
    memory::check(&format!("`{name}`"), 2 * length)?;
    Ok(bytes.to_vec())
}

/// Copies files.
fn read_files(files: &JsValue) -> Answer<InMemory> {
    let mut all = InMemory::default();
    if files.is_undefined() || files.is_null() {
        return Ok(all);
    }
    let no_files = || thrown(&[Report::error("expected files as pairs of a name and bytes (Uint8Array)")]);
    for pair in try_iter(files).ok().flatten().ok_or_else(no_files)? {
        let pair: Array = pair?.dyn_into().map_err(|_| no_files())?;
        let name = pair.get(0).as_string().ok_or_else(no_files)?;
        let bytes: Uint8Array = pair.get(1).dyn_into().map_err(|_| no_files())?;
        all.insert(&name, or_throw(copy(&name, &bytes, u64::MAX))?);
    }
    Ok(all)
}
