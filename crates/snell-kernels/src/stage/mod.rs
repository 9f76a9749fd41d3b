//! What stands there, as numbers: all that is read while rays are traced.

mod camera;
mod light;
mod material;
mod solid;
mod surface;
mod texture;

pub use camera::{CameraFrame, JITTER};
pub use light::{LightSource, Spot};
pub use material::{CompiledMaterial, NONE};
pub use solid::{Medium, NO_SOLID, Solid};
pub use surface::{FLAT, NO_PRIMITIVE, Placement, Side, Surfaces};
pub use texture::{Background, Colors, Pattern};

use crate::color::Rgb;
use crate::geometry::bvh::Bvh;
use crate::geometry::{Affine, Sphere};
use crate::optics::spectrum::Band;
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::ops::Range;

/// What stands there, compiled: geometry, tree, materials as plain numbers, lights, camera.
///
/// Primitives are numbered kind by kind, those of a kind in the order of the scene: spheres, triangles, planes, boxes, discs,
/// then what stands in many places. At equal distance the lower number is hit.
///
/// What is large is shared by stages that differ in something else.
#[derive(Clone, Debug)]
pub struct Stage {
    /// The camera, placed.
    pub camera: CameraFrame,
    /// The primitives of each object of the scene, in order.
    pub objects: Vec<Range<u32>>,
    /// Is it compiled for models of light that follow rays through solids, from medium to medium?
    pub has_media: bool,
    /// Light from everywhere alike.
    pub ambient: Rgb,
    /// Index of refraction between the objects.
    pub eta_outside: f64,
    /// The lights, in the order of the scene.
    pub lights: Vec<LightSource>,
    /// The materials, in the order of the scene; at least one.
    pub materials: Vec<CompiledMaterial>,
    /// The spheres, which are the first primitives.
    pub spheres: Vec<Sphere>,
    /// How each sphere is turned back for its texture; empty where none is turned.
    pub sphere_turns: Vec<Affine>,
    /// Of the primitives that stand for themselves.
    pub surfaces: Arc<Surfaces>,
    /// Of the meshes that stand in several places, and these places in the order of their ids.
    pub models: Arc<Vec<Surfaces>>,
    /// Where models stand, in the order of their primitives.
    pub placements: Vec<Placement>,
    /// What light goes through, where there is real optics.
    pub solids: Vec<Solid>,
    /// Into what light splits, if it does.
    pub bands: Vec<Band>,
    /// The indices of the bands, of each dispersive material.
    pub spectra: Vec<Vec<f64>>,
    /// Patterns on surfaces.
    pub patterns: Vec<Pattern>,
    /// Has a pattern places where the surface is not there?
    pub has_alpha: bool,
    /// Light from where nothing is.
    pub background: Background,
    /// No ray is longer before it hits something: the diagonal of the box around everything, the starts of camera rays included.
    pub reach: f64,
    /// How far a computed hit may be off the plane of its face, in scene units (`docs/tolerances.md`).
    pub coincidence_tolerance: f64,
    /// How far behind its start a ray may still meet something: half of the tolerance, so that boxes, which are larger than what is in
    /// them by the tolerance at least, do not hide it.
    pub exit_tolerance: f64,
    /// Is no triangle smooth?
    pub all_flat: bool,
    /// The tree, with the triangles in its leaves and the trees of the models.
    pub tree: Arc<Bvh>,
}

impl Stage {
    /// Nothing but a camera, in the dark. Its reach and tolerances are 0: whoever adds shapes sets them to what follows from the size of
    /// everything, without which models with media find nothing.
    pub fn new(camera: CameraFrame) -> Self {
        Self {
            camera,
            objects: Vec::new(),
            has_media: false,
            ambient: Rgb::gray(0.0),
            eta_outside: 1.0,
            lights: Vec::new(),
            materials: Vec::new(),
            spheres: Vec::new(),
            sphere_turns: Vec::new(),
            surfaces: Arc::default(),
            models: Arc::default(),
            placements: Vec::new(),
            solids: Vec::new(),
            bands: Vec::new(),
            spectra: Vec::new(),
            patterns: Vec::new(),
            has_alpha: false,
            background: Background::Color(Rgb::gray(0.0)),
            reach: 0.0,
            coincidence_tolerance: 0.0,
            exit_tolerance: 0.0,
            all_flat: true,
            tree: Arc::default(),
        }
    }

    /// Number of primitives.
    pub fn primitive_count(&self) -> usize {
        self.objects.last().map_or(0, |primitives| primitives.end as usize)
    }

    /// The number of the object that a primitive belongs to.
    pub fn object_number(&self, primitive: u32) -> Option<usize> {
        let after = self.objects.partition_point(|primitives| primitives.start <= primitive);
        let number = after.checked_sub(1)?;
        self.objects[number].contains(&primitive).then_some(number)
    }
}
