//! The scene as the viewer draws it: shapes, camera and lights as plain data, version 1 of its JSON form.

use crate::film::transfer::Transfer;
use crate::geometry::Bounds;
use crate::world::CompiledScene;
use serde::Serialize;

/// Triangles that are drawn; of objects beyond them, only the box.
const MOST_FACES: u32 = 40_000;

/// The version of this form.
const VERSION: u32 = 1;

/// What can be seen of a scene. Lengths are in scene units, colours linear.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub struct ViewScene {
    /// The version of this form.
    #[cfg_attr(feature = "schemars", schemars(extend("const" = VERSION)))]
    snell_view: u32,
    /// The curve by which colours are shown.
    transfer: Transfer,
    spheres: Vec<ViewSphere>,
    meshes: Vec<ViewMesh>,
    camera: ViewCamera,
    lights: Vec<ViewLight>,
}

#[derive(Clone, Debug, Serialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
struct ViewSphere {
    name: String,
    center: [f64; 3],
    radius: f64,
    color: [f64; 3],
    /// From 0 to 1.
    opacity: f64,
}

#[derive(Clone, Debug, Serialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
struct ViewMesh {
    name: String,
    /// x, y, z of one vertex after the other.
    vertices: Vec<f64>,
    /// Three vertices for each face.
    faces: Vec<u32>,
    color: [f64; 3],
    /// From 0 to 1.
    opacity: f64,
}

#[derive(Clone, Debug, Serialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
struct ViewCamera {
    eye: [f64; 3],
    /// Of the image plane: left bottom, right bottom, left top, right top.
    corners: [[f64; 3]; 4],
    up: [f64; 3],
}

#[derive(Clone, Debug, Serialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
struct ViewLight {
    name: String,
    /// Where it stands.
    position: Option<[f64; 3]>,
    /// Or, if it is infinitely far away, the direction towards it.
    direction: Option<[f64; 3]>,
    color: [f64; 3],
}

/// What a mesh is made of, where it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewGeometry {
    /// x, y, z of one vertex after the other.
    pub vertices: Vec<f64>,
    /// Three vertices for each face.
    pub faces: Vec<u32>,
}

impl ViewScene {
    /// Takes vertices and faces out of the meshes, which are left without, for whoever hands them over in another way.
    pub fn take_geometry(&mut self) -> Vec<ViewGeometry> {
        let take = |mesh: &mut ViewMesh| ViewGeometry {
            vertices: std::mem::take(&mut mesh.vertices),
            faces: std::mem::take(&mut mesh.faces),
        };
        self.meshes.iter_mut().map(take).collect()
    }

    /// Of a scene and its world.
    pub fn of(compiled: &CompiledScene) -> Self {
        let world = compiled.world();
        let look = |primitive: u32| {
            let m = &world.materials[world.material_of(primitive as usize) as usize];
            let own = if m.emission.mean() > 0.0 {
                m.emission
            } else if m.kd.mean() > 0.0 {
                m.kd
            } else {
                m.ka
            };
            let color = own.to_array().map(|c| c.clamp(0.0, 1.0));
            // What is wholly transparent is still to be seen.
            (if own.mean() > 0.0 { color } else { [0.7, 0.8, 0.85] }, m.ko.mean().clamp(0.15, 1.0))
        };
        let (mut spheres, mut meshes, mut room) = (Vec::new(), Vec::new(), MOST_FACES);
        for object in world.objects.iter().filter(|object| object.count > 0) {
            let (color, opacity) = look(object.first);
            let name = object.name.clone();
            if let Some(sphere) = world.spheres.get(object.first as usize) {
                spheres.push(ViewSphere { name, center: sphere.center.into(), radius: sphere.radius, color, opacity });
                continue;
            }
            let shapes = (object.first..object.first + object.count).map(|p| world.shape(p as usize));
            let (vertices, faces): (Vec<f64>, Vec<u32>) = if object.count > room {
                let corners = shapes.map(|shape| shape.bounds()).fold(Bounds::EMPTY, Bounds::union).corners();
                let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
                let faces = sides.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]).collect();
                (corners.iter().flat_map(|p| [p.x, p.y, p.z]).collect(), faces)
            } else {
                room -= object.count;
                let mut vertices = Vec::new();
                shapes
                    .for_each(|shape| shape.tessellate(&mut |corners| vertices.extend(corners.map(<[f64; 3]>::from))));
                (vertices.concat(), (0..vertices.len() as u32).collect())
            };
            meshes.push(ViewMesh { name, vertices, faces, color, opacity });
        }
        let lights = world.lights.iter().enumerate().map(|(number, light)| ViewLight {
            name: compiled.light(number),
            position: (!light.at_infinity).then(|| light.at.into()),
            direction: light.at_infinity.then(|| light.at.into()),
            color: light.color.to_array(),
        });
        let camera = ViewCamera {
            eye: world.camera.eye.into(),
            corners: world.camera.corners().map(Into::into),
            up: world.camera.axes[1].into(),
        };
        let transfer = compiled.scene().render.transfer;
        Self { snell_view: VERSION, transfer, spheres, meshes, camera, lights: lights.collect() }
    }
}
