//! Which solids a scene has, and which of them may touch something.

use super::builder::Builder;
use crate::geometry::bvh::{Instance, Shapes};
use crate::geometry::solid::{Component, EdgePlace, Found, Orientation, Report, Verdict, structure};
use crate::geometry::{Affine, Bounds, TriangleMesh, Vec3};
use crate::stage::{Medium, NO_PRIMITIVE, NO_SOLID, Solid, Stage};

/// More solids than this, among as many objects, are not compared with each other: all count as touching.
const COMPARED: usize = 2000;

/// The solids of a mesh: one for each component that is not the wall of a cavity, which belongs to the solid around it.
pub(super) struct MeshSolids {
    pub solids: Vec<Solid>,
    /// For each face its solid.
    pub interior_of: Vec<u32>,
}

impl MeshSolids {
    /// Fails with what keeps the mesh from being a solid.
    pub fn of(mesh: &TriangleMesh, medium: Medium) -> Result<Self, String> {
        let mut report = structure(mesh);
        let inside_out = |report: &Report| report.components.iter().any(|c| c.inside_out);
        let mut turned = false;
        if inside_out(&report) {
            // Turned over, walls of cavities are told from solids again.
            let faces = mesh.faces.iter().map(|&[a, b, c]| [a, c, b]).collect();
            let other = structure(&TriangleMesh { faces, ..mesh.clone() });
            turned = !inside_out(&other);
            report = if turned { other } else { report };
        }
        if !report.is_solid() {
            return Err(why_not(&report));
        }
        let mut solids = Vec::new();
        let mut number_of = vec![NO_SOLID; report.components.len()];
        for (number, component) in number_of.iter_mut().zip(&report.components).filter(|(_, c)| !c.cavity) {
            *number = solids.len() as u32;
            let inward = (component.orientation == Orientation::Inward) != turned;
            solids.push(Solid {
                medium,
                inward,
                touches: false,
                between_faces_of: None,
                primitive: NO_PRIMITIVE,
                bounds: component.bounds,
            });
        }
        for i in 0..report.components.len() {
            if report.components[i].cavity {
                number_of[i] = around(&report.components[i], &report.components, &number_of);
            }
        }
        // A face without area belongs to no component, and is never hit.
        let interior_of = report.component_of.iter().map(|&c| number_of.get(c as usize).copied().unwrap_or(NO_SOLID));
        Ok(Self { interior_of: interior_of.collect(), solids })
    }
}

/// The solid of the smallest component whose box holds that of a cavity.
fn around(cavity: &Component, components: &[Component], number_of: &[u32]) -> u32 {
    let holds = |outer: &Bounds, inner: &Bounds| outer.union(*inner) == *outer;
    let all = components.iter().zip(number_of);
    let candidates = all.filter(|(c, _)| !c.cavity && holds(&c.bounds, &cavity.bounds));
    let smallest = candidates.min_by(|a, b| a.0.volume.abs().total_cmp(&b.0.volume.abs()));
    smallest.map_or(NO_SOLID, |(_, &number)| number)
}

fn why_not(report: &Report) -> String {
    let at = |p: Vec3| format!("({}, {}, {})", p.x, p.y, p.z);
    let edges = |found: &Found<EdgePlace>| {
        found.first.first().map_or(String::new(), |edge| {
            let [a, b] = edge.ends.map(at);
            format!(", the first from {a} to {b}")
        })
    };
    // In the order and the words of `Report::verdict`, so that a check of the model says the same.
    let open = report.components.iter().map(|c| c.open_edges).sum::<usize>();
    match report.verdict() {
        Verdict::Empty => "it has no faces".to_owned(),
        Verdict::Open if open == 0 => {
            format!("{} faces have vertices that are not there or not finite", report.broken.count)
        }
        Verdict::Open if report.boundary.is_empty() => {
            format!(
                "it is open along {open} edges: an odd number of faces, more than two, meet there{}",
                edges(&report.non_manifold)
            )
        }
        Verdict::Open => format!("it is open along {open} edges{}", edges(&report.boundary)),
        Verdict::Misoriented if report.misoriented.is_empty() => {
            "its faces cannot all look to one side, as on a Möbius strip".to_owned()
        }
        Verdict::Misoriented => {
            let count = report.misoriented.count;
            format!("at {count} of its edges neighbouring faces look opposite ways{}", edges(&report.misoriented))
        }
        Verdict::Flat | Verdict::InsideOut | Verdict::Solid => "it encloses no volume".to_owned(),
    }
}

/// The same solid where an instance stands.
pub(super) fn placed(solid: &Solid, map: &Affine) -> Solid {
    let bounds = Bounds::of(solid.bounds.corners().map(|corner| map.apply(corner)));
    Solid { inward: solid.inward != map.mirrors(), bounds, ..solid.clone() }
}

/// Finds which solids may touch something: those whose box meets that of another solid, or one of these, within the tolerance.
pub(super) fn find_touching(stage: &mut Stage, opaque: &[Bounds]) {
    let solids = stage.solids.len();
    let boxes: Vec<Bounds> = stage.solids.iter().map(|solid| solid.bounds).chain(opaque.iter().copied()).collect();
    let room = Vec3::new(stage.coincidence_tolerance, stage.coincidence_tolerance, stage.coincidence_tolerance);
    let too_many = solids.saturating_mul(boxes.len()) > COMPARED * COMPARED;
    for (number, solid) in stage.solids.iter_mut().enumerate() {
        let grown = Bounds { min: boxes[number].min - room, max: boxes[number].max + room };
        solid.touches = too_many
            || solid.between_faces_of.is_some()
            || boxes.iter().enumerate().any(|(other, bounds)| other != number && grown.meets(bounds));
    }
}

impl Builder<'_> {
    /// The boxes of what is no solid, object by object; none where there are no solids.
    pub(super) fn boxes_without_solids(&self, shapes: &Shapes<'_>, instances: &[Instance]) -> Vec<Bounds> {
        let mut boxes = Vec::new();
        for object in self.objects.iter().filter(|_| !self.stage.solids.is_empty()) {
            let mut opaque = (object.first as usize..(object.first + object.count) as usize)
                .filter(|&id| self.stage.interior_of(id) == NO_SOLID);
            if object.first as usize >= shapes.count() {
                let instance = instances.iter().find(|i| i.first == object.first);
                boxes.extend(instance.filter(|_| opaque.next().is_some()).map(|i| i.bounds));
            } else {
                boxes.extend(opaque.map(|id| shapes.bounds(id)).reduce(Bounds::union));
            }
        }
        boxes
    }

    /// Gives each solid one of its primitives, the first.
    pub(super) fn find_primitives(&mut self) {
        if self.stage.solids.is_empty() {
            return;
        }
        for primitive in 0..self.primitive_count() as u32 {
            for solid in [self.stage.interior_of(primitive as usize), self.stage.exterior_of(primitive as usize)] {
                if let Some(solid) = self.stage.solids.get_mut(solid as usize)
                    && solid.primitive == NO_PRIMITIVE
                {
                    solid.primitive = primitive;
                }
            }
        }
    }
}
