//! The primitives of the leaves, in columns, so that several of a leaf are read at once.

use super::instance::Instance;
use super::node::{Block, Child, Kind, Tree};
use crate::geometry::{Bounds, Sphere, Vec3};
use crate::lanes::MAX_WIDTH;

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
    pub fn new(shapes: &Shapes<'_>, tree: &mut Tree) -> Self {
        // Triangles are numbered from `first` to before `last`, then instances.
        let (first, last) = (shapes.spheres.len(), shapes.spheres.len() + shapes.faces.len());
        let count = SPHERE * first + TRIANGLE * shapes.faces.len() + shapes.instances.len() + MAX_WIDTH;
        let mut numbers = Vec::with_capacity(count);
        let mut places = vec![0; shapes.faces.len()];
        for child in tree.nodes.iter_mut().flat_map(|node| &mut node.child) {
            let Kind::Leaf(leaf) = child.kind() else { continue };
            let leaf = tree.leaves[leaf as usize];
            let ids = &tree.order[leaf.first as usize..(leaf.first + leaf.count) as usize];
            let (spheres, others) = ids.split_at(ids.partition_point(|&id| (id as usize) < first));
            let (triangles, instances) = others.split_at(others.partition_point(|&id| (id as usize) < last));
            *child = Child::block(Block {
                at: numbers.len(),
                spheres: spheres.len(),
                triangles: triangles.len(),
                instances: instances.len(),
            });
            for column in 0..SPHERE {
                numbers.extend(spheres.iter().map(|&id| {
                    let Sphere { center, radius } = shapes.spheres[id as usize];
                    [center.x, center.y, center.z, radius, f64::from(id)][column]
                }));
            }
            for (i, &id) in triangles.iter().enumerate() {
                places[id as usize - first] = ((numbers.len() + i) as u64) << 4 | triangles.len() as u64;
            }
            for corner in 0..3 {
                for axis in 0..3 {
                    let number = |&id: &u32| shapes.corners(id as usize - first)[corner].component(axis);
                    numbers.extend(triangles.iter().map(number));
                }
            }
            numbers.extend(triangles.iter().map(|&id| f64::from(id)));
            numbers.extend(instances.iter().map(|&id| (id as usize - last) as f64));
        }
        numbers.resize(numbers.len() + MAX_WIDTH, 0.0);
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
