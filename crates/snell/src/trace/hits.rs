//! The hits of a generation as columns, and a view of several of them at once.

use super::leaving::together_at_most;
use super::queue::{Generation, Load, Weight};
use crate::film::Rgb;
use crate::geometry::Vec3;
use crate::geometry::bvh::{FewSpheres, Nearest, PACKET, Packet};
use crate::lanes::{Columns, Lanes, MAX_WIDTH, Mask, index};
use crate::scene::{Integrator, Material};
use crate::world::{Side, World};

/// Columns of the hits as they are found.
const RAY: usize = 0;
const PIXEL: usize = 1;
const PRIMITIVE: usize = 2;
const T: usize = 3;
const POINT: usize = 4;
const WO: usize = 7;
const ATTENUATION: usize = 10;

/// Columns of the faces: handles of the solids before and behind each, whether it is met from outside, the band of the ray.
const BEFORE: usize = 0;
const AFTER: usize = 1;
const BAND: usize = 3;

/// In the column of primitives: nothing is there, only the background.
pub(super) const SKY: f64 = -1.0;

/// Columns of what is worked out about them.
const NORMAL: usize = 0;
const MATERIAL: usize = 3;
const LOCAL: usize = 4;
const CONTRIBUTION: usize = 7;

/// The hits of a generation, compacted, in the order of their rays.
#[derive(Debug, Default)]
pub(crate) struct Hits {
    found: Columns<16>,
    /// With real optics the faces that were met, and their geometric normals; else empty.
    faces: Columns<4>,
    surface: Columns<10>,
    geometric: Columns<3>,
    /// By what the colours of the surfaces are multiplied, if there are patterns; else empty.
    tints: Columns<3>,
    /// How much of the surfaces is there, if there are patterns with holes; else empty.
    coverage: Columns<1>,
    /// Spheres that the rays may meet.
    seen: FewSpheres,
}

impl Hits {
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.found.len()
    }

    #[inline(always)]
    pub fn clear(&mut self) {
        self.found.clear();
        self.faces.clear();
    }

    /// Finds the closest hits of all rays, and what surface is there.
    #[inline(always)]
    pub fn find<L: Lanes>(&mut self, world: &World, rays: &impl Generation, packet: &mut Packet) {
        self.found.clear();
        if let Some(spheres) = world.tree.few_spheres() {
            let mut seen = std::mem::take(&mut self.seen);
            seen.clear();
            seen.extend(spheres.iter().filter(|(_, sphere)| rays.may_meet(sphere)));
            let all = if seen.is_empty() { 0 } else { rays.len() };
            for start in (0..all).step_by(L::WIDTH) {
                let ((origin, dir), load) = (rays.ways::<L>(start), rays.loads::<L>(start));
                let active = L::Mask::first(rays.len() - start);
                let none = Nearest::none(active, load.t_min, L::splat(f64::INFINITY), load.source);
                let Nearest { hit, t, primitive, .. } = none.among(false, &seen, origin, dir);
                if hit.any() {
                    self.push(hit, start, (origin, dir), t, primitive, &load);
                }
            }
            self.seen = seen;
        } else {
            for first in (0..rays.len()).step_by(PACKET) {
                let all = rays.fill::<L>(packet, first, world.tree.needs_shears());
                let hit = world.tree.intersect::<L, false>(packet, all);
                for start in (0..PACKET).step_by(L::WIDTH) {
                    let mask = L::Mask::from_bits((hit >> start) as u32);
                    if mask.any() {
                        let (t, primitive) = (L::load(&packet.t[start..]), L::load(&packet.primitive[start..]));
                        let (way, load) = (packet.ways(start), rays.loads(first + start));
                        self.push(mask, first + start, way, t, primitive, &load);
                    }
                }
            }
        }
        self.look_up_surfaces::<L>(world);
    }

    /// Appends the hits of some rays, from a row of their queue on.
    #[inline(always)]
    pub(super) fn push<L: Lanes>(
        &mut self,
        hit: L::Mask,
        row: usize,
        (o, d): (Vec3<L>, Vec3<L>),
        t: L,
        primitive: L,
        load: &Load<L>,
    ) {
        let (row, pixel, p, wo) = (L::ramp(row), load.pixel, o + d * t, -d);
        let Weight { attenuation: a, factor: f } = load.weight;
        self.found.push(hit, [row, pixel, primitive, t, p.x, p.y, p.z, wo.x, wo.y, wo.z, a.r, a.g, a.b, f.r, f.g, f.b]);
    }

    /// Appends the faces of the hits that were appended last.
    #[inline(always)]
    pub(super) fn push_faces<L: Lanes>(&mut self, hit: L::Mask, face: &Face<L>, band: L) {
        self.faces.push(hit, [face.before, face.after, face.outer, band]);
    }

    #[inline(always)]
    pub(super) fn look_up_surfaces<L: Lanes>(&mut self, world: &World) {
        let real_optics = world.render.integrator == Integrator::Whitted;
        self.surface.clear();
        self.geometric.clear();
        self.tints.clear();
        self.coverage.clear();
        for start in (0..self.len()).step_by(L::WIDTH) {
            let (mut primitives, mut materials) = ([0; MAX_WIDTH], [0.0; MAX_WIDTH]);
            for lane in 0..L::WIDTH.min(self.len() - start) {
                if self.found.at(PRIMITIVE, start + lane) != SKY {
                    primitives[lane] = self.primitive(start + lane) as usize;
                    materials[lane] = f64::from(world.material_of(primitives[lane]));
                }
            }
            let [x, y, z] = self.found.group(POINT, start);
            let [wx, wy, wz] = self.found.group(WO, start);
            let (point, dir) = (Vec3::new(x, y, z), -Vec3::new(wx, wy, wz));
            let (mut side, mut there) = (Side::outside(), L::Mask::first(self.len() - start));
            if real_optics {
                let [before, after, outer] = self.faces.group::<L, 3>(BEFORE, start);
                side = Side { within: outer.eq(L::splat(0.0)), either: before.eq(after) };
                there = there & !self.found.lanes::<L>(PRIMITIVE, start).eq(L::splat(SKY));
            }
            let nothing = Vec3::new(wx, wy, wz);
            let mut normals = [nothing, nothing];
            if there.any() {
                let rim;
                (normals, rim) = world.facing_normals::<L>(&primitives, point, dir, &side);
                // Not where the ray has just started: of the place that it leaves it sees the front, too.
                let rim = rim & there & self.found.lanes::<L>(T, start).gt(L::splat(together_at_most(world)));
                if real_optics && rim.any() {
                    let mut turned = false;
                    for lane in 0..L::WIDTH {
                        if !rim.test(lane) {
                            continue;
                        }
                        let front = world.front_of_outline(primitives[lane], point.lane(lane), dir.lane(lane));
                        if let Some(front) = front {
                            self.found.replace::<f64, 1>(PRIMITIVE, start + lane, [f64::from(front)]);
                            primitives[lane] = front as usize;
                            materials[lane] = f64::from(world.material_of(front as usize));
                            turned = true;
                        }
                    }
                    if turned {
                        normals = world.facing_normals::<L>(&primitives, point, dir, &side).0;
                    }
                }
            }
            let [normal, geometric] = normals;
            let (normal, active) = (normal.unit(), L::Mask::first(self.len() - start));
            let zero = L::splat(0.0);
            let row = [normal.x, normal.y, normal.z, L::load(&materials), zero, zero, zero, zero, zero, zero];
            self.surface.push(active, row);
            if real_optics {
                self.geometric.push(active, geometric.unit().into());
            }
            if !world.patterns.is_empty() {
                let (there, mut colors, mut coverage) = (there.bits(), [Rgb::gray(1.0); MAX_WIDTH], [1.0; MAX_WIDTH]);
                for lane in 0..L::WIDTH {
                    if there >> lane & 1 != 0 {
                        (colors[lane], coverage[lane]) = world.pattern_at(primitives[lane], point.lane(lane));
                    }
                }
                let tint = Rgb::<L>::from_fn(
                    #[inline(always)]
                    |lane| colors[lane],
                );
                self.tints.push(active, tint.into());
                if world.has_alpha {
                    self.coverage.push(active, [L::load(&coverage)]);
                }
            }
        }
    }

    /// Row of the ray of a hit in its queue.
    pub fn ray(&self, row: usize) -> usize {
        index(self.found.at(RAY, row))
    }

    #[inline(always)]
    pub fn pixel(&self, row: usize) -> usize {
        index(self.found.at(PIXEL, row))
    }

    #[inline(always)]
    pub fn primitive(&self, row: usize) -> u32 {
        index(self.found.at(PRIMITIVE, row)) as u32
    }

    /// Is there nothing but the background?
    pub fn is_sky(&self, row: usize) -> bool {
        self.found.at(PRIMITIVE, row) == SKY
    }

    pub fn t(&self, row: usize) -> f64 {
        self.found.at(T, row)
    }

    /// Of unit length, facing the ray.
    pub fn normal(&self, row: usize) -> Vec3 {
        let at = |i| self.surface.at(NORMAL + i, row);
        Vec3::new(at(0), at(1), at(2))
    }

    /// What the hit adds to its pixel.
    #[inline(always)]
    pub fn contribution(&self, row: usize) -> Rgb {
        let [r, g, b] = [0, 1, 2].map(
            #[inline(always)]
            |i| self.surface.at(CONTRIBUTION + i, row),
        );
        Rgb::new(r, g, b)
    }

    /// Replaces the local colour of a batch.
    #[inline(always)]
    pub fn set_local_color<L: Lanes>(&mut self, start: usize, color: Rgb<L>) {
        self.surface.replace::<L, 3>(LOCAL, start, color.into());
    }

    /// Says what a batch adds to its pixels.
    #[inline(always)]
    pub fn set_contribution<L: Lanes>(&mut self, start: usize, color: Rgb<L>) {
        self.surface.replace::<L, 3>(CONTRIBUTION, start, color.into());
    }

    /// The hits from one row on.
    #[inline(always)]
    pub fn batch<'a, L: Lanes>(&'a self, world: &'a World, start: usize) -> Batch<'a, L> {
        let mut active = L::Mask::first(self.len() - start);
        if self.faces.len() > 0 {
            active = active & !self.found.lanes::<L>(PRIMITIVE, start).eq(L::splat(SKY));
        }
        let material = self.surface.lanes::<L>(MATERIAL, start);
        let first = self.surface.at(MATERIAL, start);
        let one_material = !(active & !material.eq(L::splat(first))).any();
        Batch { world, hits: self, start, active, one_material }
    }
}

/// The hits from one row on, one in each lane. Lanes behind the last hit are not active and of no meaning.
#[derive(Clone, Copy)]
pub(crate) struct Batch<'a, L: Lanes> {
    pub world: &'a World,
    hits: &'a Hits,
    start: usize,
    pub active: L::Mask,
    /// Neighbouring hits mostly have the same material: then its numbers need not be gathered.
    one_material: bool,
}

/// On which side of a surface a ray is, and what it is in, in lanes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Face<L: Lanes> {
    /// In which solids the ray arrives, and in which it would go on behind the face: handles of `Media`.
    pub before: L,
    pub after: L,
    /// 1 where the ray arrives from outside, else 0.
    pub outer: L,
}

/// The coefficients of a surface that decide how light goes on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coefficients<L: Lanes> {
    pub kr: Rgb<L>,
    pub ko: Rgb<L>,
}

impl<L: Lanes> Batch<'_, L> {
    #[inline(always)]
    fn found(&self, column: usize) -> Vec3<L> {
        let [x, y, z] = self.hits.found.group(column, self.start);
        Vec3::new(x, y, z)
    }

    #[inline(always)]
    pub fn point(&self) -> Vec3<L> {
        self.found(POINT)
    }

    /// How far the rays came.
    #[inline(always)]
    pub fn t(&self) -> L {
        self.hits.found.lanes(T, self.start)
    }

    /// Towards where the ray came from.
    #[inline(always)]
    pub fn wo(&self) -> Vec3<L> {
        self.found(WO)
    }

    /// Of unit length, facing the ray.
    #[inline(always)]
    pub fn normal(&self) -> Vec3<L> {
        let [x, y, z] = self.hits.surface.group(NORMAL, self.start);
        Vec3::new(x, y, z)
    }

    /// The same of the face itself, where the surface is smoothed.
    #[inline(always)]
    pub fn geometric_normal(&self) -> Vec3<L> {
        let [x, y, z] = self.hits.geometric.group(0, self.start);
        Vec3::new(x, y, z)
    }

    /// Is nothing there but the background?
    #[inline(always)]
    pub fn is_sky(&self) -> L::Mask {
        self.primitive().eq(L::splat(SKY))
    }

    #[inline(always)]
    pub fn face(&self) -> Face<L> {
        let [before, after, outer] = self.hits.faces.group(BEFORE, self.start);
        Face { before, after, outer }
    }

    /// The handles of the solids before and behind the face of one hit, and the band of the ray.
    pub fn media_of(&self, lane: usize) -> [u32; 3] {
        let row = (self.start + lane).min(self.hits.len() - 1);
        [BEFORE, AFTER, BAND].map(|column| index(self.hits.faces.at(column, row)) as u32)
    }

    #[inline(always)]
    pub fn band(&self) -> L {
        self.hits.faces.lanes(BAND, self.start)
    }

    #[inline(always)]
    pub fn local_color(&self) -> Rgb<L> {
        let [r, g, b] = self.hits.surface.group(LOCAL, self.start);
        Rgb::new(r, g, b)
    }

    #[inline(always)]
    pub fn ray(&self) -> L {
        self.hits.found.lanes(RAY, self.start)
    }

    #[inline(always)]
    pub fn pixel(&self) -> L {
        self.hits.found.lanes(PIXEL, self.start)
    }

    #[inline(always)]
    pub fn primitive(&self) -> L {
        self.hits.found.lanes(PRIMITIVE, self.start)
    }

    /// What the rays that hit here carry.
    #[inline(always)]
    pub fn weight(&self) -> Weight<L> {
        let [r, g, b, fr, fg, fb] = self.hits.found.group(ATTENUATION, self.start);
        Weight { attenuation: Rgb::new(r, g, b), factor: Rgb::new(fr, fg, fb) }
    }

    #[inline(always)]
    pub fn coefficients(&self) -> Coefficients<L> {
        Coefficients { kr: self.material_color(|m| m.kr), ko: self.material_color(|m| m.ko) }
    }

    #[inline(always)]
    pub fn material(&self, value: impl Fn(&Material) -> f64) -> L {
        if self.one_material {
            L::splat(value(self.material_of(0)))
        } else {
            L::from_fn(|lane| value(self.material_of(lane)))
        }
    }

    #[inline(always)]
    pub fn material_color(&self, value: impl Fn(&Material) -> Rgb) -> Rgb<L> {
        if self.one_material {
            value(self.material_of(0)).splat()
        } else {
            Rgb::from_fn(|lane| value(self.material_of(lane)))
        }
    }

    /// The same of a colour that patterns multiply.
    #[inline(always)]
    pub fn patterned(&self, value: impl Fn(&Material) -> Rgb) -> Rgb<L> {
        let color = self.material_color(value);
        if self.hits.tints.len() == 0 {
            return color;
        }
        let [r, g, b] = self.hits.tints.group(0, self.start);
        color * Rgb::new(r, g, b)
    }

    /// How much of the surface is there.
    #[inline(always)]
    pub fn coverage(&self) -> L {
        if self.hits.coverage.len() == 0 { L::splat(1.0) } else { self.hits.coverage.lanes(0, self.start) }
    }

    /// What dyes the light that goes through: `kd`, and the pattern as far as that is there.
    #[inline(always)]
    pub fn dye(&self) -> Rgb<L> {
        let coverage = self.coverage();
        let bare = L::splat(1.0) - coverage;
        let kd = self.material_color(
            #[inline(always)]
            |m| m.kd,
        );
        let patterned = self.patterned(
            #[inline(always)]
            |m| m.kd,
        );
        kd * Rgb::new(bare, bare, bare) + patterned * Rgb::new(coverage, coverage, coverage)
    }

    /// The number of the material of one hit.
    #[inline(always)]
    pub fn material_number(&self, lane: usize) -> u32 {
        let row = (self.start + lane).min(self.hits.len() - 1);
        index(self.hits.surface.at(MATERIAL, row)) as u32
    }

    #[inline(always)]
    fn material_of(&self, lane: usize) -> &Material {
        let row = (self.start + lane).min(self.hits.len() - 1);
        &self.world.materials[index(self.hits.surface.at(MATERIAL, row))]
    }

    #[inline(always)]
    pub fn is_sphere(&self) -> L::Mask {
        self.primitive().lt(L::splat(self.world.spheres.len() as f64))
    }

    /// Centre of the sphere that was hit; for a triangle any point, which nobody looks at.
    #[inline(always)]
    pub fn center(&self) -> Vec3<L> {
        Vec3::from_fn(|lane| {
            let row = (self.start + lane).min(self.hits.len() - 1);
            self.world.spheres.get(self.hits.primitive(row) as usize).map_or(Vec3::default(), |s| s.center)
        })
    }
}
