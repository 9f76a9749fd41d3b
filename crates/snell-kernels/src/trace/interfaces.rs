//! Where rays meet real optics: from which media into which, and what was absorbed between them.
//!
//! Inside a solid only faces that lead out of it count, outside only those that lead in (`Media::cross`): no distance is so
//! small that a ray could meet the face it comes from, and an edge between two faces is crossed once. Faces that lie in one place,
//! to within the rounding of hits, are one interface, from the medium before all of them to the medium behind all of them;
//! an opaque surface among them is what is seen. Where both media are the same, or have the same index and the face shows
//! nothing itself, there is no interface, and the ray goes on as if nothing had been there.
//!
//! At the start of a ray exits count from a little behind it, entries and opaque surfaces as `Leaving` says. A ray that starts
//! within a solid at an edge may have been rounded to its outside, from where no face leads out: it leaves by the nearest one.

use super::hits::{Batch, Hits, SKY};
use super::leaving::{Leaving, are_in_one_place, back, through, together_at_most, until_clear};
use super::media::{Media, OUTSIDE, WHITE};
use super::propagation::Propagation;
use super::queue::Generation;
use super::statistics::{Overlap, Statistics};
use crate::color::Rgb;
use crate::geometry::Vec3;
use crate::geometry::bvh::{PACKET, Packet};
use crate::lanes::{Kernel, Lanes, Mask, Number, index, table};
use crate::optics::absorption::transmittance_rgb;
use crate::stage::{NO_SOLID, Side, Stage};
use alloc::boxed::Box;
use alloc::vec::Vec;

table! {
    /// What a ray among media has, besides a line and the primitive that it leaves.
    Travel,
    /// The same in columns.
    TravelColumns {
        /// Up to here it is not clear of the place that it leaves, and what it meets is looked at closely.
        clear_at: Number,
        /// In which solids it is: a handle of [`Media`].
        medium: Number,
        /// Its band of light; [`WHITE`] for all of it.
        band: Number,
        /// From where it starts to the place from which it is asked what it meets (`back`, `through`); zero where that is the same.
        back: Vec3,
    }
}

table! {
    /// On which side of a surface a ray is, and what it is in.
    Face,
    /// The same in columns.
    FaceColumns {
        /// In which solids the ray arrives: a handle of [`Media`].
        before: Number,
        /// In which it would go on behind the face.
        after: Number,
        /// 1 where it arrives from outside, else 0.
        outer: Number,
        /// The band of the ray.
        band: Number,
        /// What the media along it have transmitted.
        transmittance: Rgb,
    }
}

/// Real optics: rays are in media, and meet the interfaces between them.
#[derive(Clone, Copy, Debug)]
pub struct Interfaces;

/// What a worker remembers of them.
#[derive(Debug)]
pub struct InterfaceState<'a> {
    /// In which solids rays are.
    pub media: Media<'a>,
    paths: Box<Paths>,
}

impl Propagation for Interfaces {
    type Travel = TravelColumns;
    type Face = FaceColumns;
    type State<'a> = InterfaceState<'a>;

    const T_MIN: f64 = 0.0;
    const TWO_SIDED: bool = true;

    fn new(stage: &Stage) -> InterfaceState<'_> {
        InterfaceState { media: Media::new(stage), paths: Box::default() }
    }

    fn start_tile(state: &mut InterfaceState<'_>) {
        state.media.forget();
    }

    fn medium_of_eye(state: &InterfaceState<'_>) -> u32 {
        state.media.eye()
    }

    #[inline(always)]
    fn from_camera<L: Lanes>(medium: u32) -> Travel<L> {
        let (medium, band) = (L::splat(f64::from(medium)), L::splat(f64::from(WHITE)));
        Travel { clear_at: L::splat(0.0), medium, band, back: Vec3::default().splat() }
    }

    #[inline(always)]
    fn find_hits<L: Lanes>(
        state: &mut InterfaceState<'_>,
        _world: &Stage,
        rays: &impl Generation<Self>,
        hits: &mut Hits<Self>,
        packet: &mut Packet,
        statistics: &mut Statistics,
    ) {
        let InterfaceState { media, paths } = state;
        // A function of its own: the rest of a generation should not have to make room for it.
        L::call(FindInterfaces { hits, rays, media, paths, packet, statistics });
    }

    #[inline(always)]
    fn side<L: Lanes>(faces: &FaceColumns, start: usize) -> Side<L> {
        let (before, after) = (faces.before::<L>(start), faces.after(start));
        Side { within: faces.outer::<L>(start).eq(L::splat(0.0)), either: before.eq(after) }
    }

    #[inline(always)]
    fn shadow_start<L: Lanes>(hits: &Batch<'_, L, Self>, wi: Vec3<L>) -> (Vec3<L>, L) {
        let start = hits.point() + hits.wo() * back(hits.stage, hits.t());
        (start, until_clear(hits.stage, hits.geometric_normal().dot(wi)))
    }

    fn light_along(state: &mut InterfaceState<'_>, ray: &Leaving, distance: f64, medium: u32) -> Rgb {
        state.media.light_along(ray, distance, medium)
    }

    #[inline(always)]
    fn medium_before<L: Lanes>(hits: &Batch<'_, L, Self>) -> L {
        hits.face().before
    }

    fn medium_of_ray(
        state: &InterfaceState<'_>,
        _world: &Stage,
        travel: &Travel<f64>,
    ) -> (f64, Option<u32>, Option<u32>) {
        let (set, band) = (index(travel.medium) as u32, index(travel.band) as u32);
        let solid = state.media.top(set);
        (state.media.eta(set, band), (solid != NO_SOLID).then_some(solid), (band != WHITE).then_some(band))
    }

    fn sides_of_hit(state: &InterfaceState<'_>, hit: &Batch<'_, f64, Self>) -> ([f64; 2], bool) {
        let [before, after, band] = media_of(hit, 0);
        ([before, after].map(|set| state.media.eta(set, band)), hit.face().outer > 0.0)
    }

    fn is_in_the_way(stage: &Stage, ray: &Leaving, (t, primitive): (f64, u32), tinted: bool) -> bool {
        let is_hole = tinted && stage.is_hole(primitive as usize, ray.origin + ray.dir * t);
        ray.meets(stage, primitive, t) && !is_hole
    }
}

/// The handles of the solids before and behind the face of one hit, and the band of the ray.
#[inline(always)]
pub fn media_of<L: Lanes>(hits: &Batch<'_, L, Interfaces>, lane: usize) -> [u32; 3] {
    let Face { before, after, band, .. } = hits.face_of(lane);
    [before, after, band].map(|number| index(number) as u32)
}

/// What a ray has that leaves hits in this direction, into this medium.
#[inline(always)]
pub fn onward<L: Lanes>(hits: &Batch<'_, L, Interfaces>, dir: Vec3<L>, medium: L, band: L) -> Travel<L> {
    let clear_at = until_clear(hits.stage, hits.geometric_normal().dot(dir));
    Travel { clear_at, medium, band, back: Vec3::default().splat() }
}

/// The same of a mirrored ray: what it meets is asked from a place surely in front of the surface.
#[inline(always)]
pub fn mirrored<L: Lanes>(hits: &Batch<'_, L, Interfaces>, dir: Vec3<L>, medium: L, band: L) -> Travel<L> {
    Travel { back: hits.wo() * back(hits.stage, hits.t()), ..onward(hits, dir, medium, band) }
}

/// The same of a ray that goes on through faces that are only partly there, where the mask says so.
#[inline(always)]
pub fn through_holes<L: Lanes>(
    hits: &Batch<'_, L, Interfaces>,
    cut_out: L::Mask,
    dir: Vec3<L>,
    ray: Travel<L>,
) -> Travel<L> {
    let [back, clear] = through(hits.stage, hits.geometric_normal().dot(dir), hits.t());
    Travel {
        back: Vec3::select(cut_out, hits.wo() * back, ray.back),
        clear_at: L::select(cut_out, clear, ray.clear_at),
        ..ray
    }
}

/// A packet's rays on their way to an interface.
#[derive(Clone, Debug)]
struct Paths {
    /// In which solids each is, and would be behind the face that it has met.
    before: [f64; PACKET],
    after: [f64; PACKET],
    /// 1 where it meets the face from outside.
    outer: [f64; PACKET],
    band: [f64; PACKET],
    /// Where it is clear of the plane of the face that it leaves, and how far in front of that face the packet has its start.
    clear: [f64; PACKET],
    back: [[f64; PACKET]; 3],
    /// How often it has left something where it starts, without a face in its way.
    left: [u8; PACKET],
    /// From where on the medium has been the same, and what the media before have let through.
    since: [f64; PACKET],
    /// Where it went into or out of a solid last.
    changed: [f64; PACKET],
    kept: [[f64; PACKET]; 3],
    crossings: Vec<(f64, u32)>,
}

impl Default for Paths {
    fn default() -> Self {
        let zero = [0.0; PACKET];
        Self {
            before: zero,
            after: zero,
            outer: zero,
            band: zero,
            clear: zero,
            back: [zero; 3],
            left: [0; PACKET],
            since: zero,
            changed: zero,
            kept: [[1.0; PACKET]; 3],
            crossings: Vec::new(),
        }
    }
}

/// More media than this do not end at one edge.
const AT_ONE_EDGE: u8 = 8;

/// What a ray has met.
enum Met {
    /// A surface: it ends here.
    Face,
    /// Nothing that it would notice up to this distance.
    Nothing(f64),
}

/// Where a ray meets something.
struct Place {
    /// In which solids it would be behind it.
    after: u32,
    /// The farthest face that belongs to it.
    up_to: f64,
    /// The face that counts: distance and primitive.
    face: (f64, u32),
    /// Does the ray come from outside of it?
    enters: bool,
}

/// Finds the next interface of all rays, or the background.
struct FindInterfaces<'b, 'a, G> {
    hits: &'b mut Hits<Interfaces>,
    rays: &'b G,
    media: &'b mut Media<'a>,
    paths: &'b mut Paths,
    packet: &'b mut Packet,
    statistics: &'b mut Statistics,
}

impl<G: Generation<Interfaces>> Kernel for FindInterfaces<'_, '_, G> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { hits, rays, media, paths, packet, statistics } = self;
        let stage = media.stage();
        hits.clear();
        packet.two_sided = true;
        for first in (0..rays.len()).step_by(PACKET) {
            let all = rays.fill::<L>(packet, first, stage.tree.needs_shears());
            let mut moved = 0;
            for start in (0..PACKET).step_by(L::WIDTH).filter(|&start| all >> start != 0) {
                let (source, travel) = (rays.sources::<L>(first + start), rays.travel(first + start));
                moved |= paths.start(stage, packet, start, source, &travel) << start;
            }
            let (mut open, mut met) = (all, 0);
            while open != 0 {
                let hit = stage.tree.intersect::<L, false>(packet, open);
                let lost = ones(open & !hit).filter(|&ray| paths.leave_where_it_starts(media, packet, ray));
                let hit = hit | lost.fold(0, |lost, ray| lost | 1 << ray);
                open = 0;
                for ray in ones(hit) {
                    match paths.meet(media, packet, ray, index(rays.pixels(first + ray)), statistics) {
                        Met::Face => met |= 1 << ray,
                        Met::Nothing(up_to) => {
                            open |= 1 << ray;
                            (packet.t_min[ray], packet.t[ray], packet.primitive[ray]) = (up_to, f64::INFINITY, SKY);
                        }
                    }
                }
            }
            for ray in ones(all & !met) {
                // Every body ends somewhere: a ray that leaves the scene in one has missed its exit.
                let before = index(paths.before[ray]) as u32;
                if before != OUTSIDE {
                    let (origin, dir) = packet.lines::<f64>(ray);
                    let ahead = paths.clear[ray].max(packet.t_min[ray]).min(stage.reach) + together_at_most(stage);
                    if media.is_lost(before, origin + dir * ahead) {
                        statistics.stray.add(index(rays.pixels(first + ray)));
                    }
                }
                (packet.t[ray], packet.primitive[ray]) = (f64::INFINITY, SKY);
            }
            for ray in ones(met & moved) {
                // From the place itself; but in a corner, where that may be behind what is met, all is as it was asked for.
                let (origin, dir) = rays.lines::<f64>(first + ray);
                let t = stage.meets_at(index(packet.primitive[ray]), origin, dir, packet.t[ray]);
                if let Some(t) = t.filter(|&t| t > 8.0 * stage.coincidence_tolerance) {
                    packet.start_at(ray, origin);
                    packet.t[ray] = t;
                }
            }
            let seen = if stage.background.is_black() { met } else { all };
            for ray in ones(seen) {
                paths.absorb(media, ray, packet.t[ray]);
            }
            for start in (0..PACKET).step_by(L::WIDTH) {
                let mask = L::Mask::from_bits((seen >> start) as u32);
                if mask.any() {
                    let (t, primitive) = (L::load(&packet.t[start..]), L::load(&packet.primitive[start..]));
                    let row = first + start;
                    // The background is nowhere.
                    let at = L::select(primitive.eq(L::splat(SKY)), L::splat(0.0), t);
                    hits.push(mask, row, packet.lines(start), at, primitive, rays);
                    hits.push_faces(mask, &paths.face::<L>(start));
                }
            }
        }
        hits.look_up_surfaces::<L>(stage);
    }
}

/// The places of the bits that are 1.
fn ones(mut bits: u64) -> impl Iterator<Item = usize> {
    core::iter::from_fn(move || {
        let place = (bits != 0).then_some(bits.trailing_zeros() as usize & (PACKET - 1));
        bits &= bits.wrapping_sub(1);
        place
    })
}

impl Paths {
    /// What has been let through, in lanes.
    #[inline(always)]
    fn kept<L: Lanes>(&self, start: usize) -> Rgb<L> {
        let [r, g, b] = &self.kept;
        Rgb::new(L::load(&r[start..]), L::load(&g[start..]), L::load(&b[start..]))
    }

    /// The faces that have been met, in lanes.
    #[inline(always)]
    fn face<L: Lanes>(&self, start: usize) -> Face<L> {
        Face {
            before: L::load(&self.before[start..]),
            after: L::load(&self.after[start..]),
            outer: L::load(&self.outer[start..]),
            band: L::load(&self.band[start..]),
            transmittance: self.kept(start),
        }
    }

    /// Says which rays of a group have been moved in front of the place that they leave.
    #[inline(always)]
    fn start<L: Lanes>(
        &mut self,
        stage: &Stage,
        packet: &mut Packet,
        start: usize,
        source: L,
        travel: &Travel<L>,
    ) -> u64 {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let Travel { clear_at, medium, band, back } = *travel;
        let back_columns: [L; 3] = back.into();
        for (value, column) in [
            (medium, &mut self.before),
            (medium, &mut self.after),
            (one, &mut self.outer),
            (band, &mut self.band),
            (clear_at, &mut self.clear),
            (zero, &mut self.since),
            (zero, &mut self.changed),
        ] {
            value.store(&mut column[start..]);
        }
        for axis in 0..3 {
            one.store(&mut self.kept[axis][start..]);
            back_columns[axis].store(&mut self.back[axis][start..]);
        }
        self.left[start..start + L::WIDTH].fill(0);
        // At an edge a ray may have crossed a face by rounding a little before it starts.
        let anywhere = source.lt(zero) & medium.eq(L::splat(f64::from(OUTSIDE)));
        L::select(anywhere, zero, L::splat(-stage.exit_tolerance)).store(&mut packet.t_min[start..]);
        packet.move_starts(start, back);
        u64::from(back.dot(back).gt(zero).bits())
    }

    fn leaving(&self, packet: &Packet, ray: usize) -> Leaving {
        let (origin, dir) = packet.lines::<f64>(ray);
        let [x, y, z] = &self.back;
        let back = Vec3::new(x[ray], y[ray], z[ray]);
        let wo = if back == Vec3::default() { -dir } else { back };
        Leaving { origin, dir, source: packet.source[ray], clear: self.clear[ray], wo }
    }

    /// Does a ray that goes on behind a thin face only meet the same pane again? Between two faces of one plane is nothing but rounding;
    /// at an edge the ray starts beside its face, and may meet the next one, though it has been through.
    fn leaves_pane(&self, stage: &Stage, packet: &Packet, ray: usize, (t, primitive): (f64, u32)) -> bool {
        let source = packet.source[ray];
        if source < 0.0 || !stage.is_thin(primitive as usize) || !stage.is_thin(index(source)) {
            return false;
        }
        if stage.is_cut_out(index(source)) {
            // It starts in front of its face.
            let (origin, dir) = packet.lines::<f64>(ray);
            return t <= self.clear[ray] && !stage.is_opaque_at(primitive as usize, origin + dir * t);
        }
        // A pane shifts aside by its thickness at most; beyond an edge that is on its next face.
        let within = stage.object_number(primitive) == stage.object_number(index(source) as u32);
        let thickness = stage.materials[stage.material_of(index(source)) as usize].thickness.max(0.0);
        t <= stage.coincidence_tolerance + if within { thickness } else { 0.0 }
    }

    /// Does a ray go on through a face as if that were not there: through a hole, or one that it has been through?
    fn goes_on(&self, stage: &Stage, packet: &Packet, ray: usize, (t, primitive): (f64, u32)) -> bool {
        let (origin, dir) = packet.lines::<f64>(ray);
        self.leaves_pane(stage, packet, ray, (t, primitive)) || stage.is_hole(primitive as usize, origin + dir * t)
    }

    /// Does a ray really meet a face, where it could only be a part of the place that it leaves?
    fn meets(&self, stage: &Stage, packet: &Packet, ray: usize, primitive: u32, t: f64) -> bool {
        if t > self.clear[ray] { t > 0.0 } else { self.leaving(packet, ray).meets(stage, primitive, t) }
    }

    /// For a ray that has missed its exit from something: was it rounded to the outside of an edge where it starts? Then it meets
    /// the nearest face there that leads out, at once.
    fn leave_where_it_starts(&mut self, media: &Media<'_>, packet: &mut Packet, ray: usize) -> bool {
        let before = index(self.before[ray]) as u32;
        let is_clear = packet.t_min[ray] > self.clear[ray];
        if before == OUTSIDE || is_clear || self.left[ray] == AT_ONE_EDGE {
            return false;
        }
        let (origin, dir) = packet.lines::<f64>(ray);
        let Some(primitive) = media.way_out(before, origin, dir) else { return false };
        (packet.t[ray], packet.primitive[ray]) = (0.0, f64::from(primitive));
        self.left[ray] += 1;
        true
    }

    /// Looks at what a ray has hit.
    fn meet(
        &mut self,
        media: &mut Media<'_>,
        packet: &mut Packet,
        ray: usize,
        pixel: usize,
        statistics: &mut Statistics,
    ) -> Met {
        let stage = media.stage();
        let (t, primitive, before) =
            (packet.t[ray], index(packet.primitive[ray]) as u32, index(self.before[ray]) as u32);
        let (origin, dir) = packet.lines::<f64>(ray);
        let solid = stage.interior_of(primitive as usize);
        if solid == NO_SOLID {
            (self.after[ray], self.outer[ray]) = (self.before[ray], 1.0);
            if !self.meets(stage, packet, ray, primitive, t) {
                return Met::Nothing(t);
            }
            if !self.goes_on(stage, packet, ray, (t, primitive)) {
                return Met::Face;
            }
            let next = if stage.has_alpha { self.next_in_place(stage, packet, ray) } else { None };
            let Some(next) = next else { return Met::Nothing(t) };
            packet.primitive[ray] = f64::from(next);
            return self.meet(media, packet, ray, pixel, statistics);
        }
        let enters = stage.enters(primitive as usize, solid, origin, dir, t);
        if enters
            && t > self.clear[ray]
            && media.contains(before, solid)
            && self.leave_where_it_starts(media, packet, ray)
        {
            // Nothing is entered twice: there was an exit.
            return self.meet(media, packet, ray, pixel, statistics);
        }
        let mut place = Place { after: before, up_to: t, face: (t, primitive), enters };
        if stage.solids[solid as usize].touches {
            if let Some(opaque) = self.gather_coincident(media, packet, ray, &mut place) {
                // What is opaque is seen, and nothing else in its place, but through its holes.
                (packet.t[ray], packet.primitive[ray]) = (opaque.0, f64::from(opaque.1));
                (self.after[ray], self.outer[ray]) = (self.before[ray], 1.0);
                return Met::Face;
            }
        } else if !enters || self.meets(stage, packet, ray, primitive, t) {
            place.after = media.cross(before, primitive, origin, dir, t);
        }
        let Place { after, up_to, face, enters } = place;
        let is_clear = t > self.clear[ray].max(self.since[ray] + stage.coincidence_tolerance);
        if after == before && !enters && is_clear && !media.contains(before, solid) {
            // Along the rim of a solid a ray meets an exit and an entry, in one place and in any order; and a face that it sees
            // edge on may look either way.
            if !stage.is_edge_on(primitive as usize, dir) {
                match self.rim(stage, packet, ray, solid) {
                    Some(up_to) => return Met::Nothing(up_to),
                    None => statistics.stray.add(pixel),
                }
            }
        }
        if media.top(before) == media.top(after) {
            self.before[ray] = f64::from(after);
            // At an edge where solids touch, rounding may have let it into one before it was out of the other.
            let overlapped = t - self.changed[ray] > together_at_most(stage);
            if after != before {
                self.changed[ray] = up_to;
            }
            if after != before && overlapped && media.overlap(before, after) {
                let other = stage.solids[media.top(after) as usize].primitive;
                let (pixel, point) = (pixel as u64, origin + dir * t);
                statistics.overlaps.add(Overlap { pixel, primitives: [primitive, other], point });
            }
            return Met::Nothing(up_to);
        }
        let band = index(self.band[ray]) as u32;
        let shows = |(t, face): (f64, u32)| enters && stage.shows(face as usize, origin + dir * t);
        if media.same_index(before, after, band) && !shows(face) {
            self.absorb(media, ray, face.0);
            (self.before[ray], self.since[ray], self.changed[ray]) = (f64::from(after), face.0, up_to);
            return Met::Nothing(up_to);
        }
        (packet.t[ray], packet.primitive[ray]) = (face.0, f64::from(face.1));
        (self.after[ray], self.outer[ray]) = (f64::from(after), f64::from(u8::from(enters)));
        Met::Face
    }

    /// Crosses all faces in one place, in the order of their ids, so that a rounding does not decide which was entered last. The
    /// face that counts is the one into the medium behind the place, or else the one out of the medium before it. Returns an
    /// opaque surface there, if there is one, perhaps one that is only partly there.
    fn gather_coincident(
        &mut self,
        media: &mut Media<'_>,
        packet: &Packet,
        ray: usize,
        place: &mut Place,
    ) -> Option<(f64, u32)> {
        let (stage, leaving) = (media.stage(), self.leaving(packet, ray));
        let Leaving { origin, dir, source, .. } = leaving;
        let (t, before) = (place.up_to, index(self.before[ray]) as u32);
        let far = together_at_most(stage);
        self.crossings.clear();
        stage.tree.crossings(origin, dir, [t - far, t + far], &mut self.crossings);
        self.crossings.retain(|&face| are_in_one_place(stage, (origin, dir), place.face, face));
        if !self.crossings.contains(&place.face) {
            // It is met where the ray starts, and does not lie in its way.
            self.crossings.push(place.face);
        }
        self.crossings.sort_by_key(|&(_, primitive)| primitive);
        let opaque = |&&(t, primitive): &&(f64, u32)| {
            let is_paint = stage.is_cut_out(primitive as usize) && !self.goes_on(stage, packet, ray, (t, primitive));
            (is_paint || stage.is_opaque_at(primitive as usize, origin + dir * t))
                && f64::from(primitive) != source
                && leaving.meets(stage, primitive, t)
        };
        if let Some(&found) = self.crossings.iter().find(opaque) {
            return Some(found);
        }
        self.crossings.retain(|&(t, primitive)| {
            let starts = f64::from(primitive) == source && stage.starts_at(primitive as usize, origin, dir, t);
            let leads_out = media.contains(before, stage.interior_of(primitive as usize));
            !starts && (leads_out || leaving.meets(stage, primitive, t))
        });
        if self.crossings.len() > 1 {
            // Along the rim of a solid there is an entry and an exit in one place, which cancel.
            let enters = |&(t, primitive): &(f64, u32)| {
                let solid = stage.interior_of(primitive as usize);
                (solid, solid != NO_SOLID && stage.enters(primitive as usize, solid, origin, dir, t))
            };
            let entries: Vec<_> = self.crossings.iter().map(enters).collect();
            let mut kept = entries.iter().map(|&(solid, enters)| !entries.contains(&(solid, !enters)));
            self.crossings.retain(|_| kept.next().unwrap_or(true));
        }
        let mut crossed = |&(t, primitive): &(f64, u32)| {
            let next = media.cross(place.after, primitive, origin, dir, t);
            place.up_to = place.up_to.max(t);
            core::mem::replace(&mut place.after, next) != next
        };
        self.crossings.retain(|face| crossed(face));
        let beside = |primitive: u32, solid: u32| {
            let primitive = primitive as usize;
            solid != NO_SOLID && (stage.interior_of(primitive) == solid || stage.exterior_of(primitive) == solid)
        };
        let of = |solid: u32| self.crossings.iter().rev().find(|&&(_, primitive)| beside(primitive, solid));
        if let Some(&(t, primitive)) = of(media.top(place.after)).or_else(|| of(media.top(before))) {
            place.face = (t, primitive);
            place.enters = stage.enters(primitive as usize, stage.interior_of(primitive as usize), origin, dir, t);
        }
        None
    }

    /// What a ray meets at exactly the distance of something that it goes on through: the tree has told only the first that is there.
    fn next_in_place(&mut self, stage: &Stage, packet: &Packet, ray: usize) -> Option<u32> {
        let ((origin, dir), t, first) = (packet.lines::<f64>(ray), packet.t[ray], index(packet.primitive[ray]) as u32);
        let mut crossings = core::mem::take(&mut self.crossings);
        crossings.clear();
        stage.tree.crossings(origin, dir, [t, t], &mut crossings);
        let is_met = |&&(_, primitive): &&(f64, u32)| {
            primitive > first
                && self.meets(stage, packet, ray, primitive, t)
                && !self.goes_on(stage, packet, ray, (t, primitive))
        };
        let next = crossings.iter().find(is_met).map(|&(_, primitive)| primitive);
        self.crossings = crossings;
        next
    }

    /// The farthest face of a solid in the place of the hit, if there are entries among them.
    fn rim(&mut self, stage: &Stage, packet: &Packet, ray: usize, solid: u32) -> Option<f64> {
        let ((origin, dir), t) = (packet.lines::<f64>(ray), packet.t[ray]);
        let off = until_clear(stage, stage.geometric_normal(index(packet.primitive[ray]), origin + dir * t).dot(dir));
        self.crossings.clear();
        stage.tree.crossings(origin, dir, [t - off, t + off], &mut self.crossings);
        self.crossings.retain(|&(_, primitive)| stage.interior_of(primitive as usize) == solid);
        let way_in = |&(t, primitive): &(f64, u32)| stage.enters(primitive as usize, solid, origin, dir, t);
        self.crossings.iter().any(way_in).then(|| self.crossings.iter().fold(t, |up_to, &(t, _)| up_to.max(t)))
    }

    /// Takes away what the medium absorbs up to a distance.
    fn absorb(&mut self, media: &Media<'_>, ray: usize, t: f64) {
        let sigma_a = media.medium(index(self.before[ray]) as u32).sigma_a;
        if sigma_a == Rgb::gray(0.0) {
            return;
        }
        let length = (t - self.since[ray]).max(0.0);
        let passed = transmittance_rgb::<f64>(sigma_a, length).to_array();
        for (kept, passed) in self.kept.iter_mut().zip(passed) {
            kept[ray] *= passed;
        }
    }
}
