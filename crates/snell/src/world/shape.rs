//! From the planes, boxes and discs of a scene to shapes of the world: one primitive for each place of each.

use super::Object;
use super::builder::Builder;
use super::mesh::{Parts, Which, nothing_goes_through, put_sparse, refusal};
use super::solid::MeshSolids;
use crate::geometry::shape::{Cuboid, Disc, Rectangle, Surface};
use crate::geometry::{Affine, TriangleMesh};
use crate::scene::{LARGEST_NUMBER, Problem, Step, Transform, Warning, WarningCode, whole_map};
use crate::stage::{NO_SOLID, Solid};
use std::sync::Arc;

/// What is said of a shape besides where it is.
struct About<'a> {
    which: Which,
    name: Option<&'a String>,
    material: &'a str,
    inside: Option<&'a String>,
    outside: Option<&'a String>,
    transform: &'a [Transform],
    instances: &'a [Vec<Transform>],
}

/// A shape that stays one of its kind under every map.
trait Placeable: Surface + Copy {
    /// Does it enclose something?
    const IS_SOLID: bool;

    fn under(&self, map: &Affine) -> Self;
    /// Is there anything to be hit?
    fn has_size(&self) -> bool;
    /// Where those of its kind are collected.
    fn list(parts: &mut Parts) -> &mut Vec<Self>;
}

impl Placeable for Rectangle {
    const IS_SOLID: bool = false;
    fn under(&self, map: &Affine) -> Self {
        self.under(map)
    }
    fn has_size(&self) -> bool {
        self.has_area()
    }
    fn list(parts: &mut Parts) -> &mut Vec<Self> {
        &mut parts.rectangles
    }
}

impl Placeable for Cuboid {
    const IS_SOLID: bool = true;
    fn under(&self, map: &Affine) -> Self {
        self.under(map)
    }
    fn has_size(&self) -> bool {
        self.has_volume()
    }
    fn list(parts: &mut Parts) -> &mut Vec<Self> {
        &mut parts.cuboids
    }
}

impl Placeable for Disc {
    const IS_SOLID: bool = false;
    fn under(&self, map: &Affine) -> Self {
        self.under(map)
    }
    fn has_size(&self) -> bool {
        self.has_area()
    }
    fn list(parts: &mut Parts) -> &mut Vec<Self> {
        &mut parts.discs
    }
}

impl Builder<'_> {
    /// Adds all of them, in the order of their kinds.
    pub(super) fn add_shapes(&mut self) -> Result<(), Problem> {
        let scene = self.scene;
        for (i, plane) in scene.planes.iter().enumerate() {
            let about = About {
                which: ("plane", i),
                name: plane.name.as_ref(),
                material: &plane.material,
                inside: plane.inside.as_ref(),
                outside: plane.outside.as_ref(),
                transform: &plane.transform,
                instances: &plane.instances,
            };
            let shape = Rectangle::new(plane.center.into(), plane.normal.into(), plane.size);
            self.add_shape(&about, shape)?;
        }
        for (i, cuboid) in scene.boxes.iter().enumerate() {
            let about = About {
                which: ("box", i),
                name: cuboid.name.as_ref(),
                material: &cuboid.material,
                inside: None,
                outside: None,
                transform: &cuboid.transform,
                instances: &cuboid.instances,
            };
            self.add_shape(&about, Cuboid::new(cuboid.min.into(), cuboid.max.into()))?;
        }
        for (i, disc) in scene.discs.iter().enumerate() {
            let about = About {
                which: ("disc", i),
                name: disc.name.as_ref(),
                material: &disc.material,
                inside: disc.inside.as_ref(),
                outside: disc.outside.as_ref(),
                transform: &disc.transform,
                instances: &disc.instances,
            };
            let shape = Disc::new(disc.center.into(), disc.normal.into(), disc.radius);
            self.add_shape(&about, shape)?;
        }
        Ok(())
    }

    /// Adds a shape in all of its places.
    fn add_shape<S: Placeable>(&mut self, about: &About<'_>, shape: S) -> Result<(), Problem> {
        let (kind, index) = about.which;
        let place = |key: &str| vec![Step::from(kind), Step::from(index), Step::from(key)];
        let name = about.name.cloned().unwrap_or_else(|| format!("{kind} {}", index + 1));
        let material = self.material_ids.get(about.material).copied().unwrap_or(0);
        let own = shape.under(&whole_map(about.transform));
        let (key, places) = if about.instances.is_empty() {
            ("transform", vec![own])
        } else {
            ("instances", about.instances.iter().map(|steps| own.under(&whole_map(steps))).collect())
        };
        for placed in places {
            let bounds = placed.bounds();
            let farthest = bounds.min.length().max(bounds.max.length());
            let problem = |message: String| Problem { place: place(key), message, help: None, remedy: None };
            if farthest.is_nan() || farthest > LARGEST_NUMBER {
                return Err(problem(format!("`{name}` ends up beyond 1e15")));
            }
            let has_size = placed.has_size();
            if !has_size && (S::IS_SOLID || key == "instances") {
                return Err(problem(format!("`{name}` is scaled by 0 here")));
            }
            let first = self.surfaces.material_of.len() as u32;
            Arc::make_mut(&mut self.objects).push(Object { name: name.clone(), first, count: u32::from(has_size) });
            if !has_size {
                let message = format!("`{name}` has no area, and is left out");
                self.shape_warnings.push(Warning { code: WarningCode::DegenerateFaces, place: place(key), message });
                continue;
            }
            let refused = |problem| Problem { place: place("material"), ..problem };
            let [behind, front] = self.sides_of_shape(&name, about, &placed, material).map_err(refused)?;
            self.surfaces.material_of.push(material);
            put_sparse(&mut self.surfaces.interior_of, first as usize, behind, NO_SOLID);
            put_sparse(&mut self.surfaces.exterior_of, first as usize, front, NO_SOLID);
            S::list(&mut self.parts).push(placed);
        }
        if self.stage.materials[material as usize].is_transparent() {
            self.warn_not_refracted(&name, place("material"));
        }
        Ok(())
    }

    /// The solids behind a shape and in front of it.
    fn sides_of_shape<S: Placeable>(
        &mut self,
        name: &str,
        about: &About<'_>,
        shape: &S,
        material: u32,
    ) -> Result<[u32; 2], Problem> {
        if !self.refracts(material) {
            return match about.inside {
                Some(_) if self.stage.has_media => Err(nothing_goes_through(name)),
                _ => Ok([NO_SOLID; 2]),
            };
        }
        if about.inside.is_some() {
            let bounds = shape.bounds();
            return Ok([self.side(about.inside, bounds), self.side(about.outside, bounds)]);
        }
        let medium = self.stage.materials[material as usize].medium();
        if !S::IS_SOLID {
            let mut mesh = TriangleMesh::default();
            shape.tessellate(&mut |corners| {
                let number = corners.map(|corner| {
                    let known = mesh.vertices.iter().position(|vertex| *vertex == corner);
                    known.unwrap_or_else(|| {
                        mesh.vertices.push(corner);
                        mesh.vertices.len() - 1
                    }) as u32
                });
                mesh.faces.push(number);
            });
            let why_not = MeshSolids::of(&mesh, medium).err();
            let message = format!("`{name}` is transparent but not a solid: {}", why_not.unwrap_or_default());
            let help = "give its material a `thickness` for a thin pane, or name the media on both sides with `inside` and `outside`";
            return Err(refusal(message, help, None));
        }
        let number = self.stage.solids.len() as u32;
        self.stage.solids.push(Solid {
            medium,
            inward: false,
            touches: false,
            between_faces_of: None,
            primitive: self.surfaces.material_of.len() as u32,
            bounds: shape.bounds(),
        });
        Ok([number, NO_SOLID])
    }
}
