//! Polygons as triangles.

use snell::geometry::Vec3;
use std::collections::HashMap;

/// Triangulates polygons; keeps its memory from one to the next.
pub(crate) struct Polygons(earcut::Earcut<f64>);

impl Default for Polygons {
    fn default() -> Self {
        Self(earcut::Earcut::new())
    }
}

impl Polygons {
    /// The triangles of a polygon of at least three corners, which are numbers of vertices.
    pub fn triangles(&mut self, corners: &[u32], vertices: &[Vec3]) -> Vec<[u32; 3]> {
        self.places(corners, vertices).into_iter().map(|t| t.map(|i| corners[i as usize])).collect()
    }

    /// The same triangles by the places of their corners in the polygon, where corners have more to them than a vertex: a fan
    /// for triangles and convex polygons, ears for others (Meisters 1975). Every corner is a corner of a triangle, also
    /// one on a straight edge: the polygon behind that edge may have a corner there too.
    pub fn places(&mut self, corners: &[u32], vertices: &[Vec3]) -> Vec<[u32; 3]> {
        let fan = || (1..corners.len() as u32 - 1).map(|i| [0, i, i + 1]).collect();
        if corners.len() == 3 {
            return fan();
        }
        // Seen from the first corner, so that far from the origin no digits are lost.
        let origin = vertices[corners[0] as usize];
        let points: Vec<Vec3> = corners.iter().map(|&v| vertices[v as usize] - origin).collect();
        // Newell's normal tells the plane; a fan is right if no triangle of it turns the other way.
        let normal = (0..points.len())
            .map(|i| points[i].cross(points[(i + 1) % points.len()]))
            .fold(Vec3::default(), |sum, c| sum + c);
        let turns_back = points.windows(2).skip(1).any(|w| w[0].cross(w[1]).dot(normal) < 0.0);
        if !turns_back {
            return fan();
        }
        let drop = (0..3).max_by(|&a, &b| normal.component(a).abs().total_cmp(&normal.component(b).abs())).unwrap_or(2);
        let flip = normal.component(drop) < 0.0;
        let flat = points.iter().map(|p| {
            let (x, y) = (p.component((drop + 1) % 3), p.component((drop + 2) % 3));
            if flip { [y, x] } else { [x, y] }
        });
        let mut ears: Vec<u32> = Vec::new();
        self.0.earcut(flat, &[], &mut ears);
        // earcut may turn all triangles around; the polygon's own sense is kept.
        let same_sense = |t: &[u32]| {
            let [p, q, r] = [t[0], t[1], t[2]].map(|i| points[i as usize]);
            if (q - p).cross(r - p).dot(normal) < 0.0 { [t[0], t[2], t[1]] } else { [t[0], t[1], t[2]] }
        };
        let mut triangles = ears.chunks_exact(3).map(same_sense).collect();
        put_back(&mut triangles, corners.len() as u32);
        triangles
    }
}

/// Earcut leaves out corners on straight edges. Puts them back: the triangle at such an edge is divided.
fn put_back(triangles: &mut Vec<[u32; 3]>, count: u32) {
    let mut kept = vec![false; count as usize];
    triangles.iter().flatten().for_each(|&i| kept[i as usize] = true);
    let Some(first) = kept.iter().position(|&k| k).map(|i| i as u32).filter(|_| kept.contains(&false)) else { return };
    let sides = |[a, b, c]: [u32; 3]| [(a, b), (b, c), (c, a)];
    let mut at: HashMap<(u32, u32), usize> =
        triangles.iter().enumerate().flat_map(|(i, &t)| sides(t).map(|side| (side, i))).collect();
    let mut start = first;
    // Once around, from each corner that was kept to the next.
    for step in 1..=count {
        let end = (first + step) % count;
        if !kept[end as usize] {
            continue;
        }
        if let Some(&i) = at.get(&(start, end)).filter(|_| (start + 1) % count != end) {
            let tip = triangles[i].iter().copied().find(|&v| v != start && v != end).unwrap_or(start);
            let mut from = start;
            while from != end {
                let to = (from + 1) % count;
                let triangle = [from, to, tip];
                let place = if from == start { i } else { triangles.len() };
                if place == i {
                    triangles[i] = triangle;
                } else {
                    triangles.push(triangle);
                }
                at.extend(sides(triangle).map(|side| (side, place)));
                from = to;
            }
        }
        start = end;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_on_straight_edges_are_kept() {
        // An L with a corner in the middle of each of its six edges.
        let l = [[0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4]];
        let mut points: Vec<Vec3> = Vec::new();
        for i in 0..6 {
            let ([x, y], [u, v]) = (l[i], l[(i + 1) % 6]);
            points.push(Vec3::new(f64::from(x), f64::from(y), 0.0));
            points.push(Vec3::new(f64::from(x + u) / 2.0, f64::from(y + v) / 2.0, 0.0));
        }
        for first in 0..12 {
            let corners: Vec<u32> = (0..12).map(|i| (i + first) % 12).collect();
            let triangles = Polygons::default().triangles(&corners, &points);
            assert_eq!(triangles.len(), 10, "{triangles:?}");
            let area = |t: &[u32; 3]| {
                let [a, b, c] = t.map(|v| points[v as usize]);
                (b - a).cross(c - a).z / 2.0
            };
            assert!(triangles.iter().all(|t| area(t) >= 0.0));
            assert_eq!(triangles.iter().map(area).sum::<f64>(), 12.0);
            let side = |i: u32| triangles.iter().any(|t| (0..3).any(|k| (t[k], t[(k + 1) % 3]) == (i, (i + 1) % 12)));
            assert!((0..12).all(side), "{triangles:?}");
        }
    }
}
