//! The primitives of the leaves, in columns, so that several of a leaf are read at once.

use super::build::Range;
use crate::geometry::{Bounds, Sphere, Vec3};
use crate::lanes::MAX_WIDTH;

/// What a tree is built over: all spheres before all triangles, numbered in this order.
#[derive(Clone, Copy, Debug)]
pub struct Shapes<'a> {
    /// The spheres.
    pub spheres: &'a [Sphere],
    /// The corners of the triangles.
    pub vertices: &'a [Vec3],
    /// Three vertices per triangle.
    pub faces: &'a [[u32; 3]],
}

impl Shapes<'_> {
    /// How many there are.
    pub fn count(&self) -> usize {
        self.spheres.len() + self.faces.len()
    }

    /// The box of a primitive.
    pub fn bounds(&self, primitive: usize) -> Bounds {
        match self.spheres.get(primitive) {
            Some(sphere) => sphere.bounds(),
            None => Bounds::of(self.corners(primitive - self.spheres.len())),
        }
    }

    fn corners(&self, face: usize) -> [Vec3; 3] {
        self.faces[face].map(|v| self.vertices[v as usize])
    }
}

/// A leaf: its spheres, then its triangles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leaf {
    /// Where its primitives start in `ids`.
    pub first: u32,
    /// Where its numbers start in `numbers`.
    pub at: u32,
    pub spheres: u8,
    pub triangles: u8,
}

/// Where the numbers of one primitive are: the first, and how far apart.
#[derive(Clone, Copy, Debug, Default)]
struct Place {
    at: u32,
    stride: u32,
}

/// All primitives of a tree.
///
/// A leaf of `s` spheres and `t` triangles is `4·s + 9·t` numbers: the columns x, y, z and radius of its spheres, then the
/// columns `ax ay az bx by bz cx cy cz` of its triangles.
#[derive(Clone, Debug, Default)]
pub(super) struct Primitives {
    pub leaves: Vec<Leaf>,
    /// Ids of the primitives, leaf by leaf, ascending in each.
    pub ids: Vec<u32>,
    /// The leaves' columns, and some zeros so that the last one can be read in full lanes.
    pub numbers: Vec<f64>,
    /// By id.
    places: Vec<Place>,
}

impl Primitives {
    pub fn new(shapes: &Shapes<'_>, ranges: &[Range], ids: Vec<u32>) -> Self {
        let count = shapes.spheres.len();
        let mut numbers = Vec::with_capacity(4 * count + 9 * shapes.faces.len() + MAX_WIDTH);
        let mut places = vec![Place::default(); shapes.count()];
        let mut leaves = Vec::with_capacity(ranges.len());
        for range in ranges {
            let own = &ids[range.first as usize..(range.first + range.count) as usize];
            let (spheres, triangles) = own.split_at(own.partition_point(|&id| (id as usize) < count));
            let at = numbers.len();
            let sphere = |&id: &u32| shapes.spheres[id as usize];
            numbers.extend(spheres.iter().map(|id| sphere(id).center.x));
            numbers.extend(spheres.iter().map(|id| sphere(id).center.y));
            numbers.extend(spheres.iter().map(|id| sphere(id).center.z));
            numbers.extend(spheres.iter().map(|id| sphere(id).radius));
            let first = numbers.len();
            for column in 0..9 {
                let number = |&id: &u32| shapes.corners(id as usize - count)[column / 3].component(column % 3);
                numbers.extend(triangles.iter().map(number));
            }
            for (start, some) in [(at, spheres), (first, triangles)] {
                for (i, &id) in some.iter().enumerate() {
                    places[id as usize] = Place { at: (start + i) as u32, stride: some.len() as u32 };
                }
            }
            leaves.push(Leaf {
                first: range.first,
                at: at as u32,
                spheres: spheres.len() as u8,
                triangles: triangles.len() as u8,
            });
        }
        numbers.resize(numbers.len() + MAX_WIDTH, 0.0);
        Self { leaves, ids, numbers, places }
    }

    /// The corners of a triangle.
    pub fn corners(&self, id: u32) -> [Vec3; 3] {
        let Place { at, stride } = self.places[id as usize];
        let number = |column: u32| self.numbers[(at + column * stride) as usize];
        [0, 3, 6].map(|first| Vec3::new(number(first), number(first + 1), number(first + 2)))
    }

    pub fn memory(&self) -> usize {
        size_of_val(self.leaves.as_slice())
            + size_of_val(self.ids.as_slice())
            + size_of_val(self.numbers.as_slice())
            + size_of_val(self.places.as_slice())
    }
}
