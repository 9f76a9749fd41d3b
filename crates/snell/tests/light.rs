//! Where a ray leaves a surface: nothing shades or mirrors itself at its edges, and everything else is still in its way.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod common;

use common::{close, furnace, glass, mesh, picture, traced};
use snell::film::Rgb;
use snell::geometry::{Affine, TriangleMesh, Vec3, tessellate, triangle};
use snell::render::{Options, Settings, render};
use snell::scene::{
    Camera, Cuboid, Integrator, Light, Material, Plane, Render, Scene, Shadows, Sky, Transform, WarningCode,
};
use snell::trace::Statistics;
use snell::world::World;
use snell_formats::scene_file::{self, Syntax};
use snell_formats::{LoadOptions, Source};
use snell_test_scenes::brilliant::Cut;
use snell_test_scenes::real_files::cases;

/// Numbers that only look random, the same each time: the fractional parts of multiples of the golden ratio's kin.
struct Numbers(u32);

impl Numbers {
    /// From −1 to 1.
    fn next(&mut self) -> f64 {
        self.0 += 1;
        let n = f64::from(self.0) * 0.754_877_666_246_692_7;
        2.0 * (n - n.floor()) - 1.0
    }

    fn direction(&mut self) -> Vec3 {
        loop {
            let v = Vec3::new(self.next(), self.next(), self.next());
            if (0.3..1.0).contains(&v.length()) {
                return v.unit();
            }
        }
    }
}

/// Turned, of a size, and so far from the origin.
fn somewhere(numbers: &mut Numbers, size: f64, offset: f64) -> Vec<Transform> {
    let (axis, degrees) = (numbers.direction().into(), 180.0 * numbers.next());
    let away = numbers.direction() * offset;
    vec![Transform::Rotate { axis, degrees }, Transform::Scale([size; 3]), Transform::Move(away.into())]
}

fn whole(steps: &[Transform]) -> Affine {
    steps.iter().map(|step| step.map().unwrap()).fold(Affine::IDENTITY, Affine::then)
}

/// Half of the size of the box among the [`convex`] ones.
const HALF: [f64; 3] = [1.0, 0.7, 0.4];

/// The same box as shapes of their own: one, or its six sides; `None` for what is no box.
fn exact(name: &str, scene: &Scene, steps: &[Transform]) -> Vec<(&'static str, Scene)> {
    if name != "box" {
        return vec![];
    }
    let mut one = Scene { meshes: vec![], ..scene.clone() };
    let mut six = one.clone();
    let (transform, material) = (steps.to_vec(), "it".to_owned());
    one.boxes.push(Cuboid { name: None, min: HALF.map(|c| -c), max: HALF, material, transform, instances: vec![] });
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let (mut normal, mut center) = ([0.0; 3], [0.0; 3]);
            (normal[axis], center[axis]) = (side, side * HALF[axis]);
            // As `Rectangle` has it: up is y, but z for floors and ceilings.
            let [width, height] = [[2, 1], [0, 2], [0, 1]][axis];
            let size = [2.0 * HALF[width], 2.0 * HALF[height]];
            six.planes.push(Plane { transform: steps.to_vec(), ..Plane::new(center, normal, size, "it") });
        }
    }
    vec![("exact box", one), ("six planes", six)]
}

/// An outward mesh without curvature: of some vertices on a sphere the faces that have all others behind them.
fn hull(vertices: Vec<Vec3>) -> TriangleMesh {
    let count = vertices.len() as u32;
    let mut faces = Vec::new();
    for a in 0..count {
        for b in 0..count {
            for c in (a + 1)..count {
                let corners = [a, b, c].map(|v| vertices[v as usize]);
                let n = triangle::normal(corners);
                let behind =
                    (0..count).all(|v| [a, b, c].contains(&v) || n.dot(vertices[v as usize] - corners[0]) < -1e-9);
                if b > a && b != c && behind {
                    faces.push([a, b, c]);
                }
            }
        }
    }
    // Both orders of each face were asked for; the outward one has everything behind it.
    TriangleMesh { vertices, faces, ..TriangleMesh::default() }
}

fn icosahedron() -> TriangleMesh {
    let golden = f64::midpoint(1.0, 5.0f64.sqrt());
    let vertices = [-1.0, 1.0].into_iter().flat_map(|a| [-golden, golden].map(|b| (a, b)));
    hull(vertices.flat_map(|(a, b)| [Vec3::new(0.0, a, b), Vec3::new(a, b, 0.0), Vec3::new(b, 0.0, a)]).collect())
}

fn octahedron() -> TriangleMesh {
    hull(
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
            .iter()
            .flat_map(|&v| [Vec3::from(v), -Vec3::from(v)])
            .collect(),
    )
}

fn convex() -> Vec<(&'static str, TriangleMesh)> {
    let one = Vec3::from(HALF);
    vec![
        ("box", tessellate::cuboid(-one, one)),
        ("octahedron", octahedron()),
        ("icosahedron", icosahedron()),
        ("lathe", tessellate::lathe(&[[0.0, -1.0], [0.8, -0.9], [1.0, 0.0], [0.7, 0.8], [0.0, 1.0]], 24)),
        ("brilliant", Cut::default().brilliant().solid.mesh()),
    ]
}

/// A scene with one opaque mesh.
fn stage(geometry: TriangleMesh, material: Material) -> Scene {
    let render = Render { shadows: Some(Shadows::Opaque), ..Render::new(Integrator::Whitted, [1, 1]) };
    let camera = Camera::new([0.0, 0.0, 1.0], [0.0; 3], [0.0, 1.0, 0.0], [-1.0, 1.0, -1.0, 1.0], -1.0);
    let mut scene = Scene::new(render, camera);
    scene.materials.insert("it".to_owned(), material);
    mesh(&mut scene, geometry, "it");
    scene
}

/// Turns the camera of a world, from its eye to a point.
fn aim(scene: &Scene, world: &mut World, eye: Vec3, at: Vec3, size: f64) {
    let up = if (at - eye).unit().y.abs() > 0.9 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let camera = Camera::new(
        [eye.x, eye.y, eye.z],
        [at.x, at.y, at.z],
        up,
        [-size, size, -size, size],
        -0.5 * (at - eye).length(),
    );
    world.stage.camera = camera.frame(&scene.render);
}

/// What is seen there.
fn look(scene: &Scene, world: &mut World, eye: Vec3, at: Vec3, size: f64) -> Rgb {
    aim(scene, world, eye, at, size);
    traced(scene, world, 0, 0).0
}

/// Where to aim: the corners of a mesh and some points on its edges, and which faces meet there.
fn places(mesh: &TriangleMesh) -> Vec<(Vec3, Vec<usize>)> {
    let mut places = Vec::new();
    for (v, &at) in mesh.vertices.iter().enumerate() {
        let around = (0..mesh.faces.len()).filter(|&f| mesh.faces[f].contains(&(v as u32)));
        places.push((at, around.collect()));
    }
    for &[a, b, c] in &mesh.faces {
        for (p, q) in [(a, b), (b, c), (c, a)].into_iter().filter(|(p, q)| p < q) {
            let around: Vec<usize> =
                (0..mesh.faces.len()).filter(|&f| mesh.faces[f].contains(&p) && mesh.faces[f].contains(&q)).collect();
            for share in [0.5, 0.123] {
                let [p, q] = [p, q].map(|v| mesh.vertices[v as usize]);
                places.push((p + (q - p) * share, around.clone()));
            }
        }
    }
    places.retain(|(_, faces)| !faces.is_empty());
    places
}

/// Convex opaque solids, looked at exactly on edges and corners: each pixel is that of one of the faces there. A solid that shades
/// or mirrors itself, or lets light or a reflection through a seam, has another value.
#[test]
fn convex_solids_do_not_shade_or_mirror_themselves() {
    let mut numbers = Numbers(0);
    let mut aimed = 0;
    for (name, shape) in convex() {
        for (exponent, offset) in [(0, 0.0), (20, 0.0), (-20, 0.0), (0, 1e5)] {
            let size = libm::exp2(f64::from(exponent));
            let plain = offset == 0.0 && exponent == 0;
            let steps = if plain { vec![] } else { somewhere(&mut numbers, size, offset * size) };
            let map = whole(&steps);
            let placed = shape.transformed(&map);
            let middle = map.apply(Vec3::<f64>::default());
            for round in 0..3 {
                let eye = middle + numbers.direction() * (size * [4.0, 30.0, 7.0][round]);
                let light = middle + ((eye - middle).unit() + numbers.direction() * 0.8).unit() * (size * 9.0);
                let black = Rgb::gray(0.0);
                let chalk = Material { ka: black, kd: Rgb::gray(1.0), ks: black, kr: black, ..Material::default() };
                let mirror = Material { ka: black, kd: black, ks: black, kr: Rgb::gray(1.0), ..Material::default() };
                let mut lit = stage(placed.clone(), chalk);
                lit.lights.push(point_light(light));
                let mut mirrored = stage(placed.clone(), mirror);
                let [horizon, zenith, nadir] = [[0.5, 0.5, 0.5], [1.0, 0.5, 0.0], [0.0, 0.5, 1.0]].map(Rgb::from);
                let (horizon, zenith, nadir) = (Some(horizon), Some(zenith), Some(nadir));
                mirrored.sky =
                    Some(Sky { horizon, zenith, nadir, image: None, brightness: 1.0, rotate: 0.0, pixels: None });
                // The world's size follows from its camera, too.
                for scene in [&mut lit, &mut mirrored] {
                    scene.camera.eye = [eye.x, eye.y, eye.z];
                    scene.camera.look_at = [middle.x, middle.y, middle.z];
                }
                // Of planes by themselves the back shows at an outline.
                let [others, others_mirrored] = [&lit, &mirrored].map(|scene| exact(name, scene, &steps));
                let others = others.into_iter().zip(others_mirrored).take(1);
                let scenes = others.map(|((name, lit), (_, mirrored))| (name, lit, mirrored));
                for (name, lit, mirrored) in [(name, lit, mirrored)].into_iter().chain(scenes) {
                    let [mut lit_world, mut mirrored_world] = [&lit, &mirrored].map(|scene| World::new(scene).unwrap());
                    for (at, around) in places(&placed) {
                        let wo = (eye - at).unit();
                        let normals: Vec<Vec3> = around.iter().map(|&f| triangle::normal(placed.corners(f))).collect();
                        if normals.iter().any(|n| n.dot(wo).abs() < 1e-3) {
                            // Edge on, and what it shows is anybody's guess.
                            continue;
                        }
                        let outline = normals.iter().any(|n| n.dot(wo) < 0.0);
                        let normals: Vec<Vec3> = normals.into_iter().filter(|n| n.dot(wo) > 0.0).collect();
                        if normals.is_empty() {
                            continue;
                        }
                        aimed += 1;
                        // Along the outline the ray may pass, and the sky is what is seen.
                        let seen = look(&lit, &mut lit_world, eye, at, size).r;
                        let wi = (light - at).unit();
                        let mut expected: Vec<f64> = normals.iter().map(|n| n.dot(wi).max(0.0)).collect();
                        expected.extend(outline.then_some(0.0));
                        // Directions err by what places are rounded to, far away by 1e5·2^-53, thirty times that where the eye aims.
                        let fits = expected.iter().any(|e| (e - seen).abs() < 1e-9);
                        assert!(
                            fits,
                            "{name}, 2^{exponent}, {offset} away: {seen} at {at:?}, expected one of {expected:?}"
                        );
                        let seen = look(&mirrored, &mut mirrored_world, eye, at, size).r;
                        let heights = normals.iter().map(|&n| (n * (2.0 * n.dot(wo)) - wo).unit().y);
                        let expected: Vec<f64> =
                            heights.chain(outline.then_some(-wo.y)).map(|y| 0.5 + 0.5 * y).collect();
                        let fits = expected.iter().any(|e| (e - seen).abs() < 1e-9);
                        assert!(
                            fits,
                            "{name}, 2^{exponent}, {offset} away: {seen} in the mirror at {at:?}, not {expected:?}"
                        );
                    }
                }
            }
        }
    }
    assert!(aimed > 5000, "{aimed} places");
}

/// Rooms seen from inside, exactly into their edges and corners: no light comes in from outside, and no mirror shows what is there.
#[test]
fn the_corners_of_a_room_do_not_leak() {
    let mut numbers = Numbers(700);
    for (name, shape) in convex() {
        for (size, offset) in [(1.0, 0.0), (libm::exp2(-20.0), 0.0), (3.0, 3e5)] {
            let steps = somewhere(&mut numbers, size, offset);
            let map = whole(&steps);
            let placed = shape.transformed(&map);
            let middle = map.apply(Vec3::<f64>::default());
            let eye = middle + numbers.direction() * (0.1 * size);
            let black = Rgb::gray(0.0);
            let material =
                Material { ka: black, kd: Rgb::gray(1.0), ks: black, kr: Rgb::gray(1.0), ..Material::default() };
            let mut scene = stage(placed.clone(), material);
            scene.camera.eye = [eye.x, eye.y, eye.z];
            scene.background = Rgb::gray(1.0);
            scene.render.max_depth = 6;
            for _ in 0..4 {
                let light = middle + numbers.direction() * (5.0 * size);
                scene.lights.push(point_light(light));
            }
            for shadows in [Shadows::Opaque, Shadows::Tinted] {
                scene.render.shadows = Some(shadows);
                for (name, scene) in [(name, scene.clone())].into_iter().chain(exact(name, &scene, &steps)) {
                    let mut world = World::new(&scene).unwrap();
                    for (at, _) in places(&placed) {
                        let seen = look(&scene, &mut world, eye, at, size);
                        assert_eq!(seen, black, "{name}, {size} large, {offset} away, {shadows:?}, at {at:?}");
                    }
                }
            }
        }
    }
}

fn point_light(at: Vec3) -> Light {
    let position = Some([at.x, at.y, at.z]);
    Light { name: None, position, direction: None, target: None, cone: None, edge: None, color: Rgb::gray(1.0) }
}

/// A wall on a floor. What is next to it, be it a billionth of its size, lies in its shadow and in its mirror image.
#[test]
fn what_is_near_a_wall_is_in_its_shadow() {
    for (size, offset) in [(1.0, 0.0), (libm::exp2(-20.0), 0.0), (libm::exp2(20.0), 0.0), (1.0, 1e3)] {
        let at = |x: f64, y: f64, z: f64| Vec3::new(x * size, y * size, z * size) + Vec3::new(offset, -offset, offset);
        // A rectangle each, both sides of the foot of the wall being inside of the floor's triangles, and on its diagonal.
        let quad = |corners: [Vec3; 4]| TriangleMesh {
            vertices: corners.to_vec(),
            faces: vec![[0, 1, 2], [0, 2, 3]],
            ..TriangleMesh::default()
        };
        let floor = quad([at(-1.0, 0.0, -1.0), at(-1.0, 0.0, 1.0), at(1.0, 0.0, 1.0), at(1.0, 0.0, -1.0)]);
        let wall = quad([at(0.0, 0.0, -1.0), at(0.0, 1.0, -1.0), at(0.0, 1.0, 1.0), at(0.0, 0.0, 1.0)]);
        let black = Rgb::gray(0.0);
        let chalk = Material { ka: black, kd: Rgb::gray(1.0), ks: black, kr: black, ..Material::default() };
        let mirror = Material { ka: black, kd: black, ks: black, kr: Rgb::gray(1.0), ..Material::default() };
        let red = Material { ka: Rgb::new(1.0, 0.0, 0.0), kd: black, ks: black, ..Material::default() };
        let light = at(-0.7, 0.6, 0.1);
        for z in [-0.31, 0.0, 0.313] {
            // In roundings of the coordinates there is nothing nearer than this, where the scene is away.
            let nearest = if offset > 0.0 { 1e-6 } else { 1e-9 };
            for x in [0.0, nearest, 1e-5, 1e-3, 0.1] {
                for side in [1.0, -1.0] {
                    let eye = at(side * 0.8, 0.5, z + 0.2);
                    let place = at(side * x, 0.0, z);
                    let mut scene = stage(floor.clone(), chalk.clone());
                    mesh(&mut scene, wall.clone(), "it");
                    scene.camera.eye = [eye.x, eye.y, eye.z];
                    scene.lights.push(point_light(light));
                    let seen = look(&scene, &mut World::new(&scene).unwrap(), eye, place, size).r;
                    let toward = (light - place).unit();
                    if side > 0.0 {
                        assert_eq!(seen, 0.0, "{size}, {offset}: light at {x} behind the wall");
                    } else {
                        // At the very foot the wall may be what is seen.
                        let of_the_floor = (seen - toward.y).abs() < 1e-9;
                        let of_the_wall = x == 0.0 && (seen + toward.x).abs() < 1e-9;
                        assert!(of_the_floor || of_the_wall, "{size}, {offset}: {seen} at {x} before the wall");
                    }
                    let mut scene = stage(floor.clone(), mirror.clone());
                    scene.materials.insert("red".to_owned(), red.clone());
                    mesh(&mut scene, wall.clone(), "red");
                    (scene.ambient, scene.background) = (Rgb::gray(1.0), Rgb::new(0.0, 0.0, 1.0));
                    scene.camera.eye = [eye.x, eye.y, eye.z];
                    let seen = look(&scene, &mut World::new(&scene).unwrap(), eye, place, size);
                    assert_eq!(seen, Rgb::new(1.0, 0.0, 0.0), "{size}, {offset}: the wall, {side}·{x} from its foot");
                }
            }
        }
    }
}

/// Another object that is stretched much, and hit where it stands only to some roundings of its own, takes no shadow away.
#[test]
fn a_stretched_instance_leaves_shadows_alone() {
    let black = Rgb::gray(0.0);
    let chalk = Material { ka: black, kd: Rgb::gray(1.0), ks: black, ..Material::default() };
    let level =
        |y: f64, half: f64| tessellate::rectangle(Vec3::new(0.0, y, 0.0), Vec3::new(0.0, 1.0, 0.0), [half, half]);
    for gap in [1e-8, 1e-9] {
        let mut scene = stage(level(0.0, 4.0), chalk.clone());
        mesh(&mut scene, level(gap, 1.0), "it");
        mesh(&mut scene, tessellate::cuboid(Vec3::new(-0.1, -0.1, -0.1), Vec3::new(0.1, 0.1, 0.1)), "it");
        let stretched = |x: f64| vec![Transform::Scale([1.0, 1e-6, 1.0]), Transform::Move([x, 1.0, 0.0])];
        scene.meshes[2].instances = vec![stretched(3.0), stretched(-3.0)];
        scene.lights.push(point_light(Vec3::new(0.3, 3.0, 0.2)));
        // Between the floor and the plate, looking at the floor.
        let eye = Vec3::new(2.0, 0.5 * gap, 0.0);
        scene.camera.eye = [eye.x, eye.y, eye.z];
        let seen = look(&scene, &mut World::new(&scene).unwrap(), eye, Vec3::new(0.3, 0.0, 0.0), 1.0);
        assert_eq!(seen, black, "the floor is lit through a plate {gap} above it");
    }
}

/// An eye outside of a solid is outside, also where the line by which that is found out meets an edge or a corner.
#[test]
fn an_eye_in_line_with_an_edge_is_where_it_is() {
    let line = Vec3::new(0.309_016_994_374_947_4, 0.754_877_666_246_692_7, 0.578_548_4).unit();
    for (name, shape) in convex() {
        let mut scene = stage(shape.clone(), Material::default());
        glass(&mut scene, "it", 1.5, 0);
        for (at, _) in places(&shape) {
            let eye = at - line * 9.0;
            scene.camera.eye = [eye.x, eye.y, eye.z];
            scene.camera.look_at = [at.x, at.y, at.z];
            let (_, tree) = traced(&scene, &World::new(&scene).unwrap(), 0, 0);
            assert_eq!(tree.nodes[0].medium, None, "{name}: the eye is before {at:?}");
        }
    }
}

/// On a smoothed convex mesh nothing stands between a light and the faces that look at it.
#[test]
fn a_smooth_solid_does_not_shade_itself() {
    for (size, offset) in [(1.0, 0.0), (libm::exp2(-20.0), 0.0), (libm::exp2(20.0), 0.0), (1.0, 1e5)] {
        let profile: Vec<[f64; 2]> = (0..=12)
            .map(|k| {
                let (sin, cos) = snell::lanes::elementary::sin_cos_degrees(15.0 * f64::from(k));
                [if k == 12 { 0.0 } else { sin }, -cos]
            })
            .collect();
        let map =
            Affine::scaling(Vec3::new(size, size, size)).then(Affine::translation(Vec3::new(offset, offset, 0.0)));
        let ball = tessellate::lathe(&profile, 24).transformed(&map);
        let mut scene = stage(ball, Material { kd: Rgb::gray(1.0), ..Material::default() });
        scene.meshes[0].smooth_angle = 180.0;
        let at = |x: f64, y: f64, z: f64| map.apply(Vec3::<f64>::new(x, y, z));
        let (eye, middle, light) = (at(0.3, 0.4, 6.0), at(0.0, 0.0, 0.0), at(8.0, 4.0, -1.0));
        let half = 0.2 * size;
        scene.camera = Camera::new(
            [eye.x, eye.y, eye.z],
            [middle.x, middle.y, middle.z],
            [0.0, 1.0, 0.0],
            [-half, half, -half, half],
            -size,
        );
        scene.render.size = [61, 61];
        scene.lights.push(point_light(light));
        let world = World::new(&scene).unwrap();
        let mut lit = 0;
        for pixel in 0..61 * 61 {
            let (_, tree) = traced(&scene, &world, pixel % 61, pixel / 61);
            for hit in tree.nodes.iter().filter_map(|node| node.hit.as_ref()) {
                for light in &hit.lights {
                    assert!(light.between.is_empty(), "pixel {pixel}, {size}, {offset}: {:?}", light.between);
                    lit += u32::from(light.facing);
                }
            }
        }
        assert!(lit > 500, "{lit} pixels look at the light");
    }
}

/// A prism over a regular polygon, whose ends are triangles from one corner of the rim on: caps and needles.
fn prism(corners: u32, height: f64) -> TriangleMesh {
    let n = corners;
    let ring = |y: f64| {
        (0..n).map(move |k| {
            let (sin, cos) = snell::lanes::elementary::sin_cos_degrees(360.0 * f64::from(k) / f64::from(n));
            Vec3::new(cos, y, -sin)
        })
    };
    let sides = (0..n).flat_map(|k| [[k, (k + 1) % n, k + n], [(k + 1) % n, (k + 1) % n + n, k + n]]);
    let ends = (1..n - 1).flat_map(|k| [[0, k + 1, k], [n, n + k, n + k + 1]]);
    TriangleMesh {
        vertices: ring(-height).chain(ring(height)).collect(),
        faces: sides.chain(ends).collect(),
        ..TriangleMesh::default()
    }
}

/// Glass of thousands of slivers is white in a white room, and no ray loses count of what it is in.
#[test]
fn glass_of_slivers_has_no_holes() {
    let closed = |radius: f64, height: f64| [[0.0, -height], [radius, -height], [radius, height], [0.0, height]];
    let solids = [
        ("cylinder of 1000", prism(1000, 1.0)),
        ("cylinder of 4096", tessellate::lathe(&closed(1.0, 1.0), 4096)),
        ("lathe of 512", tessellate::lathe(&[[0.0, -1.0], [1.0, -0.8], [0.4, 0.1], [0.9, 0.9], [0.0, 1.0]], 512)),
        ("lathe of 4096", tessellate::lathe(&[[0.0, -1.0], [1.0, -0.8], [0.4, 0.1], [0.9, 0.9], [0.0, 1.0]], 4096)),
        ("disc of 4000", prism(4000, 0.01)),
    ];
    for (name, solid) in solids {
        for (turn, size) in [(0.0, 1.0), (37.0, 1e-6), (37.0, 1e6)] {
            let map = Affine::rotation(Vec3::new(1.0, 0.4, 0.2), turn).unwrap();
            let map = map.then(Affine::scaling(Vec3::new(size, size, size)));
            let mut scene = furnace(24);
            glass(&mut scene, "glass", 1.5, 0);
            mesh(&mut scene, solid.transformed(&map), "glass");
            let [eye, half] = [[3.0, 4.0, 5.0].map(|c: f64| c * size), [size, 0.0, 0.0]];
            scene.camera =
                Camera::new(eye, [0.0; 3], [0.0, 1.0, 0.0], [-half[0], half[0], -half[0], half[0]], -4.0 * size);
            let world = World::new(&scene).unwrap();
            for pixel in 0..24 * 24 {
                let (radiance, tree) = traced(&scene, &world, pixel % 24, pixel / 24);
                for channel in (radiance + tree.lost).to_array() {
                    // Some hundred rays, each with a few roundings of 1e-16.
                    assert!((channel - 1.0).abs() < 1e-12, "{name}, {size} large: {channel} in pixel {pixel}");
                }
            }
            scene.render.size = [96, 96];
            assert_eq!(strays(&scene), None, "{name}, {size} large");
        }
    }
}

/// What W007 says of a picture.
fn strays(scene: &Scene) -> Option<String> {
    let world = World::new(scene).unwrap();
    let statistics: Statistics = render(&world, &Settings::from(scene), &Options::default()).unwrap().statistics;
    let warnings = snell::render::warnings(&statistics, &world, &Settings::from(scene));
    warnings.into_iter().find(|w| w.code == WarningCode::StrayExit).map(|w| w.message)
}

/// Glass solids looked at exactly on their edges and corners, from all sides and along their axes of symmetry: every ray finds its
/// way out, and in a white room all is white.
#[test]
fn glass_is_left_at_its_edges() {
    let mut numbers = Numbers(4000);
    let mut aimed = 0;
    for (name, shape) in convex() {
        for (size, offset) in [(1.0, 0.0), (libm::exp2(-20.0), 0.0), (3.0, 3e5)] {
            let steps = somewhere(&mut numbers, size, offset);
            let steps = if offset == 0.0 && size == 1.0 { vec![] } else { steps };
            let map = whole(&steps);
            let placed = shape.transformed(&map);
            let mut scene = stage(placed.clone(), Material::default());
            glass(&mut scene, "it", 1.5168, 0);
            (scene.background, scene.render.max_depth) = (Rgb::gray(1.0), 8);
            let middle = map.apply(Vec3::<f64>::default());
            for eye in [middle + numbers.direction() * (6.0 * size), map.apply(Vec3::new(3.0, 3.0, 3.0))] {
                scene.camera.eye = [eye.x, eye.y, eye.z];
                let others = exact(name, &scene, &steps).into_iter().filter(|(name, _)| *name == "exact box");
                for (name, scene) in [(name, scene.clone())].into_iter().chain(others) {
                    let mut world = World::new(&scene).unwrap();
                    for (at, _) in places(&placed).into_iter().chain([(middle, vec![])]) {
                        aim(&scene, &mut world, eye, at, size);
                        let (radiance, tree) = traced(&scene, &world, 0, 0);
                        let whole = (radiance + tree.lost).r;
                        assert!((whole - 1.0).abs() < 1e-12, "{name}, {size} large, {offset} away: {whole} at {at:?}");
                        let statistics =
                            render(&world, &Settings::from(&scene), &Options::default()).unwrap().statistics;
                        assert_eq!(statistics.stray.count, 0, "{name}, {size} large, {offset} away, at {at:?}");
                        aimed += 1;
                    }
                }
            }
        }
    }
    assert!(aimed > 5000, "{aimed} places");
}

/// Rays by the million through boxes of glass of every proportion, turned and skewed, that touch, overlap and stand in each other:
/// each finds its way out of what it has gone into.
#[test]
fn no_ray_is_lost_in_boxes_of_glass() {
    let mut numbers = Numbers(9000);
    let mut rays = 0;
    for (size, offset) in [(1.0, 0.0), (1e-9, 0.0), (1e9, 0.0), (1.0, 1e8)] {
        for thin in [1.0, 1e-3, 1e-6, 1e-12] {
            let mut scene = stage(TriangleMesh::default(), Material::default());
            scene.meshes.clear();
            (scene.background, scene.render.max_depth, scene.render.size) = (Rgb::gray(1.0), 12, [96, 96]);
            glass(&mut scene, "it", 1.5, 0);
            glass(&mut scene, "water", 1.33, 1);
            let place = [Transform::Scale([size; 3]), Transform::Move([offset, -offset, offset])];
            let mut put = |min: [f64; 3], max: [f64; 3], material: &str, own: &[Transform]| {
                let (material, transform) = (material.to_owned(), [own, &place].concat());
                scene.boxes.push(Cuboid { name: None, min, max, material, transform, instances: vec![] });
            };
            put([-1.0, -1.0, -thin], [0.0, 1.0, thin], "it", &[]);
            put([0.0, -1.0, -thin], [1.0, 0.5, thin], "it", &[]);
            put([-0.5, -0.5, -0.5], [0.5, 0.7, 0.5], "water", &[]);
            for _ in 0..3 {
                let skew = |numbers: &mut Numbers| Transform::Rotate {
                    axis: numbers.direction().into(),
                    degrees: 180.0 * numbers.next(),
                };
                let own = [skew(&mut numbers), Transform::Scale([1.0, 0.3, -2.0]), skew(&mut numbers)];
                put([-0.6, -0.4, -thin], [0.6, 0.4, thin], "it", &own);
            }
            let at = |p: Vec3| (p * size + Vec3::new(offset, -offset, offset)).into();
            for _ in 0..2 {
                scene.camera = Camera::new(
                    at(numbers.direction() * 5.0),
                    at(numbers.direction() * 0.1),
                    [0.3, 1.0, 0.2],
                    [-1.0, 1.0, -1.0, 1.0].map(|b| b * size),
                    -2.0 * size,
                );
                let world = World::new(&scene).unwrap();
                let rendered = render(&world, &Settings::from(&scene), &Options::default()).unwrap();
                rays += rendered.statistics.depth.iter().sum::<u64>();
                // Far away a box thinner than the roundings of its place is in any order with what is beside it.
                if offset == 0.0 || thin > 1e-3 {
                    assert_eq!(rendered.statistics.stray.count, 0, "{size}, {offset} away, {thin} thin");
                }
            }
        }
    }
    assert!(rays > 1_000_000, "{rays} rays");
}

fn parsed(text: &str) -> Scene {
    scene_file::parse(&Source::new("test.toml", text), Syntax::Toml).unwrap()
}

/// A plane that is looked at straight on, its diagonal through the middle of many pixels.
#[test]
fn a_wall_seen_straight_on_is_lit() {
    let scene = parsed(
        r#"
        snell = 1
        [render]
        integrator = "whitted"
        shadows = "opaque"
        size = [301, 301]
        [camera]
        eye = [0.3, 1.1, 2.7]
        look_at = [0.3, 1.1, -0.7]
        up = [0, 1, 0]
        fov = 40
        [[light]]
        position = [1, 2, 2]
        color = 0.8
        [material.m]
        ka = 0
        kd = 1
        ks = 0
        [[plane]]
        center = [0.3, 1.1, -0.7]
        normal = [0, 0, 1]
        size = [6, 6]
        material = "m"
        "#,
    );
    let world = World::new(&scene).unwrap();
    let film = picture(&scene);
    for (number, pixel) in (0..).zip(&film.pixels) {
        let (origin, dir) = world.camera.ray(number % 301, number / 301);
        let point = origin + dir * ((-0.7 - origin.z) / dir.z);
        let expected = 0.8 * (Vec3::new(1.0, 2.0, 2.0) - point).unit().z;
        // The plane's corners are at decimal fractions; a few roundings of lengths of some units.
        assert!((pixel.r - expected).abs() < 1e-14, "{} for {expected} in pixel {number}", pixel.r);
    }
}

/// Half of a white floor, half of the blue sky, whatever triangle of the floor it is.
#[test]
fn a_mirror_does_not_show_itself() {
    let scene = parsed(
        r#"
        snell = 1
        ambient = 1
        background = [0, 0, 1]
        [render]
        integrator = "whitted"
        size = [101, 101]
        [camera]
        eye = [3, 4, 3]
        look_at = [0, 0, 0]
        up = [0, 1, 0]
        fov = 30
        [material.f]
        ka = [0.5, 0, 0]
        kd = 0
        ks = 0
        kr = 0.5
        [[plane]]
        center = [0, 0, 0]
        normal = [0, 1, 0]
        size = [20, 20]
        material = "f"
        "#,
    );
    assert!(picture(&scene).pixels.iter().all(|&pixel| pixel == Rgb::new(0.5, 0.0, 0.5)));
}

/// A plate of glass, silvered below: `R + (1 − R)²(1 + R + …) = 1` of the sky above, as if it were a plain mirror.
#[test]
fn silver_on_glass_is_a_mirror() {
    let mut scene = parsed(
        r#"
        snell = 1
        [sky]
        horizon = [0.2, 0.5, 0.5]
        zenith = [1, 0.5, 0.2]
        nadir = [0, 0.1, 1]
        [render]
        integrator = "whitted"
        size = [101, 101]
        max_depth = 30
        min_throughput = 0
        [camera]
        eye = [0, 6, 0]
        look_at = [0, 0, 0]
        up = [0, 0, -1]
        fov = 40
        [material.g]
        ko = 0
        eta = 1.5
        [material.s]
        ka = 0
        kd = 0
        ks = 0
        kr = 1
        [[plane]]
        center = [0, -1, 0]
        normal = [0, 1, 0]
        size = [20, 20]
        material = "s"
        [[box]]
        min = [-10, -1, -10]
        max = [10, 0, 10]
        material = "g"
        "#,
    );
    // With the silver first, and with the glass first, whose faces then have the lower numbers.
    for glass_first in [false, true] {
        if glass_first {
            scene.boxes.clear();
            mesh(&mut scene, tessellate::cuboid(Vec3::new(-10.0, -1.0, -10.0), Vec3::new(10.0, 0.0, 10.0)), "g");
        }
        let (film, world) = (picture(&scene), World::new(&scene).unwrap());
        for (number, pixel) in (0..).zip(&film.pixels) {
            let up = -world.camera.ray(number % 101, number / 101).1.y;
            let expected = Rgb::new(0.2, 0.5, 0.5) * (1.0 - up) + Rgb::new(1.0, 0.5, 0.2) * up;
            // Fifteen ways through the glass leave R¹⁵, and the angle of each is that of the first to a few roundings.
            assert!(close(*pixel, expected, 1e-13), "{pixel:?} for {expected:?} in pixel {number}");
        }
        assert_eq!(strays(&scene), None);
    }
}

/// Planes so thin that a rounding of the distance along them is more than the room that a box leaves.
#[test]
fn planks_have_no_holes() {
    for (aspect, distance) in [(200.0, 1.0), (1e3, 1.0), (1e6, 1.0), (1e9, 1.0), (1e3, 1e3)] {
        for size in [1.0, 1e-9, 1e9] {
            let half = 5.0 / aspect;
            let scale = |corner: [f64; 3]| Vec3::from(corner.map(|c| c * size));
            let corners = [[-half, 0.0, 5.0], [half, 0.0, 5.0], [half, 0.0, -5.0], [-half, 0.0, -5.0]];
            let vertices = corners.map(scale).to_vec();
            let plank = TriangleMesh { vertices, faces: vec![[0, 1, 2], [0, 2, 3]], ..TriangleMesh::default() };
            let mut scene = stage(plank, Material { ka: Rgb::gray(1.0), ..Material::default() });
            scene.ambient = Rgb::gray(1.0);
            let eye = [6.0, 5.0, 7.0].map(|c| c * distance * size);
            // Ten times as wide as the plank.
            let window = 10.0 * half * size;
            scene.camera = Camera::new(
                eye,
                [0.0; 3],
                [0.0, 1.0, 0.0],
                [-window, window, -window, window],
                -Vec3::from(eye).length() * 0.5,
            );
            scene.render.size = [100, 100];
            let (film, world) = (picture(&scene), World::new(&scene).unwrap());
            let mut inside = 0;
            for (number, pixel) in (0..).zip(&film.pixels) {
                let (origin, dir) = world.camera.ray(number % 100, number / 100);
                let at = origin + dir * (-origin.y / dir.y);
                let (x, z) = (at.x.abs() - half * size, at.z.abs() - 5.0 * size);
                // A few roundings of the distance.
                let sure = 1e-15 * 10.5 * distance * size * 4.0;
                if x < -sure && z < -sure {
                    assert_eq!(pixel.r, 1.0, "a hole, 1 : {aspect}, from {distance}, {size} large");
                    inside += 1;
                } else if x > sure || z > sure {
                    assert_eq!(pixel.r, 0.0, "beside, 1 : {aspect}, from {distance}, {size} large");
                }
            }
            assert!(inside > 100, "{inside} pixels of a plank of 1 : {aspect}");
        }
    }
}

/// The files in which these faults were found: what is drawn of one convex solid or plane is in one piece, and no ray is lost in it.
#[test]
fn the_cases_of_light_are_right() {
    let Some(folder) = cases() else { return };
    for name in ["cap-holes", "corner-cube", "cyl1000", "one-plank", "silvered-plate", "wall-seen-straight-on"] {
        let path = folder.join("light").join(format!("{name}.toml"));
        let mut scene = snell_formats::load(path.to_str().unwrap(), &LoadOptions::default()).unwrap().into_scene();
        assert_eq!(strays(&scene), None, "{name}");
        // In a white room glass cannot be seen; and what is opaque and stands out is either there or not.
        let opaque = scene.materials.values().all(|m| m.ko == Rgb::gray(1.0));
        (scene.ambient, scene.sky) = (Rgb::gray(1.0), None);
        scene.background = if opaque { Rgb::gray(2.0) } else { Rgb::gray(1.0) };
        scene.lights.clear();
        scene.materials.values_mut().filter(|m| opaque || m.ko == Rgb::gray(1.0)).for_each(|m| {
            *m = Material {
                ka: Rgb::gray(0.0),
                kd: Rgb::gray(0.0),
                ks: Rgb::gray(0.0),
                kr: m.kr,
                ..Material::default()
            };
        });
        let world = World::new(&scene).unwrap();
        let [width, height] = scene.render.size;
        let mut row = Vec::new();
        for (x, y) in (0..height).step_by(3).flat_map(|y| (0..width).map(move |x| (x, y))) {
            let (radiance, tree) = traced(&scene, &world, x, y);
            let seen = (radiance + tree.lost).r;
            if opaque {
                row.push(seen == 0.0);
                if x + 1 == width {
                    let edges = row.windows(2).filter(|pair| pair[0] != pair[1]).count();
                    assert!(edges <= 2, "{name}: {edges} edges in row {y}");
                    row.clear();
                }
            } else {
                assert!((seen - 1.0).abs() < 1e-12, "{name}: {seen} in pixel {x},{y}");
            }
        }
    }
}
