//! Rays against triangles of every shape, size and place, compared with exact arithmetic of the corners as they were rounded.
//!
//! Random rays find no fault in a triangle test; so these are aimed: at corners, at edges, just beside them, along planes and along
//! axes, at slivers of an aspect up to 10⁹, 2⁻⁶⁰ to 2⁶⁰ in size, up to 10⁶ of their sizes from the origin. `SNELL_SOAK_SECONDS` says
//! how long; without it a few hundred thousand rays are tried.

use super::exact::Exact;
use crate::geometry::area::largest_angle;
use crate::geometry::bvh::{self, MARGIN, PACKET, Packet, Quality, Shapes};
use crate::geometry::ray::{Heading, axes, main_axis};
use crate::geometry::shape::Triangles;
use crate::geometry::{Affine, Bounds, Vec3, triangle};
use crate::lanes::ArrayLanes;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// What a rounding is, relative.
const U: f64 = f64::EPSILON / 2.0;

/// Numbers that only look random (`SplitMix64`; Steele, Lea and Flood, 2014).
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.roll() % count as u64) as usize
    }

    /// From 0 to 1.
    fn share(&mut self) -> f64 {
        (self.roll() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }

    fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.vector();
            if v.length() > 0.1 {
                return v.unit();
            }
        }
    }

    /// A power of ten with any exponent in this range.
    fn power(&mut self, low: f64, high: f64) -> f64 {
        libm::exp10(self.between(low, high))
    }
}

/// Triangles, and a point inside of them if they are convex and closed.
struct Mesh {
    vertices: Vec<Vec3>,
    faces: Vec<[u32; 3]>,
    inside: Option<Vec3>,
}

fn sliver(dice: &mut Dice) -> [Vec3; 3] {
    let (along, across) = (dice.direction(), dice.direction());
    let thin = dice.power(-9.0, 0.0);
    let [a, b] = [Vec3::default(), along];
    match dice.below(4) {
        // A needle, half a plank, and a cap.
        0 => [a, b, b + across * thin],
        1 => [Vec3::default(), Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 0.0, thin)],
        2 => [a, b, along * dice.share() + across * thin],
        _ => [a, b, across],
    }
}

/// A lathe of two ends and some rings between them; with `fans` its flat ends are triangles from one corner of the rim on.
fn lathe(dice: &mut Dice, segments: usize) -> Mesh {
    let height = dice.power(-3.0, 3.0);
    let ring = |y: f64, r: f64| {
        (0..segments).map(move |k| {
            let (sin, cos) = crate::lanes::elementary::sin_cos_degrees(360.0 * k as f64 / segments as f64);
            Vec3::new(r * cos, y, r * sin)
        })
    };
    let n = segments as u32;
    let mut vertices: Vec<Vec3> = ring(-height, 1.0).chain(ring(height, 1.0)).collect();
    let mut faces: Vec<[u32; 3]> =
        (0..n).flat_map(|k| [[k, k + n, (k + 1) % n], [(k + 1) % n, k + n, (k + 1) % n + n]]).collect();
    for (first, y) in [(0, -height), (n, height)] {
        if dice.below(2) == 0 {
            faces.extend((1..n - 1).map(|k| [first, first + k, first + k + 1]));
        } else {
            vertices.push(Vec3::new(0.0, y, 0.0));
            let middle = vertices.len() as u32 - 1;
            faces.extend((0..n).map(|k| [middle, first + k, first + (k + 1) % n]));
        }
    }
    Mesh { vertices, faces, inside: Some(Vec3::default()) }
}

fn octahedron(dice: &mut Dice) -> Mesh {
    let axes = [0, 1, 2].map(|axis: usize| {
        let mut v = [0.0; 3];
        v[axis] = dice.power(-4.0, 0.0);
        Vec3::from(v)
    });
    let vertices = axes.iter().flat_map(|&v| [v, -v]).collect();
    let faces = (0..8).map(|i| [i & 1, 2 + (i >> 1 & 1), 4 + (i >> 2 & 1)]).collect();
    Mesh { vertices, faces, inside: Some(Vec3::default()) }
}

fn plank(dice: &mut Dice) -> Mesh {
    let thin = dice.power(-9.0, 0.0);
    let at = |x: f64, z: f64| Vec3::new(x * thin, 0.0, z);
    let vertices = vec![at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)];
    Mesh { vertices, faces: vec![[0, 1, 2], [0, 2, 3]], inside: None }
}

fn mesh(dice: &mut Dice) -> Mesh {
    match dice.below(6) {
        0 => {
            let segments = 3 + dice.below(40);
            lathe(dice, segments)
        }
        1 => octahedron(dice),
        2 => plank(dice),
        3 => {
            let vertices: Vec<Vec3> = (0..8)
                .flat_map(|_| {
                    let place = dice.vector();
                    sliver(dice).map(|v| v + place)
                })
                .collect();
            Mesh { vertices, faces: (0..8).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect(), inside: None }
        }
        _ => Mesh { vertices: sliver(dice).to_vec(), faces: vec![[0, 1, 2]], inside: None },
    }
}

/// Turned or not, somewhere, of some size.
fn placed(dice: &mut Dice, mut mesh: Mesh) -> Mesh {
    let turn = if dice.below(2) == 0 { Affine::rotation(dice.direction(), dice.between(-180.0, 180.0)) } else { None };
    let turn = turn.unwrap_or(Affine::IDENTITY);
    let offset = if dice.below(3) == 0 { Vec3::default() } else { dice.direction() * dice.power(0.0, 6.0) };
    let size = libm::exp2((dice.below(121) as f64) - 60.0);
    let map = turn.then(Affine::translation(offset)).then(Affine::scaling(Vec3::new(size, size, size)));
    mesh.vertices.iter_mut().for_each(|v| *v = map.apply(*v));
    mesh.inside = mesh.inside.map(|p| map.apply(p));
    for face in &mut mesh.faces {
        let first = largest_angle(face.map(|v| mesh.vertices[v as usize]));
        face.rotate_left(first);
    }
    mesh
}

/// A place on a triangle or beside it, aimed at as a fault would like it.
fn target(dice: &mut Dice, [a, b, c]: [Vec3; 3]) -> Vec3 {
    let on = |p: f64, q: f64| a + (b - a) * p + (c - a) * q;
    let (p, q) = (dice.share(), dice.share());
    match dice.below(5) {
        0 => [a, b, c][dice.below(3)],
        1 => [on(p, 0.0), on(0.0, p), on(p, 1.0 - p)][dice.below(3)],
        2 => {
            let aside = dice.power(-17.0, -1.0) * if dice.below(2) == 0 { 1.0 } else { -1.0 };
            [on(p, aside), on(aside, p), on(p, 1.0 - p + aside)][dice.below(3)]
        }
        3 => on(p * 3.0 - 1.0, q * 3.0 - 1.0),
        _ => on(p * (1.0 - q), q),
    }
}

/// From where to a target; the direction as it was rounded.
fn ray(dice: &mut Dice, at: Vec3, size: f64, corners: [Vec3; 3]) -> Option<(Vec3, Vec3)> {
    let distance = size * dice.power(-2.0, 3.0);
    let from = match dice.below(4) {
        // In the plane of the triangle, and along an axis.
        0 => (corners[1] - corners[0]).unit(),
        1 => {
            let mut axis = [0.0; 3];
            axis[dice.below(3)] = 1.0;
            Vec3::from(axis)
        }
        _ => dice.direction(),
    };
    let origin = at + from * distance;
    let dir = (at - origin).unit();
    (origin.is_finite() && dir.is_finite()).then_some((origin, dir))
}

/// What exact arithmetic says of a line and a triangle, seen along the line.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Truth {
    /// Inside, and from all edges farther than the bound.
    Hits,
    /// Outside, by more than the bound.
    Misses,
    /// Nearer to an edge than what corners are seen at.
    Either,
}

fn truth(origin: Vec3, dir: Vec3, corners: [Vec3; 3]) -> Truth {
    let k = axes(main_axis(dir));
    let heading = Heading::new(dir.permuted(k));
    let seen = corners.map(|v| heading.seen((v - origin).permuted(k)));
    let far = corners.iter().map(|&v| Bounds::of([v - origin]).farthest()).fold(0.0, f64::max);
    let minus = |p: [f64; 2], q: [f64; 2]| [p[0] - q[0], p[1] - q[1]];
    let length = |v: [f64; 2]| (v[0] * v[0] + v[1] * v[1]).sqrt();
    let diameter = (0..3).map(|i| length(minus(seen[i], seen[(i + 1) % 3]))).fold(0.0, f64::max);
    // In two dimensions, and the same again for what this oracle rounds; where products cancel to zero, a rounding of the size.
    let bound = 4.0 * triangle::SEEN * far + 16.0 * U * diameter;
    let distance_to_segment = |p: [f64; 2], q: [f64; 2]| {
        let along = minus(q, p);
        let share =
            (-(p[0] * along[0] + p[1] * along[1]) / (along[0] * along[0] + along[1] * along[1])).clamp(0.0, 1.0);
        let share = if share.is_nan() { 0.0 } else { share };
        length([p[0] + along[0] * share, p[1] + along[1] * share])
    };
    let rim = (0..3).map(|i| distance_to_segment(seen[i], seen[(i + 1) % 3])).fold(f64::INFINITY, f64::min);
    // What is surely on one side of every edge is decided by plain numbers.
    let cross = |p: [f64; 2], q: [f64; 2]| (p[0] * q[1] - p[1] * q[0], 8.0 * U * length(p) * length(q));
    let plain = [cross(seen[2], seen[1]), cross(seen[0], seen[2]), cross(seen[1], seen[0])];
    let moved = 2.0 * triangle::SEEN * far;
    let sure = (0..3).all(|i| {
        let ends = length(seen[(i + 1) % 3]) + length(seen[(i + 2) % 3]);
        plain[i].0.abs() > plain[i].1 + moved * (ends + moved)
    });
    let signs = if sure { plain.map(|p| p.0) } else { Exact::edge_functions(origin, dir, corners) };
    let inside = signs.iter().all(|&s| s > 0.0) || signs.iter().all(|&s| s < 0.0);
    match (inside, rim > bound) {
        (_, false) => Truth::Either,
        (true, true) => Truth::Hits,
        (false, true) => Truth::Misses,
    }
}

#[derive(Default)]
struct Count {
    rays: AtomicU64,
    decided: AtomicU64,
    hits: AtomicU64,
}

/// Some rays at one mesh.
fn attack(dice: &mut Dice, count: &Count, rays: usize) {
    let whole = mesh(dice);
    let mesh = placed(dice, whole);
    let bounds = Bounds::of(mesh.vertices.iter().copied());
    let size = bounds.diagonal();
    let corners: Vec<[Vec3; 3]> = mesh.faces.iter().map(|f| f.map(|v| mesh.vertices[v as usize])).collect();
    let triangles = Triangles { vertices: &mesh.vertices, faces: &mesh.faces };
    let shapes = Shapes { triangles, ..Shapes::default() };
    // Rays start up to a thousand sizes away.
    let margin = MARGIN * (2e3 * size + bounds.farthest());
    let tree = bvh::build(&shapes, vec![], margin, Quality::Good, 1);
    for _ in 0..rays {
        let aimed = corners[dice.below(corners.len())];
        let at = target(dice, aimed);
        let Some((origin, dir)) = ray(dice, at, size, aimed) else { continue };
        let k = axes(main_axis(dir));
        let heading = Heading::new(dir.permuted(k));
        let mut nearest: Option<(f64, usize)> = None;
        for (id, &corners) in corners.iter().enumerate() {
            let hit = triangle::intersect::<f64>(origin.permuted(k), &heading, corners.map(|v| v.permuted(k)));
            let truth = truth(origin, dir, corners);
            let say = || format!("{origin:?} {dir:?} {corners:?}: {hit:?}, but it {truth:?}");
            match truth {
                Truth::Hits => assert!(hit.meets, "{}", say()),
                Truth::Misses => assert!(!hit.meets, "{}", say()),
                Truth::Either => {}
            }
            count.decided.fetch_add(u64::from(truth != Truth::Either), Ordering::Relaxed);
            if truth == Truth::Hits {
                count.hits.fetch_add(1, Ordering::Relaxed);
                let n = Exact::area_vector(corners).unit();
                let off = n.dot(origin + dir * hit.t - corners[0]).abs();
                // The plane is good to 22 roundings of the distance (`Bvh`'s margin has 32), and this sum errs by some more.
                let far = corners.iter().map(|&v| (v - origin).length()).fold(0.0, f64::max);
                assert!(off <= 32.0 * U * (far + bounds.farthest() + origin.length()), "off by {off}: {}", say());
            }
            if hit.meets && hit.t > 0.0 && nearest.is_none_or(|(t, _)| hit.t < t) {
                nearest = Some((hit.t, id));
            }
        }
        // In lanes, through the tree, alone and in a packet.
        let mut packet = Packet::default();
        for copies in [1, PACKET] {
            type Four = ArrayLanes<4>;
            for start in (0..copies).step_by(4) {
                let [t_min, t_max, source] = [0.0, f64::INFINITY, -1.0].map(<Four as crate::lanes::Lanes>::splat);
                packet.set(start, origin.splat(), dir.splat(), t_min, t_max, source, true);
            }
            let hit = tree.intersect::<Four, false>(&mut packet, u64::MAX >> (PACKET - copies));
            let found = (hit & 1 == 1).then_some((packet.t[0], packet.primitive[0] as usize));
            assert_eq!(found, nearest, "in the tree: {origin:?} {dir:?}");
        }
        if let Some(inside) = mesh.inside {
            // Nothing leaks: from within there is a way to every place, and every one ends at the surface.
            let dir = (at - inside).unit();
            if dir.is_finite() && bounds.farthest() < 1e6 * size {
                let k = axes(main_axis(dir));
                let heading = Heading::new(dir.permuted(k));
                let leaves = corners.iter().any(|&c| {
                    let hit = triangle::intersect::<f64>(inside.permuted(k), &heading, c.map(|v| v.permuted(k)));
                    hit.meets && hit.t > 0.0
                });
                assert!(leaves, "out of {inside:?} {dir:?}: {:?}", mesh.vertices);
            }
        }
        count.rays.fetch_add(1, Ordering::Relaxed);
    }
}

#[test]
fn rays_at_slivers_hit_what_exact_arithmetic_says() {
    let seconds = std::env::var("SNELL_SOAK_SECONDS").ok().and_then(|s| s.parse::<u64>().ok());
    let (count, start) = (Count::default(), Instant::now());
    let limit = seconds.map(Duration::from_secs);
    // A soak begins elsewhere each time.
    let seed = limit.map_or(0, |_| u64::from(std::process::id()));
    std::thread::scope(|scope| {
        for worker in 0..2 {
            let count = &count;
            scope.spawn(move || {
                let mut dice = Dice(seed << 8 | worker);
                let mut meshes = 0u64;
                while limit.map_or(meshes < 2000, |limit| start.elapsed() < limit) {
                    attack(&mut dice, count, 64);
                    meshes += 1;
                }
            });
        }
    });
    let [rays, decided, hits] = [&count.rays, &count.decided, &count.hits].map(|n| n.load(Ordering::Relaxed));
    #[expect(clippy::print_stdout, reason = "what a soak is run for")]
    {
        println!(
            "seed {seed}: {rays} rays; {decided} times a ray and a triangle decided, {hits} of them hits; none wrong"
        );
    }
    assert!(rays > 200_000 && hits > rays / 8, "aimed badly: {rays} rays, {hits} hits");
}
