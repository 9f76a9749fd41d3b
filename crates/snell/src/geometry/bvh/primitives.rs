//! The primitives of the leaves, in columns, so that several of a leaf are read at once.

use super::instance::Instance;
use super::node::{Block, Child, Kind, Tree};
use crate::geometry::{Bounds, Sphere, Vec3};
use crate::lanes::MAX_WIDTH;
use crate::memory;

/// What a tree is built over: all spheres before all triangles, numbered in this order; then the instances.
#[derive(Clone, Copy, Debug, Default)]
pub struct Shapes<'a> {
    /// The spheres.
    pub spheres: &'a [Sphere],
    /// The corners of the triangles.
    pub vertices: &'a [Vec3],
    /// Three vertices per triangle.
    pub faces: &'a [[u32; 3]],
    /// Where other trees stand.
    pub instances: &'a [Instance],
}

impl Shapes<'_> {
    /// How many there are.
    pub fn count(&self) -> usize {
        self.spheres.len() + self.faces.len() + self.instances.len()
    }

    /// The box of one of them.
    pub fn bounds(&self, number: usize) -> Bounds {
        if let Some(sphere) = self.spheres.get(number) {
            return sphere.bounds();
        }
        let number = number - self.spheres.len();
        if number < self.faces.len() {
            return Bounds::of(self.corners(number));
        }
        self.instances[number - self.faces.len()].bounds
    }

    fn corners(&self, face: usize) -> [Vec3; 3] {
        self.faces[face].map(|v| self.vertices[v as usize])
    }
}

/// Columns of spheres: centre, radius, id.
pub(super) const SPHERE: usize = 5;
/// Columns of triangles: three corners, id.
pub(super) const TRIANGLE: usize = 10;

/// All primitives of a tree.
///
/// A leaf of `s` spheres and `t` triangles is `5·s + 10·t` numbers: the columns x, y, z, radius and id of its spheres, then
/// the columns `ax ay az bx by bz cx cy cz` and id of its triangles, ids ascending, then the numbers of its instances. Every
/// `u32` is exact as `f64`.
#[derive(Clone, Debug, Default)]
pub(super) struct Primitives {
    /// The leaves' columns, and some zeros so that the last one can be read in full lanes.
    pub numbers: Vec<f64>,
    /// By triangle: the place of its first number, and in the last four bits the distance to the next ones, which is at
    /// most 8.
    places: Vec<u64>,
    /// The id of the first triangle.
    spheres: usize,
}

impl Primitives {
    /// Copies the primitives, leaf by leaf, and makes the leaves of the tree point to them.
    pub fn new(shapes: &Shapes<'_>, tree: &mut Tree, parallel: bool) -> Self {
        // Triangles are numbered from `first` to before `last`, then instances.
        let (first, last) = (shapes.spheres.len(), shapes.spheres.len() + shapes.faces.len());
        let mut jobs = Vec::with_capacity(tree.leaves.len());
        let mut places = vec![0; shapes.faces.len()];
        let mut count = 0;
        for child in tree.nodes.iter_mut().flat_map(|node| &mut node.child) {
            let Kind::Leaf(leaf) = child.kind() else { continue };
            let leaf = tree.leaves[leaf as usize];
            let ids = &tree.order[leaf.first as usize..(leaf.first + leaf.count) as usize];
            let (spheres, others) = ids.split_at(ids.partition_point(|&id| (id as usize) < first));
            let (triangles, instances) = others.split_at(others.partition_point(|&id| (id as usize) < last));
            let block =
                Block { at: count, spheres: spheres.len(), triangles: triangles.len(), instances: instances.len() };
            *child = Child::block(block);
            for (i, &id) in triangles.iter().enumerate() {
                places[id as usize - first] =
                    ((count + SPHERE * spheres.len() + i) as u64) << 4 | triangles.len() as u64;
            }
            jobs.push((block, ids));
            count += SPHERE * spheres.len() + TRIANGLE * triangles.len() + instances.len();
        }
        let mut numbers = memory::zeros(count + MAX_WIDTH).unwrap_or_else(|| vec![0.0; count + MAX_WIDTH]);
        fill(shapes, &jobs, &mut numbers, parallel);
        Self { numbers, places, spheres: first }
    }

    /// The corners of a triangle.
    pub fn corners(&self, id: usize) -> [Vec3; 3] {
        let place = self.places[id - self.spheres];
        let (at, stride) = ((place >> 4) as usize, (place & 15) as usize);
        let number = |column: usize| self.numbers[at + column * stride];
        [0, 3, 6].map(|first| Vec3::new(number(first), number(first + 1), number(first + 2)))
    }

    pub fn has_triangles(&self) -> bool {
        !self.places.is_empty()
    }

    pub fn memory(&self) -> usize {
        size_of_val(self.numbers.as_slice()) + size_of_val(self.places.as_slice())
    }
}

/// Writes the numbers of some leaves, which start with those of the first one.
fn fill(shapes: &Shapes<'_>, jobs: &[(Block, &[u32])], numbers: &mut [f64], parallel: bool) {
    const ALONE: usize = 1 << 10;
    if parallel && jobs.len() > ALONE {
        let (left, right) = jobs.split_at(jobs.len() / 2);
        let (left_numbers, right_numbers) = numbers.split_at_mut(right[0].0.at - left[0].0.at);
        rayon::join(|| fill(shapes, left, left_numbers, true), || fill(shapes, right, right_numbers, true));
        return;
    }
    let (first, last) = (shapes.spheres.len(), shapes.spheres.len() + shapes.faces.len());
    let mut rest = numbers;
    for (Block { spheres, triangles, instances, .. }, ids) in jobs {
        let (sphere_ids, others) = ids.split_at(*spheres);
        let (triangle_ids, instance_ids) = others.split_at(*triangles);
        let (block, after) = rest.split_at_mut(SPHERE * spheres);
        for (i, &id) in sphere_ids.iter().enumerate() {
            let Sphere { center, radius } = shapes.spheres[id as usize];
            put(block, *spheres, i, [center.x, center.y, center.z, radius, f64::from(id)]);
        }
        let (block, after) = after.split_at_mut(TRIANGLE * triangles);
        for (i, &id) in triangle_ids.iter().enumerate() {
            let [a, b, c] = shapes.corners(id as usize - first);
            put(block, *triangles, i, [a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, f64::from(id)]);
        }
        let (block, after) = after.split_at_mut(*instances);
        for (number, &id) in block.iter_mut().zip(instance_ids) {
            *number = (id as usize - last) as f64;
        }
        rest = after;
    }
}

/// Writes one primitive into the columns of its leaf.
fn put<const N: usize>(block: &mut [f64], stride: usize, i: usize, row: [f64; N]) {
    for (column, number) in row.into_iter().enumerate() {
        block[column * stride + i] = number;
    }
}
