//! The tree over everything, with the trees of the models and the places where they stand.

use super::Object;
use super::builder::Builder;
use super::mesh::{Triangles, Which};
use super::solid::{find_touching, placed};
use crate::geometry::Bounds;
use crate::geometry::bvh::{self, Instance, MARGIN, Quality, Shapes};
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

impl Builder<'_> {
    pub(super) fn build_tree(&mut self, quality: Quality, threads: usize) -> Result<(), Problem> {
        let problem = |(kind, index): Which, message: String| {
            let place = vec![Step::from(kind), Step::from(index), Step::from("instances")];
            Problem { place, message, help: None, remedy: None }
        };
        let shapes = Shapes {
            spheres: &self.stage.spheres,
            triangles: self.parts.triangles.list(),
            rectangles: &self.parts.rectangles,
            cuboids: &self.parts.cuboids,
            discs: &self.parts.discs,
            instances: &[],
        };
        if shapes.count() + self.parts.placed.len() >= 1 << 31 {
            let message = "more than 2 billion shapes and triangles".to_owned();
            return Err(Problem { place: vec![Step::from("mesh")], message, help: None, remedy: None });
        }
        let mut extent = (0..shapes.count()).map(|i| shapes.bounds(i)).fold(Bounds::EMPTY, Bounds::union);
        let mut boxes = Vec::with_capacity(self.parts.placed.len());
        for (which, name, model, map) in &self.parts.placed {
            let Triangles { vertices, faces } = &self.parts.models[*model];
            // Vertices of no face may lie anywhere, and must not make the boxes of others larger.
            let vertices = if faces.is_empty() { &[] } else { vertices.as_slice() };
            let bounds = Bounds::of(vertices.iter().map(|&v| map.apply(v)));
            if !(bounds.farthest() <= LARGEST_NUMBER || faces.is_empty()) {
                return Err(problem(*which, format!("an instance of `{name}` reaches beyond 1e15")));
            }
            extent = extent.union(bounds);
            boxes.push(bounds);
        }
        let (everything, tolerance) = measure(extent, &self.stage.camera);
        let (reach, farthest) = (everything.diagonal(), everything.farthest());
        (self.stage.reach, self.stage.coincidence_tolerance) = (reach, tolerance);
        // In the space of a model rays come from everywhere that any of its instances sees, and start a little behind.
        let mut seen: Vec<Bounds> = self.parts.models.iter().map(|m| Bounds::of(m.vertices.iter().copied())).collect();
        let mut norms = vec![0.0; self.parts.models.len()];
        let mut instances = Vec::with_capacity(self.parts.placed.len());
        let mut first = self.stage.surfaces.material_of.len();
        for ((which, name, model, map), bounds) in self.parts.placed.iter().zip(boxes) {
            let instance = Instance::new(*model, map, first as u32, bounds, reach, farthest);
            let flat = || problem(*which, format!("an instance of `{name}` is scaled by 0"));
            let instance = instance.ok_or_else(flat)?;
            self.stage.coincidence_tolerance = self.stage.coincidence_tolerance.max(instance.off);
            norms[*model] = instance.to_model.norm().max(norms[*model]);
            seen[*model] = seen[*model].union(Bounds::of(everything.corners().map(|c| instance.to_model.apply(c))));
            let count = self.stage.models[*model].material_of.len();
            Arc::make_mut(&mut self.objects).push(Object {
                name: name.clone(),
                first: first as u32,
                count: count as u32,
            });
            let placement = Placement {
                model: *model,
                first: first as u32,
                first_solid: self.stage.solids.len() as u32,
                to_world: *map,
                to_model: instance.to_model,
                bounds: instance.bounds,
            };
            self.stage.solids.extend(self.parts.solids[*model].iter().map(|solid| placed(solid, map)));
            if count > 0 {
                self.stage.placements.push(placement);
                instances.push(instance);
            }
            first += count;
            if first >= NO_PRIMITIVE as usize {
                return Err(problem(*which, "more than 4 billion triangles in all places together".to_owned()));
            }
        }
        self.stage.exit_tolerance = 0.5 * self.stage.coincidence_tolerance;
        let models = self.parts.models.iter().zip(seen.iter().zip(norms)).map(|(model, (seen, norm))| {
            let shapes = Shapes { triangles: model.list(), ..Shapes::default() };
            let margin = (MARGIN * (seen.diagonal() + seen.farthest())).max(norm * self.stage.coincidence_tolerance);
            bvh::build(&shapes, vec![], margin, quality, threads)
        });
        let models = models.collect();
        let opaque = Arc::new(self.boxes_without_solids(&shapes, &instances));
        let shapes = Shapes { instances: &instances, ..shapes };
        self.ground = Ground { extent, margin: ROOM * self.stage.coincidence_tolerance, opaque };
        self.stage.tree = Arc::new(bvh::build(&shapes, models, self.ground.margin, quality, threads));
        find_touching(&mut self.stage, &self.ground.opaque);
        self.find_primitives();
        Ok(())
    }
}
