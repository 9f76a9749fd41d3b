//! What JavaScript holds: a scene, and its picture as far as it has come.

use crate::findings::{json, thrown};
use crate::gathered::Gathered;
use crate::picture::{Asked, Changed, Picture};
use crate::ready::{Given, Ready};
use js_sys::{Array, Float64Array, Object, Reflect, Uint8Array, Uint32Array, try_iter};
use serde_json::json;
use snell::explain::{Path, Sightings, ViewGeometry, ViewScene, black_picture, explain, find, only};
use snell::film::{Crop, Film};
use snell::optics::glass::CATALOGUE;
use snell::render::{Options, Progress};
use snell::world::CompiledScene;
use snell_formats::files::{InMemory, MAX_SCENE_BYTES, in_memory, sha256};
use snell_formats::picture::{Format, Writing};
use snell_formats::recipe::Changes;
use snell_formats::report::known_names;
use snell_formats::scene_file::{self, Syntax};
use snell_formats::{Report, builtin, memory};
use std::hash::{DefaultHasher, Hash, Hasher};
use wasm_bindgen::prelude::*;
use wasm_bindgen::{Clamped, JsCast};

/// A scene that may be edited, and its picture.
#[wasm_bindgen]
pub struct Session {
    given: Given,
    /// What was asked of the picture; `ready` was made with it.
    changes: Changes,
    ready: Ready,
    picture: Option<Picture>,
    /// Of the meshes in the view that was handed over last.
    geometry: Vec<ViewGeometry>,
}

/// What a function for JavaScript returns.
type Answer<T> = Result<T, JsValue>;

/// Throws what is refused.
fn or_throw<T, E: Into<Vec<Report>>>(result: Result<T, E>) -> Answer<T> {
    result.map_err(|reports| thrown(&reports.into()))
}

#[wasm_bindgen]
impl Session {
    /// Reads a scene from the bytes of its file, of any kind; from then on it is a text in TOML. `files` are the models and pictures that it names, and more if need be: a `Map`, or
    /// a list of pairs, of a name and bytes. Names may have folders; those in a scene are relative to the folder of `name`.
    pub fn load(
        name: String,
        text: &Uint8Array,
        #[wasm_bindgen(unchecked_optional_param_type = "Iterable<[string, Uint8Array]>")] files: JsValue,
    ) -> Answer<Self> {
        let bytes = or_throw(copy(&name, text, MAX_SCENE_BYTES))?;
        let (given, odd) = or_throw(Given::new(&name, &bytes, read_files(&files)?))?;
        let mut session = Self::new(given)?;
        // What the file had, and its text in TOML has not.
        let warnings = &mut session.ready.warnings;
        let is_new = |report: &Report| warnings.iter().all(|warning| warning.message != report.message);
        let lost: Vec<Report> = odd.into_iter().filter(is_new).collect();
        warnings.splice(0..0, lost);
        Ok(session)
    }

    /// A built-in scene.
    pub fn builtin(name: &str) -> Answer<Self> {
        Self::new(or_throw(Given::builtin(name))?)
    }

    /// The built-in scenes: a list of `name` and `text`, in JSON.
    pub fn scenes() -> String {
        let scenes = builtin::SCENES.iter().map(|(name, text)| json!({ "name": name, "text": text }));
        scenes.collect::<serde_json::Value>().to_string()
    }

    /// The names of the glasses of the catalogue: a list in JSON.
    pub fn glasses() -> String {
        CATALOGUE.iter().map(|glass| glass.name).collect::<serde_json::Value>().to_string()
    }

    /// The scene as text, in TOML.
    #[wasm_bindgen(getter)]
    pub fn text(&self) -> String {
        self.given.source.text.to_string()
    }

    /// The scene as text, in JSON.
    pub fn json(&self) -> Answer<String> {
        let scene = or_throw(scene_file::parse(&self.given.source, Syntax::Toml))?;
        or_throw(scene_file::to_text(&scene, Syntax::Json))
    }

    /// Changes values in the text of the scene; comments and layout stay. `changes` are a list in JSON of keys with their values, like
    /// `[["sphere.glass.radius", "8"], ["material.glass.eta", null]]`: as for `--set`, and `null` takes a key, or an element of a
    /// list, away. A list with a whole table gets one more element. All of them or none: what is refused leaves all as it was. What was
    /// rendered is gone.
    pub fn edit(&mut self, changes: &str) -> Answer<()> {
        let changes: Vec<(String, Option<String>)> = or_throw(serde_json::from_str(changes).map_err(|e| {
            let help = r#"like [["material.glass.eta", "2.4"]]"#;
            Report::error(format!("these are no changes of a scene: {e}")).help(help)
        }))?;
        let is_of_render = |key: &str| scene_file::keys(&format!("{key}=")).first().is_some_and(|key| key == "render");
        // What was asked of the picture before must not hide a setting of the scene.
        let hides = changes.iter().any(|(key, _)| is_of_render(key));
        let asked = if hides { Changes::default() } else { self.changes.clone() };
        let text = scene_file::rewrite(&self.given.source, &changes).map_err(Vec::from);
        let read = text.and_then(|text| self.read(&text, &asked));
        let named =
            |reports: Vec<Report>| reports.into_iter().map(|report| about(report, &changes)).collect::<Vec<_>>();
        let (given, ready) = or_throw(read.map_err(named))?;
        self.take_text(given, asked, ready);
        Ok(())
    }

    /// Takes another text for the scene. What is refused leaves all as it was; the findings have their places in the text.
    pub fn revise(&mut self, text: &str) -> Answer<()> {
        let (given, ready) = or_throw(self.read(text, &Changes::default()))?;
        self.take_text(given, Changes::default(), ready);
        Ok(())
    }

    /// The scene in JSON, as its text has it; vertices and faces of meshes are left out, and long lists of
    /// instances.
    pub fn scene(&self) -> Answer<String> {
        let mut scene = or_throw(scene_file::parse(&self.given.source, Syntax::Toml))?;
        let short = |instances: &mut Vec<_>| {
            if instances.len() > MOST_INSTANCES {
                instances.clear();
            }
        };
        scene.spheres.iter_mut().for_each(|sphere| short(&mut sphere.instances));
        for mesh in &mut scene.meshes {
            (mesh.vertices, mesh.faces) = (Vec::new(), Vec::new());
            short(&mut mesh.instances);
        }
        // Numbers of a scene that was validated always have a form.
        Ok(serde_json::to_string(&scene).unwrap_or_default())
    }

    /// Begins a picture. `options` are an object in JSON: `size`, `spp`, `depth`, `integrator`, `shadows`, as of a scene's `render`;
    /// `coarsest`, with which the first sample of every so many-th pixel comes first; and `crop`, a part of the picture by `x`, `y`,
    /// `width`, `height`. With `share`, a number from 0 and the number of shares, only every so many-th piece of 64 x 64 pixels is rendered,
    /// and `rgba` and `values` tell of what lies within one piece. What is left out is as the scene has it. What is refused leaves the
    /// scene as it was.
    pub fn begin(&mut self, options: Option<String>) -> Answer<()> {
        self.begin_with(options, Picture::begin)
    }

    /// Begins a picture that other instances render: it is put together from their `values` and `lost`. The options are
    /// those of `begin`.
    pub fn gather(&mut self, options: Option<String>) -> Answer<()> {
        self.begin_with(options, Picture::gather)
    }

    /// Renders for so many milliseconds, at least a tile. Returns which parts of the picture have changed, five numbers for each: left,
    /// top, width, height, and how many pixels apart those are that were rendered.
    pub fn step(&mut self, milliseconds: f64) -> Vec<u32> {
        let changed = self.picture.as_mut().map(|picture| picture.step(milliseconds)).unwrap_or_default();
        changed.iter().flat_map(Changed::numbers).collect()
    }

    /// Puts a part, which another instance has rendered, into a gathered picture. `finished`: with all of its samples.
    pub fn put(&mut self, x: u32, y: u32, width: u32, height: u32, values: &[f64], finished: bool) -> Answer<()> {
        or_throw(self.gathered()?.put(Crop { x, y, width, height }, values, finished))
    }

    /// Puts what the pixels of a part have `lost` in another instance into a gathered picture.
    pub fn put_lost(&mut self, x: u32, y: u32, width: u32, height: u32, lost: &[f64]) -> Answer<()> {
        or_throw(self.gathered()?.put_lost(Crop { x, y, width, height }, lost))
    }

    /// What was traced for the picture so far, in JSON, for `put_statistics` of the instance that gathers it.
    pub fn statistics(&self) -> Answer<String> {
        let picture = self.picture.as_ref().ok_or_else(|| thrown(&[nothing_begun()]))?;
        Ok(serde_json::to_string(&picture.statistics()).unwrap_or_default())
    }

    /// Adds what another instance has traced for a gathered picture, once it is finished there: `validate` knows of it then.
    pub fn put_statistics(&mut self, statistics: &str) -> Answer<()> {
        or_throw(self.gathered()?.put_statistics(statistics))
    }

    /// Width and height of the whole picture.
    #[wasm_bindgen(getter)]
    pub fn size(&self) -> Vec<u32> {
        self.ready.compiled.world().camera.size.to_vec()
    }

    /// Samples of each pixel.
    #[wasm_bindgen(getter)]
    pub fn spp(&self) -> u32 {
        self.ready.compiled.settings().spp
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
        let picture = self.picture.as_ref().filter(|picture| picture.is_finished())?;
        picture.film().map(|film| sha256(film.bytes()))
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

    /// The light that each pixel of a part has lost over all of its samples so far: the throughput of the rays that were not followed,
    /// in units of 2⁻³², as the statistics have it. It is known of a picture with `coarsest`, and of one that was gathered.
    pub fn lost(&self, x: u32, y: u32, width: u32, height: u32) -> Answer<Vec<f64>> {
        let part = Crop { x, y, width, height };
        let picture = self.picture.as_ref().ok_or_else(|| thrown(&[nothing_begun()]))?;
        picture.lost(part).ok_or_else(|| thrown(&[no_part(part).help("begin the picture with `coarsest`")]))
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

    /// The scene as the viewer draws it, in JSON; instead of vertices and faces, meshes have `geometry`, a text that stays the same as long
    /// as these do. `view_mesh` has them.
    pub fn view(&mut self) -> String {
        let mut view = ViewScene::of(&self.ready.compiled);
        self.geometry = view.take_geometry();
        let mut view = serde_json::to_value(&view).unwrap_or_default();
        let meshes = view["meshes"].as_array_mut().into_iter().flatten();
        for (mesh, geometry) in meshes.zip(&self.geometry) {
            mesh["geometry"] = fingerprint(geometry).into();
        }
        view.to_string()
    }

    /// Vertices and faces of a mesh in the last `view`, by its number there from 0.
    #[wasm_bindgen(unchecked_return_type = "{ vertices: Float64Array; faces: Uint32Array }")]
    pub fn view_mesh(&self, index: usize) -> Answer<Object> {
        let no_mesh = || thrown(&[Report::error(format!("the view has no mesh {index}"))]);
        let ViewGeometry { vertices, faces } = self.geometry.get(index).ok_or_else(no_mesh)?;
        let mesh = Object::new();
        Reflect::set(&mesh, &"vertices".into(), &Float64Array::from(vertices.as_slice()))?;
        Reflect::set(&mesh, &"faces".into(), &Uint32Array::from(faces.as_slice()))?;
        Ok(mesh)
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

    /// Where something is seen along one path, as `paths` has them: for each pixel, row by row, 1 if it is, else 0. It takes as long as
    /// finding.
    pub fn find_path(&self, path: &str) -> Answer<Vec<f64>> {
        let path = or_throw(Path::parse(path).map_err(|error| Report::error(error.to_string())))?;
        let seen = only(&self.ready.compiled, &path, &Options::default());
        let seen = seen.ok_or_else(|| thrown(&[nothing_begun()]))?;
        Ok(seen.iter().map(|color| if color.mean() == 0.0 { 0.0 } else { 1.0 }).collect())
    }

    /// What is odd about the scene, and about its picture once that is finished: a list in JSON.
    pub fn validate(&self) -> String {
        let Ready { compiled, warnings, .. } = &self.ready;
        let finished = self.picture.iter().filter(|picture| picture.is_finished());
        let of_picture = finished.flat_map(|picture| {
            let black = picture.film().and_then(|film| black_picture(compiled, film));
            picture.warnings(compiled).into_iter().chain(black)
        });
        let of_picture = of_picture.map(|warning| Report::warning(warning.code, warning.message));
        json(&warnings.iter().cloned().chain(of_picture).collect::<Vec<_>>())
    }

    /// The picture so far as an 8-bit PNG, with its recipe.
    pub fn png(&mut self) -> Answer<Vec<u8>> {
        self.file(Format::Png { sixteen_bit: false })
    }

    /// The picture so far as an EXR, with its recipe.
    pub fn exr(&mut self) -> Answer<Vec<u8>> {
        self.file(Format::Exr)
    }
}

/// What finding takes for each pixel, where a few paths lead to an object.
const BYTES_OF_SIGHTINGS: u64 = 400;

impl Session {
    fn new(given: Given) -> Answer<Self> {
        let changes = Changes::default();
        let ready = or_throw(Ready::new(&given, &changes, None))?;
        Ok(Self { given, changes, ready, picture: None, geometry: Vec::new() })
    }

    /// Reads and compiles the scene with another text.
    fn read(&self, text: &str, asked: &Changes) -> Result<(Given, Ready), Vec<Report>> {
        if text.len() as u64 > MAX_SCENE_BYTES {
            return Err(Report::error(format!("a scene of more than {MAX_SCENE_BYTES} bytes is not read")).into());
        }
        let given = self.given.with_text(text);
        let ready = Ready::new(&given, asked, Some(&self.ready.compiled))?;
        Ok((given, ready))
    }

    fn take_text(&mut self, given: Given, changes: Changes, ready: Ready) {
        (self.given, self.changes, self.ready, self.picture) = (given, changes, ready, None);
    }

    fn begin_with(
        &mut self,
        options: Option<String>,
        begin: impl Fn(&CompiledScene, &Asked) -> Result<Picture, Report>,
    ) -> Answer<()> {
        let asked = or_throw(Asked::parse(options.as_deref()))?;
        let changes = asked.changes();
        let make = || Ready::new(&self.given, &changes, Some(&self.ready.compiled));
        let ready = or_throw((changes != self.changes).then(make).transpose())?;
        // The memory of the picture before is free for the next one.
        self.picture = None;
        let compiled = &ready.as_ref().unwrap_or(&self.ready).compiled;
        self.picture = Some(or_throw(begin(compiled, &asked))?);
        self.changes = changes;
        if let Some(ready) = ready {
            self.ready = ready;
        }
        Ok(())
    }

    fn film(&self) -> Answer<&Film> {
        let picture = self.picture.as_ref().ok_or_else(|| thrown(&[nothing_begun()]))?;
        picture.film().ok_or_else(|| thrown(&[Report::error("this is only a share of a picture")]))
    }

    fn part(&self, part: Crop) -> Answer<Film> {
        let picture = self.picture.as_ref().ok_or_else(|| thrown(&[nothing_begun()]))?;
        picture.part(part).ok_or_else(|| thrown(&[no_part(part)]))
    }

    fn gathered(&mut self) -> Answer<&mut Gathered> {
        let picture = self.picture.as_mut().ok_or_else(|| thrown(&[nothing_begun()]))?;
        or_throw(picture.gathered())
    }

    fn file(&mut self, format: Format) -> Answer<Vec<u8>> {
        let mut recipe = self.ready.recipe.clone();
        recipe.remember(self.film()?);
        let writing = Writing { format, encoding: self.ready.compiled.scene().render.encoding(), threads: 1 };
        let write = |film: &Film| in_memory(|out| writing.write_to(out, film, || Some(recipe.to_json())));
        let written = match &mut self.picture {
            Some(Picture::Gathered(gathered)) => gathered.as_shown(write),
            _ => write(self.film()?),
        };
        or_throw(written.map_err(|error| Report::error(format!("the picture cannot be written: {error}"))))
    }
}

/// A report of a text that was made by changes, which nobody has seen: it names them instead of a place.
fn about(report: Report, changes: &[(String, Option<String>)]) -> Report {
    let change = |(key, value): &(String, Option<String>)| match value {
        Some(value) => format!("`{key} = {}`", value.chars().take(MOST_SHOWN).collect::<String>()),
        None => format!("`{key}` taken away"),
    };
    let mut names: Vec<String> = changes.iter().take(3).map(change).collect();
    if changes.len() > names.len() {
        names.push(format!("{} more", changes.len() - names.len()));
    }
    Report { message: format!("{}: {}", names.join(", "), report.message), place: None, ..report }
}

/// Longer lists are for programs, not for people to edit.
const MOST_INSTANCES: usize = 100;

/// Characters of a value in a message.
const MOST_SHOWN: usize = 60;

/// The same for the same numbers.
fn fingerprint(ViewGeometry { vertices, faces }: &ViewGeometry) -> String {
    let mut hasher = DefaultHasher::new();
    for number in vertices {
        number.to_bits().hash(&mut hasher);
    }
    faces.hash(&mut hasher);
    format!("{:016x}", hasher.finish())
}

fn nothing_begun() -> Report {
    Report::error("there is no picture yet").help("begin one")
}

fn no_part(Crop { x, y, width, height }: Crop) -> Report {
    Report::error(format!("{width} x {height} pixels at {x},{y} are no part of the picture"))
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
