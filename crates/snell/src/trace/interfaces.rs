//! Where rays meet real optics: from which media into which, and what was absorbed on the way.
//!
//! Inside a solid only faces that lead out of it count, outside only those that lead in (`Media::cross`): no distance is so
//! small that a ray could meet the face it comes from, and an edge between two faces is crossed once. Faces that lie in one place,
//! to within the rounding of hits, are one interface, from the medium before all of them to the medium behind all of them;
//! an opaque surface among them is what is seen. Where both media are the same, or have the same index and the face shows
//! nothing itself, there is no interface, and the ray goes on as if nothing had been there.

use super::hits::{Face, Hits, SKY};
use super::media::{Media, OUTSIDE};
use super::queue::Generation;
use super::statistics::StrayExits;
use crate::film::Rgb;
use crate::geometry::bvh::{PACKET, Packet};
use crate::lanes::{Lanes, Mask, index};
use crate::optics::absorption::transmittance_rgb;
use crate::world::{NO_SOLID, World};

/// A packet's rays on their way to an interface.
#[derive(Clone, Debug)]
pub(crate) struct Ways {
    /// In which solids each is, and would be behind the face that it has met.
    before: [f64; PACKET],
    after: [f64; PACKET],
    /// 1 where it meets the face from outside.
    outer: [f64; PACKET],
    /// From where on the medium has been the same, and what the media before have let through.
    since: [f64; PACKET],
    kept: [[f64; PACKET]; 3],
    crossings: Vec<(f64, u32)>,
}

impl Default for Ways {
    fn default() -> Self {
        let zero = [0.0; PACKET];
        Self { before: zero, after: zero, outer: zero, since: zero, kept: [[1.0; PACKET]; 3], crossings: Vec::new() }
    }
}

/// What a ray has met.
enum Met {
    /// A surface: it ends here.
    Face,
    /// Nothing that it would notice up to this distance.
    Nothing(f64),
}

impl Hits {
    /// Finds the next interface of all rays, or the background.
    #[inline(always)]
    pub fn find_interfaces<L: Lanes>(
        &mut self,
        rays: &impl Generation,
        media: &mut Media<'_>,
        ways: &mut Ways,
        packet: &mut Packet,
        stray: &mut StrayExits,
    ) {
        let world = media.world();
        self.clear();
        packet.two_sided = true;
        for first in (0..rays.len()).step_by(PACKET) {
            let all = rays.fill::<L>(packet, first, world.tree.has_triangles());
            for start in (0..PACKET).step_by(L::WIDTH).filter(|&start| all >> start != 0) {
                rays.loads::<L>(first + start).medium.store(&mut ways.before[start..]);
            }
            for ray in ones(all) {
                ways.start(world, packet, ray);
            }
            let (mut open, mut met) = (all, 0);
            while open != 0 {
                let hit = world.tree.intersect::<L, false>(packet, open);
                open = 0;
                for ray in ones(hit) {
                    match ways.meet(media, packet, ray, rays.pixel(first + ray), stray) {
                        Met::Face => met |= 1 << ray,
                        Met::Nothing(up_to) => {
                            open |= 1 << ray;
                            (packet.t_min[ray], packet.t[ray], packet.primitive[ray]) = (up_to, f64::INFINITY, SKY);
                        }
                    }
                }
            }
            for ray in ones(all & !met) {
                (packet.t[ray], packet.primitive[ray]) = (f64::INFINITY, SKY);
            }
            let seen = if world.background == Rgb::gray(0.0) { met } else { all };
            for ray in ones(seen) {
                ways.absorb(media, ray, packet.t[ray]);
            }
            for start in (0..PACKET).step_by(L::WIDTH) {
                let mask = L::Mask::from_bits((seen >> start) as u32);
                if mask.any() {
                    let (t, primitive) = (L::load(&packet.t[start..]), L::load(&packet.primitive[start..]));
                    let mut load = rays.loads::<L>(first + start);
                    let [r, g, b] = [0, 1, 2].map(
                        #[inline(always)]
                        |channel| L::load(&ways.kept[channel][start..]),
                    );
                    load.weight.attenuation = load.weight.attenuation * Rgb::new(r, g, b);
                    let [before, after, outer] = [&ways.before, &ways.after, &ways.outer].map(
                        #[inline(always)]
                        |column| L::load(&column[start..]),
                    );
                    let face = Face { before, after, outer };
                    self.push(mask, first + start, packet.ways(start), t, primitive, &load, &face);
                }
            }
        }
        self.look_up_surfaces::<L>(world);
    }
}

/// The places of the bits that are 1.
fn ones(mut bits: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let place = (bits != 0).then_some(bits.trailing_zeros() as usize & (PACKET - 1));
        bits &= bits.wrapping_sub(1);
        place
    })
}

impl Ways {
    fn start(&mut self, world: &World, packet: &mut Packet, ray: usize) {
        (self.after[ray], self.outer[ray], self.since[ray]) = (self.before[ray], 1.0, 0.0);
        for channel in &mut self.kept {
            channel[ray] = 1.0;
        }
        // A ray that has just entered a solid may leave it at once, at an edge, and by rounding a little before it starts.
        if index(self.before[ray]) as u32 != OUTSIDE {
            packet.t_min[ray] = -world.behind;
        }
    }

    /// Looks at what a ray has hit.
    fn meet(
        &mut self,
        media: &mut Media<'_>,
        packet: &Packet,
        ray: usize,
        pixel: usize,
        stray: &mut StrayExits,
    ) -> Met {
        let world = media.world();
        let (t, primitive, before) = (packet.t[ray], packet.primitive[ray], index(self.before[ray]) as u32);
        let solid = world.solid_of(index(primitive));
        if solid == NO_SOLID {
            (self.after[ray], self.outer[ray]) = (self.before[ray], 1.0);
            return if t > 0.0 { Met::Face } else { Met::Nothing(t) };
        }
        let (origin, dir) = packet.ways::<f64>(ray);
        let (mut after, mut up_to) = (before, t);
        let enters = world.enters(index(primitive), solid, origin, dir, t);
        if world.solids[solid as usize].touches {
            let range = [t - world.clearance, t + world.clearance];
            self.crossings.clear();
            world.tree.crossings(origin, dir, range, &mut self.crossings);
            for &(t, primitive) in &self.crossings {
                up_to = up_to.max(t);
                if t > 0.0
                    && world.solid_of(primitive as usize) == NO_SOLID
                    && f64::from(primitive) != packet.source[ray]
                {
                    // The opaque surface comes next, and nothing before it.
                    return Met::Nothing(t.next_down());
                }
                after = media.cross(after, primitive, origin, dir, t);
            }
        } else if t > 0.0 || !enters {
            after = media.cross(before, index(primitive) as u32, origin, dir, t);
        }
        if after == before && !enters && t > world.clearance && !media.contains(before, solid) {
            stray.add(pixel);
        }
        let (from, to) = (media.medium(before).eta, media.medium(after).eta);
        if media.top(before) == media.top(after) {
            self.before[ray] = f64::from(after);
            return Met::Nothing(up_to);
        }
        if from.to_bits() == to.to_bits() && !(enters && world.shows(index(primitive))) {
            self.absorb(media, ray, t);
            (self.before[ray], self.since[ray]) = (f64::from(after), t);
            return Met::Nothing(up_to);
        }
        (self.after[ray], self.outer[ray]) = (f64::from(after), f64::from(u8::from(enters)));
        Met::Face
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
