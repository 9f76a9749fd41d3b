//! The pictures that a scene and its models name: on surfaces and as the sky.

use super::{Cache, Loaded, ModelFile};
use crate::files::Files;
use crate::model::Finder;
use crate::report::Report;
use crate::texture::read_with_hash;
use snell::scene::Step;
use snell::texture::Image;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Reads pictures, each file once.
pub(super) struct PictureReader<'a> {
    /// By file, and whether its curve was decoded.
    images: HashMap<(PathBuf, bool), Arc<Image>>,
    /// By the names that the scene has for them, where they were found.
    pub paths: HashMap<String, PathBuf>,
    pub files: Vec<ModelFile>,
    cache: Option<&'a Cache>,
}

impl<'a> PictureReader<'a> {
    pub fn new(cache: Option<&'a Cache>) -> Self {
        Self { images: HashMap::new(), paths: HashMap::new(), files: Vec::new(), cache }
    }

    /// A picture from a file, which the scene calls `name`.
    pub fn read(&mut self, files: &dyn Files, name: &str, path: &Path, srgb: bool) -> Result<Arc<Image>, Report> {
        let key = (path.to_owned(), srgb);
        if !self.images.contains_key(&key) {
            let (image, sha256) = if let Some(known) = self.cache.and_then(|cache| cache.image(&key)) {
                known
            } else {
                let (image, sha256) = read_with_hash(files, path, srgb)?;
                (Arc::new(image), sha256)
            };
            if let Some(cache) = self.cache {
                cache.keep_image(&key, &image, &sha256);
            }
            if !self.files.iter().any(|file| file.path == path) {
                self.files.push(ModelFile { path: path.to_owned(), sha256 });
            }
            self.images.insert(key.clone(), image);
        }
        self.paths.insert(name.to_owned(), path.to_owned());
        Ok(Arc::clone(&self.images[&key]))
    }
}

/// Reads those of the scene itself.
pub(super) fn read(loaded: &mut Loaded, finder: Finder<'_>, reader: &mut PictureReader<'_>) -> Result<(), Report> {
    let places = finder.places(&loaded.folder);
    let mut one = |loaded: &mut Loaded, file: &str, srgb: bool, place: &[Step]| {
        let put = |report: Report| if report.place.is_some() { report } else { loaded.places.put(report, place) };
        let found = finder.find_in(file, &places).map_err(put)?;
        let image = reader.read(finder.files, file, &found.path, srgb).map_err(put)?;
        let warning = found.warning.map(put);
        loaded.warnings.extend(warning);
        Ok::<_, Report>(image)
    };
    for number in 0..loaded.scene.textures.len() {
        let (name, texture) = (&loaded.scene.textures.keys()[number], &loaded.scene.textures[number]);
        if let (Some(file), None) = (texture.image.clone(), &texture.pixels) {
            let (place, srgb) = (["texture", name, "image"].map(Step::from), !texture.linear);
            let image = one(loaded, &file, srgb, &place)?;
            loaded.scene_mut().textures[number].pixels = Some(image);
        }
    }
    if let Some(file) = loaded.scene.sky.as_ref().and_then(|sky| sky.image.clone()) {
        let image = one(loaded, &file, true, &["sky", "image"].map(Step::from))?;
        if let Some(sky) = &mut loaded.scene_mut().sky {
            sky.pixels = Some(image);
        }
    }
    Ok(())
}
