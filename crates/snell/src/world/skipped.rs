//! What stands between the eye and the image plane. In the models of the lecture and the course rays start on the plane, so
//! that nothing of it is seen, and what reaches through the plane is cut open.

use super::{CameraFrame, World};
use crate::geometry::{Sphere, Vec3};
use crate::scene::{Step, Warning, WarningCode};
use crate::stage::JITTER;

/// So many objects are named.
const NAMED: usize = 3;

impl World {
    /// W009, if rays start on the image plane and pass over something.
    pub(super) fn before_image_plane(&self, spp: u32) -> Option<Warning> {
        if self.camera.from_eye {
            return None;
        }
        let skipped = Pyramid::of(&self.camera, if spp > 1 { JITTER } else { 0.0 });
        if skipped.leaves_out(&self.ground.extent.corners()) {
            return None;
        }
        let mut names: Vec<&str> = Vec::new();
        for object in self.objects.iter().filter(|object| object.count > 0) {
            let first = object.first as usize;
            let stands_there = if let Some(sphere) = self.spheres.get(first) {
                skipped.meets_sphere(sphere)
            } else {
                let place = self.placement(first).map(|(place, _)| place.bounds.corners());
                let mut primitives = first..first + object.count as usize;
                !place.is_some_and(|corners| skipped.leaves_out(&corners))
                    && primitives.any(|id| {
                        let mut meets = false;
                        self.shape(id).tessellate(&mut |corners| meets |= skipped.meets_triangle(corners));
                        meets
                    })
            };
            if stands_there {
                names.push(&object.name);
            }
        }
        names.dedup();
        let more = names.len().saturating_sub(NAMED);
        let named: Vec<String> = names.iter().take(NAMED).map(|name| format!("`{name}`")).collect();
        let named = named.join(", ") + &if more > 0 { format!(" and {more} more") } else { String::new() };
        let message = format!(
            "between the eye and the image plane, where rays start, there is something of {named}, which is missing in the \
             picture or cut open; move `near` towards the eye, and `bounds` with it, or choose the integrator `whitted`"
        );
        let place = vec![Step::from("camera"), Step::from("near")];
        (!names.is_empty()).then_some(Warning { code: WarningCode::BeforeImagePlane, place, message })
    }
}

/// All between the eye, which is its tip, and the picture on the image plane, its base.
struct Pyramid {
    eye: Vec3,
    /// Of the base, seen from the eye.
    corners: [Vec3; 4],
    /// Four sides and the base: outward normals of unit length, and how far from the eye.
    faces: [(Vec3, f64); 5],
}

/// The corners of the base in pairs, once around it.
const AROUND: [[usize; 2]; 4] = [[0, 1], [1, 3], [3, 2], [2, 0]];

impl Pyramid {
    fn of(camera: &CameraFrame, jitter: f64) -> Self {
        let corners = camera.outermost(jitter).map(|corner| corner - camera.eye);
        let middle = corners[0] + corners[3];
        let side = |[a, b]: [usize; 2]| {
            let normal = corners[a].cross(corners[b]).unit();
            (if normal.dot(middle) > 0.0 { -normal } else { normal }, 0.0)
        };
        let [a, b, c, d] = AROUND.map(side);
        // What touches the plane but for roundings stands behind it.
        let base = (-camera.axes[2], camera.near.abs() * (1.0 - 1e-9));
        Self { eye: camera.eye, corners, faces: [a, b, c, d, base] }
    }

    /// Is all between these points surely outside?
    fn leaves_out(&self, points: &[Vec3]) -> bool {
        self.faces.iter().any(|face| points.iter().all(|&p| beyond(face, p - self.eye) > 0.0))
    }

    /// Could a ray from the eye meet the sphere before the plane? From within, rays do not meet a sphere in these models.
    fn meets_sphere(&self, sphere: &Sphere) -> bool {
        let center = sphere.center - self.eye;
        center.length() > sphere.radius && self.distance(center) < sphere.radius
    }

    /// How far away a point is, seen from the eye: 0 within, else the way to the nearest face or edge.
    fn distance(&self, p: Vec3) -> f64 {
        let within = |q: Vec3| self.faces.iter().all(|face| beyond(face, q) <= 0.0);
        if within(p) {
            return 0.0;
        }
        let on_faces = self.faces.iter().enumerate().filter_map(|(number, face)| {
            let foot = p - face.0 * beyond(face, p);
            let mut others = self.faces.iter().enumerate().filter(|(other, _)| *other != number);
            others.all(|(_, other)| beyond(other, foot) <= 0.0).then_some(foot)
        });
        let along = |a: Vec3, b: Vec3| {
            let edge = b - a;
            a + edge * ((p - a).dot(edge) / edge.dot(edge)).clamp(0.0, 1.0)
        };
        let base = AROUND.map(|[a, b]| along(self.corners[a], self.corners[b]));
        let slanted = self.corners.map(|corner| along(Vec3::default(), corner));
        let feet = on_faces.chain(base).chain(slanted);
        feet.map(|foot| (p - foot).length()).fold(f64::INFINITY, f64::min)
    }

    /// Is something of a triangle inside? It is cut at one face after the other (Sutherland and Hodgman, *Reentrant polygon
    /// clipping*, Communications of the ACM 17(1), 1974).
    fn meets_triangle(&self, corners: [Vec3; 3]) -> bool {
        if self.leaves_out(&corners) {
            return false;
        }
        let mut polygon: Vec<Vec3> = corners.iter().map(|&corner| corner - self.eye).collect();
        for face in &self.faces {
            let mut kept = Vec::with_capacity(polygon.len() + 1);
            for (i, &p) in polygon.iter().enumerate() {
                let q = polygon[(i + 1) % polygon.len()];
                let (from, to) = (beyond(face, p), beyond(face, q));
                if from <= 0.0 {
                    kept.push(p);
                }
                if (from <= 0.0) != (to <= 0.0) {
                    kept.push(p + (q - p) * (from / (from - to)));
                }
            }
            polygon = kept;
        }
        !polygon.is_empty()
    }
}

/// How far a point is outside of a face; inside it is negative.
fn beyond((normal, offset): &(Vec3, f64), point: Vec3) -> f64 {
    normal.dot(point) - offset
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::sphere;
    use crate::geometry::triangle;
    use crate::scene::{Camera, Integrator, Render};
    use proptest::prelude::*;

    fn frame(scale: f64) -> CameraFrame {
        let at = |p: [f64; 3]| p.map(|c| c * scale);
        let bounds = [-1.0, 3.0, -2.0, 1.0].map(|b| b * scale);
        let camera = Camera::new(at([1.0, 2.0, 9.0]), at([0.5, 0.0, 0.0]), [0.1, 1.0, 0.2], bounds, -4.0 * scale);
        camera.frame(&Render::new(Integrator::Lecture, [33, 33]))
    }

    /// Whether one of many rays from the eye meets something before it reaches the plane. They leave gaps.
    fn met(frame: &CameraFrame, meets: impl Fn(Vec3, Vec3) -> Option<f64>) -> bool {
        (0..33 * 33).any(|i| {
            let (start, dir) = frame.ray(i % 33, i / 33);
            meets(frame.eye, dir).is_some_and(|t| t > 0.0 && t < (start - frame.eye).length() * (1.0 - 1e-6))
        })
    }

    proptest! {
        /// Whatever a ray meets before the plane is found, at any scale; and what is found is still met, or nearly.
        #[test]
        fn it_is_what_rays_from_the_eye_meet_before_the_plane(
            near in prop::array::uniform3(-7.0..7.0f64),
            radius in 0.01..5.0f64,
            sides in prop::array::uniform3(prop::array::uniform3(-7.0..7.0f64)),
            scale in prop_oneof![Just(1e-9), Just(1.0), Just(1e9)],
        ) {
            let frame = frame(scale);
            let pyramid = Pyramid::of(&frame, 0.0);
            let at = |p: [f64; 3]| Vec3::from(p) * scale + Vec3::new(1.0, 2.0, 6.0) * scale;
            let hit = |center: Vec3, radius: f64| met(&frame, |eye, dir| {
                let (t, meets) = sphere::intersect(eye, dir, center, radius);
                meets.then_some(t)
            });
            let ball = Sphere { center: at(near), radius: radius * scale };
            let found = pyramid.meets_sphere(&ball);
            prop_assert!(found || !hit(ball.center, ball.radius));
            // Between rays there are gaps of at most 4·√2/32, half of it to the nearest ray; and the eye must stay outside.
            let larger = ball.radius + 0.1 * scale;
            let outside = (ball.center - frame.eye).length() > larger * 1.001;
            prop_assert!(!found || !outside || hit(ball.center, larger));

            let corners = sides.map(at);
            let crossed = met(&frame, |eye, dir| {
                let normal = triangle::normal(corners);
                let t = (corners[0] - eye).dot(normal) / dir.dot(normal);
                let p = eye + dir * t;
                let inside = [[0, 1], [1, 2], [2, 0]].iter().all(|&[a, b]| {
                    (corners[b] - corners[a]).cross(p - corners[a]).dot(normal) >= 0.0
                });
                inside.then_some(t)
            });
            prop_assert!(pyramid.meets_triangle(corners) || !crossed);
        }
    }

    #[test]
    fn what_stands_behind_or_beside_is_left_alone() {
        for scale in [1e-9, 1.0, 1e9] {
            let frame = frame(scale);
            let (pyramid, [_, right, back]) = (Pyramid::of(&frame, 0.0), [frame.axes[1], frame.axes[0], frame.axes[2]]);
            let plane = frame.eye - back * (4.0 * scale);
            let ball = |center: Vec3, radius: f64| pyramid.meets_sphere(&Sphere { center, radius: radius * scale });
            assert!(!ball(plane - back * (2.0 * scale), 2.0), "touches the plane from behind");
            assert!(ball(plane - back * (2.0 * scale), 2.001), "pokes through it");
            assert!(!ball(frame.eye + back * (2.0 * scale), 1.999), "behind the eye");
            assert!(!ball(frame.eye, 100.0), "around the eye");
            assert!(!ball(plane + right * (5.0 * scale), 1.9) && ball(plane + right * (5.0 * scale), 2.1), "beside");
            let triangle = |depth: f64| {
                let middle = frame.eye - back * (depth * scale);
                // Large, with all its corners outside.
                [[-90.0, -80.0], [90.0, -80.0], [0.0, 99.0]]
                    .map(|[x, y]| middle + frame.axes[0] * (x * scale) + frame.axes[1] * (y * scale))
            };
            assert!(!pyramid.meets_triangle(triangle(4.0)) && pyramid.meets_triangle(triangle(3.999)));
            assert!(!pyramid.meets_triangle(triangle(-1.0)), "behind the eye");
        }
    }
}
