//! Filling small holes.
//!
//! A hole is a loop of edges with one face each. It is filled with the triangles that together are smallest (Barequet and
//! Sharir 1995, "Filling gaps in the boundary of a polyhedron"), which in a plane is the polygon itself. What is filled
//! must not become something else: a loop around a lone sheet is its rim and no hole, an edge that is there already must not
//! get a third face, and nothing may be in the way.

use super::super::crossing::{Shapes, with_area};
use super::super::topology::Topology;
use super::super::{Outline, Report};
use super::RepairLog;
use crate::geometry::{NO_UVS, TriangleMesh, Vec3};
use std::collections::{BTreeMap, HashMap, HashSet};

/// Filling a loop of n edges takes n³/6 steps. When so many are spent, the remaining holes stay.
const STEPS: u64 = 500_000_000;

/// A component that encloses less than this share of what its faces sweep is a sheet with two sides, no solid.
const FLAT: f64 = 1e-9;

/// An edge with one face, in the direction in which a face that fills the hole passes it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Rim {
    from: u32,
    to: u32,
    face: u32,
}

/// Fills holes of at most `largest` edges.
pub(super) fn fill(mesh: &mut TriangleMesh, largest: usize) -> RepairLog {
    let Outline { topology, report, points, with_area: faces, .. } = Outline::of(mesh);
    if report.boundary.is_empty() || largest == 0 {
        return RepairLog::default();
    }
    let component = |rim: &Rim| report.component_of[rim.face as usize];
    let mut rims: Vec<Rim> = topology
        .edges()
        .filter_map(|edge| if let [only] = edge { Some(only) } else { None })
        .map(|u| {
            let [from, to] = if u.forward { [u.ends[1], u.ends[0]] } else { u.ends };
            Rim { from, to, face: u.face }
        })
        .filter(|rim| report.components[component(rim) as usize].is_oriented())
        .collect();
    rims.sort_unstable();

    let mut patches: Vec<Patch> = Vec::new();
    let mut new_edges = HashSet::new();
    let mut steps = STEPS;
    for rim in loops(&rims, mesh.vertices.len()) {
        let part = component(&rim[0]);
        let cost = (rim.len() as u64).pow(3) / 6;
        let one = rim.iter().all(|r| component(r) == part);
        // The rim of a sheet is as long as it is wide: no more faces than there are.
        if one && rim.len() <= largest && rim.len() - 2 < report.components[part as usize].faces && cost <= steps {
            steps -= cost;
            if let Some(faces) = triangulate(&rim, mesh, &topology, &mut new_edges) {
                patches.push(Patch { part, slot: rim[0].face, edges: rim.len(), faces });
            }
        }
    }
    let count = patches.len();
    let patches = unobstructed(patches, topology.corners, faces, &points);
    let obstructed_holes = count - patches.len();
    let mut chosen: BTreeMap<u32, Vec<Patch>> = BTreeMap::new();
    for patch in patches {
        chosen.entry(patch.part).or_default().push(patch);
    }
    let closed: HashMap<u32, (f64, f64)> = enclosed(mesh, &report, &chosen);
    let (mut holes, before) = (0, mesh.faces.len());
    for (_, patches) in
        chosen.iter().filter(|(part, _)| closed.get(part).is_none_or(|(sum, size)| sum.abs() > FLAT * size))
    {
        for patch in patches {
            holes += 1;
            mesh.faces.extend(&patch.faces);
            if let Some(&slot) = mesh.face_slots.get(patch.slot as usize) {
                mesh.face_slots.extend(patch.faces.iter().map(|_| slot));
            }
            if !mesh.face_uvs.is_empty() {
                // Nobody painted what was not there.
                mesh.face_uvs.resize(mesh.faces.len(), NO_UVS);
            }
        }
    }
    RepairLog { filled_holes: holes, new_faces: mesh.faces.len() - before, obstructed_holes, ..RepairLog::default() }
}

/// The patches that meet nothing but what is around their holes. Slivers there may well be folded onto what is beside them,
/// as in a crack along an edge that has a vertex near it.
fn unobstructed(patches: Vec<Patch>, mut corners: Vec<[u32; 3]>, mut faces: Vec<u32>, points: &[Vec3]) -> Vec<Patch> {
    let mut number = |patch: &Patch| {
        let first = corners.len() as u32;
        corners.extend(&patch.faces);
        (first..corners.len() as u32).collect()
    };
    let numbers: Vec<Vec<u32>> = patches.iter().map(&mut number).collect();
    faces.extend(with_area(numbers.iter().flatten().copied(), points, &corners).0);
    let obstructed = Shapes::new(points, &corners, faces).obstructed(&numbers);
    patches.into_iter().zip(obstructed).filter(|(_, obstructed)| !obstructed).map(|(patch, _)| patch).collect()
}

/// What fills one hole.
struct Patch {
    /// The component that it is a hole of.
    part: u32,
    /// The face whose slot the new ones get.
    slot: u32,
    edges: usize,
    faces: Vec<[u32; 3]>,
}

/// For each component that its patches close, its signed volume and the sum of the unsigned parts of it.
fn enclosed(mesh: &TriangleMesh, report: &Report, chosen: &BTreeMap<u32, Vec<Patch>>) -> HashMap<u32, (f64, f64)> {
    let mut sums: HashMap<u32, (f64, f64)> = chosen
        .iter()
        .filter(|(part, patches)| {
            patches.iter().map(|p| p.edges).sum::<usize>() == report.components[**part as usize].open_edges
        })
        .map(|(part, _)| (*part, (0.0, 0.0)))
        .collect();
    let mut add = |part: u32, face: [u32; 3]| {
        if let Some((sum, size)) = sums.get_mut(&part) {
            let near = report.components[part as usize].bounds.min;
            let [a, b, c] = face.map(|v| mesh.vertices[v as usize] - near);
            let six = a.dot(b.cross(c));
            (*sum, *size) = (*sum + six, *size + six.abs());
        }
    };
    for (&face, &part) in mesh.faces.iter().zip(&report.component_of) {
        add(part, face);
    }
    for (part, patches) in chosen {
        patches.iter().flat_map(|p| &p.faces).for_each(|&face| add(*part, face));
    }
    sums
}

/// Simple loops of rims. Where holes touch in a vertex, a loop is cut off as soon as it comes back to one of its own.
fn loops(rims: &[Rim], vertices: usize) -> Vec<Vec<Rim>> {
    const NOWHERE: u32 = u32::MAX;
    let mut used = vec![false; rims.len()];
    // For each vertex the first rim from it that may not be used yet.
    let mut next: HashMap<u32, usize> = HashMap::new();
    for (i, rim) in rims.iter().enumerate() {
        next.entry(rim.from).or_insert(i);
    }
    // Where on the path a vertex is left.
    let mut on_path = vec![NOWHERE; vertices];
    let mut found = Vec::new();
    for start in 0..rims.len() {
        let mut path: Vec<Rim> = Vec::new();
        let mut candidate = (!used[start]).then_some(start);
        while let Some(i) = candidate {
            used[i] = true;
            on_path[rims[i].from as usize] = path.len() as u32;
            path.push(rims[i]);
            let at = rims[i].to;
            let back = on_path[at as usize];
            if back != NOWHERE {
                let ring = path.split_off(back as usize);
                for r in &ring {
                    on_path[r.from as usize] = NOWHERE;
                }
                found.push(ring);
                if path.is_empty() {
                    break;
                }
            }
            candidate = next.get_mut(&at).and_then(|i| {
                while rims.get(*i).is_some_and(|r| r.from == at) && used[*i] {
                    *i += 1;
                }
                rims.get(*i).filter(|r| r.from == at).map(|_| *i)
            });
        }
        for r in &path {
            on_path[r.from as usize] = NOWHERE;
        }
    }
    found
}

/// The triangles between the vertices of a loop, smallest in sum; `None` where every way would use an edge that is there.
fn triangulate(
    rim: &[Rim],
    mesh: &TriangleMesh,
    topology: &Topology,
    new_edges: &mut HashSet<[u32; 2]>,
) -> Option<Vec<[u32; 3]>> {
    let n = rim.len();
    // Around one face: filled, it would be that face's other side.
    if n < 3 || rim.iter().all(|r| r.face == rim[0].face) {
        return None;
    }
    let corner: Vec<u32> = rim.iter().map(|r| r.from).collect();
    let point: Vec<Vec3> = corner.iter().map(|&v| mesh.vertices[v as usize]).collect();
    let key = |i: usize, j: usize| [corner[i].min(corner[j]), corner[i].max(corner[j])];
    let free = |i: usize, j: usize| {
        let side = j == i + 1 || (i == 0 && j == n - 1);
        side || (topology.edge(key(i, j)).is_empty() && !new_edges.contains(&key(i, j)))
    };
    // Smallest cost of the part of the loop from i to j, and where its triangle at i-j has its tip.
    let mut best = vec![(0.0, 0u32); n * n];
    for length in 2..n {
        for i in 0..n - length {
            let j = i + length;
            best[i * n + j] = (f64::INFINITY, 0);
            if !free(i, j) {
                continue;
            }
            let base = point[j] - point[i];
            for k in i + 1..j {
                let (p, q) = (point[k] - point[i], point[k] - point[j]);
                // In a plane all ways to fill a convex hole are equally large; a little weight on the sides avoids slivers.
                let size = base.cross(p).length() + 1e-6 * (base.dot(base) + p.dot(p) + q.dot(q));
                let cost = best[i * n + k].0 + best[k * n + j].0 + size;
                if cost < best[i * n + j].0 {
                    best[i * n + j] = (cost, k as u32);
                }
            }
        }
    }
    if !best[n - 1].0.is_finite() {
        return None;
    }
    let (mut faces, mut open) = (Vec::with_capacity(n - 2), vec![(0, n - 1)]);
    while let Some((i, j)) = open.pop() {
        if j < i + 2 {
            continue;
        }
        let k = best[i * n + j].1 as usize;
        faces.push([corner[i], corner[k], corner[j]]);
        open.extend([(i, k), (k, j)]);
    }
    for &[a, b, c] in &faces {
        new_edges.extend([[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)]));
    }
    Some(faces)
}
