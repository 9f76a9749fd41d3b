//! What the page, or the worker, does for the module.

use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    /// Milliseconds, to a fraction of one. The standard library has no clock here.
    #[wasm_bindgen(js_namespace = performance)]
    pub fn now() -> f64;

    #[wasm_bindgen(js_namespace = console)]
    fn error(text: &str);
}

/// Lets a panic say what it was before it traps. After one, the instance is of no use.
#[wasm_bindgen(start)]
fn start() {
    std::panic::set_hook(Box::new(|panic| error(&panic.to_string())));
}
