//! From the meshes of a scene to triangles, surfaces and solids.

use super::Object;
use super::builder::Builder;
use super::solid::MeshSolids;
use crate::geometry::area::largest_angle;
use crate::geometry::mesh::{MAX_SMOOTHED_VALENCE, NormalWeights};
use crate::geometry::shape::{self, Cuboid, Disc, Rectangle, Shapes, Sphere};
use crate::geometry::solid::{Options, repair, structure};
use crate::geometry::{Affine, Bounds, TriangleMesh, Vec3, triangle};
use crate::scene::{
    Integrator, LARGEST_NUMBER, Mesh, OpenMesh, Problem, Remedy, Step, Warning, WarningCode, whole_map,
};
use crate::stage::{CompiledMaterial, FLAT, NO_PRIMITIVE, NO_SOLID, Solid, Surfaces};
use std::sync::Arc;

/// Triangles on their way into a tree, each with its largest angle first ([`area`](crate::geometry::area)).
#[derive(Default)]
pub(super) struct Triangles {
    pub vertices: Vec<Vec3>,
    pub faces: Vec<[u32; 3]>,
}

impl Triangles {
    pub fn list(&self) -> shape::Triangles<'_> {
        shape::Triangles { vertices: &self.vertices, faces: &self.faces }
    }
}

/// Which shape of a scene: the name of its list, and its number there.
pub(super) type Which = (&'static str, usize);

/// All that trees are to be built of.
#[derive(Default)]
pub(super) struct Parts {
    pub triangles: Triangles,
    pub models: Vec<Triangles>,
    /// The meshes to be placed, when all ids before them are known: shape of the scene, name, model, map.
    pub placed: Vec<(Which, String, usize, Affine)>,
    /// Shapes that stand for themselves.
    pub rectangles: Vec<Rectangle>,
    pub cuboids: Vec<Cuboid>,
    pub discs: Vec<Disc>,
    /// The solids of each model.
    pub solids: Vec<Vec<Solid>>,
}

impl Parts {
    /// All shapes, without the meshes that are to be placed.
    pub fn shapes<'a>(&'a self, spheres: &'a [Sphere]) -> Shapes<'a> {
        Shapes {
            spheres,
            triangles: self.triangles.list(),
            rectangles: &self.rectangles,
            cuboids: &self.cuboids,
            discs: &self.discs,
            instances: &[],
        }
    }
}

/// What is on both sides of the transparent faces of a mesh.
enum Sides {
    /// Nothing goes through any of them.
    None,
    /// They enclose solids.
    Solids(MeshSolids),
    /// They are interfaces between two media, by the numbers of their solids: behind them and in front.
    Interface([u32; 2]),
}

impl Sides {
    /// The solids behind a face and in front of it.
    fn of(&self, face: usize, first_solid: u32) -> [u32; 2] {
        match self {
            Self::None => [NO_SOLID; 2],
            Self::Solids(solids) => match solids.interior_of[face] {
                NO_SOLID => [NO_SOLID; 2],
                solid => [first_solid + solid, NO_SOLID],
            },
            Self::Interface(sides) => *sides,
        }
    }
}

/// A mesh that is ready to stand among the others.
struct Faces<'a, M> {
    mesh: &'a TriangleMesh,
    material_of: M,
    sides: &'a Sides,
    /// What the numbers of its solids begin with.
    first_solid: u32,
    /// Of smooth surfaces.
    corner_normals: Option<Vec<[Vec3; 3]>>,
    textured: bool,
}

impl<M: Fn(usize, &TriangleMesh) -> u32> Faces<'_, M> {
    /// Appends the faces. Returns how many of them have no area and are left out, and which materials the others have.
    fn append(
        self,
        materials: &[CompiledMaterial],
        surfaces: &mut Surfaces,
        triangles: &mut Triangles,
    ) -> (usize, Vec<bool>) {
        let base = triangles.vertices.len() as u32;
        let (mut without_area, mut used) = (0, vec![false; materials.len()]);
        for (f, face) in self.mesh.faces.iter().enumerate() {
            let corners = self.mesh.corners(f);
            if !triangle::normal(corners).is_finite() {
                without_area += 1;
                continue;
            }
            let first_corner = largest_angle(corners);
            let material = (self.material_of)(f, self.mesh);
            used[material as usize] = true;
            let row = surfaces.material_of.len();
            triangles.faces.push(turned(*face, first_corner).map(|v| v + base));
            surfaces.material_of.push(material);
            if materials[material as usize].is_transparent() {
                let [behind, front] = self.sides.of(f, self.first_solid);
                put_sparse(&mut surfaces.interior_of, row, behind, NO_SOLID);
                put_sparse(&mut surfaces.exterior_of, row, front, NO_SOLID);
            }
            let normals = self.corner_normals.as_ref().map(|normals| turned(normals[f], first_corner));
            let at = normals.map_or(FLAT, |_| surfaces.corner_normals.len() as u32);
            surfaces.corner_normals_of.push(at);
            surfaces.corner_normals.extend(normals);
            if self.textured {
                put_sparse(&mut surfaces.corner_uvs_of, row, surfaces.corner_uvs.len() as u32, FLAT);
                surfaces.corner_uvs.push(turned(self.mesh.corner_uvs(f).unwrap_or_default(), first_corner));
            }
        }
        triangles.vertices.extend(&self.mesh.vertices);
        (without_area, used)
    }
}

fn place_of(which: Which, key: &'static str) -> Vec<Step> {
    vec![Step::from(which.0), Step::from(which.1), Step::from(key)]
}

/// What is wrong with a shape, without its place.
pub(super) fn refusal(message: String, help: &str, remedy: Option<Remedy>) -> Problem {
    Problem { place: Vec::new(), message, help: Some(help.to_owned()), remedy }
}

/// The course's pictures are made with the plain mean.
fn normal_weights(has_media: bool) -> NormalWeights {
    if has_media { NormalWeights::Angle } else { NormalWeights::Equal }
}

impl Builder<'_> {
    pub(super) fn add_mesh(&mut self, which: Which, mesh: &Mesh) -> Result<(), Problem> {
        if mesh.inside.is_some() && !mesh.instances.is_empty() {
            // Media are what they are everywhere, unlike the solids of a model, which are others in each place.
            for steps in &mesh.instances {
                let transform = [mesh.transform.as_slice(), steps].concat();
                let one = Mesh { transform, instances: Vec::new(), ..mesh.clone() };
                self.add_mesh(which, &one)?;
            }
            return Ok(());
        }
        let (placed, slots) = self.placed(which, mesh)?;
        let name = mesh.name.clone().or_else(|| mesh.file.clone());
        let name = name.unwrap_or_else(|| format!("{} {}", which.0, which.1 + 1));
        let material_of = |face: usize, mesh_of: &TriangleMesh| match mesh_of.face_slots.get(face) {
            Some(&slot) if mesh.material.is_none() => slots[slot as usize],
            _ => slots[0],
        };
        // Where a person would look for what is wrong with the mesh.
        let main_place = place_of(which, if mesh.file.is_some() { "file" } else { "material" });
        let refused = |problem| Problem { place: main_place.clone(), ..problem };
        let open = place_of(which, "open");
        let (placed, sides) = self.sides_of(&name, &open, mesh, placed, &material_of).map_err(refused)?;
        let textured = (0..placed.faces.len()).any(|f| self.stage.texture_of(material_of(f, &placed)).is_some());
        if textured && placed.face_uvs.is_empty() && !placed.faces.is_empty() {
            let help = "give it a material without texture, or a model file with texture coordinates";
            return Err(refused(refusal(format!("`{name}` has no texture coordinates for its texture"), help, None)));
        }
        let weights = normal_weights(self.stage.has_media);
        let corner_normals = (mesh.smooth_angle > 0.0).then(|| placed.smooth_normals(mesh.smooth_angle, weights));
        let is_model = !mesh.instances.is_empty();
        // Solids of a model are numbered from 0, and get their own in each place.
        let first_solid = if is_model { 0 } else { self.stage.solids.len() as u32 };
        let faces = Faces { mesh: &placed, material_of, sides: &sides, first_solid, corner_normals, textured };
        let (without_area, used) = if is_model {
            let (mut surfaces, mut triangles) = (Surfaces::default(), Triangles::default());
            let added = faces.append(&self.stage.materials, &mut surfaces, &mut triangles);
            self.models.push(surfaces);
            self.parts.models.push(triangles);
            let maps = mesh.instances.iter().map(|steps| whole_map(steps));
            let model = self.models.len() - 1;
            self.parts.placed.extend(maps.map(|map| (which, name.clone(), model, map)));
            added
        } else {
            let first = self.surfaces.material_of.len() as u32;
            let added = faces.append(&self.stage.materials, &mut self.surfaces, &mut self.parts.triangles);
            let count = self.surfaces.material_of.len() as u32 - first;
            Arc::make_mut(&mut self.objects).push(Object { name: name.clone(), first, count });
            added
        };
        let solids = if let Sides::Solids(solids) = sides { solids.solids } else { Vec::new() };
        if is_model {
            self.parts.solids.push(solids);
        } else {
            self.stage.solids.extend(solids);
        }
        self.warn_about(&name, &main_place, &placed, mesh, without_area, &used);
        Ok(())
    }

    /// The triangles of a mesh where its transform puts them, and the materials of its slots.
    fn placed(&self, which: Which, mesh: &Mesh) -> Result<(TriangleMesh, Vec<u32>), Problem> {
        let problem = |key, message| Problem { place: place_of(which, key), message, help: None, remedy: None };
        let written;
        let source = match (&mesh.geometry, &mesh.file) {
            (Some(geometry), _) => geometry.as_ref(),
            (None, Some(file)) => return Err(problem("file", format!("`{file}` has not been read"))),
            (None, None) => {
                written = written_out(mesh);
                &written
            }
        };
        if !source.face_uvs.is_empty() && source.face_uvs.len() != source.faces.len() {
            let (uvs, faces) = (source.face_uvs.len(), source.faces.len());
            return Err(problem("file", format!("{uvs} of {faces} faces have texture coordinates: all or none must")));
        }
        let placed = source.transformed(&whole_map(&mesh.transform));
        if let Some(v) = placed.vertices.iter().find(|v| !v.is_finite() || v.length() > LARGEST_NUMBER) {
            let message = format!("a vertex ends up at ({}, {}, {}), beyond 1e15", v.x, v.y, v.z);
            return Err(problem("transform", message));
        }
        let slots = self.slot_materials(mesh, source).map_err(|message| problem("materials", message))?;
        Ok((placed, slots))
    }

    /// The material of each slot of a model; at least one.
    fn slot_materials(&self, mesh: &Mesh, source: &TriangleMesh) -> Result<Vec<u32>, String> {
        let id =
            |name: &str| self.material_ids.get(name).copied().ok_or_else(|| format!("no material is called `{name}`"));
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

    /// The mesh, with its holes filled if that was asked for, and what is on both sides of its faces if light goes through
    /// them. Fails with what is wrong and what to do, but not where.
    fn sides_of(
        &mut self,
        name: &str,
        place: &[Step],
        mesh: &Mesh,
        placed: TriangleMesh,
        material_of: &impl Fn(usize, &TriangleMesh) -> u32,
    ) -> Result<(TriangleMesh, Sides), Problem> {
        let materials = (0..placed.faces.len()).map(|f| material_of(f, &placed));
        let mut media = materials.filter(|&m| self.refracts(m)).map(|m| self.stage.materials[m as usize].medium());
        let Some(medium) = media.next() else {
            if mesh.inside.is_some() && self.stage.has_media {
                return Err(nothing_goes_through(name));
            }
            drop(media);
            return Ok((placed, Sides::None));
        };
        if mesh.inside.is_some() {
            drop(media);
            return self.interface(name, mesh, placed);
        }
        if media.any(|other| other != medium) {
            let message = format!("`{name}` has faces of different glasses, so that it is not clear what is inside");
            let help = "give all its transparent materials the same eta, absorption and priority";
            return Err(refusal(message, help, None));
        }
        drop(media);
        let why_not = match MeshSolids::of(&placed, medium) {
            Ok(solids) => return Ok((placed, Sides::Solids(solids))),
            Err(why_not) => why_not,
        };
        let message = format!("`{name}` is transparent but not a solid: {why_not}");
        match mesh.open {
            None => {
                let help = "give its material a `thickness` for thin panes, or the mesh open = \"fill\" or open = \
                            \"opaque\", or the media on both sides, `inside` and `outside`";
                Err(refusal(message, help, Some(Remedy::CheckMesh)))
            }
            Some(OpenMesh::Opaque) => {
                let message = format!("{message}; it is opaque, as `open` says");
                self.shape_warnings.push(Warning {
                    code: WarningCode::MeshNotRefracted,
                    place: place.to_vec(),
                    message,
                });
                Ok((placed, Sides::None))
            }
            Some(OpenMesh::Fill) => {
                let (filled, _) = repair(&placed, &Options::default());
                match MeshSolids::of(&filled, medium) {
                    Ok(solids) => Ok((filled, Sides::Solids(solids))),
                    Err(why_not) => Err(refusal(
                        format!("`{name}` is transparent, and with its holes filled still not a solid: {why_not}"),
                        "add open = \"opaque\"",
                        Some(Remedy::CheckMesh),
                    )),
                }
            }
        }
    }

    /// Faces that are interfaces between two media.
    fn interface(
        &mut self,
        name: &str,
        mesh: &Mesh,
        mut placed: TriangleMesh,
    ) -> Result<(TriangleMesh, Sides), Problem> {
        let turned = structure(&placed).misoriented.count;
        if turned > 0 {
            let message =
                format!("`{name}` has two sides, but at {turned} of its edges neighbouring faces look opposite ways");
            return Err(refusal(message, "turn them to one side", Some(Remedy::RepairMesh)));
        }
        let bounds = Bounds::of(placed.vertices.iter().copied());
        let [inside, outside] = [self.side(mesh.inside.as_ref(), bounds), self.side(mesh.outside.as_ref(), bounds)];
        if whole_map(&mesh.transform).mirrors() {
            // In a mirror image faces look the other way.
            (0..placed.faces.len()).for_each(|face| placed.turn(face));
        }
        Ok((placed, Sides::Interface([inside, outside])))
    }

    /// The solid of all that interfaces say to be filled with the material of this name; [`NO_SOLID`] where there is none.
    pub(super) fn side(&mut self, material: Option<&String>, bounds: Bounds) -> u32 {
        let Some(&material) = material.and_then(|name| self.material_ids.get(name.as_str())) else { return NO_SOLID };
        let known = self.stage.solids.iter().position(|solid| solid.between_faces_of == Some(material));
        let number = known.unwrap_or(self.stage.solids.len());
        if known.is_none() {
            let medium = self.stage.materials[material as usize].medium();
            let bounds = Bounds::EMPTY;
            self.stage.solids.push(Solid {
                medium,
                inward: false,
                touches: false,
                between_faces_of: Some(material),
                primitive: NO_PRIMITIVE,
                bounds,
            });
        }
        self.stage.solids[number].bounds = self.stage.solids[number].bounds.union(bounds);
        number as u32
    }

    #[allow(clippy::too_many_arguments, reason = "all that is known of a mesh, and nobody else wants it together")]
    fn warn_about(
        &mut self,
        name: &str,
        place: &[Step],
        placed: &TriangleMesh,
        mesh: &Mesh,
        without_area: usize,
        used: &[bool],
    ) {
        let mut warn = |code, message| self.shape_warnings.push(Warning { code, place: place.to_vec(), message });
        if without_area > 0 {
            let message = format!("`{name}`: {without_area} faces without area are left out");
            warn(WarningCode::DegenerateFaces, message);
        }
        if mesh.smooth_angle > 0.0 {
            let mut valence = vec![0usize; placed.vertices.len()];
            placed.faces.iter().flatten().for_each(|&v| valence[v as usize] += 1);
            if valence.iter().any(|&n| n > MAX_SMOOTHED_VALENCE) {
                let message = format!("`{name}`: vertices shared by more than {MAX_SMOOTHED_VALENCE} faces stay flat");
                warn(WarningCode::NotSmoothed, message);
            }
        }
        let transparent = self.stage.materials.iter().zip(used).any(|(m, &used)| used && m.is_transparent());
        if transparent {
            self.warn_not_refracted(name, place.to_vec());
        }
    }

    /// Warns of what is transparent and no sphere, where only spheres refract.
    pub(super) fn warn_not_refracted(&mut self, name: &str, place: Vec<Step>) {
        if matches!(self.scene.render.integrator, Integrator::Lecture | Integrator::Course2020) {
            let message = format!(
                "`{name}` has a transparent material, but this integrator refracts only in spheres: \
                 its transparent share is not drawn"
            );
            self.shape_warnings.push(Warning { code: WarningCode::MeshNotRefracted, place, message });
        }
    }
}

/// Why faces cannot be interfaces, and what to do.
pub(super) fn nothing_goes_through(name: &str) -> Problem {
    let message = format!("`{name}` has media on both sides, but light does not go through its material");
    refusal(message, "give the material a `ko` below 1 and no `thickness`, or remove `inside`", None)
}

/// Sets a value in a list that ends with the last value that is not the usual one.
pub(super) fn put_sparse(list: &mut Vec<u32>, at: usize, value: u32, usual: u32) {
    if value != usual {
        list.resize(at, usual);
        list.push(value);
    }
}

/// What belongs to the corners of a triangle, from one of them on.
fn turned<T>(mut corners: [T; 3], first: usize) -> [T; 3] {
    corners.rotate_left(first);
    corners
}

/// The triangles that are written in the scene itself.
fn written_out(mesh: &Mesh) -> TriangleMesh {
    let vertices = mesh.vertices.iter().map(|&v| v.into()).collect();
    TriangleMesh { vertices, faces: mesh.faces.clone(), ..TriangleMesh::default() }
}
