//! Polygons as triangles.

use snell::geometry::Vec3;
use spade::handles::FixedVertexHandle;
use spade::{
    ConstrainedDelaunayTriangulation, HierarchyHintGenerator, LineIntersectionIterator, Point2, Triangulation,
};
use std::collections::{HashMap, HashSet};

/// Polygons with so many corners are not cut into fans and ears.
const MANY: usize = 1000;

/// Ears of so many corners may take seconds.
const TOO_MANY: usize = 20_000;

/// Edges that may be flipped to make way for those of a polygon: under a second.
const FLIPS: usize = 30_000_000;

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
    /// for triangles and convex polygons, ears for others (Meisters 1975), and a Delaunay triangulation for those with very
    /// many corners: ears would take time that grows with their square, and a fan would be slivers, all of which lie near
    /// each other. Every corner is a corner of a triangle, also one on a straight edge: the polygon behind that edge may
    /// have a corner there too.
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
        if !turns_back && corners.len() < MANY {
            return fan();
        }
        let drop = (0..3).max_by(|&a, &b| normal.component(a).abs().total_cmp(&normal.component(b).abs())).unwrap_or(2);
        if corners.len() >= MANY {
            // In its own plane: seen askew, a regular polygon is a hard one.
            let up = normal.unit();
            let axis = [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0)][(drop + 1) % 3];
            let right = (axis - up * up.dot(axis)).unit();
            let flat: Vec<[f64; 2]> = points.iter().map(|p| [right.dot(*p), up.cross(right).dot(*p)]).collect();
            match delaunay(&points, &flat) {
                Ok(triangles) => return triangles,
                // Nobody can say what is inside.
                Err(NoDelaunay::Crosses) if !turns_back || corners.len() >= TOO_MANY => return fan(),
                Err(_) => {}
            }
        }
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

/// Why a polygon has no Delaunay triangulation.
enum NoDelaunay {
    /// It crosses or touches itself other than in corners, or its numbers are too large or too small.
    Crosses,
    /// The triangulation of its corners alone is too far from its own.
    Costly,
}

/// The constrained Delaunay triangulation (Chew 1989) of a polygon, by the places of its corners. `flat` are its corners in
/// the plane, anticlockwise.
fn delaunay(points: &[Vec3], flat: &[[f64; 2]]) -> Result<Vec<[u32; 3]>, NoDelaunay> {
    let mut all = ConstrainedDelaunayTriangulation::<Point2<f64>, (), (), (), HierarchyHintGenerator<f64>>::new();
    let count = points.len();
    let mut vertices = vec![None; count];
    let mut corner_of = Vec::with_capacity(count);
    // Out of order, so that no corner changes much of what is there (Guibas, Knuth and Sharir 1992). The prime passes each
    // corner once.
    for corner in (0..count as u64).map(|i| (i * 2_654_435_761 % count as u64) as usize) {
        let vertex = all.insert(Point2::new(flat[corner][0], flat[corner][1])).map_err(|_| NoDelaunay::Crosses)?;
        vertices[corner] = Some(vertex);
        if vertex.index() == corner_of.len() {
            corner_of.push(corner);
        } else if points[corner_of[vertex.index()]] != points[corner] {
            return Err(NoDelaunay::Crosses);
        }
    }
    let vertices: Vec<FixedVertexHandle> = vertices.into_iter().flatten().collect();
    // Those edges that are passed an odd number of times: on a way to a hole and back, the inside is on both sides.
    let mut border = HashSet::new();
    let ways = vertices.iter().copied().zip(vertices.iter().copied().cycle().skip(1));
    let mut flips = FLIPS;
    for (from, to) in ways.filter(|(from, to)| from != to) {
        // Making way for an edge that passes so many may take the square of it.
        let passed = LineIntersectionIterator::new_from_handles(&all, from, to).take(FLIPS.isqrt()).count();
        flips = flips.checked_sub(passed * passed).ok_or(NoDelaunay::Costly)?;
        if all.try_add_constraint(from, to).len() != 1 {
            return Err(NoDelaunay::Crosses);
        }
        let edge = [from.min(to), from.max(to)];
        if !border.remove(&edge) {
            border.insert(edge);
        }
    }
    // From outside on, each border leads in or out.
    let mut seen = vec![false; all.num_all_faces()];
    let mut open: Vec<_> = all.convex_hull().map(|edge| (edge, false)).collect();
    let mut triangles = Vec::with_capacity(count);
    while let Some((edge, inside)) = open.pop() {
        let [from, to] = [edge.from().fix(), edge.to().fix()];
        let inside = inside != border.contains(&[from.min(to), from.max(to)]);
        let face = edge.rev().face();
        let Some(triangle) = face.as_inner().filter(|_| !std::mem::replace(&mut seen[face.index()], true)) else {
            continue;
        };
        open.extend(triangle.adjacent_edges().map(|edge| (edge, inside)));
        if inside {
            triangles.push(triangle.vertices().map(|vertex| corner_of[vertex.index()] as u32));
        }
    }
    if triangles.is_empty() { Err(NoDelaunay::Crosses) } else { Ok(triangles) }
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
    use snell::lanes::elementary::sin_cos_degrees;
    use std::time::{Duration, Instant};

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

    const CORNERS: u32 = 100_000;

    /// The triangles of a polygon of many corners; they are within it and fill it, and it is done in time.
    fn of_many(name: &str, flat: &[[f64; 2]], area: f64) -> Vec<[u32; 3]> {
        // In a slanted plane, not at the origin.
        let (right, up) = (Vec3::new(0.6, 0.8, 0.0), Vec3::new(-0.64, 0.48, 0.6));
        let points: Vec<Vec3> = flat.iter().map(|&[x, y]| right * x + up * y + Vec3::new(9.0, 9.0, 9.0)).collect();
        let corners: Vec<u32> = (0..flat.len() as u32).collect();
        let start = Instant::now();
        let triangles = Polygons::default().triangles(&corners, &points);
        // About a second; where time grows with the square of the corners, half a minute and more.
        assert!(start.elapsed() < Duration::from_secs(15), "{name}: {:?}", start.elapsed());
        let doubled = |t: &[u32; 3]| {
            let [[ax, ay], [bx, by], [cx, cy]] = t.map(|v| flat[v as usize]);
            (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        };
        // Slivers are as thin as the positions are rounded.
        assert!(triangles.iter().all(|t| doubled(t) > -1e-9 * area), "{name}");
        let sum = triangles.iter().map(doubled).sum::<f64>() / 2.0;
        // 100 000 additions, each rounded to 1e-16 of the sum.
        assert!((sum - area).abs() < 1e-9 * area, "{name}: {sum} of {area}");
        triangles
    }

    #[test]
    fn polygons_of_many_corners_take_little_time() {
        let ring = |i: u32, radius: f64| {
            let (sin, cos) = sin_cos_degrees(f64::from(i) / f64::from(CORNERS) * 360.0);
            [radius * cos, radius * sin]
        };
        let shoelace = |p: &[[f64; 2]]| {
            let next = p.iter().cycle().skip(1);
            p.iter().zip(next).map(|([ax, ay], [bx, by])| ax * by - ay * bx).sum::<f64>() / 2.0
        };
        let half = CORNERS / 2;
        // Out on a spiral of many turns, and back beside it.
        let arm = |i: u32, by: f64| {
            let turns = f64::from(i) / 50.0;
            let (sin, cos) = sin_cos_degrees(turns * 360.0);
            [(1.0 + turns + by) * cos, (1.0 + turns + by) * sin]
        };
        let line = |i: u32, by: f64| [f64::from(i), f64::from(i) * 1e-3 + f64::from(i % 2) * 5.0 + by];
        let there_and_back = |f: &dyn Fn(u32, f64) -> [f64; 2], by: f64| {
            (0..half).map(|i| f(i, 0.0)).chain((0..half).rev().map(|i| f(i, by))).collect::<Vec<_>>()
        };
        for (name, mut flat) in [
            ("circle", (0..CORNERS).map(|i| ring(i, 1.0)).collect::<Vec<_>>()),
            ("star", (0..CORNERS).map(|i| ring(i, if i % 2 == 0 { 1.0 } else { 0.5 })).collect()),
            ("spiral", there_and_back(&arm, 0.5)),
            ("zigzag", there_and_back(&line, 1.0)),
        ] {
            if shoelace(&flat) < 0.0 {
                flat.reverse();
            }
            assert_eq!(of_many(name, &flat, shoelace(&flat)).len(), flat.len() - 2, "{name}");
        }
    }

    #[test]
    fn a_polygon_of_many_corners_around_a_hole() {
        // A square with all corners on its straight edges, and a way to a square hole and back.
        let square = |size: i32| {
            let along =
                move |i: i32| (-size..size).map(move |k| [[k, -size], [size, k], [-k, size], [-size, -k]][i as usize]);
            (0..4).flat_map(along)
        };
        let outer: Vec<[i32; 2]> = square(200).chain([[-200, -200]]).collect();
        let mut hole: Vec<[i32; 2]> = square(100).chain([[-100, -100]]).collect();
        hole.reverse();
        let flat: Vec<[f64; 2]> = outer.into_iter().chain(hole).map(|at| at.map(f64::from)).collect();
        let triangles = of_many("frame", &flat, 120_000.0);
        let place = |v: u32| flat[v as usize].map(f64::to_bits);
        let mut sides: HashSet<_> = HashSet::new();
        for [a, b, c] in triangles {
            sides.extend([[a, b], [b, c], [c, a]].map(|side| side.map(place)));
        }
        let count = flat.len() as u32;
        assert!(
            (0..count).all(|i| sides.contains(&[i, (i + 1) % count].map(place))),
            "every edge is one of a triangle"
        );
    }

    #[test]
    fn convex_polygons_are_fans_unless_they_have_many_corners() {
        let ring = |count: u32| {
            let at = |i: u32| sin_cos_degrees(f64::from(i) / f64::from(count) * 360.0);
            let points: Vec<Vec3> = (0..count).map(|i| Vec3::new(at(i).1, at(i).0, 0.0)).collect();
            Polygons::default().triangles(&(0..count).collect::<Vec<_>>(), &points)
        };
        let fan: Vec<[u32; 3]> = (1..98).map(|i| [0, i, i + 1]).collect();
        assert_eq!(ring(99), fan);
        // A vertex of a fan has them all.
        let most =
            |triangles: Vec<[u32; 3]>| (0..2000).map(|v| triangles.iter().filter(|t| t.contains(&v)).count()).max();
        assert!(most(ring(2000)).is_some_and(|most| most < 1000));
    }
}
