//! The hits of a generation as columns, and a view of several of them at once.

use super::carried::Carried;
use super::leaving::together_at_most;
use super::propagation::Propagation;
use super::queue::{Generation, Outgoing, Ray};
use crate::color::Rgb;
use crate::geometry::Vec3;
use crate::geometry::bvh::FewSpheres;
use crate::lanes::{Columns, Lanes, MAX_WIDTH, Mask, Number, Record, Row, Table, index, table};
use crate::stage::{CompiledMaterial, Stage};

/// As a primitive: nothing is there, only the background.
pub(super) const SKY: f64 = -1.0;

table! {
    /// A hit as it is found.
    Found,
    /// The same in columns.
    FoundColumns {
        /// Row of its ray in the queue.
        ray: Number,
        pixel: Number,
        primitive: Number,
        t: Number,
        point: Vec3,
        /// Towards where the ray came from.
        wo: Vec3,
    }
}

table! {
    /// What is looked up about it.
    Surface,
    /// The same in columns.
    SurfaceColumns {
        /// The shading normal, of unit length, facing the ray.
        normal: Vec3,
        material: Number,
    }
}

/// The hits of a generation, compacted, in the order of their rays.
#[derive(Debug)]
pub struct Hits<P: Propagation> {
    found: FoundColumns,
    carried: Carried,
    faces: P::Face,
    surface: SurfaceColumns,
    /// Where surfaces are met from both sides: the normals of the faces themselves; else empty.
    geometric: Columns<3>,
    local: Columns<3>,
    contribution: Columns<3>,
    /// By what the colours of the surfaces are multiplied, if there are patterns; else empty.
    tints: Columns<3>,
    /// How much of the surfaces is there, if there are patterns with holes; else empty.
    coverage: Columns<1>,
    /// Spheres that the rays may meet.
    seen: FewSpheres,
}

impl<P: Propagation> Default for Hits<P> {
    fn default() -> Self {
        Self {
            found: FoundColumns::default(),
            carried: Carried::default(),
            faces: P::Face::default(),
            surface: SurfaceColumns::default(),
            geometric: Columns::default(),
            local: Columns::default(),
            contribution: Columns::default(),
            tints: Columns::default(),
            coverage: Columns::default(),
            seen: FewSpheres::default(),
        }
    }
}

impl<P: Propagation> Hits<P> {
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.found.len()
    }

    #[inline(always)]
    pub fn clear(&mut self) {
        self.found.clear();
        self.carried.clear();
        self.faces.clear();
    }

    /// Those of a few spheres that rays may meet, in memory that is to be given back.
    #[inline(always)]
    pub(super) fn seen_of(&mut self, spheres: &FewSpheres, rays: &impl Generation<P>) -> FewSpheres {
        let mut seen = core::mem::take(&mut self.seen);
        seen.clear();
        seen.extend(spheres.iter().filter(|(_, sphere)| rays.may_meet(sphere)));
        seen
    }

    /// Keeps the memory of what [`seen_of`](Self::seen_of) has returned.
    #[inline(always)]
    pub(super) fn give_back(&mut self, seen: FewSpheres) {
        self.seen = seen;
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
        rays: &impl Generation<P>,
    ) {
        let (ray, pixel) = (L::ramp(row), rays.pixels(row));
        self.found.push(hit, &Found { ray, pixel, primitive, t, point: o + d * t, wo: -d });
        rays.copy_carried::<L>(hit, row, &mut self.carried);
    }

    /// Appends the faces of the hits that were appended last.
    #[inline(always)]
    pub(super) fn push_faces<L: Lanes>(&mut self, hit: L::Mask, faces: &Row<P::Face, L>) {
        self.faces.push(hit, faces);
    }

    /// Looks up the surfaces of all hits.
    #[inline(always)]
    pub(super) fn look_up_surfaces<L: Lanes>(&mut self, stage: &Stage) {
        let two_sided = P::TWO_SIDED;
        self.surface.clear();
        self.geometric.clear();
        self.tints.clear();
        self.coverage.clear();
        self.local.resize(self.len());
        self.contribution.resize(self.len());
        for start in (0..self.len()).step_by(L::WIDTH) {
            let (mut primitives, mut materials) = ([0; MAX_WIDTH], [0.0; MAX_WIDTH]);
            for lane in 0..L::WIDTH.min(self.len() - start) {
                let primitive = self.found.primitive::<f64>(start + lane);
                if primitive != SKY {
                    primitives[lane] = index(primitive);
                    materials[lane] = f64::from(stage.material_of(primitives[lane]));
                }
            }
            let (point, wo) = (self.found.point::<L>(start), self.found.wo::<L>(start));
            let (dir, side) = (-wo, P::side(&self.faces, start));
            let mut there = L::Mask::first(self.len() - start);
            if two_sided {
                there = there & !self.found.primitive::<L>(start).eq(L::splat(SKY));
            }
            let mut normals = [wo, wo];
            if there.any() {
                let rim;
                (normals, rim) = stage.facing_normals::<L>(&primitives, point, dir, &side);
                // Not where the ray has just started: of the place that it leaves it sees the front, too.
                let rim = rim & there & self.found.t::<L>(start).gt(L::splat(together_at_most(stage)));
                if two_sided && rim.any() {
                    let mut turned = false;
                    for lane in 0..L::WIDTH {
                        if !rim.test(lane) {
                            continue;
                        }
                        let front = stage.front_of_silhouette(primitives[lane], point.lane(lane), dir.lane(lane));
                        if let Some(front) = front {
                            let found = self.found.rows::<f64>(start + lane);
                            self.found.replace(start + lane, &Found { primitive: f64::from(front), ..found });
                            primitives[lane] = front as usize;
                            materials[lane] = f64::from(stage.material_of(front as usize));
                            turned = true;
                        }
                    }
                    if turned {
                        normals = stage.facing_normals::<L>(&primitives, point, dir, &side).0;
                    }
                }
            }
            let ([normal, geometric], active) = (normals, L::Mask::first(self.len() - start));
            self.surface.push(active, &Surface { normal: normal.unit(), material: L::load(&materials) });
            if two_sided {
                self.geometric.push(active, geometric.unit().into());
            }
            if !stage.patterns.is_empty() {
                let (there, mut colors, mut coverage) = (there.bits(), [Rgb::gray(1.0); MAX_WIDTH], [1.0; MAX_WIDTH]);
                for lane in 0..L::WIDTH {
                    if there >> lane & 1 != 0 {
                        (colors[lane], coverage[lane]) = stage.pattern_at(primitives[lane], point.lane(lane));
                    }
                }
                let tint = Rgb::<L>::from_fn(
                    #[inline(always)]
                    |lane| colors[lane],
                );
                self.tints.push(active, tint.into());
                if stage.has_alpha {
                    self.coverage.push(active, [L::load(&coverage)]);
                }
            }
        }
    }

    /// Row of the ray of a hit in its queue.
    pub fn ray(&self, row: usize) -> usize {
        index(self.found.ray(row))
    }

    #[inline(always)]
    pub fn pixel(&self, row: usize) -> usize {
        index(self.found.pixel(row))
    }

    #[inline(always)]
    pub fn primitive(&self, row: usize) -> u32 {
        index(self.found.primitive(row)) as u32
    }

    /// Is there nothing but the background?
    pub fn is_sky(&self, row: usize) -> bool {
        self.found.primitive::<f64>(row) == SKY
    }

    /// What the hit adds to its pixel.
    #[inline(always)]
    pub fn contribution(&self, row: usize) -> Rgb {
        let [r, g, b] = self.contribution.group::<f64, 3>(0, row);
        Rgb::new(r, g, b)
    }

    /// Replaces the local colour of a batch.
    #[inline(always)]
    pub fn set_local_color<L: Lanes>(&mut self, start: usize, color: Rgb<L>) {
        self.local.replace::<L, 3>(0, start, color.into());
    }

    /// Says what a batch adds to its pixels.
    #[inline(always)]
    pub fn set_contribution<L: Lanes>(&mut self, start: usize, color: Rgb<L>) {
        self.contribution.replace::<L, 3>(0, start, color.into());
    }

    /// The hits from one row on.
    #[inline(always)]
    pub fn batch<'a, L: Lanes>(&'a self, stage: &'a Stage, start: usize) -> Batch<'a, L, P> {
        let mut active = L::Mask::first(self.len() - start);
        if P::TWO_SIDED {
            active = active & !self.found.primitive::<L>(start).eq(L::splat(SKY));
        }
        let (material, first) = (self.surface.material::<L>(start), self.surface.material::<f64>(start));
        let one_material = !(active & !material.eq(L::splat(first))).any();
        Batch { stage, hits: self, start, active, one_material }
    }
}

/// The hits from one row on, one in each lane. Lanes behind the last hit are not active and of no meaning.
#[derive(Clone, Copy, Debug)]
pub struct Batch<'a, L: Lanes, P: Propagation> {
    /// What stands there.
    pub stage: &'a Stage,
    hits: &'a Hits<P>,
    start: usize,
    /// Which lanes hold a hit.
    pub active: L::Mask,
    /// Neighbouring hits mostly have the same material: then its numbers need not be gathered.
    one_material: bool,
}

impl<L: Lanes, P: Propagation> Batch<'_, L, P> {
    /// Where it is.
    #[inline(always)]
    pub fn point(&self) -> Vec3<L> {
        self.hits.found.point(self.start)
    }

    /// How far the rays came.
    #[inline(always)]
    pub fn t(&self) -> L {
        self.hits.found.t(self.start)
    }

    /// Towards where the ray came from.
    #[inline(always)]
    pub fn wo(&self) -> Vec3<L> {
        self.hits.found.wo(self.start)
    }

    /// Of unit length, facing the ray.
    #[inline(always)]
    pub fn normal(&self) -> Vec3<L> {
        self.hits.surface.normal(self.start)
    }

    /// The same of the face itself, where the surface is smoothed. Only if surfaces are met from both sides.
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

    /// What the propagation knows of the hits.
    #[inline(always)]
    pub fn face(&self) -> Row<P::Face, L> {
        self.hits.faces.rows(self.start)
    }

    /// The same of one of them.
    #[inline(always)]
    pub fn face_of(&self, lane: usize) -> Row<P::Face, f64> {
        self.hits.faces.rows((self.start + lane).min(self.hits.len() - 1))
    }

    /// Ambient light on the surface and what it emits, before any light is asked for.
    #[inline(always)]
    pub fn local_color(&self) -> Rgb<L> {
        let [r, g, b] = self.hits.local.group(0, self.start);
        Rgb::new(r, g, b)
    }

    /// Number of the primitive.
    #[inline(always)]
    pub fn primitive(&self) -> L {
        self.hits.found.primitive(self.start)
    }

    /// What the rays that hit here carry.
    #[inline(always)]
    pub fn carried<T: Record>(&self) -> Row<T, L> {
        self.hits.carried.rows::<L, T>(self.start)
    }

    /// A ray that leaves from each hit.
    #[inline(always)]
    pub fn leaving(&self, origin: Vec3<L>, dir: Vec3<L>, travel: Row<P::Travel, L>) -> Outgoing<L, P> {
        let found = &self.hits.found;
        let (parent, pixel) = (found.ray(self.start), found.pixel(self.start));
        Outgoing { ray: Ray { origin, dir, source: self.primitive(), parent, pixel }, travel }
    }

    /// A number of the material.
    #[inline(always)]
    pub fn material(&self, value: impl Fn(&CompiledMaterial) -> f64) -> L {
        if self.one_material {
            L::splat(value(self.material_of(0)))
        } else {
            L::from_fn(|lane| value(self.material_of(lane)))
        }
    }

    /// A colour of the material.
    #[inline(always)]
    pub fn material_color(&self, value: impl Fn(&CompiledMaterial) -> Rgb) -> Rgb<L> {
        if self.one_material {
            value(self.material_of(0)).splat()
        } else {
            Rgb::from_fn(|lane| value(self.material_of(lane)))
        }
    }

    /// The same of a colour that patterns multiply.
    #[inline(always)]
    pub fn patterned(&self, value: impl Fn(&CompiledMaterial) -> Rgb) -> Rgb<L> {
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
        index(self.hits.surface.material(row)) as u32
    }

    #[inline(always)]
    fn material_of(&self, lane: usize) -> &CompiledMaterial {
        let row = (self.start + lane).min(self.hits.len() - 1);
        &self.stage.materials[index(self.hits.surface.material(row))]
    }

    /// Is it on a sphere?
    #[inline(always)]
    pub fn is_sphere(&self) -> L::Mask {
        self.primitive().lt(L::splat(self.stage.spheres.len() as f64))
    }

    /// Centre of the sphere that was hit; for a triangle any point, which nobody looks at.
    #[inline(always)]
    pub fn center(&self) -> Vec3<L> {
        Vec3::from_fn(|lane| {
            let row = (self.start + lane).min(self.hits.len() - 1);
            self.stage.spheres.get(self.hits.primitive(row) as usize).map_or(Vec3::default(), |s| s.center)
        })
    }
}
