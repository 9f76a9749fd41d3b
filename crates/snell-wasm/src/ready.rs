//! A scene with its files, read and compiled.

use snell::geometry::bvh::Quality;
use snell::scene::WarningCode;
use snell::world::CompiledScene;
use snell_formats::files::InMemory;
use snell_formats::load::{Cache, Kind, load_bytes, load_text};
use snell_formats::recipe::{Changes, Recipe};
use snell_formats::scene_file::{self, Syntax};
use snell_formats::{LoadOptions, Loaded, Report, Source, builtin};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The text of a scene, and what it is read with.
#[derive(Clone)]
pub struct Given {
    /// In TOML.
    pub source: Source,
    /// File names in it are relative to this one.
    pub folder: PathBuf,
    pub files: Arc<InMemory>,
    /// Models and pictures, so that an edit does not read them again.
    pub cache: Arc<Cache>,
}

impl Given {
    /// The text of a scene file of any kind, as TOML, and what is odd about the file.
    pub fn new(name: &str, bytes: &[u8], files: InMemory) -> Result<(Self, Vec<Report>), Vec<Report>> {
        let path = Path::new(name);
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let (files, cache) = (Arc::new(files), Arc::new(Cache::default()));
        let options =
            LoadOptions { files: Arc::clone(&files) as _, cache: Some(Arc::clone(&cache)), ..LoadOptions::default() };
        let Loaded { source, scene, kind, warnings, .. } = load_bytes(name, path, bytes, &folder, &options)?;
        let source = match kind {
            Kind::Toml => source,
            Kind::Json | Kind::Driver | Kind::Nff => {
                let name = path.with_extension("toml").to_string_lossy().into_owned();
                Source::new(name, scene_file::to_text(&scene, Syntax::Toml)?)
            }
        };
        Ok((Self { source, folder, files, cache }, warnings))
    }

    /// A built-in scene.
    pub fn builtin(name: &str) -> Result<Self, Report> {
        let source = builtin::find(name)?;
        Ok(Self { source, folder: PathBuf::from("."), files: Arc::default(), cache: Arc::default() })
    }

    /// The same with another text.
    pub fn with_text(&self, text: &str) -> Self {
        Self { source: Source::new(Arc::clone(&self.source.name), text), ..self.clone() }
    }

    fn read(&self, changes: &Changes) -> Result<(Recipe, Loaded), Vec<Report>> {
        let options = LoadOptions {
            files: Arc::clone(&self.files) as _,
            integrator: changes.integrator,
            cache: Some(Arc::clone(&self.cache)),
            ..LoadOptions::default()
        };
        let loaded = load_text(self.source.clone(), Kind::Toml, &self.folder, &options)?;
        Ok((Recipe::of(&loaded, &options, changes), loaded))
    }
}

/// A scene that only has to be traced.
pub struct Ready {
    pub recipe: Recipe,
    pub compiled: CompiledScene,
    /// What is odd about it.
    pub warnings: Vec<Report>,
}

impl Ready {
    /// Reads and compiles a scene. `before` is nearly the same one, which may share its tree.
    pub fn new(given: &Given, changes: &Changes, before: Option<&CompiledScene>) -> Result<Self, Vec<Report>> {
        let (mut recipe, mut loaded) = given.read(changes)?;
        let bounds = recipe.apply(loaded.scene_mut());
        recipe.resolve(&loaded.scene);
        let compiled = match before {
            Some(before) => loaded.compile_after(before),
            None => loaded.compile(&recipe.name, Quality::default(), 1),
        }?;
        // Not before: what is refused must not cost the models of the scene that stays.
        given.cache.keep_only(&loaded.models);
        let widened = bounds.map(|[left, right, bottom, top]| {
            let [width, height] = loaded.scene.render.size;
            let message = format!(
                "{width} x {height} has another shape than the scene: to keep pixels square the bounds are widened to \
                 [{left}, {right}, {bottom}, {top}]"
            );
            Report::warning(WarningCode::WidenedBounds, message)
        });
        let warnings = widened.into_iter().chain(loaded.warnings_with(compiled.world())).collect();
        Ok(Self { recipe, compiled, warnings })
    }
}
