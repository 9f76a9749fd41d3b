//! From a scene to a world, part by part.

use super::mesh::Parts;
use super::tree::Ground;
use super::{Object, World, light, material, texture};
use crate::geometry::Bounds;
use crate::geometry::bvh::Quality;
use crate::optics::spectrum;
use crate::scene::{Problem, Problems, Scene, Step, Warning, validate};
use crate::stage::{FLAT, Pattern, Stage, Surfaces};
use indexmap::IndexMap;
use std::mem;
use std::sync::Arc;

/// What is there of a world, while its parts are added one after the other: those that are numbered first come first.
pub(super) struct Builder<'a> {
    pub scene: &'a Scene,
    pub stage: Stage,
    /// Of the primitives that stand for themselves, and of the models.
    pub surfaces: Surfaces,
    pub models: Vec<Surfaces>,
    pub objects: Arc<Vec<Object>>,
    /// Of the scene as it is written.
    pub warnings: Vec<Warning>,
    /// Of the shapes, as they are compiled.
    pub shape_warnings: Vec<Warning>,
    /// The numbers of materials, by their names.
    pub material_ids: IndexMap<&'a str, u32>,
    /// What trees are to be built of.
    pub parts: Parts,
    pub ground: Ground,
}

impl<'a> Builder<'a> {
    /// Everything but what stands there: camera, lights, materials.
    pub fn new(scene: &'a Scene) -> Result<Self, Problems> {
        let warnings = validate(scene)?;
        let mut stage = Stage::new(scene.camera.frame(&scene.render));
        if !stage.camera.has_image_plane() {
            let message = "the image plane is so near to the eye that it is lost in rounding".to_owned();
            let place = vec![Step::from("camera"), Step::from("near")];
            let help = "move it away from the eye: let `near` be more negative, and `bounds` larger by the same factor";
            return Err(Problem { place, message, help: Some(help.to_owned()), remedy: None }.into());
        }
        stage.has_media = scene.render.integrator.has_media();
        stage.ambient = scene.ambient;
        stage.eta_outside = scene.eta_outside;
        stage.lights = scene.lights.iter().map(light::compile).collect();
        stage.background = texture::background(scene.background, scene.sky.as_ref()).ok_or_else(|| unread("sky"))?;
        if stage.has_media && scene.render.bands > 1 {
            stage.bands = spectrum::bands(scene.render.bands as usize);
        }
        stage.patterns = texture::patterns(scene, stage.has_media)?;
        let has_alpha: Vec<bool> = stage.patterns.iter().map(Pattern::has_alpha).collect();
        stage.has_alpha = has_alpha.contains(&true);
        (stage.materials, stage.spectra) = material::compile(scene, &stage.bands, &has_alpha);
        let material_ids = scene.materials.keys().enumerate().map(|(i, name)| (name.as_str(), i as u32)).collect();
        Ok(Self {
            scene,
            stage,
            surfaces: Surfaces::default(),
            models: Vec::new(),
            objects: Arc::default(),
            warnings,
            shape_warnings: Vec::new(),
            material_ids,
            parts: Parts::default(),
            ground: Ground { extent: Bounds::EMPTY, margin: 0.0, opaque: Arc::default() },
        })
    }

    /// Adds what stands there, in the order of its numbers, and the tree over it.
    pub fn build(mut self, quality: Quality, threads: usize) -> Result<World, Problems> {
        let scene = self.scene;
        for (i, sphere) in scene.spheres.iter().enumerate() {
            self.add_sphere(i, sphere)?;
        }
        self.surfaces.corner_normals_of.resize(self.stage.spheres.len(), FLAT);
        for (i, mesh) in scene.meshes.iter().enumerate() {
            self.add_mesh(("mesh", i), mesh)?;
        }
        for (i, lathe) in scene.lathes.iter().enumerate() {
            self.add_mesh(("lathe", i), &lathe.mesh(i))?;
        }
        self.add_shapes()?;
        for surfaces in self.models.iter_mut().chain([&mut self.surfaces]) {
            self.stage.all_flat &= surfaces.corner_normals.is_empty();
            if surfaces.corner_normals.is_empty() {
                surfaces.corner_normals_of = Vec::new();
            }
        }
        self.stage.surfaces = Arc::new(mem::take(&mut self.surfaces));
        self.stage.models = Arc::new(mem::take(&mut self.models));
        self.build_tree(quality, threads)?;
        self.stage.objects = self.objects.iter().map(|object| object.first..object.first + object.count).collect();
        Ok(self.finish())
    }

    /// The world, with the warnings that need all of it.
    pub fn finish(self) -> World {
        let Self { scene, stage, objects, warnings, shape_warnings, ground, .. } = self;
        let mut world = World { stage, objects, warnings, shape_warnings, ground };
        world.warnings.extend(world.shape_warnings.iter().cloned());
        world.warnings.extend(world.lights_on_surfaces(scene));
        world.warnings.extend(world.before_image_plane(scene.render.spp));
        world
    }

    /// Is there real optics, and is this material the surface of what light goes through? Thin panes have no inside.
    pub fn refracts(&self, material: u32) -> bool {
        let material = &self.stage.materials[material as usize];
        self.stage.has_media && material.is_transparent() && !material.is_pane()
    }

    /// Number of primitives so far.
    pub fn primitive_count(&self) -> usize {
        self.objects.last().map_or(0, |object| (object.first + object.count) as usize)
    }
}

/// A picture that the scene names has not been read.
fn unread(key: &str) -> Problem {
    let place = vec![Step::from(key), Step::from("image")];
    Problem { place, message: "this picture has not been read".to_owned(), help: None, remedy: None }
}
