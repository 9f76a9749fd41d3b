//! The compiled scene: arrays, a tree, a camera. Immutable; holds no names but for messages.

mod camera;
mod solid;
mod surface;

pub use camera::CameraFrame;
use solid::MeshSolids;
pub(crate) use solid::{Medium, NO_SOLID, Solid};
pub use surface::NO_PRIMITIVE;
pub(crate) use surface::Side;
use surface::{FLAT, Placement, Surfaces};

use crate::film::Rgb;
use crate::geometry::bvh::MARGIN;
use crate::geometry::bvh::{Bvh, Instance, Quality, Shapes, TreeStatistics};
use crate::geometry::mesh::MAX_SMOOTHED_VALENCE;
use crate::geometry::solid::{Options, repair};
use crate::geometry::{Affine, Bounds, Sphere, TriangleMesh, Vec3, triangle};
use crate::optics::spectrum::Band;
use crate::scene::{
    Integrator, LARGEST_NUMBER, Material, Mesh, OpenMesh, Problem, Render, Scene, Step, Transform, Warning,
    WarningCode, validate,
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
    pub(crate) spheres: Vec<Sphere>,
    /// Of the primitives that stand for themselves.
    surfaces: Surfaces,
    /// Of the meshes that stand in several places, and these places in the order of their ids.
    models: Vec<Surfaces>,
    placements: Vec<Placement>,
    /// What light goes through, where there is real optics.
    pub(crate) solids: Vec<Solid>,
    /// Into what light splits, if it does.
    pub(crate) bands: Vec<Band>,
    /// The indices of the bands, of each dispersive material.
    pub(crate) spectra: Vec<Vec<f64>>,
    /// For each material its spectrum.
    spectrum_of: Vec<Option<u32>>,
    /// Light from where nothing is.
    pub(crate) background: Rgb,
    /// How far a computed hit may be off, in scene units: faces nearer to each other than this along a ray are in one place.
    pub(crate) clearance: f64,
    /// How far behind its start a ray may still leave a solid: half of what the boxes of the tree are larger than what is in
    /// them, so that no way down the tree can hide it.
    pub(crate) behind: f64,
    /// Is no triangle smooth?
    all_flat: bool,
    /// The tree, with the triangles in its leaves and the trees of the models.
    pub(crate) tree: Bvh,
}

/// Triangles on their way into a tree.
#[derive(Default)]
struct Triangles {
    vertices: Vec<Vec3>,
    faces: Vec<[u32; 3]>,
}

/// All that trees are to be built of.
#[derive(Default)]
struct Parts {
    triangles: Triangles,
    models: Vec<Triangles>,
    /// The meshes to be placed, when all ids before them are known: scene index, name, model, map.
    placed: Vec<(usize, String, usize, Affine)>,
    /// The solids of each model.
    solids: Vec<Vec<Solid>>,
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
            spheres: Vec::new(),
            surfaces: Surfaces::default(),
            models: Vec::new(),
            placements: Vec::new(),
            solids: Vec::new(),
            bands: Vec::new(),
            spectra: Vec::new(),
            spectrum_of: Vec::new(),
            background: scene.background,
            clearance: 0.0,
            behind: 0.0,
            all_flat: true,
            tree: Bvh::default(),
        };
        if !world.camera.has_image_plane() {
            let message = "the image plane is so near to the eye that it is lost in rounding".to_owned();
            let place = vec![Step::from("camera"), Step::from("near")];
            return Err(vec![Problem { place, message, help: Some("move it away, like near = -5".to_owned()) }]);
        }
        if world.materials.is_empty() {
            // Where nothing is, nobody asks what it is made of; but rows of the background are rows like others.
            world.materials.push(Material::default());
        }
        world.find_indices();
        let material_ids: IndexMap<&str, u32> =
            scene.materials.keys().enumerate().map(|(i, name)| (name.as_str(), i as u32)).collect();
        for (i, s) in scene.spheres.iter().enumerate() {
            let name = s.name.clone().unwrap_or_else(|| format!("sphere {}", i + 1));
            world.objects.push(Object { name, first: i as u32, count: 1 });
            world.spheres.push(Sphere { center: s.center.into(), radius: s.radius });
            let material = material_ids.get(s.material.as_str()).copied().unwrap_or(0);
            world.surfaces.material_of.push(material);
            if world.refracts(material) {
                world.surfaces.solid_of.resize(i, NO_SOLID);
                world.surfaces.solid_of.push(world.solids.len() as u32);
                let (medium, bounds) = (world.medium_of(material), world.spheres[i].bounds());
                world.solids.push(Solid { medium, inward: false, touches: false, bounds });
            }
        }
        world.surfaces.corner_normals_of.resize(world.spheres.len(), FLAT);
        let mut parts = Parts::default();
        for (i, mesh) in scene.meshes.iter().enumerate() {
            world.add_mesh(i, mesh, &material_ids, &mut parts).map_err(|problem| vec![problem])?;
        }
        for surfaces in world.models.iter_mut().chain([&mut world.surfaces]) {
            world.all_flat &= surfaces.corner_normals.is_empty();
            if surfaces.corner_normals.is_empty() {
                surfaces.corner_normals_of = Vec::new();
            }
        }
        world.build_tree(&parts, quality, threads).map_err(|problem| vec![problem])?;
        Ok(world)
    }

    /// The same world without a tree: every ray is tested against every primitive. Slow, and the oracle of the tests.
    #[must_use]
    pub fn brute_force(mut self) -> Self {
        self.tree = self.tree.flat();
        self
    }

    /// Is there real optics, and does light go through this material?
    fn refracts(&self, material: u32) -> bool {
        self.render.integrator == Integrator::Whitted && self.materials[material as usize].is_transparent()
    }

    /// Number of primitives.
    pub fn primitive_count(&self) -> usize {
        self.objects.last().map_or(0, |object| (object.first + object.count) as usize)
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
        let tree = self.tree.statistics();
        let surfaces: usize = self.models.iter().chain([&self.surfaces]).map(Surfaces::memory).sum();
        size_of_val(self.spheres.as_slice()) + surfaces + tree.node_bytes + tree.primitive_bytes
    }

    fn add_mesh(
        &mut self,
        index: usize,
        mesh: &Mesh,
        material_ids: &IndexMap<&str, u32>,
        parts: &mut Parts,
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
        let map = whole_map(&mesh.transform);
        let placed = source.transformed(&map);
        if let Some(v) = placed.vertices.iter().find(|v| !v.is_finite() || v.length() > LARGEST_NUMBER) {
            let message = format!("a vertex ends up at ({}, {}, {}), beyond 1e15", v.x, v.y, v.z);
            return Err(problem("transform", message));
        }
        let slots = slot_materials(mesh, source, material_ids).map_err(|m| problem("materials", m))?;

        let name = mesh.name.clone().or_else(|| mesh.file.clone()).unwrap_or_else(|| format!("mesh {}", index + 1));
        let material_of = |face: usize, mesh_of: &TriangleMesh| match mesh_of.face_slots.get(face) {
            Some(&slot) if mesh.material.is_none() => slots[slot as usize],
            _ => slots[0],
        };
        let (placed, solids) = self
            .solids_of(&name, &place("open"), mesh, placed, &material_of)
            .map_err(|(message, help)| Problem { place: place("file"), message, help: Some(help) })?;
        let corner_normals = (mesh.smooth_angle > 0.0).then(|| placed.smooth_normals(mesh.smooth_angle));
        let is_model = !mesh.instances.is_empty();
        let (surfaces, triangles) = if is_model {
            self.models.push(Surfaces::default());
            parts.models.push(Triangles::default());
            (self.models.last_mut(), parts.models.last_mut())
        } else {
            (Some(&mut self.surfaces), Some(&mut parts.triangles))
        };
        let (Some(surfaces), Some(triangles)) = (surfaces, triangles) else { return Ok(()) };
        // Solids of a model are numbered from 0, and get their own in each place.
        let first_solid = if is_model { 0 } else { self.solids.len() as u32 };
        let (first, base) = (surfaces.material_of.len() as u32, triangles.vertices.len() as u32);
        let mut without_area = 0usize;
        let mut used = vec![false; self.materials.len()];
        for (f, face) in placed.faces.iter().enumerate() {
            if !triangle::normal(placed.corners(f)).is_finite() {
                without_area += 1;
                continue;
            }
            let material = material_of(f, &placed);
            used[material as usize] = true;
            triangles.faces.push(face.map(|v| v + base));
            surfaces.material_of.push(material);
            if let Some(solids) = &solids {
                // Nothing is written down of what lets no light through.
                surfaces.solid_of.resize(surfaces.material_of.len() - 1, NO_SOLID);
                let transparent = self.materials[material as usize].is_transparent();
                let solid = if transparent { solids.solid_of[f] } else { NO_SOLID };
                surfaces.solid_of.push(if solid == NO_SOLID { NO_SOLID } else { first_solid + solid });
            }
            surfaces
                .corner_normals_of
                .push(corner_normals.as_ref().map_or(FLAT, |_| surfaces.corner_normals.len() as u32));
            surfaces.corner_normals.extend(corner_normals.as_ref().map(|normals| normals[f]));
        }
        triangles.vertices.extend(&placed.vertices);
        let solids = solids.map_or(Vec::new(), |solids| solids.solids);
        if is_model {
            parts.solids.push(solids);
        } else {
            self.solids.extend(solids);
        }
        if is_model {
            let model = self.models.len() - 1;
            let maps = mesh.instances.iter().map(|steps| whole_map(steps));
            parts.placed.extend(maps.map(|map| (index, name.clone(), model, map)));
        } else {
            let count = self.surfaces.material_of.len() as u32 - first;
            self.objects.push(Object { name: name.clone(), first, count });
        }
        self.warn_about(&name, &place("file"), &placed, mesh, without_area, &used);
        Ok(())
    }

    /// The mesh, with its holes filled if that was asked for, and its solids if light goes through it. Fails with what is wrong
    /// and what to do.
    fn solids_of(
        &mut self,
        name: &str,
        place: &[Step],
        mesh: &Mesh,
        placed: TriangleMesh,
        material_of: &impl Fn(usize, &TriangleMesh) -> u32,
    ) -> Result<(TriangleMesh, Option<MeshSolids>), (String, String)> {
        let materials = (0..placed.faces.len()).map(|f| material_of(f, &placed));
        let mut media = materials.filter(|&m| self.refracts(m)).map(|m| self.medium_of(m));
        let Some(medium) = media.next() else { return Ok((placed, None)) };
        if media.any(|other| other != medium) {
            let message =
                format!("mesh `{name}` has faces of different glasses, so that it is not clear what is inside");
            return Err((
                message,
                "give all its transparent materials the same eta, absorption and priority".to_owned(),
            ));
        }
        drop(media);
        let why_not = match MeshSolids::of(&placed, medium) {
            Ok(solids) => return Ok((placed, Some(solids))),
            Err(why_not) => why_not,
        };
        let message = format!("mesh `{name}` is transparent but not a solid: {why_not}");
        let help =
            "`snell check` shows what is wrong with it and can repair it; or add open = \"fill\" or open = \"opaque\"";
        match mesh.open {
            None => Err((message, help.to_owned())),
            Some(OpenMesh::Opaque) => {
                let message = format!("{message}; it is opaque, as `open` says");
                self.warnings.push(Warning { code: WarningCode::MeshNotRefracted, place: place.to_vec(), message });
                Ok((placed, None))
            }
            Some(OpenMesh::Fill) => {
                let (filled, _) = repair(&placed, &Options::default());
                match MeshSolids::of(&filled, medium) {
                    Ok(solids) => Ok((filled, Some(solids))),
                    Err(why_not) => Err((
                        format!("mesh `{name}` is transparent, and with its holes filled still not a solid: {why_not}"),
                        "`snell check` shows what is wrong with it; or add open = \"opaque\"".to_owned(),
                    )),
                }
            }
        }
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
        let transparent = self.materials.iter().zip(used).any(|(m, &used)| used && m.is_transparent());
        let refracts_spheres = matches!(self.render.integrator, Integrator::Lecture | Integrator::Course2020);
        if transparent && refracts_spheres {
            let message = format!(
                "mesh `{name}` has a transparent material, but this integrator refracts only in spheres: \
                 its transparent share is not drawn"
            );
            warn(WarningCode::MeshNotRefracted, message);
        }
    }

    fn build_tree(&mut self, parts: &Parts, quality: Quality, threads: usize) -> Result<(), Problem> {
        let problem = |mesh: usize, message: String| {
            let place = vec![Step::from("mesh"), Step::from(mesh), Step::from("instances")];
            Problem { place, message, help: None }
        };
        let Triangles { vertices, faces } = &parts.triangles;
        let shapes = Shapes { spheres: &self.spheres, vertices, faces, instances: &[] };
        if shapes.count() + parts.placed.len() >= 1 << 31 {
            let message = "more than 2 billion spheres and triangles".to_owned();
            return Err(Problem { place: vec![Step::from("mesh")], message, help: None });
        }
        // Rays start on surfaces or on the image plane; no ray origin is farther from a primitive than this.
        let corners = Bounds::of(self.camera.corners());
        let mut everything = (0..shapes.count()).map(|i| shapes.bounds(i)).fold(corners, Bounds::union);
        let mut boxes = Vec::with_capacity(parts.placed.len());
        for (mesh, name, model, map) in &parts.placed {
            let Triangles { vertices, faces } = &parts.models[*model];
            // Vertices of no face may lie anywhere, and must not make the boxes of others larger.
            let vertices = if faces.is_empty() { &[] } else { vertices.as_slice() };
            let bounds = Bounds::of(vertices.iter().map(|&v| map.apply(v)));
            if !(bounds.farthest() <= LARGEST_NUMBER || faces.is_empty()) {
                return Err(problem(*mesh, format!("an instance of mesh `{name}` reaches beyond 1e15")));
            }
            everything = everything.union(bounds);
            boxes.push(bounds);
        }
        let (reach, farthest) = (everything.diagonal(), everything.farthest());
        self.clearance = MARGIN * (reach + farthest);
        self.behind = 0.5 * MARGIN * reach;
        // In the space of a model rays come from everywhere that any of its instances sees.
        let mut seen: Vec<Bounds> = parts.models.iter().map(|m| Bounds::of(m.vertices.iter().copied())).collect();
        let mut instances = Vec::with_capacity(parts.placed.len());
        let mut first = self.surfaces.material_of.len();
        for ((mesh, name, model, map), bounds) in parts.placed.iter().zip(boxes) {
            let instance = Instance::new(*model, map, first as u32, bounds, reach, farthest);
            let flat = || problem(*mesh, format!("an instance of mesh `{name}` is scaled by 0"));
            let instance = instance.ok_or_else(flat)?;
            seen[*model] = seen[*model].union(Bounds::of(everything.corners().map(|c| instance.to_model.apply(c))));
            let count = self.models[*model].material_of.len();
            self.objects.push(Object { name: name.clone(), first: first as u32, count: count as u32 });
            let placement = Placement {
                model: *model,
                first: first as u32,
                first_solid: self.solids.len() as u32,
                to_world: *map,
                to_model: instance.to_model,
            };
            self.solids.extend(parts.solids[*model].iter().map(|solid| solid.placed(map)));
            if count > 0 {
                self.placements.push(placement);
                instances.push(instance);
            }
            first += count;
            if first >= NO_PRIMITIVE as usize {
                return Err(problem(*mesh, "more than 4 billion triangles in all places together".to_owned()));
            }
        }
        let models = parts.models.iter().zip(seen).map(|(Triangles { vertices, faces }, seen)| {
            let shapes = Shapes { vertices, faces, ..Shapes::default() };
            Bvh::build(&shapes, vec![], seen.diagonal(), quality, threads)
        });
        let models = models.collect();
        let touching = self.touching(&shapes, &instances);
        let shapes = Shapes { instances: &instances, ..shapes };
        self.tree = Bvh::build(&shapes, models, reach, quality, threads);
        for (solid, touches) in self.solids.iter_mut().zip(touching) {
            solid.touches = touches;
        }
        Ok(())
    }
}

/// Some steps, one after the other.
fn whole_map(steps: &[Transform]) -> Affine {
    steps.iter().filter_map(Transform::map).fold(Affine::IDENTITY, Affine::then)
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
