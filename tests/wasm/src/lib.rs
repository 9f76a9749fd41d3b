//! The matrix of `snell-test-scenes` for `run.mjs`, which calls it with plain numbers. Not the surface for browsers.

#![allow(unsafe_code, reason = "names that JavaScript can call must not be mangled; nothing else here is unsafe")]

#[cfg(all(target_family = "wasm", not(target_feature = "simd128")))]
compile_error!("WASM is to be tested with simd128: is RUSTFLAGS set, or .cargo/config.toml not read?");

use snell_test_scenes::{Named, all, matrix};
use std::sync::{LazyLock, Mutex, PoisonError};

static SCENES: LazyLock<Vec<Named>> = LazyLock::new(all);

/// The last line, or why the last call panicked.
static TEXT: Mutex<String> = Mutex::new(String::new());

fn say(text: String) {
    *TEXT.lock().unwrap_or_else(PoisonError::into_inner) = text;
}

/// How many scenes there are. To be called first: from then on a panic leaves its message in the text before it traps.
#[unsafe(no_mangle)]
pub extern "C" fn scene_count() -> usize {
    std::panic::set_hook(Box::new(|panic| say(panic.to_string())));
    SCENES.len()
}

/// Renders a scene in all ways that one thread allows; the text is then its line.
#[unsafe(no_mangle)]
pub extern "C" fn check(scene: usize) {
    let (name, scene) = &SCENES[scene];
    say(matrix::all_ways(name, scene, &[1]));
}

/// Where the text starts.
#[unsafe(no_mangle)]
pub extern "C" fn text() -> *const u8 {
    TEXT.lock().unwrap_or_else(PoisonError::into_inner).as_ptr()
}

/// How many bytes of UTF-8 it has.
#[unsafe(no_mangle)]
pub extern "C" fn text_length() -> usize {
    TEXT.lock().unwrap_or_else(PoisonError::into_inner).len()
}
