//! Copies of faces, and faces that look the wrong way.

use super::super::Outline;
use super::super::parts::Parts;
use super::super::topology::Topology;
use super::keep;
use crate::geometry::TriangleMesh;
use std::collections::{HashMap, HashSet};

/// Removes copies of faces; returns how many.
///
/// A copy that looks the same way is one too many. One that looks the other way may be one too many (every face given for
/// both of its sides) or the wall of a second solid that touches the first. And copies may be what closes other faces, as
/// where a mesh has been folded together. So what is done leaves as few edges open as can be; then, as few with more than
/// two faces. It is decided for the copies that hang together over edges, as what is right in one place need not be so in
/// another.
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
    // Of each place the first face in each sense is no copy of its sense.
    let mut seen: HashSet<(u32, bool)> = copies.iter().map(|&(_, first)| (first, sense(first))).collect();
    let copies: HashMap<u32, Duplicate> = copies
        .iter()
        .map(|&(face, first)| (face, Duplicate { first, in_sense: !seen.insert((first, sense(face))) }))
        .collect();
    let mut patches = Parts::new(mesh.faces.len());
    for (&face, copy) in &copies {
        patches.join(face, copy.first, false);
    }
    for edge in topology.edges() {
        let mut doubled = edge.iter().map(|u| u.face).filter(|face| copies.contains_key(face));
        if let Some(first) = doubled.next() {
            doubled.for_each(|face| patches.join(face, first, false));
        }
    }
    // What each choice leaves of open and crowded edges.
    let mut costs: HashMap<u32, [(usize, usize); 3]> = HashMap::new();
    for edge in topology.edges() {
        let Some(doubled) = edge.iter().find(|u| copies.contains_key(&u.face)) else { continue };
        let costs = costs.entry(patches.find(doubled.face).0).or_default();
        for (choice, (open, crowded)) in CHOICES.into_iter().zip(costs) {
            let faces = edge.iter().filter(|u| copies.get(&u.face).is_none_or(|&copy| !choice(copy))).count();
            *open += faces % 2;
            *crowded += usize::from(faces > 2);
        }
    }
    let gone: HashSet<u32> = copies
        .iter()
        .filter(|&(&face, &copy)| {
            let costs = costs[&patches.find(face).0];
            let best = (0..CHOICES.len()).min_by_key(|&i| costs[i]).unwrap_or(0);
            CHOICES[best](copy)
        })
        .map(|(&face, _)| face)
        .collect();
    keep(mesh, |face| !gone.contains(&(face as u32)))
}

/// A face in the place of an earlier one.
#[derive(Clone, Copy)]
struct Duplicate {
    /// The first face there.
    first: u32,
    /// Does an earlier one there look the same way?
    in_sense: bool,
}

/// Is a copy to go? The earlier choice is taken where they are equally good.
const CHOICES: [fn(Duplicate) -> bool; 3] = [|copy| copy.in_sense, |_| true, |_| false];

/// Turns faces so that neighbours agree, the fewer ones of each component that can be; returns how many.
pub(super) fn agree(mesh: &mut TriangleMesh) -> usize {
    let turned = Outline::of(mesh).turned;
    for &face in &turned {
        mesh.turn(face as usize);
    }
    turned.len()
}
