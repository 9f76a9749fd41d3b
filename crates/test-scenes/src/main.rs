//! Prints the lines that the WASM module must print too, one for each scene of the matrix.

#![allow(clippy::print_stdout, reason = "that is what it is for")]

use snell_test_scenes::{all, matrix};

fn main() {
    for (name, scene) in all() {
        println!("{}", matrix::once(&name, &scene));
    }
}
