//! What surface is at a hit: its normal, its material.

use super::{NO_SOLID, Stage};
use crate::color::Rgb;
use crate::geometry::area::area_vector;
use crate::geometry::ray::{Heading, axes, main_axis};
use crate::geometry::shape::{AnyShape, Kind, Surface, Triangle};
use crate::geometry::{Affine, Bounds, Vec3, triangle};
use crate::lanes::{Lanes, MAX_WIDTH, Mask};
use crate::settings::Shadows;
use alloc::vec::Vec;

/// "No primitive", where an id is expected.
pub const NO_PRIMITIVE: u32 = u32::MAX;

/// "No corner normals", where their place is expected.
pub const FLAT: u32 = u32::MAX;

/// What is known of primitives besides their shape, by their ids.
#[derive(Clone, Debug, Default)]
pub struct Surfaces {
    /// Number of the material of each.
    pub material_of: Vec<u32>,
    /// The solid whose surface each is; `NO_SOLID`, or no entry at all, where nothing goes through.
    pub interior_of: Vec<u32>,
    /// The solid in front of each, where it is an interface between two, as above.
    pub exterior_of: Vec<u32>,
    /// Texture coordinates at the corners of the triangles that have a texture.
    pub corner_uvs: Vec<[[f64; 2]; 3]>,
    /// For each primitive where its texture coordinates are; `FLAT`, or no entry at all, where it has none.
    pub corner_uvs_of: Vec<u32>,
    /// Normals at the corners of the triangles that are smooth.
    pub corner_normals: Vec<[Vec3; 3]>,
    /// For each primitive where its corner normals are, `FLAT` if it has none; empty if none has any.
    pub corner_normals_of: Vec<u32>,
}

/// So many times [`Stage::coincidence_tolerance`] from an edge of a triangle is near it, whatever the angle at which a ray meets it.
const RIM: f64 = 2048.0;

/// From which side rays meet spheres.
#[derive(Clone, Copy, Debug)]
pub struct Side<L: Lanes> {
    /// From inside.
    pub within: L::Mask,
    /// It is not known.
    pub either: L::Mask,
}

impl<L: Lanes> Side<L> {
    /// All from outside.
    #[inline(always)]
    pub fn outside() -> Self {
        Self { within: L::Mask::from_bits(0), either: L::Mask::from_bits(0) }
    }
}

/// By which angle planes and boxes that are turned alike may differ: some dozens of roundings, of the steps that turn them.
const TURNED: f64 = 1.0 / (1u64 << 47) as f64;

/// A mesh in one of its places.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    /// Number of the model, whose triangles are numbered from 0.
    pub model: usize,
    /// Id of its first triangle here.
    pub first: u32,
    /// Number of its first solid here.
    pub first_solid: u32,
    /// From the space of the model.
    pub to_world: Affine,
    /// Into the space of the model.
    pub to_model: Affine,
    /// Its box, with some room.
    pub bounds: Bounds,
}

impl Surfaces {
    /// Bytes.
    pub fn memory(&self) -> usize {
        size_of_val(self.material_of.as_slice())
            + size_of_val(self.interior_of.as_slice())
            + size_of_val(self.exterior_of.as_slice())
            + size_of_val(self.corner_uvs.as_slice())
            + size_of_val(self.corner_uvs_of.as_slice())
            + size_of_val(self.corner_normals.as_slice())
            + size_of_val(self.corner_normals_of.as_slice())
    }

    /// The mean of the normals at the corners of a smooth triangle, as near as they are; `None` on a flat one.
    fn smooth_normal(&self, primitive: usize, corners: [Vec3; 3], point: Vec3, dir: Vec3) -> Option<Vec3> {
        let at = *self.corner_normals_of.get(primitive)?;
        let [a, b, c] = self.corner_normals.get(at as usize)?;
        // The barycentric weights do not depend on where the ray starts: start it at the hit.
        let k = axes(main_axis(dir));
        let (point, heading) = (point.permuted(k), Heading::new(dir.permuted(k)));
        let [alpha, beta, gamma] = triangle::weights(point, &heading, corners.map(|v| v.permuted(k)));
        let smooth = *a * alpha + *b * beta + *c * gamma;
        // Opposite normals at the corners can cancel, and a grazing ray can find no weights.
        (smooth.is_finite() && smooth != Vec3::default()).then_some(smooth)
    }
}

impl Stage {
    /// The placement of a primitive and its id in the model; `None` where it stands for itself.
    pub fn placement(&self, primitive: usize) -> Option<(&Placement, usize)> {
        let after = self.placements.partition_point(|p| p.first as usize <= primitive);
        let placement = self.placements[..after].last()?;
        Some((placement, primitive - placement.first as usize))
    }

    /// The material of a primitive.
    #[inline(always)]
    pub fn material_of(&self, primitive: usize) -> u32 {
        match self.surfaces.material_of.get(primitive) {
            Some(&material) => material,
            None => self.material_in_model(primitive),
        }
    }

    /// Does the outer side of a transparent surface show something at a point, besides what it reflects?
    pub fn shows(&self, primitive: usize, point: Vec3) -> bool {
        let (material, black) = (&self.materials[self.material_of(primitive) as usize], Rgb::gray(0.0));
        let shines = material.ko != black || material.emission != black;
        material.tints > 0.0 || (shines && self.coverage(primitive, point) > 0.0)
    }

    /// Does no light at all go through, with this kind of shadows?
    pub fn blocks_light(&self, primitive: u32, shadows: Shadows) -> bool {
        let primitive = primitive as usize;
        shadows != Shadows::Tinted || (self.interior_of(primitive) == NO_SOLID && !self.is_thin(primitive))
    }

    /// The same at one of its points: what has holes may be whole there.
    pub fn blocks_light_at(&self, primitive: u32, point: Vec3, shadows: Shadows) -> bool {
        shadows != Shadows::Tinted || self.is_opaque_at(primitive as usize, point)
    }

    /// Is it a surface of no solid, and lets nothing through at this point?
    pub fn is_opaque_at(&self, primitive: usize, point: Vec3) -> bool {
        self.interior_of(primitive) == NO_SOLID && self.lets_through(primitive, point) == Rgb::gray(0.0)
    }

    /// What of the light on the outer side of a surface does not go through.
    fn opacity(&self, primitive: usize, point: Vec3) -> Rgb {
        let material = &self.materials[self.material_of(primitive) as usize];
        let is_clear = self.interior_of(primitive) != NO_SOLID || material.is_pane();
        let whole = if is_clear { material.ko } else { Rgb::gray(1.0) };
        whole * self.coverage(primitive, point)
    }

    /// The share of light that passes the outer side of a surface, without what Fresnel reflects.
    pub fn lets_through(&self, primitive: usize, point: Vec3) -> Rgb {
        let material = &self.materials[self.material_of(primitive) as usize];
        let clear = Rgb::gray(1.0) - self.opacity(primitive, point);
        if material.tints == 0.0 || self.is_cut_out(primitive) {
            return clear;
        }
        let (tint, alpha) = self.pattern_at(primitive, point);
        clear * material.kd * (tint * alpha + Rgb::gray(1.0 - alpha))
    }

    /// Is a crossing of the primitive on which a ray starts only its start? Not if it is the far wall of a sphere that the ray
    /// leaves inward. Distances do not tell: at a grazing angle they are off by much.
    pub fn starts_at(&self, primitive: usize, origin: Vec3, dir: Vec3, t: f64) -> bool {
        self.ask(primitive, |surface| surface.starts_at(origin, dir, t))
    }

    /// The unit normal of the face itself, outward.
    pub fn geometric_normal(&self, primitive: usize, point: Vec3) -> Vec3 {
        self.ask(primitive, |surface| surface.normal(point))
    }

    /// Where a line meets a primitive; a sphere on the side on which it was met at about `t`.
    pub fn meets_at(&self, primitive: usize, origin: Vec3, dir: Vec3, t: f64) -> Option<f64> {
        self.ask_of_ray(primitive, (origin, dir), |surface, origin, dir| surface.meets_at(origin, dir, t))
    }

    /// The face of the same object that looks at a ray and is in the place where the ray has met the back of an opaque one: along the
    /// outline of a body both are there, and rounding alone says which is nearer.
    pub fn front_of_silhouette(&self, primitive: usize, point: Vec3, dir: Vec3) -> Option<u32> {
        if self.interior_of(primitive) != NO_SOLID {
            return None;
        }
        let (object, mut faces) = (self.object_number(primitive as u32), Vec::new());
        self.tree.near(point, &mut faces);
        let fronts = faces.into_iter().filter(|&face| {
            let shape = self.shape(face as usize);
            self.object_number(face) == object
                && shape.normal(point).dot(dir) < 0.0
                && shape.distance(point) <= self.coincidence_tolerance
        });
        fronts.min()
    }

    /// Does a line along `dir` stay in the plane of a triangle, as far as hits are exact, all the way past it?
    pub fn is_edge_on(&self, primitive: usize, dir: Vec3) -> bool {
        let shape = self.shape(primitive);
        let bounds = shape.bounds();
        shape.is_flat() && shape.normal(bounds.min).dot(dir).abs() * bounds.diagonal() <= self.coincidence_tolerance
    }

    /// A primitive, in the space of the world.
    pub fn shape(&self, primitive: usize) -> AnyShape {
        let placed = || Triangle { corners: self.triangle(primitive).unwrap_or_default() }.any();
        self.tree.shape(primitive).unwrap_or_else(placed)
    }

    /// The same, for a question that is often asked: most scenes are made of spheres and triangles.
    #[inline(always)]
    fn ask<A>(&self, primitive: usize, question: impl Fn(&dyn Surface) -> A) -> A {
        if let Some(sphere) = self.spheres.get(primitive) {
            return question(sphere);
        }
        match self.triangle(primitive) {
            Some(corners) => question(&Triangle { corners }),
            None => question(&*self.shape(primitive)),
        }
    }

    /// The same in the space in which rays meet the primitive, which is that of the model for an instance, and with a ray there.
    #[inline(always)]
    pub fn ask_of_ray<A>(
        &self,
        primitive: usize,
        (origin, dir): (Vec3, Vec3),
        question: impl Fn(&dyn Surface, Vec3, Vec3) -> A,
    ) -> A {
        let Some((Placement { model, to_model, .. }, id)) = self.placement(primitive) else {
            return self.ask(primitive, |surface| question(surface, origin, dir));
        };
        let corners = self.tree.model(*model).get(id).map_or_else(Default::default, |Triangle { corners }| corners);
        question(&Triangle { corners }, to_model.apply(origin), to_model.turn(dir))
    }

    /// Are the surfaces parallel in two places, for all that is known of them? Smoothed normals count, as a smoothed face stands
    /// for a curved one.
    pub fn are_parallel(&self, places: [(usize, Vec3); 2], dir: Vec3) -> bool {
        let [(a, a_slack), (b, b_slack)] = places.map(|(primitive, point)| {
            let Some(corners) = self.triangle(primitive) else {
                // What is exact is as parallel as it is.
                return (
                    self.geometric_normal(primitive, point),
                    if primitive < self.spheres.len() { 0.0 } else { TURNED },
                );
            };
            let smooth = self.smooth_normal(primitive, corners, point, dir).map(Vec3::unit);
            (smooth.unwrap_or_else(|| triangle::normal(corners)), self.tilt(primitive, corners))
        });
        a.cross(b).length() <= a_slack + b_slack
    }

    /// By which angle the normal of a triangle may be off.
    ///
    /// Corners are known to single precision of the size of their solid, which is what model files hold, and to
    /// [`coincidence_tolerance`](Self::coincidence_tolerance). Where all of them are off by `d`, a triangle of longest edge `l` and height `h` upon it
    /// turns by up to `2d/h` about that edge and `2d/l` across; as `h` is at most `√3/2·l`, by less than `3d/h`.
    fn tilt(&self, primitive: usize, [a, b, c]: [Vec3; 3]) -> f64 {
        const SINGLE: f64 = 1.0 / (1u64 << 24) as f64;
        let size = self.solids.get(self.interior_of(primitive) as usize).map_or(0.0, |solid| solid.bounds.diagonal());
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        let height = area_vector([a, b, c]).length() / longest;
        3.0 * (SINGLE * size + self.coincidence_tolerance) / height
    }

    fn material_in_model(&self, primitive: usize) -> u32 {
        self.placement(primitive).map_or(0, |(placement, id)| self.models[placement.model].material_of[id])
    }

    /// The corners of a primitive that is a triangle, in the space of the world.
    #[inline(always)]
    fn triangle(&self, primitive: usize) -> Option<[Vec3; 3]> {
        match self.placement(primitive) {
            None => Some(self.tree.get::<Triangle>(primitive)?.corners),
            Some((placement, id)) => {
                let Triangle { corners } = self.tree.model(placement.model).get(id)?;
                Some(corners.map(|corner| placement.to_world.apply(corner)))
            }
        }
    }

    /// The outward normal of a shape that is neither sphere nor triangle, where a ray has met it.
    fn normal_along(&self, primitive: usize, point: Vec3, dir: Vec3, within: bool) -> Vec3 {
        self.shape(primitive).normal_along(point, dir, within, self.coincidence_tolerance)
    }

    /// The texture coordinates at the corners of a triangle, if it has any.
    pub fn corner_uvs(&self, primitive: usize) -> Option<[[f64; 2]; 3]> {
        let (surfaces, id) = match self.placement(primitive) {
            None => (self.surfaces.as_ref(), primitive),
            Some((placement, id)) => (&self.models[placement.model], id),
        };
        surfaces.corner_uvs.get(*surfaces.corner_uvs_of.get(id)? as usize).copied()
    }

    /// Is it one face with nothing inside that a ray may go through: a pane, or a surface with holes?
    pub fn is_thin(&self, primitive: usize) -> bool {
        self.materials[self.material_of(primitive) as usize].is_pane() || self.is_cut_out(primitive)
    }

    /// Is it a surface of no solid and no pane, with places where it is not there?
    pub fn is_cut_out(&self, primitive: usize) -> bool {
        let material = self.material_of(primitive);
        self.has_holes(material)
            && !self.materials[material as usize].is_pane()
            && self.interior_of(primitive) == NO_SOLID
    }

    /// Is nothing there at this point?
    pub fn is_hole(&self, primitive: usize, point: Vec3) -> bool {
        self.is_cut_out(primitive) && self.coverage(primitive, point) == 0.0
    }

    /// The interpolated normal of a triangle with corners there; `None` on a flat one.
    fn smooth_normal(&self, primitive: usize, corners: [Vec3; 3], point: Vec3, dir: Vec3) -> Option<Vec3> {
        let Some((placement, id)) = self.placement(primitive) else {
            return self.surfaces.smooth_normal(primitive, corners, point, dir);
        };
        let normal = self.models[placement.model].smooth_normal(id, corners, point, dir)?;
        Some(placement.to_model.turn_normal_back(normal))
    }

    /// The shading and the geometric normals at some hits, turned to face rays of these directions, not yet of unit length, and which
    /// hits are on the back of a triangle, near one of its edges. The geometric normal decides the side, on spheres what is known
    /// of it.
    #[inline(always)]
    pub fn facing_normals<L: Lanes>(
        &self,
        primitives: &[usize; MAX_WIDTH],
        point: Vec3<L>,
        dir: Vec3<L>,
        side: &Side<L>,
    ) -> ([Vec3<L>; 2], L::Mask) {
        let bit = |lane: usize| u32::from(primitives[lane] < self.spheres.len()) << lane;
        let spheres = L::Mask::from_bits((0..L::WIDTH).map(bit).sum());
        let mut normal = point;
        if spheres.any() {
            let center = |lane: usize| self.spheres.get(primitives[lane]).map_or(Vec3::default(), |s| s.center);
            let one = primitives[..L::WIDTH].iter().all(|&p| p == primitives[0]);
            normal = normal - if one { center(0).splat() } else { Vec3::from_fn(center) };
            if (side.within | side.either).any() {
                let inward = side.within | (side.either & normal.dot(dir).gt(L::splat(0.0)));
                normal = Vec3::select(inward, -normal, normal);
            }
        }
        if (!spheres).any() {
            // A lane with another shape gets a triangle without area, and is not looked at.
            let (mut corners, mut others, mut normals) =
                ([[Vec3::default(); 3]; MAX_WIDTH], 0, [Vec3::default(); MAX_WIDTH]);
            for lane in 0..L::WIDTH {
                if spheres.test(lane) {
                    continue;
                }
                if let Some(own) = self.triangle(primitives[lane]) {
                    corners[lane] = own;
                } else {
                    let (point, dir) = (point.lane(lane), dir.lane(lane));
                    normals[lane] = self.normal_along(primitives[lane], point, dir, side.within.test(lane));
                    others |= 1 << lane;
                }
            }
            let (a, b) = (Vec3::<L>::from_fn(|lane| corners[lane][0]), Vec3::from_fn(|lane| corners[lane][1]));
            let mut flat = triangle::normal([a, b, Vec3::from_fn(|lane| corners[lane][2])]);
            let others = L::Mask::from_bits(others);
            if others.any() {
                flat = Vec3::select(others, Vec3::from_fn(|lane| normals[lane]), flat);
            }
            let smooth = if self.all_flat {
                flat
            } else {
                Vec3::from_fn(
                    #[inline(always)]
                    |lane| {
                        let (point, dir, flat) = (point.lane(lane), dir.lane(lane), flat.lane(lane));
                        self.smooth_normal(primitives[lane], corners[lane], point, dir).unwrap_or(flat)
                    },
                )
            };
            let behind = flat.dot(dir).gt(L::splat(0.0));
            let (smooth, flat) = (Vec3::select(behind, -smooth, smooth), Vec3::select(behind, -flat, flat));
            let (mut rim, mut near_one) = (behind & !spheres & !others, L::Mask::from_bits(0));
            if rim.any() {
                let c = Vec3::<L>::from_fn(|lane| corners[lane][2]);
                let far = RIM * self.coincidence_tolerance;
                for [a, b] in [[a, b], [b, c], [c, a]] {
                    let (along, off) = (b - a, (b - a).cross(point - a));
                    near_one = near_one | off.dot(off).le(along.dot(along) * L::splat(far * far));
                }
                rim = rim & near_one;
            }
            return ([Vec3::select(spheres, normal, smooth), Vec3::select(spheres, normal, flat)], rim);
        }
        ([normal, normal], L::Mask::from_bits(0))
    }
}
