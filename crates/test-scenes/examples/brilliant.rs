//! Prints a round brilliant:   cargo run -p snell-test-scenes --example brilliant -- obj|toml [TABLE CROWN PAVILION]
//!
//! `obj` is a model, `toml` the lines of a `[[mesh]]` in a scene file. Table in diameters, angles in degrees.

#![allow(clippy::print_stdout, reason = "that is what it is for")]

use snell_formats::model::write_obj;
use snell_test_scenes::brilliant::Cut;
use std::error::Error;
use std::fmt::Debug;
use std::io::stdout;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let mut cut = Cut::default();
    for (value, text) in [&mut cut.table, &mut cut.crown, &mut cut.pavilion].into_iter().zip(arguments.iter().skip(1)) {
        *value = text.parse()?;
    }
    let mesh = cut.brilliant().solid.mesh();
    match arguments.first().map(String::as_str) {
        Some("obj") => write_obj(&mesh, &[], &mut stdout())?,
        Some("toml") => {
            let vertices: Vec<[f64; 3]> = mesh.vertices.into_iter().map(Into::into).collect();
            print_array("vertices", &vertices, 2);
            print_array("faces", &mesh.faces, 8);
        }
        _ => return Err("obj or toml?".into()),
    }
    Ok(())
}

/// A TOML array, with so many elements in a line.
fn print_array(name: &str, elements: &[impl Debug], in_a_line: usize) {
    println!("{name} = [");
    for line in elements.chunks(in_a_line) {
        print!("   ");
        for element in line {
            print!(" {element:?},");
        }
        println!();
    }
    println!("]");
}
