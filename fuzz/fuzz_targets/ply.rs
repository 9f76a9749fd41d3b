//! PLY files, text and bytes: reading ends with a mesh whose faces are all there, or a report; what was read can be checked
//! and mended.
#![no_main]

use libfuzzer_sys::fuzz_target;
use snell::geometry::solid::{Options, check, repair};
use snell_formats::model::{Model, parse_ply};

fuzz_target!(|data: &[u8]| {
    match parse_ply("fuzz", data) {
        Err(report) => {
            if let Some((source, range)) = report.place {
                assert!(source.text.get(range).is_some());
            }
        }
        Ok(Model { mesh, .. }) => {
            assert!(mesh.faces.iter().flatten().all(|&v| (v as usize) < mesh.vertices.len()));
            check(&mesh);
            let (mended, _) = repair(&mesh, &Options::default());
            assert!(mended.faces.iter().flatten().all(|&v| (v as usize) < mended.vertices.len()));
        }
    }
});
