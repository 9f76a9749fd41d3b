use crate::geometry::bvh::{self, Bvh, Instance, MARGIN, PACKET, Packet, Quality, Shapes};
use crate::geometry::shape::Triangles;
use crate::geometry::{Affine, Bounds, Vec3};
use crate::lanes::{ArrayLanes, Lanes};
use proptest::prelude::*;

/// The nearest hit of one ray, alone and in a packet.
fn nearest(tree: &Bvh, origin: Vec3, dir: Vec3) -> Option<(f64, f64)> {
    let [one, many] = [1, PACKET].map(|copies| {
        type Four = ArrayLanes<4>;
        let mut packet = Packet::default();
        for start in (0..PACKET).step_by(4) {
            let [t_min, t_max, source] = [0.0, f64::INFINITY, -1.0].map(Four::splat);
            packet.set(start, origin.splat(), dir.splat(), t_min, t_max, source, true);
        }
        let hit = tree.intersect::<Four, false>(&mut packet, u64::MAX >> (PACKET - copies));
        (hit & 1 == 1).then_some((packet.t[0], packet.primitive[0]))
    });
    assert_eq!(one, many);
    one
}

fn turn() -> impl Strategy<Value = Affine> {
    (prop::array::uniform3(-1.0..1.0f64), -180.0..180.0f64)
        .prop_filter_map("no axis", |(axis, degrees)| Affine::rotation(Vec3::from(axis), degrees))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// The box of an instance holds its hits, however its map turns, stretches and moves: rays at the rim of a triangle
    /// find it in its box as they do without one. Models far from their own origin, which the map brings back, too.
    #[test]
    fn an_instance_is_found_in_its_box(
        turns in [turn(), turn()],
        scale in prop::array::uniform3(-6.0..6.0f64),
        stretch in prop_oneof![Just(0.0), Just(0.3), Just(1.0)],
        far in prop_oneof![Just(0.0), Just(1e6), Just(1e12)],
        corners in prop::array::uniform3(prop::array::uniform3(-9..9i32)),
        along in 0.0..=1.0f64,
        from in prop::array::uniform3(-30.0..30.0f64),
    ) {
        let scale = Affine::scaling(scale.map(|e| libm::exp10(e * stretch)).into());
        let there = Vec3::new(far, -far, far);
        let linear = turns[0].then(scale).then(turns[1]);
        let map = Affine::translation(-there).then(linear);
        let vertices = corners.map(|c| there + Vec3::from(c.map(f64::from)));
        let bounds = Bounds::of(vertices.map(|v| map.apply(v)));
        let origin = Vec3::from(from) * (1.0 + bounds.farthest());
        let everything = bounds.union(Bounds::of([origin]));
        let instance = Instance::new(0, &map, 0, bounds, everything.diagonal(), everything.farthest());
        prop_assume!(bounds.farthest() < 1e15 && instance.is_some());
        let instances = [instance.unwrap()];
        // Aimed in the space of the model, where the hit is found, and not where the world says that it should be.
        let to_model = instances[0].to_model;
        let target = vertices[0] * along + vertices[1] * (1.0 - along) - to_model.apply(origin);
        let aim = |dir: Vec3, _| dir + map.turn(target - to_model.turn(dir));
        let dir = (0..9).fold(map.turn(target), aim);
        prop_assume!(dir.is_finite());
        let seen = everything.corners().map(|c| to_model.apply(c));
        let reach = Bounds::of(vertices).union(Bounds::of(seen)).diagonal();
        let shapes = Shapes { triangles: Triangles { vertices: &vertices, faces: &[[0, 1, 2]] }, ..Shapes::default() };
        let model = bvh::build(&shapes, vec![], MARGIN * reach, Quality::Good, 1);
        let shapes = Shapes { instances: &instances, ..Shapes::default() };
        let tree = bvh::build(&shapes, vec![model], MARGIN * everything.diagonal(), Quality::Good, 1);
        prop_assert_eq!(nearest(&tree, origin, dir), nearest(&tree.flat(), origin, dir));
    }
}

/// Numbers that meet each other, both zeros, and what makes no sense.
fn component() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -1.0..1.0f64,
        4 => (-2..3i32).prop_map(f64::from),
        1 => Just(-0.0),
        1 => prop_oneof![Just(1e-300), Just(-1e-300), Just(f64::NAN)],
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    /// Rays of all kinds in one packet find what each finds alone and without boxes: among spheres, triangles and
    /// models that often stand in the same places, so that several are hit at the same distance.
    #[test]
    fn rays_of_all_kinds_find_the_same_together(
        corners in prop::collection::vec(prop::array::uniform3(-3..4i32), 6..60),
        places in prop::collection::vec((prop::array::uniform3(-1..2i32), 0..3usize, 0..2usize), 0..30),
        own in 0..2usize,
        spheres in 0..4usize,
        rays in prop::collection::vec(
            (prop::array::uniform3(-9..10i32), prop::array::uniform3(component()), 0..5usize, -1..30i32),
            PACKET,
        ),
        alike in any::<bool>(),
    ) {
        type Eight = ArrayLanes<8>;
        let whole = |p: [i32; 3]| Vec3::from(p.map(f64::from));
        let vertices: Vec<Vec3> = corners.into_iter().map(whole).collect();
        let faces: Vec<[u32; 3]> = (0..vertices.len() as u32 / 3)
            .map(|f| [3 * f, 3 * f + 1, 3 * f + 2])
            .filter(|face| crate::geometry::triangle::normal(face.map(|v| vertices[v as usize])).is_finite())
            .collect();
        prop_assume!(!faces.is_empty());
        let (few, all) = (&faces[..1], &faces[..]);
        let spheres: Vec<_> = (0..spheres)
            .map(|i| crate::geometry::Sphere { center: Vec3::new(i as f64, 0.0, 0.0), radius: 1.0 })
            .collect();
        let own = if own == 0 { &[] } else { all };
        let reach = 100.0;
        let mut first = (spheres.len() + own.len()) as u32;
        let instances: Vec<Instance> = places
            .into_iter()
            .map(|(at, kind, model)| {
                let scale = [1.0, -1.0, 0.5][kind];
                let map = Affine::scaling(Vec3::new(scale, 1.0, scale)).then(Affine::translation(whole(at)));
                let bounds = Bounds::of(vertices.iter().map(|&v| map.apply(v)));
                let instance = Instance::new(model, &map, first, bounds, reach, 10.0).unwrap();
                first += [few.len(), all.len()][model] as u32;
                instance
            })
            .collect();
        let model = |faces| {
            let shapes = Shapes { triangles: Triangles { vertices: &vertices, faces }, ..Shapes::default() };
            bvh::build(&shapes, vec![], MARGIN * 4.0 * reach, Quality::Good, 1)
        };
        let triangles = Triangles { vertices: &vertices, faces: own };
        let shapes = Shapes { spheres: &spheres, triangles, instances: &instances, ..Shapes::default() };
        let tree = bvh::build(&shapes, vec![model(few), model(all)], MARGIN * reach, Quality::Good, 1);
        let flat = tree.clone().flat();
        let limits = [(0.0, f64::INFINITY), (1.0, 4.0), (2.0, 2.0), (0.0, f64::NAN), (1e-5, 8.0)];
        // In the plane of no triangle: seen edge on, rounding alone says whether it is hit.
        let beside = Vec3::new(0.314_159_265_3, 0.271_828_182_8, 0.577_215_664_9);
        let fill = |row: usize| {
            let mut packet = Packet::default();
            for place in 0..PACKET {
                let (at, dir, limit, source) = rays[if row < PACKET { row } else { place }];
                let dir = Vec3::from(dir);
                let dir = if alike { Vec3::new(dir.x.abs() * 0.1, dir.y.abs() * 0.1, 1.0) } else { dir };
                let unit = if dir.length() > 0.0 { dir.unit() } else { dir };
                let (t_min, t_max) = limits[limit];
                packet.set(place, whole(at) + beside, unit, t_min, t_max, f64::from(source), true);
            }
            packet
        };
        let (mut together, mut any) = (fill(PACKET), fill(PACKET));
        let hit = tree.intersect::<Eight, false>(&mut together, !0);
        let blocked = tree.intersect::<Eight, true>(&mut any, !0);
        prop_assert_eq!(hit, blocked);
        for ray in 0..PACKET {
            let mut alone = fill(ray);
            let found = flat.intersect::<f64, false>(&mut alone, 1);
            prop_assert_eq!(hit >> ray & 1, found);
            let same = |a: f64, b: f64| a == b || a.is_nan() && b.is_nan();
            prop_assert!(same(together.t[ray], alone.t[0]));
            prop_assert_eq!(together.primitive[ray], alone.primitive[0]);
        }
    }
}
