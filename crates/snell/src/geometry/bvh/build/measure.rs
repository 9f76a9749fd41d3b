//! Boxes like those of real scenes; times and figures of their trees, for whoever changes the builder:
//! `cargo test --profile ci -p snell --lib build::measure -- --ignored --nocapture`.

use super::*;
use crate::geometry::bvh::node::{Kind, WIDTH};
use crate::geometry::shape::Surface;
use crate::geometry::{Bounds, Sphere, Vec3};

/// The knot of `n` rings of `m` quads, on a floor of two triangles: 2nm + 2 boxes.
pub(super) fn knot(n: usize, m: usize) -> Vec<OuterBox> {
    let tau = std::f64::consts::TAU;
    let ring = |i: usize| {
        let u = tau * i as f64 / n as f64;
        let (s2, c2, s3, c3) = (libm::sin(2.0 * u), libm::cos(2.0 * u), libm::sin(3.0 * u), libm::cos(3.0 * u));
        let a = 2.0 + c3;
        let c = Vec3::new(a * c2, a * s2, s3);
        let t = Vec3::new(-3.0 * s3 * c2 - 2.0 * a * s2, -3.0 * s3 * s2 + 2.0 * a * c2, 3.0 * c3);
        let b = t.cross(c).unit();
        (c, b, b.cross(t).unit())
    };
    let rings: Vec<Vec<Vec3>> = (0..n)
        .map(|i| {
            let (c, b, n) = ring(i);
            let point = |j: usize| {
                let v = tau * j as f64 / m as f64;
                c + (n * libm::cos(v) + b * libm::sin(v)) * 0.45
            };
            (0..m).map(point).collect()
        })
        .collect();
    let outer = |corners: [Vec3; 3]| OuterBox::around(&Bounds::of(corners), 1e-13);
    let mut boxes = Vec::new();
    for i in 0..n {
        for j in 0..m {
            let (here, next, k) = (&rings[i], &rings[(i + 1) % n], (j + 1) % m);
            boxes.push(outer([here[j], next[j], next[k]]));
            boxes.push(outer([here[j], next[k], here[k]]));
        }
    }
    let [a, b, c, d] = [(-12.0, -12.0), (12.0, -12.0), (12.0, 12.0), (-12.0, 12.0)].map(|(x, y)| Vec3::new(x, y, -1.6));
    boxes.extend([outer([a, b, c]), outer([a, c, d])]);
    boxes
}

/// Spheres on spheres, nine on each, of a third of its size (Haines, *A Proposal for Standard Graphics Environments*,
/// 1987): 1 + 9 + … + 9^levels boxes, and a floor.
pub(super) fn flake(levels: usize) -> Vec<OuterBox> {
    fn grow(level: usize, at: Vec3, radius: f64, up: Vec3, boxes: &mut Vec<OuterBox>) {
        boxes.push(OuterBox::around(&Sphere { center: at, radius }.bounds(), 1e-13));
        if level == 0 {
            return;
        }
        for child in 0..9 {
            let azimuth = if child < 6 { 15 + 60 * child } else { 45 + 120 * (child - 6) };
            let azimuth = f64::from(azimuth) * std::f64::consts::PI / 180.0;
            let height = if child < 6 { 0.0 } else { libm::sqrt(2.0 / 3.0) };
            let out = libm::sqrt(1.0 - height * height);
            let d = Vec3::new(out * libm::cos(azimuth), out * libm::sin(azimuth), height);
            // The turn that takes (0, 0, 1) to `up`.
            let (k, c) = (Vec3::new(-up.y, up.x, 0.0), up.z);
            let d =
                if c <= -1.0 { Vec3::new(d.x, -d.y, -d.z) } else { d * c + k.cross(d) + k * (k.dot(d) / (1.0 + c)) };
            grow(level - 1, at + d * (radius * 4.0 / 3.0), radius / 3.0, d, boxes);
        }
    }
    let mut boxes = Vec::new();
    grow(levels, Vec3::default(), 0.5, Vec3::new(0.0, 0.0, 1.0), &mut boxes);
    boxes.extend([OuterBox { min: [-12.0, -12.0, -0.6], max: [12.0, 12.0, -0.5] }; 2]);
    boxes
}

/// Boxes of all sizes and proportions, like the long and thin triangles of a building: a fixed sequence of random ones.
pub(super) fn sticks(count: usize) -> Vec<OuterBox> {
    let mut state = 1u64;
    let mut random = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1u64 << 24) as f32
    };
    (0..count)
        .map(|_| {
            let min = [random(), random(), random()].map(|x| x * 100.0);
            let size = [random(), random(), random()].map(|x| 0.01 + x * x * x * x * x * x * 5.0);
            OuterBox { min, max: [min[0] + size[0], min[1] + size[1], min[2] + size[2]] }
        })
        .collect()
}

/// A small knot in the middle of sticks, a thousandth of their space.
pub(super) fn stadium(rings: usize) -> Vec<OuterBox> {
    let mut boxes = sticks(rings * 50);
    boxes.extend(knot(rings, 50).into_iter().map(|b| {
        let there = |x: f32| 50.0 + x * 0.01;
        OuterBox { min: b.min.map(there), max: b.max.map(there) }
    }));
    boxes
}

/// Expected cost of a ray that meets the root.
pub(super) fn cost(tree: &Tree) -> f64 {
    let area = |min: [f32; 3], max: [f32; 3]| {
        let d = [0, 1, 2].map(|i| f64::from(max[i]) - f64::from(min[i]));
        d[0] * d[1] + d[1] * d[2] + d[2] * d[0]
    };
    let (mut all, mut root) = (0.0, OuterBox { min: [f32::INFINITY; 3], max: [f32::NEG_INFINITY; 3] });
    for (index, node) in tree.nodes.iter().enumerate() {
        for place in 0..WIDTH {
            let OuterBox { min, max } = node.bounds(place);
            match node.child[place].kind() {
                Kind::Node(_) => all += collapse::NODE_COST * area(min, max),
                Kind::Leaf(leaf) => all += collapse::leaf_cost(tree.leaves[leaf as usize].count, area(min, max)),
                Kind::Nothing | Kind::Block(_) => continue,
            }
            if index == 0 {
                for i in 0..3 {
                    root.min[i] = root.min[i].min(min[i]);
                    root.max[i] = root.max[i].max(max[i]);
                }
            }
        }
    }
    collapse::NODE_COST + all / area(root.min, root.max)
}

#[test]
#[ignore = "prints figures, checks nothing"]
#[expect(clippy::print_stdout, reason = "its purpose")]
fn figures() {
    let scenes =
        [("knot", knot(2000, 250)), ("flake", flake(5)), ("sticks", sticks(200_000)), ("stadium", stadium(1000))];
    for (name, boxes) in &scenes {
        for quality in [Quality::Fast, Quality::Good, Quality::Best] {
            let mut times = [Vec::new(), Vec::new()];
            let mut tree = Tree::default();
            for _ in 0..5 {
                for (threads, times) in [1, 2].into_iter().zip(&mut times) {
                    let start = std::time::Instant::now();
                    tree = threads::share(threads, |parallel| build(boxes.len(), |i| boxes[i], quality, parallel));
                    times.push(start.elapsed().as_secs_f64() * 1e3);
                }
            }
            let [one, two] = times.map(|times| times.into_iter().fold(f64::INFINITY, f64::min));
            let Tree { nodes, leaves, order, depth } = &tree;
            let used = nodes.iter().flat_map(|n| n.child).filter(|c| c.kind() != Kind::Nothing).count();
            let bytes = size_of_val(&nodes[..]) + size_of_val(&leaves[..]) + size_of_val(&order[..]);
            println!(
                "{name:8} {quality:?}: {one:6.1} ms, two threads {two:6.1} ms; cost {:.3}; {} nodes of {:.2}, {} leaves of {:.2}, \
                 depth {depth}, {:.1} MB",
                cost(&tree),
                nodes.len(),
                used as f64 / nodes.len() as f64,
                leaves.len(),
                order.len() as f64 / leaves.len() as f64,
                bytes as f64 / 1e6
            );
        }
    }
}
