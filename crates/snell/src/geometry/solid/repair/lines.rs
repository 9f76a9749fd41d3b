//! Faces whose corners lie on a line.
//!
//! Such a face cannot just be removed: it closes the mesh where one side has an edge a-c and the other two edges a-b and b-c.
//! So the edge a-c is flipped: the face behind it, (a, c, d), is divided into (a, b, d) and (b, c, d), which meet the two
//! edges themselves.

use super::super::exact::{broadside, scaled};
use super::super::topology::{Kind, Topology, Use};
use crate::geometry::{NO_UVS, TriangleMesh, Vec3};
use std::collections::HashSet;

/// Rounds of flips. Each can free others; a line of faces without end is left as it is.
const ROUNDS: usize = 16;

/// Mends what can be mended; returns how many faces.
pub(super) fn mend(mesh: &mut TriangleMesh) -> usize {
    let points = scaled(&mesh.vertices);
    let mut mended = 0;
    for _ in 0..ROUNDS {
        let count = round(mesh, &points);
        mended += count;
        if count == 0 {
            break;
        }
    }
    mended
}

fn round(mesh: &mut TriangleMesh, points: &[Vec3]) -> usize {
    let is_line = |face: [u32; 3]| broadside(face.map(|v| points[v as usize])).is_none();
    let lines: Vec<u32> = (0u32..).zip(&mesh.faces).filter(|(_, face)| is_line(**face)).map(|(face, _)| face).collect();
    if lines.is_empty() {
        return 0;
    }
    let topology = Topology::of(mesh);
    let mut touched = vec![false; mesh.faces.len()];
    let mut drawn = HashSet::new();
    let mut count = 0;
    for line in lines.into_iter().filter(|&line| topology.kinds[line as usize] == Kind::Whole) {
        let face = mesh.faces[line as usize];
        // The long edge, from `a` to `c` as the face behind it passes it; `b` lies on it.
        let apart = |i: usize| {
            let d = points[face[i] as usize] - points[face[(i + 1) % 3] as usize];
            d.x.abs().max(d.y.abs()).max(d.z.abs())
        };
        let long = (0..3).max_by(|&i, &j| apart(i).total_cmp(&apart(j))).unwrap_or(0);
        let (c, a, b) = (face[long], face[(long + 1) % 3], face[(long + 2) % 3]);
        let faces = topology.edge([a, c]);
        let Some(behind) = faces.iter().map(|u| u.face).find(|&f| f != line).filter(|_| faces.len() == 2) else {
            continue;
        };
        let other = mesh.faces[behind as usize];
        let Some(at) = (0..3).find(|&i| other[i] == a && other[(i + 1) % 3] == c) else { continue };
        let d = other[(at + 2) % 3];
        let free = !touched[line as usize] && !touched[behind as usize];
        if !free || d == b || is_line(other) || !topology.edge([b, d]).is_empty() || !drawn.insert([b.min(d), b.max(d)])
        {
            continue;
        }
        // In this round the faces around must not change: their edges are looked up in what was before.
        for corner in [[a, c], [a, b], [b, c], [a, d], [c, d]] {
            topology.edge(corner).iter().for_each(|u: &Use| touched[u.face as usize] = true);
        }
        // On a line the longest components are in the ratio of the lengths.
        let (from_a, whole) = (apart((long + 1) % 3), apart(long));
        let way = if whole > 0.0 { from_a / whole } else { 0.0 };
        divide_uvs(mesh, line as usize, behind as usize, at, way);
        mesh.faces[line as usize] = [a, b, d];
        mesh.faces[behind as usize] = [b, c, d];
        if let [Some(&slot), Some(own)] = [mesh.face_slots.get(behind as usize), mesh.face_slots.get(line as usize)]
            && slot != *own
        {
            mesh.face_slots[line as usize] = slot;
        }
        count += 1;
    }
    count
}

/// The texture of the face behind goes on over both halves of it: between its corners `at` and the next, the new one lies
/// at this part of the way.
fn divide_uvs(mesh: &mut TriangleMesh, line: usize, behind: usize, at: usize, way: f64) {
    let Some(&numbers) = mesh.face_uvs.get(behind) else { return };
    if numbers == NO_UVS {
        mesh.face_uvs[line] = NO_UVS;
        return;
    }
    let [a, c, d] = [0, 1, 2].map(|i| numbers[(at + i) % 3]);
    let ([au, av], [cu, cv]) = (mesh.uvs[a as usize], mesh.uvs[c as usize]);
    let b = mesh.uvs.len() as u32;
    mesh.uvs.push([au * (1.0 - way) + cu * way, av * (1.0 - way) + cv * way]);
    mesh.face_uvs[line] = [a, b, d];
    mesh.face_uvs[behind] = [b, c, d];
}
