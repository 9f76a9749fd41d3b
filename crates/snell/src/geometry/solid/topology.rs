//! What touches what: vertices by position, edges with their faces, and the components that edges join.

use super::around;
use super::parts::Parts;
use super::report::NO_COMPONENT;
use crate::geometry::{TriangleMesh, Vec3};

/// One face at one of its edges. In order: all faces of an edge stand together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Use {
    /// The ends of the edge.
    pub ends: [u32; 2],
    pub face: u32,
    /// Does the face pass from the first end to the second?
    pub forward: bool,
}

/// What a face is good for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Three places.
    Whole,
    /// Two corners in one place: it has no part in any surface.
    Void,
    /// A vertex that is not there or not finite.
    Broken,
}

/// A mesh by its places.
#[derive(Debug)]
pub(super) struct Topology {
    /// The corners of each face, every place by the lowest vertex in it.
    pub corners: Vec<[u32; 3]>,
    pub kinds: Vec<Kind>,
    /// All edges, sorted.
    pub uses: Vec<Use>,
}

impl Topology {
    pub fn of(mesh: &TriangleMesh) -> Self {
        let place = places(&mesh.vertices);
        let kind = |face: &[u32; 3]| match face.map(|v| mesh.vertices.get(v as usize).copied()) {
            [Some(a), Some(b), Some(c)] if a.is_finite() && b.is_finite() && c.is_finite() => {
                let [a, b, c] = face.map(|v| place[v as usize]);
                if a == b || b == c || c == a { Kind::Void } else { Kind::Whole }
            }
            _ => Kind::Broken,
        };
        let kinds: Vec<Kind> = mesh.faces.iter().map(kind).collect();
        let at = |(face, kind): (&[u32; 3], &Kind)| match kind {
            Kind::Broken => *face,
            _ => face.map(|v| place[v as usize]),
        };
        let corners: Vec<[u32; 3]> = mesh.faces.iter().zip(&kinds).map(at).collect();
        let mut uses: Vec<Use> = (0u32..)
            .zip(&corners)
            .zip(&kinds)
            .filter(|(_, kind)| **kind == Kind::Whole)
            .flat_map(|((face, &[a, b, c]), _)| [[a, b], [b, c], [c, a]].map(|[from, to]| edge(from, to, face)))
            .collect();
        uses.sort_unstable();
        Self { corners, kinds, uses }
    }

    /// The faces of each edge.
    pub fn edges(&self) -> impl Iterator<Item = &[Use]> {
        self.uses.chunk_by(|a, b| a.ends == b.ends)
    }

    /// The faces of each edge that has an odd number of them.
    pub fn open_edges(&self) -> impl Iterator<Item = &[Use]> {
        self.edges().filter(|edge| edge.len() % 2 == 1)
    }

    /// The faces of one edge, given by its ends.
    pub fn edge(&self, [a, b]: [u32; 2]) -> &[Use] {
        let ends = [a.min(b), a.max(b)];
        let start = self.uses.partition_point(|u| u.ends < ends);
        let count = self.uses[start..].partition_point(|u| u.ends == ends);
        &self.uses[start..start + count]
    }

    /// The whole faces, by number.
    pub fn whole(&self) -> impl Iterator<Item = u32> {
        (0u32..).zip(&self.kinds).filter(|(_, kind)| **kind == Kind::Whole).map(|(face, _)| face)
    }

    /// Joins faces over edges. `points` are the positions of the vertices.
    ///
    /// An edge with two faces joins them. At an edge with more, those are joined between which a solid lies: two cubes that
    /// share an edge or a wall are two solids. Where that cannot be said, parts that have an even number of faces there
    /// are closed by themselves and stay apart; those with an odd number are joined.
    pub fn parts(&self, points: &[Vec3]) -> Parts {
        let mut parts = Parts::new(self.corners.len());
        let mut unclear = Vec::new();
        for edge in self.edges() {
            match edge {
                [_] => {}
                [a, b] => parts.join(a.face, b.face, a.forward == b.forward),
                _ => match around::pairs(edge, &self.corners, points) {
                    Some(pairs) => pairs.iter().for_each(|(a, b)| parts.join(a.face, b.face, false)),
                    None => unclear.push(edge),
                },
            }
        }
        for edge in unclear {
            join_odd(&mut parts, edge);
        }
        parts
    }

    /// For each face its component, numbered by their first faces, and how many there are.
    pub fn components(&self, parts: &mut Parts) -> (Vec<u32>, usize) {
        let mut number = vec![NO_COMPONENT; self.corners.len()];
        let mut component_of = number.clone();
        let mut count = 0;
        for face in self.whole() {
            let (part, _) = parts.find(face);
            let known = &mut number[part as usize];
            if *known == NO_COMPONENT {
                *known = count;
                count += 1;
            }
            component_of[face as usize] = *known;
        }
        (component_of, count as usize)
    }

    /// Faces with the same three places as one before them, each with the first of these.
    pub fn duplicates(&self) -> Vec<(u32, u32)> {
        let mut keys: Vec<([u32; 3], u32)> = self
            .whole()
            .map(|face| {
                let mut key = self.corners[face as usize];
                key.sort_unstable();
                (key, face)
            })
            .collect();
        keys.sort_unstable();
        let mut found: Vec<(u32, u32)> = keys
            .chunk_by(|a, b| a.0 == b.0)
            .flat_map(|same| same[1..].iter().map(|&(_, face)| (face, same[0].1)))
            .collect();
        found.sort_unstable();
        found
    }
}

/// Joins the parts that have an odd number of faces at an edge.
fn join_odd(parts: &mut Parts, edge: &[Use]) {
    let sense = |u: &Use| {
        let (part, turned) = parts.find(u.face);
        (part, u.face, if u.forward == turned { -1 } else { 1 })
    };
    let mut there: Vec<(u32, u32, i64)> = edge.iter().map(sense).collect();
    there.sort_unstable();
    let odd: Vec<(u32, i64)> = there
        .chunk_by(|a, b| a.0 == b.0)
        .filter(|part| part.len() % 2 == 1)
        .map(|part| (part[0].0, part.iter().map(|p| p.2).sum()))
        .collect();
    match odd[..] {
        [(a, sum), (b, other)] => parts.join(a, b, sum == other),
        [(first, _), ref others @ ..] => others.iter().for_each(|&(other, _)| parts.join(first, other, false)),
        [] => {}
    }
}

fn edge(from: u32, to: u32, face: u32) -> Use {
    Use { ends: [from.min(to), from.max(to)], face, forward: from < to }
}

/// For each vertex the lowest vertex at its position. −0.0 and 0.0 are one position.
pub(super) fn places(vertices: &[Vec3]) -> Vec<u32> {
    let key = |v: &Vec3| [v.x, v.y, v.z].map(|c| (c + 0.0).to_bits());
    let mut sorted: Vec<([u64; 3], u32)> = vertices.iter().map(key).zip(0..).collect();
    sorted.sort_unstable();
    let mut place = vec![0; vertices.len()];
    for same in sorted.chunk_by(|a, b| a.0 == b.0) {
        for &(_, vertex) in same {
            place[vertex as usize] = same[0].1;
        }
    }
    place
}
