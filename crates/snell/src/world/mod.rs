//! The compiled scene: what the kernels read ([`Stage`]), and the names and warnings that go with it. Immutable.

mod builder;
mod compiled;
mod edit;
mod lamp;
mod light;
mod material;
mod mesh;
mod shape;
mod skipped;
mod solid;
mod sphere;
mod texture;
mod tree;

pub use compiled::CompiledScene;
pub use snell_kernels::stage::{CameraFrame, NO_PRIMITIVE, Stage};

use crate::geometry::Bounds;
use crate::geometry::bvh::{Quality, TreeStatistics};
use crate::scene::{Integrator, Problems, Scene, Warning};
use crate::stage::Surfaces;
use builder::Builder;
use std::ops::Deref;
use std::sync::Arc;
use tree::Ground;

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

/// A scene that is ready to be traced. What stands there is its [`Stage`], to which it dereferences.
#[derive(Clone, Debug)]
pub struct World {
    /// What the kernels read.
    pub stage: Stage,
    /// Objects in the order of their primitives.
    pub objects: Arc<Vec<Object>>,
    /// What is probably not meant.
    pub warnings: Vec<Warning>,
    /// Those of them that the shapes give rise to.
    shape_warnings: Vec<Warning>,
    ground: Ground,
}

impl Deref for World {
    type Target = Stage;

    fn deref(&self) -> &Stage {
        &self.stage
    }
}

impl World {
    /// Compiles a scene, with all processors.
    ///
    /// # Errors
    /// Everything that is wrong with the scene. A mesh that names a file must have been read before.
    pub fn new(scene: &Scene) -> Result<Self, Problems> {
        Self::build(scene, Quality::default(), 0)
    }

    /// Compiles a scene with a tree of this quality, on so many threads, 0 for [those by default](crate::threads::ByDefault). Neither
    /// changes the picture.
    ///
    /// # Errors
    /// As [`World::new`].
    pub fn build(scene: &Scene, quality: Quality, threads: usize) -> Result<Self, Problems> {
        Builder::new(scene)?.build(quality, threads)
    }

    /// Can it be rendered with this model of light? Worlds of models with media hold solids and what is in them, others do not.
    pub fn is_for(&self, integrator: Integrator) -> bool {
        self.has_media == integrator.has_media()
    }

    /// The same world without a tree: every ray is tested against every primitive. Slow, and the oracle of the tests.
    #[must_use]
    pub fn brute_force(mut self) -> Self {
        self.stage.tree = Arc::new(self.stage.tree.as_ref().clone().flat());
        self
    }

    /// The names of its objects, each once where several in a row have it.
    pub fn object_names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = self.objects.iter().map(|object| object.name.as_str()).collect();
        names.dedup();
        names
    }

    /// The object that a primitive belongs to.
    pub fn object_of(&self, primitive: u32) -> Option<&Object> {
        self.object_number(primitive).map(|number| &self.objects[number])
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
        let surfaces: usize = self.models.iter().chain([self.surfaces.as_ref()]).map(Surfaces::memory).sum();
        size_of_val(self.spheres.as_slice()) + surfaces + tree.node_bytes + tree.primitive_bytes
    }
}
