use crate::geometry::bvh::{self, Bvh, MARGIN, PACKET, Packet, Quality, Shapes};
use crate::geometry::ray::{Heading, axes, main_axis};
use crate::geometry::shape::Triangles;
use crate::geometry::{Bounds, Sphere, Vec3, sphere, triangle};
use crate::lanes::{ArrayLanes, Lanes};
use proptest::prelude::*;

fn direction() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-1.0..1.0f64).prop_map(Vec3::from).prop_filter("short", |v| v.length() > 0.1)
}

/// Whole numbers and others, near the origin and far from it.
fn point() -> impl Strategy<Value = Vec3> {
    let number = prop_oneof![-20.0..20.0f64, (-9..9i32).prop_map(f64::from)];
    let offset = prop_oneof![Just(0.0), Just(4096.0), Just(1e6), Just(-3e8)];
    (prop::array::uniform3(number), offset).prop_map(|(p, offset)| p.map(|c| c + offset).into())
}

/// What the primitive tests say, without any tree.
fn alone(shapes: &Shapes<'_>, id: usize, origin: Vec3, dir: Vec3) -> Option<f64> {
    let (t, meets) = if let Some(s) = shapes.spheres.get(id) {
        sphere::intersect(origin, dir, s.center, s.radius)
    } else {
        let k = axes(main_axis(dir));
        let Triangles { vertices, faces } = shapes.triangles;
        let corners = faces[id - shapes.spheres.len()].map(|v| vertices[v as usize].permuted(k));
        let hit = triangle::intersect(origin.permuted(k), &Heading::new(dir.permuted(k)), corners);
        (hit.t, hit.meets)
    };
    (meets && t > 0.0).then_some(t)
}

/// One ray in `copies` places of a packet: few go down the tree alone, many together.
fn in_tree<L: Lanes, const ANY: bool>(
    tree: &Bvh,
    origin: Vec3,
    dir: Vec3,
    t_max: f64,
    copies: usize,
) -> (u64, f64, f64) {
    let mut packet = Packet::default();
    for start in (0..PACKET).step_by(L::WIDTH) {
        packet.set(start, origin.splat(), dir.splat(), L::splat(0.0), L::splat(t_max), L::splat(-1.0), true);
    }
    let rays = u64::MAX >> (PACKET - copies);
    let hit = tree.intersect::<L, ANY>(&mut packet, rays);
    for i in 0..copies {
        assert_eq!((packet.t[i], packet.primitive[i]), (packet.t[0], packet.primitive[0]));
    }
    assert!(hit == rays || hit == 0);
    (hit, packet.t[0], packet.primitive[0])
}

/// The claim on which everything rests: the tree finds what the primitive tests find, also if nothing behind the hit
/// counts any more, so that no box may be entered later than its hit.
fn finds_the_same(shapes: &Shapes<'_>, origin: Vec3, dir: Vec3) {
    let hits = (0..shapes.count()).filter_map(|id| Some((alone(shapes, id, origin, dir)?, id)));
    let nearest = hits.min_by(|a, b| a.partial_cmp(b).unwrap());
    let everything = (0..shapes.count()).map(|i| shapes.bounds(i)).fold(Bounds::of([origin]), Bounds::union);
    let tree = bvh::build(shapes, vec![], MARGIN * everything.diagonal(), Quality::Good, 1);
    let limit = nearest.map_or(f64::INFINITY, |(t, _)| t.next_up());
    for (t_max, copies) in [(f64::INFINITY, 1), (f64::INFINITY, PACKET), (limit, 1), (limit, PACKET)] {
        let found = [
            in_tree::<f64, false>(&tree, origin, dir, t_max, copies),
            in_tree::<ArrayLanes<4>, false>(&tree, origin, dir, t_max, copies),
        ];
        for (hit, t, id) in found {
            assert_eq!((hit != 0).then_some((t, id as usize)), nearest, "t_max {t_max}, {copies} rays");
        }
        let any = in_tree::<ArrayLanes<8>, true>(&tree, origin, dir, t_max, copies).0;
        assert_eq!(any != 0, nearest.is_some());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn a_sphere_is_found_in_its_box(
        center in point(),
        exponent in -9..10i32,
        from in direction(),
        distance in -1.0..6.0f64,
        axis in 0..3usize,
        around in direction(),
        rim in prop_oneof![Just(0.0), -1e-12..1e-12f64, -1e-6..1e-6f64, -1.0..0.0f64],
    ) {
        // Aimed at the rim of the sphere, at one of the six points where it touches its box.
        let radius = libm::exp10(f64::from(exponent));
        let origin = center + from * (radius * (1.5 + libm::exp10(distance)));
        let mut pole = [0.0; 3];
        pole[axis] = if around.x < 0.0 { -1.0 } else { 1.0 };
        let target = center + Vec3::from(pole) * (radius * (1.0 + rim));
        let dir = (target - origin).unit();
        prop_assume!(dir.is_finite());
        finds_the_same(&Shapes { spheres: &[Sphere { center, radius }], ..Shapes::default() }, origin, dir);
    }

    #[test]
    fn a_triangle_is_found_in_its_box(
        origin in point(),
        corners in prop::array::uniform3(prop::array::uniform3(-9..9i32)),
        flat in 0..4usize,
        weights in prop::array::uniform3(prop_oneof![Just(0.0), 0.0..1.0f64]),
    ) {
        let mut corners = corners.map(|c| origin + Vec3::from(c.map(f64::from)) + Vec3::new(0.5, 2.0, 12.0));
        // Often in a plane across an axis, where the box has no thickness but its margin.
        let (_, rest) = corners.split_at_mut(1);
        match flat {
            0 => rest.iter_mut().for_each(|c| c.x = origin.x + 0.5),
            1 => rest.iter_mut().for_each(|c| c.y = origin.y + 2.0),
            2 => rest.iter_mut().for_each(|c| c.z = origin.z + 12.0),
            _ => {}
        }
        let sum: f64 = weights.iter().sum();
        prop_assume!(sum > 0.0);
        let target = (corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2]) * (1.0 / sum);
        let dir = (target - origin).unit();
        prop_assume!(dir.is_finite());
        finds_the_same(&Shapes { triangles: Triangles { vertices: &corners, faces: &[[0, 1, 2]] }, ..Shapes::default() }, origin, dir);
    }

    /// In the plane of a triangle the edge functions are noise.
    #[test]
    fn a_ray_in_the_plane_of_a_triangle_finds_the_same(
        corners in prop::array::uniform3(prop::array::uniform3(-9..9i32)),
        steps in prop::array::uniform4(-5..6i32),
    ) {
        let [a, b, c] = corners.map(|p| Vec3::from(p.map(f64::from)));
        let [to_b, to_c, from_b, from_c] = steps.map(f64::from);
        let origin = a + (b - a) * from_b + (c - a) * from_c;
        let dir = ((b - a) * to_b + (c - a) * to_c).unit();
        prop_assume!(dir.is_finite() && triangle::normal([a, b, c]).is_finite());
        finds_the_same(&Shapes { triangles: Triangles { vertices: &[a, b, c], faces: &[[0, 1, 2]] }, ..Shapes::default() }, origin, dir);
    }

    /// Enough primitives for several levels, and many rays at the same distance from two of them.
    #[test]
    fn the_nearest_of_many_is_found(
        centers in prop::collection::vec(prop::array::uniform3(-4..5i32), 1..120),
        corners in prop::collection::vec(prop::array::uniform3(-9..9i32), 3..120),
        origin in prop::array::uniform3(-12..12i32),
        dir in direction(),
    ) {
        let whole = |p: [i32; 3]| Vec3::from(p.map(f64::from));
        let spheres: Vec<Sphere> =
            centers.iter().map(|&c| Sphere { center: whole(c) * 2.0, radius: 1.0 }).collect();
        let vertices: Vec<Vec3> = corners.iter().map(|&c| whole(c)).collect();
        let faces: Vec<[u32; 3]> = (0..vertices.len() as u32 / 3).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
        let triangles = Triangles { vertices: &vertices, faces: &faces };
        let shapes = Shapes { spheres: &spheres, triangles, ..Shapes::default() };
        let origin = whole(origin) + Vec3::new(0.3, 0.3, 0.3);
        finds_the_same(&shapes, origin, dir.unit());
        // Along an axis: into the planes of boxes, and at several spheres at once.
        finds_the_same(&shapes, whole([0, 0, 30]), Vec3::new(0.0, 0.0, -1.0));
    }
}
