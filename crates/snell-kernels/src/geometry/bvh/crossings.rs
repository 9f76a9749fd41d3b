//! All places where one ray crosses something, within a range of distances: slow, for the few rays that need it.

use super::Bvh;
use super::node::{Child, Kind, Node, WIDTH, plane};
use super::primitives::{INSTANCES, RunOf};
use crate::geometry::Vec3;
use crate::geometry::ray::{Heading, Ray, axes, main_axis};
use crate::geometry::shape::{self, ForKind, One, of_kind};
use alloc::vec;
use alloc::vec::Vec;

/// What a ray needs for every box and shape.
struct Line {
    range: [f64; 2],
    /// As it is, and in the order of its main axis.
    plain: Ray,
    sheared: Ray,
    /// For each axis whether boxes are entered at their high side.
    backward: [bool; 3],
}

impl Line {
    fn new(origin: Vec3, dir: Vec3, range: [f64; 2]) -> Self {
        let ray = |axes| Ray { origin: origin.permuted(axes), heading: Heading::new(dir.permuted(axes)), axes };
        let (plain, sheared) = (ray([0, 1, 2]), ray(axes(main_axis(dir))));
        let backward = [0, 1, 2].map(|axis| plain.heading.inverse.component(axis) < 0.0);
        Self { range, plain, sheared, backward }
    }

    /// Which boxes of a node does the line meet within its range? A bit for each.
    fn meets(&self, node: &Node) -> u32 {
        let [mut enter, mut leave] = self.range.map(|t| [t; WIDTH]);
        for axis in 0..3 {
            let Ray { origin, heading, .. } = &self.plain;
            let (o, i, side) =
                (origin.component(axis), heading.inverse.component(axis), usize::from(self.backward[axis]));
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
    pub fn crossings(&self, origin: Vec3, dir: Vec3, range: [f64; 2], found: &mut Vec<(f64, u32)>) {
        let before = found.len();
        self.collect(&Line::new(origin, dir, range), 0, found);
        found[before..].sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    }

    /// Appends every primitive whose box, with its margin, holds a point.
    pub fn near(&self, point: Vec3, found: &mut Vec<u32>) {
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
                    for run in self.primitives.runs(block) {
                        if run.kind != INSTANCES {
                            found.extend(run.ids().iter().map(|&id| first_id + id as u32));
                            continue;
                        }
                        for &number in run.ids() {
                            let instance = &self.instances[number as usize];
                            let (model, first_id) = (&self.models[instance.model], first_id + instance.first);
                            model.collect_near(instance.to_model.apply(point), first_id, found);
                        }
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
        // Few boxes wait at a time: room for as many as could would take longer to clear than the search itself.
        let mut waiting = Vec::with_capacity(8 * WIDTH);
        waiting.push(Child::ROOT);
        while let Some(child) = waiting.pop() {
            match child.kind() {
                Kind::Node(number) => {
                    let node = &self.nodes[number as usize];
                    let mut met = line.meets(node);
                    while met != 0 {
                        waiting.push(node.child[met.trailing_zeros() as usize]);
                        met &= met - 1;
                    }
                }
                Kind::Block(_) => self.collect_in_leaf(child, line, first_id, found),
                Kind::Leaf(_) | Kind::Nothing => {}
            }
        }
    }

    fn collect_in_leaf(&self, leaf: Child, line: &Line, first_id: u32, found: &mut Vec<(f64, u32)>) {
        for run in self.primitives.runs(leaf.place()) {
            if run.kind != INSTANCES {
                of_kind(run.kind, Cross { line, run, first_id, found });
                continue;
            }
            for &number in run.ids() {
                let (instance, Ray { origin, heading, .. }) = (&self.instances[number as usize], &line.plain);
                let (origin, dir) = (instance.to_model.apply(*origin), instance.to_model.turn(heading.dir));
                let line = Line::new(origin, dir, line.range);
                self.models[instance.model].collect(&line, first_id + instance.first, found);
            }
        }
    }
}

/// Appends the crossings of the primitives of a run.
struct Cross<'a> {
    line: &'a Line,
    run: RunOf<'a>,
    first_id: u32,
    found: &'a mut Vec<(f64, u32)>,
}

impl ForKind for Cross<'_> {
    type Output = ();
    fn run<S: shape::Kind>(self) {
        let Self { line, run, first_id, found } = self;
        let ray = if S::SHEARED { &line.sheared } else { &line.plain };
        for (place, &id) in run.ids().iter().enumerate() {
            let shape = One { numbers: run.numbers, stride: run.count, place };
            S::crossings(ray, shape, |t| {
                if t >= line.range[0] && t <= line.range[1] {
                    found.push((t, first_id + id as u32));
                }
            });
        }
    }
}
