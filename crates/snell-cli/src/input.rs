//! What a command is given: a scene, by any name or on standard input, and whether a file is something else.

use crate::output::STANDARD;
use crate::say::{FAILED, Failure, OrFail, SCENE};
use snell_formats::files::MAX_SCENE_BYTES;
use snell_formats::given::{Given, given_file};
use snell_formats::load::{Loaded, load_bytes};
use snell_formats::{LoadOptions, Report, load};
use std::io::Read;
use std::path::Path;

/// Reads a scene.
pub fn scene(name: &str, options: &LoadOptions) -> Result<Loaded, Failure> {
    if name == STANDARD {
        let mut bytes = Vec::new();
        let limit = MAX_SCENE_BYTES;
        std::io::stdin()
            .lock()
            .take(limit + 1)
            .read_to_end(&mut bytes)
            .map_err(|e| Failure::new(FAILED, Report::error(format!("cannot read standard input: {e}"))))?;
        if bytes.len() as u64 > limit {
            return Err(Failure::new(SCENE, Report::error(format!("standard input has more than {limit} bytes"))));
        }
        return load_bytes("standard input", Path::new(""), &bytes, Path::new("."), options).or_fail(SCENE);
    }
    load(name, options).or_fail(SCENE)
}

/// The file behind standard input, if that is what was named: it is read like any other.
pub fn standard(name: &str) -> Option<&'static Path> {
    (name == STANDARD).then_some(Path::new("/dev/stdin"))
}

/// What a file is, by its first bytes and its name; a pipe is not looked into, which would swallow them.
pub fn what_is(name: &str) -> Given {
    let path = Path::new(name);
    if name == STANDARD || !path.is_file() {
        return Given::Text;
    }
    given_file(path)
}
