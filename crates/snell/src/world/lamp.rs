//! Lights that stand on a surface, as far as hits can tell: whether a point is in the shadow of the lamp is left to chance.

use super::World;
use crate::geometry::Vec3;
use crate::geometry::shape::AnyShape;
use crate::scene::{Scene, Shadows, Step, Warning, WarningCode};

impl World {
    /// Warns of each light on a surface, to within what a hit may be off.
    pub(super) fn lights_on_surfaces(&self, scene: &Scene) -> Vec<Warning> {
        if scene.render.shadows() == Shadows::Off {
            return Vec::new();
        }
        let lamps = self.lights.iter().enumerate().filter(|(_, light)| !light.at_infinity);
        let warning = |(number, distance, primitive): (usize, f64, u32)| {
            let name = scene.lights.get(number).and_then(|light| light.name.clone());
            let name = name.unwrap_or_else(|| format!("light {}", number + 1));
            let message = format!(
                "`{name}` stands on the surface of `{}`: {distance:e} away, where hits are known to {:.0e} only, so that \
                 the surface takes its light from some points by chance, which looks like speckles; move it away, by an amount \
                 that can be seen, to the side on which it is to shine",
                self.object_of(primitive)?.name,
                self.coincidence_tolerance
            );
            let place = vec![Step::from("light"), Step::from(number), Step::from("position")];
            Some(Warning { code: WarningCode::LightOnSurface, place, message })
        };
        let found = lamps.filter_map(|(number, light)| {
            let (distance, primitive) = self.surface_at(light.at)?;
            Some((number, distance, primitive))
        });
        found.filter_map(warning).collect()
    }

    /// The nearest surface within [`coincidence_tolerance`](crate::world::Stage::coincidence_tolerance), and how far it is.
    fn surface_at(&self, point: Vec3) -> Option<(f64, u32)> {
        let mut near = Vec::new();
        self.tree.near(point, &mut near);
        let distance = |primitive: u32| match self.shape(primitive as usize) {
            // It is not there.
            AnyShape::Sphere(sphere) if sphere.radius == 0.0 => f64::INFINITY,
            shape => shape.distance(point),
        };
        let all = near.into_iter().map(|primitive| (distance(primitive), primitive));
        let touching = all.filter(|(distance, _)| *distance <= self.coincidence_tolerance);
        touching.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
    }
}
