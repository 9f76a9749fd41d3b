//! Is a picture finished?

use snell_formats::picture::memory_of;
use snell_formats::recipe::Recipe;
use std::path::Path;

/// What lies where a picture should go.
pub enum There {
    Nothing,
    /// The picture, whole.
    Finished,
    /// One that Snell made otherwise, or that is not whole.
    Another,
    /// Somebody's file, and what it is.
    Foreign(String),
}

/// Compares a file with the recipe of the picture that should be there.
pub fn look(output: &Path, wanted: &Recipe) -> There {
    match output.metadata() {
        // A link to nowhere is written through, as everywhere.
        Err(_) => return There::Nothing,
        Ok(metadata) if !metadata.is_file() => return There::Foreign("it is no file".to_owned()),
        // What a power cut leaves of a file that was just renamed.
        Ok(metadata) if metadata.len() == 0 => return There::Nothing,
        Ok(_) => {}
    }
    let memory = match memory_of(output) {
        Ok(memory) => memory,
        // Another machine may have it renamed over at this moment, or it is gone.
        Err(_) if !output.exists() => return There::Nothing,
        Err(report) => return There::Foreign(report.message),
    };
    let Some(recipe) = memory.recipe.and_then(|text| Recipe::from_json(&text).ok()) else {
        return There::Foreign("it does not say that Snell made it".to_owned());
    };
    let finished = memory.is_whole && recipe.film_sha256.is_some() && recipe.difference(wanted).is_none();
    let how = |recipe: &Recipe| (recipe.transfer, recipe.rounding, recipe.bits.unwrap_or(8));
    if finished && how(&recipe) == how(wanted) { There::Finished } else { There::Another }
}
