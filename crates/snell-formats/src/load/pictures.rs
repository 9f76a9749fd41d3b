//! The pictures that a scene names: on surfaces and as its sky.

use super::{Loaded, ModelFile};
use crate::disk;
use crate::model::find;
use crate::report::Report;
use crate::texture::read_image;
use snell::scene::Step;
use snell::texture::Image;
use std::path::PathBuf;
use std::sync::Arc;

/// Reads them all.
pub(super) fn read(loaded: &mut Loaded, search: &[PathBuf]) -> Result<(), Report> {
    for number in 0..loaded.scene.textures.len() {
        let (name, texture) = (&loaded.scene.textures.keys()[number], &loaded.scene.textures[number]);
        if let (Some(file), None) = (texture.image.clone(), &texture.pixels) {
            let place = ["texture", name, "image"].map(Step::from);
            let image = read_one(loaded, &file, !texture.linear, &place, search)?;
            loaded.scene.textures[number].pixels = Some(image);
        }
    }
    if let Some(file) = loaded.scene.sky.as_ref().and_then(|sky| sky.image.clone()) {
        let place = ["sky", "image"].map(Step::from);
        let image = read_one(loaded, &file, true, &place, search)?;
        if let Some(sky) = &mut loaded.scene.sky {
            sky.pixels = Some(image);
        }
    }
    Ok(())
}

fn read_one(
    loaded: &mut Loaded,
    file: &str,
    srgb: bool,
    place: &[Step],
    search: &[PathBuf],
) -> Result<Arc<Image>, Report> {
    let put = |report: Report| if report.place.is_some() { report } else { loaded.places.put(report, place) };
    let found = find(file, &loaded.folder, search).map_err(put)?;
    let image = read_image(&found.path, srgb).map_err(put)?;
    let sha256 = disk::sha256([&disk::read(&found.path, disk::MAX_MODEL_BYTES)?]);
    let warning = found.warning.map(put);
    loaded.warnings.extend(warning);
    loaded.picture_paths.insert(file.to_owned(), found.path.clone());
    loaded.models.push(ModelFile { path: found.path, sha256 });
    Ok(Arc::new(image))
}
