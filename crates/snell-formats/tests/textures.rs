//! Real models with texture coordinates and real pictures.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use snell::geometry::solid::{Options, repair};
use snell_formats::model::parse_model;
use snell_formats::read_image;
use snell_test_scenes::real_files::data;

#[test]
fn the_cow_is_painted_all_over_and_stays_so() {
    let Some(data) = data() else { return };
    let path = data.join("meshes/spot.obj");
    let mesh = parse_model(&path, &std::fs::read(&path).unwrap()).unwrap().mesh;
    assert_eq!(
        (mesh.vertices.len(), mesh.uvs.len(), mesh.faces.len()),
        (2930, 3225, 5856),
        "seams: more of them than vertices"
    );
    let area = |face: usize| {
        let [a, b, c] = mesh.corner_uvs(face).unwrap();
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    // As the file is: it reaches a little beyond the picture, and 177 slivers of it are folded over.
    assert!(mesh.uvs.iter().flatten().all(|c| (-0.06..1.01).contains(c)));
    let areas: Vec<f64> = (0..mesh.faces.len()).map(|face| area(face) / 2.0).collect();
    assert_eq!(areas.iter().filter(|&&area| area <= 0.0).count(), 177);
    assert!((areas.iter().sum::<f64>() - 0.474_669_881_509).abs() < 1e-12, "as a script adds them up");
    // Taken apart, turned over and put together again, every corner has the texture coordinates that it had.
    let mut apart = mesh.clone();
    apart.vertices = (0..mesh.faces.len()).flat_map(|face| mesh.corners(face)).collect();
    apart.faces = (0..mesh.faces.len() as u32).map(|face| [3 * face, 3 * face + 2, 3 * face + 1]).collect();
    apart.face_uvs.iter_mut().for_each(|uvs| uvs.swap(1, 2));
    let (mended, log) = repair(&apart, &Options::default());
    assert!(log.turned_components == 1 && mended.vertices.len() == mesh.vertices.len(), "{log:?}");
    for face in 0..mesh.faces.len() {
        assert_eq!((mended.corners(face), mended.corner_uvs(face)), (mesh.corners(face), mesh.corner_uvs(face)));
    }
}

#[test]
fn polygons_of_old_models_keep_their_texture() {
    let Some(data) = data() else { return };
    let folder = data.join("course/unpaired");
    for (model, vts) in [("set-4/obj/wolf.obj", 2624), ("set-1/models/pug.obj", 528), ("set-1/models/grass.obj", 4)] {
        let path = folder.join(model);
        let mesh = parse_model(&path, &std::fs::read(&path).unwrap()).unwrap().mesh;
        assert_eq!((mesh.uvs.len(), mesh.face_uvs.len()), (vts, mesh.faces.len()), "{model}");
    }
}

#[test]
fn a_real_picture_is_read() {
    let Some(data) = data() else { return };
    let image = read_image(&data.join("gltf/BoxTextured/glTF/CesiumLogoFlat.png"), true).unwrap();
    assert_eq!((image.width(), image.height()), (256, 256));
    assert!(image.pixels().iter().flatten().all(|c| (0.0..=1.0).contains(c)));
}
