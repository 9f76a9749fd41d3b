//! Meshes of simple shapes, with texture coordinates: rectangle, box, and what a lathe makes.

use super::{TriangleMesh, Vec3};
use crate::lanes::elementary::sin_cos_degrees;

/// Coordinates of the corners of a rectangle, counter-clockwise from the lower left.
const CORNERS: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

/// A rectangle around `center`, seen from where `normal` points. Its texture stands upright for `normal` along z; for one along
/// ±y it is that of a floor or a ceiling with x to the right. A normal without direction makes vertices that are not finite.
pub fn rectangle(center: Vec3, normal: Vec3, size: [f64; 2]) -> TriangleMesh {
    let n = normal.unit();
    let across = Vec3::new(0.0, 1.0, 0.0).cross(n);
    let u = if across.length() == 0.0 { Vec3::new(1.0, 0.0, 0.0) } else { across.unit() };
    let (u, v) = (u * size[0], n.cross(u) * size[1]);
    let corner = |[s, t]: [f64; 2]| center + u * (s - 0.5) + v * (t - 0.5);
    let faces = vec![[0, 1, 2], [0, 2, 3]];
    let vertices = CORNERS.map(corner).to_vec();
    TriangleMesh { vertices, uvs: CORNERS.to_vec(), face_uvs: faces.clone(), faces, ..TriangleMesh::default() }
}

/// The box between two corners. Each side shows the whole texture.
pub fn cuboid(min: Vec3, max: Vec3) -> TriangleMesh {
    let corner = |i: usize| {
        let side = |bit: usize, low: f64, high: f64| if i >> bit & 1 == 0 { low } else { high };
        Vec3::new(side(0, min.x, max.x), side(1, min.y, max.y), side(2, min.z, max.z))
    };
    // Each side from outside, counter-clockwise from the lower left, as in the rectangle that looks the same way.
    let sides = [[0, 4, 6, 2], [5, 1, 3, 7], [0, 1, 5, 4], [6, 7, 3, 2], [1, 0, 2, 3], [4, 5, 7, 6]];
    TriangleMesh {
        vertices: (0..8).map(corner).collect(),
        faces: sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
        uvs: CORNERS.to_vec(),
        face_uvs: [[0, 1, 2], [0, 2, 3]].repeat(6),
        ..TriangleMesh::default()
    }
}

/// What a lathe makes of a profile: points `[radius, height]` that turn around the y axis, as a ring of `segments` vertices each,
/// or one where the radius is 0. The outer side is on the right of the way along the profile: outside for one that
/// leads up. A profile whose last point is its first makes a closed ring. Textures go once around, and once along.
pub fn lathe(profile: &[[f64; 2]], segments: u32) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let around: Vec<_> = (0..segments).map(|i| sin_cos_degrees(360.0 * f64::from(i) / f64::from(segments))).collect();
    let closes = profile.len() > 2 && profile.first() == profile.last();
    let mut rings: Vec<u32> = Vec::with_capacity(profile.len());
    for (k, &[radius, height]) in profile.iter().enumerate() {
        if closes && k + 1 == profile.len() {
            rings.push(0);
            break;
        }
        rings.push(mesh.vertices.len() as u32);
        let count = if radius == 0.0 { 1 } else { around.len() };
        mesh.vertices.extend(around[..count].iter().map(|(sin, cos)| Vec3::new(radius * cos, height, -radius * sin)));
    }
    let mut along = vec![0.0];
    for pair in profile.windows(2) {
        let step = Vec3::new(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1], 0.0).length();
        along.push(along[along.len() - 1] + step);
    }
    let whole = along[along.len() - 1];
    for v in along {
        mesh.uvs.extend((0..=segments).map(|i| [f64::from(i) / f64::from(segments), v / whole]));
    }
    let vertex = |k: usize, i: u32| rings[k] + if profile[k][0] == 0.0 { 0 } else { i % segments };
    let uv = |k: usize, i: u32| k as u32 * (segments + 1) + i;
    for k in 0..profile.len().saturating_sub(1) {
        for i in 0..segments {
            let quad = [(k, i), (k, i + 1), (k + 1, i + 1), (k + 1, i)];
            let halves = [(profile[k][0] > 0.0, [0, 1, 2]), (profile[k + 1][0] > 0.0, [0, 2, 3])];
            for (_, half) in halves.into_iter().filter(|(has_area, _)| *has_area) {
                mesh.faces.push(half.map(|corner: usize| vertex(quad[corner].0, quad[corner].1)));
                mesh.face_uvs.push(half.map(|corner: usize| uv(quad[corner].0, quad[corner].1)));
            }
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::solid::structure;
    use crate::geometry::triangle;
    use std::f64::consts::PI;

    fn volume(mesh: &TriangleMesh) -> f64 {
        let report = structure(mesh);
        assert!(report.is_solid());
        let [component] = report.components.as_slice() else { panic!("{} components", report.components.len()) };
        assert!(!component.inside_out);
        component.volume
    }

    #[test]
    fn a_rectangle_looks_along_its_normal_with_its_texture_upright() {
        for normal in [[0., 0., 1.], [0., 1., 0.], [0., -2., 0.], [1., 2., -3.]].map(Vec3::from) {
            let mesh = rectangle(Vec3::new(5.0, 6.0, 7.0), normal, [2.0, 3.0]);
            for f in 0..2 {
                // One rounding for each step.
                assert!((triangle::normal(mesh.corners(f)).unit() - normal.unit()).length() < 1e-15);
            }
            let [a, b, c, d] = [0, 1, 2, 3].map(|i| mesh.vertices[i]);
            assert!(((b - a).length() - 2.0).abs() < 1e-14 && ((d - a).length() - 3.0).abs() < 1e-14);
            assert!((c - b - (d - a)).length() < 1e-14);
        }
        let upright = rectangle(Vec3::default(), Vec3::new(0.0, 0.0, 1.0), [2.0, 4.0]);
        assert_eq!(upright.vertices[0], Vec3::new(-1.0, -2.0, 0.0));
        assert_eq!(upright.vertices[2], Vec3::new(1.0, 2.0, 0.0));
    }

    #[test]
    fn a_box_is_a_solid_and_its_sides_are_not_mirrored() {
        let mesh = cuboid(Vec3::new(-1.0, -2.0, -3.0), Vec3::new(1.0, 2.0, 4.0));
        assert_eq!(volume(&mesh), 2.0 * 4.0 * 7.0);
        for f in 0..12 {
            // The texture's own normal, u × v, is the face's.
            let [a, b, c] = mesh.face_uvs[f].map(|i| mesh.uvs[i as usize]);
            assert!((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0.0);
        }
    }

    #[test]
    fn a_lathe_makes_solids() {
        // A cone of 2000 sides: the polygon's area is short of the circle's by (2π/n)²/6.
        let cone = lathe(&[[0.0, 0.0], [2.0, 0.0], [0.0, 3.0]], 2000);
        assert!((volume(&cone) / (4.0 * PI) - 1.0).abs() < 2e-6);
        // A ring of square section around the axis: Pappus, area times the way of its middle.
        let ring = lathe(&[[1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 0.0]], 2000);
        assert!((volume(&ring) / (2.0 * PI * 1.5) - 1.0).abs() < 2e-6);
        let report = structure(&ring);
        assert_eq!(report.components[0].euler(), 0, "a torus");
    }
}
