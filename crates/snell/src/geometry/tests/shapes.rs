//! Every shape against what is known of it otherwise, aimed at where roundings decide.

use super::exact::Exact;
use crate::geometry::bvh::{self, Bvh, MARGIN, PACKET, Packet, Quality};
use crate::geometry::ray::{Heading, Ray, axes, main_axis};
use crate::geometry::shape::*;
use crate::geometry::{Affine, Bounds, Vec3};
use crate::lanes::ArrayLanes;
use proptest::prelude::*;

/// No crossing.
const NONE: [f64; 0] = [];

/// What a rounding is, relative.
const U: f64 = f64::EPSILON / 2.0;

fn vector() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-1.0..1.0f64).prop_map(Vec3::from)
}

fn direction() -> impl Strategy<Value = Vec3> {
    vector().prop_filter("short", |v| v.length() > 0.1).prop_map(Vec3::unit)
}

/// Turned, scaled and stretched, into units of 1e-9 to 1e9, and far away.
fn map() -> impl Strategy<Value = Affine> {
    let turn = || (direction(), -180.0..180.0f64).prop_map(|(axis, degrees)| Affine::rotation(axis, degrees).unwrap());
    let stretch = prop_oneof![
        Just([1.0; 3]),
        prop::array::uniform3(0.2..2.0f64),
        (1e-12..1e-9f64).prop_map(|thin| [1.0, thin, -1.0]),
    ];
    let unit = prop_oneof![Just(1.0), Just(1e-9), Just(1e9)];
    let away = prop_oneof![Just(0.0), Just(1e3), Just(1e8)];
    (turn(), stretch, turn(), unit, direction(), away).prop_map(|(first, stretch, second, unit, to, away)| {
        let scale = Affine::scaling(Vec3::from(stretch) * unit);
        first.then(scale).then(second).then(Affine::translation(to * (away * unit)))
    })
}

/// One shape of each new kind.
fn shapes(map: &Affine) -> (Rectangle, Cuboid, Disc) {
    let up = Vec3::new(0.3, 1.0, 0.2);
    let rectangle = Rectangle::new(Vec3::default(), up, [2.0, 1.5]).under(map);
    let cuboid = Cuboid::new(Vec3::new(-1.0, -0.7, -0.4), Vec3::new(1.0, 0.7, 0.4)).under(map);
    (rectangle, cuboid, Disc::new(Vec3::default(), up, 1.0).under(map))
}

/// The places on the line of a ray where it crosses a shape.
fn crossings<S: Shape>(shape: &S, origin: Vec3, dir: Vec3) -> Vec<f64> {
    let axes = if S::SHEARED { axes(main_axis(dir)) } else { [0, 1, 2] };
    let ray = Ray { origin: origin.permuted(axes), heading: Heading::new(dir.permuted(axes)), axes };
    let (mut numbers, mut found) = (Vec::new(), Vec::new());
    shape.write(|number| numbers.push(number));
    assert_eq!(numbers.len(), S::NUMBERS);
    S::crossings(&ray, One { numbers: &numbers, stride: 1, place: 0 }, |t| found.push(t));
    assert!(found.is_sorted(), "{found:?}");
    found
}

/// By exact arithmetic, whether a line goes through a triangle; `None` within `off` of one of its edges.
fn exactly(origin: Vec3, dir: Vec3, corners: [Vec3; 3], off: f64) -> Option<bool> {
    let signs = Exact::edge_functions(origin, dir, corners);
    let [a, b, c] = corners;
    // The functions are of the edges opposite to a, b and c.
    for (sign, edge) in signs.into_iter().zip([c - b, a - c, b - a]) {
        if sign.abs() <= off * edge.length() {
            return None;
        }
    }
    Some(signs.iter().all(|s| *s > 0.0) || signs.iter().all(|s| *s < 0.0))
}

/// Where a ray starts and where it is aimed: at a point of the shape in its own coordinates.
fn aimed(map: &Affine, from: Vec3, at: Vec3) -> (Vec3, Vec3) {
    let middle = map.apply(Vec3::<f64>::default());
    let size = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|v| map.turn(Vec3::<f64>::from(v)).length());
    let origin = middle + from * (4.0 * size.into_iter().fold(0.0, f64::max));
    (origin, (map.apply(at) - origin).unit())
}

/// Coordinates that are often those of an edge, of a corner, or of nothing special.
fn place() -> impl Strategy<Value = Vec3> {
    let coordinate =
        prop_oneof![Just(-1.0), Just(1.0), Just(0.0), -1.2..1.2f64, (-1.0..1.0f64).prop_map(|x| 1.0 + 1e-9 * x)];
    prop::array::uniform3(coordinate).prop_map(|[x, y, z]| Vec3::new(x, 0.7 * y, 0.4 * z))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, max_global_rejects: 100_000, ..ProptestConfig::default() })]

    /// A rectangle is met as its two halves are, and where its plane is.
    #[test]
    fn a_rectangle_is_its_two_triangles(map in map(), from in direction(), at in place()) {
        let (rectangle, ..) = shapes(&map);
        prop_assume!(rectangle.has_area());
        let (origin, dir) = aimed(&map, from, at);
        let [a, b, c, d] = rectangle.corners;
        let farthest = rectangle.corners.iter().map(|&p| (p - origin).length()).fold(0.0, f64::max);
        // Corners are seen where they are to within 6 roundings of their distance; the fourth corner is rounded, too.
        let off = 16.0 * U * (farthest + rectangle.bounds().farthest());
        let halves = [[a, b, c], [a, c, d]].map(|half| exactly(origin, dir, half, off));
        let found = crossings(&rectangle, origin, dir);
        if let [Some(one), Some(other)] = halves {
            prop_assert_eq!(!found.is_empty(), one || other);
        }
        for t in found {
            prop_assert!(rectangle.height(origin + dir * t, dir, t).1.abs() <= 32.0 * U * (farthest + rectangle.bounds().farthest()));
        }
    }

    /// A box is met as its twelve triangles are: in and out, in the same places.
    #[test]
    fn a_box_is_its_twelve_triangles(map in map(), from in direction(), at in place()) {
        let (_, cuboid, _) = shapes(&map);
        prop_assume!(cuboid.has_volume());
        let (origin, dir) = aimed(&map, from, at);
        let size = (cuboid.corners()[0] - origin).length() + cuboid.bounds().farthest();
        // What a hit may be off the plane of its face: 32 roundings of reach and farthest. Edges are off by that over the sine of the
        // angle between their faces.
        let skew = (0..3).map(|i| cuboid.axes[i].length() / cuboid.height(cuboid.center, cuboid.axes[i], 1.0).1.abs()).fold(0.0, f64::max);
        let off = 64.0 * U * size * skew;
        let (mut faces, mut sure) = (vec![], true);
        // In a mirror image they look inward.
        let outward = if map.mirrors() { -1.0 } else { 1.0 };
        cuboid.tessellate(&mut |corners| {
            match exactly(origin, dir, corners, off) {
                Some(true) => {
                    let n = triangle::normal(corners) * outward;
                    faces.push((n.dot(corners[0] - origin) / n.dot(dir), n.dot(dir)));
                }
                Some(false) => {}
                None => sure = false,
            }
        });
        let found = crossings(&cuboid, origin, dir);
        if sure && faces.iter().all(|(_, cos)| cos.is_finite()) {
            prop_assert_eq!(found.len(), faces.len());
            faces.sort_by(|a, b| a.0.total_cmp(&b.0));
            for (t, (expected, cos)) in found.iter().zip(faces) {
                prop_assert!((t - expected).abs() * cos.abs() <= 4.0 * off, "{} for {}", t, expected);
                // Its normal is that of the face, and faces the ray on the way in.
                let enters = cuboid.enters(origin, dir, *t);
                prop_assert_eq!(enters, cos < 0.0);
                let normal = cuboid.normal_along(origin + dir * *t, dir, !enters, f64::INFINITY);
                prop_assert_eq!(normal.dot(dir) < 0.0, enters);
            }
        }
    }

    /// A disc is met where its plane is within its radius; all points of a rim at `a² + b² = 1`.
    #[test]
    fn a_disc_is_round(map in map(), from in direction(), place in prop::array::uniform2(-1.3..1.3f64), rim in any::<bool>()) {
        let (.., disc) = shapes(&map);
        prop_assume!(disc.has_area());
        let [mut a, mut b] = place;
        let length = (a * a + b * b).sqrt();
        prop_assume!(length > 0.01);
        if rim {
            (a, b) = (a / length, b / length);
        }
        let target = disc.center + disc.radii[0] * a + disc.radii[1] * b;
        let (origin, _) = aimed(&map, from, Vec3::default());
        let dir = (target - origin).unit();
        let found = crossings(&disc, origin, dir);
        let size = (target - origin).length() + disc.bounds().farthest();
        // In units of the smaller radius across, over the cosine at which the disc is seen.
        let cos = disc.normal(target).dot(dir).abs();
        let small = disc.radii[0].cross(disc.radii[1]).length() / disc.radii[0].length().max(disc.radii[1].length());
        let unsure = 64.0 * U * size / (small * cos);
        let radius = (a * a + b * b).sqrt();
        if (radius - 1.0).abs() > unsure {
            prop_assert_eq!(!found.is_empty(), radius < 1.0, "{} with {}", radius, unsure);
        }
        for t in found {
            prop_assert!(disc.height(origin + dir * t, dir, t).1.abs() <= 32.0 * U * size);
        }
    }

    /// The tree finds what is there without one, whatever stands in lanes: all kinds at once, often in the same places.
    #[test]
    fn all_kinds_are_found_in_the_tree(
        places in prop::collection::vec((prop::array::uniform3(-2..3i32), 0..5usize, any::<bool>()), 1..60),
        rays in prop::collection::vec((prop::array::uniform3(-8..9i32), direction(), any::<bool>()), PACKET),
        source in -1..60i32,
        two_sided in any::<bool>(),
    ) {
        let (mut spheres, mut rectangles, mut cuboids, mut discs) = (vec![], vec![], vec![], vec![]);
        let (mut vertices, mut faces) = (vec![], vec![]);
        for (at, kind, turned) in places {
            let turn = Affine::rotation(Vec3::new(1.0, 2.0, 3.0), if turned { 40.0 } else { 0.0 }).unwrap();
            let map = turn.then(Affine::translation(Vec3::from(at.map(f64::from))));
            let normal = Vec3::new(0.0, 0.0, 1.0);
            match kind {
                0 => spheres.push(Sphere { center: map.apply(Vec3::default()), radius: 0.5 }),
                1 => {
                    let first = vertices.len() as u32;
                    vertices.extend([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(|v| map.apply(Vec3::<f64>::from(v))));
                    faces.push([first, first + 1, first + 2]);
                }
                2 => rectangles.push(Rectangle::new(Vec3::default(), normal, [1.0, 2.0]).under(&map)),
                3 => cuboids.push(Cuboid::new(Vec3::default(), Vec3::new(1.0, 1.0, 0.5)).under(&map)),
                _ => discs.push(Disc::new(Vec3::default(), normal, 1.0).under(&map)),
            }
        }
        let triangles = Triangles { vertices: &vertices, faces: &faces };
        let shapes = Shapes { spheres: &spheres, triangles, rectangles: &rectangles, cuboids: &cuboids, discs: &discs, instances: &[] };
        let tree = bvh::build(&shapes, vec![], MARGIN * 100.0, Quality::Good, 1);
        let flat = tree.clone().flat();
        for number in 0..shapes.count() {
            let bounds = tree.shape(number).map(|shape| shape.bounds());
            prop_assert_eq!(bounds, Some(shapes.bounds(number)), "read back from its leaf");
        }
        let fill = |only: Option<usize>, alike: bool| {
            let mut packet = Box::new(Packet::default());
            packet.two_sided = two_sided;
            for place in 0..PACKET {
                let (at, dir, along) = rays[only.unwrap_or(place)];
                let dir = if alike { Vec3::new(dir.x.abs() * 0.1, dir.y.abs() * 0.1, 1.0).unit() } else { dir };
                let dir = if along && !alike { Vec3::new(0.0, 0.0, dir.z.signum()) } else { dir };
                let beside = if along { 0.0 } else { 0.314_159_265_3 };
                let origin = Vec3::from(at.map(f64::from)) + Vec3::new(beside, 0.5 * beside, 2.0 * beside);
                packet.set(place, origin, dir, 0.0, f64::INFINITY, f64::from(source), true);
            }
            packet
        };
        for alike in [false, true] {
            let mut packets = [fill(None, alike), fill(None, alike), fill(None, alike), fill(None, alike)];
            let hits = [
                tree.intersect::<f64, false>(&mut packets[0], !0),
                tree.intersect::<ArrayLanes<2>, false>(&mut packets[1], !0),
                tree.intersect::<ArrayLanes<4>, false>(&mut packets[2], !0),
                tree.intersect::<ArrayLanes<8>, false>(&mut packets[3], !0),
            ];
            prop_assert!(hits.iter().all(|hit| *hit == hits[0]));
            prop_assert_eq!(tree.intersect::<ArrayLanes<4>, true>(&mut fill(None, alike), !0), hits[0]);
            for ray in 0..PACKET {
                let mut alone = fill(Some(ray), alike);
                prop_assert_eq!(flat.intersect::<f64, false>(&mut alone, 1), hits[0] >> ray & 1);
                for packet in &packets {
                    prop_assert_eq!((packet.t[ray], packet.primitive[ray]), (alone.t[0], alone.primitive[0]));
                }
            }
        }
    }

    /// No tree hides a hit, however its shape is turned, squashed and skewed, and wherever it stands.
    #[test]
    fn a_squashed_shape_is_found_in_its_box(map in map(), from in direction(), at in place()) {
        let (rectangle, cuboid, disc) = shapes(&map);
        prop_assume!(rectangle.has_area() && cuboid.has_volume() && disc.has_area());
        let (origin, dir) = aimed(&map, from, at);
        let everything = rectangle.bounds().union(cuboid.bounds()).union(disc.bounds()).union(Bounds::of([origin]));
        let margin = MARGIN * (everything.diagonal() + everything.farthest());
        let (rectangles, cuboids, discs) = ([rectangle], [cuboid], [disc]);
        for kind in 0..3 {
            let all = Shapes { rectangles: &rectangles, cuboids: &cuboids, discs: &discs, ..Shapes::default() };
            let none = Shapes::default();
            let shapes = match kind {
                0 => Shapes { rectangles: all.rectangles, ..none },
                1 => Shapes { cuboids: all.cuboids, ..none },
                _ => Shapes { discs: all.discs, ..none },
            };
            let tree = bvh::build(&shapes, vec![], margin, Quality::Good, 1);
            let hit = |tree: &Bvh| {
                let mut packet = Box::new(Packet::default());
                packet.set(0, origin, dir, 0.0, f64::INFINITY, -1.0, true);
                (tree.intersect::<f64, false>(&mut packet, 1), packet.t[0])
            };
            prop_assert_eq!(hit(&tree), hit(&tree.clone().flat()), "kind {}", kind);
        }
    }

    /// A ray that starts on a face of a box meets the far side if it goes in, and nothing if it goes out.
    #[test]
    fn a_box_that_is_left_is_met_on_its_far_side_only(
        map in map(),
        face in 0..6usize,
        place in prop::array::uniform2(-0.999..0.999f64),
        dir in direction(),
    ) {
        let (_, cuboid, _) = shapes(&map);
        prop_assume!(cuboid.has_volume());
        let (axis, side) = (face % 3, if face < 3 { 1.0 } else { -1.0 });
        let mut local = [0.0; 3];
        (local[axis], local[(axis + 1) % 3], local[(axis + 2) % 3]) = (side, place[0], place[1]);
        let start = cuboid.center + cuboid.axes[0] * local[0] + cuboid.axes[1] * local[1] + cuboid.axes[2] * local[2];
        let normal = cuboid.normal(start);
        let clearance = 32.0 * 2.0 * U * (cuboid.bounds().farthest() + cuboid.bounds().diagonal());
        let thinnest = cuboid.axes.map(|axis| cuboid.normal_along(start, axis.unit(), true, 0.0).dot(axis).abs());
        // Thinner than a hit may be off, nobody knows on which face it is.
        prop_assume!(thinnest.into_iter().fold(f64::INFINITY, f64::min) > 2000.0 * clearance && normal.dot(dir).abs() > 0.01);
        let cuboids = [cuboid];
        let shapes = Shapes { cuboids: &cuboids, ..Shapes::default() };
        let margin = MARGIN * (cuboid.bounds().farthest() + cuboid.bounds().diagonal());
        let tree = bvh::build(&shapes, vec![], margin, Quality::Good, 1);
        let mut packet = Packet::default();
        packet.two_sided = true;
        packet.set(0, start, dir, 0.0, f64::INFINITY, 0.0, true);
        let hit = tree.intersect::<f64, false>(&mut packet, 1) == 1;
        // Where it starts the tree may find a hit that is none: what is near is looked at again.
        let from = Departure { origin: start, dir, wo: normal, up: if normal.dot(dir) < 0.0 { -normal } else { normal }, tolerance: clearance };
        let hit = hit && cuboid.is_met_again(&from, packet.t[0]);
        prop_assert_eq!(hit, normal.dot(dir) < 0.0);
        if hit {
            prop_assert!(!cuboid.enters(start, dir, packet.t[0]) && packet.t[0] > clearance);
            prop_assert!(cuboid.distance(start + dir * packet.t[0]) <= clearance);
        }
    }

    /// Two rectangles that share an edge have no gap, and neither have a rectangle and a triangle.
    #[test]
    fn shared_edges_do_not_leak(
        corners in prop::array::uniform3(prop::array::uniform3(-9..10i32)),
        across in prop::array::uniform3(-9..10i32),
        from in prop::array::uniform3(-9.0..9.0f64),
        along in 0.0..=1.0f64,
    ) {
        let [a, b, c] = corners.map(|corner| Vec3::from(corner.map(f64::from)));
        let other = Vec3::from(across.map(f64::from));
        let one = Rectangle { corners: [a, b, b + (c - a), c], front: 1.0 };
        let beside = Rectangle { corners: [b, a, a + other, b + other], front: 1.0 };
        prop_assume!(one.has_area() && beside.has_area());
        let origin = Vec3::from(from);
        let target = a + (b - a) * along;
        let dir = (target - origin).unit();
        // From where the edge has one of the two on each side, as it is seen.
        let side = |p: Vec3| (b - a).cross(origin - a).dot(p - a);
        prop_assume!(dir.is_finite() && side(c) * side(a + other) < 0.0 && (0.01..0.99).contains(&along));
        let half = Triangle { corners: [b, a, a + other] };
        let [first, second, third] = [crossings(&one, origin, dir), crossings(&beside, origin, dir), crossings(&half, origin, dir)];
        prop_assert!(!first.is_empty() || !second.is_empty(), "between two rectangles");
        prop_assert!(!first.is_empty() || !third.is_empty(), "between a rectangle and a triangle");
    }
}

#[test]
fn known_answers() {
    let x = Vec3::new(1.0, 0.0, 0.0);
    let at = |x: f64, y: f64, z: f64| Vec3::new(x, y, z);
    let cuboid = Cuboid::new(at(1.0, -1.0, -1.0), at(5.0, 1.0, 1.0));
    assert_eq!(crossings(&cuboid, at(0.0, 0.0, 0.0), x), [1.0, 5.0]);
    assert_eq!(crossings(&cuboid, at(0.0, 2.0, 0.0), x), NONE, "beside");
    assert_eq!(crossings(&cuboid, at(2.0, 0.5, 0.0), -x), [-3.0, 1.0], "from inside");
    assert_eq!(crossings(&cuboid, at(0.0, 0.0, 0.0), at(f64::NAN, 0.0, 0.0)), NONE, "no direction");
    assert_eq!(cuboid.uv(at(1.0, 0.0, 0.5)), [0.75, 0.5]);
    assert_eq!((cuboid.distance(at(0.0, 0.0, 0.0)), cuboid.distance(at(2.0, 0.0, 0.5))), (1.0, 0.5));
    let disc = Disc::new(at(5.0, 0.0, 0.0), x, 2.0);
    assert_eq!(crossings(&disc, at(0.0, 1.9, 0.0), x), [5.0]);
    assert_eq!(crossings(&disc, at(0.0, 1.5, 1.5), x), NONE, "in the corner of its box");
    assert_eq!(crossings(&disc, at(0.0, 0.0, 0.0), at(0.0, 1.0, 0.0)), NONE, "along its plane");
    assert_eq!(crossings(&disc, at(5.0, -9.0, 0.0), at(0.0, 1.0, 0.0)), NONE, "in its plane");
    assert_eq!((disc.distance(at(7.0, 0.0, 0.0)), disc.distance(at(5.0, 4.0, 0.0))), (2.0, 2.0));
    // Seen from +x up is y and right is −z.
    assert_eq!((disc.uv(at(5.0, 0.0, 0.0)), disc.uv(at(5.0, 2.0, 0.0))), ([0.5, 0.5], [0.5, 1.0]));
    let rectangle = Rectangle::new(at(0.0, 0.0, 3.0), at(0.0, 0.0, 1.0), [2.0, 4.0]);
    assert_eq!(crossings(&rectangle, at(0.9, 1.9, 9.0), at(0.0, 0.0, -1.0)), [6.0]);
    assert_eq!(crossings(&rectangle, at(1.0, 2.0, 9.0), at(0.0, 0.0, -1.0)), [6.0], "its corner is inside");
    assert_eq!(crossings(&rectangle, at(1.1, 0.0, 9.0), at(0.0, 0.0, -1.0)), NONE);
    assert_eq!(rectangle.uv(at(-1.0, 2.0, 3.0)), [0.0, 1.0]);
    assert!(rectangle.enters(at(0.0, 0.0, 9.0), at(0.0, 0.0, -1.0), 6.0));
    let mirrored = rectangle.under(&Affine::scaling(at(-1.0, 1.0, 1.0)));
    assert!(mirrored.enters(at(0.0, 0.0, 9.0), at(0.0, 0.0, -1.0), 6.0), "it still looks to +z");
    assert_eq!(mirrored.uv(at(1.0, 2.0, 3.0)), [0.0, 1.0], "its texture sticks to it");
}
