//! Vertices in one place become one.

use super::super::topology::{Topology, places};
use crate::geometry::{Bounds, TriangleMesh, Vec3};
use std::collections::HashMap;

/// Makes vertices at equal positions one; returns how many of those in use became one with another. They stay in the list,
/// unused.
pub(super) fn equal(mesh: &mut TriangleMesh) -> usize {
    let place = places(&mesh.vertices);
    join(mesh, &place)
}

/// Makes vertices one that lie on open edges and within a share of the diagonal of each other; returns how many. Where
/// vertices become one, edges do, and two open edges that become one are open no longer: nothing is opened by it.
pub(super) fn near(mesh: &mut TriangleMesh, share: f64) -> usize {
    let distance = share * Bounds::of(mesh.faces.iter().flatten().map(|&v| mesh.vertices[v as usize])).diagonal();
    if !(distance > 0.0 && distance.is_finite()) {
        return 0;
    }
    let topology = Topology::of(mesh);
    let mut rim: Vec<u32> = topology.open_edges().flat_map(|edge| edge[0].ends).collect();
    rim.sort_unstable();
    rim.dedup();
    let mut place: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
    send(&mesh.vertices, &rim, &mut place, distance);
    join(mesh, &place)
}

/// Puts the vertex at its place in the stead of each; returns how many of those in use became one with another.
fn join(mesh: &mut TriangleMesh, place: &[u32]) -> usize {
    let before = used(mesh);
    mesh.faces.iter_mut().flatten().for_each(|v| *v = place[*v as usize]);
    let count = |used: &[bool]| used.iter().filter(|used| **used).count();
    count(&before) - count(&used(mesh))
}

/// Sends each of some vertices to the lowest one within `distance` that is not sent away itself. Those that stay are farther
/// than that from each other, so a cell of a grid of this width holds only a few, and nothing moves a second time.
fn send(vertices: &[Vec3], some: &[u32], place: &mut [u32], distance: f64) {
    let cell = |v: Vec3| [v.x, v.y, v.z].map(|c| (c / distance).floor());
    let key = |cell: [f64; 3]| cell.map(|c| (c + 0.0).to_bits());
    let mut grid: HashMap<[u64; 3], Vec<u32>> = HashMap::new();
    for &vertex in some {
        let here = vertices[vertex as usize];
        let [x, y, z] = cell(here);
        let around =
            (0..27).map(|i| [x + f64::from(i % 3 - 1), y + f64::from(i / 3 % 3 - 1), z + f64::from(i / 9 - 1)]);
        let lowest = around
            .filter_map(|cell| grid.get(&key(cell)))
            .flatten()
            .filter(|&&other| (vertices[other as usize] - here).length() <= distance)
            .min();
        if let Some(&other) = lowest {
            place[vertex as usize] = other;
        } else {
            grid.entry(key([x, y, z])).or_default().push(vertex);
        }
    }
}

fn used(mesh: &TriangleMesh) -> Vec<bool> {
    let mut used = vec![false; mesh.vertices.len()];
    mesh.faces.iter().flatten().for_each(|&v| used[v as usize] = true);
    used
}

/// Removes the vertices that no face uses; returns how many.
pub(super) fn drop_unused(mesh: &mut TriangleMesh) -> usize {
    let used = used(mesh);
    let mut number = vec![0; used.len()];
    let mut next = 0;
    for (number, used) in number.iter_mut().zip(&used) {
        *number = next;
        next += u32::from(*used);
    }
    mesh.faces.iter_mut().flatten().for_each(|v| *v = number[*v as usize]);
    let mut which = used.iter();
    mesh.vertices.retain(|_| which.next().is_none_or(|&used| used));
    used.len() - next as usize
}
