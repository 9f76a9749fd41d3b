//! Lights that stand on a surface, as far as hits can tell: whether a point is in the shadow of the lamp is left to chance.

use super::World;
use super::mesh::{Parts, Triangles};
use crate::geometry::{Affine, Bounds, Vec3, triangle};
use crate::scene::{Scene, Shadows, Step, Warning, WarningCode};

/// A light at a place, and the nearest surface that was found so far: its distance and primitive.
struct Lamp {
    number: usize,
    at: Vec3,
    nearest: Option<(f64, u32)>,
}

impl World {
    /// Warns of each light on a surface, to within what a hit may be off ([`coincidence_tolerance`](Self::coincidence_tolerance)).
    ///
    /// Looks at the box of each primitive.
    pub(super) fn find_lights_on_surfaces(&mut self, scene: &Scene, parts: &Parts) {
        if scene.render.shadows() == Shadows::Off {
            return;
        }
        let lamps = self.lights.iter().enumerate().filter(|(_, light)| !light.at_infinity);
        let mut lamps: Vec<Lamp> = lamps.map(|(number, light)| Lamp { number, at: light.at, nearest: None }).collect();
        if lamps.is_empty() {
            return;
        }
        let (tolerance, mut first) = (self.coincidence_tolerance, self.spheres.len() as u32);
        for (id, sphere) in (0..).zip(&self.spheres).filter(|(_, sphere)| sphere.radius > 0.0) {
            for lamp in &mut lamps {
                lamp.offer(((lamp.at - sphere.center).length() - sphere.radius).abs(), id, tolerance);
            }
        }
        let mut look_at = |first: u32, triangles: &Triangles, map: Affine, bounds: Bounds| {
            // The box of mapped corners holds all that is in it but for roundings, which are far smaller than the tolerance.
            if lamps.iter().any(|lamp| is_near(lamp.at, &bounds, 2.0 * tolerance)) {
                for (id, face) in (first..).zip(&triangles.faces) {
                    let corners = face.map(|v| map.apply(triangles.vertices[v as usize]));
                    let bounds = Bounds::of(corners);
                    for lamp in lamps.iter_mut().filter(|lamp| is_near(lamp.at, &bounds, tolerance)) {
                        lamp.offer(triangle::distance(corners, lamp.at), id, tolerance);
                    }
                }
            }
            first + triangles.faces.len() as u32
        };
        let whole = |triangles: &Triangles| Bounds::of(triangles.vertices.iter().copied());
        first = look_at(first, &parts.triangles, Affine::IDENTITY, whole(&parts.triangles));
        let others = first..first + (parts.rectangles.len() + parts.cuboids.len() + parts.discs.len()) as u32;
        first = others.end;
        let boxes: Vec<Bounds> = parts.models.iter().map(whole).collect();
        for (_, _, model, map) in &parts.placed {
            let bounds = Bounds::of(boxes[*model].corners().map(|corner| map.apply(corner)));
            first = look_at(first, &parts.models[*model], *map, bounds);
        }
        for id in others {
            let shape = self.shape(id as usize);
            for lamp in lamps.iter_mut().filter(|lamp| is_near(lamp.at, &shape.bounds(), tolerance)) {
                lamp.offer(shape.distance(lamp.at), id, tolerance);
            }
        }
        for lamp in lamps {
            let object = |(distance, id)| Some((distance, self.object_of(id)?));
            let Some((distance, object)) = lamp.nearest.and_then(object) else { continue };
            let name = scene.lights.get(lamp.number).and_then(|light| light.name.clone());
            let name = name.unwrap_or_else(|| format!("light {}", lamp.number + 1));
            let message = format!(
                "`{name}` stands on the surface of `{}`: {distance:e} away, where hits are known to {tolerance:.0e} only, so that \
                 the surface takes its light from some points by chance, which looks like speckles; move it away, by an amount \
                 that can be seen, to the side on which it is to shine",
                object.name
            );
            let place = vec![Step::from("light"), Step::from(lamp.number), Step::from("position")];
            self.warnings.push(Warning { code: WarningCode::LightOnSurface, place, message });
        }
    }
}

impl Lamp {
    /// Takes note of a surface, if none nearer is known.
    fn offer(&mut self, distance: f64, primitive: u32, tolerance: f64) {
        if distance <= tolerance && self.nearest.is_none_or(|(nearest, _)| distance < nearest) {
            self.nearest = Some((distance, primitive));
        }
    }
}

fn is_near(point: Vec3, bounds: &Bounds, distance: f64) -> bool {
    (0..3).all(|axis| {
        let (low, high) = (bounds.min.component(axis) - distance, bounds.max.component(axis) + distance);
        (low..=high).contains(&point.component(axis))
    })
}
