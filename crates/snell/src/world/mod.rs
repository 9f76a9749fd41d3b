//! The compiled scene: arrays, a tree, a camera. Immutable; holds no names but for messages.

mod camera;
mod surface;

pub use camera::CameraFrame;
use surface::FLAT;
pub use surface::NO_PRIMITIVE;

use crate::film::Rgb;
use crate::geometry::bvh::{Bvh, Quality, Shapes, TreeStatistics};
use crate::geometry::mesh::MAX_SMOOTHED_VALENCE;
use crate::geometry::{Affine, Bounds, Sphere, TriangleMesh, Vec3, triangle};
use crate::scene::{
    Integrator, LARGEST_NUMBER, Material, Mesh, Problem, Render, Scene, Step, Warning, WarningCode, validate,
};
use indexmap::IndexMap;

/// A light as the kernels see it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightSource {
    /// Its position, or the direction towards it.
    pub at: Vec3,
    /// Does `at` hold a direction?
    pub at_infinity: bool,
    pub color: Rgb,
}

/// An object of the scene: the primitives `first .. first + count`.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// The name in the scene, or a made-up one like `sphere 3`.
    pub name: String,
    /// Its first primitive.
    pub first: u32,
    /// How many primitives it has.
    pub count: u32,
}

/// A scene that is ready to be traced.
///
/// Primitives are numbered in the order of the scene, all spheres before all triangles. At equal distance the lower
/// number is hit.
#[derive(Clone, Debug)]
pub struct World {
    /// The settings of the scene.
    pub render: Render,
    /// The camera, placed.
    pub camera: CameraFrame,
    /// Objects in the order of their primitives.
    pub objects: Vec<Object>,
    /// What is probably not meant.
    pub warnings: Vec<Warning>,
    pub(crate) ambient: Rgb,
    pub(crate) eta_outside: f64,
    pub(crate) lights: Vec<LightSource>,
    pub(crate) materials: Vec<Material>,
    /// Material of each primitive.
    material_of: Vec<u32>,
    pub(crate) spheres: Vec<Sphere>,
    /// Normals at the corners of the triangles that are smooth.
    corner_normals: Vec<[Vec3; 3]>,
    /// For each triangle where its corner normals are, `FLAT` if it has none; empty if no triangle has any.
    corner_normals_of: Vec<u32>,
    /// The tree, with the triangles in its leaves.
    pub(crate) tree: Bvh,
}

/// Triangles on their way into the tree.
#[derive(Default)]
struct Triangles {
    vertices: Vec<Vec3>,
    faces: Vec<[u32; 3]>,
}

impl World {
    /// Compiles a scene, with all processors.
    ///
    /// # Errors
    /// Everything that is wrong with the scene. A mesh that names a file must have been read before.
    pub fn new(scene: &Scene) -> Result<Self, Vec<Problem>> {
        Self::build(scene, Quality::default(), 0)
    }

    /// Compiles a scene with a tree of this quality, on so many threads, 0 for as many as the machine has cores. Neither
    /// changes the picture.
    ///
    /// # Errors
    /// As [`World::new`].
    pub fn build(scene: &Scene, quality: Quality, threads: usize) -> Result<Self, Vec<Problem>> {
        let warnings = validate(scene)?;
        let mut world = Self {
            render: scene.render.clone(),
            camera: CameraFrame::new(&scene.camera, scene.render.size),
            objects: Vec::new(),
            warnings,
            ambient: scene.ambient,
            eta_outside: scene.eta_outside,
            lights: scene.lights.iter().map(light_source).collect(),
            materials: scene.materials.values().cloned().collect(),
            material_of: Vec::new(),
            spheres: Vec::new(),
            corner_normals: Vec::new(),
            corner_normals_of: Vec::new(),
            tree: Bvh::default(),
        };
        if !world.camera.has_image_plane() {
            let message = "the image plane is so near to the eye that it is lost in rounding".to_owned();
            let place = vec![Step::from("camera"), Step::from("near")];
            return Err(vec![Problem { place, message, help: Some("move it away, like near = -5".to_owned()) }]);
        }
        let material_ids: IndexMap<&str, u32> =
            scene.materials.keys().enumerate().map(|(i, name)| (name.as_str(), i as u32)).collect();
        for (i, s) in scene.spheres.iter().enumerate() {
            let name = s.name.clone().unwrap_or_else(|| format!("sphere {}", i + 1));
            world.objects.push(Object { name, first: i as u32, count: 1 });
            world.spheres.push(Sphere { center: s.center.into(), radius: s.radius });
            world.material_of.push(material_ids.get(s.material.as_str()).copied().unwrap_or(0));
        }
        let mut triangles = Triangles::default();
        for (i, mesh) in scene.meshes.iter().enumerate() {
            world.add_mesh(i, mesh, &material_ids, &mut triangles).map_err(|problem| vec![problem])?;
        }
        if world.corner_normals.is_empty() {
            world.corner_normals_of = Vec::new();
        }
        world.build_tree(&triangles, quality, threads);
        Ok(world)
    }

    /// The same world without a tree: every ray is tested against every primitive. Slow, and the oracle of the tests.
    #[must_use]
    pub fn brute_force(mut self) -> Self {
        self.tree = self.tree.flat();
        self
    }

    /// Number of primitives.
    pub fn primitive_count(&self) -> usize {
        self.material_of.len()
    }

    /// The object that a primitive belongs to.
    pub fn object_of(&self, primitive: u32) -> Option<&Object> {
        let after = self.objects.partition_point(|o| o.first <= primitive);
        self.objects[..after].last().filter(|o| primitive - o.first < o.count)
    }

    /// What the tree over the primitives is made of.
    pub fn tree(&self) -> TreeStatistics {
        self.tree.statistics()
    }

    /// Bytes of geometry and tree.
    pub fn memory(&self) -> usize {
        size_of_val(self.spheres.as_slice())
            + size_of_val(self.corner_normals.as_slice())
            + size_of_val(self.corner_normals_of.as_slice())
            + size_of_val(self.material_of.as_slice())
            + self.tree.statistics().node_bytes
            + self.tree.statistics().primitive_bytes
    }

    fn add_mesh(
        &mut self,
        index: usize,
        mesh: &Mesh,
        material_ids: &IndexMap<&str, u32>,
        triangles: &mut Triangles,
    ) -> Result<(), Problem> {
        let place = |key: &str| vec![Step::from("mesh"), Step::from(index), Step::from(key)];
        let problem = |key: &str, message: String| Problem { place: place(key), message, help: None };
        let inline;
        let source = match (&mesh.geometry, &mesh.file) {
            (Some(geometry), _) => geometry.as_ref(),
            (None, Some(file)) => return Err(problem("file", format!("`{file}` has not been read"))),
            (None, None) => {
                inline = TriangleMesh {
                    vertices: mesh.vertices.iter().map(|&v| v.into()).collect(),
                    faces: mesh.faces.clone(),
                    ..TriangleMesh::default()
                };
                &inline
            }
        };
        let map = mesh.transform.iter().filter_map(super::scene::Transform::map).fold(Affine::IDENTITY, Affine::then);
        let placed = source.transformed(&map);
        if let Some(v) = placed.vertices.iter().find(|v| !v.is_finite() || v.length() > LARGEST_NUMBER) {
            let message = format!("a vertex ends up at ({}, {}, {}), beyond 1e15", v.x, v.y, v.z);
            return Err(problem("transform", message));
        }
        let slots = slot_materials(mesh, source, material_ids).map_err(|m| problem("materials", m))?;

        let name = mesh.name.clone().or_else(|| mesh.file.clone()).unwrap_or_else(|| format!("mesh {}", index + 1));
        let corner_normals = (mesh.smooth_angle > 0.0).then(|| placed.smooth_normals(mesh.smooth_angle));
        let (first, base) = (self.primitive_count() as u32, triangles.vertices.len() as u32);
        let mut without_area = 0usize;
        let mut used = vec![false; self.materials.len()];
        for (f, face) in placed.faces.iter().enumerate() {
            if !triangle::normal(placed.corners(f)).is_finite() {
                without_area += 1;
                continue;
            }
            let material = match placed.face_slots.get(f) {
                Some(&slot) if mesh.material.is_none() => slots[slot as usize],
                _ => slots[0],
            };
            used[material as usize] = true;
            triangles.faces.push(face.map(|v| v + base));
            self.material_of.push(material);
            self.corner_normals_of.push(corner_normals.as_ref().map_or(FLAT, |_| self.corner_normals.len() as u32));
            self.corner_normals.extend(corner_normals.as_ref().map(|normals| normals[f]));
        }
        triangles.vertices.extend(&placed.vertices);
        let count = self.primitive_count() as u32 - first;
        self.objects.push(Object { name: name.clone(), first, count });
        self.warn_about(&name, &place("file"), &placed, mesh, without_area, &used);
        Ok(())
    }

    fn warn_about(
        &mut self,
        name: &str,
        place: &[Step],
        placed: &TriangleMesh,
        mesh: &Mesh,
        without_area: usize,
        used: &[bool],
    ) {
        let mut warn = |code, message| self.warnings.push(Warning { code, place: place.to_vec(), message });
        if without_area > 0 {
            let message = format!("mesh `{name}`: {without_area} faces without area are left out");
            warn(WarningCode::DegenerateFaces, message);
        }
        if mesh.smooth_angle > 0.0 {
            let mut valence = vec![0usize; placed.vertices.len()];
            placed.faces.iter().flatten().for_each(|&v| valence[v as usize] += 1);
            if valence.iter().any(|&n| n > MAX_SMOOTHED_VALENCE) {
                let message =
                    format!("mesh `{name}`: vertices shared by more than {MAX_SMOOTHED_VALENCE} faces stay flat");
                warn(WarningCode::NotSmoothed, message);
            }
        }
        let refracts = |m: &Material| m.ko.to_array().iter().sum::<f64>() < 3.0;
        let transparent = self.materials.iter().zip(used).any(|(m, &used)| used && refracts(m));
        if transparent && self.render.integrator != Integrator::Course2018 {
            let message = format!(
                "mesh `{name}` has a transparent material, but this integrator refracts only in spheres: \
                 its transparent share is not drawn"
            );
            warn(WarningCode::MeshNotRefracted, message);
        }
    }

    fn build_tree(&mut self, triangles: &Triangles, quality: Quality, threads: usize) {
        let Triangles { vertices, faces } = triangles;
        let shapes = Shapes { spheres: &self.spheres, vertices, faces };
        // Rays start on surfaces or on the image plane; no ray origin is farther from a primitive than this.
        let corners = Bounds::of(self.camera.corners());
        let everything = (0..shapes.count()).map(|i| shapes.bounds(i)).fold(corners, Bounds::union);
        self.tree = Bvh::build(&shapes, everything.diagonal(), quality, threads);
    }
}

fn light_source(light: &crate::scene::Light) -> LightSource {
    let at_infinity = light.direction.is_some();
    let at: Vec3 = light.direction.or(light.position).unwrap_or_default().into();
    LightSource { at: if at_infinity { at.unit() } else { at }, at_infinity, color: light.color }
}

/// The material of each slot of a model; at least one.
fn slot_materials(mesh: &Mesh, source: &TriangleMesh, ids: &IndexMap<&str, u32>) -> Result<Vec<u32>, String> {
    let id = |name: &str| ids.get(name).copied().ok_or_else(|| format!("no material is called `{name}`"));
    if let Some(name) = &mesh.material {
        return Ok(vec![id(name)?]);
    }
    if source.faces.is_empty() {
        return Ok(vec![0]);
    }
    if source.slots.is_empty() || source.face_slots.len() != source.faces.len() {
        return Err("the model names no materials: give the mesh one with `material`".to_owned());
    }
    let named = |slot: &String| match mesh.materials.get(slot) {
        Some(name) => id(name),
        None => {
            Err(format!("no material for `{slot}` of the model: give the mesh a `material` or a `materials` entry"))
        }
    };
    source.slots.iter().map(named).collect()
}
