//! A tube around a (2, 3) torus knot, finely meshed.

use crate::to_f32;
use snell::geometry::{TriangleMesh, Vec3};
use std::f64::consts::PI;

/// The mesh of the benchmarks: a million triangles in the knot and two in the ground below it.
pub fn on_ground() -> TriangleMesh {
    let mut mesh = knot(2000, 250, 0.45);
    let ground = square(12.0, -1.6);
    let base = mesh.vertices.len() as u32;
    mesh.vertices.extend(ground.vertices);
    mesh.faces.extend(ground.faces.iter().map(|face| face.map(|v| v + base)));
    mesh
}

/// A tube of radius `r` around the curve `c(u) = (a·cos 2u, a·sin 2u, sin 3u)`, `a = 2 + cos 3u`, with `2·nu·nv`
/// triangles.
///
/// At each of `nu` points of the curve stands a circle of `nv` vertices, spanned by `b = unit(c′ × c)` and
/// `n = unit(b × c′)`.
pub fn knot(nu: u32, nv: u32, r: f64) -> TriangleMesh {
    let step = |i: u32, count: u32| 2.0 * PI * f64::from(i) / f64::from(count);
    let circle: Vec<_> = (0..nv).map(|j| libm::sincos(step(j, nv))).collect();
    let mut mesh = TriangleMesh::default();
    for i in 0..nu {
        let u = step(i, nu);
        let ((sin2, cos2), (sin3, cos3)) = (libm::sincos(2.0 * u), libm::sincos(3.0 * u));
        let (a, da) = (2.0 + cos3, -3.0 * sin3);
        let center = Vec3::new(a * cos2, a * sin2, sin3);
        let tangent = Vec3::new(da * cos2 - 2.0 * a * sin2, da * sin2 + 2.0 * a * cos2, 3.0 * cos3);
        let b = tangent.cross(center).unit();
        let n = b.cross(tangent).unit();
        mesh.vertices.extend(circle.iter().map(|&(sin, cos)| rounded(center + (n * cos + b * sin) * r)));
    }
    for i in 0..nu {
        for j in 0..nv {
            let at = |i: u32, j: u32| (i % nu) * nv + j % nv;
            mesh.faces.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            mesh.faces.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    mesh
}

/// A square in the plane of this height, from `−half` to `half`.
pub fn square(half: f64, z: f64) -> TriangleMesh {
    let corners = [(-half, -half), (half, -half), (half, half), (-half, half)];
    TriangleMesh {
        vertices: corners.map(|(x, y)| rounded(Vec3::new(x, y, z))).to_vec(),
        faces: vec![[0, 1, 2], [0, 2, 3]],
        ..TriangleMesh::default()
    }
}

/// The white and the black squares of a chessboard in the plane of this height, from `−half` to `half`. Squares have edges
/// of 1, and the one from the origin to (1, 1) is white.
pub fn chessboard(half: i32, z: f64) -> [TriangleMesh; 2] {
    let mut colors = [TriangleMesh::default(), TriangleMesh::default()];
    for (i, j) in (-half..half).flat_map(|i| (-half..half).map(move |j| (i, j))) {
        let mesh = &mut colors[((i + j) & 1) as usize];
        let first = mesh.vertices.len() as u32;
        let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
        mesh.vertices.extend(corners.map(|(x, y)| rounded(Vec3::new(f64::from(x), f64::from(y), z))));
        mesh.faces.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    colors
}

fn rounded(v: Vec3) -> Vec3 {
    Vec3::new(to_f32(v.x), to_f32(v.y), to_f32(v.z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn the_knot_is_closed() {
        let mesh = knot(40, 8, 0.3);
        let mut edges = HashSet::new();
        for &[a, b, c] in &mesh.faces {
            for edge in [(a, b), (b, c), (c, a)] {
                assert!(edges.insert(edge), "an edge is passed twice in the same direction");
            }
        }
        assert_eq!(edges.len(), 3 * 2 * 40 * 8);
        assert!(edges.iter().all(|&(a, b)| edges.contains(&(b, a))), "an edge has one side only");
    }
}
