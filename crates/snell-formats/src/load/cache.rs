//! What many loads of nearly the same scene need to read once only.

use super::ModelFile;
use crate::report::Report;
use snell::geometry::TriangleMesh;
use snell::texture::Image;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

/// Models and pictures by their files. A file that changes meanwhile is not read again.
#[derive(Debug, Default)]
pub struct Cache {
    models: Mutex<HashMap<PathBuf, Arc<Parsed>>>,
    images: Mutex<HashMap<ImageFile, ImageWithHash>>,
}

/// A file, and whether its curve is decoded.
pub(super) type ImageFile = (PathBuf, bool);

/// What was read, and the SHA-256 of the file.
pub(super) type ImageWithHash = (Arc<Image>, String);

/// A model as its file has it.
#[derive(Debug)]
pub(super) struct Parsed {
    pub mesh: Arc<TriangleMesh>,
    pub libraries: Vec<String>,
    pub has_normals: bool,
    pub lost_uv: Option<Report>,
    pub warnings: Vec<Report>,
    pub sha256: String,
}

impl Cache {
    /// Forgets all but these files, so that a scene whose models change does not fill the memory.
    pub fn keep_only(&self, files: &[ModelFile]) {
        let is_kept = |path: &Path| files.iter().any(|file| file.path == path);
        if let Ok(mut models) = self.models.lock() {
            models.retain(|path, _| is_kept(path));
        }
        if let Ok(mut images) = self.images.lock() {
            images.retain(|(path, _), _| is_kept(path));
        }
    }

    pub(super) fn model(&self, path: &Path) -> Option<Arc<Parsed>> {
        self.models.lock().ok()?.get(path).cloned()
    }

    pub(super) fn keep_model(&self, path: &Path, model: &Arc<Parsed>) {
        if let Ok(mut models) = self.models.lock() {
            models.insert(path.to_owned(), Arc::clone(model));
        }
    }

    pub(super) fn image(&self, file: &ImageFile) -> Option<ImageWithHash> {
        self.images.lock().ok()?.get(file).cloned()
    }

    pub(super) fn keep_image(&self, file: &ImageFile, image: &Arc<Image>, sha256: &str) {
        if let Ok(mut images) = self.images.lock() {
            images.insert(file.clone(), (Arc::clone(image), sha256.to_owned()));
        }
    }
}
