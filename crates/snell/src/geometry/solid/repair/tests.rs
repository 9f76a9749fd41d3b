//! Repair of anything at all.

use super::super::tests::torus;
use super::super::{Verdict, check, structure};
use super::*;
use crate::geometry::Vec3;
use proptest::prelude::*;
use std::collections::HashMap;

fn once_and_for_all(mesh: &TriangleMesh) -> Result<TriangleMesh, TestCaseError> {
    let (before, (mended, log)) = (check(mesh), repair(mesh, &Options::default()));
    let after = check(&mended);
    prop_assert!(!before.is_solid() || after.is_solid(), "{before:?} {log:?} {after:?}");
    prop_assert!(after.broken.is_empty() && before.component_of.len() == mesh.faces.len());
    prop_assert!(mended.face_slots.len() == mended.faces.len());
    prop_assert!(mended.face_uvs.len() == mended.faces.len());
    let painted = (0..mended.faces.len()).filter_map(|f| Some((mended.corners(f), mended.corner_uvs(f)?)));
    for (corners, uvs) in painted.clone() {
        // Numbers up to 17, halved again and again: a few roundings.
        let off = |i: usize| [0, 1].map(|k| (uvs[i][k] - paint(corners[i])[k]).abs());
        prop_assert!((0..3).all(|i| off(i).iter().all(|&off| off < 1e-12)), "{corners:?} {uvs:?}");
    }
    prop_assert!(log.new_faces > 0 || painted.count() == mended.faces.len(), "only what fills holes is bare");
    let (again, nothing) = repair(&mended, &Options::default());
    prop_assert!(nothing.is_empty() && again == mended, "{log:?} {nothing:?}");
    Ok(mended)
}

/// Faces between the points of a small grid, where much lies on lines, in planes and in one place.
fn on_a_grid(faces: Vec<[u32; 3]>, places: Vec<[i8; 3]>) -> TriangleMesh {
    let vertices = places.into_iter().map(|p| Vec3::from(p.map(f64::from))).collect();
    let mut mesh = TriangleMesh {
        vertices,
        face_slots: vec![0; faces.len()],
        faces,
        slots: vec![String::new()],
        ..TriangleMesh::default()
    };
    for (i, face) in mesh.faces.iter().enumerate() {
        mesh.uvs.extend(face.map(|v| mesh.vertices.get(v as usize).map_or([0.5; 2], |&at| paint(at))));
        mesh.face_uvs.push([0, 1, 2].map(|k| 3 * i as u32 + k));
    }
    mesh
}

/// Texture coordinates that tell the position, and are linear in it.
fn paint(at: Vec3) -> [f64; 2] {
    [at.x + 16.0 * at.y, 16.0 * at.z - at.x]
}

/// How many edges have an odd number of faces, and how many not two, of which each passes the edge in its own direction.
fn bad_edges(mesh: &TriangleMesh) -> [usize; 2] {
    let key = |v: u32| {
        let Vec3 { x, y, z } = mesh.vertices[v as usize];
        [x, y, z].map(|c| (c + 0.0).to_bits())
    };
    let mut edges: HashMap<_, [usize; 2]> = HashMap::new();
    for [a, b, c] in mesh.faces.iter().map(|face| face.map(key)).filter(|[a, b, c]| a != b && b != c && c != a) {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            edges.entry((from.min(to), from.max(to))).or_default()[usize::from(from < to)] += 1;
        }
    }
    [edges.values().filter(|[a, b]| (a + b) % 2 == 1).count(), edges.values().filter(|uses| **uses != [1, 1]).count()]
}

/// Does to a mesh what scanners, converters and people do. Meshes that were closed may stay so.
fn damage(mesh: &mut TriangleMesh, kind: u8, face: usize, other: usize) {
    let count = mesh.faces.len();
    let [a, b, c] = mesh.faces[face % count];
    let [at_a, at_b] = [a, b].map(|v| mesh.vertices[v as usize]);
    let strange = mesh.faces[other % count][0];
    let mut add = |at: Vec3| {
        mesh.vertices.push(at);
        mesh.vertices.len() as u32 - 1
    };
    match kind {
        0 => mesh.faces[face % count].swap(0, 1),
        1 => mesh.faces.push([b, c, a]),
        2 => mesh.faces.push([c, b, a]),
        3 if count > 1 => drop(mesh.faces.swap_remove(face % count)),
        // A vertex of its own, in the same place or near it.
        4 => mesh.faces[face % count][0] = add(at_a),
        5 => mesh.faces[face % count][0] = add(at_a + (at_b - at_a) * 1e-4),
        // A vertex on an edge, with a face without area that closes the crack, or without it.
        6 | 7 => {
            let middle = add((at_a + at_b) * 0.5);
            mesh.faces[face % count] = [a, middle, c];
            mesh.faces.push([middle, b, c]);
            if kind == 7 {
                mesh.faces.push([a, b, middle]);
            }
        }
        // An edge collapses, or strange vertices become one.
        8 => mesh.faces.iter_mut().flatten().filter(|v| **v == a).for_each(|v| *v = b),
        9 => mesh.faces.iter_mut().flatten().filter(|v| **v == a).for_each(|v| *v = strange),
        // An edge becomes short, a face a needle.
        10 => mesh.vertices[a as usize] = at_b + (at_b - at_a) * 1e-4,
        11 => mesh.vertices[c as usize] = at_a + (at_b - at_a) * 0.25,
        // A tetrahedron stands on a face, with the face or without it.
        12 => mesh.faces.extend([[a, b, strange], [b, c, strange], [c, a, strange]]),
        _ => mesh.faces.extend([[a, b, strange], [b, c, strange], [c, a, strange], [c, b, a]]),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn nothing_is_worse_than_it_was(
        size in (3u32..9, 3u32..9),
        done in prop::collection::vec((0u8..14, 0usize..1000, 0usize..1000), 0..7),
        weld in prop::sample::select(vec![0.0, 1e-3, 0.05]),
    ) {
        let mut mesh = torus(size.0, size.1);
        for (kind, face, other) in done {
            damage(&mut mesh, kind, face, other);
        }
        let options = Options { weld, ..Options::default() };
        let (mended, log) = repair(&mesh, &options);
        let (before, after) = (bad_edges(&mesh), bad_edges(&mended));
        prop_assert!(after[0] <= before[0] && after[1] <= before[1], "{before:?} {after:?} {log:?}");
        let (was, is) = (structure(&mesh), structure(&mended));
        prop_assert!(is.is_solid() || !was.is_solid(), "{was:?} {log:?}");
        prop_assert!(is.verdict() == Verdict::Solid || was.verdict() != Verdict::Solid, "{was:?} {is:?} {log:?}");
        prop_assert!(!is.components.is_empty() || was.components.is_empty());
        prop_assert!(!log.is_empty() || mended == mesh, "{log:?}");
        let (again, nothing) = repair(&mended, &options);
        prop_assert!(nothing.is_empty() && again == mended, "{log:?} {nothing:?}");
    }

    /// Vertex 12 is not there.
    #[test]
    fn whatever_it_is_twice_is_once(
        faces in prop::collection::vec(prop::array::uniform3(0u32..13), 1..40),
        places in prop::collection::vec(prop::array::uniform3(-1i8..=1), 12),
    ) {
        once_and_for_all(&on_a_grid(faces, places))?;
    }

    /// A grid of cubes of which some are there, each with faces of its own; with faces taken away and turned.
    #[test]
    fn damaged_solids_are_mended(
        cubes in prop::collection::vec(prop::array::uniform3(0i8..3), 1..6),
        gone in prop::collection::vec(0usize..72, 0..2),
        turned in prop::collection::vec(0usize..72, 0..2),
    ) {
        let mut cubes = cubes;
        cubes.sort_unstable();
        cubes.dedup();
        let quads = [[0u32, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let (mut faces, mut places) = (Vec::new(), Vec::new());
        for at in &cubes {
            let first = places.len() as u32;
            places.extend((0..8).map(|i| [0, 1, 2].map(|axis| at[axis] + (i >> axis & 1))));
            faces.extend(quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|f| f.map(|v| v + first)));
        }
        let whole = on_a_grid(faces, places);
        let report = structure(&whole);
        prop_assert!(report.is_solid() && report.components.iter().all(|c| c.volume == 1.0), "{report:?}");
        prop_assert_eq!(report.components.len(), cubes.len());
        prop_assert_eq!(once_and_for_all(&whole)?.faces.len(), whole.faces.len());
        let mut damaged = whole;
        let count = damaged.faces.len();
        for t in turned {
            damaged.faces[t % count].swap(0, 1);
            damaged.face_uvs[t % count].swap(0, 1);
        }
        for g in gone {
            damaged.faces.remove(g % damaged.faces.len());
            damaged.face_slots.pop();
            damaged.face_uvs.remove(g % damaged.face_uvs.len());
        }
        let mended = once_and_for_all(&damaged)?;
        if cubes.len() == 1 {
            prop_assert!(structure(&mended).is_solid());
        }
    }
}
