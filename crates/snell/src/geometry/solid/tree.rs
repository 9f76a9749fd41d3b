//! A tree of boxes over faces, for questions that are asked once: which faces are near each other, which lie on a line.
//!
//! Halved by number at every node, so its depth is log n whatever the faces are. What it costs to ask is bounded by a budget:
//! of a million faces in one place all pairs are near each other.

use crate::geometry::Bounds;

/// Faces in a leaf.
const LEAF: usize = 4;

#[derive(Debug)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    /// Faces, in the order of the leaves.
    order: Vec<u32>,
}

#[derive(Debug)]
struct Node {
    bounds: Bounds,
    /// Its part of the order.
    start: usize,
    end: usize,
    /// The second child; the first stands behind the node. 0 for a leaf.
    second: usize,
}

/// Work that may still be done, in steps of some nanoseconds.
#[derive(Debug)]
pub(super) struct Budget(pub u64);

impl Budget {
    /// Is there work left? Takes some of it.
    pub fn take(&mut self, steps: u64) -> bool {
        self.0 = self.0.saturating_sub(steps);
        self.0 > 0
    }
}

impl Tree {
    /// A tree over some of the faces, whose boxes are given by number.
    pub fn over(faces: Vec<u32>, boxes: &[Bounds]) -> Self {
        let mut tree = Self { nodes: Vec::with_capacity(faces.len()), order: faces };
        if !tree.order.is_empty() {
            let mut order = std::mem::take(&mut tree.order);
            tree.build(&mut order, 0, boxes);
            tree.order = order;
        }
        tree
    }

    fn build(&mut self, faces: &mut [u32], start: usize, boxes: &[Bounds]) {
        let bounds = faces.iter().map(|&f| boxes[f as usize]).fold(Bounds::EMPTY, Bounds::union);
        let node = self.nodes.len();
        self.nodes.push(Node { bounds, start, end: start + faces.len(), second: 0 });
        if faces.len() <= LEAF {
            return;
        }
        let middle =
            |face: u32, axis| boxes[face as usize].min.component(axis) + boxes[face as usize].max.component(axis);
        let spread = |axis| {
            let of = faces.iter().map(|&f| middle(f, axis));
            of.clone().fold(f64::NEG_INFINITY, f64::max) - of.fold(f64::INFINITY, f64::min)
        };
        let axis = (0..3).max_by(|&a, &b| spread(a).total_cmp(&spread(b))).unwrap_or(0);
        let half = faces.len() / 2;
        faces.select_nth_unstable_by(half, |&a, &b| middle(a, axis).total_cmp(&middle(b, axis)).then(a.cmp(&b)));
        let (left, right) = faces.split_at_mut(half);
        self.build(left, start, boxes);
        self.nodes[node].second = self.nodes.len();
        self.build(right, start + half, boxes);
    }

    /// Calls `pair` for every two faces whose boxes touch, until the budget is spent.
    pub fn pairs(&self, boxes: &[Bounds], budget: &mut Budget, pair: &mut impl FnMut(u32, u32, &mut Budget)) {
        let mut open = vec![(0, 0)];
        if self.nodes.is_empty() {
            open.clear();
        }
        while let Some((a, b)) = open.pop() {
            if !budget.take(1) {
                return;
            }
            let (first, other) = (&self.nodes[a], &self.nodes[b]);
            if !touch(&first.bounds, &other.bounds) {
                continue;
            }
            match (first.second, other.second) {
                (0, 0) => {
                    for i in first.start..first.end {
                        for j in if a == b { i + 1 } else { other.start }..other.end {
                            let (f, g) = (self.order[i], self.order[j]);
                            if touch(&boxes[f as usize], &boxes[g as usize]) {
                                pair(f.min(g), f.max(g), budget);
                            }
                        }
                    }
                }
                (second, _) if a == b => open.extend([(a + 1, a + 1), (second, second), (a + 1, second)]),
                (second, 0) => open.extend([(a + 1, b), (second, b)]),
                (0, second) => open.extend([(a, b + 1), (a, second)]),
                // The larger one is taken apart, so that both stay of the same size.
                (second, _) if first.end - first.start >= other.end - other.start => {
                    open.extend([(a + 1, b), (second, b)]);
                }
                (_, second) => open.extend([(a, b + 1), (a, second)]),
            }
        }
    }

    /// Calls `met` for every face whose box touches this one, until the budget is spent.
    pub fn touching(&self, boxes: &[Bounds], bounds: &Bounds, budget: &mut Budget, met: &mut impl FnMut(u32)) {
        let mut open = if self.nodes.is_empty() { vec![] } else { vec![0] };
        while let Some(node) = open.pop() {
            let Node { bounds: own, start, end, second } = &self.nodes[node];
            if !budget.take(1 + if *second == 0 { (end - start) as u64 } else { 0 }) {
                return;
            }
            match second {
                _ if !touch(own, bounds) => {}
                0 => {
                    let faces = self.order[*start..*end].iter();
                    faces.filter(|face| touch(&boxes[**face as usize], bounds)).for_each(|&face| met(face));
                }
                &second => open.extend([node + 1, second]),
            }
        }
    }
}

fn touch(a: &Bounds, b: &Bounds) -> bool {
    a.min.x <= b.max.x
        && b.min.x <= a.max.x
        && a.min.y <= b.max.y
        && b.min.y <= a.max.y
        && a.min.z <= b.max.z
        && b.min.z <= a.max.z
}
