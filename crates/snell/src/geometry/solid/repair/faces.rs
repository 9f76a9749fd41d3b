//! Copies of faces, and faces that look the wrong way.

use super::super::Outline;
use super::super::topology::Topology;
use super::keep;
use crate::geometry::TriangleMesh;
use std::collections::HashSet;

/// Removes copies of faces; returns how many.
///
/// A copy that looks the same way is one too many. One that looks the other way may be one too many (every face given for
/// both of its sides) or the wall of a second solid that touches the first. What leaves fewer edges open decides; then, what
/// leaves fewer edges with more than two faces.
pub(super) fn remove_copies(mesh: &mut TriangleMesh) -> usize {
    let topology = Topology::of(mesh);
    let copies = topology.duplicates();
    if copies.is_empty() {
        return 0;
    }
    let sense = |face: u32| {
        let [a, b, c] = topology.corners[face as usize];
        // Whether the lowest corner is followed by the next higher one.
        (a < b) ^ (b < c) ^ (c < a)
    };
    // Of each place the first face in each sense stays.
    let mut seen: HashSet<(u32, bool)> = copies.iter().map(|&(_, first)| (first, sense(first))).collect();
    let again: HashSet<u32> =
        copies.iter().filter(|&&(face, first)| !seen.insert((first, sense(face)))).map(|copy| copy.0).collect();
    let any: HashSet<u32> = copies.iter().map(|copy| copy.0).collect();
    let cost = |gone: &HashSet<u32>| {
        let (mut open, mut crowded) = (0, 0);
        for edge in topology.edges() {
            let faces = edge.iter().filter(|u| !gone.contains(&u.face)).count();
            open += faces % 2;
            crowded += usize::from(faces > 2);
        }
        (open, crowded)
    };
    let gone = if cost(&any) < cost(&again) { any } else { again };
    keep(mesh, |face| !gone.contains(&(face as u32)))
}

/// Turns faces so that neighbours agree, the fewer ones of each component that can be; returns how many.
pub(super) fn agree(mesh: &mut TriangleMesh) -> usize {
    let turned = Outline::of(mesh).turned;
    for &face in &turned {
        mesh.turn(face as usize);
    }
    turned.len()
}
