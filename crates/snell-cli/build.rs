//! Puts the pages of Snell Studio into the command, compressed, if `SNELL_STUDIO_DIST` names the folder that they lie in.

use flate2::{Compression, write::GzEncoder};
use std::env;
use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::io::{Result, Write};
use std::path::{Path, PathBuf};

const FOLDER: &str = "SNELL_STUDIO_DIST";

fn main() -> std::result::Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed={FOLDER}");
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or("cargo sets OUT_DIR")?);
    let mut list = String::new();
    if let Some(folder) = env::var_os(FOLDER).filter(|folder| !folder.is_empty()).map(PathBuf::from) {
        if !folder.is_absolute() || !folder.join("index.html").is_file() {
            return Err(format!("{FOLDER} has to be the absolute path of a folder with index.html in it").into());
        }
        println!("cargo::rerun-if-changed={}", folder.display());
        for (number, (name, path)) in files_in(&folder)?.into_iter().enumerate() {
            let packed = format!("studio-{number}.gz");
            fs::write(out.join(&packed), gzip(&fs::read(path)?)?)?;
            writeln!(list, "    ({name:?}, include_bytes!(concat!(env!(\"OUT_DIR\"), \"/{packed}\"))),")?;
        }
    }
    fs::write(out.join("studio.rs"), format!("&[\n{list}]\n"))?;
    Ok(())
}

/// All files of a folder, by their names with `/` between folders, in an order that does not change.
fn files_in(folder: &Path) -> Result<Vec<(String, PathBuf)>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() {
            files.extend(files_in(&path)?.into_iter().map(|(inner, path)| (format!("{name}/{inner}"), path)));
        } else {
            files.push((name, path));
        }
    }
    files.sort();
    Ok(files)
}

fn gzip(bytes: &[u8]) -> Result<Vec<u8>> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes)?;
    encoder.finish()
}
