//! Faces that meet where they should not, and shells that lie in others.

use super::exact::{
    broadside, folded, plainly_apart, plainly_apart_elsewhere, segment_meets, side, sign, triangles_meet, turn,
};
use super::report::{Crossing, Found};
use super::tree::{Budget, Tree};
use crate::geometry::{Bounds, Vec3};
use std::collections::HashSet;

/// Steps of the search for crossings, for each face. Usual meshes need about 80.
const CROSSING_STEPS: u64 = 400;

/// Steps of the search for cavities: for each face enough to look at all faces of the mesh some times over.
const CAVITY_STEPS: u64 = 50;

/// Steps of a search in any mesh: enough for two fans of a thousand faces, all pairs of which meet in a vertex.
const LEAST_STEPS: u64 = 30_000_000;

/// Steps that a look at two faces counts for.
const LOOK: u64 = 5;

/// Steps that an exact look counts for besides: microseconds where they are in one plane.
const EXACT_LOOK: u64 = 50;

fn budget(faces: usize, each: u64) -> Budget {
    Budget(LEAST_STEPS + each * faces as u64)
}

/// Faces by their places, for questions about where they meet.
pub(super) struct Shapes<'a> {
    /// Positions, scaled so that exact answers are exact.
    points: &'a [Vec3],
    corners: &'a [[u32; 3]],
    boxes: Vec<Bounds>,
    tree: Tree,
}

impl<'a> Shapes<'a> {
    /// The faces of `chosen`, which have area.
    pub fn new(points: &'a [Vec3], corners: &'a [[u32; 3]], chosen: Vec<u32>) -> Self {
        let mut boxes = vec![Bounds::EMPTY; corners.len()];
        for &face in &chosen {
            boxes[face as usize] = Bounds::of(corners[face as usize].map(|v| points[v as usize]));
        }
        let tree = Tree::over(chosen, &boxes);
        Self { points, corners, boxes, tree }
    }

    fn at(&self, face: u32) -> [Vec3; 3] {
        self.corners[face as usize].map(|v| self.points[v as usize])
    }

    /// Pairs of faces that meet in more than they share, and whether all were looked at. Places in the units of `points`.
    pub fn crossings(&self) -> (Found<Crossing>, bool) {
        let mut budget = budget(self.corners.len(), CROSSING_STEPS);
        let mut found = Found::default();
        self.tree.pairs(&self.boxes, &mut budget, &mut |f, g, budget| {
            if budget.take(LOOK) && self.cross(f, g, budget) {
                let (a, b) = (&self.boxes[f as usize], &self.boxes[g as usize]);
                found.add(|| Crossing { faces: [f, g], at: middle_of_both(a, b) });
            }
        });
        (found, budget.0 > 0)
    }

    fn cross(&self, f: u32, g: u32, budget: &mut Budget) -> bool {
        let (s, t) = (self.corners[f as usize], self.corners[g as usize]);
        let point = |v: u32| self.points[v as usize];
        let shared = s.map(|v| t.iter().position(|&w| w == v));
        match shared {
            [None, None, None] => {
                let (s, t) = (self.at(f), self.at(g));
                !plainly_apart(s, t) && budget.take(EXACT_LOOK) && triangles_meet(s, t)
            }
            [Some(j), None, None] => self.meet_elsewhere((f, 0), (g, j), budget),
            [None, Some(j), None] => self.meet_elsewhere((f, 1), (g, j), budget),
            [None, None, Some(j)] => self.meet_elsewhere((f, 2), (g, j), budget),
            // One edge: they meet elsewhere only if one is folded onto the other.
            [None, Some(i), Some(j)] => folded(point(s[1]), point(s[2]), point(s[0]), point(t[3 - i - j])),
            [Some(i), None, Some(j)] => folded(point(s[2]), point(s[0]), point(s[1]), point(t[3 - i - j])),
            [Some(i), Some(j), None] => folded(point(s[0]), point(s[1]), point(s[2]), point(t[3 - i - j])),
            // The same triangle: a duplicate, which is said elsewhere.
            [Some(_), Some(_), Some(_)] => false,
        }
    }

    /// Do two faces that share one vertex, each given with its number there, have another point in common?
    fn meet_elsewhere(&self, (f, i): (u32, usize), (g, j): (u32, usize), budget: &mut Budget) -> bool {
        let (mut s, mut t) = (self.at(f), self.at(g));
        s.rotate_left(i);
        t.rotate_left(j);
        // They do if the edge across from the vertex meets the other triangle.
        !plainly_apart_elsewhere(s, t)
            && budget.take(EXACT_LOOK)
            && (segment_meets(s[1], s[2], t) || segment_meets(t[1], t[2], s))
    }

    /// Which of some patches of faces meet a face that has no vertex in common with them. Where the work is too much, what was
    /// not looked at counts as not met.
    pub fn obstructed(&self, patches: &[Vec<u32>]) -> Vec<bool> {
        let mut budget = budget(self.corners.len(), CROSSING_STEPS);
        let meets = |patch: &Vec<u32>| {
            let own: HashSet<u32> = patch.iter().flat_map(|&face| self.corners[face as usize]).collect();
            let mut meets = false;
            for &face in patch {
                let (mut near, bounds) = (Vec::new(), &self.boxes[face as usize]);
                self.tree.touching(&self.boxes, bounds, &mut budget, &mut |other| near.push(other));
                near.retain(|&other| !self.corners[other as usize].iter().any(|v| own.contains(v)));
                meets |=
                    near.iter().any(|&other| budget.take(EXACT_LOOK) && triangles_meet(self.at(face), self.at(other)));
            }
            meets
        };
        patches.iter().map(meets).collect()
    }

    /// How often the faces that `counts` wind around each of some points: 1 within a solid that looks outward. `None` where
    /// the work was too much.
    pub fn windings(&self, points: &[(u32, Vec3)], counts: impl Fn(u32, u32) -> bool) -> Vec<Option<i32>> {
        let mut budget = budget(self.corners.len(), CAVITY_STEPS);
        points
            .iter()
            .map(|&(part, p)| {
                let mut winding = 0;
                let along_x = Bounds { min: p, max: Vec3::new(f64::INFINITY, p.y, p.z) };
                self.tree.touching(&self.boxes, &along_x, &mut budget, &mut |face| {
                    if counts(part, face) {
                        winding += self.passes(face, p);
                    }
                });
                (budget.0 > 0).then_some(winding)
            })
            .collect()
    }

    /// Does the line from `p` along x pass the face, outward (1) or inward (−1)? Seen along x, a point on an edge belongs
    /// to one of its two faces (half-open intervals, as in Sunday 2001, "Inclusion of a point in a polygon").
    fn passes(&self, face: u32, p: Vec3) -> i32 {
        let t = self.at(face);
        let mut around = 0;
        for i in 0..3 {
            let (a, b) = (t[i], t[(i + 1) % 3]);
            if (a.z <= p.z) != (b.z <= p.z) {
                let up = if a.z <= p.z { 1 } else { -1 };
                around += i32::from(turn(0, a, b, p) * up > 0) * up;
            }
        }
        // Behind p, as seen along x, the side that the normal points away from is the far one.
        if around != 0 && side(t, p) == sign(f64::from(around)) { around } else { 0 }
    }
}

/// Faces with area, of some.
pub(super) fn with_area(
    faces: impl Iterator<Item = u32>,
    points: &[Vec3],
    corners: &[[u32; 3]],
) -> (Vec<u32>, Vec<u32>) {
    faces.partition(|&face| broadside(corners[face as usize].map(|v| points[v as usize])).is_some())
}

fn middle_of_both(a: &Bounds, b: &Bounds) -> Vec3 {
    let low = Vec3::new(a.min.x.max(b.min.x), a.min.y.max(b.min.y), a.min.z.max(b.min.z));
    let high = Vec3::new(a.max.x.min(b.max.x), a.max.y.min(b.max.y), a.max.z.min(b.max.z));
    (low + high) * 0.5
}
