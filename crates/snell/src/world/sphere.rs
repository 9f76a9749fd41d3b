//! From the spheres of a scene to those of the world.

use super::Object;
use super::builder::Builder;
use crate::geometry::shape::Surface;
use crate::geometry::{Affine, Sphere, Vec3};
use crate::scene::{self, LARGEST_NUMBER, Problem, Step, Warning, WarningCode, whole_map};
use crate::stage::{NO_SOLID, Solid};
use std::sync::Arc;

impl Builder<'_> {
    /// Adds a sphere in all of its places.
    pub(super) fn add_sphere(&mut self, index: usize, sphere: &scene::Sphere) -> Result<(), Problem> {
        let own = whole_map(&sphere.transform);
        let places: Vec<Affine> = if sphere.instances.is_empty() {
            vec![own]
        } else {
            sphere.instances.iter().map(|steps| own.then(whole_map(steps))).collect()
        };
        for map in places {
            let place = vec![Step::from("sphere"), Step::from(index), Step::from("transform")];
            let problem = |message: String, help: &str| Problem {
                place: place.clone(),
                message,
                help: Some(help.to_owned()),
                remedy: None,
            };
            let Some(factor) = similarity(&map) else {
                let help = "scale by the same factor along x, y and z; for an ellipsoid use a `lathe` or a mesh";
                return Err(problem("a sphere must stay a sphere, and this stretches it".to_owned(), help));
            };
            let (center, radius) = (map.apply(sphere.center.into()), sphere.radius * factor);
            let farthest = center.length() + radius;
            if farthest.is_nan() || farthest > LARGEST_NUMBER {
                return Err(problem("the sphere ends up beyond 1e15".to_owned(), ""));
            }
            if radius == 0.0 && sphere.radius > 0.0 {
                let message = "this scales the sphere to radius 0: it is invisible".to_owned();
                self.shape_warnings.push(Warning { code: WarningCode::InvisibleSphere, place, message });
            }
            self.place_sphere(index, sphere, Sphere { center, radius });
            if map != Affine::IDENTITY || !self.stage.sphere_turns.is_empty() {
                // Without its length, which texture coordinates do not depend on, the inverse of a turn is there always.
                self.stage.sphere_turns.resize(self.stage.spheres.len() - 1, Affine::IDENTITY);
                self.stage.sphere_turns.push(map.inverse().unwrap_or(Affine::IDENTITY));
            }
        }
        Ok(())
    }

    fn place_sphere(&mut self, index: usize, sphere: &scene::Sphere, placed: Sphere) {
        let name = sphere.name.clone().unwrap_or_else(|| format!("sphere {}", index + 1));
        let id = self.stage.spheres.len();
        Arc::make_mut(&mut self.objects).push(Object { name, first: id as u32, count: 1 });
        self.stage.spheres.push(placed);
        let material = self.material_ids.get(sphere.material.as_str()).copied().unwrap_or(0);
        self.surfaces.material_of.push(material);
        if self.refracts(material) {
            self.surfaces.interior_of.resize(id, NO_SOLID);
            self.surfaces.interior_of.push(self.stage.solids.len() as u32);
            let (medium, bounds) = (self.stage.materials[material as usize].medium(), placed.bounds());
            self.stage.solids.push(Solid {
                medium,
                inward: false,
                touches: false,
                between_faces_of: None,
                primitive: id as u32,
                bounds,
            });
        }
    }
}

/// By how much a map makes everything larger, if it does so alike in all directions.
fn similarity(map: &Affine) -> Option<f64> {
    let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|v| map.turn(Vec3::<f64>::from(v)));
    let factor = x.length();
    // Some rotations, one after the other, each with a few roundings.
    let small = 1e-12 * factor;
    let alike = (y.length() - factor).abs() <= small && (z.length() - factor).abs() <= small;
    let upright = [x.dot(y), y.dot(z), z.dot(x)].iter().all(|dot| dot.abs() <= small * factor);
    (alike && upright).then_some(factor)
}
