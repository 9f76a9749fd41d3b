//! From a scene to a world, part by part.

use super::mesh::Parts;
use super::{Object, World, light, material, texture};
use crate::geometry::bvh::Quality;
use crate::optics::spectrum;
use crate::scene::{Problem, Problems, Scene, Step, Warning, validate};
use crate::stage::{FLAT, Pattern, Stage};
use indexmap::IndexMap;

/// What is there of a world, while its parts are added one after the other: those that are numbered first come first.
pub(super) struct Builder<'a> {
    pub scene: &'a Scene,
    pub stage: Stage,
    pub objects: Vec<Object>,
    pub warnings: Vec<Warning>,
    /// The numbers of materials, by their names.
    pub material_ids: IndexMap<&'a str, u32>,
    /// What trees are to be built of.
    pub parts: Parts,
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
        Ok(Self { scene, stage, objects: Vec::new(), warnings, material_ids, parts: Parts::default() })
    }

    /// Adds what stands there, in the order of its numbers, and the tree over it.
    pub fn build(mut self, quality: Quality, threads: usize) -> Result<World, Problems> {
        let scene = self.scene;
        for (i, sphere) in scene.spheres.iter().enumerate() {
            self.add_sphere(i, sphere)?;
        }
        self.stage.surfaces.corner_normals_of.resize(self.stage.spheres.len(), FLAT);
        for (i, mesh) in scene.meshes.iter().enumerate() {
            self.add_mesh(("mesh", i), mesh)?;
        }
        for (i, lathe) in scene.lathes.iter().enumerate() {
            self.add_mesh(("lathe", i), &lathe.mesh(i))?;
        }
        self.add_shapes()?;
        for surfaces in self.stage.models.iter_mut().chain([&mut self.stage.surfaces]) {
            self.stage.all_flat &= surfaces.corner_normals.is_empty();
            if surfaces.corner_normals.is_empty() {
                surfaces.corner_normals_of = Vec::new();
            }
        }
        self.build_tree(quality, threads)?;
        let Self { mut stage, objects, warnings, parts, .. } = self;
        stage.objects = objects.iter().map(|object| object.first..object.first + object.count).collect();
        let mut world = World { stage, objects, warnings };
        world.find_lights_on_surfaces(scene, &parts);
        world.warnings.extend(world.before_image_plane(scene.render.spp));
        Ok(world)
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
