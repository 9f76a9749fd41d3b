//! All places where one ray crosses something, within a range of distances: slow, for the few rays that need it.

use super::Bvh;
use super::node::{Child, Kind, Node, WIDTH, plane};
use super::primitives::{SPHERE, TRIANGLE};
use crate::geometry::ray::{Shear, axes, inverse, main_axis};
use crate::geometry::{Vec3, sphere, triangle};

impl Bvh {
    /// Appends every crossing from `range[0]` to `range[1]`, both included: distance and primitive, by distance and then by
    /// id. `dir` of unit length.
    pub(crate) fn crossings(&self, origin: Vec3, dir: Vec3, range: [f64; 2], found: &mut Vec<(f64, u32)>) {
        let before = found.len();
        self.collect(origin, dir, range, 0, found);
        found[before..].sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    }

    fn collect(&self, origin: Vec3, dir: Vec3, range: [f64; 2], first_id: u32, found: &mut Vec<(f64, u32)>) {
        if self.nodes.is_empty() {
            return;
        }
        let mut waiting = vec![Child::ROOT];
        while let Some(child) = waiting.pop() {
            match child.kind() {
                Kind::Node(number) => {
                    let node = &self.nodes[number as usize];
                    let met = (0..WIDTH).filter(|&place| meets(node, place, origin, dir, range));
                    waiting.extend(met.map(|place| node.child[place]));
                }
                Kind::Block(_) => self.collect_in_leaf(child, origin, dir, range, first_id, found),
                Kind::Leaf(_) | Kind::Nothing => {}
            }
        }
    }

    fn collect_in_leaf(
        &self,
        leaf: Child,
        origin: Vec3,
        dir: Vec3,
        range: [f64; 2],
        first_id: u32,
        found: &mut Vec<(f64, u32)>,
    ) {
        let block = leaf.place();
        let mut offer = |t: f64, meets: bool, id: f64| {
            if meets && t >= range[0] && t <= range[1] {
                found.push((t, first_id + id as u32));
            }
        };
        let numbers = &self.primitives.numbers[block.at..];
        for i in 0..block.spheres {
            let [x, y, z, radius, id] = [0, 1, 2, 3, 4].map(|column| numbers[column * block.spheres + i]);
            let center = Vec3::new(x, y, z);
            let before = f64::NEG_INFINITY;
            let (near, meets) = sphere::crossing::<f64>(origin, dir, center, radius, before, false);
            let (far, _) = sphere::crossing::<f64>(origin, dir, center, radius, near, false);
            offer(near, meets, id);
            offer(far, meets, id);
        }
        let numbers = &numbers[SPHERE * block.spheres..];
        let k = axes(main_axis(dir));
        let shear = Shear::new(dir.permuted(k));
        for i in 0..block.triangles {
            let number = |column: usize| numbers[column * block.triangles + i];
            let corners = [0, 3, 6].map(|c| Vec3::new(number(c), number(c + 1), number(c + 2)).permuted(k));
            let hit = triangle::intersect::<f64>(origin.permuted(k), &shear, corners);
            offer(hit.t, hit.meets, number(TRIANGLE - 1));
        }
        let numbers = &numbers[TRIANGLE * block.triangles..][..block.instances];
        for &number in numbers {
            let instance = &self.instances[number as usize];
            let (origin, dir) = (instance.to_model.apply(origin), instance.to_model.turn(dir));
            self.models[instance.model].collect(origin, dir, range, first_id + instance.first, found);
        }
    }
}

/// Does the line of a ray meet a box of a node within a range?
fn meets(node: &Node, place: usize, origin: Vec3, dir: Vec3, [mut enter, mut leave]: [f64; 2]) -> bool {
    for axis in 0..3 {
        let (o, i) = (origin.component(axis), inverse(dir.component(axis)));
        let side = usize::from(i < 0.0);
        enter = ((f64::from(node.planes[plane(axis, side)][place]) - o) * i).max(enter);
        leave = ((f64::from(node.planes[plane(axis, 1 - side)][place]) - o) * i).min(leave);
    }
    enter <= leave
}
