//! Makes what a page loads of the module that cargo has built: JavaScript that calls it, its types, and the module without names.
//!
//! ```text
//! snell-wasm-bundle target/wasm32-unknown-unknown/wasm/snell_wasm.wasm target/studio
//! ```
//!
//! It is `wasm-bindgen` as a library, in the version that `Cargo.lock` has for the module too, so that the two always fit.

#![allow(clippy::print_stderr, reason = "a command says how it is called")]

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;
use wasm_bindgen_cli_support::Bindgen;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let paths: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [module, folder] = paths.as_slice() else {
        eprintln!("usage: snell-wasm-bundle MODULE.wasm FOLDER");
        return Ok(ExitCode::from(2));
    };
    let mut bindgen = Bindgen::new();
    bindgen.input_path(module).web(true)?.typescript(true).remove_name_section(true).remove_producers_section(true);
    bindgen.generate(folder)?;
    // So that Node loads it as the module that it is for a page.
    std::fs::write(folder.join("package.json"), "{ \"type\": \"module\" }\n")?;
    Ok(ExitCode::SUCCESS)
}
