//! A scene together with its world: what explanations need, as worlds are numbers and scenes are names.

use super::World;
use crate::geometry::bvh::Quality;
use crate::scene::{Problems, Scene};
use crate::settings::Settings;
use std::sync::Arc;

/// What the space between the objects is called.
const OUTSIDE: &str = "outside";

/// A scene and the world that was made of it, which cannot be out of step.
///
/// ```
/// use snell::film::Rgb;
/// use snell::scene::{Camera, Integrator, Render, Scene};
/// use snell::world::CompiledScene;
///
/// let camera = Camera::new([0.0, 0.0, 10.0], [0.0; 3], [0.0, 1.0, 0.0], [-1.0, 1.0, -1.0, 1.0], -5.0);
/// let empty = Scene::new(Render::new(Integrator::Whitted, [32, 32]), camera);
/// let compiled = CompiledScene::new("empty", empty.clone())?;
/// assert_eq!(compiled.world().primitive_count(), 0);
///
/// // What moves while someone looks on: the geometry and its tree are kept.
/// let brighter = compiled.edited(Scene { ambient: Rgb::gray(0.5), ..empty })?;
/// assert_eq!(brighter.world().ambient.r, 0.5);
/// # Ok::<(), snell::scene::Problems>(())
/// ```
#[derive(Clone, Debug)]
pub struct CompiledScene {
    name: String,
    scene: Arc<Scene>,
    world: Arc<World>,
}

impl CompiledScene {
    /// Compiles a scene, with all processors. The name is what explanations call it.
    ///
    /// # Errors
    /// As [`World::new`].
    pub fn new(name: impl Into<String>, scene: impl Into<Arc<Scene>>) -> Result<Self, Problems> {
        Self::build(name, scene, Quality::default(), 0)
    }

    /// Compiles a scene with a tree of this quality, on so many threads, 0 for [those by default](crate::threads::ByDefault).
    ///
    /// # Errors
    /// As [`World::new`].
    pub fn build(
        name: impl Into<String>,
        scene: impl Into<Arc<Scene>>,
        quality: Quality,
        threads: usize,
    ) -> Result<Self, Problems> {
        let scene = scene.into();
        let world = World::build(&scene, quality, threads)?;
        Ok(Self { name: name.into(), scene, world: world.into() })
    }

    /// Compiles a scene that differs from this one, and shares geometry and tree where [it can](World::edited).
    ///
    /// # Errors
    /// As [`World::new`].
    pub fn edited(&self, scene: impl Into<Arc<Scene>>) -> Result<Self, Problems> {
        let scene = scene.into();
        let world = self.world.edited(&self.scene, &scene)?;
        Ok(Self { name: self.name.clone(), scene, world: world.into() })
    }

    /// What explanations call it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What was compiled.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// What it was compiled to.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The same, for whoever keeps it longer, as a [`Renderer`](crate::render::Renderer) does.
    pub fn shared_world(&self) -> Arc<World> {
        Arc::clone(&self.world)
    }

    /// The settings that the scene asks for.
    pub fn settings(&self) -> Settings {
        Settings::from(self.scene())
    }

    /// The name of the object that a primitive belongs to.
    pub fn object(&self, primitive: u32) -> &str {
        self.world.object_of(primitive).map_or("?", |object| object.name.as_str())
    }

    /// The name of a light, by its number in the scene.
    pub fn light(&self, number: usize) -> String {
        let name = self.scene.lights.get(number).and_then(|light| light.name.clone());
        name.unwrap_or_else(|| format!("light {}", number + 1))
    }

    /// The name of a material, by its number in the scene.
    pub fn material(&self, number: u32) -> &str {
        self.scene.materials.get_index(number as usize).map_or("?", |(name, _)| name.as_str())
    }

    /// The name of what a solid holds, by its number: the object, or the material that interfaces speak of.
    pub fn medium(&self, solid: Option<u32>) -> &str {
        let solid = solid.and_then(|solid| self.world.solids.get(solid as usize));
        solid.map_or(OUTSIDE, |solid| match solid.between_faces_of {
            Some(material) => self.material(material),
            None => self.object(solid.primitive),
        })
    }
}
