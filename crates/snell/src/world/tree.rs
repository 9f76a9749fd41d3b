//! The tree over everything, with the trees of the models and the places where they stand.

use super::Object;
use super::builder::Builder;
use super::mesh::{Parts, Triangles, Which};
use super::solid::{find_touching, placed};
use crate::geometry::bvh::{self, Instance, MARGIN, Quality, Shapes};
use crate::geometry::{Affine, Bounds};
use crate::scene::{LARGEST_NUMBER, Problem, Step};
use crate::stage::{CameraFrame, NO_PRIMITIVE, Placement};
use std::sync::Arc;

/// The boxes of the tree are larger by that many tolerances, where one would do, so that they may stay when rays start farther away: by
/// 2⁻⁴⁴ of the scene, beside which rounding to `f32` adds 2⁻²⁴ of a coordinate.
const ROOM: f64 = 16.0;

/// What the tree was built for.
#[derive(Clone, Debug)]
pub(super) struct Ground {
    /// All shapes, without the places where camera rays start.
    pub extent: Bounds,
    /// The largest tolerance for which the boxes of the tree are large enough.
    pub margin: f64,
    /// The boxes of what is no solid; none where there are no solids.
    pub opaque: Arc<Vec<Bounds>>,
}

/// The box around everything, and what a hit may be off the plane of its face, but for instances. Rays start at the camera or on
/// surfaces: no ray origin is farther from a primitive than the diagonal of the box.
pub(super) fn measure(extent: Bounds, camera: &CameraFrame) -> (Bounds, f64) {
    let everything = extent.union(camera.starts());
    (everything, MARGIN * (everything.diagonal() + everything.farthest()))
}

/// What may meet a model, in its own space.
struct Met {
    /// The model, and where rays start that may meet it.
    seen: Bounds,
    /// The most that a way into this space stretches.
    norm: f64,
}

fn problem((kind, index): Which, message: String) -> Problem {
    let place = vec![Step::from(kind), Step::from(index), Step::from("instances")];
    Problem { place, message, help: None, remedy: None }
}

impl Builder<'_> {
    pub(super) fn build_tree(&mut self, quality: Quality, threads: usize) -> Result<(), Problem> {
        let parts = std::mem::take(&mut self.parts);
        let shapes = parts.shapes(&self.stage.spheres);
        if shapes.count() + parts.placed.len() >= 1 << 31 {
            let message = "more than 2 billion shapes and triangles".to_owned();
            return Err(Problem { place: vec![Step::from("mesh")], message, help: None, remedy: None });
        }
        let boxes = boxes_of_instances(&parts)?;
        let extent = boxes.iter().fold(shapes.extent(), |all, bounds| all.union(*bounds));
        let (everything, tolerance) = measure(extent, &self.stage.camera);
        (self.stage.reach, self.stage.coincidence_tolerance) = (everything.diagonal(), tolerance);
        let (instances, met) = self.place_instances(&parts, boxes, everything)?;
        self.stage.exit_tolerance = 0.5 * self.stage.coincidence_tolerance;
        let models = parts.models.iter().zip(met).map(|(model, Met { seen, norm })| {
            let shapes = Shapes { triangles: model.list(), ..Shapes::default() };
            let margin = (MARGIN * (seen.diagonal() + seen.farthest())).max(norm * self.stage.coincidence_tolerance);
            bvh::build(&shapes, vec![], margin, quality, threads)
        });
        let models = models.collect();
        let shapes = parts.shapes(&self.stage.spheres);
        let opaque = Arc::new(self.boxes_without_solids(&shapes, &instances));
        let shapes = Shapes { instances: &instances, ..shapes };
        self.ground = Ground { extent, margin: ROOM * self.stage.coincidence_tolerance, opaque };
        self.stage.tree = Arc::new(bvh::build(&shapes, models, self.ground.margin, quality, threads));
        find_touching(&mut self.stage, &self.ground.opaque);
        self.find_primitives();
        Ok(())
    }

    /// Puts the models in their places, each a placement with solids and an object of its own; with what may meet each model.
    fn place_instances(
        &mut self,
        parts: &Parts,
        boxes: Vec<Bounds>,
        everything: Bounds,
    ) -> Result<(Vec<Instance>, Vec<Met>), Problem> {
        let (reach, farthest) = (everything.diagonal(), everything.farthest());
        // Rays come from everywhere that any of the instances sees, and start a little behind.
        let alone = |model: &Triangles| Met { seen: Bounds::of(model.vertices.iter().copied()), norm: 0.0 };
        let mut met: Vec<Met> = parts.models.iter().map(alone).collect();
        let mut instances = Vec::with_capacity(parts.placed.len());
        let mut first = self.stage.surfaces.material_of.len();
        for ((which, name, model, map), bounds) in parts.placed.iter().zip(boxes) {
            let instance = Instance::new(*model, map, first as u32, bounds, reach, farthest);
            let flat = || problem(*which, format!("an instance of `{name}` is scaled by 0"));
            let instance = instance.ok_or_else(flat)?;
            self.stage.coincidence_tolerance = self.stage.coincidence_tolerance.max(instance.off);
            let Met { seen, norm } = &mut met[*model];
            *norm = instance.to_model.norm().max(*norm);
            *seen = seen.union(Bounds::of(everything.corners().map(|c| instance.to_model.apply(c))));
            let count = self.stage.models[*model].material_of.len();
            let object = Object { name: name.clone(), first: first as u32, count: count as u32 };
            Arc::make_mut(&mut self.objects).push(object);
            let placement = Placement {
                model: *model,
                first: first as u32,
                first_solid: self.stage.solids.len() as u32,
                to_world: *map,
                to_model: instance.to_model,
                bounds: instance.bounds,
            };
            self.stage.solids.extend(parts.solids[*model].iter().map(|solid| placed(solid, map)));
            if count > 0 {
                self.stage.placements.push(placement);
                instances.push(instance);
            }
            first += count;
            if first >= NO_PRIMITIVE as usize {
                return Err(problem(*which, "more than 4 billion triangles in all places together".to_owned()));
            }
        }
        Ok((instances, met))
    }
}

/// The boxes around the models in their places.
fn boxes_of_instances(parts: &Parts) -> Result<Vec<Bounds>, Problem> {
    let around = |(which, name, model, map): &(Which, String, usize, Affine)| {
        let Triangles { vertices, faces } = &parts.models[*model];
        // Vertices of no face may lie anywhere, and must not make the boxes of others larger.
        let vertices = if faces.is_empty() { &[] } else { vertices.as_slice() };
        let bounds = Bounds::of(vertices.iter().map(|&v| map.apply(v)));
        if bounds.farthest() <= LARGEST_NUMBER || faces.is_empty() {
            Ok(bounds)
        } else {
            Err(problem(*which, format!("an instance of `{name}` reaches beyond 1e15")))
        }
    };
    parts.placed.iter().map(around).collect()
}
