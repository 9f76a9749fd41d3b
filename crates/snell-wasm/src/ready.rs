//! A scene with its files, read and compiled.

use snell::geometry::bvh::Quality;
use snell::scene::{Scene, WarningCode};
use snell::world::CompiledScene;
use snell_formats::files::InMemory;
use snell_formats::load::{Cache, Kind, load_bytes, load_text};
use snell_formats::recipe::{Changes, Recipe};
use snell_formats::{LoadOptions, Loaded, Report, Source};
use std::path::Path;
use std::sync::Arc;

/// What a session was given.
pub struct Given {
    pub scene: GivenScene,
    pub files: Arc<InMemory>,
    /// Models and pictures, so that an edit does not read them again.
    pub cache: Arc<Cache>,
}

/// A scene as it was given.
pub enum GivenScene {
    Builtin(Source),
    File { name: String, bytes: Vec<u8> },
}

impl Given {
    /// Reads it, with changes.
    fn read(&self, changes: &Changes) -> Result<(Recipe, Loaded), Vec<Report>> {
        let options = LoadOptions {
            files: Arc::clone(&self.files) as _,
            set: changes.set.clone(),
            integrator: changes.integrator,
            cache: Some(Arc::clone(&self.cache)),
            ..LoadOptions::default()
        };
        let loaded = match &self.scene {
            GivenScene::Builtin(source) => load_text(source.clone(), Kind::Toml, Path::new("."), &options),
            GivenScene::File { name, bytes } => {
                let path = Path::new(name);
                load_bytes(name, path, bytes, path.parent().unwrap_or(Path::new("")), &options)
            }
        }?;
        Ok((Recipe::of(&loaded, &options, changes), loaded))
    }

    /// The scene with these edits alone, without what is asked of a picture.
    pub fn edited(&self, edits: &[String]) -> Result<Arc<Scene>, Vec<Report>> {
        let changes = Changes { set: edits.to_vec(), ..Changes::default() };
        self.read(&changes).map(|(_, loaded)| loaded.scene)
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
        given.cache.keep_only(&loaded.models);
        let bounds = recipe.apply(loaded.scene_mut());
        recipe.resolve(&loaded.scene);
        let compiled = match before {
            Some(before) => loaded.compile_after(before),
            None => loaded.compile(&recipe.name, Quality::default(), 1),
        }?;
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
