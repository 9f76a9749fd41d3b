//! Everything that decides the bits of a picture, and that a PNG or EXR remembers.

use crate::driver::Dialect;
use crate::files::sha256;
use crate::load::{Kind, LoadOptions, Loaded, ModelFile, load_text};
use crate::report::{Remedy, Report, Source};
use crate::scene_file;
use serde::{Deserialize, Serialize};
use snell::film::{Crop, Film};
use snell::scene::{Integrator, Rounding, Scene, Shadows, Transfer};
use std::path::{Path, PathBuf};

/// How a picture is made: the text of its scene and all settings besides. Once rendered, those that the text may leave out are
/// written out, so that another default of a later version does not change the picture.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Recipe {
    /// Version of Snell that made the picture.
    pub snell: String,
    /// Name of the scene: a file, or a built-in one.
    pub name: String,
    /// What the text is.
    pub kind: Kind,
    /// The text of the scene, as it was read.
    pub text: String,
    /// Folder that the names of models are relative to.
    pub folder: PathBuf,
    /// The year of a driver, where it was not recognised.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dialect: Option<String>,
    /// Changes of the scene, `key=value`, in order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub set: Vec<String>,
    /// Width and height in pixels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<[u32; 2]>,
    /// Does another shape of the picture stretch pixels? Otherwise the bounds are widened.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub stretch: bool,
    /// The part of the picture that was rendered.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub crop: Option<Crop>,
    /// Samples per pixel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spp: Option<u32>,
    /// Of the samples.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u32>,
    /// Bounces that may follow.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth: Option<u32>,
    /// What carries less is not followed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min_throughput: Option<f64>,
    /// Bands of light.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bands: Option<u32>,
    /// The model of light.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub integrator: Option<Integrator>,
    /// What blocks a light.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shadows: Option<Shadows>,
    /// Where the image plane stands, if the scene does not say.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub near: Option<f64>,
    /// The curve by which the film is shown.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub transfer: Option<Transfer>,
    /// How it becomes whole numbers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rounding: Option<Rounding>,
    /// Bits per channel of a PNG, 8 if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bits: Option<u8>,
    /// Layers for so many light paths.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub paths: Option<u32>,
    /// Only the light of this path.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub only: Option<String>,
    /// Folders in which models were looked for first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub search: Vec<PathBuf>,
    /// Models that the scene reads, in the order of reading, and their content.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub models: Vec<ModelFile>,
    /// Did nobody ask for these shadows? They are what the default was when the picture was made.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    default_shadows: bool,
    /// Is it from when pictures did not remember the shadows that nobody asked for, or where the image plane stood?
    #[serde(skip)]
    is_old: [bool; 2],
    /// SHA-256 of the finished film's numbers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub film_sha256: Option<String>,
}

/// What is asked to be other than in a scene, or in a recipe. The fields are those of [`Recipe`].
#[allow(missing_docs, reason = "they are those of a recipe")]
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Changes {
    pub set: Vec<String>,
    pub size: Option<[u32; 2]>,
    pub stretch: bool,
    pub crop: Option<Crop>,
    pub spp: Option<u32>,
    pub depth: Option<u32>,
    pub integrator: Option<Integrator>,
    pub shadows: Option<Shadows>,
    pub transfer: Option<Transfer>,
    pub rounding: Option<Rounding>,
    pub bits: Option<u8>,
    pub paths: Option<u32>,
    pub only: Option<String>,
}

/// A default that was another one when a picture was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OldDefault {
    /// `whitted` had opaque shadows, and now has tinted ones.
    OpaqueShadows,
    /// The image plane stood at `near` = −1, and now stands a tenth of the way to `look_at`.
    ImagePlane,
}

impl Recipe {
    /// Of a scene that was read from `text`, with all settings left to it. `folder` is what file names in it are relative to.
    pub fn new(name: &str, kind: Kind, text: &str, folder: &Path, models: &[ModelFile]) -> Self {
        // Only models need the folder; otherwise a picture need not tell where it was made.
        let folder = if models.is_empty() { PathBuf::from(".") } else { absolute(folder) };
        let models = models.iter().map(|m| ModelFile { path: absolute(&m.path), sha256: m.sha256.clone() });
        Self {
            snell: env!("CARGO_PKG_VERSION").to_owned(),
            name: name.to_owned(),
            kind,
            text: text.to_owned(),
            folder,
            dialect: None,
            set: Vec::new(),
            size: None,
            stretch: false,
            crop: None,
            spp: None,
            seed: None,
            depth: None,
            min_throughput: None,
            bands: None,
            integrator: None,
            shadows: None,
            near: None,
            transfer: None,
            rounding: None,
            bits: None,
            paths: None,
            only: None,
            search: Vec::new(),
            models: models.collect(),
            default_shadows: false,
            is_old: [false; 2],
            film_sha256: None,
        }
    }

    /// Of a scene that was read as `options` say.
    pub fn of(loaded: &Loaded, options: &LoadOptions, changes: &Changes) -> Self {
        let Loaded { source, kind, folder, models, .. } = loaded;
        let mut recipe = Self::new(&source.name, *kind, &source.text, folder, models);
        recipe.dialect = options.dialect.map(|d| d.name().to_owned());
        if !models.is_empty() {
            recipe.search = options.search.iter().map(|folder| absolute(folder)).collect();
        }
        recipe.change(changes);
        recipe
    }

    /// What a picture remembers.
    ///
    /// # Errors
    /// If it cannot be read, or does not say how it was made.
    #[cfg(feature = "disk")]
    pub fn in_picture(path: &Path) -> Result<Self, Report> {
        let remembered = crate::picture::read(path)?.recipe.ok_or_else(|| {
            let report = Report::error(format!("`{}` does not say how it was made", path.display()));
            report.help("only PNG and EXR pictures made by Snell do")
        })?;
        Self::from_json(&remembered)
            .map_err(|e| Report::error(format!("the recipe in `{}` cannot be read: {e}", path.display())))
    }

    /// Reads what a picture remembers ([`Picture::recipe`](crate::picture::Picture::recipe)).
    ///
    /// # Errors
    /// If it is no recipe, or one of another version.
    pub fn from_json(text: &str) -> serde_json::Result<Self> {
        let mut recipe: Self = serde_json::from_str(text)?;
        recipe.is_old = [recipe.shadows.is_none(), recipe.near.is_none()];
        Ok(recipe)
    }

    /// The text that a picture keeps.
    pub fn to_json(&self) -> String {
        // Every number in it comes from a scene that was validated, so that there is always one.
        serde_json::to_string(self).unwrap_or_default()
    }

    /// What decides the numbers of the film; where files lie, and how the picture is written, does not.
    fn of_the_film(&self) -> serde_json::Map<String, serde_json::Value> {
        let values = serde_json::to_value(self).unwrap_or_default();
        let mut values = values.as_object().cloned().unwrap_or_default();
        let models: Vec<&String> = self.models.iter().map(|file| &file.sha256).collect();
        values.insert("models".to_owned(), serde_json::json!(models));
        let elsewhere = ["name", "folder", "search", "film_sha256", "transfer", "rounding", "bits"];
        values.retain(|key, _| !elsewhere.contains(&key.as_str()));
        values
    }

    /// SHA-256 of all that decides the numbers of the film, in hexadecimal.
    pub fn digest(&self) -> String {
        sha256([serde_json::Value::from(self.of_the_film()).to_string()])
    }

    /// The first thing that makes a picture of the other recipe another one; where files lie and how the picture is written is none.
    pub fn difference(&self, other: &Self) -> Option<String> {
        let (a, b) = (self.of_the_film(), other.of_the_film());
        let key = a.keys().chain(b.keys()).find(|key| a.get(*key) != b.get(*key))?;
        let line = |text: &str, at: usize| text.lines().nth(at).unwrap_or("nothing").trim().to_owned();
        Some(if key == "text" {
            let differs = |at: &usize| self.text.lines().nth(*at) != other.text.lines().nth(*at);
            let at = (0..self.text.lines().count().max(other.text.lines().count())).find(differs).unwrap_or(0);
            let (here, there) = (line(&self.text, at), line(&other.text, at));
            format!("line {} of the scene is `{here}` in one and `{there}` in the other", at + 1)
        } else {
            let shown = |value: Option<&serde_json::Value>| value.map_or("nothing".to_owned(), ToString::to_string);
            format!("`{key}` is {} in one and {} in the other", shown(a.get(key)), shown(b.get(key)))
        })
    }

    /// Notes the film that came out. One that is not finished tells nothing.
    pub fn remember(&mut self, film: &Film) {
        self.film_sha256 = film.is_finished().then(|| sha256(film.bytes()));
    }

    /// Takes over what is asked to be other than it was.
    pub fn change(&mut self, changes: &Changes) {
        let of_the_file = Changes { transfer: None, rounding: None, bits: None, ..changes.clone() };
        if of_the_file != Changes::default() {
            // The film will be another one.
            self.film_sha256 = None;
        }
        for change in &changes.set {
            self.forget(change);
            self.set.push(change.clone());
        }
        if changes.size.is_some() {
            // A part of the picture is another part of another one.
            (self.size, self.stretch, self.crop) = (changes.size, changes.stretch, None);
        }
        if changes.integrator.is_some() && changes.integrator != self.integrator {
            self.forget_default_shadows();
        }
        self.crop = changes.crop.or(self.crop);
        self.spp = changes.spp.or(self.spp);
        self.depth = changes.depth.or(self.depth);
        self.integrator = changes.integrator.or(self.integrator);
        self.default_shadows &= changes.shadows.is_none();
        self.shadows = changes.shadows.or(self.shadows);
        self.transfer = changes.transfer.or(self.transfer);
        self.rounding = changes.rounding.or(self.rounding);
        self.bits = changes.bits.or(self.bits);
        if changes.paths.is_some() || changes.only.is_some() {
            (self.paths, self.only) = (changes.paths, changes.only.clone());
        }
    }

    /// What another model of light does about shadows, if nobody says, is another thing.
    fn forget_default_shadows(&mut self) {
        self.shadows = self.shadows.filter(|_| !self.default_shadows);
    }

    /// Lets a change of the scene decide what the recipe remembers of its settings.
    fn forget(&mut self, change: &str) {
        let keys = scene_file::keys(change);
        let [table, key] = [0, 1].map(|i| keys.get(i).map_or("", String::as_str));
        if table == "camera" {
            self.near = None;
        }
        if table != "render" {
            return;
        }
        let is = |name: &str| key.is_empty() || key == name;
        if is("size") {
            (self.size, self.crop) = (None, None);
        }
        if is("integrator") {
            self.integrator = None;
            self.forget_default_shadows();
        }
        if is("shadows") {
            self.shadows = None;
        }
        self.spp = self.spp.filter(|_| !is("spp"));
        self.seed = self.seed.filter(|_| !is("seed"));
        self.depth = self.depth.filter(|_| !is("max_depth"));
        self.min_throughput = self.min_throughput.filter(|_| !is("min_throughput"));
        self.bands = self.bands.filter(|_| !is("bands"));
        self.transfer = self.transfer.filter(|_| !is("transfer"));
        self.rounding = self.rounding.filter(|_| !is("rounding"));
    }

    /// Reads the scene of a recipe again, with these folders searched first. Its models must be what they were.
    ///
    /// # Errors
    /// If it cannot be read, or a model is another one.
    pub fn load(&self, search: &[PathBuf]) -> Result<Loaded, Vec<Report>> {
        let dialect = match self.dialect.as_deref() {
            None => None,
            Some(name) => Some(
                Dialect::ALL
                    .into_iter()
                    .find(|d| d.name() == name)
                    .ok_or_else(|| Report::error(format!("the picture was made with an unknown dialect `{name}`")))?,
            ),
        };
        let options = LoadOptions {
            search: search.iter().chain(&self.search).cloned().collect(),
            dialect,
            set: self.set.clone(),
            integrator: self.integrator,
            ..LoadOptions::default()
        };
        let source = Source::new(self.name.as_str(), self.text.as_str());
        let loaded = load_text(source, self.kind, &self.folder, &options)?;
        // A change may change which files a scene reads, but not what is in them.
        let changed = self.film_sha256.is_none();
        let known = |file: &ModelFile, files: &[ModelFile]| files.iter().any(|other| other.sha256 == file.sha256);
        let other = |now: &&ModelFile| {
            let of_its_path = |then: &ModelFile| then.path == absolute(&now.path) && then.sha256 != now.sha256;
            let of_its_name = |then: &ModelFile| then.path.file_name() == now.path.file_name();
            self.models.iter().any(of_its_path)
                || (!known(now, &self.models) && (!changed || self.models.iter().any(of_its_name)))
        };
        let lost = self.models.iter().find(|then| !changed && !known(then, &loaded.models));
        let Some(file) = loaded.models.iter().find(other).or(lost) else { return Ok(loaded) };
        let was = self.models.iter().find(|then| then.path.file_name() == file.path.file_name());
        let was = was.map_or("it was not there".to_owned(), |m| {
            format!("it was {} with SHA-256 {}", m.path.display(), m.sha256)
        });
        let message = format!("the model `{}` has changed since the picture was made", file.path.display());
        Err(Report::error(message).help(was).remedy(Remedy::NameFolder).into())
    }

    /// Takes over what the settings of the scene have come to.
    pub fn resolve(&mut self, scene: &Scene) {
        let render = &scene.render;
        self.default_shadows |= self.shadows.is_none();
        self.near = Some(scene.camera.image_plane());
        self.spp = Some(render.spp);
        self.seed = Some(render.seed);
        self.depth = Some(render.max_depth);
        self.min_throughput = Some(render.min_throughput);
        self.bands = Some(render.bands);
        self.integrator = Some(render.integrator);
        self.shadows = Some(render.shadows());
        self.transfer = Some(render.transfer);
        self.rounding = Some(render.rounding);
    }

    /// Where neither a recipe nor its scene says, a recipe means the defaults of the Snell that made it. Writes out those that have
    /// changed since, and returns which.
    pub fn keep_old_defaults(&mut self, scene: &Scene) -> Vec<OldDefault> {
        let integrator = self.integrator.unwrap_or(scene.render.integrator);
        let mut kept = Vec::new();
        let [old_shadows, old_plane] = self.is_old;
        if old_shadows && integrator == Integrator::Whitted && self.shadows.or(scene.render.shadows).is_none() {
            self.shadows = Some(Shadows::Opaque);
            kept.push(OldDefault::OpaqueShadows);
        }
        if old_plane && !integrator.starts_at_eye() && self.near.or(scene.camera.near).is_none() {
            self.near = Some(-1.0);
            kept.push(OldDefault::ImagePlane);
        }
        kept
    }

    /// Puts the settings into the scene. If the bounds were widened to keep pixels square, returns the new ones: left, right, bottom, top.
    pub fn apply(&self, scene: &mut Scene) -> Option<[f64; 4]> {
        scene.camera.near = scene.camera.near.or(self.near);
        let render = &mut scene.render;
        render.spp = self.spp.unwrap_or(render.spp);
        render.seed = self.seed.unwrap_or(render.seed);
        render.max_depth = self.depth.unwrap_or(render.max_depth);
        render.min_throughput = self.min_throughput.unwrap_or(render.min_throughput);
        render.bands = self.bands.unwrap_or(render.bands);
        render.integrator = self.integrator.unwrap_or(render.integrator);
        render.shadows = self.shadows.or(render.shadows);
        render.transfer = self.transfer.unwrap_or(render.transfer);
        render.rounding = self.rounding.unwrap_or(render.rounding);
        let size = self.size?;
        if self.stretch {
            render.size = size;
            return None;
        }
        scene.resize(size)
    }
}

/// A path that a picture can remember, as text.
fn absolute(path: &Path) -> PathBuf {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    path.to_string_lossy().into_owned().into()
}
