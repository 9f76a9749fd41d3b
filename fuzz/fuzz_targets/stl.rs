//! STL files, text and bytes: reading ends with a mesh whose faces are all there, or a report.
#![no_main]

use libfuzzer_sys::fuzz_target;
use snell::geometry::solid::check;
use snell_formats::model::{Model, parse_stl};

fuzz_target!(|data: &[u8]| {
    match parse_stl("fuzz", data) {
        Err(report) => {
            if let Some((source, range)) = report.place {
                assert!(source.text.get(range).is_some());
            }
        }
        Ok(Model { mesh, .. }) => {
            assert!(mesh.faces.iter().flatten().all(|&v| (v as usize) < mesh.vertices.len()));
            check(&mesh);
        }
    }
});
