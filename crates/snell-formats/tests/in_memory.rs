//! A scene whose files are in memory is the scene whose files are on disk.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use snell::film::{Crop, Film, Rgb};
use snell::scene::{Integrator, Render, Scene};
use snell_formats::files::{Disk, Files, InMemory};
use snell_formats::load::{Cache, Kind, Loaded, load_text};
use snell_formats::{LoadOptions, Report, Source, picture};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A model in a folder beside, with a library beside that, and with a picture that the library names; a sky; a file that lies in
/// two places.
const SCENE: &str = r#"
snell = 1
[render]
integrator = "whitted"
size = [4, 4]
[camera]
eye = [0, 0, 5]
look_at = [0, 0, 0]
up = [0, 1, 0]
fov = 30
[sky]
image = "../skies/sky.png"
[[mesh]]
file = "one.obj"
[[mesh]]
file = "models\\two.obj"
material = "plain"
[material.plain]
"#;

const MODEL: &str = "mtllib one.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";

fn files() -> Vec<(&'static str, Vec<u8>)> {
    let mut film = Film::new([2, 1], Crop { x: 0, y: 0, width: 2, height: 1 }).unwrap();
    film.pixels = vec![Rgb::gray(1.0), Rgb::new(0.2, 0.4, 0.6)];
    film.finished.fill(true);
    let png = picture::png_bytes(&film, Render::new(Integrator::Whitted, [2, 1]).encoding(), 1, None).unwrap();
    let two = MODEL.replace("mtllib one.mtl\nusemtl red\n", "");
    vec![
        ("scenes/models/one.obj", MODEL.into()),
        ("scenes/models/one.mtl", b"newmtl red\nKd 1 0 0\nmap_Kd paint.png\n".to_vec()),
        ("scenes/models/paint.png", png.clone()),
        ("scenes/models/two.obj", two.clone().into()),
        ("models/two.obj", (two + "# another\n").into()),
        ("skies/sky.png", png),
    ]
}

fn loaded(files: impl Files + 'static, root: &Path, text: &str) -> Result<(Scene, Vec<String>), Vec<Report>> {
    let options = LoadOptions { files: Arc::new(files), ..LoadOptions::default() };
    let loaded = load_text(Source::new("scene.toml", text), Kind::Toml, &root.join("scenes"), &options)?;
    let hashes = loaded.models.iter().map(|file| file.sha256.clone());
    let said = hashes.chain(loaded.warnings.iter().map(ToString::to_string)).collect();
    Ok((loaded.into_scene(), said))
}

#[test]
fn files_in_memory_are_read_like_those_on_disk() {
    let folder = tempfile::tempdir().unwrap();
    let mut memory = InMemory::default();
    for (name, bytes) in files() {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, &bytes).unwrap();
        memory.insert(Path::new("home").join(name), bytes);
    }
    let (on_disk, said) = loaded(Disk, folder.path(), SCENE).unwrap();
    assert!(on_disk.meshes.iter().all(|mesh| mesh.geometry.is_some()) && on_disk.textures.len() == 1);
    assert!(on_disk.sky.as_ref().is_some_and(|sky| sky.pixels.is_some()));
    assert_eq!(said.len(), 6, "five files and a warning: {said:?}");

    // Names that were found are those of the folder, which is another one here.
    let home = Path::new("home");
    let there = |text: &str| text.replace(&*folder.path().to_string_lossy(), "home");
    let (in_memory, said_there) = loaded(memory.clone(), home, SCENE).unwrap();
    assert_eq!(said.iter().map(|text| there(text)).collect::<Vec<_>>(), said_there);
    let text = |scene: &Scene| there(&format!("{scene:?}"));
    assert_eq!(text(&in_memory), text(&on_disk));

    let misspelt = SCENE.replace("\"one.obj\"", "\"onr.obj\"");
    let [on_disk, in_memory] = [loaded(Disk, folder.path(), &misspelt), loaded(memory, home, &misspelt)]
        .map(|loaded| loaded.unwrap_err().iter().map(|report| report.help.clone()).collect::<Vec<_>>());
    assert!(in_memory[0].as_ref().is_some_and(|help| help.starts_with("did you mean `one.obj`?")), "{in_memory:?}");
    assert_eq!(on_disk[0].as_ref().map(|help| there(help)), in_memory[0]);

    let none: Vec<PathBuf> = InMemory::default().list(Path::new("")).collect();
    assert!(none.is_empty() && loaded(InMemory::default(), home, SCENE).is_err());
}

#[test]
fn with_a_cache_files_are_read_once_and_the_scene_is_the_same() {
    let mut memory = InMemory::default();
    for (name, bytes) in files() {
        memory.insert(name, bytes);
    }
    let cache = Arc::new(Cache::default());
    let load = |memory: &InMemory, cache: Option<&Arc<Cache>>| {
        let options =
            LoadOptions { files: Arc::new(memory.clone()), cache: cache.map(Arc::clone), ..LoadOptions::default() };
        load_text(Source::new("scene.toml", SCENE), Kind::Toml, Path::new("scenes"), &options).unwrap()
    };
    let said = |loaded: &Loaded| format!("{:?} {:?} {:?}", loaded.scene, loaded.models, loaded.warnings);
    let alone = load(&memory, None);
    let [first, second] = [(); 2].map(|()| load(&memory, Some(&cache)));
    assert_eq!([said(&first), said(&second)], [said(&alone), said(&alone)]);
    let geometry = |loaded: &Loaded| loaded.scene.meshes[0].geometry.clone().unwrap();
    assert!(Arc::ptr_eq(&geometry(&first), &geometry(&second)) && !Arc::ptr_eq(&geometry(&first), &geometry(&alone)));

    memory.insert("scenes/models/one.obj", MODEL.replace("v 1 0 0", "v 2 0 0").into());
    assert_eq!(said(&load(&memory, Some(&cache))), said(&alone), "what was read stays");
    cache.keep_only(&[]);
    assert_ne!(said(&load(&memory, Some(&cache))), said(&alone), "what was forgotten is read again");
}
