//! Fills and the meshes that have them.

use crate::model::polygon::Polygons;
use indexmap::IndexMap;
use snell::geometry::Vec3;
use snell::scene::{Material, Mesh, OpenMesh, Step};
use std::collections::HashMap;
use std::ops::Range;

/// Smooth meshes are smoothed over edges up to this angle, in degrees: more than between the facets of any usual
/// tessellation, less than between the sides of a box.
const SMOOTH: f64 = 60.0;

/// Everything but spheres, as it is read.
#[derive(Default)]
pub(super) struct Shapes {
    materials: IndexMap<String, Material>,
    /// Names of materials by their numbers, so that equal fills have one name.
    known: HashMap<[u64; 8], String>,
    /// Where each material was first filled in.
    filled: Vec<Range<usize>>,
    current: Option<String>,
    flat: Builder,
    smooth: Builder,
    meshes: Vec<(Mesh, Range<usize>)>,
}

impl Shapes {
    /// A new fill: what follows is another mesh.
    pub fn fill(&mut self, material: Material, range: Range<usize>) {
        self.end_meshes();
        let Material { kd, ks, ko, spow, eta, .. } = &material;
        let key = [kd.r, kd.g, kd.b, ks.r, ko.r, *spow, *eta, 0.0].map(f64::to_bits);
        let count = self.known.len() + 1;
        let name = self.known.entry(key).or_insert_with(|| format!("fill_{count}")).clone();
        if !self.materials.contains_key(&name) {
            self.materials.insert(name.clone(), material);
            self.filled.push(range);
        }
        self.current = Some(name);
    }

    /// The name of the current material.
    pub fn material(&self) -> Option<String> {
        self.current.clone()
    }

    pub fn flat(&mut self, corners: &[Vec3], range: Range<usize>) {
        self.flat.polygon(corners, range);
    }

    pub fn smooth(&mut self, polygons: &[Vec<Vec3>], range: Range<usize>) {
        for corners in polygons {
            self.smooth.polygon(corners, range.clone());
        }
    }

    fn end_meshes(&mut self) {
        for (builder, smooth_angle) in [(&mut self.flat, 0.0), (&mut self.smooth, SMOOTH)] {
            let Builder { vertices, faces, range, .. } = std::mem::take(builder);
            if !faces.is_empty() {
                let vertices = vertices.into_iter().map(|v| [v.x, v.y, v.z]).collect();
                let material = self.current.clone();
                // The format says nothing of solids: what is none cannot refract.
                let is_transparent = |name: &String| self.materials.get(name).is_some_and(Material::is_transparent);
                let open = material.as_ref().filter(|name| is_transparent(name)).map(|_| OpenMesh::Opaque);
                self.meshes.push((Mesh { vertices, faces, material, smooth_angle, open, ..Mesh::default() }, range));
            }
        }
    }

    /// All materials and meshes, and where they come from.
    pub fn finish(mut self, places: &mut Vec<(Vec<Step>, Range<usize>)>) -> (IndexMap<String, Material>, Vec<Mesh>) {
        self.end_meshes();
        let names = self.materials.keys().map(|name| vec![Step::from("material"), Step::from(name.as_str())]);
        places.extend(names.zip(self.filled));
        let (meshes, ranges): (Vec<Mesh>, Vec<Range<usize>>) = self.meshes.into_iter().unzip();
        let numbers = (0..meshes.len()).map(|i| vec![Step::from("mesh"), Step::from(i)]);
        places.extend(numbers.zip(ranges));
        (self.materials, meshes)
    }
}

/// A mesh whose polygons share the vertices at equal positions.
#[derive(Default)]
struct Builder {
    vertices: Vec<Vec3>,
    known: HashMap<[u64; 3], u32>,
    faces: Vec<[u32; 3]>,
    /// Of its first polygon.
    range: Range<usize>,
    polygons: Polygons,
}

impl Builder {
    fn polygon(&mut self, corners: &[Vec3], range: Range<usize>) {
        if self.faces.is_empty() {
            self.range = range;
        }
        let mut number = |v: &Vec3| {
            let key = [v.x, v.y, v.z].map(|c| (c + 0.0).to_bits()); // −0.0 is 0.0
            *self.known.entry(key).or_insert_with(|| {
                self.vertices.push(*v);
                self.vertices.len() as u32 - 1
            })
        };
        let corners: Vec<u32> = corners.iter().map(&mut number).collect();
        self.faces.extend(self.polygons.triangles(&corners, &self.vertices));
    }
}
