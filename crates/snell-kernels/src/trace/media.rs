//! In which solids a ray is, and what medium that makes.
//!
//! A ray carries one number, the handle of a set of solids, in the order in which they were entered. The medium around it is
//! that of the solid with the highest priority, the last entered among equals (Schmidt and Budge, *Simple Nested
//! Dielectrics in Ray Traced Images*, Journal of Graphics Tools 7(2), 2002); with no solid, the space between the objects.

use super::leaving::{Leaving, are_in_one_place};
use super::pane::Pane;
use crate::color::Rgb;
use crate::geometry::{Bounds, Vec3};
use crate::optics::absorption::transmittance_rgb;
use crate::optics::fresnel::fresnel_dielectric;
use crate::optics::thin::slanted_pass;
use crate::stage::{Medium, NO_SOLID, Stage};
use alloc::collections::BTreeMap;
use alloc::vec::Vec;

/// The handle of the set of no solids.
pub const OUTSIDE: u32 = 0;

/// The band of a ray that has not split: all colours.
pub const WHITE: u32 = u32::MAX;

/// A set of solids.
#[derive(Clone, Debug)]
struct Set {
    /// In the order in which they were entered.
    solids: Vec<u32>,
    /// The one whose medium is there.
    top: u32,
    medium: Medium,
}

/// Every set that rays have been in so far. Handles belong to one worker and never reach a picture.
#[derive(Clone, Debug)]
pub struct Media<'a> {
    stage: &'a Stage,
    sets: Vec<Set>,
    handles: BTreeMap<Vec<u32>, u32>,
    /// What has been worked out: from a set across a solid's surface.
    across: BTreeMap<(u32, u32), u32>,
    /// The set that holds the eye.
    eye: u32,
    crossings: Vec<(f64, u32)>,
}

impl<'a> Media<'a> {
    /// Of what stands there.
    pub fn new(stage: &'a Stage) -> Self {
        let mut media = Self {
            stage,
            sets: Vec::new(),
            handles: BTreeMap::new(),
            across: BTreeMap::new(),
            eye: OUTSIDE,
            crossings: Vec::new(),
        };
        media.intern(Vec::new());
        let eye = stage.camera.eye;
        if stage.solids.iter().any(|solid| solid.between_faces_of.is_some() || solid.bounds.meets(&Bounds::of([eye]))) {
            media.eye = media.around(eye);
        }
        media
    }

    /// The solids that hold a point: those whose surface a ray from there crosses outward more often than inward. The order of
    /// entering is not known; the scene's is taken.
    fn around(&mut self, point: Vec3) -> u32 {
        // Any direction will do. Along this one rays seldom meet an edge.
        let dir = Vec3::new(0.309_016_994_374_947_4, 0.754_877_666_246_692_7, 0.578_548_4).unit();
        let mut crossings = core::mem::take(&mut self.crossings);
        crossings.clear();
        self.stage.tree.crossings(point, dir, [0.0, f64::INFINITY], &mut crossings);
        let mut balance = BTreeMap::new();
        for place in crossings.chunk_by(|&a, &b| are_in_one_place(self.stage, (point, dir), a, b)) {
            // On an edge several faces are met, which are one entry, one exit, or, along a rim, neither.
            let mut passed: BTreeMap<u32, (bool, bool)> = BTreeMap::new();
            let mut met = |solid: u32, enters: bool| {
                let (in_, out) = passed.entry(solid).or_default();
                *(if enters { in_ } else { out }) = true;
            };
            for &(t, primitive) in place {
                let solid = self.stage.interior_of(primitive as usize);
                if solid != NO_SOLID {
                    let enters = self.stage.enters(primitive as usize, solid, point, dir, t);
                    met(solid, enters);
                    let front = self.stage.exterior_of(primitive as usize);
                    if front != NO_SOLID {
                        met(front, !enters);
                    }
                }
            }
            for (solid, (enters, leaves)) in passed {
                *balance.entry(solid).or_insert(0) += i32::from(leaves) - i32::from(enters);
            }
        }
        self.crossings = crossings;
        self.intern(balance.into_iter().filter(|&(_, out)| out > 0).map(|(solid, _)| solid).collect())
    }

    /// Forgets all sets but that of the eye and the empty one: handles are good for a tile.
    pub fn forget(&mut self) {
        let kept = self.eye as usize + 1;
        self.sets.truncate(kept);
        self.handles.retain(|_, handle| (*handle as usize) < kept);
        self.across.clear();
    }

    /// The set that holds the eye, where camera rays start.
    pub fn eye(&self) -> u32 {
        self.eye
    }

    /// Across a primitive, if it is a face through which a ray in this set can go: one that leads out of a solid of the set, or
    /// into one that is not in it.
    pub fn cross(&mut self, set: u32, primitive: u32, origin: Vec3, dir: Vec3, t: f64) -> u32 {
        let solid = self.stage.interior_of(primitive as usize);
        if solid == NO_SOLID {
            return set;
        }
        let enters = self.stage.enters(primitive as usize, solid, origin, dir, t);
        if enters == self.contains(set, solid) {
            return set;
        }
        let (after, front) = (self.across(set, solid), self.stage.exterior_of(primitive as usize));
        // What is in front of an interface is left on entry, and entered on exit.
        if front != NO_SOLID && enters == self.contains(after, front) { self.across(after, front) } else { after }
    }

    /// The face nearest to a point in this set, within what a hit may be off, through which a ray from there would leave one of its
    /// solids.
    pub fn way_out(&self, set: u32, origin: Vec3, dir: Vec3) -> Option<u32> {
        let (stage, mut faces) = (self.stage, Vec::new());
        stage.tree.near(origin, &mut faces);
        let leads_out = |primitive: u32| {
            let [behind, front] = [stage.interior_of(primitive as usize), stage.exterior_of(primitive as usize)];
            let enters = behind != NO_SOLID
                && stage.enters(primitive as usize, behind, origin, dir, stage.coincidence_tolerance);
            self.contains(set, if enters { front } else { behind }) && !(enters && self.contains(set, behind))
        };
        let distances = faces
            .into_iter()
            .filter(|&face| leads_out(face))
            .map(|face| (stage.shape(face as usize).distance(origin), face));
        let near = distances.filter(|&(distance, _)| distance <= stage.coincidence_tolerance);
        near.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))).map(|(_, face)| face)
    }

    /// Between these sets a solid was left that had the same priority as the one that is there before and after, and another
    /// medium: nobody has said which of the two is there.
    pub fn overlap(&self, before: u32, after: u32) -> bool {
        let (medium, left) = (self.medium(after), &self.sets[before as usize].solids);
        let left = left.iter().filter(|&&solid| !self.contains(after, solid));
        left.map(|&solid| &self.stage.solids[solid as usize].medium)
            .any(|other| other.priority == medium.priority && other != medium)
    }

    /// What stands there.
    pub fn stage(&self) -> &'a Stage {
        self.stage
    }

    fn intern(&mut self, solids: Vec<u32>) -> u32 {
        if let Some(&handle) = self.handles.get(&solids) {
            return handle;
        }
        let of = |solid: u32| self.stage.solids[solid as usize].medium;
        // The last of the largest.
        let top = solids.iter().copied().max_by_key(|&solid| of(solid).priority);
        let outside =
            Medium { eta: self.stage.eta_outside, spectrum: None, sigma_a: Rgb::gray(0.0), priority: i32::MIN };
        let handle = self.sets.len() as u32;
        let set = Set { top: top.unwrap_or(NO_SOLID), medium: top.map_or(outside, of), solids: solids.clone() };
        self.sets.push(set);
        self.handles.insert(solids, handle);
        handle
    }

    /// What of the light from `distance` away reaches a point in this set, straight through what is transparent: black behind
    /// an opaque surface. At each interface the light loses what Fresnel reflects at the angle of its straight path on the side
    /// of the thinner medium, so that nothing is totally reflected; between them, what the media absorb. Between parallel faces they do
    /// so over the refracted path, as in a plate or a stack of plates, elsewhere over the straight one.
    pub(super) fn light_along(&mut self, ray: &Leaving, distance: f64, mut set: u32) -> Rgb {
        let stage = self.stage;
        let mut crossings = core::mem::take(&mut self.crossings);
        crossings.clear();
        stage.tree.crossings(ray.origin, ray.dir, [-stage.exit_tolerance, distance], &mut crossings);
        let (mut light, mut since) = (Rgb::gray(1.0), 0.0);
        // The interface before, and the index in front of the stack of parallel ones that it belongs to.
        let mut last: Option<((usize, Vec3), f64)> = None;
        // What lies in one place is one interface, as for all rays.
        for place in crossings.chunk_by(|&a, &b| are_in_one_place(stage, (ray.origin, ray.dir), a, b)) {
            let (t, first) = place[0];
            let (mut next, mut entered, mut pane) = (set, None, false);
            for &(t, primitive) in place {
                let solid = stage.interior_of(primitive as usize);
                let meets = ray.meets(stage, primitive, t);
                if solid == NO_SOLID {
                    let point = ray.origin + ray.dir * t;
                    if stage.is_hole(primitive as usize, point) {
                        continue;
                    }
                    // On the edge between two triangles a pane is met twice, and is one all the same.
                    let is_pane = stage.is_thin(primitive as usize) && !stage.is_opaque_at(primitive as usize, point);
                    let again = is_pane && core::mem::replace(&mut pane, true);
                    if meets && t < distance && !again {
                        light = light * self.transmitted_by_surface(set, primitive as usize, ray, t);
                    }
                    continue;
                }
                let enters = !self.contains(next, solid);
                if !enters || meets {
                    let after = self.cross(next, primitive, ray.origin, ray.dir, t);
                    if enters && after != next {
                        entered = Some((solid, primitive));
                    }
                    next = after;
                }
            }
            if self.top(next) != self.top(set) {
                if let Some((_, primitive)) = entered.filter(|(solid, _)| *solid == self.top(next)) {
                    light = light * stage.lets_through(primitive as usize, ray.origin + ray.dir * t);
                }
                let (before, after) = (*self.medium(set), *self.medium(next));
                let (hit, straight) = ((first as usize, ray.origin + ray.dir * t), t - since);
                let cos_theta_i = stage.geometric_normal(hit.0, hit.1).dot(ray.dir).abs();
                let stack = last.filter(|&(other, _)| stage.are_parallel([other, hit], ray.dir)).map(|(_, eta)| eta);
                let length = stack.map_or(straight, |eta| refracted_length(straight, cos_theta_i, before.eta / eta));
                light = light * transmittance_rgb::<f64>(before.sigma_a, length);
                (since, last) = (t, Some((hit, stack.unwrap_or(before.eta))));
                let eta = before.eta.max(after.eta) / before.eta.min(after.eta);
                light = light * (1.0 - fresnel_dielectric(cos_theta_i, eta));
            }
            set = next;
            if light == Rgb::gray(0.0) {
                break;
            }
        }
        self.crossings = crossings;
        light * transmittance_rgb::<f64>(self.medium(set).sigma_a, distance - since)
    }

    /// What a surface that no solid has lets through: a pane something, others what is not there of them.
    fn transmitted_by_surface(&self, set: u32, primitive: usize, ray: &Leaving, t: f64) -> Rgb {
        let (stage, point) = (self.stage, ray.origin + ray.dir * t);
        let material = &stage.materials[stage.material_of(primitive) as usize];
        if !material.is_pane() {
            return stage.lets_through(primitive, point);
        }
        let eta = material.eta / self.medium(set).eta;
        let pane = Pane::<f64> { thickness: material.thickness, eta, sigma_a: material.sigma_a };
        let cos_theta_i = stage.geometric_normal(primitive, point).dot(ray.dir).abs();
        stage.lets_through(primitive, point) * pane.passage(cos_theta_i).transmittance
    }

    /// Is a ray lost that has met no exit from this set and is at `point`? Only if that is really in a body of the set: a ray along
    /// a rim, or one that was rounded out of a corner, is not. What interfaces fill may be as wide as the sea.
    pub fn is_lost(&mut self, set: u32, point: Vec3) -> bool {
        let is_body = |&solid: &u32| self.stage.solids[solid as usize].between_faces_of.is_none();
        let bodies: Vec<u32> = self.sets[set as usize].solids.iter().copied().filter(is_body).collect();
        if bodies.is_empty() {
            return false;
        }
        let there = self.around(point);
        bodies.into_iter().any(|solid| self.contains(there, solid))
    }

    /// Is a ray in this solid?
    #[inline(always)]
    pub fn contains(&self, set: u32, solid: u32) -> bool {
        self.sets[set as usize].solids.contains(&solid)
    }

    /// Across the surface of a solid: into it, or out of it.
    pub fn across(&mut self, set: u32, solid: u32) -> u32 {
        if let Some(&next) = self.across.get(&(set, solid)) {
            return next;
        }
        let mut solids = self.sets[set as usize].solids.clone();
        match solids.iter().position(|&s| s == solid) {
            Some(at) => {
                solids.remove(at);
            }
            None => solids.push(solid),
        }
        let next = self.intern(solids);
        self.across.insert((set, solid), next);
        next
    }

    /// The solid whose medium is there, [`NO_SOLID`] outside of all.
    #[inline(always)]
    pub fn top(&self, set: u32) -> u32 {
        self.sets[set as usize].top
    }

    /// The index that is there for a ray of this band; [`WHITE`] for one that has not split.
    #[inline(always)]
    pub fn eta(&self, set: u32, band: u32) -> f64 {
        let medium = self.medium(set);
        match medium.spectrum {
            Some(spectrum) if band != WHITE => self.stage.spectra[spectrum as usize][band as usize],
            _ => medium.eta,
        }
    }

    /// Does a ray that has not split split here?
    #[inline(always)]
    pub fn splits(&self, before: u32, after: u32) -> bool {
        before != after && (self.medium(before).spectrum, self.medium(after).spectrum) != (None, None)
    }

    /// Is the index the same on both sides, for a ray of this band?
    pub fn same_index(&self, before: u32, after: u32, band: u32) -> bool {
        let same = |band: u32| self.eta(before, band).to_bits() == self.eta(after, band).to_bits();
        if band == WHITE && self.splits(before, after) {
            return (0..self.stage.bands.len() as u32).all(same);
        }
        same(band)
    }

    /// The medium that is there.
    #[inline(always)]
    pub fn medium(&self, set: u32) -> &Medium {
        &self.sets[set as usize].medium
    }
}

/// Length of the refracted path between two parallel faces that are `straight` apart along a straight one. `eta` is the index
/// between them relative to where light travels so. A path that cannot be refracted stays straight.
fn refracted_length(straight: f64, cos_theta_i: f64, eta: f64) -> f64 {
    let length = slanted_pass(straight * cos_theta_i, cos_theta_i, eta);
    if length.is_finite() { length } else { straight }
}
