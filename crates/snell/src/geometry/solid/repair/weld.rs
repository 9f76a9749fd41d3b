//! Vertices in one place become one.

use super::super::topology::places;
use crate::geometry::{Bounds, TriangleMesh, Vec3};
use std::collections::HashMap;

/// Makes vertices at equal positions one, and those within a share of the diagonal; returns how many of those in use became
/// one with another. They stay in the list, unused.
pub(super) fn weld(mesh: &mut TriangleMesh, share: f64) -> usize {
    let mut place = places(&mesh.vertices);
    let used = used(mesh);
    if share > 0.0 {
        let in_use = mesh.vertices.iter().zip(&used).filter(|(_, used)| **used).map(|(v, _)| *v);
        let distance = share * Bounds::of(in_use).diagonal();
        near(&mesh.vertices, &used, &mut place, distance);
    }
    mesh.faces.iter_mut().flatten().for_each(|v| *v = place[*v as usize]);
    let moved = |(vertex, used): (usize, &bool)| *used && place[vertex] as usize != vertex;
    let welded = used.iter().enumerate().filter(|one| moved(*one)).count();
    // The lowest vertex of a place need not have been in use before.
    let fresh = used.iter().zip(self::used(mesh)).filter(|(before, after)| !**before && *after).count();
    welded - fresh.min(welded)
}

/// Sends each place to the lowest one within `distance` that is not sent away itself. Those that stay are farther than that
/// from each other, so a cell of a grid of this width holds only a few, and nothing moves a second time.
fn near(vertices: &[Vec3], used: &[bool], place: &mut [u32], distance: f64) {
    if !(distance > 0.0 && distance.is_finite()) {
        return;
    }
    let cell = |v: Vec3| [v.x, v.y, v.z].map(|c| (c / distance).floor());
    let key = |cell: [f64; 3]| cell.map(|c| (c + 0.0).to_bits());
    let mut grid: HashMap<[u64; 3], Vec<u32>> = HashMap::new();
    for vertex in 0..vertices.len() {
        let at = place[vertex] as usize;
        if at != vertex {
            place[vertex] = place[at];
            continue;
        }
        let here = vertices[vertex];
        if !used[vertex] && !here.is_finite() {
            continue;
        }
        let [x, y, z] = cell(here);
        let around =
            (0..27).map(|i| [x + f64::from(i % 3 - 1), y + f64::from(i / 3 % 3 - 1), z + f64::from(i / 9 - 1)]);
        let lowest = around
            .filter_map(|cell| grid.get(&key(cell)))
            .flatten()
            .filter(|&&other| (vertices[other as usize] - here).length() <= distance)
            .min();
        if let Some(&other) = lowest {
            place[vertex] = other;
        } else {
            grid.entry(key([x, y, z])).or_default().push(vertex as u32);
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
