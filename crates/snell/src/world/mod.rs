//! The compiled scene: arrays, a tree, a camera. Immutable; holds no names but for messages.

mod camera;
mod lamp;
mod light;
mod material;
mod mesh;
mod shape;
mod skipped;
mod solid;
mod sphere;
mod surface;
mod texture;
mod tree;

pub use camera::CameraFrame;
pub(crate) use camera::JITTER;
pub(crate) use light::LightSource;
pub(crate) use material::CompiledMaterial;
use mesh::{MaterialIds, Parts};
pub(crate) use solid::{Medium, NO_SOLID, Solid};
pub use surface::NO_PRIMITIVE;
pub(crate) use surface::Side;
use surface::{FLAT, Placement, Surfaces};
pub(crate) use texture::{Background, Pattern};

use crate::color::Rgb;
use crate::geometry::bvh::{Bvh, Quality, TreeStatistics};
use crate::geometry::{Affine, Bounds, Sphere};
use crate::optics::spectrum::{self, Band};
use crate::scene::{Integrator, Mesh, Problem, Problems, Scene, Step, Warning, validate};

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
/// Primitives are numbered kind by kind, those of a kind in the order of the scene: spheres, triangles, planes, boxes, discs,
/// then what stands in many places. At equal distance the lower number is hit.
#[derive(Clone, Debug)]
pub struct World {
    /// The camera, placed.
    pub camera: CameraFrame,
    /// Objects in the order of their primitives.
    pub objects: Vec<Object>,
    /// What is probably not meant.
    pub warnings: Vec<Warning>,
    /// Is it compiled for models of light that follow rays through solids, from medium to medium?
    pub(crate) has_media: bool,
    pub(crate) ambient: Rgb,
    pub(crate) eta_outside: f64,
    pub(crate) lights: Vec<LightSource>,
    pub(crate) materials: Vec<CompiledMaterial>,
    pub(crate) spheres: Vec<Sphere>,
    /// How each sphere is turned back for its texture; empty where none is turned.
    sphere_turns: Vec<Affine>,
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
    /// Patterns on surfaces.
    pub(crate) patterns: Vec<Pattern>,
    /// Has a pattern places where the surface is not there?
    pub(crate) has_alpha: bool,
    /// Light from where nothing is.
    pub(crate) background: Background,
    /// No ray is longer before it hits something: the diagonal of the box around everything, the starts of camera rays included.
    pub(crate) reach: f64,
    /// How far a computed hit may be off the plane of its face, in scene units (`docs/tolerances.md`).
    pub(crate) coincidence_tolerance: f64,
    /// How far behind its start a ray may still meet something: half of what the boxes of the tree are larger than what is in
    /// them, so that no way down the tree can hide it.
    pub(crate) exit_tolerance: f64,
    /// Is no triangle smooth?
    all_flat: bool,
    /// The tree, with the triangles in its leaves and the trees of the models.
    pub(crate) tree: Bvh,
}

impl World {
    /// Compiles a scene, with all processors.
    ///
    /// # Errors
    /// Everything that is wrong with the scene. A mesh that names a file must have been read before.
    pub fn new(scene: &Scene) -> Result<Self, Problems> {
        Self::build(scene, Quality::default(), 0)
    }

    /// Compiles a scene with a tree of this quality, on so many threads, 0 for as many as the machine has cores. Neither
    /// changes the picture.
    ///
    /// # Errors
    /// As [`World::new`].
    pub fn build(scene: &Scene, quality: Quality, threads: usize) -> Result<Self, Problems> {
        let warnings = validate(scene)?;
        let has_media = scene.render.integrator.has_media();
        let bands =
            if has_media && scene.render.bands > 1 { spectrum::bands(scene.render.bands as usize) } else { Vec::new() };
        let patterns = texture::patterns(scene, has_media)?;
        let has_alpha: Vec<bool> = patterns.iter().map(Pattern::has_alpha).collect();
        let (materials, spectra) = material::compile(scene, &bands, &has_alpha);
        let mut world = Self {
            has_media,
            camera: CameraFrame::new(&scene.camera, &scene.render),
            objects: Vec::new(),
            warnings,
            ambient: scene.ambient,
            eta_outside: scene.eta_outside,
            lights: scene.lights.iter().map(LightSource::new).collect(),
            materials,
            spheres: Vec::new(),
            sphere_turns: Vec::new(),
            surfaces: Surfaces::default(),
            models: Vec::new(),
            placements: Vec::new(),
            solids: Vec::new(),
            bands,
            spectra,
            patterns,
            has_alpha: has_alpha.contains(&true),
            background: Background::new(scene.background, scene.sky.as_ref()).ok_or_else(|| unread("sky"))?,
            reach: 0.0,
            coincidence_tolerance: 0.0,
            exit_tolerance: 0.0,
            all_flat: true,
            tree: Bvh::default(),
        };
        if !world.camera.has_image_plane() {
            let message = "the image plane is so near to the eye that it is lost in rounding".to_owned();
            let place = vec![Step::from("camera"), Step::from("near")];
            let help = "move it away from the eye: let `near` be more negative, and `bounds` larger by the same factor";
            return Err(Problem { place, message, help: Some(help.to_owned()), remedy: None }.into());
        }
        let material_ids: MaterialIds<'_> =
            scene.materials.keys().enumerate().map(|(i, name)| (name.as_str(), i as u32)).collect();
        for (i, sphere) in scene.spheres.iter().enumerate() {
            world.add_sphere(i, sphere, &material_ids)?;
        }
        world.surfaces.corner_normals_of.resize(world.spheres.len(), FLAT);
        let mut parts = Parts::of(scene.render.integrator);
        let mut add = |kind, i, mesh: &Mesh| world.add_mesh((kind, i), mesh, &material_ids, &mut parts);
        scene.meshes.iter().enumerate().try_for_each(|(i, mesh)| add("mesh", i, mesh))?;
        scene.lathes.iter().enumerate().try_for_each(|(i, lathe)| add("lathe", i, &lathe.mesh(i)))?;
        world.add_shapes(scene, &material_ids, &mut parts)?;
        for surfaces in world.models.iter_mut().chain([&mut world.surfaces]) {
            world.all_flat &= surfaces.corner_normals.is_empty();
            if surfaces.corner_normals.is_empty() {
                surfaces.corner_normals_of = Vec::new();
            }
        }
        world.build_tree(&parts, quality, threads)?;
        world.find_lights_on_surfaces(scene, &parts);
        world.warnings.extend(world.before_image_plane(scene.render.spp));
        Ok(world)
    }

    /// Can it be rendered with this model of light? Worlds of models with media hold solids and what is in them, others do not.
    pub fn is_for(&self, integrator: Integrator) -> bool {
        self.has_media == integrator.has_media()
    }

    /// The same world without a tree: every ray is tested against every primitive. Slow, and the oracle of the tests.
    #[must_use]
    pub fn brute_force(mut self) -> Self {
        self.tree = self.tree.flat();
        self
    }

    /// Is there real optics, and is this material the surface of what light goes through? Thin panes have no inside.
    fn refracts(&self, material: u32) -> bool {
        let material = &self.materials[material as usize];
        self.has_media && material.is_transparent() && !material.is_pane()
    }

    /// Number of primitives.
    pub fn primitive_count(&self) -> usize {
        self.objects.last().map_or(0, |object| (object.first + object.count) as usize)
    }

    /// The names of its objects, each once where several in a row have it.
    pub fn object_names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = self.objects.iter().map(|object| object.name.as_str()).collect();
        names.dedup();
        names
    }

    /// The object that a primitive belongs to.
    pub fn object_of(&self, primitive: u32) -> Option<&Object> {
        let after = self.objects.partition_point(|o| o.first <= primitive);
        self.objects[..after].last().filter(|o| primitive - o.first < o.count)
    }

    /// The smallest box around everything that is there; [`Bounds::EMPTY`] if nothing is.
    pub fn bounds(&self) -> Bounds {
        (0..self.primitive_count()).map(|primitive| self.shape(primitive).bounds()).fold(Bounds::EMPTY, Bounds::union)
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
}

/// A picture that the scene names has not been read.
fn unread(key: &str) -> Problem {
    let place = vec![Step::from(key), Step::from("image")];
    Problem { place, message: "this picture has not been read".to_owned(), help: None, remedy: None }
}
