//! All places where one ray crosses something, within a range of distances: slow, for the few rays that need it.

use super::Bvh;
use super::build::MOST_WAITING;
use super::node::{Child, Kind, Node, WIDTH, plane};
use super::primitives::{SPHERE, TRIANGLE};
use crate::geometry::ray::{Heading, axes, inverse, main_axis};
use crate::geometry::{Vec3, sphere, triangle};

/// What a ray needs for every box and triangle.
struct Line {
    origin: Vec3,
    dir: Vec3,
    range: [f64; 2],
    /// For each axis the inverse of the direction, and whether boxes are entered at their high side.
    inverse: [f64; 3],
    backward: [bool; 3],
    /// Origin and heading along its main axis.
    axes: [usize; 3],
    permuted: Vec3,
    heading: Heading<f64>,
}

impl Line {
    fn new(origin: Vec3, dir: Vec3, range: [f64; 2]) -> Self {
        let (inverse, axes) = ([0, 1, 2].map(|axis| inverse(dir.component(axis))), axes(main_axis(dir)));
        Self {
            origin,
            dir,
            range,
            inverse,
            backward: inverse.map(|i| i < 0.0),
            axes,
            permuted: origin.permuted(axes),
            heading: Heading::new(dir.permuted(axes)),
        }
    }

    /// Which boxes of a node does the line meet within its range? A bit for each.
    fn meets(&self, node: &Node) -> u32 {
        let [mut enter, mut leave] = self.range.map(|t| [t; WIDTH]);
        for axis in 0..3 {
            let (o, i, side) = (self.origin.component(axis), self.inverse[axis], usize::from(self.backward[axis]));
            let (near, far) = (&node.planes[plane(axis, side)], &node.planes[plane(axis, 1 - side)]);
            for place in 0..WIDTH {
                enter[place] = ((f64::from(near[place]) - o) * i).max(enter[place]);
                leave[place] = ((f64::from(far[place]) - o) * i).min(leave[place]);
            }
        }
        (0..WIDTH).map(|place| u32::from(enter[place] <= leave[place]) << place).sum()
    }
}

impl Bvh {
    /// Appends every crossing from `range[0]` to `range[1]`, both included: distance and primitive, by distance and then by
    /// id. `dir` of unit length.
    pub(crate) fn crossings(&self, origin: Vec3, dir: Vec3, range: [f64; 2], found: &mut Vec<(f64, u32)>) {
        let before = found.len();
        self.collect(&Line::new(origin, dir, range), 0, found);
        found[before..].sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    }

    /// Appends every triangle whose box, with its margin, holds a point.
    pub(crate) fn near(&self, point: Vec3, found: &mut Vec<u32>) {
        self.collect_near(point, 0, found);
    }

    fn collect_near(&self, point: Vec3, first_id: u32, found: &mut Vec<u32>) {
        let holds = |node: &Node, place: usize| {
            (0..3).all(|axis| {
                let [low, high] = [0, 1].map(|side| f64::from(node.planes[plane(axis, side)][place]));
                (low..=high).contains(&point.component(axis))
            })
        };
        let mut waiting = if self.nodes.is_empty() { vec![] } else { vec![Child::ROOT] };
        while let Some(child) = waiting.pop() {
            match child.kind() {
                Kind::Node(number) => {
                    let node = &self.nodes[number as usize];
                    waiting.extend((0..WIDTH).filter(|&place| holds(node, place)).map(|place| node.child[place]));
                }
                Kind::Block(block) => {
                    let triangles = &self.primitives.numbers[block.at + SPHERE * block.spheres..];
                    let ids = &triangles[(TRIANGLE - 1) * block.triangles..][..block.triangles];
                    found.extend(ids.iter().map(|&id| first_id + id as u32));
                    for &number in &triangles[TRIANGLE * block.triangles..][..block.instances] {
                        let instance = &self.instances[number as usize];
                        let (model, first_id) = (&self.models[instance.model], first_id + instance.first);
                        model.collect_near(instance.to_model.apply(point), first_id, found);
                    }
                }
                Kind::Leaf(_) | Kind::Nothing => {}
            }
        }
    }

    fn collect(&self, line: &Line, first_id: u32, found: &mut Vec<(f64, u32)>) {
        if self.nodes.is_empty() {
            return;
        }
        let mut waiting = [Child::ROOT; 1 + MOST_WAITING];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let child = waiting[count];
            match child.kind() {
                Kind::Node(number) => {
                    let node = &self.nodes[number as usize];
                    let mut met = line.meets(node);
                    while met != 0 {
                        waiting[count] = node.child[met.trailing_zeros() as usize];
                        (count, met) = (count + 1, met & (met - 1));
                    }
                }
                Kind::Block(_) => self.collect_in_leaf(child, line, first_id, found),
                Kind::Leaf(_) | Kind::Nothing => {}
            }
        }
    }

    fn collect_in_leaf(&self, leaf: Child, line: &Line, first_id: u32, found: &mut Vec<(f64, u32)>) {
        let (block, &Line { origin, dir, range, .. }) = (leaf.place(), line);
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
        for i in 0..block.triangles {
            let number = |column: usize| numbers[column * block.triangles + i];
            let corners = [0, 3, 6].map(|c| Vec3::new(number(c), number(c + 1), number(c + 2)).permuted(line.axes));
            let hit = triangle::intersect::<f64>(line.permuted, &line.heading, corners);
            offer(hit.t, hit.meets, number(TRIANGLE - 1));
        }
        let numbers = &numbers[TRIANGLE * block.triangles..][..block.instances];
        for &number in numbers {
            let instance = &self.instances[number as usize];
            let (origin, dir) = (instance.to_model.apply(origin), instance.to_model.turn(dir));
            let line = Line::new(origin, dir, range);
            self.models[instance.model].collect(&line, first_id + instance.first, found);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Sphere;
    use crate::geometry::bvh::{MARGIN, Quality, Shapes};

    /// A tree as deep as it gets, met by a ray in all of its boxes. Crowds of spheres stand around the origin, each a quarter
    /// nearer than the one before, on the axes in turn: cut in the middle, each node splits off one crowd, down to where nodes
    /// are cut by count, which is done with the crowd in the origin. A crowd of 35 fills seven leaves, and all leaves are so
    /// large that it costs least to let them wait beside the rest.
    #[test]
    fn as_many_boxes_wait_as_the_deepest_tree_has() {
        let mut spheres = Vec::new();
        for i in 0..75 {
            let scale = libm::exp2(-0.4 * f64::from(i));
            let mut center = [0.0; 3];
            center[i as usize % 3] = -scale;
            spheres.extend([Sphere { center: center.into(), radius: 2.0 * scale }; 35]);
        }
        spheres.extend(vec![Sphere { center: Vec3::default(), radius: 1e-12 }; 50_000]);
        let shapes = Shapes { spheres: &spheres, ..Shapes::default() };
        let tree = Bvh::build(&shapes, vec![], 10.0 * MARGIN, Quality::Fast, 1);
        assert!(tree.depth > 65, "only {} levels", tree.depth);
        let dir = Vec3::new(1.0, 1.0, 1.0).unit();
        let mut found = Vec::new();
        tree.crossings(dir * -9.0, dir, [0.0, 20.0], &mut found);
        assert_eq!(found.len(), 2 * spheres.len(), "into each and out of it");
    }
}
