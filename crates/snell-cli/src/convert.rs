//! `snell convert`.

use crate::args::ConvertArgs;
use crate::excerpt::plain;
use crate::input;
use crate::output::{is_standard, refuse_existing, refuse_inputs};
use crate::say::{self, FAILED, Failure, OrFail, Outcome, SCENE, USAGE};
use snell::scene::Scene;
use snell_formats::files::MAX_SCENE_BYTES;
use snell_formats::load::Loaded;
use snell_formats::scene_file::{self, Syntax};
use snell_formats::{LoadOptions, Report, disk};
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

pub fn run(args: &ConvertArgs) -> Outcome {
    let output = args.output.as_deref().filter(|output| !is_standard(output));
    let syntax = match output.and_then(Path::extension).map(|e| e.to_string_lossy().to_lowercase()) {
        None if output.is_none() => Syntax::Toml,
        Some(ending) if ending == "toml" => Syntax::Toml,
        Some(ending) if ending == "json" => Syntax::Json,
        _ => {
            let report = Report::error("a scene file ends in .toml or .json");
            return Err(Failure::new(USAGE, report.help("like -o scene.toml")));
        }
    };
    let mut loaded = input::scene(&args.file, &LoadOptions::from(&args.reading))?;
    let world = loaded.world().or_fail(SCENE)?;
    say::reports(&loaded.warnings_with(&world));

    let target = output.map(disk::behind_links);
    let folder = target.as_deref().and_then(Path::parent).unwrap_or(Path::new(""));
    let name_of = |path: &Path| relative(path, folder);
    let scene = Arc::make_mut(&mut loaded.scene);
    for (mesh, path) in scene.meshes.iter_mut().zip(&loaded.mesh_paths) {
        if let Some(path) = path {
            mesh.file = Some(name_of(path));
        }
    }
    for texture in scene.textures.values_mut() {
        let path = texture.image.as_ref().and_then(|image| loaded.picture_paths.get(image));
        texture.image = path.map(|path| name_of(path)).or(texture.image.take());
    }
    if let Some(sky) = &mut scene.sky {
        let path = sky.image.as_ref().and_then(|image| loaded.picture_paths.get(image));
        sky.image = path.map(|path| name_of(path)).or(sky.image.take());
    }
    let heading = if syntax == Syntax::Toml { heading(&loaded) } else { String::new() };
    let Some(output) = output else {
        let text = heading + &scene_file::to_text(&loaded.scene, syntax).or_fail(FAILED)?;
        if text.len() as u64 > MAX_SCENE_BYTES {
            let report =
                Report::error(format!("this scene has {} bytes as text, which are not read again", text.len()));
            return Err(Failure::new(FAILED, report.help("with -o scene.toml large meshes go into files beside it")));
        }
        return say::print(&text);
    };
    // The scene itself may be rewritten by --force, but nothing that it names.
    let read: Vec<&Path> = loaded.files().filter(|path| !args.force || Some(*path) != loaded.path.as_deref()).collect();
    refuse_inputs(output, read.into_iter().chain(input::standard(&args.file)))?;
    refuse_existing(output, args.force).or_fail(FAILED)?;
    disk::check_writable(output).or_fail(FAILED)?;
    let written = scene_file::save(Scene::clone(&loaded.scene), output, syntax, &heading).or_fail(FAILED)?;
    for file in &written {
        say::tell(&file.display().to_string());
    }
    Ok(())
}

fn heading(loaded: &Loaded) -> String {
    let dialect = loaded.dialect.map_or(String::new(), |d| format!(", read as a driver of the dialect {}", d.name()));
    format!("# From {}{dialect}.\n\n", plain(&loaded.source.name).replace('\n', " "))
}

/// The path from a folder to a file, with `/` on every system.
fn relative(file: &Path, folder: &Path) -> String {
    let whole = |p: &Path| p.canonicalize().or_else(|_| std::path::absolute(p)).unwrap_or_else(|_| p.to_owned());
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let (file, folder) = (whole(file), whole(folder));
    let common = file.components().zip(folder.components()).take_while(|(a, b)| a == b).count();
    let up = folder.components().skip(common).map(|_| Component::ParentDir);
    let path: PathBuf = up.chain(file.components().skip(common)).collect();
    let path = path.to_string_lossy();
    if cfg!(windows) { path.replace('\\', "/") } else { path.into_owned() }
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
