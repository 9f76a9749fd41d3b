//! OBJ and MTL texts: reading ends with a mesh whose faces are all there, or a report.
#![no_main]

use libfuzzer_sys::fuzz_target;
use snell::geometry::mesh::NormalWeights;
use snell_formats::model::{parse_mtl, parse_obj};
use snell_formats::text::decode;

fuzz_target!(|bytes: &[u8]| {
    let (source, _) = decode("fuzz", bytes);
    let _ = parse_mtl(&source);
    if let Ok(model) = parse_obj(&source) {
        let mesh = model.mesh;
        assert!(mesh.faces.iter().flatten().all(|&v| (v as usize) < mesh.vertices.len()));
        assert_eq!(mesh.faces.len(), mesh.face_slots.len());
        assert!(mesh.face_slots.iter().all(|&slot| (slot as usize) < mesh.slots.len()));
        for weights in [NormalWeights::Equal, NormalWeights::Angle] {
            mesh.smooth_normals(30.0, weights);
        }
    }
});
