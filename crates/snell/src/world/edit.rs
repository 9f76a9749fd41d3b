//! Worlds of scenes that differ in little: what sliders change has no need of another tree.

use super::World;
use super::builder::Builder;
use super::solid::find_touching;
use super::tree::measure;
use crate::geometry::bvh::Quality;
use crate::scene::{Mesh, Problems, Scene};
use crate::stage::{CompiledMaterial, Medium, NO_PRIMITIVE, NONE, Solid, Stage};
use std::sync::Arc;

impl World {
    /// The world of `after`, where this is that of `before`: equal to [`World::new`] of it, to the bit. If only camera, lights, sky,
    /// materials or settings differ, it shares this one's geometry and tree. It is built anew where shapes or the model of light differ;
    /// where a material begins or ceases to refract, to be a thin pane, or to have a texture, or two of one glass become two
    /// glasses; and where the camera leaves the scene far behind, or moves at all if meshes have instances.
    ///
    /// # Errors
    /// As [`World::new`].
    pub fn edited(&self, before: &Scene, after: &Scene) -> Result<Self, Problems> {
        let mut builder = Builder::new(after)?;
        if !(same_shapes(before, after) && self.is_ground_for(&builder.stage)) {
            return builder.build(Quality::default(), 0);
        }
        builder.take_ground(self);
        Ok(builder.finish())
    }

    /// May the geometry, the solids and the tree stay, with this camera and these materials?
    fn is_ground_for(&self, stage: &Stage) -> bool {
        let same_kind = |(old, new): (&CompiledMaterial, &CompiledMaterial)| {
            old.is_transparent() == new.is_transparent()
                && old.is_pane() == new.is_pane()
                && (old.pattern == NONE) == (new.pattern == NONE)
        };
        let glasses = |stage: &Stage| -> Vec<Medium> {
            let solid = stage.materials.iter().filter(|material| material.is_transparent() && !material.is_pane());
            solid.map(CompiledMaterial::medium).collect()
        };
        // Which of them are the same glass: the first that equals each.
        let first_like = |media: &[Medium]| -> Vec<Option<usize>> {
            media.iter().map(|medium| media.iter().position(|other| other == medium)).collect()
        };
        let same_starts = stage.camera.starts() == self.camera.starts();
        self.materials.len() == stage.materials.len()
            && self.materials.iter().zip(&stage.materials).all(same_kind)
            && first_like(&glasses(self)) == first_like(&glasses(stage))
            && (same_starts
                || self.placements.is_empty() && measure(self.ground.extent, &stage.camera).1 <= self.ground.margin)
    }
}

impl Builder<'_> {
    /// Takes what stands there from a world that [may lend it](World::is_ground_for).
    fn take_ground(&mut self, world: &World) {
        let (old, new) = (&world.stage, &mut self.stage);
        new.objects.clone_from(&old.objects);
        new.spheres.clone_from(&old.spheres);
        new.sphere_turns.clone_from(&old.sphere_turns);
        new.placements.clone_from(&old.placements);
        new.solids.clone_from(&old.solids);
        (new.surfaces, new.models) = (Arc::clone(&old.surfaces), Arc::clone(&old.models));
        (new.tree, new.all_flat) = (Arc::clone(&old.tree), old.all_flat);
        (new.reach, new.coincidence_tolerance, new.exit_tolerance) =
            (old.reach, old.coincidence_tolerance, old.exit_tolerance);
        if new.camera.starts() != old.camera.starts() {
            let (everything, tolerance) = measure(world.ground.extent, &new.camera);
            (new.reach, new.coincidence_tolerance) = (everything.diagonal(), tolerance);
            new.exit_tolerance = 0.5 * new.coincidence_tolerance;
            find_touching(new, &world.ground.opaque);
        }
        for at in 0..new.solids.len() {
            let Solid { between_faces_of, primitive, .. } = new.solids[at];
            let material =
                between_faces_of.or_else(|| (primitive != NO_PRIMITIVE).then(|| new.material_of(primitive as usize)));
            if let Some(material) = material {
                new.solids[at].medium = new.materials[material as usize].medium();
            }
        }
        self.objects = Arc::clone(&world.objects);
        self.shape_warnings.clone_from(&world.shape_warnings);
        self.ground.clone_from(&world.ground);
    }
}

/// Do the shapes stand in the same places, of materials of the same names? A list that is new in scenes must be named here, or this does
/// not compile.
fn same_shapes(before: &Scene, after: &Scene) -> bool {
    let Scene {
        snell: _,
        schema: _,
        ambient: _,
        background: _,
        sky: _,
        eta_outside: _,
        render,
        camera: _,
        lights: _,
        materials,
        textures: _,
        spheres,
        meshes,
        planes,
        boxes,
        discs,
        lathes,
    } = before;
    render.integrator == after.render.integrator
        && materials.keys().eq(after.materials.keys())
        && *spheres == after.spheres
        && meshes.len() == after.meshes.len()
        && meshes.iter().zip(&after.meshes).all(|(a, b)| same_mesh(a, b))
        && *planes == after.planes
        && *boxes == after.boxes
        && *discs == after.discs
        && *lathes == after.lathes
}

/// Large meshes are mostly the very same, and need not be compared.
fn same_mesh(a: &Mesh, b: &Mesh) -> bool {
    let shared = matches!((&a.geometry, &b.geometry), (Some(a), Some(b)) if Arc::ptr_eq(a, b));
    let without = |mesh: &Mesh| Mesh { geometry: None, ..mesh.clone() };
    if shared { without(a) == without(b) } else { a == b }
}
