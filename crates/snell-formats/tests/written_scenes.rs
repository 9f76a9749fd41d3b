//! Scenes that are written and read again.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use snell::scene::{Integrator, Scene};
use snell_formats::Source;
use snell_formats::scene_file::{Syntax, parse, to_text};
use snell_test_scenes::{crowd, instances};

/// With the triangles where a file has them.
fn written_out(mut scene: Scene) -> Scene {
    for mesh in &mut scene.meshes {
        let Some(geometry) = mesh.geometry.take() else { continue };
        mesh.vertices = geometry.vertices.iter().map(|&vertex| vertex.into()).collect();
        mesh.faces.clone_from(&geometry.faces);
    }
    scene
}

#[test]
fn a_scene_survives_being_written_to_the_bit() {
    for scene in [crowd(Integrator::Course2020), written_out(instances(0.0, true))] {
        for syntax in [Syntax::Json, Syntax::Toml] {
            let text = to_text(&scene, syntax).unwrap();
            assert!(parse(&Source::new("written", text), syntax).unwrap() == scene);
        }
    }
}
