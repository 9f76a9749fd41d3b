//! A convex polyhedron from the half-spaces that it is the intersection of.

use snell::geometry::{TriangleMesh, Vec3};

/// A half-space: the points `p` with `normal · p ≤ offset`.
#[derive(Clone, Copy, Debug)]
pub struct HalfSpace {
    /// Outward, of unit length.
    pub normal: Vec3,
    /// Distance of its plane from the origin, along `normal`.
    pub offset: f64,
}

impl HalfSpace {
    /// How far outside a point lies; negative inside.
    pub fn distance(&self, p: Vec3) -> f64 {
        self.normal.dot(p) - self.offset
    }
}

/// Vertices and the facets that share them.
#[derive(Clone, Debug)]
pub struct Polyhedron {
    /// Where three or more planes meet.
    pub vertices: Vec<Vec3>,
    /// For each half-space its corners, counter-clockwise seen from outside; fewer than three where the others hide it.
    pub facets: Vec<Vec<u32>>,
}

/// Points nearer than this are one, and so are a point and a plane. Made for solids of about unit size whose edges are much
/// longer.
const SAME: f64 = 1e-9;

/// Three unit normals with a smaller determinant do not fix a point: its error is a few times ε/det, here 1e-9 at most.
const LEAST_DETERMINANT: f64 = 1e-6;

/// The intersection of half-spaces, by trying all threes of planes: for solids of a hundred facets or so.
pub fn polyhedron(sides: &[HalfSpace]) -> Polyhedron {
    let mut found: Vec<(f64, Vec3)> = Vec::new();
    for (i, a) in sides.iter().enumerate() {
        for (j, b) in sides.iter().enumerate().skip(i + 1) {
            for c in &sides[j + 1..] {
                let Some((determinant, point)) = meet(a, b, c) else { continue };
                if sides.iter().any(|side| side.distance(point) > SAME) {
                    continue;
                }
                // Where more than three planes meet, the three that fix the point best say where.
                match found.iter_mut().find(|(_, other)| (*other - point).length() < SAME) {
                    Some(best) if best.0 >= determinant => {}
                    Some(best) => *best = (determinant, point),
                    None => found.push((determinant, point)),
                }
            }
        }
    }
    let vertices: Vec<Vec3> = found.into_iter().map(|(_, point)| point).collect();
    let facets = sides.iter().map(|side| around(side, &vertices)).collect();
    Polyhedron { vertices, facets }
}

/// The point in three planes, and the determinant of their normals, positive: Cramer's rule.
fn meet(a: &HalfSpace, b: &HalfSpace, c: &HalfSpace) -> Option<(f64, Vec3)> {
    let (bc, ca, ab) = (b.normal.cross(c.normal), c.normal.cross(a.normal), a.normal.cross(b.normal));
    let determinant = a.normal.dot(bc);
    let point = (bc * a.offset + ca * b.offset + ab * c.offset) * (1.0 / determinant);
    (determinant.abs() > LEAST_DETERMINANT).then_some((determinant.abs(), point))
}

/// The vertices in a side's plane, in order: from each the next is the one that has all others on its left (Jarvis's march).
fn around(side: &HalfSpace, vertices: &[Vec3]) -> Vec<u32> {
    let at = |v: u32| vertices[v as usize];
    let all: Vec<u32> = (0..vertices.len() as u32).filter(|&v| side.distance(at(v)).abs() < SAME).collect();
    let mut facet: Vec<u32> = all.first().copied().into_iter().collect();
    while facet.len() < all.len() {
        let last = facet[facet.len() - 1];
        let left = |a: u32, b: u32| side.normal.dot((at(a) - at(last)).cross(at(b) - at(last))) > 0.0;
        let others = all.iter().copied().filter(|&v| v != last);
        facet.extend(others.reduce(|a, b| if left(a, b) { a } else { b }));
    }
    facet
}

impl Polyhedron {
    /// Its facets as fans of triangles. Each starts at the corner that is farthest from the facet's middle: from others
    /// there would be slivers.
    pub fn mesh(&self) -> TriangleMesh {
        let at = |v: u32| self.vertices[v as usize];
        let mut faces = Vec::new();
        for facet in self.facets.iter().filter(|facet| facet.len() >= 3) {
            let middle = facet.iter().fold(Vec3::default(), |sum, &v| sum + at(v)) * (1.0 / facet.len() as f64);
            let distance = |&i: &usize| (at(facet[i]) - middle).length();
            let first = (0..facet.len()).max_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap();
            let corner = |i: usize| facet[(first + i) % facet.len()];
            faces.extend((1..facet.len() - 1).map(|i| [corner(0), corner(i), corner(i + 1)]));
        }
        TriangleMesh { vertices: self.vertices.clone(), faces, ..TriangleMesh::default() }
    }
}
