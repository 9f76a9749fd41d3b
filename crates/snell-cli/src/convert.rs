//! `snell convert`.

use crate::args::ConvertArgs;
use crate::say::{self, FAILED, Failure, OrFail, Outcome, SCENE, USAGE};
use crate::scenes::save;
use snell_formats::load::Loaded;
use snell_formats::scene_file::{self, Syntax};
use snell_formats::{LoadOptions, Report, load};
use std::path::{Component, Path, PathBuf};

pub fn run(args: &ConvertArgs) -> Outcome {
    let syntax = match args.output.as_deref().and_then(Path::extension).map(|e| e.to_string_lossy().to_lowercase()) {
        None if args.output.is_none() => Syntax::Toml,
        Some(ending) if ending == "toml" => Syntax::Toml,
        Some(ending) if ending == "json" => Syntax::Json,
        _ => {
            let report = Report::error("a scene file ends in .toml or .json");
            return Err(Failure::new(USAGE, report.help("like -o scene.toml")));
        }
    };
    let mut loaded = load(&args.file, &LoadOptions::from(&args.reading)).or_fail(SCENE)?;
    let world = loaded.world().or_fail(SCENE)?;
    say::reports(&loaded.warnings_with(&world));

    let folder = args.output.as_deref().and_then(Path::parent).unwrap_or(Path::new(""));
    for (mesh, path) in loaded.scene.meshes.iter_mut().zip(&loaded.mesh_paths) {
        if let Some(path) = path {
            mesh.file = Some(relative(path, folder));
        }
    }
    let text = scene_file::to_text(&loaded.scene, syntax).or_fail(FAILED)?;
    let text = if syntax == Syntax::Toml { heading(&loaded) + &text } else { text };
    match &args.output {
        Some(output) => save(output, &text, args.force),
        None => say::print(&text),
    }
}

fn heading(loaded: &Loaded) -> String {
    let dialect = loaded.dialect.map_or(String::new(), |d| format!(", read as a driver of the dialect {}", d.name()));
    format!("# From {}{dialect}.\n\n", loaded.source.name)
}

/// The way from a folder to a file, with `/` on every system.
fn relative(file: &Path, folder: &Path) -> String {
    let whole = |p: &Path| p.canonicalize().or_else(|_| std::path::absolute(p)).unwrap_or_else(|_| p.to_owned());
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let (file, folder) = (whole(file), whole(folder));
    let common = file.components().zip(folder.components()).take_while(|(a, b)| a == b).count();
    let up = folder.components().skip(common).map(|_| Component::ParentDir);
    let way: PathBuf = up.chain(file.components().skip(common)).collect();
    way.to_string_lossy().replace('\\', "/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_from_a_folder_to_a_file() {
        assert_eq!(relative(Path::new("/no/a/b/c.obj"), Path::new("/no/a/x")), "../b/c.obj");
        assert_eq!(relative(Path::new("/no/a/c.obj"), Path::new("/no/a")), "c.obj");
        assert_eq!(relative(Path::new("models/c.obj"), Path::new("")), "models/c.obj");
    }
}
